//! The impact law as laws: over many random collisions, and against closed forms.
#![allow(
    clippy::disallowed_methods,
    reason = "what is expected may come from any library"
)]

mod support;

use glam::{DMat3, DVec3};
use physics::Response;
use physics::response::{Coefficients, compliance, impulse};
use support::Random;

const ALL: [Response; 3] = [Response::UnoSlater, Response::Guarded, Response::Coulomb];

/// A random eccentric collision: normal, approaching relative velocity, `K`.
fn collision(random: &mut Random) -> (DVec3, DVec3, DMat3) {
    let mut k = DMat3::ZERO;
    for _ in 0..2 {
        let rotation = DMat3::from_quat(random.rotation());
        let inverse = random.vector().abs() * 5.0 + DVec3::splat(0.05);
        let inertia = rotation * DMat3::from_diagonal(inverse) * rotation.transpose();
        k += compliance((3.0 * random.next()).exp(), &inertia, random.vector());
    }
    let n = random.direction();
    let dv = random.vector();
    (n, if dv.dot(n) < 0.0 { -dv } else { dv }, k)
}

fn pair(elasticity: f64, friction: f64) -> Coefficients {
    Coefficients {
        elasticity,
        friction,
    }
}

fn energy_change(f: DVec3, dv: DVec3, k: DMat3) -> f64 {
    f.dot(dv) + 0.5 * f.dot(k * f)
}

#[test]
fn no_collision_adds_energy_and_every_one_separates() {
    let mut random = Random(88172645463325252);
    for response in ALL {
        for _ in 0..100_000 {
            let (n, dv, k) = collision(&mut random);
            let (e, mu) = (random.next().abs(), random.next().abs());
            let f = impulse(response, pair(e, mu), n, dv, &k);
            let before = 0.5 * dv.dot(k.inverse() * dv);
            let change = energy_change(f, dv, k);
            assert!(
                change <= 1e-12 * before,
                "{response:?} e {e} mu {mu} gains {change} of {before}"
            );
            assert!(
                n.dot(dv + k * f) <= 1e-9,
                "{response:?} e {e} mu {mu} still approaches"
            );
        }
    }
}

#[test]
fn guarded_never_pulls_and_never_hops_where_the_paper_does() {
    let mut random = Random(7);
    let (mut pulls, mut hops) = (0, 0);
    for _ in 0..50_000 {
        let (n, dv, k) = collision(&mut random);
        let (e, mu) = (random.next().abs(), random.next().abs());
        let paper = impulse(Response::UnoSlater, pair(e, mu), n, dv, &k);
        pulls += i32::from(paper.dot(n) > 1e-12);
        hops += i32::from(-n.dot(dv + k * paper) > n.dot(dv) * (1.0 + 1e-9));
        let guarded = impulse(Response::Guarded, pair(e, mu), n, dv, &k);
        assert!(guarded.dot(n) <= 1e-12, "pulls at e {e} mu {mu}");
        assert!(
            -n.dot(dv + k * guarded) <= n.dot(dv) * (1.0 + 1e-9),
            "hops at e {e} mu {mu}"
        );
    }
    assert!(
        pulls > 100,
        "the paper's law pulls in some of these: {pulls}"
    );
    assert!(hops > 100, "the paper's law hops in some of these: {hops}");
}

#[test]
fn coulomb_keeps_restitution_and_cone_and_sticks_where_the_cone_is_wide() {
    let mut random = Random(31);
    let (mut stuck, mut slid) = (0, 0);
    for _ in 0..50_000 {
        let (n, dv, k) = collision(&mut random);
        let (e, mu) = (random.next().abs(), 2.0 * random.next().abs());
        let f = impulse(Response::Coulomb, pair(e, mu), n, dv, &k);
        let (pressed, along) = (-f.dot(n), (f - n * f.dot(n)).length());
        let parting = -n.dot(dv + k * f);
        assert!((parting - e * n.dot(dv)).abs() < 1e-9, "e {e} mu {mu}");
        assert!(pressed >= 0.0 && along <= mu * pressed * (1.0 + 1e-12));
        // Sticking is what brings the slip to rest while they press, F01, and e F00 more while they part.
        let f00 = n * (-n.dot(dv) / n.dot(k * n));
        let grips = (f - (f00 * e - k.inverse() * dv)).length() < 1e-9 * (1.0 + f.length());
        assert!(grips || along >= mu * pressed * (1.0 - 1e-9));
        (stuck, slid) = (stuck + i32::from(grips), slid + i32::from(!grips));
    }
    assert!(stuck > 5000 && slid > 5000, "{stuck} stuck, {slid} slid");
}

/// How far the corners of the blend are from what defines them: relative, so that stiff and soft bodies count alike.
#[derive(Debug, Default)]
struct Worst {
    /// Of an impulse across n, per impulse.
    across: f64,
    /// Of a velocity that is to be stopped, per velocity that `K` makes of the impulse.
    left: f64,
    /// Of the energy, per energy before.
    energy: f64,
    /// Of Eq. (9) as it is printed, per sum of its terms.
    blend: f64,
}

fn worse(worst: &mut f64, found: f64, scale: f64) {
    *worst = worst.max(found.abs() / scale);
}

#[test]
fn corners_of_the_blend_are_the_special_impulses() {
    let (mut random, mut worst) = (Random(99), Worst::default());
    for _ in 0..100_000 {
        let (n, dv, k) = collision(&mut random);
        let law = |e, mu| impulse(Response::UnoSlater, pair(e, mu), n, dv, &k);
        let before = 0.5 * dv.dot(k.inverse() * dv);
        // Rounding of K F is of the size of the largest entry of K times F.
        let stiff = k.x_axis.length() + k.y_axis.length() + k.z_axis.length();
        let [f00, f10, f01, f11] =
            [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(e, mu)| law(e, mu));
        // (iii) F00: along N and dV.N = 0.
        worse(&mut worst.across, f00.cross(n).length(), f00.length());
        worse(&mut worst.left, n.dot(dv + k * f00), stiff * f00.length());
        // (i) F10: along N and energy kept.
        worse(&mut worst.across, f10.cross(n).length(), f10.length());
        worse(&mut worst.energy, energy_change(f10, dv, k), before);
        // (iv) F01: dV = 0.
        worse(
            &mut worst.left,
            (dv + k * f01).length(),
            stiff * f01.length(),
        );
        // (ii) F11: dV = k N and energy kept.
        worse(
            &mut worst.left,
            (dv + k * f11).cross(n).length(),
            stiff * f11.length(),
        );
        worse(&mut worst.energy, energy_change(f11, dv, k), before);
        // Eq. (9) in between, term by term.
        let (e, mu) = (random.next().abs(), random.next().abs());
        let terms = [
            f00 * ((1.0 - e) * (1.0 - mu)),
            f10 * (e * (1.0 - mu)),
            f01 * ((1.0 - e) * mu),
            f11 * (e * mu),
        ];
        let scale: f64 = terms.iter().map(|term| term.length()).sum();
        let blend: DVec3 = terms.into_iter().sum();
        worse(&mut worst.blend, (law(e, mu) - blend).length(), scale);
    }
    println!("{worst:?}");
    assert!(worst.across < 1e-15, "{worst:?}");
    assert!(worst.left < 1e-12, "{worst:?}");
    assert!(worst.energy < 1e-13, "{worst:?}");
    assert!(worst.blend < 2e-15, "{worst:?}");
}

#[test]
fn coefficients_that_are_none_do_not_panic() {
    let mut random = Random(5);
    for _ in 0..2000 {
        let (n, dv, k) = collision(&mut random);
        for response in ALL {
            for bad in [f64::NAN, -1.0, 2.0, f64::INFINITY] {
                impulse(response, pair(bad, 0.5), n, dv, &k);
                impulse(response, pair(0.5, bad), n, dv, &k);
            }
        }
    }
}

#[test]
fn sphere_on_a_plane_meets_the_closed_forms() {
    // Hard case 2.4: a uniform sphere, b = 2/5; slip s = v + R w.
    let (m, r) = (6.8, 0.1085);
    let inertia = DMat3::from_diagonal(DVec3::splat(1.0 / (0.4 * m * r * r)));
    let arm = DVec3::new(0.0, -r, 0.0);
    let k = compliance(1.0 / m, &inertia, arm);
    let (v, w) = (DVec3::new(8.0, -1.0, 0.0), DVec3::new(0.0, 0.0, -20.0));
    let dv = v + w.cross(arm);
    let after = |e, mu| {
        let f = impulse(Response::UnoSlater, pair(e, mu), DVec3::NEG_Y, dv, &k);
        v + f / m
    };
    let slip = dv.x;
    let close = |a: f64, b: f64| (a - b).abs() < 1e-9;
    assert!(close(after(0.0, 0.0).x, 8.0) && close(after(0.0, 0.0).y, 0.0));
    assert!(close(after(1.0, 0.0).x, 8.0) && close(after(1.0, 0.0).y, 1.0));
    assert!(close(after(0.0, 1.0).x, 8.0 - slip * 2.0 / 7.0));
    let coned = |mu| {
        let f = impulse(Response::Coulomb, pair(0.5, mu), DVec3::NEG_Y, dv, &k);
        v + f / m
    };
    // Grips where mu (1 + e) v_n covers 2/7 of the slip, else loses that much along.
    assert!(close(coned(2.0).x, 8.0 - slip * 2.0 / 7.0) && close(coned(2.0).y, 0.5));
    assert!(close(coned(0.1).x, 8.0 - 0.1 * 1.5) && close(coned(0.1).y, 0.5));
    let f11 = after(1.0, 1.0);
    assert!(close(f11.x, 8.0 - slip * 2.0 / 7.0));
    assert!(close(f11.y, (1.0 + slip * slip * 2.0 / 7.0).sqrt()));
}

#[test]
fn hop_of_the_paper_is_the_documented_one() {
    // Slides at 8 m/s and touches at 1 m/s with e = mu = 0.49: about 1.3 m/s up by the paper, no more than 1 guarded.
    let (m, r) = (6.8, 0.1085);
    let inertia = DMat3::from_diagonal(DVec3::splat(1.0 / (0.4 * m * r * r)));
    let k = compliance(1.0 / m, &inertia, DVec3::new(0.0, -r, 0.0));
    let up = |response| {
        let f = impulse(
            response,
            pair(0.49, 0.49),
            DVec3::NEG_Y,
            DVec3::new(8.0, -1.0, 0.0),
            &k,
        );
        -1.0 + f.y / m
    };
    assert!(
        (up(Response::UnoSlater) - 1.3).abs() < 0.05,
        "{}",
        up(Response::UnoSlater)
    );
    assert!(
        (up(Response::Guarded) - 0.49).abs() < 1e-9,
        "{}",
        up(Response::Guarded)
    );
}

//! Pitch against material: the frequencies are computed here from measures and moduli, by formulas of elasticity.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use sound::{Impact, Material};

use crate::support::{RATE, at, dry_pressure, spectrum};

/// Sugar maple along the grain [Pa] and the pin's mean density [kg/m3].
const MAPLE: f64 = 12.6e9;
const PIN_DENSITY: f64 = 752.87;

/// The pin's radius [m] at heights [m], as the specification has it.
fn profile() -> Vec<(f64, f64)> {
    include_str!("../../../game/tests/data/pin_profile.csv")
        .lines()
        .skip(1)
        .map(|line| {
            let (height, radius) = line.split_once(',').expect("two columns");
            (height.parse().expect("m"), radius.parse().expect("m"))
        })
        .collect()
}

fn radius_at(profile: &[(f64, f64)], height: f64) -> f64 {
    let above = profile
        .partition_point(|row| row.0 < height)
        .clamp(1, profile.len() - 1);
    let ((h0, r0), (h1, r1)) = (profile[above - 1], profile[above]);
    (r0 + (r1 - r0) * (height - h0) / (h1 - h0).max(1e-9)).max(0.004)
}

/// Frequencies of `stiffness x = omega^2 mass x` with a mass on the diagonal [Hz], in order.
fn frequencies(stiffness: &DMatrix<f64>, mass: &DVector<f64>) -> Vec<f64> {
    let scale = mass.map(|m| 1.0 / m.sqrt());
    let scaled = DMatrix::from_fn(mass.len(), mass.len(), |i, j| {
        scale[i] * stiffness[(i, j)] * scale[j]
    });
    let mut found: Vec<f64> = SymmetricEigen::new(scaled)
        .eigenvalues
        .iter()
        .map(|value| value.max(0.0).sqrt() / TAU)
        .collect();
    found.sort_by(f64::total_cmp);
    found
}

/// Bending of a free pin: a Timoshenko beam in pieces (J. S. Przemieniecki, *Theory of Matrix Structural Analysis*, §5.6).
fn pin_bending() -> Vec<f64> {
    const PIECES: usize = 100;
    let profile = profile();
    let l = 0.381 / PIECES as f64;
    let mut stiffness = DMatrix::zeros(2 * PIECES + 2, 2 * PIECES + 2);
    let mut mass = DVector::zeros(2 * PIECES + 2);
    for piece in 0..PIECES {
        let r = radius_at(&profile, (piece as f64 + 0.5) * l);
        let (area, inertia) = (PI * r * r, PI * r.powi(4) / 4.0);
        let bending = MAPLE * inertia;
        let phi = 12.0 * bending / (0.9 * 0.111 * MAPLE * area * l * l);
        let k = bending / (l.powi(3) * (1.0 + phi));
        let (a, b, c) = (6.0 * l, (4.0 + phi) * l * l, (2.0 - phi) * l * l);
        let rows = [
            [12.0, a, -12.0, a],
            [a, b, -a, c],
            [-12.0, -a, 12.0, -a],
            [a, c, -a, b],
        ];
        for (i, row) in rows.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                stiffness[(2 * piece + i, 2 * piece + j)] += k * value;
            }
            let share = if i % 2 == 0 { area } else { inertia };
            mass[2 * piece + i] += PIN_DENSITY * share * l / 2.0;
        }
    }
    // The first two are the pin as a whole, that moves and turns.
    frequencies(&stiffness, &mass)[2..].to_vec()
}

/// Stretching of a free pin along its axis: a rod in pieces.
fn pin_stretch() -> f64 {
    const PIECES: usize = 100;
    let profile = profile();
    let l = 0.381 / PIECES as f64;
    let mut stiffness = DMatrix::zeros(PIECES + 1, PIECES + 1);
    let mut mass = DVector::zeros(PIECES + 1);
    for piece in 0..PIECES {
        let area = PI * radius_at(&profile, (piece as f64 + 0.5) * l).powi(2);
        let k = MAPLE * area / l;
        for (i, j, sign) in [(0, 0, 1.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 1.0)] {
            stiffness[(piece + i, piece + j)] += sign * k;
        }
        for end in 0..2 {
            mass[piece + end] += PIN_DENSITY * area * l / 2.0;
        }
    }
    frequencies(&stiffness, &mass)[1]
}

/// Spherical Bessel function of the first kind.
fn bessel(order: usize, x: f64) -> f64 {
    // The power series: exact for the arguments below 6 that are asked for.
    let mut term = (1..=order).fold(1.0, |product, k| product * x / (2 * k + 1) as f64);
    let mut sum = 0.0;
    for k in 1..60 {
        sum += term;
        term *= -x * x / 2.0 / (k * (2 * order + 2 * k + 1)) as f64;
    }
    sum
}

/// Lowest `k a` of a free elastic sphere's spheroidal vibration of order `n` at Poisson's ratio 1/3
/// (A. C. Eringen, E. S. Suhubi, *Elastodynamics*, vol. II, §8.14).
fn sphere_root(n: usize) -> f64 {
    let nu = 1.0 / 3.0;
    let ratio = f64::sqrt((1.0 - 2.0 * nu) / (2.0 * (1.0 - nu)));
    let m = n as f64;
    let determinant = |k: f64| {
        let h = k * ratio;
        let t11 = (m * m - m - k * k / 2.0) * bessel(n, h) + 2.0 * h * bessel(n + 1, h);
        let t13 = m * (m + 1.0) * ((m - 1.0) * bessel(n, k) - k * bessel(n + 1, k));
        let t41 = (m - 1.0) * bessel(n, h) - h * bessel(n + 1, h);
        let t43 = (m * m - 1.0 - k * k / 2.0) * bessel(n, k) + k * bessel(n + 1, k);
        t11 * t43 - t13 * t41
    };
    let mut low = 1.0;
    while determinant(low).signum() == determinant(low + 0.01).signum() {
        low += 0.01;
    }
    let mut high = low + 0.01;
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if determinant(middle).signum() == determinant(low).signum() {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// What a material's modes should be [Hz].
fn expected(material: Material) -> Vec<f64> {
    match material {
        Material::Pin => {
            let bending = pin_bending();
            vec![bending[0], bending[1], pin_stretch(), bending[2]]
        }
        Material::Ball => [2, 1, 3]
            .map(|n| sphere_root(n) * 1000.0 / (TAU * 0.1086))
            .to_vec(),
        Material::Lane => (1..=4)
            .map(|n| {
                let wave = f64::sqrt(MAPLE / (12.0 * 705.0)) * 0.0635;
                FRAC_PI_2 * f64::from(n * n) * wave / (1.07 * 1.07)
            })
            .collect(),
        Material::Gutter => (3..=7)
            .map(|n| {
                let n = f64::from(n);
                let plate = f64::sqrt(2.3e9 / (12.0 * 1050.0 * (1.0 - 0.37 * 0.37)));
                let curve = 0.0032 / (TAU * 0.1175 * 0.1175) * plate;
                curve * n * (n * n - 1.0) / (n * n + 1.0).sqrt()
            })
            .collect(),
        _ => {
            let plate = 0.0445 * f64::sqrt(10e9 / (12.0 * 650.0 * (1.0 - 0.09)));
            let f = |m: f64, n: f64| FRAC_PI_2 * plate * ((m / 0.61).powi(2) + (n / 1.5).powi(2));
            vec![f(1., 1.), f(1., 2.), f(1., 3.), f(1., 4.), f(2., 1.)]
        }
    }
}

const COMPUTED: [Material; 5] = [
    Material::Pin,
    Material::Ball,
    Material::Lane,
    Material::Gutter,
    Material::Kickback,
];

#[test]
fn every_computed_mode_of_the_table_is_that_of_its_formula() {
    for material in COMPUTED {
        let expected = expected(material);
        assert_eq!(expected.len(), material.modes().len(), "{material:?}");
        for (mode, expected) in material.modes().iter().zip(expected) {
            let off = mode.frequency_hz / expected - 1.0;
            assert!(off.abs() < 0.01, "{material:?}: {mode:?}, {expected:.1} Hz");
        }
    }
}

/// A tap with a tenth of a gram, too short to leave a mode out, sounds at each of a material's computed frequencies: a peak
/// that stands 6 dB above the valley on either side.
#[test]
fn a_tap_rings_at_the_computed_frequencies_of_its_material() {
    const LENGTH: usize = 1 << 16;
    for material in COMPUTED {
        let tap = Impact {
            point: DVec3::new(0.0, 0.0, -1.0),
            materials: [material, Material::Hand],
            masses: [1.0, 1e-8],
            impulse: 1.0,
            approach_speed: 1.0,
        };
        let [left, _] = dry_pressure(&[at(0.05, tap)], 0.6);
        // From 2 ms after the tap, so that its click is over.
        let start = (0.052 * RATE) as usize;
        let power = spectrum(&left[start..], LENGTH);
        let bin = |frequency: f64| (frequency / RATE * LENGTH as f64) as usize;
        let strongest = |low: f64, high: f64| {
            power[bin(low)..=bin(high)]
                .iter()
                .fold(0.0, |a: f64, b| a.max(*b))
        };
        let weakest = |low: f64, high: f64| {
            power[bin(low)..=bin(high)]
                .iter()
                .fold(f64::MAX, |a: f64, b| a.min(*b))
        };
        for frequency in expected(material) {
            let top = strongest(0.98 * frequency, 1.02 * frequency);
            // Modes 5 % apart share a valley; the others' are deeper.
            let valley = weakest(0.88 * frequency, 0.98 * frequency)
                .max(weakest(1.02 * frequency, 1.12 * frequency));
            let above = 10.0 * (top / valley).log10();
            assert!(
                above > 3.0,
                "{material:?} at {frequency:.0} Hz: {above:.1} dB"
            );
        }
    }
}

#[test]
fn a_pin_is_higher_than_a_kickback_and_a_kickback_higher_than_a_lane() {
    let pitch = |material| {
        let blow = Impact {
            point: DVec3::new(0.0, 0.0, -2.0),
            materials: [Material::Pin, material],
            masses: [1.59, f64::INFINITY],
            impulse: 4.0,
            approach_speed: 2.0,
        };
        let pins = Impact {
            materials: [Material::Pin; 2],
            masses: [1.59; 2],
            ..blow
        };
        let blow = if material == Material::Pin {
            pins
        } else {
            blow
        };
        let [left, _] = dry_pressure(&[at(0.0, blow)], 0.5);
        crate::support::centroid(&left)
    };
    let heard = [Material::Cushion, Material::Kickback, Material::Pin].map(pitch);
    assert!(heard[0] < heard[1] && heard[1] < heard[2], "{heard:?}");
}

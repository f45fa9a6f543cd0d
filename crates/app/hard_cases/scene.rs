//! Scenes for the cases: bodies with textbook inertias, the reference pin, a rack, an alley.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DQuat, DVec3};
use physics::{
    Body, BodyDef, BodyId, Compound, Effect, Effects, MassProperties, Material, Motion,
    PairContact, Pose, Response, Settings, Shape, Surface, World,
};

use experiment::random::SplitMix64;

/// Gravity [m/s2].
pub const G: f64 = 9.81;
/// All models of response.
pub const MODELS: [Response; 3] = [Response::UnoSlater, Response::Guarded, Response::Coulomb];
/// Steps per second from a slow display's to sixteen times a headset's [1/s].
pub const RATES: [f64; 4] = [60.0, 90.0, 720.0, 1440.0];

/// Ball radius [m], mass [kg] and moment of inertia [kg m2] (ball.toml of the reference data).
pub const BALL_RADIUS: f64 = 0.108585;
const BALL_MASS: f64 = 6.803886;
const BALL_INERTIA: f64 = 0.027435;
/// Height of the pin's centre of mass above its base, and radius of its flat base [m] (pin.toml).
pub const PIN_CG: f64 = 0.147461;
pub const BASE_RADIUS: f64 = 0.0257935;
/// Mass and moments of inertia of the pin (pin.toml).
pub const PIN: MassProperties = MassProperties {
    mass: 1.587573,
    inertia: DVec3::new(1.369813e-2, 2.015449e-3, 1.369813e-2),
};

/// The constants of a scene, and the one pair of coefficients of everything in it.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    pub response: Response,
    pub step_hz: f64,
    pub gravity: DVec3,
    /// Elasticity of every pair.
    pub elasticity: f64,
    /// Friction of every pair: the paper's rate, or Coulomb's coefficient.
    pub friction: f64,
    pub sleeping: bool,
}

impl Setup {
    /// Awake, under gravity, 720 steps a second, neither elastic nor rough.
    pub fn new(response: Response) -> Setup {
        Setup {
            response,
            step_hz: 720.0,
            gravity: DVec3::NEG_Y * G,
            elasticity: 0.0,
            friction: 0.0,
            sleeping: false,
        }
    }

    pub fn rate(self, step_hz: f64) -> Setup {
        Setup { step_hz, ..self }
    }

    pub fn weightless(self) -> Setup {
        Setup {
            gravity: DVec3::ZERO,
            ..self
        }
    }

    /// Gravity as on a plane that falls along +x at this angle [rad].
    pub fn slope(self, angle: f64) -> Setup {
        Setup {
            gravity: DVec3::new(angle.sin(), -angle.cos(), 0.0) * G,
            ..self
        }
    }

    /// The coefficients of every pair.
    pub fn contact(self, elasticity: f64, friction: f64) -> Setup {
        Setup {
            elasticity,
            friction,
            ..self
        }
    }

    /// An empty world.
    pub fn world(&self) -> World {
        World::new(Settings {
            step_hz: self.step_hz,
            gravity: self.gravity,
            response: self.response,
            effects: Effects::default().set(Effect::Sleeping, self.sleeping),
            contact: PairContact {
                restitution: self.elasticity,
                friction: self.friction,
            },
            ..Settings::default()
        })
        .expect("the cases' settings can run")
    }

    /// The paper's laws use products, so each object has the root; Coulomb's law reads the world's pair, whose mu may be above 1.
    fn material(&self) -> Material {
        Material {
            elasticity: self.elasticity.sqrt(),
            friction_rate: self.friction.sqrt().min(1.0),
            surface: Surface::default(),
        }
    }

    /// A body that moves, at rest.
    pub fn body(&self, compound: Compound, mass: MassProperties, position: DVec3) -> BodyDef {
        BodyDef {
            compound: Arc::new(compound),
            motion: Motion::Dynamic,
            mass,
            material: self.material(),
            pose: Pose::from_position(position),
            linear_velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            drag_area_m2: 0.0,
        }
    }

    /// A uniform ball.
    pub fn ball(&self, radius: f64, mass: f64, position: DVec3) -> BodyDef {
        let inertia = DVec3::splat(0.4 * mass * radius * radius);
        self.body(
            single(Shape::sphere(radius)),
            MassProperties { mass, inertia },
            position,
        )
    }

    /// The bowling ball.
    pub fn bowling_ball(&self, position: DVec3) -> BodyDef {
        let inertia = DVec3::splat(BALL_INERTIA);
        let mass = BALL_MASS;
        self.body(
            single(Shape::sphere(BALL_RADIUS)),
            MassProperties { mass, inertia },
            position,
        )
    }

    /// A uniform upright cylinder.
    pub fn cylinder(&self, radius: f64, half_height: f64, mass: f64, at: DVec3) -> BodyDef {
        let across = mass * (0.25 * radius * radius + half_height * half_height / 3.0);
        let inertia = DVec3::new(across, 0.5 * mass * radius * radius, across);
        let shape = single(Shape::cylinder(radius, half_height));
        self.body(shape, MassProperties { mass, inertia }, at)
    }

    /// A uniform box.
    pub fn cuboid(&self, half: DVec3, mass: f64, position: DVec3) -> BodyDef {
        let square = half * half;
        let sums = DVec3::splat(square.element_sum()) - square;
        let inertia = sums * (mass / 3.0);
        self.body(
            single(Shape::cuboid(half)),
            MassProperties { mass, inertia },
            position,
        )
    }

    /// The reference pin with its base's centre on `spot`.
    pub fn pin(&self, compound: &Arc<Compound>, spot: DVec3) -> BodyDef {
        let mut def = self.body(single(Shape::sphere(1.0)), PIN, spot + DVec3::Y * PIN_CG);
        def.compound = compound.clone();
        def
    }

    /// A box between two corners that nothing moves.
    pub fn block(&self, low: DVec3, high: DVec3) -> BodyDef {
        let mut def = self.cuboid((high - low) * 0.5, 1.0, (low + high) * 0.5);
        def.motion = Motion::Fixed;
        def
    }

    /// A floor with its surface at y = 0, 100 m each way.
    pub fn floor(&self) -> BodyDef {
        self.block(DVec3::new(-50.0, -1.0, -50.0), DVec3::new(50.0, 0.0, 50.0))
    }

    /// A half-space with its surface at y = 0.
    pub fn ground(&self) -> BodyDef {
        let mut def = self.floor();
        def.compound = Arc::new(single(Shape::half_space(DVec3::Y)));
        def.pose = Pose::IDENTITY;
        def
    }
}

/// A body of one shape; the cases' sizes are valid.
pub fn single(shape: Result<Shape, physics::ShapeError>) -> Compound {
    Compound::single(shape.expect("the cases' sizes are valid"))
}

/// Height above the pin's base to its body frame.
fn above_base(y: f64) -> Pose {
    Pose::from_position(DVec3::Y * (y - PIN_CG))
}

/// The pin of primitives: flat base, belly, neck and head.
pub fn composite_pin() -> Arc<Compound> {
    let parts = [
        (0.0095, Shape::frustum(BASE_RADIUS, 0.0359, 0.0095)),
        (0.1143, Shape::ellipsoid(DVec3::new(0.0605, 0.112, 0.0605))),
        (0.247, Shape::frustum(0.0265, 0.0230, 0.028)),
        (0.3487, Shape::sphere(0.0323)),
    ];
    let placed = parts.map(|(y, shape)| (above_base(y), shape.expect("the pin's sizes are valid")));
    Arc::new(Compound::new(placed.to_vec()).expect("four parts make a body"))
}

/// The pin of one ellipsoid, which stands on its cut.
pub fn ellipsoid_pin() -> Arc<Compound> {
    let ratio = (1.0 - (BASE_RADIUS / 0.0605).powi(2)).sqrt();
    let tall = 0.381 / (1.0 + ratio);
    let shape = Shape::truncated_ellipsoid(DVec3::new(0.0605, tall, 0.0605), -tall * ratio)
        .expect("the pin's sizes are valid");
    let placed = vec![(above_base(tall * ratio), shape)];
    Arc::new(Compound::new(placed).expect("one part makes a body"))
}

/// Where the pins of a rack stand, the head pin at the origin, the rest towards -z [m].
pub fn spots() -> Vec<DVec3> {
    let mut spots = Vec::new();
    for row in 0..4 {
        for k in 0..=row {
            let x = (f64::from(k) - f64::from(row) * 0.5) * 0.3048;
            spots.push(DVec3::new(x, 0.0, -f64::from(row) * 0.263965));
        }
    }
    spots
}

/// A rack of ten pins about the origin, on nothing.
pub fn add_rack(world: &mut World, setup: &Setup, pin: &Arc<Compound>) -> Vec<BodyId> {
    let spots = spots().into_iter();
    spots.map(|spot| world.add(setup.pin(pin, spot))).collect()
}

/// Pin deck with gutters, kickbacks and cushion about the rack, and 3 m of lane before it.
pub fn add_alley(world: &mut World, setup: &Setup) {
    let v = DVec3::new;
    for (low, high) in [
        (v(-0.527, -0.3, -0.87), v(0.527, 0.0, 3.0)),
        (v(-0.762, -0.3, -0.87), v(-0.527, -0.0889, 3.0)),
        (v(0.527, -0.3, -0.87), v(0.762, -0.0889, 3.0)),
        (v(-0.962, -0.5, -2.1), v(-0.762, 0.6, 3.0)),
        (v(0.762, -0.5, -2.1), v(0.962, 0.6, 3.0)),
        (v(-0.962, -0.5, -2.1), v(0.962, -0.3, -0.87)),
        (v(-0.962, -0.5, -2.3), v(0.962, 0.9, -1.77)),
    ] {
        world.add(setup.block(low, high));
    }
}

/// What closes the alley on all sides: a lid and a wall behind the thrower.
pub fn close_alley(world: &mut World, setup: &Setup) {
    let v = DVec3::new;
    for (low, high) in [
        (v(-1.2, 0.6, -2.5), v(1.2, 1.0, 3.5)),
        (v(-1.2, -0.6, 3.0), v(1.2, 1.0, 3.4)),
    ] {
        world.add(setup.block(low, high));
    }
}

/// Adds the bowling ball, rolling towards the rack from `back` metres before the head pin, `aside` to the right.
pub fn throw(world: &mut World, setup: &Setup, aside: f64, back: f64, speed: f64) -> BodyId {
    let mut def = setup.bowling_ball(DVec3::new(aside, BALL_RADIUS, back));
    def.linear_velocity = DVec3::NEG_Z * speed;
    def.angular_velocity = DVec3::NEG_X * (speed / BALL_RADIUS);
    world.add(def)
}

/// Angle between the body's own y axis and the vertical [degrees].
pub fn tilt(body: &Body) -> f64 {
    let axis = body.pose().rotation * DVec3::Y;
    axis.x.hypot(axis.z).atan2(axis.y).to_degrees()
}

/// The same angle between -pi and pi [rad].
pub fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// Momentum, and angular momentum about the origin, of all that moves.
pub fn momenta(world: &World) -> (DVec3, DVec3) {
    let bodies = world.ids().map(|id| world.body(id));
    let moving = bodies.filter(|body| body.motion() == Motion::Dynamic);
    moving.fold((DVec3::ZERO, DVec3::ZERO), |(p, l), body| {
        let own = body.linear_velocity() * body.mass().mass;
        let about = body.pose().position.cross(own);
        (p + own, l + body.angular_momentum() + about)
    })
}

/// Takes so many simulated seconds.
pub fn run(world: &mut World, seconds: f64) {
    let steps = (seconds * world.settings().step_hz).round() as u64;
    for _ in 0..steps {
        world.step();
    }
}

/// A number between two others.
pub fn between(random: &mut SplitMix64, low: f64, high: f64) -> f64 {
    low + (high - low) * random.uniform()
}

/// A vector with parts between -1 and 1.
pub fn vector(random: &mut SplitMix64) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| between(random, -1.0, 1.0)))
}

/// A unit vector, uniform on the sphere.
pub fn direction(random: &mut SplitMix64) -> DVec3 {
    loop {
        let v = vector(random);
        if (0.01..1.0).contains(&v.length_squared()) {
            return v / v.length();
        }
    }
}

/// A rotation, uniform among all.
pub fn rotation(random: &mut SplitMix64) -> DQuat {
    loop {
        let q = DQuat::from_array([(); 4].map(|()| between(random, -1.0, 1.0)));
        if (0.01..1.0).contains(&q.length_squared()) {
            return q.normalize();
        }
    }
}

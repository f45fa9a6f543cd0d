//! One room under one condition: the physics world, the entities in it, and who is who.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use hecs::Entity;
use physics::{Body, BodyDef, BodyId, Compound, Motion, Pose, Shape, ShapeError, World};

use crate::GameError;
use crate::alley;
use crate::bodies;
use crate::components::{
    Ball, Grabbable, Journey, Painted, Physical, Pin, PinKeeper, PushButton, Shown,
};
use crate::config::{Config, coulomb};
use crate::pin_shape::pin_compound;
use crate::visible::Model;

/// Thickness of the sweep bar along the lane [m].
const BAR_THICKNESS: f64 = 0.05;

/// Thickness of the pinsetter's rack, and how far it reaches beyond the outer pins' axes [m].
pub(crate) const TABLE_THICKNESS: f64 = 0.06;
const TABLE_BEYOND_PINS: f64 = 0.09;

/// How far a button's body reaches into the desk when it is up [m].
const BUTTON_ROOT: f64 = 0.01;

/// Everything that is built anew when a game starts in another condition.
pub(crate) struct Room {
    pub config: Config,
    pub world: World,
    pub ecs: hecs::World,
    /// By spot, pin 1 first.
    pub pins: Vec<Entity>,
    /// By place on the rack.
    pub balls: Vec<Entity>,
    /// Red, Blue.
    pub buttons: [Entity; 2],
    pub hand: Entity,
    pub bar: Entity,
    /// The pinsetter's rack, which is only seen.
    pub table: Entity,
    owners: BTreeMap<BodyId, Entity>,
    /// Boxes that never move, for keeping a held thing out of them.
    pub obstacles: Vec<(Pose, DVec3, Shape)>,
    /// Pins and balls before the last step, for pictures of an instant within it.
    earlier: Vec<(Entity, Pose)>,
}

/// Farther than this in one step nothing rolls or flies: it was put somewhere [m].
const PUT: f64 = 0.1;

/// A pose between two.
pub(crate) fn between(before: Pose, now: Pose, share: f64) -> Pose {
    Pose::new(
        before.position.lerp(now.position, share),
        before.rotation.lerp(now.rotation, share),
    )
}

impl Room {
    /// Builds the room that a configuration describes: pins on their spots, balls on the rack.
    ///
    /// # Errors
    /// When physics refuses a setting or a size.
    pub fn new(config: &Config) -> Result<Self, GameError> {
        let mut builder = Builder::new(config)?;
        let obstacles = builder.building()?;
        let pins = builder.pins()?;
        let balls = builder.balls()?;
        let buttons = [
            builder.button(Model::RedButton, -1.0)?,
            builder.button(Model::BlueButton, 1.0)?,
        ];
        let hand = builder.hand()?;
        let bar = builder.bar()?;
        let table = builder.table();
        let Builder {
            world, ecs, owners, ..
        } = builder;
        let mut room = Self {
            config: config.clone(),
            world,
            ecs,
            pins,
            balls,
            buttons,
            hand,
            bar,
            table,
            owners,
            obstacles,
            earlier: Vec::new(),
        };
        room.leave_pins();
        Ok(room)
    }

    /// Puts away the pins that practice leaves out.
    fn leave_pins(&mut self) {
        for pin in self.pins.clone() {
            let mut state: Pin = self.get(pin);
            if self.config.practice.stands(state.number) {
                continue;
            }
            (state.ready, state.keeper) = (None, PinKeeper::Store);
            self.set(pin, state);
            self.set_hidden(pin, true);
            self.take_out(pin);
        }
    }

    /// Keeps the poses of pins and balls; the step that follows is the one whose inside pictures may show.
    pub fn keep_poses(&mut self) {
        let mut earlier = std::mem::take(&mut self.earlier);
        earlier.clear();
        let things = self.pins.iter().chain(&self.balls);
        earlier.extend(things.map(|entity| (*entity, self.body(*entity).pose())));
        self.earlier = earlier;
    }

    /// Where a body is at a share of the last step, from 0 to 1.
    pub fn pose_at(&self, entity: Entity, now: Pose, share: f64) -> Pose {
        let earlier = self.earlier.iter().find(|(thing, _)| *thing == entity);
        match earlier {
            Some((_, before)) if before.position.distance(now.position) < PUT => {
                between(*before, now, share)
            }
            _ => now,
        }
    }

    /// A component of an entity that has it.
    pub fn get<T: hecs::Component + Copy>(&self, entity: Entity) -> T {
        *self
            .ecs
            .get::<&T>(entity)
            .expect("entities keep the components they are built with")
    }

    /// Writes a component back.
    pub fn set<T: hecs::Component + Copy>(&self, entity: Entity, value: T) {
        *self
            .ecs
            .get::<&mut T>(entity)
            .expect("entities keep the components they are built with") = value;
    }

    /// The body of an entity that has one.
    pub fn id(&self, entity: Entity) -> BodyId {
        self.get::<Physical>(entity).0
    }

    /// The body of an entity that has one.
    pub fn body(&self, entity: Entity) -> &Body {
        self.world.body(self.id(entity))
    }

    /// Whose body this is.
    pub fn owner(&self, body: BodyId) -> Entity {
        self.owners[&body]
    }

    /// What an entity looks like.
    pub fn model(&self, entity: Entity) -> Model {
        self.get::<Shown>(entity).model
    }

    /// Hides or shows an entity.
    pub fn set_hidden(&self, entity: Entity, is_hidden: bool) {
        let mut shown: Shown = self.get(entity);
        shown.is_hidden = is_hidden;
        self.set(entity, shown);
    }

    /// Gives a body to the laws of physics, at rest.
    pub fn let_loose(&mut self, entity: Entity) {
        let id = self.id(entity);
        self.world.set_motion(id, Motion::Dynamic);
        self.world.set_velocity(id, DVec3::ZERO, DVec3::ZERO);
        self.world.set_collides(id, true);
    }

    /// Takes a body out of the laws of physics: it goes where it is driven and passes through everything.
    pub fn take_out(&mut self, entity: Entity) {
        let id = self.id(entity);
        self.world.set_motion(id, Motion::Driven);
        self.world.set_velocity(id, DVec3::ZERO, DVec3::ZERO);
        self.world.set_collides(id, false);
    }

    /// Physics steps in a time [s].
    pub fn steps_in(&self, seconds: f64) -> u64 {
        (seconds * self.config.physics.step_hz).round() as u64
    }

    /// The upright pose of a pin whose base stands at a point of the deck.
    pub fn upright(&self, x: f64, z: f64) -> Pose {
        Pose::from_position(DVec3::new(x, self.config.pin.cg_height_m, z))
    }
}

/// A room while it is built.
struct Builder<'a> {
    config: &'a Config,
    world: World,
    ecs: hecs::World,
    owners: BTreeMap<BodyId, Entity>,
}

impl<'a> Builder<'a> {
    fn new(config: &'a Config) -> Result<Self, GameError> {
        Ok(Self {
            config,
            world: bodies::world(config)?,
            ecs: hecs::World::new(),
            owners: BTreeMap::new(),
        })
    }

    /// Adds a body, and the entity it belongs to.
    fn body(&mut self, def: BodyDef, shown: Shown) -> Entity {
        let id = self.world.add(def);
        self.own(id, shown)
    }

    /// The entity that a body belongs to.
    fn own(&mut self, id: BodyId, shown: Shown) -> Entity {
        let entity = self.ecs.spawn((Physical(id), shown));
        self.owners.insert(id, entity);
        entity
    }

    /// Adds a body that goes where it is driven.
    fn driven(&mut self, shape: Shape, pose: Pose, shown: Shown) -> Entity {
        let compound = Arc::new(Compound::single(shape));
        let (motion, mass) = (Motion::Driven, bodies::immovable());
        let def = bodies::body(self.config, coulomb::REST, compound, motion, mass, pose);
        self.body(def, shown)
    }

    fn building(&mut self) -> Result<Vec<(Pose, DVec3, Shape)>, GameError> {
        let mut obstacles = Vec::new();
        for part in alley::parts(self.config) {
            let shown = Shown {
                model: part.model,
                size: part.size,
                body_from_model: Pose::IDENTITY,
                is_hidden: false,
            };
            if part.is_solid {
                let half = part.size / 2.0;
                let id = bodies::add_part(&mut self.world, self.config, &part)?;
                self.own(id, shown);
                obstacles.push((part.pose, half, Shape::cuboid(half)?));
            } else {
                self.ecs.spawn((Painted(part.pose), shown));
            }
        }
        Ok(obstacles)
    }

    fn pins(&mut self) -> Result<Vec<Entity>, ShapeError> {
        let pin = &self.config.pin;
        let compound = Arc::new(pin_compound(pin, self.config.objects.shape)?);
        let spots = alley::pin_spots(&self.config.lane);
        let mut pins = Vec::new();
        for (number, spot) in (1..).zip(spots) {
            let def = bodies::pin(self.config, compound.clone(), spot);
            let pose = def.pose;
            let entity = self.body(def, bodies::shown_pin(self.config, number));
            let state = Pin {
                number,
                spot,
                ready: Some(pose),
                in_pit_since: None,
                keeper: PinKeeper::Nobody,
            };
            self.add(entity, (state, Grabbable));
            pins.push(entity);
        }
        Ok(pins)
    }

    fn balls(&mut self) -> Result<Vec<Entity>, ShapeError> {
        let homes = alley::ball_homes(self.config);
        let mut balls = Vec::new();
        for ((index, ball), home) in (0..).zip(&self.config.balls).zip(homes) {
            let radius = ball.radius_m();
            let shown = bodies::shown_ball(ball, index);
            let entity = self.body(bodies::ball(self.config, ball, home)?, shown);
            let state = Ball {
                index,
                home,
                radius,
                is_beyond: false,
                is_spent: false,
                foul: None,
                astray_since: None,
                journey: Journey::InRoom,
            };
            self.add(entity, (state, Grabbable));
            balls.push(entity);
        }
        Ok(balls)
    }

    fn button(&mut self, model: Model, side: f64) -> Result<Entity, ShapeError> {
        let desk = &self.config.desk;
        let half_height = (desk.button_travel_m + BUTTON_ROOT) / 2.0;
        let shape = Shape::cylinder(desk.button_radius_m, half_height)?;
        let width = 2.0 * desk.button_radius_m;
        let shown = Shown {
            model,
            size: DVec3::new(width, 2.0 * half_height, width),
            body_from_model: Pose::IDENTITY,
            is_hidden: false,
        };
        let state = PushButton {
            foot: alley::button_foot(self.config, side),
            depression: 0.0,
            is_pressed: false,
        };
        let pose = button_pose(self.config, &state);
        let entity = self.driven(shape, pose, shown);
        self.add(entity, (state,));
        Ok(entity)
    }

    fn hand(&mut self) -> Result<Entity, ShapeError> {
        let radius = self.config.hand.radius_m;
        let shown = Shown {
            model: Model::Hand,
            size: DVec3::splat(2.0 * radius),
            body_from_model: Pose::IDENTITY,
            is_hidden: true,
        };
        let pose = Pose::from_position(DVec3::Y);
        let entity = self.driven(Shape::sphere(radius)?, pose, shown);
        self.pass_through(entity);
        Ok(entity)
    }

    fn bar(&mut self) -> Result<Entity, ShapeError> {
        let size = DVec3::new(
            2.0 * alley::kickback_x(self.config) - 0.02,
            self.config.pinsetter.bar_height_m,
            BAR_THICKNESS,
        );
        let shown = Shown {
            model: Model::SweepBar,
            size,
            body_from_model: Pose::IDENTITY,
            is_hidden: false,
        };
        let pose = crate::pinsetter::bar_at_rest(self.config);
        let entity = self.driven(Shape::cuboid(size / 2.0)?, pose, shown);
        self.pass_through(entity);
        Ok(entity)
    }

    /// Pins hang on it by their heads; nothing touches it.
    fn table(&mut self) -> Entity {
        let lane = &self.config.lane;
        let size = DVec3::new(
            3.0 * lane.pin_spacing_m + 2.0 * TABLE_BEYOND_PINS,
            TABLE_THICKNESS,
            3.0 * lane.row_pitch_m + 2.0 * TABLE_BEYOND_PINS,
        );
        let shown = Shown {
            model: Model::SettingTable,
            size,
            body_from_model: Pose::IDENTITY,
            is_hidden: false,
        };
        let pose = crate::pinsetter::table_pose(self.config, 1.0);
        self.ecs.spawn((Painted(pose), shown))
    }

    /// Lets a body that was just made pass through everything, until the game puts it to use.
    fn pass_through(&mut self, entity: Entity) {
        let id = self
            .ecs
            .get::<&Physical>(entity)
            .expect("it was just made")
            .0;
        self.world.set_collides(id, false);
    }

    fn add(&mut self, entity: Entity, components: impl hecs::DynamicBundle) {
        self.ecs
            .insert(entity, components)
            .expect("it was just made");
    }
}

/// Where a button's body is, for how far it is pressed.
pub(crate) fn button_pose(config: &Config, button: &PushButton) -> Pose {
    let top = config.desk.button_travel_m - button.depression;
    let half_height = (config.desk.button_travel_m + BUTTON_ROOT) / 2.0;
    Pose::from_position(button.foot + DVec3::Y * (top - half_height))
}

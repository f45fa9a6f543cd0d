//! The machine behind the lane: it lifts the pins that stand, sweeps the rest away, and sets pins down.

use glam::{DQuat, DVec3};
use hecs::Entity;
use physics::Pose;

use crate::Game;
use crate::alley;
use crate::components::{Ball, Journey, Painted, Pin, PinKeeper};
use crate::config::Config;
use crate::event::EventKind;
use crate::room::{Room, TABLE_THICKNESS};
use crate::throw::{Stage, base_and_axis, is_down};

/// How far before the deck the sweep bar waits and comes down [m].
const BAR_BEFORE_DECK: f64 = 0.25;

/// How close to the deck's end the sweep bar goes [m].
const BAR_BEFORE_END: f64 = 0.05;

/// Gap between the heads of standing pins and the pinsetter's rack [m].
const TABLE_ABOVE_PINS: f64 = 0.005;

/// Gap between the sweep bar and the deck [m].
const BAR_ABOVE_DECK: f64 = 0.01;

/// One run of the machine.
#[derive(Clone, Debug)]
pub(crate) struct Cycle {
    movement: Movement,
    /// Step at which the movement began.
    began: u64,
    /// Pins that are lifted before the sweep, with the poses they are lifted from.
    lifted: Vec<(Entity, Pose)>,
    /// Pins that stand at the end, with the poses they stand in.
    set: Vec<(Entity, Pose)>,
}

/// The machine's movements, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Movement {
    Pause,
    Lift,
    BarDown,
    Sweep,
    BarUp,
    Set,
}

impl Movement {
    fn next(self) -> Option<Self> {
        match self {
            Self::Pause => Some(Self::Lift),
            Self::Lift => Some(Self::BarDown),
            Self::BarDown => Some(Self::Sweep),
            Self::Sweep => Some(Self::BarUp),
            Self::BarUp => Some(Self::Set),
            Self::Set => None,
        }
    }

    fn seconds(self, config: &Config) -> f64 {
        let machine = &config.pinsetter;
        match self {
            Self::Pause => machine.pause_s,
            Self::Lift => machine.lift_s,
            Self::BarDown | Self::BarUp => machine.bar_drop_s,
            Self::Sweep => machine.sweep_s,
            Self::Set => machine.set_s,
        }
    }
}

impl Cycle {
    /// After a throw: a full rack, or what practice leaves of it, on its spots, or the pins that stand, where they stand.
    pub(crate) fn after_throw(room: &Room, now: u64, full_rack: bool) -> Self {
        let standing: Vec<Entity> = in_play(room)
            .into_iter()
            .filter(|pin| !is_down(room, *pin))
            .collect();
        if full_rack {
            let stands = |pin: &&Entity| {
                let number = room.get::<Pin>(**pin).number;
                room.config.practice.stands(number)
            };
            let rack = room.pins.iter().filter(stands);
            let set = rack.map(|pin| (*pin, on_spot(room, *pin))).collect();
            return Self::new(now, Vec::new(), set);
        }
        let lifted = standing
            .iter()
            .map(|pin| (*pin, room.body(*pin).pose()))
            .collect();
        let set = standing
            .iter()
            .map(|pin| (*pin, where_it_stands(room, *pin)))
            .collect();
        Self::new(now, lifted, set)
    }

    /// With no ball delivered: every pin of the rack where it was made ready.
    pub(crate) fn put_back(room: &Room, now: u64) -> Self {
        let pins = in_play(room);
        let standing = pins.iter().filter(|pin| !is_down(room, **pin));
        let lifted = standing.map(|pin| (*pin, room.body(*pin).pose())).collect();
        let ready = |pin: Entity| room.get::<Pin>(pin).ready.map(|pose| (pin, pose));
        Self::new(now, lifted, pins.into_iter().filter_map(ready).collect())
    }

    fn new(now: u64, lifted: Vec<(Entity, Pose)>, set: Vec<(Entity, Pose)>) -> Self {
        Self {
            movement: Movement::Pause,
            began: now,
            lifted,
            set,
        }
    }

    /// Where a pin will stand at the end, raised to the height that pins are lifted to.
    fn raised(&self, room: &Room, pin: Entity) -> Option<Pose> {
        let (_, stand) = self.set.iter().find(|(set, _)| *set == pin)?;
        Some(raise(*stand, room.config.pinsetter.lift_height_m))
    }
}

/// Whether a thing lies in the pit: behind the deck, and its middle below it.
fn is_in_pit(room: &Room, entity: Entity) -> bool {
    let at = room.body(entity).pose().position;
    at.z < room.config.lane.deck_end_z_m && at.y < 0.0
}

/// Pins of this rack.
fn in_play(room: &Room) -> Vec<Entity> {
    let pins = room.pins.iter().copied();
    pins.filter(|pin| room.get::<Pin>(*pin).ready.is_some())
        .collect()
}

/// A pin upright on its spot.
fn on_spot(room: &Room, pin: Entity) -> Pose {
    let spot = room.get::<Pin>(pin).spot;
    room.upright(spot.x, spot.z)
}

/// A standing pin upright where its base is, turned as it is turned.
fn where_it_stands(room: &Room, pin: Entity) -> Pose {
    let (base, axis) = base_and_axis(&room.config, room.body(pin).pose());
    let rotation = DQuat::from_rotation_arc(axis, DVec3::Y) * room.body(pin).pose().rotation;
    Pose::new(room.upright(base.x, base.z).position, rotation)
}

fn raise(pose: Pose, height: f64) -> Pose {
    Pose::new(pose.position + DVec3::Y * height, pose.rotation)
}

/// From 0 to 1 and smooth at both ends.
fn smooth(share: f64) -> f64 {
    let share = share.clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Where the sweep bar waits.
pub(crate) fn bar_at_rest(config: &Config) -> Pose {
    bar_pose(config, 0.0, 0.0)
}

/// Middle of the sweep bar: `down` and `along` from 0 to 1.
fn bar_pose(config: &Config, down: f64, along: f64) -> Pose {
    let machine = &config.pinsetter;
    let (front, rear) = (
        alley::deck_front_z(config) + BAR_BEFORE_DECK,
        config.lane.deck_end_z_m + BAR_BEFORE_END,
    );
    let bottom = machine.bar_rest_height_m + (BAR_ABOVE_DECK - machine.bar_rest_height_m) * down;
    let z = front + (rear - front) * along;
    Pose::from_position(DVec3::new(0.0, bottom + machine.bar_height_m / 2.0, z))
}

/// The pinsetter's rack: `up` is 0 where it holds standing pins by their heads and 1 where it waits.
pub(crate) fn table_pose(config: &Config, up: f64) -> Pose {
    let middle = config.lane.headpin_z_m - 1.5 * config.lane.row_pitch_m;
    let over_pins = config.pin.height_m + TABLE_ABOVE_PINS;
    let height = over_pins + config.pinsetter.lift_height_m * up;
    Pose::from_position(DVec3::new(0.0, height + TABLE_THICKNESS / 2.0, middle))
}

/// How high the rack is at `share` of the cycle's movement.
fn table_height(cycle: &Cycle, share: f64) -> f64 {
    let lifts = !cycle.lifted.is_empty();
    match cycle.movement {
        Movement::Pause if lifts => 1.0 - share,
        Movement::Lift if lifts => share,
        Movement::Set => 1.0 - share,
        _ => 1.0,
    }
}

impl Game {
    /// Moves the machine by one step.
    pub(crate) fn run_pinsetter(&mut self) {
        let Stage::Setting(cycle) = &self.stage else {
            self.raise_table();
            return;
        };
        let steps = self
            .room
            .steps_in(cycle.movement.seconds(&self.room.config))
            .max(1);
        let share = (self.steps - cycle.began) as f64 / steps as f64;
        let mut cycle = cycle.clone();
        move_parts(&mut self.room, &cycle, share);
        if share < 1.0 || !self.may_go_on(&cycle) {
            return;
        }
        self.finish(&cycle);
        match cycle.movement.next() {
            Some(next) => {
                cycle.movement = next;
                cycle.began = self.steps;
                self.begin(&mut cycle);
                self.stage = Stage::Setting(cycle);
            }
            None => {
                self.stage = Stage::Ready {
                    disturbed_since: None,
                };
                let (_, standing) = crate::throw::count(&self.room);
                self.record(EventKind::PinsReady { standing });
            }
        }
    }

    /// The rack goes up again from pins that it has set, at the pace at which it came down.
    fn raise_table(&mut self) {
        let config = &self.room.config;
        let machine = &config.pinsetter;
        let top = table_pose(config, 1.0);
        let per_step = machine.lift_height_m / (machine.set_s * config.physics.step_hz);
        let Painted(mut pose) = self.room.get(self.room.table);
        if pose.position.y < top.position.y {
            pose.position.y = (pose.position.y + per_step).min(top.position.y);
            self.room.set(self.room.table, Painted(pose));
        }
    }

    /// The machine waits before it sets a pin that a hand still holds.
    fn may_go_on(&self, cycle: &Cycle) -> bool {
        let held = self.hand.held.map(|held| held.entity);
        cycle.movement != Movement::BarUp || !cycle.set.iter().any(|(pin, _)| Some(*pin) == held)
    }

    /// Takes away what has lain in the pit for a while, as the belt of a real pit does: it cannot come back on the deck.
    pub(crate) fn clear_pit(&mut self) {
        let patience = self
            .room
            .steps_in(self.room.config.pinsetter.pit_clears_after_s);
        let held = self.hand.held.map(|held| held.entity);
        for pin in self.room.pins.clone() {
            let mut state: Pin = self.room.get(pin);
            let lies_there = state.keeper == PinKeeper::Nobody
                && Some(pin) != held
                && is_in_pit(&self.room, pin);
            let since = lies_there.then(|| state.in_pit_since.unwrap_or(self.steps));
            if since != state.in_pit_since {
                state.in_pit_since = since;
                self.room.set(pin, state);
            }
            if since.is_some_and(|since| self.steps >= since + patience) {
                self.keep(pin, PinKeeper::Store);
            }
        }
    }

    /// What happens at the start of a movement.
    fn begin(&mut self, cycle: &mut Cycle) {
        let held = self.hand.held.map(|held| held.entity);
        match cycle.movement {
            Movement::Lift => {
                cycle.lifted.retain(|(pin, _)| Some(*pin) != held);
                for (pin, from) in &mut cycle.lifted {
                    *from = self.room.body(*pin).pose();
                    self.keep(*pin, PinKeeper::Pinsetter);
                }
            }
            Movement::BarDown => {
                let bar = self.room.id(self.room.bar);
                self.room.world.set_collides(bar, true);
            }
            Movement::Set => {
                for (pin, _) in cycle.set.clone() {
                    let above = cycle
                        .raised(&self.room, pin)
                        .expect("the pin is one of those to set");
                    self.keep(pin, PinKeeper::Pinsetter);
                    let id = self.room.id(pin);
                    self.room.world.set_pose(id, above);
                }
            }
            Movement::Pause | Movement::Sweep | Movement::BarUp => {}
        }
    }

    /// What happens at the end of a movement.
    fn finish(&mut self, cycle: &Cycle) {
        match cycle.movement {
            Movement::Pause => self.return_balls(|ball, deck_end| ball.z < deck_end),
            Movement::Sweep => {
                let bar = self.room.id(self.room.bar);
                self.room.world.set_collides(bar, false);
                self.clear_deck(cycle);
                self.return_balls(|ball, _| ball.z < 0.0);
            }
            Movement::Set => {
                for pin in self.room.pins.clone() {
                    let mut state: Pin = self.room.get(pin);
                    state.ready = cycle
                        .set
                        .iter()
                        .find(|(set, _)| *set == pin)
                        .map(|(_, pose)| *pose);
                    self.room.set(pin, state);
                    if let Some(pose) = state.ready {
                        let id = self.room.id(pin);
                        self.room.world.set_pose(id, pose);
                        self.keep(pin, PinKeeper::Nobody);
                    }
                }
            }
            Movement::Lift | Movement::BarDown | Movement::BarUp => {}
        }
    }

    /// Puts away every pin that the machine has not lifted and no hand holds.
    fn clear_deck(&mut self, cycle: &Cycle) {
        let held = self.hand.held.map(|held| held.entity);
        for pin in self.room.pins.clone() {
            let is_lifted = cycle.lifted.iter().any(|(lifted, _)| *lifted == pin);
            if !is_lifted && Some(pin) != held {
                self.keep(pin, PinKeeper::Store);
            }
        }
    }

    /// Sends balls back to the rack: those for whose position and the deck's end `wanted` holds.
    fn return_balls(&mut self, wanted: impl Fn(DVec3, f64) -> bool) {
        let deck_end = self.room.config.lane.deck_end_z_m;
        let held = self.hand.held.map(|held| held.entity);
        for entity in self.room.balls.clone() {
            let ball: Ball = self.room.get(entity);
            let at = self.room.body(entity).pose().position;
            if ball.journey == Journey::InRoom && Some(entity) != held && wanted(at, deck_end) {
                self.send_back(entity);
            }
        }
    }

    /// Gives a pin to a keeper, and to the laws of physics when nobody keeps it.
    fn keep(&mut self, pin: Entity, keeper: PinKeeper) {
        let mut state: Pin = self.room.get(pin);
        state.keeper = keeper;
        self.room.set(pin, state);
        self.room.set_hidden(pin, keeper == PinKeeper::Store);
        match keeper {
            PinKeeper::Nobody => self.room.let_loose(pin),
            PinKeeper::Pinsetter | PinKeeper::Store => self.room.take_out(pin),
        }
    }
}

/// Drives bar and pins to where the movement has them at `share` of its time.
fn move_parts(room: &mut Room, cycle: &Cycle, share: f64) {
    let share = smooth(share);
    let (down, along) = match cycle.movement {
        Movement::Pause | Movement::Lift => (0.0, 0.0),
        Movement::BarDown => (share, 0.0),
        Movement::Sweep => (1.0, share),
        Movement::BarUp => (1.0 - share, 1.0),
        Movement::Set => (0.0, 1.0 - share),
    };
    let bar = room.id(room.bar);
    let pose = bar_pose(&room.config, down, along);
    room.world.drive_to(bar, pose);
    let table = table_pose(&room.config, table_height(cycle, share));
    room.set(room.table, Painted(table));
    let height = room.config.pinsetter.lift_height_m;
    match cycle.movement {
        Movement::Lift => {
            for (pin, from) in &cycle.lifted {
                let above = Pose::new(raise(*from, height).position, from.rotation);
                drive_between(room, *pin, *from, above, share);
            }
        }
        Movement::Set => {
            for (pin, stand) in &cycle.set {
                drive_between(room, *pin, raise(*stand, height), *stand, share);
            }
        }
        _ => {}
    }
}

/// Drives a pin to a share of the way between two poses.
fn drive_between(room: &mut Room, pin: Entity, from: Pose, to: Pose, share: f64) {
    let pose = Pose::new(
        from.position.lerp(to.position, share),
        from.rotation.lerp(to.rotation, share),
    );
    let id = room.id(pin);
    room.world.drive_to(id, pose);
}

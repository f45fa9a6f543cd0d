//! Which shape the hand has: open, closing with the trigger, pointing at a button, round what it holds.

use game::{Game, Model};

use crate::scenery::hand::Fingers;

/// A hand nearer than this to a button points at it [m].
const POINTS_WITHIN: f64 = 0.3;
/// A trigger that is pulled farther than this closes the hand, also beside a button.
const CLOSES_FROM: f64 = 0.3;

/// The shape of the hand that is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HandShape {
    /// From open, 0, to closed, 1.
    Closing(f64),
    /// The index finger stretched.
    Pointing,
    /// Round what it holds.
    Holding(Model),
    /// As a tracker has the fingers.
    Bent(Fingers),
}

/// The hand as it is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandLook {
    /// Its shape.
    pub shape: HandShape,
    /// It is a left one.
    pub is_left: bool,
}

impl HandLook {
    /// A right hand in a shape.
    pub fn right(shape: HandShape) -> Self {
        Self {
            shape,
            is_left: false,
        }
    }

    /// A left hand in a shape.
    pub fn left(shape: HandShape) -> Self {
        Self {
            shape,
            is_left: true,
        }
    }

    /// How the hand of a game looks now.
    pub fn of(game: &Game) -> Self {
        Self {
            shape: HandShape::of(game),
            is_left: game.hand_is_left(),
        }
    }

    /// As these fingers are bent, unless it holds something.
    pub fn bent(self, tracked: Option<Fingers>) -> Self {
        let shape = match (self.shape, tracked) {
            (HandShape::Holding(_), _) | (_, None) => self.shape,
            (_, Some(fingers)) => HandShape::Bent(fingers),
        };
        Self { shape, ..self }
    }
}

impl HandShape {
    /// The shape that the hand of a game has now.
    fn of(game: &Game) -> Self {
        if let Some(model) = game.held() {
            return Self::Holding(model);
        }
        let trigger = game.trigger();
        if trigger < CLOSES_FROM && is_near_button(game) {
            return Self::Pointing;
        }
        Self::Closing(trigger)
    }

    /// The ball that it holds.
    pub fn held_ball(self) -> Option<Model> {
        match self {
            Self::Holding(model @ Model::Ball(_)) => Some(model),
            _ => None,
        }
    }
}

fn is_near_button(game: &Game) -> bool {
    let desk = &game.config().desk;
    game.hand_pose_world().is_some_and(|hand| {
        [-0.5, 0.5].into_iter().any(|side| {
            let x = desk.x_m + side * desk.button_spacing_m;
            let button = glam::DVec3::new(x, desk.height_m, desk.z_m);
            hand.position.distance(button) < POINTS_WITHIN
        })
    })
}

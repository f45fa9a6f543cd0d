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
    Bent {
        /// How they are bent.
        fingers: Fingers,
        /// A left hand; the others are right ones.
        is_left: bool,
    },
}

impl HandShape {
    /// The shape that the hand of a game has now.
    pub fn of(game: &Game) -> Self {
        if let Some(model) = game.held() {
            return Self::Holding(model);
        }
        let trigger = game.trigger();
        if trigger < CLOSES_FROM && is_near_button(game) {
            return Self::Pointing;
        }
        Self::Closing(trigger)
    }

    /// As these fingers are bent, those of a left hand or a right one, unless it holds something.
    pub fn bent(self, tracked: Option<(Fingers, bool)>) -> Self {
        match (self, tracked) {
            (Self::Holding(_), _) | (_, None) => self,
            (_, Some((fingers, is_left))) => Self::Bent { fingers, is_left },
        }
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

//! The properties of a scene that affect the direction in which a camera without a given position looks.

use super::camera::half_width;
use crate::scene::{Body, GridPlane, Scene};

/// The properties of a scene that affect the direction in which a camera without a given position looks.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DirectionHints {
    /// True if the ground has numbers, which are read from above.
    pub(super) reads_ground: bool,
    /// Whether a coordinate plane with numbers is read along x, or else along z. `None` without such a plane.
    pub(super) along_x: Option<bool>,
    /// The largest width of a body that can move on the ground, m. `None` if there is no such body, or no ground that stops bodies.
    pub(super) on_ground: Option<f64>,
}

impl DirectionHints {
    /// Finds these properties of a scene.
    pub(super) fn of(scene: &Scene) -> DirectionHints {
        let width = |body: &Body| Some(2.0 * half_width(body)?);
        let bodies = scene.bodies.iter().filter(|body| !body.start.fixed);
        let has_ground = scene.ground_that_stops().is_some() && !scene.output.transparent;
        DirectionHints {
            reads_ground: scene.grid.is_some_and(|grid| grid.plane.is_level()),
            along_x: match scene.grid.map(|grid| grid.plane) {
                Some(GridPlane::Yz) => Some(true),
                Some(GridPlane::Xy) => Some(false),
                _ => None,
            },
            on_ground: bodies.filter_map(width).reduce(f64::max).filter(|_| has_ground),
        }
    }
}

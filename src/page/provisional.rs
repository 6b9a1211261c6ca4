//! How a run looks before it has finished.
//!
//! The positions of cameras, the lengths of arrows and the sizes of marks follow from the whole run. Someone who moves a slider would see them
//! change with each value, and vanish in between. So an unfinished run is shown with the look of the run before it, if both are of the same
//! scene.

use super::{Outcome, PageRun};
use crate::diagnostic::Report;
use crate::picture::Plan;
use crate::scene::{Camera, Scene};

/// The largest number of bodies of a scene that is shown so. The look of a larger one takes too long.
const MAX_BODIES: usize = 1_000;

/// Returns the outcome that a run of `scene` has until it is finished. `None` if the run before it is unfinished or of another scene.
pub(super) fn outcome(scene: &Scene, before: &PageRun) -> Option<Outcome> {
    let known = before.look()?;
    if !are_alike(scene, &before.scene) || !is_simple(scene) {
        return None;
    }
    let survey = known.survey.clone();
    let plan = |camera: &Camera| Plan::new(scene, camera, &survey);
    let plans = std::iter::once(plan(&scene.camera)).chain(scene.views.iter().map(|view| plan(&view.camera)));
    let plans = plans.collect();
    Some(Outcome { survey, plans, warnings: Report::default() })
}

/// Returns true if two scenes have the same things, so that what was measured in one has a place in the other.
fn are_alike(a: &Scene, b: &Scene) -> bool {
    let counts = |scene: &Scene| {
        [
            scene.bodies.len(),
            scene.joints.len(),
            scene.forces.len(),
            scene.labels.len(),
            scene.angles.len(),
            scene.distances.len(),
            scene.fields.len(),
            scene.arrow_marks.len(),
            scene.views.len(),
            scene.lights.len(),
            scene.materials.len(),
            scene.color_maps.len(),
            scene.value_maps.len(),
            scene.conditions.len(),
        ]
    };
    a.name == b.name
        && counts(a) == counts(b)
        && a.simulation.contacts == b.simulation.contacts
        && a.bodies.iter().zip(&b.bodies).all(|(a, b)| a.name == b.name)
}

/// Returns true if nothing in the scene's pictures shows a run as a whole: no plots, ghosts, particles, swept areas and lagging cameras.
fn is_simple(scene: &Scene) -> bool {
    let mut cameras = scene.views.iter().map(|view| &view.camera).chain([&scene.camera]);
    scene.bodies.len() <= MAX_BODIES
        && scene.plots.is_empty()
        && scene.areas.is_empty()
        && scene.emitters.is_empty()
        && scene.bodies.iter().all(|body| body.showing.ghosts.is_none())
        && cameras.all(|camera| camera.motion.follow.is_none_or(|follow| follow.lag.is_none()))
}

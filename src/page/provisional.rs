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

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::Arc;

    use super::super::host::NoHost;
    use super::super::{Answer, Frames, answer_of_run};
    use super::*;
    use crate::scene::{Options, Override};

    const SWING: &str = "
        simulation = { duration = 1, gravity = [0, -9.81, 0] }
        [body.bob]
        shape.sphere.radius = 0.1
        location = [1, 0, 0]
        [joint.string.rod]
        between = [[0, 0, 0], 'bob']
        [label.speed]
        text = '${bob.speed}'
        ";

    /// Makes a run of a scene after a whole run of another one, and simulates some pieces of it.
    fn run_after(before: &str, scene: &str, pieces: usize) -> Arc<PageRun> {
        let before = PageRun::whole(Scene::parse(before).unwrap());
        let scene = Arc::new(Scene::parse(scene).unwrap());
        let run = PageRun::new(2, scene, Arc::new(NoHost), Some(&before));
        let mut work = run.work();
        (0..pieces).for_each(|_| assert!(work.advance()));
        run
    }

    fn shown(run: &Arc<PageRun>) -> serde_json::Value {
        match answer_of_run(run, "shown", &Frames { to: Some(1), ..Frames::default() }).unwrap() {
            Answer::Json(bytes) => serde_json::from_slice(&bytes).unwrap(),
            Answer::Binary(_) => panic!("this is JSON"),
        }
    }

    #[test]
    fn an_unfinished_run_shows_its_own_frames_with_the_look_of_the_run_before_it() {
        let heavy = SWING.replace("radius = 0.1", "radius = 0.1\nmass = 3");
        let run = run_after(SWING, &heavy, 3);
        assert!(run.outcome().is_none() && run.look().is_some());
        let first = &shown(&run)[0];
        assert_eq!(first["texts"].as_array().unwrap().len(), 1);
        assert!(!first["things"].as_array().unwrap().is_empty());
        // Without a run of the same scene before it, nothing is known.
        let other = SWING.replace("body.bob]", "body.weight]").replace("bob", "weight");
        for (before, scene) in [
            (SWING, &*other),
            (&*format!("{SWING}\n[plot.x]\ny = 'bob.x'"), &*format!("{heavy}\n[plot.x]\ny = 'bob.x'")),
        ] {
            let run = run_after(before, scene, 3);
            assert!(run.look().is_none());
            assert_eq!(shown(&run), serde_json::json!([]));
        }
    }

    /// Longer runs of all scenes of the gallery take the look of shorter ones.
    #[test]
    fn every_scene_takes_the_look_of_a_run_before_it() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
        let mut looks = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|end| end != "toml") {
                continue;
            }
            let scene = |duration: f64| {
                let overrides = vec![Override::new(format!("simulation.duration={duration}"))];
                Scene::from_path_with(&path, &Options { overrides, ..Options::default() })
            };
            // Some scenes have keyframes or plots that need their whole duration.
            let (Ok(short), Ok(long)) = (scene(0.04), scene(0.08)) else { continue };
            let before = PageRun::whole(short);
            let run = PageRun::new(2, Arc::new(long), Arc::new(NoHost), Some(&before));
            let mut work = run.work();
            work.advance();
            if run.look().is_some() {
                looks += 1;
                for what in ["", "shown", "ghosts"] {
                    answer_of_run(&run, what, &Frames { to: Some(1), ..Frames::default() }).unwrap();
                }
            }
        }
        assert!(looks > 20, "{looks}");
    }
}

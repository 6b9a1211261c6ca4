//! Measures the accuracy of a run: compares it with the same run at smaller timesteps, with a twin (a run from a slightly different
//! start), and with other integration methods.
//!
//! | what | where |
//! | --- | --- |
//! | a method and its timestep | `setting` |
//! | several runs side by side, frame by frame | `lockstep` |
//! | the distance between two runs at one time | `measure` |
//! | the run, the run at half and at a quarter of its timestep, and the twin | `compare` |
//! | the run under the other contact law | `other_scheme` |
//! | error, order, momenta, the time until which the film is accurate | `verdict` |
//! | the rate at which neighboring runs separate | `neighbours` |
//! | the timestep and method that reach an accuracy | `trials` |
//! | the report as text, and as a picture | `text`, `plot` |
//!
//! The error is Richardson's estimate: with a method of order p, a run at the timestep h has an error of about |x_h − x_{h/2}| 2ᵖ/(2ᵖ−1)
//! (E. Hairer, S. P. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I*, II.4). The runs are not stored. Only a few numbers
//! per frame are kept.
//!
//! # The runs
//!
//! `jabuka report` repeats the run at half and at a quarter of its step. It also simulates a neighboring run, whose initial state differs by
//! 10⁻⁹ of the size of the scene. All of these runs advance together, frame by frame, so none is recorded. The order p is that of the
//! method, or the measured order of the three runs if it differs. The error is the largest of any point of a body, so an error in the
//! rotation counts in proportion to the size of the body. The rotation of a ball does not count. If a momentum changes equally at half the
//! step, external forces change it. If it changes less at half the step, it should be constant, and its change is an error.
//!
//! All steps agree on a mistake of the contacts themselves. So a scene with contacts also runs under the other contact law, at two steps, if
//! that law can simulate it and if it is small. If the two laws part by more than their errors explain, the report gives no advice, and
//! calls no estimate good.
//!
//! The chaos indicator MEGNO is computed from neighboring runs. It tends to 2 for regular motion and grows with time for chaotic motion, so
//! a distance that grows as a power of time does not count as chaos.
//!
//! # Advice
//!
//! The report tries steps and methods (`trials`), each also with half its step, and recommends only a combination that it has tried. The
//! next step of a method follows from the last error and the order. The number of force evaluations limits the trials, and is the cost in
//! the table, because seconds would differ from run to run.
//!
//! The plot (`plot/`) is a list of lines and texts, from which SVG and PNG are made. A plotting library would depend on the platform's
//! `log10` and `sin`, or on a font, and would replace only 300 lines.

mod compare;
mod influence;
mod lockstep;
mod measure;
mod neighbours;
mod other_scheme;
pub mod plot;
mod setting;
#[cfg(test)]
mod tests;
mod text;
mod trials;
mod verdict;

use serde::Serialize;

use self::measure::ComparedBodies;
use self::other_scheme::Other;
use self::setting::Setting;
use self::trials::Goal;
use self::verdict::Verdict;
use crate::scene::Scene;

pub use lockstep::{Ended, Watch};
pub use neighbours::Separation;
pub use other_scheme::{Agreement, OtherScheme};
pub use trials::{Trial, Untested};
pub use verdict::{AccurateUntil, BodyError, BrokenLaw, Conserved, Order};

/// The default accuracy, as a fraction of the size of the scene: about a pixel of an image.
pub const DEFAULT_ACCURACY: f64 = 1e-3;

/// The error that a computation returns after its progress callback has stopped it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stopped;

/// The measured accuracy of a scene's run, with advice.
#[derive(Clone, Debug, Serialize)]
pub struct Assessment {
    /// The name of the integration method.
    pub integrator: &'static str,
    /// The order of the integration method.
    pub order: u32,
    /// The timestep, s. `None` if the method is adaptive.
    pub timestep: Option<f64>,
    /// The error tolerance of an adaptive method. `None` for other methods.
    pub tolerance: Option<f64>,
    /// The number of timesteps from one frame to the next. It is 1 for a method whose timesteps are independent of frames.
    pub steps_per_frame: u32,
    /// The number of bodies that forces move. If it is 0, nothing is integrated, and there is no verdict.
    pub bodies_moved: usize,
    /// The time of the last frame, s.
    pub end: f64,
    /// The errors found in the run. `None` if nothing is integrated.
    pub verdict: Option<Verdict>,
    /// The requested accuracy, as a fraction of the size of the scene.
    pub accuracy: f64,
    /// The results of the tested methods and timesteps.
    pub trials: Vec<Trial>,
    /// The index in `trials` of the trial that reaches the accuracy with the fewest force evaluations. `None` if no trial reaches it, if
    /// the two contact laws give different motions, or if contacts have broken a law.
    pub recommended: Option<usize>,
    /// The methods that were not tested, or not at timesteps as small as necessary, with the reasons.
    pub untried: Vec<Untested>,
    /// True if the scene has particles. Their errors are not measured.
    pub has_particles: bool,
    /// True if a force is computed with a tree of bodies. The energy and its drift are then those of the tree's potential.
    pub has_tree: bool,
}

/// The phase of an assessment, for progress bars.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// The run is compared with the same run at smaller timesteps.
    Comparing,
    /// Other timesteps and methods are tested.
    Trying,
}

/// Measures the accuracy of a scene's run. `accuracy` is the allowed error as a fraction of the size of the scene. `watch` receives the
/// phase and its progress (0 to 1), and returns false to stop.
///
/// # Errors
/// If `watch` has stopped the computation.
pub fn assess(
    scene: &Scene,
    accuracy: f64,
    watch: &mut dyn FnMut(Phase, f64) -> bool,
) -> Result<Assessment, Stopped> {
    let (own, measured) = (Setting::of(scene), ComparedBodies::of(scene));
    let mut assessment = Assessment {
        integrator: own.method.name,
        order: own.method.order,
        timestep: own.timestep(scene),
        tolerance: own.tolerance(),
        steps_per_frame: own.steps,
        bodies_moved: measured.bodies.len(),
        end: scene.simulation.timeline.end(),
        verdict: None,
        accuracy,
        trials: Vec::new(),
        recommended: None,
        untried: Vec::new(),
        has_particles: !scene.emitters.is_empty(),
        has_tree: scene.has_tree(),
    };
    if measured.bodies.is_empty() || scene.simulation.timeline.frames() < 2 {
        return Ok(assessment);
    }
    let other = Other::of(scene, &measured);
    let (mut done, all) = (0.0, 8.0 * own.cost(scene) + other.as_ref().map_or(0.0, Other::cost));
    let compared = compare::compare(scene, own, &measured, other.as_ref(), &mut |cost| {
        done += cost;
        watch(Phase::Comparing, (done / all).min(1.0))
    })?;
    let verdict = Verdict::of(scene, own, &measured, &compared, other.as_ref(), accuracy);
    let size = if verdict.knows_the_size() { verdict.size } else { 0.0 };
    let goal = Goal { scene, measured: &measured, own, accuracy, order: verdict.order, size };
    let (mut done, all) = (0.0, goal.budget());
    let trials = goal.search(verdict.known(scene, own, &compared), &mut |cost| {
        done += cost;
        watch(Phase::Trying, (done / all).min(1.0))
    })?;
    let is_contradicted = verdict.is_contradicted(accuracy * verdict.size);
    assessment.recommended = trials::cheapest(&trials.tried).filter(|_| !is_contradicted);
    assessment.verdict = Some(verdict);
    assessment.trials = trials.tried;
    assessment.untried = trials.untried;
    Ok(assessment)
}

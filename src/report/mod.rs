//! The accuracy of a run: it is compared with itself at smaller steps, with a twin from a slightly different start, and with other
//! methods.
//!
//! | what | where |
//! | --- | --- |
//! | a method and its step | `setting` |
//! | several runs side by side, frame by frame | `lockstep` |
//! | the distance between two moments | `measure` |
//! | the run, half its step, a quarter of it, and the twin | `compare` |
//! | error, order, momenta, the time until which the film is accurate | `verdict` |
//! | the rate at which neighbours separate | `neighbours` |
//! | the step and method that reach an accuracy | `trials` |
//! | the report as text, and as a picture | `text`, `plot` |
//!
//! The error is Richardson's estimate: with a method of order p, a run at the step h has an error of about |x_h − x_{h/2}| 2ᵖ/(2ᵖ−1) (E.
//! Hairer, S. P. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I*, II.4). The runs are not stored: only a few numbers per
//! frame are.

mod compare;
mod lockstep;
mod measure;
mod neighbours;
pub mod plot;
mod setting;
#[cfg(test)]
mod tests;
mod text;
mod trials;
mod verdict;

use serde::Serialize;

use self::measure::Measured;
use self::setting::Setting;
use self::trials::Goal;
use self::verdict::Verdict;
use crate::scene::Scene;

pub use lockstep::{Ended, Watch};
pub use neighbours::Parting;
pub use trials::{Trial, Untried};
pub use verdict::{BodyError, Conserved, Order, Trusted};

/// The default accuracy: about a pixel of an image.
pub const ACCURACY: f64 = 1e-3;

/// The error of a computation that the caller has stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stopped;

/// The accuracy of a run.
#[derive(Clone, Debug, Serialize)]
pub struct Assessment {
    /// The name of the method.
    pub integrator: &'static str,
    /// Its order.
    pub order: u32,
    /// The timestep, s; `None` if the method chooses it.
    pub timestep: Option<f64>,
    /// The tolerance of an adaptive method.
    pub tolerance: Option<f64>,
    /// The timesteps from one frame to the next.
    pub steps_per_frame: u32,
    /// The number of bodies that forces move. If there are none, nothing is integrated, and the rest is empty.
    pub bodies_moved: usize,
    /// The time of the last frame, s.
    pub end: f64,
    /// The verdict on the run. `None` if nothing is integrated.
    pub verdict: Option<Verdict>,
    /// The wanted accuracy, as a fraction of the size of the scene.
    pub accuracy: f64,
    /// The tested methods and steps.
    pub trials: Vec<Trial>,
    /// The index of the trial that reaches the accuracy with the fewest force evaluations.
    pub recommended: Option<usize>,
    /// The methods that were not tested, or not as finely as necessary.
    pub untried: Vec<Untried>,
    /// Whether there are particles, whose accuracy is unknown.
    pub has_particles: bool,
}

/// The phase of the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Comparing the run with itself at smaller steps.
    Comparing,
    /// Testing other steps and methods.
    Trying,
}

/// Assesses the accuracy of a scene's run. `watch` receives the phase and its progress; it returns false to stop.
///
/// # Errors
/// If `watch` has stopped it.
pub fn assess(
    scene: &Scene,
    accuracy: f64,
    watch: &mut dyn FnMut(Phase, f64) -> bool,
) -> Result<Assessment, Stopped> {
    let (own, measured) = (Setting::of(scene), Measured::of(scene));
    let mut assessment = Assessment {
        integrator: own.method.name,
        order: own.method.order,
        timestep: own.timestep(scene),
        tolerance: own.tolerance(),
        steps_per_frame: own.steps,
        bodies_moved: measured.bodies.len(),
        end: scene.simulation.end(),
        verdict: None,
        accuracy,
        trials: Vec::new(),
        recommended: None,
        untried: Vec::new(),
        has_particles: !scene.emitters.is_empty(),
    };
    if measured.bodies.is_empty() || scene.simulation.frames() < 2 {
        return Ok(assessment);
    }
    let (mut done, all) = (0.0, 8.0 * own.cost(scene));
    let compared = compare::compare(scene, own, &measured, &mut |cost| {
        done += cost;
        watch(Phase::Comparing, (done / all).min(1.0))
    })?;
    let verdict = Verdict::of(scene, own, &measured, &compared, accuracy);
    let size = if verdict.knows_the_size() { verdict.size } else { 0.0 };
    let goal = Goal { scene, measured: &measured, own, accuracy, order: verdict.order, size };
    let (mut done, all) = (0.0, goal.budget());
    let trials = goal.search(verdict.known(scene, own, &compared), &mut |cost| {
        done += cost;
        watch(Phase::Trying, (done / all).min(1.0))
    })?;
    assessment.recommended = trials::cheapest(&trials.tried);
    assessment.verdict = Some(verdict);
    assessment.trials = trials.tried;
    assessment.untried = trials.untried;
    Ok(assessment)
}

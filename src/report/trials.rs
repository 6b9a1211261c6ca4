//! Searches for the timestep and the integration method that reach a requested accuracy. Each is tested before it is recommended.

use serde::Serialize;

use super::Stopped;
use super::compare::points;
use super::lockstep::{ComparedRun, Ended, Watch, together};
use super::measure::{ComparedBodies, union};
use super::setting::{Setting, refused};
use super::verdict::Order;
use crate::physics::Method;
use crate::scene::Scene;
use crate::simulate::{EnergyError, evaluations, forces};

/// The result of a test run with one method and one timestep.
#[derive(Clone, Debug, Serialize)]
pub struct Trial {
    /// The name of the integration method.
    pub integrator: &'static str,
    /// The value of the key `step` that gives this timestep in the scene, s. `None` if the method is adaptive.
    pub step: Option<f64>,
    /// The timestep of the test run, s. `None` if the method is adaptive.
    pub timestep: Option<f64>,
    /// The value of the key `tolerance` for the scene, if the method is adaptive. `None` otherwise.
    pub tolerance: Option<f64>,
    /// The number of timesteps from one frame to the next. For a method whose timesteps are independent of frames, the factor by which
    /// they are finer than in the scene.
    pub steps_per_frame: u32,
    /// The total number of timesteps of the test run.
    pub steps: u64,
    /// The number of force evaluations of the test run. The true number is slightly larger if impacts divide timesteps.
    pub evaluations: u64,
    /// The largest error of any point of a body, m, estimated from a run at half the timestep. `None` if one of the two runs broke down.
    pub error: Option<f64>,
    /// The largest energy error of the test run, relative to the energy of the verdict's scale.
    pub drift: f64,
    /// True if the test run reaches the requested accuracy.
    pub reaches: bool,
    #[serde(skip)]
    pub(super) ended: Option<Ended>,
    #[serde(skip)]
    pub(super) setting: Setting,
    /// The diagonal of the box around the motion of all bodies in the test run, m.
    #[serde(skip)]
    pub(super) size: f64,
}

/// A method that was not tested, or not at a timestep as small as necessary.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Untested {
    /// The name of the integration method.
    pub integrator: &'static str,
    /// The reason why the method, or a smaller timestep, was not tested.
    pub why: String,
}

/// The results of all test runs, ordered by method and then by decreasing timestep, and the methods that were not tested.
#[derive(Debug, Default)]
pub(super) struct Trials {
    pub(super) tried: Vec<Trial>,
    pub(super) untried: Vec<Untested>,
}

/// Returns the ratio of a run's error to its difference from the run at half the timestep, for a method of this order: 2ᵖ/(2ᵖ−1).
pub(super) fn factor(order: f64) -> f64 {
    let ratio = libm::exp2(order);
    ratio / (ratio - 1.0)
}

/// Returns the methods to test with a scene, its own first, and the methods that the scene cannot use. Other methods of first order are
/// left out, since they would not be more accurate.
fn methods(scene: &Scene) -> (Vec<&'static Method>, Vec<Untested>) {
    let own = scene.simulation.method;
    let of_use = |method: &&&Method| method.order > 1 && !method.is_planetary();
    let others = || Method::all().filter(|method| !std::ptr::eq(*method, own)).filter(|it| of_use(&it));
    let tried = std::iter::once(own).chain(others().filter(|method| refused(scene, method).is_none()));
    let untried = others().filter_map(|method| {
        Some(Untested { integrator: method.name, why: refused(scene, method)?.to_owned() })
    });
    (tried.collect(), untried.collect())
}

/// The budget of the search, in force evaluations, as a multiple of those of the run itself.
const BUDGET_IN_RUNS: f64 = 4.0;

/// The smallest budget of the search, in force evaluations of a single body. They take about two seconds.
const MIN_BUDGET_EVALUATIONS: f64 = 6e6;

/// The goal of the search for a method and a timestep.
pub(super) struct Goal<'a> {
    pub(super) scene: &'a Scene,
    pub(super) measured: &'a ComparedBodies,
    pub(super) own: Setting,
    /// The allowed error of any point, as a fraction of the size of the scene.
    pub(super) accuracy: f64,
    /// The measured order of the scene's own method.
    pub(super) order: Order,
    /// The size of the scene, m: the diagonal of the box around the motion. It is 0 if the run is too inaccurate to show its size.
    pub(super) size: f64,
}

impl Goal<'_> {
    /// Returns the budget of the search, in force evaluations.
    pub(super) fn budget(&self) -> f64 {
        let (scene, bodies) = (self.scene, self.measured.bodies.len() as f64);
        let pairs = scene.forces.iter().flat_map(|force| forces(&force.kind)).map(|force| force.pairs());
        let contacts = if scene.simulation.contacts.is_some() { 20.0 * bodies } else { 0.0 };
        let pairs: f64 = pairs.map(|pairs| pairs as f64 / 20.0).sum();
        let weight = 2.0 + bodies + 5.0 * scene.joints.len() as f64 + pairs + contacts;
        (BUDGET_IN_RUNS * self.own.cost(scene)).max(MIN_BUDGET_EVALUATIONS / weight)
    }

    fn reaches(&self, trial: &Trial) -> bool {
        let size = if self.size > 0.0 { self.size } else { trial.size };
        trial.error.is_some_and(|error| error <= self.accuracy * size)
    }

    /// Tests methods and timesteps within the budget. `known` holds the results that are already known of the scene's own method.
    pub(super) fn search(&self, known: Vec<Trial>, watch: &mut Watch<'_>) -> Result<Trials, Stopped> {
        let mut left = self.budget();
        let (methods, untried) = methods(self.scene);
        let mut trials = Trials { tried: Vec::new(), untried };
        // The scene's own method comes last, since its accuracy is already known.
        let mut own = Some(known);
        for method in methods.iter().skip(1).chain(&methods[..1]) {
            let is_own = std::ptr::eq(*method, self.own.method);
            let known = if is_own { own.take().unwrap_or_default() } else { Vec::new() };
            if is_own && matches!(self.order, Order::None { .. }) {
                // The differences between the runs do not decrease with the timestep, so smaller timesteps would not help.
                trials.tried.extend(known);
                continue;
            }
            let (tried, why) = self.search_method(method, known, &mut left, watch)?;
            trials.tried.extend(tried);
            trials.untried.extend(why.map(|why| Untested { integrator: method.name, why }));
        }
        for trial in &mut trials.tried {
            trial.reaches = self.reaches(trial);
        }
        let place = |trial: &Trial| {
            let is_own = std::ptr::eq(trial.setting.method, self.own.method);
            let place = Method::all().position(|method| method.name == trial.integrator);
            (!is_own, place, trial.steps_per_frame)
        };
        trials.tried.sort_by_key(place);
        Ok(trials)
    }

    /// Tests timesteps of a method until one reaches the accuracy and no much longer one is expected to reach it. If the search ends
    /// before, the text gives the reason.
    fn search_method(
        &self,
        method: &'static Method,
        mut tried: Vec<Trial>,
        left: &mut f64,
        watch: &mut Watch<'_>,
    ) -> Result<(Vec<Trial>, Option<String>), Stopped> {
        /// The largest number of timesteps tested with each method.
        const MAX_TIMESTEPS_PER_METHOD: usize = 5;
        for _ in 0..MAX_TIMESTEPS_PER_METHOD {
            let Some(steps) = self.next_steps(method, &tried) else { return Ok((tried, None)) };
            let setting = Setting::new(method, steps, self.scene);
            // The test makes two runs. The run at half the timestep costs twice as much as the other.
            let cost = 3.0 * setting.cost(self.scene);
            if cost > *left {
                let is_reached = tried.iter().any(|trial| self.reaches(trial));
                let times = setting.cost(self.scene) / self.own.cost(self.scene);
                let finer = match (setting.written(self.scene), setting.tolerance()) {
                    (Some(step), _) => format!("a step of {step} s"),
                    (None, tolerance) => format!("a tolerance of {:e}", tolerance.unwrap_or_default()),
                };
                let why =
                    format!("{finer} was not tried, since it takes {times:.0} times as long as this run");
                return Ok((tried, (!is_reached && times >= 1.5).then_some(why)));
            }
            let Some(trial) = self.attempt(setting, *left, watch)? else {
                *left *= 0.5;
                return Ok((tried, Some("it takes more steps than are tried here".to_owned())));
            };
            // The number of timesteps of an adaptive method is known only after the run.
            *left -= cost.max(3.0 * trial.evaluations as f64 * f64::from(u8::from(method.adaptive)));
            tried.push(trial);
        }
        Ok((tried, None))
    }

    /// Returns the next number of timesteps per frame to test with a method. `None` if the search of this method is finished.
    fn next_steps(&self, method: &'static Method, tried: &[Trial]) -> Option<u32> {
        if method.adaptive {
            return match tried.last() {
                None => Some(1),
                Some(last) => (!self.reaches(last)).then_some(4 * last.steps_per_frame),
            };
        }
        let Some(last) = tried.last() else {
            // The first test has the number of timesteps that costs as many force evaluations as the scene's run.
            let each = evaluations(method).max(1) as f64 / evaluations(self.own.method).max(1) as f64;
            return Some(nice(f64::from(self.own.steps) / each));
        };
        let finest_failed =
            tried.iter().filter(|trial| !self.reaches(trial)).map(|trial| trial.steps_per_frame).max();
        let coarsest_good =
            tried.iter().filter(|trial| self.reaches(trial)).min_by_key(|trial| trial.steps_per_frame);
        let size = if self.size > 0.0 { self.size } else { last.size };
        let wanted = self.accuracy * size;
        let from = coarsest_good.unwrap_or(last);
        let steps = f64::from(from.steps_per_frame);
        // The factor of 1.5 is a safety margin. The order of the method relates the error to the timestep.
        let by_order = |error: f64| libm::pow(1.5 * error / wanted, 1.0 / f64::from(method.order));
        match (coarsest_good, from.error) {
            (Some(good), Some(error)) => {
                let coarser = nice(steps * by_order(error).max(0.1));
                let is_new =
                    coarser < good.steps_per_frame && finest_failed.is_none_or(|failed| coarser > failed);
                is_new.then_some(coarser)
            }
            (_, Some(error)) => {
                // An error as large as the scene cannot grow further, so it says little about the necessary timestep.
                let least = if error > 0.05 * size { 4.0 } else { 1.2 };
                Some(nice(steps * by_order(error).clamp(least, 64.0)))
            }
            (_, None) => Some(nice(4.0 * steps)),
        }
        .filter(|steps| *steps < u32::MAX / 4)
    }

    /// Makes a test run, and the same run at half the timestep, to estimate the error. `None` if an adaptive method exceeds its share of
    /// the remaining force evaluations `left`.
    fn attempt(&self, setting: Setting, left: f64, watch: &mut Watch<'_>) -> Result<Option<Trial>, Stopped> {
        let scene = self.scene;
        let settings = [setting, setting.finer(2)];
        let scenes = settings.map(|setting| setting.applied(scene, self.own));
        let frames = scene.simulation.timeline.frames().max(1) as f64;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a number that is too large saturates"
        )]
        let most = (left / 4.0 / evaluations(setting.method).max(1) as f64) as u64;
        let run = |run: usize| ComparedRun::new(&scenes[run], settings[run].cost(scene) / frames);
        let mut runs =
            [0, 1].map(|it| if setting.method.adaptive { run(it).of_at_most(most) } else { run(it) });
        let (mut most, mut energy, mut around) = (0.0_f64, EnergyError::default(), None);
        together(&mut runs, scene, watch, &mut |moments| {
            let [coarse, fine] = moments else { return };
            if let Some(coarse) = coarse {
                energy.add(&coarse.balance);
            }
            if let Some(fine) = fine {
                let here = self.measured.around(fine);
                around = around.zip(here).map(|(all, here)| union(all, here)).or(around).or(here);
            }
            if let (Some(coarse), Some(fine)) = (coarse, fine) {
                let farthest = points(self.measured, [coarse, fine]).map(|(_, distance)| distance.point);
                most = farthest.fold(most, f64::max);
            }
        })?;
        let factor = match std::ptr::eq(setting.method, self.own.method) {
            true => self.order.factor(setting.method),
            false => Order::Nominal { measured: f64::from(setting.method.order) }.factor(setting.method),
        };
        if runs.iter().any(|run| run.is_long) {
            return Ok(None);
        }
        let steps = runs[0].steps();
        let ended = runs.into_iter().find_map(|run| run.ended);
        Ok(Some(Trial {
            integrator: setting.method.name,
            step: setting.written(scene),
            timestep: setting.timestep(scene),
            tolerance: setting.tolerance(),
            steps_per_frame: setting.steps,
            steps,
            evaluations: steps * evaluations(setting.method),
            error: ended.is_none().then_some(most * factor),
            drift: energy.drift(scene.simulation.contacts),
            reaches: false,
            ended,
            setting,
            size: around.map_or(0.0, |[min, max]| (max - min).length()),
        }))
    }
}

/// Returns the index of the trial that reaches the accuracy with the fewest force evaluations. `None` if no trial reaches it.
pub(super) fn cheapest(trials: &[Trial]) -> Option<usize> {
    let good = trials.iter().enumerate().filter(|(_, trial)| trial.reaches);
    good.min_by_key(|(_, trial)| (trial.evaluations, trial.steps)).map(|(place, _)| place)
}

/// Returns the smallest of 1, 2, 4, 5, 8, 10, 20, 40, 50, 80 … that is at least the given number.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a number that is too large saturates"
)]
fn nice(number: f64) -> u32 {
    let mut power = 1.0;
    loop {
        for step in [1.0, 2.0, 4.0, 5.0, 8.0] {
            if step * power >= number * (1.0 - 1e-9) || power > 1e9 {
                return (step * power) as u32;
            }
        }
        power *= 10.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_numbers() {
        assert_eq!([0.2, 1.0, 2.1, 4.0, 6.0, 9.0, 11.0, 45.0].map(nice), [1, 1, 4, 4, 8, 10, 20, 50]);
        assert!(nice(1e300) > 1_000_000);
    }

    #[test]
    fn the_factor_of_richardson() {
        assert_eq!([1.0, 2.0, 4.0].map(factor), [2.0, 4.0 / 3.0, 16.0 / 15.0]);
    }
}

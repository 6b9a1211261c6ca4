//! Finds the step and the method that reach a wanted accuracy. Each is tested before it is recommended.

use serde::Serialize;

use super::Stopped;
use super::compare::points;
use super::lockstep::{Ended, Track, Watch, together};
use super::measure::{Measured, union};
use super::setting::{Setting, refused};
use super::verdict::Order;
use crate::dynamics::Method;
use crate::scene::Scene;
use crate::simulate::evaluations;

/// The result of a tested method and step.
#[derive(Clone, Debug, Serialize)]
pub struct Trial {
    /// The name of the method.
    pub integrator: &'static str,
    /// The step to write into the scene, s; `None` if the method chooses it.
    pub step: Option<f64>,
    /// The resulting timestep, s.
    pub timestep: Option<f64>,
    /// The tolerance to write into the scene, for an adaptive method.
    pub tolerance: Option<f64>,
    /// The timesteps from one frame to the next.
    pub steps_per_frame: u32,
    /// The timesteps of the run.
    pub steps: u64,
    /// The number of force evaluations; slightly more if impacts divide steps.
    pub evaluations: u64,
    /// The largest error of any point of a body, m, from a run at half the step. `None` if one of the two broke down.
    pub error: Option<f64>,
    /// The largest energy error, relative to the largest kinetic energy.
    pub drift: f64,
    /// Whether it reaches the wanted accuracy.
    pub reaches: bool,
    #[serde(skip)]
    pub(super) ended: Option<Ended>,
    #[serde(skip)]
    pub(super) setting: Setting,
    /// The diagonal of the box around the motion of bodies, m.
    #[serde(skip)]
    pub(super) size: f64,
}

/// A method that was not tested, or not as finely as necessary.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Untried {
    /// Its name.
    pub integrator: &'static str,
    /// The reason.
    pub why: String,
}

/// The trials, in order of methods and falling steps, and the methods that were not tested.
#[derive(Debug, Default)]
pub(super) struct Trials {
    pub(super) tried: Vec<Trial>,
    pub(super) untried: Vec<Untried>,
}

/// Halving the step changes a run by less than the error of the coarser run. This is the ratio of the error to the change.
pub(super) fn factor(order: f64) -> f64 {
    let ratio = libm::exp2(order);
    ratio / (ratio - 1.0)
}

/// The methods to test with a scene, its own first. Other first-order methods would not help.
fn methods(scene: &Scene) -> (Vec<&'static Method>, Vec<Untried>) {
    let own = scene.simulation.method;
    let of_use = |method: &&&Method| method.order > 1 && !method.is_of_planets();
    let others = || Method::all().filter(|method| !std::ptr::eq(*method, own)).filter(|it| of_use(&it));
    let tried = std::iter::once(own).chain(others().filter(|method| refused(scene, method).is_none()));
    let untried = others().filter_map(|method| {
        Some(Untried { integrator: method.name, why: refused(scene, method)?.to_owned() })
    });
    (tried.collect(), untried.collect())
}

/// The budget of the search, in force evaluations: this many times the run itself,
const RUNS: f64 = 4.0;

/// or this many evaluations of a single body, if that is more: about two seconds.
const EVALUATIONS: f64 = 6e6;

/// The goal of a trial.
pub(super) struct Goal<'a> {
    pub(super) scene: &'a Scene,
    pub(super) measured: &'a Measured,
    pub(super) own: Setting,
    /// The allowed error of a point, as a fraction of the size of the scene.
    pub(super) accuracy: f64,
    /// The observed order of the scene's own method.
    pub(super) order: Order,
    /// The size of the scene, m; 0 if the run is too inaccurate to tell.
    pub(super) size: f64,
}

impl Goal<'_> {
    /// The budget of the search, in force evaluations.
    pub(super) fn budget(&self) -> f64 {
        let (scene, bodies) = (self.scene, self.measured.bodies.len() as f64);
        let pairs = scene.forces.iter().flat_map(|force| force.kind.acting()).map(|force| force.pairs());
        let contacts = if scene.simulation.contacts.is_some() { 20.0 * bodies } else { 0.0 };
        let pairs: f64 = pairs.map(|pairs| pairs as f64 / 20.0).sum();
        let weight = 2.0 + bodies + 5.0 * scene.joints.len() as f64 + pairs + contacts;
        (RUNS * self.own.cost(scene)).max(EVALUATIONS / weight)
    }

    fn reaches(&self, trial: &Trial) -> bool {
        let size = if self.size > 0.0 { self.size } else { trial.size };
        trial.error.is_some_and(|error| error <= self.accuracy * size)
    }

    /// Tests methods and steps within the budget. `known` are the results of the scene's own setting.
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
                // Smaller steps do not help.
                trials.tried.extend(known);
                continue;
            }
            let (tried, why) = self.search_method(method, known, &mut left, watch)?;
            trials.tried.extend(tried);
            trials.untried.extend(why.map(|why| Untried { integrator: method.name, why }));
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

    /// Tests steps of a method until one reaches the accuracy and no much longer one does. Otherwise gives the reason.
    fn search_method(
        &self,
        method: &'static Method,
        mut tried: Vec<Trial>,
        left: &mut f64,
        watch: &mut Watch<'_>,
    ) -> Result<(Vec<Trial>, Option<String>), Stopped> {
        /// The largest number of steps tested with each method.
        const TRIES: usize = 5;
        for _ in 0..TRIES {
            let Some(steps) = self.next_steps(method, &tried) else { return Ok((tried, None)) };
            let setting = Setting::new(method, steps, self.scene);
            // The run, and the run at half its step.
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
            // The number of steps of an adaptive method is only known afterwards.
            *left -= cost.max(3.0 * trial.evaluations as f64 * f64::from(u8::from(method.adaptive)));
            tried.push(trial);
        }
        Ok((tried, None))
    }

    /// The next number of steps per frame to test. `None` if the right number is known.
    fn next_steps(&self, method: &'static Method, tried: &[Trial]) -> Option<u32> {
        if method.adaptive {
            return match tried.last() {
                None => Some(1),
                Some(last) => (!self.reaches(last)).then_some(4 * last.steps_per_frame),
            };
        }
        let Some(last) = tried.last() else {
            // The number that takes as long as the run.
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
        // With a margin, from the order of the method.
        let by_order = |error: f64| libm::pow(1.5 * error / wanted, 1.0 / f64::from(method.order));
        match (coarsest_good, from.error) {
            (Some(good), Some(error)) => {
                let coarser = nice(steps * by_order(error).max(0.1));
                let is_new =
                    coarser < good.steps_per_frame && finest_failed.is_none_or(|failed| coarser > failed);
                is_new.then_some(coarser)
            }
            (_, Some(error)) => {
                // An error as large as the scene cannot grow further, so it gives little information.
                let least = if error > 0.05 * size { 4.0 } else { 1.2 };
                Some(nice(steps * by_order(error).clamp(least, 64.0)))
            }
            (_, None) => Some(nice(4.0 * steps)),
        }
        .filter(|steps| *steps < u32::MAX / 4)
    }

    /// Makes a run, and the same at half its step. `None` if an adaptive method takes more than half of the remaining force evaluations.
    fn attempt(&self, setting: Setting, left: f64, watch: &mut Watch<'_>) -> Result<Option<Trial>, Stopped> {
        let scene = self.scene;
        let settings = [setting, setting.finer(2)];
        let scenes = settings.map(|setting| setting.applied(scene, self.own));
        let frames = scene.simulation.frames().max(1) as f64;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a number that is too large saturates"
        )]
        let most = (left / 4.0 / evaluations(setting.method).max(1) as f64) as u64;
        let track = |track: usize| Track::new(&scenes[track], settings[track].cost(scene) / frames);
        let mut tracks =
            [0, 1].map(|it| if setting.method.adaptive { track(it).of_at_most(most) } else { track(it) });
        let (mut most, mut kinetic, mut energy, mut around) = (0.0_f64, 0.0_f64, 0.0_f64, None);
        together(&mut tracks, scene, watch, &mut |moments| {
            let [coarse, fine] = moments else { return };
            if let Some(coarse) = coarse {
                kinetic = kinetic.max(coarse.balance.kinetic);
                let error = coarse.balance.drift * kinetic;
                energy = if error.abs() > energy.abs() { error } else { energy };
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
        if tracks.iter().any(|track| track.is_long) {
            return Ok(None);
        }
        let steps = tracks[0].steps();
        let ended = tracks.into_iter().find_map(|track| track.ended);
        Ok(Some(Trial {
            integrator: setting.method.name,
            step: setting.written(scene),
            timestep: setting.timestep(scene),
            tolerance: setting.tolerance(),
            steps_per_frame: setting.steps,
            steps,
            evaluations: steps * evaluations(setting.method),
            error: ended.is_none().then_some(most * factor),
            drift: if kinetic > 0.0 { energy / kinetic } else { 0.0 },
            reaches: false,
            ended,
            setting,
            size: around.map_or(0.0, |[min, max]| (max - min).length()),
        }))
    }
}

/// The cheapest trial that reaches the accuracy.
pub(super) fn cheapest(trials: &[Trial]) -> Option<usize> {
    let good = trials.iter().enumerate().filter(|(_, trial)| trial.reaches);
    good.min_by_key(|(_, trial)| (trial.evaluations, trial.steps)).map(|(place, _)| place)
}

/// The smallest of 1, 2, 4, 5, 8, 10, 20, 40 … that is at least the given number.
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

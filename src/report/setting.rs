//! The settings of a run: its method, and its fineness.

use crate::dynamics::{Method, World};
use crate::scene::{ContactLaw, Scene, Simulation};
use crate::simulate::{evaluations, world};

/// The smallest tolerance that is tested. Below it, rounding errors dominate.
const LEAST_TOLERANCE: f64 = 1e-13;

/// A method with its step, or with its tolerance if it chooses its steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting {
    pub(super) method: &'static Method,
    /// The timesteps from one frame to the next. For a method with steps independent of frames, the factor by which it is finer than in
    /// the scene.
    pub(super) steps: u32,
    /// The step and the tolerance of such a method in the scene.
    step: f64,
    tolerance: f64,
}

impl Setting {
    /// The setting of a scene.
    pub(super) fn of(scene: &Scene) -> Setting {
        let interval = 1.0 / scene.simulation.frame_rate;
        let method = scene.simulation.method;
        let steps = if method.ahead.is_some() { 1 } else { world(scene).steps_within(interval) };
        Setting::new(method, steps, scene)
    }

    /// The setting of a scene with another method.
    pub(super) fn new(method: &'static Method, steps: u32, scene: &Scene) -> Setting {
        let Simulation { step, tolerance, .. } = scene.simulation;
        Setting { method, steps, step, tolerance }
    }

    /// The same with this many times the steps. For an adaptive method, a tenth of the tolerance counts as twice the steps.
    pub(super) fn finer(self, times: u32) -> Setting {
        Setting { steps: self.steps.saturating_mul(times), ..self }
    }

    /// The timestep, s; `None` if the method chooses it.
    pub(super) fn timestep(self, scene: &Scene) -> Option<f64> {
        match (self.method.adaptive, self.method.ahead) {
            (true, _) => None,
            (false, Some(_)) => Some(self.step / f64::from(self.steps)),
            (false, None) => Some(1.0 / scene.simulation.frame_rate / f64::from(self.steps)),
        }
    }

    /// The tolerance; `None` if the method has none.
    pub(super) fn tolerance(self) -> Option<f64> {
        let finer = self.tolerance / libm::pow(10.0, f64::from(self.steps.max(1).ilog2()));
        self.method.adaptive.then(|| finer.max(LEAST_TOLERANCE.min(self.tolerance)))
    }

    /// The scene with this setting. The scene's own setting changes nothing.
    pub(super) fn applied(self, scene: &Scene, own: Setting) -> Scene {
        let mut scene = scene.clone();
        if !std::ptr::eq(self.method, own.method) || self.steps != own.steps {
            scene.simulation.method = self.method;
            scene.simulation.step = self.timestep(&scene).unwrap_or(f64::INFINITY);
            scene.simulation.tolerance = self.tolerance().unwrap_or(scene.simulation.tolerance);
        }
        scene
    }

    /// The number of force evaluations of a run; approximate if impacts divide steps.
    #[allow(clippy::cast_precision_loss, reason = "two digits of it are needed")]
    pub(super) fn cost(self, scene: &Scene) -> f64 {
        let intervals = scene.simulation.frames().saturating_sub(1) as f64;
        intervals * f64::from(self.steps) * evaluations(self.method) as f64
    }

    /// The step to write into a scene, s: the fewest digits that give the same number of steps. `None` if the method chooses its own
    /// steps.
    pub(super) fn written(self, scene: &Scene) -> Option<f64> {
        let step = self.timestep(scene)?;
        if self.method.ahead.is_some() {
            return Some(step);
        }
        let interval = 1.0 / scene.simulation.frame_rate;
        let mut world = World::new();
        let mut is_enough = |rounded: &f64| {
            world.set_step(*rounded);
            world.steps_within(interval) == self.steps
        };
        Some((2..=15).map(|digits| rounded_up(step, digits)).find(|step| is_enough(step)).unwrap_or(step))
    }
}

/// The reason why a scene cannot use a method; `None` if it can.
pub(super) fn refused(scene: &Scene, method: &Method) -> Option<&'static str> {
    let simulation = &scene.simulation;
    if std::ptr::eq(simulation.method, method) {
        None
    } else if simulation.contacts == Some(ContactLaw::TimeStepping) {
        Some("time stepping has a method of its own")
    } else if method.ahead.is_some() && !scene.emitters.is_empty() {
        Some("it moves no particles")
    } else if method.constraints {
        None
    } else if simulation.contacts.is_some() {
        Some("it computes no contacts")
    } else if !scene.joints.is_empty() {
        Some("it keeps no joints")
    } else {
        None
    }
}

/// A positive number, rounded up to this many digits; rounding errors are ignored.
fn rounded_up(number: f64, digits: usize) -> f64 {
    let text = format!("{number:.*e}", digits - 1);
    let near: f64 = text.parse().unwrap_or(number);
    let exponent: Option<i64> = text.split_once('e').and_then(|(_, exponent)| exponent.parse().ok());
    let (Some(exponent), true) = (exponent, near < number * (1.0 - 1e-12)) else { return near };
    let unit: f64 = format!("1e{}", exponent + 1 - digits as i64).parse().unwrap_or_default();
    // By text, so that 0.0016 + 0.0001 is 0.0017.
    format!("{:.*e}", digits - 1, near + unit).parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::METHODS;

    fn scene(keys: &str) -> Scene {
        Scene::parse(&format!("simulation = {{ {keys} }}\n[body.ball]\nshape.sphere.radius = 1\n")).unwrap()
    }

    #[test]
    fn the_step_that_is_written_makes_the_steps_that_were_tried() {
        for rate in [25.0, 30.0, 24.0, 60.0, 3.0e-7] {
            let of = scene(&format!("frame_rate = {rate}, duration = {}", 10.0 / rate));
            for steps in [1, 2, 3, 7, 8, 10, 48, 1000] {
                let setting = Setting::new(&METHODS[0], steps, &of);
                let step = setting.written(&of).unwrap();
                let again = scene(&format!("frame_rate = {rate}, duration = {}, step = {step}", 10.0 / rate));
                assert_eq!(Setting::of(&again).steps, steps, "{rate} {step}");
            }
        }
        let scene_of = |rate| scene(&format!("frame_rate = {rate}"));
        let setting = Setting::new(&METHODS[0], 8, &scene_of(30));
        assert_eq!(setting.written(&scene_of(30)), Some(0.0042));
        assert_eq!(setting.written(&scene_of(25)), Some(0.005));
    }

    #[test]
    fn a_setting_of_its_own_changes_nothing_of_a_scene() {
        let scene = scene("step = 0.0333, duration = 1");
        let own = Setting::of(&scene);
        assert_eq!(own.applied(&scene, own).simulation.step, 0.0333);
        assert_eq!(Setting::of(&own.finer(2).applied(&scene, own)).steps, 2 * own.steps);
    }

    #[test]
    fn an_adaptive_method_takes_a_tenth_of_its_tolerance_in_the_place_of_half_a_step() {
        let scene = scene("integrator = 'dop853', tolerance = 1e-6, duration = 1");
        let own = Setting::of(&scene);
        assert_eq!((own.steps, own.timestep(&scene), own.tolerance()), (1, None, Some(1e-6)));
        let finer = own.finer(4).applied(&scene, own);
        assert!((finer.simulation.tolerance / 1e-8 - 1.0).abs() < 1e-12, "{}", finer.simulation.tolerance);
        assert_eq!(finer.simulation.step, f64::INFINITY);
    }
}

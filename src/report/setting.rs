//! The settings of a run that determine its accuracy: the integration method, and its timestep or tolerance.

use crate::physics::{Method, World};
use crate::scene::{ContactLaw, Scene, SimulationSettings};
use crate::simulate::{evaluations, world};

/// The smallest error tolerance that is tested. With a smaller one, rounding errors dominate.
const LEAST_TOLERANCE: f64 = 1e-13;

/// An integration method with its timestep, or with its tolerance if it is adaptive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting {
    pub(super) method: &'static Method,
    /// The number of timesteps from one frame to the next. For a method whose timesteps are independent of frames, the factor by which
    /// they are finer than in the scene.
    pub(super) steps: u32,
    /// The timestep (s) and the tolerance in the scene. They are used for methods whose timesteps are independent of frames.
    step: f64,
    tolerance: f64,
}

impl Setting {
    /// Returns the method and the timestep of a scene.
    pub(super) fn of(scene: &Scene) -> Setting {
        let interval = scene.simulation.timeline.interval();
        let method = scene.simulation.method;
        let steps = if method.take_over.is_some() { 1 } else { world(scene).steps_within(interval) };
        Setting::new(method, steps, scene)
    }

    /// Returns a setting with this method and this number of timesteps per frame. The tolerance comes from the scene.
    pub(super) fn new(method: &'static Method, steps: u32, scene: &Scene) -> Setting {
        let SimulationSettings { step, tolerance, .. } = scene.simulation;
        Setting { method, steps, step, tolerance }
    }

    /// Returns the same method with `times` as many timesteps. For an adaptive method, a tenth of the tolerance counts as twice the
    /// timesteps.
    pub(super) fn finer(self, times: u32) -> Setting {
        Setting { steps: self.steps.saturating_mul(times), ..self }
    }

    /// Returns the timestep, s. `None` if the method is adaptive.
    pub(super) fn timestep(self, scene: &Scene) -> Option<f64> {
        match (self.method.adaptive, self.method.take_over) {
            (true, _) => None,
            (false, Some(_)) => Some(self.step / f64::from(self.steps)),
            (false, None) => Some(scene.simulation.timeline.interval() / f64::from(self.steps)),
        }
    }

    /// Returns the error tolerance of an adaptive method. `None` for other methods.
    pub(super) fn tolerance(self) -> Option<f64> {
        let finer = self.tolerance / libm::pow(10.0, f64::from(self.steps.max(1).ilog2()));
        self.method.adaptive.then(|| finer.max(LEAST_TOLERANCE.min(self.tolerance)))
    }

    /// Returns a copy of the scene with this method and timestep. The copy is unchanged if this setting equals the scene's `own`.
    pub(super) fn applied(self, scene: &Scene, own: Setting) -> Scene {
        let mut scene = scene.clone();
        if !std::ptr::eq(self.method, own.method) || self.steps != own.steps {
            scene.simulation.method = self.method;
            scene.simulation.step = self.timestep(&scene).unwrap_or(f64::INFINITY);
            scene.simulation.tolerance = self.tolerance().unwrap_or(scene.simulation.tolerance);
        }
        scene
    }

    /// Returns the number of force evaluations of a run with this setting. It is approximate if impacts divide timesteps.
    #[allow(clippy::cast_precision_loss, reason = "two digits of it are needed")]
    pub(super) fn cost(self, scene: &Scene) -> f64 {
        let timeline = &scene.simulation.timeline;
        let intervals = (timeline.end() / timeline.interval()).round();
        intervals * f64::from(self.steps) * evaluations(self.method) as f64
    }

    /// Returns the value of the key `step` for a scene, s: the number with the fewest digits that gives the same number of timesteps per
    /// frame. `None` if the method is adaptive.
    pub(super) fn written(self, scene: &Scene) -> Option<f64> {
        let step = self.timestep(scene)?;
        if self.method.take_over.is_some() {
            return Some(step);
        }
        let interval = scene.simulation.timeline.interval();
        let mut world = World::new();
        let mut is_enough = |rounded: &f64| {
            world.set_step(*rounded);
            world.steps_within(interval) == self.steps
        };
        Some((2..=15).map(|digits| rounded_up(step, digits)).find(|step| is_enough(step)).unwrap_or(step))
    }
}

/// Returns the reason why a scene cannot use an integration method. `None` if it can.
pub(super) fn refused(scene: &Scene, method: &Method) -> Option<&'static str> {
    let simulation = &scene.simulation;
    if std::ptr::eq(simulation.method, method) {
        None
    } else if simulation.contacts == Some(ContactLaw::TimeStepping) {
        Some("time stepping has a method of its own")
    } else if method.take_over.is_some() && !scene.emitters.is_empty() {
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

/// Rounds a positive number up to this many significant digits. A number that exceeds a rounded one by a rounding error alone is rounded
/// down.
fn rounded_up(number: f64, digits: usize) -> f64 {
    let text = format!("{number:.*e}", digits - 1);
    let near: f64 = text.parse().unwrap_or(number);
    let exponent: Option<i64> = text.split_once('e').and_then(|(_, exponent)| exponent.parse().ok());
    let (Some(exponent), true) = (exponent, near < number * (1.0 - 1e-12)) else { return near };
    let unit: f64 = format!("1e{}", exponent + 1 - digits as i64).parse().unwrap_or_default();
    // The sum goes through text, so that 0.0016 + 0.0001 is exactly the number 0.0017.
    format!("{:.*e}", digits - 1, near + unit).parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::METHODS;

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

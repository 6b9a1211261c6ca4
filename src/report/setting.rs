//! How a run is advanced: by which method, and how finely.

use crate::dynamics::{Method, World};
use crate::scene::{ContactLaw, Scene};
use crate::simulate::{evaluations, world};

/// A method and its step. A method with a tolerance in place of a step needs its tolerance here, and a tenth of it wherever others
/// halve their step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting {
    pub(super) method: &'static Method,
    /// The timesteps from one frame to the next.
    pub(super) steps: u32,
}

impl Setting {
    /// That of a scene.
    pub(super) fn of(scene: &Scene) -> Setting {
        let interval = 1.0 / scene.simulation.frame_rate;
        Setting { method: scene.simulation.method, steps: world(scene).steps_within(interval) }
    }

    /// The same with so many times the steps.
    pub(super) fn finer(self, times: u32) -> Setting {
        Setting { steps: self.steps.saturating_mul(times), ..self }
    }

    /// The timestep, s.
    pub(super) fn timestep(self, scene: &Scene) -> f64 {
        1.0 / scene.simulation.frame_rate / f64::from(self.steps)
    }

    /// A scene that is advanced so. What is its own setting changes nothing.
    pub(super) fn applied(self, scene: &Scene, own: Setting) -> Scene {
        let mut scene = scene.clone();
        if !std::ptr::eq(self.method, own.method) || self.steps != own.steps {
            scene.simulation.method = self.method;
            scene.simulation.step = self.timestep(&scene);
        }
        scene
    }

    /// How often a run evaluates the forces: about as often, where impacts divide steps.
    #[allow(clippy::cast_precision_loss, reason = "two digits of it are needed")]
    pub(super) fn cost(self, scene: &Scene) -> f64 {
        let intervals = scene.simulation.frames().saturating_sub(1) as f64;
        intervals * f64::from(self.steps) * evaluations(self.method) as f64
    }

    /// The step to write into a scene, s: the timestep with as few digits as give the same number of steps.
    pub(super) fn written(self, scene: &Scene) -> f64 {
        let step = self.timestep(scene);
        let interval = 1.0 / scene.simulation.frame_rate;
        let mut world = World::new();
        let mut is_enough = |rounded: &f64| {
            world.set_step(*rounded);
            world.steps_within(interval) == self.steps
        };
        (2..=15).map(|digits| rounded_up(step, digits)).find(|step| is_enough(step)).unwrap_or(step)
    }
}

/// Why a scene cannot be advanced by a method; none: it can.
pub(super) fn refused(scene: &Scene, method: &Method) -> Option<&'static str> {
    let simulation = &scene.simulation;
    if std::ptr::eq(simulation.method, method) {
        None
    } else if simulation.contacts == Some(ContactLaw::TimeStepping) {
        Some("time stepping has a method of its own")
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

/// A positive number, rounded up to so many digits, but for rounding.
fn rounded_up(number: f64, digits: usize) -> f64 {
    let text = format!("{number:.*e}", digits - 1);
    let near: f64 = text.parse().unwrap_or(number);
    let exponent: Option<i64> = text.split_once('e').and_then(|(_, exponent)| exponent.parse().ok());
    let (Some(exponent), true) = (exponent, near < number * (1.0 - 1e-12)) else { return near };
    let unit: f64 = format!("1e{}", exponent + 1 - digits as i64).parse().unwrap_or_default();
    // Through text, so that 0.0016 + 0.0001 is 0.0017.
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
                let setting = Setting { method: &METHODS[0], steps };
                let step = setting.written(&of);
                let again = scene(&format!("frame_rate = {rate}, duration = {}, step = {step}", 10.0 / rate));
                assert_eq!(Setting::of(&again).steps, steps, "{rate} {step}");
            }
        }
        let setting = Setting { method: &METHODS[0], steps: 8 };
        assert_eq!(setting.written(&scene("frame_rate = 30")), 0.0042);
        assert_eq!(setting.written(&scene("frame_rate = 25")), 0.005);
    }

    #[test]
    fn a_setting_of_its_own_changes_nothing_of_a_scene() {
        let scene = scene("step = 0.0333, duration = 1");
        let own = Setting::of(&scene);
        assert_eq!(own.applied(&scene, own).simulation.step, 0.0333);
        assert_eq!(Setting::of(&own.finer(2).applied(&scene, own)).steps, 2 * own.steps);
    }
}

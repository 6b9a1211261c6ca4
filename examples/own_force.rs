//! Runs a scene with a force and an integration method that are written in Rust:
//!
//!     cargo run --example own_force
//!
//! This writes a script for each frame into `out/rosette`. `povray +Iout/rosette/frame_0250.pov` renders the last frame.
//!
//! The force is Newton's example of a revolving orbit (*Principia*, book I, propositions 43 to 45). A spring to the origin leads a
//! ball around an ellipse. An added force in proportion to 1/r³ rotates that ellipse: at each moment, the ball is as far from the
//! origin as on the ellipse, but its angle is `TURNS` times as large. Its trail is a rosette.

use std::f64::consts::TAU;
use std::path::Path;

use jabuka::emit::frame_name;
use jabuka::physics::{Force, Integrator, Loads, Method, Moment, State, System};
use jabuka::simulate::{Recorded, world};
use jabuka::{Run, Scene};

/// The stiffness of the spring, N/m. The mass of the ball is 1 kg, so the ball oscillates at 1 rad/s.
const STIFFNESS: f64 = 1.0;
/// The lengths of the semi-axes of the ellipse, m.
const HALF_AXES: [f64; 2] = [3.0, 1.0];
/// The angle of the ball about the origin, divided by its angle on the ellipse.
const TURNS: f64 = 1.2;

/// Returns the scene with a number of steps per second. Its duration is five turns on the ellipse, after which the rosette is closed.
fn scene(steps: f64) -> Result<Scene, jabuka::diagnostic::Report> {
    let ([x, y], duration) = (HALF_AXES, 5.0 * TAU);
    Scene::parse(&format!(
        r#"
        title = "Newton's revolving orbit"
        simulation = {{ duration = {duration}, frame_rate = {rate}, step = {step} }}

        [body.ball]
        shape.sphere.radius = 0.15
        mass = 1
        location = [{x}, 0, 0]
        velocity = [0, {speed}, 0]
        trail = true

        [environment]
        ground = false
        "#,
        rate = 250.0 / duration,
        step = 1.0 / steps,
        speed = TURNS * y,
    ))
}

/// A spring to the origin, and the force that rotates the orbit: F = (−k + c/r⁴) r.
struct Revolving {
    /// The index of the body in the scene.
    body: usize,
    /// The stiffness k of the spring, N/m.
    spring: f64,
    /// The strength c of the added force, N m³. Negative values attract.
    added: f64,
}

impl Force for Revolving {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        let place = moment.state.location[self.body];
        let square = place.length_squared();
        loads.force[self.body] += (-self.spring + self.added / (square * square)) * place;
    }

    /// Returns the potential energy, J. With it, the drift of the total energy shows the error of the run.
    fn potential(&self, moment: &Moment) -> f64 {
        let square = moment.state.location[self.body].length_squared();
        0.5 * (self.spring * square + self.added / square)
    }
}

/// The position Verlet method: half a drift, a kick, half a drift. It is symplectic and of second order. This implementation does not
/// rotate bodies.
static POSITION_VERLET: Method = Method {
    name: "position-verlet",
    order: 2,
    symplectic: true,
    constraints: false,
    adaptive: false,
    summary: "second order, symplectic, one evaluation of forces in the middle of a step",
    create: || Box::new(PositionVerlet::default()),
    take_over: None,
};

#[derive(Clone, Default)]
struct PositionVerlet {
    /// Working memory for the forces in the middle of the step. It is kept, so that steps allocate no memory.
    loads: Loads,
}

impl Integrator for PositionVerlet {
    fn advance(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State) {
        let half = 0.5 * dt;
        drift(state, half);
        system.arrive(t + half, state, &mut self.loads);
        let masses = system.model().inverse_mass();
        for ((velocity, force), inverse_mass) in state.velocity.iter_mut().zip(&self.loads.force).zip(masses)
        {
            *velocity += dt * inverse_mass * *force;
        }
        drift(state, half);
    }

    fn clone_box(&self) -> Box<dyn Integrator> {
        Box::new(self.clone())
    }
}

fn drift(state: &mut State, dt: f64) {
    for (location, velocity) in state.location.iter_mut().zip(&state.velocity) {
        *location += dt * *velocity;
    }
}

/// Runs the scene with the force and the method above.
fn run(scene: &Scene) -> Result<Run<'_>, jabuka::RunError> {
    let [x, y] = HALF_AXES;
    // The angular momentum on the ellipse is √k a b for a mass of 1 kg.
    let added = STIFFNESS * x * x * y * y * (1.0 - TURNS * TURNS);
    let mut world = world(scene);
    world.add_force(Revolving { body: 0, spring: STIFFNESS, added });
    world.set_integrator(&POSITION_VERLET);
    Run::of(Recorded::of(scene, Box::new(world))?)
}

/// Writes the scripts of all frames into a folder. Returns their number.
fn write(run: &Run<'_>, folder: &Path) -> Result<usize, Box<dyn std::error::Error>> {
    std::fs::create_dir_all(folder)?;
    let frames = run.scene().simulation.timeline.frames();
    for frame in run.frames() {
        let frame = frame?;
        std::fs::write(folder.join(frame_name(frame.index, frames)), run.script(&frame)?)?;
    }
    Ok(frames)
}

#[allow(clippy::print_stdout, reason = "an example shows what it does")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = scene(100.0)?;
    let (run, folder) = (run(&scene)?, Path::new("out/rosette"));
    println!("{}: {} scripts", folder.display(), write(&run, folder)?);
    println!("the energy drifts by {:.1e} of the largest kinetic energy", run.survey().drift.abs());
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]

    use glam::DVec3;

    use super::*;

    /// Returns the exact position of the ball at time `t`, s: its distance is that on the ellipse, and its angle is `TURNS` times as
    /// large.
    fn exact(t: f64) -> DVec3 {
        let [x, y] = HALF_AXES;
        let (sin, cos) = (libm::sin(t), libm::cos(t));
        // The angle on the ellipse differs from the phase by the last term, which stays within a quarter of a turn.
        let angle = t - libm::atan((x - y) * sin * cos / (x * cos * cos + y * sin * sin));
        let (sin, cos) = (libm::sin(TURNS * angle), libm::cos(TURNS * angle));
        libm::hypot(x * libm::cos(t), y * libm::sin(t)) * DVec3::new(cos, sin, 0.0)
    }

    /// Returns the largest distance between the ball and the closed form in all frames, m.
    fn error(run: &Run<'_>) -> f64 {
        let off = |frame: jabuka::simulate::Frame| (frame.bodies[0].location - exact(frame.time)).length();
        run.frames().map(|frame| off(frame.unwrap())).fold(0.0, f64::max)
    }

    #[test]
    fn the_orbit_is_newtons_and_the_method_of_second_order() {
        let [coarse, fine] = [100.0, 200.0].map(|steps| error(&run(&scene(steps).unwrap()).unwrap()));
        assert!(fine < 1e-3, "{fine}");
        assert!((coarse / fine - 4.0).abs() < 0.1, "{coarse} / {fine}");
    }

    #[test]
    fn scripts_show_the_trail() {
        let folder = std::env::temp_dir().join(format!("jabuka_rosette_{}", std::process::id()));
        let scene = scene(100.0).unwrap();
        let run = run(&scene).unwrap();
        assert_eq!(write(&run, &folder).unwrap(), 251);
        let last = std::fs::read_to_string(folder.join("frame_0250.pov")).unwrap();
        assert!(last.starts_with("// frame 250, t = ") && last.contains("trail"), "{last}");
        assert!(run.survey().drift.abs() < 1e-4, "{}", run.survey().drift);
        std::fs::remove_dir_all(&folder).unwrap();
    }
}

//! True errors of adaptive methods, held against closed forms or, for rotations, against an extrapolation (Gragg–Bulirsch–Stoer) with 30
//! digits (mpmath). SciPy 1.17.1 (`solve_ivp`, DOP853) tells how many evaluations the tolerance (`rtol` = `atol`) takes: the smaller number
//! of two forms of the equations, with the angular momentum in world axes and in those of the body.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use super::*;

/// The force and the torque on a body, by time and state.
type Law = fn(f64, &State) -> [DVec3; 2];

/// Loads that a function of time and of a body's state returns: force and torque, world axes.
struct Driven {
    law: Law,
    turns: bool,
    evaluations: Arc<AtomicU32>,
}

impl Force for Driven {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        self.evaluations.fetch_add(1, Ordering::Relaxed);
        let [force, torque] = (self.law)(moment.time, moment.state);
        loads.force[0] += force;
        loads.torque[0] += torque;
    }

    fn potential(&self, _: &Moment) -> f64 {
        0.0
    }

    fn turns_bodies(&self) -> bool {
        self.turns
    }
}

/// A problem with its end (s), what it yields there, the size of this value, and SciPy's evaluations at the tolerances 1e-6, 1e-9 and
/// 1e-12.
struct Problem {
    name: &'static str,
    body: RigidBody,
    law: Law,
    /// Whether the law can have a torque.
    turns: bool,
    end: f64,
    yields: fn(&BodySnapshot) -> DVec3,
    expected: DVec3,
    size: f64,
    of_scipy: [u32; 3],
    /// The allowed error, in tolerances. A rotation that passes its unstable axis many times multiplies all errors.
    allowed: f64,
    /// The part of the allowed error that comes from rounding, relative to the size.
    rounding: f64,
}

fn hold(problem: &Problem) {
    for method in ADAPTIVE {
        for (tolerance, of_scipy) in [1e-6, 1e-9, 1e-12].into_iter().zip(problem.of_scipy) {
            let evaluations = Arc::new(AtomicU32::new(0));
            let mut world = World::new();
            world.add(problem.body);
            world.add_force(Driven {
                law: problem.law,
                turns: problem.turns,
                evaluations: evaluations.clone(),
            });
            let mut run = run(method, tolerance, problem.end, world);
            run.advance(problem.end, &[], &mut |_| {}).unwrap();
            let made = evaluations.load(Ordering::Relaxed);
            let off = ((problem.yields)(&run.snapshot().unwrap().bodies[0]) - problem.expected).length();
            let case = format!(
                "{} by {method} at {tolerance:e}: {:e}, {made} of {of_scipy}",
                problem.name,
                off / problem.size
            );
            assert!(off <= problem.size * (problem.allowed * tolerance + problem.rounding), "{case}");
            assert!(method != "dop853" || f64::from(made) <= 1.3 * f64::from(of_scipy), "{case}");
        }
    }
}

fn body(inertia: DVec3, angular_velocity: DVec3) -> RigidBody {
    sphere(1.0).with_inertia(inertia).with_angular_velocity(angular_velocity)
}

/// A body of 1 m × 2 m × 0.3 m and 3 kg, which flips about its intermediate axis. Each flip multiplies all errors: those of SciPy are 210
/// tolerances at 1e-6, 1,700 at 1e-9 and 8,000 at 1e-12. Where no force can have a torque, angular momentum and energy hold, and so do the
/// times of the flips.
#[test]
fn a_tumbling_card() {
    for (turns, allowed, rounding) in [(true, 1000.0, 8e-9), (false, 100.0, 2e-9)] {
        hold(&Problem {
            name: "card",
            body: body(DVec3::new(1.0225, 0.2725, 1.25), DVec3::new(5.0, 0.01, 0.01)),
            law: |_, _| [DVec3::ZERO; 2],
            turns,
            end: 60.0,
            yields: |body| body.angular_velocity,
            expected: DVec3::new(4.998_603_162_549, 0.301_495_751_126, 0.517_760_443_568),
            size: 5.0,
            of_scipy: [2966, 5990, 12638],
            allowed,
            rounding,
        });
    }
}

/// A spinning top that precesses and nods: its tip is pulled down by 4 N m at a right angle.
#[test]
fn a_top() {
    hold(&Problem {
        name: "top",
        body: body(DVec3::new(1.0, 1.0, 0.5), 20.0 * (tilted() * DVec3::Z)).with_orientation(tilted()),
        law: |_, state| [DVec3::ZERO, (state.orientation[0] * DVec3::Z).cross(-4.0 * DVec3::Z)],
        turns: true,
        end: 10.0,
        yields: |body| body.angular_velocity,
        expected: DVec3::new(-5.280_558_077_067, 3.088_109_710_785, 19.042_856_493_707),
        size: 20.0,
        of_scipy: [1010, 2354, 5570],
        allowed: 100.0,
        rounding: 1e-12,
    });
}

fn tilted() -> DQuat {
    DQuat::from_rotation_x(0.3)
}

/// A body with three moments of inertia that a turning field pulls at, through its unstable axis: SciPy's error is 4,000 to 12,000
/// tolerances.
#[test]
fn a_driven_tumbler() {
    hold(&Problem {
        name: "tumbler",
        body: body(DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.01, 5.0, 0.01)),
        law: |t, state| {
            let (sin, cos) = libm::sincos(2.0 * t);
            [DVec3::ZERO, (state.orientation[0] * DVec3::Z).cross(DVec3::new(cos, 1.0, sin))]
        },
        turns: true,
        end: 20.0,
        yields: |body| body.angular_velocity,
        expected: DVec3::new(2.349_132_851_468, 5.232_174_222_083, -0.894_764_601_912),
        size: 5.8,
        of_scipy: [1094, 2270, 4658],
        allowed: 2000.0,
        rounding: 1e-10,
    });
}

/// A charge in crossed fields: with q/m = 1, a cycloid and a fall along the magnetic field. The closed form is J. D. Jackson, *Classical
/// Electrodynamics*, 12.3.
#[test]
fn a_charged_body() {
    const B: f64 = 2.0;
    let (sin, cos) = libm::sincos(B * 30.0);
    // In the plane, v = drift + (v₀ − drift) turned by −B t.
    let (drift, start) = (-0.3 / B, DVec3::new(1.0, 0.3 / B, 0.0));
    let turned =
        DVec3::new(start.x * sin + start.y * (1.0 - cos), start.y * sin - start.x * (1.0 - cos), 0.0) / B;
    let fall = 0.5 * 0.1 * 30.0 * 30.0;
    hold(&Problem {
        name: "charge",
        body: sphere(1.0).with_velocity(DVec3::X),
        law: |_, state| [DVec3::new(0.3, 0.0, 0.1) + state.velocity[0].cross(B * DVec3::Z), DVec3::ZERO],
        turns: false,
        end: 30.0,
        yields: |body| body.location,
        expected: turned + DVec3::new(0.0, drift * 30.0, fall),
        size: 5.5,
        of_scipy: [626, 1454, 3422],
        allowed: 100.0,
        rounding: 1e-12,
    });
}

/// x″ = −4 x + cos 3t from x = 1: x = 1.2 cos 2t − 0.2 cos 3t.
#[test]
fn a_driven_oscillator() {
    hold(&Problem {
        name: "oscillator",
        body: sphere(1.0).with_location(DVec3::X),
        law: |t, state| [-4.0 * state.location[0] + libm::cos(3.0 * t) * DVec3::X, DVec3::ZERO],
        turns: false,
        end: 30.0,
        yields: |body| body.location,
        expected: (1.2 * libm::cos(60.0) - 0.2 * libm::cos(90.0)) * DVec3::X,
        size: 1.0,
        of_scipy: [890, 1910, 4442],
        allowed: 100.0,
        rounding: 1e-12,
    });
}

//! Integration methods whose steps are independent of the frames of the animation: either adaptive steps, or constant steps of a symplectic
//! method.
//!
//! A step ends where the motion is not smooth — at a birth, a death, or the end of the run — and nowhere else. A requested moment within a
//! step is computed by a branch: a copy of the bodies at the start of the step makes a shorter step to exactly that moment. The result is
//! as accurate as the run, and does not affect the run: it is the same, bit for bit, whichever moments are requested.
//!
//! The engine takes over a `World` with its forces, given motions, energy accounts and expected energy, and the times at which bodies appear
//! and disappear. A `Stepper` holds the bodies in its own representation, and chooses its own steps. `Bodies` lists the quantities to
//! integrate: a body without torques rotates in closed form.

mod advance;
mod bodies;
mod dop853;
mod fixed;
mod gauss_radau;
mod snapshot;
mod stepper;
#[cfg(test)]
mod tests;
mod time;
mod wisdom_holman;

use self::bodies::{Bodies, Field, Scales};
use self::dop853::Dop853;
use self::gauss_radau::GaussRadau;
use self::stepper::Stepper;
use self::time::Time;
use self::wisdom_holman::WisdomHolman;
use super::presence::PresenceSchedule;
use super::world::Parts;
use super::{Breakdown, Dynamics, EnergyLedger, Loads, Method, Model, Snapshot, State, World};

use fixed::Fixed;

/// The accuracy of an adaptive method, and the end of the run.
#[derive(Clone, Copy, Debug)]
pub struct Accuracy {
    /// The allowed error of a step, relative to the size of the motion. Each method defines it in detail.
    pub tolerance: f64,
    /// The time at which the run ends, s. No step goes beyond this time, unless a later time is requested.
    pub end: f64,
}

pub(super) const DOP853: Method = Method {
    name: "dop853",
    order: 8,
    symplectic: false,
    constraints: false,
    adaptive: true,
    summary: "order 8, adaptive (`tolerance`): for smooth motion of any kind, precise over short and medium times",
    create: || Box::new(Fixed::new(Dop853::new(FOR_FIXED_STEPS))),
    take_over: Some(|world, accuracy| take_over(world, Dop853::new(accuracy.tolerance), accuracy.end)),
};

pub(super) const GAUSS_RADAU: Method = Method {
    name: "gauss-radau",
    order: 15,
    symplectic: false,
    constraints: false,
    adaptive: true,
    summary: "order 15, adaptive (`tolerance`): orbits to the last digits, also through close encounters and over long times",
    create: || Box::new(Fixed::new(GaussRadau::new(FOR_FIXED_STEPS))),
    take_over: Some(|world, accuracy| take_over(world, GaussRadau::new(accuracy.tolerance), accuracy.end)),
};

pub(super) const WISDOM_HOLMAN: Method = Method {
    name: "wisdom-holman",
    order: 2,
    symplectic: true,
    constraints: false,
    adaptive: false,
    summary: "order 2, symplectic, with a corrector: planets about one heavy body for millions of years, without close encounters",
    create: || Box::new(Fixed::new(WisdomHolman::new(f64::INFINITY))),
    take_over: Some(|world, accuracy| {
        let parts = world.into_parts();
        let method = WisdomHolman::new(parts.step);
        Box::new(FrameIndependent::new(parts, method, accuracy.end))
    }),
};

/// The tolerance of adaptive methods when they make steps of fixed length. Such steps do not depend on it.
const FOR_FIXED_STEPS: f64 = 1e-9;

fn take_over(world: World, method: impl Stepper + 'static, end: f64) -> Box<dyn Dynamics> {
    Box::new(FrameIndependent::new(world.into_parts(), method, end))
}

/// Simulates bodies that move under forces, by a method that chooses its own steps.
struct FrameIndependent<S> {
    model: Model,
    /// The state of the bodies at the requested time.
    state: State,
    ledger: EnergyLedger,
    calendar: PresenceSchedule,
    /// The last requested time, s.
    time: f64,
    end: f64,
    steps: u64,
    /// Whether the method has taken over the bodies; false at the start, and after a birth or a death.
    is_begun: bool,
    /// The method with its bodies at the end of the last step, and at the start of that step.
    now: (Time, S),
    before: (Time, S),
    /// Working memory for a copy of the method that computes a moment within a step.
    branch: S,
    bodies: Bodies,
    scales: Scales,
    /// Working memory for the state of the bodies at a stage, and for their loads.
    stage: State,
    loads: Loads,
}

impl<S: Stepper> FrameIndependent<S> {
    fn new(parts: Parts, stepper: S, end: f64) -> FrameIndependent<S> {
        let Parts { time, model, state, ledger, calendar, .. } = parts;
        let now = (Time::at(time), stepper);
        FrameIndependent {
            stage: state.clone(),
            before: now.clone(),
            branch: now.1.clone(),
            now,
            model,
            state,
            ledger,
            calendar,
            time,
            end,
            steps: 0,
            is_begun: false,
            bodies: Bodies::default(),
            scales: Scales::default(),
            loads: Loads::default(),
        }
    }
}

impl<S: Stepper> Dynamics for FrameIndependent<S> {
    fn time(&self) -> f64 {
        self.time
    }

    fn advance(&mut self, t: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) -> Result<(), Breakdown> {
        if !(t > self.time && t.is_finite()) {
            return Ok(());
        }
        self.advance_by_events(t, moments, see).map_err(|breakdown| self.model.cause(breakdown))
    }

    fn snapshot(&mut self) -> Result<Snapshot, Breakdown> {
        let balance = self.ledger.measure(&self.model, self.time, &self.state);
        self.picture(balance).checked().map_err(|breakdown| self.model.cause(breakdown))
    }

    fn steps(&self) -> u64 {
        self.steps
    }
}

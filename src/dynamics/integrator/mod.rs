//! Integration methods: their interface, the table of all methods, and one file for each.
//!
//! A new method is one file that implements [`Integrator`], and one line in [`METHODS`]. The tests of order and energy then cover it
//! automatically.

mod dense;
mod euler_cromer;
mod explicit_euler;
mod rk4;
mod rotation;
mod runge_kutta;
mod splitting;
mod straight;
mod velocities;
mod velocity_verlet;
mod yoshida4;

use super::{Accuracy, Dynamics, State, System, World, ahead};

pub use dense::{DenseOutput, Step};
pub(super) use rotation::{free as turn_freely, rate as orientation_rate};
pub(super) use splitting::drift_body;

/// An integration method. It advances a state; the time belongs to the [`World`](super::World).
pub trait Integrator: Send {
    /// Advances `state` from time `t` by one step of `dt` seconds. To evaluate forces at a later time, it must [arrive](System::arrive)
    /// there first. The caller arrives at the end of the step, and settles the constraints there.
    fn advance(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State);

    /// The motion within the last step. The default uses quintic Hermite polynomials, which suit smooth methods of order 2 and higher.
    fn dense<'a>(&self, system: &mut System<'_>, step: Step<'a>) -> Box<dyn DenseOutput + 'a> {
        Box::new(dense::Hermite::new(system, step))
    }

    /// Called after anything that is not smooth (an impact, a birth, a force changed by hand): values kept from earlier steps become
    /// invalid.
    fn discontinuity(&mut self) {}

    /// A copy that continues exactly as this one would.
    fn clone_box(&self) -> Box<dyn Integrator>;
}

impl Clone for Box<dyn Integrator> {
    fn clone(&self) -> Self {
        self.as_ref().clone_box()
    }
}

/// Takes over a world and advances it from then on.
pub type TakeOver = fn(World, Accuracy) -> Box<dyn Dynamics>;

/// An entry of the table of methods.
#[derive(Debug)]
pub struct Method {
    /// The name that selects it.
    pub name: &'static str,
    /// The order p: halving the step divides the error by 2ᵖ.
    pub order: u32,
    /// Whether it is symplectic: the energy error then stays bounded over any time.
    pub symplectic: bool,
    /// Whether it supports constraints. A scene with joints cannot use other methods.
    pub constraints: bool,
    /// Whether it chooses its steps by their error. A scene then sets `tolerance`, not `step`.
    pub adaptive: bool,
    /// One line for a list of methods.
    pub summary: &'static str,
    /// Makes a new integrator.
    pub create: fn() -> Box<dyn Integrator>,
    /// Takes over a world, to advance it by steps that are independent of frames. `None` for a method whose steps divide the time between
    /// two frames.
    pub ahead: Option<TakeOver>,
}

/// The methods whose steps divide the time between two frames; the first is the default.
pub static METHODS: &[Method] =
    &[euler_cromer::METHOD, explicit_euler::METHOD, velocity_verlet::METHOD, rk4::METHOD, yoshida4::METHOD];

/// The methods whose steps are independent of frames.
pub static AHEAD: &[Method] = &[ahead::DOP853, ahead::GAUSS_RADAU, ahead::WISDOM_HOLMAN];

impl Method {
    /// All methods.
    pub fn all() -> impl Iterator<Item = &'static Method> {
        METHODS.iter().chain(AHEAD)
    }

    /// The method of this name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<&'static Method> {
        Method::all().find(|method| method.name == name)
    }

    /// Whether it is only for planets about a heavy body that gravitation alone moves.
    #[must_use]
    pub fn is_of_planets(&self) -> bool {
        self.name == ahead::WISDOM_HOLMAN.name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_is_found_by_its_own_name() {
        for method in Method::all() {
            let found = Method::by_name(method.name).unwrap();
            assert!(std::ptr::eq(found, method), "{} is there twice", method.name);
        }
        assert!(Method::by_name("guesswork").is_none());
        assert_eq!(METHODS[0].name, "euler-cromer");
    }
}

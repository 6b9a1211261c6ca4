//! Methods of numerical integration: the interface of one, the table of all, and one file for each.
//!
//! A new method is one file that implements [`Integrator`], and one line in [`METHODS`]; the tests of order and of
//! energy then run on it by themselves.

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

/// A method of integration. It advances a state; time belongs to the [`World`](super::World).
pub trait Integrator: Send {
    /// Advances `state` from time `t` by one step of `dt` seconds. Where it evaluates forces at a later time, it
    /// must [arrive](System::arrive) there; at the end of the step, the caller does, and settles what constraints hold.
    fn advance(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State);

    /// The motion within the last step, for times between two steps. The default takes quintic Hermite polynomials, which suit
    /// smooth methods from order 2 up.
    fn dense<'a>(&self, system: &mut System<'_>, step: Step<'a>) -> Box<dyn DenseOutput + 'a> {
        Box::new(dense::Hermite::new(system, step))
    }

    /// Told after anything that is not smooth (an impact, a birth, a force changed by hand): values kept from
    /// earlier steps do not hold any more.
    fn discontinuity(&mut self) {}

    /// A copy that goes on exactly as this one would.
    fn clone_box(&self) -> Box<dyn Integrator>;
}

impl Clone for Box<dyn Integrator> {
    fn clone(&self) -> Self {
        self.as_ref().clone_box()
    }
}

/// Takes over a world, and advances it from then on.
pub type TakeOver = fn(World, Accuracy) -> Box<dyn Dynamics>;

/// An entry of the table of methods.
#[derive(Debug)]
pub struct Method {
    /// The name by which it is chosen.
    pub name: &'static str,
    /// The order p: halving the step divides the error by 2ᵖ.
    pub order: u32,
    /// Whether it is symplectic: then the error of the energy stays bounded over any time.
    pub symplectic: bool,
    /// Whether it can keep constraints; a scene with joints is refused where it cannot.
    pub constraints: bool,
    /// Whether it chooses its steps by their error, and a scene says `tolerance` and not `step`.
    pub adaptive: bool,
    /// One line for a list of methods.
    pub summary: &'static str,
    /// Makes a new integrator, which makes steps of a given length.
    pub create: fn() -> Box<dyn Integrator>,
    /// Takes over a world, to advance it by steps that know nothing of frames; none for a method whose steps divide the time between two
    /// frames.
    pub ahead: Option<TakeOver>,
}

/// The methods whose steps divide the time between two frames; the first is the default.
pub static METHODS: &[Method] =
    &[euler_cromer::METHOD, explicit_euler::METHOD, velocity_verlet::METHOD, rk4::METHOD, yoshida4::METHOD];

/// The methods whose steps know nothing of frames.
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

    /// Whether it is for planets about a heavy body alone, which no force but gravitation moves.
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

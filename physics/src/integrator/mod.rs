//! Integration methods: their interface, the table of all methods, and one file for each method.
//!
//! A new method is one file that implements [`Integrator`], and one line in [`METHODS`]. The tests of order and energy then cover it
//! automatically.
//!
//! Each method has its own dense output for the moments between two steps (`dense.rs`): the drift of a splitting method, or quintic Hermite
//! polynomials from order 2 up. So the steps never depend on what is drawn. A method gets a `System`, which combines forces and constraints.

mod dense;
mod euler_cromer;
mod explicit_euler;
mod rk4;
mod rotation;
mod runge_kutta;
mod splitting;
mod torque_free;
mod velocities;
mod velocity_verlet;
mod yoshida4;

use super::{Accuracy, Dynamics, State, System, World, frame_independent};

pub use dense::{DenseOutput, Step};
pub(super) use rotation::{free as turn_freely, rate as orientation_rate};
pub(super) use splitting::drift_body;

/// An integration method, which advances the state of bodies. The [`World`](super::World) keeps the time.
pub trait Integrator: Send {
    /// Advances `state` from time `t` by one step of `dt` seconds. To evaluate forces at a later time, the method must call
    /// [`System::arrive`] for that time. After the step, the caller places the bodies with a given motion and satisfies the constraints.
    fn advance(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State);

    /// Returns the interpolated motion within the last step. The default uses quintic Hermite polynomials, which suit methods of order 2
    /// and higher.
    fn dense<'a>(&self, system: &mut System<'_>, step: Step<'a>) -> Box<dyn DenseOutput + 'a> {
        Box::new(dense::Hermite::new(system, step))
    }

    /// Discards values that are kept from earlier steps. The caller reports a discontinuity of the motion with this function: an impact, a
    /// birth, or a manual change of a force.
    fn discontinuity(&mut self) {}

    /// Returns a copy that continues exactly as the original would.
    fn clone_box(&self) -> Box<dyn Integrator>;
}

impl Clone for Box<dyn Integrator> {
    fn clone(&self) -> Self {
        self.as_ref().clone_box()
    }
}

/// A function that takes over a world and returns a simulation of it with the given accuracy.
pub type TakeOver = fn(World, Accuracy) -> Box<dyn Dynamics>;

/// An integration method in the table of methods, with its properties.
#[derive(Debug)]
pub struct Method {
    /// The name by which a scene selects the method.
    pub name: &'static str,
    /// The order p of the method: halving the step divides the error by 2ᵖ.
    pub order: u32,
    /// Whether the method is symplectic. Its energy error then stays bounded over any time.
    pub symplectic: bool,
    /// Whether the method supports constraints. A scene with joints cannot use other methods.
    pub constraints: bool,
    /// Whether the method chooses its steps by their error. A scene then sets `tolerance` instead of `step`.
    pub adaptive: bool,
    /// A description of the method in one line, for lists of methods.
    pub summary: &'static str,
    /// Creates an integrator of this method, for steps of given lengths.
    pub create: fn() -> Box<dyn Integrator>,
    /// Takes over a world to advance it in steps that are independent of the frames of the animation. `None` for a method whose steps
    /// divide the time between two frames.
    pub take_over: Option<TakeOver>,
}

/// The methods whose steps divide the time between two frames of the animation. The first method is the default.
pub static METHODS: &[Method] =
    &[euler_cromer::METHOD, explicit_euler::METHOD, velocity_verlet::METHOD, rk4::METHOD, yoshida4::METHOD];

/// The methods whose steps are independent of the frames of the animation.
pub static FRAME_INDEPENDENT: &[Method] =
    &[frame_independent::DOP853, frame_independent::GAUSS_RADAU, frame_independent::WISDOM_HOLMAN];

impl Method {
    /// Returns all methods of both tables.
    pub fn all() -> impl Iterator<Item = &'static Method> {
        METHODS.iter().chain(FRAME_INDEPENDENT)
    }

    /// Returns the method with this name; `None` if there is no such method.
    #[must_use]
    pub fn by_name(name: &str) -> Option<&'static Method> {
        Method::all().find(|method| method.name == name)
    }

    /// Whether the method can only advance planets about a heavy body, moved by gravitation alone.
    #[must_use]
    pub fn is_planetary(&self) -> bool {
        self.name == frame_independent::WISDOM_HOLMAN.name
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

//! The physics: rigid bodies, the forces on them, and the methods that advance them.
//!
//! This module needs no scene and draws nothing; it can be used on its own. Units are SI, angles are in radians, axes are right-handed.
//!
//! | what | where |
//! | --- | --- |
//! | a body at one moment, as it enters a world | [`RigidBody`], its [`Shape`] |
//! | everything that changes with time | [`State`] |
//! | everything constant: masses, inertia, forces | [`Model`] |
//! | loads at one moment | [`Force`], [`Loads`] |
//! | motion given as a function of time | [`Motion`], its [`Kinematics`] |
//! | when a body is present | [`Presence`] |
//! | joints and other constraints | [`Constraint`], one type for each kind of joint |
//! | contacts and impacts | [`Contacts`], [`Impact`] |
//! | forces and constraints together, for an integration method | [`System`] |
//! | how the state advances | [`Integrator`], the table of [`METHODS`] |
//! | the motion within a step | [`DenseOutput`] |
//! | energy, momentum, drift | [`Balance`] |
//! | everything known about one moment | [`Snapshot`] |
//! | many small bodies from a source | [`ParticleSource`], [`Cloud`] |
//! | all of these together, with a clock | [`World`] |
//! | many bodies in contact, at fixed steps | [`TimeStepping`] |
//! | few bodies, by adaptive methods | [`Method::take_over`], its [`Accuracy`] |
//! | the interface for the rest of the program | [`Dynamics`] |
//!
//! # Ideas
//!
//! Physics is separate from drawing. The integrator is chosen at run time. All bodies are the same rigid body, whether a program draws them
//! as a sphere or as a triad of axes. A body without a force has zero force. A [`World`] does not store its initial state, so a reset builds
//! the world again, and gives the same bits. [`State`] is a structure of arrays: a method advances all bodies by one step, and [`World`]
//! holds the time.
//!
//! No result depends on the machine. All functions such as sine come from the crate `libm`, sums have a fixed order, and random numbers come
//! from [`random`].
//!
//! # Engines
//!
//! A type that implements [`Dynamics`] is an engine: it advances to a time, reports the requested moments before it, returns snapshots, and
//! fails with an error that names body and time. There are three: [`World`] itself, the methods whose steps do not depend on the requested
//! moments ([`Method::take_over`]), and `TimeStepping` with the crate rapier. The last two take over a [`World`] with its forces, given
//! motions, presence of bodies, accounts and expected energy. A new engine is one more type that implements [`Dynamics`]. Everything that
//! adds or removes energy needs an account in [`Accounts`].
//!
//! The motion within a step comes from [`DenseOutput`]. So the steps of a run never depend on the moments that are requested.
//!
//! # Tutorial
//!
//! The world has two bodies: a sphere and a set of coordinate axes. They differ only in their shapes, and so in their inertia. The sphere
//! starts without a force, which is the same as zero force.
//!
//! ```
//! use glam::DVec3;
//! use jabuka_physics::{Method, RigidBody, Shape, World};
//!
//! // The closure builds a world in its initial state. The world itself does not store this state.
//! let build = || {
//!     let mut world = World::new();
//!     let sphere = RigidBody::new(&Shape::Sphere { radius: 0.5 }, 1.0)
//!         .with_location(DVec3::new(20.0, 0.0, 0.0))
//!         .with_velocity(DVec3::new(2.0, 10.0, 0.0));
//!     let axes = RigidBody::new(&Shape::Axes { length: 2.0 }, 1.0)
//!         .with_angular_velocity(DVec3::new(0.0, 1.0, 0.0))
//!         .with_force(DVec3::new(0.0, 0.0, 3.0));
//!     let (sphere, axes) = (world.add(sphere), world.add(axes));
//!     world.set_step(0.01);
//!     (world, sphere, axes)
//! };
//!
//! let run = || {
//!     let (mut world, sphere, axes) = build();
//!     world.advance_to(1.0);
//!     // After one second, push the sphere, and switch to a more accurate method of integration.
//!     world.apply_force(sphere, DVec3::new(0.0, -1.0, 0.0));
//!     world.set_integrator(Method::by_name("rk4").expect("rk4 is one of the methods"));
//!     world.advance_to(2.0);
//!     (world, sphere, axes)
//! };
//!
//! let (mut world, sphere, axes) = run();
//! assert_eq!(world.time(), 2.0);
//! // Without the push, the position would be x₀ + v t. After one second, the push has added −½ a t².
//! assert!((world.location(sphere) - DVec3::new(24.0, 19.5, 0.0)).length() < 1e-12);
//! // The axes have rotated by 2 rad about y.
//! let x_arm = world.orientation(axes) * DVec3::X;
//! assert!((x_arm.angle_between(DVec3::X) - 2.0).abs() < 1e-9);
//! // The energy error comes from the first second, which Euler–Cromer (a first-order method) computed.
//! assert!(world.balance().drift.abs() < 1e-2);
//!
//! // To reset a world, build it again: the second run equals the first, bit for bit.
//! let (again, ..) = run();
//! assert_eq!(again.state(), world.state());
//! ```

mod anchor;
mod body;
mod constraint;
mod contact;
mod energy;
mod force;
mod frame_independent;
mod integrator;
mod loads;
mod model;
mod motion;
mod pair_counter;
mod particles;
mod presence;
pub mod random;
mod sets;
mod shape;
mod snapshot;
mod softness;
mod state;
#[cfg(feature = "time-stepping")]
mod stepping;
mod system;
mod threads;
mod track;
mod world;

pub use anchor::Anchor;
pub use body::{BodyId, RigidBody};
pub use constraint::*;
pub use contact::{ContactProperties, ContactSnapshot, Contacts, Impact, LawResidual, MotionLaw, Surface};
pub use energy::{Balance, EnergyLedger};
pub use force::*;
pub use frame_independent::Accuracy;
pub use integrator::{DenseOutput, FRAME_INDEPENDENT, Integrator, METHODS, Method, Step, TakeOver};
pub use loads::Loads;
pub use model::Model;
pub use motion::{Kinematics, Motion};
pub use pair_counter::PairCounter;
pub use particles::*;
pub use presence::Presence;
pub use shape::{Compound, Flaw, Mesh, Part, Placed, Shape, Submerged, cone_base};
pub use snapshot::find;
pub use snapshot::{BodySnapshot, Breakdown, Snapshot};
pub use softness::suitable_step;
pub use state::{Accounts, State, WorkAccount};
#[cfg(feature = "time-stepping")]
pub use stepping::{Link, LinkKind, TimeStepping};
pub use system::System;
pub use track::{Interpolation, Keyframe, Track};
pub use world::{ContactPolicy, World};

/// An engine that advances bodies in time. The rest of the program uses this interface, and does not depend on the implementation.
pub trait Dynamics: Send {
    /// Returns the time that the engine has reached, s.
    fn time(&self) -> f64;

    /// Advances to time `t`, s. Afterwards [`time`](Self::time) is exactly `t`. Time cannot go back: a `t` that is not later (or not
    /// finite) changes nothing.
    ///
    /// `see` receives a snapshot for each of `moments`: times (s) in ascending order, later than now and not later than `t`. The moments do
    /// not affect the run: without them, it is the same, bit for bit.
    ///
    /// # Errors
    /// If the run cannot continue, or if a body's position or velocity at one of the moments is not finite.
    fn advance(&mut self, t: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) -> Result<(), Breakdown>;

    /// Returns a snapshot of the current moment. Its energy drift is relative to the largest kinetic energy of all snapshots so far.
    ///
    /// # Errors
    /// If a body's position or velocity is not finite, or if the run cannot continue.
    fn snapshot(&mut self) -> Result<Snapshot, Breakdown>;

    /// Returns the impacts since the last call, in the order in which they happened. Empty for an engine without impacts.
    fn impacts(&mut self) -> Vec<Impact> {
        Vec::new()
    }

    /// Returns the worst residual of each law that no contact can break, in the run so far. Empty for an engine that does not check them.
    fn law_residuals(&self) -> &[LawResidual] {
        &[]
    }

    /// Returns the number of integration steps so far.
    fn steps(&self) -> u64;

    /// Returns the current state of the engine as bytes. A run that [`resume`](Self::resume) continues from these bytes is the same, bit
    /// for bit, as an uninterrupted run. `None` if the engine cannot save its state. [`impacts`](Self::impacts) must be called first.
    fn checkpoint(&mut self) -> Option<Vec<u8>> {
        None
    }

    /// Continues from a checkpoint of the same run. Returns false if the bytes are no valid checkpoint. The run must not have advanced
    /// before.
    fn resume(&mut self, _checkpoint: &[u8]) -> bool {
        false
    }
}

//! The physics: rigid bodies, the forces on them, and the methods that advance them.
//!
//! This module needs no scene and draws nothing; it can be used for itself. Units are SI, angles radians, axes
//! right-handed.
//!
//! | what | where |
//! | --- | --- |
//! | a body at one moment, as it enters a world | [`RigidBody`], its [`Shape`] |
//! | all that changes with time | [`State`] |
//! | all that does not: masses, inertia, forces | [`Model`] |
//! | what acts at one moment | [`Force`], [`Loads`] |
//! | motion that is given | [`Motion`], its [`Kinematics`] |
//! | when a body is there | [`Presence`] |
//! | what holds bodies together | [`Constraint`], one type for each kind of joint |
//! | what happens where bodies touch | [`Contacts`], [`Impact`] |
//! | forces and constraints together, as a method of integration sees them | [`System`] |
//! | how the state advances | [`Integrator`], the table of [`METHODS`] |
//! | what happens within a step | [`DenseOutput`] |
//! | energy, momentum, drift | [`Balance`] |
//! | all that can be known of one moment | [`Snapshot`] |
//! | many small bodies that a source sends out | [`ParticleSource`], [`Cloud`] |
//! | all of it together, with a clock | [`World`] |
//! | many bodies in contact, at fixed steps | [`TimeStepping`] |
//! | few bodies, by methods that choose their steps | [`Method::ahead`], its [`Accuracy`] |
//! | what the rest of the program sees of it | [`Dynamics`] |
//!
//! # Tutorial
//!
//! Two bodies: a sphere and a triad of axes. A body is a body: only its shape, and so its inertia, differs. The
//! sphere begins without a force, and a body with no force is a body with zero force.
//!
//! ```
//! use glam::DVec3;
//! use jabuka::dynamics::{Method, RigidBody, Shape, World};
//!
//! // The start is known to this closure, not to the world.
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
//!     // Half-way the sphere is pushed, and the method of integration exchanged for a more accurate one.
//!     world.apply_force(sphere, DVec3::new(0.0, -1.0, 0.0));
//!     world.set_integrator(Method::by_name("rk4").expect("rk4 is one of the methods"));
//!     world.advance_to(2.0);
//!     (world, sphere, axes)
//! };
//!
//! let (mut world, sphere, axes) = run();
//! assert_eq!(world.time(), 2.0);
//! // Free for a second, then pushed for another: x₀ + v t, and −½ a t² from then on.
//! assert!((world.location(sphere) - DVec3::new(24.0, 19.5, 0.0)).length() < 1e-12);
//! // The axes have turned by 2 rad about y.
//! let x_arm = world.orientation(axes) * DVec3::X;
//! assert!((x_arm.angle_between(DVec3::X) - 2.0).abs() < 1e-9);
//! // Euler–Cromer's first-order error shows in the energy of the first half.
//! assert!(world.balance().drift.abs() < 1e-2);
//!
//! // A reset is to build the world again: the second run is equal to the first, bit for bit.
//! let (again, ..) = run();
//! assert_eq!(again.state(), world.state());
//! ```

mod ahead;
mod anchor;
mod body;
mod constraint;
mod contact;
mod effort;
mod energy;
mod force;
mod integrator;
mod loads;
mod model;
mod motion;
mod particles;
mod presence;
mod sets;
mod shape;
mod snapshot;
mod softness;
mod state;
#[cfg(feature = "time-stepping")]
mod stepping;
mod system;
mod track;
mod world;

pub use ahead::Accuracy;
pub use anchor::Anchor;
pub use body::{BodyId, RigidBody};
pub use constraint::*;
pub use contact::{ContactSnapshot, Contacts, Impact, Meeting, Surface};
pub use effort::Effort;
pub use energy::{Balance, EnergyLedger};
pub use force::*;
pub use integrator::{AHEAD, DenseOutput, Integrator, METHODS, Method, Step, TakeOver};
pub use loads::Loads;
pub use model::Model;
pub use motion::{Kinematics, Motion};
pub use particles::*;
pub use presence::Presence;
pub use shape::{Compound, Flaw, Immersed, Mesh, Part, Placed, Shape, cone_base};
pub(crate) use snapshot::find;
pub use snapshot::{BodySnapshot, Breakdown, Snapshot};
pub use softness::suitable_step;
pub use state::{Accounts, State, WorkAccount};
#[cfg(feature = "time-stepping")]
pub use stepping::{Link, LinkKind, TimeStepping};
pub use system::System;
pub use track::{Interpolation, Key, Track};
pub use world::World;

/// Whatever advances bodies in time. The rest of the program drives it, and knows nothing of how it is done.
pub trait Dynamics: Send {
    /// The time reached, s.
    fn time(&self) -> f64;

    /// Advances to time `t`, s; afterwards [`time`](Self::time) is exactly `t`. There is no way back: a `t` that is
    /// not later (or not finite) leaves all as it is.
    ///
    /// `see` is told of each of `moments`, which are times (s) in rising order, later than now and not later than `t`.
    /// Looking at moments changes nothing: the run is the same bit for bit without them.
    ///
    /// # Errors
    /// If the run cannot go on, or a moment is not finite.
    fn advance(&mut self, t: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) -> Result<(), Breakdown>;

    /// The present moment. The drift is relative to the largest kinetic energy among all snapshots so far.
    ///
    /// # Errors
    /// If a body is at no finite place.
    fn snapshot(&mut self) -> Result<Snapshot, Breakdown>;

    /// The impacts since somebody asked last, in the order in which they happened.
    fn impacts(&mut self) -> Vec<Impact> {
        Vec::new()
    }

    /// The number of steps that have been made.
    fn steps(&self) -> u64;

    /// The present moment as bytes, from which [`resume`](Self::resume) goes on with the same bits; none where that is not
    /// possible. Impacts must have been asked for.
    fn checkpoint(&mut self) -> Option<Vec<u8>> {
        None
    }

    /// Goes on from a checkpoint of the same run; false where it is not one. Nothing may have been advanced before.
    fn resume(&mut self, _checkpoint: &[u8]) -> bool {
        false
    }
}

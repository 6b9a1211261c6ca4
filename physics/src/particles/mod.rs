//! Particles: many small bodies from a source, each with its own lifetime.
//!
//! Particles are not bodies of a [`World`](super::World). Forces act on particles as on bodies, with the same integrator and the same
//! timesteps, and bodies can stop particles. Particles do not act on bodies or on each other. The seed of the source and the number of a
//! particle determine its motion, so any particle can be computed alone.
//!
//! | what | where |
//! | --- | --- |
//! | the birth times of particles | [`Births`] |
//! | the region in which particles are born | [`Origin`] |
//! | the initial values of particles | [`ParticleSource`] |
//! | the motion of bodies that emit, attract or stop particles | [`RecordedMotion`] |
//! | the living particles and their motion | [`Cloud`] |
//! | the bodies that stop particles | [`Scenery`] |
//! | the force at any point of space | [`TestParticle`] |
//! | impacts, and lasting contact | `bounce.rs`, `hold.rs` |
//!
//! # How a cloud moves
//!
//! A [`Cloud`] advances the living particles of one emitter, 128 at a time, with the world's own methods and forces. Each particle starts at
//! the exact time of its birth, with a shorter first step. Each has its own random numbers, so no particle depends on another, and any
//! subset gives the same bits.
//!
//! A particle that collides is a small ball. [`Scenery`] holds the convex parts of all obstacles and their paths between two frames. If the
//! free path of a particle is far from all of them, the particle follows it. For all other particles, `bounce.rs` finds the first contact in
//! each step, applies an impulse, and repeats the remaining part of the step. A particle that would hardly rebound stays in contact, and
//! slides or sticks (`hold.rs`).
//!
//! Bodies that emit or attract particles are interpolated between frames (`recorded_motion.rs`).

mod births;
mod bounce;
mod cloud;
mod hold;
mod obstacles;
mod origin;
mod particle_step;
mod recorded_motion;
mod source;
mod stepper;
mod surface;
mod test_particle;
#[cfg(test)]
mod tests;
mod triangles;

pub use births::Births;
pub use cloud::{Cloud, Particle};
pub use obstacles::{Obstacle, Scenery};
pub use origin::{BodyState, Origin};
pub use recorded_motion::RecordedMotion;
pub use source::{Draw, ParticleSource};
pub use stepper::Field;
pub use surface::has_surface;
pub use test_particle::TestParticle;
pub use triangles::Triangles;

//! Particles: many small bodies from a source, each with its own lifetime.
//!
//! Particles are not bodies of a [`World`](super::World). Forces act on them as on bodies, with the same integrator and
//! the same timesteps, and bodies can stop them. They do not act on bodies or on each other. The seed of the source and
//! the number of a particle determine its motion, so any particle can be computed without the others.
//!
//! | what | where |
//! | --- | --- |
//! | which particle is born when | [`Births`] |
//! | where it begins | [`Origin`] |
//! | all that a particle begins with | [`ParticleSource`] |
//! | where a body is that sends them out or attracts them | [`Course`] |
//! | those that are alive, and how they move | [`Cloud`] |
//! | the bodies that stop them | [`Scenery`] |
//! | what happens where they touch one | `bounce.rs`, `hold.rs` |

mod births;
mod bounce;
mod cloud;
mod course;
mod hold;
mod obstacles;
mod origin;
mod source;
mod stepper;
mod surface;
#[cfg(test)]
mod tests;
mod triangles;
mod way;

pub use births::Births;
pub use cloud::{Cloud, Particle};
pub use course::Course;
pub use obstacles::{Obstacle, Scenery};
pub use origin::{Origin, Spot};
pub use source::{Draw, ParticleSource};
pub use stepper::Field;
pub use surface::has_surface;
pub use triangles::Triangles;

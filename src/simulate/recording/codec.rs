//! The encoding of moments as bytes. Values that have not changed since the previous moment take no bytes.
//!
//! A page is a sequence of moments. Each moment consists of little-endian numbers:
//!
//! | what | type |
//! | --- | --- |
//! | the number of the frame, or 2³² − 1 between frames | `u32` |
//! | time; kinetic energy, also of given motions, potential, total energy; error, drift; linear momentum; angular momentum; the accounts; the penetration | `f64` each |
//! | the number of runs, and for each run: a mask, and its number of bodies | `u32`; `u8`, `u32` |
//! | for each body, the numbers selected by its mask | `f64` each |
//! | with joints: runs of masks, and numbers, in the same way | |
//! | with counted impacts: runs of masks, and counts, in the same way | |
//! | with counted impacts: the number of contacts, and for each: two bodies, position, normal, force, friction | `u32`; `f64` |
//! | with counted impacts: the number of new impacts, and for each: two bodies, time, position, normal, impulse, energy | `u32`; `f64` |
//! | with counted impacts: the number of residuals of laws, and for each: the law, time, two bodies, amount, part | `u32`; `f64` |
//!
//! A run is a sequence of consecutive bodies (or joints, or counts) with the same mask. A bit of a mask marks a changed column: for a
//! body, location, orientation, velocity, angular velocity, force; for a joint, force, torque, effort of
//! the motor, and counted angle. Each page starts from bodies at rest at
//! the origin, joints without load, and impact counts of 0.

mod decoder;
mod encoder;
mod last;
#[cfg(test)]
mod tests;

use std::io;

pub(super) use decoder::Decoder;
pub(super) use encoder::Encoder;

use super::super::ImpactCounts;
use crate::physics::Accounts;
use crate::scene::Scene;

/// The number of floating-point values in the header of a moment, before the bodies.
const NUMBERS_PER_HEADER: usize = 14 + Accounts::NAMES.len();
/// The number of values that describe a body.
const NUMBERS_PER_BODY: usize = 16;
/// The index of the first value of each column of a body, and the end of the last column.
const BODY_COLUMNS: [usize; 6] = [0, 3, 7, 10, 13, NUMBERS_PER_BODY];
/// The mask of an absent body.
const ABSENT_BODY_MASK: u8 = 0x80;
/// The frame number of a moment between frames.
const NO_FRAME: u32 = u32::MAX;

const AT_REST: [f64; NUMBERS_PER_BODY] = {
    let mut numbers = [0.0; NUMBERS_PER_BODY];
    numbers[6] = 1.0;
    numbers
};

/// The index of the first value of each column of a joint, and the end of the last column.
const JOINT_COLUMNS: [usize; 5] = [0, 3, 6, 7, NUMBERS_PER_JOINT];
/// The number of values that describe a joint: force, torque, effort of the motor, angle.
const NUMBERS_PER_JOINT: usize = 8;

/// The start and the end of the single column of an impact count.
const COUNT_COLUMNS: [usize; 2] = [0, 1];

/// The numbers of bodies, joints and impact counts in each moment of a recording.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    /// The number of bodies.
    pub bodies: usize,
    /// The number of joints.
    pub joints: usize,
    /// The number of impact counts. 0 in scenes without contacts.
    pub impacts: usize,
}

impl Counts {
    /// Counts the bodies, joints and impact counts of a scene.
    pub fn of(scene: &Scene) -> Counts {
        Counts { bodies: scene.bodies.len(), joints: scene.joints.len(), impacts: ImpactCounts::size(scene) }
    }
}

pub(super) fn damaged() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "the recording of the run is damaged")
}

//! Frames as the page reads them: little-endian 64-bit numbers.

use std::io;

use crate::dynamics::Balance;
use crate::simulate::Reader;

/// The numbers that are said of all bodies of a frame together.
#[cfg(test)]
pub(super) const HEAD: usize = 13;
/// The numbers that are said of one body over time.
#[cfg(test)]
pub(super) const BODY: usize = 15;
/// The numbers of a body that say where it is.
const POSE: usize = 7;
/// The bytes of a number.
const NUMBER: usize = 8;

/// The bytes of the poses of a frame.
pub(super) fn pose_bytes(bodies: usize) -> usize {
    POSE * bodies * NUMBER
}

/// The poses of all bodies in some frames: for each frame, all locations, then all orientations, x y z w. An absent body has
/// NaNs.
pub(super) fn poses(
    reader: &mut Reader,
    bodies: usize,
    frames: impl Iterator<Item = usize>,
) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    for frame in frames {
        let snapshot = reader.frame(frame)?;
        let (mut locations, mut orientations) = (vec![[f64::NAN; 3]; bodies], vec![[f64::NAN; 4]; bodies]);
        for body in &snapshot.bodies {
            locations[body.id] = body.location.to_array();
            orientations[body.id] = body.orientation.to_array();
        }
        put(&mut bytes, locations.as_flattened());
        put(&mut bytes, orientations.as_flattened());
    }
    Ok(bytes)
}

/// Appends what is said of all bodies together: the time; kinetic, potential, total energy; the sum of the accounts; drift; linear
/// momentum; angular momentum; the number of impacts, which is not a number without contacts.
pub(super) fn put_balance(bytes: &mut Vec<u8>, time: f64, balance: &Balance, impacts: f64) {
    let Balance { kinetic, potential, accounts, total, linear_momentum, angular_momentum, drift } = balance;
    put(bytes, &[time, *kinetic, *potential, *total]);
    put(bytes, &[accounts.total(), *drift]);
    put(bytes, &linear_momentum.to_array());
    put(bytes, &angular_momentum.to_array());
    put(bytes, &[impacts]);
}

/// Appends numbers.
pub(super) fn put(bytes: &mut Vec<u8>, numbers: &[f64]) {
    numbers.iter().for_each(|number| bytes.extend_from_slice(&number.to_le_bytes()));
}

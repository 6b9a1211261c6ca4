//! Encodes frames for the page as little-endian 64-bit numbers.

use std::io;

use crate::physics::Balance;
use crate::simulate::Reader;

/// The number of values in the energy and momentum balance of a frame.
#[cfg(test)]
pub(super) const NUMBERS_PER_BALANCE: usize = 13;
/// The number of values in a sample of one body at one frame.
#[cfg(test)]
pub(super) const NUMBERS_PER_SAMPLE: usize = 15;
/// The number of values of a contact of one body at one frame.
#[cfg(any(test, feature = "render"))]
pub(super) const NUMBERS_PER_CONTACT: usize = 11;

/// The count of numbers of a pose: location (3) and orientation (4).
#[cfg(feature = "render")]
pub(super) const NUMBERS_PER_POSE: usize = 7;

/// Encodes the poses of all bodies in some frames. Each frame has all locations (x y z), then all orientations (x y z w). The numbers of
/// an absent body are NaN.
pub(crate) fn poses(
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

/// Appends the energy and momentum balance of a frame: the time; kinetic, potential and total energy; the total energy that influences
/// without a potential have brought in, with that of given motions; the energy drift; linear momentum; angular momentum; the number of impacts, which is NaN without
/// contacts.
pub(super) fn put_balance(bytes: &mut Vec<u8>, time: f64, balance: &Balance, impacts: f64) {
    let Balance { given_kinetic, potential, accounts, linear_momentum, angular_momentum, drift, .. } =
        balance;
    put(bytes, &[time, balance.kinetic_of_all(), *potential, balance.total_of_all()]);
    put(bytes, &[accounts.total() + given_kinetic, *drift]);
    put(bytes, &linear_momentum.to_array());
    put(bytes, &angular_momentum.to_array());
    put(bytes, &[impacts]);
}

/// Appends numbers in little-endian order.
pub(super) fn put(bytes: &mut Vec<u8>, numbers: &[f64]) {
    numbers.iter().for_each(|number| bytes.extend_from_slice(&number.to_le_bytes()));
}

//! Encodes moments as bytes.

use super::super::super::simulation::Entry;
use super::super::events::{contact_numbers, impact_numbers, law_numbers};
use super::last::Last;
use super::{
    ABSENT_BODY_MASK, BODY_COLUMNS, COUNT_COLUMNS, Counts, JOINT_COLUMNS, NO_FRAME, NUMBERS_PER_BODY,
};
use crate::physics::{Balance, BodySnapshot, Reaction, Snapshot};

/// Encodes the moments of a recording one after another.
pub(in super::super) struct Encoder {
    last: Last,
    masks: Vec<u8>,
}

impl Encoder {
    /// Creates an encoder for moments with these numbers of bodies, joints and impact counts.
    pub(in super::super) fn new(counts: Counts) -> Encoder {
        Encoder { last: Last::new(counts), masks: Vec::new() }
    }

    /// Starts a new page, which can be decoded without the pages before it.
    pub(in super::super) fn begin_page(&mut self) {
        self.last.begin_page();
    }

    /// Appends a moment to `bytes`.
    pub(in super::super) fn encode(&mut self, entry: &Entry, bytes: &mut Vec<u8>) {
        let Self { last, masks } = self;
        let Entry { frame, snapshot, .. } = entry;
        let number = frame.and_then(|frame| u32::try_from(frame).ok()).unwrap_or(NO_FRAME);
        bytes.extend_from_slice(&number.to_le_bytes());
        put(bytes, &[snapshot.time]);
        let Balance {
            kinetic,
            given_kinetic,
            potential,
            total,
            error,
            drift,
            linear_momentum,
            angular_momentum,
            accounts,
        } = snapshot.balance;
        put(bytes, &[kinetic, given_kinetic, potential, total, error, drift]);
        put(bytes, &linear_momentum.to_array());
        put(bytes, &angular_momentum.to_array());
        put(bytes, &accounts.to_array());
        put(bytes, &[snapshot.penetration]);

        masks.clear();
        masks.resize(last.bodies.len(), ABSENT_BODY_MASK);
        let start = bytes.len();
        for body in &snapshot.bodies {
            let numbers = numbers_of(body);
            let last = &mut last.bodies[body.id];
            masks[body.id] = put_changed(bytes, &BODY_COLUMNS, &numbers, last);
            *last = numbers;
        }
        put_runs(bytes, start, masks);
        if !last.joints.is_empty() {
            self.encode_joints(snapshot, bytes);
        }
        if !self.last.impacts.is_empty() {
            self.encode_contacts(entry, bytes);
        }
    }

    fn encode_joints(&mut self, snapshot: &Snapshot, bytes: &mut Vec<u8>) {
        let Self { last: Last { joints, .. }, masks } = self;
        masks.clear();
        let start = bytes.len();
        // A joint without a recorded reaction has no load.
        let reactions = snapshot.reactions.iter().copied().chain(std::iter::repeat(Reaction::default()));
        let angles = snapshot.angles.iter().copied().chain(std::iter::repeat(0.0));
        for ((last, reaction), angle) in joints.iter_mut().zip(reactions).zip(angles) {
            let Reaction { force, torque, motor } = reaction;
            let numbers = [force.x, force.y, force.z, torque.x, torque.y, torque.z, motor, angle];
            masks.push(put_changed(bytes, &JOINT_COLUMNS, &numbers, last));
            *last = numbers;
        }
        put_runs(bytes, start, masks);
    }

    /// Appends the impact counts, the contacts of the moment, the impacts since the previous moment, and the worst residuals of laws.
    fn encode_contacts(&mut self, entry: &Entry, bytes: &mut Vec<u8>) {
        let Self { last: Last { impacts, .. }, masks } = self;
        masks.clear();
        let start = bytes.len();
        let counts = entry.counts.0.iter().copied().chain(std::iter::repeat(0.0));
        for (last, count) in impacts.iter_mut().zip(counts) {
            masks.push(put_changed(bytes, &COUNT_COLUMNS, &[count], &[*last]));
            *last = count;
        }
        put_runs(bytes, start, masks);
        let contacts = &entry.snapshot.contacts;
        bytes.extend_from_slice(&u32_of(contacts.len()).to_le_bytes());
        contacts.iter().for_each(|contact| put(bytes, &contact_numbers(contact)));
        bytes.extend_from_slice(&u32_of(entry.impacts.len()).to_le_bytes());
        entry.impacts.iter().for_each(|impact| put(bytes, &impact_numbers(impact)));
        let laws = &entry.snapshot.laws;
        bytes.extend_from_slice(&u32_of(laws.len()).to_le_bytes());
        laws.iter().for_each(|residual| put(bytes, &law_numbers(residual)));
    }
}

/// Appends the values of the columns that differ from `last`. Returns the mask that selects these columns.
fn put_changed(bytes: &mut Vec<u8>, columns: &[usize], numbers: &[f64], last: &[f64]) -> u8 {
    let mut mask = 0;
    for (column, range) in columns.windows(2).enumerate() {
        let (new, old) = (&numbers[range[0]..range[1]], &last[range[0]..range[1]]);
        // Compare the bits, since `==` treats -0 and 0 as equal.
        if new.iter().zip(old).any(|(new, old)| new.to_bits() != old.to_bits()) {
            mask |= 1 << column;
            put(bytes, new);
        }
    }
    mask
}

/// Inserts the runs of the masks at offset `start`.
fn put_runs(bytes: &mut Vec<u8>, start: usize, masks: &[u8]) {
    let mut runs = Vec::new();
    for run in masks.chunk_by(|a, b| a == b) {
        runs.push(run[0]);
        runs.extend_from_slice(&u32_of(run.len()).to_le_bytes());
    }
    let count = u32_of(runs.len() / 5).to_le_bytes();
    bytes.splice(start..start, count.into_iter().chain(runs));
}

fn put(bytes: &mut Vec<u8>, numbers: &[f64]) {
    for number in numbers {
        bytes.extend_from_slice(&number.to_le_bytes());
    }
}

fn numbers_of(body: &BodySnapshot) -> [f64; NUMBERS_PER_BODY] {
    let mut numbers = [0.0; NUMBERS_PER_BODY];
    numbers[0..3].copy_from_slice(&body.location.to_array());
    numbers[3..7].copy_from_slice(&body.orientation.to_array());
    numbers[7..10].copy_from_slice(&body.velocity.to_array());
    numbers[10..13].copy_from_slice(&body.angular_velocity.to_array());
    numbers[13..16].copy_from_slice(&body.force.to_array());
    numbers
}

#[allow(clippy::cast_possible_truncation, reason = "the check of a scene limits the number of bodies")]
fn u32_of(count: usize) -> u32 {
    count as u32
}

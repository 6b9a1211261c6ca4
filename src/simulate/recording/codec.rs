//! Moments as bytes: what has not changed since the moment before takes none.
//!
//! A page is a sequence of moments. Each is, in little-endian numbers:
//!
//! | what | type |
//! | --- | --- |
//! | the number of the frame, or 2³² − 1 between frames | `u32` |
//! | time; kinetic, potential, total energy; drift; linear momentum; angular momentum; the accounts | `f64` each |
//! | the number of runs, and of each run: a mask, and for how many bodies that holds | `u32`; `u8`, `u32` |
//! | of each body, the numbers that its mask names | `f64` each |
//! | where there are joints: runs of masks, and numbers, in the same way | |
//! | where impacts are counted: runs of masks, and counts, in the same way | |
//! | there as well: the number of contacts, and of each two bodies, place, normal, force, friction | `u32`; `f64` |
//! | there as well: the number of impacts since the moment before, and of each two bodies, time, place, normal, impulse, energy | `u32`; `f64` |
//!
//! A bit of a mask says that a column has changed: location, orientation, velocity, angular velocity, force; of a
//! joint, force and torque. Before the first moment of a page, all numbers are those of a body at rest at the origin, and of a joint
//! that does nothing.

use std::io;

use glam::{DQuat, DVec3};

use super::super::ImpactCounts;
use super::super::simulation::Entry;
use super::events::{
    CONTACT_NUMBERS, IMPACT_NUMBERS, contact_numbers, contact_of, impact_numbers, impact_of,
};
use crate::dynamics::{Accounts, Balance, BodySnapshot, Reaction, Snapshot};
use crate::scene::Scene;

/// The numbers before the bodies.
const HEAD: usize = 11 + Accounts::NAMES.len();
/// The numbers of a body.
const NUMBERS: usize = 16;
/// Where each column of a body begins, and after the last, where it ends.
const COLUMNS: [usize; 6] = [0, 3, 7, 10, 13, NUMBERS];
/// The mask of a body that is not there.
const ABSENT: u8 = 0x80;
/// The number that stands for no frame.
const NO_FRAME: u32 = u32::MAX;

const AT_REST: [f64; NUMBERS] = {
    let mut numbers = [0.0; NUMBERS];
    numbers[6] = 1.0;
    numbers
};

/// Where each column of a joint begins, and after the last, where it ends.
const JOINT_COLUMNS: [usize; 3] = [0, 3, JOINT_NUMBERS];
/// The numbers of a joint.
const JOINT_NUMBERS: usize = 6;

/// Where the one column of a count begins and ends.
const COUNT_COLUMNS: [usize; 2] = [0, 1];

/// How many bodies and joints a run has, and how many numbers count its impacts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    /// The number of bodies.
    pub bodies: usize,
    /// The number of joints.
    pub joints: usize,
    /// The number of counts of impacts; 0 without contacts.
    pub impacts: usize,
}

impl Counts {
    /// Those of a scene.
    pub fn of(scene: &Scene) -> Counts {
        Counts { bodies: scene.bodies.len(), joints: scene.joints.len(), impacts: ImpactCounts::size(scene) }
    }
}

/// Turns moments into bytes, one after another.
pub(super) struct Encoder {
    last: Vec<[f64; NUMBERS]>,
    joints: Vec<[f64; JOINT_NUMBERS]>,
    impacts: Vec<f64>,
    masks: Vec<u8>,
}

impl Encoder {
    /// For so many bodies and joints.
    pub(super) fn new(Counts { bodies, joints, impacts }: Counts) -> Encoder {
        Encoder {
            last: vec![AT_REST; bodies],
            joints: vec![[0.0; JOINT_NUMBERS]; joints],
            impacts: vec![0.0; impacts],
            masks: Vec::new(),
        }
    }

    /// A new page begins: it can be read without those before it.
    pub(super) fn begin_page(&mut self) {
        self.last.fill(AT_REST);
        self.joints.fill([0.0; JOINT_NUMBERS]);
        self.impacts.fill(0.0);
    }

    /// Appends a moment.
    pub(super) fn encode(&mut self, entry: &Entry, bytes: &mut Vec<u8>) {
        let Self { last, joints, masks, .. } = self;
        let Entry { frame, snapshot, .. } = entry;
        let number = frame.and_then(|frame| u32::try_from(frame).ok()).unwrap_or(NO_FRAME);
        bytes.extend_from_slice(&number.to_le_bytes());
        put(bytes, &[snapshot.time]);
        let Balance { kinetic, potential, total, drift, linear_momentum, angular_momentum, accounts } =
            snapshot.balance;
        put(bytes, &[kinetic, potential, total, drift]);
        put(bytes, &linear_momentum.to_array());
        put(bytes, &angular_momentum.to_array());
        put(bytes, &accounts.to_array());

        masks.clear();
        masks.resize(last.len(), ABSENT);
        let start = bytes.len();
        for body in &snapshot.bodies {
            let numbers = numbers_of(body);
            let last = &mut last[body.id];
            masks[body.id] = put_changed(bytes, &COLUMNS, &numbers, last);
            *last = numbers;
        }
        put_runs(bytes, start, masks);
        if !joints.is_empty() {
            self.encode_joints(snapshot, bytes);
        }
        if !self.impacts.is_empty() {
            self.encode_contacts(entry, bytes);
        }
    }

    fn encode_joints(&mut self, snapshot: &Snapshot, bytes: &mut Vec<u8>) {
        let Self { joints, masks, .. } = self;
        masks.clear();
        let start = bytes.len();
        // What has no reaction does nothing.
        let reactions = snapshot.reactions.iter().copied().chain(std::iter::repeat(Reaction::default()));
        for (last, Reaction { force, torque }) in joints.iter_mut().zip(reactions) {
            let numbers = [force.x, force.y, force.z, torque.x, torque.y, torque.z];
            masks.push(put_changed(bytes, &JOINT_COLUMNS, &numbers, last));
            *last = numbers;
        }
        put_runs(bytes, start, masks);
    }

    /// The counts of impacts, the contacts of the moment, and the impacts since the one before.
    fn encode_contacts(&mut self, entry: &Entry, bytes: &mut Vec<u8>) {
        let Self { impacts, masks, .. } = self;
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
    }
}

/// Appends the columns of some numbers that have changed; a mask that names them.
fn put_changed(bytes: &mut Vec<u8>, columns: &[usize], numbers: &[f64], last: &[f64]) -> u8 {
    let mut mask = 0;
    for (column, range) in columns.windows(2).enumerate() {
        let (new, old) = (&numbers[range[0]..range[1]], &last[range[0]..range[1]]);
        // By their bits: -0 is not 0.
        if new.iter().zip(old).any(|(new, old)| new.to_bits() != old.to_bits()) {
            mask |= 1 << column;
            put(bytes, new);
        }
    }
    mask
}

/// Puts the runs of some masks at a place.
fn put_runs(bytes: &mut Vec<u8>, start: usize, masks: &[u8]) {
    let mut runs = Vec::new();
    for run in masks.chunk_by(|a, b| a == b) {
        runs.push(run[0]);
        runs.extend_from_slice(&u32_of(run.len()).to_le_bytes());
    }
    let count = u32_of(runs.len() / 5).to_le_bytes();
    bytes.splice(start..start, count.into_iter().chain(runs));
}

/// Reads a page from its beginning on.
#[derive(Default)]
pub(super) struct Decoder {
    last: Vec<[f64; NUMBERS]>,
    joints: Vec<[f64; JOINT_NUMBERS]>,
    impacts: Vec<f64>,
    at: usize,
}

impl Decoder {
    /// For so many bodies and joints, at the beginning of a page.
    pub(super) fn new(Counts { bodies, joints, impacts }: Counts) -> Decoder {
        Decoder {
            last: vec![AT_REST; bodies],
            joints: vec![[0.0; JOINT_NUMBERS]; joints],
            impacts: vec![0.0; impacts],
            at: 0,
        }
    }

    /// Goes back to the beginning of a page, of this or another recording of so many.
    pub(super) fn begin_page(&mut self) {
        self.last.fill(AT_REST);
        self.joints.fill([0.0; JOINT_NUMBERS]);
        self.impacts.fill(0.0);
        self.at = 0;
    }

    /// The next moment.
    pub(super) fn decode(&mut self, page: &[u8]) -> io::Result<Entry> {
        let Parts { head, bodies: (runs, mut values), joints, counts, contacts, impacts } =
            parts(page, &mut self.at, (self.joints.len(), self.impacts.len()))?;
        let mut bodies = Vec::with_capacity(self.last.len());
        let mut id = 0;
        for (mask, count) in runs {
            let ids = id..id + count;
            id += count;
            if mask == ABSENT {
                continue;
            }
            for (id, last) in ids.clone().zip(self.last.get_mut(ids).ok_or_else(damaged)?) {
                values = take_changed(values, mask, &COLUMNS, last)?;
                bodies.push(body_of(id, last));
            }
        }
        let (runs, mut values) = joints;
        let mut next = 0;
        for (mask, count) in runs {
            let them = self.joints.get_mut(next..next + count).ok_or_else(damaged)?;
            next += count;
            for last in them {
                values = take_changed(values, mask, &JOINT_COLUMNS, last)?;
            }
        }
        let (runs, mut values) = counts;
        let mut next = 0;
        for (mask, count) in runs {
            for last in self.impacts.get_mut(next..next + count).ok_or_else(damaged)? {
                values = take_changed(values, mask, &COUNT_COLUMNS, std::slice::from_mut(last))?;
            }
            next += count;
        }
        let reaction = |n: &[f64; JOINT_NUMBERS]| Reaction {
            force: DVec3::new(n[0], n[1], n[2]),
            torque: DVec3::new(n[3], n[4], n[5]),
        };
        let mut entry = head.entry(bodies, self.joints.iter().map(reaction).collect());
        entry.snapshot.contacts = numbers_in(contacts, contact_of)?;
        entry.impacts = numbers_in(impacts, impact_of)?;
        entry.counts = ImpactCounts(self.impacts.clone());
        Ok(entry)
    }

    /// Passes the next moment, and keeps only what is of one body; whether it is there. What is known of others, of joints and
    /// of contacts is lost.
    pub(super) fn decode_one(&mut self, page: &[u8], wanted: usize) -> io::Result<(Entry, bool)> {
        let Parts { head, bodies: (runs, mut values), .. } =
            parts(page, &mut self.at, (self.joints.len(), self.impacts.len()))?;
        let (mut id, mut found) = (0, false);
        for (mask, count) in runs {
            if mask != ABSENT && (id..id + count).contains(&wanted) {
                let skipped = values.get(8 * width(mask, &COLUMNS) * (wanted - id)..).ok_or_else(damaged)?;
                let last = self.last.get_mut(wanted).ok_or_else(damaged)?;
                take_changed(skipped, mask, &COLUMNS, last)?;
                found = true;
                break;
            }
            values = values.get(8 * width(mask, &COLUMNS) * count..).ok_or_else(damaged)?;
            id += count;
        }
        let body = if found { vec![body_of(wanted, &self.last[wanted])] } else { Vec::new() };
        Ok((head.entry(body, Vec::new()), found))
    }
}

/// What stands before the bodies of a moment.
struct Head {
    frame: Option<usize>,
    numbers: [f64; HEAD],
}

impl Head {
    fn entry(self, bodies: Vec<BodySnapshot>, reactions: Vec<Reaction>) -> Entry {
        let n = &self.numbers;
        let balance = Balance {
            kinetic: n[1],
            potential: n[2],
            total: n[3],
            drift: n[4],
            linear_momentum: DVec3::new(n[5], n[6], n[7]),
            angular_momentum: DVec3::new(n[8], n[9], n[10]),
            accounts: Accounts::from_array(std::array::from_fn(|i| n[11 + i])),
        };
        Entry {
            frame: self.frame,
            snapshot: Snapshot { time: n[0], bodies, reactions, contacts: Vec::new(), balance },
            impacts: Vec::new(),
            counts: ImpactCounts::default(),
        }
    }
}

/// A mask, and for how many bodies it holds.
type Run = (u8, usize);

/// A moment in a page: of bodies, joints and counts of impacts, the runs and the bytes of the values; of contacts and impacts,
/// the bytes.
struct Parts<'a> {
    head: Head,
    bodies: (Vec<Run>, &'a [u8]),
    joints: (Vec<Run>, &'a [u8]),
    counts: (Vec<Run>, &'a [u8]),
    contacts: &'a [u8],
    impacts: &'a [u8],
}

/// The parts of the moment at a place of a page of a run with so many joints and counts of impacts. The place becomes that of the
/// moment after it.
fn parts<'a>(page: &'a [u8], at: &mut usize, (joints, counts): (usize, usize)) -> io::Result<Parts<'a>> {
    let rest = page.get(*at..).ok_or_else(damaged)?;
    let (number, rest) = rest.split_first_chunk::<4>().ok_or_else(damaged)?;
    let number = u32::from_le_bytes(*number);
    let mut numbers = [0.0; HEAD];
    let rest = take(rest, &mut numbers)?;
    let (bodies, mut rest) = runs_of(rest, &COLUMNS)?;
    let mut of_joints = (Vec::new(), &rest[..0]);
    if joints > 0 {
        (of_joints, rest) = runs_of(rest, &JOINT_COLUMNS)?;
    }
    let mut of_counts = (Vec::new(), &rest[..0]);
    let [mut contacts, mut impacts] = [&rest[..0]; 2];
    if counts > 0 {
        (of_counts, rest) = runs_of(rest, &COUNT_COLUMNS)?;
        (contacts, rest) = list(rest, CONTACT_NUMBERS)?;
        (impacts, rest) = list(rest, IMPACT_NUMBERS)?;
    }
    *at = page.len() - rest.len();
    let frame = (number != NO_FRAME).then_some(number as usize);
    let head = Head { frame, numbers };
    Ok(Parts { head, bodies, joints: of_joints, counts: of_counts, contacts, impacts })
}

/// The bytes of a list of things of so many numbers each, and what is behind them.
fn list(bytes: &[u8], numbers: usize) -> io::Result<(&[u8], &[u8])> {
    let (count, rest) = bytes.split_first_chunk::<4>().ok_or_else(damaged)?;
    let count = u32::from_le_bytes(*count) as usize;
    rest.split_at_checked(count.saturating_mul(8 * numbers)).ok_or_else(damaged)
}

/// The things of a list, each of so many numbers.
fn numbers_in<T, const N: usize>(bytes: &[u8], of: impl Fn(&[f64; N]) -> T) -> io::Result<Vec<T>> {
    let thing = |bytes: &[u8]| {
        let mut numbers = [0.0; N];
        take(bytes, &mut numbers)?;
        Ok(of(&numbers))
    };
    bytes.chunks(8 * N).map(thing).collect()
}

/// Runs, the bytes of their values, and what is behind them.
type Runs<'a> = ((Vec<Run>, &'a [u8]), &'a [u8]);

/// Reads runs of masks that name columns.
fn runs_of<'a>(bytes: &'a [u8], columns: &[usize]) -> io::Result<Runs<'a>> {
    let (count, rest) = bytes.split_first_chunk::<4>().ok_or_else(damaged)?;
    let count = u32::from_le_bytes(*count) as usize;
    let (runs, values) = rest.split_at_checked(count.saturating_mul(5)).ok_or_else(damaged)?;
    let run =
        |bytes: &[u8]| (bytes[0], u32::from_le_bytes([bytes[1], bytes[2], bytes[3], bytes[4]]) as usize);
    let runs: Vec<Run> = runs.chunks_exact(5).map(run).collect();
    let numbers = runs
        .iter()
        .fold(0usize, |sum, (mask, count)| sum.saturating_add(width(*mask, columns).saturating_mul(*count)));
    let (values, rest) = values.split_at_checked(numbers.saturating_mul(8)).ok_or_else(damaged)?;
    Ok(((runs, values), rest))
}

/// How many numbers there are with this mask.
fn width(mask: u8, columns: &[usize]) -> usize {
    if mask == ABSENT {
        return 0;
    }
    columns
        .windows(2)
        .enumerate()
        .filter(|(column, _)| mask & (1 << column) != 0)
        .map(|(_, r)| r[1] - r[0])
        .sum()
}

/// Reads the columns that a mask names, and gives what is behind them.
fn take_changed<'a>(
    mut values: &'a [u8],
    mask: u8,
    columns: &[usize],
    last: &mut [f64],
) -> io::Result<&'a [u8]> {
    for (column, range) in columns.windows(2).enumerate() {
        if mask & (1 << column) != 0 {
            values = take(values, &mut last[range[0]..range[1]])?;
        }
    }
    Ok(values)
}

fn put(bytes: &mut Vec<u8>, numbers: &[f64]) {
    for number in numbers {
        bytes.extend_from_slice(&number.to_le_bytes());
    }
}

/// Reads numbers, and gives what is behind them.
fn take<'a>(bytes: &'a [u8], numbers: &mut [f64]) -> io::Result<&'a [u8]> {
    let (mine, rest) = bytes.split_at_checked(8 * numbers.len()).ok_or_else(damaged)?;
    for (number, chunk) in numbers.iter_mut().zip(mine.as_chunks::<8>().0) {
        *number = f64::from_le_bytes(*chunk);
    }
    Ok(rest)
}

fn numbers_of(body: &BodySnapshot) -> [f64; NUMBERS] {
    let mut numbers = [0.0; NUMBERS];
    numbers[0..3].copy_from_slice(&body.location.to_array());
    numbers[3..7].copy_from_slice(&body.orientation.to_array());
    numbers[7..10].copy_from_slice(&body.velocity.to_array());
    numbers[10..13].copy_from_slice(&body.angular_velocity.to_array());
    numbers[13..16].copy_from_slice(&body.force.to_array());
    numbers
}

fn body_of(id: usize, n: &[f64; NUMBERS]) -> BodySnapshot {
    BodySnapshot {
        id,
        location: DVec3::new(n[0], n[1], n[2]),
        orientation: DQuat::from_xyzw(n[3], n[4], n[5], n[6]),
        velocity: DVec3::new(n[7], n[8], n[9]),
        angular_velocity: DVec3::new(n[10], n[11], n[12]),
        force: DVec3::new(n[13], n[14], n[15]),
    }
}

#[allow(clippy::cast_possible_truncation, reason = "the check of a scene limits the number of bodies")]
fn u32_of(count: usize) -> u32 {
    count as u32
}

pub(super) fn damaged() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "the recording of the run is damaged")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{ContactSnapshot, Impact};

    const COUNTS: Counts = Counts { bodies: 3, joints: 2, impacts: 5 };

    fn entry(time: f64, bodies: &[(usize, f64)]) -> Entry {
        let body = |&(id, x): &(usize, f64)| BodySnapshot {
            id,
            location: DVec3::new(x, -0.0, 1.0),
            orientation: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            force: DVec3::new(0.0, x, 0.0),
        };
        let balance = Balance {
            kinetic: 1.0,
            potential: 2.0,
            total: 3.0,
            drift: 4.0,
            linear_momentum: DVec3::X,
            angular_momentum: DVec3::Y,
            accounts: Accounts { work: 5.0, motors: 6.0, limits: -7.0, impacts: -8.0, friction: -9.0 },
        };
        let frame = (time > 1.5).then_some(7);
        let reactions = vec![
            Reaction::default(),
            Reaction { force: DVec3::new(0.0, -0.0, 3.0), torque: DVec3::splat((time - 1.5).max(0.0)) },
        ];
        let vector = |n: f64| DVec3::new(n, -0.0, time);
        let (place, normal) = (vector(1.0), vector(2.0));
        let contact =
            ContactSnapshot { bodies: [1, 2], place, normal, force: vector(3.0), friction: vector(4.0) };
        let impact = Impact { time, bodies: [0, 3], place, normal, impulse: vector(5.0), energy: 6.0 };
        Entry {
            frame,
            snapshot: Snapshot {
                time,
                bodies: bodies.iter().map(body).collect(),
                reactions,
                contacts: vec![contact; usize::from(time > 0.5)],
                balance,
            },
            impacts: vec![impact; usize::from(time > 1.5) * 2],
            counts: ImpactCounts(vec![time.floor(), 0.0, -0.0, 7.0, time]),
        }
    }

    /// Bodies come and go; -0 stays -0; what stays as it is takes no bytes but those of its run.
    #[test]
    fn moments_are_read_as_they_were_written() {
        let entries = [
            entry(0.0, &[(0, 1.0), (2, 2.0)]),
            entry(1.0, &[(0, 1.0), (2, 2.0)]),
            entry(2.0, &[(1, 3.0), (2, 4.0)]),
            entry(3.0, &[]),
        ];
        let (mut encoder, mut page, mut sizes) = (Encoder::new(COUNTS), Vec::new(), Vec::new());
        for entry in &entries {
            let before = page.len();
            encoder.encode(entry, &mut page);
            sizes.push(page.len() - before);
        }
        let head = 4 + 8 * HEAD + 4;
        let of_counts = 4 + 3 * 5 + 2 * 8;
        let of_contacts = 4 + 8 * CONTACT_NUMBERS + 4;
        let bodies_and_joints = 3 * 5 + 4 + 5;
        assert_eq!(
            sizes[1],
            head + bodies_and_joints + of_counts + of_contacts,
            "present, absent, present; two joints; of five counts, the first and the last; one contact"
        );
        let mut decoder = Decoder::new(COUNTS);
        for entry in &entries {
            let found = decoder.decode(&page).unwrap();
            assert_eq!(found, *entry);
            for (a, b) in found.snapshot.bodies.iter().zip(&entry.snapshot.bodies) {
                assert_eq!(a.location.y.to_bits(), b.location.y.to_bits());
            }
        }
        assert!(decoder.decode(&page).is_err(), "after the end");
        let mut decoder = Decoder::new(COUNTS);
        for entry in &entries {
            let (found, is_there) = decoder.decode_one(&page, 2).unwrap();
            let expected: Vec<_> =
                entry.snapshot.bodies.iter().filter(|body| body.id == 2).copied().collect();
            assert_eq!((found.snapshot.bodies, is_there), (expected.clone(), !expected.is_empty()));
        }
    }

    #[test]
    fn what_is_cut_or_changed_never_panics() {
        let mut page = Vec::new();
        let mut encoder = Encoder::new(COUNTS);
        for entry in [entry(0.0, &[(0, 1.0), (2, 2.0)]), entry(2.0, &[(1, 3.0)])] {
            encoder.encode(&entry, &mut page);
        }
        for cut in 0..page.len() {
            let mut decoder = Decoder::new(COUNTS);
            while decoder.decode(&page[..cut]).is_ok() {}
        }
        for at in 0..page.len() {
            let mut changed = page.clone();
            changed[at] ^= 0xff;
            for wanted in 0..3 {
                let mut decoder = Decoder::new(COUNTS);
                (0..2).for_each(|_| drop(decoder.decode_one(&changed, wanted)));
            }
            let mut decoder = Decoder::new(COUNTS);
            (0..2).for_each(|_| drop(decoder.decode(&changed)));
        }
    }
}

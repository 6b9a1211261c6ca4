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
//!
//! A bit of a mask says that a column has changed: location, orientation, velocity, angular velocity, force. Before the
//! first moment of a page, all numbers are those of a body at rest at the origin.

use std::io;

use glam::{DQuat, DVec3};

use super::super::simulation::Entry;
use crate::dynamics::{Accounts, Balance, BodySnapshot, Snapshot};

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

/// Turns moments into bytes, one after another.
pub(super) struct Encoder {
    last: Vec<[f64; NUMBERS]>,
    masks: Vec<u8>,
}

impl Encoder {
    /// For so many bodies.
    pub(super) fn new(bodies: usize) -> Encoder {
        Encoder { last: vec![AT_REST; bodies], masks: Vec::new() }
    }

    /// A new page begins: it can be read without those before it.
    pub(super) fn begin_page(&mut self) {
        self.last.fill(AT_REST);
    }

    /// Appends a moment.
    pub(super) fn encode(&mut self, frame: Option<usize>, snapshot: &Snapshot, bytes: &mut Vec<u8>) {
        let Self { last, masks } = self;
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
            let mut mask = 0;
            for (column, range) in COLUMNS.windows(2).enumerate() {
                let (new, old) = (&numbers[range[0]..range[1]], &last[range[0]..range[1]]);
                // By their bits: -0 is not 0.
                if new.iter().zip(old).any(|(new, old)| new.to_bits() != old.to_bits()) {
                    mask |= 1 << column;
                    put(bytes, new);
                }
            }
            masks[body.id] = mask;
            *last = numbers;
        }
        let mut runs = Vec::new();
        for run in masks.chunk_by(|a, b| a == b) {
            runs.push(run[0]);
            runs.extend_from_slice(&u32_of(run.len()).to_le_bytes());
        }
        let count = u32_of(runs.len() / 5).to_le_bytes();
        bytes.splice(start..start, count.into_iter().chain(runs));
    }
}

/// Reads a page from its beginning on.
#[derive(Default)]
pub(super) struct Decoder {
    last: Vec<[f64; NUMBERS]>,
    at: usize,
}

impl Decoder {
    /// For so many bodies, at the beginning of a page.
    pub(super) fn new(bodies: usize) -> Decoder {
        Decoder { last: vec![AT_REST; bodies], at: 0 }
    }

    /// Goes back to the beginning of a page, of this or another recording of so many bodies.
    pub(super) fn begin_page(&mut self) {
        self.last.fill(AT_REST);
        self.at = 0;
    }

    /// The next moment.
    pub(super) fn decode(&mut self, page: &[u8]) -> io::Result<Entry> {
        let (head, runs, mut values) = parts(page, &mut self.at)?;
        let mut bodies = Vec::with_capacity(self.last.len());
        let mut id = 0;
        for (mask, count) in runs {
            let ids = id..id + count;
            id += count;
            if mask == ABSENT {
                continue;
            }
            for (id, last) in ids.clone().zip(self.last.get_mut(ids).ok_or_else(damaged)?) {
                for (column, range) in COLUMNS.windows(2).enumerate() {
                    if mask & (1 << column) != 0 {
                        values = take(values, &mut last[range[0]..range[1]])?;
                    }
                }
                bodies.push(body_of(id, last));
            }
        }
        Ok(head.entry(bodies))
    }

    /// Passes the next moment, and keeps only what is of one body; whether it is there. What is known of others is lost.
    pub(super) fn decode_one(&mut self, page: &[u8], wanted: usize) -> io::Result<(Entry, bool)> {
        let (head, runs, mut values) = parts(page, &mut self.at)?;
        let (mut id, mut found) = (0, false);
        for (mask, count) in runs {
            if mask != ABSENT && (id..id + count).contains(&wanted) {
                let skipped = values.get(8 * width(mask) * (wanted - id)..).ok_or_else(damaged)?;
                let last = self.last.get_mut(wanted).ok_or_else(damaged)?;
                values = skipped;
                for (column, range) in COLUMNS.windows(2).enumerate() {
                    if mask & (1 << column) != 0 {
                        values = take(values, &mut last[range[0]..range[1]])?;
                    }
                }
                found = true;
                break;
            }
            values = values.get(8 * width(mask) * count..).ok_or_else(damaged)?;
            id += count;
        }
        let body = if found { vec![body_of(wanted, &self.last[wanted])] } else { Vec::new() };
        Ok((head.entry(body), found))
    }
}

/// What stands before the bodies of a moment.
struct Head {
    frame: Option<usize>,
    numbers: [f64; HEAD],
}

impl Head {
    fn entry(self, bodies: Vec<BodySnapshot>) -> Entry {
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
        Entry { frame: self.frame, snapshot: Snapshot { time: n[0], bodies, balance } }
    }
}

/// A mask, and for how many bodies it holds.
type Run = (u8, usize);

/// The parts of the moment at a place of a page: its head, its runs, and the bytes of its values. The place becomes that
/// of the moment after it.
fn parts<'a>(page: &'a [u8], at: &mut usize) -> io::Result<(Head, Vec<Run>, &'a [u8])> {
    let rest = page.get(*at..).ok_or_else(damaged)?;
    let (number, rest) = rest.split_first_chunk::<4>().ok_or_else(damaged)?;
    let number = u32::from_le_bytes(*number);
    let mut numbers = [0.0; HEAD];
    let rest = take(rest, &mut numbers)?;
    let (count, rest) = rest.split_first_chunk::<4>().ok_or_else(damaged)?;
    let count = u32::from_le_bytes(*count) as usize;
    let (runs, values) = rest.split_at_checked(count.saturating_mul(5)).ok_or_else(damaged)?;
    let run =
        |bytes: &[u8]| (bytes[0], u32::from_le_bytes([bytes[1], bytes[2], bytes[3], bytes[4]]) as usize);
    let runs: Vec<Run> = runs.chunks_exact(5).map(run).collect();
    let numbers_of_bodies = runs
        .iter()
        .fold(0usize, |sum, (mask, count)| sum.saturating_add(width(*mask).saturating_mul(*count)));
    let values = values.get(..numbers_of_bodies.saturating_mul(8)).ok_or_else(damaged)?;
    *at = page.len() - rest.len() + 5 * count + values.len();
    let frame = (number != NO_FRAME).then_some(number as usize);
    Ok((Head { frame, numbers }, runs, values))
}

/// How many numbers a body with this mask has.
fn width(mask: u8) -> usize {
    if mask == ABSENT {
        return 0;
    }
    COLUMNS
        .windows(2)
        .enumerate()
        .filter(|(column, _)| mask & (1 << column) != 0)
        .map(|(_, r)| r[1] - r[0])
        .sum()
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
            accounts: Accounts { work: 5.0, motors: 6.0, limits: -7.0 },
        };
        let frame = (time > 1.5).then_some(7);
        Entry { frame, snapshot: Snapshot { time, bodies: bodies.iter().map(body).collect(), balance } }
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
        let (mut encoder, mut page, mut sizes) = (Encoder::new(3), Vec::new(), Vec::new());
        for Entry { frame, snapshot } in &entries {
            let before = page.len();
            encoder.encode(*frame, snapshot, &mut page);
            sizes.push(page.len() - before);
        }
        let head = 4 + 8 * HEAD + 4;
        assert_eq!(sizes[1], head + 3 * 5, "present, absent, present, and no number");
        let mut decoder = Decoder::new(3);
        for entry in &entries {
            let found = decoder.decode(&page).unwrap();
            assert_eq!(found, *entry);
            for (a, b) in found.snapshot.bodies.iter().zip(&entry.snapshot.bodies) {
                assert_eq!(a.location.y.to_bits(), b.location.y.to_bits());
            }
        }
        assert!(decoder.decode(&page).is_err(), "after the end");
        let mut decoder = Decoder::new(3);
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
        let mut encoder = Encoder::new(3);
        for Entry { frame, snapshot } in [entry(0.0, &[(0, 1.0), (2, 2.0)]), entry(2.0, &[(1, 3.0)])] {
            encoder.encode(frame, &snapshot, &mut page);
        }
        for cut in 0..page.len() {
            let mut decoder = Decoder::new(3);
            while decoder.decode(&page[..cut]).is_ok() {}
        }
        for at in 0..page.len() {
            let mut changed = page.clone();
            changed[at] ^= 0xff;
            for wanted in 0..3 {
                let mut decoder = Decoder::new(3);
                (0..2).for_each(|_| drop(decoder.decode_one(&changed, wanted)));
            }
            let mut decoder = Decoder::new(3);
            (0..2).for_each(|_| drop(decoder.decode(&changed)));
        }
    }
}

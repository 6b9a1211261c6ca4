//! Decodes bytes into moments. The bytes come from a file, so they are never trusted.

use std::io;

use glam::{DQuat, DVec3};

use super::super::super::ImpactCounts;
use super::super::super::simulation::Entry;
use super::super::events::{CONTACT_NUMBERS, IMPACT_NUMBERS, LAW_NUMBERS, contact_of, impact_of, law_of};
use super::last::Last;
use super::{
    ABSENT_BODY_MASK, BODY_COLUMNS, COUNT_COLUMNS, Counts, JOINT_COLUMNS, NO_FRAME, NUMBERS_PER_BODY,
    NUMBERS_PER_HEADER, NUMBERS_PER_JOINT, damaged,
};
use crate::physics::{Accounts, Balance, BodySnapshot, Reaction, Snapshot};

/// Decodes the moments of a page one after another, from the start of the page.
#[derive(Default)]
pub(in super::super) struct Decoder {
    last: Last,
    at: usize,
}

impl Decoder {
    /// Creates a decoder at the start of a page, for moments with these numbers of bodies, joints and impact counts.
    pub(in super::super) fn new(counts: Counts) -> Decoder {
        Decoder { last: Last::new(counts), at: 0 }
    }

    /// Restarts at the start of a page. The page may belong to another recording with the same numbers of bodies, joints and impact
    /// counts.
    pub(in super::super) fn begin_page(&mut self) {
        self.last.begin_page();
        self.at = 0;
    }

    /// Decodes the next moment of the page.
    pub(in super::super) fn decode(&mut self, page: &[u8]) -> io::Result<Entry> {
        let Parts { head, bodies: (runs, mut values), joints, counts, contacts, impacts, laws } =
            parts(page, &mut self.at, self.last.joints.len(), self.last.impacts.len())?;
        let mut bodies = Vec::with_capacity(self.last.bodies.len());
        let mut id = 0;
        for (mask, count) in runs {
            let ids = id..id + count;
            id += count;
            if mask == ABSENT_BODY_MASK {
                continue;
            }
            for (id, last) in ids.clone().zip(self.last.bodies.get_mut(ids).ok_or_else(damaged)?) {
                values = take_changed(values, mask, &BODY_COLUMNS, last)?;
                bodies.push(body_of(id, last));
            }
        }
        let (runs, mut values) = joints;
        let mut next = 0;
        for (mask, count) in runs {
            let them = self.last.joints.get_mut(next..next + count).ok_or_else(damaged)?;
            next += count;
            for last in them {
                values = take_changed(values, mask, &JOINT_COLUMNS, last)?;
            }
        }
        self.take_counts(counts)?;
        let reaction = |n: &[f64; NUMBERS_PER_JOINT]| Reaction {
            force: DVec3::new(n[0], n[1], n[2]),
            torque: DVec3::new(n[3], n[4], n[5]),
            motor: n[6],
        };
        let mut entry = head.entry(bodies, self.last.joints.iter().map(reaction).collect());
        entry.snapshot.angles = self.last.joints.iter().map(|numbers| numbers[7]).collect();
        entry.snapshot.contacts = numbers_in(contacts, contact_of)?;
        entry.impacts = numbers_in(impacts, impact_of)?;
        entry.snapshot.laws = numbers_in(laws, law_of)?;
        entry.counts = ImpactCounts(self.last.impacts.clone());
        Ok(entry)
    }

    fn take_counts(&mut self, (runs, mut values): (Vec<Run>, &[u8])) -> io::Result<()> {
        let mut next = 0;
        for (mask, count) in runs {
            for last in self.last.impacts.get_mut(next..next + count).ok_or_else(damaged)? {
                values = take_changed(values, mask, &COUNT_COLUMNS, std::slice::from_mut(last))?;
            }
            next += count;
        }
        Ok(())
    }

    /// Decodes only one body and the impact counts of the next moment. Returns the moment, and whether the body is present. Until the next
    /// page, the decoder cannot decode other bodies, joints and contacts.
    pub(in super::super) fn decode_one(&mut self, page: &[u8], wanted: usize) -> io::Result<(Entry, bool)> {
        let Parts { head, bodies: (runs, mut values), counts, .. } =
            parts(page, &mut self.at, self.last.joints.len(), self.last.impacts.len())?;
        let (mut id, mut found) = (0, false);
        for (mask, count) in runs {
            if mask != ABSENT_BODY_MASK && (id..id + count).contains(&wanted) {
                let skipped =
                    values.get(8 * width(mask, &BODY_COLUMNS) * (wanted - id)..).ok_or_else(damaged)?;
                let last = self.last.bodies.get_mut(wanted).ok_or_else(damaged)?;
                take_changed(skipped, mask, &BODY_COLUMNS, last)?;
                found = true;
                break;
            }
            values = values.get(8 * width(mask, &BODY_COLUMNS) * count..).ok_or_else(damaged)?;
            id += count;
        }
        let body = if found { vec![body_of(wanted, &self.last.bodies[wanted])] } else { Vec::new() };
        self.take_counts(counts)?;
        let mut entry = head.entry(body, Vec::new());
        entry.counts = ImpactCounts(self.last.impacts.clone());
        Ok((entry, found))
    }
}

/// The header of a moment: the values before the bodies.
struct Head {
    frame: Option<usize>,
    numbers: [f64; NUMBERS_PER_HEADER],
}

impl Head {
    fn entry(self, bodies: Vec<BodySnapshot>, reactions: Vec<Reaction>) -> Entry {
        let n = &self.numbers;
        let balance = Balance {
            kinetic: n[1],
            given_kinetic: n[2],
            potential: n[3],
            total: n[4],
            error: n[5],
            drift: n[6],
            linear_momentum: DVec3::new(n[7], n[8], n[9]),
            angular_momentum: DVec3::new(n[10], n[11], n[12]),
            accounts: Accounts::from_array(std::array::from_fn(|i| n[13 + i])),
        };
        Entry {
            frame: self.frame,
            snapshot: Snapshot {
                time: n[0],
                bodies,
                reactions,
                angles: Vec::new(),
                contacts: Vec::new(),
                penetration: n[NUMBERS_PER_HEADER - 1],
                laws: Vec::new(),
                balance,
            },
            impacts: Vec::new(),
            counts: ImpactCounts::default(),
        }
    }
}

/// A mask, and the number of consecutive bodies, joints or counts that it applies to.
type Run = (u8, usize);

/// The undecoded parts of a moment in a page. For bodies, joints and impact counts: the runs, and the bytes of their values. For contacts
/// and impacts: the bytes of the list.
struct Parts<'a> {
    head: Head,
    bodies: (Vec<Run>, &'a [u8]),
    joints: (Vec<Run>, &'a [u8]),
    counts: (Vec<Run>, &'a [u8]),
    contacts: &'a [u8],
    impacts: &'a [u8],
    laws: &'a [u8],
}

/// Splits the moment at offset `at` of a page into its parts. `joints` and `counts` are the numbers of joints and impact counts in each
/// moment. Moves the offset to the next moment.
fn parts<'a>(page: &'a [u8], at: &mut usize, joints: usize, counts: usize) -> io::Result<Parts<'a>> {
    let rest = page.get(*at..).ok_or_else(damaged)?;
    let (number, rest) = rest.split_first_chunk::<4>().ok_or_else(damaged)?;
    let number = u32::from_le_bytes(*number);
    let mut numbers = [0.0; NUMBERS_PER_HEADER];
    let rest = take(rest, &mut numbers)?;
    let (bodies, mut rest) = read_runs(rest, &BODY_COLUMNS)?;
    let mut of_joints = (Vec::new(), &rest[..0]);
    if joints > 0 {
        (of_joints, rest) = read_runs(rest, &JOINT_COLUMNS)?;
    }
    let mut of_counts = (Vec::new(), &rest[..0]);
    let [mut contacts, mut impacts, mut laws] = [&rest[..0]; 3];
    if counts > 0 {
        (of_counts, rest) = read_runs(rest, &COUNT_COLUMNS)?;
        (contacts, rest) = list(rest, CONTACT_NUMBERS)?;
        (impacts, rest) = list(rest, IMPACT_NUMBERS)?;
        (laws, rest) = list(rest, LAW_NUMBERS)?;
    }
    *at = page.len() - rest.len();
    let frame = (number != NO_FRAME).then_some(number as usize);
    let head = Head { frame, numbers };
    Ok(Parts { head, bodies, joints: of_joints, counts: of_counts, contacts, impacts, laws })
}

/// Splits bytes into the list at their start and the remaining bytes. Each item of the list consists of `numbers` values.
fn list(bytes: &[u8], numbers: usize) -> io::Result<(&[u8], &[u8])> {
    let (count, rest) = bytes.split_first_chunk::<4>().ok_or_else(damaged)?;
    let count = u32::from_le_bytes(*count) as usize;
    rest.split_at_checked(count.saturating_mul(8 * numbers)).ok_or_else(damaged)
}

/// Decodes the items of a list, each of N values.
fn numbers_in<T, const N: usize>(bytes: &[u8], of: impl Fn(&[f64; N]) -> T) -> io::Result<Vec<T>> {
    let thing = |bytes: &[u8]| {
        let mut numbers = [0.0; N];
        take(bytes, &mut numbers)?;
        Ok(of(&numbers))
    };
    bytes.chunks(8 * N).map(thing).collect()
}

/// A list of runs with the bytes of their values, and the remaining bytes.
type Runs<'a> = ((Vec<Run>, &'a [u8]), &'a [u8]);

/// Reads a list of runs. Their masks select from the given columns.
fn read_runs<'a>(bytes: &'a [u8], columns: &[usize]) -> io::Result<Runs<'a>> {
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

/// The number of values that a mask selects for a body, joint or count.
fn width(mask: u8, columns: &[usize]) -> usize {
    if mask == ABSENT_BODY_MASK {
        return 0;
    }
    columns
        .windows(2)
        .enumerate()
        .filter(|(column, _)| mask & (1 << column) != 0)
        .map(|(_, r)| r[1] - r[0])
        .sum()
}

/// Reads the values of the columns that a mask selects into `last`. Returns the remaining bytes.
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

/// Reads values into `numbers`. Returns the remaining bytes.
fn take<'a>(bytes: &'a [u8], numbers: &mut [f64]) -> io::Result<&'a [u8]> {
    let (mine, rest) = bytes.split_at_checked(8 * numbers.len()).ok_or_else(damaged)?;
    for (number, chunk) in numbers.iter_mut().zip(mine.as_chunks::<8>().0) {
        *number = f64::from_le_bytes(*chunk);
    }
    Ok(rest)
}

fn body_of(id: usize, n: &[f64; NUMBERS_PER_BODY]) -> BodySnapshot {
    BodySnapshot {
        id,
        location: DVec3::new(n[0], n[1], n[2]),
        orientation: DQuat::from_xyzw(n[3], n[4], n[5], n[6]),
        velocity: DVec3::new(n[7], n[8], n[9]),
        angular_velocity: DVec3::new(n[10], n[11], n[12]),
        force: DVec3::new(n[13], n[14], n[15]),
    }
}

//! A grid of cells that finds all points near each other in linear time.

use glam::DVec3;

/// The largest number of cells along an axis. The key of a cell holds its cell number along each of the three axes.
const MAX_CELLS_PER_AXIS: f64 = 1_048_576.0;
/// The bits of a key for each axis. [`MAX_CELLS_PER_AXIS`] cells need one bit less; the extra bit leaves room for a border of cells on all
/// sides.
const KEY_BITS_PER_AXIS: u32 = 21;

/// Points sorted by cells. A cell is a box whose edges are at least as long as the reach, the largest distance of a pair of near points. So
/// all points within reach of a point are in the same cell or in one of the 26 cells around it. The keys of neighbouring cells along x are
/// consecutive, so the points of three such cells form one range.
///
/// Only cells with points take memory, so a single distant point costs nothing. The time is linear in the number of points, because a
/// radix sort orders the keys.
#[derive(Debug, Default)]
pub(super) struct Cells {
    /// The coordinates of the sorted points, m: one list for each axis.
    pub(super) at: [Vec<f64>; 3],
    /// The index that each sorted point has in the input.
    pub(super) number: Vec<u32>,
    keys: Vec<u64>,
    spare: (Vec<u64>, Vec<u32>),
}

/// The offsets (y, z) of the four neighboring rows of cells that are searched from each row. Together with the row itself, they cover each
/// pair of neighboring cells once.
const NEIGHBOR_ROW_OFFSETS: [(i64, i64); 4] = [(1, 0), (-1, 1), (0, 1), (1, 1)];

impl Cells {
    /// Sorts points into cells whose edges are at least `reach`, m.
    #[allow(clippy::cast_possible_truncation, reason = "there are far fewer than 2^32 bodies")]
    pub(super) fn sort(&mut self, points: &[DVec3], reach: f64) {
        let finite = || points.iter().filter(|point| point.is_finite());
        let low = finite().fold(DVec3::INFINITY, |low, point| low.min(*point));
        let high = finite().fold(DVec3::NEG_INFINITY, |high, point| high.max(*point));
        let edge = ((high - low) / (MAX_CELLS_PER_AXIS - 2.0)).max(DVec3::splat(reach));
        self.keys.clear();
        self.keys.extend(points.iter().map(|point| key((*point - low) / edge)));
        self.number.clear();
        self.number.extend(0..points.len() as u32);
        self.sort_keys();
        for (axis, at) in self.at.iter_mut().enumerate() {
            at.clear();
            at.extend(self.number.iter().map(|&number| points[number as usize][axis]));
        }
    }

    /// Sorts the keys and the point indices by a radix sort, eleven bits at a time, lowest bits first. Points in the same cell keep their
    /// order.
    #[allow(clippy::cast_possible_truncation, reason = "a digit is small, and so is the number of points")]
    fn sort_keys(&mut self) {
        /// The number of bits of a key by which one pass sorts.
        const DIGIT_BITS: u32 = 11;
        let used = self.keys.iter().fold(0, |used, key| used | key);
        let (keys, numbers) = &mut self.spare;
        keys.resize(self.keys.len(), 0);
        numbers.resize(self.keys.len(), 0);
        let mut shift = 0;
        while shift < u64::BITS && used >> shift != 0 {
            let digit = |key: u64| (key >> shift) as usize & ((1 << DIGIT_BITS) - 1);
            let mut begin = [0_u32; 1 << DIGIT_BITS];
            self.keys.iter().for_each(|key| begin[digit(*key)] += 1);
            let mut sum = 0;
            for count in &mut begin {
                (*count, sum) = (sum, sum + *count);
            }
            for (key, number) in self.keys.iter().zip(&self.number) {
                let place = &mut begin[digit(*key)];
                (keys[*place as usize], numbers[*place as usize]) = (*key, *number);
                *place += 1;
            }
            std::mem::swap(&mut self.keys, keys);
            std::mem::swap(&mut self.number, numbers);
            shift += DIGIT_BITS;
        }
    }

    /// Calls `see` with each sorted point and a range of later sorted points: once for the point's own row of cells, and at most once for
    /// each of the four rows ahead. The ranges contain all later points within reach, so each pair of near points occurs exactly once.
    pub(super) fn each(&self, mut see: impl FnMut(usize, std::ops::Range<usize>)) {
        let count = self.keys.len();
        // For each of the four rows, the search continues at the position that the previous cell has reached, because cells and their
        // neighbours come in rising order.
        let mut from = [0; NEIGHBOR_ROW_OFFSETS.len()];
        let mut first = 0;
        while first < count {
            let key = self.keys[first];
            let same = self.keys[first..].iter().take_while(|other| **other == key).count();
            let next = self.keys[first + same..].iter().take_while(|other| **other == key + 1).count();
            let end = first + same;
            for point in first..end {
                see(point, point + 1..end + next);
            }
            for (from, (y, z)) in from.iter_mut().zip(NEIGHBOR_ROW_OFFSETS) {
                let row = key.wrapping_add_signed((y << KEY_BITS_PER_AXIS) + (z << (2 * KEY_BITS_PER_AXIS)));
                while *from < count && self.keys[*from] < row - 1 {
                    *from += 1;
                }
                let near = self.keys[*from..].iter().take_while(|other| **other <= row + 1).count();
                if near > 0 {
                    (first..end).for_each(|point| see(point, *from..*from + near));
                }
            }
            first = end;
        }
    }
}

/// Returns the key of the cell that contains `place`, a point in units of cell edges. The lowest bits hold x. Cell numbers start at 1, so
/// that all neighbours of a cell have valid keys.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the conversion saturates, and what is nowhere may be in any cell"
)]
fn key(place: DVec3) -> u64 {
    let [x, y, z] = place.to_array().map(|place| place.clamp(0.0, MAX_CELLS_PER_AXIS - 1.0) as u64 + 1);
    x | y << KEY_BITS_PER_AXIS | z << (2 * KEY_BITS_PER_AXIS)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// Returns all pairs of points within `reach` that the cells find.
    fn near(points: &[DVec3], reach: f64) -> Vec<[u32; 2]> {
        let mut cells = Cells::default();
        cells.sort(points, reach);
        let mut pairs = Vec::new();
        cells.each(|one, others| {
            for other in others {
                let place = |k: usize| DVec3::new(cells.at[0][k], cells.at[1][k], cells.at[2][k]);
                if place(one).distance(place(other)) < reach {
                    let (a, b) = (cells.number[one], cells.number[other]);
                    pairs.push([a.min(b), a.max(b)]);
                }
            }
        });
        pairs
    }

    /// The points form a dense cluster, with one point far away, several points at one position, and one point with non-finite
    /// coordinates.
    #[test]
    fn each_pair_within_reach_is_seen_once_and_no_other() {
        let part = |i: usize, k: f64| (i as f64 * k).fract();
        let mut points: Vec<DVec3> = (0..400)
            .map(|i| {
                DVec3::new(6.0 * part(i, 0.618_033), 5.0 * part(i, 0.414_213) - 9.0, 4.0 * part(i, 0.732_05))
            })
            .collect();
        points.extend([DVec3::splat(1e9), DVec3::splat(3.0), DVec3::splat(3.0), DVec3::NAN]);
        for spread in [1.0, 1e-3, 1e6] {
            let points: Vec<DVec3> = points.iter().map(|point| *point * spread).collect();
            for reach in [0.9 * spread, 2.5 * spread, 100.0 * spread] {
                let found = near(&points, reach);
                let mut expected = BTreeSet::new();
                for (i, one) in points.iter().enumerate() {
                    for (j, other) in points.iter().enumerate().skip(i + 1) {
                        if one.distance(*other) < reach {
                            expected.insert([i as u32, j as u32]);
                        }
                    }
                }
                assert_eq!(found.len(), expected.len(), "{reach}");
                assert_eq!(found.into_iter().collect::<BTreeSet<_>>(), expected);
            }
        }
        assert!(near(&[], 1.0).is_empty());
    }
}

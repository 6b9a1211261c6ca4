//! A uniform grid of cells, to find bodies that are near each other.

use glam::DVec3;

/// A cubic cell of a uniform grid, given by three integer coordinates.
#[derive(Clone, Copy)]
pub(super) struct Cell([i64; 3]);

impl Cell {
    #[allow(
        clippy::cast_possible_truncation,
        reason = "what is too far away to be counted shares the last cell"
    )]
    pub(super) fn of(edge: f64, location: DVec3) -> Cell {
        // The limits leave room for the coordinates of neighboring cells.
        Cell(location.to_array().map(|coordinate| libm::floor(coordinate / edge).clamp(-9e15, 9e15) as i64))
    }

    /// Returns the cell itself and its 26 neighbors.
    pub(super) fn around(self) -> impl Iterator<Item = Cell> {
        (0..27).map(move |n| self.moved(n))
    }

    /// Returns 13 of the 26 neighbors of the cell, one of each opposite pair. If every cell searches only these, each pair of cells is
    /// visited once.
    pub(super) fn half_around(self) -> impl Iterator<Item = Cell> {
        (14..27).map(move |n| self.moved(n))
    }

    fn moved(self, n: i64) -> Cell {
        let Cell([x, y, z]) = self;
        Cell([x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1])
    }

    /// Hashes the cell together with the size class of the bodies and whether forces move them. Different inputs rarely have the same
    /// hash.
    pub(super) fn key(self, size: usize, moves: bool) -> u64 {
        /// Odd numbers with random-looking bits: the golden ratio and the square roots of 2, 3 and 5, each times 2⁶⁴, without the integer
        /// part.
        const HASH_FACTORS: [u64; 4] =
            [0x9E37_79B9_7F4A_7C15, 0x6A09_E667_F3BC_C909, 0xBB67_AE85_84CA_A73B, 0x3C6E_F372_FE94_F82B];
        let kind = 2 * size as u64 + u64::from(moves);
        let numbers = self.0.map(i64::cast_unsigned).into_iter().chain([kind]);
        let sum = numbers
            .zip(HASH_FACTORS)
            .fold(0, |sum: u64, (n, factor)| sum.wrapping_add(n.wrapping_mul(factor)));
        (sum ^ (sum >> 32)).wrapping_mul(HASH_FACTORS[0])
    }
}

/// A hash table that maps each cell to the bodies in the cell.
#[derive(Default)]
pub(super) struct Grid {
    /// The last body in each slot of the hash table. A cell has one slot; several cells may share a slot.
    last: Vec<u32>,
    /// For each body, the previous body in the same slot of the hash table, or `NO_BODY`.
    before: Vec<u32>,
}

impl Grid {
    /// The mark that a slot of the hash table holds no further body.
    const NO_BODY: u32 = u32::MAX;

    /// Refills the table: each body with a key goes to the slot of its cell.
    #[allow(clippy::cast_possible_truncation, reason = "a scene has at most a few million bodies")]
    pub(super) fn fill(&mut self, keys: impl ExactSizeIterator<Item = Option<u64>>) {
        let bodies = keys.len();
        self.last.clear();
        self.last.resize((2 * bodies).next_power_of_two(), Grid::NO_BODY);
        self.before.resize(bodies, Grid::NO_BODY);
        for (body, key) in keys.enumerate() {
            let Some(key) = key else { continue };
            let place = self.place(key);
            self.before[body] = std::mem::replace(&mut self.last[place], body as u32);
        }
    }

    /// Calls `show` for the bodies in a cell, and for the bodies of other cells that share its slot.
    pub(super) fn each(&self, key: u64, mut show: impl FnMut(usize)) {
        let mut next = self.last[self.place(key)];
        while next != Grid::NO_BODY {
            show(next as usize);
            next = self.before[next as usize];
        }
    }

    /// The slot of a key, from its high half. The high bits of a product depend on all bits of its factors.
    #[allow(clippy::cast_possible_truncation, reason = "the remainder is less than the number of places")]
    fn place(&self, key: u64) -> usize {
        (key >> 32) as usize & (self.last.len() - 1)
    }
}

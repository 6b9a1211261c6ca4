//! Disjoint sets of numbers.

/// Disjoint sets of the numbers from 0 on, as a union–find forest: each number points to another one of its set, and the first one to
/// itself.
pub(super) struct Sets(Vec<usize>);

impl Sets {
    /// As many sets, each of one number.
    pub(super) fn new(numbers: usize) -> Sets {
        Sets((0..numbers).collect())
    }

    /// The smallest number in the set of `number`.
    pub(super) fn first(&mut self, number: usize) -> usize {
        let mut first = number;
        while self.0[first] != first {
            self.0[first] = self.0[self.0[first]];
            first = self.0[first];
        }
        first
    }

    /// Unites the sets of two numbers.
    pub(super) fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b)] = a.min(b);
    }
}

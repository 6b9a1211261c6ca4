//! Disjoint sets of indices (union–find).

/// Disjoint sets of the indices from 0 on, as a union–find forest. Each entry points to an index of the same set that is not larger; the
/// smallest index of a set points to itself.
pub(super) struct Sets(Vec<usize>);

impl Sets {
    /// Creates `numbers` sets, each of one index.
    pub(super) fn new(numbers: usize) -> Sets {
        Sets((0..numbers).collect())
    }

    /// Returns the smallest index in the set that contains the index `number`. The smallest index identifies a set.
    pub(super) fn first(&mut self, number: usize) -> usize {
        let mut first = number;
        while self.0[first] != first {
            self.0[first] = self.0[self.0[first]];
            first = self.0[first];
        }
        first
    }

    /// Merges the sets of two indices.
    pub(super) fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b)] = a.min(b);
    }
}

//! The order in which frames are rendered.

/// Yields the numbers below `count`, from coarse to fine: first 0, then the middle one, then those between. At any time, the finished
/// frames are spread evenly over the film. So they show the whole motion and allow an estimate of the remaining time.
pub(super) fn coarse_to_fine(count: usize) -> impl Iterator<Item = usize> {
    let bits = count.next_power_of_two().trailing_zeros();
    let reversed =
        move |number: usize| if bits == 0 { 0 } else { number.reverse_bits() >> (usize::BITS - bits) };
    (0..count.next_power_of_two()).map(reversed).filter(move |number| *number < count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_comes_once_and_the_first_is_first() {
        assert_eq!(coarse_to_fine(8).collect::<Vec<_>>(), [0, 4, 2, 6, 1, 5, 3, 7]);
        for count in [0, 1, 2, 3, 24, 501] {
            let mut all: Vec<usize> = coarse_to_fine(count).collect();
            assert_eq!(all.first().copied(), (count > 0).then_some(0), "{count}");
            all.sort_unstable();
            assert!(all.into_iter().eq(0..count), "{count}");
        }
    }
}

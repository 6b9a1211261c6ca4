//! The frames that one `povray` command renders: those whose scripts are in a folder.

/// The frames whose scripts are in a folder, as POV-Ray's animation loop counts them: from the first to the last one in equal steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Span {
    /// The number of the first frame.
    pub(super) first: usize,
    /// The number of the last frame.
    pub(super) last: usize,
    /// The largest step with which the loop meets all frames.
    pub(super) step: usize,
    /// True if the loop also meets frames without scripts, because the distances between the frames differ.
    pub(super) gaps: bool,
}

impl Span {
    /// Returns the span of some frames, which may come in any order, but each only once. Without frames, it is the span of frame 0.
    pub(super) fn of(frames: impl IntoIterator<Item = usize>) -> Span {
        let mut frames = frames.into_iter();
        let begin = frames.next().unwrap_or(0);
        let (mut first, mut last, mut step, mut count) = (begin, begin, 0, 1);
        for frame in frames {
            (first, last, count) = (first.min(frame), last.max(frame), count + 1);
            step = common_divisor(step, frame.abs_diff(begin));
        }
        let step = step.max(1);
        Span { first, last, step, gaps: (last - first) / step + 1 != count }
    }
}

/// Returns the greatest common divisor of two numbers, by Euclid's algorithm. That of 0 and a number is the number.
fn common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_meets_its_frames_in_the_largest_step() {
        let of = |frames: &[usize]| {
            let Span { first, last, step, gaps } = Span::of(frames.iter().copied());
            (first, last, step, gaps)
        };
        assert_eq!(of(&[0, 1, 2]), (0, 2, 1, false));
        assert_eq!(of(&[5]), (5, 5, 1, false));
        assert_eq!(of(&[8, 5, 7, 6]), (5, 8, 1, false));
        assert_eq!(of(&[13, 1, 7]), (1, 13, 6, false));
        assert_eq!(of(&[0, 4, 10]), (0, 10, 2, true));
        assert_eq!(of(&[0, 50, 90, 91]), (0, 91, 1, true));
        assert_eq!(of(&[]), (0, 0, 1, false));
    }
}

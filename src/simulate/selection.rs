//! A selection of a scene's frames, such as `0,50,90-100`.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// A selection of a scene's frames: a list of ranges, optionally thinned to every n-th frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selection {
    ranges: Vec<RangeInclusive<usize>>,
    /// The step n: only every n-th frame of the ranges is selected, counted from the smallest frame.
    every: usize,
}

impl Selection {
    /// Selects the first `frames` frames.
    pub fn first(frames: usize) -> Selection {
        Selection { ranges: if frames == 0 { vec![] } else { vec![0..=frames - 1] }, every: 1 }
    }

    /// Thins the selection to every n-th frame, counted from its smallest frame.
    #[must_use]
    pub fn every(self, every: usize) -> Selection {
        Selection { every: every.max(1), ..self }
    }

    /// True if the frame is selected.
    pub fn contains(&self, frame: usize) -> bool {
        let first = || self.ranges.iter().map(|range| *range.start()).min().unwrap_or(0);
        self.ranges.iter().any(|range| range.contains(&frame))
            && (self.every == 1 || (frame - first()).is_multiple_of(self.every))
    }

    /// The largest frame number in the ranges. `None` for an empty selection.
    pub fn last(&self) -> Option<usize> {
        self.ranges.iter().map(|range| *range.end()).max()
    }

    /// The number of selected frames among the first `frames`.
    pub fn count_within(&self, frames: usize) -> usize {
        (0..frames).filter(|&frame| self.contains(frame)).count()
    }
}

impl FromIterator<usize> for Selection {
    /// Selects the frames with these numbers. Consecutive numbers become one range.
    fn from_iter<I: IntoIterator<Item = usize>>(numbers: I) -> Selection {
        let mut ranges: Vec<RangeInclusive<usize>> = Vec::new();
        for number in numbers {
            match ranges.last_mut() {
                Some(range) if number.checked_sub(1) == Some(*range.end()) => {
                    *range = *range.start()..=number;
                }
                _ => ranges.push(number..=number),
            }
        }
        Selection { ranges, every: 1 }
    }
}

impl FromStr for Selection {
    type Err = String;

    fn from_str(text: &str) -> Result<Selection, String> {
        let number = |text: &str| {
            text.trim()
                .parse::<usize>()
                .map_err(|_| format!("`{}` is not the number of a frame", text.trim()))
        };
        let range = |part: &str| match part.split_once('-') {
            None => number(part).map(|frame| frame..=frame),
            Some((first, _)) if first.trim().is_empty() => {
                Err(format!("`{}` does not say where it begins: the first frame is 0", part.trim()))
            }
            Some((first, last)) if last.trim().is_empty() => {
                let first = number(first)?;
                Err(format!(
                    "`{first}-` does not say where it ends, as `{first}-{}` does",
                    first.saturating_add(10)
                ))
            }
            Some((first, last)) => {
                let (first, last) = (number(first)?, number(last)?);
                if first > last {
                    return Err(format!("`{}` ends before it begins", part.trim()));
                }
                Ok(first..=last)
            }
        };
        let ranges = text.split(',').map(range).collect::<Result<_, _>>()?;
        Ok(Selection { ranges, every: 1 })
    }
}

impl fmt::Display for Selection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, range) in self.ranges.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            match (range.start(), range.end()) {
                (first, last) if first == last => write!(f, "{comma}{first}")?,
                (first, last) => write!(f, "{comma}{first}-{last}")?,
            }
        }
        if self.every > 1 {
            write!(f, " (every {})", self.every)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_has_frames_and_ranges() {
        let selection: Selection = "0, 50,90-100".parse().unwrap();
        assert!([0, 50, 90, 95, 100].into_iter().all(|frame| selection.contains(frame)));
        assert!([1, 49, 89, 101].into_iter().all(|frame| !selection.contains(frame)));
        assert_eq!((selection.last(), selection.count_within(96)), (Some(100), 8));
        assert_eq!(selection.to_string(), "0,50,90-100");
        assert_eq!([0, 2, 3, 4, 9].into_iter().collect::<Selection>().to_string(), "0,2-4,9");
    }

    #[test]
    fn every_so_many_th_counts_from_the_first() {
        let selection = "5-20,30".parse::<Selection>().unwrap().every(5);
        assert_eq!(
            (0..50).filter(|&frame| selection.contains(frame)).collect::<Vec<_>>(),
            [5, 10, 15, 20, 30]
        );
        assert_eq!(selection.to_string(), "5-20,30 (every 5)");
    }

    #[test]
    fn what_is_no_list_is_refused() {
        for text in ["", "a", "1,", "3-1", "-1", "1-2-3", "1.5", "99999999999999999999"] {
            assert!(text.parse::<Selection>().is_err(), "{text:?}");
        }
    }
}

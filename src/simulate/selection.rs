//! Some of a scene's frames: `0,50,90-100`.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// Some of a scene's frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selection(Vec<RangeInclusive<usize>>);

impl Selection {
    /// The first so many frames.
    pub fn first(frames: usize) -> Selection {
        Selection(if frames == 0 { vec![] } else { vec![0..=frames - 1] })
    }

    /// Whether the frame is among them.
    pub fn contains(&self, frame: usize) -> bool {
        self.0.iter().any(|range| range.contains(&frame))
    }

    /// The last of them.
    pub fn last(&self) -> Option<usize> {
        self.0.iter().map(|range| *range.end()).max()
    }

    /// How many of the first `frames` are among them.
    pub fn count_within(&self, frames: usize) -> usize {
        (0..frames).filter(|&frame| self.contains(frame)).count()
    }
}

impl FromIterator<usize> for Selection {
    /// The frames of these numbers; those that follow each other are one range.
    fn from_iter<I: IntoIterator<Item = usize>>(numbers: I) -> Selection {
        let mut ranges: Vec<RangeInclusive<usize>> = Vec::new();
        for number in numbers {
            match ranges.last_mut() {
                Some(range) if number.checked_sub(1) == Some(*range.end()) => {
                    *range = *range.start()..=number
                }
                _ => ranges.push(number..=number),
            }
        }
        Selection(ranges)
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
        text.split(',').map(range).collect::<Result<_, _>>().map(Selection)
    }
}

impl fmt::Display for Selection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, range) in self.0.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            match (range.start(), range.end()) {
                (first, last) if first == last => write!(f, "{comma}{first}")?,
                (first, last) => write!(f, "{comma}{first}-{last}")?,
            }
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
    fn what_is_no_list_is_refused() {
        for text in ["", "a", "1,", "3-1", "-1", "1-2-3", "1.5", "99999999999999999999"] {
            assert!(text.parse::<Selection>().is_err(), "{text:?}");
        }
    }
}

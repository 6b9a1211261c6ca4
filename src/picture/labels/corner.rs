//! Labels in the corners of a picture, one line below another.

use super::super::grid;
use super::super::text::{MARGIN, Text, Vertical, across, is_top};
use super::said::Moment;
use super::{LINE, Labels, Planned};
use crate::scene::{Corner, LabelPlace};

impl Labels {
    /// A label in its corner.
    pub(super) fn in_corner<'a>(&'a self, planned: &'a Planned, now: &Moment<'_>) -> Option<Text<'a>> {
        let LabelPlace::Corner(corner) = planned.label.place else { return None };
        let (x, align) = across(corner);
        let y = match is_top(corner) {
            true => Vertical::Top(planned.inset + 0.3 * planned.height),
            false => Vertical::Bottom(planned.inset - 0.3 * planned.height),
        };
        Some(planned.text(self.said(&planned.label, now).into(), (x, y), align))
    }
}

/// The space taken at the upper edge or the lower one.
pub(super) struct Taken {
    is_top: bool,
    /// The range across the picture.
    across: [f64; 2],
    /// The range of distances from the edge.
    inset: [f64; 2],
}

/// The space of a scale bar. Its length is at most a quarter of the picture.
pub(super) fn under_bar(corner: Corner, aspect: f64) -> Taken {
    let (x, align) = across(corner);
    let left = x - 0.5 * align;
    Taken {
        is_top: is_top(corner),
        across: [left, left + 0.5],
        inset: [0.0, MARGIN + 4.0 * aspect * grid::SIZE],
    }
}

/// The distance from the edge to the middle of a line of text in a corner: the least that overlaps no other
/// line. No room is kept beyond the other edge of the picture, at `most`, where nothing is visible.
pub(super) fn inset_without_overlap(
    taken: &mut Vec<Taken>,
    corner: Corner,
    [wide, height]: [f64; 2],
    most: f64,
) -> f64 {
    let (x, align) = across(corner);
    let across = [x - align * wide, x - align * wide + wide];
    let overlap = |a: [f64; 2], b: [f64; 2]| a[0] < b[1] - 1e-9 && b[0] < a[1] - 1e-9;
    let mut begin = MARGIN;
    loop {
        let down = [begin, begin + LINE * height];
        let hidden = taken.iter().filter(|line| {
            let [left, right] = line.across;
            line.is_top == is_top(corner)
                && overlap([left - height / 2.0, right + height / 2.0], across)
                && overlap(line.inset, down)
        });
        match hidden.map(|line| line.inset[1]).reduce(f64::max) {
            Some(end) if end > most => return end + height / 2.0,
            Some(end) => begin = end,
            None => {
                taken.push(Taken { is_top: is_top(corner), across, inset: down });
                return begin + height / 2.0;
            }
        }
    }
}

//! Places labels in the corners of a picture, one below another.

use super::super::framing::Free;
use super::super::grid;
use super::super::occupancy::Rectangle;
use super::super::text::{MARGIN, Text, Vertical, across_free, is_top};
use super::{LINE, Labels, Planned};
use crate::scene::{Corner, LabelPlace};
use crate::simulate::MomentState;

impl Labels {
    /// Places a label in its corner. `None` for a label beside a body.
    pub(super) fn in_corner<'a>(&'a self, planned: &'a Planned, now: &MomentState<'_>) -> Option<Text<'a>> {
        let LabelPlace::Corner(corner) = planned.label.place else { return None };
        let (x, align) = across_free(corner, self.free);
        let y = match is_top(corner) {
            true => Vertical::Top(planned.inset + 0.3 * planned.height),
            false => Vertical::Bottom(planned.inset - 0.3 * planned.height),
        };
        Some(planned.text(self.said(&planned.label.text, now).into(), (x, y), align))
    }
}

/// A rectangle that a text takes at the upper or lower edge of the picture.
pub(super) struct Taken {
    is_top: bool,
    /// The left and right ends of the rectangle, from -1 to 1.
    across: [f64; 2],
    /// The distances of the rectangle's near and far sides from the edge of the picture.
    inset: [f64; 2],
}

/// The rectangle of a scale bar, whose length is at most a quarter of the picture's width.
pub(super) fn under_bar(corner: Corner, aspect: f64, free: Free) -> Taken {
    let (x, align) = across_free(corner, free);
    let left = x - 0.5 * align;
    Taken {
        is_top: is_top(corner),
        across: [left, left + 0.5],
        inset: [0.0, MARGIN + 4.0 * aspect * grid::SIZE],
    }
}

/// The rectangle of a plot, as seen from the upper and from the lower edge of the picture.
pub(super) fn under_plot(area: Rectangle, aspect: f64) -> [Taken; 2] {
    let across = [area.left, area.right];
    let inset = [[aspect - area.top, aspect - area.bottom], [area.bottom + aspect, area.top + aspect]];
    [Taken { is_top: true, across, inset: inset[0] }, Taken { is_top: false, across, inset: inset[1] }]
}

/// Finds room for a line of text in a corner: the smallest distance from the edge at which the line overlaps no other. Returns the
/// distance from the edge to the middle of the line. Beyond the opposite edge, at the distance `most`, no room is reserved, since nothing
/// is visible.
pub(super) fn inset_without_overlap(
    taken: &mut Vec<Taken>,
    corner: Corner,
    [wide, height]: [f64; 2],
    (free, most): (Free, f64),
) -> f64 {
    let (x, align) = across_free(corner, free);
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

//! Places labels in the corners and in the center of a picture, one below another.

use super::super::bar;
use super::super::framing::Free;
use super::super::occupancy::Rectangle;
use super::super::text::{LINE, MARGIN, Vertical, across_free, below, is_top};
use super::Planned;
use super::lines::Block;
use crate::scene::{Corner, LabelPlace, Output};

/// The places of the labels that are visible from a time on, until the next layout.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub(super) from: f64,
    /// The places of the visible labels, each with the index of its label.
    pub(super) places: Vec<(usize, FirstLine)>,
}

/// The position of a label: that of the first base line.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstLine {
    pub(super) x: f64,
    pub(super) y: Vertical,
    pub(super) align: f64,
}

impl Layout {
    /// Lays out the labels that are visible at a time, around what is taken of the picture.
    pub(super) fn new(
        labels: &[Planned],
        from: f64,
        mut taken: Vec<Taken>,
        (free, aspect): (Free, f64),
    ) -> Layout {
        let labels = labels.iter().map(|planned| &planned.block).enumerate();
        let visible: Vec<(usize, &Block)> =
            labels.filter(|(_, block)| block.label.is_visible(from)).collect();
        // Plots and the scale bar.
        let others = taken.len();
        let mut places = Vec::new();
        for (number, block) in &visible {
            let LabelPlace::Corner(corner) = block.label.place else { continue };
            let Block { height, rows, .. } = **block;
            let size = [block.wide, height, block.high()];
            let (x, align) = beside_others(&taken[..others], corner, size, free);
            let inset = inset_without_overlap(&mut taken, corner, size, ((x, align), 2.0 * aspect));
            let y = match is_top(corner) {
                true => Vertical::Top(inset + 0.3 * height),
                false => Vertical::Bottom(inset - 0.3 * height + below(rows, height)),
            };
            places.push((*number, FirstLine { x, y, align }));
        }
        let in_center = || visible.iter().filter(|(_, block)| block.label.place == LabelPlace::Center);
        let size = [
            in_center().map(|(_, block)| block.wide).fold(0.0, f64::max),
            in_center().map(|(_, block)| block.high()).sum(),
        ];
        let mut top = size[1] / 2.0 + middle(&taken, size, (free, aspect));
        for (number, block) in in_center() {
            let y = Vertical::Middle(top - (0.5 * LINE + 0.3) * block.height);
            places.push((*number, FirstLine { x: free.center, y, align: 0.5 }));
            top -= block.high();
        }
        // In the order of the scene.
        places.sort_by_key(|(number, _)| *number);
        Layout { from, places }
    }
}

/// The height of the middle of the labels in the center above the middle of the picture: 0, or a little more or less if labels at the
/// edges would be covered. `size` is the width and the height of the labels in the center.
fn middle(taken: &[Taken], [wide, high]: [f64; 2], (free, aspect): (Free, f64)) -> f64 {
    let [mut floor, mut ceiling] = [-aspect, aspect];
    for Taken { is_top, across, inset } in taken {
        let is_beside = across[1] < free.center - wide / 2.0 || across[0] > free.center + wide / 2.0;
        // A panel of a plot is known from both edges. It counts from the nearer one.
        if is_beside || inset[0] + inset[1] > 2.0 * aspect {
            continue;
        }
        match is_top {
            true => ceiling = ceiling.min(aspect - inset[1]),
            false => floor = floor.max(inset[1] - aspect),
        }
    }
    let [low, most] = [floor + high / 2.0, ceiling - high / 2.0];
    if low <= most { 0.0_f64.clamp(low, most) } else { 0.0 }
}

/// A rectangle that a text takes at the upper or lower edge of the picture.
#[derive(Clone, Debug)]
pub(super) struct Taken {
    is_top: bool,
    /// The left and right ends of the rectangle, from -1 to 1.
    across: [f64; 2],
    /// The distances of the rectangle's near and far sides from the edge of the picture.
    inset: [f64; 2],
}

/// The rectangle of a scale bar, whose length is at most a quarter of the picture's width.
pub(super) fn under_bar(corner: Corner, output: Output, free: Free) -> Taken {
    let (x, align) = across_free(corner, free);
    let left = x - 0.5 * align;
    Taken { is_top: is_top(corner), across: [left, left + 0.5], inset: [0.0, MARGIN + bar::room(output)] }
}

/// The rectangle of a plot, as seen from the upper and from the lower edge of the picture.
pub(super) fn under_plot(area: Rectangle, aspect: f64) -> [Taken; 2] {
    let across = [area.left, area.right];
    let inset = [[aspect - area.top, aspect - area.bottom], [area.bottom + aspect, area.top + aspect]];
    [Taken { is_top: true, across, inset: inset[0] }, Taken { is_top: false, across, inset: inset[1] }]
}

/// The horizontal position of lines of text, and their alignment. In the middle of an edge, they move aside from plots and from the scale
/// bar, by the smallest way at which they have room at the edge. `size` is the width of the longest line, the height of letters and that of
/// all lines.
fn beside_others(others: &[Taken], corner: Corner, [wide, height, high]: [f64; 3], free: Free) -> (f64, f64) {
    let (x, align) = across_free(corner, free);
    if !matches!(corner, Corner::Top | Corner::Bottom) {
        return (x, align);
    }
    let gap = height / 2.0;
    let at_edge = |other: &&Taken| {
        other.is_top == is_top(corner) && other.inset[0] < MARGIN + high && other.inset[1] > MARGIN
    };
    let blocking: Vec<[f64; 2]> =
        others.iter().filter(at_edge).map(|other| [other.across[0] - gap, other.across[1] + gap]).collect();
    let [low, most] = [-1.0, 1.0].map(|side| free.center + side * (free.half - MARGIN - wide / 2.0));
    let has_room = |x: &f64| {
        let is_apart =
            |other: &[f64; 2]| x + wide / 2.0 <= other[0] + 1e-9 || x - wide / 2.0 >= other[1] - 1e-9;
        (low - 1e-9..=most + 1e-9).contains(x) && blocking.iter().all(is_apart)
    };
    let beside = blocking.iter().flat_map(|[left, right]| [left - wide / 2.0, right + wide / 2.0]);
    let nearest = std::iter::once(x).chain(beside).filter(has_room);
    let nearest = nearest.min_by(|one, other| (one - x).abs().total_cmp(&(other - x).abs()));
    (nearest.unwrap_or(x), align)
}

/// Finds room for lines of text in a corner: the smallest distance from the edge at which they overlap no others. `size` is the width of
/// the longest line, the height of letters and that of all lines. `x` is their horizontal position, and `align` the part of them there. Returns the distance from the edge to the middle of the nearest line. Beyond the opposite edge, at the distance `most`, no room is reserved, since nothing
/// is visible.
fn inset_without_overlap(
    taken: &mut Vec<Taken>,
    corner: Corner,
    [wide, height, high]: [f64; 3],
    ((x, align), most): ((f64, f64), f64),
) -> f64 {
    let across = [x - align * wide, x - align * wide + wide];
    let overlap = |a: [f64; 2], b: [f64; 2]| a[0] < b[1] - 1e-9 && b[0] < a[1] - 1e-9;
    let mut begin = MARGIN;
    loop {
        let down = [begin, begin + high];
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

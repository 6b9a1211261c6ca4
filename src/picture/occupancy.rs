//! Records which parts of a picture are taken, to place texts in free parts.

use glam::DVec3;

use super::screen::Screen;
use super::text::Text;

/// The number of cells across the picture.
const CELLS_ACROSS: f64 = 48.0;

/// A rectangle in the image plane. The picture has a width of 2, and (0, 0) is in its middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
    pub(super) top: f64,
}

/// A straight line of some width in the image plane. `half` is half of its width.
#[derive(Clone, Copy, Debug)]
struct Stripe {
    from: [f64; 2],
    to: [f64; 2],
    half: f64,
}

/// The taken parts of a picture. A grid of cells lists the rectangles and lines in each cell, so that a search looks only at near ones.
#[derive(Debug)]
pub(super) struct Occupancy {
    /// The height of the picture, relative to its width.
    aspect: f64,
    /// The numbers of cells across the picture and upward.
    across: usize,
    upward: usize,
    /// The cells row by row, from the lower left corner. Empty before the first part is taken.
    cells: Vec<Cell>,
}

/// The taken parts of a cell.
#[derive(Clone, Debug, Default)]
struct Cell {
    /// The taken rectangles in the cell. None of them contains another.
    taken: Vec<Rectangle>,
    stripes: Vec<Stripe>,
}

impl Cell {
    /// Adds a rectangle to the taken parts of the cell.
    fn take(&mut self, part: Rectangle) {
        if !self.has_taken(part) {
            self.taken.retain(|other| !part.covers(*other));
            self.taken.push(part);
        }
    }

    /// True if a single taken rectangle contains the given rectangle.
    fn has_taken(&self, part: Rectangle) -> bool {
        self.taken.iter().any(|other| other.covers(part))
    }
}

impl Occupancy {
    /// Creates a record of a picture in which nothing is taken. `aspect` is the height of the picture, relative to its width.
    pub(super) fn new(aspect: f64) -> Occupancy {
        let (across, upward) = (CELLS_ACROSS, (CELLS_ACROSS * aspect).ceil().clamp(1.0, CELLS_ACROSS));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "both are 48 at most")]
        let (across, upward) = (across as usize, upward as usize);
        Occupancy { aspect, across, upward, cells: Vec::new() }
    }

    /// Marks a rectangle of the picture as taken.
    pub(super) fn take(&mut self, part: Rectangle) {
        self.each_cell(part, |cell, place| {
            if part.overlaps(place) {
                cell.take(part.within(place));
            }
        });
    }

    /// Marks the area of a text as taken.
    pub(super) fn take_text(&mut self, text: &Text<'_>) {
        self.take(text.area(self.aspect));
    }

    /// True if a text is completely inside the picture and overlaps no taken part.
    pub(super) fn has_room_for(&self, text: &Text<'_>) -> bool {
        self.is_free(text.area(self.aspect))
    }

    /// The height of the picture, relative to its width.
    pub(super) fn aspect(&self) -> f64 {
        self.aspect
    }

    /// Marks the image of a line between two points in the world as taken. The width of the line is in meters.
    pub(super) fn cross(&mut self, ends: [DVec3; 2], width: f64, screen: &Screen) {
        if let [Some(from), Some(to)] = ends.map(|end| screen.project(end)) {
            self.stripe([from.x, from.y], [to.x, to.y], width * to.scale);
        }
    }

    /// Marks a line of this width in the image plane as taken.
    fn stripe(&mut self, from: [f64; 2], to: [f64; 2], width: f64) {
        let stripe = Stripe { from, to, half: width / 2.0 };
        self.each_cell(stripe.bounds(), |cell, place| {
            if !cell.has_taken(place) && stripe.meets(place) {
                cell.stripes.push(stripe);
            }
        });
    }

    /// True if a rectangle is completely inside the picture and overlaps no taken part.
    pub(super) fn is_free(&self, part: Rectangle) -> bool {
        let inside =
            part.left >= -1.0 && part.right <= 1.0 && part.bottom >= -self.aspect && part.top <= self.aspect;
        let is_taken = |cell: &Cell| {
            cell.taken.iter().any(|other| part.overlaps(*other))
                || cell.stripes.iter().any(|stripe| stripe.meets(part))
        };
        let mut cells = self.numbers(part).filter_map(|number| self.cells.get(number));
        inside && !cells.any(is_taken)
    }

    /// Calls `work` with each cell that may overlap a rectangle, and with the area of the cell.
    fn each_cell(&mut self, part: Rectangle, mut work: impl FnMut(&mut Cell, Rectangle)) {
        if self.cells.is_empty() {
            self.cells = vec![Cell::default(); self.across * self.upward];
        }
        for number in self.numbers(part) {
            let place = self.place(number);
            work(&mut self.cells[number], place);
        }
    }

    /// The indices of the cells that may overlap a rectangle.
    fn numbers(&self, part: Rectangle) -> impl Iterator<Item = usize> + use<> {
        let across = self.across;
        let columns = range([part.left, part.right], 1.0, across);
        let rows = range([part.bottom, part.top], self.aspect, self.upward);
        rows.flat_map(move |row| columns.clone().map(move |column| row * across + column))
    }

    /// The area of the cell with this index.
    #[allow(clippy::cast_precision_loss, reason = "there are few cells")]
    fn place(&self, number: usize) -> Rectangle {
        let (row, column) = (number / self.across, number % self.across);
        let edge = |number: usize, half: f64, count: usize| half * (2.0 * number as f64 / count as f64 - 1.0);
        Rectangle {
            left: edge(column, 1.0, self.across),
            right: edge(column + 1, 1.0, self.across),
            bottom: edge(row, self.aspect, self.upward),
            top: edge(row + 1, self.aspect, self.upward),
        }
    }
}

/// The indices of the cells between two coordinates, where `count` cells lie between `-half` and `half`. One additional cell on each side
/// covers rounding errors.
#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the conversion saturates, and what is outside the picture belongs to no cell"
)]
fn range([low, high]: [f64; 2], half: f64, count: usize) -> std::ops::Range<usize> {
    let cell = |place: f64| (place / half + 1.0) / 2.0 * count as f64;
    let (first, end) = (cell(low).floor() - 1.0, cell(high).ceil() + 1.0);
    first as usize..(end.max(0.0) as usize).min(count)
}

impl Rectangle {
    fn overlaps(self, other: Rectangle) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.bottom < other.top
            && other.bottom < self.top
    }

    /// The intersection with another rectangle.
    fn within(self, other: Rectangle) -> Rectangle {
        Rectangle {
            left: self.left.max(other.left),
            right: self.right.min(other.right),
            bottom: self.bottom.max(other.bottom),
            top: self.top.min(other.top),
        }
    }

    /// True if this rectangle contains another rectangle.
    fn covers(self, other: Rectangle) -> bool {
        self.left <= other.left
            && other.right <= self.right
            && self.bottom <= other.bottom
            && other.top <= self.top
    }
}

impl Stripe {
    /// The bounding box of the line.
    fn bounds(self) -> Rectangle {
        let [low, high] =
            [f64::min, f64::max].map(|of| [0, 1].map(|axis| of(self.from[axis], self.to[axis])));
        Rectangle {
            left: low[0] - self.half,
            right: high[0] + self.half,
            bottom: low[1] - self.half,
            top: high[1] + self.half,
        }
    }

    /// True if the line overlaps a rectangle. Clips the middle line at the four edges of the widened rectangle (Liang–Barsky algorithm).
    fn meets(self, part: Rectangle) -> bool {
        let edges = [
            (self.from[0], self.to[0], part.left - self.half, part.right + self.half),
            (self.from[1], self.to[1], part.bottom - self.half, part.top + self.half),
        ];
        let (mut enters, mut leaves) = (0.0f64, 1.0f64);
        for (from, to, low, high) in edges {
            let along = to - from;
            if along == 0.0 {
                if from < low || from > high {
                    return false;
                }
                continue;
            }
            let (first, second) = ((low - from) / along, (high - from) / along);
            enters = enters.max(first.min(second));
            leaves = leaves.min(first.max(second));
        }
        enters <= leaves
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PART: Rectangle = Rectangle { left: -0.2, right: 0.2, bottom: 0.0, top: 0.1 };

    #[test]
    fn what_is_taken_is_not_free() {
        let mut room = Occupancy::new(0.5);
        assert!(room.is_free(PART));
        room.take(Rectangle { left: 0.2, right: 0.4, ..PART });
        assert!(room.is_free(PART));
        room.take(Rectangle { left: 0.1, right: 0.4, bottom: -0.1, top: 0.01 });
        assert!(!room.is_free(PART));
        assert!(!room.is_free(Rectangle { bottom: 0.45, top: 0.51, ..PART }));
    }

    #[test]
    fn lines_take_what_they_cross() {
        for (from, to, meets) in [
            ([-1.0, 0.05], [1.0, 0.05], true),
            ([0.0, -0.5], [0.0, -0.02], false),
            ([0.0, -0.5], [0.0, -0.005], true),
            ([-0.35, 0.0], [-0.1, 0.25], false),
            ([0.1, 0.05], [0.1, 0.05], true),
            ([0.3, 0.05], [0.3, 0.3], false),
        ] {
            let mut room = Occupancy::new(0.5);
            room.stripe(from, to, 0.02);
            assert_eq!(!room.is_free(PART), meets, "{from:?} {to:?}");
        }
    }

    /// The division of the picture into cells makes the search faster, and must not change its result.
    #[test]
    fn parts_are_free_as_if_each_were_held_against_all_that_is_taken() {
        let mut state: u32 = 7;
        let mut random = |low: f64, high: f64| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            low + (high - low) * f64::from(state >> 8) / f64::from(1 << 24)
        };
        for (aspect, largest) in [(0.5625, 0.1), (0.5625, 0.9), (3.0, 0.4), (0.01, 0.02)] {
            let mut room = Occupancy::new(aspect);
            let (mut taken, mut stripes): (Vec<Rectangle>, Vec<Stripe>) = Default::default();
            for number in 0..400 {
                let mut point = || [random(-1.2, 1.2), random(-1.2 * aspect, 1.2 * aspect)];
                let ([left, bottom], end) = (point(), point());
                let (right, top) = (left + random(0.01, largest), bottom + random(0.01, largest) * aspect);
                let part = Rectangle { left, right, bottom, top };
                let free = !taken.iter().any(|other| part.overlaps(*other))
                    && !stripes.iter().any(|stripe| stripe.meets(part));
                let inside = left >= -1.0 && right <= 1.0 && bottom >= -aspect && top <= aspect;
                assert_eq!(room.is_free(part), free && inside, "{number}: {part:?}");
                match number % 8 {
                    0 => {
                        let half = random(0.001, 0.01);
                        let to = [left + 0.2 * (end[0] - left), bottom + 0.2 * (end[1] - bottom)];
                        stripes.push(Stripe { from: [left, bottom], to, half });
                        room.stripe([left, bottom], to, 2.0 * half);
                    }
                    1 | 2 => {
                        taken.push(part);
                        room.take(part);
                    }
                    _ => {}
                }
            }
        }
    }
}

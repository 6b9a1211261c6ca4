//! Which parts of a picture are taken, so that texts stand where there is room.

use glam::DVec3;

use super::screen::Screen;
use super::text::Text;

/// A part of the picture, whose width is 2; the middle of the picture is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
    pub(super) top: f64,
}

/// A line across the picture, with half its width.
#[derive(Clone, Copy, Debug)]
struct Stripe {
    from: [f64; 2],
    to: [f64; 2],
    half: f64,
}

/// What is taken of a picture.
#[derive(Debug)]
pub(super) struct Room {
    /// The height of the picture, as part of its width.
    aspect: f64,
    taken: Vec<Rectangle>,
    stripes: Vec<Stripe>,
}

impl Room {
    /// A picture of which nothing is taken.
    pub(super) fn new(aspect: f64) -> Room {
        Room { aspect, taken: Vec::new(), stripes: Vec::new() }
    }

    /// Takes a part of the picture.
    pub(super) fn take(&mut self, part: Rectangle) {
        self.taken.push(part);
    }

    /// Takes the part of the picture in which a text stands.
    pub(super) fn take_text(&mut self, text: &Text<'_>) {
        self.take(text.area(self.aspect));
    }

    /// Whether a text is in the picture and nothing of its part is taken.
    pub(super) fn has_room_for(&self, text: &Text<'_>) -> bool {
        self.is_free(text.area(self.aspect))
    }

    /// The height of the picture, as part of its width.
    pub(super) fn aspect(&self) -> f64 {
        self.aspect
    }

    /// Takes a line in the world, from one point to another and of a width, m, as it is seen on the plane of a camera.
    pub(super) fn cross(&mut self, ends: [DVec3; 2], width: f64, screen: &Screen) {
        if let [Some(from), Some(to)] = ends.map(|end| screen.spot(end)) {
            self.stripe([from.x, from.y], [to.x, to.y], width * to.metre);
        }
    }

    /// Takes a line of a width.
    fn stripe(&mut self, from: [f64; 2], to: [f64; 2], width: f64) {
        self.stripes.push(Stripe { from, to, half: width / 2.0 });
    }

    /// Whether a part is in the picture and nothing of it is taken.
    pub(super) fn is_free(&self, part: Rectangle) -> bool {
        let inside =
            part.left >= -1.0 && part.right <= 1.0 && part.bottom >= -self.aspect && part.top <= self.aspect;
        inside
            && !self.taken.iter().any(|other| part.overlaps(*other))
            && !self.stripes.iter().any(|stripe| stripe.meets(part))
    }
}

impl Rectangle {
    fn overlaps(self, other: Rectangle) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.bottom < other.top
            && other.bottom < self.top
    }
}

impl Stripe {
    /// Whether some of it is in a rectangle: clips its middle line at the four edges (Liang and Barsky).
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
        let mut room = Room::new(0.5);
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
            let mut room = Room::new(0.5);
            room.stripe(from, to, 0.02);
            assert_eq!(!room.is_free(PART), meets, "{from:?} {to:?}");
        }
    }
}

//! Places labels beside bodies, where there is room.

use super::super::occupancy::Rectangle;
use super::super::screen::{Screen, ScreenPoint};
use super::super::surroundings::{Movable, TextPlace};
use super::super::text::{LINE, MARGIN, Text, Vertical, below};
use super::{Key, Labels, Planned};
use crate::physics::BodySnapshot;
use crate::scene::Side;
use crate::simulate::MomentState;

/// The largest distance of a label from its body, in lines.
const MAX_LINES_AWAY: u8 = 5;
/// The costs of the requested side, the opposite one and the two others, in heights of a line.
const COSTS_OF_SIDES: [f64; 4] = [0.0, 0.9, 1.3, 1.3];
/// The cost of a place beside a corner of the body's area, in heights of a line.
const COST_OF_CORNER: f64 = 1.5;
/// The cost of a line of distance, in heights of a line. A text rather goes farther away than to another side.
const COST_OF_DISTANCE: f64 = 0.6;

impl Labels {
    /// The position of a body or ghost in the picture, and the rectangle that it covers. `None` if it is behind the camera. The rectangle
    /// of a plane is empty.
    pub(super) fn seen(&self, at: &BodySnapshot, screen: &Screen) -> Option<(ScreenPoint, Rectangle)> {
        let shape = self.measures.body(at.id).drawn();
        let point = screen.project(at.location)?;
        let reach = |direction| shape.support(at.orientation, direction).unwrap_or(0.0) * point.scale;
        let (up, right) = (screen.up(), screen.right());
        let area = Rectangle {
            left: point.x - reach(-right),
            right: point.x + reach(right),
            bottom: point.y - reach(-up),
            top: point.y + reach(up),
        };
        Some((point, area))
    }

    /// The possible places of a label beside a body or ghost. `None` if the body is outside the picture. The label stays inside the picture. It
    /// moves to another side or a little farther away if it would cover a text, an arrow or another body.
    pub(super) fn beside<'a>(
        &'a self,
        planned: &'a Planned,
        (at, side): (&BodySnapshot, Side),
        key: Key,
        moment: &MomentState<'_>,
        screen: &Screen,
    ) -> Option<Movable<'a>> {
        let (point, area) = self.seen(at, screen)?;
        if area.right < -1.0 || area.left > 1.0 || area.top < -self.aspect || area.bottom > self.aspect {
            return None;
        }
        let height = planned.block.height;
        let below = below(planned.block.rows, height);
        let middle = point.y - 0.3 * height + below / 2.0;
        let at_side = |side: Side, farther: f64| match side {
            Side::Above => (point.x, area.top + 0.3 * height + below + farther, 0.5),
            Side::Below => (point.x, area.bottom - 0.9 * height - farther, 0.5),
            Side::Left => (area.left - 0.35 * height - farther, middle, 1.0),
            Side::Right => (area.right + 0.35 * height + farther, middle, 0.0),
        };
        let said = self.said(&planned.block.label.text, moment);
        let text = planned.text(said.into(), (point.x, Vertical::Middle(point.y)), 0.5);
        let place = |(x, y, align): (f64, f64, f64), cost: f64| {
            let Text { x, y, align, .. } =
                self.kept_inside(Text { x, y: Vertical::Middle(y), align, ..text.clone() });
            TextPlace { x, y, align, cost }
        };
        let others = match side {
            Side::Above | Side::Below => [side, opposite(side), Side::Right, Side::Left],
            Side::Left | Side::Right => [side, opposite(side), Side::Above, Side::Below],
        };
        let sides = (0..=MAX_LINES_AWAY).flat_map(|lines| {
            let lines = f64::from(lines);
            [0, 1, 2, 3].map(|number| {
                let cost = COST_OF_DISTANCE * lines + COSTS_OF_SIDES[number];
                place(at_side(others[number], lines * LINE * height), cost)
            })
        });
        let corners = [Side::Above, Side::Below].into_iter().flat_map(|side| {
            let y = at_side(side, 0.0).1;
            [(area.right, 0.0), (area.left, 1.0)].map(|(x, align)| place((x, y, align), COST_OF_CORNER))
        });
        let places = sides.chain(corners).collect();
        Some(Movable { key, text, places })
    }

    /// Moves a text to the edge of the picture if it would extend beyond this edge.
    pub(in crate::picture) fn kept_inside<'a>(&self, text: Text<'a>) -> Text<'a> {
        let area = text.area(self.aspect);
        let edge = 1.0 - MARGIN / 2.0;
        let shift = |low: f64, high: f64, edge: f64| {
            if high - low > 2.0 * edge {
                -(low + high) / 2.0
            } else {
                (edge - high).min(0.0) + (-edge - low).max(0.0)
            }
        };
        let x = text.x + shift(area.left, area.right, edge);
        let y = text.y.raised(shift(area.bottom, area.top, self.aspect - MARGIN / 2.0));
        Text { x, y, ..text }
    }
}

/// The opposite side of a body.
fn opposite(side: Side) -> Side {
    match side {
        Side::Above => Side::Below,
        Side::Below => Side::Above,
        Side::Left => Side::Right,
        Side::Right => Side::Left,
    }
}

//! Dimension lines: a line between two points with ticks at its ends, and the distance as a text.

use std::sync::Arc;

use glam::{BVec3, DVec3};

use super::angle::drawn;
use super::{FrameView, HELPING_LINE_RADIUS, MAIN_LINE_RADIUS, Mark, Note, Says, Sides, Sketch};
use crate::physics::Anchor;
use crate::picture::length::prefixed;
use crate::picture::number;
use crate::picture::thing::{Form, Line, Thing};
use crate::scene::{Color, Distance, Scene};
use crate::simulate::{Bounds, DistanceNow};

/// The length of a tick on each side of the line, relative to the width in view.
const TICK_LENGTH: f64 = 0.009;
/// The smallest difference of lengths that a text shows, relative to the width in view, up to a factor of ten.
const MIN_SHOWN_DIFFERENCE: f64 = 0.005;

#[derive(Debug)]
struct DistanceMark {
    /// The distance, with its points on bodies in their drawn size.
    distance: Distance,
    name: String,
    color: Color,
}

/// Plans the marks for the distances of a scene.
pub(super) fn marks(scene: &Scene, ink: Color) -> Vec<Arc<dyn Mark>> {
    let mark = |distance: &Distance| {
        let between = distance.between.map(|end| drawn(end, &scene.bodies));
        let (name, color) = (format!("distance {}", distance.name), distance.color.unwrap_or(ink));
        Arc::new(DistanceMark { distance: Distance { between, ..distance.clone() }, name, color })
            as Arc<dyn Mark>
    };
    scene.distances.iter().map(mark).collect()
}

/// Extends the bounds of a run by the dimension lines that stand beside its bodies. `bounds` contain the bodies and all fixed points. The
/// place of a moving end is not known here, so each corner of the bounds counts as one.
pub(in crate::picture) fn with_lines(scene: &Scene, bounds: Bounds) -> Bounds {
    let Bounds { min, max } = bounds;
    let corners = (0..8).map(|corner: u32| {
        let pick = |axis: u32| corner >> axis & 1 == 1;
        DVec3::select(BVec3::new(pick(0), pick(1), pick(2)), max, min)
    });
    let ends = |distance: &Distance| {
        let Distance { between, along, offset, .. } = distance.clone();
        let corners = corners.clone();
        corners.map(move |corner| match (between[0], along) {
            (Anchor::Point(begin), Some(along)) => begin + offset + along * (corner - begin).dot(along),
            _ => corner + offset,
        })
    };
    let beside = scene.distances.iter().filter(|distance| distance.offset != DVec3::ZERO);
    let points = beside.flat_map(ends).map(|point| Bounds { min: point, max: point });
    points.fold(bounds, Bounds::union)
}

impl Mark for DistanceMark {
    fn draw<'a>(&'a self, scale: &FrameView<'_>, sketch: &mut Sketch<'a>) {
        let Some(now) = DistanceNow::of(&self.distance, &scale.frame.bodies) else { return };
        let [begin, end] = now.line;
        let middle = (begin + end) / 2.0;
        let aside = scale.camera.towards(middle).cross(end - begin);
        let aside = aside.try_normalize().unwrap_or(scale.screen.up());
        let tick = aside * TICK_LENGTH * scale.view;
        let line = |from: DVec3, to: DVec3, radius: f64| Line { from, to, radius: radius * scale.stroke };
        let mut lines = vec![
            line(begin, end, MAIN_LINE_RADIUS),
            line(begin - tick, begin + tick, MAIN_LINE_RADIUS),
            line(end - tick, end + tick, MAIN_LINE_RADIUS),
        ];
        lines.extend([0, 1].map(|i| line(now.ends[i], now.line[i], HELPING_LINE_RADIUS)));
        lines.retain(|line| line.from.distance(line.to) > line.radius);
        sketch.things.push(Thing {
            name: self.name.as_str().into(),
            form: Form::Lines { lines },
            color: self.color,
        });
        // The text stands on the side of the offset; without an offset, on either side.
        let outward = self.distance.offset.dot(aside);
        let is_beside = outward.abs() > 1e-9 * scale.view;
        sketch.notes.push(Note {
            name: &self.name,
            number: 0,
            says: self
                .distance
                .text
                .as_deref()
                .map_or_else(|| Says::Words(with_unit(now.value, scale.view)), Says::Text),
            at: middle_of_visible([begin, end], scale).unwrap_or(middle),
            away: if is_beside { aside * outward.signum() } else { aside },
            sides: if is_beside { Sides::Wanted } else { Sides::Both },
            color: self.color,
        });
    }
}

/// The middle of the part of a line that is in the picture. `None` if no part is.
fn middle_of_visible([begin, end]: [DVec3; 2], scale: &FrameView<'_>) -> Option<DVec3> {
    /// The number of points of the line that are tried.
    const TRIED_POINTS: u32 = 64;
    let is_visible = |point: &DVec3| {
        let spot = scale.screen.project(*point);
        spot.is_some_and(|spot| spot.x.abs() < 1.0 && spot.y.abs() < scale.aspect)
    };
    let points =
        (0..=TRIED_POINTS).map(|number| begin.lerp(end, f64::from(number) / f64::from(TRIED_POINTS)));
    let visible: Vec<DVec3> = points.filter(is_visible).collect();
    Some((*visible.first()? + *visible.last()?) / 2.0)
}

/// Writes a length. The unit and the number of decimals follow from the width in view (m), so that they stay the same while the length
/// changes.
fn with_unit(length: f64, view: f64) -> String {
    let (unit, symbol) = prefixed(0.1 * view);
    let decimals = -libm::floor(libm::log10(MIN_SHOWN_DIFFERENCE * view / unit));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is limited")]
    let decimals = decimals.clamp(0.0, 6.0) as usize;
    format!("{} {symbol}", number::typeset(&format!("{:.decimals$}", length / unit)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_the_unit_and_the_decimals_of_the_picture() {
        for (length, view, said) in [
            (1.23456, 5.0, "1.23 m"),
            (0.05, 5.0, "0.05 m"),
            (0.05, 0.3, "5.0 cm"),
            (123.456, 200.0, "123 m"),
            (0.0, 5.0, "0.00 m"),
            (384.4e6, 1e9, "384400 km"),
        ] {
            assert_eq!(with_unit(length, view), said);
        }
    }
}

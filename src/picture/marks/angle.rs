//! Angles: an arc between two legs, with a text.

use std::sync::Arc;

use super::{FrameView, HELPING_LINE_RADIUS, MAIN_LINE_RADIUS, Mark, Note, Says, Sides, Sketch};
use crate::physics::Anchor;
use crate::picture::thing::{Form, Line, Thing};
use crate::scene::{Angle, Body, Color, Leg, Scene};
use crate::simulate::{AngleNow, Measures};

/// The default radius of an arc, relative to the width in view.
const USUAL_RADIUS: f64 = 0.1;
/// The length of a leg's line, relative to the radius of the arc.
const LEG_LENGTH: f64 = 1.3;
/// The largest angle between two neighboring points of an arc, rad.
const MAX_BEND: f64 = 0.08;

#[derive(Debug)]
struct AngleMark {
    /// The angle, with its points on bodies in their drawn size.
    angle: Angle,
    /// Has the bodies of the scene.
    measures: Arc<Measures>,
    name: String,
    color: Color,
}

/// Plans the marks for the angles of a scene.
pub(super) fn marks(scene: &Scene, measures: &Arc<Measures>, ink: Color) -> Vec<Arc<dyn Mark>> {
    let bodies = scene.bodies.as_slice();
    let mark = |angle: &Angle| {
        let leg = |leg: Leg| match leg {
            Leg::Towards(point) => Leg::Towards(drawn(point, bodies)),
            leg => leg,
        };
        let angle = Angle { vertex: drawn(angle.vertex, bodies), legs: angle.legs.map(leg), ..angle.clone() };
        let (name, color) = (format!("angle {}", angle.name), angle.color.unwrap_or(ink));
        Arc::new(AngleMark { angle, measures: measures.clone(), name, color }) as Arc<dyn Mark>
    };
    scene.angles.iter().map(mark).collect()
}

/// Moves a point of a body to where it is on the drawn body, which may be larger.
pub(super) fn drawn(anchor: Anchor, bodies: &[Body]) -> Anchor {
    match anchor {
        Anchor::Body { id, at } => Anchor::Body { id, at: at * bodies[id.index()].look.scale },
        Anchor::Point(_) => anchor,
    }
}

impl Mark for AngleMark {
    fn draw<'a>(&'a self, scale: &FrameView<'_>, sketch: &mut Sketch<'a>) {
        let Some(now) = AngleNow::of(&self.angle, self.measures.bodies(), &scale.frame.bodies) else {
            return;
        };
        let size = self.angle.radius.unwrap_or(USUAL_RADIUS * scale.view);
        let line = |from, to, radius: f64| Line { from, to, radius: radius * scale.stroke };
        let pieces = (now.value.abs() / MAX_BEND).ceil().max(1.0);
        let point = |number: f64| now.vertex + now.leg(number / pieces) * size;
        let mut lines = Vec::new();
        for leg in [0.0, 1.0] {
            let end = now.vertex + now.leg(leg) * size * LEG_LENGTH;
            lines.push(line(now.vertex, end, HELPING_LINE_RADIUS));
        }
        let mut number = 0.0;
        while number < pieces {
            lines.push(line(point(number), point(number + 1.0), MAIN_LINE_RADIUS));
            number += 1.0;
        }
        sketch.things.push(Thing {
            name: self.name.as_str().into(),
            form: Form::Lines { lines },
            color: self.color,
        });
        sketch.notes.push(Note {
            name: &self.name,
            number: 0,
            says: Says::Text(&self.angle.text),
            at: now.vertex + now.leg(0.5) * size,
            away: now.leg(0.5),
            sides: Sides::Wanted,
            color: self.color,
        });
    }
}

//! What is drawn with arrows: a text at the tip, and components along and across a direction.

use std::collections::HashMap;

use super::{HELPING_LINE_RADIUS, Note, Says, Sides, Sketch};
use crate::picture::arrows::{Arrow, Arrows};
use crate::picture::thing::{Form, Line, Thing};
use crate::scene::{ArrowMark, ArrowOwner, Piece, Quantity, Scene};
use crate::simulate::{Frame, direction};

/// The radius of a component's shaft, relative to that of its arrow.
const COMPONENT_RADIUS: f64 = 0.7;
/// The length below which an arrow is too short for a text, relative to the width of a clearly visible line.
const SHORTEST_NAMED: f64 = 3.0;
/// The length below which a component is omitted, relative to its arrow.
const MIN_COMPONENT: f64 = 1e-3;

/// The texts and components of the arrows of a scene.
#[derive(Clone, Debug)]
pub(in crate::picture) struct ArrowMarks {
    marks: HashMap<(ArrowOwner, Quantity), Named>,
}

/// A mark, with the name of its arrow in scripts.
#[derive(Clone, Debug)]
struct Named {
    name: String,
    mark: ArrowMark,
}

impl ArrowMarks {
    pub(in crate::picture) fn new(scene: &Scene) -> ArrowMarks {
        let mark = |mark: &ArrowMark| {
            let owner = match mark.owner {
                ArrowOwner::Body(body) => &*scene.bodies[body].name,
                ArrowOwner::Joint(joint) => &scene.joints[joint].name,
                ArrowOwner::Force(force) => &scene.forces[force].name,
            };
            let name = format!("{owner}, {}", mark.quantity.name());
            ((mark.owner, mark.quantity), Named { name, mark: mark.clone() })
        };
        ArrowMarks { marks: scene.arrow_marks.iter().map(mark).collect() }
    }

    pub(in crate::picture) fn is_empty(&self) -> bool {
        self.marks.is_empty()
    }

    /// Draws the texts and components of the arrows of a frame. `stroke` is the width of a clearly visible line, m.
    pub(in crate::picture) fn sketch(
        &self,
        arrows: &[Arrow],
        of: &Arrows,
        frame: &Frame,
        stroke: f64,
    ) -> Sketch<'_> {
        let mut sketch = Sketch::default();
        for arrow in arrows {
            let Some(named) = self.marks.get(&(arrow.owner, arrow.quantity)) else { continue };
            named.draw(arrow, of, frame, stroke, &mut sketch);
        }
        sketch
    }
}

impl Named {
    fn draw<'a>(&'a self, arrow: &Arrow, of: &Arrows, frame: &Frame, stroke: f64, sketch: &mut Sketch<'a>) {
        let mut note = |number: u8, arrow: &Arrow, text: &'a [Piece]| {
            let way = arrow.to - arrow.from;
            if way.length() < SHORTEST_NAMED * stroke {
                return;
            }
            let away = way.normalize_or_zero();
            let Arrow { to: at, color, .. } = *arrow;
            let (name, says, sides) = (&self.name, Says::Text(text), Sides::Wanted);
            sketch.notes.push(Note { name, number, says, at, away, sides, color });
        };
        if let Some(text) = &self.mark.text {
            note(0, arrow, text);
        }
        let Some(components) = &self.mark.components else { return };
        let whole = arrow.to - arrow.from;
        let bodies = of.measures().bodies();
        // An arrow may begin at the surface of its body, and in front of it.
        let body = arrow.body.filter(|_| !matches!(arrow.owner, ArrowOwner::Joint(_)));
        let vertex = body.and_then(|body| frame.body(body)).map_or(arrow.from, |body| body.location);
        let Some(along) = direction(components.along, vertex, bodies, &frame.bodies) else { return };
        let along = along * whole.dot(along);
        let mut helping = Vec::new();
        for (number, way) in [(0, along), (1, whole - along)] {
            if way.length() <= MIN_COMPONENT * whole.length() {
                continue;
            }
            let to = arrow.from + way;
            let component = Arrow { to, radius: COMPONENT_RADIUS * arrow.radius, ..*arrow };
            sketch.things.push(of.thing(&component));
            helping.push(Line { from: to, to: arrow.to, radius: HELPING_LINE_RADIUS * stroke });
            if let Some(texts) = &components.texts {
                note(number + 1, &component, &texts[usize::from(number)]);
            }
        }
        if helping.len() == 2 {
            let name = format!("{}, components", self.name).into();
            sketch.things.push(Thing { name, form: Form::Lines { lines: helping }, color: arrow.color });
        }
    }
}

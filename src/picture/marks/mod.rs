//! Marks: what a scene measures or names in the picture, such as angles and dimension lines.
//!
//! A mark draws itself in each frame as a list of things and notes (texts at points of the world). Everything else follows from these
//! lists: scripts, page, room for texts. A new kind of mark is one file here, and a line in [`Marks::new`].

mod angle;
mod area;
mod arrow;
mod distance;
mod field;
mod liquid;
mod note;

use std::fmt::Debug;
use std::sync::Arc;

pub(super) use self::arrow::ArrowMarks;
pub(super) use self::distance::with_lines;
pub(super) use self::note::{Note, Says, Sides, movable};

use super::camera::Placed;
use super::screen::Screen;
use super::stage::Stage;
use super::thing::Thing;
use crate::scene::{Color, Scene};
use crate::simulate::{Frame, Measures};

/// The radius of a mark's main line, in strokes. A stroke is the width of a clearly visible line.
const MAIN_LINE_RADIUS: f64 = 0.4;
/// The radius of a mark's helping line, in strokes.
const HELPING_LINE_RADIUS: f64 = 0.22;

/// A frame, and how its camera sees it.
pub(super) struct FrameView<'a> {
    pub(super) frame: &'a Frame,
    pub(super) camera: &'a Placed,
    pub(super) screen: &'a Screen,
    /// The height of the picture, relative to its width.
    pub(super) aspect: f64,
    /// The width in view of the camera, m.
    pub(super) view: f64,
    /// The width of a clearly visible line, m.
    pub(super) stroke: f64,
}

/// What marks draw in a frame.
#[derive(Default)]
pub(super) struct Sketch<'a> {
    pub(super) things: Vec<Thing<'a>>,
    pub(super) notes: Vec<Note<'a>>,
}

/// Something that a scene measures or names in the picture.
trait Mark: Debug + Send + Sync {
    /// Draws the mark in a frame. Draws nothing while a body that it needs is absent.
    fn draw<'a>(&'a self, scale: &FrameView<'_>, sketch: &mut Sketch<'a>);
}

/// The marks of a scene.
#[derive(Clone, Debug)]
pub(super) struct Marks {
    marks: Vec<Arc<dyn Mark>>,
}

impl Marks {
    /// Plans the marks of a scene, on a stage. `camera` is the camera at the start, with the width of its view (m); `ink` is their default color.
    pub(super) fn new(
        scene: &Scene,
        measures: &Arc<Measures>,
        stage: &Stage,
        camera: (&Placed, f64),
        ink: Color,
    ) -> Marks {
        let mut marks: Vec<Arc<dyn Mark>> = liquid::marks(scene, camera.0, camera.1);
        marks.extend(area::marks(scene));
        marks.extend(field::marks(scene, stage, camera));
        marks.extend(angle::marks(scene, measures, ink));
        marks.extend(distance::marks(scene, ink));
        Marks { marks }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.marks.is_empty()
    }

    /// Draws all marks in a frame.
    pub(super) fn sketch(&self, scale: &FrameView<'_>) -> Sketch<'_> {
        let mut sketch = Sketch::default();
        self.marks.iter().for_each(|mark| mark.draw(scale, &mut sketch));
        sketch
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::picture::{Form, Plan, Text, Thing};
    use crate::scene::Scene;
    use crate::simulate::{Frame, Frames, survey};

    /// A pendulum with a bob at 60° from the vertical, and marks.
    fn pendulum(marks: &str) -> (Plan, Frame) {
        let text = format!(
            "simulation = {{ duration = 1, gravity = [0, -10, 0], integrator = 'rk4' }}
            [body.bob]\nshape.sphere.radius = 0.1\nlocation = ['sin(rad(60))', 'cos(rad(60))', 0]\n{marks}
            [joint.string.rod]\nbetween = [[0, 1, 0], 'bob']"
        );
        let scene = Scene::parse(&text).unwrap_or_else(|report| panic!("{report}"));
        let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
        (plan, Frames::new(&scene).next().unwrap().unwrap())
    }

    fn lines<'a>(marks: &'a [Thing<'_>], name: &str) -> &'a Thing<'a> {
        marks.iter().find(|thing| thing.name == name).unwrap_or_else(|| panic!("{marks:?}"))
    }

    fn text<'a>(texts: &'a [Text<'_>], name: &str) -> &'a Text<'a> {
        texts.iter().find(|text| text.name == name).unwrap_or_else(|| panic!("{texts:?}"))
    }

    /// The arc goes from one leg to the other, at its radius from the vertex. Its text stands outside of it, in its middle.
    #[test]
    fn an_angle_is_an_arc_from_leg_to_leg() {
        let (plan, frame) =
            pendulum("[angle.phi]\nat = [0, 1, 0]\nfrom = [0, -1, 0]\nto = 'bob'\nradius = 0.5");
        let marks = plan.marks(&frame);
        let lines = lines(&marks, "angle phi").lines();
        let vertex = DVec3::Y;
        let arc = &lines[2..];
        assert!(arc.len() > 8, "{arc:?}");
        for line in arc {
            for point in [line.from, line.to] {
                assert!((point.distance(vertex) - 0.5).abs() < 1e-9, "{point}");
            }
        }
        assert!(arc[0].from.abs_diff_eq(vertex - DVec3::Y * 0.5, 1e-9));
        let bob = frame.bodies[0].location;
        assert!(arc[arc.len() - 1].to.abs_diff_eq(vertex + (bob - vertex).normalize() * 0.5, 1e-9));
        let texts = plan.texts(&frame);
        let text = text(&texts, "angle phi");
        assert_eq!(text.says, "φ");
        let screen = plan.screen(&frame).unwrap();
        let [inner, outer] = [0.5, 1.0]
            .map(|way| screen.project(vertex + DVec3::new(0.5, -0.75_f64.sqrt(), 0.0) * way).unwrap());
        let place = (text.x - inner.x) * (outer.x - inner.x)
            + (text.y.above_middle(0.5625) - inner.y) * (outer.y - inner.y);
        assert!(place > 0.0, "{text:?} is inside");
    }

    #[test]
    fn a_dimension_line_has_its_length_and_ticks_at_its_ends() {
        let (plan, frame) = pendulum(
            "[distance.h]\nbetween = [[0, 0, 0], 'bob']\nalong = [0, 1, 0]\noffset = [2, 0, 0]\n[output]\ndecimal = ','",
        );
        let marks = plan.marks(&frame);
        let lines = lines(&marks, "distance h").lines();
        assert!(lines[0].from.abs_diff_eq(DVec3::new(2.0, 0.0, 0.0), 1e-9), "{lines:?}");
        assert!(lines[0].to.abs_diff_eq(DVec3::new(2.0, 0.5, 0.0), 1e-9), "{lines:?}");
        for tick in &lines[1..3] {
            assert!((tick.to - tick.from).normalize().dot(DVec3::Y).abs() < 1e-9, "{tick:?}");
        }
        assert_eq!(text(&plan.texts(&frame), "distance h").says, "0,50 m");
    }

    /// The components of the weight along the string and across it are G cos 60° and G sin 60°.
    #[test]
    fn components_add_up_to_their_arrow() {
        let (plan, frame) = pendulum(
            "arrows.weight = { label = 'G', scale = 0.1, components = ['sin(rad(60))', '-cos(rad(60))', 0], component_labels = ['a', 'b'] }",
        );
        let marks = plan.marks(&frame);
        let arrows = marks.iter().filter_map(|thing| match thing.form {
            Form::Arrow { from, to, .. } => Some(to - from),
            _ => None,
        });
        let [whole, along, across] = arrows.collect::<Vec<_>>()[..] else { panic!("{marks:?}") };
        assert!((along + across).abs_diff_eq(whole, 1e-12) && along.dot(across).abs() < 1e-9);
        assert!((along.length() / whole.length() - 0.5).abs() < 1e-9);
        let texts = plan.texts(&frame);
        let says: Vec<&str> = texts.iter().map(|text| text.says.as_ref()).collect();
        assert_eq!(says, ["G", "a", "b"]);
    }
}

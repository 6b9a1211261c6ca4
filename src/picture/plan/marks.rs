//! Collects the arrows, axes and marks of a frame, and moves them in front of what would hide them.

use super::Plan;
use crate::picture::arrows::Arrow;
use crate::picture::in_front::lift_from_link;
use crate::picture::marks::{FrameView, Sketch};
use crate::picture::thing::{Form, Thing};
use crate::scene::ArrowOwner;
use crate::simulate::{Frame, Ghost};

impl Plan {
    /// What a frame shows of measured quantities: arrows, axes, angles, distances. The arrows and axes of one body follow each other. What
    /// the ground or a spring would hide is moved towards the camera, in such a way that it looks the same in the picture.
    pub fn marks(&self, frame: &Frame) -> Vec<Thing<'_>> {
        let arrows = self.arrows_in_front(frame);
        let of_arrows = self.sketch_of_arrows(frame, &arrows);
        let mut arrows = arrows.into_iter().peekable();
        let mut marks = Vec::new();
        for (its, axes) in self.arrows.axes(frame) {
            let is_before = |arrow: &Arrow| {
                !matches!(arrow.owner, ArrowOwner::Joint(_)) && arrow.body.is_some_and(|body| body <= its)
            };
            while let Some(before) = arrows.next_if(is_before) {
                marks.push(self.arrows.thing(&before));
            }
            marks.push(axes);
        }
        marks.extend(arrows.map(|arrow| self.arrows.thing(&arrow)));
        marks.extend(of_arrows.things);
        marks.extend(self.sketch(frame).things);
        marks
    }

    /// The arrows of a ghost, moved in front of the ground. They show the quantities at the time of the ghost.
    pub fn ghost_marks(&self, frame: &Frame, ghost: &Ghost) -> Vec<Thing<'_>> {
        let mut arrows = self.ghost_arrows(frame, ghost);
        let camera = self.eye.at(frame);
        arrows.iter_mut().for_each(|arrow| self.planes.lift(arrow, &camera));
        arrows.iter().map(|arrow| self.arrows.thing(arrow)).collect()
    }

    /// The things and notes of angles and dimension lines in a frame, moved in front of the ground.
    pub(super) fn sketch(&self, frame: &Frame) -> Sketch<'_> {
        if self.marks.is_empty() {
            return Sketch::default();
        }
        let (camera, sizes) = (self.eye.at(frame), self.sizes(frame));
        let screen = camera.screen();
        let scale = FrameView {
            frame,
            camera: &camera,
            screen: &screen,
            aspect: self.labels.aspect(),
            view: sizes.view,
            stroke: sizes.lines.stroke,
        };
        let mut sketch = self.marks.sketch(&scale);
        for thing in &mut sketch.things {
            match &mut thing.form {
                Form::Lines { lines } => {
                    lines.iter_mut().for_each(|line| self.planes.lift_line(line, [line.radius; 2], &camera));
                }
                Form::Area { points, .. } => self.planes.lift_area(points, sizes.lines.stroke, &camera),
                _ => {}
            }
        }
        sketch
    }

    /// The texts and components of the arrows of a frame.
    pub(super) fn sketch_of_arrows(&self, frame: &Frame, arrows: &[Arrow]) -> Sketch<'_> {
        self.arrow_marks.sketch(arrows, &self.arrows, frame, self.sizes(frame).lines.stroke)
    }

    /// The arrows of a frame, moved in front of what would hide them.
    pub(super) fn arrows_in_front(&self, frame: &Frame) -> Vec<Arrow> {
        let mut arrows = self.arrows(frame);
        if !arrows.is_empty() {
            let camera = self.eye.at(frame);
            for arrow in &mut arrows {
                self.planes.lift(arrow, &camera);
                for link in arrow.body.into_iter().flat_map(|body| self.links.of_body(body, frame)) {
                    lift_from_link(arrow, &link.form, &camera);
                }
            }
        }
        arrows
    }
}

//! Labels: texts in the picture, with current values.

mod beside;
mod corner;
mod said;

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use self::corner::{Taken, inset_without_overlap, under_bar, under_plot};
use self::said::longest;
use super::framing::Free;
use super::occupancy::{Occupancy, Rectangle};
use super::plots;
use super::screen::Screen;
use super::text::{MARGIN, Text, Vertical, least_height, width};
use crate::scene::{Color, Label, LabelPlace, Output, Scene};
use crate::simulate::{Frame, Ghost, Measures, MomentState};

/// The default height of a line of text, relative to the height of the picture.
const SIZE: f64 = 0.055;
/// The smallest default height of a line of text, pixels.
const LEAST_PIXELS: f64 = 13.0;
/// The distance between the base lines of two successive lines of text, relative to the height of a line.
const LINE: f64 = 1.15;

/// The labels of a scene.
#[derive(Clone, Debug)]
pub(super) struct Labels {
    labels: Vec<Planned>,
    measures: Arc<Measures>,
    /// The part of the picture that plots at its sides leave free.
    free: Free,
    /// The height of the picture, relative to its width.
    aspect: f64,
    /// The height of a note's line of text in the image plane.
    note_height: f64,
}

#[derive(Clone, Debug)]
struct Planned {
    label: Label,
    /// The height of a line of text in the image plane.
    height: f64,
    color: Color,
    /// The distance from the edge of the picture to the middle of the line. 0 for a label beside a body.
    inset: f64,
}

impl Labels {
    /// Plans the labels of a scene. `ink` is their default color. `panels` are those of plots, which no label covers. `measures` are those of
    /// the scene.
    pub(super) fn new(
        scene: &Scene,
        ink: Color,
        panels: impl Iterator<Item = Rectangle>,
        measures: Arc<Measures>,
    ) -> Labels {
        let aspect = f64::from(scene.output.height) / f64::from(scene.output.width);
        let free = plots::free(scene);
        let mut taken: Vec<Taken> =
            scene.scale_bar.map(|bar| under_bar(bar.corner, aspect, free)).into_iter().collect();
        taken.extend(panels.flat_map(|area| under_plot(area, aspect)));
        let plan = |label: &Label| {
            let mut height = height(label, scene.output);
            let mut inset = 0.0;
            if let LabelPlace::Corner(corner) = label.place {
                // A line wider than the picture gets smaller letters.
                let wide = width(&longest(label), 1.0);
                height = height.min(2.0 * (free.half - MARGIN) / wide.max(1e-9));
                inset =
                    inset_without_overlap(&mut taken, corner, [wide * height, height], (free, 2.0 * aspect));
            }
            Planned { label: label.clone(), height, color: label.color.unwrap_or(ink), inset }
        };
        let labels: Vec<Planned> = scene.labels.iter().map(plan).collect();
        Labels { labels, measures, free, aspect, note_height: usual_height(scene.output) }
    }

    /// The number of labels in the scene.
    pub(super) fn count(&self) -> usize {
        self.labels.len()
    }

    /// The height of a note's line of text in the image plane.
    pub(super) fn note_height(&self) -> f64 {
        self.note_height
    }

    /// Creates an empty record of the taken parts of a picture.
    pub(super) fn room(&self) -> Occupancy {
        Occupancy::new(self.aspect)
    }

    /// Returns the labels in the corners of a frame, each with its index in the scene.
    pub(super) fn in_corners(&self, frame: &Frame) -> Vec<(usize, Text<'_>)> {
        let now = MomentState::now(frame);
        let labels = self.labels.iter().enumerate();
        let text = |(number, planned)| Some((number, self.in_corner(planned, &now)?));
        labels.filter_map(text).collect()
    }

    /// Places the labels beside bodies in a frame, in free parts of `room`, and marks the places of these labels as taken. Returns each
    /// label with its index in the scene.
    pub(super) fn beside_bodies(
        &self,
        frame: &Frame,
        screen: &Screen,
        room: &mut Occupancy,
    ) -> Vec<(usize, Text<'_>)> {
        let now = MomentState::now(frame);
        let ghosts_of = self.ghosts_by_body(frame);
        let crowd = self.crowd(frame, screen);
        let mut texts = Vec::new();
        for (number, planned) in self.labels.iter().enumerate() {
            let LabelPlace::Body { body, side, ghosts } = planned.label.place else { continue };
            let here = frame.body(body);
            let text = here.and_then(|here| self.beside(planned, (here, side), &now, screen, (room, &crowd)));
            texts.extend(text.map(|text| (number, text)));
            let its = ghosts_of.get(&body).filter(|_| ghosts);
            for ghost in its.into_iter().flatten() {
                let then = MomentState::then(ghost);
                let text = self.beside(planned, (&ghost.body, side), &then, screen, (room, &crowd));
                texts.extend(text.map(|text| (number, text)));
            }
        }
        texts
    }

    /// The parts of a picture that bodies and ghosts cover.
    pub(super) fn crowd(&self, frame: &Frame, screen: &Screen) -> Occupancy {
        let mut crowd = self.room();
        let ghosts = frame.past.ghosts.iter().map(|ghost| &ghost.body);
        for body in frame.bodies.iter().chain(ghosts) {
            self.seen(body, screen).into_iter().for_each(|(_, area)| crowd.take(area));
        }
        crowd
    }

    /// Groups the ghosts of a frame by the indices of their bodies. Empty if ghosts have no labels.
    fn ghosts_by_body<'a>(&self, frame: &'a Frame) -> HashMap<usize, Vec<&'a Ghost>> {
        let mut by_body: HashMap<usize, Vec<&Ghost>> = HashMap::new();
        let at_ghosts =
            |planned: &Planned| matches!(planned.label.place, LabelPlace::Body { ghosts: true, .. });
        if self.labels.iter().any(at_ghosts) {
            frame.past.ghosts.iter().for_each(|ghost| by_body.entry(ghost.body.id).or_default().push(ghost));
        }
        by_body
    }
}

/// The height of a label's line of text in the image plane.
fn height(label: &Label, output: Output) -> f64 {
    let aspect = f64::from(output.height) / f64::from(output.width);
    label.size.map_or_else(|| usual_height(output), |size| 2.0 * aspect * size)
}

/// The default height of a line of text in the image plane.
fn usual_height(output: Output) -> f64 {
    let aspect = f64::from(output.height) / f64::from(output.width);
    (2.0 * aspect * SIZE).max(least_height(LEAST_PIXELS, output))
}

/// The height that a label takes in a corner of the picture.
pub(super) fn least_room(label: &Label, output: Output) -> f64 {
    LINE * height(label, output)
}

impl Planned {
    /// Creates the text of the label at a position in the image plane.
    fn text<'a>(&'a self, says: Cow<'a, str>, (x, y): (f64, Vertical), align: f64) -> Text<'a> {
        Text {
            name: &self.label.name,
            says,
            x,
            y,
            height: self.height,
            align,
            color: self.color,
            anchor: None,
        }
    }
}

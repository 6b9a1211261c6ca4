//! Labels: texts in the picture, with current values.

mod beside;
mod corner;
mod lines;
mod said;

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use self::corner::{Layout, Taken, under_bar, under_plot};
use self::lines::Block;
use super::framing::Free;
use super::occupancy::{Occupancy, Rectangle};
use super::plots;
use super::screen::Screen;
use super::surroundings::{Key, Movable};
use super::text::{MARGIN, Text, Vertical, is_top, usual_height};
use crate::font::Weight;
use crate::lettering;
use crate::scene::{Color, Corner, DecimalSign, Label, LabelPlace, Output, Scene};
use crate::simulate::{Frame, Ghost, Measures, MomentState};

/// The default height of a line of text, relative to the shorter side of the picture.
const DEFAULT_LABEL_HEIGHT: f64 = 0.055;
/// The default height of a line of text in the center of the picture, relative to the shorter side of the picture.
const SIZE_IN_CENTER: f64 = 0.1;
/// The smallest default height of a line of text, pixels.
const LEAST_PIXELS: f64 = 13.0;

/// The labels of a scene.
#[derive(Clone, Debug)]
pub(super) struct Labels {
    labels: Vec<Planned>,
    /// The places of the labels that stand at no body, in order of time.
    layouts: Vec<Layout>,
    measures: Arc<Measures>,
    /// The height of the picture, relative to its width.
    aspect: f64,
    /// The height of a note's line of text in the image plane.
    note_height: f64,
    /// The sign before the decimals of values.
    sign: DecimalSign,
}

#[derive(Clone, Debug)]
struct Planned {
    block: Block,
    color: Color,
}

/// The largest part of the picture's height that is kept free for labels at the top, and at the bottom.
const MAX_KEPT_FREE: f64 = 0.16;

/// The part of the picture's height that a camera leaves free at the top, and at the bottom, in any case.
const FREE_ANYWAY: f64 = 0.03;

/// Returns the part of the picture that plots at its sides and labels in its corners leave free.
pub(super) fn free(scene: &Scene) -> Free {
    let free = plots::free(scene);
    let height = 2.0 * f64::from(scene.output.height) / f64::from(scene.output.width);
    let kept = |at_top: bool| {
        let taken = Corner::ALL.into_iter().filter(|corner| is_top(*corner) == at_top).map(|corner| {
            let labels = scene.labels.iter().filter(|label| label.place == LabelPlace::Corner(corner));
            let high = |label: &Label| Block::new(label, free, scene.output).high();
            let (always, sometimes): (Vec<&Label>, Vec<&Label>) =
                labels.partition(|label| label.visible == Label::ALWAYS);
            // Labels that come and go take turns.
            let high = always.into_iter().map(high).sum::<f64>()
                + sometimes.into_iter().map(high).fold(0.0, f64::max);
            if high > 0.0 { (MARGIN + high) / height - FREE_ANYWAY } else { 0.0 }
        });
        taken.fold(0.0, f64::max).min(MAX_KEPT_FREE)
    };
    free.between([kept(true), kept(false)])
}

/// Replaces the letters of a text that the label's own font lacks by letters that it has.
fn adapted<'a>(label: &Label, says: Cow<'a, str>) -> Cow<'a, str> {
    match &label.own_typeface {
        Some(typeface) => lettering::adapted(&says, typeface.font(Weight::Regular)).into(),
        None => says,
    }
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
            scene.scale_bar.map(|bar| under_bar(bar.corner, scene.output, free)).into_iter().collect();
        taken.extend(panels.flat_map(|area| under_plot(area, aspect)));
        let plan = |label: &Label| Planned {
            block: Block::new(label, free, scene.output),
            color: label.color.unwrap_or(ink),
        };
        let labels: Vec<Planned> = scene.labels.iter().map(plan).collect();
        let layout = |time| Layout::new(&labels, time, taken.clone(), (free, aspect));
        let layouts = times(&scene.labels).into_iter().map(layout).collect();
        let (note_height, sign) =
            (usual_height(DEFAULT_LABEL_HEIGHT, LEAST_PIXELS, scene.output), scene.output.decimal);
        Labels { labels, layouts, measures, aspect, note_height, sign }
    }

    /// The height of the picture, relative to its width.
    pub(super) fn aspect(&self) -> f64 {
        self.aspect
    }

    /// The height of a note's line of text in the image plane.
    pub(super) fn note_height(&self) -> f64 {
        self.note_height
    }

    /// Creates an empty record of the taken parts of a picture.
    pub(super) fn room(&self) -> Occupancy {
        Occupancy::new(self.aspect)
    }

    /// Returns the labels in the corners and in the center of a frame, each with its index in the scene.
    pub(super) fn in_corners(&self, frame: &Frame) -> Vec<(usize, Text<'_>)> {
        let now = MomentState::now(frame);
        let next = self.layouts.partition_point(|layout| layout.from <= frame.time);
        let Some(layout) = next.checked_sub(1).and_then(|number| self.layouts.get(number)) else {
            return Vec::new();
        };
        let text = |(number, place): &(usize, corner::FirstLine)| {
            let planned = &self.labels[*number];
            let said = self.said(&planned.block.label.text, &now);
            (*number, planned.text(said.into(), (place.x, place.y), place.align))
        };
        layout.places.iter().map(text).collect()
    }

    /// The labels beside bodies and ghosts in a frame, with their possible places.
    pub(super) fn beside_bodies(&self, frame: &Frame, screen: &Screen) -> Vec<Movable<'_>> {
        let now = MomentState::now(frame);
        let ghosts_of = self.ghosts_by_body(frame);
        let mut movables = Vec::new();
        for (number, planned) in self.labels.iter().enumerate() {
            let LabelPlace::Body { body, side, ghosts } = planned.block.label.place else { continue };
            if !planned.block.label.is_visible(frame.time) {
                continue;
            }
            let here = frame.body(body);
            let key = Key::Label(number);
            movables.extend(here.and_then(|here| self.beside(planned, (here, side), key, &now, screen)));
            let its = ghosts_of.get(&body).filter(|_| ghosts);
            for ghost in its.into_iter().flatten() {
                let (key, then) = (Key::Ghost(number, ghost.time.to_bits()), MomentState::then(ghost));
                movables.extend(self.beside(planned, (&ghost.body, side), key, &then, screen));
            }
        }
        movables
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
            |planned: &Planned| matches!(planned.block.label.place, LabelPlace::Body { ghosts: true, .. });
        if self.labels.iter().any(at_ghosts) {
            frame.past.ghosts.iter().for_each(|ghost| by_body.entry(ghost.body.id).or_default().push(ghost));
        }
        by_body
    }
}

/// The height of a label's line of text in the image plane.
fn height(label: &Label, output: Output) -> f64 {
    let aspect = f64::from(output.height) / f64::from(output.width);
    let size = if label.place == LabelPlace::Center { SIZE_IN_CENTER } else { DEFAULT_LABEL_HEIGHT };
    label.size.map_or_else(|| usual_height(size, LEAST_PIXELS, output), |size| 2.0 * aspect * size)
}

/// The times from which other labels are visible than before, s, in order. The first is −∞.
fn times(labels: &[Label]) -> Vec<f64> {
    let changes = labels.iter().filter(|label| !matches!(label.place, LabelPlace::Body { .. }));
    let changes = changes.flat_map(|label| label.visible).filter(|time| time.is_finite());
    let mut times: Vec<f64> = changes.chain([f64::NEG_INFINITY]).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// The largest height that labels take in corners of the picture.
pub(super) fn least_room(scene: &Scene, is_here: impl Fn(Corner) -> bool) -> f64 {
    let free = plots::free(scene);
    let is_in = |label: &&Label| matches!(label.place, LabelPlace::Corner(corner) if is_here(corner));
    let labels: Vec<&Label> = scene.labels.iter().filter(is_in).collect();
    let heights: Vec<f64> = labels.iter().map(|label| Block::new(label, free, scene.output).high()).collect();
    let at = |time: f64| {
        let visible = labels.iter().zip(&heights).filter(|(label, _)| label.is_visible(time));
        visible.map(|(_, height)| height).sum::<f64>()
    };
    times(&scene.labels).into_iter().map(at).fold(0.0, f64::max)
}

impl Planned {
    /// Creates the text of the label at a position in the image plane.
    fn text<'a>(&'a self, says: Cow<'a, str>, (x, y): (f64, Vertical), align: f64) -> Text<'a> {
        let Block { label, height, .. } = &self.block;
        Text {
            name: &label.name,
            says: adapted(label, says),
            x,
            y,
            height: *height,
            align,
            color: self.color,
            typeface: label.typeface(),
            anchor: None,
        }
    }
}

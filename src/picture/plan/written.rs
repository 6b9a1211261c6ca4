//! Places the texts of a frame where there is room.

use glam::DVec3;

use super::Plan;
use crate::picture::bar::Bar;
use crate::picture::marks::{self, Note, Sketch};
use crate::picture::screen::Screen;
use crate::picture::surroundings::Surroundings;
use crate::picture::text::Text;
use crate::picture::thing::Thing;
use crate::simulate::{Frame, MomentState};

/// The texts of a frame, by kind.
#[derive(Clone, Debug)]
pub struct Written<'a> {
    /// The image plane that the texts lie in.
    pub screen: Screen,
    /// The axis names and numbers of the grid.
    pub grid: Vec<Text<'a>>,
    /// The scale bar and its number.
    pub bar: Option<(Bar, Text<'a>)>,
    /// The names of arrows, and the texts of angles and dimension lines.
    pub named: Vec<Text<'a>>,
    /// The labels, in the order of the scene.
    pub labels: Vec<Text<'a>>,
}

impl Plan {
    /// The texts of a frame in a single list: axis names and numbers of the grid, the number of the scale bar, the texts of arrows and marks,
    /// the labels.
    pub fn texts<'a>(&'a self, frame: &Frame) -> Vec<Text<'a>> {
        let Some(Written { grid, bar, named, labels, .. }) = self.written(frame) else { return Vec::new() };
        grid.into_iter().chain(bar.map(|(_, number)| number)).chain(named).chain(labels).collect()
    }

    /// Places the texts of a frame. `None` if the scene has no texts.
    ///
    /// Labels in corners and the scale bar have fixed positions. The axis names of the grid are placed next, then the labels beside
    /// bodies and the texts of arrows and marks, then the numbers of the grid, each where there is room. No text covers a spring or joint, except an axis name without
    /// another free position.
    pub fn written<'a>(&'a self, frame: &Frame) -> Option<Written<'a>> {
        let screen = self.screen(frame)?;
        let mut room = self.labels.room();
        self.plots.areas().for_each(|area| room.take(area));
        let bar = self.bar.as_ref().and_then(|bar| bar.on(&screen));
        if let Some((bar, number)) = &bar {
            room.take_text(number);
            room.take(bar.area(room.aspect()));
        }
        let mut labels = self.labels.in_corners(frame);
        labels.iter().for_each(|(_, text)| room.take_text(text));
        let mut links = self.labels.room();
        for (line, width) in self.linked(frame) {
            links.cross(line, width, &screen);
        }
        let ruled = self.ruled(frame).map(|ruled| ruled.written(&screen, &room, &links));
        let (mut grid, numbers) = ruled.map_or_else(Default::default, |it| (it.titles, it.numbers));
        grid.iter().for_each(|title| room.take_text(title));
        let sketch = self.sketch(frame);
        let of_arrows = match self.arrow_marks.is_empty() {
            true => Sketch::default(),
            false => self.sketch_of_arrows(frame, &self.arrows_in_front(frame)),
        };
        let things: Vec<Thing<'_>> = of_arrows.things.into_iter().chain(sketch.things).collect();
        let notes: Vec<Note<'_>> = of_arrows.notes.into_iter().chain(sketch.notes).collect();
        let mut named = Vec::new();
        if self.labels.are_beside_bodies(frame.time) || !notes.is_empty() {
            let before = labels.len();
            let mut surroundings = Surroundings {
                texts: room,
                lines: self.labels.room(),
                bodies: self.labels.crowd(frame, &screen),
            };
            let avoided = things.iter().flat_map(|thing| thing.form.avoided());
            for (ends, width) in self.lines(frame).into_iter().chain(avoided) {
                surroundings.lines.cross(ends, width, &screen);
            }
            let mut beside = self.labels.room();
            named = marks::place(notes, &self.labels, &MomentState::now(frame), &screen, &mut surroundings);
            named.iter().for_each(|text| beside.take_text(text));
            labels.extend(self.labels.beside_bodies(frame, &screen, &mut surroundings));
            labels[before..].iter().for_each(|(_, text)| beside.take_text(text));
            grid.extend(numbers.into_iter().filter(|number| beside.has_room_for(number)));
            labels.sort_by_key(|(place, _)| *place);
        } else {
            grid.extend(numbers);
        }
        let labels = labels.into_iter().map(|(_, text)| text).collect();
        Some(Written { screen, grid, bar, named, labels })
    }

    /// The lines that labels avoid in a frame, each with its width, m: arrows, coordinate axes, springs and joints.
    fn lines(&self, frame: &Frame) -> Vec<([DVec3; 2], f64)> {
        let mut arrows = self.arrows(frame);
        arrows.extend(self.ghosts(frame).flat_map(|ghost| self.ghost_arrows(frame, ghost)));
        let arrows = arrows.into_iter().flat_map(|arrow| self.arrows.thing(&arrow).form.avoided());
        let axes = self.arrows.axes(frame).into_iter().flat_map(|(_, axes)| axes.form.avoided());
        arrows.chain(axes).chain(self.linked(frame)).collect()
    }

    /// The lines of springs and joints in a frame, each with its width, m.
    fn linked(&self, frame: &Frame) -> Vec<([DVec3; 2], f64)> {
        let links = self.links(frame);
        links.iter().flat_map(|link| link.form.avoided()).collect()
    }
}

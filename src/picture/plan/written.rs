//! Places the texts of a frame where there is room.

use glam::DVec3;

use super::Plan;
use crate::picture::bar::Bar;
use crate::picture::favored_places::Favored;
use crate::picture::marks::{self, Sketch};
use crate::picture::screen::Screen;
use crate::picture::surroundings::{Key, Movable, Surroundings};
use crate::picture::text::Text;
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

/// The texts of a frame, before those with several possible places are placed.
struct PartlyPlaced<'a> {
    screen: Screen,
    /// The axis names of the grid.
    grid: Vec<Text<'a>>,
    /// The numbers of the grid.
    numbers: Vec<Text<'a>>,
    bar: Option<(Bar, Text<'a>)>,
    /// The labels that stand at no body, each with its index in the scene.
    labels: Vec<(usize, Text<'a>)>,
    movables: Vec<Movable<'a>>,
    /// What the movable texts evade. `None` without such texts.
    surroundings: Option<Surroundings>,
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
    /// Labels in corners and the scale bar have fixed places. Then come the axis names of the grid, then the texts of arrows and marks, then the
    /// labels beside bodies. The numbers of the grid come last: a number without room is left out. A text near a body or an arrow evades
    /// springs, joints and bodies only as far as it stays near.
    pub fn written<'a>(&'a self, frame: &Frame) -> Option<Written<'a>> {
        let PartlyPlaced { screen, mut grid, numbers, bar, mut labels, movables, surroundings } =
            self.partly_placed(frame)?;
        let mut named = Vec::new();
        let mut moved = self.labels.room();
        let is_alone = surroundings.is_none();
        if let Some(mut surroundings) = surroundings {
            for movable in movables {
                let favored = self.favored.at(&movable.key, frame.time);
                let Some(text) = surroundings.settle(&movable, &favored) else { continue };
                moved.take_text(&text);
                match movable.key {
                    Key::Note(..) => named.push(text),
                    Key::Label(number) | Key::Ghost(number, _) => labels.push((number, text)),
                }
            }
        }
        grid.extend(numbers.into_iter().filter(|number| is_alone || moved.has_room_for(number)));
        labels.sort_by_key(|(place, _)| *place);
        let labels = labels.into_iter().map(|(_, text)| text).collect();
        Some(Written { screen, grid, bar, named, labels })
    }

    /// Chooses the favored places of texts from a sample of frames.
    pub(super) fn favored(&self, samples: &[Frame]) -> Favored {
        let sample = |frame: &Frame| {
            let partly = self.partly_placed(frame)?;
            Some((frame.time, partly.surroundings?, partly.movables))
        };
        Favored::new(samples.iter().filter_map(sample).collect())
    }

    /// Places the texts of a frame that have only one place, and finds the possible places of the others. `None` if the scene has no texts.
    fn partly_placed<'a>(&'a self, frame: &Frame) -> Option<PartlyPlaced<'a>> {
        let screen = self.screen(frame)?;
        let mut room = self.labels.room();
        self.plots.areas().for_each(|area| room.take(area));
        let bar = self.bar.as_ref().and_then(|bar| bar.on(&screen));
        if let Some((bar, number)) = &bar {
            room.take_text(number);
            room.take(bar.area(room.aspect()));
        }
        let labels = self.labels.in_corners(frame);
        labels.iter().for_each(|(_, text)| room.take_text(text));
        let mut links = self.labels.room();
        for (line, width) in self.linked(frame) {
            links.cross(line, width, &screen);
        }
        let ruled = self.ruled(frame).map(|ruled| ruled.written(&screen, &room, &links));
        let (grid, numbers) = ruled.map_or_else(Default::default, |it| (it.titles, it.numbers));
        grid.iter().for_each(|title| room.take_text(title));
        let sketch = self.sketch(frame);
        let of_arrows = match self.arrow_marks.is_empty() {
            true => Sketch::default(),
            false => self.sketch_of_arrows(frame, &self.arrows_in_front(frame)),
        };
        let now = MomentState::now(frame);
        let notes = of_arrows.notes.into_iter().chain(sketch.notes);
        let mut movables: Vec<Movable<'_>> =
            notes.filter_map(|note| marks::movable(note, &self.labels, &now, &screen)).collect();
        movables.extend(self.labels.beside_bodies(frame, &screen));
        let surroundings = (!movables.is_empty()).then(|| {
            let mut lines = self.labels.room();
            let avoided =
                of_arrows.things.iter().chain(&sketch.things).flat_map(|thing| thing.form.avoided());
            for (ends, width) in self.lines(frame).into_iter().chain(avoided) {
                lines.cross(ends, width, &screen);
            }
            Surroundings { texts: room, lines, bodies: self.labels.crowd(frame, &screen) }
        });
        Some(PartlyPlaced { screen, grid, numbers, bar, labels, movables, surroundings })
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

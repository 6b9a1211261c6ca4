//! Bodies that go into each other, since nothing keeps them apart.

use std::collections::HashSet;

use glam::{DQuat, DVec3};

use super::Frame;
use crate::dynamics::{Placed, Shape};
use crate::scene::Scene;

/// Bodies overlap when they still do after they have been made smaller by this part.
const DEEP: f64 = 0.01;

/// That two bodies go into each other, which were apart at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlap {
    /// The names of the two.
    pub bodies: [String; 2],
    /// The time of the first frame in which they overlap, s.
    pub time: f64,
}

/// Watches a run for the first two bodies that go into each other.
///
/// Bodies that touch in the first frame belong together and may do as they like; so may two of which neither is moved
/// by forces. What is not convex — meshes, rings — is not watched, and what happens between frames is not seen.
pub(super) struct Watch<'a> {
    bodies: Vec<Watched<'a>>,
    /// Pairs that have touched in the first frame; none before that.
    together: Option<HashSet<(usize, usize)>>,
    found: Option<Overlap>,
    scene: &'a Scene,
    /// Room for the cells of a frame.
    cells: Vec<(Cell, usize)>,
}

/// A body that is watched.
struct Watched<'a> {
    /// Its number in the scene.
    id: usize,
    /// Its convex parts, with their places in its frame.
    parts: Vec<(&'a Shape, DVec3, DQuat)>,
    /// The radius of a ball around its centre that holds it, m.
    radius: f64,
    /// Whether forces move it.
    moves: bool,
    /// Bodies of about the same size share a grid, with cells of 2 to the power of this, m.
    level: i32,
}

/// A cell of the grid of a level. Cells that are neighbours along x follow each other.
type Cell = (i32, i64, i64, i64);

impl<'a> Watch<'a> {
    pub(super) fn new(scene: &'a Scene) -> Watch<'a> {
        let watched = |(id, body): (usize, &'a crate::scene::Body)| {
            let whole = [(&body.shape, DVec3::ZERO, DQuat::IDENTITY)];
            let parts: Vec<_> = match &body.shape {
                Shape::Compound(compound) => compound
                    .parts()
                    .iter()
                    .map(|part| (&part.shape, part.location, part.orientation))
                    .collect(),
                _ => whole.to_vec(),
            };
            let parts: Vec<_> =
                parts.into_iter().filter(|(shape, ..)| shape.farthest(DVec3::X).is_some()).collect();
            let radius = body.shape.bounding_radius().filter(|radius| *radius > 0.0)?;
            let moves = !body.start.fixed && body.motion.is_none();
            #[allow(
                clippy::cast_possible_truncation,
                reason = "the sizes of a scene have logarithms of three digits"
            )]
            let level = libm::ceil(libm::log2(2.02 * radius)) as i32;
            (!parts.is_empty()).then_some(Watched { id, parts, radius, moves, level })
        };
        let bodies = scene.bodies.iter().enumerate().filter_map(watched).collect();
        Watch { bodies, together: None, found: None, scene, cells: Vec::new() }
    }

    /// Looks at the next frame of the run.
    pub(super) fn see(&mut self, frame: &Frame) {
        if self.found.is_some() || !self.bodies.iter().any(|body| body.moves) {
            return;
        }
        let mut cells = std::mem::take(&mut self.cells);
        cells.clear();
        cells.extend(
            self.bodies
                .iter()
                .enumerate()
                .map(|(i, body)| (cell(body.level, frame.bodies[body.id].location), i)),
        );
        cells.sort_unstable();
        let mut levels: Vec<i32> = self.bodies.iter().map(|body| body.level).collect();
        levels.sort_unstable();
        levels.dedup();
        match &self.together {
            None => {
                let mut together = HashSet::new();
                self.each_near_pair(frame, &cells, &levels, |i, j| {
                    if self.meet(frame, i, j, 1.0 + DEEP) {
                        together.insert((i, j));
                    }
                });
                self.together = Some(together);
            }
            Some(together) => {
                let mut first: Option<(usize, usize)> = None;
                self.each_near_pair(frame, &cells, &levels, |i, j| {
                    let is_earlier = first.is_none_or(|first| (i, j) < first);
                    if is_earlier && !together.contains(&(i, j)) && self.meet(frame, i, j, 1.0 - DEEP) {
                        first = Some((i, j));
                    }
                });
                let name = |i: usize| self.scene.bodies[self.bodies[i].id].name.clone();
                self.found = first.map(|(i, j)| Overlap { bodies: [name(i), name(j)], time: frame.time });
            }
        }
        self.cells = cells;
    }

    /// What has been found.
    pub(super) fn finish(self) -> Option<Overlap> {
        self.found
    }

    /// Shows every two bodies whose balls may meet and one of which moves, the one with the smaller number first. The work
    /// grows with the number of bodies, not with that of pairs.
    fn each_near_pair(
        &self,
        frame: &Frame,
        cells: &[(Cell, usize)],
        levels: &[i32],
        mut show: impl FnMut(usize, usize),
    ) {
        for (i, body) in self.bodies.iter().enumerate() {
            let here = frame.bodies[body.id].location;
            // Smaller bodies look for larger ones, so that a large one need not look through many cells.
            for &level in levels.iter().filter(|level| **level >= body.level) {
                let (_, z, y, x) = cell(level, here);
                for (z, y) in [-1, 0, 1].into_iter().flat_map(|dz| [-1, 0, 1].map(|dy| (z + dz, y + dy))) {
                    let begin = cells.partition_point(|(cell, _)| *cell < (level, z, y, x - 1));
                    let row = cells[begin..].iter().take_while(|(cell, _)| *cell <= (level, z, y, x + 1));
                    for &(_, j) in row {
                        let other = &self.bodies[j];
                        let is_pair = other.level > body.level || i < j;
                        let reach = (body.radius + other.radius) * (1.0 + DEEP);
                        let square = (frame.bodies[other.id].location - here).length_squared();
                        if is_pair && (body.moves || other.moves) && square < reach * reach {
                            show(i.min(j), i.max(j));
                        }
                    }
                }
            }
        }
    }

    /// Whether two bodies overlap that are so many times larger than they are.
    fn meet(&self, frame: &Frame, i: usize, j: usize, scale: f64) -> bool {
        let placed = |body: &Watched<'a>| {
            let at = frame.bodies[body.id];
            body.parts
                .iter()
                .map(|&(shape, location, orientation)| Placed {
                    shape,
                    location: at.location + at.orientation * location,
                    orientation: at.orientation * orientation,
                    scale,
                })
                .collect::<Vec<_>>()
        };
        let (ones, others) = (placed(&self.bodies[i]), placed(&self.bodies[j]));
        ones.iter().any(|one| others.iter().any(|other| one.meets(other)))
    }
}

#[allow(clippy::cast_possible_truncation, reason = "what is too far away to be counted shares the last cell")]
fn cell(level: i32, location: DVec3) -> Cell {
    let size = libm::ldexp(1.0, level);
    // One less than the largest number, so that a neighbour can be counted.
    let at = |coordinate: f64| libm::floor(coordinate / size).clamp(-9e15, 9e15) as i64;
    (level, at(location.z), at(location.y), at(location.x))
}

#[cfg(test)]
mod tests {
    use super::super::{Frames, survey};
    use super::*;

    fn overlap(text: &str) -> Option<Overlap> {
        survey(&Scene::parse(text).unwrap(), |_| {}).unwrap().overlap
    }

    fn found(one: &str, two: &str, time: f64) -> Option<Overlap> {
        Some(Overlap { bodies: [one.to_owned(), two.to_owned()], time })
    }

    #[test]
    fn balls_that_run_into_each_other_are_found_with_their_time() {
        let text = "
            [simulation]
            duration = 2
            frame_rate = 10
            [body.left]
            shape.sphere.radius = 0.5
            velocity = [2, 0, 0]
            [body.right]
            shape.sphere.radius = 0.5
            location = [3, 0, 0]
            [body.above]
            shape.box.size = [1, 1, 1]
            location = [0, 1.5, 0]
            ";
        // They touch at t = 1 s, and overlap by more than 0.01 m in the next frame.
        assert_eq!(overlap(text), found("left", "right", 1.1));
        // A hundredth of their size is none, and neither is what touches from the start.
        assert_eq!(overlap(&text.replace("duration = 2", "duration = 1")), None);
        assert_eq!(overlap(&text.replace("[3, 0, 0]", "[1, 0, 0]")), None);
        assert_eq!(overlap(&text.replace("[3, 0, 0]", "[0.2, 0, 0]")), None);
    }

    #[test]
    fn boxes_and_parts_of_compounds_are_found_where_their_surfaces_are() {
        let text = |shape: &str| {
            format!(
                "simulation = {{ duration = 4, frame_rate = 10 }}
                [body.wall]
                shape.box.size = [0.2, 4, 4]
                location = [3, 0, 0]
                fixed = true
                [body.thing]
                shape.{shape}
                velocity = [1, 0, 0]"
            )
        };
        assert_eq!(overlap(&text("box.size = [2, 0.1, 0.1]")), found("wall", "thing", 2.0));
        let dumbbell = "compound.parts = [{ sphere.radius = 0.5, location = [-2, 0, 0] }, { sphere.radius = 0.5, location = [2, 0, 0] }]";
        assert_eq!(overlap(&text(dumbbell)), found("wall", "thing", 0.5));
        // A ring is not convex: its middle is empty, and it is not watched.
        assert_eq!(overlap(&text("torus = { radius = 1, tube_radius = 0.1 }")), None);
    }

    #[test]
    fn what_is_given_to_overlap_may_do_so() {
        let text = "
            [simulation]
            duration = 2
            [body.piston]
            shape.box.size = [1, 1, 1]
            motion.formula.location = ['t', 0, 0]
            [body.cylinder]
            shape.box.size = [1, 1, 1]
            location = [3, 0, 0]
            fixed = true
            ";
        assert_eq!(overlap(text), None);
    }

    /// The grid finds the pairs that a look at every pair finds, whatever their sizes.
    #[test]
    fn near_pairs_are_those_of_all_pairs() {
        let mut text = String::from("simulation.duration = 0.04\n");
        for i in 0..400 {
            use std::fmt::Write;
            let at = |k: f64| (f64::from(i) * k).fract() * 20.0 - 10.0;
            let radius = 0.05 * libm::exp2(f64::from(i % 7));
            let (x, y, z) = (at(0.618_033), at(0.414_213), at(0.732_050));
            writeln!(text, "[body.b{i}]\nshape.sphere.radius = {radius}\nlocation = [{x}, {y}, {z}]")
                .unwrap();
        }
        let scene = Scene::parse(&text).unwrap();
        let frame = Frames::new(&scene).next().unwrap().unwrap();
        let mut watch = Watch::new(&scene);
        watch.see(&frame);
        let mut expected = HashSet::new();
        for i in 0..400 {
            for j in i + 1..400 {
                let reach = watch.bodies[i].radius + watch.bodies[j].radius;
                if (frame.bodies[i].location - frame.bodies[j].location).length() < 1.01 * reach {
                    expected.insert((i, j));
                }
            }
        }
        assert!(expected.len() > 300, "{}", expected.len());
        assert_eq!(watch.together, Some(expected));
    }
}

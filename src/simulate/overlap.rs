//! Bodies that go into each other, since nothing keeps them apart.

mod grid;

use std::collections::{BTreeMap, HashSet};

use glam::{DQuat, DVec3};

use self::grid::{Cell, Grid};
use super::Frame;
use crate::dynamics::{Placed, Shape};
use crate::scene::Scene;

/// Bodies overlap when they still do after they have been made smaller by this part.
const DEEP: f64 = 0.01;

/// That two bodies go into each other, which were apart when the later of them came.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlap {
    /// The names of the two.
    pub bodies: [String; 2],
    /// The time of the first frame in which they overlap, s.
    pub time: f64,
}

/// Watches a run for the first two bodies that go into each other.
///
/// Bodies that touch in the first frame in which both are there belong together and may do as they like; so may two that
/// a joint holds, and two of which neither is moved by forces. What is not convex — meshes, rings — is not watched, and what happens between frames is not seen.
///
/// The work is proportional to the number of bodies. After a frame with very many near pairs, some frames are passed over;
/// where almost everything is near everything, nothing is watched.
pub(super) struct Watch<'a> {
    scene: &'a Scene,
    bodies: Vec<Watched>,
    /// The sizes that there are, the smallest first.
    sizes: Vec<Size>,
    /// Pairs that have touched in their first frame.
    together: HashSet<(usize, usize)>,
    /// Which of the bodies were there in the frame before.
    were_there: Vec<bool>,
    found: Option<Overlap>,
    /// Nothing is watched any more.
    is_over: bool,
    /// So many frames are passed over.
    pause: u64,
    grid: Grid,
}

/// A body that is watched.
struct Watched {
    /// Its number in the scene.
    id: usize,
    /// The radius of a ball around its centre that holds it, m.
    radius: f64,
    /// The number of its size.
    size: usize,
    /// Whether forces move it.
    moves: bool,
}

/// Bodies of about the same size, which share a grid.
#[derive(Clone, Copy)]
struct Size {
    /// The bodies reach at most 2 to the power of this, and at least half of that, m.
    level: i32,
    /// The edge of the cells, m: the largest distance at which two of the bodies may be near each other.
    edge: f64,
    /// Whether forces move any of the bodies.
    has_moving: bool,
    /// Whether any of the bodies is not moved by forces.
    has_resting: bool,
}

/// What a look at a pair costs, relative to a comparison of a distance: shapes that are not balls are compared step by step.
const OF_SHAPES: u64 = 64;
/// What the looks at pairs may cost on average, for each body and frame: less than its line in a script.
const USUAL: u64 = 32;
/// What they may cost beside that in every frame, however few bodies there are.
const ALWAYS: u64 = 16_384;
/// So many times what is usual ends the watch.
const MOST: u64 = 128;
/// So many pairs may touch in their first frame, for each body: equal balls have six.
const TOGETHER: usize = 64;

impl<'a> Watch<'a> {
    pub(super) fn new(scene: &'a Scene) -> Watch<'a> {
        let mut levels = BTreeMap::new();
        let mut bodies: Vec<(Watched, i32)> = Vec::new();
        for (id, body) in scene.bodies.iter().enumerate() {
            let radius = body.shape.bounding_radius().filter(|radius| *radius > 0.0);
            let Some(radius) = radius.filter(|_| parts(&body.shape).next().is_some()) else { continue };
            #[allow(
                clippy::cast_possible_truncation,
                reason = "the sizes of a scene have logarithms of three digits"
            )]
            let level = libm::ceil(libm::log2(radius)) as i32;
            let moves = !body.start.fixed && body.motion.is_none();
            let none = Size { level, edge: 0.0, has_moving: false, has_resting: false };
            let size = levels.entry(level).or_insert(none);
            size.edge = size.edge.max(2.0 * (1.0 + DEEP) * radius);
            size.has_moving |= moves;
            size.has_resting |= !moves;
            bodies.push((Watched { id, radius, size: 0, moves }, level));
        }
        let sizes: Vec<Size> = levels.into_values().collect();
        let numbered = |(body, level): (Watched, i32)| {
            let size = sizes.partition_point(|size| size.level < level);
            Watched { size, ..body }
        };
        let is_over = scene.simulation.contacts.is_some() || !sizes.iter().any(|size| size.has_moving);
        let bodies: Vec<Watched> = bodies.into_iter().map(numbered).collect();
        let grid = Grid::new(if is_over { 0 } else { bodies.len() });
        let number = |id: usize| bodies.binary_search_by_key(&id, |body| body.id).ok();
        let joined = scene.joints.iter().filter_map(|joint| {
            let [i, j] = joint.kind.between().map(|end| end.body().and_then(|id| number(id.index())));
            Some((i?.min(j?), i?.max(j?)))
        });
        // Where joints hold them, bodies may be within each other.
        let together = joined.collect();
        let were_there = vec![false; bodies.len()];
        Watch { scene, bodies, sizes, together, were_there, found: None, is_over, pause: 0, grid }
    }

    /// Looks at the next frame of the run.
    pub(super) fn see(&mut self, frame: &Frame) {
        if self.is_over {
            return;
        }
        if self.pause > 0 {
            self.pause -= 1;
            return;
        }
        let mut grid = std::mem::take(&mut self.grid);
        grid.fill(self.bodies.iter().map(|body| self.key(frame, body)));
        let mut first: Option<(usize, usize)> = None;
        let mut together = std::mem::take(&mut self.together);
        let most = TOGETHER * self.bodies.len();
        let cost = self.each_near_pair(frame, &grid, |i, j| {
            if !(self.were_there[i] && self.were_there[j]) {
                if self.meet(frame, i, j, 1.0 + DEEP) {
                    together.insert((i, j));
                }
                return if together.len() > most { u64::MAX } else { self.cost(i, j) };
            }
            let is_earlier = first.is_none_or(|first| (i, j) < first);
            if !is_earlier || together.contains(&(i, j)) {
                return 1;
            }
            if self.meet(frame, i, j, 1.0 - DEEP) {
                first = Some((i, j));
            }
            self.cost(i, j)
        });
        (self.together, self.grid) = (together, grid);
        let are_there = self.bodies.iter().map(|body| frame.body(body.id).is_some());
        are_there.zip(&mut self.were_there).for_each(|(is_there, was_there)| *was_there = is_there);
        let name = |i: usize| self.scene.bodies[self.bodies[i].id].name.to_string();
        self.found = first.map(|(i, j)| Overlap { bodies: [name(i), name(j)], time: frame.time });
        self.is_over = self.found.is_some() || cost > MOST * self.usual();
        self.pause = cost / self.usual();
    }

    /// What has been found.
    pub(super) fn finish(self) -> Option<Overlap> {
        self.found
    }

    /// Shows every two bodies whose balls may meet and one of which moves, the one with the smaller number first, a few of
    /// them twice. `show` says what its look has cost; the sum is returned, and too large a sum ends it.
    fn each_near_pair(&self, frame: &Frame, grid: &Grid, mut show: impl FnMut(usize, usize) -> u64) -> u64 {
        let most = MOST * self.usual();
        let mut cost: u64 = 0;
        for (i, body) in self.bodies.iter().enumerate() {
            if cost > most {
                break;
            }
            let Some(here) = frame.body(body.id).map(|body| body.location) else { continue };
            let mut look = |j: usize| {
                let other = &self.bodies[j];
                let reach = (body.radius + other.radius) * (1.0 + DEEP);
                let Some(there) = frame.body(other.id) else { return };
                let square = (there.location - here).length_squared();
                // By chance there may be any body in a cell, also this one.
                let is_pair = j != i && (body.moves || other.moves);
                let is_near = is_pair && square < reach * reach;
                cost = cost.saturating_add(if is_near { show(i.min(j), i.max(j)) } else { 1 });
            };
            // Smaller bodies look for larger ones, so that a large one need not look through many cells. What rests looks
            // for what moves.
            for (number, size) in self.sizes.iter().enumerate().skip(body.size) {
                let is_own = number == body.size;
                let here = Cell::of(size.edge, here);
                let moving = |cell: Cell| cell.key(number, true);
                if size.has_moving && is_own && body.moves {
                    // Each pair once: later ones of the same cell, and those of half of the cells around it.
                    grid.each(moving(here), |j| {
                        if j > i {
                            look(j);
                        }
                    });
                    here.half_around().for_each(|cell| grid.each(moving(cell), &mut look));
                } else if size.has_moving && !is_own {
                    here.around().for_each(|cell| grid.each(moving(cell), &mut look));
                }
                if size.has_resting && body.moves {
                    here.around().for_each(|cell| grid.each(cell.key(number, false), &mut look));
                }
            }
        }
        cost
    }

    /// What the looks at pairs may cost on average in a frame.
    fn usual(&self) -> u64 {
        ALWAYS + USUAL * self.bodies.len() as u64
    }

    /// The key of the cell that a body is in, if it is there.
    fn key(&self, frame: &Frame, body: &Watched) -> Option<u64> {
        let cell = Cell::of(self.sizes[body.size].edge, frame.body(body.id)?.location);
        Some(cell.key(body.size, body.moves))
    }

    /// Whether two bodies overlap that are so many times larger than they are.
    fn meet(&self, frame: &Frame, i: usize, j: usize, scale: f64) -> bool {
        let placed = |i: usize| {
            let id = self.bodies[i].id;
            frame.body(id).into_iter().flat_map(move |at| {
                parts(&self.scene.bodies[id].shape).map(move |(shape, location, orientation)| Placed {
                    shape,
                    location: at.location + at.orientation * location,
                    orientation: at.orientation * orientation,
                    scale,
                })
            })
        };
        placed(i).any(|one| placed(j).any(|other| one.meets(&other)))
    }

    /// What it costs to find out whether two bodies overlap.
    fn cost(&self, i: usize, j: usize) -> u64 {
        let [one, other] = [i, j].map(|i| &self.scene.bodies[self.bodies[i].id].shape);
        match (one, other) {
            (Shape::Sphere { .. }, Shape::Sphere { .. }) => 1,
            _ => OF_SHAPES * (parts(one).count() * parts(other).count()) as u64,
        }
    }
}

/// The convex parts of a shape, with their places in its frame.
fn parts(shape: &Shape) -> impl Iterator<Item = (&Shape, DVec3, DQuat)> {
    let (whole, parts) = match shape {
        Shape::Compound(compound) => (None, compound.parts()),
        shape => (Some((shape, DVec3::ZERO, DQuat::IDENTITY)), &[][..]),
    };
    let parts = parts.iter().map(|part| (&part.shape, part.location, part.orientation));
    whole.into_iter().chain(parts).filter(|(shape, ..)| shape.farthest(DVec3::X).is_some())
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

    /// The upper half of a folding rule swings against the lower one; without the hinge, it is another body.
    #[test]
    fn bodies_that_a_joint_holds_may_be_within_each_other() {
        let text = "
            simulation = { duration = 2, frame_rate = 20 }
            [body.lower]
            shape.box.size = [0.1, 1, 0.1]
            fixed = true
            [body.upper]
            shape.box.size = [0.1, 0.9, 0.1]
            location = [0, 1, 0]
            angular_velocity = [0, 0, 3]
            velocity = [1.5, 0, 0]
            ";
        let hinge = "[joint.fold.hinge]\nbetween = ['lower', 'upper']\nat = [0, 0.5, 0]\naxis = [0, 0, 1]";
        assert_eq!(overlap(&format!("{text}{hinge}")), None);
        let others = "[body.other]\nrepeat = 1\nshape.box.size = [0.1, 1, 0.1]\nfixed = true\n";
        assert!(overlap(&format!("{text}{others}{hinge}")).is_some());
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

    /// The first frame of a scene.
    fn first_frame(scene: &Scene) -> Frame {
        Frames::new(scene).next().unwrap().unwrap()
    }

    /// The grid finds the pairs that a look at every pair finds, whatever their sizes, and whichever rest.
    #[test]
    fn near_pairs_are_those_of_all_pairs() {
        for resting in [1, 3, 400] {
            let mut text = String::from("simulation.duration = 0.04\n");
            for i in 0..400 {
                use std::fmt::Write;
                let at = |k: f64| (f64::from(i) * k).fract() * 20.0 - 10.0;
                let radius = 0.03 * libm::exp2(f64::from(i % 7) + at(0.236_067) / 20.0);
                let (x, y, z) = (at(0.618_033), at(0.414_213), at(0.732_050));
                let fixed = i % resting == resting - 1 && resting > 1;
                writeln!(text, "[body.b{i}]\nshape.sphere.radius = {radius}\nlocation = [{x}, {y}, {z}]")
                    .unwrap();
                writeln!(text, "fixed = {fixed}").unwrap();
            }
            let scene = Scene::parse(&text).unwrap();
            let frame = first_frame(&scene);
            let mut watch = Watch::new(&scene);
            watch.see(&frame);
            assert!(!watch.is_over);
            let mut expected = HashSet::new();
            for i in 0..400 {
                for j in i + 1..400 {
                    let (one, other) = (&watch.bodies[i], &watch.bodies[j]);
                    let distance = (frame.bodies[i].location - frame.bodies[j].location).length();
                    if (one.moves || other.moves) && distance < 1.01 * (one.radius + other.radius) {
                        expected.insert((i, j));
                    }
                }
            }
            assert!(expected.len() > 100, "{}", expected.len());
            let found = &watch.together;
            assert_eq!(
                found.symmetric_difference(&expected).collect::<Vec<_>>(),
                Vec::<&(usize, usize)>::new()
            );
        }
    }

    #[test]
    fn the_work_grows_with_the_number_of_bodies_and_not_with_that_of_pairs() {
        let cost = |count: usize| {
            let scene = Scene::parse(&format!(
                "simulation.duration = 0.04\n[body.b]\nshape.sphere.radius = 0.5\nvelocity = [1, 0, 0]\n\
                 repeat.grid = {{ count = [10, 10, {count}], spacing = 1.1 }}\n"
            ));
            let scene = scene.unwrap();
            let (watch, frame) = (Watch::new(&scene), first_frame(&scene));
            let mut grid = Grid::new(watch.bodies.len());
            grid.fill(watch.bodies.iter().map(|body| watch.key(&frame, body)));
            watch.each_near_pair(&frame, &grid, |i, j| watch.cost(i, j))
        };
        let (few, many) = (cost(5), cost(20));
        assert!(many < 5 * few, "{few} for 500 bodies, {many} for 2000");
    }

    /// A thousand at the same place are half a million pairs, of which none is a surprise.
    #[test]
    fn where_all_is_near_all_nothing_is_watched() {
        let scene = Scene::parse(
            "simulation.duration = 0.04\n[body.b]\nshape.sphere.radius = 0.5\nrepeat = 1000\nvelocity = [1, 0, 0]\n",
        );
        let scene = scene.unwrap();
        let mut watch = Watch::new(&scene);
        watch.see(&first_frame(&scene));
        assert!(watch.is_over);
        assert!(watch.together.len() < 100_000);
    }
}

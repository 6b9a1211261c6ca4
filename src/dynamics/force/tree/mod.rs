//! Gravitation of many bodies by a tree, in which distant bodies act together.

mod by_tree;
mod kernel;
mod walk;

use glam::DVec3;

pub(super) use self::by_tree::ByTree;
use self::kernel::{Potential, Pull};
use crate::threads;

/// The largest number of bodies in a leaf.
const LEAF: usize = 8;
/// The largest number of bodies that walk through the tree together.
const GROUP: usize = 32;
/// A node with fewer bodies is built on one thread.
const ALONE: usize = 2048;
/// 2/√3. With this factor, the size of a uniform cube is its edge.
const EDGE: f64 = 1.154_700_538_379_251_5;

/// A tree of bodies, after J. Barnes and P. Hut, Nature 324 (1986) 446.
///
/// Each node is split in two across the longest edge of its box, near the middle of that edge. A node acts as a whole, by its mass,
/// centre of mass and second moments, if its size is less than `angle` times its distance. Its size is 2/√3 of the largest distance of a
/// body from the centre of mass (J. Stadel, thesis, University of Washington 2001). So the expansion converges for angles up to 1.
///
/// The tree depends only on the positions, the masses and the order of the bodies.
struct Tree {
    bodies: Vec<Body>,
    /// All nodes, each before those of its first part, and these before those of its second part.
    nodes: Vec<Node>,
}

/// A body in the order of the tree.
#[derive(Clone, Copy)]
struct Body {
    at: DVec3,
    mass: f64,
    /// Its number in the input.
    number: usize,
}

/// Bodies close to each other: `first..end`.
#[derive(Clone, Copy, Default)]
struct Node {
    first: usize,
    end: usize,
    /// The number of the node that follows all parts of this one.
    next: usize,
    /// The square of the distance beyond which it acts as a whole.
    opening: f64,
    moments: Moments,
}

/// The mass distribution of a node, up to second order.
#[derive(Clone, Copy, Default)]
struct Moments {
    mass: f64,
    /// Their centre of mass.
    centre: DVec3,
    /// Q = Σ m s sᵀ, with s from the centre of mass: xx, yy, zz, xy, xz, yz.
    second: [f64; 6],
}

impl Tree {
    /// Builds the tree of bodies at these positions with these masses.
    fn new(bodies: impl Iterator<Item = (DVec3, f64)>, angle: f64) -> Tree {
        let mut bodies: Vec<Body> =
            bodies.enumerate().map(|(number, (at, mass))| Body { at, mass, number }).collect();
        let mut nodes = vec![Node::default(); nodes(bodies.len())];
        if !bodies.is_empty() {
            grow(&mut nodes, &mut bodies, (0, 0), EDGE / angle);
        }
        Tree { bodies, nodes }
    }
}

/// The number of bodies in the first part, close to `best`. Each part gets at least an eighth, so that the tree stays shallow. All groups
/// and leaves are full, except the last.
fn split(count: usize, best: usize) -> usize {
    let unit = if count > GROUP { GROUP } else { LEAF };
    let units = count.div_ceil(unit);
    let least = units.div_ceil(8);
    unit * ((best + unit / 2) / unit).clamp(least, units - least)
}

/// The number of nodes of a tree of `count` bodies.
fn nodes(count: usize) -> usize {
    let leaves = |count: usize| (2 * count.div_ceil(LEAF)).saturating_sub(1);
    let groups = count.div_ceil(GROUP).max(1);
    let last = count - (groups - 1) * GROUP;
    (groups - 1) * (leaves(GROUP) + 1) + leaves(last)
}

/// Builds a node and all its parts. `number` and `first` are the indices of the first node and the first body in the tree.
fn grow(all: &mut [Node], bodies: &mut [Body], (number, first): (usize, usize), reach: f64) {
    let Some((node, parts)) = all.split_first_mut() else { return };
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for body in &*bodies {
        (low, high) = (low.min(body.at), high.max(body.at));
    }
    let moments = if bodies.len() <= LEAF {
        // The splits leave the bodies in any order.
        bodies.sort_unstable_by_key(|body| body.number);
        Moments::of(bodies.iter().map(|body| Moments { mass: body.mass, centre: body.at, second: [0.0; 6] }))
    } else {
        let edges = high - low;
        let axis = edges.max_position();
        let (count, middle) = (bodies.len(), 0.5 * (low[axis] + high[axis]));
        let at = split(count, bodies.iter().filter(|body| body.at[axis] < middle).count());
        bodies.select_nth_unstable_by(at, |a, b| {
            a.at[axis].total_cmp(&b.at[axis]).then(a.number.cmp(&b.number))
        });
        let (left, right) = bodies.split_at_mut(at);
        let (left_nodes, right_nodes) = parts.split_at_mut(nodes(at));
        let second = (number + 1 + left_nodes.len(), first + at);
        let mut first_part = || grow(left_nodes, left, (number + 1, first), reach);
        let mut second_part = || grow(right_nodes, right, second, reach);
        if count > ALONE {
            threads::join(first_part, second_part);
        } else {
            first_part();
            second_part();
        }
        Moments::of([left_nodes[0].moments, right_nodes[0].moments].into_iter())
    };
    let farthest = |square: f64, body: &Body| square.max(body.at.distance_squared(moments.centre));
    let farthest = bodies.iter().fold(0.0, farthest);
    let next = number + 1 + parts.len();
    *node = Node { first, end: first + bodies.len(), next, opening: farthest * reach * reach, moments };
}

impl Moments {
    /// The combined moments of several parts. Without mass, the centre is the mean of their centres.
    fn of(parts: impl Iterator<Item = Moments> + Clone) -> Moments {
        let (mut mass, mut weighted, mut places, mut count) = (0.0, DVec3::ZERO, DVec3::ZERO, 0.0);
        for part in parts.clone() {
            mass += part.mass;
            weighted += part.mass * part.centre;
            places += part.centre;
            count += 1.0;
        }
        let centre = if mass > 0.0 { weighted / mass } else { places / count };
        let mut second = [0.0; 6];
        for part in parts {
            let (m, s) = (part.mass, part.centre - centre);
            let own = [s.x * s.x, s.y * s.y, s.z * s.z, s.x * s.y, s.x * s.z, s.y * s.z];
            for ((sum, second), own) in second.iter_mut().zip(part.second).zip(own) {
                *sum += second + m * own;
            }
        }
        Moments { mass, centre, second }
    }
}

#[cfg(test)]
mod tests;

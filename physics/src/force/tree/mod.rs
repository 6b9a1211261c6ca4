//! Gravitation of many bodies by a Barnes–Hut tree, in which groups of distant bodies act as a whole.

mod by_tree;
mod kernel;
mod walk;

use glam::DVec3;

pub(super) use self::by_tree::ByTree;
use self::kernel::{Potential, Pull};
use crate::threads;

/// The largest number of bodies in a leaf.
const MAX_LEAF_BODIES: usize = 8;
/// The largest number of bodies in a group. The bodies of a group traverse the tree together.
const MAX_GROUP_BODIES: usize = 32;
/// The largest number of bodies in a node that a single thread builds.
const MAX_SERIAL_BODIES: usize = 2048;
/// 2/√3: the ratio of the size of a node to the largest distance of its bodies from their center of mass. With this factor, the size of a
/// uniform cube is its edge.
const CUBE_EDGE_FACTOR: f64 = 1.154_700_538_379_251_5;

/// A tree of bodies, after J. Barnes and P. Hut, Nature 324 (1986) 446.
///
/// Each node is split in two across the longest edge of its box, near the middle of that edge. A node acts as a whole, by its mass, centre
/// of mass and second moments, if its size is less than `angle` times its distance. Its size is 2/√3 of the largest distance of a body
/// from the centre of mass (J. Stadel, thesis, University of Washington 2001). So the expansion converges for angles up to 1.
///
/// The tree depends only on the positions, the masses and the order of the bodies.
struct Tree {
    bodies: Vec<Body>,
    /// All nodes in depth-first order: each node comes before the nodes of its first part, and these come before the nodes of its second
    /// part.
    nodes: Vec<Node>,
}

/// A body of the tree. The bodies are sorted so that each node holds a contiguous range.
#[derive(Clone, Copy)]
struct Body {
    at: DVec3,
    mass: f64,
    /// The index of the body in the input.
    number: usize,
}

/// A node of the tree: the bodies `first..end`, which are close to each other.
#[derive(Clone, Copy, Default)]
struct Node {
    first: usize,
    end: usize,
    /// The index of the node after this node and all its parts.
    next: usize,
    /// The square of the distance beyond which the node acts as a whole, m².
    opening: f64,
    moments: Moments,
}

/// The mass distribution of a node: the moments of order zero to two.
#[derive(Clone, Copy, Default)]
struct Moments {
    mass: f64,
    /// The centre of mass, m.
    centre: DVec3,
    /// The second moments Q = Σ m s sᵀ about the centre of mass, in the order xx, yy, zz, xy, xz, yz.
    second: [f64; 6],
}

impl Tree {
    /// Builds the tree of bodies with these positions and masses, for the opening angle `angle`.
    fn new(bodies: impl Iterator<Item = (DVec3, f64)>, angle: f64) -> Tree {
        let mut bodies: Vec<Body> =
            bodies.enumerate().map(|(number, (at, mass))| Body { at, mass, number }).collect();
        let mut nodes = vec![Node::default(); nodes(bodies.len())];
        if !bodies.is_empty() {
            grow(&mut nodes, &mut bodies, (0, 0), CUBE_EDGE_FACTOR / angle);
        }
        Tree { bodies, nodes }
    }
}

/// Returns the number of bodies in the first part of a node with `count` bodies, as close to `best` as possible. Each part gets at least
/// about an eighth of the bodies, so that the tree stays shallow. All groups and leaves are full, except the last.
fn split(count: usize, best: usize) -> usize {
    let unit = if count > MAX_GROUP_BODIES { MAX_GROUP_BODIES } else { MAX_LEAF_BODIES };
    let units = count.div_ceil(unit);
    let least = units.div_ceil(8);
    unit * ((best + unit / 2) / unit).clamp(least, units - least)
}

/// Returns the number of nodes of a tree of `count` bodies.
fn nodes(count: usize) -> usize {
    let leaves = |count: usize| (2 * count.div_ceil(MAX_LEAF_BODIES)).saturating_sub(1);
    let groups = count.div_ceil(MAX_GROUP_BODIES).max(1);
    let last = count - (groups - 1) * MAX_GROUP_BODIES;
    (groups - 1) * (leaves(MAX_GROUP_BODIES) + 1) + leaves(last)
}

/// Builds a node and all its parts, recursively. `number` and `first` are the indices of this node and of its first body in the tree.
/// `reach` is the opening distance of a node, divided by the distance of its farthest body from its centre of mass.
fn grow(all: &mut [Node], bodies: &mut [Body], (number, first): (usize, usize), reach: f64) {
    let Some((node, parts)) = all.split_first_mut() else { return };
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for body in &*bodies {
        (low, high) = (low.min(body.at), high.max(body.at));
    }
    let moments = if bodies.len() <= MAX_LEAF_BODIES {
        // The splits above leave the bodies of a leaf in arbitrary order, so they are sorted by their input index.
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
        if count > MAX_SERIAL_BODIES {
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
    /// Combines the moments of several parts. If the total mass is zero, the centre is the mean of the parts' centres.
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

//! A tree of bounding boxes, to find the parts of a mesh near a point.

use glam::DVec3;

/// The largest number of boxes in a leaf of the tree.
const MAX_LEAF_BOXES: usize = 4;

/// An axis-parallel box: its lowest and its highest corner, m.
type Bounds = [DVec3; 2];

/// A tree of bounding boxes. Each node is split at its middle box along its longest edge.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    /// The nodes in depth-first order: each node precedes all nodes of its first half, then those of its second half.
    nodes: Vec<Node>,
    /// All boxes with their original indices, in the order of the leaves.
    boxes: Vec<(usize, Bounds)>,
}

#[derive(Clone, Debug)]
struct Node {
    bounds: Bounds,
    /// The boxes within the node: the range from `first` to before `end` of [`Tree::boxes`].
    first: usize,
    end: usize,
    /// The index of the first node after this node and its descendants.
    next: usize,
}

impl Tree {
    /// Creates a tree of boxes, each given by its lowest and its highest corner.
    pub(crate) fn new(boxes: impl Iterator<Item = Bounds>) -> Tree {
        let (mut boxes, mut nodes): (Vec<_>, _) = (boxes.enumerate().collect(), Vec::new());
        grow(&mut nodes, &mut boxes, 0);
        Tree { nodes, boxes }
    }

    /// Returns the indices of the boxes that are at most `within` from a given box along each axis, in ascending order. `count` is the
    /// number of all boxes.
    pub(crate) fn near(&self, [low, high]: Bounds, within: f64, count: usize) -> Vec<usize> {
        if !(low.is_finite() && high.is_finite() && within.is_finite()) {
            return (0..count).collect();
        }
        let within = DVec3::splat(within.max(0.0));
        let place = [low - within, high + within];
        let (mut found, mut number) = (Vec::new(), 0);
        while let Some(node) = self.nodes.get(number) {
            if !meet(node.bounds, place) {
                number = node.next;
                continue;
            }
            number += 1;
            if node.next == number {
                let near = self.boxes[node.first..node.end].iter().filter(|(_, bounds)| meet(*bounds, place));
                found.extend(near.map(|(i, _)| i));
            }
        }
        found.sort_unstable();
        found
    }
}

/// Appends the node of these boxes and all its descendants. `first` is the index of the first box in the tree.
fn grow(nodes: &mut Vec<Node>, boxes: &mut [(usize, Bounds)], first: usize) {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (_, bounds) in &*boxes {
        (low, high) = (low.min(bounds[0]), high.max(bounds[1]));
    }
    let number = nodes.len();
    nodes.push(Node { bounds: [low, high], first, end: first + boxes.len(), next: 0 });
    if boxes.len() > MAX_LEAF_BOXES {
        let (axis, middle) = ((high - low).max_position(), boxes.len() / 2);
        let at = |(_, [low, high]): &(usize, Bounds)| low[axis] + high[axis];
        boxes.select_nth_unstable_by(middle, |a, b| at(a).total_cmp(&at(b)));
        let (left, right) = boxes.split_at_mut(middle);
        grow(nodes, left, first);
        grow(nodes, right, first + middle);
    }
    nodes[number].next = nodes.len();
}

/// Returns true if two boxes touch or overlap.
fn meet([low, high]: Bounds, [other_low, other_high]: Bounds) -> bool {
    low.cmple(other_high).all() && other_low.cmple(high).all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    #[test]
    fn the_tree_finds_what_all_pairs_find() {
        let mut random = Stream::new(0, "boxes");
        let mut bounds = |size: f64| {
            let mut corner = || DVec3::from_array([0; 3].map(|_| random.uniform()));
            let low = corner();
            [low, low + size * corner()]
        };
        for count in [0, 1, 5, 300] {
            let boxes: Vec<Bounds> = (0..count).map(|_| bounds(0.1)).collect();
            let tree = Tree::new(boxes.iter().copied());
            for within in [0.0, 0.05] {
                for _ in 0..50 {
                    let [low, high] = bounds(0.3);
                    let larger = [low - within, high + within];
                    let all: Vec<usize> = (0..count).filter(|&i| meet(boxes[i], larger)).collect();
                    assert_eq!(tree.near([low, high], within, count), all);
                }
            }
        }
    }
}

//! The mechanisms of a scene: groups of bodies that joints connect, directly or through other bodies.

use super::super::Model;
use super::super::sets::Sets;
use super::joint::Joints;

/// Tells how joints hold bodies and connect them.
pub(super) struct Mechanisms {
    /// For each body, the number of its mechanism.
    number: Vec<usize>,
    /// For each body, how joints hold it.
    holds: Vec<Hold>,
    /// For each number of a mechanism, whether one of its joints has a motor.
    has_motor: Vec<bool>,
}

/// How joints hold a body.
#[derive(Clone, Copy, Default)]
struct Hold {
    /// Whether a joint connects the body with another body that can move.
    to_movable: bool,
    /// Whether a joint connects the body with the world, a fixed body or a guided one.
    to_world: bool,
}

impl Mechanisms {
    pub(super) fn new(model: &Model, joints: &Joints) -> Mechanisms {
        let is_movable = |body: &usize| model.inverse_mass()[*body] != 0.0;
        let mut sets = Sets::new(model.len());
        let mut holds = vec![Hold::default(); model.len()];
        for k in 0..joints.len() {
            match joints.bodies(k).map(|body| body.filter(is_movable)) {
                [Some(one), Some(two)] => {
                    sets.unite(one, two);
                    (holds[one].to_movable, holds[two].to_movable) = (true, true);
                }
                [Some(body), None] | [None, Some(body)] => holds[body].to_world = true,
                [None, None] => {}
            }
        }
        let number: Vec<usize> = (0..model.len()).map(|body| sets.first(body)).collect();
        let mut has_motor = vec![false; model.len()];
        for k in (0..joints.len()).filter(|&k| joints.has_motor(k)) {
            let movable = joints.bodies(k).into_iter().flatten().filter(is_movable);
            movable.for_each(|body| has_motor[number[body]] = true);
        }
        Mechanisms { number, holds, has_motor }
    }

    /// The number of a body's mechanism, smaller than the number of bodies.
    pub(super) fn number(&self, body: usize) -> usize {
        self.number[body]
    }

    /// Whether a motor moves the mechanism of a body.
    pub(super) fn has_motor(&self, body: usize) -> bool {
        self.has_motor[self.number[body]]
    }

    /// Returns the indices of the bodies that can move and are held by joints, in ascending order.
    pub(super) fn held(&self) -> impl Iterator<Item = usize> {
        (0..self.holds.len()).filter(|&body| self.is_held(body))
    }

    /// Returns each body that can move and is held by joints, with the number of joints of its mechanism.
    pub(super) fn joint_counts(&self, joints: &Joints) -> impl Iterator<Item = (usize, usize)> {
        let mut counts = vec![0; self.number.len()];
        for k in 0..joints.len() {
            let held = joints.bodies(k).into_iter().flatten().find(|&body| self.is_held(body));
            held.into_iter().for_each(|body| counts[self.number[body]] += 1);
        }
        self.held().map(move |body| (body, counts[self.number[body]]))
    }

    /// Whether a body can move and is held by a joint.
    pub(super) fn is_held(&self, body: usize) -> bool {
        self.holds[body].to_movable || self.holds[body].to_world
    }

    /// Whether a joint connects a body with another body that can move.
    pub(super) fn is_joined(&self, body: usize) -> bool {
        self.holds[body].to_movable
    }

    /// Returns for each body whether no joint connects its mechanism with the world, a fixed body or a guided one.
    pub(super) fn free(&self) -> Vec<bool> {
        let mut is_free = vec![true; self.holds.len()];
        for (hold, &number) in self.holds.iter().zip(&self.number) {
            is_free[number] &= !hold.to_world;
        }
        self.number.iter().map(|&number| is_free[number]).collect()
    }
}

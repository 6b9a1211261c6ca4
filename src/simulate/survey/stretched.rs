//! Finds joints that give way, because their forces are too large for the timestep.

use super::super::Frame;
use crate::physics::BodyId;
use crate::scene::{Joint, JointKind, Scene};

/// The largest gap at which a joint still counts as holding well, as a fraction of the size of the joint.
const MAX_RELATIVE_GAP: f64 = 0.05;

/// The joint that gives way most, relative to its size, and when it does so.
#[derive(Clone, Debug, PartialEq)]
pub struct StretchedJoint {
    /// The name of the joint.
    pub joint: String,
    /// The largest gap of the joint in any frame, m.
    pub gap: f64,
    /// The time of that frame, s.
    pub time: f64,
    /// The number of other joints that give way too much.
    pub others: usize,
}

/// Watches the gaps of all joints of a run.
pub(super) struct Gaps {
    /// The size of each joint, m.
    sizes: Vec<f64>,
    /// The largest gap of each joint so far, m, and its time, s.
    largest: Vec<(f64, f64)>,
}

impl Gaps {
    pub(super) fn new(scene: &Scene) -> Gaps {
        Gaps {
            sizes: scene.joints.iter().map(|joint| size(scene, joint)).collect(),
            largest: vec![(0.0, 0.0); scene.joints.len()],
        }
    }

    /// Adds the gaps of the next frame.
    pub(super) fn add(&mut self, scene: &Scene, frame: &Frame) {
        for (joint, largest) in scene.joints.iter().zip(&mut self.largest) {
            let gap = joint.kind.gap(|id: BodyId| frame.body(id.index()).copied());
            if let Some(gap) = gap.filter(|gap| *gap > largest.0) {
                *largest = (gap, frame.time);
            }
        }
    }

    /// Returns the largest gap of any joint so far, m.
    pub(super) fn largest(&self) -> f64 {
        self.largest.iter().fold(0.0, |most, (gap, _)| most.max(*gap))
    }

    /// Returns the joint that gave way most. `None` if no joint gave way too much.
    pub(super) fn finish(&self, scene: &Scene) -> Option<StretchedJoint> {
        let stretch = |joint: usize| self.largest[joint].0 / self.sizes[joint];
        let stretched = || (0..self.sizes.len()).filter(|joint| stretch(*joint) > MAX_RELATIVE_GAP);
        let joint = stretched().max_by(|one, two| stretch(*one).total_cmp(&stretch(*two)))?;
        let (gap, time) = self.largest[joint];
        Some(StretchedJoint {
            joint: scene.joints[joint].name.clone(),
            gap,
            time,
            others: stretched().count() - 1,
        })
    }
}

/// Returns the size of a joint, m: the diameter of the ball around its smaller moving body, or the length of its rod or rope if that is
/// larger.
fn size(scene: &Scene, joint: &Joint) -> f64 {
    let bodies = joint.kind.between().into_iter().filter_map(|end| Some(&scene.bodies[end.body()?.index()]));
    let moving = bodies.filter(|body| !body.start.fixed && body.motion.is_none());
    let diameter =
        moving.filter_map(|body| Some(2.0 * body.shape.bounding_radius()?)).fold(f64::INFINITY, f64::min);
    let length = match &joint.kind {
        JointKind::Rod(rod) => rod.length,
        JointKind::Rope(rope) => rope.length,
        _ => 0.0,
    };
    diameter.max(length)
}

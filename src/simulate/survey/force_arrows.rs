//! The arrows of named forces in a run, which a camera must show.

use super::super::span::JointArrow;
use super::super::{Frame, Measures, MomentState, root};
use crate::scene::{Quantity, Scene};

/// The arrows of named forces.
pub(super) struct ForceArrows<'a> {
    scene: &'a Scene,
    measures: Measures,
    /// Each arrow: the index of its force, that of its body, and its scale if given.
    arrows: Vec<(usize, usize, Option<f64>)>,
}

impl<'a> ForceArrows<'a> {
    /// Lists the arrows of a scene. `None` without any.
    pub(super) fn new(scene: &'a Scene) -> Option<ForceArrows<'a>> {
        let arrows: Vec<_> = scene
            .arrows_of_forces()
            .map(|(force, body)| (force, body, scene.forces[force].arrow.and_then(|arrow| arrow.scale)))
            .collect();
        (!arrows.is_empty()).then(|| ForceArrows { scene, measures: Measures::new(scene), arrows })
    }

    /// Returns the arrows of a frame.
    pub(super) fn at(&self, frame: &Frame) -> Vec<JointArrow> {
        let moment = MomentState::now(frame);
        let arrow = |(force, body, scale): &(usize, usize, Option<f64>)| {
            let vector = self.measures.force_on(*body, *force, &moment)?;
            let root = root(&self.scene.bodies[*body], frame.body(*body)?, vector);
            Some(JointArrow { quantity: Quantity::NamedForce, scale: *scale, root, vector })
        };
        self.arrows.iter().filter_map(arrow).collect()
    }
}

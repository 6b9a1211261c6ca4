//! The arrows of joints and named forces in a run, which a camera must show.

use super::super::span::ArrowNow;
use super::super::vectors::JointEnd;
use super::super::{Frame, Measures, MomentState, root};
use crate::scene::{Quantity, Scene};

/// The requested arrows of joints and named forces. Each comes with its scale, m per unit of its quantity, if the scene gives it.
pub(super) struct Arrows<'a> {
    scene: &'a Scene,
    /// The end of a joint at which each arrow begins, and the quantity that it shows.
    of_joints: Vec<(JointEnd, Quantity, Option<f64>)>,
    /// The index of the force of each arrow, and that of the body at which it begins.
    of_forces: Vec<(usize, usize, Option<f64>)>,
}

impl<'a> Arrows<'a> {
    /// Lists the arrows that a scene requests.
    pub(super) fn new(scene: &'a Scene) -> Arrows<'a> {
        let of_joints = scene.joints.iter().enumerate().flat_map(|(number, joint)| {
            let arrows = Quantity::OF_JOINTS.into_iter().zip(joint.arrows);
            arrows.filter_map(move |(quantity, arrow)| {
                Some((JointEnd::new(scene, number), quantity, arrow?.scale))
            })
        });
        let of_forces = scene
            .arrows_of_forces()
            .map(|(force, body)| (force, body, scene.forces[force].arrow.and_then(|arrow| arrow.scale)));
        Arrows { scene, of_joints: of_joints.collect(), of_forces: of_forces.collect() }
    }

    /// Returns the arrows of joints in a frame.
    pub(super) fn of_joints<'b>(&'b self, frame: &'b Frame) -> impl Iterator<Item = ArrowNow> + 'b {
        self.of_joints.iter().filter_map(|(end, quantity, scale)| {
            let (root, vector) = end.arrow(*quantity, frame)?;
            Some(ArrowNow { quantity: *quantity, scale: *scale, root, vector })
        })
    }

    /// Returns the arrows of named forces in a frame, each with the index of its force. `moment` is that of the frame, and `measures` are those
    /// of the scene.
    pub(super) fn of_forces(
        &self,
        frame: &Frame,
        moment: &MomentState<'_>,
        measures: &Measures,
    ) -> Vec<(usize, ArrowNow)> {
        let arrow = |(force, body, scale): &(usize, usize, Option<f64>)| {
            let vector = measures.force_on(*body, *force, moment)?;
            let root = root(&self.scene.bodies[*body], frame.body(*body)?, vector);
            Some((*force, ArrowNow { quantity: Quantity::NamedForce, scale: *scale, root, vector }))
        };
        self.of_forces.iter().filter_map(arrow).collect()
    }
}

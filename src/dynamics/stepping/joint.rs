//! Joints as the engine has them: it solves for them together with the contacts, by impulses.

use glam::{DQuat, DVec3};
use rapier3d_f64::prelude::{
    GenericJoint, GenericJointBuilder, ImpulseJointHandle, JointAxesMask, JointAxis, MotorModel,
    PhysicsWorld, Pose, RigidBodyBuilder, RigidBodyHandle,
};

use super::super::{Anchor, Ball, Fixed, Freedom, Hinge, Model, Motor, Rod, Rope, Slider};

/// The stiffness of the motor that keeps the length of a rod, N/m, and that of one that keeps a speed, N s/m or N m s: so stiff that the
/// step alone says how soft they are.
const RIGID: f64 = 1e30;

/// What holds two bodies together, among the kinds that the engine has.
#[derive(Clone, Debug)]
pub struct Link {
    /// What it is.
    pub kind: LinkKind,
    /// Whether the two bodies can collide with each other.
    pub collides: bool,
}

/// The kinds of links.
#[derive(Clone, Debug)]
pub enum LinkKind {
    /// Two points stay together.
    Ball(Ball),
    /// Two points stay together, and one axis is common. Its motor keeps a speed, if it has one.
    Hinge(Hinge),
    /// One body moves along an axis of the other. Its motor keeps a speed, if it has one.
    Slider(Slider),
    /// Two bodies move as one.
    Fixed(Fixed),
    /// Two points keep their distance.
    Rod(Rod),
    /// The distance of two points does not grow.
    Rope(Rope),
}

/// The joints of a run.
pub(super) struct Joints {
    handles: Vec<ImpulseJointHandle>,
}

/// An end of a link: its body in the engine, and the rotation from the axes of the body to the engine's.
struct End {
    body: RigidBodyHandle,
    turn: DQuat,
    at: DVec3,
}

impl LinkKind {
    /// Its two ends.
    #[must_use]
    pub fn between(&self) -> [Anchor; 2] {
        match self {
            LinkKind::Ball(Ball { between })
            | LinkKind::Hinge(Hinge { between, .. })
            | LinkKind::Slider(Slider { between, .. })
            | LinkKind::Fixed(Fixed { between, .. })
            | LinkKind::Rod(Rod { between, .. })
            | LinkKind::Rope(Rope { between, .. }) => *between,
        }
    }
}

impl Joints {
    /// Puts all links into the engine.
    pub(super) fn insert(
        engine: &mut PhysicsWorld,
        links: &[Link],
        bodies: &[RigidBodyHandle],
        model: &Model,
    ) -> Joints {
        // What points of the world belong to.
        let ground = (!links.is_empty()).then(|| engine.insert_body(RigidBodyBuilder::fixed()));
        let end = |anchor: Anchor| match (anchor, ground) {
            (Anchor::Body { id, at }, _) => {
                let turn = model.principal_axes(id.index()).conjugate();
                Some(End { body: *bodies.get(id.index())?, turn, at: turn * at })
            }
            (Anchor::Point(at), Some(body)) => Some(End { body, turn: DQuat::IDENTITY, at }),
            (Anchor::Point(_), None) => None,
        };
        let mut handles = Vec::with_capacity(links.len());
        for link in links {
            let [one, two] = link.kind.between().map(end);
            if let (Some(one), Some(two)) = (one, two) {
                let mut joint = joint(&link.kind, &one, &two);
                joint.set_contacts_enabled(link.collides);
                handles.push(engine.insert_impulse_joint(one.body, two.body, joint));
            }
        }
        Joints { handles }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.handles.len()
    }
}

/// A link as the engine has it.
fn joint(kind: &LinkKind, one: &End, two: &End) -> GenericJoint {
    // The first axis of a joint of the engine is the one that is free.
    let frames = |axis: DVec3, turned: DQuat| {
        let own = DQuat::from_rotation_arc(DVec3::X, axis);
        [Pose::from_parts(one.at, one.turn * own), Pose::from_parts(two.at, two.turn * turned * own)]
    };
    let build = |locked: JointAxesMask, [first, second]: [Pose; 2]| {
        GenericJointBuilder::new(locked).local_frame1(first).local_frame2(second).build()
    };
    match kind {
        LinkKind::Ball(_) => build(JointAxesMask::LIN_AXES, frames(DVec3::X, DQuat::IDENTITY)),
        LinkKind::Fixed(fixed) => build(JointAxesMask::all(), frames(DVec3::X, fixed.turned)),
        LinkKind::Hinge(hinge) => {
            let locked = JointAxesMask::LOCKED_REVOLUTE_AXES;
            let joint = build(locked, frames(hinge.axis(), hinge.turned()));
            free(joint, JointAxis::AngX, &hinge.freedom)
        }
        LinkKind::Slider(slider) => {
            let locked = JointAxesMask::LOCKED_PRISMATIC_AXES;
            free(build(locked, frames(slider.axis, slider.turned)), JointAxis::LinX, &slider.freedom)
        }
        LinkKind::Rope(rope) => {
            let mut joint = build(JointAxesMask::empty(), frames(DVec3::X, DQuat::IDENTITY));
            joint.coupled_axes = JointAxesMask::LIN_AXES;
            joint.set_limits(JointAxis::LinX, [0.0, rope.length]);
            joint
        }
        LinkKind::Rod(rod) => {
            // The engine has no joint for a distance that neither grows nor shrinks, but a motor without limit keeps one.
            let mut joint = build(JointAxesMask::empty(), frames(DVec3::X, DQuat::IDENTITY));
            joint.coupled_axes = JointAxesMask::LIN_AXES;
            joint.set_motor_model(JointAxis::LinX, MotorModel::ForceBased);
            joint.set_motor_position(JointAxis::LinX, rod.length, RIGID, 0.0);
            joint
        }
    }
}

/// Limits and motors of the axis that is free.
fn free(mut joint: GenericJoint, axis: JointAxis, freedom: &Freedom) -> GenericJoint {
    if let Some(limits) = freedom.limits {
        joint.set_limits(axis, limits);
    }
    if let Some(Motor::Speed { speed, limit }) = &freedom.motor {
        joint.set_motor_model(axis, MotorModel::ForceBased);
        joint.set_motor_velocity(axis, *speed, RIGID);
        joint.set_motor_max_force(axis, *limit);
    }
    joint
}

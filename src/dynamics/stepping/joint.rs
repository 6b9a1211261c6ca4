//! Joints in the engine, which solves them together with the contacts, by impulses.

use glam::{DQuat, DVec3};
use rapier3d_f64::prelude::{
    GenericJoint, GenericJointBuilder, ImpulseJointHandle, JointAxesMask, JointAxis, MotorModel,
    PhysicsWorld, Pose, RigidBodyBuilder, RigidBodyHandle,
};

use super::super::{Anchor, Ball, BodyId, Fixed, Freedom, Hinge, Model, Motor, Rod, Rope, Slider, State};
use super::books::Motion;

/// The stiffness of the motor that keeps the length of a rod, N/m, and of one that keeps a speed, N s/m or N m s. It is so large that the
/// step alone determines the softness.
const RIGID: f64 = 1e30;

/// A joint of two bodies, of a kind that the engine supports.
#[derive(Clone, Debug)]
pub struct Link {
    /// Its kind.
    pub kind: LinkKind,
    /// Whether the two bodies can collide with each other.
    pub collides: bool,
}

/// The kinds of links.
#[derive(Clone, Debug)]
pub enum LinkKind {
    /// Two points coincide.
    Ball(Ball),
    /// Two points coincide, and one axis is common. An optional motor keeps a speed.
    Hinge(Hinge),
    /// One body moves along an axis of the other. An optional motor keeps a speed.
    Slider(Slider),
    /// Two bodies move as one.
    Fixed(Fixed),
    /// The distance of two points is constant.
    Rod(Rod),
    /// The distance of two points is limited.
    Rope(Rope),
}

/// The joints of a run.
pub(super) struct Joints {
    handles: Vec<ImpulseJointHandle>,
    /// The indices of the bodies at both ends; `None` for the world.
    bodies: Vec<[Option<usize>; 2]>,
    /// The free axis of each joint with a motor.
    motors: Vec<Option<JointAxis>>,
    /// Whether any joint has an end at a body with a given motion.
    pub(super) has_guide: bool,
}

/// The impulse of a motor on the first body within a step, N s or N m s, and the coefficients of its row.
pub(super) struct MotorPush {
    bodies: [Option<usize>; 2],
    impulse: f64,
    /// The direction of a linear motor; zero for a rotary one.
    direction: DVec3,
    /// For each body, the coefficients of its angular velocity.
    arms: [DVec3; 2],
}

impl MotorPush {
    /// The energy from the motor, J. The closure returns the mean motion of a body in the step.
    pub(super) fn work(&self, mean: impl Fn(usize) -> Motion) -> f64 {
        let rate = |side: usize| {
            let Some((velocity, turning)) = self.bodies[side].map(&mean) else { return 0.0 };
            self.direction.dot(velocity) + self.arms[side].dot(turning)
        };
        self.impulse * (rate(0) - rate(1))
    }
}

/// An end of a link: its body in the engine, and the rotation from the body's axes to the engine's.
struct End {
    body: RigidBodyHandle,
    turn: DQuat,
    at: DVec3,
}

impl LinkKind {
    /// The axis of the motor that keeps a speed, if there is one.
    fn motor(&self) -> Option<JointAxis> {
        let of = |freedom: &Freedom, axis: JointAxis| {
            matches!(freedom.motor, Some(Motor::Speed { .. })).then_some(axis)
        };
        match self {
            LinkKind::Hinge(hinge) => of(&hinge.freedom, JointAxis::AngX),
            LinkKind::Slider(slider) => of(&slider.freedom, JointAxis::LinX),
            _ => None,
        }
    }

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
    /// Adds all links to the engine.
    pub(super) fn insert(
        engine: &mut PhysicsWorld,
        links: &[Link],
        bodies: &[RigidBodyHandle],
        model: &Model,
    ) -> Joints {
        // Points of the world belong to this body.
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
        let (mut ends, mut motors) = (Vec::new(), Vec::new());
        for link in links {
            let [one, two] = link.kind.between().map(end);
            if let (Some(one), Some(two)) = (one, two) {
                let mut joint = joint(&link.kind, &one, &two);
                joint.set_contacts_enabled(link.collides);
                ends.push(link.kind.between().map(|end| end.body().map(BodyId::index)));
                motors.push(link.kind.motor());
                handles.push(engine.insert_impulse_joint(one.body, two.body, joint));
            }
        }
        let has_guide = ends.iter().flatten().flatten().any(|&body: &usize| model.is_guided(body));
        Joints { handles, bodies: ends, motors, has_guide }
    }

    /// For each of `bodies` bodies, whether a joint holds it.
    pub(super) fn held(&self, bodies: usize) -> Vec<bool> {
        let mut held = vec![false; bodies];
        self.bodies.iter().flatten().flatten().for_each(|&body| held[body] = true);
        held
    }

    /// The impulses of the motors in the last step. `state` is that of its start.
    ///
    /// A motor is the first row that the engine makes for a joint, so its impulse acts along its axis. The later rows are made orthogonal
    /// to each other, so their impulses have no such meaning.
    pub(super) fn motor_pushes(&self, engine: &PhysicsWorld, state: &State) -> Vec<MotorPush> {
        let with_motor = self.motors.iter().enumerate().filter_map(|(k, axis)| Some((k, (*axis)?)));
        let push = |(k, axis): (usize, JointAxis)| {
            let joint = engine.impulse_joints.get(self.handles[k])?;
            let impulse = joint.data.motors[axis as usize].impulse;
            let bodies = self.bodies[k];
            let place = |side: usize, frame: Pose| {
                bodies[side].map_or(frame, |body| super::bodies::pose(state, body) * frame)
            };
            let (first, second) = (place(0, joint.data.local_frame1), place(1, joint.data.local_frame2));
            let along = first.rotation * DVec3::X;
            if axis == JointAxis::AngX {
                return Some(MotorPush { bodies, impulse, direction: DVec3::ZERO, arms: [along; 2] });
            }
            let arm = |side: usize| {
                let centre = bodies[side].map_or(DVec3::ZERO, |body| state.location[body]);
                (second.translation - centre).cross(along)
            };
            Some(MotorPush { bodies, impulse, direction: along, arms: [arm(0), arm(1)] })
        };
        with_motor.filter_map(push).collect()
    }

    /// The number of joints.
    pub(super) fn len(&self) -> usize {
        self.handles.len()
    }
}

/// A link in the form of the engine.
fn joint(kind: &LinkKind, one: &End, two: &End) -> GenericJoint {
    // The first axis of an engine joint is the free one.
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
            // The engine has no joint for a constant distance, but a motor without limit keeps one.
            let mut joint = build(JointAxesMask::empty(), frames(DVec3::X, DQuat::IDENTITY));
            joint.coupled_axes = JointAxesMask::LIN_AXES;
            joint.set_motor_model(JointAxis::LinX, MotorModel::ForceBased);
            joint.set_motor_position(JointAxis::LinX, rod.length, RIGID, 0.0);
            joint
        }
    }
}

/// Adds limits and a motor on the free axis.
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

//! Joints in the physics engine. The engine solves joints and contacts together, by impulses.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use rapier3d_f64::prelude::{
    GenericJoint, GenericJointBuilder, ImpulseJointHandle, JointAxesMask, JointAxis, MotorModel,
    PhysicsWorld, Pose, RigidBodyBuilder, RigidBodyHandle,
};

use super::super::motion::Twist;
use super::super::{
    Anchor, Ball, BodyId, Constraint, Fixed, Freedom, Hinge, Model, Motor, Rod, Rope, Slider, State,
};

/// The stiffness (N/m) of the motor that keeps the length of a rod, and the damping (N s/m or N m s) of a motor that keeps a speed. The
/// value is so large that only the length of the step determines how soft the motor is.
const RIGID_MOTOR_GAIN: f64 = 1e30;

/// A joint between two bodies, of a kind that time-stepping supports.
#[derive(Clone, Debug)]
pub struct Link {
    /// The kind of the joint, with its ends and parameters.
    pub kind: LinkKind,
    /// Whether the two bodies can collide with each other.
    pub collides: bool,
}

/// The kinds of joints that time-stepping supports.
#[derive(Clone, Debug)]
pub enum LinkKind {
    /// Ball joint: two points coincide.
    Ball(Ball),
    /// Hinge: two points coincide, and one axis is common to both bodies. An optional motor keeps an angular speed.
    Hinge(Hinge),
    /// Slider: one body moves along an axis of the other body without rotating relative to that body. An optional motor keeps a speed.
    Slider(Slider),
    /// Fixed joint: two bodies keep their relative position and orientation.
    Fixed(Fixed),
    /// Rod: the distance between two points is constant.
    Rod(Rod),
    /// Rope: the distance between two points has an upper limit.
    Rope(Rope),
}

/// The joints of a run in the physics engine.
pub(super) struct Joints {
    handles: Vec<ImpulseJointHandle>,
    /// For each joint, the indices of the bodies at its two ends; `None` for an end at a fixed point of the world.
    bodies: Vec<[Option<usize>; 2]>,
    /// For each joint, the axis of the motor that keeps a speed, and that speed, m/s or rad/s; `None` for a joint without a motor.
    motors: Vec<Option<(JointAxis, f64)>>,
    /// Whether any joint has an end at a body with a given motion.
    pub(super) has_guide: bool,
}

/// The impulse of a joint's motor on the first body within a step, N s or N m s, and the coefficients of the Jacobian row of the motor.
pub(super) struct MotorPush {
    bodies: [Option<usize>; 2],
    impulse: f64,
    /// The direction of a linear motor, as a unit vector in world axes; zero for a rotary motor.
    direction: DVec3,
    /// For each body, the coefficients of its angular velocity in the motor's speed, world axes.
    arms: [DVec3; 2],
}

impl MotorPush {
    /// Whether the motor moves one of the bodies for which `is_led` returns true.
    pub(super) fn moves(&self, is_led: impl Fn(usize) -> bool) -> bool {
        self.bodies.into_iter().flatten().any(is_led)
    }

    /// Returns the work of the motor in the step, J. The closure `mean` returns the mean motion of a body in the step.
    pub(super) fn work(&self, mean: impl Fn(usize) -> Twist) -> f64 {
        let rate = |side: usize| {
            let Some((velocity, turning)) = self.bodies[side].map(&mean) else { return 0.0 };
            self.direction.dot(velocity) + self.arms[side].dot(turning)
        };
        self.impulse * (rate(0) - rate(1))
    }
}

/// An end of a joint: a body in the physics engine, the rotation from the axes of the scene's body to those of the engine's body, and the
/// joint's point in the axes of the engine's body, m.
struct End {
    body: RigidBodyHandle,
    turn: DQuat,
    at: DVec3,
}

impl LinkKind {
    /// Returns the axis of the motor that keeps a speed, and that speed, m/s or rad/s; `None` for a joint without a motor.
    fn motor(&self) -> Option<(JointAxis, f64)> {
        let of = |freedom: &Freedom, axis: JointAxis| match freedom.motor {
            Some(Motor::Speed { speed, .. }) => Some((axis, speed)),
            _ => None,
        };
        match self {
            LinkKind::Hinge(hinge) => of(&hinge.freedom, JointAxis::AngX),
            LinkKind::Slider(slider) => of(&slider.freedom, JointAxis::LinX),
            _ => None,
        }
    }

    /// Returns the joint as a constraint.
    pub(super) fn constraint(&self) -> Arc<dyn Constraint> {
        match self {
            LinkKind::Ball(joint) => Arc::new(*joint),
            LinkKind::Hinge(joint) => Arc::new(joint.clone()),
            LinkKind::Slider(joint) => Arc::new(joint.clone()),
            LinkKind::Fixed(joint) => Arc::new(*joint),
            LinkKind::Rod(joint) => Arc::new(*joint),
            LinkKind::Rope(joint) => Arc::new(*joint),
        }
    }

    /// The two ends of the joint.
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
    /// Adds a joint to the physics engine for each of `links`. `bodies` holds the engine's handle of each body.
    pub(super) fn insert(
        engine: &mut PhysicsWorld,
        links: &[Link],
        bodies: &[RigidBodyHandle],
        model: &Model,
    ) -> Joints {
        // Joints to fixed points of the world are attached to this body.
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

    /// Returns for each of `bodies` bodies whether a joint holds it.
    pub(super) fn held(&self, bodies: usize) -> Vec<bool> {
        let mut held = vec![false; bodies];
        self.bodies.iter().flatten().flatten().for_each(|&body| held[body] = true);
        held
    }

    /// Returns the impulses of the joints' motors in the last step. `state` is the state at the start of the step.
    ///
    /// The physics engine makes the row of a motor before the other rows of its joint, so the motor's impulse acts along its axis. The
    /// engine makes later rows orthogonal to the earlier ones, so impulses of later rows would not act along the axes of the joint.
    pub(super) fn motor_pushes(&self, engine: &PhysicsWorld, state: &State) -> Vec<MotorPush> {
        let with_motor = self.motors.iter().enumerate().filter_map(|(k, motor)| Some((k, (*motor)?.0)));
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

    /// Returns the hinges of each of `bodies` bodies: a point of the hinge's axis, and its direction, in the engine's frame of the body.
    /// `None` for a body that other joints hold, too, or hinges with limits.
    pub(super) fn hinges(&self, engine: &PhysicsWorld, bodies: usize) -> Vec<Option<Vec<(DVec3, DVec3)>>> {
        let mut hinges = vec![Some(Vec::new()); bodies];
        for (handle, ends) in self.handles.iter().zip(&self.bodies) {
            let Some(joint) = engine.impulse_joints.get(*handle).map(|joint| &joint.data) else { continue };
            let is_free =
                joint.locked_axes == JointAxesMask::LOCKED_REVOLUTE_AXES && joint.limit_axes.is_empty();
            for (body, frame) in ends.iter().zip([joint.local_frame1, joint.local_frame2]) {
                let Some(body) = *body else { continue };
                match &mut hinges[body] {
                    Some(hinges) if is_free => hinges.push((frame.translation, frame.rotation * DVec3::X)),
                    other => *other = None,
                }
            }
        }
        hinges
    }

    /// Returns for each of `bodies` bodies the axis of its last hinge, a unit vector in the engine's frame of the body; `None` without a hinge.
    pub(super) fn hinge_axes(&self, engine: &PhysicsWorld, bodies: usize) -> Vec<Option<DVec3>> {
        let mut axes = vec![None; bodies];
        for k in 0..self.len() {
            let joint = self.get(engine, k);
            let hinge = joint.filter(|joint| joint.locked_axes == JointAxesMask::LOCKED_REVOLUTE_AXES);
            let Some(hinge) = hinge else { continue };
            for (body, frame) in self.bodies[k].iter().zip([hinge.local_frame1, hinge.local_frame2]) {
                if let Some(body) = *body {
                    axes[body] = Some(frame.rotation * DVec3::X);
                }
            }
        }
        axes
    }

    /// Sets the speeds of the hinges' motors for a step. `spin` returns the angular velocity of a body that the physics engine does not
    /// know, rad/s. `state` is the state at the start of the step.
    pub(super) fn set_speeds(&self, engine: &mut PhysicsWorld, state: &State, spin: impl Fn(usize) -> DVec3) {
        for (k, axis) in self.motors.iter().enumerate() {
            let Some((axis, speed)) = axis.filter(|(axis, _)| *axis == JointAxis::AngX) else { continue };
            let Some(joint) = engine.impulse_joints.get(self.handles[k]).map(|joint| &joint.data) else {
                continue;
            };
            let turn = self.bodies[k][0].map_or(DQuat::IDENTITY, |body| state.orientation[body]);
            let along = turn * joint.local_frame1.rotation * DVec3::X;
            let [one, two] = self.bodies[k].map(|body| body.map_or(0.0, |body| spin(body).dot(along)));
            let rest = speed - (two - one);
            if joint.motors[axis as usize].target_vel == rest {
                continue;
            }
            if let Some(joint) = engine.impulse_joints.get_mut(self.handles[k], false) {
                joint.data.set_motor_velocity(axis, rest, RIGID_MOTOR_GAIN);
            }
        }
    }

    /// Returns a joint as the physics engine describes it.
    pub(super) fn get<'a>(&self, engine: &'a PhysicsWorld, joint: usize) -> Option<&'a GenericJoint> {
        Some(&engine.impulse_joints.get(self.handles[joint])?.data)
    }

    /// Whether a joint has a motor.
    pub(super) fn has_motor(&self, joint: usize) -> bool {
        self.motors[joint].is_some()
    }

    /// Returns the indices of the bodies at the two ends of a joint; `None` for an end at a fixed point of the world.
    pub(super) fn bodies(&self, joint: usize) -> [Option<usize>; 2] {
        self.bodies[joint]
    }

    /// The number of joints.
    pub(super) fn len(&self) -> usize {
        self.handles.len()
    }
}

/// Returns a joint as the physics engine describes it.
fn joint(kind: &LinkKind, one: &End, two: &End) -> GenericJoint {
    // The x axis of an engine joint's frame is the axis of its free motion.
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
            // The physics engine has no joint that keeps a distance constant, so a motor with unlimited force does.
            let mut joint = build(JointAxesMask::empty(), frames(DVec3::X, DQuat::IDENTITY));
            joint.coupled_axes = JointAxesMask::LIN_AXES;
            joint.set_motor_model(JointAxis::LinX, MotorModel::ForceBased);
            joint.set_motor_position(JointAxis::LinX, rod.length, RIGID_MOTOR_GAIN, 0.0);
            joint
        }
    }
}

/// Adds the limits and the motor of `freedom` to the free axis of a joint.
fn free(mut joint: GenericJoint, axis: JointAxis, freedom: &Freedom) -> GenericJoint {
    if let Some(limits) = freedom.limits {
        joint.set_limits(axis, limits);
    }
    if let Some(Motor::Speed { speed, limit }) = &freedom.motor {
        joint.set_motor_model(axis, MotorModel::ForceBased);
        joint.set_motor_velocity(axis, *speed, RIGID_MOTOR_GAIN);
        joint.set_motor_max_force(axis, *limit);
    }
    joint
}

//! A body as constraints see it.

use glam::{DMat3, DQuat, DVec3};

use super::super::model::is_isotropic;
use super::super::{Anchor, Model, State};
use super::{Direction, Members};

/// A body of a constraint at one moment.
#[derive(Clone, Copy, Debug, Default)]
pub struct Member {
    /// Its centre of mass, m.
    pub location: DVec3,
    /// Its velocity, m/s.
    pub velocity: DVec3,
    /// The rotation that takes its own axes to the world's.
    pub orientation: DQuat,
    /// Its angular velocity, world axes, rad/s.
    pub angular_velocity: DVec3,
    /// 1/m, 1/kg; 0 for a body that no force moves.
    pub(super) inverse_mass: f64,
    /// R I⁻¹ Rᵀ, 1/(kg m²); 0 for a body that no torque turns.
    pub(super) inverse_inertia: DMat3,
}

impl Member {
    /// Body `i`, at no moment yet.
    pub(super) fn new(i: usize, model: &Model) -> Member {
        let inverse_mass = model.inverse_mass()[i];
        let is_movable = inverse_mass != 0.0;
        let inverse_inertia = if is_movable { model.inverse_inertia()[i] } else { DVec3::ZERO };
        let inverse_inertia = DMat3::from_diagonal(inverse_inertia);
        Member { inverse_mass, inverse_inertia, ..Member::default() }
    }

    /// Body `i` of a state.
    pub(super) fn of(i: usize, model: &Model, state: &State) -> Member {
        let mut member = Member::new(i, model);
        member.follow(i, model, state);
        member
    }

    /// Takes what changes with time from a state.
    pub(super) fn follow(&mut self, i: usize, model: &Model, state: &State) {
        let (orientation, angular_momentum) = (state.orientation[i], state.angular_momentum[i]);
        let axes = model.principal_axes(i);
        self.location = state.location[i];
        self.velocity = state.velocity[i];
        self.orientation = if axes == DQuat::IDENTITY { orientation } else { orientation * axes.conjugate() };
        let principal = model.inverse_inertia()[i];
        // Without a preferred axis, the inertia is the same in any orientation.
        if is_isotropic(principal) {
            self.angular_velocity = principal.x * angular_momentum;
            return;
        }
        let turn = DMat3::from_quat(orientation);
        let back = turn.transpose();
        self.angular_velocity = turn * (principal * (back * angular_momentum));
        if self.inverse_mass != 0.0 {
            self.inverse_inertia = turn * (DMat3::from_diagonal(principal) * back);
        }
    }

    /// M⁻¹ times a direction.
    pub(super) fn weigh(&self, direction: &Direction) -> Direction {
        Direction { linear: self.inverse_mass * direction.linear, angular: self.turn(direction.angular) }
    }

    /// I⁻¹ times a vector, which is zero for most ends at the centre of a body.
    pub(super) fn turn(&self, vector: DVec3) -> DVec3 {
        if vector == DVec3::ZERO { vector } else { self.inverse_inertia * vector }
    }
}

/// An end of a constraint at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    /// Which of the constraint's bodies it belongs to; none for a point of the world.
    pub(super) body: Option<usize>,
    /// Where it is, m.
    pub(super) location: DVec3,
    /// How it moves, m/s.
    pub(super) velocity: DVec3,
    /// ω × (ω × r): the part of its acceleration that does not come from accelerations of the body, m/s².
    pub(super) centripetal: DVec3,
    /// r: the way to it from the centre of mass, m.
    pub(super) arm: DVec3,
    /// The rotation that takes the axes of the body to the world's.
    pub(super) orientation: DQuat,
    /// Its angular velocity, rad/s.
    pub(super) angular_velocity: DVec3,
}

impl End {
    /// The ends of a constraint; `members` are its bodies, each once, in the order of the ends.
    #[inline(always)]
    pub(super) fn all<const N: usize>(anchors: [Anchor; N], members: &Members<'_>) -> [End; N] {
        let mut next = 0;
        let mut slots = [None; N];
        std::array::from_fn(|i| match anchors[i] {
            Anchor::Point(location) => End::fixed(location),
            Anchor::Body { id, at } => {
                let known = anchors[..i].iter().position(|other| other.body() == Some(id));
                let slot = known.and_then(|other| slots[other]).unwrap_or_else(|| {
                    next += 1;
                    next - 1
                });
                slots[i] = Some(slot);
                End::on(&members[slot], slot, at)
            }
        })
    }

    fn fixed(location: DVec3) -> End {
        End {
            body: None,
            location,
            velocity: DVec3::ZERO,
            centripetal: DVec3::ZERO,
            arm: DVec3::ZERO,
            orientation: DQuat::IDENTITY,
            angular_velocity: DVec3::ZERO,
        }
    }

    #[inline(always)]
    fn on(member: &Member, body: usize, at: DVec3) -> End {
        let omega = member.angular_velocity;
        if at == DVec3::ZERO {
            return End {
                body: Some(body),
                location: member.location,
                velocity: member.velocity,
                centripetal: DVec3::ZERO,
                arm: DVec3::ZERO,
                orientation: member.orientation,
                angular_velocity: omega,
            };
        }
        let arm = member.orientation * at;
        let turning = omega.cross(arm);
        End {
            body: Some(body),
            location: member.location + arm,
            velocity: member.velocity + turning,
            centripetal: omega.cross(turning),
            arm,
            orientation: member.orientation,
            angular_velocity: omega,
        }
    }
}

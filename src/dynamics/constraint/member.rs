//! A body as constraints see it.

use glam::{DMat3, DQuat, DVec3};

use super::super::model::is_isotropic;
use super::super::{Anchor, Model, State};
use super::Members;

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
    /// Body `i` of a state.
    pub(super) fn of(i: usize, model: &Model, state: &State) -> Member {
        let orientation = state.orientation[i];
        let axes = model.principal_axes(i);
        let inverse_mass = model.inverse_mass()[i];
        let principal = model.inverse_inertia()[i];
        let inverse_inertia = if inverse_mass == 0.0 {
            DMat3::ZERO
        } else if is_isotropic(principal) {
            DMat3::from_diagonal(principal)
        } else {
            let turn = DMat3::from_quat(orientation);
            turn * DMat3::from_diagonal(principal) * turn.transpose()
        };
        Member {
            location: state.location[i],
            velocity: state.velocity[i],
            orientation: if axes == DQuat::IDENTITY { orientation } else { orientation * axes.conjugate() },
            angular_velocity: model.angular_velocity(i, state),
            inverse_mass,
            inverse_inertia,
        }
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

    fn on(member: &Member, body: usize, at: DVec3) -> End {
        let arm = if at == DVec3::ZERO { at } else { member.orientation * at };
        let omega = member.angular_velocity;
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

//! Bodies and ends in the form that constraints need.

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
    /// The rotation from its own axes to the world's.
    pub orientation: DQuat,
    /// Its angular velocity, world axes, rad/s.
    pub angular_velocity: DVec3,
    /// Its angular momentum about its centre of mass, world axes, kg m²/s.
    pub(super) angular_momentum: DVec3,
    /// 1/m, 1/kg; 0 for a body that forces do not move.
    pub(super) inverse_mass: f64,
    /// R I⁻¹ Rᵀ, 1/(kg m²); 0 for a body that torques do not rotate.
    pub(super) inverse_inertia: DMat3,
}

/// The constants of a body of a constraint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nature {
    body: usize,
    inverse_mass: f64,
    /// I⁻¹ in its principal axes.
    inverse_inertia: DVec3,
    is_isotropic: bool,
    /// The rotation from its own axes to its principal axes. `None` if they are the same.
    turned: Option<DQuat>,
}

impl Nature {
    pub(super) fn of(body: usize, model: &Model) -> Nature {
        let (axes, inverse_inertia) = (model.principal_axes(body), model.inverse_inertia()[body]);
        Nature {
            body,
            inverse_mass: model.inverse_mass()[body],
            inverse_inertia,
            is_isotropic: is_isotropic(inverse_inertia),
            turned: (axes != DQuat::IDENTITY).then(|| axes.conjugate()),
        }
    }
}

impl Member {
    /// A body with an unknown state.
    pub(super) fn new(nature: &Nature) -> Member {
        let inverse_mass = nature.inverse_mass;
        let inverse_inertia = if inverse_mass == 0.0 { DVec3::ZERO } else { nature.inverse_inertia };
        let inverse_inertia = DMat3::from_diagonal(inverse_inertia);
        Member { inverse_mass, inverse_inertia, ..Member::default() }
    }

    /// Body `i` of a state.
    pub(super) fn of(i: usize, model: &Model, state: &State) -> Member {
        let nature = Nature::of(i, model);
        let mut member = Member::new(&nature);
        member.follow(&nature, state);
        member
    }

    /// Updates position and motion from a state. Returns whether the position or orientation has changed.
    #[inline(always)]
    pub(super) fn follow(&mut self, nature: &Nature, state: &State) -> bool {
        let i = nature.body;
        let angular_momentum = state.angular_momentum[i];
        let orientation = match nature.turned {
            None => state.orientation[i],
            Some(turned) => state.orientation[i] * turned,
        };
        let has_moved = self.location != state.location[i] || self.orientation != orientation;
        self.location = state.location[i];
        self.velocity = state.velocity[i];
        self.orientation = orientation;
        self.angular_momentum = angular_momentum;
        if nature.is_isotropic {
            // The inertia is the same for all orientations.
            self.angular_velocity = nature.inverse_inertia.x * angular_momentum;
            return has_moved;
        }
        let turn = DMat3::from_quat(state.orientation[i]);
        let back = turn.transpose();
        self.angular_velocity = turn * (nature.inverse_inertia * (back * angular_momentum));
        if self.inverse_mass != 0.0 {
            self.inverse_inertia = turn * (DMat3::from_diagonal(nature.inverse_inertia) * back);
        }
        has_moved
    }

    /// M⁻¹ times a direction.
    pub(super) fn weigh(&self, direction: &Direction) -> Direction {
        Direction {
            linear: self.inverse_mass * direction.linear,
            angular: self.turn(direction.angular),
            ..*direction
        }
    }

    /// I⁻¹ times a vector. The vector is often zero, and always for an end at the centre of mass.
    pub(super) fn turn(&self, vector: DVec3) -> DVec3 {
        if vector == DVec3::ZERO { vector } else { self.inverse_inertia * vector }
    }
}

/// An end of a constraint at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct End<'a> {
    /// The index of its body among those of the constraint. `None` for a point of the world.
    pub(super) body: Option<usize>,
    /// Its body. A point of the world has a body at rest at the origin.
    pub(super) member: &'a Member,
    /// r: the vector from the centre of mass to it, m.
    pub(super) arm: DVec3,
    /// Whether it is a point of a body away from the centre of mass.
    pub(super) is_off_centre: bool,
}

/// The body to which points of the world belong.
static WORLD: Member = Member {
    location: DVec3::ZERO,
    velocity: DVec3::ZERO,
    orientation: DQuat::IDENTITY,
    angular_velocity: DVec3::ZERO,
    angular_momentum: DVec3::ZERO,
    inverse_mass: 0.0,
    inverse_inertia: DMat3::ZERO,
};

impl<'a> End<'a> {
    /// The ends of a constraint; `members` are its bodies, each once, in the order of the ends.
    #[inline(always)]
    pub(super) fn all<const N: usize>(anchors: &[Anchor; N], members: &'a Members<'_>) -> [End<'a>; N] {
        let world = End { body: None, member: &WORLD, arm: DVec3::ZERO, is_off_centre: false };
        let (mut ends, mut bodies) = ([world; N], 0);
        // A loop instead of `from_fn`: calling a closure for each end slows rods down.
        for (i, &anchor) in anchors.iter().enumerate() {
            ends[i] = match anchor {
                Anchor::Point(arm) => End { arm, ..world },
                Anchor::Body { id, at } => {
                    let same = (0..i).find(|&other| anchors[other].body() == Some(id));
                    let body = same.and_then(|same| ends[same].body).unwrap_or(bodies);
                    bodies = bodies.max(body + 1);
                    let member = &members[body];
                    let is_off_centre = at != DVec3::ZERO;
                    let arm = if is_off_centre { member.orientation * at } else { at };
                    End { body: Some(body), member, arm, is_off_centre }
                }
            };
        }
        ends
    }

    /// Its position, m.
    pub(super) fn location(&self) -> DVec3 {
        self.member.location + self.arm
    }

    /// The rotation from the body's axes to the world's.
    pub(super) fn orientation(&self) -> DQuat {
        self.member.orientation
    }

    /// The angular velocity of the body, rad/s.
    pub(super) fn angular_velocity(&self) -> DVec3 {
        self.member.angular_velocity
    }

    /// ω × r, its velocity relative to the centre of mass, m/s; and ω × (ω × r), its centripetal acceleration, m/s².
    #[inline(always)]
    pub(super) fn turning(&self) -> (DVec3, DVec3) {
        let omega = self.member.angular_velocity;
        let turning = omega.cross(self.arm);
        (turning, omega.cross(turning))
    }

    /// Its velocity, m/s, and its centripetal acceleration, m/s².
    #[inline(always)]
    pub(super) fn motion(&self) -> (DVec3, DVec3) {
        if !self.is_off_centre {
            return (self.member.velocity, DVec3::ZERO);
        }
        let (turning, bend) = self.turning();
        (self.member.velocity + turning, bend)
    }
}

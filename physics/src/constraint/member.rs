//! The bodies and the ends of constraints, in the form that the constraint equations need.

use glam::{DMat3, DQuat, DVec3};

use super::super::model::is_isotropic;
use super::super::{Anchor, Model, State};
use super::{Direction, Members};

/// The state of a body at one moment, as constraint equations need it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Member {
    /// The position of the body's center of mass, world axes, m.
    pub location: DVec3,
    /// The velocity of the body's center of mass, world axes, m/s.
    pub velocity: DVec3,
    /// The rotation from the body axes to the world axes.
    pub orientation: DQuat,
    /// The angular velocity of the body, world axes, rad/s.
    pub angular_velocity: DVec3,
    /// The angular momentum of the body about its center of mass, world axes, kg m²/s.
    pub(super) angular_momentum: DVec3,
    /// The inverse mass 1/m of the body, 1/kg; 0 for a body that forces cannot move.
    pub(super) inverse_mass: f64,
    /// The inverse inertia tensor R I⁻¹ Rᵀ of the body, world axes, 1/(kg m²); 0 for a body that torques cannot rotate.
    pub(super) inverse_inertia: DMat3,
    /// The size of the body, m: its largest radius of gyration. 0 for a body that forces cannot move.
    pub(super) size: f64,
}

/// The constant properties of a constrained body: its mass and inertia.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyConstants {
    body: usize,
    inverse_mass: f64,
    /// The diagonal of the inverse inertia tensor I⁻¹ in the principal axes, 1/(kg m²).
    inverse_inertia: DVec3,
    is_isotropic: bool,
    /// The size of the body, m: its largest radius of gyration. 0 for a body that forces cannot move.
    pub(super) size: f64,
    /// The rotation from the body axes to the principal axes. `None` if these axes are the same.
    turned: Option<DQuat>,
}

impl BodyConstants {
    /// Returns true if forces can move the body.
    pub(super) fn can_move(&self) -> bool {
        self.inverse_mass != 0.0
    }

    pub(super) fn of(body: usize, model: &Model) -> BodyConstants {
        let (axes, inverse_inertia) = (model.principal_axes(body), model.inverse_inertia()[body]);
        BodyConstants {
            body,
            inverse_mass: model.inverse_mass()[body],
            inverse_inertia,
            is_isotropic: is_isotropic(inverse_inertia),
            size: (model.inertia()[body].max_element() * model.inverse_mass()[body]).sqrt(),
            turned: (axes != DQuat::IDENTITY).then(|| axes.conjugate()),
        }
    }
}

impl Member {
    /// Returns true if forces can move the body.
    pub(crate) fn can_move(&self) -> bool {
        self.inverse_mass != 0.0
    }

    /// Creates a member with the mass and inertia of a body. Its position and velocity are not set yet.
    pub(super) fn new(nature: &BodyConstants) -> Member {
        let inverse_mass = nature.inverse_mass;
        let inverse_inertia = if inverse_mass == 0.0 { DVec3::ZERO } else { nature.inverse_inertia };
        let inverse_inertia = DMat3::from_diagonal(inverse_inertia);
        Member { inverse_mass, inverse_inertia, size: nature.size, ..Member::default() }
    }

    /// Returns body `i` with its position and velocity in a state.
    pub(super) fn of(i: usize, model: &Model, state: &State) -> Member {
        let nature = BodyConstants::of(i, model);
        let mut member = Member::new(&nature);
        member.follow(&nature, state);
        member
    }

    /// Copies the position and velocity of the body from a state. Returns true if the position or orientation has changed.
    #[inline(always)]
    pub(super) fn follow(&mut self, nature: &BodyConstants, state: &State) -> bool {
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
            // The inertia tensor of an isotropic body does not depend on its orientation.
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

    /// Multiplies a direction of the Jacobian by M⁻¹, the body's inverse mass and inverse inertia.
    pub(super) fn weigh(&self, direction: &Direction) -> Direction {
        Direction {
            linear: self.inverse_mass * direction.linear,
            angular: self.turn(direction.angular),
            ..*direction
        }
    }

    /// Multiplies a vector in world axes by the inverse inertia tensor. Zero vectors are frequent (ends at centers of mass), so they are
    /// returned at once.
    pub(super) fn turn(&self, vector: DVec3) -> DVec3 {
        if vector == DVec3::ZERO { vector } else { self.inverse_inertia * vector }
    }
}

/// An end of a constraint at one moment: a point of a body, or a point of the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct End<'a> {
    /// The index of the end's body among the bodies of the constraint. `None` for a point of the world.
    pub(super) body: Option<usize>,
    /// The state of the end's body. For a point of the world, a body at rest at the origin.
    pub(super) member: &'a Member,
    /// r: the vector from the body's center of mass to the end, world axes, m.
    pub(super) arm: DVec3,
    /// True if the end is a point of a body away from its center of mass.
    pub(super) is_off_centre: bool,
}

/// The body of all ends that are points of the world. It rests at the origin.
static WORLD: Member = Member {
    location: DVec3::ZERO,
    velocity: DVec3::ZERO,
    orientation: DQuat::IDENTITY,
    angular_velocity: DVec3::ZERO,
    angular_momentum: DVec3::ZERO,
    inverse_mass: 0.0,
    inverse_inertia: DMat3::ZERO,
    size: 0.0,
};

impl<'a> End<'a> {
    /// Computes the ends of a constraint at one moment. `members` are the bodies of the constraint, each once, in the order of the ends.
    #[inline(always)]
    pub(super) fn all<const N: usize>(anchors: &[Anchor; N], members: &'a Members<'_>) -> [End<'a>; N] {
        let (mut ends, mut bodies) = ([End::of(Anchor::Point(DVec3::ZERO), None, members); N], 0);
        // A loop instead of `from_fn`: a closure call for each end would slow down rods.
        for (i, &anchor) in anchors.iter().enumerate() {
            let mut body = None;
            if let Anchor::Body { id, .. } = anchor {
                let same = (0..i).find(|&other| anchors[other].body() == Some(id));
                let place = same.and_then(|same| ends[same].body).unwrap_or(bodies);
                bodies = bodies.max(place + 1);
                body = Some(place);
            }
            ends[i] = End::of(anchor, body, members);
        }
        ends
    }

    /// Computes an end of a constraint at one moment. `body` is the index of the end's body among `members`, and `None` for a point of the
    /// world.
    #[inline(always)]
    pub(super) fn of(anchor: Anchor, body: Option<usize>, members: &'a Members<'_>) -> End<'a> {
        match (anchor, body) {
            (Anchor::Body { at, .. }, Some(body)) => {
                let (member, is_off_centre) = (&members[body], at != DVec3::ZERO);
                let arm = if is_off_centre { member.orientation * at } else { at };
                End { body: Some(body), member, arm, is_off_centre }
            }
            (Anchor::Body { at: arm, .. } | Anchor::Point(arm), _) => {
                End { body: None, member: &WORLD, arm, is_off_centre: false }
            }
        }
    }

    /// Returns the position of the end, world axes, m.
    pub(super) fn location(&self) -> DVec3 {
        self.member.location + self.arm
    }

    /// Returns the size of the end, m: its lever and the size of its body. 0 if forces cannot move the body.
    #[inline(always)]
    pub(super) fn size(&self) -> f64 {
        if self.member.inverse_mass == 0.0 { 0.0 } else { self.arm.length().max(self.member.size) }
    }

    /// Returns the rotation from the axes of the end's body to the world axes.
    pub(super) fn orientation(&self) -> DQuat {
        self.member.orientation
    }

    /// Returns the angular velocity of the end's body, world axes, rad/s.
    pub(super) fn angular_velocity(&self) -> DVec3 {
        self.member.angular_velocity
    }

    /// Returns two vectors that follow from the rotation of the end's body: ω × r, the end's velocity relative to the center of mass, m/s;
    /// and ω × (ω × r), its centripetal acceleration, m/s².
    #[inline(always)]
    pub(super) fn turning(&self) -> (DVec3, DVec3) {
        let omega = self.member.angular_velocity;
        let turning = omega.cross(self.arm);
        (turning, omega.cross(turning))
    }

    /// Returns the velocity of the end, m/s, and its centripetal acceleration, m/s².
    #[inline(always)]
    pub(super) fn motion(&self) -> (DVec3, DVec3) {
        if !self.is_off_centre {
            return (self.member.velocity, DVec3::ZERO);
        }
        let (turning, bend) = self.turning();
        (self.member.velocity + turning, bend)
    }
}

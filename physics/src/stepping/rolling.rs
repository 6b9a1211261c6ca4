//! The rotation of round bodies within their own surface.
//!
//! The physics engine keeps a contact as one point of each body, and moves both points with their bodies during a step. When a ball rolls,
//! its surface stays where it is, but the point leaves the floor: by r (1 − cos φ) for a radius r and an angle φ. The engine would take this
//! for a gap, and give the ball the velocity that closes the gap, ½ r ω² Δt. Fast balls would hop, and fast wheels would leave their track.
//!
//! So the engine does not get the part of a body's angular velocity that leaves its surface in place, the spin: all of it for a ball, the
//! component along the axis for a cylinder. Friction finds the spin as the velocity of the surface, as of a conveyor belt. After the step,
//! the body is rotated by the spin.

use glam::{DQuat, DVec3};
use rapier3d_f64::prelude::{ColliderHandle, ContactModificationContext, PhysicsWorld, RigidBodyHandle};

use super::super::Model;
use super::super::model::is_isotropic;
use super::joint::Joints;
use super::rotation::advanced;
use super::shape::Symmetry;
use super::touch::Touch;

/// The smallest rotation by the spin within a step, rad, that is computed here. A smaller one is left to the physics engine.
const MIN_SPIN_ROTATION: f64 = 0.005;
/// The surface of a body has different velocities at the points of a contact if the cosine of the angle between the contact's normal and
/// the axis is larger than this.
const INCLINED_COSINE: f64 = 0.1;
/// The tolerance for the position of a common axis, as a fraction of the thickness of the thinnest moving body, and for the sine of the
/// angle between two axes.
const COMMON_AXIS_TOLERANCE: f64 = 1e-6;

/// A body whose surface is symmetric under rotations about its centre of mass, or about an axis through it.
struct RoundBody {
    /// The axis of the symmetry and of all hinges, a unit vector in the engine's frame of the body; `None` for a ball without joints.
    axis: Option<DVec3>,
    /// The part of the leading angular velocity that belongs to the spin; see `rotation::leading`.
    leading: DVec3,
    /// Whether the engine need not know the orientation of the body: a ball of equal moments of inertia, without joints.
    is_ball: bool,
    /// The orientation of the body in the engine if it differs from the true one: for a body with a spin, after the last step, and always for
    /// a ball.
    unturned: Option<DQuat>,
}

/// The colliders of a body, each with the symmetries of its parts in the engine's frame of the body.
pub(super) type ColliderSymmetries = Vec<(ColliderHandle, Vec<Symmetry>)>;

/// The round bodies, and their spins in the present step.
pub(super) struct Rolling {
    /// The round body with each index, if the body is round.
    round: Vec<Option<RoundBody>>,
    /// The spin of each body, world axes, rad/s.
    spin: Vec<DVec3>,
}

impl Rolling {
    /// Finds the round bodies. `symmetries` holds the colliders of each body, and `length` is the thickness of the thinnest moving body, m.
    pub(super) fn new(
        engine: &PhysicsWorld,
        symmetries: &[ColliderSymmetries],
        (model, joints): (&Model, &Joints),
        length: f64,
    ) -> Rolling {
        let hinges = joints.hinges(engine, symmetries.len());
        let round = symmetries.iter().zip(hinges).enumerate().map(|(i, (colliders, hinges))| {
            let parts = colliders.iter().flat_map(|(_, parts)| parts.iter().copied());
            let hinges = hinges?.into_iter().map(|(centre, axis)| Symmetry::Axis { centre, axis });
            let axis = common_axis(&parts.chain(hinges).collect::<Vec<_>>(), COMMON_AXIS_TOLERANCE * length)?;
            Some(RoundBody {
                axis,
                leading: DVec3::ZERO,
                // The moments of inertia of an absent body are not known yet.
                is_ball: axis.is_none() && model.is_present(i) && is_isotropic(model.inverse_inertia()[i]),
                unturned: None,
            })
        });
        let round: Vec<Option<RoundBody>> = round.collect();
        Rolling { spin: vec![DVec3::ZERO; round.len()], round }
    }

    /// Reads the orientations of balls in the physics engine, after it has been restored from a checkpoint. `handles` holds the engine's handle of each body.
    #[cfg(feature = "checkpoints")]
    pub(super) fn resume(&mut self, engine: &PhysicsWorld, handles: &[RigidBodyHandle]) {
        for (round, handle) in self.round.iter_mut().zip(handles) {
            let Some(round) = round else { continue };
            let orientation = engine.bodies.get(*handle).map(|body| *body.rotation());
            round.unturned = orientation.filter(|_| round.is_ball);
        }
    }

    /// Notes that the orientation of a body has been set in the physics engine.
    pub(super) fn set(&mut self, body: usize) {
        if let Some(round) = &mut self.round[body] {
            round.unturned = None;
        }
    }

    /// Finds the spin of a body in a step of `dt` seconds. `turning` is the angular velocity of the body, and `leading` is the one with
    /// which the physics engine would rotate it, rad/s. Returns the part of `leading` that the engine must not get.
    pub(super) fn take(
        &mut self,
        engine: &PhysicsWorld,
        colliders: &[ColliderHandle],
        body: usize,
        (orientation, turning, leading): (DQuat, DVec3, DVec3),
        dt: f64,
    ) -> DVec3 {
        let Some(round) = &mut self.round[body] else { return DVec3::ZERO };
        let axis = round.axis.map(|axis| orientation * axis);
        let [spin, leading] = [turning, leading].map(|all| axis.map_or(all, |axis| all.dot(axis) * axis));
        let is_fast = spin.length_squared() * dt * dt > MIN_SPIN_ROTATION * MIN_SPIN_ROTATION;
        let is_spun = is_fast && !axis.is_some_and(|axis| is_twisted(engine, colliders, axis));
        (self.spin[body], round.leading) = if is_spun { (spin, leading) } else { (DVec3::ZERO, DVec3::ZERO) };
        round.leading
    }

    /// Whether the engine must call [`Rolling::modify`] for the contacts of a body in the present step.
    pub(super) fn is_spun(&self, body: usize) -> bool {
        self.spin[body] != DVec3::ZERO
    }

    /// Whether the surface of a body is symmetric about an axis or about its centre.
    pub(super) fn is_round(&self, body: usize) -> bool {
        self.round[body].is_some()
    }

    /// Whether the engine need not know the orientation of a body.
    pub(super) fn is_ball(&self, body: usize) -> bool {
        self.round[body].as_ref().is_some_and(|round| round.is_ball)
    }

    /// The spin of a body in the present step, world axes, rad/s.
    pub(super) fn spin(&self, body: usize) -> DVec3 {
        self.spin[body]
    }

    /// Returns the orientation of a body after a step of `dt`, with the rotation by its spin. The body had the orientation `from`, and the
    /// physics engine ended at the orientation `to`. Also returns whether the orientation must be set in the engine. `None` if the
    /// orientation in the engine is the true one.
    pub(super) fn turn(&mut self, body: usize, [from, to]: [DQuat; 2], dt: f64) -> Option<(DQuat, bool)> {
        let round = self.round[body].as_mut()?;
        let begin = round.unturned.filter(|_| round.is_ball).unwrap_or(from);
        round.unturned = (round.is_ball || round.leading != DVec3::ZERO).then_some(to);
        round.unturned?;
        // The engine advances orientations along a straight line, q + ½ ω q dt. So both parts of the angular velocity add up.
        let change = to * begin.conjugate();
        let turning = 2.0 / dt / change.w * DVec3::new(change.x, change.y, change.z) + round.leading;
        Some((advanced(from, turning, dt), !round.is_ball))
    }

    /// Returns the orientation that a body has in the physics engine after a step, if it differs from the true one. The engine's contacts
    /// belong to this orientation.
    pub(super) fn unturned(&self, body: usize) -> Option<DQuat> {
        self.round[body].as_ref()?.unturned
    }

    /// Gives the points of a contact the velocities that the spins give the surfaces there.
    pub(super) fn modify(&self, context: &mut ContactModificationContext<'_>) {
        let side = |body: Option<RigidBodyHandle>| {
            let body = body?;
            let spin = *self.spin.get(body.into_raw_parts().0 as usize)?;
            Some((spin, context.bodies.get(body)?.translation()))
        };
        let sides = [context.rigid_body1, context.rigid_body2].map(side);
        let Some(contact) = context.rigid_mut() else { return };
        for point in contact.solver_contacts.iter_mut() {
            let place = 0.5 * (point.anchor1 + point.anchor2);
            let velocity = |(spin, centre): (DVec3, DVec3)| spin.cross(place - centre);
            let [one, two] = sides.map(|side| side.map_or(DVec3::ZERO, velocity));
            point.tangent_velocity = one - two;
        }
    }
}

/// Returns the axis through the centre of mass about which all parts are symmetric: `Some(None)` if every axis is, `None` if none is.
fn common_axis(parts: &[Symmetry], tolerance: f64) -> Option<Option<DVec3>> {
    let own = |part: &Symmetry| match *part {
        Symmetry::Axis { axis, .. } => Some(axis),
        Symmetry::Point { centre } if centre.length() > tolerance => Some(centre.normalize()),
        Symmetry::Point { .. } | Symmetry::None => None,
    };
    let common = parts.iter().find_map(own);
    let is_on_axis = |place: DVec3| common.is_none_or(|axis| place.cross(axis).length() <= tolerance);
    let fits = |part: &Symmetry| match *part {
        Symmetry::None => false,
        Symmetry::Point { centre } => is_on_axis(centre),
        Symmetry::Axis { centre, axis: own } => {
            is_on_axis(centre) && common.is_some_and(|axis| axis.cross(own).length() <= COMMON_AXIS_TOLERANCE)
        }
    };
    (!parts.is_empty() && parts.iter().all(fits)).then_some(common)
}

/// Returns true if the spin about an axis gives the surface different velocities at the points of a contact, as for a disk that lies flat or a
/// cone that lies on its side. The engine's friction knows only one velocity for all points of a contact.
fn is_twisted(engine: &PhysicsWorld, colliders: &[ColliderHandle], axis: DVec3) -> bool {
    let pairs = colliders.iter().flat_map(|collider| engine.narrow_phase.contact_pairs_with(*collider));
    let is_inclined = |touch: &Touch<'_>| touch.normal().dot(axis).abs() > INCLINED_COSINE;
    pairs.flat_map(Touch::of_pair).any(|touch| is_inclined(&touch) && touch.points().nth(1).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINT: Symmetry = Symmetry::Point { centre: DVec3::ZERO };

    fn about(centre: DVec3, axis: DVec3) -> Symmetry {
        Symmetry::Axis { centre, axis }
    }

    #[test]
    fn a_ball_is_symmetric_about_every_axis_and_a_wheel_about_one() {
        assert_eq!(common_axis(&[POINT], 1e-9), Some(None));
        let wheel = about(0.3 * DVec3::Y, DVec3::Y);
        assert_eq!(common_axis(&[POINT, wheel], 1e-9), Some(Some(DVec3::Y)));
        // The hinge of a wheel has the opposite direction.
        assert_eq!(common_axis(&[wheel, about(DVec3::ZERO, -DVec3::Y)], 1e-9), Some(Some(DVec3::Y)));
        let dumbbell = [1.0, -1.0].map(|x| Symmetry::Point { centre: x * DVec3::X });
        assert_eq!(common_axis(&dumbbell, 1e-9), Some(Some(DVec3::X)));
    }

    #[test]
    fn what_has_two_axes_or_corners_is_not_round() {
        assert_eq!(common_axis(&[POINT, Symmetry::None], 1e-9), None);
        assert_eq!(common_axis(&[], 1e-9), None);
        assert_eq!(common_axis(&[about(DVec3::ZERO, DVec3::Y), about(DVec3::ZERO, DVec3::X)], 1e-9), None);
        assert_eq!(common_axis(&[about(0.1 * DVec3::X, DVec3::Y)], 1e-9), None);
    }
}

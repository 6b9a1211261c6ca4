//! A lasting contact between two bodies at one point: a constraint that pushes and never pulls, with friction.

use std::collections::BTreeSet;

use glam::DVec3;

use super::super::constraint::{Constraint, Equations, Law, Member, Members, Scale};
use super::super::{Anchor, BodyId};
use super::contact_rates::ContactRates;
use super::patch::{Patch, meet};
use super::solid::Pose;
use super::touch::Touch;
use super::{ContactProperties, ContactSnapshot, closest_points::ClosestPoints};

/// A lasting contact between two bodies at one point.
#[derive(Clone, Debug)]
pub(crate) struct LastingContact {
    /// The indices of the two bodies, in ascending order.
    pub(crate) bodies: [usize; 2],
    /// The features of the two bodies (corners, edges, faces) that touch, and their closest points.
    pub(crate) touch: Touch,
    /// The restitution and the friction of the two surfaces.
    pub(crate) law: ContactProperties,
    /// A typical length of the smaller body, m. Tolerances are relative to it.
    pub(crate) size: f64,
    /// The bodies count as at rest at this contact if they separate more slowly than this, m/s.
    pub(crate) still: f64,
    /// True if the bodies may pass each other: in free flight, they are apart at the end of the substep.
    pub(crate) may_miss: bool,
    /// For a rim on a plane: the unit direction from the center of the rim to the contact point, world axes. Zero for all others.
    pub(crate) spoke: DVec3,
}

/// Returns the unit direction from the center of a rim to its contact point with a plane, world axes; zero for all other contacts.
pub(crate) fn spoke(patches: &[Patch; 2], poses: [&Pose; 2], meeting: &ClosestPoints) -> DVec3 {
    let side = match patches {
        [Patch::Circle { .. }, Patch::Plane { .. }] => 0,
        [Patch::Plane { .. }, Patch::Circle { .. }] => 1,
        _ => return DVec3::ZERO,
    };
    let Patch::Circle { centre, .. } = patches[side] else { return DVec3::ZERO };
    (meeting.on[side] - poses[side].point(centre)).normalize_or_zero()
}

/// Two limits for the cosine of the angle by which the normal has turned since the contact was found. Below the first limit, the step ends
/// and the tangents are chosen again. Below the second limit, the tangents are chosen again at events with another cause.
const NORMAL_COSINE_LIMITS: [f64; 2] = [0.0, 0.25];

/// The same two limits for the cosine of the angle by which the contact point has moved around a rim: cos 5° and cos 3.6°. A step is
/// accurate only if the forces in it act at nearly one place.
const RIM_COSINE_LIMITS: [f64; 2] = [0.9962, 0.998];

impl LastingContact {
    /// Returns true if one of the contact's bodies is in this set.
    pub(crate) fn is_of(&self, bodies: &BTreeSet<usize>) -> bool {
        self.bodies.iter().any(|body| bodies.contains(body))
    }

    /// Returns whether the contact has friction, and whether it has rolling friction. Each adds a pair of rows.
    fn pairs(&self) -> [bool; 2] {
        [self.law.friction > 0.0, self.law.rolling_friction > 0.0]
    }

    /// Returns true if a newly found contact is the same as this one: the same features of the same bodies touch, and the tangents remain
    /// valid.
    pub(crate) fn is(&self, new: &LastingContact) -> bool {
        let is_same = self.bodies == new.bodies && self.touch.patches == new.touch.patches;
        let has_turned = self.touch.meeting.normal.dot(new.touch.meeting.normal) < NORMAL_COSINE_LIMITS[1];
        let has_run = self.spoke != DVec3::ZERO && self.spoke.dot(new.spoke) < RIM_COSINE_LIMITS[1];
        is_same && !has_turned && !has_run
    }

    /// Returns how far the contact normal, and the contact point on a rim, are from the limit at which the contact must be found again, as a
    /// difference of cosines. It is negative beyond the limit. The contact point of a nearly flat rim can run around it within a step, and
    /// forces at the place where it was would then press the rim into the plane.
    pub(super) fn left(&self, poses: [Pose; 2]) -> f64 {
        let meeting = self.meet(poses);
        let turned = self.touch.meeting.normal.dot(meeting.normal) - NORMAL_COSINE_LIMITS[0];
        if self.spoke == DVec3::ZERO {
            return turned;
        }
        let spoke = spoke(&self.touch.patches, [&poses[0], &poses[1]], &meeting);
        turned.min(self.spoke.dot(spoke) - RIM_COSINE_LIMITS[0])
    }

    /// Returns two unit tangents, perpendicular to the normal and to each other. They turn with the normal by the shortest way from those
    /// at the beginning of the contact. Which these are is arbitrary: no result depends on them.
    fn tangents(&self, normal: DVec3) -> [DVec3; 2] {
        let begun = self.touch.meeting.normal;
        let first = begun.any_orthonormal_vector();
        let first = first - first.dot(normal) / (1.0 + begun.dot(normal)) * (begun + normal);
        let first = first.reject_from_normalized(normal).normalize();
        [first, normal.cross(first)]
    }

    /// Returns the components of a force along the rows of the same contact found later, from those along the rows of this one.
    pub(crate) fn carried(&self, forces: &[f64], new: &LastingContact) -> Vec<f64> {
        let [old, new] = [self, new].map(|contact| contact.tangents(contact.touch.meeting.normal));
        let mut carried = forces.to_vec();
        for pair in carried.get_mut(1..).into_iter().flat_map(|pairs| pairs.chunks_exact_mut(2)) {
            let force = pair[0] * old[0] + pair[1] * old[1];
            (pair[0], pair[1]) = (force.dot(new[0]), force.dot(new[1]));
        }
        carried
    }

    /// Returns the gap of the bodies at this contact, m. It is negative if they overlap.
    pub(super) fn gap(&self, poses: [Pose; 2]) -> f64 {
        self.meet(poses).gap
    }

    /// Returns the closest points of the two features.
    pub(crate) fn meet(&self, poses: [Pose; 2]) -> ClosestPoints {
        meet(&self.touch.patches[0], &poses[0], &self.touch.patches[1], &poses[1])
    }
}

/// Returns the current pose (position and orientation) of a body.
fn pose(member: &Member) -> Pose {
    Pose { location: member.location, orientation: member.orientation }
}

/// Computes the velocity of the second body relative to the first at the contact point, m/s.
fn slip(meeting: &ClosestPoints, members: [&Member; 2]) -> DVec3 {
    let at = |member: &Member, place: DVec3| {
        member.velocity + member.angular_velocity.cross(place - member.location)
    };
    at(members[1], meeting.on[1]) - at(members[0], meeting.on[0])
}

impl Constraint for LastingContact {
    fn ends(&self) -> Vec<Anchor> {
        self.bodies.map(|body| Anchor::centre(BodyId::new(body))).to_vec()
    }

    fn rows(&self) -> usize {
        1 + self.pairs().into_iter().map(|is_there| 2 * usize::from(is_there)).sum::<usize>()
    }

    fn law(&self, row: usize) -> Law {
        match row {
            0 => Law::Inequality,
            1 | 2 if self.law.friction > 0.0 => Law::Friction { coefficient: self.law.friction },
            _ => Law::Friction { coefficient: self.law.rolling_friction },
        }
    }

    /// Writes the equations of the contact: the gap c ≥ 0 along the normal; then the slip along two tangents; then the rolling about them.
    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>) {
        let both = [&members[0], &members[1]];
        let meeting = self.meet(both.map(pose));
        let ClosestPoints { gap, normal, on } = meeting;
        let arms = [on[0] - both[0].location, on[1] - both[1].location];
        let [a, b] = &self.touch.patches;
        let change = ContactRates::of([a, b], both, &meeting, self.size);
        let slipping = slip(&meeting, both);
        // The part of the slip's rate that does not depend on accelerations: the arms change as the contact point moves over both bodies.
        let turning = |i: usize| both[i].angular_velocity.cross(change.place - both[i].velocity);
        let drift = turning(1) - turning(0);
        let terms = on[0].abs().max(on[1].abs()).max(arms[0].abs()).max(arms[1].abs()).max_element();
        let levers = [0, 1].map(|i| if both[i].can_move() { arms[i].length() } else { 0.0 });
        let scale = Scale::length(self.size, terms).max(Scale::length(levers[0].max(levers[1]), terms));
        let mut write = |row: usize, violation: f64, bias: f64, linear: DVec3| {
            equations.row(row, violation, bias, scale);
            equations.direction(row, Some(0), -linear, -arms[0].cross(linear));
            equations.direction(row, Some(1), linear, arms[1].cross(linear));
        };
        write(0, gap, normal.dot(drift) + change.normal.dot(slipping), normal);
        let [u, w] = self.tangents(normal);
        let [slides, rolls] = self.pairs();
        // For methods that correct initial velocities (SHAKE): the distance slipped since the start of the step, by the trapezoidal rule.
        let slipped = members.aimed().map_or(DVec3::ZERO, |origin| {
            let before = self.meet([&origin[0], &origin[1]].map(pose));
            0.5 * members.elapsed() * (slip(&before, [&origin[0], &origin[1]]) + slipping)
        });
        if slides {
            write(1, slipped.dot(u), u.dot(drift), u);
            write(2, slipped.dot(w), w.dot(drift), w);
        }
        if rolls {
            let first = if slides { 3 } else { 1 };
            let rolled = members.aimed().map_or(DVec3::ZERO, |origin| {
                let relative = |a: &Member, b: &Member| b.angular_velocity - a.angular_velocity;
                0.5 * members.elapsed() * (relative(&origin[0], &origin[1]) + relative(both[0], both[1]))
            });
            for (row, axis) in [(first, u), (first + 1, w)] {
                equations.row(row, rolled.dot(axis), 0.0, Scale::ANGLE);
                equations.direction(row, Some(0), DVec3::ZERO, -axis);
                equations.direction(row, Some(1), DVec3::ZERO, axis);
            }
        }
    }
}

impl LastingContact {
    /// Returns the snapshot of the contact: its place, normal, normal force and friction. The closure `add` adds the force that one row of
    /// the contact exerts on the second body.
    pub(crate) fn snapshot(&self, members: [&Member; 2], add: impl Fn(usize, &mut DVec3)) -> ContactSnapshot {
        let meeting = self.meet(members.map(pose));
        let (mut force, mut friction) = (DVec3::ZERO, DVec3::ZERO);
        add(0, &mut force);
        if self.law.friction > 0.0 {
            add(1, &mut friction);
            add(2, &mut friction);
        }
        let place = 0.5 * (meeting.on[0] + meeting.on[1]);
        ContactSnapshot { bodies: self.bodies, place, normal: meeting.normal, force, friction }
    }
}

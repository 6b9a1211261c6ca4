//! The motion of a particle that stays in contact with obstacles for a step: it slides or sticks.
//!
//! The motion is computed in the axes of an obstacle, where the obstacle is at rest. The motion of these axes adds inertial accelerations.

use glam::{DQuat, DVec3};

use super::bounce::Contact;
use super::obstacles::{ObstacleState, Scenery};
use super::particle_step::ParticleStep;
use crate::contact::Ball;

/// A particle comes to rest if its speed is at most this fraction of the velocity change that forces cause in a step.
const MAX_RESTING_SPEED: f64 = 1e-6;
/// Two unit normals count as equal if the length of their difference is at most this.
const NORMAL_TOLERANCE: f64 = 1e-12;
/// The largest number of iterations for the impulses of several simultaneous contacts.
const MAX_IMPULSE_ITERATIONS: usize = 60;
/// The iteration for the impulses ends when it changes the velocity by at most this fraction of the velocity change that forces cause in a
/// step.
const IMPULSE_TOLERANCE: f64 = 1e-13;
/// The largest number of corrections that move the particle onto the surfaces at the end of a step.
const MAX_POSITION_CORRECTIONS: usize = 6;
/// A particle counts as lying on a surface if the gap is at most this fraction of its radius.
const CONTACT_TOLERANCE: f64 = 1e-11;

/// The state of a particle at the beginning of a step, in the axes of an obstacle.
struct Frame {
    /// The poses and velocities of the obstacle at the beginning and at the end of the step.
    standing: [ObstacleState; 2],
    span: f64,
    place: DVec3,
    velocity: DVec3,
    acceleration: DVec3,
}

impl Frame {
    fn new(leap: &ParticleStep, contact: &Contact, scenery: &Scenery) -> Frame {
        let standing = leap.times.map(|t| scenery.standing(&contact.target, t));
        let back = standing.map(|it| it.pose.orientation.conjugate());
        let place = standing[0].pose.local(leap.places[0]);
        let carried = standing[1].pose.point(place);
        let begin = standing[0].velocity(leap.places[0]);
        let end = standing[1].velocity(carried);
        let velocity = back[0] * (leap.velocities[0] - begin);
        let against = leap.acceleration() - (end - begin) / leap.span();
        let turning = back[0] * standing[0].state.angular_velocity;
        let acceleration = 0.5 * (back[0] * against + back[1] * against) - 2.0 * turning.cross(velocity);
        Frame { standing, span: leap.span(), place, velocity, acceleration }
    }

    /// Converts a position and a velocity at the end of the step from the obstacle's axes to world axes.
    fn end(&self, place: DVec3, velocity: DVec3) -> (DVec3, DVec3) {
        let ObstacleState { pose, .. } = self.standing[1];
        let place = pose.point(place);
        (place, self.standing[1].velocity(place) + pose.orientation * velocity)
    }

    fn local(&self, direction: DVec3) -> DVec3 {
        self.standing[0].pose.orientation.conjugate() * direction
    }
}

/// Returns the position (m) and the velocity (m/s) at the end of a step, world axes, for a particle that stays in contact with the parts
/// in `held`.
pub(super) fn hold(ball: &Ball, leap: &ParticleStep, held: &[Contact], scenery: &Scenery) -> (DVec3, DVec3) {
    let frame = Frame::new(leap, &held[0], scenery);
    if let [contact] = held {
        hold_one(ball, &frame, contact, scenery)
    } else {
        hold_many(ball, leap, &frame, held, scenery)
    }
}

fn hold_one(ball: &Ball, frame: &Frame, contact: &Contact, scenery: &Scenery) -> (DVec3, DVec3) {
    let (span, friction) = (frame.span, contact.law.friction);
    let normal = frame.local(contact.near.normal);
    let begin = frame.velocity.reject_from_normalized(normal);
    let push = -span * normal.dot(frame.acceleration);
    if push <= 0.0 {
        // The rotation of the obstacle throws the particle off its surface.
        let velocity = frame.velocity + span * frame.acceleration;
        return frame.end(frame.place + 0.5 * span * (frame.velocity + velocity), velocity);
    }
    let along = (span * frame.acceleration).reject_from_normalized(normal);
    let (way, mut velocity) = slide(begin, along, friction * push, span);
    let mut place = frame.place + way;
    if way == DVec3::ZERO && contact.near.gap.abs() <= CONTACT_TOLERANCE * ball.radius() {
        return frame.end(place, velocity);
    }
    let (mut gap, mut end) = scenery.seen_within(ball, &contact.target, place);
    if gap.abs() < ball.radius() && (end - normal).length() > NORMAL_TOLERANCE {
        // On a curved surface, the tangent plane at the middle of the step is used. The curvature presses the particle onto the surface,
        // or throws it off.
        let middle = (normal + end).normalize_or(normal);
        let turned = DQuat::from_rotation_arc(normal, middle) * begin;
        let bent = middle.dot(DQuat::from_rotation_arc(normal, end) * begin - begin);
        let push = bent - span * middle.dot(frame.acceleration);
        if push > 0.0 {
            let along = (span * frame.acceleration).reject_from_normalized(middle);
            let (way, slid) = slide(turned, along, friction * push, span);
            place = frame.place + way;
            (gap, end) = scenery.seen_within(ball, &contact.target, place);
            velocity = (DQuat::from_rotation_arc(middle, end) * slid).reject_from_normalized(end);
        } else if gap > 0.0 {
            return frame.end(place, velocity);
        }
    }
    if gap.abs() < ball.radius() {
        place -= gap * end;
    }
    frame.end(place, velocity)
}

/// Slides along a plane for a step. Returns the displacement (m) and the final velocity (m/s). `along` is the velocity change without
/// friction, and `most` is the largest velocity change by friction.
fn slide(begin: DVec3, along: DVec3, most: f64, span: f64) -> (DVec3, DVec3) {
    let free = begin + along;
    let speed = free.length();
    if speed > most {
        let end = free * (1.0 - most / speed);
        return (0.5 * span * (begin + end), end);
    }
    let before = begin.length();
    if before == 0.0 {
        return (DVec3::ZERO, DVec3::ZERO);
    }
    // Friction stops the particle within the step.
    let slowing = most - along.dot(begin) / before;
    let stop = if slowing > before { before / slowing } else { 1.0 };
    (0.5 * stop * span * begin, DVec3::ZERO)
}

/// Returns the position and the velocity at the end of a step for a particle in contact with several parts. An iteration over the contacts
/// finds the impulses.
fn hold_many(
    ball: &Ball,
    leap: &ParticleStep,
    frame: &Frame,
    held: &[Contact],
    scenery: &Scenery,
) -> (DVec3, DVec3) {
    let span = frame.span;
    let acting = span * frame.acceleration.length();
    let mut velocity = frame.velocity + span * frame.acceleration;
    // For each contact, the list `given` holds the normal, the velocity of the obstacle relative to the first obstacle, and the normal and
    // friction impulses so far, per unit of mass.
    let other = |it: &Contact| {
        if Scenery::is_same(&it.target, &held[0].target) {
            return DVec3::ZERO;
        }
        let carried = frame.standing[1].pose.point(frame.place);
        let own = frame.standing[1].velocity(carried);
        let theirs = scenery.standing(&it.target, leap.times[1]).velocity(carried);
        frame.standing[1].pose.orientation.conjugate() * (theirs - own)
    };
    let mut given: Vec<(DVec3, DVec3, f64, DVec3)> =
        held.iter().map(|it| (frame.local(it.near.normal), other(it), 0.0, DVec3::ZERO)).collect();
    for _ in 0..MAX_IMPULSE_ITERATIONS {
        let last = velocity;
        for (it, (normal, theirs, pushed, rubbed)) in held.iter().zip(&mut given) {
            let relative = velocity - *theirs;
            let push = (*pushed - normal.dot(relative)).max(0.0);
            let rub = *rubbed - relative.reject_from_normalized(*normal);
            let rub = rub.clamp_length_max(it.law.friction * push);
            velocity += (push - *pushed) * *normal + (rub - *rubbed);
            (*pushed, *rubbed) = (push, rub);
        }
        if (velocity - last).length() <= IMPULSE_TOLERANCE * acting {
            break;
        }
    }
    let is_slow = |velocity: DVec3| velocity.length() <= MAX_RESTING_SPEED * acting;
    if is_slow(frame.velocity) && is_slow(velocity) {
        return frame.end(frame.place, DVec3::ZERO);
    }
    if is_slow(velocity) {
        velocity = DVec3::ZERO;
    }
    let place = frame.place + 0.5 * span * (frame.velocity + velocity);
    let (mut place, velocity) = frame.end(place, velocity);
    let least = CONTACT_TOLERANCE * ball.radius();
    for _ in 0..MAX_POSITION_CORRECTIONS {
        let mut is_right = true;
        for (it, (_, _, pushed, _)) in held.iter().zip(&given) {
            let near = scenery.seen(ball, &it.target, place, leap.times[1]);
            let is_off = near.gap < -least || *pushed > 0.0 && near.gap > least;
            if is_off && near.gap.abs() < ball.radius() {
                place -= near.gap * near.normal;
                is_right = false;
            }
        }
        if is_right {
            break;
        }
    }
    (place, velocity)
}

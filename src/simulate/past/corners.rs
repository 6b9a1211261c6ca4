//! Computes the corners of a trail at impacts between two frames.

use glam::DVec3;

use super::trail_path::{self, TrailPoint};
use crate::physics::{BodySnapshot, Impact};
use crate::scene::Trail;

/// The largest number of impacts between two points of a trail. More corners would be too close together to be seen.
pub(super) const MAX_CORNER_IMPACTS: usize = 4;

/// The time (s) and the state of a body at that time.
pub(super) type At = (f64, BodySnapshot);

/// Computes the points of a trail at the impacts between two moments. Each impact gives two points at one place, with the velocities
/// before and after the impact. `values` are those at both moments that the color of the trail follows. `impulse` returns the impulse of an impact on the body, N s. Returns no points if there are more than
/// [`MAX_CORNER_IMPACTS`] impacts.
///
/// An impact has a time, but no position of the body's center. The path is therefore computed forward from the first moment and backward
/// from the second, with a constant acceleration and the velocity jumps of the impacts. The result is exact under a constant force.
pub(super) fn between(
    (before, after): (&At, &At),
    values: [Option<f64>; 2],
    impacts: &[Impact],
    impulse: impl Fn(&Impact) -> DVec3,
    mass: f64,
    trail: Trail,
) -> Vec<TrailPoint> {
    let mut hits: Vec<(f64, DVec3)> = Vec::new();
    for impact in impacts {
        let jump = impulse(impact) / mass;
        if jump == DVec3::ZERO || impact.time <= before.0 || impact.time >= after.0 {
            continue;
        }
        match hits.last_mut().filter(|(time, _)| *time == impact.time) {
            Some((_, sum)) => *sum += jump,
            None => hits.push((impact.time, jump)),
        }
    }
    if hits.len() > MAX_CORNER_IMPACTS {
        return Vec::new();
    }
    let mut flight = Flight::of(before, mass, trail);
    let forth: Vec<Flight> = hits.iter().map(|hit| flight.pass(*hit, 1.0)).collect();
    let mut flight = Flight::of(after, mass, trail);
    let back: Vec<Flight> = hits.iter().rev().map(|hit| flight.pass(*hit, -1.0)).collect();
    let pairs = forth.into_iter().zip(back.into_iter().rev());
    pairs
        .flat_map(|(forth, back)| {
            // Each of the two paths is most accurate near the moment it starts from, so interpolate between them.
            let part = (forth.time - before.0) / (after.0 - before.0);
            let location = forth.location.lerp(back.location, part);
            let value = trail_path::between(values, part);
            let point = |velocity| TrailPoint { time: forth.time, location, velocity, frame: None, value };
            [point(forth.velocity), point(back.velocity)]
        })
        .collect()
}

/// The motion of a point of a body under a constant acceleration, forward or backward in time.
#[derive(Clone, Copy)]
struct Flight {
    time: f64,
    location: DVec3,
    velocity: DVec3,
    acceleration: DVec3,
}

impl Flight {
    fn of((time, body): &At, mass: f64, trail: Trail) -> Flight {
        let (location, velocity) = body.point(trail.at);
        let spin = body.angular_velocity;
        let towards_axis = spin.cross(spin.cross(location - body.location));
        Flight { time: *time, location, velocity, acceleration: body.force / mass + towards_axis }
    }

    /// Advances to an impact, and applies its velocity jump with the sign of `sense`. Returns the state just before the jump.
    fn pass(&mut self, (time, jump): (f64, DVec3), sense: f64) -> Flight {
        let span = time - self.time;
        self.location += self.velocity * span + 0.5 * self.acceleration * (span * span);
        self.velocity += self.acceleration * span;
        self.time = time;
        let there = *self;
        self.velocity += sense * jump;
        there
    }
}

//! One contact point of a pile, and its rolling friction: the impulses of a Gauss–Seidel step.

use glam::{DVec2, DVec3};

use super::super::super::contact::ClosestPoints;
use super::super::sweep::stiffest;
use super::Body;

/// A contact point. Vectors of three components stand for the normal and the two tangents.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// The index of the contact in the pile.
    pub(super) contact: usize,
    /// The indices of the two bodies in the pile.
    pub(super) bodies: [u32; 2],
    normal: DVec3,
    tangents: [DVec3; 2],
    /// The vectors from the centers of the bodies to the point, m.
    arms: [DVec3; 2],
    pub(super) gap: f64,
    /// True if the point has been measured at a later moment of the substep, at which its bodies touch or are nearest.
    pub(super) is_foreseen: bool,
    /// The rates before the loads of the substep acted, m/s.
    pub(super) rate_before: DVec3,
    /// The changes of the rates under unit impulses, 1/kg: a symmetric 3 × 3 matrix, its upper triangle row by row.
    response: [f64; 6],
    /// The largest response along any tangent, 1/kg.
    grip: f64,
    /// The coefficient of friction.
    friction: f64,
    /// The rates that the impulses aim at, m/s.
    pub(super) goal: DVec3,
    /// The smallest normal impulse, N s.
    pub(super) least: f64,
}

/// The rolling friction at a contact point. Vectors of two components stand for the two tangents.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roll {
    /// The index of the point in the pile.
    pub(super) point: usize,
    /// The coefficient of rolling friction, m.
    coefficient: f64,
    /// The largest response of the angular rate to a unit moment, 1/(kg m²).
    grip: f64,
    /// The angular rates that the moments aim at, rad/s.
    pub(super) goal: DVec2,
    /// The moment on the second body, N m s.
    pub(super) impulse: DVec2,
}

impl Point {
    pub(super) fn new(contact: usize, bodies: [u32; 2], friction: f64) -> Point {
        Point {
            contact,
            bodies,
            normal: DVec3::ZERO,
            tangents: [DVec3::ZERO; 2],
            arms: [DVec3::ZERO; 2],
            gap: 0.0,
            is_foreseen: false,
            rate_before: DVec3::ZERO,
            response: [0.0; 6],
            grip: 0.0,
            friction,
            goal: DVec3::ZERO,
            least: 0.0,
        }
    }

    /// Sets the geometry of the point. `locations` are those of the centers of the bodies. The tangents turn with the normal by the
    /// shortest way. Which tangents these are is arbitrary: no result depends on them.
    pub(super) fn set(&mut self, meeting: &ClosestPoints, locations: [DVec3; 2]) {
        let (before, normal) = (self.normal, meeting.normal);
        let first = if before == DVec3::ZERO {
            normal.any_orthonormal_vector()
        } else {
            let first = self.tangents[0];
            let first = first - first.dot(normal) / (1.0 + before.dot(normal)) * (before + normal);
            first.reject_from_normalized(normal).normalize()
        };
        self.tangents = [first, normal.cross(first)];
        self.normal = normal;
        // Where a gap closes within the substep, the arms are those at the impact.
        self.arms = [meeting.on[0] - locations[0], meeting.on[1] - locations[1]];
        self.gap = meeting.gap;
    }

    /// Computes the responses of the rates to unit impulses.
    pub(super) fn respond(&mut self, bodies: &[Body]) {
        let [a, b] = [&bodies[self.bodies[0] as usize], &bodies[self.bodies[1] as usize]];
        let mass = a.inverse_mass + b.inverse_mass;
        let mut response = [mass, 0.0, 0.0, mass, 0.0, mass];
        self.add_turning(a, self.arms[0], &mut response);
        self.add_turning(b, self.arms[1], &mut response);
        self.response = response;
        self.grip = stiffest([response[3], response[5]], response[4]);
    }

    /// Adds what the rotation of a body contributes to the responses.
    #[inline(always)]
    fn add_turning(&self, body: &Body, arm: DVec3, response: &mut [f64; 6]) {
        if !body.moves() {
            return;
        }
        let (n, u, w) = (arm.cross(self.normal), arm.cross(self.tangents[0]), arm.cross(self.tangents[1]));
        let inverse = body.inverse_inertia;
        let (by_n, by_u, by_w) = (inverse * n, inverse * u, inverse * w);
        response[0] += n.dot(by_n);
        response[1] += n.dot(by_u);
        response[2] += n.dot(by_w);
        response[3] += u.dot(by_u);
        response[4] += u.dot(by_w);
        response[5] += w.dot(by_w);
    }

    pub(super) fn axes(&self) -> [DVec3; 3] {
        [self.normal, self.tangents[0], self.tangents[1]]
    }

    /// Returns the change of the normal rate under a unit normal impulse, 1/kg.
    pub(super) fn weight(&self) -> f64 {
        self.response[0]
    }

    /// Returns the weights of the three impulses in the norm of their change. Both tangents have the same.
    pub(super) fn weights(&self) -> [f64; 3] {
        let [normal, _, _, along, _, across] = self.response;
        let mean = 0.5 * (along + across);
        [normal, mean, mean]
    }

    /// Returns the coefficient of friction.
    pub(super) fn friction(&self) -> f64 {
        self.friction
    }

    /// Returns the vectors from the centers of the bodies to the point, m.
    pub(super) fn arms(&self) -> [DVec3; 2] {
        self.arms
    }

    /// Returns the components of a vector along the normal and the tangents.
    #[inline(always)]
    pub(super) fn components(&self, vector: DVec3) -> DVec3 {
        DVec3::new(vector.dot(self.normal), vector.dot(self.tangents[0]), vector.dot(self.tangents[1]))
    }

    /// Returns the vector with these components along the normal and the tangents.
    #[inline(always)]
    pub(super) fn vector(&self, components: DVec3) -> DVec3 {
        components.x * self.normal + components.y * self.tangents[0] + components.z * self.tangents[1]
    }

    /// Returns the rates at the present velocities, m/s.
    #[inline(always)]
    pub(super) fn rate(&self, bodies: &[Body]) -> DVec3 {
        let [a, b] = [&bodies[self.bodies[0] as usize], &bodies[self.bodies[1] as usize]];
        let first = a.velocity + a.angular_velocity.cross(self.arms[0]);
        let second = b.velocity + b.angular_velocity.cross(self.arms[1]);
        self.components(second - first)
    }

    /// Returns the rates without the impulses of contacts, m/s.
    pub(super) fn free_rate(&self, bodies: &[Body]) -> DVec3 {
        let [a, b] = [&bodies[self.bodies[0] as usize], &bodies[self.bodies[1] as usize]];
        let first = a.free[0] + a.free[1].cross(self.arms[0]);
        let second = b.free[0] + b.free[1].cross(self.arms[1]);
        self.components(second - first)
    }

    /// Changes the velocities of the bodies by an impulse on the second one.
    #[inline(always)]
    pub(super) fn push(&self, impulse: DVec3, bodies: &mut [Body]) {
        let push = self.vector(impulse);
        let a = &mut bodies[self.bodies[0] as usize];
        if a.moves() {
            a.velocity -= a.inverse_mass * push;
            a.angular_velocity -= a.inverse_inertia * self.arms[0].cross(push);
        }
        let b = &mut bodies[self.bodies[1] as usize];
        if b.moves() {
            b.velocity += b.inverse_mass * push;
            b.angular_velocity += b.inverse_inertia * self.arms[1].cross(push);
        }
    }

    /// Corrects the impulse: the normal rate may not fall below its goal, then friction drives the slip towards its goal, as far as its
    /// bound allows. Returns the largest change of a rate, m/s.
    #[inline(always)]
    pub(super) fn solve(&self, impulse: &mut [f64; 3], bodies: &mut [Body]) -> f64 {
        let [weight, along, across, ..] = self.response;
        if weight <= 0.0 {
            return 0.0;
        }
        let (rate, before) = (self.rate(bodies) - self.goal, DVec3::from_array(*impulse));
        let mut next = before;
        next.x = (before.x - rate.x / weight).max(self.least);
        let normal = next.x - before.x;
        let mut change = normal.abs() * weight;
        let held = DVec2::new(before.y, before.z);
        let most = self.friction * next.x;
        if self.grip > 0.0 && (most > 0.0 || held != DVec2::ZERO) {
            let slip = DVec2::new(rate.y + along * normal, rate.z + across * normal);
            let found = (held - slip / self.grip).clamp_length_max(most);
            (next.y, next.z) = (found.x, found.y);
            change = change.max((found - held).length() * self.grip);
        }
        if next != before {
            *impulse = next.to_array();
            self.push(next - before, bodies);
        }
        change
    }

    /// Corrects the normal impulse alone. Returns the change of the normal rate.
    #[inline(always)]
    pub(super) fn solve_normal(&self, impulse: &mut [f64; 3], bodies: &mut [Body]) -> f64 {
        let weight = self.weight();
        if weight <= 0.0 {
            return 0.0;
        }
        let before = impulse[0];
        impulse[0] = (before - (self.rate(bodies).x - self.goal.x) / weight).max(0.0);
        let change = impulse[0] - before;
        if change != 0.0 {
            self.push(DVec3::new(change, 0.0, 0.0), bodies);
        }
        change.abs() * weight
    }
}

impl Roll {
    pub(super) fn new(point: usize, coefficient: f64) -> Roll {
        Roll { point, coefficient, grip: 0.0, goal: DVec2::ZERO, impulse: DVec2::ZERO }
    }

    /// Returns the coefficient of rolling friction, m.
    pub(super) fn coefficient(&self) -> f64 {
        self.coefficient
    }

    /// Returns the weight of the moments in the norm of their change.
    pub(super) fn weight(&self) -> f64 {
        self.grip
    }

    /// Computes the largest response of the angular rate to a unit moment about any tangent.
    pub(super) fn respond(&mut self, point: &Point, bodies: &[Body]) {
        let [a, b] = point.bodies.map(|body| bodies[body as usize].inverse_inertia);
        let (both, [_, u, w]) = (a + b, point.axes());
        self.grip = stiffest([u.dot(both * u), w.dot(both * w)], u.dot(both * w));
    }

    /// Returns the angular rates about the tangents, from the angular velocities of the bodies that `of` returns.
    pub(super) fn rate(&self, point: &Point, bodies: &[Body], of: impl Fn(&Body) -> DVec3) -> DVec2 {
        let [a, b] = point.bodies.map(|body| of(&bodies[body as usize]));
        let [_, u, w] = point.axes();
        DVec2::new((b - a).dot(u), (b - a).dot(w))
    }

    /// Changes the angular velocities of the bodies by a moment on the second one.
    pub(super) fn push(&self, impulse: DVec2, point: &Point, bodies: &mut [Body]) {
        let moment = self.moment(impulse, point);
        for (side, moment) in [-moment, moment].into_iter().enumerate() {
            let body = &mut bodies[point.bodies[side] as usize];
            body.angular_velocity += body.inverse_inertia * moment;
        }
    }

    /// Returns the vector of a moment with these components along the tangents.
    pub(super) fn moment(&self, impulse: DVec2, point: &Point) -> DVec3 {
        let [_, u, w] = point.axes();
        impulse.x * u + impulse.y * w
    }

    /// Corrects the moment: it drives the angular rate towards its goal, as far as its bound allows. `normal` is the normal impulse of the
    /// point, N s. Returns the change of the angular rate,
    /// rad/s.
    pub(super) fn solve(&mut self, point: &Point, normal: f64, bodies: &mut [Body]) -> f64 {
        let (before, most) = (self.impulse, self.coefficient * normal);
        if self.grip <= 0.0 || most == 0.0 && before == DVec2::ZERO {
            return 0.0;
        }
        let rate = self.rate(point, bodies, |body| body.angular_velocity) - self.goal;
        self.impulse = (before - rate / self.grip).clamp_length_max(most);
        self.push(self.impulse - before, point, bodies);
        (self.impulse - before).length() * self.grip
    }
}

//! Dense output: the state at any time within a step, without additional steps.
//!
//! Each method has its own dense output. So the interpolated motion is as accurate as the steps, and the steps never depend on the times at
//! which frames of the animation are taken. Velocities are the derivatives of positions.

use glam::{DQuat, DVec3};

use super::super::{Accounts, Loads, Model, State, System};
use super::{rotation, splitting};

/// A completed step of an integration method.
#[derive(Clone, Copy)]
pub struct Step<'a> {
    /// The masses of the bodies and the forces on them.
    pub model: &'a Model,
    /// The time at the start of the step, s.
    pub start: f64,
    /// The duration of the step, s.
    pub duration: f64,
    /// The state of the bodies at the start of the step.
    pub before: &'a State,
    /// The state of the bodies at the end of the step.
    pub after: &'a State,
}

/// The interpolated motion of all bodies within a step.
pub trait DenseOutput {
    /// Sets `state` to the interpolated state at time `t` (s) within the step. Bodies with a given motion are placed exactly.
    fn at(&self, t: f64, state: &mut State);
}

impl Step<'_> {
    /// Returns the fraction of the step that has passed at time `t` (s), from 0 to 1.
    fn part(&self, t: f64) -> f64 {
        ((t - self.start) / self.duration).clamp(0.0, 1.0)
    }

    fn accounts(&self, s: f64) -> Accounts {
        let (before, after) = (self.before.accounts.to_array(), self.after.accounts.to_array());
        Accounts::from_array(std::array::from_fn(|i| before[i] + s * (after[i] - before[i])))
    }
}

/// Interpolation for Euler–Cromer and similar methods: forces change the velocities at the start of a step, and bodies then move freely.
pub(super) struct Drift<'a>(pub(super) Step<'a>);

impl DenseOutput for Drift<'_> {
    fn at(&self, t: f64, state: &mut State) {
        let Drift(step) = self;
        let s = step.part(t);
        state.clone_from(step.before);
        state.velocity.clone_from(&step.after.velocity);
        state.angular_momentum.clone_from(&step.after.angular_momentum);
        splitting::drift(step.model, s * step.duration, state);
        state.accounts = step.accounts(s);
        step.model.place(t, state);
    }
}

/// Interpolation for explicit Euler: bodies follow the tangent at the start of the step.
pub(super) struct Tangent<'a>(pub(super) Step<'a>);

impl DenseOutput for Tangent<'_> {
    fn at(&self, t: f64, state: &mut State) {
        let Tangent(step) = self;
        let s = step.part(t);
        let Step { before, after, .. } = step;
        state.clone_from(before);
        for i in 0..state.len() {
            state.location[i] = before.location[i].lerp(after.location[i], s);
            state.velocity[i] = before.velocity[i].lerp(after.velocity[i], s);
            state.angular_momentum[i] = before.angular_momentum[i].lerp(after.angular_momentum[i], s);
            let omega = step.model.angular_velocity(i, before);
            if omega != DVec3::ZERO {
                let rate = rotation::rate(before.orientation[i], omega);
                state.orientation[i] = (before.orientation[i] + rate * (s * step.duration)).normalize();
            }
        }
        state.accounts = step.accounts(s);
        step.model.place(t, state);
    }
}

/// Interpolation by quintic Hermite polynomials through positions, velocities and accelerations at both ends of a step. The error is O(h⁶)
/// in the position and O(h⁵) in the velocity. An orientation is exp(θ) q₀, where the rotation vector θ is also a quintic polynomial.
/// Angular momenta and accounts are cubic polynomials through values and slopes. Source: Hairer, Nørsett & Wanner, *Solving Ordinary
/// Differential Equations I*, II.6; the derivatives of θ: Iserles et al., *Lie-group methods*, Acta Numerica 9 (2000) 215, section B.
pub(super) struct Hermite<'a> {
    step: Step<'a>,
    start: Loads,
    end: Loads,
    /// For each body, the data of its rotation vector θ; `None` for a body that does not rotate.
    turns: Vec<Option<Turn>>,
}

/// The rotation vector θ of a body within a step: its derivatives θ' and θ'' at the start, and θ, θ' and θ'' at the end. At the start, θ
/// is 0.
#[derive(Clone, Copy)]
struct Turn {
    rate: DVec3,
    curvature: DVec3,
    end: DVec3,
    end_rate: DVec3,
    end_curvature: DVec3,
}

impl<'a> Hermite<'a> {
    /// Computes the polynomials of a step. Evaluates the forces at both ends of the step.
    pub(super) fn new(system: &mut System<'_>, step: Step<'a>) -> Hermite<'a> {
        let (mut start, mut end) = (Loads::default(), Loads::default());
        system.evaluate(step.start, step.before, &mut start);
        system.evaluate(step.start + step.duration, step.after, &mut end);
        let turn = |i: usize| turn(&step, i, start.torque[i], end.torque[i]);
        let turns = (0..step.before.len()).map(turn).collect();
        Hermite { step, start, end, turns }
    }
}

/// Returns the rotation vector of body `i` within a step; `None` if the body does not rotate.
fn turn(step: &Step<'_>, i: usize, torque: DVec3, end_torque: DVec3) -> Option<Turn> {
    let (before, after) = (step.before, step.after);
    if before.angular_momentum[i] == DVec3::ZERO && before.orientation[i] == after.orientation[i] {
        return None;
    }
    // The angular acceleration is ω' = I⁻¹ (τ − ω × L), in world axes.
    let acceleration = |state: &State, torque: DVec3| {
        let omega = step.model.angular_velocity(i, state);
        let inverse = step.model.inverse_inertia()[i];
        let world_from_body = state.orientation[i];
        let net = torque - omega.cross(state.angular_momentum[i]);
        (omega, world_from_body * (inverse * (world_from_body.conjugate() * net)))
    };
    let (rate, curvature) = acceleration(before, torque);
    let (omega, alpha) = acceleration(after, end_torque);
    let turned = after.orientation[i] * before.orientation[i].conjugate();
    let turned = if turned.w < 0.0 { -turned } else { turned };
    let end = turned.to_scaled_axis();
    // The derivative of θ is θ' = ω − ½ θ×ω + c θ×(θ×ω), by the inverse of the left Jacobian of the exponential map. The coefficient c
    // depends on u = θ².
    let u = end.length_squared();
    let (c, slope) = coefficients(u);
    let crossed = end.cross(omega);
    let end_rate = omega - 0.5 * crossed + c * end.cross(crossed);
    let c_rate = slope * 2.0 * end.dot(end_rate);
    let crossed_alpha = end.cross(alpha);
    let end_curvature = alpha - 0.5 * crossed_alpha + c * end.cross(crossed_alpha)
        - 0.5 * end_rate.cross(omega)
        + c * (end_rate.cross(crossed) + end.cross(end_rate.cross(omega)))
        + c_rate * end.cross(crossed);
    Some(Turn { rate, curvature, end, end_rate, end_curvature })
}

/// Returns c(u) = 1/u − (1 + cos φ) / (2 φ sin φ) with u = φ², and its derivative by u. For small u, the terms cancel, so a series is
/// used.
fn coefficients(u: f64) -> (f64, f64) {
    let series = |u: f64| 1.0 / 12.0 + u * (1.0 / 720.0 + u * (1.0 / 30_240.0 + u / 1_209_600.0));
    let slope = |u: f64| 1.0 / 720.0 + u * (2.0 / 30_240.0 + u * (3.0 / 1_209_600.0));
    if u < 0.1 {
        return (series(u), slope(u));
    }
    let phi = u.sqrt();
    let (sin, cos) = libm::sincos(phi);
    let c = 1.0 / u - (1.0 + cos) / (2.0 * phi * sin);
    // The subtracted term of c is cot(φ/2) / 2φ. The derivative of c by φ is converted to a derivative by u.
    let half = libm::sin(0.5 * phi);
    let cot = libm::cos(0.5 * phi) / half;
    let by_phi = -2.0 / (u * phi) + 0.25 / (phi * half * half) + cot / (2.0 * u);
    (c, by_phi / (2.0 * phi))
}

impl DenseOutput for Hermite<'_> {
    fn at(&self, t: f64, state: &mut State) {
        let Hermite { step, start, end, turns } = self;
        let Step { model, duration: h, before, after, .. } = *step;
        let s = step.part(t);
        let place = quintic(s);
        let rate = quintic_rate(s);
        let cubic = cubic(s);
        state.clone_from(before);
        for (i, turn) in turns.iter().enumerate() {
            let inverse_mass = model.inverse_mass()[i];
            let (a, b) = (start.force[i] * inverse_mass, end.force[i] * inverse_mass);
            let terms = [
                before.location[i],
                before.velocity[i] * h,
                a * (h * h),
                after.location[i],
                after.velocity[i] * h,
                b * (h * h),
            ];
            // The displacement is relative to the start, so that a body at rest keeps its position to the last bit.
            let moved = terms[3] - terms[0];
            state.location[i] = terms[0]
                + (place[1] * terms[1] + place[2] * terms[2] + place[3] * moved)
                + (place[4] * terms[4] + place[5] * terms[5]);
            state.velocity[i] = (rate[1] * terms[1]
                + rate[2] * terms[2]
                + rate[3] * moved
                + rate[4] * terms[4]
                + rate[5] * terms[5])
                / h;
            let gained = after.angular_momentum[i] - before.angular_momentum[i];
            state.angular_momentum[i] = before.angular_momentum[i]
                + cubic[1] * h * start.torque[i]
                + cubic[2] * gained
                + cubic[3] * h * end.torque[i];
            if let Some(turn) = turn {
                let theta = place[1] * h * turn.rate
                    + place[2] * h * h * turn.curvature
                    + place[3] * turn.end
                    + place[4] * h * turn.end_rate
                    + place[5] * h * h * turn.end_curvature;
                state.orientation[i] = (DQuat::from_scaled_axis(theta) * before.orientation[i]).normalize();
            }
        }
        let (first, last) = (before.accounts.to_array(), after.accounts.to_array());
        let (power, end_power) = (start.power.to_array(), end.power.to_array());
        state.accounts = Accounts::from_array(std::array::from_fn(|i| {
            first[i] + cubic[1] * h * power[i] + cubic[2] * (last[i] - first[i]) + cubic[3] * h * end_power[i]
        }));
        model.place(t, state);
    }
}

/// Returns the quintic Hermite polynomials at `s`: those of the value, the slope and the curvature at 0, then those at 1.
fn quintic(s: f64) -> [f64; 6] {
    let (s2, s3) = (s * s, s * s * s);
    let end = s3 * (10.0 + s * (-15.0 + 6.0 * s));
    [
        1.0 - end,
        s + s3 * (-6.0 + s * (8.0 - 3.0 * s)),
        0.5 * s2 + s3 * (-1.5 + s * (1.5 - 0.5 * s)),
        end,
        s3 * (-4.0 + s * (7.0 - 3.0 * s)),
        s3 * (0.5 + s * (-1.0 + 0.5 * s)),
    ]
}

/// Returns the derivatives of the quintic Hermite polynomials at `s`.
fn quintic_rate(s: f64) -> [f64; 6] {
    let s2 = s * s;
    let end = s2 * (30.0 + s * (-60.0 + 30.0 * s));
    [
        -end,
        1.0 + s2 * (-18.0 + s * (32.0 - 15.0 * s)),
        s + s2 * (-4.5 + s * (6.0 - 2.5 * s)),
        end,
        s2 * (-12.0 + s * (28.0 - 15.0 * s)),
        s2 * (1.5 + s * (-4.0 + 2.5 * s)),
    ]
}

/// Returns the cubic Hermite polynomials at `s`: those of the value and the slope at 0, then those at 1.
fn cubic(s: f64) -> [f64; 4] {
    let (s2, s3) = (s * s, s * s * s);
    let end = 3.0 * s2 - 2.0 * s3;
    [1.0 - end, s - 2.0 * s2 + s3, end, s3 - s2]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The coefficient c must equal its definition, and its derivative a difference quotient over 2e-4, which has an error of 1e-8.
    #[test]
    fn the_two_ways_to_compute_the_coefficient_agree() {
        for u in [0.0999, 0.1001, 1.0, 4.0] {
            let (c, slope) = coefficients(u);
            let phi = f64::sqrt(u);
            let by_half = 1.0 / u - 1.0 / (2.0 * phi * libm::tan(0.5 * phi));
            assert!((c - by_half).abs() < 1e-10, "{u}: {c} {by_half}");
            let (left, right) = (coefficients(u - 1e-4).0, coefficients(u + 1e-4).0);
            assert!(((right - left) / 2e-4 - slope).abs() < 1e-6, "{u}: {slope}");
        }
    }
}

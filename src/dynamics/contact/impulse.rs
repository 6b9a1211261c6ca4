//! The impulses of one impact between two bodies: Newton's restitution and Coulomb's friction at all contact points.
//!
//! With W = J M⁻¹ Jᵀ, where J is the Jacobian of the contact points along their normals and tangents, the velocities after the impact are
//! u⁺ = u⁻ + W Λ. Where Λₙ > 0, uₙ⁺ = −e uₙ⁻. The friction impulse Λₜ opposes the remaining slip, with |Λₜ| ≤ μ Λₙ. Sources: F. Pfeiffer &
//! C. Glocker, *Multibody Dynamics with Unilateral Contacts* (1996), chapter 8; for the sweeps, J. J. Moreau, *Unilateral contact and dry
//! friction in finite freedom dynamics* (1988), section 13.

use glam::{DVec2, DVec3};

/// The largest number of sweeps for the impulses at coupled contact points.
const SWEEPS: usize = 2_000;

/// The sweeps end when they change impulses by less than this fraction of the largest impulse.
const SETTLED: f64 = 1e-14;

/// The restitution and the friction at one contact point of an impact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounce {
    /// The coefficient of restitution at the contact point.
    pub(super) restitution: f64,
    /// Coulomb's coefficient of friction at the contact point.
    pub(super) friction: f64,
}

/// Computes the impulses between two bodies: for each contact point, the components along its normal and its two tangents, N s. `rates`
/// holds u⁻ of each point, and `response` holds W, row by row.
pub(super) fn impulses(bounces: &[Bounce], rates: &[DVec3], response: &[f64]) -> Vec<DVec3> {
    let goals: Vec<f64> = bounces.iter().zip(rates).map(|(bounce, rate)| goal(bounce, rate.x)).collect();
    if let ([bounce], [rate], [goal]) = (bounces, rates, &goals[..]) {
        return vec![single(bounce, *rate, *goal, response)];
    }
    let n = 3 * rates.len();
    let entry = |row: usize, column: usize| response[row * n + column];
    let mut impulses = vec![DVec3::ZERO; rates.len()];
    for _ in 0..SWEEPS {
        let (mut change, mut size) = (0.0_f64, 0.0_f64);
        for place in 0..rates.len() {
            let rate = |axis: usize, impulses: &[DVec3]| {
                let row = 3 * place + axis;
                let pushed = (0..n).map(|column| entry(row, column) * impulses[column / 3][column % 3]);
                rates[place][axis] + pushed.sum::<f64>()
            };
            let before = impulses[place];
            let first = 3 * place;
            let normal = before.x - (rate(0, &impulses) - goals[place]) / entry(first, first);
            impulses[place].x = normal.max(0.0);
            let stiff = entry(first + 1, first + 1) + entry(first + 2, first + 2);
            let slip = DVec2::new(rate(1, &impulses), rate(2, &impulses));
            let tangent = DVec2::new(before.y, before.z) - slip / stiff;
            let tangent = tangent.clamp_length_max(bounces[place].friction * impulses[place].x);
            (impulses[place].y, impulses[place].z) = (tangent.x, tangent.y);
            change = change.max((impulses[place] - before).abs().max_element());
            size = size.max(impulses[place].abs().max_element());
        }
        if change <= SETTLED * size {
            break;
        }
    }
    impulses
}

/// Returns the normal velocity after the impact. It is negative for a point that separates before the impact but is pushed by other
/// points. Otherwise the impact would add energy.
fn goal(bounce: &Bounce, rate: f64) -> f64 {
    -bounce.restitution * rate
}

/// Computes the impulse of an impact at a single contact point.
fn single(bounce: &Bounce, rate: DVec3, goal: f64, response: &[f64]) -> DVec3 {
    let w = glam::DMat3::from_cols_slice(response.get(..9).unwrap_or(&[0.0; 9]));
    let needed = goal - rate.x;
    if bounce.friction == 0.0 {
        return DVec3::new(needed / w.x_axis.x, 0.0, 0.0);
    }
    let stick = w.inverse() * DVec3::new(needed, -rate.y, -rate.z);
    if stick.x >= 0.0 && stick.yz().length() <= bounce.friction * stick.x {
        return stick;
    }
    // The point slides: the impulse is along (1, −μ d), where d is the direction of the remaining slip.
    let slip = DVec2::new(rate.y, rate.z);
    let mut direction = if slip == DVec2::ZERO { -stick.yz() } else { slip }.normalize_or_zero();
    let mut impulse = DVec3::new(needed / w.x_axis.x, 0.0, 0.0);
    for _ in 0..100 {
        let along = DVec3::new(1.0, -bounce.friction * direction.x, -bounce.friction * direction.y);
        let pushed = w * along;
        if pushed.x <= 0.0 {
            break;
        }
        impulse = needed / pushed.x * along;
        let left = (rate + w * impulse).yz();
        // If the slip would reverse its direction, the point sticks, and the direction before the impact counts.
        if left.dot(direction) <= 0.0 {
            break;
        }
        let next = left.normalize();
        if (next - direction).length() < 1e-15 {
            break;
        }
        direction = next;
    }
    impulse
}

/// Access to the tangential components (y and z) of a contact vector.
trait Tangential {
    fn yz(self) -> DVec2;
}

impl Tangential for DVec3 {
    fn yz(self) -> DVec2 {
        DVec2::new(self.y, self.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// W of a solid ball of mass 1 kg and radius 1 m: diagonal, 1 along the normal and 7/2 along the tangents.
    const BALL: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 3.5, 0.0, 0.0, 0.0, 3.5];

    #[test]
    fn a_ball_bounces_and_sticks_or_slides() {
        let bounce = |friction: f64| Bounce { restitution: 0.5, friction };
        let rate = DVec3::new(-2.0, 0.7, 0.0);
        let stick = impulses(&[bounce(1.0)], &[rate], &BALL)[0];
        assert!((stick - DVec3::new(3.0, -0.2, 0.0)).length() < 1e-15, "{stick}");
        let slide = impulses(&[bounce(0.05)], &[rate], &BALL)[0];
        assert!((slide - DVec3::new(3.0, -0.15, 0.0)).length() < 1e-15, "{slide}");
        assert_eq!(impulses(&[bounce(0.0)], &[rate], &BALL)[0], DVec3::new(3.0, 0.0, 0.0));
    }

    /// A unit square plate falls flat on the ground. It can move along its normal and tilt about two axes, so its four corners give more
    /// equations than unknowns. Each corner gets a quarter of the impulse.
    #[test]
    fn places_that_imply_each_other_share_the_impulse() {
        let corners = [(0.5, 0.5), (0.5, -0.5), (-0.5, 0.5), (-0.5, -0.5)];
        let mut response = vec![0.0; 144];
        for (i, a) in corners.iter().enumerate() {
            for (j, b) in corners.iter().enumerate() {
                response[3 * i * 12 + 3 * j] = 1.0 + 6.0 * (a.0 * b.0 + a.1 * b.1);
            }
            for axis in 1..3 {
                response[(3 * i + axis) * 12 + 3 * i + axis] = 1.0;
            }
        }
        let bounces = [Bounce { restitution: 0.5, friction: 0.0 }; 4];
        let all = impulses(&bounces, &[DVec3::new(-1.0, 0.0, 0.0); 4], &response);
        for impulse in all {
            assert!((impulse.x - 0.375).abs() < 1e-12, "{impulse}");
        }
    }
}

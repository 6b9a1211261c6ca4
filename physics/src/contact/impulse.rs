//! The impulses of one impact between two bodies: Newton's restitution and Coulomb's friction at all contact points.
//!
//! With W = J M⁻¹ Jᵀ, where J is the Jacobian of the contact points along their normals and tangents, the velocities after the impact are
//! u⁺ = u⁻ + W Λ. Where Λₙ > 0, uₙ⁺ = −e uₙ⁻. The friction impulse Λₜ opposes the remaining slip, with |Λₜ| ≤ μ Λₙ. Sources: F. Pfeiffer &
//! C. Glocker, *Multibody Dynamics with Unilateral Contacts* (1996), chapter 8; for the sweeps, J. J. Moreau, *Unilateral contact and dry
//! friction in finite freedom dynamics* (1988), section 13.
//!
//! Several points with friction can share an impulse in many ways. A sweep changes all points at the same time, so the way that is found
//! does not depend on their order.

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3, DVec4};

use super::super::constraint::Anderson;

/// The largest number of sweeps for the impulses at coupled contact points.
const MAX_SWEEPS: usize = 2_000;

/// The largest number of sweeps whose results are extrapolated. Extrapolations rarely go round in a circle, and then plain sweeps converge.
const EXTRAPOLATED_SWEEPS: usize = 500;

/// The sweeps end when they change impulses by less than this fraction of the largest impulse.
const SWEEP_TOLERANCE: f64 = 1e-14;

/// The number of directions of slip among which the search for the slip after an impact begins.
const SLIP_DIRECTIONS: u32 = 32;

/// This many halvings of an angle between two directions lead to its rounding error.
const ANGLE_HALVINGS: u32 = 52;

/// The diagonal of W is enlarged by this fraction of its trace, so that W has an inverse.
const ENLARGED_DIAGONAL: f64 = 1e-12;

/// The number of iterative refinements that remove the error of the enlarged diagonal.
const ITERATIVE_REFINEMENTS: u32 = 3;

/// A solution solves its equations if its error is at most this fraction of the right-hand side.
const SOLUTION_TOLERANCE: f64 = 1e-6;

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
    let shares = Shares::of(rates.len(), response);
    let mut impulses = vec![DVec3::ZERO; rates.len()];
    let mut anderson = Anderson::from(&vec![0.0; 3 * rates.len()], &shares.weights());
    for sweep in 1..=MAX_SWEEPS {
        let before = impulses.clone();
        let (mut change, mut size) = (0.0_f64, 0.0_f64);
        for (place, impulse) in impulses.iter_mut().enumerate() {
            let now = rates[place] + changed(response, &before, place);
            let normal = (impulse.x - (now.x - goals[place]) / shares.normal[place]).max(0.0);
            let tangent = impulse.yz() - now.yz() / shares.tangent[place];
            let tangent = tangent.clamp_length_max(bounces[place].friction * normal);
            *impulse = DVec3::new(normal, tangent.x, tangent.y);
            change = change.max((*impulse - before[place]).length());
            size = size.max(impulse.length());
        }
        if change <= SWEEP_TOLERANCE * size {
            break;
        }
        // An extrapolation may break the laws. The next sweep restores them.
        if sweep > EXTRAPOLATED_SWEEPS {
            continue;
        }
        let found: Vec<f64> = impulses.iter().flat_map(DVec3::to_array).collect();
        for (impulse, further) in impulses.iter_mut().zip(anderson.go_further(&found).as_chunks::<3>().0) {
            *impulse += DVec3::from_array(*further);
        }
    }
    impulses
}

/// Returns the change of the velocities of a contact point by the impulses at all points.
pub(super) fn changed(response: &[f64], impulses: &[DVec3], place: usize) -> DVec3 {
    let n = 3 * impulses.len();
    let row = |axis: usize| {
        let entries = response[(3 * place + axis) * n..].as_chunks::<3>().0;
        entries.iter().zip(impulses).map(|(entry, impulse)| DVec3::from_array(*entry).dot(*impulse)).sum()
    };
    DVec3::new(row(0), row(1), row(2))
}

/// The responses by which the points divide their rates in a sweep: for each point, the sums of the norms of its couplings with all points.
/// With these, points that change their impulses at the same time never do too much together: the matrix of the sums, less W, has no
/// negative eigenvalue. A norm does not depend on the directions of the tangents.
struct Shares {
    /// The response along the normal and along the tangents of each point, 1/kg.
    normal: Vec<f64>,
    tangent: Vec<f64>,
}

impl Shares {
    fn of(places: usize, response: &[f64]) -> Shares {
        let entry = |row: usize, column: usize| response[row * 3 * places + column];
        let sum = |place: usize, of: &dyn Fn([usize; 3], [usize; 3]) -> f64| {
            let axes = |place: usize| [3 * place, 3 * place + 1, 3 * place + 2];
            (0..places).map(|other| of(axes(place), axes(other))).sum::<f64>()
        };
        let normal = |[n, ..]: [usize; 3], [m, u, w]: [usize; 3]| {
            entry(n, m).abs() + DVec2::new(entry(n, u), entry(n, w)).length()
        };
        let tangent = |[_, s, t]: [usize; 3], [m, u, w]: [usize; 3]| {
            let block = DVec4::new(entry(s, u), entry(s, w), entry(t, u), entry(t, w));
            DVec2::new(entry(s, m), entry(t, m)).length() + block.length()
        };
        Shares {
            normal: (0..places).map(|place| sum(place, &normal)).collect(),
            tangent: (0..places).map(|place| sum(place, &tangent)).collect(),
        }
    }

    /// Returns the weight of each component of the impulses.
    fn weights(&self) -> Vec<f64> {
        self.normal
            .iter()
            .zip(&self.tangent)
            .flat_map(|(normal, tangent)| [*normal, *tangent, *tangent])
            .collect()
    }
}

/// Returns the normal velocity after the impact. It is negative for a point that separates before the impact but is pushed by other
/// points. Otherwise the impact would add energy.
fn goal(bounce: &Bounce, rate: f64) -> f64 {
    -bounce.restitution * rate
}

/// Computes the impulse of an impact at a single contact point.
fn single(bounce: &Bounce, rate: DVec3, goal: f64, response: &[f64]) -> DVec3 {
    let w = DMat3::from_cols_slice(response.get(..9).unwrap_or(&[0.0; 9]));
    let needed = goal - rate.x;
    let normal = DVec3::new(needed / w.x_axis.x, 0.0, 0.0);
    if bounce.friction == 0.0 {
        return normal;
    }
    let stopped = DVec3::new(needed, -rate.y, -rate.z);
    let stick = solution(w, stopped);
    // Joints may make it impossible to rebound and to stick.
    let is_solved = (w * stick - stopped).length() <= SOLUTION_TOLERANCE * stopped.length();
    if is_solved && stick.x >= 0.0 && stick.yz().length() <= bounce.friction * stick.x {
        return stick;
    }
    // The point slides. If no slip is consistent, it sticks, and the slip before the impact gives the direction of the friction.
    let slip = rate.yz();
    let slip = if slip == DVec2::ZERO { -stick.yz() } else { slip }.normalize_or_zero();
    let sliding = Sliding { friction: bounce.friction, rate, needed, w };
    sliding.find(slip).or_else(|| sliding.impulse(slip)).unwrap_or(normal)
}

/// Solves W x = b. Where joints block a motion, W has no inverse. The solution with the smallest impulse then counts.
fn solution(w: DMat3, b: DVec3) -> DVec3 {
    let inverse =
        (w + DMat3::from_diagonal(DVec3::splat(ENLARGED_DIAGONAL * (w.x_axis.x + w.y_axis.y + w.z_axis.z))))
            .inverse();
    // Iterative refinement removes the error of the enlarged diagonal.
    (0..ITERATIVE_REFINEMENTS).fold(inverse * b, |x, _| x + inverse * (b - w * x))
}

/// The search for the impulse at a single contact point that slides: it is along (1, −μ d), where d is the direction of the remaining slip.
struct Sliding {
    friction: f64,
    rate: DVec3,
    /// The change of the normal velocity, m/s.
    needed: f64,
    w: DMat3,
}

impl Sliding {
    /// Returns the impulse whose friction opposes the unit vector `direction`. `None` if friction would need an infinite normal impulse.
    fn impulse(&self, direction: DVec2) -> Option<DVec3> {
        let along = DVec3::new(1.0, -self.friction * direction.x, -self.friction * direction.y);
        let pushed = self.w * along;
        (pushed.x > 0.0).then(|| self.needed / pushed.x * along)
    }

    /// Returns the impulse after which the slip has the direction that the friction opposes. Of several, the one whose direction is
    /// nearest to `first` counts. `None` if there is none.
    ///
    /// The angle of the direction is found by bisection. To take the remaining slip as the next direction, again and again, would diverge
    /// where friction nearly stops the slip.
    fn find(&self, first: DVec2) -> Option<DVec3> {
        let direction = |angle: f64| first.rotate(DVec2::new(libm::cos(angle), libm::sin(angle)));
        let left = |angle: f64| Some((self.rate + self.w * self.impulse(direction(angle))?).yz());
        // The part of the remaining slip across the direction.
        let across = |angle: f64| Some(direction(angle).perp_dot(left(angle)?));
        let part = TAU / f64::from(SLIP_DIRECTIONS);
        // The intervals are tried in the order of their distance from `first`, which is in the middle of the first one.
        for i in 0..SLIP_DIRECTIONS {
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let middle = side * part * f64::from(i.div_ceil(2));
            let (mut low, mut high) = (middle - 0.5 * part, middle + 0.5 * part);
            let (Some(below), Some(above)) = (across(low), across(high)) else { continue };
            if below * above > 0.0 {
                continue;
            }
            for _ in 0..ANGLE_HALVINGS {
                let middle = 0.5 * (low + high);
                match across(middle) {
                    Some(0.0) => (low, high) = (middle, middle),
                    Some(across) if across * below > 0.0 => low = middle,
                    Some(_) => high = middle,
                    None => break,
                }
            }
            let angle = 0.5 * (low + high);
            if left(angle).is_some_and(|left| left.dot(direction(angle)) >= 0.0) {
                return self.impulse(direction(angle));
            }
        }
        None
    }
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

    /// Friction nearly stops a ball that slides in any direction: it opposes the slip exactly, with μ times the normal impulse, and leaves
    /// 0.6 − 3.5 · 0.15 = 0.075 m/s.
    #[test]
    fn friction_that_nearly_stops_the_slip_opposes_it() {
        for i in 0..360 {
            let (sin, cos) = libm::sincos(0.017 * f64::from(i));
            let slip = DVec2::new(cos, sin);
            let rate = DVec3::new(-2.0, 0.6 * slip.x, 0.6 * slip.y);
            let bounce = Bounce { restitution: 0.5, friction: 0.05 };
            let found = impulses(&[bounce], &[rate], &BALL)[0];
            let expected = DVec3::new(3.0, -0.15 * slip.x, -0.15 * slip.y);
            assert!((found - expected).length() < 1e-14, "{i}: {found} instead of {expected}");
        }
    }

    /// A body can move along one direction only, because joints hold it. Its impact does not depend on the directions of the tangents.
    #[test]
    fn a_body_that_joints_guide_hits_alike_with_any_tangents() {
        let way = DVec3::new(0.8, 0.6, 0.0);
        let first = guided(way, 0.0);
        for i in 0..100 {
            let found = guided(way, 0.063 * f64::from(i));
            assert!((found - first).length() < 1e-9, "{i}: {found} instead of {first}");
        }
    }

    /// The impulse on a body of 1 kg that can move along `way` only, with tangents that are turned by an angle, rad. Returned in the axes of
    /// the tangents at the angle 0.
    fn guided(way: DVec3, angle: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(angle);
        let turn = |v: DVec3| DVec3::new(v.x, cos * v.y + sin * v.z, cos * v.z - sin * v.y);
        let back = |v: DVec3| DVec3::new(v.x, cos * v.y - sin * v.z, cos * v.z + sin * v.y);
        let along = turn(way).to_array();
        let response: Vec<f64> = (0..9).map(|i| along[i / 3] * along[i % 3]).collect();
        let bounce = Bounce { restitution: 0.5, friction: 0.5 };
        back(impulses(&[bounce], &[-2.0 * turn(way)], &response)[0])
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

    /// A box lands on an edge and sticks. Friction along the edge can be shared by its two ends in many
    /// ways. The shares do not depend on the order of the ends.
    #[test]
    fn the_order_of_places_does_not_matter() {
        let arms = [DVec3::new(0.3, -0.2, 0.5), DVec3::new(0.3, -0.2, -0.4)];
        let axes = [DVec3::Y, DVec3::X, DVec3::Z];
        let inverse_inertia = DVec3::new(9.0, 4.0, 13.0);
        let rate = |arm: DVec3| {
            let velocity = DVec3::new(0.3, -1.0, 0.2) + DVec3::new(0.4, 1.3, -0.2).cross(arm);
            DVec3::from_array(axes.map(|axis| axis.dot(velocity)))
        };
        let found = |arms: [DVec3; 2]| {
            let mut response = Vec::new();
            for (arm, axis) in arms.iter().flat_map(|arm| axes.map(|axis| (*arm, axis))) {
                for (other, along) in arms.iter().flat_map(|arm| axes.map(|axis| (*arm, axis))) {
                    let turned = (inverse_inertia * other.cross(along)).cross(arm);
                    response.push(axis.dot(along + turned));
                }
            }
            impulses(&[Bounce { restitution: 0.3, friction: 3.0 }; 2], &arms.map(rate), &response)
        };
        let (one, other) = (found(arms), found([arms[1], arms[0]]));
        assert!(
            (one[0] - other[1]).length() < 1e-13 && (one[1] - other[0]).length() < 1e-13,
            "{one:?} {other:?}"
        );
        assert!(one[0].x > 0.1 && one[1].x > 0.1, "{one:?}");
    }

    /// Boxes of all proportions land on two to four corners. The impulses obey the laws: corners push only, a corner that pushes reaches its
    /// goal, and friction lies within its bound.
    #[test]
    fn impulses_at_several_places_obey_the_laws() {
        let mut state = 1_u64;
        let mut number = |low: f64, high: f64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let axes = [DVec3::Y, DVec3::X, DVec3::Z];
        for case in 0..500 {
            let half = DVec3::new(number(0.1, 1.0), number(0.1, 1.0), number(0.1, 1.0));
            let inverse_inertia = 3.0 / (half.length_squared() - half * half);
            let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
            let arms: Vec<DVec3> =
                signs[..2 + case % 3].iter().map(|(x, z)| half * DVec3::new(*x, -1.0, *z)).collect();
            let velocity = DVec3::new(number(-1.0, 1.0), -1.0, number(-1.0, 1.0));
            let spin = DVec3::new(number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0));
            let rates: Vec<DVec3> = arms
                .iter()
                .map(|arm| DVec3::from_array(axes.map(|axis| axis.dot(velocity + spin.cross(*arm)))))
                .collect();
            let pushes: Vec<(DVec3, DVec3)> =
                arms.iter().flat_map(|arm| axes.map(|axis| (*arm, axis))).collect();
            let entry = |(arm, axis): &(DVec3, DVec3), (other, along): &(DVec3, DVec3)| {
                axis.dot(*along + (inverse_inertia * other.cross(*along)).cross(*arm))
            };
            let response: Vec<f64> =
                pushes.iter().flat_map(|row| pushes.iter().map(move |column| entry(row, column))).collect();
            let bounce = Bounce { restitution: number(0.0, 1.0), friction: number(0.0, 1.0) };
            let all = impulses(&vec![bounce; arms.len()], &rates, &response);
            for (place, impulse) in all.iter().enumerate() {
                let missed =
                    rates[place].x + changed(&response, &all, place).x + bounce.restitution * rates[place].x;
                assert!(impulse.x >= 0.0 && missed > -1e-9, "{case}: {missed}");
                assert!(impulse.x == 0.0 || missed.abs() < 1e-9, "{case}: {missed}");
                assert!(
                    impulse.yz().length() <= bounce.friction * impulse.x * (1.0 + 1e-12),
                    "{case}: {impulse}"
                );
            }
        }
    }
}

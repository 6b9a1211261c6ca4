//! The exact motion of two bodies that attract each other (Kepler's problem).

use glam::DVec3;

/// The largest number of iterations of Newton's method. If it does not converge, bisection is used.
const MAX_ITERATIONS: usize = 32;

/// Advances the position and the velocity of a body relative to another one by `dt` (s) along its Kepler orbit. Universal variables treat
/// ellipses, parabolas and hyperbolas alike. `mass` is the sum of both masses times the gravitational constant, m³/s². Source: H. Rein &
/// D. Tamayo, Mon. Not. R. Astron. Soc. 452 (2015) 376; E. Stiefel & G. Scheifele, *Linear and Regular Celestial Mechanics* (1971), § 11.
#[inline]
pub(super) fn drift(mass: f64, dt: f64, place: &mut DVec3, velocity: &mut DVec3) {
    let (at, moves) = (*place, *velocity);
    let r0 = at.length();
    let per_r0 = 1.0 / r0;
    // β is −2 times the energy per mass. η₀ and ζ₀ are the first two derivatives of the distance by X, where dt = r dX.
    let beta = 2.0 * mass * per_r0 - moves.length_squared();
    let eta = at.dot(moves);
    let zeta = mass - beta * r0;
    let part = dt * per_r0;
    let mut x = part * (1.0 - part * eta * 0.5 * per_r0);
    if beta > 0.0 && (x * x * beta > 1.0 || !x.is_finite()) {
        // For a large part of a period, the value on a circular orbit is a better first guess.
        x = dt * beta / mass;
    }
    let (mut g, mut r) = ([0.0; 4], r0);
    let mut before = f64::NAN;
    let mut is_found = false;
    for _ in 0..MAX_ITERATIONS {
        g = stiefel(beta, x);
        let bend = eta * g[1] + zeta * g[2];
        r = r0 + bend;
        let earlier = std::mem::replace(&mut before, x);
        x = (x * bend - eta * g[2] - zeta * g[3] + dt) / r;
        // The last digit may oscillate between two values.
        if x == before || x == earlier {
            is_found = true;
            break;
        }
    }
    if !is_found {
        x = bisect(beta, (r0, eta, zeta), dt, mass);
        g = stiefel(beta, x);
        r = r0 + eta * g[1] + zeta * g[2];
    }
    let per_r = 1.0 / r;
    *place += -mass * g[2] * per_r0 * at + (dt - mass * g[3]) * moves;
    *velocity += -mass * g[1] * per_r0 * per_r * at - mass * g[2] * per_r * moves;
}

/// Finds X by bisection of r₀ X + η₀ G₂ + ζ₀ G₃ = dt, whose left side increases with X.
#[cold]
fn bisect(beta: f64, (r0, eta, zeta): (f64, f64, f64), dt: f64, mass: f64) -> f64 {
    let excess = |x: f64| {
        let g = stiefel(beta, x);
        r0 * x + eta * g[2] + zeta * g[3] - dt
    };
    let sign = if dt < 0.0 { -1.0 } else { 1.0 };
    // This is the first guess of an upper bound for |X|. The loop doubles it until it is an upper bound.
    let mut far = sign * (dt.abs() / r0).max(dt.abs() * beta.abs() / mass).max(f64::MIN_POSITIVE);
    for _ in 0..200 {
        if sign * excess(far) > 0.0 {
            break;
        }
        far *= 2.0;
    }
    let mut near = 0.0;
    for _ in 0..200 {
        let middle = 0.5 * (near + far);
        if middle == near || middle == far {
            break;
        }
        if sign * excess(middle) > 0.0 { far = middle } else { near = middle }
    }
    0.5 * (near + far)
}

/// The inverse factorials 1/2!, 1/3!, … 1/13!.
const INVERSE_FACTORIALS: [f64; 12] = {
    let mut all = [0.0; 12];
    let (mut factorial, mut n) = (1.0, 2);
    while n < 14 {
        factorial *= n as f64;
        all[n - 2] = 1.0 / factorial;
        n += 1;
    }
    all
};

/// Returns Stiefel's functions Gₙ = Xⁿ cₙ(β X²) for n from 0 to 3, with Stumpff's functions cₙ(z) = 1/n! − z/(n + 2)! + z²/(n + 4)! − …
#[inline]
fn stiefel(beta: f64, x: f64) -> [f64; 4] {
    let square = x * x;
    let mut z = beta * square;
    let mut halvings = 0;
    while z.abs() > 0.1 && halvings < 600 {
        z *= 0.25;
        halvings += 1;
    }
    let [f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12, f13] = INVERSE_FACTORIALS;
    let mut c3 = f3 - z * (f5 - z * (f7 - z * (f9 - z * (f11 - z * f13))));
    let mut c2 = f2 - z * (f4 - z * (f6 - z * (f8 - z * (f10 - z * f12))));
    let mut c1 = 1.0 - z * c3;
    let mut c0 = 1.0 - z * c2;
    for _ in 0..halvings {
        (c3, c2, c1, c0) = (0.25 * (c2 + c0 * c3), 0.5 * c1 * c1, c0 * c1, 2.0 * c0 * c0 - 1.0);
    }
    [c0, c1 * x, c2 * square, c3 * square * x]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half a period after perihelion, a planet must be at aphelion. After whole periods, forwards or backwards, it must be back at
    /// perihelion.
    #[test]
    fn ellipses_come_round() {
        for e in [0.0, 0.3, 0.9, 0.99] {
            let start = (DVec3::X * (1.0 - e), DVec3::Y * f64::sqrt((1.0 + e) / (1.0 - e)));
            let after = |dt: f64| {
                let (mut place, mut velocity) = start;
                drift(1.0, dt, &mut place, &mut velocity);
                (place, velocity)
            };
            let half = after(std::f64::consts::PI);
            assert!(half.0.abs_diff_eq(DVec3::NEG_X * (1.0 + e), 1e-12), "{e}: {}", half.0);
            for turns in [1.0, -1.0, 3.0] {
                let whole = after(turns * std::f64::consts::TAU);
                assert!(whole.0.abs_diff_eq(start.0, 1e-11 / (1.0 - e)), "{e} {turns}: {}", whole.0);
            }
        }
    }

    /// On a hyperbola, energy and angular momentum must be conserved, and a step backwards must lead back to the start.
    #[test]
    fn hyperbolas_keep_their_energy_and_go_back() {
        let start = (DVec3::new(1.0, 0.2, 0.1), DVec3::new(-2.0, 1.0, 0.5));
        let (mut place, mut velocity) = start;
        let energy = |place: DVec3, velocity: DVec3| 0.5 * velocity.length_squared() - 1.0 / place.length();
        for dt in [0.1, 1.0, 50.0] {
            drift(1.0, dt, &mut place, &mut velocity);
            let lost = energy(place, velocity) - energy(start.0, start.1);
            assert!(lost.abs() < 1e-13, "{dt}: {lost:e}");
            assert!(place.cross(velocity).abs_diff_eq(start.0.cross(start.1), 1e-12), "{dt}");
        }
        drift(1.0, -51.1, &mut place, &mut velocity);
        assert!(place.abs_diff_eq(start.0, 1e-10) && velocity.abs_diff_eq(start.1, 1e-10), "{place}");
    }
}

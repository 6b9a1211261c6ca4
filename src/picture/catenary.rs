//! The curve of a rope that hangs between two points: a catenary with the length of the rope.
//!
//! Let y be the depth below the first end, x the horizontal distance from it, and τ a parameter that grows by 2u along the rope. Then x =
//! a (τ − τ₀), y = a (cosh τ₀ − cosh τ), and the arc length is a (sinh τ − sinh τ₀). For a rope of length L whose ends are h apart
//! horizontally and v vertically, h = 2 a u, tanh((τ₀ + τ₁)/2) = v/L and sinh(u)/u = √(L² − v²)/h. Source: E. H. Lockwood, *A Book of
//! Curves* (1961), chapter 13.

use glam::DVec3;

/// The number of straight pieces of a drawn curve. Each piece deviates from the curve by at most h u / 2304.
const PIECES_PER_CURVE: u32 = 24;

/// The horizontal distance between the ends, relative to the rope's length, below which the rope hangs straight down.
const UPRIGHT_RATIO: f64 = 1e-9;

/// The slack, relative to the rope's length, up to which the rope counts as straight.
const TAUT_TOLERANCE: f64 = 1e-12;

/// The points of a hanging rope without stiffness, m. `down` is the direction of gravity, a unit vector; without gravity the rope is a
/// circular arc. A rope that is no longer than the distance between its ends is a straight line with two points.
pub(super) fn hanging(ends: [DVec3; 2], length: f64, down: Option<DVec3>) -> Vec<DVec3> {
    let distance = ends[0].distance(ends[1]);
    if length - distance <= TAUT_TOLERANCE * length {
        return ends.to_vec();
    }
    let Some(down) = down else { return arc(ends, length) };
    match Catenary::new(ends, length, down) {
        Some(curve) => curve.points(),
        None => {
            // The rope hangs straight down and goes straight up again.
            let [from, to] = ends;
            let depth = (length + (to - from).dot(down)) / 2.0;
            vec![from, from + down * depth, to]
        }
    }
}

/// The curve of a hanging rope.
struct Catenary {
    ends: [DVec3; 2],
    down: DVec3,
    /// The horizontal vector from the first end to the second, m.
    across: DVec3,
    /// Half of the range of the parameter τ.
    half_range: f64,
    /// The value of the parameter τ at the first end.
    first: f64,
}

impl Catenary {
    /// Computes the curve of a rope that is longer than the distance between its ends. `None` if one end is vertically below the other.
    fn new(ends: [DVec3; 2], length: f64, down: DVec3) -> Option<Catenary> {
        let way = ends[1] - ends[0];
        let rise = -way.dot(down);
        let across = way + down * rise;
        let width = across.length();
        if width < UPRIGHT_RATIO * length {
            return None;
        }
        // Compute (L² − v²)/h² − 1 without cancellation.
        let distance = way.length();
        let excess = (length - distance) * (length + distance) / (width * width);
        let half_range = solve(0.5 * libm::log1p(excess));
        // Use sinh((τ₀ + τ₁)/2) = v/√(L² − v²), which is more accurate than v/L if v/L is nearly 1.
        let first = libm::asinh(rise / (width * libm::sqrt(1.0 + excess))) - half_range;
        Some(Catenary { ends, down, across, half_range, first })
    }

    /// The point at a fraction of the parameter's range, m. The horizontal distance from the first end is the same fraction of the whole.
    fn point(&self, part: f64) -> DVec3 {
        let Catenary { ends, down, across, half_range, first } = *self;
        let half = half_range * part;
        let scale = across.length() / half_range;
        // Use cosh τ − cosh τ₀ = 2 sinh((τ + τ₀)/2) sinh((τ − τ₀)/2).
        let rise = scale * libm::sinh(first + half) * libm::sinh(half);
        ends[0] + across * part - down * rise
    }

    fn points(&self) -> Vec<DVec3> {
        let inner =
            (1..PIECES_PER_CURVE).map(|piece| self.point(f64::from(piece) / f64::from(PIECES_PER_CURVE)));
        std::iter::once(self.ends[0]).chain(inner).chain([self.ends[1]]).collect()
    }
}

/// Computes the positive u with ln(sinh(u)/u) = s. The left-hand side is convex and increasing, so Newton's method converges from every
/// starting point; after the first step, it converges from the right.
fn solve(s: f64) -> f64 {
    // The starting point: ln(sinh(u)/u) is about u²/6 for small u, and about u − ln 2u for large u.
    let mut u = if s < 1.0 { libm::sqrt(6.0 * s) } else { s + libm::log(2.0 * s + 2.0) };
    for _ in 0..50 {
        let (value, slope) = log_sinh_ratio(u);
        let step = (value - s) / slope;
        u -= step;
        if step.abs() <= 1e-15 * u {
            break;
        }
    }
    u
}

/// Computes ln(sinh(u)/u) and its derivative for a positive u, without cancellation.
fn log_sinh_ratio(u: f64) -> (f64, f64) {
    if u < 0.5 {
        // The series sinh(u)/u − 1 = Σ u²ᵏ/(2k + 1)!, and its derivative.
        let square = u * u;
        let (mut term, mut sum, mut derivative) = (1.0, 0.0, 0.0);
        for k in 1..10_u32 {
            term *= square / f64::from(2 * k * (2 * k + 1));
            sum += term;
            derivative += f64::from(2 * k) * term / u;
        }
        return (libm::log1p(sum), derivative / (1.0 + sum));
    }
    let fall = libm::exp(-2.0 * u);
    (u + libm::log1p(-fall) - libm::log(2.0 * u), (1.0 + fall) / (1.0 - fall) - 1.0 / u)
}

/// The points of a circular arc that is longer than the distance between its ends, m. The arc bulges downward.
fn arc(ends: [DVec3; 2], length: f64) -> Vec<DVec3> {
    let [from, to] = ends;
    let chord = from.distance(to);
    // Half the angle of the arc, φ, satisfies sin(φ)/φ = chord/length. The left-hand side decreases from φ = 0 to φ = π, so bisection
    // finds it.
    let (mut low, mut high) = (0.0, std::f64::consts::PI);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if libm::sin(middle) * length > chord * middle { low = middle } else { high = middle }
    }
    let half = 0.5 * (low + high);
    let radius = length / (2.0 * half);
    let along = (to - from).normalize_or(DVec3::X);
    let side = DVec3::NEG_Y.reject_from_normalized(along).normalize_or(DVec3::X);
    let centre = from.midpoint(to) + side * (-radius * libm::cos(half));
    let point = |piece: u32| {
        let angle = half * (2.0 * f64::from(piece) / f64::from(PIECES_PER_CURVE) - 1.0);
        centre + radius * (along * libm::sin(angle) + side * libm::cos(angle))
    };
    std::iter::once(from).chain((1..PIECES_PER_CURVE).map(point)).chain([to]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOWN: DVec3 = DVec3::NEG_Y;

    /// The length of the curve from the formula for its arc length.
    fn length(curve: &Catenary) -> f64 {
        let scale = curve.across.length() / (2.0 * curve.half_range);
        // Use sinh τ₁ − sinh τ₀ = 2 cosh((τ₁ + τ₀)/2) sinh((τ₁ − τ₀)/2).
        2.0 * scale * libm::cosh(curve.first + curve.half_range) * libm::sinh(curve.half_range)
    }

    #[test]
    fn a_rope_keeps_its_length_between_any_ends() {
        let slacks = [1e-11, 1e-9, 1e-6, 1e-3, 0.01, 0.3, 1.0, 5.0, 100.0, 1e6];
        for to in [[1.0, 0.0], [1.0, 1.0], [1.0, -3.0], [1e-3, 2.0], [1e-6, -1.0], [1e4, 3.0], [1e-3, 0.0]] {
            let ends =
                [DVec3::new(0.3, 2.0, -1.0), DVec3::new(0.3, 2.0, -1.0) + DVec3::new(to[0], to[1], 0.0)];
            for slack in slacks {
                let asked = ends[0].distance(ends[1]) * (1.0 + slack);
                // Only ends that hang nearly one below the other have no catenary.
                let Some(curve) = Catenary::new(ends, asked, DOWN) else {
                    assert!(to[0] < 2.0 * UPRIGHT_RATIO * asked);
                    continue;
                };
                assert!((length(&curve) / asked - 1.0).abs() < 1e-9, "{to:?} {slack}: {}", length(&curve));
                // The curve must also reach the second end.
                let missing = curve.point(1.0).distance(ends[1]);
                assert!(missing < 1e-9 * asked, "{to:?} {slack}: {missing}");
            }
        }
    }

    /// The curve y = cosh x between x = -1 and 1, and between x = 0 and 2. Its length is a difference of sinh x.
    #[test]
    fn a_rope_is_a_catenary() {
        let curve = Catenary::new([DVec3::NEG_X, DVec3::X], 2.350_402_387_287_602_9, DOWN).unwrap();
        let sag = -curve.point(0.5).y;
        assert!((sag - 0.543_080_634_815_243_7).abs() < 1e-12, "{sag}");
        let ends = [DVec3::new(0.0, 1.0, 0.0), DVec3::new(0.0, 3.762_195_691_083_631, 2.0)];
        let curve = Catenary::new(ends, 3.626_860_407_847_018_6, DOWN).unwrap();
        let middle = curve.point(0.5);
        assert!(middle.abs_diff_eq(DVec3::new(0.0, 1.543_080_634_815_243_7, 1.0), 1e-12), "{middle}");
    }

    /// A rope whose length L is a little larger than the distance d between its ends sags by √(3 d (L − d)/8).
    #[test]
    fn a_rope_that_is_nearly_taut_sags_little() {
        for slack in [1e-11, 1e-8, 1e-5] {
            let points = hanging([DVec3::ZERO, DVec3::X * 2.0], 2.0 * (1.0 + slack), Some(DOWN));
            let sag = -points[12].y;
            let expected = libm::sqrt(3.0 * 2.0 * 2.0 * slack / 8.0);
            assert!((sag / expected - 1.0).abs() < 1e-4, "{slack}: {sag} {expected}");
        }
    }

    #[test]
    fn pieces_are_a_little_shorter_than_the_rope() {
        let ends = [DVec3::ZERO, DVec3::new(1.0, -0.5, 0.4)];
        for (length, down) in [(1.3, Some(DOWN)), (4.0, Some(DVec3::X)), (1.3, None), (9.0, None)] {
            let points = hanging(ends, length, down);
            assert_eq!((points[0], points[24]), (ends[0], ends[1]));
            let pieces: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            assert!((0.99..1.0).contains(&(pieces / length)), "{length} {down:?}: {pieces}");
        }
    }

    #[test]
    fn taut_and_upright_ropes_are_straight() {
        let ends = [DVec3::Y, DVec3::X];
        for length in [1.0, 2_f64.sqrt()] {
            assert_eq!(hanging(ends, length, Some(DOWN)), ends);
            assert_eq!(hanging(ends, length, None), ends);
        }
        // A rope of 3 m, whose ends are 1 m apart vertically, hangs to 1 m below the lower end.
        let upright = hanging([DVec3::Y, DVec3::ZERO], 3.0, Some(DOWN));
        assert_eq!(upright, [DVec3::Y, DVec3::NEG_Y, DVec3::ZERO]);
        let loose = hanging([DVec3::ZERO; 2], 3.0, Some(DOWN));
        assert_eq!(loose, [DVec3::ZERO, DVec3::NEG_Y * 1.5, DVec3::ZERO]);
    }
}

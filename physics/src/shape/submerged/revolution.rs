//! Computes the part of a solid of revolution below a plane, by integration over slices across its axis (y).

use std::f64::consts::PI;

use glam::DVec3;

use super::Submerged;

/// The positive nodes and their weights of Gauss–Legendre quadrature with 16 points on [−1, 1]. Source: M. Abramowitz & I. A. Stegun,
/// *Handbook of Mathematical Functions*, table 25.4.
const GAUSS_LEGENDRE: [(f64, f64); 8] = [
    (0.095_012_509_837_637_44, 0.189_450_610_455_068_5),
    (0.281_603_550_779_258_9, 0.182_603_415_044_923_6),
    (0.458_016_777_657_227_4, 0.169_156_519_395_002_5),
    (0.617_876_244_402_643_7, 0.149_595_988_816_576_7),
    (0.755_404_408_355_003, 0.124_628_971_255_533_9),
    (0.865_631_202_387_831_7, 0.095_158_511_682_492_78),
    (0.944_575_023_073_232_6, 0.062_253_523_938_647_89),
    (0.989_400_934_991_649_9, 0.027_152_459_411_754_1),
];

/// A section of a solid of revolution about the y axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Profile {
    /// The lower and the upper end of the section on the y axis, m.
    span: [f64; 2],
    outline: Outline,
}

#[derive(Clone, Copy, Debug)]
enum Outline {
    /// A cone: its radius at y is `middle + slope · y`.
    Cone { middle: f64, slope: f64 },
    /// A ball around the point y = `centre` of the axis.
    Ball { centre: f64, radius: f64 },
    /// A torus around the axis: the middle of its tube is the circle y = 0 at the distance `radius` from the axis.
    Ring { radius: f64, tube: f64 },
}

impl Profile {
    /// Creates a cylinder or a frustum with these radii at its lower and upper end.
    pub(super) fn cone(span: [f64; 2], [lower, upper]: [f64; 2]) -> Profile {
        let slope = if span[1] > span[0] { (upper - lower) / (span[1] - span[0]) } else { 0.0 };
        Profile { span, outline: Outline::Cone { middle: lower - slope * span[0], slope } }
    }

    pub(super) fn ball(span: [f64; 2], centre: f64, radius: f64) -> Profile {
        Profile { span, outline: Outline::Ball { centre, radius } }
    }

    pub(super) fn ring(radius: f64, tube: f64) -> Profile {
        Profile { span: [-tube, tube], outline: Outline::Ring { radius, tube } }
    }

    /// Returns the part of the section below the plane up·p = height.
    ///
    /// A slice at y is a disk or a ring. The part of a slice below the plane is the whole slice, nothing, or a segment. The integral over y
    /// is split where one case changes into another. Near these places, the integrand behaves like a power 3/2 of the distance, so the
    /// substitution a + (b − a) τ² (3 − 2τ) makes it smooth in τ. A ball or a torus becomes smooth at its ends if an angle replaces y.
    pub(super) fn below(&self, up: DVec3, height: f64) -> Submerged {
        let across = (up.x * up.x + up.z * up.z).sqrt();
        let mut ends = [self.span[0]; 6];
        let inner = self.crossings(up.y, across, height);
        for (end, y) in ends[1..5].iter_mut().zip(inner) {
            // A crossing outside of the section, or NaN, is replaced by the lower end.
            *end = if y > self.span[0] && y < self.span[1] { y } else { self.span[0] };
        }
        ends[5] = self.span[1];
        ends.sort_unstable_by(f64::total_cmp);
        let (mut volume, mut axial, mut radial) = (0.0, 0.0, 0.0);
        for pair in ends.windows(2).filter(|pair| pair[0] < pair[1]) {
            let [begin, end] = [pair[0], pair[1]].map(|y| self.parameter(y));
            let length = end - begin;
            for (node, weight) in
                GAUSS_LEGENDRE.into_iter().flat_map(|(node, weight)| [(node, weight), (-node, weight)])
            {
                let part = 0.5 + 0.5 * node;
                let (y, slope) = self.place(begin + length * part * part * (3.0 - 2.0 * part));
                let thickness = 0.5 * weight * slope * length * 6.0 * part * (1.0 - part);
                let (area, moment) = self.slice(y, height - y * up.y, across);
                volume += thickness * area;
                axial += thickness * area * y;
                radial += thickness * moment;
            }
        }
        let outwards = if across > 0.0 { DVec3::new(up.x, 0.0, up.z) / across } else { DVec3::ZERO };
        Submerged { volume, moment: axial * DVec3::Y + radial * outwards }
    }

    /// Returns the integration parameter that belongs to y. The outline is smooth in this parameter, which is y itself or an angle.
    fn parameter(&self, y: f64) -> f64 {
        match self.outline {
            Outline::Cone { .. } => y,
            Outline::Ball { centre, radius } => libm::asin(((y - centre) / radius).clamp(-1.0, 1.0)),
            Outline::Ring { tube, .. } => libm::asin((y / tube).clamp(-1.0, 1.0)),
        }
    }

    /// Returns the coordinate y that belongs to an integration parameter, and its derivative with respect to the parameter.
    fn place(&self, parameter: f64) -> (f64, f64) {
        let (centre, radius) = match self.outline {
            Outline::Cone { .. } => return (parameter, 1.0),
            Outline::Ball { centre, radius } => (centre, radius),
            Outline::Ring { tube, .. } => (0.0, tube),
        };
        let (sin, cos) = libm::sincos(parameter);
        (centre + radius * sin, radius * cos)
    }

    /// Returns up to four coordinates y at which the plane touches the outline, or nearly touches it. Unused entries are NaN. `along` and
    /// `across` are the components of `up` along the axis and across it.
    fn crossings(&self, along: f64, across: f64, height: f64) -> [f64; 4] {
        // These coordinates solve (height − along y)² = across² ρ(y)², where ρ is the radius of the outline.
        match self.outline {
            Outline::Cone { middle, slope } => {
                let [one, other] = [1.0, -1.0]
                    .map(|side| (height - side * across * middle) / (along + side * across * slope));
                [one, other, f64::NAN, f64::NAN]
            }
            Outline::Ball { centre, radius } => {
                let [one, other] =
                    roots(along * (height - along * centre), height - along * centre, across * radius);
                [one + centre, other + centre, f64::NAN, f64::NAN]
            }
            Outline::Ring { radius, tube } => {
                let [[a, b], [c, d]] = [1.0, -1.0].map(|side| {
                    let height = height - side * across * radius;
                    roots(along * height, height, across * tube)
                });
                [a, b, c, d]
            }
        }
    }

    /// Returns the area of the part of the slice at y for which across · s ≤ rest, where s is a coordinate in the slice with its origin on
    /// the axis, and the integral of s over this part.
    fn slice(&self, y: f64, rest: f64, across: f64) -> (f64, f64) {
        let disk = |radius: f64| segment(radius, rest, across);
        match self.outline {
            Outline::Cone { middle, slope } => disk(middle + slope * y),
            Outline::Ball { centre, radius } => {
                let from = y - centre;
                disk(((radius - from) * (radius + from)).max(0.0).sqrt())
            }
            Outline::Ring { radius, tube } => {
                let half = ((tube - y) * (tube + y)).max(0.0).sqrt();
                let (outer, inner) = (disk(radius + half), disk(radius - half));
                (outer.0 - inner.0, outer.1 - inner.1)
            }
        }
    }
}

/// Returns the two solutions of y² − 2 b y + h² − c² = 0. Without real solutions, both results are b, where the left side is smallest and
/// the plane may nearly touch the outline.
fn roots(b: f64, h: f64, c: f64) -> [f64; 2] {
    let root = (b * b - (h - c) * (h + c)).max(0.0).sqrt();
    [b - root, b + root]
}

/// Returns the area of the part of a disk where across · s ≤ rest, with s from the centre of the disk, and the integral of s over this
/// part.
fn segment(radius: f64, rest: f64, across: f64) -> (f64, f64) {
    let reach = across * radius;
    if rest >= reach {
        return (PI * radius * radius, 0.0);
    }
    if rest <= -reach {
        return (0.0, 0.0);
    }
    let part = rest / reach;
    let half_chord = ((1.0 - part) * (1.0 + part)).sqrt();
    let area = radius * radius * (PI - libm::acos(part) + part * half_chord);
    (area, -2.0 / 3.0 * radius * radius * radius * half_chord * half_chord * half_chord)
}

//! Volumes and principal moments of inertia of homogeneous solids. The moments are about the centre of mass and divided by the mass, m².
//!
//! Unless noted otherwise, the formulas are from J. L. Meriam, L. G. Kraige, *Engineering Mechanics: Dynamics*, appendix D, with the axis
//! of symmetry along y.

use std::f64::consts::PI;

use glam::DVec3;

/// Returns the volume of a sphere, m³: ⁴⁄₃ π r³.
pub(super) fn sphere_volume(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius * radius * radius
}

/// Returns the moments of inertia of a sphere, divided by its mass, m²: ⅖ r².
pub(super) fn sphere(radius: f64) -> DVec3 {
    DVec3::splat(0.4 * radius * radius)
}

/// Returns twelve times the moments of inertia of a box, divided by its mass, m²: b² + c² and its permutations (Goldstein, *Classical
/// Mechanics*, ch. 5).
pub(super) fn box_times_12(size: DVec3) -> DVec3 {
    let square = size * size;
    DVec3::new(square.y + square.z, square.z + square.x, square.x + square.y)
}

/// Returns the volume of a cylinder, m³: π r² h.
pub(super) fn cylinder_volume(radius: f64, height: f64) -> f64 {
    PI * radius * radius * height
}

/// Returns the moments of inertia of a cylinder, divided by its mass, m²: ½ r² about the axis, ¹⁄₁₂ (3 r² + h²) across the axis.
pub(super) fn cylinder(radius: f64, height: f64) -> DVec3 {
    let square = radius * radius;
    about_y(square / 2.0, (3.0 * square + height * height) / 12.0)
}

/// Returns the volume of a capsule, m³: a cylinder and two half balls.
pub(super) fn capsule_volume(radius: f64, height: f64) -> f64 {
    cylinder_volume(radius, height - 2.0 * radius) + sphere_volume(radius)
}

/// Returns the moments of inertia of a capsule, divided by its mass, m²: those of a cylinder of length l and of two half balls. The centre
/// of mass of a half ball is l/2 + ⅜ r from the origin. Across the axis, the moment of a half ball about its own centre of mass is ⁸³⁄₃₂₀
/// r². With ⁸³⁄₃₂₀ + ⁹⁄₆₄ = ⅖, the moment of the half balls about the origin is ⅖ r² + ¼ l² + ⅜ l r.
pub(super) fn capsule(radius: f64, height: f64) -> DVec3 {
    let length = height - 2.0 * radius;
    let (tube, balls) = (cylinder_volume(radius, length), sphere_volume(radius));
    let across = length * length / 4.0 + 0.375 * length * radius;
    let of_balls = sphere(radius) + about_y(0.0, across);
    let share = tube / (tube + balls);
    share * cylinder(radius, length) + (1.0 - share) * of_balls
}

/// Returns the volume of a cone or frustum, m³: ⅓ π h (R² + R r + r²).
pub(super) fn cone_volume(radius: f64, top_radius: f64, height: f64) -> f64 {
    PI / 3.0 * height * cone_sum(radius, top_radius)
}

/// Returns the height of the centre of mass of a cone or frustum above its base, m: ¼ h (R² + 2 R r + 3 r²) / (R² + R r + r²).
pub(super) fn cone_centre(radius: f64, top_radius: f64, height: f64) -> f64 {
    let weighted = radius * radius + 2.0 * radius * top_radius + 3.0 * top_radius * top_radius;
    height / 4.0 * weighted / cone_sum(radius, top_radius)
}

/// Returns the moments of inertia of a cone or frustum, divided by its mass, m².
///
/// About the axis: ³⁄₁₀ (R⁵ − r⁵) / (R³ − r³), with the factor R − r cancelled. Across the axis: half of that moment, plus the mean square
/// of the height relative to the centre of mass, ³⁄₈₀ h² ((R + r)⁴ + 4 R² r²) / (R² + R r + r²)².
pub(super) fn cone(radius: f64, top_radius: f64, height: f64) -> DVec3 {
    // The fourth powers of lengths could overflow, so the radii are divided by the larger radius.
    let widest = radius.max(top_radius);
    let (radius, top_radius) = (radius / widest, top_radius / widest);
    let (a, b, sum) = (radius * radius, top_radius * top_radius, cone_sum(radius, top_radius));
    let product = radius * top_radius;
    // This is the quotient (R⁵ − r⁵) / (R − r) = R⁴ + R³ r + R² r² + R r³ + r⁴.
    let fourth = a * a + product * (a + product + b) + b * b;
    let along = 0.3 * fourth / sum * widest * widest;
    let both = (radius + top_radius) * (radius + top_radius);
    let spread = 3.0 / 80.0 * height * height * (both * both + 4.0 * product * product) / (sum * sum);
    about_y(along, along / 2.0 + spread)
}

fn cone_sum(radius: f64, top_radius: f64) -> f64 {
    radius * radius + radius * top_radius + top_radius * top_radius
}

/// Returns the volume of a torus by Pappus's theorem, m³: 2 π² R r².
pub(super) fn torus_volume(radius: f64, tube_radius: f64) -> f64 {
    2.0 * PI * PI * radius * tube_radius * tube_radius
}

/// Returns the moments of inertia of a torus, divided by its mass, m²: R² + ¾ r² about the axis, ½ R² + ⅝ r² across the axis.
pub(super) fn torus(radius: f64, tube_radius: f64) -> DVec3 {
    let (ring, tube) = (radius * radius, tube_radius * tube_radius);
    about_y(ring + 0.75 * tube, 0.5 * ring + 0.625 * tube)
}

/// Returns the volume (m³) of a rounded box, and its moments of inertia divided by its mass (m²).
///
/// Let a, b and c be the inner edges. A slice across x at |x| ≤ a/2 is the rectangle b × c extended by r, with round corners. At
/// |x| = a/2 + u, the rectangle is extended by √(r² − u²). Extended by ρ, its area is b c + 2 (b + c) ρ + π ρ². The mean of x² follows from
/// ∫ uⁿ du, ∫ uⁿ √(r² − u²) du and ∫ uⁿ (r² − u²) du over 0 … r, for n = 0, 1, 2.
pub(super) fn rounded_box(size: DVec3, rounding: f64) -> (f64, DVec3) {
    // The fifth powers of lengths could overflow, so all lengths are divided by the longest edge.
    let unit = size.max_element();
    let (inner, r) = ((size - 2.0 * rounding).max(DVec3::ZERO) / unit, rounding / unit);
    let (r2, r3) = (r * r, r * r * r);
    let integral = |a: f64, b: f64, c: f64| {
        let area = |one: f64, root: f64, square: f64| b * c * one + 2.0 * (b + c) * root + PI * square;
        let caps = [
            area(r, PI / 4.0 * r2, 2.0 / 3.0 * r3),
            area(r2 / 2.0, r3 / 3.0, r2 * r2 / 4.0),
            area(r3 / 3.0, PI / 16.0 * r2 * r2, 2.0 / 15.0 * r2 * r3),
        ];
        let middle = area(1.0, r, r2);
        let volume = middle * a + 2.0 * caps[0];
        let x2 = middle * a * a * a / 12.0 + 2.0 * (a * a / 4.0 * caps[0] + a * caps[1] + caps[2]);
        (volume, x2)
    };
    let DVec3 { x: a, y: b, z: c } = inner;
    let ((volume, x2), (_, y2), (_, z2)) = (integral(a, b, c), integral(b, c, a), integral(c, a, b));
    let moments = DVec3::new(y2 + z2, z2 + x2, x2 + y2) / volume;
    (volume * unit * unit * unit, moments * unit * unit)
}

fn about_y(along: f64, across: f64) -> DVec3 {
    DVec3::new(across, along, across)
}

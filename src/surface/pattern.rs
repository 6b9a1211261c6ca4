//! Patterns with plane borders. Triangles are cut along the borders, so that each resulting triangle has a single color.

use std::collections::HashMap;
use std::f64::consts::FRAC_PI_3;

use glam::{DAffine3, DVec3, Vec3};

use super::{SurfacePattern, Triangles};

/// The edge length of a cube in the checkered pattern.
const CHECK_EDGE: f64 = 0.5;
/// The height of a band in the striped pattern.
const BAND_HEIGHT: f64 = 0.22;
/// The height |y| beyond which a beach ball is white.
const WHITE_CAP_HEIGHT: f64 = 0.455 * 2.002;
/// The largest number of border planes. A finer pattern would look like its mean color.
const MOST_PLANES: f64 = 200.0;

/// A corner of a polygon that was cut from a triangle.
#[derive(Clone, Copy)]
struct Corner {
    place: DVec3,
    normal: DVec3,
    /// The position in the coordinates of the pattern.
    at: DVec3,
}

/// A plane border between two colors: the points p of the pattern with `normal` · p = `distance`.
struct Border {
    normal: DVec3,
    distance: f64,
}

impl SurfacePattern {
    /// Cuts triangles along the borders of the pattern. Returns one set of triangles for each of [`colors`](super::Appearance::colors).
    /// `to_pattern` maps positions of the triangles to the coordinates of the pattern. `None` without a pattern, or if the pattern is too
    /// fine to be visible.
    #[must_use]
    pub fn split(self, triangles: &Triangles, to_pattern: DAffine3) -> Option<Vec<Triangles>> {
        let corners: Vec<Corner> = triangles
            .positions
            .iter()
            .zip(&triangles.normals)
            .map(|(place, normal)| {
                let place = Vec3::from_array(*place).as_dvec3();
                let normal = Vec3::from_array(*normal).as_dvec3();
                Corner { place, normal, at: to_pattern.transform_point3(place) }
            })
            .collect();
        let least = corners.iter().map(|corner| corner.at).reduce(DVec3::min)?;
        let largest = corners.iter().map(|corner| corner.at).reduce(DVec3::max)?;
        let (borders, colors) = self.borders(least, largest)?;
        let mut parts: Vec<ColoredTriangles> = (0..colors).map(|_| ColoredTriangles::default()).collect();
        for indices in triangles.indices.chunks_exact(3) {
            let mut pieces = vec![indices.iter().map(|&index| corners[index as usize]).collect::<Vec<_>>()];
            for border in &borders {
                pieces = pieces.into_iter().flat_map(|piece| border.cut(piece)).collect();
            }
            for piece in pieces {
                let middle = piece.iter().map(|corner| corner.at).sum::<DVec3>() / piece.len() as f64;
                parts[self.color_at(middle)].add(&piece);
            }
        }
        Some(parts.into_iter().map(|part| part.triangles).collect())
    }

    /// Returns the borders that cross a box, and the number of colors. `None` without a pattern, or if there are too many borders.
    fn borders(self, least: DVec3, largest: DVec3) -> Option<(Vec<Border>, usize)> {
        let counts = |axis: DVec3, first: f64, step: f64| {
            let from = ((least.dot(axis) - first) / step).ceil();
            let count = ((largest.dot(axis) - first) / step).floor() - from + 1.0;
            (axis, first + from * step, step, count.max(0.0))
        };
        let families = match self {
            SurfacePattern::None => return None,
            SurfacePattern::Checkered => {
                [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| counts(axis, 0.0, CHECK_EDGE)).to_vec()
            }
            SurfacePattern::Striped => {
                vec![counts(DVec3::Y, BAND_HEIGHT / 2.0, BAND_HEIGHT), (DVec3::X, 0.0, 1.0, 1.0)]
            }
            SurfacePattern::Ground => [DVec3::X, DVec3::Z].map(|axis| counts(axis, 0.0, 1.0)).to_vec(),
            SurfacePattern::BeachBall => {
                let side = |i: u8| {
                    let (sine, cosine) = libm::sincos(FRAC_PI_3 * f64::from(i));
                    Border { normal: DVec3::new(sine, 0.0, cosine), distance: 0.0 }
                };
                let pole = |sign: f64| Border { normal: DVec3::Y, distance: sign * WHITE_CAP_HEIGHT };
                return Some((vec![side(0), side(1), side(2), pole(-1.0), pole(1.0)], 7));
            }
        };
        let count: f64 = families.iter().map(|(.., count)| count).sum();
        if !count.is_finite() || count > MOST_PLANES {
            return None;
        }
        let all = families.iter().flat_map(|&(normal, first, step, count)| {
            (0..count as u32).map(move |i| Border { normal, distance: first + step * f64::from(i) })
        });
        Some((all.collect(), 2))
    }

    /// The index of the color at a point of the pattern.
    fn color_at(self, at: DVec3) -> usize {
        let second_where = |even: f64| usize::from(even.rem_euclid(2.0) < 0.5);
        match self {
            SurfacePattern::None => 0,
            SurfacePattern::Checkered => second_where((at / CHECK_EDGE).floor().element_sum()),
            SurfacePattern::Striped => {
                let shift = if at.x > 0.0 { 1.0 } else { 0.0 };
                second_where((at.y / BAND_HEIGHT + 0.5).floor() + shift)
            }
            SurfacePattern::Ground => second_where(at.x.floor() + at.z.floor()),
            SurfacePattern::BeachBall if at.y.abs() > WHITE_CAP_HEIGHT => 6,
            SurfacePattern::BeachBall => {
                let sector = (libm::atan2(-at.z, at.x) / FRAC_PI_3).floor();
                sector.rem_euclid(6.0) as usize % 6
            }
        }
    }
}

impl Border {
    /// Cuts a convex polygon into two if the border crosses it.
    fn cut(&self, piece: Vec<Corner>) -> Vec<Vec<Corner>> {
        // The distance up to which a corner counts as lying on the border.
        const BORDER_TOLERANCE: f64 = 1e-7;
        let side = |corner: &Corner| {
            let side = self.normal.dot(corner.at) - self.distance;
            if side.abs() < BORDER_TOLERANCE { 0.0 } else { side }
        };
        let on = |sign: f64| piece.iter().any(|corner| side(corner) * sign > 0.0);
        if !on(1.0) || !on(-1.0) {
            return vec![piece];
        }
        let mut halves = [Vec::new(), Vec::new()];
        for (i, corner) in piece.iter().enumerate() {
            let next = &piece[(i + 1) % piece.len()];
            let (here, there) = (side(corner), side(next));
            if here >= 0.0 {
                halves[0].push(*corner);
            }
            if here <= 0.0 {
                halves[1].push(*corner);
            }
            if here * there < 0.0 {
                let between = corner.towards(next, here / (here - there));
                halves.iter_mut().for_each(|half| half.push(between));
            }
        }
        halves.into_iter().filter(|half| half.len() > 2).collect()
    }
}

impl Corner {
    /// Interpolates between two corners: 0 gives this corner, 1 the other.
    fn towards(&self, other: &Corner, part: f64) -> Corner {
        let normal = self.normal.lerp(other.normal, part);
        Corner {
            place: self.place.lerp(other.place, part),
            normal: normal.try_normalize().unwrap_or(self.normal),
            at: self.at.lerp(other.at, part),
        }
    }
}

/// The triangles of one color.
#[derive(Default)]
struct ColoredTriangles {
    triangles: Triangles,
    /// The vertex for each position and normal, as the bits of their components. The map is never iterated.
    known: HashMap<[u32; 6], u32>,
}

impl ColoredTriangles {
    fn add(&mut self, piece: &[Corner]) {
        let numbers: Vec<u32> = piece.iter().map(|corner| self.vertex(corner)).collect();
        for pair in numbers[1..].windows(2) {
            self.triangles.triangle([numbers[0], pair[0], pair[1]]);
        }
    }

    fn vertex(&mut self, corner: &Corner) -> u32 {
        let [x, y, z] = corner.place.as_vec3().to_array().map(f32::to_bits);
        let [nx, ny, nz] = corner.normal.as_vec3().to_array().map(f32::to_bits);
        let triangles = &mut self.triangles;
        *self
            .known
            .entry([x, y, z, nx, ny, nz])
            .or_insert_with(|| triangles.vertex(corner.place, corner.normal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{BaseShape, Detail};

    fn area(triangles: &Triangles) -> f64 {
        let at = |i: u32| Vec3::from_array(triangles.positions[i as usize]).as_dvec3();
        let corners = triangles.indices.chunks_exact(3);
        corners.map(|c| (at(c[1]) - at(c[0])).cross(at(c[2]) - at(c[0])).length() / 2.0).sum()
    }

    fn parts(form: &BaseShape, pattern: SurfacePattern) -> (f64, Vec<f64>) {
        let triangles = form.triangles(Detail::Fine);
        let parts = pattern.split(&triangles, DAffine3::IDENTITY).unwrap();
        (area(&triangles), parts.iter().map(area).collect())
    }

    #[test]
    fn parts_make_up_the_whole() {
        for form in [BaseShape::BALL, BaseShape::CUBE, BaseShape::CYLINDER, BaseShape::torus(0.3)] {
            for pattern in [
                SurfacePattern::Checkered,
                SurfacePattern::Striped,
                SurfacePattern::BeachBall,
                SurfacePattern::Ground,
            ] {
                let (whole, parts) = parts(&form, pattern);
                assert!(
                    (parts.iter().sum::<f64>() / whole - 1.0).abs() < 1e-6,
                    "{form:?} {pattern:?}: {parts:?}"
                );
                // The torus is too flat to reach the poles of the beach ball pattern.
                let seen = parts.iter().filter(|part| **part > 0.0).count();
                assert!(seen >= parts.len() - 1 && seen >= 2, "{form:?} {pattern:?}: {parts:?}");
            }
        }
    }

    /// On a ball, the area of a zone is proportional to its height (Archimedes), so the areas of all bands follow from their heights.
    #[test]
    fn bands_have_the_heights_that_the_scripts_give_them() {
        let color = |x: f64, y: f64| SurfacePattern::Striped.color_at(DVec3::new(x, y, 0.0));
        assert_eq!([-0.1, -0.12, 0.1, 0.12, 0.32, 0.34].map(|y| color(-0.5, y)), [1, 0, 1, 0, 0, 1]);
        assert_eq!([-0.1, -0.12, 0.1, 0.12, 0.32, 0.34].map(|y| color(0.5, y)), [0, 1, 0, 1, 1, 0]);
        // The halves complete each other.
        let (whole, parts) = parts(&BaseShape::BALL, SurfacePattern::Striped);
        assert!((parts[1] / whole - 0.5).abs() < 2e-3, "{}", parts[1] / whole);
    }

    #[test]
    fn a_beach_ball_has_six_equal_sectors_and_two_poles() {
        let (whole, parts) = parts(&BaseShape::BALL, SurfacePattern::BeachBall);
        assert!((parts[6] / whole - (1.0 - WHITE_CAP_HEIGHT)).abs() < 2e-3, "{parts:?}");
        assert!(parts[..6].iter().all(|part| (part / parts[0] - 1.0).abs() < 1e-3), "{parts:?}");
        let first = SurfacePattern::BeachBall.color_at(DVec3::new(0.9, 0.0, -0.1));
        let last = SurfacePattern::BeachBall.color_at(DVec3::new(0.9, 0.0, 0.1));
        assert_eq!((first, last), (0, 5));
    }

    #[test]
    fn a_cube_of_the_checkered_pattern_is_where_the_scripts_have_it() {
        assert_eq!(SurfacePattern::Checkered.color_at(DVec3::splat(0.25)), 1);
        assert_eq!(SurfacePattern::Checkered.color_at(DVec3::new(-0.25, 0.25, 0.25)), 0);
        let (whole, parts) = parts(&BaseShape::CUBE, SurfacePattern::Checkered);
        assert!((parts[0] / whole - 0.5).abs() < 1e-9);
    }

    #[test]
    fn what_is_too_fine_to_be_seen_is_left_whole() {
        let triangles = BaseShape::PLANE.triangles(Detail::Fine);
        let fine = DAffine3::from_scale(DVec3::splat(1e9));
        assert!(SurfacePattern::Ground.split(&triangles, fine).is_none());
        assert!(SurfacePattern::None.split(&triangles, DAffine3::IDENTITY).is_none());
    }
}

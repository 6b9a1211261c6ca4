//! Cuts a solid of triangles into convex parts, without any deviation.
//!
//! The solid is cut by planes of its own faces (a binary space partition) until the faces in each cell belong to a convex solid. Then parts
//! that are convex together are united. Source: B. Naylor, J. Amanatides & W. Thibault, *Merging BSP trees yields polyhedral set
//! operations*, SIGGRAPH 1990.

use glam::DVec3;
use rapier3d_f64::prelude::SharedShape;

/// Lengths count as rounding errors if they are below this fraction of the solid's size.
const LENGTH_ROUNDING: f64 = 1e-9;
/// A solid with more triangles than this is not cut, because the time grows with the square of their number.
const MAX_TRIANGLES: usize = 2000;
/// A solid that would fall into more parts than this is not cut.
const MAX_PARTS: usize = 128;
/// Two parts together count as convex if the volume of their common convex hull exceeds the sum of their volumes by at most this fraction.
const CONVEXITY_TOLERANCE: f64 = 1e-7;
/// The parts are correct if the sum of their volumes differs from the volume of the solid by at most this fraction.
const VOLUME_TOLERANCE: f64 = 1e-6;

/// The corners of a convex part.
type Corners = Vec<DVec3>;

/// A plane with its unit normal: the points x with normal · x = offset. The back is the side of the smaller products.
#[derive(Clone, Copy)]
struct Plane {
    normal: DVec3,
    offset: f64,
}

impl Plane {
    fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }

    fn reversed(self) -> Plane {
        Plane { normal: -self.normal, offset: -self.offset }
    }
}

/// A polygon: a face of the solid or a part of it, with the plane of that face. The normal of the plane points out of the solid.
struct Facet {
    corners: Corners,
    plane: Plane,
}

/// Returns the corners of convex parts that together are the solid with this closed surface of triangles. `None` if there would be too
/// many, or if the surface is not exact enough to be cut. `volume` is the volume of the solid, m³.
pub(super) fn convex_parts(vertices: &[DVec3], triangles: &[[u32; 3]], volume: f64) -> Option<Vec<Corners>> {
    if triangles.len() > MAX_TRIANGLES {
        return None;
    }
    let (low, high) = vertices.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), vertex| {
        (low.min(*vertex), high.max(*vertex))
    });
    let rounding = LENGTH_ROUNDING * (high - low).length();
    let facets: Vec<Facet> = triangles.iter().filter_map(|triangle| facet(vertices, triangle)).collect();
    let mut cutter = Cutter { rounding, parts: Vec::new() };
    let margin = DVec3::splat(0.1 * (high - low).length());
    cutter.cut(&block(low - margin, high + margin), facets)?;
    let parts = unite(cutter.parts);
    let sum: f64 = parts.iter().map(|part| hull_volume(part)).sum();
    ((sum - volume).abs() <= VOLUME_TOLERANCE * volume).then_some(parts)
}

/// Makes the facet of a triangle; `None` if its area is zero.
fn facet(vertices: &[DVec3], triangle: &[u32; 3]) -> Option<Facet> {
    let corners = triangle.map(|corner| vertices[corner as usize]);
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).try_normalize()?;
    let plane = Plane { normal, offset: normal.dot(corners[0]) };
    Some(Facet { corners: corners.to_vec(), plane })
}

/// Returns the faces of a block with these two corners.
fn block(low: DVec3, high: DVec3) -> Vec<Corners> {
    let side = |axis: usize, at: f64| {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        let corner = |(p, q): (f64, f64)| {
            let mut corner = DVec3::ZERO;
            (corner[axis], corner[j], corner[k]) = (at, p, q);
            corner
        };
        [(low[j], low[k]), (high[j], low[k]), (high[j], high[k]), (low[j], high[k])].map(corner).to_vec()
    };
    (0..3).flat_map(|axis| [side(axis, low[axis]), side(axis, high[axis])]).collect()
}

/// Cuts cells of space, and collects the convex parts of the solid.
struct Cutter {
    /// Shorter lengths than this are rounding errors, m.
    rounding: f64,
    parts: Vec<Corners>,
}

impl Cutter {
    /// Cuts a convex cell, given by its faces, until its facets belong to a convex solid. `None` if there are too many parts.
    fn cut(&mut self, cell: &[Corners], facets: Vec<Facet>) -> Option<()> {
        let Some(plane) = self.best_plane(&facets) else {
            // The solid is convex in this cell.
            let faces = facets.iter().fold(cell.to_vec(), |faces, facet| self.behind(&faces, facet.plane));
            let corners = self.distinct(faces.into_iter().flatten());
            if corners.len() > 3 {
                self.parts.push(corners);
            }
            return (self.parts.len() <= 2 * MAX_PARTS).then_some(());
        };
        let (mut front, mut back) = (Vec::new(), Vec::new());
        for facet in facets {
            let heights = || facet.corners.iter().map(|corner| plane.height(*corner));
            // A facet in the plane is a face of the cells on both sides.
            if heights().all(|height| height.abs() <= self.rounding) {
                continue;
            }
            for (side, plane) in [(&mut back, plane), (&mut front, plane.reversed())] {
                let corners = self.part_behind(&facet.corners, plane);
                if corners.len() > 2 {
                    side.push(Facet { corners, plane: facet.plane });
                }
            }
        }
        // Without facets, a cell is inside the solid behind a face, and outside in front of it.
        if back.is_empty() {
            let corners = self.distinct(self.behind(cell, plane).into_iter().flatten());
            self.parts.push(corners);
        } else {
            self.cut(&self.behind(cell, plane), back)?;
        }
        if front.is_empty() { Some(()) } else { self.cut(&self.behind(cell, plane.reversed()), front) }
    }

    /// Returns the plane of a facet that cuts the fewest other facets, among those with facets in front. `None` if there is none, so that
    /// the facets belong to a convex solid.
    fn best_plane(&self, facets: &[Facet]) -> Option<Plane> {
        let cost = |facet: &Facet| {
            let (mut cuts, mut before, mut behind) = (0_usize, 0_usize, 0_usize);
            for other in facets {
                let heights = || other.corners.iter().map(|corner| facet.plane.height(*corner));
                let rises = heights().any(|height| height > self.rounding);
                let falls = heights().any(|height| height < -self.rounding);
                cuts += usize::from(rises && falls);
                before += usize::from(rises);
                behind += usize::from(falls);
            }
            (before > 0).then_some((8 * cuts + before.abs_diff(behind), facet.plane))
        };
        facets.iter().filter_map(cost).min_by_key(|(cost, _)| *cost).map(|(_, plane)| plane)
    }

    /// Returns the faces of the part of a convex cell behind a plane.
    fn behind(&self, faces: &[Corners], plane: Plane) -> Vec<Corners> {
        if faces.iter().flatten().all(|corner| plane.height(*corner) <= self.rounding) {
            return faces.to_vec();
        }
        let mut kept: Vec<Corners> = faces.iter().map(|face| self.part_behind(face, plane)).collect();
        kept.retain(|face| face.len() > 2);
        let in_plane = |corner: &DVec3| plane.height(*corner).abs() <= self.rounding;
        let mut cap = self.distinct(kept.iter().flatten().copied().filter(in_plane));
        if cap.len() > 2 {
            let centre = cap.iter().sum::<DVec3>() / cap.len() as f64;
            let (x, y) = plane.normal.any_orthonormal_pair();
            let angle = |corner: &DVec3| libm::atan2((*corner - centre).dot(y), (*corner - centre).dot(x));
            cap.sort_by(|one, two| angle(one).total_cmp(&angle(two)));
            kept.push(cap);
        }
        kept
    }

    /// Returns the corners of the part of a convex polygon behind a plane.
    fn part_behind(&self, corners: &[DVec3], plane: Plane) -> Corners {
        let mut part = Vec::with_capacity(corners.len() + 1);
        let Some(last) = corners.last() else { return part };
        let mut before = (*last, plane.height(*last));
        for corner in corners {
            let here = (*corner, plane.height(*corner));
            let crosses = (before.1 > self.rounding && here.1 < -self.rounding)
                || (before.1 < -self.rounding && here.1 > self.rounding);
            if crosses {
                part.push(before.0.lerp(here.0, before.1 / (before.1 - here.1)));
            }
            if here.1 <= self.rounding {
                part.push(here.0);
            }
            before = here;
        }
        // A polygon that only touches the plane has no part behind it.
        if part.iter().all(|corner| plane.height(*corner) >= -self.rounding) {
            part.clear();
        }
        part
    }

    /// Returns the points that are farther apart than rounding errors.
    fn distinct(&self, points: impl Iterator<Item = DVec3>) -> Corners {
        let mut found: Corners = Vec::new();
        for point in points {
            if found.iter().all(|other| other.distance(point) > 4.0 * self.rounding) {
                found.push(point);
            }
        }
        found
    }
}

/// Unites parts that are convex together, until there are none left.
fn unite(parts: Vec<Corners>) -> Vec<Corners> {
    if parts.len() > MAX_PARTS {
        return parts;
    }
    let with_volume = |part: Corners| {
        let volume = hull_volume(&part);
        (part, volume)
    };
    let mut parts: Vec<(Corners, f64)> = parts.into_iter().map(with_volume).collect();
    let mut one = 0;
    while one < parts.len() {
        let together = |two: usize| {
            let both: Corners = parts[one].0.iter().chain(&parts[two].0).copied().collect();
            let (sum, volume) = (parts[one].1 + parts[two].1, hull_volume(&both));
            (volume <= sum * (1.0 + CONVEXITY_TOLERANCE)).then_some((two, both, volume))
        };
        match (one + 1..parts.len()).find_map(together) {
            Some((two, both, volume)) => {
                parts.swap_remove(two);
                parts[one] = (both, volume);
                one = 0;
            }
            None => one += 1,
        }
    }
    parts.into_iter().map(|(part, _)| part).collect()
}

/// Returns the volume of the convex hull of some points, m³; 0 if they lie in a plane.
fn hull_volume(points: &[DVec3]) -> f64 {
    SharedShape::convex_hull(points).map_or(0.0, |hull| hull.mass_properties(1.0).mass())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes a prism of thickness 0.5 over a polygon that is star-shaped about a centre.
    fn prism(polygon: &[[f64; 2]], centre: [f64; 2]) -> (Vec<DVec3>, Vec<[u32; 3]>, f64) {
        let n = polygon.len() as u32;
        let level = |z: f64| polygon.iter().chain([&centre]).map(move |[x, y]| DVec3::new(*x, *y, z));
        let triangles = (0..n).flat_map(|i| {
            let (j, top) = ((i + 1) % n, n + 1);
            [[n, j, i], [top + n, top + i, top + j], [i, j, top + j], [i, top + j, top + i]]
        });
        let next = polygon.iter().cycle().skip(1);
        let doubled: f64 = polygon.iter().zip(next).map(|(one, two)| one[0] * two[1] - two[0] * one[1]).sum();
        (level(0.0).chain(level(0.5)).collect(), triangles.collect(), 0.5 * 0.5 * doubled)
    }

    fn parts(polygon: &[[f64; 2]], centre: [f64; 2]) -> Vec<Corners> {
        let (vertices, triangles, volume) = prism(polygon, centre);
        convex_parts(&vertices, &triangles, volume).unwrap_or_default()
    }

    #[test]
    fn a_block_is_one_part_and_an_l_is_two() {
        assert_eq!(parts(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]], [1.0, 0.5]).len(), 1);
        let l = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let parts = parts(&l, [0.5, 0.5]);
        assert_eq!(parts.len(), 2);
        // No part reaches across the inner corner.
        for part in parts {
            assert!(
                part.iter().all(|corner| corner.x < 1.0 + 1e-9)
                    || part.iter().all(|corner| corner.y < 1.0 + 1e-9)
            );
        }
    }

    /// The profile of a snail cam is a spiral with a step. It is concave only at the inner end of the step, so few parts are enough.
    #[test]
    fn a_snail_is_a_few_parts() {
        for sides in [12, 40, 96] {
            let spiral = |i: u32| {
                let part = f64::from(i) / f64::from(sides);
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * part);
                [(0.2 + 0.1 * part) * cos, (0.2 + 0.1 * part) * sin]
            };
            let polygon: Vec<[f64; 2]> = (0..=sides).map(spiral).collect();
            let parts = parts(&polygon, [0.0, 0.0]);
            assert!((2..=4).contains(&parts.len()), "{sides} sides: {} parts", parts.len());
        }
    }

    /// A ring has as many parts as its hole has sides.
    #[test]
    fn a_ring_keeps_its_hole() {
        let (n, m) = (16, 2);
        let vertices: Vec<DVec3> = (0..n * m * 2)
            .map(|k| {
                let (i, radius, z) = (k % n, [1.0, 2.0][k / n % m], [0.0, 0.5][k / n / m]);
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / n as f64);
                DVec3::new(radius * cos, radius * sin, z)
            })
            .collect();
        let [inner, outer, high] = [0, n, n * m];
        let quads = (0..n).flat_map(|i| {
            let j = (i + 1) % n;
            let (a, b, c, d) = (inner + i, inner + j, outer + j, outer + i);
            [
                [a, b, c, d],
                [high + d, high + c, high + b, high + a],
                [d, c, high + c, high + d],
                [b, a, high + a, high + b],
            ]
        });
        let triangles: Vec<[u32; 3]> = quads
            .flat_map(|quad| {
                let [a, b, c, d] = quad.map(|corner| corner as u32);
                [[a, b, c], [a, c, d]]
            })
            .collect();
        let polygon =
            |radius: f64| 0.5 * n as f64 * radius * radius * libm::sin(std::f64::consts::TAU / n as f64);
        let parts =
            convex_parts(&vertices, &triangles, 0.5 * (polygon(2.0) - polygon(1.0))).unwrap_or_default();
        assert_eq!(parts.len(), n);
    }
}

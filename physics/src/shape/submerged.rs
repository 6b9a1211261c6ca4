//! Computes the part of a solid below a plane, which is the submerged part of a floating body.

mod revolution;

use glam::DVec3;

use self::revolution::Profile;
use super::{Mesh, Shape, cone_base};

/// The part of a shape below a plane, in the frame of the shape.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Submerged {
    /// The volume of the submerged part, m³.
    pub volume: f64,
    /// The first moment of the submerged part, m⁴: its volume times its centroid.
    pub moment: DVec3,
}

impl Submerged {
    fn add(&mut self, other: Submerged) {
        self.volume += other.volume;
        self.moment += other.moment;
    }
}

impl Shape {
    /// Returns the part of the shape below the plane up·p = height, where `up` is a unit vector in the frame of the shape, and `height` is
    /// in m. Returns `None` for a plane, axes, a rounded box, and a mesh that is not closed.
    ///
    /// The results for spheres, boxes and meshes are exact. Shapes with an axis of symmetry are integrated over slices, with an error of
    /// at most 1e-9 of the whole, and mostly 1e-12.
    #[must_use]
    pub fn submerged(&self, up: DVec3, height: f64) -> Option<Submerged> {
        Some(match self {
            Shape::Sphere { radius } => ball(*radius, up, height),
            Shape::Box { size } => cuboid(*size, up, height),
            Shape::Cylinder { radius, height: length } => {
                Profile::cone([-0.5 * length, 0.5 * length], [*radius; 2]).below(up, height)
            }
            Shape::Cone { radius, top_radius, height: length } => {
                let base = cone_base(*radius, *top_radius, *length);
                Profile::cone([base, base + length], [*radius, *top_radius]).below(up, height)
            }
            Shape::Capsule { radius, height: length } => {
                let half = 0.5 * length - radius;
                let mut sum = Profile::cone([-half, half], [*radius; 2]).below(up, height);
                sum.add(Profile::ball([-half - radius, -half], -half, *radius).below(up, height));
                sum.add(Profile::ball([half, half + radius], half, *radius).below(up, height));
                sum
            }
            Shape::Torus { radius, tube_radius } => Profile::ring(*radius, *tube_radius).below(up, height),
            Shape::Mesh { mesh, scale } if mesh.flaw().is_none() => of_mesh(mesh, *scale, up, height),
            Shape::Compound(compound) => {
                let mut sum = Submerged::default();
                for part in compound.parts() {
                    let inner = part.orientation.conjugate() * up;
                    let below = part.shape.submerged(inner, height - part.location.dot(up))?;
                    let moment = part.orientation * below.moment + below.volume * part.location;
                    sum.add(Submerged { volume: below.volume, moment });
                }
                sum
            }
            Shape::Plane { .. } | Shape::Axes { .. } | Shape::RoundedBox { .. } | Shape::Mesh { .. } => {
                return None;
            }
        })
    }
}

/// Returns the part of a ball below a plane at height h above its centre: a cap of height R + h. Its volume is π (R + h)² (2R − h)/3, and
/// its first moment along `up` is −π (R² − h²)²/4.
fn ball(radius: f64, up: DVec3, height: f64) -> Submerged {
    let h = height.clamp(-radius, radius);
    let pi = std::f64::consts::PI;
    let rest = (radius - h) * (radius + h);
    let volume = pi / 3.0 * (radius + h) * (radius + h) * (2.0 * radius - h);
    Submerged { volume, moment: -0.25 * pi * rest * rest * up }
}

/// The corners of each face of a box, counter-clockwise as seen from outside. In the index of a corner, bit 0 is 1 for positive x, bit 1
/// for positive y, bit 2 for positive z.
const BOX_FACES: [[usize; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

fn cuboid(size: DVec3, up: DVec3, height: f64) -> Submerged {
    let side = |corner: usize, bit: usize| if corner >> bit & 1 == 1 { 0.5 } else { -0.5 };
    let corner = |corner: usize| size * DVec3::new(side(corner, 0), side(corner, 1), side(corner, 2));
    let reach = 0.5 * size.dot(up.abs());
    if height >= reach {
        return Submerged { volume: size.x * size.y * size.z, moment: DVec3::ZERO };
    }
    let mut cut = Cut::new(up, height);
    for [a, b, c, d] in BOX_FACES.map(|face| face.map(corner)) {
        cut.add([a, b, c]);
        cut.add([a, c, d]);
    }
    cut.done()
}

fn of_mesh(mesh: &Mesh, scale: f64, up: DVec3, height: f64) -> Submerged {
    let mut cut = Cut::new(up, height);
    for corners in mesh.triangles() {
        cut.add(corners.map(|corner| scale * mesh.vertices()[corner as usize]));
    }
    cut.done()
}

/// Sums up pyramids over the part of a closed surface below a plane. The apex of all pyramids is `tip`, a point of the plane. So the
/// pyramid over the cut face has height 0 and can be left out.
struct Cut {
    up: DVec3,
    tip: DVec3,
    /// The summed volumes and moments of the pyramids. The moments are relative to `tip`.
    sum: Submerged,
}

impl Cut {
    fn new(up: DVec3, height: f64) -> Cut {
        Cut { up, tip: height * up, sum: Submerged::default() }
    }

    fn add(&mut self, corners: [DVec3; 3]) {
        let corners = corners.map(|corner| corner - self.tip);
        let above = corners.map(|corner| corner.dot(self.up));
        // The part of a triangle below a plane is a triangle or a quadrilateral. Its corners keep their order.
        let mut kept = [DVec3::ZERO; 4];
        let mut count = 0;
        for (k, corner) in corners.iter().enumerate() {
            let next = (k + 1) % 3;
            if above[k] <= 0.0 {
                kept[count] = *corner;
                count += 1;
            }
            if (above[k] <= 0.0) != (above[next] <= 0.0) {
                let part = above[k] / (above[k] - above[next]);
                kept[count] = *corner + part * (corners[next] - *corner);
                count += 1;
            }
        }
        for k in 2..count {
            let [a, b, c] = [kept[0], kept[k - 1], kept[k]];
            let volume = a.dot(b.cross(c)) / 6.0;
            self.sum.add(Submerged { volume, moment: 0.25 * volume * (a + b + c) });
        }
    }

    fn done(self) -> Submerged {
        let Submerged { volume, moment } = self.sum;
        Submerged { volume, moment: moment + volume * self.tip }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Compound, Part};
    use super::*;
    use glam::DQuat;
    use std::sync::Arc;

    #[allow(clippy::unwrap_used, reason = "it is part of tests")]
    fn shapes() -> Vec<Shape> {
        let octahedron = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        let faces =
            vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        let part =
            |shape, x: f64| Part { shape, location: x * DVec3::X, orientation: DQuat::from_rotation_z(x) };
        vec![
            Shape::Sphere { radius: 0.7 },
            Shape::Box { size: DVec3::new(1.0, 0.6, 1.7) },
            Shape::Cylinder { radius: 0.5, height: 1.3 },
            Shape::Cone { radius: 0.8, top_radius: 0.0, height: 1.1 },
            Shape::Cone { radius: 0.4, top_radius: 0.9, height: 0.8 },
            Shape::Capsule { radius: 0.3, height: 1.6 },
            Shape::Torus { radius: 0.7, tube_radius: 0.25 },
            Shape::Mesh { mesh: Arc::new(Mesh::new("octahedron", octahedron.to_vec(), faces)), scale: 0.8 },
            Shape::Compound(Compound::new(vec![
                part(Shape::Cylinder { radius: 0.3, height: 1.0 }, 0.6),
                part(Shape::Box { size: DVec3::splat(0.5) }, -0.9),
            ])),
        ]
    }

    /// Unit vectors that point up in the frame of the shape.
    const UP_DIRECTIONS: [DVec3; 6] = [
        DVec3::Y,
        DVec3::NEG_Y,
        DVec3::X,
        DVec3::new(0.6, 0.8, 0.0),
        DVec3::new(0.48, -0.6, 0.64),
        DVec3::new(1e-7, 1.0, 0.0),
    ];

    #[test]
    fn all_below_is_the_whole_and_all_above_is_nothing() {
        for shape in shapes() {
            let whole = shape.volume().unwrap();
            for up in UP_DIRECTIONS {
                let below = shape.submerged(up, 9.0).unwrap();
                assert!((below.volume / whole - 1.0).abs() < 1e-11, "{shape:?} {up}: {below:?} {whole}");
                assert!(below.moment.length() < 1e-11, "{shape:?} {up}: {below:?}");
                let above = shape.submerged(up, -9.0).unwrap();
                assert!(above.volume.abs() < 1e-13 && above.moment.length() < 1e-13, "{shape:?}: {above:?}");
            }
        }
    }

    /// The parts of a shape below a plane and above it must add up to the whole shape.
    #[test]
    fn both_sides_of_a_plane_make_the_whole() {
        for shape in shapes() {
            for up in UP_DIRECTIONS {
                for height in [-0.41, -0.1, 0.0, 0.23, 0.52] {
                    let [one, other] = [(up, height), (-up, -height)]
                        .map(|(up, height)| shape.submerged(up, height).unwrap());
                    let whole = shape.volume().unwrap();
                    let off = (one.volume + other.volume - whole).abs();
                    assert!(off < 1e-11 * whole, "{shape:?} {up} {height}: {off:e}");
                    assert!((one.moment + other.moment).length() < 1e-11, "{shape:?} {up} {height}");
                }
            }
        }
    }

    /// When the plane rises, the moment along `up` must grow by the height of the plane times the growth of the volume. Central
    /// differences with 1e-4 have an error of 1e-8 times a third derivative, which is of order 1 unless an edge lies in the plane.
    #[test]
    fn the_moment_grows_with_the_volume() {
        const H: f64 = 1e-4;
        for shape in shapes() {
            for up in UP_DIRECTIONS.into_iter().skip(3).take(2) {
                for height in [-0.31, 0.07, 0.29] {
                    let at = |height| shape.submerged(up, height).unwrap();
                    let (less, more) = (at(height - H), at(height + H));
                    let area = (more.volume - less.volume) / (2.0 * H);
                    let rise = (more.moment - less.moment).dot(up) / (2.0 * H);
                    assert!((rise - height * area).abs() < 1e-6, "{shape:?} {up} {height}: {rise} {area}");
                }
            }
        }
    }

    /// Known results: half of a lying cylinder has its centroid 4 R/3π below the axis. A cone with its tip down, submerged to half its
    /// height, displaces an eighth of its volume.
    #[test]
    fn known_parts() {
        let lying = Shape::Cylinder { radius: 0.5, height: 2.0 }.submerged(DVec3::X, 0.0).unwrap();
        let pi = std::f64::consts::PI;
        assert!((lying.volume - 0.25 * pi).abs() < 1e-13);
        assert!((lying.moment + DVec3::X * (0.25 * pi) * (2.0 / (3.0 * pi))).length() < 1e-13, "{lying:?}");
        let cone = Shape::Cone { radius: 1.0, top_radius: 0.0, height: 2.0 };
        // The centre of mass of the cone is 1.5 m from its tip.
        let part = cone.submerged(DVec3::NEG_Y, -0.5).unwrap();
        assert!((part.volume - cone.volume().unwrap() / 8.0).abs() < 1e-13, "{part:?}");
        let corner = Shape::Box { size: DVec3::splat(2.0) };
        // A plane cuts off a corner of the cube with three edges of 1 m. The plane is 1/√3 m from the corner, and the corner is √3 m from
        // the centre.
        let third = 1.0 / 3.0_f64.sqrt();
        let part = corner.submerged(DVec3::splat(third), third - 3.0_f64.sqrt()).unwrap();
        assert!(
            (part.volume - 1.0 / 6.0).abs() < 1e-14
                && (part.moment + DVec3::splat(0.75 / 6.0)).length() < 1e-14
        );
    }
}

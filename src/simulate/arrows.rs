//! How long the arrows of a run are, and where they end.

use glam::{DQuat, DVec3};

use super::{BodyFrame, Bounds, Diverged, Frames};
use crate::dynamics::Shape;
use crate::scene::{Body, ForceKind, Quantity, Scene, SpringEnd};

/// The longest arrow that has no scale is so long, as a part of the size of the scene.
const LONGEST: f64 = 0.16;

/// What an arrow of a body shows, in SI units.
pub fn shown(quantity: Quantity, body: &Body, frame: &BodyFrame) -> DVec3 {
    match quantity {
        Quantity::Velocity => frame.velocity,
        Quantity::Acceleration if body.start.fixed => DVec3::ZERO,
        Quantity::Acceleration => frame.force / body.start.mass,
        Quantity::Force => frame.force,
    }
}

/// How far it is from the centre of a shape to its surface in a direction (a unit vector in world axes), m; 0 for a
/// plane.
///
/// A convex shape ends where the first of its tangent planes is met. Those are tried that matter for balls, boxes and
/// whatever is round about its y; of other shapes the result is a little too large at most.
pub fn surface(shape: &Shape, orientation: DQuat, direction: DVec3) -> f64 {
    let axis = orientation * DVec3::Y;
    let sideways = (direction - axis * axis.dot(direction)).normalize_or_zero();
    let [x, z] = [orientation * DVec3::X, orientation * DVec3::Z];
    let met = |normal: DVec3| {
        let slope = normal.dot(direction);
        (slope > 1e-9).then(|| shape.support(orientation, normal).map(|reach| reach / slope)).flatten()
    };
    let normals = [direction, sideways, axis, -axis, x, -x, z, -z];
    let nearest = normals.into_iter().filter_map(met).fold(f64::MAX, f64::min);
    if nearest < f64::MAX { nearest } else { 0.0 }
}

/// Where an arrow for a vector begins, m: at the surface of the body, so that all of it is seen.
pub fn root(body: &Body, frame: &BodyFrame, vector: DVec3) -> DVec3 {
    let along = vector.normalize_or_zero();
    frame.location + along * surface(&body.drawn(), frame.orientation, along)
}

/// How long an axis of a body is drawn, m, if it is.
pub fn axis(body: &Body) -> Option<f64> {
    let axes = body.showing.axes?;
    let reach = |direction| body.drawn().support(DQuat::IDENTITY, direction);
    let reach = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().filter_map(reach).fold(0.0, f64::max);
    Some(axes.length.unwrap_or(2.0 * reach))
}

/// The largest of what the arrows without a scale show, for each kind.
#[derive(Default)]
pub(super) struct Largest([f64; 3]);

impl Largest {
    pub(super) fn see(&mut self, scene: &Scene, bodies: &[BodyFrame]) {
        for (body, frame) in scene.bodies.iter().zip(bodies) {
            for ((quantity, arrow), largest) in
                Quantity::ALL.into_iter().zip(body.showing.arrows).zip(&mut self.0)
            {
                if arrow.is_some_and(|arrow| arrow.scale.is_none()) {
                    *largest = largest.max(shown(quantity, body, frame).length());
                }
            }
        }
    }

    /// The length of arrows for a unit of each kind, m, in a scene of a size: 1, 2 or 5 times a power of ten.
    pub(super) fn scales(&self, size: f64) -> [f64; 3] {
        self.0.map(|largest| if largest > 0.0 { round_down(LONGEST * size / largest) } else { 1.0 })
    }
}

/// 1, 2 or 5 times a power of ten: the largest that is not larger than a positive number.
fn round_down(number: f64) -> f64 {
    let decade = libm::pow(10.0, libm::floor(libm::log10(number) + 1e-12));
    let digit = [5.0, 2.0].into_iter().find(|digit| digit * decade <= number * (1.0 + 1e-9));
    if decade.is_finite() && decade > 0.0 { digit.unwrap_or(1.0) * decade } else { 1.0 }
}

/// Whether something reaches out of the bodies of a scene.
pub(super) fn any(scene: &Scene) -> bool {
    scene
        .bodies
        .iter()
        .any(|body| body.showing.axes.is_some() || body.showing.arrows.iter().any(Option::is_some))
}

/// The points of the world that springs which are drawn are fastened to.
pub(super) fn anchors(scene: &Scene) -> impl Iterator<Item = DVec3> {
    let links = scene.forces.iter().filter_map(|force| match &force.kind {
        ForceKind::Spring { links, coil: Some(_), .. } => Some(links),
        _ => None,
    });
    links.flatten().flat_map(|link| link.between).filter_map(|end| match end {
        SpringEnd::Point(point) => Some(point),
        SpringEnd::Body(_) => None,
    })
}

/// The bounds of a run together with its arrows and axes. The run is simulated once more, since the length of arrows
/// follows from all of it.
pub(super) fn with_arrows(scene: &Scene, bounds: Bounds, scales: [f64; 3]) -> Result<Bounds, Diverged> {
    let mut all = bounds;
    for frame in Frames::without_past(scene) {
        for (body, frame) in scene.bodies.iter().zip(&frame?.bodies) {
            // What has left the picture may take its arrows along.
            if frame.location.cmplt(bounds.min).any() || frame.location.cmpgt(bounds.max).any() {
                continue;
            }
            for ((quantity, arrow), scale) in Quantity::ALL.into_iter().zip(body.showing.arrows).zip(scales) {
                let Some(arrow) = arrow else { continue };
                let vector = shown(quantity, body, frame);
                let tip = root(body, frame, vector) + vector * arrow.scale.unwrap_or(scale);
                all = all.union(Bounds { min: tip, max: tip });
            }
            if let Some(length) = axis(body) {
                for axis in glam::DMat3::from_quat(frame.orientation).to_cols_array_2d() {
                    let tip = frame.location + DVec3::from_array(axis) * length * 1.1;
                    all = all.union(Bounds { min: tip, max: tip });
                }
            }
        }
    }
    // An arrow that somebody has made endless is not followed.
    Ok(if all.min.is_finite() && all.max.is_finite() { all } else { bounds })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_are_where_they_are() {
        let beam = Shape::Box { size: DVec3::new(4.0, 0.2, 1.0) };
        let can = Shape::Cylinder { radius: 0.5, height: 2.0 };
        let slanted = DVec3::new(3.0, 4.0, 0.0) / 5.0;
        let turned = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
        for (shape, orientation, direction, distance) in [
            (Shape::Sphere { radius: 2.0 }, turned, slanted, 2.0),
            (beam.clone(), DQuat::IDENTITY, slanted, 0.125),
            (beam.clone(), DQuat::IDENTITY, DVec3::X, 2.0),
            (beam, turned, DVec3::Y, 2.0),
            (can.clone(), DQuat::IDENTITY, slanted, 0.5 / 0.6),
            (can, turned, slanted, 0.5 / 0.8),
            (Shape::Plane { normal: DVec3::Y }, DQuat::IDENTITY, DVec3::Y, 0.0),
        ] {
            let found = surface(&shape, orientation, direction);
            assert!((found - distance).abs() < 1e-9, "{shape:?} {direction}: {found}");
        }
    }

    #[test]
    fn scales_are_round() {
        for (number, round) in [(0.3, 0.2), (0.5, 0.5), (7.0, 5.0), (1.0, 1.0), (1.9e-9, 1e-9), (0.0, 1.0)] {
            assert!((round_down(number) / round - 1.0).abs() < 1e-12, "{number}");
        }
    }
}

//! Decomposes the shape of a body into base shapes.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::BaseShape;
use crate::physics::{Shape, cone_base};
use crate::scene::Color;

/// A base shape as a part of a body: it is scaled, then rotated, then moved, in body axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The base shape.
    pub form: BaseShape,
    /// The drawn length of one unit of the base shape along each of its axes, m.
    pub scale: DVec3,
    /// The position of the base shape's origin, m.
    pub location: DVec3,
    /// The rotation from the axes of the base shape to body axes.
    pub orientation: DQuat,
    /// The fixed color of the piece. `None` if it has the body's material.
    pub color: Option<Color>,
}

impl Piece {
    fn new(form: BaseShape, scale: DVec3) -> Piece {
        Piece { form, scale, location: DVec3::ZERO, orientation: DQuat::IDENTITY, color: None }
    }
}

/// Decomposes a shape into base shapes. A compound has the pieces of all its parts. A plane becomes a square of 2 m × 2 m, which the
/// renderer enlarges as needed.
#[must_use]
pub fn pieces(shape: &Shape) -> Vec<Piece> {
    let even = |form, length| vec![Piece::new(form, DVec3::splat(length))];
    match *shape {
        Shape::Sphere { radius } => even(BaseShape::BALL, radius),
        Shape::Box { size } => vec![Piece::new(BaseShape::CUBE, size / 2.0)],
        Shape::RoundedBox { size, rounding } => {
            let longest = size.max_element() / 2.0;
            let form = BaseShape::rounded_box(size / 2.0 / longest, rounding / longest);
            even(form, longest)
        }
        Shape::Cylinder { radius, height } => {
            vec![Piece::new(BaseShape::CYLINDER, DVec3::new(radius, height / 2.0, radius))]
        }
        Shape::Capsule { radius, height } => {
            let straight = (height / 2.0 / radius - 1.0).max(0.0);
            // A capsule that is as long as wide, except for rounding, is a ball.
            even(if straight < 1e-6 { BaseShape::BALL } else { BaseShape::capsule(straight) }, radius)
        }
        Shape::Cone { radius, top_radius, height } => vec![cone(radius, top_radius, height)],
        Shape::Torus { radius, tube_radius } => even(BaseShape::torus(tube_radius / radius), radius),
        Shape::Plane { normal } => {
            let orientation = DQuat::from_rotation_arc(DVec3::Y, normal);
            vec![Piece { orientation, ..Piece::new(BaseShape::PLANE, DVec3::ONE) }]
        }
        Shape::Axes { length } => axes(length),
        Shape::Compound(ref compound) => {
            let placed = compound.parts().iter().flat_map(|part| {
                pieces(&part.shape).into_iter().map(|piece| Piece {
                    location: part.location + part.orientation * piece.location,
                    orientation: part.orientation * piece.orientation,
                    ..piece
                })
            });
            placed.collect()
        }
        Shape::Mesh { ref mesh, scale } => even(BaseShape::mesh(Arc::clone(mesh)), scale),
    }
}

/// The piece for a cone or frustum. A frustum with equal radii becomes a cylinder.
fn cone(radius: f64, top_radius: f64, height: f64) -> Piece {
    let wide = radius.max(top_radius);
    let scale = DVec3::new(wide, height / 2.0, wide);
    if radius == top_radius {
        return Piece::new(BaseShape::CYLINDER, scale);
    }
    Piece::new(BaseShape::cone(radius / wide, top_radius / wide), scale)
}

/// The colors of the ball at the center of an axes triad, and of its arms along x, y and z. They equal those in `templates/axes.inc`.
const AXES: [Color; 4] =
    [Color([0.82, 0.81, 0.79]), Color([0.8, 0.1, 0.12]), Color([0.1, 0.54, 0.2]), Color([0.14, 0.3, 0.82])];

/// The axes triad of `templates/axes.inc` without its letters: a ball, and for each arm a cylinder and a cone.
fn axes(length: f64) -> Vec<Piece> {
    let [middle, arms @ ..] = AXES;
    let mut pieces =
        vec![Piece { color: Some(middle), ..Piece::new(BaseShape::BALL, DVec3::splat(0.055 * length)) }];
    for (axis, color) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().zip(arms) {
        let orientation = DQuat::from_rotation_arc(DVec3::Y, axis);
        let shaft = Piece::new(BaseShape::CYLINDER, DVec3::new(0.03, 0.4, 0.03) * length);
        pieces.push(Piece { location: axis * 0.4 * length, orientation, color: Some(color), ..shaft });
        let (radius, height) = (0.078 * length, 0.24 * length);
        let location = axis * (length - height - cone_base(radius, 0.0, height));
        pieces.push(Piece { location, orientation, color: Some(color), ..cone(radius, 0.0, height) });
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_the_colors_of_the_scripts() {
        let template = include_str!("../../templates/axes.inc");
        for Color([red, green, blue]) in AXES {
            let color = format!("color srgb <{red}, {green}, {blue}>");
            assert!(template.contains(&color), "{color}");
        }
    }
}

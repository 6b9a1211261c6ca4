//! Writes lengths, vectors and transforms in SDL, POV-Ray's scene description language.

use glam::{DMat3, DQuat, DVec3};

use super::number;
use crate::scene::SdlPiece;

/// The smallest distance between two points that count as different, POV-Ray units. The limit of POV-Ray's parser is 10⁻¹⁰.
const MIN_POINT_DISTANCE: f64 = 1e-8;

/// The unit and precision of numbers in the scripts of a scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    /// The length of one POV-Ray unit, m.
    pub(super) unit: f64,
    /// The number of significant digits.
    pub(super) digits: usize,
}

impl Style {
    /// Appends a length in POV-Ray units.
    pub(super) fn length(&self, out: &mut String, metres: f64) {
        number::write(out, metres / self.unit, self.digits);
    }

    /// Appends a number as it is.
    pub(super) fn number(&self, out: &mut String, value: f64) {
        number::write(out, value, self.digits);
    }

    /// Appends a point in POV-Ray units: `<24, 17.99, 0>`.
    pub(super) fn point(&self, out: &mut String, metres: DVec3) {
        self.vector(out, metres / self.unit);
    }

    /// Appends a vector as it is, without a conversion of units.
    pub(super) fn vector(&self, out: &mut String, vector: DVec3) {
        out.push('<');
        number::write(out, vector.x, self.digits);
        out.push_str(", ");
        number::write(out, vector.y, self.digits);
        out.push_str(", ");
        number::write(out, vector.z, self.digits);
        out.push('>');
    }

    /// Appends the transform from body axes to world axes. POV-Ray multiplies row vectors, so the rows in the script are the columns of
    /// the rotation, and the last row is the translation.
    pub(super) fn matrix(&self, out: &mut String, orientation: DQuat, location: DVec3) {
        self.scaled_matrix(out, orientation, location, 1.0);
    }

    /// Appends the same transform of a body that is drawn `scale` times as large.
    pub(super) fn scaled_matrix(&self, out: &mut String, orientation: DQuat, location: DVec3, scale: f64) {
        let rotation = DMat3::from_quat(orientation) * scale;
        out.push_str("matrix <");
        for column in [rotation.x_axis, rotation.y_axis, rotation.z_axis] {
            for entry in column.to_array() {
                // A rounding error in place of a zero would be the longest number of the line.
                let entry = if entry.abs() < 1e-12 { 0.0 } else { entry };
                number::write(out, entry, self.digits);
                out.push_str(", ");
            }
        }
        let location = (location / self.unit).to_array();
        for (i, entry) in location.into_iter().enumerate() {
            number::write(out, entry, self.digits);
            out.push_str(if i < 2 { ", " } else { ">" });
        }
    }

    /// Returns true if the coordinates of a point are finite in POV-Ray units.
    pub(super) fn can_write(&self, metres: DVec3) -> bool {
        (metres / self.unit).is_finite()
    }

    /// Returns true if the coordinates of two points are finite in POV-Ray units, and the points are far enough apart for POV-Ray. The
    /// limit for the distance is so large that POV-Ray does not treat lengths some hundred times smaller as zero either.
    pub(super) fn can_tell(&self, from: DVec3, to: DVec3) -> bool {
        let written = |point: DVec3| {
            let mut out = String::new();
            self.point(&mut out, point);
            out
        };
        self.can_write(from)
            && self.can_write(to)
            && (to - from).length() / self.unit > MIN_POINT_DISTANCE
            && written(from) != written(to)
    }
}

/// Returns the scene's own SDL if it is the same in all scripts. `None` if there is none, or if it contains values.
pub(super) fn constant(pieces: &[SdlPiece]) -> Option<String> {
    let code = |piece: &SdlPiece| match piece {
        SdlPiece::Sdl(code) => Some(code.clone()),
        SdlPiece::Value { .. } => None,
    };
    let code: Option<String> = pieces.iter().map(code).collect();
    code.filter(|_| !pieces.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y() {
        let style = Style { unit: 1.0, digits: 9 };
        let mut out = String::new();
        style.matrix(&mut out, DQuat::from_rotation_z(90f64.to_radians()), DVec3::new(1.0, 2.0, 3.0));
        // The first row is the image of the x axis.
        assert_eq!(out, "matrix <0, 1, 0, -1, 0, 0, 0, 0, 1, 1, 2, 3>");
    }

    #[test]
    fn places_that_povray_takes_for_one_are_told() {
        let style = |digits: usize| Style { unit: 0.1, digits };
        let far = DVec3::new(1000.0, 0.0, 0.0);
        assert!(style(9).can_tell(far, far + DVec3::X * 1e-3));
        assert!(!style(4).can_tell(far, far + DVec3::X * 1e-3), "both are 10000");
        assert!(!style(9).can_tell(far, far + DVec3::X * f64::INFINITY));
        assert!(!style(9).can_tell(DVec3::ZERO, DVec3::X * 1e-10));
    }

    #[test]
    fn lengths_are_in_units() {
        let style = Style { unit: 0.01, digits: 9 };
        let mut out = String::new();
        style.point(&mut out, DVec3::new(0.24, -0.1, -0.0));
        assert_eq!(out, "<24, -10, 0>");
    }
}

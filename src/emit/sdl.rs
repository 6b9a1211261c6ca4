//! Vectors and transforms in POV-Ray's words.

use glam::{DMat3, DQuat, DVec3};

use super::number;

/// Two places that are nearer are one to POV-Ray's parser, in its units; its own limit is 10⁻¹⁰.
const NEAREST: f64 = 1e-8;

/// How lengths and numbers are written in one scene's scripts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    /// The length of one unit of POV-Ray's, m.
    pub(super) unit: f64,
    /// Significant digits.
    pub(super) digits: usize,
}

impl Style {
    /// Appends a length in POV-Ray's units.
    pub(super) fn length(&self, out: &mut String, metres: f64) {
        number::write(out, metres / self.unit, self.digits);
    }

    /// Appends a point in POV-Ray's units: `<24, 17.99, 0>`.
    pub(super) fn point(&self, out: &mut String, metres: DVec3) {
        self.vector(out, metres / self.unit);
    }

    /// Appends a vector without a unit.
    pub(super) fn vector(&self, out: &mut String, vector: DVec3) {
        out.push('<');
        number::write(out, vector.x, self.digits);
        out.push_str(", ");
        number::write(out, vector.y, self.digits);
        out.push_str(", ");
        number::write(out, vector.z, self.digits);
        out.push('>');
    }

    /// Appends the transform `world_from_body`. POV-Ray multiplies row vectors, so the rows that it reads are the
    /// columns of the rotation, and the last is the translation.
    pub(super) fn matrix(&self, out: &mut String, orientation: DQuat, location: DVec3) {
        let rotation = DMat3::from_quat(orientation);
        out.push_str("matrix <");
        for column in [rotation.x_axis, rotation.y_axis, rotation.z_axis] {
            for entry in column.to_array() {
                // A zero with a rounding error would be the longest number of the line.
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

    /// Whether a place can be written: in units, it is a finite number.
    pub(super) fn can_write(&self, metres: DVec3) -> bool {
        (metres / self.unit).is_finite()
    }

    /// Whether two places can be written, and POV-Ray takes them for two: in units they are finite, and so far apart
    /// that also what is some hundred times smaller than their distance is not nothing.
    pub(super) fn can_tell(&self, from: DVec3, to: DVec3) -> bool {
        let written = |point: DVec3| {
            let mut out = String::new();
            self.point(&mut out, point);
            out
        };
        self.can_write(from)
            && self.can_write(to)
            && (to - from).length() / self.unit > NEAREST
            && written(from) != written(to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y() {
        let style = Style { unit: 1.0, digits: 9 };
        let mut out = String::new();
        style.matrix(&mut out, DQuat::from_rotation_z(90f64.to_radians()), DVec3::new(1.0, 2.0, 3.0));
        // The first row is the image of x.
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

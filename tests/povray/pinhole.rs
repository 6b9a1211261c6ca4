//! A pinhole camera for tests. It predicts where POV-Ray must draw a point.

use glam::{DVec2, DVec3};

/// A pinhole camera in a right-handed coordinate system with y up.
pub(crate) struct Pinhole {
    pub(crate) location: DVec3,
    pub(crate) look_at: DVec3,
    /// The horizontal angle of view, degrees.
    pub(crate) angle: f64,
    /// The direction that appears upward in the picture, as far as it is perpendicular to the line of sight.
    pub(crate) up: DVec3,
    /// The width and the height of the picture, pixels.
    pub(crate) size: [u32; 2],
}

/// The size of most test images, pixels.
pub(crate) const SIZE: [u32; 2] = [160, 100];

impl Pinhole {
    /// Returns a camera with an angle of view of 40° for images of [`SIZE`].
    pub(crate) fn new(location: [f64; 3], look_at: [f64; 3]) -> Pinhole {
        let (location, look_at) = (DVec3::from_array(location), DVec3::from_array(look_at));
        Pinhole { location, look_at, angle: 40.0, up: DVec3::Y, size: SIZE }
    }

    /// Returns the camera as TOML for a scene.
    pub(crate) fn toml(&self) -> String {
        let Pinhole { location, look_at, angle, .. } = self;
        format!("\n[camera]\nlocation = {location}\nlook_at = {look_at}\nangle = {angle}\n")
    }

    /// Returns the position of a point in the picture, in pixels from the upper left corner.
    pub(crate) fn sees(&self, point: DVec3) -> DVec2 {
        let forward = (self.look_at - self.location).normalize();
        let right = forward.cross(self.up).normalize();
        let up = right.cross(forward);
        let offset = point - self.location;
        let [width, height] = self.size.map(f64::from);
        let pixels_per_slope = width / 2.0 / libm::tan(self.angle.to_radians() / 2.0);
        let slope = DVec2::new(offset.dot(right), -offset.dot(up)) / offset.dot(forward);
        DVec2::new(width, height) / 2.0 + slope * pixels_per_slope
    }
}

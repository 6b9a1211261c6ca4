//! The image plane of a camera. Texts are placed on this plane: they face the viewer, and no body covers them.

use glam::DVec3;

/// The distance of the image plane from the camera, relative to the distance of the camera's aim.
const IMAGE_PLANE_DISTANCE: f64 = 0.01;

/// The image plane of a camera. On the plane, x goes from -1 at the left edge of the picture to 1 at the right edge. y is 0 in the middle,
/// and has the same scale.
#[derive(Clone, Copy, Debug)]
pub struct Screen {
    location: DVec3,
    right: DVec3,
    up: DVec3,
    back: DVec3,
    /// The distance of the plane from the camera, m.
    depth: f64,
    /// Half the width of the visible part of the plane, m.
    half: f64,
    /// The tangent of half the horizontal field of view. `None` for parallel rays.
    slope: Option<f64>,
    /// How far the middle of the picture lies to the left of the camera's straight line, relative to the distance. 0 unless the camera is one
    /// of two eyes.
    aside: f64,
}

/// The image of a point on the image plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenPoint {
    /// The horizontal position: -1 at the left edge of the picture, 1 at the right edge.
    pub x: f64,
    /// The vertical position: 0 in the middle, in the same scale as `x`.
    pub y: f64,
    /// The drawn length of one meter at the depth of the point.
    pub scale: f64,
}

impl Screen {
    /// Creates the image plane of a camera at `location` that looks at `look_at`. The direction `sky` points up; `None` for an upright camera.
    /// The view is limited by the tangent `slope` of half its angle or, for parallel rays, by a width (m). `sharp` is the point in focus; with depth of field, the plane must be at its depth.
    pub(super) fn new(
        location: DVec3,
        look_at: DVec3,
        sky: Option<DVec3>,
        (slope, width): (Option<f64>, f64),
        sharp: Option<DVec3>,
    ) -> Screen {
        let back = (location - look_at).normalize_or(DVec3::Z);
        // A camera that looks straight up or down has the same orientation as in [`Placed`](super::Placed).
        let vertical = back.x.abs().max(back.z.abs()) < 1e-6 * back.y.abs();
        let right = match sky {
            Some(sky) => sky.cross(back).normalize_or(DVec3::X),
            None if vertical => DVec3::X,
            None => DVec3::Y.cross(back).normalize_or(DVec3::X),
        };
        let depth = match sharp {
            Some(point) => (location - point).dot(back),
            None => IMAGE_PLANE_DISTANCE * location.distance(look_at),
        };
        let half = slope.map_or(width / 2.0, |slope| slope * depth);
        let up = back.cross(right).normalize_or(DVec3::Y);
        Screen { location, right, up, back, depth, half, slope, aside: 0.0 }
    }

    /// The image plane of one of two eyes. `aside` is the distance of the eye to the right of the middle between both, relative to the distance of
    /// the point that they look at.
    pub(super) fn of_eye(self, aside: f64) -> Screen {
        Screen { aside, ..self }
    }

    /// The point in the middle of the plane, in the world, m.
    pub fn middle(&self) -> DVec3 {
        self.location - self.back * self.depth - self.right * (self.aside * self.depth)
    }

    /// The unit vectors of the plane in the world, m: to the right, up, and towards the viewer. Their length is half the width of the
    /// plane.
    pub fn axes(&self) -> [DVec3; 3] {
        [self.right * self.half, self.up * self.half, self.back * self.half]
    }

    /// Projects a point in the world onto the plane. `None` if the point is not in front of the camera.
    pub fn project(&self, point: DVec3) -> Option<ScreenPoint> {
        let offset = point - self.location;
        let depth = -offset.dot(self.back);
        let half = match self.slope {
            Some(slope) => slope * depth,
            None => self.half,
        };
        let projected = ScreenPoint {
            x: (offset.dot(self.right) + self.aside * depth) / half,
            y: offset.dot(self.up) / half,
            scale: 1.0 / half,
        };
        (depth > 0.0 && projected.x.is_finite() && projected.y.is_finite()).then_some(projected)
    }

    /// The ray from the viewer through a point on the plane: its origin, m, and its direction. The component of the direction along the
    /// line of sight is 1.
    pub(super) fn ray(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let aside = self.right * x + self.up * y;
        match self.slope {
            Some(slope) => (self.location, aside * slope - self.back - self.right * self.aside),
            None => (self.location + aside * self.half, -self.back),
        }
    }

    /// The direction in the world that points up in the picture.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// The direction in the world that points right in the picture.
    pub fn right(&self) -> DVec3 {
        self.right
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_looked_at_is_in_the_middle_and_edges_are_at_1() {
        let screen = Screen::new(DVec3::new(0.0, 0.0, 10.0), DVec3::ZERO, None, (Some(0.5), 0.0), None);
        assert_eq!(screen.project(DVec3::ZERO), Some(ScreenPoint { x: 0.0, y: 0.0, scale: 0.2 }));
        let edge = screen.project(DVec3::new(5.0, -2.0, 0.0)).unwrap();
        assert!((edge.x - 1.0).abs() < 1e-12 && (edge.y + 0.4).abs() < 1e-12);
        assert_eq!(screen.project(DVec3::new(0.0, 0.0, 11.0)), None);
    }

    #[test]
    fn parallel_rays_show_everything_in_one_size() {
        let screen = Screen::new(DVec3::new(0.0, 9.0, 0.0), DVec3::ZERO, None, (None, 4.0), None);
        for height in [-5.0, 0.0, 5.0] {
            let projected = screen.project(DVec3::new(1.0, height, 1.0)).unwrap();
            assert!((projected.x - 0.5).abs() < 1e-12 && (projected.y + 0.5).abs() < 1e-12, "{projected:?}");
        }
    }

    #[test]
    fn a_ray_through_a_place_is_seen_there() {
        for slope in [Some(0.5), None] {
            let screen = Screen::new(DVec3::new(3.0, 4.0, 10.0), DVec3::ZERO, None, (slope, 4.0), None);
            let (origin, direction) = screen.ray(0.7, -0.3);
            for far in [5.0, 40.0] {
                let projected = screen.project(origin + direction * far).unwrap();
                assert!(
                    (projected.x - 0.7).abs() < 1e-12 && (projected.y + 0.3).abs() < 1e-12,
                    "{projected:?}"
                );
            }
        }
    }
}

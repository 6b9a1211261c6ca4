//! The plane before a camera on which texts stand: they face the viewer, are as large wherever they are, and nothing
//! of the scene is in front of them.

use glam::DVec3;

/// The distance of the plane before the camera, as part of the distance to the point it looks at.
const NEAR: f64 = 0.01;

/// The plane before a camera. On it, x goes from -1 at the left edge of the picture to 1 at the right one; y has the
/// same scale, and 0 in the middle.
#[derive(Clone, Copy, Debug)]
pub struct Screen {
    location: DVec3,
    right: DVec3,
    up: DVec3,
    back: DVec3,
    /// The distance of the plane from the camera, m.
    depth: f64,
    /// Half the width of the plane, m.
    half: f64,
    /// The tangent of half the horizontal field of view; none without perspective.
    slope: Option<f64>,
}

/// A place on the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// How far to the right of the middle.
    pub x: f64,
    /// How far above the middle.
    pub y: f64,
    /// How large a metre is there.
    pub metre: f64,
}

impl Screen {
    /// The plane of a camera at a location that looks at a point, and sees all that is within a slope, or a width of
    /// parallel rays. `sharp` is the distance at which everything is sharp, if not everywhere: there the plane must be.
    pub(super) fn new(
        location: DVec3,
        look_at: DVec3,
        slope: Option<f64>,
        width: f64,
        sharp: Option<DVec3>,
    ) -> Screen {
        let back = (location - look_at).normalize_or(DVec3::Z);
        // As [`Placed`](super::Placed) says which way is up when it looks straight down.
        let vertical = back.x.abs().max(back.z.abs()) < 1e-6 * back.y.abs();
        let right = if vertical { DVec3::X } else { DVec3::Y.cross(back).normalize_or(DVec3::X) };
        let depth = match sharp {
            Some(point) => (location - point).dot(back),
            None => NEAR * location.distance(look_at),
        };
        let half = slope.map_or(width / 2.0, |slope| slope * depth);
        Screen { location, right, up: back.cross(right).normalize_or(DVec3::Y), back, depth, half, slope }
    }

    /// The point of the world that is in the middle of the plane, m.
    pub fn middle(&self) -> DVec3 {
        self.location - self.back * self.depth
    }

    /// What 1 to the right, up, and towards the viewer on the plane is in the world, m.
    pub fn axes(&self) -> [DVec3; 3] {
        [self.right * self.half, self.up * self.half, self.back * self.half]
    }

    /// Where on the plane a point of the world is seen; none if it is not before the camera.
    pub fn spot(&self, point: DVec3) -> Option<Spot> {
        let offset = point - self.location;
        let depth = -offset.dot(self.back);
        let half = match self.slope {
            Some(slope) => slope * depth,
            None => self.half,
        };
        let spot =
            Spot { x: offset.dot(self.right) / half, y: offset.dot(self.up) / half, metre: 1.0 / half };
        (depth > 0.0 && spot.x.is_finite() && spot.y.is_finite()).then_some(spot)
    }

    /// The ray through a place on the plane: a point of it, m, and its direction, of which the part straight away from
    /// the viewer is 1.
    pub(super) fn ray(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let aside = self.right * x + self.up * y;
        match self.slope {
            Some(slope) => (self.location, aside * slope - self.back),
            None => (self.location + aside * self.half, -self.back),
        }
    }

    /// The direction in the world that is up in the picture.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// The direction in the world that is right in the picture.
    pub fn right(&self) -> DVec3 {
        self.right
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_looked_at_is_in_the_middle_and_edges_are_at_1() {
        let screen = Screen::new(DVec3::new(0.0, 0.0, 10.0), DVec3::ZERO, Some(0.5), 0.0, None);
        assert_eq!(screen.spot(DVec3::ZERO), Some(Spot { x: 0.0, y: 0.0, metre: 0.2 }));
        let edge = screen.spot(DVec3::new(5.0, -2.0, 0.0)).unwrap();
        assert!((edge.x - 1.0).abs() < 1e-12 && (edge.y + 0.4).abs() < 1e-12);
        assert_eq!(screen.spot(DVec3::new(0.0, 0.0, 11.0)), None);
    }

    #[test]
    fn parallel_rays_show_everything_in_one_size() {
        let screen = Screen::new(DVec3::new(0.0, 9.0, 0.0), DVec3::ZERO, None, 4.0, None);
        for height in [-5.0, 0.0, 5.0] {
            let spot = screen.spot(DVec3::new(1.0, height, 1.0)).unwrap();
            assert!((spot.x - 0.5).abs() < 1e-12 && (spot.y + 0.5).abs() < 1e-12, "{spot:?}");
        }
    }

    #[test]
    fn a_ray_through_a_place_is_seen_there() {
        for slope in [Some(0.5), None] {
            let screen = Screen::new(DVec3::new(3.0, 4.0, 10.0), DVec3::ZERO, slope, 4.0, None);
            let (origin, direction) = screen.ray(0.7, -0.3);
            for far in [5.0, 40.0] {
                let spot = screen.spot(origin + direction * far).unwrap();
                assert!((spot.x - 0.7).abs() < 1e-12 && (spot.y + 0.3).abs() < 1e-12, "{spot:?}");
            }
        }
    }
}

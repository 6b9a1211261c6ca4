//! Chooses the position of a camera for which the scene gives none.

use glam::{DQuat, DVec3};

use super::direction_hints::DirectionHints;
use crate::decimal::decimal_step;
use crate::scene::Output;
use crate::simulate::Bounds;

/// The components of the direction from the motion to the camera: mainly forward, a little sideways, and a little upward.
const FORWARD_COMPONENT: f64 = 1.0;
const SIDEWAYS_COMPONENT: f64 = 0.16;
const UPWARD_COMPONENT: f64 = 0.11;
/// The upward component of the direction to the camera if the ground has numbers, which are read from above.
const ABOVE_GRID: f64 = 0.36;
/// The upward component of the direction to the camera for flat motion: a circle on the ground is seen as an ellipse, and not edge-on.
const HIGH_ABOVE: f64 = 0.7;
/// The smallest upward component for long flat motion of small bodies on the ground, such as a ball and pins on a lane. The picture then
/// shows the horizon.
const LOW_ABOVE: f64 = 0.15;
/// Motion is long if its depth is below this fraction of its width across the picture.
const LONG_MOTION_RATIO: f64 = 2.0 / 3.0;
/// For long flat motion, the camera is so high that the depth of the motion is drawn at least this many times as high as the largest body
/// is wide. The bodies in front then hide few of those behind.
const CLEAR_DEPTH: f64 = 1.5;

/// Chooses the direction from the middle of the motion towards a camera without a given position. The camera faces the plane of the
/// motion: usually from the front, along x for motion in y and z, from above for motion in x and z. It also faces a
/// coordinate plane with numbers. If the ground has numbers, the camera
/// is somewhat higher. For a long lane or road with small bodies, it is low.
pub(super) fn towards_camera(moving: Bounds, sight: DirectionHints) -> DVec3 {
    let extent = moving.max - moving.min;
    let from_the_side = sight.along_x.unwrap_or(extent.z > 2.0 * extent.x);
    let (across, depth) = if from_the_side { (extent.z, extent.x) } else { (extent.x, extent.z) };
    let is_flat = depth > 1.5 * extent.y && depth > (0.25 * across).min(4.0 * extent.y);
    let above = match (is_flat, sight) {
        (true, DirectionHints { reads_ground: false, on_ground: Some(width), .. })
            if depth < LONG_MOTION_RATIO * across =>
        {
            (CLEAR_DEPTH * width / depth).clamp(LOW_ABOVE, HIGH_ABOVE)
        }
        (true, _) => HIGH_ABOVE,
        (false, DirectionHints { reads_ground: true, .. }) => ABOVE_GRID,
        (false, _) => UPWARD_COMPONENT,
    };
    if from_the_side {
        DVec3::new(-FORWARD_COMPONENT, above, SIDEWAYS_COMPONENT)
    } else {
        DVec3::new(SIDEWAYS_COMPONENT, above, FORWARD_COMPONENT)
    }
}

/// The largest fraction of the picture's width and height that the motion may fill.
const MAX_FILLED: f64 = 0.86;

/// The position of a camera and the point that it looks at, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Framing {
    pub(super) location: DVec3,
    pub(super) look_at: DVec3,
}

/// The field of view: the tangents of half of its horizontal and vertical angles, and the part of it that the motion may fill.
#[derive(Clone, Copy, Debug)]
pub(super) struct Field {
    pub(super) horizontal: f64,
    vertical: f64,
    free: Free,
}

/// The part of the picture that plots at its sides and labels in its corners leave free for the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Free {
    /// The middle of the free part, in half-widths of the picture: negative if plots stand at the right side.
    pub(super) center: f64,
    /// Half of its width, in half-widths of the picture.
    pub(super) half: f64,
    /// The middle of the free part above that of the picture, in half-heights of the picture: negative below labels.
    pub(super) middle: f64,
    /// Half of its height, in half-heights of the picture.
    pub(super) half_height: f64,
}

impl Free {
    /// The whole picture.
    pub(super) const ALL: Free = Free { center: 0.0, half: 1.0, middle: 0.0, half_height: 1.0 };

    /// Returns the way from the aim of a camera to what it shows in the middle of the free part, m, for a camera with this width in view
    /// (m) and these unit vectors to the right and up.
    pub(super) fn shift(self, view: f64, output: Output, (right, up): (DVec3, DVec3)) -> DVec3 {
        let height = view * f64::from(output.height) / f64::from(output.width);
        right * (self.center * view / 2.0) + up * (self.middle * height / 2.0)
    }

    /// Returns the part that is also free of what takes these fractions of the picture's height at the top and at the bottom.
    pub(super) fn between(self, [top, bottom]: [f64; 2]) -> Free {
        Free { middle: bottom - top, half_height: 1.0 - top - bottom, ..self }
    }
}

impl Field {
    /// Creates the field of view of a camera with a horizontal angle in degrees.
    pub(super) fn new(angle: f64, output: Output) -> Field {
        // An angle may reach 180°, for which no distance is large enough.
        let horizontal = libm::tan(angle.min(160.0).to_radians() / 2.0);
        Field {
            horizontal,
            vertical: horizontal * f64::from(output.height) / f64::from(output.width),
            free: Free::ALL,
        }
    }

    /// Limits the motion to a part of the picture.
    pub(super) fn within(self, free: Free) -> Field {
        Field { free, ..self }
    }
}

/// Places a perspective camera in the direction `towards` so that the bounds fill the picture. If the scene gives the aim `look_at`, only
/// the distance is chosen.
pub(super) fn perspective(
    bounds: Bounds,
    field: Field,
    look_at: Option<DVec3>,
    towards: DVec3,
    tilt: Tilt,
) -> Framing {
    let (right, up, back) = tilt.axes(towards);
    let corners = corners(bounds);
    let mut aim = look_at.unwrap_or((bounds.min + bounds.max) / 2.0);
    let mut distance = distance(&corners, aim, (right, up, back), field);
    if look_at.is_none() {
        // Near things look larger, so the center of the box is not in the middle of the picture. Shift the aim until the picture is
        // centered. Each iteration removes most of the error.
        for _ in 0..6 {
            let (x, y) = middle_of_picture(&corners, aim, (right, up, back), distance);
            let (across, upward) = (field.free.center * field.horizontal, field.free.middle * field.vertical);
            aim += (right * (x - across) + up * (y - upward)) * distance;
            distance = self::distance(&corners, aim, (right, up, back), field);
        }
    }
    // If a given aim lies far in front of the bounds, even a distance of 0 shows all of them. Keep the camera away from its aim.
    let size = (bounds.max - bounds.min).length();
    rounded(aim, back, if distance > 1e-3 * size { distance } else { size })
}

/// The width in view at a point, m, that shows all of the bounds from there in the directions `axes` (right, up and back). `rays` is the
/// tangent of half of the horizontal angle. `None` for parallel rays.
pub(super) fn view_for(
    bounds: Bounds,
    aim: DVec3,
    axes: (DVec3, DVec3, DVec3),
    rays: Option<f64>,
    (output, free): (Output, Free),
) -> f64 {
    let aspect = f64::from(output.width) / f64::from(output.height);
    let corners = corners(bounds);
    match rays {
        Some(horizontal) => {
            let free = Free { center: 0.0, middle: 0.0, ..free };
            let field = Field { horizontal, vertical: horizontal / aspect, free };
            2.0 * horizontal * distance(&corners, aim, axes, field)
        }
        None => {
            let half = |corner: DVec3| {
                let offset = corner - aim;
                let [across, upward] = [axes.0, axes.1].map(|axis| offset.dot(axis).abs());
                (across / free.half).max(upward / free.half_height * aspect)
            };
            2.0 * corners.into_iter().map(half).fold(0.0, f64::max) / MAX_FILLED
        }
    }
}

/// Places an orthographic camera in the direction `towards` from its aim. Also returns the width in view that shows all of the bounds, m.
pub(super) fn orthographic(
    bounds: Bounds,
    output: Output,
    look_at: Option<DVec3>,
    (towards, tilt): (DVec3, Tilt),
    free: Free,
) -> (Framing, f64) {
    let (right, up, back) = tilt.axes(towards);
    let middle = (bounds.min + bounds.max) / 2.0;
    let aim = look_at.unwrap_or(middle);
    let width = view_for(bounds, aim, (right, up, back), None, (output, free));
    let aim = look_at.unwrap_or(aim - free.shift(width, output, (right, up)));
    // With parallel rays, the picture is the same from any distance in front of all bodies.
    let distance = 2.0 * ((bounds.max - bounds.min).length() + aim.distance((bounds.min + bounds.max) / 2.0));
    (rounded(aim, back, distance), width)
}

/// The direction that points up in the pictures of a camera.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Tilt {
    /// The direction that points up without a roll, a unit vector. `None` for the vertical.
    pub(super) up: Option<DVec3>,
    /// The angle by which the camera is turned about its line of sight, degrees: clockwise as seen from behind it.
    pub(super) roll: f64,
}

impl Tilt {
    /// Returns whether the camera is upright.
    pub(super) fn is_upright(self) -> bool {
        self == Tilt::default()
    }

    /// Turns a direction of an upright camera to the same one of a camera with this upward direction.
    pub(super) fn turned(self, direction: DVec3) -> DVec3 {
        self.up.map_or(direction, |up| DQuat::from_rotation_arc(DVec3::Y, up) * direction)
    }

    /// The unit vectors of a camera to the right, up and back, from the direction towards the camera.
    pub(super) fn axes(self, towards_camera: DVec3) -> (DVec3, DVec3, DVec3) {
        let back = towards_camera.normalize();
        // For a camera that looks straight down, the picture's upper edge points away from the viewer.
        let right = self.up.unwrap_or(DVec3::Y).cross(back).try_normalize().unwrap_or(DVec3::X);
        let up = back.cross(right);
        if self.roll == 0.0 {
            return (right, up, back);
        }
        let (sin, cos) = libm::sincos(self.roll.to_radians());
        (right * cos - up * sin, up * cos + right * sin, back)
    }
}

/// Rounds the position and the aim of a camera to about three digits of its distance.
fn rounded(aim: DVec3, back: DVec3, distance: f64) -> Framing {
    let step = decimal_step(distance) / 100.0;
    let round = |point: DVec3| (point / step).round() * step;
    Framing { location: round(aim + back * distance), look_at: round(aim) }
}

fn corners(bounds: Bounds) -> [DVec3; 8] {
    std::array::from_fn(|i| {
        let pick = |bit: usize, low: f64, high: f64| if i >> bit & 1 == 0 { low } else { high };
        DVec3::new(
            pick(0, bounds.min.x, bounds.max.x),
            pick(1, bounds.min.y, bounds.max.y),
            pick(2, bounds.min.z, bounds.max.z),
        )
    })
}

/// The smallest distance between the camera and its aim at which all corners are in view, m.
fn distance(corners: &[DVec3; 8], aim: DVec3, axes: (DVec3, DVec3, DVec3), field: Field) -> f64 {
    let (right, up, back) = axes;
    let needed = |corner: &DVec3| {
        let offset = *corner - aim;
        let Free { center, half, middle, half_height } = field.free;
        let within = |at: f64, (center, half): (f64, f64), tangent: f64| {
            let edges = [center + half * MAX_FILLED, center - half * MAX_FILLED];
            edges.map(|edge| at / (edge * tangent)).into_iter().fold(0.0, f64::max)
        };
        let across = within(offset.dot(right), (center, half), field.horizontal);
        let upward = within(offset.dot(up), (middle, half_height), field.vertical);
        across.max(upward) + offset.dot(back)
    };
    corners.iter().map(needed).fold(0.0, f64::max)
}

/// The direction to the middle of the corners, as they appear in the picture: the tangents of its horizontal and vertical angles from the
/// line of sight.
fn middle_of_picture(
    corners: &[DVec3; 8],
    aim: DVec3,
    axes: (DVec3, DVec3, DVec3),
    distance: f64,
) -> (f64, f64) {
    let (right, up, back) = axes;
    let slopes = corners.map(|corner| {
        let offset = corner - aim;
        let depth = distance - offset.dot(back);
        (offset.dot(right) / depth, offset.dot(up) / depth)
    });
    let middle = |of: fn(&(f64, f64)) -> f64| {
        let (low, high) = slopes.iter().map(of).fold((f64::MAX, f64::MIN), |(l, h), s| (l.min(s), h.max(s)));
        (low + high) / 2.0
    };
    (middle(|s| s.0), middle(|s| s.1))
}

/// Rounds bounds outward to two digits of their largest edge, so that small edits of a scene do not move its camera.
pub(crate) fn rounded_outward(bounds: Bounds) -> Bounds {
    let step = decimal_step((bounds.max - bounds.min).max_element()) / 10.0;
    // A coordinate that is a multiple of the step, except for rounding errors, is kept.
    let slack = DVec3::splat(1e-6);
    Bounds { min: (bounds.min / step + slack).floor() * step, max: (bounds.max / step - slack).ceil() * step }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UPRIGHT: Tilt = Tilt { up: None, roll: 0.0 };

    const WIDE: Output = Output {
        decimal: crate::scene::DecimalSign::Point,
        width: 1280,
        height: 720,
        layout: crate::scene::Layout::SelfContained,
        transparent: false,
        video_rate: None,
    };

    #[test]
    fn all_corners_are_in_the_picture_and_it_is_filled() {
        for bounds in [
            Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) },
            Bounds { min: DVec3::new(-2.0, 0.0, -1.0), max: DVec3::new(62.0, 52.0, 1.0) },
            Bounds { min: DVec3::new(0.0, 0.0, -40.0), max: DVec3::new(1.0, 1.0, 40.0) },
        ] {
            let field = Field::new(40.0, WIDE);
            let framing =
                perspective(bounds, field, None, towards_camera(bounds, DirectionHints::default()), UPRIGHT);
            let (right, up, back) = UPRIGHT.axes(framing.location - framing.look_at);
            let mut fullest: f64 = 0.0;
            for corner in corners(bounds) {
                let offset = corner - framing.location;
                let depth = -offset.dot(back);
                let x = offset.dot(right).abs() / depth / field.horizontal;
                let y = offset.dot(up).abs() / depth / field.vertical;
                fullest = fullest.max(x).max(y);
            }
            // The position of the camera is rounded to at most a hundredth of its distance.
            assert!((fullest - MAX_FILLED).abs() < 0.03, "{bounds:?} fills {fullest}");
        }
    }

    /// Plots at the right side take 40 % of the width, and labels at the top 20 % of the height: the corners are in the rest, and fill it.
    #[test]
    fn beside_plots_and_labels_all_corners_are_in_the_free_part() {
        let free = Free { center: -0.4, half: 0.6, ..Free::ALL }.between([0.2, 0.0]);
        assert!((free.middle + 0.2).abs() < 1e-12 && (free.half_height - 0.8).abs() < 1e-12, "{free:?}");
        for bounds in [
            Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) },
            Bounds { min: DVec3::new(-2.0, 0.0, -1.0), max: DVec3::new(62.0, 12.0, 1.0) },
        ] {
            let field = Field::new(40.0, WIDE).within(free);
            let framing =
                perspective(bounds, field, None, towards_camera(bounds, DirectionHints::default()), UPRIGHT);
            let (right, up, back) = UPRIGHT.axes(framing.location - framing.look_at);
            let (flat, width) = orthographic(
                bounds,
                WIDE,
                None,
                (towards_camera(bounds, DirectionHints::default()), UPRIGHT),
                free,
            );
            let mut fullest = [0.0_f64; 2];
            for corner in corners(bounds) {
                let offset = corner - framing.location;
                let depth = -offset.dot(back);
                let across = offset.dot(right) / depth / field.horizontal;
                let upward = offset.dot(up) / depth / field.vertical;
                let filled = |across: f64, upward: f64| {
                    let across = (across - free.center).abs() / free.half;
                    across.max((upward - free.middle).abs() / free.half_height)
                };
                fullest[0] = fullest[0].max(filled(across, upward));
                let offset = (corner - flat.look_at) / (width / 2.0);
                fullest[1] = fullest[1].max(filled(offset.dot(right), offset.dot(up) * 1280.0 / 720.0));
            }
            for fullest in fullest {
                assert!((fullest - MAX_FILLED).abs() < 0.05, "{bounds:?} fills {fullest}");
            }
        }
    }

    #[test]
    fn without_perspective_all_corners_are_in_the_picture_too() {
        let bounds = Bounds { min: DVec3::new(-2.0, 0.0, -1.0), max: DVec3::new(62.0, 52.0, 1.0) };
        for towards in
            [towards_camera(bounds, DirectionHints::default()), DVec3::Y, DVec3::Z, DVec3::new(1.0, 1.0, 1.0)]
        {
            let (framing, width) = orthographic(bounds, WIDE, None, (towards, UPRIGHT), Free::ALL);
            let (right, up, _) = UPRIGHT.axes(towards);
            let mut fullest: f64 = 0.0;
            for corner in corners(bounds) {
                let offset = corner - framing.look_at;
                let upward = offset.dot(up).abs() * 1280.0 / 720.0;
                fullest = fullest.max(offset.dot(right).abs().max(upward) / (width / 2.0));
            }
            assert!((fullest - MAX_FILLED).abs() < 0.03, "{towards:?} fills {fullest}");
        }
    }

    #[test]
    fn the_camera_looks_onto_the_plane_in_which_most_happens() {
        let towards = |size: [f64; 3]| {
            let half = DVec3::from_array(size) / 2.0;
            towards_camera(Bounds { min: -half, max: half }, DirectionHints::default()).to_array()
        };
        let front = [SIDEWAYS_COMPONENT, UPWARD_COMPONENT, FORWARD_COMPONENT];
        for size in [[9.0, 5.0, 1.0], [1.0, 1.0, 1.0], [5.0, 3.0, 3.0], [100.0, 0.8, 1.2], [0.2, 100.0, 0.2]]
        {
            assert_eq!(towards(size), front, "{size:?}");
        }
        let cube = Bounds { min: DVec3::ZERO, max: DVec3::ONE };
        let numbers = DirectionHints { reads_ground: true, ..DirectionHints::default() };
        assert_eq!(
            towards_camera(cube, numbers).to_array(),
            [SIDEWAYS_COMPONENT, ABOVE_GRID, FORWARD_COMPONENT]
        );
        assert_eq!(towards([4.0, 0.2, 4.0]), [SIDEWAYS_COMPONENT, HIGH_ABOVE, FORWARD_COMPONENT]);
        assert_eq!(towards([10.0, 0.2, 1.5]), [SIDEWAYS_COMPONENT, HIGH_ABOVE, FORWARD_COMPONENT]);
        assert_eq!(towards([0.5, 6.0, 20.0]), [-FORWARD_COMPONENT, UPWARD_COMPONENT, SIDEWAYS_COMPONENT]);
        assert_eq!(towards([2.0, 0.1, 20.0]), [-FORWARD_COMPONENT, HIGH_ABOVE, SIDEWAYS_COMPONENT]);
    }

    /// A lane of 10 m by 3 m. From a low camera, small bodies hide few of those behind; large bodies need a higher camera.
    #[test]
    fn the_camera_is_low_above_a_lane_with_small_bodies() {
        let above = |size: [f64; 3], width: f64| {
            let half = DVec3::from_array(size) / 2.0;
            let sight = DirectionHints { on_ground: Some(width), ..DirectionHints::default() };
            towards_camera(Bounds { min: -half, max: half }, sight).y
        };
        assert_eq!(above([10.0, 0.4, 3.0], 0.1), LOW_ABOVE);
        assert!((above([10.0, 0.4, 3.0], 0.8) - 0.4).abs() < 1e-12);
        assert!((above([3.0, 0.4, 10.0], 0.8) - 0.4).abs() < 1e-12, "from the side");
        assert_eq!(above([10.0, 0.4, 3.0], 4.0), HIGH_ABOVE);
        assert_eq!(above([10.0, 0.4, 8.0], 0.1), HIGH_ABOVE, "a table is not long");
        assert_eq!(above([10.0, 5.0, 1.0], 0.1), UPWARD_COMPONENT, "a wall is not flat");
    }

    #[test]
    fn bounds_are_rounded_outward_to_two_digits() {
        let bounds = Bounds { min: DVec3::new(-0.3, 0.0, -2.0), max: DVec3::new(61.2, 52.0, 2.0) };
        let rounded = rounded_outward(bounds);
        assert_eq!(rounded.min, DVec3::new(-1.0, 0.0, -2.0));
        assert_eq!(rounded.max, DVec3::new(62.0, 52.0, 2.0));
    }

    #[test]
    fn the_camera_stands_in_front_of_an_aim_that_is_in_front_of_everything() {
        let bounds = Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) };
        let towards = DVec3::new(1.0, 1.0, 4.0);
        let (right, up, back) = UPRIGHT.axes(towards);
        let field = Field::new(60.0, WIDE);
        let aim = back * 9000.0;
        assert_eq!(distance(&corners(bounds), aim, (right, up, back), field), 0.0, "every distance will do");
        let framing = perspective(bounds, field, Some(aim), towards, UPRIGHT);
        let size = (bounds.max - bounds.min).length();
        let ahead = (framing.location - framing.look_at).dot(back);
        assert!((ahead / size - 1.0).abs() < 0.02, "{framing:?}");
    }
}

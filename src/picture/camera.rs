//! The camera of a run: given by the scene, or chosen to fit the motion.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::followed::FollowedValues;
use super::framing::{self, Field, Framing, Free, Tilt};
use super::labels;
use super::screen::Screen;
use super::track::Track;
use crate::scene::{Blur, Body, Camera, MeasureFormula, Output, Projection, Scene, VaryingPoint};
use crate::simulate::{Bounds, Frame};

/// The default distance between a camera and the body that it follows, in half-widths of the body. The body then fills an eighth of the
/// picture.
const USUAL_DISTANCE: f64 = 22.0;

/// A camera at one moment, with its position, aim and projection. Lengths are in meters.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    location: DVec3,
    look_at: DVec3,
    lens: Lens,
    tilt: Tilt,
    blur: Option<Blur>,
    output: Output,
    /// The part of the picture that plots and labels leave free.
    free: Free,
    /// The distance of the eye to the right of `location`, m.
    eye: f64,
}

/// The projection of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// A perspective projection: distant things look smaller.
    Perspective {
        /// The horizontal field of view, degrees.
        angle: f64,
    },
    /// A projection by parallel rays, as in a technical drawing.
    Orthographic {
        /// The width in view, m.
        width: f64,
    },
    /// A picture of all directions: 360° wide and 180° high. It is level: the camera's upward direction is in the middle of the upper edge.
    Spherical,
}

impl Lens {
    /// The horizontal angle of the part of a spherical picture that is framed, and on which labels lie, degrees: about what a 360° viewer
    /// shows at once.
    pub const SPHERICAL_WINDOW_ANGLE: f64 = 90.0;
}

impl Placed {
    /// Places a camera. If the scene gives no position, the camera looks at the bounds from the direction `towards`, at the distance that
    /// shows all of the bounds.
    fn new(camera: &Camera, bounds: Bounds, towards: DVec3, scene: &Scene) -> Placed {
        let output = scene.output;
        let tilt = Tilt { up: camera.up, roll: camera.roll };
        let towards = tilt.turned(towards);
        // A camera that is placed or moved by the scene keeps what it looks at in the middle.
        let is_free = camera.location.is_none() && camera.look_at.is_none() && !camera.motion.moves();
        let free = if is_free { labels::free(scene) } else { Free::ALL };
        let (lens, auto) = match camera.projection {
            Projection::Perspective { angle } => {
                let field = Field::new(angle, output).within(free);
                (
                    Lens::Perspective { angle },
                    framing::perspective(bounds, field, camera.look_at, towards, tilt),
                )
            }
            Projection::Orthographic { width } => {
                let given = camera.location.zip(camera.look_at).map(|(location, look_at)| location - look_at);
                let towards = given.unwrap_or(towards);
                let (auto, seen) =
                    framing::orthographic(bounds, output, camera.look_at, (towards, tilt), free);
                (Lens::Orthographic { width: width.unwrap_or(seen) }, auto)
            }
            Projection::Spherical => {
                let field = Field::new(Lens::SPHERICAL_WINDOW_ANGLE, output).within(free);
                (Lens::Spherical, framing::perspective(bounds, field, camera.look_at, towards, tilt))
            }
        };
        let location = camera.location.unwrap_or(auto.location);
        let look_at = camera.look_at.unwrap_or_else(|| aim(location, auto));
        let eye = camera.eye;
        Placed { location, look_at, lens, tilt, blur: camera.blur, output, free, eye }.leveled()
    }

    /// The camera at a time (s). The followed body has the half-width `size` (m). It was at `start` in the first frame, and is at `here`
    /// now. `value` returns the value of a formula of measures at that time.
    fn moved(
        &self,
        camera: &Camera,
        size: f64,
        [start, here]: [DVec3; 2],
        time: f64,
        value: impl Fn(&MeasureFormula) -> f64,
    ) -> Placed {
        let motion = &camera.motion;
        let mut location =
            motion.location.as_ref().map_or(self.location, |location| location.at(time, &value));
        let mut look_at = motion.look_at.as_ref().map_or(self.look_at, |look_at| look_at.at(time, &value));
        if let Some(follow) = motion.follow {
            let away = if camera.location.is_some() { location - start } else { location - look_at };
            let usual = if camera.location.is_some() { away.length() } else { USUAL_DISTANCE * size };
            look_at = here;
            location = here + away.normalize_or(DVec3::Z) * follow.distance.unwrap_or(usual);
        }
        if let Some(period) = motion.orbit {
            let angle = std::f64::consts::TAU * time / period;
            let turn = match self.tilt.up {
                Some(up) => DQuat::from_axis_angle(up, angle),
                None => DQuat::from_rotation_y(angle),
            };
            location = look_at + turn * (location - look_at);
        }
        // A camera at the point that it looks at has no direction, so keep its initial direction.
        if location.distance(look_at) <= 1e-6 * self.location.distance(self.look_at) {
            look_at = location + (self.look_at - self.location);
        }
        let lens = match (self.lens, &motion.angle) {
            (Lens::Perspective { .. }, Some(angle)) => {
                Lens::Perspective { angle: angle.at(time, &value).clamp(0.1, 179.9) }
            }
            (lens, _) => lens,
        };
        let roll = motion.roll.as_ref().map_or(self.tilt.roll, |roll| roll.at(time, &value));
        Placed { location, look_at, lens, tilt: Tilt { roll, ..self.tilt }, ..*self }.leveled()
    }

    /// The camera with a level line of sight, if its pictures are spherical. In a 360° viewer, verticals then stay vertical all around.
    fn leveled(self) -> Placed {
        if self.lens != Lens::Spherical {
            return self;
        }
        let up = self.tilt.up.unwrap_or(DVec3::Y);
        let sight = self.look_at - self.location;
        let level = sight - up * sight.dot(up);
        // A camera that looks straight up or down has the upper edge of an upright picture ahead.
        let is_vertical = level.length() <= 1e-6 * sight.length();
        let level = if is_vertical { self.tilt.turned(DVec3::NEG_Z) * sight.length() } else { level };
        Placed { look_at: self.location + level, ..self }
    }

    /// The width in view at a point, m, with which the camera shows all of the bounds if it aims at this point.
    pub(super) fn view_for(&self, bounds: Bounds, aim: DVec3) -> f64 {
        framing::view_for(bounds, aim, self.axes(), self.rays(), (self.output, self.free))
    }

    /// The camera with another aim and another width in view there, m. It keeps its direction.
    fn aimed(&self, aim: DVec3, view: f64) -> Placed {
        let (right, up, back) = self.axes();
        let look_at = aim - self.free.shift(view, self.output, (right, up));
        let (lens, distance) = match self.rays() {
            Some(slope) => (self.lens, view / (2.0 * slope)),
            None => (Lens::Orthographic { width: view }, self.location.distance(self.look_at)),
        };
        Placed { location: look_at + back * distance, look_at, lens, ..*self }.leveled()
    }

    /// The unit vectors of the camera to the right, up and back.
    fn axes(&self) -> (DVec3, DVec3, DVec3) {
        self.tilt.axes(self.location - self.look_at)
    }

    /// The tangent of half of the horizontal angle. `None` for parallel rays.
    fn rays(&self) -> Option<f64> {
        match self.lens {
            Lens::Perspective { .. } | Lens::Spherical => Some(self.half_tangent()),
            Lens::Orthographic { .. } => None,
        }
    }

    /// The tangent of half of the horizontal angle of the field of view, or of the window of a spherical picture. 0 for parallel rays.
    fn half_tangent(&self) -> f64 {
        match self.lens {
            Lens::Perspective { angle } => Field::new(angle, self.output).horizontal,
            Lens::Spherical => Field::new(Lens::SPHERICAL_WINDOW_ANGLE, self.output).horizontal,
            Lens::Orthographic { .. } => 0.0,
        }
    }

    /// The way from the middle between two eyes to the eye of this camera, m. `None` for a camera that is not one of two eyes.
    fn way_to_eye(&self) -> Option<DVec3> {
        (self.eye != 0.0).then(|| self.axes().0 * self.eye)
    }

    /// The position of the camera in the world, m.
    pub fn location(&self) -> DVec3 {
        self.way_to_eye().map_or(self.location, |way| self.location + way)
    }

    /// The point straight ahead of the camera, m: what it looks at, in the middle of the picture. Two eyes look at two points; see
    /// [`Placed::shear`].
    pub fn look_at(&self) -> DVec3 {
        self.way_to_eye().map_or(self.look_at, |way| self.look_at + way)
    }

    /// The shear that moves the point straight ahead of one of two eyes to the point that both look at, which is in the middle of the
    /// picture: it moves a point by this vector for each meter behind the camera, and leaves the plane of the camera where it is. So both
    /// eyes see what is at the distance of this point at the same place of their pictures. `None` for a camera that is not one of two eyes.
    pub fn shear(&self) -> Option<DVec3> {
        Some(self.way_to_eye()? / self.location.distance(self.look_at))
    }

    /// The unit vector from what the camera looks at towards the camera.
    pub fn back(&self) -> DVec3 {
        self.axes().2
    }

    /// The unit vector from a point towards the camera.
    pub(super) fn towards(&self, point: DVec3) -> DVec3 {
        let way = match self.lens {
            Lens::Perspective { .. } | Lens::Spherical => self.location() - point,
            Lens::Orthographic { .. } => self.location - self.look_at,
        };
        way.normalize_or(DVec3::Z)
    }

    /// The projection of the camera.
    pub fn lens(&self) -> Lens {
        self.lens
    }

    /// The depth-of-field blur. `None` if everything is in focus.
    pub fn blur(&self) -> Option<Blur> {
        self.blur
    }

    /// The point that is in focus, m. `None` if everything is in focus.
    pub fn focus(&self) -> Option<DVec3> {
        self.blur.map(|blur| blur.focus.unwrap_or(self.look_at))
    }

    /// The direction in the world that points up in the picture, a unit vector across the line of sight. `None` for a camera that is upright.
    pub fn sky(&self) -> Option<DVec3> {
        let (_, up, _) = self.tilt.axes((self.location - self.look_at).normalize_or(DVec3::Z));
        (!self.tilt.is_upright()).then_some(up)
    }

    /// True if the camera looks straight up or down. The upper edge of its picture then points away from the viewer.
    pub fn is_vertical(&self) -> bool {
        let sight = self.look_at - self.location;
        sight.x.abs().max(sight.z.abs()) < 1e-6 * sight.y.abs()
    }

    /// The height of the camera's pictures, relative to their width.
    pub fn height_to_width(&self) -> f64 {
        f64::from(self.output.height) / f64::from(self.output.width)
    }

    /// True if the pictures are more than 100 times as wide as high. POV-Ray then reports errors because of its own rounding.
    pub fn is_wide(&self) -> bool {
        const WIDE: u32 = 100;
        self.output.width > WIDE * self.output.height
    }

    /// The width in view at the camera's aim, m. If the aim is in front of the bounds or behind them, the nearest point of the bounds is
    /// used instead.
    pub(super) fn width_of_view(&self, bounds: Bounds) -> f64 {
        match self.lens {
            Lens::Perspective { .. } | Lens::Spherical => {
                let sight = self.look_at - self.location;
                let middle = self.look_at.clamp(bounds.min, bounds.max);
                let depth = (middle - self.location).dot(sight.normalize_or_zero());
                let depth = if depth > 0.0 { depth } else { sight.length() };
                2.0 * depth * self.half_tangent()
            }
            Lens::Orthographic { width } => width,
        }
    }

    /// The width in view at a distance from the camera, m.
    pub(crate) fn width_at(&self, distance: f64) -> f64 {
        match self.lens {
            Lens::Perspective { .. } => 2.0 * distance * self.half_tangent(),
            Lens::Orthographic { width } => width,
            Lens::Spherical => std::f64::consts::TAU * distance,
        }
    }

    /// The image plane of the camera, on which texts are placed.
    pub fn screen(&self) -> Screen {
        let (slope, width) = match self.lens {
            Lens::Perspective { angle } => (Some(libm::tan(angle.to_radians() / 2.0)), 0.0),
            Lens::Orthographic { width } => (None, width),
            Lens::Spherical => (Some(self.half_tangent()), 0.0),
        };
        let screen = Screen::new(self.location(), self.look_at(), self.sky(), (slope, width), self.focus());
        match self.way_to_eye() {
            Some(_) => screen.of_eye(self.eye / self.location.distance(self.look_at)),
            None => screen,
        }
    }
}

/// A camera of a run, which may move.
#[derive(Clone, Debug)]
pub(super) struct MovingCamera {
    placed: Placed,
    moving: Option<Moving>,
    followed: FollowedValues,
}

/// The motion of a camera.
#[derive(Clone, Debug)]
enum Moving {
    /// The camera moves as the scene says.
    Given {
        camera: Box<Camera>,
        /// The followed body: its index, its position at the start (m) and its half-width (m).
        body: Option<(usize, DVec3, f64)>,
    },
    /// The camera goes along with the motion of the bodies.
    Along(Arc<Track>),
}

impl MovingCamera {
    /// Creates a camera of a scene. If the scene gives no position, the camera looks at the bounds from the direction `towards`.
    pub(super) fn new(
        camera: &Camera,
        bounds: Bounds,
        towards: DVec3,
        scene: &Scene,
        followed: &FollowedValues,
    ) -> MovingCamera {
        let camera = &at_start(camera, followed);
        let body = camera.motion.follow.map(|follow| {
            let body = &scene.bodies[follow.body];
            (follow.body, body.start.location, half_width(body).unwrap_or(1.0))
        });
        let moving = camera.motion.moves().then(|| Moving::Given { camera: Box::new(camera.clone()), body });
        let placed = Placed::new(camera, bounds, towards, scene);
        MovingCamera { placed, moving, followed: followed.clone() }
    }

    /// The camera that goes along a track.
    pub(super) fn along(self, track: Arc<Track>) -> MovingCamera {
        MovingCamera { moving: Some(Moving::Along(track)), ..self }
    }

    /// The camera before it moves.
    pub(super) fn placed(&self) -> &Placed {
        &self.placed
    }

    /// True if the camera follows measures.
    pub(super) fn follows_measures(&self) -> bool {
        match &self.moving {
            Some(Moving::Given { camera, .. }) => camera.formulas().next().is_some(),
            Some(Moving::Along(_)) | None => false,
        }
    }

    /// True if the camera moves.
    pub(super) fn moves(&self) -> bool {
        self.moving.is_some()
    }

    /// The camera at a time (s), if the followed body and all measures stay at their initial values.
    pub(super) fn early(&self, time: f64) -> Placed {
        match &self.moving {
            None => self.placed,
            Some(Moving::Along(track)) => {
                let (aim, view) = track.at(time);
                self.placed.aimed(aim, view)
            }
            Some(Moving::Given { camera, body }) => {
                let (_, start, size) = body.unwrap_or((usize::MAX, DVec3::ZERO, 1.0));
                self.placed.moved(camera, size, [start, start], time, self.followed.at_start())
            }
        }
    }

    /// The camera of a frame.
    pub(super) fn at(&self, frame: &Frame) -> Placed {
        let Some(Moving::Given { camera, body }) = &self.moving else { return self.early(frame.time) };
        let (body, start, size) = body.unwrap_or((usize::MAX, DVec3::ZERO, 1.0));
        let behind = camera.motion.follow.and_then(|follow| {
            let lag = follow.lag.unwrap_or(0.0);
            frame.past.lagging.iter().find(|lagging| lagging.is_of(follow.body, lag))
        });
        let here = match behind {
            Some(lagging) => lagging.location,
            None => frame.body(body).map_or(start, |body| body.location),
        };
        self.placed.moved(camera, size, [start, here], frame.time, self.followed.at(frame))
    }
}

/// Returns the camera with the initial location, target and angles that follow from the measures at the start.
fn at_start(camera: &Camera, followed: &FollowedValues) -> Camera {
    let value = followed.at_start();
    let point = |point: &Option<VaryingPoint>| Some(point.as_ref()?.at(0.0, &value));
    let motion = &camera.motion;
    let projection = match (camera.projection, &motion.angle) {
        (Projection::Perspective { .. }, Some(angle)) => {
            Projection::Perspective { angle: angle.at(0.0, &value).clamp(0.1, 179.9) }
        }
        (projection, _) => projection,
    };
    Camera {
        location: camera.location.or_else(|| point(&motion.location)),
        look_at: camera.look_at.or_else(|| point(&motion.look_at)),
        projection,
        roll: motion.roll.as_ref().map_or(camera.roll, |roll| roll.at(0.0, &value)),
        ..camera.clone()
    }
}

/// Half of the largest extent of a drawn body along its own axes, m. `None` for a plane.
pub(super) fn half_width(body: &Body) -> Option<f64> {
    let drawn = body.drawn();
    let reach = |direction| drawn.support(DQuat::IDENTITY, direction);
    [DVec3::X, DVec3::Y, DVec3::Z].into_iter().filter_map(reach).reduce(f64::max)
}

/// The aim of a camera for which the scene gives only a position: the middle of the motion, or a point straight ahead if the camera itself
/// is in this middle.
fn aim(location: DVec3, auto: Framing) -> DVec3 {
    let far = auto.location.distance(auto.look_at);
    if location.distance(auto.look_at) > 1e-6 * far { auto.look_at } else { location - DVec3::Z * far }
}

//! The camera: as given, or as it follows from the motion.

use glam::{DQuat, DVec3};
use serde::Serialize;

use super::framing::{self, Field, Framing};
use super::screen::Screen;
use crate::scene::{Blur, Body, Camera, Output, Projection};
use crate::simulate::{Bounds, Frame};

/// A camera that has its place, in metres.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    pub(super) location: DVec3,
    pub(super) look_at: DVec3,
    lens: Lens,
    blur: Option<Blur>,
    output: Output,
}

/// How a camera sees.
#[derive(Clone, Copy, Debug)]
enum Lens {
    Perspective { angle: f64, field: Field },
    Orthographic { width: f64 },
}

/// The camera as templates see it; lengths are in POV-Ray's units.
#[derive(Clone, Debug, Serialize)]
pub(super) struct CameraText {
    location: [f64; 3],
    look_at: [f64; 3],
    /// The horizontal field of view of a perspective camera, degrees.
    angle: Option<f64>,
    /// The width that an orthographic camera sees.
    width: Option<f64>,
    /// Whether it looks straight up or down, where «up» needs another meaning.
    vertical: bool,
    /// The diameter of the lens, if it has one.
    aperture: Option<f64>,
    /// The point that is sharp.
    focus: Option<[f64; 3]>,
    blur_samples: Option<u32>,
}

impl Placed {
    /// The camera of a picture of the given size; what is not given follows from the bounds of the motion.
    pub(super) fn new(camera: &Camera, bounds: Bounds, output: Output) -> Placed {
        let (lens, auto) = match camera.projection {
            Projection::Perspective { angle } => {
                let field = Field::new(angle, output);
                (Lens::Perspective { angle, field }, framing::perspective(bounds, field, camera.look_at))
            }
            Projection::Orthographic { width } => {
                let towards =
                    camera.location.zip(camera.look_at).map(|(location, look_at)| location - look_at);
                let (auto, seen) = framing::orthographic(bounds, output, camera.look_at, towards);
                (Lens::Orthographic { width: width.unwrap_or(seen) }, auto)
            }
        };
        let location = camera.location.unwrap_or(auto.location);
        let look_at = camera.look_at.unwrap_or_else(|| aim(location, auto));
        Placed { location, look_at, lens, blur: camera.blur, output }
    }

    /// The camera at a moment of a run whose first frame had `start` where the followed body is now at `here`.
    fn moved(&self, camera: &Camera, size: f64, time: f64, [start, here]: [DVec3; 2]) -> Placed {
        let motion = &camera.motion;
        let mut location = motion.location.as_ref().map_or(self.location, |location| location.at(time));
        let mut look_at = motion.look_at.as_ref().map_or(self.look_at, |look_at| look_at.at(time));
        if let Some(follow) = motion.follow {
            let away = if camera.location.is_some() { location - start } else { location - look_at };
            let usual = if camera.location.is_some() { away.length() } else { 12.0 * size };
            look_at = here;
            location = here + away.normalize_or(DVec3::Z) * follow.distance.unwrap_or(usual);
        }
        if let Some(period) = motion.orbit {
            let turn = DQuat::from_rotation_y(std::f64::consts::TAU * time / period);
            location = look_at + turn * (location - look_at);
        }
        // POV-Ray refuses a camera at the point that it looks at; on its way through, it looks as it did.
        if location.distance(look_at) <= 1e-6 * self.location.distance(self.look_at) {
            look_at = location + (self.look_at - self.location);
        }
        let lens = match (self.lens, &motion.angle) {
            (Lens::Perspective { .. }, Some(angle)) => {
                let angle = angle.at(time).clamp(0.1, 179.9);
                Lens::Perspective { angle, field: Field::new(angle, self.output) }
            }
            (lens, _) => lens,
        };
        Placed { location, look_at, lens, blur: self.blur, output: self.output }
    }

    /// How many pixels a ball is wide whose centre is so far from the camera, m.
    pub(super) fn pixels(&self, radius: f64, distance: f64) -> f64 {
        let width = f64::from(self.output.width);
        match self.lens {
            Lens::Perspective { field, .. } => radius / distance / field.horizontal * width,
            Lens::Orthographic { width: seen } => 2.0 * radius / seen * width,
        }
    }

    /// The width of what is seen at a distance, m.
    pub(super) fn width_at(&self, distance: f64) -> f64 {
        match self.lens {
            Lens::Perspective { field, .. } => 2.0 * distance * field.horizontal,
            Lens::Orthographic { width } => width,
        }
    }

    /// The plane before the camera on which texts stand.
    pub(super) fn screen(&self) -> Screen {
        let (slope, width) = match self.lens {
            Lens::Perspective { angle, .. } => (Some(libm::tan(angle.to_radians() / 2.0)), 0.0),
            Lens::Orthographic { width } => (None, width),
        };
        let sharp = self.blur.map(|blur| blur.focus.unwrap_or(self.look_at));
        Screen::new(self.location, self.look_at, slope, width, sharp)
    }

    /// The camera as templates see it, for a unit of so many metres.
    pub(super) fn text(&self, unit: f64) -> CameraText {
        let (angle, width) = match self.lens {
            Lens::Perspective { angle, .. } => (Some(angle), None),
            Lens::Orthographic { width } => (None, Some(width / unit)),
        };
        let sight = self.look_at - self.location;
        CameraText {
            location: (self.location / unit).to_array(),
            look_at: (self.look_at / unit).to_array(),
            angle,
            width,
            vertical: sight.x.abs().max(sight.z.abs()) < 1e-6 * sight.y.abs(),
            aperture: self.blur.map(|blur| blur.aperture / unit),
            focus: self.blur.map(|blur| (blur.focus.unwrap_or(self.look_at) / unit).to_array()),
            blur_samples: self.blur.map(|blur| blur.samples),
        }
    }
}

/// A camera that is not the same in all frames.
#[derive(Clone, Debug)]
pub(super) struct Moving {
    camera: Camera,
    placed: Placed,
    /// Of the body that it follows: its number, where it is at the start, and its size, m.
    followed: Option<(usize, DVec3, f64)>,
    unit: f64,
}

impl Moving {
    /// A camera, if it moves.
    pub(super) fn new(camera: &Camera, placed: Placed, bodies: &[Body], unit: f64) -> Option<Moving> {
        let followed = camera.motion.follow.map(|follow| {
            let body = &bodies[follow.body];
            let size = body.drawn().support(DQuat::IDENTITY, DVec3::Y).unwrap_or(1.0);
            (follow.body, body.start.location, size)
        });
        camera.motion.moves().then(|| Moving { camera: camera.clone(), placed, followed, unit })
    }

    /// The camera of a frame, in words.
    pub(super) fn text(&self, frame: &Frame) -> CameraText {
        self.of(frame).text(self.unit)
    }

    /// The plane before it on which texts of a frame stand.
    pub(super) fn screen(&self, frame: &Frame) -> Screen {
        self.of(frame).screen()
    }

    fn of(&self, frame: &Frame) -> Placed {
        let (body, start, size) = self.followed.unwrap_or((usize::MAX, DVec3::ZERO, 1.0));
        let follow = self.camera.motion.follow;
        let behind = follow.and_then(|follow| {
            let lag = follow.lag?;
            frame.past.lagging.iter().find(|lagging| lagging.is_of(follow.body, lag))
        });
        let here = match behind {
            Some(lagging) => lagging.location,
            None => frame.bodies.get(body).map_or(start, |body| body.location),
        };
        self.placed.moved(&self.camera, size, frame.time, [start, here])
    }
}

/// What a camera looks at whose place alone is given: the middle of the motion, or from there straight ahead.
fn aim(location: DVec3, auto: Framing) -> DVec3 {
    let far = auto.location.distance(auto.look_at);
    if location.distance(auto.look_at) > 1e-6 * far { auto.look_at } else { location - DVec3::Z * far }
}

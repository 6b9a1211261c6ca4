//! Where the bodies are in all frames, as far as they move.

use glam::{DQuat, DVec3};

use super::container::LARGEST;
use crate::export::ExportError;
use crate::render::Film;
use crate::scene::Scene;
use crate::simulate::{BodyFrame, Frame, Selection, Survey, survey};

/// The frames per second of what is too fast or too slow for a film.
const USUAL_RATE: f64 = 25.0;

/// The motion of all bodies in the frames that are asked for.
pub(super) struct Motion {
    /// The times of the frames, as they are shown, s.
    times: Vec<f32>,
    /// Shown seconds for each second of the scene.
    slower: f64,
    bodies: Vec<Way>,
}

/// The way of a body.
pub(super) struct Way {
    /// Where it is in the first of the frames, m.
    pub(super) location: DVec3,
    /// How it is turned then.
    pub(super) orientation: DQuat,
    /// Its locations in all frames, m; empty if they are all the same.
    pub(super) translations: Vec<f32>,
    /// Its orientations in all frames, each x, y, z, w; empty if they are all the same.
    pub(super) rotations: Vec<f32>,
    /// How it was turned last, of the two signs that a quaternion can have that which is near the one before.
    last: DQuat,
}

impl Motion {
    /// Simulates the scene, and keeps what is asked for.
    pub(super) fn of(scene: &Scene, selection: &Selection) -> Result<(Motion, Survey), ExportError> {
        let count = selection.count_within(scene.simulation.frames());
        let mut rate = scene.simulation.frame_rate;
        if !Film::RATES.contains(&rate) {
            rate = USUAL_RATE;
        }
        let slower = scene.simulation.frame_rate / rate;
        let mut motion = Motion { times: Vec::with_capacity(count), slower, bodies: Vec::new() };
        let mut failed = None;
        let mut room = Room::default();
        room.take(count)?;
        let survey = survey(scene, |frame| {
            if failed.is_none() && selection.contains(frame.index) {
                failed = motion.add(scene, frame, count, &mut room).err();
            }
        })?;
        match failed {
            Some(error) => Err(error),
            None => Ok((motion, survey)),
        }
    }

    /// Adds a frame of so many that there will be. The room is what is left in a file.
    fn add(
        &mut self,
        scene: &Scene,
        frame: &Frame,
        count: usize,
        room: &mut Room,
    ) -> Result<(), ExportError> {
        let known = self.times.len();
        self.times.push((frame.time * self.slower) as f32);
        if known == 0 {
            self.bodies = frame.bodies.iter().map(Way::new).collect();
        }
        for (way, body) in self.bodies.iter_mut().zip(&frame.bodies) {
            if !body.location.as_vec3().is_finite() {
                let body = scene.bodies[body.id].name.clone();
                return Err(ExportError::OutOfRange { body, time: frame.time });
            }
            way.add(body, known, count, room)?;
        }
        Ok(())
    }

    /// The times of the frames, as they are shown, s.
    pub(super) fn times(&self) -> &[f32] {
        &self.times
    }

    /// How many times faster than in life the frames are shown.
    pub(super) fn faster(&self) -> f64 {
        1.0 / self.slower
    }

    /// The ways of the bodies, in the order of the scene.
    pub(super) fn ways(&self) -> &[Way] {
        &self.bodies
    }

    /// All numbers in the order of the file: the times, and for each body its locations and its orientations.
    pub(super) fn numbers(&self) -> impl Iterator<Item = &[f32]> {
        let ways = self.bodies.iter().flat_map(|way| [&way.translations[..], &way.rotations[..]]);
        std::iter::once(&self.times[..]).chain(ways)
    }
}

impl Way {
    fn new(body: &BodyFrame) -> Way {
        Way {
            location: body.location,
            orientation: body.orientation.normalize(),
            translations: Vec::new(),
            rotations: Vec::new(),
            last: body.orientation.normalize(),
        }
    }

    /// Adds where a body is after so many known frames of all.
    fn add(
        &mut self,
        body: &BodyFrame,
        known: usize,
        count: usize,
        room: &mut Room,
    ) -> Result<(), ExportError> {
        let orientation = body.orientation.normalize();
        // Of q and -q, which are the same rotation, the nearer one: between the two others, it would turn all around.
        self.last = if orientation.dot(self.last) < 0.0 { -orientation } else { orientation };
        let start = self.location.as_vec3().to_array();
        follow(&mut self.translations, start, body.location.as_vec3().to_array(), known, count, room)?;
        let start = self.orientation.as_quat().to_array();
        follow(&mut self.rotations, start, self.last.as_quat().to_array(), known, count, room)
    }
}

/// Adds a value after so many known ones of all, which are kept from the first on that differs from the start.
fn follow<const N: usize>(
    values: &mut Vec<f32>,
    start: [f32; N],
    value: [f32; N],
    known: usize,
    count: usize,
    room: &mut Room,
) -> Result<(), ExportError> {
    if values.is_empty() {
        if value == start {
            return Ok(());
        }
        room.take(N * count)?;
        values.reserve_exact(N * count);
        (0..known).for_each(|_| values.extend(start));
    }
    values.extend(value);
    Ok(())
}

/// The bytes that the numbers will take in the file, as far as is known by now.
#[derive(Default)]
pub(super) struct Room(u64);

impl Room {
    /// Takes what so many numbers need, if a file can hold them.
    pub(super) fn take(&mut self, numbers: usize) -> Result<(), ExportError> {
        self.0 += 4 * numbers as u64;
        if self.0 > LARGEST { Err(ExportError::TooLarge(self.0)) } else { Ok(()) }
    }
}

//! Reads the moments that a camera sees while its shutter is open.

use std::sync::Arc;

use super::particles::Clouds;
use super::past::History;
use super::recording::{Reader, Recording};
use super::{Frame, SimulateError};
use crate::scene::{Shutter, Timeline};

/// A frame, or a moment between frames, with access to the recorded moments after it.
pub struct Exposure {
    /// The state at the time when the shutter opens.
    pub frame: Frame,
    /// The trails, ghosts and delayed camera targets up to the time when the shutter opens.
    history: History,
    /// The particles at the last frame at or before the time when the shutter opens.
    clouds: Clouds,
    /// The recording, and the number of the first moment after the shutter opens.
    rest: (Arc<Recording>, usize),
    timeline: Timeline,
}

impl Exposure {
    pub(super) fn new(
        frame: Frame,
        history: History,
        clouds: Clouds,
        rest: (Arc<Recording>, usize),
        timeline: &Timeline,
    ) -> Exposure {
        Exposure { frame, history, clouds, rest, timeline: timeline.clone() }
    }

    /// Reads the moments at which a camera with this shutter takes its samples. Each moment has the index of the frame at which the
    /// shutter opened. Moments may be later than the last frame.
    pub fn moments(&self, shutter: Shutter) -> impl Iterator<Item = Result<Frame, SimulateError>> {
        let (recording, next) = &self.rest;
        let mut reader = recording.read();
        reader.seek(*next);
        let (mut history, clouds) = (self.history.clone(), self.clouds.clone());
        let index = self.frame.index;
        self.timeline
            .exposure(shutter, self.frame.time)
            .map(move |time| moment(&mut reader, &mut history, &clouds, index, time))
    }
}

/// Reads on to the moment at a time (s). Fails if the moment was not recorded, or if the reader is already past it.
#[allow(clippy::float_cmp, reason = "moments are recorded at these very times")]
fn moment(
    reader: &mut Reader,
    history: &mut History,
    clouds: &Clouds,
    index: usize,
    time: f64,
) -> Result<Frame, SimulateError> {
    let lost = || SimulateError::Recording(format!("t = {time} s was not recorded"));
    loop {
        let entry = reader.entry()?.ok_or_else(lost)?;
        if entry.snapshot.time > time {
            return Err(lost());
        }
        history.note_moment(&entry);
        if entry.snapshot.time == time {
            let mut frame = Frame::of_entry(index, entry);
            frame.past = history.before(&frame);
            frame.particles = clouds.at(&frame);
            return Ok(frame);
        }
    }
}

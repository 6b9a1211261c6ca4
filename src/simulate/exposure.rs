//! The view of a camera while its shutter is open.

use std::sync::Arc;

use super::particles::Clouds;
use super::past::History;
use super::recording::{Reader, Recording};
use super::{Frame, SimulateError};
use crate::scene::Shutter;

/// A frame, or another moment, and the run from there on.
pub struct Exposure {
    /// The moment at which the shutter opens.
    pub frame: Frame,
    /// The past up to that moment.
    history: History,
    /// The particles of the last frame up to that moment.
    clouds: Clouds,
    /// The recording, and the number of its next moment.
    rest: (Arc<Recording>, usize),
}

impl Exposure {
    pub(super) fn new(
        frame: Frame,
        (history, clouds): (History, Clouds),
        rest: (Arc<Recording>, usize),
    ) -> Exposure {
        Exposure { frame, history, clouds, rest }
    }

    /// The moments at which a camera looks while its shutter is open. Each is read on demand. They may be later than the last frame, and
    /// have the number of the frame at which the shutter opened.
    pub fn moments(&self, shutter: Shutter) -> impl Iterator<Item = Result<Frame, SimulateError>> {
        let (recording, next) = &self.rest;
        let mut reader = recording.read();
        reader.seek(*next);
        let (mut history, clouds) = (self.history.clone(), self.clouds.clone());
        let index = self.frame.index;
        shutter
            .moments(self.frame.time)
            .map(move |time| moment(&mut reader, (&mut history, &clouds), index, time))
    }
}

/// The moment at a time (s), which is not before the reader's.
#[allow(clippy::float_cmp, reason = "moments are recorded at these very times")]
fn moment(
    reader: &mut Reader,
    (history, clouds): (&mut History, &Clouds),
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

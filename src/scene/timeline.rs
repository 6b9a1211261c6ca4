//! The times of the frames of a scene.

/// The times of the frames of a scene: frame 0 is at time 0, and the frames follow at equal distances.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timeline {
    /// The duration of the simulation, s. The time of the last frame may differ, because it is rounded to a whole number of frames.
    pub duration: f64,
    /// The number of frames per second of simulated time.
    pub frame_rate: f64,
}

/// The largest rounding error of a time, as a fraction of the interval between frames.
const RELATIVE_ROUNDING: f64 = 1e-6;

impl Timeline {
    /// Returns the number of frames, including the first frame at time 0 and the last frame.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the check of a scene limits the number of frames"
    )]
    pub fn frames(&self) -> usize {
        self.frame_count() as usize
    }

    /// Returns the number of frames, which may be larger than a scene may have.
    pub(super) fn frame_count(&self) -> f64 {
        (self.duration * self.frame_rate).round() + 1.0
    }

    /// Returns the time of the frame with the index `frame`, s. It may be a frame after the last one.
    #[allow(clippy::cast_precision_loss, reason = "the check of a scene limits the number of frames")]
    pub fn time(&self, frame: usize) -> f64 {
        frame as f64 / self.frame_rate
    }

    /// Returns the time between two frames, s.
    pub fn interval(&self) -> f64 {
        1.0 / self.frame_rate
    }

    /// Returns the time of the last frame, s.
    pub fn end(&self) -> f64 {
        self.time(self.frames() - 1)
    }

    /// Returns the index of the first frame at or after a time, s. `None` if there is none.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
    pub fn first_frame_from(&self, time: f64) -> Option<usize> {
        let about = (time * self.frame_rate).floor() as usize;
        (about..=about.saturating_add(1)).find(|frame| *frame < self.frames() && self.time(*frame) >= time)
    }

    /// Returns the latest time of the simulation, s: the duration, or the time of the last frame if that is later.
    pub fn latest(&self) -> f64 {
        self.duration.max(self.end())
    }

    /// Returns the tolerance for rounding errors of times, s.
    pub fn slack(&self) -> f64 {
        RELATIVE_ROUNDING / self.frame_rate
    }

    /// Returns whether a time (s) is exactly that of a frame.
    pub fn is_frame(&self, time: f64) -> bool {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
        let nearest = (time * self.frame_rate).round() as usize;
        nearest < self.frames() && self.time(nearest) == time
    }

    /// Returns the time of the nearest frame, s, if `time` differs from that time only by rounding. Otherwise returns `time`.
    pub fn nearest_frame(&self, time: f64) -> f64 {
        let at_frame = (time * self.frame_rate).round() / self.frame_rate;
        if (time - at_frame).abs() <= self.slack() { at_frame } else { time }
    }
}

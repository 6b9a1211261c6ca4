//! The times of the frames of a scene.

use super::{Shutter, SpeedCurve};

/// The times of the frames of a scene. Frame 0 is at time 0. The frames follow at equal distances in the time of the film, which is the simulated
/// time unless the scene gives the film a speed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timeline {
    /// The duration of the simulation, s. The time of the last frame may differ, because it is rounded to a whole number of frames.
    pub duration: f64,
    /// The number of frames per second of simulated time, at speed 1.
    pub frame_rate: f64,
    /// The speed of the film.
    pub speed: SpeedCurve,
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
        if self.speed.is_even() {
            return (self.duration * self.frame_rate).round() + 1.0;
        }
        (self.speed.film_time(self.duration) * self.frame_rate - RELATIVE_ROUNDING).ceil().max(0.0) + 1.0
    }

    /// Returns the time of the frame with the index `frame`, s. It may be a frame after the last one. If the film has a speed of its own, its last
    /// frame shows the end of the simulation.
    #[allow(clippy::cast_precision_loss, reason = "the check of a scene limits the number of frames")]
    pub fn time(&self, frame: usize) -> f64 {
        let film = frame as f64 / self.frame_rate;
        if self.speed.is_even() {
            return film;
        }
        if frame + 1 >= self.frames() { self.duration } else { self.without_rounding(self.speed.time(film)) }
    }

    /// Returns the time between two frames at speed 1, s. The dynamics advances by equal intervals of this length, so the speed of the film
    /// does not affect the motion.
    pub fn interval(&self) -> f64 {
        1.0 / self.frame_rate
    }

    /// Returns the number of whole [intervals](Self::interval) before a time, s.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
    pub fn intervals_before(&self, time: f64) -> usize {
        (time * self.frame_rate).floor() as usize
    }

    /// Returns the time after this number of [intervals](Self::interval), s.
    #[allow(clippy::cast_precision_loss, reason = "the check of a scene limits the number of intervals")]
    pub fn interval_start(&self, number: usize) -> f64 {
        number as f64 / self.frame_rate
    }

    /// Returns the times of the moments in one image with motion blur, s. `begin` is the time at which the shutter opens. The
    /// exposure time is measured in the film, so slow motion has less blur.
    pub fn exposure(&self, shutter: Shutter, begin: f64) -> impl ExactSizeIterator<Item = f64> {
        shutter.moments(self.speed.film_time(begin)).map(|film| self.speed.time(film))
    }

    /// Returns the time of the last frame, s.
    pub fn end(&self) -> f64 {
        self.time(self.frames() - 1)
    }

    /// Returns the index of the first frame at or after a time, s. `None` if there is none.
    pub fn first_frame_from(&self, time: f64) -> Option<usize> {
        let about = self.frame_before(time);
        let near = about.saturating_sub(1)..=about.saturating_add(1);
        near.into_iter().find(|frame| *frame < self.frames() && self.time(*frame) >= time)
    }

    /// Returns the indices of the frames in an interval after the start time, up to and including its end, s.
    pub fn frames_within(&self, start: f64, end: f64) -> impl Iterator<Item = usize> {
        let first = self.frame_before(start).saturating_sub(1);
        let frames = (first..self.frames()).take_while(move |frame| self.time(*frame) <= end);
        frames.filter(move |frame| self.time(*frame) > start)
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
    fn frame_before(&self, time: f64) -> usize {
        (self.speed.film_time(time) * self.frame_rate).floor() as usize
    }

    /// Returns the latest time of the simulation, s: the duration, or the time of the last frame if that is later.
    pub fn latest(&self) -> f64 {
        self.duration.max(self.end())
    }

    /// Returns the tolerance for rounding errors of times, s.
    pub fn slack(&self) -> f64 {
        RELATIVE_ROUNDING / self.frame_rate
    }

    /// Returns the index of the frame that is exactly at a time, s. `None` if there is none.
    pub fn frame_at(&self, time: f64) -> Option<usize> {
        let nearest = self.nearest(time);
        // The last frame may come early.
        (nearest..=nearest.saturating_add(1))
            .find(|frame| *frame < self.frames() && self.time(*frame) == time)
    }

    /// Returns the start of the nearest [interval](Self::interval), s, if `time` differs from it only by rounding. Otherwise returns `time`. The
    /// speed of the film makes no difference.
    pub fn without_rounding(&self, time: f64) -> f64 {
        let start = (time * self.frame_rate).round() / self.frame_rate;
        if (time - start).abs() <= self.slack() { start } else { time }
    }

    /// Returns the number of frames in a period of `duration` seconds that ends at the time `until`, s.
    pub fn frames_during(&self, duration: f64, until: f64) -> f64 {
        if self.speed.is_even() {
            return duration / self.interval();
        }
        (self.speed.film_time(until) - self.speed.film_time(until - duration)) * self.frame_rate
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
    fn nearest(&self, time: f64) -> usize {
        (self.speed.film_time(time) * self.frame_rate).round() as usize
    }
}

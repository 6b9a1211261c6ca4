//! The frame rate and the speed of a film.

use std::ops::RangeInclusive;

use crate::scene::SpeedCurve;

/// The frame rate of a film, and its speed relative to real time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// The frame rate of the film, frames per second.
    pub rate: f64,
    /// The simulated time per second of the film, s: 1 for real time, 0.25 for slow motion by a factor of 4.
    pub speed: f64,
}

impl Pace {
    /// The possible frame rates of a film, frames per second.
    pub const RATES: RangeInclusive<f64> = 0.01..=1000.0;
    /// The default frame rate of a film if the scene's frame rate is unsuitable, frames per second.
    pub const USUAL_RATE: f64 = 25.0;
    /// The frame rates of scenes that are suitable for a film in real time, frames per second.
    pub const WATCHABLE: RangeInclusive<f64> = 1.0..=120.0;

    /// Chooses the frame rate of a film from the frame rate of its scene. A rate given in `asked` is used unchanged. Otherwise the film
    /// runs in real time if the scene's rate is suitable, and at the default rate if not.
    pub fn new(scene_rate: f64, asked: Option<f64>) -> Pace {
        let watchable = Pace::WATCHABLE.contains(&scene_rate);
        let rate = asked.unwrap_or(if watchable { scene_rate } else { Pace::USUAL_RATE });
        Pace { rate, speed: rate / scene_rate }
    }

    /// The pace of a film of these frames of a scene, in ascending order, at the same frame rate. `None` if the frames are at uneven
    /// distances, so that the film has no single speed. A single frame keeps the pace.
    pub fn of_frames(self, scene_rate: f64, frames: impl IntoIterator<Item = usize>) -> Option<Pace> {
        let frames: Vec<usize> = frames.into_iter().collect();
        let mut distances = frames.windows(2).map(|pair| pair[1].saturating_sub(pair[0]));
        let Some(distance) = distances.next() else { return Some(self) };
        #[allow(clippy::cast_precision_loss, reason = "there are fewer frames than that")]
        let speed = self.rate * distance as f64 / scene_rate;
        distances.all(|other| other == distance).then_some(Pace { speed, ..self })
    }

    /// The pace of a film whose scene gives it a speed of its own. `None` if that speed changes.
    pub fn at(self, speed: &SpeedCurve) -> Option<Pace> {
        speed.constant().map(|speed| Pace { speed: speed * self.speed, ..self })
    }

    /// The speed of the film in words, such as `4 times slower than life`. `None` for real time, to one part in a thousand.
    pub fn in_words(self) -> Option<String> {
        let (times, how) =
            if self.speed < 1.0 { (1.0 / self.speed, "slower") } else { (self.speed, "faster") };
        (times > 1.001).then(|| format!("{} times {how} than life", three_digits(times)))
    }
}

/// Formats a number of at least 1 with three significant digits.
fn three_digits(number: f64) -> String {
    let rounded: f64 = format!("{number:.2e}").parse().unwrap_or(number);
    if rounded < 1e6 { format!("{rounded}") } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_that_can_be_watched_is_kept_and_any_other_is_25() {
        let rate = |scene_rate| Pace::new(scene_rate, None).rate;
        assert_eq!([1.0, 23.976, 120.0].map(rate), [1.0, 23.976, 120.0]);
        assert_eq!([0.99, 3.0e-7, 120.1, 1.0e17].map(rate), [25.0; 4]);
        assert_eq!(Pace::new(3.0e-7, Some(50.0)).rate, 50.0);
    }

    /// A film of every tenth frame of 100 in a second shows 2.5 s in a second if it has the rate 25.
    #[test]
    fn frames_at_even_distance_make_a_faster_film() {
        let of = |frames: &[usize]| {
            let pace = Pace::new(100.0, Some(25.0)).of_frames(100.0, frames.iter().copied());
            pace.and_then(Pace::in_words)
        };
        assert_eq!(of(&[0, 10, 20, 30]).unwrap(), "2.5 times faster than life");
        assert_eq!(of(&[5, 6, 7]).unwrap(), "4 times slower than life");
        assert_eq!(of(&[5]).unwrap(), "4 times slower than life");
        assert_eq!(of(&[0, 4, 8]), None, "it is life");
        assert_eq!(of(&[0, 4, 9]), None, "no single speed");
    }

    #[test]
    fn the_pace_is_said_against_life() {
        let said = |scene_rate, asked| Pace::new(scene_rate, asked).in_words();
        assert_eq!(said(25.0, None), None);
        assert_eq!(said(24.0, Some(23.999)), None);
        assert_eq!(said(100.0, Some(25.0)).unwrap(), "4 times slower than life");
        assert_eq!(said(30.0, Some(25.0)).unwrap(), "1.2 times slower than life");
        assert_eq!(said(3.0e-7, None).unwrap(), "8.33e7 times faster than life");
        assert_eq!(said(0.5, None).unwrap(), "50 times faster than life");
    }
}

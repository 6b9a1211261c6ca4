//! How fast a film shows its scene.

use std::ops::RangeInclusive;

/// How fast a film shows its scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// Frames of the film per second.
    pub rate: f64,
    /// Seconds of the scene per second of the film: 1 is as in life, 0.25 is four times slower.
    pub speed: f64,
}

impl Pace {
    /// The rates that a film can have, in frames per second.
    pub const RATES: RangeInclusive<f64> = 0.01..=1000.0;
    /// The frame rate of a film if that of the scene is unwatchable, in frames per second.
    pub const USUAL_RATE: f64 = 25.0;
    /// The frame rates of scenes that can be watched in real time, in frames per second.
    pub const WATCHABLE: RangeInclusive<f64> = 1.0..=120.0;

    /// The pace of a film whose images are `scene_rate` to the second of the scene. The film gets the rate that is asked for;
    /// without one it is in real time, if the scene's rate can be watched, and else has the usual rate.
    pub fn new(scene_rate: f64, asked: Option<f64>) -> Pace {
        let watchable = Pace::WATCHABLE.contains(&scene_rate);
        let rate = asked.unwrap_or(if watchable { scene_rate } else { Pace::USUAL_RATE });
        Pace { rate, speed: rate / scene_rate }
    }

    /// How much faster or slower than life the film is: `4 times slower than life`. `None` if it is as fast, to one part in
    /// a thousand.
    pub fn in_words(self) -> Option<String> {
        let (times, how) =
            if self.speed < 1.0 { (1.0 / self.speed, "slower") } else { (self.speed, "faster") };
        (times > 1.001).then(|| format!("{} times {how} than life", three_digits(times)))
    }
}

/// A number of at least 1, to three digits.
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

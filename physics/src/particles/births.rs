//! The birth times of particles.

/// The birth times of the particles of a source: groups of particles are born at equal intervals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Births {
    /// The time of the first birth, s.
    pub start: f64,
    /// The last time at which particles may be born, s.
    pub end: f64,
    /// The number of particles that are born at the same time, at least 1.
    pub at_once: u64,
    /// The interval between two birth times, s. Infinite if there is only one birth time.
    pub every: f64,
}

impl Births {
    /// Creates births of single particles at `rate` per second, from time `start` to time `end`, s. The rate is greater than 0.
    #[must_use]
    pub fn rate(rate: f64, start: f64, end: f64) -> Births {
        Births { start, end, at_once: 1, every: 1.0 / rate }
    }

    /// Returns the birth time of the particle with this number, s; `None` if the particle is never born. Numbers start at 0.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "no run has 2⁵³ births")]
    pub fn time(&self, number: u64) -> Option<f64> {
        let turn = number / self.at_once;
        // Turn 0 is treated separately, because 0 times infinity is NaN.
        let time = if turn == 0 { self.start } else { self.start + turn as f64 * self.every };
        (time <= self.end && time.is_finite()).then_some(time)
    }

    /// Returns the number of the first particle that is born at time `t` (s) or later. The end of the births is ignored.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the conversion saturates, and the first turn is corrected"
    )]
    pub fn first_from(&self, t: f64) -> u64 {
        let turns = ((t - self.start) / self.every).floor();
        if t <= self.start || turns.is_nan() {
            return 0;
        }
        // The quotient is rounded, so `turn` may be wrong by one.
        let mut turn = (turns as u64).saturating_sub(1);
        while self.time(turn.saturating_mul(self.at_once)).is_some_and(|time| time < t) {
            turn += 1;
        }
        turn.saturating_mul(self.at_once)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_gives_so_many_a_second() {
        let births = Births::rate(3.0, 1.0, 2.0);
        let times: Vec<f64> = (0..9).map_while(|number| births.time(number)).collect();
        assert_eq!(times, [1.0, 1.0 + 1.0 / 3.0, 1.0 + 2.0 / 3.0, 2.0]);
        assert_eq!([0.0, 1.0, 1.1, 1.5, 2.0].map(|t| births.first_from(t)), [0, 0, 1, 2, 3]);
    }

    #[test]
    fn the_first_from_the_time_of_a_birth_is_that_birth() {
        for rate in [7.0, 333.0, 33_333.0] {
            let births = Births::rate(rate, 0.1, f64::INFINITY);
            for number in [1, 2, 10, 999, 123_457] {
                assert_eq!(births.first_from(births.time(number).unwrap()), number, "{rate}");
            }
        }
    }

    #[test]
    fn a_burst_is_many_at_once_and_comes_again() {
        let once = Births { start: 0.5, end: f64::INFINITY, at_once: 3, every: f64::INFINITY };
        assert_eq!([0, 2, 3].map(|number| once.time(number)), [Some(0.5), Some(0.5), None]);
        assert_eq!([0.0, 0.5, 0.6].map(|t| once.first_from(t)), [0, 0, 3]);
        let again = Births { every: 2.0, end: 2.5, ..once };
        assert_eq!([3, 5, 6].map(|number| again.time(number)), [Some(2.5), Some(2.5), None]);
        assert_eq!([0.6, 2.5].map(|t| again.first_from(t)), [3, 3]);
    }
}

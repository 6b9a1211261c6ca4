//! A time that stays accurate when many steps are added.

/// A time (s) as the sum of two numbers, so that it has twice the precision of an `f64`. Otherwise, the rounding errors of ten thousand
/// steps of different lengths would be visible for a planet at its perihelion. Source: D. E. Knuth, *The Art of Computer Programming* 2,
/// 4.2.2, theorem B.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Time {
    seconds: f64,
    /// The difference between the exact time and `seconds`, s.
    rest: f64,
}

impl Time {
    /// Returns the time of exactly `seconds`.
    pub(super) fn at(seconds: f64) -> Time {
        Time { seconds, rest: 0.0 }
    }

    /// Returns the time as the nearest `f64`, s.
    pub(super) fn seconds(self) -> f64 {
        self.seconds
    }

    /// Returns the duration from this time to `seconds`, s.
    pub(super) fn until(self, seconds: f64) -> f64 {
        (seconds - self.seconds) - self.rest
    }

    /// Returns this time plus `duration`, s.
    pub(super) fn after(self, duration: f64) -> Time {
        let (seconds, rest) = exact_sum(self.seconds, duration);
        let (seconds, rest) = exact_sum(seconds, rest + self.rest);
        Time { seconds, rest }
    }
}

/// Returns the sum of two numbers and its rounding error.
fn exact_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Adds a million steps of 0.1 s. A plain sum would have an error of 1e-6 s. The result must have only the rounding error of the
    /// number 0.1 itself, a million times 5.6e-18 s.
    #[test]
    fn rounding_errors_do_not_add_up() {
        let mut time = Time::at(0.0);
        (0..1_000_000).for_each(|_| time = time.after(0.1));
        assert_eq!(time.seconds(), 1e5);
        assert!((time.until(1e5) + 5.55e-12).abs() < 1e-13, "{:e}", time.until(1e5));
    }
}

//! A time that is the sum of many steps.

/// A time, s, as a sum of two numbers. The rounding errors of ten thousand different steps would otherwise be visible for a planet at its
/// perihelion. Source: D. E. Knuth, *The Art of Computer Programming* 2, 4.2.2, theorem B.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Time {
    seconds: f64,
    /// The remainder.
    rest: f64,
}

impl Time {
    /// Exactly this many seconds.
    pub(super) fn at(seconds: f64) -> Time {
        Time { seconds, rest: 0.0 }
    }

    /// The nearest number, s.
    pub(super) fn seconds(self) -> f64 {
        self.seconds
    }

    /// The duration from this time to another, s.
    pub(super) fn until(self, seconds: f64) -> f64 {
        (seconds - self.seconds) - self.rest
    }

    /// The time after a duration, s.
    pub(super) fn after(self, duration: f64) -> Time {
        let (seconds, rest) = exact_sum(self.seconds, duration);
        let (seconds, rest) = exact_sum(seconds, rest + self.rest);
        Time { seconds, rest }
    }
}

/// The sum of two numbers, and its rounding error.
fn exact_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A million steps of 0.1 s. A plain sum has an error of 1e-6 s. This sum has only the error of 0.1 itself, a million times 5.6e-18
    /// s.
    #[test]
    fn rounding_errors_do_not_add_up() {
        let mut time = Time::at(0.0);
        (0..1_000_000).for_each(|_| time = time.after(0.1));
        assert_eq!(time.seconds(), 1e5);
        assert!((time.until(1e5) + 5.55e-12).abs() < 1e-13, "{:e}", time.until(1e5));
    }
}

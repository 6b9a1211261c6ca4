//! A time that many steps have led to.

/// A time, s, as a sum of two numbers: ten thousand steps of different lengths would add up to a rounding error that a planet
/// at its perihelion shows. Source: D. E. Knuth, *The Art of Computer Programming* 2, 4.2.2, theorem B.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Time {
    seconds: f64,
    /// What is missing to it.
    rest: f64,
}

impl Time {
    /// Exactly so many seconds.
    pub(super) fn at(seconds: f64) -> Time {
        Time { seconds, rest: 0.0 }
    }

    /// The nearest number, s.
    pub(super) fn seconds(self) -> f64 {
        self.seconds
    }

    /// How long it is until then, s.
    pub(super) fn until(self, seconds: f64) -> f64 {
        (seconds - self.seconds) - self.rest
    }

    /// The time after so many seconds.
    pub(super) fn after(self, duration: f64) -> Time {
        let (seconds, rest) = exact_sum(self.seconds, duration);
        let (seconds, rest) = exact_sum(seconds, rest + self.rest);
        Time { seconds, rest }
    }
}

/// The sum of two numbers, and what is lost of it by rounding.
fn exact_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A million steps of 0.1 s: plain sums are off by 1e-6 s then, and these by the error of 0.1 alone, a million times 5.6e-18 s.
    #[test]
    fn rounding_errors_do_not_add_up() {
        let mut time = Time::at(0.0);
        (0..1_000_000).for_each(|_| time = time.after(0.1));
        assert_eq!(time.seconds(), 1e5);
        assert!((time.until(1e5) + 5.55e-12).abs() < 1e-13, "{:e}", time.until(1e5));
    }
}

//! Rounds numbers to steps of decimal scales: powers of ten, and 1, 2 or 5 times such a power.
//!
//! Numbers within a small tolerance of a step count as this step, so rounding errors do not choose another one.

/// Returns the largest power of ten that does not exceed a positive number.
pub(crate) fn decimal_step(number: f64) -> f64 {
    let exponent = libm::floor(libm::log10(number) + 1e-12);
    libm::pow(10.0, exponent)
}

/// Returns the smallest of 1, 2 and 5 times a power of ten that is not below a positive number.
pub(crate) fn round_above(number: f64) -> f64 {
    let power = decimal_step(number);
    let digit = [1.0, 2.0, 5.0].into_iter().find(|digit| digit * power >= number * (1.0 - 1e-9));
    digit.unwrap_or(10.0) * power
}

/// Returns the largest of 1, 2 and 5 times a power of ten that does not exceed a positive number.
pub(crate) fn round_below(number: f64) -> f64 {
    let power = decimal_step(number);
    let digit = [5.0, 2.0].into_iter().find(|digit| *digit <= number / power + 1e-9);
    digit.unwrap_or(1.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimal_steps_are_powers_of_ten() {
        for (number, step) in [(1.0, 1.0), (9.99, 1.0), (10.0, 10.0), (0.001, 0.001), (85.0, 10.0)] {
            assert!((decimal_step(number) / step - 1.0).abs() < 1e-12, "{number}");
        }
    }

    #[test]
    fn numbers_are_rounded_up_and_down_to_1_2_and_5() {
        for (number, below, above) in [
            (1.0, 1.0, 1.0),
            (1.5, 1.0, 2.0),
            (2.0, 2.0, 2.0),
            (4.999, 2.0, 5.0),
            (5.0, 5.0, 5.0),
            (7.0, 5.0, 10.0),
            (0.03, 0.02, 0.05),
            (1.9e-9, 1e-9, 2e-9),
            (6e200, 5e200, 1e201),
        ] {
            assert!((round_below(number) / below - 1.0).abs() < 1e-12, "{number}: {}", round_below(number));
            assert!((round_above(number) / above - 1.0).abs() < 1e-12, "{number}: {}", round_above(number));
        }
        // Rounding errors do not choose another step.
        assert!((round_below(0.5 * (1.0 - 1e-12)) / 0.5 - 1.0).abs() < 1e-12);
        assert!((round_above(0.5 * (1.0 + 1e-12)) / 0.5 - 1.0).abs() < 1e-12);
    }
}

//! The numbers of logarithmic axes: powers of ten, or 1, 2 and 5 times such powers.

use super::super::number::{text, typeset};
use crate::decimal::{round_above, round_below};

/// The smallest number of decades between two neighbors of 1, 2, 5 and 10: log₁₀ 2.
const BETWEEN_DIGITS: f64 = 0.301;
/// The numbers of decades from one number to the next that are tried.
const STEPS: [i32; 9] = [1, 2, 3, 5, 10, 20, 50, 100, 200];
/// The largest exponent of the ends of an axis.
const LARGEST_EXPONENT: f64 = 300.0;
/// If all numbers of an axis are within these bounds, 1, 2 and 5 times powers of ten are written in full.
const WRITTEN_IN_FULL: std::ops::Range<f64> = 1e-3..1e5;

/// What stands beside a logarithmic axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Decades {
    /// Powers of ten whose exponents are multiples of this number.
    Powers(i32),
    /// 1, 2 and 5 times powers of ten.
    Digits,
}

impl Decades {
    /// Returns the numbers for a range, and the range: if it may be wider, it ends at round numbers. The axis has room for `count` intervals.
    pub(super) fn new([low, high]: [f64; 2], is_wider: bool, count: f64) -> (Decades, [f64; 2]) {
        let [low, high] = if is_wider { [round_below(low), round_above(high)] } else { [low, high] };
        let decades = libm::log10(high) - libm::log10(low);
        if decades * (1.0 - 1e-9) <= count * BETWEEN_DIGITS {
            return (Decades::Digits, [low, high]);
        }
        let fits = |step: &i32| decades <= count * f64::from(*step);
        let number = STEPS.iter().position(fits).unwrap_or(STEPS.len() - 1);
        if is_wider && Decades::Powers(STEPS[number]).values([low, high]).len() < 2 {
            return (Decades::Powers(STEPS[number]), between_powers([low, high], STEPS[number]));
        }
        // A single number tells nothing about the others.
        let mut powers = STEPS[..=number].iter().rev().map(|step| Decades::Powers(*step));
        let several = powers.find(|powers| powers.values([low, high]).len() > 1);
        (several.unwrap_or(Decades::Digits), [low, high])
    }

    /// Returns the numbers within a range, each with the letters that stand beside the axis.
    pub(super) fn values(self, range: [f64; 2]) -> Vec<(f64, String)> {
        let [low, high] = range;
        let is_inside = |value: &f64| (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(value);
        match self {
            Decades::Powers(step) => {
                let exponents = exponents(range).filter(|exponent| exponent % step == 0);
                let values = exponents.map(|exponent| (power(exponent), power_in_letters(exponent)));
                values.filter(|(value, _)| is_inside(value)).collect()
            }
            Decades::Digits => {
                let in_full = WRITTEN_IN_FULL.contains(&low) && WRITTEN_IN_FULL.contains(&high);
                let says = |digit: i32, exponent: i32| match (in_full, digit) {
                    (true, _) => text(times(digit, exponent), 3),
                    (false, 1) => power_in_letters(exponent),
                    (false, digit) => typeset(&format!("{digit}e{exponent}")),
                };
                let values = exponents(range).flat_map(|exponent| [1, 2, 5].map(|digit| (digit, exponent)));
                let values = values.map(|(digit, exponent)| (times(digit, exponent), says(digit, exponent)));
                values.filter(|(value, _)| is_inside(value)).collect()
            }
        }
    }

    /// Returns the values of the faint lines between the numbers of an axis.
    pub(super) fn between(self, range: [f64; 2]) -> Vec<f64> {
        let between: Vec<f64> = match self {
            Decades::Powers(1) => {
                exponents(range).flat_map(|exponent| [2, 5].map(|digit| times(digit, exponent))).collect()
            }
            Decades::Powers(step) => {
                exponents(range).filter(|exponent| exponent % step != 0).map(power).collect()
            }
            Decades::Digits => Vec::new(),
        };
        between.into_iter().filter(|value| (range[0]..=range[1]).contains(value)).collect()
    }
}

/// The exponents of the powers of ten from below the low end of a range to its high end.
#[allow(clippy::cast_possible_truncation, reason = "exponents of f64 are small")]
fn exponents([low, high]: [f64; 2]) -> std::ops::RangeInclusive<i32> {
    let [first, last] = [low, high].map(|end| libm::floor(libm::log10(end) + 1e-9) as i32);
    first..=last
}

/// Returns a range from one power of ten to another that contains the given one. The exponents are multiples of `step`.
fn between_powers([low, high]: [f64; 2], step: i32) -> [f64; 2] {
    let step = f64::from(step);
    let first = libm::floor(libm::log10(low) / step + 1e-12) * step;
    let last = libm::ceil(libm::log10(high) / step - 1e-12) * step;
    [first, last].map(|exponent| libm::pow(10.0, exponent.clamp(-LARGEST_EXPONENT, LARGEST_EXPONENT)))
}

fn power(exponent: i32) -> f64 {
    libm::pow(10.0, f64::from(exponent))
}

fn times(digit: i32, exponent: i32) -> f64 {
    f64::from(digit) * power(exponent)
}

/// A power of ten as it stands beside an axis: `10⁻³`, and `1` and `10` as everybody writes them.
fn power_in_letters(exponent: i32) -> String {
    match exponent {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        exponent => typeset(&format!("1e{exponent}")).replace("1·", ""),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The letters beside an axis, and its ends.
    fn said(range: [f64; 2], is_wider: bool, count: f64) -> (Vec<String>, [f64; 2]) {
        let (decades, range) = Decades::new(range, is_wider, count);
        (decades.values(range).into_iter().map(|(_, says)| says).collect(), range)
    }

    #[test]
    fn many_decades_have_powers_of_ten_and_few_have_1_2_and_5() {
        assert_eq!(said([1e-4, 1e2], false, 6.0).0, ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "1", "10", "10²"]);
        assert_eq!(said([1e-12, 1e2], false, 5.0).0, ["10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³", "1"]);
        assert_eq!(said([1.0, 10.0], false, 4.0).0, ["1", "2", "5", "10"]);
        assert_eq!(
            said([0.13, 4.2], true, 6.0),
            (["0.1", "0.2", "0.5", "1", "2", "5"].map(str::to_owned).to_vec(), [0.1, 5.0])
        );
        assert_eq!(said([1e-7, 1e-6], false, 4.0).0, ["10⁻⁷", "2·10⁻⁷", "5·10⁻⁷", "10⁻⁶"]);
    }

    #[test]
    fn an_axis_never_has_a_single_number() {
        assert_eq!(said([2.0, 9.0], true, 2.0), (["1", "10"].map(str::to_owned).to_vec(), [1.0, 10.0]));
        assert_eq!(said([20.0, 90.0], false, 1.0).0, ["20", "50"]);
    }

    #[test]
    fn faint_lines_stand_between_the_numbers() {
        let near = |found: Vec<f64>, expected: &[f64]| {
            let is_near = found.len() == expected.len()
                && found.iter().zip(expected).all(|(one, other)| (one / other - 1.0).abs() < 1e-12);
            assert!(is_near, "{found:?}");
        };
        near(Decades::Powers(1).between([0.1, 10.0]), &[0.2, 0.5, 2.0, 5.0]);
        near(Decades::Powers(2).between([1.0, 1e4]), &[10.0, 1e3]);
        near(Decades::Digits.between([1.0, 10.0]), &[]);
    }
}

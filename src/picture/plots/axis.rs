//! The axes of plots: their ranges, and the numbers beside them.

use super::super::number::typeset;
use super::decades::Decades;
use crate::decimal::{decimal_step, round_above};

/// The largest difference of values that counts as a rounding error, relative to the largest value. Such values are drawn as constant.
const MAX_ROUNDING: f64 = 1e-9;
/// The largest value of an axis, in its unit. Sums of larger values could overflow.
const MAX_VALUE: f64 = 1e300;
/// The smallest difference between the ends of an axis, in its unit. Parts of smaller differences could vanish.
const MIN_RANGE: f64 = 1e-290;
/// If the largest value of an axis, in its unit, is within these bounds, its numbers are written in full. Otherwise they are divided by a
/// power of ten, which stands at the unit.
const WRITTEN_IN_FULL: std::ops::Range<f64> = 1e-2..1e5;
/// The largest count of numbers beside an axis. It is more than any axis has room for.
const MAX_TICKS: f64 = 50.0;

/// The smallest value of a logarithmic axis, in its unit.
const MIN_LOGARITHMIC: f64 = 1e-300;
/// The ratio of the ends of a logarithmic axis below which its numbers are evenly spaced, as those of a linear one.
const NARROW_RATIO: f64 = 4.0;

/// An axis of a plot: the range that it shows, and its numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    pub(super) low: f64,
    pub(super) high: f64,
    is_logarithmic: bool,
    numbers: Numbers,
}

/// The numbers beside an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Numbers {
    /// Evenly spaced values.
    Even {
        /// The distance between two numbers.
        step: f64,
        /// The power of ten that all numbers are divided by, as an exponent.
        exponent: i32,
    },
    /// Values of a logarithmic axis.
    Decades(Decades),
    /// No numbers: names stand there.
    Names,
}

/// What an axis must show, and how its values are spaced.
#[derive(Clone, Copy, Debug)]
pub(super) enum AxisScale {
    /// Equal distances are equal differences.
    Linear(Range),
    /// Equal distances are equal ratios. All values are positive.
    Logarithmic(Range),
    /// Names in equal distances, each in the middle of its room. The number is that of the names.
    Names(u8),
}

/// A number beside an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// The position along the axis, from 0 to 1.
    pub(super) at: f64,
    pub(super) value: f64,
    pub(super) says: String,
}

/// What an axis must show.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    /// The lowest and the highest value.
    pub(super) span: [f64; 2],
    /// Whether the axis may show a little more, up to the next quarter of a step.
    pub(super) is_wider: bool,
    /// Whether the values are whole numbers.
    pub(super) is_count: bool,
}

impl AxisScale {
    /// Makes the axis. It has about `count` numbers.
    pub(super) fn axis(&self, count: f64) -> Axis {
        match self {
            AxisScale::Linear(range) => Axis::new(range, count),
            AxisScale::Logarithmic(range) => Axis::logarithmic(range, count),
            AxisScale::Names(names) => Axis {
                low: 0.0,
                high: f64::from(*names).max(1.0),
                is_logarithmic: false,
                numbers: Numbers::Names,
            },
        }
    }
}

impl Axis {
    /// Makes the axis of a range. It has about `count` numbers.
    pub(super) fn new(range: &Range, count: f64) -> Axis {
        let [low, high] = range.span.map(|end| end.clamp(-MAX_VALUE, MAX_VALUE));
        let largest = low.abs().max(high.abs());
        let is_flat = high - low <= if range.is_wider { MAX_ROUNDING * largest } else { 0.0 };
        let (low, high) = match is_flat || high - low < MIN_RANGE {
            true if largest < MIN_RANGE => (-1.0, 1.0),
            // A quantity that keeps its value is a line between 0 and twice the value.
            true => (low.min(0.0) * 2.0, high.max(0.0) * 2.0),
            false => (low, high),
        };
        let step = round_above((high - low) / count.max(1.0)).max(if range.is_count { 1.0 } else { 0.0 });
        let part = step / 4.0;
        let (low, high) = match range.is_wider {
            true => (libm::floor(low / part + 1e-9) * part, libm::ceil(high / part - 1e-9) * part),
            false => (low, high),
        };
        let largest = low.abs().max(high.abs());
        let exponent = match largest {
            large if !WRITTEN_IN_FULL.contains(&large) => exponent_of(large),
            _ => 0,
        };
        Axis { low, high, is_logarithmic: false, numbers: Numbers::Even { step, exponent } }
    }

    /// Makes the logarithmic axis of a range of positive values. It has about `count` numbers.
    fn logarithmic(range: &Range, count: f64) -> Axis {
        let [low, high] = range.span.map(|end| end.clamp(MIN_LOGARITHMIC, MAX_VALUE));
        // A quantity that keeps its value is a line in the middle.
        let is_flat = high <= low * if range.is_wider { 1.0 + MAX_ROUNDING } else { 1.0 };
        let [low, high] = if is_flat { [low / 10.0, high * 10.0] } else { [low, high] };
        if high < NARROW_RATIO * low {
            let even = Axis::new(&Range { span: [low, high], ..*range }, count);
            if even.low > 0.0 && even.ticks().len() > 1 {
                return Axis { is_logarithmic: true, ..even };
            }
        }
        let (decades, [low, high]) = Decades::new([low, high], range.is_wider, count.max(1.0));
        Axis { low, high, is_logarithmic: true, numbers: Numbers::Decades(decades) }
    }

    /// Returns the position of a value along the axis: 0 at the low end, 1 at the high end. NaN if the axis has no place for it.
    pub(super) fn place(&self, value: f64) -> f64 {
        if self.is_logarithmic {
            // A difference of logarithms, since a ratio could overflow.
            let [value, low, high] = [value, self.low, self.high].map(libm::log10);
            let place = (value - low) / (high - low);
            return if place.is_finite() { place } else { f64::NAN };
        }
        (value - self.low) / (self.high - self.low)
    }

    /// Returns the numbers beside the axis.
    pub(super) fn ticks(&self) -> Vec<Tick> {
        let (step, exponent) = match self.numbers {
            Numbers::Even { step, exponent } => (step, exponent),
            Numbers::Names => return Vec::new(),
            Numbers::Decades(decades) => {
                let values = decades.values([self.low, self.high]).into_iter();
                return values.map(|(value, says)| Tick { at: self.place(value), value, says }).collect();
            }
        };
        let power = libm::pow(10.0, f64::from(exponent));
        let decimals = usize::try_from(-exponent_of(step / power)).unwrap_or(0);
        let first = libm::ceil(self.low / step - 1e-9);
        let count = (libm::floor(self.high / step + 1e-9) - first).min(MAX_TICKS);
        let mut ticks = Vec::new();
        let mut number = 0.0;
        while number <= count {
            // `+ 0.0` avoids a negative zero.
            let value = (first + number) * step + 0.0;
            let says = typeset(&format!("{:.decimals$}", value / power));
            ticks.push(Tick { at: self.place(value), value, says });
            number += 1.0;
        }
        ticks
    }

    /// Returns the positions of the faint lines between the numbers of a logarithmic axis.
    pub(super) fn between(&self) -> Vec<f64> {
        match self.numbers {
            Numbers::Even { .. } | Numbers::Names => Vec::new(),
            Numbers::Decades(decades) => {
                decades.between([self.low, self.high]).into_iter().map(|value| self.place(value)).collect()
            }
        }
    }

    /// Returns a name with the unit of the axis. A name that ends with its own unit, such as `r (m)` or `r in m`, gets only the power of ten, if there is one.
    pub(super) fn named(&self, name: &str, symbol: &str) -> String {
        let before_unit = name.strip_suffix(')').and_then(|name| name.rsplit_once(" ("));
        // In `2 * (a + b)`, the parentheses hold no unit.
        let has_unit = before_unit.is_some_and(|(before, _)| !before.ends_with(['+', '-', '*', '/', '^']))
            || !symbol.is_empty() && name.strip_suffix(symbol).is_some_and(|before| before.ends_with(" in "));
        match (self.unit(if has_unit { "" } else { symbol }), has_unit) {
            (unit, _) if unit.is_empty() => name.to_owned(),
            (power, true) => format!("{name} {power}"),
            (unit, false) => format!("{name} ({unit})"),
        }
    }

    /// Returns the unit that stands at the axis: the power of ten of its numbers, and the symbol of the unit.
    pub(super) fn unit(&self, symbol: &str) -> String {
        let exponent = match self.numbers {
            Numbers::Even { exponent, .. } => exponent,
            Numbers::Decades(_) | Numbers::Names => 0,
        };
        let power = typeset(&format!("1e{exponent}"));
        match (exponent, symbol) {
            (0, symbol) => symbol.to_owned(),
            (_, "") => power.replace("1·", "·"),
            (_, symbol) => format!("{} {symbol}", power.replace("1·", "")),
        }
    }
}

/// Returns the exponent of the largest power of ten that does not exceed a positive number.
#[allow(clippy::cast_possible_truncation, reason = "exponents of f64 are small")]
fn exponent_of(number: f64) -> i32 {
    libm::round(libm::log10(decimal_step(number))) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(span: [f64; 2], count: f64, is_wider: bool) -> Axis {
        Axis::new(&Range { span, is_wider, is_count: false }, count)
    }

    fn said(axis: &Axis) -> Vec<String> {
        axis.ticks().into_iter().map(|tick| tick.says).collect()
    }

    #[test]
    fn numbers_are_round_and_have_as_many_decimals_as_they_need() {
        let scale = axis([0.0, 10.0], 5.0, false);
        assert_eq!(said(&scale), ["0", "2", "4", "6", "8", "10"]);
        let scale = axis([-0.13, 0.42], 4.0, true);
        assert_eq!(said(&scale), ["0.0", "0.2", "0.4"]);
        assert_eq!((scale.low, scale.high, scale.unit("m")), (-0.15000000000000002, 0.45, "m".to_owned()));
        let scale = axis([0.0, 0.25], 5.0, false);
        assert_eq!(said(&scale), ["0.00", "0.05", "0.10", "0.15", "0.20", "0.25"]);
    }

    #[test]
    fn counts_have_whole_numbers() {
        let scale = Axis::new(&Range { span: [0.0, 2.0], is_wider: true, is_count: true }, 6.0);
        assert_eq!(said(&scale), ["0", "1", "2"]);
    }

    #[test]
    fn very_large_and_very_small_numbers_have_a_power_of_ten_at_the_unit() {
        let scale = axis([0.0, 7.5e-6], 3.0, true);
        assert_eq!(said(&scale), ["0", "5"]);
        assert_eq!((scale.unit("J"), scale.unit("")), ("10⁻⁶ J".to_owned(), "·10⁻⁶".to_owned()));
        let scale = axis([-3e30, 6e30], 3.0, true);
        assert_eq!((said(&scale), scale.unit("J")), (vec!["0".into(), "5".into()], "10³⁰ J".into()));
        assert_eq!(
            (scale.named("E", "J"), scale.named("E (J)", "J")),
            ("E (10³⁰ J)".into(), "E (J) ·10³⁰".into())
        );
    }

    #[test]
    fn extreme_ranges_have_a_few_numbers() {
        let ends = [0.0, 1e-323, 1e-300, 1e-10, 1.0, 1e17, 1e308, f64::MAX];
        for low in ends.into_iter().flat_map(|end| [end, -end]) {
            for high in ends.into_iter().flat_map(|end| [end, -end]).filter(|high| *high >= low) {
                for is_wider in [false, true] {
                    let scale = axis([low, high], 4.0, is_wider);
                    let ticks = scale.ticks();
                    assert!(ticks.len() < 50, "{low} to {high}: {scale:?}");
                    assert!(
                        scale.high > scale.low && (scale.high - scale.low).is_finite(),
                        "{low} to {high}: {scale:?}"
                    );
                    assert!(
                        ticks.iter().all(|tick| tick.at.is_finite() && tick.value.is_finite()),
                        "{ticks:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn equal_ratios_have_equal_distances_on_a_logarithmic_axis() {
        let range = Range { span: [0.01, 100.0], is_wider: true, is_count: false };
        let scale = AxisScale::Logarithmic(range).axis(4.0);
        for (value, place) in [(0.01, 0.0), (0.1, 0.25), (1.0, 0.5), (100.0, 1.0)] {
            assert!((scale.place(value) - place).abs() < 1e-12, "{value}");
        }
        for value in [0.0, -1.0, f64::NAN] {
            assert!(scale.place(value).is_nan(), "{value}");
        }
        // In a narrow range, the numbers are those of a linear axis.
        let narrow = AxisScale::Logarithmic(Range { span: [4.1, 4.9], ..range }).axis(4.0);
        assert_eq!(said(&narrow), ["4.2", "4.4", "4.6", "4.8"]);
        assert!((narrow.place(libm::sqrt(narrow.low * narrow.high)) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn extreme_logarithmic_ranges_have_a_few_numbers() {
        let ends = [1e-323, 1e-300, 1e-10, 0.3, 1.0, 1.0 + 1e-12, 1.1, 2e17, 1e308, f64::MAX];
        for low in ends {
            for high in ends.into_iter().filter(|high| *high >= low) {
                for (is_wider, count) in [(false, 1.0), (true, 1.0), (false, 6.0), (true, 6.0)] {
                    let range = Range { span: [low, high], is_wider, is_count: false };
                    let scale = AxisScale::Logarithmic(range).axis(count);
                    let ticks = scale.ticks();
                    assert!(ticks.len() < 50 && scale.between().len() < 1000, "{low} to {high}: {scale:?}");
                    assert!(scale.low > 0.0 && scale.high > scale.low, "{low} to {high}: {scale:?}");
                    let is_inside = |tick: &Tick| (-1e-6..=1.0 + 1e-6).contains(&tick.at);
                    assert!(ticks.iter().all(is_inside), "{ticks:?}");
                    assert!(!is_wider || ticks.len() > 1, "{low} to {high}: {scale:?} {ticks:?}");
                }
            }
        }
    }

    #[test]
    fn what_does_not_change_is_a_line_in_the_middle() {
        for value in [0.2, -3.0, 0.0] {
            let scale = axis([value, value + 1e-12 * value], 4.0, true);
            assert!((scale.place(value) - 0.5).abs() < 0.2, "{value} {scale:?}");
            assert!(scale.low < scale.high);
        }
    }
}

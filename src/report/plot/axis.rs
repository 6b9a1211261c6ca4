//! The axis of a plot: it maps values to positions along its length, and chooses the labeled values.

use super::text::digits;
use crate::decimal::round_above;

/// An axis of a plot, from a smallest to a largest value. For a logarithmic axis, `min` and `max` are powers of ten.
pub(super) struct Axis {
    min: f64,
    max: f64,
    is_logarithmic: bool,
}

/// The largest number of intervals between the labels of an axis.
const MAX_INTERVALS: f64 = 6.0;

/// The smallest value of a logarithmic axis. Smaller values count as zero.
const MIN_LOGARITHMIC_VALUE: f64 = 1e-18;

impl Axis {
    /// Makes a linear axis from `min` to `max`.
    pub(super) fn linear(min: f64, max: f64) -> Axis {
        Axis { min, max: if max > min { max } else { min + 1.0 }, is_logarithmic: false }
    }

    /// Makes a linear axis that includes all finite values and zero, with a small margin.
    pub(super) fn around<'v>(values: impl Iterator<Item = &'v f64>) -> Axis {
        let finite = values.filter(|value| value.is_finite());
        let (min, max) =
            finite.fold((0.0_f64, 0.0_f64), |(min, max), value| (min.min(*value), max.max(*value)));
        match max - min {
            0.0 => Axis::linear(-1.0, 1.0),
            range => Axis::linear(min - 0.05 * range, max + 0.05 * range),
        }
    }

    /// Makes a logarithmic axis that includes all positive finite values, and begins and ends at whole powers of ten.
    pub(super) fn logarithmic<'v>(values: impl Iterator<Item = &'v f64>) -> Axis {
        let positive = values
            .filter(|value| value.is_finite() && **value > MIN_LOGARITHMIC_VALUE)
            .map(|v| libm::log10(*v));
        let range = positive.fold(None, |range: Option<[f64; 2]>, value| match range {
            Some([min, max]) => Some([min.min(value), max.max(value)]),
            None => Some([value; 2]),
        });
        let [min, max] = range.unwrap_or([-3.0, 0.0]);
        let (min, max) = (min.floor(), max.ceil());
        Axis { min, max: if max > min { max } else { min + 1.0 }, is_logarithmic: true }
    }

    /// Returns the position of a value along the axis, as a fraction of its length: 0 at `min`, 1 at `max`.
    pub(super) fn part(&self, value: f64) -> f64 {
        let place = if self.is_logarithmic { libm::log10(value.max(MIN_LOGARITHMIC_VALUE)) } else { value };
        (place - self.min) / (self.max - self.min)
    }

    /// Returns the values to label, each with its label.
    pub(super) fn ticks(&self) -> Vec<(f64, String)> {
        let range = self.max - self.min;
        if self.is_logarithmic {
            let every = (range / MAX_INTERVALS).ceil().max(1.0);
            let first = (self.min / every).ceil() * every;
            return steps(first, every, self.max)
                .map(|power| (libm::exp10(power), format!("1e{power}")))
                .collect();
        }
        let every = round_above(range / MAX_INTERVALS);
        let first = (self.min / every).ceil() * every;
        let rounded = |value: f64| if value.abs() < 1e-9 * every { 0.0 } else { value };
        steps(first, every, self.max).map(rounded).map(|value| (value, digits(value, 6))).collect()
    }
}

/// Yields equidistant values from `first` up to `last`, at most 20.
fn steps(first: f64, every: f64, last: f64) -> impl Iterator<Item = f64> {
    (0..20).map(move |k| first + f64::from(k) * every).take_while(move |value| *value <= last + 1e-9 * every)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(axis: &Axis) -> Vec<String> {
        axis.ticks().into_iter().map(|(_, name)| name).collect()
    }

    #[test]
    fn round_values_are_named() {
        assert_eq!(names(&Axis::linear(0.0, 10.0)), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(names(&Axis::linear(0.0, 9e8)), ["0", "2e8", "4e8", "6e8", "8e8"]);
        assert_eq!(names(&Axis::around([0.0, -0.19].iter())), ["-0.15", "-0.1", "-0.05", "0"]);
        assert_eq!(names(&Axis::around([0.0].iter())), ["-1", "-0.5", "0", "0.5", "1"]);
        assert_eq!(
            names(&Axis::logarithmic([3e-9, 0.0, 0.5].iter())),
            ["1e-8", "1e-6", "1e-4", "1e-2", "1e0"]
        );
        assert_eq!(names(&Axis::logarithmic([].iter())), ["1e-3", "1e-2", "1e-1", "1e0"]);
    }

    #[test]
    fn values_have_their_place() {
        let axis = Axis::logarithmic([1e-4, 1.0].iter());
        assert!((axis.part(1e-2) - 0.5).abs() < 1e-12 && axis.part(0.0) < 0.0);
        assert_eq!(Axis::linear(-1.0, 1.0).part(0.0), 0.5);
    }
}

//! Quantities of several bodies: sums, means and extremes.

use std::sync::Arc;

use super::MeasureFormula;

/// A sum, a mean or an extreme over several bodies, such as `sum(gas.kinetic)`.
#[derive(Clone, Debug)]
pub struct Aggregate {
    /// How the values of the bodies make one value.
    pub how: Aggregation,
    /// The indices of the bodies in the scene, in ascending order.
    pub bodies: Arc<[usize]>,
    /// The formula that has a value for each body. Its inputs may be measures of [each body](super::Subject::Each).
    pub formula: MeasureFormula,
}

/// How the values of several bodies make one value. Absent bodies are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aggregation {
    /// The sum of all values; 0 if no body is present.
    Sum,
    /// The mean of all values; undefined if no body is present.
    Mean,
    /// The largest value; undefined if no body is present.
    Max,
    /// The smallest value; undefined if no body is present.
    Min,
}

impl Aggregation {
    /// All kinds, each with its name in formulas and its meaning.
    pub const ALL: [(&'static str, Aggregation, &'static str); 4] = [
        ("sum", Aggregation::Sum, "the sum over the copies of a body"),
        ("mean", Aggregation::Mean, "the mean over the copies of a body"),
        ("max", Aggregation::Max, "the largest value among the copies of a body"),
        ("min", Aggregation::Min, "the smallest value among the copies of a body"),
    ];

    /// Returns the name of the kind in formulas.
    pub fn name(self) -> &'static str {
        Aggregation::ALL.into_iter().find(|(_, how, _)| *how == self).map_or("", |(name, ..)| name)
    }

    /// Makes one value of the values of the present bodies. The result is NaN if one of them is NaN.
    pub fn of(self, values: impl Iterator<Item = f64>) -> f64 {
        let (mut count, mut sum) = (0.0, 0.0);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values {
            count += 1.0;
            sum += value;
            (low, high) = (low.min(value), high.max(value));
        }
        match self {
            Aggregation::Sum => sum,
            // 0/0 is NaN.
            Aggregation::Mean => sum / count,
            // `min` and `max` ignore NaN; the sum does not. Infinite values of both signs make the sum NaN, too.
            Aggregation::Max | Aggregation::Min if count == 0.0 || sum.is_nan() => f64::NAN,
            Aggregation::Max => high,
            Aggregation::Min => low,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_make_one_value_and_no_values_have_no_mean() {
        let of = |how: Aggregation, values: &[f64]| how.of(values.iter().copied());
        let all = Aggregation::ALL.map(|(_, how, _)| how);
        assert_eq!(all.map(|how| of(how, &[3.0, -1.0, 4.0])), [6.0, 2.0, 4.0, -1.0]);
        assert!(all[1..].iter().all(|how| of(*how, &[]).is_nan()) && of(Aggregation::Sum, &[]) == 0.0);
        assert!(all.iter().all(|how| of(*how, &[1.0, f64::NAN, 2.0]).is_nan()));
    }
}

//! Numbers of looks that follow a quantity, such as a transparency that follows the speed of each body.

use super::MeasureFormula;

/// A number of a look: always the same, or following a value of each body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LookNumber {
    /// A number that never changes.
    Fixed(f64),
    /// A number that follows a value, by the index of its map in the scene.
    Mapped(usize),
}

/// Whether a body is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    /// The body is always drawn.
    Always,
    /// The body is never drawn.
    Never,
    /// The body is drawn while a condition holds, by the index of the condition in the scene.
    While(usize),
}

/// A map from the values of a quantity to the numbers of a look.
#[derive(Clone, Debug)]
pub struct ValueMap {
    /// The quantity. A measure of [each](super::Subject::Each) body is that of the body that is drawn.
    pub of: MeasureFormula,
    /// The values of the first and the last number, in the unit of the formula. `None` for the lowest and the highest value of the run.
    pub range: Option<[f64; 2]>,
    /// The first and the last number.
    pub to: [f64; 2],
}

/// A part of a body's look that may follow a value through a [`ValueMap`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LookAspect {
    /// The part of the light that passes through the body.
    Transparency,
    /// The part of the color that shines by itself.
    Glow,
    /// The size in the picture, relative to the true size.
    Scale,
}

impl LookAspect {
    /// All parts of the look that may follow a value.
    pub const ALL: [LookAspect; 3] = [LookAspect::Transparency, LookAspect::Glow, LookAspect::Scale];
}

impl LookNumber {
    /// Returns the index of the map. `None` if the number never changes.
    pub fn map(self) -> Option<usize> {
        match self {
            LookNumber::Fixed(_) => None,
            LookNumber::Mapped(map) => Some(map),
        }
    }

    /// Returns the number that never changes. `None` if it follows a value.
    pub fn fixed(self) -> Option<f64> {
        match self {
            LookNumber::Fixed(number) => Some(number),
            LookNumber::Mapped(_) => None,
        }
    }
}

impl ValueMap {
    /// The number of steps from the first to the last number. More could not be told apart, and bodies of one step stand together in scripts.
    pub const STEP_COUNT: u32 = 63;

    /// Returns the number for a value, given the values of the first and the last number. Values outside of this range get the number of its
    /// nearer end. A value that is not finite gets the first number, and a range without a width gives the number in the middle.
    pub fn number_at(&self, value: f64, range: [f64; 2]) -> f64 {
        self.number(part_of(value, range).unwrap_or(0.0))
    }

    /// Returns the same as [`number_at`](Self::number_at), rounded to one of the steps.
    pub fn step_at(&self, value: f64, range: [f64; 2]) -> f64 {
        let steps = f64::from(ValueMap::STEP_COUNT);
        self.number((part_of(value, range).unwrap_or(0.0) * steps).round() / steps)
    }

    /// Returns the number at a part of the way from the first to the last one. Both ends are exact.
    fn number(&self, part: f64) -> f64 {
        let [first, last] = self.to;
        if part == 1.0 { last } else { first + part * (last - first) }
    }
}

/// Returns the position of a value in a range, from 0 to 1. It is that of the nearer end outside of the range, and 0.5 in a range without a width.
/// `None` if the value is not finite.
pub(super) fn part_of(value: f64, [low, high]: [f64; 2]) -> Option<f64> {
    let part = if high > low { (value - low) / (high - low) } else { 0.5 };
    (value.is_finite() && part.is_finite()).then(|| part.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use crate::scene::Scene;

    #[test]
    fn values_give_the_numbers_at_equal_parts_of_the_range() {
        let text = "[body.b]\nshape.sphere.radius = 1\nmaterial.transparency.map = { of = 'speed', to = [0.9, 0.2] }";
        let scene = Scene::parse(text).unwrap();
        let [map] = &scene.value_maps[..] else { panic!("{:?}", scene.value_maps) };
        let numbers = [-1.0, 0.0, 2.0, 4.0, 9.0, f64::NAN].map(|value| map.number_at(value, [0.0, 4.0]));
        for (number, expected) in numbers.into_iter().zip([0.9, 0.9, 0.55, 0.2, 0.2, 0.9]) {
            assert!((number - expected).abs() < 1e-15, "{numbers:?}");
        }
        assert_eq!(map.step_at(4.0, [0.0, 4.0]), 0.2, "the ends are exact");
        assert!((map.number_at(7.0, [7.0, 7.0]) - 0.55).abs() < 1e-15, "a range without a width");
        let mut steps: Vec<u64> =
            (0..1000).map(|i| map.step_at(f64::from(i), [0.0, 999.0]).to_bits()).collect();
        steps.dedup();
        assert_eq!(steps.len(), 64);
    }
}

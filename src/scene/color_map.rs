//! Colors that follow a quantity, such as the speed of each body.

use colorgrad::Gradient;

use super::{Color, Corner, MeasureFormula};

/// A color map: it gives each body of its materials a color by the value of a quantity of this body.
#[derive(Clone, Debug)]
pub struct ColorMap {
    /// The quantity. A measure of [each](super::Subject::Each) body is that of the body that gets the color.
    pub of: MeasureFormula,
    /// The colors of the values.
    pub palette: Palette,
    /// The values of the first and the last color, in the unit of the formula. `None` for the lowest and the highest value of the run.
    pub range: Option<[f64; 2]>,
    /// The title of the color bar.
    pub title: String,
    /// The corner of the color bar in the picture. `None` if the bar is not drawn.
    pub bar: Option<Corner>,
}

impl ColorMap {
    /// The number of colors of a map. More could not be told apart; fewer would be seen as steps.
    pub const COLORS: usize = 256;
    /// The color of a value that is not finite, such as a quotient by 0.
    pub const UNDEFINED: Color = Color([0.5; 3]);

    /// Returns the index of the color of a value, given the values of the first and the last color. Values outside of this range get the
    /// color of its nearer end. `None` if the value is not finite.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the index is from 0 to 255")]
    #[allow(clippy::cast_precision_loss, reason = "there are few colors")]
    pub fn color_of(value: f64, [low, high]: [f64; 2]) -> Option<usize> {
        let part = (value - low) / (high - low);
        let part = if high > low { part } else { 0.5 };
        (value.is_finite() && part.is_finite()).then(|| {
            (part.clamp(0.0, 1.0) * ColorMap::COLORS as f64).min(ColorMap::COLORS as f64 - 1.0) as usize
        })
    }
}

/// The sequence of colors of a color map.
#[derive(Clone, Debug, PartialEq)]
pub enum Palette {
    /// A palette with a name, by its index in [`Palette::NAMED`].
    Named(usize),
    /// The colors between these, at least two, evenly spaced.
    Between(Vec<Color>),
}

/// Makes the gradient of a named palette.
type Preset = fn() -> Box<dyn Gradient>;

impl Palette {
    /// The name, the gradient and the meaning of each named palette.
    pub const NAMED: [(&'static str, Preset, &'static str); 9] = [
        ("viridis", || Box::new(colorgrad::preset::viridis()), "From violet over green to yellow"),
        ("plasma", || Box::new(colorgrad::preset::plasma()), "From blue over red to yellow"),
        ("inferno", || Box::new(colorgrad::preset::inferno()), "From black over red to pale yellow"),
        ("magma", || Box::new(colorgrad::preset::magma()), "From black over violet to pale rose"),
        (
            "cividis",
            || Box::new(colorgrad::preset::cividis()),
            "From blue to yellow, the same for any color vision",
        ),
        ("turbo", || Box::new(colorgrad::preset::turbo()), "A rainbow; not perceptually uniform"),
        ("blues", || Box::new(colorgrad::preset::blues()), "From white to blue"),
        (
            "red-blue",
            || Box::new(colorgrad::preset::rd_bu()),
            "From red over white to blue, for values around a middle",
        ),
        (
            "spectral",
            || Box::new(colorgrad::preset::spectral()),
            "From red over yellow to blue, for values around a middle",
        ),
    ];

    /// Returns the palette with this name. `None` for an unknown name.
    pub fn named(name: &str) -> Option<Palette> {
        Palette::NAMED.iter().position(|(known, ..)| *known == name).map(Palette::Named)
    }

    /// Returns the color at a position from 0 for the first color to 1 for the last one.
    #[allow(clippy::cast_possible_truncation, reason = "a color has fewer digits")]
    fn at(&self, gradient: Option<&dyn Gradient>, part: f64) -> Color {
        match (self, gradient) {
            (Palette::Between(colors), _) => between(colors, part),
            (Palette::Named(_), Some(gradient)) => {
                let color = gradient.at(part as f32);
                // Three decimals are finer than a screen's 256 levels.
                let level = |part: f32| (f64::from(part.clamp(0.0, 1.0)) * 1000.0).round() / 1000.0;
                Color([color.r, color.g, color.b].map(level))
            }
            (Palette::Named(_), None) => ColorMap::UNDEFINED,
        }
    }

    /// Returns this many colors of the palette, from the first to the last.
    #[allow(clippy::cast_precision_loss, reason = "there are few colors")]
    pub fn colors(&self, count: usize) -> Vec<Color> {
        let gradient = match self {
            Palette::Named(number) => Palette::NAMED.get(*number).map(|(_, gradient, _)| gradient()),
            Palette::Between(_) => None,
        };
        let last = (count.max(2) - 1) as f64;
        (0..count).map(|number| self.at(gradient.as_deref(), number as f64 / last)).collect()
    }

    /// Returns the color in the middle.
    pub fn middle(&self) -> Color {
        self.colors(3)[1]
    }
}

/// Returns the color at a position from 0 to 1 between colors that are evenly spaced. It is mixed in sRGB.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the index is small")]
#[allow(clippy::cast_precision_loss, reason = "there are few colors")]
fn between(colors: &[Color], part: f64) -> Color {
    let steps = colors.len().saturating_sub(1);
    let at = part * steps as f64;
    let first = (at as usize).min(steps.saturating_sub(1));
    let (one, other) = (colors[first], colors[(first + 1).min(steps)]);
    Color(std::array::from_fn(|k| one.0[k] + (at - first as f64) * (other.0[k] - one.0[k])))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first and the last color of viridis. Source: matplotlib, `_cm_listed.py`.
    #[test]
    fn viridis_is_that_of_matplotlib() {
        let colors = Palette::named("viridis").unwrap().colors(ColorMap::COLORS);
        let near = |color: Color, [r, g, b]: [f64; 3]| {
            [r, g, b].iter().zip(color.0).all(|(known, found)| (known - found).abs() < 0.01)
        };
        assert_eq!(colors.len(), 256);
        assert!(near(colors[0], [0.267, 0.005, 0.329]), "{:?}", colors[0]);
        assert!(near(colors[128], [0.128, 0.567, 0.551]), "{:?}", colors[128]);
        assert!(near(colors[255], [0.993, 0.906, 0.144]), "{:?}", colors[255]);
    }

    #[test]
    fn values_are_divided_evenly_among_the_colors() {
        let range = [-1.0, 3.0];
        let colors: Vec<Option<usize>> = [-5.0, -1.0, 0.0, 1.0, 2.999_999, 3.0, 9.0, f64::NAN]
            .map(|value| ColorMap::color_of(value, range))
            .to_vec();
        let expected = [Some(0), Some(0), Some(64), Some(128), Some(255), Some(255), Some(255), None];
        assert_eq!(colors, expected);
        assert_eq!(ColorMap::color_of(2.0, [2.0, 2.0]), Some(128), "a range without a width");
    }

    #[test]
    fn colors_of_a_list_are_at_equal_distances() {
        let [black, red] = ["black", "red"].map(|name| Color::parse(name).unwrap());
        let colors = Palette::Between(vec![black, red, Color::WHITE]).colors(5);
        assert_eq!(colors, [black, Color([0.5, 0.0, 0.0]), red, Color([1.0, 0.5, 0.5]), Color::WHITE]);
    }
}

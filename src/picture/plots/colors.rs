//! The colors of the curves of a plot.

use super::super::colors::seen;
use crate::scene::{Color, Plot, PlotKind, Scene};

/// The colors of the curves or bars: that of the scene, that of the only body in a formula or of the first body of a histogram, or else one of a palette whose colors can be told apart.
pub(super) fn of_curves(scene: &Scene, plot: &Plot, dark: bool) -> Vec<Color> {
    let mut free = Color::OF_CURVES.into_iter().cycle();
    let mut colors: Vec<Color> = Vec::new();
    let are_alike = plot.kind == PlotKind::Bars { are_copies: true };
    for curve in &plot.curves {
        if let Some(color) = curve.color.or_else(|| colors.first().copied().filter(|_| are_alike)) {
            colors.push(color);
            continue;
        }
        let first = match &plot.kind {
            PlotKind::Histogram { bodies, .. } => bodies.first().copied(),
            PlotKind::Curves | PlotKind::Bars { .. } => None,
        };
        let material = curve.y.body().or(first).and_then(|body| scene.bodies[body].material);
        let own = material.and_then(|material| scene.materials[material].look.color());
        let own = own.map(|color| seen(color, dark)).filter(|own| {
            let is_legible = dark || own.linear().iter().sum::<f64>() < 1.5;
            is_legible && colors.iter().all(|other| difference(*own, *other) > 0.3)
        });
        let color = own.or_else(|| {
            let mut palette = free
                .by_ref()
                .take(Color::OF_CURVES.len())
                .map(|color| if dark { mixed(color, Color::WHITE, 0.25) } else { color });
            palette.find(|color| colors.iter().all(|other| difference(*color, *other) > 0.1))
        });
        colors.push(color.unwrap_or(Color::OF_CURVES[0]));
    }
    colors
}

/// The distance of two colors in sRGB.
fn difference(one: Color, other: Color) -> f64 {
    (glam::DVec3::from_array(one.0) - glam::DVec3::from_array(other.0)).length()
}

/// Mixes a part of a second color into a color.
pub(super) fn mixed(color: Color, other: Color, part: f64) -> Color {
    Color(std::array::from_fn(|k| color.0[k] + part * (other.0[k] - color.0[k])))
}

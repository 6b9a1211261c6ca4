//! The colors of the curves of a plot.

use super::super::colors::seen;
use crate::scene::{Color, Plot, PlotKind, Scene};

/// The colors of the curves or bars: that of the scene, that of the only body in a formula or of the first body of a histogram, or else one of a palette whose colors can be told apart.
pub(super) fn of_curves(scene: &Scene, plot: &Plot, dark: bool) -> Vec<Color> {
    let are_alike = plot.kind == PlotKind::Bars { are_copies: true };
    let mut colors: Vec<Option<Color>> = Vec::new();
    for curve in &plot.curves {
        if let Some(color) = curve.color.or_else(|| colors.first().copied().flatten().filter(|_| are_alike)) {
            colors.push(Some(color));
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
            is_legible && colors.iter().flatten().all(|other| difference(*own, *other) > 0.3)
        });
        colors.push(own);
        if are_alike && own.is_none() {
            colors = vec![Some(Color::OF_CURVES[0])];
        }
    }
    let given: Vec<Color> = colors.iter().flatten().copied().collect();
    let mut chosen: Vec<Color> = Vec::new();
    let mut free = || {
        let palette =
            Color::OF_CURVES.map(|color| if dark { mixed(color, Color::WHITE, 0.25) } else { color });
        let from = |others: &[Color], color: Color| {
            others.iter().map(|other| difference(color, *other)).fold(f64::INFINITY, f64::min)
        };
        // The colors of the palette can be told apart from each other, and the first ones best.
        let is_free = |color: &&Color| from(&given, **color) > 0.4 && from(&chosen, **color) > 0.1;
        let nearest = |color: &Color| from(&given, *color).min(from(&chosen, *color));
        let best = palette
            .iter()
            .find(is_free)
            .or_else(|| palette.iter().max_by(|one, other| nearest(one).total_cmp(&nearest(other))));
        let color = best.copied().unwrap_or(palette[0]);
        chosen.push(color);
        color
    };
    colors.into_iter().map(|color| color.unwrap_or_else(&mut free)).collect()
}

/// The distance of two colors in sRGB.
fn difference(one: Color, other: Color) -> f64 {
    (glam::DVec3::from_array(one.0) - glam::DVec3::from_array(other.0)).length()
}

/// Mixes a part of a second color into a color.
pub(super) fn mixed(color: Color, other: Color, part: f64) -> Color {
    Color(std::array::from_fn(|k| color.0[k] + part * (other.0[k] - color.0[k])))
}

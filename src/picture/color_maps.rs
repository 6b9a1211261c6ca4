//! The colors of bodies whose color follows a value, at each frame.

use std::sync::Arc;

use crate::scene::{Color, ColorMap, Scene};
use crate::simulate::{Frame, Measures, MomentState, Survey};

/// The color maps of a run.
#[derive(Clone, Debug)]
pub(super) struct ColorMaps {
    maps: Vec<Mapped>,
    measures: Arc<Measures>,
    /// The number of bodies in the scene.
    bodies: usize,
}

/// A color map, with the bodies that it colors.
#[derive(Clone, Debug)]
struct Mapped {
    map: ColorMap,
    /// The values of the first and the last color.
    range: [f64; 2],
    /// The bodies, as indices in the scene.
    bodies: Vec<usize>,
}

impl ColorMaps {
    /// Plans the colors of a run. `measures` are those of its scene.
    pub(super) fn new(scene: &Scene, survey: &Survey, measures: Arc<Measures>) -> ColorMaps {
        let of_map = |(number, map): (usize, &ColorMap)| {
            let bodies = scene.bodies.iter().enumerate();
            let bodies = bodies.filter(|(_, body)| scene.color_map_of(body) == Some(number));
            let range = survey.color_ranges.get(number).copied().unwrap_or([0.0, 1.0]);
            Mapped { map: map.clone(), range, bodies: bodies.map(|(id, _)| id).collect() }
        };
        let maps = scene.color_maps.iter().enumerate().map(of_map).collect();
        ColorMaps { maps, measures, bodies: scene.bodies.len() }
    }

    /// The colors of each map, from the lowest value to the highest; the last one is for undefined values.
    pub(super) fn colors(&self) -> Vec<Vec<Color>> {
        let colors = |mapped: &Mapped| {
            let mut colors = mapped.map.palette.colors(ColorMap::COLORS);
            colors.push(ColorMap::UNDEFINED);
            colors
        };
        self.maps.iter().map(colors).collect()
    }

    /// The color of each body in a frame, as an index into the [colors](ColorMaps::colors) of its map. Bodies without a map have 0. Empty if
    /// the scene has no maps.
    #[allow(clippy::cast_possible_truncation, reason = "there are 257 colors")]
    pub(super) fn at(&self, frame: &Frame) -> Vec<u16> {
        if self.maps.is_empty() {
            return Vec::new();
        }
        let moment = MomentState::now(frame);
        let mut colors = vec![0; self.bodies];
        for Mapped { map, range, bodies } in &self.maps {
            let values = self.measures.of_each(&map.of, bodies.iter().copied(), &moment);
            for (body, value) in bodies.iter().zip(values) {
                colors[*body] = ColorMap::color_of(value, *range).unwrap_or(ColorMap::COLORS) as u16;
            }
        }
        colors
    }
}

//! The colors of bodies whose color follows a value, at each frame, and of their ghosts.

use std::sync::Arc;

use crate::scene::{Color, ColorMap, Scene};
use crate::simulate::{Ghost, Measures, MomentState, Survey};

use super::colors::pale;

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
    /// The bodies, as indices in the scene, in increasing order.
    bodies: Vec<usize>,
    /// The colors of ghosts.
    pale: Vec<Color>,
}

/// Returns the index of the color of a value, given the values of the first and the last color. The last index is for undefined values.
#[allow(clippy::cast_possible_truncation, reason = "there are 257 colors")]
pub(super) fn shade(value: Option<f64>, range: [f64; 2]) -> u16 {
    value.and_then(|value| ColorMap::color_of(value, range)).unwrap_or(ColorMap::COLORS) as u16
}

/// Returns the colors of a map, from the lowest value to the highest; the last one is for undefined values.
fn colors(map: &ColorMap) -> Vec<Color> {
    let mut colors = map.palette.colors(ColorMap::COLORS);
    colors.push(ColorMap::UNDEFINED);
    colors
}

impl ColorMaps {
    /// Plans the colors of a run. `measures` are those of its scene.
    pub(super) fn new(scene: &Scene, survey: &Survey, measures: Arc<Measures>) -> ColorMaps {
        let of_map = |(number, map): (usize, &ColorMap)| {
            let bodies = scene.bodies.iter().enumerate();
            let bodies = bodies.filter(|(_, body)| scene.color_map_of(body) == Some(number));
            let range = survey.color_ranges.get(number).copied().unwrap_or([0.0, 1.0]);
            let is_dark = scene.environment.is_dark();
            let pale = colors(map).into_iter().map(|color| pale(color, is_dark)).collect();
            Mapped { map: map.clone(), range, bodies: bodies.map(|(id, _)| id).collect(), pale }
        };
        let maps = scene.color_maps.iter().enumerate().map(of_map).collect();
        ColorMaps { maps, measures, bodies: scene.bodies.len() }
    }

    /// The colors of each map, from the lowest value to the highest; the last one is for undefined values.
    pub(super) fn colors(&self) -> Vec<Vec<Color>> {
        self.maps.iter().map(|mapped| colors(&mapped.map)).collect()
    }

    /// The color of a value, as an index into the [colors](ColorMaps::colors) of a map.
    pub(super) fn shade(&self, map: usize, value: Option<f64>) -> u16 {
        shade(value, self.maps[map].range)
    }

    /// The color of a ghost, which follows the value at the time of the ghost. `None` if the color of its body stays.
    pub(super) fn of_ghost(&self, ghost: &Ghost) -> Option<Color> {
        let is_of = |mapped: &&Mapped| mapped.bodies.binary_search(&ghost.body.id).is_ok();
        let Mapped { range, pale, .. } = self.maps.iter().find(is_of)?;
        pale.get(usize::from(shade(ghost.look.color, *range))).copied()
    }

    /// The color of each body at a frame, as an index into the [colors](ColorMaps::colors) of its map. Bodies without a map have 0. Empty if
    /// the scene has no maps.
    pub(super) fn at(&self, moment: &MomentState<'_>) -> Vec<u16> {
        if self.maps.is_empty() {
            return Vec::new();
        }
        let mut colors = vec![0; self.bodies];
        for Mapped { map, range, bodies, .. } in &self.maps {
            let values = self.measures.of_each(&map.of, bodies.iter().copied(), moment);
            for (body, value) in bodies.iter().zip(values) {
                colors[*body] = shade(Some(value), *range);
            }
        }
        colors
    }
}

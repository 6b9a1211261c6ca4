//! Finds the ranges of color maps whose range the scene does not give.

use crate::scene::{ColorMap, Scene};
use crate::simulate::{Measures, MomentState};

/// Finds the lowest and the highest value of each color map in a run.
pub(super) struct ColorRanges<'a> {
    maps: &'a [ColorMap],
    /// The bodies of each map, as indices in the scene. Empty if the scene gives the range.
    bodies: Vec<Vec<usize>>,
    measures: Measures,
    /// The range of each map so far. `None` before its first finite value.
    found: Vec<Option<[f64; 2]>>,
}

impl<'a> ColorRanges<'a> {
    pub(super) fn new(scene: &'a Scene) -> ColorRanges<'a> {
        let maps = &scene.color_maps;
        let mut bodies = vec![Vec::new(); maps.len()];
        for (number, body) in scene.bodies.iter().enumerate() {
            if let Some(map) = scene.color_map_of(body).filter(|map| maps[*map].range.is_none()) {
                bodies[map].push(number);
            }
        }
        let found = maps.iter().map(|map| map.range).collect();
        ColorRanges { maps, bodies, measures: Measures::new(scene), found }
    }

    /// Widens the ranges by the values of the next frame.
    pub(super) fn see(&mut self, moment: &MomentState<'_>) {
        for ((map, bodies), found) in self.maps.iter().zip(&self.bodies).zip(&mut self.found) {
            let values = self.measures.of_each(&map.of, bodies.iter().copied(), moment);
            for value in values.filter(|value| value.is_finite()) {
                let [low, high] = found.unwrap_or([value; 2]);
                *found = Some([low.min(value), high.max(value)]);
            }
        }
    }

    /// Returns the values of the first and the last color of each map.
    pub(super) fn finish(self) -> Vec<[f64; 2]> {
        self.found.into_iter().map(|range| range.unwrap_or([0.0, 1.0])).collect()
    }
}

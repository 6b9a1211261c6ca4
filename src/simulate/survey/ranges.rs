//! Finds the ranges of color maps and of the maps of other looks, as far as the scene does not give them.

use crate::scene::{Body, LookAspect, MeasureFormula, Scene};
use crate::simulate::{Measures, MomentState};

/// Finds the lowest and the highest value of each map in a run.
pub(super) struct Ranges<'a> {
    /// The color maps, then the maps of numbers.
    maps: Vec<Found<'a>>,
    /// The number of color maps.
    colors: usize,
}

/// The values of a map so far.
struct Found<'a> {
    of: &'a MeasureFormula,
    /// The bodies of the map, as indices in the scene. Empty if the scene gives the range.
    bodies: Vec<usize>,
    /// The range so far. `None` before the first finite value.
    range: Option<[f64; 2]>,
}

impl<'a> Ranges<'a> {
    pub(super) fn new(scene: &'a Scene) -> Ranges<'a> {
        let of_colors = scene.color_maps.iter().map(|map| (&map.of, map.range));
        let of_numbers = scene.value_maps.iter().map(|map| (&map.of, map.range));
        let found = |(of, range)| Found { of, bodies: Vec::new(), range };
        let mut maps: Vec<Found<'a>> = of_colors.chain(of_numbers).map(found).collect();
        let colors = scene.color_maps.len();
        let bodies = if maps.is_empty() { &[] } else { &scene.bodies[..] };
        for (number, body) in bodies.iter().enumerate() {
            for map in
                scene.color_map_of(body).into_iter().chain(numbers(scene, body).map(|map| colors + map))
            {
                let is_searched = maps[map].range.is_none() && maps[map].bodies.last() != Some(&number);
                if is_searched {
                    maps[map].bodies.push(number);
                }
            }
        }
        Ranges { maps, colors }
    }

    /// Widens the ranges by the values of the next frame. `measures` are those of the scene.
    pub(super) fn see(&mut self, moment: &MomentState<'_>, measures: &Measures) {
        for Found { of, bodies, range } in &mut self.maps {
            let values = measures.of_each(of, bodies.iter().copied(), moment);
            for value in values.filter(|value| value.is_finite()) {
                let [low, high] = range.unwrap_or([value; 2]);
                *range = Some([low.min(value), high.max(value)]);
            }
        }
    }

    /// Returns the values of the first and the last color of each color map, and those of the first and the last number of each other map.
    pub(super) fn finish(self) -> (Vec<[f64; 2]>, Vec<[f64; 2]>) {
        let mut ranges: Vec<[f64; 2]> =
            self.maps.into_iter().map(|found| found.range.unwrap_or([0.0, 1.0])).collect();
        let of_numbers = ranges.split_off(self.colors);
        (ranges, of_numbers)
    }
}

/// Returns the maps that the numbers of a body's look follow, as indices in the scene.
fn numbers<'a>(scene: &'a Scene, body: &'a Body) -> impl Iterator<Item = usize> + 'a {
    LookAspect::ALL.into_iter().filter_map(|aspect| scene.value_map_of(body, aspect))
}

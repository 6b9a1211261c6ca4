//! The values that the colors of trails and ghosts follow.

use crate::scene::{MeasureFormula, Scene};
use crate::simulate::{Measures, MomentState};

/// Computes the values that the colors of trails and ghosts follow, at the moments at which these are kept.
pub(super) struct Values {
    measures: Measures,
    /// The formula of each color map of the scene.
    formulas: Vec<MeasureFormula>,
    /// The color map of each body of the scene that has a trail or ghosts. `None` if its color stays.
    maps: Vec<Option<usize>>,
}

impl Values {
    /// Prepares the values of a scene. `None` if no color of a trail or a ghost follows a value.
    pub(super) fn new(scene: &Scene) -> Option<Values> {
        let has_past = |showing: &crate::scene::Showing| showing.trail.is_some() || showing.ghosts.is_some();
        let map = |body: &crate::scene::Body| scene.color_map_of(body).filter(|_| has_past(&body.showing));
        let maps: Vec<Option<usize>> = scene.bodies.iter().map(map).collect();
        maps.iter().any(Option::is_some).then(|| Values {
            measures: Measures::new(scene),
            formulas: scene.color_maps.iter().map(|map| map.of.clone()).collect(),
            maps,
        })
    }

    /// Returns the value that the color of a body follows, at a moment. `None` if the color stays, or if the value is not finite.
    pub(super) fn of(&self, body: usize, moment: &MomentState<'_>) -> Option<f64> {
        let formula = &self.formulas[self.maps[body]?];
        let value = self.measures.of_each(formula, std::iter::once(body), moment).next();
        value.filter(|value| value.is_finite())
    }
}

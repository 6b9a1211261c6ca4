//! The values that the looks of trails and ghosts follow.

use super::GhostLook;
use crate::scene::{LookAspect, MeasureFormula, Scene, Visibility};
use crate::simulate::{Measures, MomentState, is_true};

/// Computes the values that the looks of trails and ghosts follow, at the moments at which these are kept.
pub(super) struct Values {
    measures: Measures,
    /// What each body of the scene needs. Empty for a body without a trail and ghosts.
    bodies: Vec<Needed>,
}

/// The formulas that the look of a body's trail and ghosts follows.
#[derive(Default)]
struct Needed {
    color: Option<MeasureFormula>,
    scale: Option<MeasureFormula>,
    condition: Option<MeasureFormula>,
    is_never_drawn: bool,
}

impl Values {
    /// Prepares the values of a scene. `None` if no trail and no ghost has a look that follows a value.
    pub(super) fn new(scene: &Scene) -> Option<Values> {
        let mut needs_any = false;
        let mut bodies = Vec::new();
        for body in &scene.bodies {
            let mut needed = Needed::default();
            if body.showing.trail.is_some() || body.showing.ghosts.is_some() {
                needed.color = scene.color_map_of(body).map(|map| scene.color_maps[map].of.clone());
            }
            if body.showing.ghosts.is_some() {
                let scale = scene.value_map_of(body, LookAspect::Scale);
                needed.scale = scale.map(|map| scene.value_maps[map].of.clone());
                match body.look.visible {
                    Visibility::Always => {}
                    Visibility::Never => needed.is_never_drawn = true,
                    Visibility::While(condition) => {
                        needed.condition = Some(scene.conditions[condition].clone());
                    }
                }
            }
            let follows = [&needed.color, &needed.scale, &needed.condition];
            needs_any |= needed.is_never_drawn || follows.into_iter().any(Option::is_some);
            bodies.push(needed);
        }
        needs_any.then(|| Values { measures: Measures::new(scene), bodies })
    }

    /// Returns the value that the color of a body's trail follows, at a moment. `None` if the color never changes, or if the value is not finite.
    pub(super) fn of_trail(&self, body: usize, moment: &MomentState<'_>) -> Option<f64> {
        self.value(self.bodies[body].color.as_ref(), body, moment)
    }

    /// Returns the values that the look of a ghost follows, at its moment.
    pub(super) fn of_ghost(&self, body: usize, moment: &MomentState<'_>) -> GhostLook {
        let Needed { color, scale, condition, is_never_drawn } = &self.bodies[body];
        let value = |formula: &Option<MeasureFormula>| self.value(formula.as_ref(), body, moment);
        let holds = condition.is_none() || value(condition).is_some_and(is_true);
        GhostLook { color: value(color), scale: value(scale), is_drawn: holds && !is_never_drawn }
    }

    fn value(&self, formula: Option<&MeasureFormula>, body: usize, moment: &MomentState<'_>) -> Option<f64> {
        let value = self.measures.of_each(formula?, std::iter::once(body), moment).next();
        value.filter(|value| value.is_finite())
    }
}

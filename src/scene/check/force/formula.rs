//! Reads forces given by formulas, and compares each force with the gradient of its potential.

use std::sync::Arc;

use glam::DVec3;

use super::super::view::View;
use super::Reader;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::BodyId;
use crate::scene::ForceKind;
use crate::scene::expand::in_string;
use crate::scene::expression::ExpressionError;
use crate::scene::force_formula::{BodyFormula, FormulaLaw, QUANTITIES, quantities};
use crate::scene::grammar::forces::formula;

/// The maximum number of bodies for which a formula is evaluated in the initial state.
const MAX_CHECKED_BODIES: usize = 1000;
/// The largest accepted difference between a force and minus the gradient of its potential, relative to the larger of the two. Derivatives
/// are exact except for rounding errors, which grow where terms cancel.
const RELATIVE_TOLERANCE: f64 = 1e-6;

/// The values of the [`QUANTITIES`] for one body, in the same order.
type Quantities = [f64; QUANTITIES.len()];

impl Reader<'_, '_> {
    pub(super) fn formula(&mut self, view: &View<'_>) -> Option<ForceKind> {
        let bodies = self.movable(view);
        let force = view.get(&formula::FORCE)?;
        let potential = match view.has(&formula::POTENTIAL) {
            true => Some(view.get(&formula::POTENTIAL)?),
            false => None,
        };
        let law = match FormulaLaw::new(force, potential) {
            Ok(law) => law,
            Err(error) => {
                let span = view.span(&formula::POTENTIAL).unwrap_or(self.span);
                let diagnostic = Diagnostic::error(error.code, error.message).at(span, error.label);
                self.context.diagnostics.push(error.help.into_iter().fold(diagnostic, Diagnostic::help));
                return None;
            }
        };
        self.has_value_at_start(&law, &bodies);
        if let Some(span) = view.span(&formula::POTENTIAL) {
            self.belongs_to_force(&law, &bodies, view, span);
        }
        Some(ForceKind::Formula { bodies, law: Arc::new(law) })
    }

    /// Reports a formula that has no finite value in the initial state of a body that the force can move.
    fn has_value_at_start(&mut self, law: &FormulaLaw, on: &[BodyId]) {
        let bodies = self.bodies;
        let is_there = |body: &&BodyId| {
            let body = &bodies[body.index()];
            body.motion.is_none() && !body.start.fixed && body.presence.at(0.0)
        };
        for id in on.iter().filter(is_there).take(MAX_CHECKED_BODIES) {
            let start = &bodies[id.index()].start;
            let here = quantities(start.location, start.velocity, start.mass, start.charge, 0.0);
            if let Some((formula, error)) = law.explain(&here) {
                let message = format!("{}, at the start of `{}`", error.message, bodies[id.index()].name);
                self.say_of_formula(formula, error, message);
                return;
            }
        }
    }

    fn say_of_formula(&mut self, formula: &BodyFormula, error: ExpressionError, message: String) {
        let span = formula.span();
        let sources = &self.context.sources;
        let raw = sources.raw(span);
        let place = in_string(raw, formula.text(), &error.range, span);
        let help = error.help;
        self.report(error.code, span, || {
            let diagnostic = Diagnostic::error(error.code, message).at(place, error.label);
            help.into_iter().fold(diagnostic, Diagnostic::help)
        });
    }

    /// Reports a potential that does not match its force. At each of the [`places`](Self::places), the force on a body at rest must equal
    /// minus the gradient of the potential.
    fn belongs_to_force(&mut self, law: &FormulaLaw, on: &[BodyId], view: &View<'_>, potential: Span) {
        let (mut is_compared, mut first) = (false, None);
        for place in self.places(law, on) {
            let (force, gradient) = law.compare(&place);
            if !(force.is_finite() && gradient.is_finite()) {
                first = first.or(Some(place));
                continue;
            }
            is_compared = true;
            let (off, most) = (force - gradient, force.length().max(gradient.length()));
            if off.length() <= RELATIVE_TOLERANCE * most {
                continue;
            }
            let axis = (0..3).max_by(|a, b| off[*a].abs().total_cmp(&off[*b].abs())).unwrap_or(0);
            let items = view.node(&formula::FORCE).map(|node| &node.value);
            let item = match items {
                Some(crate::scene::source::Value::Array(items)) => items.get(axis).map(|item| item.span),
                _ => None,
            };
            let [x, y, z] = [place[0], place[1], place[2]].map(short);
            let message = format!("the potential of `{}` does not belong to its force", self.name);
            let letter = QUANTITIES[axis];
            let slope = format!("−∂U/∂{letter} is {} N at [{x}, {y}, {z}] m", short(gradient[axis]));
            let error = Diagnostic::error(Code::WrongPotential, message).at(potential, slope);
            let there = format!("a body at rest feels {} N there", short(force[axis]));
            let error = error.at(item.unwrap_or(potential), there);
            let help = if law.depends_on_time() {
                "a potential is the same at all times: write the part that changes as a force of its own"
            } else {
                "of a body at rest, the force is −∂U/∂x, −∂U/∂y, −∂U/∂z; without `potential`, its work is counted"
            };
            self.report(Code::WrongPotential, potential, || error.help(help));
            return;
        }
        if let (false, Some(place)) = (is_compared, first)
            && let Some((formula, error)) = law.explain(&place)
        {
            let message = format!("{}, for a body at rest", error.message);
            self.say_of_formula(formula, error, message);
        }
    }

    /// Returns sample points around the initial locations of the bodies, with zero velocity. If the force depends on time, the list
    /// contains each point at several times. The coordinates are not round numbers, at which a wrong formula might be right by chance.
    fn places(&self, law: &FormulaLaw, on: &[BodyId]) -> Vec<Quantities> {
        /// The direction and the length of the offset from the body to each sample point. Lengths are relative to the body's distance from
        /// the origin.
        const SAMPLE_OFFSETS: [([f64; 3], f64); 6] = [
            ([0.618, -0.414, 0.732], 0.001),
            ([-0.577, 0.693, 0.302], 0.03),
            ([0.841, 0.540, -0.271], 0.3),
            ([-0.367, -0.905, 0.549], 0.3),
            ([0.416, 0.279, 0.909], 1.0),
            ([-0.731, -0.163, -0.682], 1.0),
        ];
        /// The maximum number of bodies around which points are sampled. The same limit applies to emitters.
        const MAX_SAMPLED_BODIES: usize = 50;
        let starts = on.iter().take(MAX_SAMPLED_BODIES).map(|id| {
            let start = &self.bodies[id.index()].start;
            (start.location, start.mass, start.charge)
        });
        let particles = self.emitters.iter().map(|it| (DVec3::ZERO, it.source.mass, it.source.charge));
        let end = self.simulation.timeline.end();
        let times: &[f64] = if law.depends_on_time() { &[0.0, 0.37, 0.91] } else { &[0.0] };
        let mut places = Vec::new();
        for (location, mass, charge) in starts.chain(particles.take(MAX_SAMPLED_BODIES)) {
            let far = location.length();
            let far = if far > 0.0 { far } else { 1.0 };
            for (step, distance) in SAMPLE_OFFSETS {
                let place = location + far * distance * DVec3::from_array(step);
                let at = |time: &f64| quantities(place, DVec3::ZERO, mass, charge, time * end);
                places.extend(times.iter().map(at));
            }
        }
        places
    }
}

/// Rounds a number to six significant digits.
fn short(number: f64) -> f64 {
    format!("{number:.5e}").parse().unwrap_or(number)
}

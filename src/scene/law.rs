//! Forces that formulas define, from the location, the velocity and the properties of a body.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::expression::{ExpressionError, LANES, Output, Resolved, Wide, too_intricate};
use crate::diagnostic::Span;
use crate::dynamics::{BodyId, FORCE_BLOCK, ForceLaw, Moment, Undefined, in_a_row};

/// The quantities that a force formula can use. The first six are those that a potential can use too.
pub const QUANTITIES: &[&str] = &["x", "y", "z", "r", "mass", "charge", "vx", "vy", "vz", "speed", "t"];

/// The quantities that a potential can use: location, mass and charge.
pub const OF_PLACE: &[&str] = QUANTITIES.split_at(6).0;

/// The indices of quantities in [`QUANTITIES`].
const R: usize = 3;
const MASS: usize = 4;
const CHARGE: usize = 5;
const VX: usize = 6;
const SPEED: usize = 9;
const TIME: usize = 10;

const _: () = assert!(FORCE_BLOCK == LANES);

/// A formula of the quantities of a body, with resolved names.
pub struct BodyFormula {
    text: Arc<str>,
    span: Span,
    resolved: Resolved,
}

impl BodyFormula {
    /// Creates a formula. `span` is its place in the text. Its slots are [`QUANTITIES`], in that order.
    pub(super) fn new(text: Arc<str>, span: Span, resolved: Resolved) -> BodyFormula {
        BodyFormula { text, span, resolved }
    }

    /// The formula as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The place of the formula in the text.
    pub fn span(&self) -> Span {
        self.span
    }
}

impl fmt::Debug for BodyFormula {
    // Leave the place out: equal formulas at different places have the same text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.resolved.fmt(f)
    }
}

/// A number, or a formula of the quantities of a body.
#[derive(Clone, Debug)]
pub enum OfBody {
    /// The same number for all bodies.
    Constant(f64),
    /// A formula of the quantities of the body.
    Formula(Arc<BodyFormula>),
}

impl OfBody {
    fn resolved(&self) -> Resolved {
        match self {
            OfBody::Constant(number) => Resolved::of_number(*number, QUANTITIES.len()),
            OfBody::Formula(formula) => formula.resolved.clone(),
        }
    }
}

/// The force on a body by formulas, and its potential, if the scene gives one.
pub struct FormulaLaw {
    force: [OfBody; 3],
    potential: Option<OfBody>,
    program: Wide,
    energy: Option<Wide>,
    /// ∂U/∂x, ∂U/∂y and ∂U/∂z with r held constant, and ∂U/∂r.
    slopes: Option<Wide>,
}

impl fmt::Debug for FormulaLaw {
    // Leave the programs out: they are compiled from the formulas.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("FormulaLaw").field(&self.force).field(&self.potential).finish()
    }
}

impl FormulaLaw {
    /// Compiles the formulas of a force and its potential.
    ///
    /// # Errors
    /// If the derivatives of the potential are too long.
    pub fn new(force: [OfBody; 3], potential: Option<OfBody>) -> Result<FormulaLaw, ExpressionError> {
        /// The largest number of operations in a derivative; enough for formulas of up to a thousand characters.
        const MOST: u64 = 100_000;
        let formulas = force.each_ref().map(OfBody::resolved);
        let program = Wide::new(&formulas.each_ref());
        let energy = potential.as_ref().map(OfBody::resolved);
        let mut slopes = None;
        if let (Some(energy), Some(OfBody::Formula(formula))) = (&energy, &potential) {
            let each = [0, 1, 2, R].map(|slot| energy.derivative(slot));
            if each.iter().any(|slope| slope.operations() > MOST) {
                let message =
                    "the derivatives of this potential are too long, by which it is held against the force";
                return Err(too_intricate(0..formula.text.len(), message));
            }
            slopes = Some(Wide::new(&each.each_ref()));
        }
        let energy = energy.map(|energy| Wide::new(&[&energy]));
        Ok(FormulaLaw { force, potential, program, energy, slopes })
    }

    /// Whether the force depends on the time.
    pub fn depends_on_time(&self) -> bool {
        self.program.uses(TIME)
    }

    /// Whether the force depends on the charge of the body.
    pub fn depends_on_charge(&self) -> bool {
        self.program.uses(CHARGE)
    }

    /// Whether the force depends on the mass of the body.
    pub fn depends_on_mass(&self) -> bool {
        self.program.uses(MASS)
    }

    /// Finds the first formula that has no finite value for these quantities, and the reason. `None` if all values are
    /// finite.
    pub fn explain(&self, quantities: &[f64]) -> Option<(&BodyFormula, ExpressionError)> {
        self.force.iter().chain(&self.potential).find_map(|formula| match formula {
            OfBody::Constant(_) => None,
            OfBody::Formula(formula) => {
                formula.resolved.explain_non_finite(quantities).map(|error| (&**formula, error))
            }
        })
    }

    /// The force on a body at rest, and the negative gradient of the potential there, both N. A check compares the two.
    pub(super) fn compare(&self, quantities: &[f64]) -> (DVec3, DVec3) {
        let (mut force, mut gradient) = (DVec3::ZERO, DVec3::ZERO);
        let fill = |slot: usize, column: &mut [f64]| column[0] = quantities[slot];
        self.program
            .run(1, fill, |values: [_; 3]| force = DVec3::from_array(values.map(|value| value.at(0))));
        if let Some(slopes) = &self.slopes {
            slopes.run(1, fill, |values: [_; 4]| {
                let [x, y, z, r] = values.map(|value| value.at(0));
                let place = DVec3::new(quantities[0], quantities[1], quantities[2]);
                let outwards = if quantities[R] > 0.0 { place / quantities[R] } else { DVec3::ZERO };
                gradient = DVec3::new(x, y, z) + r * outwards;
            });
        }
        (force, -gradient)
    }
}

/// The quantities of a body, in the order of [`QUANTITIES`]: SI units.
pub fn quantities(
    location: DVec3,
    velocity: DVec3,
    mass: f64,
    charge: f64,
    time: f64,
) -> [f64; QUANTITIES.len()] {
    let ([x, y, z], [vx, vy, vz]) = (location.to_array(), velocity.to_array());
    [x, y, z, location.length(), mass, charge, vx, vy, vz, velocity.length(), time]
}

/// The quantities of a body at the place and time at which a force had no value.
pub fn quantities_at(at: &Undefined, mass: f64, charge: f64) -> [f64; QUANTITIES.len()] {
    quantities(at.location, at.velocity, mass, charge, at.time)
}

/// Fills a column with one quantity of some bodies. `row` is the range of their indices, if the indices are
/// consecutive.
fn fill(
    slot: usize,
    (bodies, row): (&[BodyId], Option<&Range<usize>>),
    moment: &Moment,
    at_rest: bool,
    column: &mut [f64],
) {
    let (state, model) = (moment.state, moment.model);
    match (slot, row) {
        (0..3, Some(row)) => return copy(&state.location[row.clone()], slot, column),
        (VX..SPEED, Some(row)) if !at_rest => return copy(&state.velocity[row.clone()], slot - VX, column),
        _ => {}
    }
    let each = column.iter_mut().zip(bodies.iter().map(|body| body.index()));
    match slot {
        TIME => column.fill(moment.time),
        VX..=SPEED if at_rest => column.fill(0.0),
        0..3 => each.for_each(|(to, i)| *to = state.location[i][slot]),
        R => each.for_each(|(to, i)| *to = state.location[i].length()),
        MASS => each.for_each(|(to, i)| *to = model.mass()[i]),
        CHARGE => each.for_each(|(to, i)| *to = model.charge()[i]),
        SPEED => each.for_each(|(to, i)| *to = state.velocity[i].length()),
        _ => each.for_each(|(to, i)| *to = state.velocity[i][slot - VX]),
    }
}

/// Copies one component of each vector into a column.
fn copy(from: &[DVec3], component: usize, column: &mut [f64]) {
    let each = column.iter_mut().zip(from);
    match component {
        0 => each.for_each(|(to, from)| *to = from.x),
        1 => each.for_each(|(to, from)| *to = from.y),
        _ => each.for_each(|(to, from)| *to = from.z),
    }
}

impl ForceLaw for FormulaLaw {
    fn force(&self, bodies: &[BodyId], moment: &Moment, at_rest: bool, out: &mut [DVec3]) {
        let row = in_a_row(bodies);
        let bodies = (bodies, row.as_ref());
        let fill = |slot: usize, column: &mut [f64]| fill(slot, bodies, moment, at_rest, column);
        let mut room = [[0.0; LANES]; 3];
        self.program.run(out.len(), fill, |values: [Output<'_>; 3]| {
            let [a, b, c] = &mut room;
            let [x, y, z] = values;
            let all = out.iter_mut().zip(x.column(a)).zip(y.column(b)).zip(z.column(c));
            all.for_each(|(((out, x), y), z)| *out = DVec3::new(*x, *y, *z));
        });
    }

    fn potential(&self, bodies: &[BodyId], moment: &Moment, out: &mut [f64]) {
        let Some(energy) = &self.energy else { return out.fill(0.0) };
        let fill = |slot: usize, column: &mut [f64]| fill(slot, (bodies, None), moment, true, column);
        energy.run(bodies.len(), fill, |[value]| {
            out.iter_mut().enumerate().for_each(|(lane, out)| *out = value.at(lane));
        });
    }

    fn has_potential(&self) -> bool {
        self.potential.is_some()
    }

    fn depends_on_velocity(&self) -> bool {
        (VX..=SPEED).any(|slot| self.program.uses(slot))
    }
}

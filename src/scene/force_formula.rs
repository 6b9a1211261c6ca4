//! Forces given by formulas of the location, the velocity and the properties of a body.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::expression::{ExpressionError, MAX_LANES, Output, Resolved, Wide, too_intricate};
use crate::diagnostic::Span;
use crate::physics::{BodyId, FORCE_BLOCK, ForceLaw, Moment, Undefined, in_a_row};

/// The names of the quantities that a force formula can use. A potential can use only the first six.
pub const QUANTITIES: &[&str] = &["x", "y", "z", "r", "mass", "charge", "vx", "vy", "vz", "speed", "t"];

/// The names of the quantities that a potential can use: location, mass and charge.
pub const OF_PLACE: &[&str] = QUANTITIES.split_at(6).0;

/// The index of the distance from the origin in [`QUANTITIES`].
const R_SLOT: usize = 3;
/// The index of the mass in [`QUANTITIES`].
const MASS_SLOT: usize = 4;
/// The index of the charge in [`QUANTITIES`].
const CHARGE_SLOT: usize = 5;
/// The index of the first component of the velocity in [`QUANTITIES`].
const VX_SLOT: usize = 6;
/// The index of the speed in [`QUANTITIES`]. It follows the components of the velocity.
const SPEED_SLOT: usize = 9;
/// The index of the time in [`QUANTITIES`].
const TIME_SLOT: usize = 10;

const _: () = assert!(FORCE_BLOCK == MAX_LANES);

/// A formula of a body's quantities, such as its location and velocity.
pub struct BodyFormula {
    text: Arc<str>,
    span: Span,
    resolved: Resolved,
}

impl BodyFormula {
    /// Creates a formula. `span` is its position in the scene's text. Its input slots are the [`QUANTITIES`], in the same order.
    pub(super) fn new(text: Arc<str>, span: Span, resolved: Resolved) -> BodyFormula {
        BodyFormula { text, span, resolved }
    }

    /// Returns the formula as written in the scene.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the position of the formula in the scene's text.
    pub fn span(&self) -> Span {
        self.span
    }
}

impl fmt::Debug for BodyFormula {
    // Omit the source span: equal formulas at different positions shall print the same text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.resolved.fmt(f)
    }
}

/// A constant number, or a formula of a body's quantities.
#[derive(Clone, Debug)]
pub enum OfBody {
    /// A number that is the same for all bodies.
    Constant(f64),
    /// A formula of the body's location, velocity, mass, charge and the time.
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

/// The compiled formulas for the force on a body, and for its potential if the scene gives one.
pub struct FormulaLaw {
    force: [OfBody; 3],
    potential: Option<OfBody>,
    program: Wide,
    energy: Option<Wide>,
    /// The derivatives of the potential U: ∂U/∂x, ∂U/∂y and ∂U/∂z at constant r, and ∂U/∂r.
    slopes: Option<Wide>,
}

impl fmt::Debug for FormulaLaw {
    // Omit the programs, because they are compiled from the formulas.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("FormulaLaw").field(&self.force).field(&self.potential).finish()
    }
}

impl FormulaLaw {
    /// Returns whether the scene gives the potential of the force.
    pub fn has_potential(&self) -> bool {
        self.potential.is_some()
    }

    /// Compiles the formulas of a force and its potential.
    ///
    /// # Errors
    /// If the derivatives of the potential are too long.
    pub fn new(force: [OfBody; 3], potential: Option<OfBody>) -> Result<FormulaLaw, ExpressionError> {
        /// The maximum number of operations in a derivative. This is enough for formulas of up to a thousand characters.
        const MAX_DERIVATIVE_OPERATIONS: u64 = 100_000;
        let formulas = force.each_ref().map(OfBody::resolved);
        let program = Wide::new(&formulas.each_ref());
        let energy = potential.as_ref().map(OfBody::resolved);
        let mut slopes = None;
        if let (Some(energy), Some(OfBody::Formula(formula))) = (&energy, &potential) {
            let each = [0, 1, 2, R_SLOT].map(|slot| energy.derivative(slot));
            if each.iter().any(|slope| slope.operations() > MAX_DERIVATIVE_OPERATIONS) {
                let message =
                    "the derivatives of this potential are too long, by which it is held against the force";
                return Err(too_intricate(0..formula.text.len(), message));
            }
            slopes = Some(Wide::new(&each.each_ref()));
        }
        let energy = energy.map(|energy| Wide::new(&[&energy]));
        Ok(FormulaLaw { force, potential, program, energy, slopes })
    }

    /// Returns whether the force depends on the time.
    pub fn depends_on_time(&self) -> bool {
        self.program.uses(TIME_SLOT)
    }

    /// Returns whether the force depends on the charge of the body.
    pub fn depends_on_charge(&self) -> bool {
        self.program.uses(CHARGE_SLOT)
    }

    /// Returns whether the force depends on the mass of the body.
    pub fn depends_on_mass(&self) -> bool {
        self.program.uses(MASS_SLOT)
    }

    /// Returns the first formula that has no finite value for these quantities, with the reason. `None` if all values are finite.
    pub fn explain(&self, quantities: &[f64]) -> Option<(&BodyFormula, ExpressionError)> {
        self.force.iter().chain(&self.potential).find_map(|formula| match formula {
            OfBody::Constant(_) => None,
            OfBody::Formula(formula) => {
                formula.resolved.explain_non_finite(quantities).map(|error| (&**formula, error))
            }
        })
    }

    /// Returns the force and the negative gradient of the potential for these quantities, both in N. The check requires that the two are
    /// equal for a body at rest.
    pub(super) fn compare(&self, quantities: &[f64]) -> (DVec3, DVec3) {
        let (mut force, mut gradient) = (DVec3::ZERO, DVec3::ZERO);
        let fill = |slot: usize, column: &mut [f64]| column[0] = quantities[slot];
        self.program
            .run(1, fill, |values: [_; 3]| force = DVec3::from_array(values.map(|value| value.at(0))));
        if let Some(slopes) = &self.slopes {
            slopes.run(1, fill, |values: [_; 4]| {
                let [x, y, z, r] = values.map(|value| value.at(0));
                let place = DVec3::new(quantities[0], quantities[1], quantities[2]);
                let outwards =
                    if quantities[R_SLOT] > 0.0 { place / quantities[R_SLOT] } else { DVec3::ZERO };
                gradient = DVec3::new(x, y, z) + r * outwards;
            });
        }
        (force, -gradient)
    }
}

/// Returns the quantities of a body in SI units, in the order of [`QUANTITIES`].
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

/// Returns the quantities of a body at the location, velocity and time at which a force had no finite value.
pub fn quantities_at(at: &Undefined, mass: f64, charge: f64) -> [f64; QUANTITIES.len()] {
    quantities(at.location, at.velocity, mass, charge, at.time)
}

/// Fills a column with one quantity of each body. `row` is the range of the bodies' indices if the indices are consecutive.
fn fill(
    slot: usize,
    bodies: &[BodyId],
    row: Option<&Range<usize>>,
    moment: &Moment,
    at_rest: bool,
    column: &mut [f64],
) {
    let (state, model) = (moment.state, moment.model);
    match (slot, row) {
        (0..3, Some(row)) => return copy(&state.location[row.clone()], slot, column),
        (VX_SLOT..SPEED_SLOT, Some(row)) if !at_rest => {
            return copy(&state.velocity[row.clone()], slot - VX_SLOT, column);
        }
        _ => {}
    }
    let each = column.iter_mut().zip(bodies.iter().map(|body| body.index()));
    match slot {
        TIME_SLOT => column.fill(moment.time),
        VX_SLOT..=SPEED_SLOT if at_rest => column.fill(0.0),
        0..3 => each.for_each(|(to, i)| *to = state.location[i][slot]),
        R_SLOT => each.for_each(|(to, i)| *to = state.location[i].length()),
        MASS_SLOT => each.for_each(|(to, i)| *to = model.mass()[i]),
        CHARGE_SLOT => each.for_each(|(to, i)| *to = model.charge()[i]),
        SPEED_SLOT => each.for_each(|(to, i)| *to = state.velocity[i].length()),
        _ => each.for_each(|(to, i)| *to = state.velocity[i][slot - VX_SLOT]),
    }
}

/// Copies one component (0 for x, 1 for y, 2 for z) of each vector into a column.
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
        let fill =
            |slot: usize, column: &mut [f64]| fill(slot, bodies, row.as_ref(), moment, at_rest, column);
        let mut room = [[0.0; MAX_LANES]; 3];
        self.program.run(out.len(), fill, |values: [Output<'_>; 3]| {
            let [a, b, c] = &mut room;
            let [x, y, z] = values;
            let all = out.iter_mut().zip(x.column(a)).zip(y.column(b)).zip(z.column(c));
            all.for_each(|(((out, x), y), z)| *out = DVec3::new(*x, *y, *z));
        });
    }

    fn potential(&self, bodies: &[BodyId], moment: &Moment, out: &mut [f64]) {
        let Some(energy) = &self.energy else { return out.fill(0.0) };
        let fill = |slot: usize, column: &mut [f64]| fill(slot, bodies, None, moment, true, column);
        energy.run(bodies.len(), fill, |[value]| {
            out.iter_mut().enumerate().for_each(|(lane, out)| *out = value.at(lane));
        });
    }

    fn has_potential(&self) -> bool {
        self.potential.is_some()
    }

    fn depends_on_velocity(&self) -> bool {
        (VX_SLOT..=SPEED_SLOT).any(|slot| self.program.uses(slot))
    }
}

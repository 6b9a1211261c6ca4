//! The solver of all constraints: their forces, and the projection onto them.
//!
//! With A = J M⁻¹ Jᵀ, the solver finds multipliers at three levels. The forces λ with A λ = −(J a + J̇ v) correct accelerations. The
//! impulses Λ with A Λ = −J v correct velocities. With A Λ = −c, the shifts M⁻¹ Jᵀ Λ correct positions. Source: E. Hairer, C. Lubich & G.
//! Wanner, *Geometric Numerical Integration*, 2nd ed., IV.4 and VII.1.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::super::contact::Closed;
use super::super::{Breakdown, Model, Motion, State};
use super::columns::Columns;
use super::factor::Factor;
use super::friction::Grip;
use super::member::{Member, Nature};
use super::modes::Mode;
use super::structure::{Place, Structure};
use super::warm::Warm;
use super::{Constraint, Direction, Equations, Law, Members, Row};

/// A constraint fails if its error still exceeds this fraction of its scale after all corrections.
pub(super) const FAILURE: f64 = 1e-9;

/// The working state of the solver: memory, and data of the present step. It can be discarded at any time.
#[derive(Clone, Default)]
pub(in crate::dynamics) struct Solver {
    pub(super) structure: Option<Structure>,
    /// The lasting contacts, in addition to the constraints of the model.
    pub(super) contacts: Vec<Arc<Closed>>,
    /// Bodies whose constraints another solver keeps at present.
    pub(super) away: BTreeSet<usize>,
    /// The constraints of the model, then the contacts.
    pub(super) all: Vec<Arc<dyn Constraint>>,
    /// The first row of each constraint; `None` while a body of it is absent.
    pub(super) first_row: Vec<Option<usize>>,
    pub(super) factor: Factor,
    pub(super) members: Vec<Member>,
    pub(super) natures: Vec<Nature>,
    /// The members at the start of the step, and its time, s.
    pub(super) origin: Vec<Member>,
    pub(super) begun: f64,
    /// The length of the present step, s.
    pub(super) span: f64,
    /// Whether no friction forces were found in the present step.
    pub(super) is_unsolved: bool,
    /// Whether the end of a step is being aimed at.
    pub(super) is_aiming: bool,
    /// The given motions of members.
    pub(super) motions: Vec<Option<Arc<dyn Motion>>>,
    pub(super) rows: Vec<Row>,
    pub(super) jacobian: Vec<Direction>,
    /// The Jacobian at the start of the step, for methods that kick along it.
    pub(super) first: Vec<Direction>,
    /// ∂c/∂t of the rows at the start of the step.
    pub(super) first_rates: Vec<f64>,
    /// The law of each row, and its present mode.
    pub(super) laws: Vec<Law>,
    pub(super) modes: Vec<Mode>,
    /// The pairs of friction rows.
    pub(super) grips: Vec<Grip>,
    /// The number of mode changes between two bodies in the present step.
    pub(super) changes: BTreeMap<[usize; 2], u32>,
    /// J v of all rows, if contacts slide.
    pub(super) slips: Vec<f64>,
    /// Whether any row has modes other than `Held`.
    pub(super) has_modes: bool,
    /// The largest terms of c' and c'' so far. Values far below them count as rounding errors.
    pub(super) largest_rate: f64,
    pub(super) largest_acceleration: f64,
    /// The same at the state of the last margin.
    pub(super) seen: [f64; 2],
    /// The active rows of this step: those that hold, except those that others imply.
    pub(super) held: Vec<bool>,
    /// The unknowns of the linear systems.
    pub(super) unknown: Vec<f64>,
    /// The smallest impulses of stops, if they are not 0.
    pub(super) least: Vec<f64>,
    /// The effects of impulses along the rows, for sweeps.
    pub(super) columns: Columns,
    /// The forces that the last sweeps found.
    pub(super) warm: Warm,
    /// The largest change of a rate by forces in the last part of a step.
    pub(super) forced: f64,
    /// Whether sweeps find all forces, since there are no joints.
    pub(super) is_loose: bool,
    /// A row for which no mode was right in the last decision.
    pub(super) undecided: Option<usize>,
    pub(super) trial: State,
    /// Whether rows and factors belong to the next state.
    pub(super) is_ready: bool,
    /// Whether there are factors near enough for the step that is being settled, and their time, s.
    pub(super) is_factorised: bool,
    pub(super) factorised: f64,
    /// The time of the last measurement of rows and Jacobian.
    pub(super) measured: f64,
    pub(super) failure: Option<Breakdown>,
}

impl Solver {
    /// Called when bodies or constraints have changed.
    pub(in crate::dynamics) fn forget(&mut self) {
        self.structure = None;
        // The old rows must not act or be booked any more.
        self.has_modes = false;
        self.modes.clear();
        self.grips.clear();
    }

    /// The failure since the last call, if any.
    pub(in crate::dynamics) fn take_failure(&mut self) -> Option<Breakdown> {
        self.failure.take()
    }

    /// Starts a step at a state in which the constraints hold, and decides which equations are active, since others imply the rest. They
    /// stay the same for the whole step, so that its right-hand side is smooth.
    pub(in crate::dynamics) fn begin(&mut self, model: &Model, t: f64, state: &State) {
        if self.is_idle(model) {
            return;
        }
        self.plan(model);
        self.measure(t, state);
        self.origin.clone_from(&self.members);
        self.begun = t;
        // Some rows are measured relative to the start of the step.
        self.measured = f64::NAN;
        self.hold();
        self.is_ready = true;
    }

    /// Selects the active rows: the rows in mode `Held`, except redundant rows, which follow from other active rows.
    pub(super) fn hold(&mut self) {
        for (held, mode) in self.held.iter_mut().zip(&self.modes) {
            *held = *mode == Mode::Held;
        }
        self.factorise(true);
    }

    /// The largest violation of all equations, including implied ones.
    pub(in crate::dynamics) fn violation(&mut self, model: &Model, t: f64, state: &State) -> f64 {
        self.is_ready = false;
        self.plan(model);
        self.measure(t, state);
        let missing = (0..self.rows.len()).map(|i| self.missing(i));
        missing.fold(0.0, f64::max)
    }

    /// The violation of a row.
    fn missing(&self, row: usize) -> f64 {
        self.modes[row].missing(self.laws[row], &self.rows[row])
    }

    /// The diagonal entry of J M⁻¹ Jᵀ for a row, as last factorised.
    pub(super) fn weight(&self, row: usize) -> f64 {
        self.factor.diagonal(row)
    }

    /// Reports the equation with the largest error, if it is too large.
    pub(super) fn blame(&mut self, model: &Model, time: f64) {
        let Some(structure) = &self.structure else { return };
        let mut failed = None;
        for place in &structure.places {
            // A trial step may pass an open stop.
            for row in (place.row..place.row + place.rows).filter(|&row| self.modes[row] == Mode::Held) {
                let missing = self.missing(row);
                let is_kept = missing <= FAILURE * self.rows[row].scale;
                if !is_kept && failed.is_none_or(|(_, most)| missing > most) {
                    failed = Some((place.constraint, missing));
                }
            }
        }
        let is_known = self.failure.is_some();
        if let (false, Some((constraint, missing))) = (is_known, failed) {
            self.failure = Some(self.broken(model, constraint, time, missing));
        }
    }

    /// Finds the structure, if it is unknown.
    #[inline]
    pub(super) fn plan(&mut self, model: &Model) {
        if self.structure.is_none() {
            self.make_structure(model);
        }
    }

    #[cold]
    fn make_structure(&mut self, model: &Model) {
        // Without rows that always hold, nothing is factorised.
        let can_move = |body: usize| !self.is_loose && model.inverse_mass()[body] != 0.0;
        self.all.clear();
        self.all.extend(model.constraints().iter().cloned());
        self.all.extend(self.contacts.iter().map(|contact| contact.clone() as Arc<dyn Constraint>));
        let is_there = |body: usize| model.is_present(body) && !self.away.contains(&body);
        let structure = Structure::of(&self.all, is_there, can_move);
        self.first_row = vec![None; self.all.len()];
        for place in &structure.places {
            self.first_row[place.constraint] = Some(place.row);
        }
        self.factor = Factor::new(&structure);
        if !self.contacts.is_empty() && !self.is_loose {
            let mut soft = vec![None; structure.rows];
            for place in structure.places.iter().filter(|place| place.constraint >= model.constraints().len())
            {
                soft[place.row] = Some(place.row);
                for row in (place.row + 1..place.row + place.rows).step_by(2) {
                    (soft[row], soft[row + 1]) = (Some(row + 1), Some(row));
                }
            }
            self.factor.soften(soft);
        }
        self.natures = structure.bodies.iter().map(|&body| Nature::of(body, model)).collect();
        self.members = self.natures.iter().map(Member::new).collect();
        (self.measured, self.factorised) = (f64::NAN, f64::NAN);
        self.motions = structure.bodies.iter().map(|&body| model.motion(body)).collect();
        self.rows = vec![Row::default(); structure.rows];
        self.jacobian = structure.places.iter().flat_map(Place::directions).collect();
        let places = structure.places.iter();
        let all = &self.all;
        let laws = |place: &Place| {
            let constraint = all[place.constraint].clone();
            (0..place.rows).map(move |row| constraint.law(row))
        };
        self.laws = places.flat_map(laws).collect();
        self.grips = Grip::all(&structure, &self.laws);
        self.see_restless(model, &structure);
        self.has_modes = self.laws.iter().any(|law| *law != Law::Tie);
        self.modes = self.laws.iter().map(Mode::first).collect();
        self.held = vec![false; structure.rows];
        self.origin = self.members.clone();
        self.unknown = vec![0.0; structure.rows];
        self.structure = Some(structure);
    }

    /// Measures all equations at a state.
    pub(super) fn measure(&mut self, t: f64, state: &State) {
        for (member, nature) in self.members.iter_mut().zip(&self.natures) {
            member.follow(nature, state);
        }
        self.measure_members(t);
    }

    /// Measures all equations at a state. If the last measurement was at these positions and this time, only the velocities are updated.
    pub(super) fn measure_places(&mut self, t: f64, state: &State) {
        let mut has_moved = t.to_bits() != self.measured.to_bits();
        for (member, nature) in self.members.iter_mut().zip(&self.natures) {
            has_moved |= member.follow(nature, state);
        }
        if has_moved {
            self.measure_members(t);
        }
    }

    #[inline(always)]
    fn measure_members(&mut self, t: f64) {
        let Solver { structure: Some(structure), members, origin, rows, jacobian, all, .. } = self else {
            return;
        };
        let mut equations = Equations { rows, jacobian, row: 0, direction: 0, bodies: 0 };
        let mut members =
            Members { all: members, of: &[], time: t, origin, begun: self.begun, is_aiming: self.is_aiming };
        for place in &structure.places {
            members.of = &place.bodies;
            (equations.row, equations.direction) = (place.row, place.direction);
            equations.bodies = place.bodies.len();
            all[place.constraint].measure(&members, &mut equations);
        }
        self.measured = t;
    }

    /// The largest violation as a fraction of its scale; a NaN counts as infinite.
    pub(super) fn worst(&self) -> f64 {
        let off = |row: &Row| row.violation.abs() / row.scale.max(f64::MIN_POSITIVE);
        let held = self.rows.iter().zip(&self.held).filter(|(_, held)| **held);
        held.map(|(row, _)| off(row)).fold(0.0, |worst, off| {
            if off <= worst {
                worst
            } else if off.is_nan() {
                f64::INFINITY
            } else {
                off
            }
        })
    }

    /// Factorises J M⁻¹ Jᵀ of the last measurement.
    pub(super) fn factorise(&mut self, choose: bool) {
        self.factor.assemble(&self.jacobian, &self.members);
        self.factor.compute(&mut self.held, choose);
        self.is_factorised = true;
        self.factorised = self.measured;
    }
}

//! All constraints together: the forces that keep them, and the way back to where they hold.
//!
//! With A = J M⁻¹ Jᵀ, the multipliers λ of A λ = −(J a + J̇ v) make accelerations that fit, those of A Λ = −J v impulses that
//! make velocities fit, and those of A Λ = −c shifts M⁻¹ Jᵀ Λ that make places fit. Source: E. Hairer, C. Lubich & G. Wanner,
//! *Geometric Numerical Integration*, 2nd ed., IV.4 and VII.1.

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

/// An equation that is off by more than this part of its scale after all that was tried is a failure.
pub(super) const FAILURE: f64 = 1e-9;

/// The constraints of a world at work. It holds room to work in, and what belongs to the present step; it can be thrown away at
/// any time.
#[derive(Clone, Default)]
pub(in crate::dynamics) struct Solver {
    pub(super) structure: Option<Structure>,
    /// The places where bodies stay in touch, which hold beside the constraints of the model.
    pub(super) contacts: Vec<Arc<Closed>>,
    /// Bodies whose constraints somebody else keeps at present.
    pub(super) away: BTreeSet<usize>,
    /// The constraints of the model, and then the contacts.
    pub(super) all: Vec<Arc<dyn Constraint>>,
    /// The first row of each of them; none where bodies of it are away.
    pub(super) first_row: Vec<Option<usize>>,
    pub(super) factor: Factor,
    pub(super) members: Vec<Member>,
    pub(super) natures: Vec<Nature>,
    /// The members at the beginning of the step, and when that is, s.
    pub(super) origin: Vec<Member>,
    pub(super) begun: f64,
    /// How long the present step is, s.
    pub(super) span: f64,
    /// Whether forces of friction have not been found in the present step.
    pub(super) is_unsolved: bool,
    /// Whether a step is aimed at its end.
    pub(super) is_aiming: bool,
    /// The motions of members that are given.
    pub(super) motions: Vec<Option<Arc<dyn Motion>>>,
    pub(super) rows: Vec<Row>,
    pub(super) jacobian: Vec<Direction>,
    /// The Jacobian at the beginning of the step, for methods that kick along it.
    pub(super) first: Vec<Direction>,
    /// ∂c/∂t of the rows then.
    pub(super) first_rates: Vec<f64>,
    /// What each row may do, and what it does at present.
    pub(super) laws: Vec<Law>,
    pub(super) modes: Vec<Mode>,
    /// The pairs of rows that hold by friction.
    pub(super) grips: Vec<Grip>,
    /// How many times the contacts of two bodies have changed their modes in the present step.
    pub(super) changes: BTreeMap<[usize; 2], u32>,
    /// J v of all rows, where contacts slide.
    pub(super) slips: Vec<f64>,
    /// Whether some row may do anything but hold.
    pub(super) has_modes: bool,
    /// The largest sizes of the terms of c' and c'' so far: what is slight against them has come from rounding.
    pub(super) largest_rate: f64,
    pub(super) largest_acceleration: f64,
    /// The same at the state whose margin was asked for last.
    pub(super) seen: [f64; 2],
    /// Which rows take part in this step: those that hold, but for those that others imply.
    pub(super) held: Vec<bool>,
    /// What is solved for.
    pub(super) unknown: Vec<f64>,
    /// The least impulses of stops, where they are not 0.
    pub(super) least: Vec<f64>,
    /// What impulses along the rows do, where they are found by sweeps.
    pub(super) columns: Columns,
    /// The forces that sweeps have found last.
    pub(super) warm: Warm,
    /// The largest change of a rate by forces in the last part of a step.
    pub(super) forced: f64,
    /// Whether all forces are found by sweeps, since there are no joints.
    pub(super) is_loose: bool,
    /// A row for which nothing that it may do was right, when this was decided last.
    pub(super) undecided: Option<usize>,
    pub(super) trial: State,
    /// Whether rows and factors are those of the state that comes next.
    pub(super) is_ready: bool,
    /// Whether there are factors near enough for the step that is being settled, and of what time they are, s.
    pub(super) is_factorised: bool,
    pub(super) factorised: f64,
    /// When rows and Jacobian were measured.
    pub(super) measured: f64,
    pub(super) failure: Option<Breakdown>,
}

impl Solver {
    /// Told when bodies or constraints have changed.
    pub(in crate::dynamics) fn forget(&mut self) {
        self.structure = None;
        // Nothing of what held may act or be booked any more.
        self.has_modes = false;
        self.modes.clear();
        self.grips.clear();
    }

    /// What went wrong since somebody asked last.
    pub(in crate::dynamics) fn take_failure(&mut self) -> Option<Breakdown> {
        self.failure.take()
    }

    /// Begins a step at a state in which the constraints hold: decides which equations take part, since others imply the rest.
    /// The same ones take part in the whole step, so that its right-hand side is smooth.
    pub(in crate::dynamics) fn begin(&mut self, model: &Model, t: f64, state: &State) {
        if self.is_idle(model) {
            return;
        }
        self.plan(model);
        self.measure(t, state);
        self.origin.clone_from(&self.members);
        self.begun = t;
        // Some rows are measured from the beginning of the step.
        self.measured = f64::NAN;
        self.hold();
        self.is_ready = true;
    }

    /// Decides which of the rows take part that hold: those that others imply do not.
    pub(super) fn hold(&mut self) {
        for (held, mode) in self.held.iter_mut().zip(&self.modes) {
            *held = *mode == Mode::Held;
        }
        self.factorise(true);
    }

    /// By how much equations do not hold at most, also those that others imply.
    pub(in crate::dynamics) fn violation(&mut self, model: &Model, t: f64, state: &State) -> f64 {
        self.is_ready = false;
        self.plan(model);
        self.measure(t, state);
        let missing = (0..self.rows.len()).map(|i| self.missing(i));
        missing.fold(0.0, f64::max)
    }

    /// By how much a row does not hold.
    fn missing(&self, row: usize) -> f64 {
        self.modes[row].missing(self.laws[row], &self.rows[row])
    }

    /// J M⁻¹ Jᵀ of one row, as it was factorised last.
    pub(super) fn weight(&self, row: usize) -> f64 {
        self.factor.diagonal(row)
    }

    /// Notes the equation that is off by most, if that is too much.
    pub(super) fn blame(&mut self, model: &Model, time: f64) {
        let Some(structure) = &self.structure else { return };
        let mut failed = None;
        for place in &structure.places {
            // An open stop may be passed in a step that is tried.
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

    /// Finds the structure, where it is not known.
    #[inline]
    pub(super) fn plan(&mut self, model: &Model) {
        if self.structure.is_none() {
            self.make_structure(model);
        }
    }

    #[cold]
    fn make_structure(&mut self, model: &Model) {
        // Where nothing holds for sure, nothing is factorised.
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

    /// Measures all equations at a state, or only how it moves where they have been measured at these places and this time last.
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

    /// The largest violation as a part of its scale; a NaN counts as endless.
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

    /// Factorises J M⁻¹ Jᵀ of what was measured last.
    pub(super) fn factorise(&mut self, choose: bool) {
        self.factor.assemble(&self.jacobian, &self.members);
        self.factor.compute(&mut self.held, choose);
        self.is_factorised = true;
        self.factorised = self.measured;
    }
}

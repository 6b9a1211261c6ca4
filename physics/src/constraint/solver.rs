//! The solver of all constraints: it computes constraint forces and projects states onto the constraints.
//!
//! With A = J M⁻¹ Jᵀ, the solver finds multipliers at three levels. The forces λ with A λ = −(J a + J̇ v) correct accelerations. The
//! impulses Λ with A Λ = −J v correct velocities. The shifts M⁻¹ Jᵀ Λ with A Λ = −c correct positions. Source: E. Hairer, C. Lubich & G.
//! Wanner, *Geometric Numerical Integration*, 2nd ed., IV.4 and VII.1.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::super::contact::LastingContact;
use super::super::{Anchor, BodyId, Breakdown, Model, Motion, State};
use super::columns::Columns;
use super::factor::Factor;
use super::friction::FrictionPair;
use super::last_forces::LastForces;
use super::member::{BodyConstants, Member};
use super::refine::Pause;
use super::row_modes::Mode;
use super::structure::{ConstraintBlock, Structure};
use super::{Constraint, Direction, Equations, Law, Members, Row};

/// A constraint is broken if its error after all corrections exceeds this fraction of its size.
pub(super) const CONSTRAINT_TOLERANCE: f64 = 1e-9;

/// The state of the constraint solver: working memory, contacts, and data of the present step.
#[derive(Clone, Default)]
pub(crate) struct Solver {
    pub(super) structure: Option<Structure>,
    /// The lasting contacts, which act as constraints in addition to those of the model.
    pub(super) contacts: Vec<Arc<LastingContact>>,
    /// The indices of bodies whose constraints another solver handles at present.
    pub(super) away: BTreeSet<usize>,
    /// All constraints: first those of the model, then the lasting contacts.
    pub(super) all: Vec<Arc<dyn Constraint>>,
    /// The first row of each constraint in `all`; `None` while the constraint is inactive, because a body of it is absent.
    pub(super) first_row: Vec<Option<usize>>,
    pub(super) factor: Factor,
    pub(super) members: Vec<Member>,
    pub(super) natures: Vec<BodyConstants>,
    /// The states of the members at the start of the step. `begun` is the time of this start, s.
    pub(super) origin: Vec<Member>,
    /// False after the members were laid out anew. The next state that is measured then counts as the start of the step.
    pub(super) has_origin: bool,
    pub(super) begun: f64,
    /// The length of the present step, s.
    pub(super) span: f64,
    /// The length of the present step of the world, s, which events divide into pieces; 0 if it is not known.
    pub(super) step: f64,
    /// True if the equations of sliding friction had no solution in the present step.
    pub(super) is_unsolved: bool,
    /// True if contacts would need accelerations that nothing causes, at the state of the last [`Solver::margin`].
    pub(super) is_implausible: bool,
    /// True while [`Solver::aim`] corrects initial velocities, so that the constraints hold at the end of the step.
    pub(super) is_aiming: bool,
    /// The given motion of each member; `None` for a member that forces move.
    pub(super) motions: Vec<Option<Arc<dyn Motion>>>,
    pub(super) rows: Vec<Row>,
    pub(super) jacobian: Vec<Direction>,
    /// The Jacobian at the start of the step, along which SHAKE and RATTLE apply their impulses.
    pub(super) first: Vec<Direction>,
    /// ∂c/∂t of each constraint row at the start of the step; nonzero for constraints that depend on time.
    pub(super) first_rates: Vec<f64>,
    /// The law of each constraint row. `modes` holds the present mode of each row.
    pub(super) laws: Vec<Law>,
    pub(super) modes: Vec<Mode>,
    /// For each constraint row, true if it was a touched stop (an inequality c ≥ 0 with c = 0) at the start of the present step.
    pub(super) touched: Vec<bool>,
    /// The pairs of friction rows, in the order of their rows.
    pub(super) grips: Vec<FrictionPair>,
    /// The product J v of each constraint row, for slip velocities. Computed only while contacts slide.
    pub(super) slips: Vec<f64>,
    /// True if the mode of any constraint row can change, so that not all laws are [`Law::Equality`].
    pub(super) has_modes: bool,
    /// The largest magnitude of the terms of c' so far, m/s; `largest_acceleration` is that of c'', m/s². Values far below them, in the
    /// [unit](Solver::unit) of their row, count as rounding errors.
    pub(super) largest_rate: f64,
    pub(super) largest_acceleration: f64,
    /// The largest speed that loads have given to a touching body within a step so far, m/s.
    pub(super) speed_by_loads: f64,
    /// The largest magnitudes of the terms of c' and c'' at the state of the last [`Solver::margin`].
    pub(super) seen: [f64; 2],
    /// For each constraint row, true if the row is active in this step: it is in mode `Held` and not redundant.
    pub(super) held: Vec<bool>,
    /// The right-hand side of the linear systems and their solution, the multipliers: one entry per constraint row.
    pub(super) unknown: Vec<f64>,
    /// The smallest impulse of each constraint row, for inequalities (stops) that rebound. Empty if all are 0.
    pub(super) least: Vec<f64>,
    /// The velocity changes of the bodies under a unit impulse along each constraint row. Gauss–Seidel sweeps use them.
    pub(super) columns: Columns,
    /// The contact forces that the last Gauss–Seidel sweeps found, from which the next sweeps start.
    pub(super) warm: LastForces,
    /// Whether Newton's method is left out at present.
    pub(super) pause: Pause,
    /// The forces of limits and motors that the last sweeps found: the constraint, its row, and the multiplier.
    pub(super) joint_forces: Vec<(usize, usize, f64)>,
    /// True if impacts without a rebound are recorded, too.
    pub(super) counts_soft_impacts: bool,
    /// The largest absolute rate c' of a constraint row before the contact forces acted, in the last substep of Moreau's scheme.
    pub(super) forced: f64,
    /// True if Gauss–Seidel sweeps find the forces of contacts. The matrix then couples only joints.
    pub(super) is_swept: bool,
    /// The bodies of a contact whose force lay outside its cone of friction at the state of the last [`Solver::margin`], so that the contact
    /// forces had to be shared anew. Empty if there was none.
    pub(super) strained: Vec<usize>,
    /// A constraint row for which the last decision of modes found no consistent mode.
    pub(super) undecided: Option<usize>,
    pub(super) trial: State,
    /// True if constraint rows and factors already belong to the state at which forces are evaluated next.
    pub(super) is_ready: bool,
    /// True if the present factors are accurate enough for the projection of the step. `factorised` is the time of these factors, s.
    pub(super) is_factorised: bool,
    pub(super) factorised: f64,
    /// The time at which the constraint rows and the Jacobian were last evaluated, s. NaN if they must be evaluated again.
    pub(super) measured: f64,
    pub(super) failure: Option<Breakdown>,
}

impl Solver {
    /// Tells the solver the length of the next step of the world, s.
    pub(crate) fn expect_step(&mut self, length: f64) {
        self.step = if length.is_finite() { length } else { 0.0 };
    }

    /// Discards the layout of the constraints. Must be called whenever bodies or constraints have changed.
    pub(crate) fn forget(&mut self) {
        self.structure = None;
        // The old constraint rows must not act any more, and their work must not be booked.
        self.has_modes = false;
        self.modes.clear();
        self.grips.clear();
    }

    /// Returns the first failure since the last call, and forgets it. `None` if nothing failed.
    pub(crate) fn take_failure(&mut self) -> Option<Breakdown> {
        self.failure.take()
    }

    /// Starts a step at a state in which the constraints hold, and selects the active equations: redundant ones are left out. The
    /// selection stays the same for the whole step, so the right-hand side of the equations of motion is smooth.
    pub(crate) fn begin(&mut self, model: &Model, t: f64, state: &State) {
        if self.is_idle(model) {
            return;
        }
        self.plan(model);
        self.has_origin = false;
        self.measure(t, state);
        // The errors of some constraint rows are measured relative to the start of the step.
        self.measured = f64::NAN;
        self.hold();
        self.is_ready = true;
    }

    /// Selects the active rows and factorizes their matrix. A row is active if its mode is `Held` and it does not follow from other active
    /// rows.
    pub(super) fn hold(&mut self) {
        for (held, mode) in self.held.iter_mut().zip(&self.modes) {
            *held = *mode == Mode::Held;
        }
        self.factorise(true);
    }

    /// Returns the largest error of all equations at a state, including redundant ones.
    pub(crate) fn violation(&mut self, model: &Model, t: f64, state: &State) -> f64 {
        self.is_ready = false;
        self.plan(model);
        self.measure(t, state);
        let missing = (0..self.rows.len()).map(|i| self.missing(i));
        missing.fold(0.0, f64::max)
    }

    /// Returns the error of a constraint row in its present mode.
    fn missing(&self, row: usize) -> f64 {
        self.modes[row].missing(self.laws[row], &self.rows[row])
    }

    /// Returns the diagonal entry of A = J M⁻¹ Jᵀ for a constraint row, as last assembled.
    pub(super) fn weight(&self, row: usize) -> f64 {
        self.factor.diagonal(row)
    }

    /// Returns the mean of the diagonal entries of A = J M⁻¹ Jᵀ for a pair of friction rows, which does not depend on the directions of the
    /// two tangents. `row` is the first row of the pair.
    pub(super) fn pair_weight(&self, row: usize) -> f64 {
        0.5 * (self.weight(row) + self.weight(row + 1))
    }

    /// Reports the constraint with the largest error of an active row as broken, if this error exceeds the tolerance.
    pub(super) fn blame(&mut self, model: &Model, time: f64) {
        let Some(structure) = &self.structure else { return };
        let mut failed = None;
        for place in &structure.places {
            // Open stops (inequalities without contact) do not count: a trial step may pass them.
            for row in (place.row..place.row + place.rows).filter(|&row| self.modes[row] == Mode::Held) {
                let missing = self.missing(row);
                let is_kept = missing <= self.rows[row].tolerance(CONSTRAINT_TOLERANCE);
                // A NaN is the largest error.
                if !is_kept && failed.is_none_or(|(_, most)| missing.total_cmp(&most).is_gt()) {
                    failed = Some((place.constraint, missing));
                }
            }
        }
        let is_known = self.failure.is_some();
        if let (false, Some((constraint, missing))) = (is_known, failed) {
            self.failure = Some(self.broken(model, constraint, time, missing));
        }
    }

    /// Lays out the rows and directions of all constraints, unless the layout is known.
    #[inline]
    pub(super) fn plan(&mut self, model: &Model) {
        if self.structure.is_none() {
            self.make_structure(model);
        }
    }

    /// Returns true if the layout of the joints is that of the model: the same joints, of the same bodies that are present and can move.
    pub(super) fn fits(&self, model: &Model) -> bool {
        let Some(structure) = &self.structure else { return false };
        let joints = model.constraints();
        let is_there = |id: &BodyId| model.is_present(id.index()) && !self.away.contains(&id.index());
        let has_place = |(index, joint): (usize, &Arc<dyn Constraint>)| {
            Arc::ptr_eq(joint, &self.all[index])
                && self.first_row[index].is_some() == joint.bodies().iter().all(is_there)
        };
        let moves = |(body, nature): (&usize, &BodyConstants)| {
            model.is_present(*body) && nature.can_move() == (model.inverse_mass()[*body] != 0.0)
        };
        self.all.len() == joints.len() + self.contacts.len()
            && joints.iter().enumerate().all(has_place)
            && structure.bodies.iter().zip(&self.natures).all(moves)
    }

    /// Forgets what belongs to the last contacts and keeps the layout, into which the present ones fit.
    pub(super) fn start_anew(&mut self, model: &Model) {
        let Some(structure) = &self.structure else { return };
        self.all.truncate(model.constraints().len());
        self.all.extend(self.contacts.iter().map(|contact| contact.clone() as Arc<dyn Constraint>));
        self.natures = structure.bodies.iter().map(|&body| BodyConstants::of(body, model)).collect();
        self.set_members();
        self.modes = self.laws.iter().map(Mode::first).collect();
        self.held.fill(false);
        self.unknown.fill(0.0);
    }

    /// Lays out the members, whose places are not known yet.
    fn set_members(&mut self) {
        self.members = self.natures.iter().map(Member::new).collect();
        self.has_origin = false;
        (self.measured, self.factorised) = (f64::NAN, f64::NAN);
    }

    #[cold]
    fn make_structure(&mut self, model: &Model) {
        let can_move = |body: usize| model.inverse_mass()[body] != 0.0;
        // Sweeps couple contacts, so no matrix needs to.
        let joints = model.constraints().len();
        let is_coupled = |constraint: usize| !self.is_swept || constraint < joints;
        self.all.clear();
        self.all.extend(model.constraints().iter().cloned());
        self.all.extend(self.contacts.iter().map(|contact| contact.clone() as Arc<dyn Constraint>));
        let is_there = |body: usize| model.is_present(body) && !self.away.contains(&body);
        let mut structure = Structure::of(&self.all, is_there, can_move, is_coupled);
        self.first_row = vec![None; self.all.len()];
        for place in &structure.places {
            self.first_row[place.constraint] = Some(place.row);
        }
        self.factor = Factor::new(&structure);
        if !self.contacts.is_empty() && !self.is_swept {
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
        self.natures = structure.bodies.iter().map(|&body| BodyConstants::of(body, model)).collect();
        structure.length = self.size_of(&structure);
        self.set_members();
        self.motions = structure.bodies.iter().map(|&body| model.motion(body)).collect();
        self.rows = vec![Row::default(); structure.rows];
        self.jacobian = structure.places.iter().flat_map(ConstraintBlock::directions).collect();
        let places = structure.places.iter();
        let all = &self.all;
        let laws = |place: &ConstraintBlock| {
            let constraint = all[place.constraint].clone();
            (0..place.rows).map(move |row| constraint.law(row))
        };
        self.laws = places.flat_map(laws).collect();
        self.grips = FrictionPair::all(&structure, &self.laws);
        self.has_modes = self.laws.iter().any(|law| *law != Law::Equality);
        self.modes = self.laws.iter().map(Mode::first).collect();
        self.held = vec![false; structure.rows];
        self.unknown = vec![0.0; structure.rows];
        self.structure = Some(structure);
    }

    /// Returns the size of the mechanisms, m: the largest lever or radius of gyration of a body that can move. 1 if there is none.
    fn size_of(&self, structure: &Structure) -> f64 {
        let moves = |nature: &&BodyConstants| nature.can_move();
        let sizes = self.natures.iter().filter(moves).map(|nature| nature.size);
        let ends = structure.places.iter().flat_map(|place| self.all[place.constraint].ends());
        let levers = ends.filter_map(|end| match end {
            Anchor::Body { id, at } => {
                let member = structure.bodies.binary_search(&id.index()).ok()?;
                self.natures[member].can_move().then(|| at.length())
            }
            Anchor::Point(_) => None,
        });
        let size = sizes.chain(levers).fold(0.0, f64::max);
        if size > 0.0 && size.is_finite() { size } else { 1.0 }
    }

    /// Evaluates all equations and their Jacobian at a state.
    pub(super) fn measure(&mut self, t: f64, state: &State) {
        for (member, nature) in self.members.iter_mut().zip(&self.natures) {
            member.follow(nature, state);
        }
        self.measure_members(t);
    }

    /// Evaluates all equations at a state. If the last evaluation was at the same positions and the same time, only the velocities are
    /// updated.
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
        if !self.has_origin {
            self.origin.clone_from(&self.members);
            (self.begun, self.has_origin) = (t, true);
        }
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

    /// Returns the largest error of an active constraint row, in units of its rounding error. A NaN counts as infinite.
    pub(super) fn worst(&self) -> f64 {
        let held = self.rows.iter().zip(&self.held).filter(|(_, held)| **held);
        held.map(|(row, _)| row.error()).fold(0.0, |worst, off| {
            if off <= worst {
                worst
            } else if off.is_nan() {
                f64::INFINITY
            } else {
                off
            }
        })
    }

    /// Returns true if no active constraint row is broken.
    pub(super) fn are_kept(&self) -> bool {
        let mut held = self.rows.iter().zip(&self.held).filter(|(_, held)| **held);
        held.all(|(row, _)| row.violation.abs() <= row.tolerance(CONSTRAINT_TOLERANCE))
    }

    /// Factorizes J M⁻¹ Jᵀ of the last measurement. With `choose`, redundant constraint rows become inactive.
    pub(super) fn factorise(&mut self, choose: bool) {
        self.factor.assemble(&self.jacobian, &self.members);
        self.factor.compute(&mut self.held, choose);
        self.is_factorised = true;
        self.factorised = self.measured;
    }
}

//! All constraints together: the forces that keep them, and the way back to where they hold.
//!
//! With A = J M⁻¹ Jᵀ, the multipliers λ of A λ = −(J a + J̇ v) make accelerations that fit, those of A Λ = −J v impulses that
//! make velocities fit, and those of A Λ = −c shifts M⁻¹ Jᵀ Λ that make places fit. Source: E. Hairer, C. Lubich & G. Wanner,
//! *Geometric Numerical Integration*, 2nd ed., IV.4 and VII.1.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::super::integrator::drift_body;
use super::super::{Breakdown, Loads, Model, Motion, State};
use super::factor::Factor;
use super::member::{Member, Nature};
use super::modes::Mode;
use super::structure::{Place, Structure};
use super::{Direction, Equations, Law, Members, Row};

/// By how much an equation may fail to hold, as a part of its scale: a few roundings.
const ROUNDING: f64 = 1e-15;

/// An equation that is off by more than this part of its scale after all that was tried is a failure.
const FAILURE: f64 = 1e-9;

/// Iterations contract by the square of the angle of a step at least; more would mean that they do not converge.
const ITERATIONS: usize = 60;

/// The constraints of a world at work. It holds room to work in, and what belongs to the present step; it can be thrown away at
/// any time.
#[derive(Clone, Default)]
pub(in crate::dynamics) struct Solver {
    pub(super) structure: Option<Structure>,
    pub(super) factor: Factor,
    pub(super) members: Vec<Member>,
    natures: Vec<Nature>,
    /// The members at the beginning of the step, and when that is, s.
    origin: Vec<Member>,
    begun: f64,
    /// The motions of members that are given.
    pub(super) motions: Vec<Option<Arc<dyn Motion>>>,
    pub(super) rows: Vec<Row>,
    pub(super) jacobian: Vec<Direction>,
    /// The Jacobian at the beginning of the step, for methods that kick along it.
    first: Vec<Direction>,
    /// ∂c/∂t of the rows then.
    first_rates: Vec<f64>,
    /// What each row may do, and what it does at present.
    pub(super) laws: Vec<Law>,
    pub(super) modes: Vec<Mode>,
    /// Whether some row may do anything but hold.
    pub(super) has_modes: bool,
    /// The largest sizes of the terms of c' and c'' so far: what is slight against them has come from rounding.
    pub(super) largest_rate: f64,
    pub(super) largest_acceleration: f64,
    /// Which rows take part in this step: those that hold, but for those that others imply.
    pub(super) held: Vec<bool>,
    /// What is solved for.
    pub(super) unknown: Vec<f64>,
    trial: State,
    /// Whether rows and factors are those of the state that comes next.
    pub(super) is_ready: bool,
    /// Whether there are factors near enough for the step that is being settled.
    is_factorised: bool,
    /// When rows and Jacobian were measured.
    measured: f64,
    pub(super) failure: Option<Breakdown>,
}

impl Solver {
    /// Told when bodies or constraints have changed.
    pub(in crate::dynamics) fn forget(&mut self) {
        self.structure = None;
    }

    /// What went wrong since somebody asked last.
    pub(in crate::dynamics) fn take_failure(&mut self) -> Option<Breakdown> {
        self.failure.take()
    }

    /// Begins a step at a state in which the constraints hold: decides which equations take part, since others imply the rest.
    /// The same ones take part in the whole step, so that its right-hand side is smooth.
    pub(in crate::dynamics) fn begin(&mut self, model: &Model, t: f64, state: &State) {
        if model.constraints().is_empty() {
            return;
        }
        self.plan(model);
        self.measure(model, t, state);
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

    /// Adds the forces and torques that keep the constraints to the loads.
    pub(in crate::dynamics) fn react(&mut self, model: &Model, t: f64, state: &State, loads: &mut Loads) {
        if model.constraints().is_empty() {
            return;
        }
        if !self.is_ready {
            self.plan(model);
            self.measure(model, t, state);
            self.factorise(false);
        }
        self.is_ready = false;
        self.push_drives(loads);
        self.solve_forces(t, state, loads);
        let Solver { structure: Some(structure), rows, jacobian, unknown, .. } = &*self else { return };
        for (multiplier, row) in unknown.iter().zip(rows) {
            // The power λ J v, since J v + ∂c/∂t = 0.
            loads.power.motors -= multiplier * row.rate;
        }
        for_each_direction(structure, jacobian, unknown, |member, direction, multiplier| {
            let i = structure.bodies[member];
            loads.force[i] += multiplier * direction.linear;
            loads.torque[i] += multiplier * direction.angular;
        });
    }

    /// Finds the multipliers at a state that has been measured and factorised. The accelerations without them take the place of
    /// velocities, which are not needed any more. Gives the largest size of the terms of c''.
    fn solve_forces(&mut self, t: f64, state: &State, loads: &Loads) -> f64 {
        let Solver { structure: Some(structure), members, motions, rows, jacobian, unknown, .. } = self
        else {
            return 0.0;
        };
        for ((member, motion), &i) in members.iter_mut().zip(motions).zip(&structure.bodies) {
            if let Some(motion) = motion {
                member.velocity = motion.at(t).acceleration;
                member.angular_velocity = motion.angular_acceleration(t);
            } else {
                let gyroscopic = member.angular_velocity.cross(state.angular_momentum[i]);
                member.velocity = member.inverse_mass * loads.force[i];
                member.angular_velocity = member.turn(loads.torque[i] - gyroscopic);
            }
        }
        let mut size = products(structure, jacobian, members, unknown);
        for (value, row) in unknown.iter_mut().zip(&*rows) {
            size = size.max(row.bias.abs());
            *value = -(*value + row.bias);
        }
        self.factor.solve(unknown);
        size
    }

    /// Finds the multipliers as [`react`](Self::react) does, adds nothing but what drives push, and gives c'' of each row
    /// with them, and the largest size of its terms.
    pub(super) fn react_seeing(
        &mut self,
        t: f64,
        state: &State,
        loads: &mut Loads,
        accelerations: &mut [f64],
    ) -> f64 {
        self.is_ready = false;
        self.push_drives(loads);
        let size = self.solve_forces(t, state, loads);
        let Solver { structure: Some(structure), members, rows, jacobian, unknown, .. } = self else {
            return size;
        };
        move_members(structure, jacobian, unknown, members);
        products(structure, jacobian, members, accelerations);
        for (acceleration, row) in accelerations.iter_mut().zip(&*rows) {
            *acceleration += row.bias;
        }
        size
    }

    /// Adds the forces of drives that push with their limit, and their power.
    fn push_drives(&mut self, loads: &mut Loads) {
        if !self.has_modes {
            return;
        }
        let Solver { structure: Some(structure), members, jacobian, unknown, laws, modes, .. } = self else {
            return;
        };
        for (value, (law, mode)) in unknown.iter_mut().zip(laws.iter().zip(modes)) {
            *value = match (law, mode) {
                (Law::Drive { limit }, Mode::Pushed(sign)) => *sign * *limit,
                _ => 0.0,
            };
        }
        for_each_direction(structure, jacobian, unknown, |member, direction, multiplier| {
            let (i, member) = (structure.bodies[member], &members[member]);
            loads.force[i] += multiplier * direction.linear;
            loads.torque[i] += multiplier * direction.angular;
            loads.power.motors += multiplier
                * (direction.linear.dot(member.velocity) + direction.angular.dot(member.angular_velocity));
        });
    }

    /// Adds the forces of motors that are not strong enough for their speed, where they act as forces do.
    pub(in crate::dynamics) fn drive(&mut self, model: &Model, t: f64, state: &State, loads: &mut Loads) {
        if self.modes.iter().any(|mode| matches!(mode, Mode::Pushed(_))) {
            self.measure(model, t, state);
            self.is_ready = false;
            self.push_drives(loads);
        }
    }

    /// Changes the velocities at the beginning of a step such that free bodies are where the constraints hold after it: the
    /// impulses of SHAKE and RATTLE. The step has begun with [`begin`](Self::begin) at these places.
    pub(in crate::dynamics) fn aim(&mut self, model: &Model, t: f64, dt: f64, state: &mut State) {
        if model.constraints().is_empty() {
            return;
        }
        self.is_ready = false;
        self.first.clone_from(&self.jacobian);
        self.first_rates.clear();
        self.first_rates.extend(self.rows.iter().map(|row| row.rate));
        let mut trial = std::mem::take(&mut self.trial);
        trial.clone_from(state);
        model.place(t + dt, &mut trial);
        let mut before = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let bodies = self.structure.iter().flat_map(|structure| &structure.bodies);
            for &i in bodies.filter(|&&i| model.inverse_mass()[i] != 0.0) {
                trial.location[i] = state.location[i];
                trial.orientation[i] = state.orientation[i];
                trial.velocity[i] = state.velocity[i];
                trial.angular_momentum[i] = state.angular_momentum[i];
                drift_body(model, dt, &mut trial, i);
            }
            self.measure(model, t + dt, &trial);
            let worst = self.worst();
            if worst <= ROUNDING || (worst < FAILURE && worst > 0.5 * before) {
                break;
            }
            before = worst;
            for (value, row) in self.unknown.iter_mut().zip(&self.rows) {
                *value = -row.violation / dt;
            }
            self.factor.solve(&mut self.unknown);
            let Solver { structure: Some(structure), first, unknown, .. } = &*self else { break };
            push(structure, first, unknown, model, state);
            book(self.first_rates.iter().copied(), &self.unknown, state);
        }
        self.trial = trial;
        self.blame(model, t + dt);
    }

    /// Moves the bodies the shortest way to where all constraints hold, as M measures it, and takes out of their velocities what
    /// leads away from there.
    pub(in crate::dynamics) fn settle(&mut self, model: &Model, t: f64, state: &mut State) {
        if model.constraints().is_empty() {
            return;
        }
        self.is_ready = false;
        self.plan(model);
        self.settle_places(model, t, state);
        self.blame(model, t);
        self.settle_velocities(model, state);
    }

    pub(super) fn settle_places(&mut self, model: &Model, t: f64, state: &mut State) {
        let mut before = f64::INFINITY;
        self.is_factorised = false;
        for _ in 0..ITERATIONS {
            self.measure_places(model, t, state);
            let worst = self.worst();
            let is_slow = worst > 0.1 * before;
            if worst <= ROUNDING || (worst < FAILURE && is_slow) {
                return;
            }
            if !self.is_factorised || is_slow {
                self.factorise(false);
            }
            before = worst;
            for (value, row) in self.unknown.iter_mut().zip(&self.rows) {
                *value = -row.violation;
            }
            self.factor.solve(&mut self.unknown);
            let Solver { structure: Some(structure), members, jacobian, unknown, .. } = &*self else {
                return;
            };
            for_each_direction(structure, jacobian, unknown, |member, direction, multiplier| {
                let (i, member) = (structure.bodies[member], &members[member]);
                state.location[i] += multiplier * member.inverse_mass * direction.linear;
                let turn = member.turn(multiplier * direction.angular);
                if turn != DVec3::ZERO {
                    state.orientation[i] = (DQuat::from_scaled_axis(turn) * state.orientation[i]).normalize();
                }
            });
        }
    }

    pub(super) fn settle_velocities(&mut self, model: &Model, state: &mut State) {
        let mut before = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let Solver { structure: Some(structure), members, jacobian, unknown, rows, .. } = self else {
                return;
            };
            let scale = rates(structure, jacobian, members, rows, unknown);
            let worst = unknown.iter().zip(&self.held).filter(|(_, held)| **held);
            let worst = worst.fold(0.0_f64, |worst, (rate, _)| worst.max(rate.abs()));
            // A NaN ends it as well.
            if !(worst > ROUNDING * scale && worst < 0.5 * before) {
                return;
            }
            before = worst;
            if !self.is_factorised {
                self.factorise(false);
            }
            let Solver { structure: Some(structure), members, jacobian, unknown, factor, rows, .. } = self
            else {
                return;
            };
            unknown.iter_mut().for_each(|rate| *rate = -*rate);
            factor.solve(unknown);
            push(structure, jacobian, unknown, model, state);
            book(rows.iter().map(|row| row.rate), unknown, state);
            move_members(structure, jacobian, unknown, members);
        }
    }

    /// By how much equations do not hold at most, also those that others imply.
    pub(in crate::dynamics) fn violation(&mut self, model: &Model, t: f64, state: &State) -> f64 {
        self.is_ready = false;
        self.plan(model);
        self.measure(model, t, state);
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
    fn blame(&mut self, model: &Model, time: f64) {
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
            debug_assert!(constraint < model.constraints().len());
            self.failure = Some(Breakdown::Broken { constraint, time, missing });
        }
    }

    /// Finds the structure, where it is not known.
    pub(super) fn plan(&mut self, model: &Model) {
        if self.structure.is_some() {
            return;
        }
        let can_move = |body: usize| model.inverse_mass()[body] != 0.0;
        let structure = Structure::of(model.constraints(), |body| model.is_present(body), can_move);
        self.factor = Factor::new(&structure);
        self.natures = structure.bodies.iter().map(|&body| Nature::of(body, model)).collect();
        self.members = self.natures.iter().map(Member::new).collect();
        self.measured = f64::NAN;
        self.motions = structure.bodies.iter().map(|&body| model.motion(body)).collect();
        self.rows = vec![Row::default(); structure.rows];
        self.jacobian = structure.places.iter().flat_map(Place::directions).collect();
        let places = structure.places.iter();
        let laws = |place: &Place| {
            let constraint = model.constraints()[place.constraint].clone();
            (0..place.rows).map(move |row| constraint.law(row))
        };
        self.laws = places.flat_map(laws).collect();
        self.has_modes = self.laws.iter().any(|law| *law != Law::Tie);
        self.modes = self.laws.iter().map(Mode::first).collect();
        self.held = vec![false; structure.rows];
        self.origin = self.members.clone();
        self.unknown = vec![0.0; structure.rows];
        self.structure = Some(structure);
    }

    /// Measures all equations at a state.
    pub(super) fn measure(&mut self, model: &Model, t: f64, state: &State) {
        for (member, nature) in self.members.iter_mut().zip(&self.natures) {
            member.follow(nature, state);
        }
        self.measure_members(model, t);
    }

    /// Measures all equations at a state, or only how it moves where they have been measured at these places and this time last.
    fn measure_places(&mut self, model: &Model, t: f64, state: &State) {
        let mut has_moved = t.to_bits() != self.measured.to_bits();
        for (member, nature) in self.members.iter_mut().zip(&self.natures) {
            has_moved |= member.follow(nature, state);
        }
        if has_moved {
            self.measure_members(model, t);
        }
    }

    fn measure_members(&mut self, model: &Model, t: f64) {
        let Solver { structure: Some(structure), members, origin, begun, rows, jacobian, .. } = self else {
            return;
        };
        for place in &structure.places {
            let bodies = place.bodies.len();
            let mut equations = Equations {
                rows: &mut rows[place.row..place.row + place.rows],
                jacobian: &mut jacobian[place.direction..place.direction + place.rows * bodies],
                bodies,
            };
            let members = Members { all: members, of: &place.bodies, time: t, origin, begun: *begun };
            model.constraints()[place.constraint].measure(&members, &mut equations);
        }
        self.measured = t;
    }

    /// The largest violation as a part of its scale; a NaN counts as endless.
    fn worst(&self) -> f64 {
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
    }
}

/// Adds M⁻¹ Jᵀ Λ to the velocities of members, or to the accelerations in their place.
pub(super) fn move_members(
    structure: &Structure,
    jacobian: &[Direction],
    multipliers: &[f64],
    members: &mut [Member],
) {
    for_each_direction(structure, jacobian, multipliers, |member, direction, multiplier| {
        let member = &mut members[member];
        member.velocity += multiplier * member.inverse_mass * direction.linear;
        member.angular_velocity += member.turn(multiplier * direction.angular);
    });
}

/// Calls back with each direction of the Jacobian, its member and the multiplier of its row.
pub(super) fn for_each_direction(
    structure: &Structure,
    jacobian: &[Direction],
    multipliers: &[f64],
    mut act: impl FnMut(usize, &Direction, f64),
) {
    for (row, &multiplier) in structure.row_start.windows(2).zip(multipliers) {
        if multiplier != 0.0 {
            jacobian[row[0]..row[1]]
                .iter()
                .for_each(|direction| act(direction.member, direction, multiplier));
        }
    }
}

/// c' = J v + ∂c/∂t for the velocities of the members; the largest sum of the sizes of its terms.
pub(super) fn rates(
    structure: &Structure,
    jacobian: &[Direction],
    members: &[Member],
    rows: &[Row],
    out: &mut [f64],
) -> f64 {
    let mut largest = products(structure, jacobian, members, out);
    for (rate, row) in out.iter_mut().zip(rows) {
        *rate += row.rate;
        largest = largest.max(row.rate.abs());
    }
    largest
}

/// J v for the velocities of the members, or J a where accelerations stand in their place; the largest sum of the sizes of its
/// terms.
pub(super) fn products(
    structure: &Structure,
    jacobian: &[Direction],
    members: &[Member],
    out: &mut [f64],
) -> f64 {
    let mut largest = 0.0_f64;
    for (row, out) in structure.row_start.windows(2).zip(out) {
        let (mut sum, mut size) = (0.0, 0.0);
        for direction in &jacobian[row[0]..row[1]] {
            let member = &members[direction.member];
            let moving = direction.linear.dot(member.velocity);
            let turning = direction.angular.dot(member.angular_velocity);
            sum += moving + turning;
            size += moving.abs() + turning.abs();
        }
        *out = sum;
        largest = largest.max(size);
    }
    largest
}

/// Books the work of the impulses Λ of rows that move with time: Λ J v, since J v + ∂c/∂t = 0.
pub(super) fn book(rates: impl Iterator<Item = f64>, impulses: &[f64], state: &mut State) {
    for (rate, impulse) in rates.zip(impulses) {
        state.accounts.motors -= impulse * rate;
    }
}

/// Gives the bodies the impulses Jᵀ Λ. What guides a body bears the impulse on it, and so does its work, with the opposite sign.
pub(super) fn push(
    structure: &Structure,
    jacobian: &[Direction],
    impulses: &[f64],
    model: &Model,
    state: &mut State,
) {
    for_each_direction(structure, jacobian, impulses, |member, direction, impulse| {
        let i = structure.bodies[member];
        let inverse_mass = model.inverse_mass()[i];
        if inverse_mass != 0.0 {
            state.velocity[i] += impulse * inverse_mass * direction.linear;
            state.angular_momentum[i] += impulse * direction.angular;
        } else {
            let turning = direction.angular.dot(model.angular_velocity(i, state));
            state.accounts.work -= impulse * (direction.linear.dot(state.velocity[i]) + turning);
        }
    });
}

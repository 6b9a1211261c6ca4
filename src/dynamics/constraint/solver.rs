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
use super::member::Member;
use super::structure::{Place, Structure};
use super::{Direction, Equations, Members, Row};

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
    structure: Option<Structure>,
    factor: Factor,
    members: Vec<Member>,
    /// The motions of members that are given.
    motions: Vec<Option<Arc<dyn Motion>>>,
    rows: Vec<Row>,
    jacobian: Vec<Direction>,
    /// The Jacobian at the beginning of the step, for methods that kick along it.
    first: Vec<Direction>,
    /// Which rows take part in this step.
    held: Vec<bool>,
    /// What is solved for.
    unknown: Vec<f64>,
    trial: State,
    /// Whether rows and factors are those of the state that comes next.
    is_ready: bool,
    failure: Option<Breakdown>,
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
    pub(in crate::dynamics) fn begin(&mut self, model: &Model, state: &State) {
        if model.constraints().is_empty() {
            return;
        }
        self.plan(model);
        self.measure(model, state);
        self.held.fill(true);
        self.factorise(true);
        self.is_ready = true;
    }

    /// Adds the forces and torques that keep the constraints to the loads.
    pub(in crate::dynamics) fn react(&mut self, model: &Model, t: f64, state: &State, loads: &mut Loads) {
        if model.constraints().is_empty() {
            return;
        }
        if !self.is_ready {
            self.plan(model);
            self.measure(model, state);
            self.factorise(false);
        }
        self.is_ready = false;
        let Solver { structure: Some(structure), members, motions, rows, jacobian, unknown, .. } = self
        else {
            return;
        };
        // The accelerations without the constraints take the place of velocities, which are not needed any more.
        for ((member, motion), &i) in members.iter_mut().zip(motions).zip(&structure.bodies) {
            if let Some(motion) = motion {
                member.velocity = motion.at(t).acceleration;
                member.angular_velocity = motion.angular_acceleration(t);
            } else {
                let gyroscopic = member.angular_velocity.cross(state.angular_momentum[i]);
                member.velocity = member.inverse_mass * loads.force[i];
                member.angular_velocity = member.inverse_inertia * (loads.torque[i] - gyroscopic);
            }
        }
        rates(&structure.places, jacobian, members, unknown);
        for (value, row) in unknown.iter_mut().zip(&*rows) {
            *value = -(*value + row.bias);
        }
        self.factor.solve(unknown);
        for_each_direction(&structure.places, jacobian, unknown, |member, direction, multiplier| {
            let i = structure.bodies[member];
            loads.force[i] += multiplier * direction.linear;
            loads.torque[i] += multiplier * direction.angular;
        });
    }

    /// Changes the velocities at the beginning of a step such that free bodies are where the constraints hold after it: the
    /// impulses of SHAKE and RATTLE. The step has begun with [`begin`](Self::begin) at these places.
    pub(in crate::dynamics) fn aim(&mut self, model: &Model, t: f64, dt: f64, state: &mut State) {
        if model.constraints().is_empty() {
            return;
        }
        self.is_ready = false;
        self.first.clone_from(&self.jacobian);
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
            self.measure(model, &trial);
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
        self.settle_places(model, state);
        self.blame(model, t);
        self.settle_velocities(model, state);
    }

    fn settle_places(&mut self, model: &Model, state: &mut State) {
        let mut before = f64::INFINITY;
        let mut is_factorised = false;
        for _ in 0..ITERATIONS {
            self.measure(model, state);
            let worst = self.worst();
            let is_slow = worst > 0.1 * before;
            let is_there = worst <= ROUNDING || (worst < FAILURE && is_slow);
            if !is_factorised || (is_slow && !is_there) {
                self.factorise(false);
                is_factorised = true;
            }
            if is_there {
                return;
            }
            before = worst;
            for (value, row) in self.unknown.iter_mut().zip(&self.rows) {
                *value = -row.violation;
            }
            self.factor.solve(&mut self.unknown);
            let Solver { structure: Some(structure), members, jacobian, unknown, .. } = &*self else {
                return;
            };
            for_each_direction(&structure.places, jacobian, unknown, |member, direction, multiplier| {
                let (i, member) = (structure.bodies[member], &members[member]);
                state.location[i] += multiplier * member.inverse_mass * direction.linear;
                let turn = member.inverse_inertia * (multiplier * direction.angular);
                if turn != DVec3::ZERO {
                    state.orientation[i] = (DQuat::from_scaled_axis(turn) * state.orientation[i]).normalize();
                }
            });
        }
    }

    fn settle_velocities(&mut self, model: &Model, state: &mut State) {
        let Solver { structure: Some(structure), members, jacobian, unknown, factor, .. } = self else {
            return;
        };
        let mut before = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let scale = rates(&structure.places, jacobian, members, unknown);
            let worst = unknown.iter().zip(&self.held).filter(|(_, held)| **held);
            let worst = worst.fold(0.0_f64, |worst, (rate, _)| worst.max(rate.abs()));
            // A NaN ends it as well.
            if !(worst > ROUNDING * scale && worst < 0.5 * before) {
                return;
            }
            before = worst;
            unknown.iter_mut().for_each(|rate| *rate = -*rate);
            factor.solve(unknown);
            push(structure, jacobian, unknown, model, state);
            for_each_direction(&structure.places, jacobian, unknown, |member, direction, multiplier| {
                let member = &mut members[member];
                member.velocity += multiplier * member.inverse_mass * direction.linear;
                member.angular_velocity += member.inverse_inertia * (multiplier * direction.angular);
            });
        }
    }

    /// The largest value of all equations, also of those that others imply.
    pub(in crate::dynamics) fn violation(&mut self, model: &Model, state: &State) -> f64 {
        self.is_ready = false;
        self.plan(model);
        self.measure(model, state);
        self.rows.iter().fold(0.0, |worst, row| worst.max(row.violation.abs()))
    }

    /// Notes the equation that is off by most, if that is too much.
    fn blame(&mut self, model: &Model, time: f64) {
        let Some(structure) = &self.structure else { return };
        let mut failed = None;
        for place in &structure.places {
            for row in &self.rows[place.row..place.row + place.rows] {
                let is_kept = row.violation.abs() <= FAILURE * row.scale;
                if !is_kept && failed.is_none_or(|(_, missing)| row.violation.abs() > missing) {
                    failed = Some((place.constraint, row.violation.abs()));
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
    fn plan(&mut self, model: &Model) {
        if self.structure.is_some() {
            return;
        }
        let can_move = |body: usize| model.inverse_mass()[body] != 0.0;
        let structure = Structure::of(model.constraints(), |body| model.is_present(body), can_move);
        self.factor = Factor::new(&structure);
        self.members = vec![Member::default(); structure.bodies.len()];
        self.motions = structure.bodies.iter().map(|&body| model.motion(body)).collect();
        self.rows = vec![Row::default(); structure.rows];
        self.jacobian = vec![Direction::default(); structure.directions];
        self.held = vec![true; structure.rows];
        self.unknown = vec![0.0; structure.rows];
        self.structure = Some(structure);
    }

    /// Measures all equations at a state.
    fn measure(&mut self, model: &Model, state: &State) {
        let Some(structure) = &self.structure else { return };
        for (member, &i) in self.members.iter_mut().zip(&structure.bodies) {
            *member = Member::of(i, model, state);
        }
        for place in &structure.places {
            let bodies = place.bodies.len();
            let mut equations = Equations {
                rows: &mut self.rows[place.row..place.row + place.rows],
                jacobian: &mut self.jacobian[place.direction..place.direction + place.rows * bodies],
                bodies,
            };
            let members = Members { all: &self.members, of: &place.bodies };
            model.constraints()[place.constraint].measure(&members, &mut equations);
        }
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
    fn factorise(&mut self, choose: bool) {
        let Some(structure) = &self.structure else { return };
        for (own, neighbours) in structure.places.iter().zip(&structure.neighbours) {
            for row in 0..own.rows {
                let mut at = self.factor.columns[own.row + row].first;
                for neighbour in neighbours {
                    let other = &structure.places[neighbour.place];
                    let count = other.rows.min((own.row + row + 1).saturating_sub(other.row));
                    for other_row in 0..count {
                        let mut sum = 0.0;
                        for &(theirs, mine) in &neighbour.shared {
                            let a = &self.jacobian[other.direction + other_row * other.bodies.len() + theirs];
                            let b = &self.jacobian[own.direction + row * own.bodies.len() + mine];
                            let member = &self.members[own.bodies[mine]];
                            sum += member.inverse_mass * a.linear.dot(b.linear)
                                + a.angular.dot(member.inverse_inertia * b.angular);
                        }
                        self.factor.values[at] = sum;
                        at += 1;
                    }
                }
            }
        }
        self.factor.compute(&mut self.held, choose);
    }
}

/// Calls back with each direction of the Jacobian, its member and the multiplier of its row.
fn for_each_direction(
    places: &[Place],
    jacobian: &[Direction],
    multipliers: &[f64],
    mut act: impl FnMut(usize, &Direction, f64),
) {
    for place in places {
        let width = place.bodies.len();
        for row in 0..place.rows {
            let multiplier = multipliers[place.row + row];
            if multiplier != 0.0 {
                let first = place.direction + row * width;
                for (direction, &member) in jacobian[first..first + width].iter().zip(&place.bodies) {
                    act(member, direction, multiplier);
                }
            }
        }
    }
}

/// J v for the velocities of the members; the largest sum of the sizes of its terms.
fn rates(places: &[Place], jacobian: &[Direction], members: &[Member], out: &mut [f64]) -> f64 {
    let mut largest = 0.0_f64;
    for place in places {
        let width = place.bodies.len();
        for row in 0..place.rows {
            let first = place.direction + row * width;
            let (mut sum, mut size) = (0.0, 0.0);
            for (direction, &member) in jacobian[first..first + width].iter().zip(&place.bodies) {
                let member = &members[member];
                let (moving, turning) =
                    (direction.linear.dot(member.velocity), direction.angular.dot(member.angular_velocity));
                sum += moving + turning;
                size += moving.abs() + turning.abs();
            }
            out[place.row + row] = sum;
            largest = largest.max(size);
        }
    }
    largest
}

/// Gives the bodies the impulses Jᵀ Λ. What guides a body bears the impulse on it, and so does its work, with the opposite sign.
fn push(structure: &Structure, jacobian: &[Direction], impulses: &[f64], model: &Model, state: &mut State) {
    for_each_direction(&structure.places, jacobian, impulses, |member, direction, impulse| {
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

//! The model: all quantities that are constant in time, such as the masses of the bodies and the forces on them.

mod away;

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use self::away::Away;
use super::{
    Accounts, Breakdown, Constraint, Effort, Force, Gravitation, Kinematics, Loads, Moment, Motion,
    RigidBody, Shape, State,
};

/// The constants of the equations of motion: masses, inertia and forces. With a [`State`], the model determines x' = v, v' = F/m, L' = τ
/// and q' = ½ ω q, where ω = R I⁻¹ Rᵀ L.
#[derive(Clone, Default)]
pub struct Model {
    mass: Vec<f64>,
    charge: Vec<f64>,
    inverse_mass: Vec<f64>,
    inertia: Vec<DVec3>,
    inverse_inertia: Vec<DVec3>,
    principal_axes: Sparse<DQuat>,
    shapes: Vec<Shape>,
    movable: Vec<bool>,
    /// For each body held at rest, its inverse mass and inverse moments of inertia. They return when the body is released.
    frozen: BTreeMap<usize, (f64, DVec3)>,
    /// The indices of the bodies that no load moves: fixed, guided, absent, or held at rest.
    unmoved: Vec<usize>,
    /// The constants of absent bodies, one entry per body; `None` for present ones. The list ends at the last absent body, to save memory.
    away: Vec<Option<Box<Away>>>,
    /// The given motions, each with the index of the body that follows it.
    motions: Vec<(usize, Arc<dyn Motion>)>,
    force: Sparse<DVec3>,
    torque: Sparse<DVec3>,
    /// The indices of the bodies with a nonzero constant torque. They are few, and only their constant torques do work.
    torqued: Vec<usize>,
    forces: Vec<Arc<dyn Force>>,
    constraints: Vec<Arc<dyn Constraint>>,
    effort: Effort,
    /// The indices of the bodies that are advanced at present; `None` if all are.
    focus: Option<Vec<usize>>,
}

impl Model {
    /// Returns the number of bodies in the model.
    #[must_use]
    pub fn len(&self) -> usize {
        self.mass.len()
    }

    /// Returns true if the model has no bodies.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.mass.is_empty()
    }

    /// Returns the mass of each body, kg.
    #[must_use]
    pub fn mass(&self) -> &[f64] {
        &self.mass
    }

    /// Returns the electric charge of each body, C.
    #[must_use]
    pub fn charge(&self) -> &[f64] {
        &self.charge
    }

    /// Returns the inverse mass 1/m of each body, 1/kg; 0 for a body that forces cannot move.
    #[must_use]
    pub fn inverse_mass(&self) -> &[f64] {
        &self.inverse_mass
    }

    /// Returns the principal moments of inertia of each body, kg m².
    #[must_use]
    pub fn inertia(&self) -> &[DVec3] {
        &self.inertia
    }

    /// Returns the inverse principal moments of inertia of each body, 1/(kg m²). 0 for an axis about which torques cannot rotate the body.
    #[must_use]
    pub fn inverse_inertia(&self) -> &[DVec3] {
        &self.inverse_inertia
    }

    /// Returns the rotation from a body's principal axes of inertia to its body axes.
    #[must_use]
    pub fn principal_axes(&self, body: usize) -> DQuat {
        self.principal_axes.get(body)
    }

    /// Returns the shape of a body for contacts; `None` if it has not been set.
    #[must_use]
    pub fn shape(&self, body: usize) -> Option<&Shape> {
        self.shapes.get(body)
    }

    /// Returns, for each body, whether its position can change: its motion is given, or it is not fixed and its mass is positive.
    #[must_use]
    pub fn movable(&self) -> &[bool] {
        &self.movable
    }

    /// Returns true if bodies that do not meet can be advanced one after another: no force or constraint couples bodies, and no work has
    /// to be integrated.
    pub(super) fn is_local(&self) -> bool {
        self.constraints.is_empty()
            && self.motions.is_empty()
            && self.torqued.is_empty()
            && self.forces.iter().all(|force| force.is_local())
    }

    /// Restricts the integration to these bodies from now on; their indices are in ascending order. `None` stands for all bodies. Methods
    /// may leave the other bodies unchanged.
    pub(super) fn focus(&mut self, bodies: Option<Vec<usize>>) {
        self.focus = bodies;
    }

    /// Returns the indices of the bodies that are advanced at present, in ascending order; `None` if all are.
    pub(super) fn in_focus(&self) -> Option<&[usize]> {
        self.focus.as_deref()
    }

    /// Returns true if any force depends on velocities, or does work without a potential. Methods must then evaluate forces at more than
    /// the positions.
    pub(super) fn depends_on_motion(&self) -> bool {
        !self.torqued.is_empty() || self.forces.iter().any(|force| force.depends_on_motion())
    }

    /// Returns true if any force or torque can change the angular momentum of a body.
    pub(super) fn turns_bodies(&self) -> bool {
        !self.torqued.is_empty() || self.forces.iter().any(|force| force.turns_bodies())
    }

    /// Returns Newton's gravitation between bodies, if it is among the forces.
    pub(super) fn gravitation(&self) -> Option<&Gravitation> {
        self.forces.iter().find_map(|force| force.gravitation())
    }

    /// Returns true if any present body follows a given motion.
    pub(super) fn has_guided(&self) -> bool {
        self.guided().next().is_some()
    }

    /// Returns true if forces move no body at all, present or absent.
    pub(super) fn is_given(&self) -> bool {
        self.frozen.is_empty()
            && self.inverse_mass.iter().all(|&inverse| inverse == 0.0)
            && self.away.iter().flatten().all(|away| away.is_given())
    }

    /// Returns true if loads can move a body. A body held at rest counts as movable.
    pub(super) fn can_move(&self, body: usize) -> bool {
        self.inverse_mass[body] != 0.0 || self.frozen.contains_key(&body)
    }

    /// Holds a body at rest: loads do not move it until it is released.
    pub(super) fn freeze(&mut self, body: usize, state: &mut State) {
        let constants = (self.inverse_mass[body], self.inverse_inertia[body]);
        self.frozen.insert(body, constants);
        (self.inverse_mass[body], self.inverse_inertia[body]) = (0.0, DVec3::ZERO);
        (state.velocity[body], state.angular_momentum[body]) = (DVec3::ZERO, DVec3::ZERO);
        self.unmoved.push(body);
    }

    /// Releases a body held at rest: loads move it again.
    pub(super) fn thaw(&mut self, body: usize) {
        if let Some(constants) = self.frozen.remove(&body) {
            (self.inverse_mass[body], self.inverse_inertia[body]) = constants;
            self.unmoved.retain(|&other| other != body);
        }
    }

    /// Returns the constant force on a body, world axes, N.
    #[must_use]
    pub fn constant_force(&self, body: usize) -> DVec3 {
        self.force.get(body)
    }

    /// Returns the constant torque on a body, world axes, N m.
    #[must_use]
    pub fn constant_torque(&self, body: usize) -> DVec3 {
        self.torque.get(body)
    }

    /// Returns all forces except the constant forces of single bodies.
    #[must_use]
    pub fn forces(&self) -> &[Arc<dyn Force>] {
        &self.forces
    }

    /// Replaces a breakdown by its cause, if a force without a finite value is the cause.
    pub(super) fn cause(&self, breakdown: Breakdown) -> Breakdown {
        let (Breakdown::Diverged { .. } | Breakdown::Stalled { .. }) = breakdown else { return breakdown };
        let undefined = |(force, it): (usize, &Arc<dyn Force>)| it.undefined().map(|at| (force, at));
        match self.forces.iter().enumerate().find_map(undefined) {
            Some((force, at)) => Breakdown::Undefined { force, at },
            None => breakdown,
        }
    }

    /// Returns the constraints between bodies, in the order in which they were added.
    #[must_use]
    pub fn constraints(&self) -> &[Arc<dyn Constraint>] {
        &self.constraints
    }

    /// Returns the given motion of a body; `None` if forces move it or it is fixed.
    pub(super) fn motion(&self, body: usize) -> Option<Arc<dyn Motion>> {
        self.motions.iter().find(|(other, _)| *other == body).map(|(_, motion)| motion.clone())
    }

    /// Returns the counter of computed pair interactions, for progress bars.
    pub(super) fn effort(&self) -> &Effort {
        &self.effort
    }

    pub(super) fn watch(&mut self, effort: Effort) {
        self.effort = effort;
    }

    /// Reserves memory for this many more bodies.
    pub(super) fn reserve(&mut self, bodies: usize) {
        self.mass.reserve_exact(bodies);
        self.charge.reserve_exact(bodies);
        self.inverse_mass.reserve_exact(bodies);
        self.inertia.reserve_exact(bodies);
        self.inverse_inertia.reserve_exact(bodies);
        self.movable.reserve_exact(bodies);
    }

    /// Adds a body to the model and to `state`, so that both always have the same number of bodies.
    pub(super) fn push(&mut self, body: &RigidBody, state: &mut State) {
        let index = self.len();
        let movable = !body.fixed && body.mass > 0.0;
        let inverse = |x: f64| if movable && x > 0.0 { 1.0 / x } else { 0.0 };
        let inverse_inertia = body.inertia.map(inverse);
        // If the principal axes are the body axes, the product would change only the signs of zeros.
        let turned = body.principal_axes != DQuat::IDENTITY;
        let orientation = if turned { body.orientation * body.principal_axes } else { body.orientation };
        let orientation = orientation.normalize();

        self.mass.push(body.mass);
        self.charge.push(body.charge);
        self.inverse_mass.push(inverse(body.mass));
        self.inertia.push(body.inertia);
        self.inverse_inertia.push(inverse_inertia);
        self.principal_axes.set(index, body.principal_axes);
        self.movable.push(movable);
        if !movable {
            self.unmoved.push(index);
        }
        self.force.set(index, body.force);
        self.set_constant_torque(index, body.torque);

        // A body that cannot move starts at rest, and zero loads keep it at rest. Integration methods therefore need no special case for
        // it.
        let (velocity, angular_momentum) = if movable {
            let in_body = orientation.conjugate() * body.angular_velocity;
            (body.velocity, orientation * (body.inertia * in_body))
        } else {
            (DVec3::ZERO, DVec3::ZERO)
        };
        state.location.push(body.location);
        state.velocity.push(velocity);
        state.orientation.push(orientation);
        state.angular_momentum.push(angular_momentum);
    }

    /// Makes a body follow a given motion from now on. Its inverse mass becomes 0, so that loads do not move it.
    pub(super) fn drive(&mut self, body: usize, motion: Arc<dyn Motion>) {
        let is_fixed = !self.movable[body];
        let is_driven = !is_fixed && self.inverse_mass[body] == 0.0;
        if is_driven {
            self.motions.retain(|(other, _)| *other != body);
        } else if !is_fixed {
            self.unmoved.push(body);
        }
        self.motions.push((body, motion));
        self.movable[body] = true;
        self.inverse_mass[body] = 0.0;
        // The inverse moments stay: the angular velocity is computed from them and the angular momentum.
        self.inverse_inertia[body] =
            self.inertia[body].map(|moment| if moment > 0.0 { 1.0 / moment } else { 0.0 });
    }

    /// Returns the present bodies with a given motion, each with its motion.
    fn guided(&self) -> impl Iterator<Item = (usize, &dyn Motion)> {
        let present = self.motions.iter().filter(|(i, _)| self.is_present(*i));
        present.map(|(i, motion)| (*i, &**motion))
    }

    /// Sets the force on each body with a given motion to m a, the force that this motion requires.
    pub(super) fn guide(&self, t: f64, loads: &mut Loads) {
        for (i, motion) in self.guided() {
            loads.force[i] = self.mass[i] * motion.at(t).acceleration;
        }
    }

    /// Places all present bodies with a given motion where they are at time `t`, s.
    pub fn place(&self, t: f64, state: &mut State) {
        self.guided().for_each(|(i, motion)| self.place_body(i, &motion.at(t), state));
    }

    /// Sets the position, orientation and velocities of one body to those of `given`.
    pub(super) fn place_body(&self, i: usize, given: &Kinematics, state: &mut State) {
        let orientation = (given.orientation * self.principal_axes.get(i)).normalize();
        let in_body = orientation.conjugate() * given.angular_velocity;
        state.location[i] = given.location;
        state.velocity[i] = given.velocity;
        state.orientation[i] = orientation;
        state.angular_momentum[i] = orientation * (self.inertia[i] * in_body);
    }

    pub(super) fn push_force(&mut self, force: Arc<dyn Force>) {
        self.forces.push(force);
    }

    /// Sets the shape of the first body that has none yet.
    pub(super) fn push_shape(&mut self, shape: Shape) {
        self.shapes.push(shape);
    }

    pub(super) fn push_constraint(&mut self, constraint: Arc<dyn Constraint>) {
        self.constraints.push(constraint);
    }

    pub(super) fn set_constant_force(&mut self, body: usize, force: DVec3) {
        self.force.set(body, force);
    }

    pub(super) fn set_constant_torque(&mut self, body: usize, torque: DVec3) {
        let before = self.torque.get(body);
        self.torque.set(body, torque);
        match (before != DVec3::ZERO, torque != DVec3::ZERO) {
            (false, true) => self.torqued.push(body),
            (true, false) => self.torqued.retain(|&other| other != body),
            _ => {}
        }
    }

    /// Computes the sums of all forces and torques at `time`, s, and writes them to `loads`. Constraint forces are not included:
    /// [`System::evaluate`](super::System::evaluate) adds them.
    ///
    /// The loads on bodies that do not move are zero, because the support of the body balances them.
    pub fn evaluate(&self, time: f64, state: &State, loads: &mut Loads) {
        self.sum(time, state, loads);
        self.bear(state, loads);
    }

    /// Computes the sums of the forces on a range of bodies, including bodies that no load moves. Torques and power are not changed.
    /// Returns false if any force can only be evaluated for all bodies; the loads are then invalid.
    pub(super) fn sum_part(&self, bodies: Range<usize>, time: f64, state: &State, loads: &mut Loads) -> bool {
        loads.force.resize(self.len(), DVec3::ZERO);
        self.force.write_part(&mut loads.force, bodies.clone());
        let moment = Moment { time, state, model: self };
        self.forces.iter().all(|force| force.apply_to(bodies.clone(), &moment, loads))
    }

    /// Computes the sums of all forces and torques, including those on bodies that no load moves.
    pub(super) fn sum(&self, time: f64, state: &State, loads: &mut Loads) {
        if self.sum_in_focus(time, state, loads) {
            return;
        }
        self.force.write(&mut loads.force, self.len());
        self.torque.write(&mut loads.torque, self.len());
        loads.power = Accounts::default();
        for &i in &self.torqued {
            loads.power.work += self.torque.get(i).dot(self.angular_velocity(i, state));
        }
        let moment = Moment { time, state, model: self };
        for force in &self.forces {
            force.apply(&moment, loads);
        }
    }

    /// Computes the loads only on the bodies that are advanced at present; those on other bodies become invalid. Returns false if all
    /// bodies are advanced, or if any force can only be evaluated for all bodies.
    fn sum_in_focus(&self, time: f64, state: &State, loads: &mut Loads) -> bool {
        let Some(bodies) = self.in_focus().filter(|_| !self.turns_bodies() && !self.depends_on_motion())
        else {
            return false;
        };
        loads.force.resize(self.len(), DVec3::ZERO);
        loads.torque.resize(self.len(), DVec3::ZERO);
        loads.power = Accounts::default();
        let moment = Moment { time, state, model: self };
        bodies.iter().all(|&i| {
            (loads.force[i], loads.torque[i]) = (self.force.get(i), self.torque.get(i));
            self.forces.iter().all(|force| force.apply_to(i..i + 1, &moment, loads))
        })
    }

    /// Sets the loads to zero on bodies that no load moves: the support of a fixed body, or the guide of a body with a given motion, bears
    /// them.
    pub(super) fn bear(&self, state: &State, loads: &mut Loads) {
        for (i, _) in self.guided() {
            // The guide of a body makes it follow its given motion. It exerts the opposite loads, so its work has the opposite sign.
            let turning = loads.torque[i].dot(self.angular_velocity(i, state));
            loads.power.work -= loads.force[i].dot(state.velocity[i]) + turning;
        }
        for &i in &self.unmoved {
            loads.force[i] = DVec3::ZERO;
            loads.torque[i] = DVec3::ZERO;
        }
    }

    /// Computes the potential energy of all forces that have one, J. A constant force has the potential −F·x.
    #[must_use]
    pub fn potential(&self, time: f64, state: &State) -> f64 {
        let mut potential = 0.0;
        for i in (0..self.len()).filter(|&i| self.movable[i]) {
            potential -= self.force.get(i).dot(state.location[i]);
        }
        let moment = Moment { time, state, model: self };
        self.forces.iter().fold(potential, |sum, force| sum + force.potential(&moment))
    }

    /// Returns the changes of velocity (m/s) and angular velocity (rad/s) of a body by an impulse and its moment about the center of mass.
    pub(super) fn respond(&self, i: usize, state: &State, (push, moment): (DVec3, DVec3)) -> (DVec3, DVec3) {
        let inverse_mass = self.inverse_mass[i];
        if inverse_mass == 0.0 {
            return (DVec3::ZERO, DVec3::ZERO);
        }
        let (inverse, turn) = (self.inverse_inertia[i], state.orientation[i]);
        (inverse_mass * push, turn * (inverse * (turn.conjugate() * moment)))
    }

    /// Returns the orientation of a body: the rotation from body axes to world axes. (A state stores the orientation of the principal
    /// axes.)
    #[must_use]
    pub fn world_from_body(&self, body: usize, state: &State) -> DQuat {
        let (orientation, axes) = (state.orientation[body], self.principal_axes(body));
        if axes == DQuat::IDENTITY { orientation } else { orientation * axes.conjugate() }
    }

    /// Returns the angular velocity of body `i`, ω = R I⁻¹ Rᵀ L, world axes, rad/s.
    #[must_use]
    pub fn angular_velocity(&self, i: usize, state: &State) -> DVec3 {
        let inverse = self.inverse_inertia[i];
        let angular_momentum = state.angular_momentum[i];
        if is_isotropic(inverse) {
            // If all moments are equal, all axes are principal axes, and R cancels.
            return inverse.x * angular_momentum;
        }
        let world_from_body = state.orientation[i];
        world_from_body * (inverse * (world_from_body.conjugate() * angular_momentum))
    }
}

/// Returns true if all three principal moments are equal, as for a sphere or a cube.
pub(super) fn is_isotropic(moments: DVec3) -> bool {
    moments.x == moments.y && moments.y == moments.z
}

/// A quantity that has its default value for most bodies. The list ends at the last body with another value, to save memory.
#[derive(Clone, Default)]
struct Sparse<T>(Vec<T>);

/// A type with a default value for [`Sparse`] lists.
trait Nothing: Copy + PartialEq {
    const NOTHING: Self;
}

impl Nothing for DVec3 {
    const NOTHING: DVec3 = DVec3::ZERO;
}

impl Nothing for DQuat {
    const NOTHING: DQuat = DQuat::IDENTITY;
}

impl<T: Nothing> Sparse<T> {
    fn get(&self, body: usize) -> T {
        self.0.get(body).copied().unwrap_or(T::NOTHING)
    }

    fn set(&mut self, body: usize, value: T) {
        if body >= self.0.len() && value != T::NOTHING {
            self.0.resize(body + 1, T::NOTHING);
        }
        if let Some(place) = self.0.get_mut(body) {
            *place = value;
        }
    }

    /// Writes the values of bodies 0 to `bodies` − 1 to `out`, and replaces its contents.
    fn write(&self, out: &mut Vec<T>, bodies: usize) {
        out.clone_from(&self.0);
        out.resize(bodies, T::NOTHING);
    }

    /// Writes the values of a range of bodies to the same range of `out`.
    fn write_part(&self, out: &mut [T], bodies: Range<usize>) {
        let known = self.0.len().clamp(bodies.start, bodies.end);
        out[known..bodies.end].fill(T::NOTHING);
        if known > bodies.start {
            out[bodies.start..known].copy_from_slice(&self.0[bodies.start..known]);
        }
    }
}

//! The model: all quantities that are constant in time, such as the masses of the bodies and the forces on them.

mod away;
mod guided;
mod loads;
mod sparse;

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use self::away::Away;
use self::sparse::Sparse;
use super::{Breakdown, Constraint, Force, Gravitation, Motion, PairCounter, RigidBody, Shape, State};

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
    /// The indices of the bodies that no load moves: fixed, absent, held at rest, or with a given motion.
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
    pair_counter: PairCounter,
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

    /// Restricts the integration to these bodies from now on; their indices are in ascending order. `None` stands for all bodies.
    /// Integration methods may leave the other bodies unchanged.
    pub(super) fn focus(&mut self, bodies: Option<Vec<usize>>) {
        self.focus = bodies;
    }

    /// Returns the indices of the bodies that are advanced at present, in ascending order; `None` if all are.
    pub(super) fn in_focus(&self) -> Option<&[usize]> {
        self.focus.as_deref()
    }

    /// Returns true if any force depends on velocities, or does work without a potential. Integration methods must then know the
    /// velocities, not only the positions, when they evaluate forces.
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

    /// Returns true if forces move no body at all, present or absent.
    pub(super) fn is_given(&self) -> bool {
        self.frozen.is_empty()
            && self.inverse_mass.iter().all(|&inverse| inverse == 0.0)
            && self.away.iter().flatten().all(|away| away.is_given())
    }

    /// Returns true if loads can move a body. A body held at rest counts as movable.
    pub(crate) fn can_move(&self, body: usize) -> bool {
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

    /// Replaces a breakdown by [`Breakdown::Undefined`] if a force without a finite value has caused it.
    pub(super) fn cause(&self, breakdown: Breakdown) -> Breakdown {
        let (Breakdown::Diverged { .. } | Breakdown::Stalled { .. }) = breakdown else { return breakdown };
        let undefined = |(force, it): (usize, &Arc<dyn Force>)| it.undefined().map(|at| (force, at));
        match self.forces.iter().enumerate().find_map(undefined) {
            Some((force, at)) => Breakdown::Undefined { force, at },
            None => breakdown,
        }
    }

    /// Returns true if any load does work without a potential.
    pub(super) fn does_work(&self) -> bool {
        !self.torqued.is_empty() || self.forces.iter().any(|force| force.work_account().is_some())
    }

    /// Returns the constraints between bodies, in the order in which they were added.
    #[must_use]
    pub fn constraints(&self) -> &[Arc<dyn Constraint>] {
        &self.constraints
    }

    /// Returns the counter of computed pair interactions, for progress bars.
    pub(super) fn pair_counter(&self) -> &PairCounter {
        &self.pair_counter
    }

    pub(super) fn watch(&mut self, pair_counter: PairCounter) {
        self.pair_counter = pair_counter;
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

    pub(super) fn push_force(&mut self, force: Arc<dyn Force>) {
        self.forces.push(force);
    }

    /// Sets the shape of the first body that has no shape yet.
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

    /// Returns the changes of a body's velocity (m/s) and angular velocity (rad/s) that an impulse and its moment about the center of mass
    /// cause.
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

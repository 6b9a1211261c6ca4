//! Bodies, forces, an integration method and a clock.

mod advance;
mod apart;
mod crowd;
mod event;
mod picture;
mod piece;
mod rest;

#[cfg(feature = "time-stepping")]
pub(super) use advance::steps_of;

use std::sync::Arc;

use glam::{DQuat, DVec3};

use self::picture::{picture, push_crowd};
use self::rest::Rest;
use super::constraint::Solver;
use super::contact::Collider;
use super::presence::Calendar;
use super::{
    Balance, BodyId, Breakdown, Constraint, ContactSnapshot, Contacts, Dynamics, Effort, EnergyLedger, Force,
    Impact, Integrator, Loads, METHODS, Method, Model, Motion, Presence, RigidBody, Shape, Snapshot, State,
    System,
};

/// The default for the longest timestep, s.
const DEFAULT_STEP: f64 = 1.0 / 240.0;

/// Bodies that move under forces, advanced by one of the [`METHODS`].
///
/// A world does not know its initial state: to reset it, build it again. A clone continues exactly as the original would, and the two are
/// independent.
#[derive(Clone)]
pub struct World {
    time: f64,
    step: f64,
    model: Model,
    state: State,
    method: &'static Method,
    integrator: Box<dyn Integrator>,
    solver: Solver,
    /// Whether the state satisfies the constraints.
    is_settled: bool,
    ledger: EnergyLedger,
    calendar: Calendar,
    /// Contacts between bodies, if bodies collide.
    collider: Option<Collider>,
    /// The bodies held at rest.
    rest: Rest,
    /// The contacts of bodies under time-stepping, only filled when a snapshot is taken.
    crowd: Vec<ContactSnapshot>,
    steps: u64,
    /// Working memory for the loads at one moment.
    loads: Loads,
    /// The end of the present step, s.
    end: f64,
    /// Whether the modes of all contacts are decided; false after a step in groups.
    is_decided: bool,
    /// The solvers of the groups' contacts.
    parts: Vec<Solver>,
    /// The number of steps until groups are searched again.
    together: u32,
    /// Working memory for the state before a step, for moments within it.
    before: State,
}

/// The parts of a world, except its method and its constraints.
pub(super) struct Parts {
    pub(super) time: f64,
    pub(super) step: f64,
    pub(super) model: Model,
    pub(super) state: State,
    pub(super) ledger: EnergyLedger,
    pub(super) calendar: Calendar,
}

impl World {
    /// An empty world at time 0, with the default method and a longest step of 1/240 s.
    #[must_use]
    pub fn new() -> Self {
        let method = &METHODS[0];
        Self {
            time: 0.0,
            step: DEFAULT_STEP,
            model: Model::default(),
            state: State::default(),
            method,
            integrator: (method.create)(),
            solver: Solver::default(),
            is_settled: true,
            ledger: EnergyLedger::new(),
            calendar: Calendar::default(),
            collider: None,
            rest: Rest::default(),
            crowd: Vec::new(),
            steps: 0,
            loads: Loads::default(),
            end: 0.0,
            is_decided: true,
            parts: Vec::new(),
            together: 0,
            before: State::default(),
        }
    }

    /// Its parts, for another engine.
    pub(super) fn into_parts(self) -> Parts {
        let World { time, step, model, state, ledger, calendar, .. } = self;
        Parts { time, step, model, state, ledger, calendar }
    }

    /// Reserves memory for more bodies.
    pub fn reserve(&mut self, bodies: usize) {
        self.model.reserve(bodies);
        self.state.reserve(bodies);
    }

    /// Adds a body. This is allowed at any time.
    pub fn add(&mut self, body: RigidBody) -> BodyId {
        self.about_to_change();
        self.model.push(&body, &mut self.state);
        BodyId::new(self.model.len() - 1)
    }

    /// Adds the shapes of bodies, in the order in which the bodies were added.
    pub fn add_shapes(&mut self, shapes: impl IntoIterator<Item = Shape>) {
        shapes.into_iter().for_each(|shape| self.model.push_shape(shape));
    }

    /// From now on, a body follows a given motion; it still acts on others. Its kinetic energy and momentum are not counted, and its
    /// guide does work.
    pub fn drive(&mut self, body: BodyId, motion: impl Motion + 'static) {
        self.follow(body, Arc::new(motion));
    }

    /// Like [`World::drive`], with a motion that can be shared.
    pub fn follow(&mut self, body: BodyId, motion: Arc<dyn Motion>) {
        self.about_to_change();
        let (i, is_present) = (body.index(), self.model.is_present(body.index()));
        if is_present {
            // Only this body: placing all guided bodies here would take n² placements for n bodies.
            self.model.place_body(i, &motion.at(self.time), &mut self.state);
            self.model.drive(i, motion);
        } else {
            self.model.bring(i, &mut self.state);
            self.model.drive(i, motion);
            self.model.take_away(i, &mut self.state);
        }
    }

    /// From now on, a body is present only when `presence` says so. It returns in the state in which it left; before its first
    /// appearance, that is the state in which it was [added](World::add). Its energy comes and goes with it, without drift.
    ///
    /// A step ends at each birth and death. If the motion of all bodies is given, births and deaths take effect at the end of the step.
    pub fn limit(&mut self, body: BodyId, presence: &Presence) {
        self.about_to_change();
        let i = body.index();
        if !self.calendar.note(i, presence, self.time) {
            self.model.take_away(i, &mut self.state);
        } else if !self.model.is_present(i) {
            self.model.let_come_and_go(&[(i, true)], &mut self.state);
        }
    }

    /// Adds a force. This is allowed at any time.
    pub fn add_force(&mut self, force: impl Force + 'static) {
        self.add_shared_force(Arc::new(force));
    }

    /// Adds a shared force. This is allowed at any time.
    pub fn add_shared_force(&mut self, force: Arc<dyn Force>) {
        self.about_to_change();
        self.model.push_force(force);
    }

    /// Adds a constraint. This is allowed at any time. If it is violated, the bodies are moved the shortest distance to satisfy it, and
    /// the violating components of their velocities are removed.
    pub fn add_constraint(&mut self, constraint: impl Constraint + 'static) {
        self.add_shared_constraint(Arc::new(constraint));
    }

    /// Adds a shared constraint. This is allowed at any time.
    pub fn add_shared_constraint(&mut self, constraint: Arc<dyn Constraint>) {
        self.about_to_change();
        self.model.push_constraint(constraint);
    }

    /// From now on, bodies touch each other by the rules of `contacts`. Their shapes are those of [`add_shapes`](Self::add_shapes).
    pub fn collide(&mut self, contacts: Contacts) {
        self.about_to_change();
        self.collider = Some(Collider::new(contacts));
    }

    /// From now on, `force` (world axes, N) is the body's constant force.
    pub fn apply_force(&mut self, body: BodyId, force: DVec3) {
        self.about_to_change();
        self.model.set_constant_force(body.index(), force);
    }

    /// From now on, `torque` (world axes, N m) is the body's constant torque.
    pub fn apply_torque(&mut self, body: BodyId, torque: DVec3) {
        self.about_to_change();
        self.model.set_constant_torque(body.index(), torque);
    }

    /// Must be called before every manual change: the energy ledger and the integrator rely on it.
    fn about_to_change(&mut self) {
        self.let_all_go();
        self.about_to_change_some();
        if let Some(collider) = &mut self.collider {
            collider.forget();
        }
    }

    /// The same if nothing changes for bodies held at rest.
    fn about_to_change_some(&mut self) {
        self.ledger.open(&self.model, self.time, &self.state);
        self.integrator.discontinuity();
        self.solver.forget();
        self.parts.clear();
        self.is_settled = false;
    }

    /// Must be called after manual changes, before anything is measured or time advances.
    fn settle(&mut self) {
        if !self.is_settled {
            self.is_settled = true;
            let accounts = self.state.accounts;
            let mut system = System::new(&self.model, &mut self.solver);
            if system.is_constrained() {
                self.ledger.see_given(&self.model, &self.state);
            }
            system.start(self.time, &mut self.state, &mut self.loads);
            self.is_decided = true;
            self.begin_contacts();
            // This energy is booked with the change itself.
            self.state.accounts = accounts;
        }
    }

    /// Selects the integration method from now on.
    pub fn set_integrator(&mut self, method: &'static Method) {
        self.method = method;
        self.integrator = (method.create)();
    }

    /// The current integration method.
    #[must_use]
    pub fn integrator(&self) -> &'static Method {
        self.method
    }

    /// Sets the longest step that [`advance_to`](Self::advance_to) may take, s. It must be positive; with
    /// `f64::INFINITY` every call is one step.
    pub fn set_step(&mut self, step: f64) {
        self.step = step;
    }

    /// The time reached, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The bodies as they are now.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The angular velocity of a body, world axes, rad/s.
    #[must_use]
    pub fn angular_velocity(&self, body: BodyId) -> DVec3 {
        self.model.angular_velocity(body.index(), &self.state)
    }

    /// The resultant force on each body at this moment, N. Each call evaluates it. It is zero for bodies that do not move, and m a for
    /// those with a given motion.
    pub fn forces(&mut self) -> &[DVec3] {
        self.settle();
        let mut copy = self.decided();
        let World { model, state, solver, crowd, loads, time, .. } = copy.as_mut().unwrap_or(self);
        let mut system = System::new(model, solver);
        system.begin(*time, state);
        system.evaluate(*time, state, loads);
        push_crowd(crowd, model, loads);
        model.guide(*time, loads);
        if let Some(copy) = copy {
            self.loads = copy.loads;
        }
        &self.loads.force
    }

    /// The largest violation of all constraint equations, in metres, or in radians for rotations.
    pub fn violation(&mut self) -> f64 {
        self.settle();
        self.solver.violation(&self.model, self.time, &self.state)
    }

    /// The energies and momenta at this moment. The drift is relative to the largest kinetic energy among all
    /// measurements so far.
    pub fn balance(&mut self) -> Balance {
        self.settle();
        self.ledger.measure(&self.model, self.time, &self.state)
    }

    /// From now on, pair interactions are counted in `effort`.
    pub fn watch(&mut self, effort: &Effort) {
        self.model.watch(effort.clone());
    }

    /// The number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.state.len()
    }

    /// Whether there is no body.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.state.is_empty()
    }

    /// Everything that is constant in time: masses, inertia and forces.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The location of a body's centre of mass, m.
    #[must_use]
    pub fn location(&self, body: BodyId) -> DVec3 {
        self.state.location[body.index()]
    }

    /// The velocity of a body's centre of mass, m/s.
    #[must_use]
    pub fn velocity(&self, body: BodyId) -> DVec3 {
        self.state.velocity[body.index()]
    }

    /// The orientation of a body (`world_from_body`).
    #[must_use]
    pub fn orientation(&self, body: BodyId) -> DQuat {
        self.model.world_from_body(body.index(), &self.state)
    }

    /// A body as it is now.
    #[must_use]
    pub fn body(&self, body: BodyId) -> RigidBody {
        let i = body.index();
        RigidBody {
            mass: self.model.mass()[i],
            charge: self.model.charge()[i],
            inertia: self.model.inertia()[i],
            principal_axes: self.model.principal_axes(i),
            location: self.state.location[i],
            orientation: self.orientation(body),
            velocity: self.state.velocity[i],
            angular_velocity: self.angular_velocity(body),
            force: self.model.constant_force(i),
            torque: self.model.constant_torque(i),
            fixed: !self.model.movable()[i],
        }
    }
}

impl Default for World {
    fn default() -> Self {
        Self::new()
    }
}

impl Dynamics for World {
    fn time(&self) -> f64 {
        self.time
    }

    fn advance(&mut self, t: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) -> Result<(), Breakdown> {
        let mut broken = None;
        self.advance_seeing(t, moments, &mut |moment| match moment.checked() {
            Ok(moment) if broken.is_none() => see(moment),
            Ok(_) => {}
            Err(error) => broken = broken.or(Some(error)),
        });
        let broken = broken.map(|error| self.model.cause(error));
        broken.or(self.solver.take_failure()).map_or(Ok(()), Err)
    }

    fn snapshot(&mut self) -> Result<Snapshot, Breakdown> {
        let balance = self.balance();
        // A snapshot must not change the world.
        let mut copy = self.decided();
        let World { model, state, solver, rest, crowd, loads, time, .. } = copy.as_mut().unwrap_or(self);
        let mut system = System::new(model, solver);
        let snapshot = picture(&mut system, *time, state, (balance, rest, crowd), loads).checked();
        let snapshot = snapshot.map_err(|error| model.cause(error));
        solver.take_failure().map_or(snapshot, Err)
    }

    fn impacts(&mut self) -> Vec<Impact> {
        self.collider.as_mut().map(Collider::take_impacts).unwrap_or_default()
    }

    fn steps(&self) -> u64 {
        self.steps
    }
}

#[cfg(test)]
mod tests {
    use super::super::UniformGravity;
    use super::*;

    #[test]
    fn an_interval_is_divided_evenly_into_the_fewest_steps_allowed() {
        let mut world = World::new();
        for (step, interval, steps) in [
            (0.01, 0.1, 10),
            (0.1, 0.1 + 0.2, 3),
            (0.01, 0.101, 11),
            (0.01, 0.005, 1),
            (f64::INFINITY, 7.0, 1),
        ] {
            world.set_step(step);
            assert_eq!(world.steps_within(interval), steps, "{interval} by {step}");
        }
    }

    #[test]
    fn time_is_reached_exactly_and_never_goes_back() {
        let mut world = World::new();
        let id = world.add(RigidBody::new(&Shape::Axes { length: 1.0 }, 1.0).with_velocity(DVec3::X));
        for t in [0.1, 0.3, 1.0 / 3.0, 2.7] {
            world.advance_to(t);
            assert_eq!(world.time(), t);
        }
        let location = world.location(id);
        for t in [2.7, 1.0, f64::INFINITY, f64::NAN] {
            world.advance_to(t);
            assert_eq!((world.time(), world.location(id)), (2.7, location));
        }
        assert!((location.x - 2.7).abs() < 1e-13);
    }

    #[test]
    fn a_fixed_body_does_not_move_whatever_pulls_at_it() {
        let fixed = RigidBody::new(&Shape::Sphere { radius: 1.0 }, 1.0)
            .with_velocity(DVec3::X)
            .with_angular_velocity(DVec3::Y)
            .with_force(DVec3::Z)
            .with_torque(DVec3::X)
            .with_fixed(true);
        for method in METHODS {
            let mut world = World::new();
            world.set_integrator(method);
            let id = world.add(fixed);
            world.add_force(UniformGravity { acceleration: DVec3::NEG_Y });
            world.advance_to(1.0);
            let at_rest = RigidBody { velocity: DVec3::ZERO, angular_velocity: DVec3::ZERO, ..fixed };
            assert_eq!(world.body(id), at_rest, "{}", method.name);
            assert_eq!(world.forces(), [DVec3::ZERO]);
        }
    }

    #[test]
    fn the_resultant_force_is_the_sum_of_all() {
        let mut world = World::new();
        let id = world.add(RigidBody::new(&Shape::Sphere { radius: 1.0 }, 2.0).with_force(DVec3::X));
        world.add_force(UniformGravity { acceleration: DVec3::NEG_Y });
        assert_eq!(world.forces(), [DVec3::new(1.0, -2.0, 0.0)]);
        world.apply_force(id, DVec3::Z);
        assert_eq!(world.forces(), [DVec3::new(0.0, -2.0, 1.0)]);
    }
}

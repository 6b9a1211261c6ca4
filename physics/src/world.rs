//! The world: bodies and forces, an integration method, and a clock.
//!
//! # Steps in pieces
//!
//! A step ends at each event (`world/step_pieces.rs`). A piece also ends where the velocity of a body with a given motion jumps (`world/jump.rs`):
//! a contact that holds would pull others along.
//!
//! Separate groups (`world/separate_groups.rs`) are advanced one after another. First all bodies make the step without contacts. Then each group with
//! contacts makes the same step in its own pieces. An impact may throw a body so far that it could hit another group. The paths of all
//! bodies show whether this happens; then the step is repeated with these groups as one. The results of contacts are kept for each group.
//! For a requested moment within a step, a copy of the world computes all groups together.
//!
//! # Rest
//!
//! Bodies that have rested on each other for some steps are held in place (`world/rest.rs`), until something touches them or their loads
//! change. They are held only if the forces on each balance within the cones of friction.
//!
//! # Contact policies
//!
//! A world has a contact policy (`world/policy.rs`). By default, events are located. With `TimeStepping`, none is: in each step all bodies
//! that can move are the crowd, and Moreau's scheme advances them (`world/stepped.rs`, `contact/crowd/all.rs`), so free motion is of second
//! order, and contacts are of first. Contacts that carried a force before get no impulses, which would only take the small rates that
//! turning leaves; impacts without a rebound are recorded, too, and one for each pair. Joints stay exact. For a snapshot, a copy of the
//! world gets the last contact forces as loads, and the last forces of limits and motors, so its reactions balance them. Bodies are held at
//! rest as with events, are obstacles for others then, and wake before something hits them.

mod advance;
mod change;
mod crowd;
mod event;
mod jump;
mod policy;
mod rest;
mod separate_groups;
mod snapshot;
mod step_pieces;
mod stepped;

#[cfg(feature = "time-stepping")]
pub(super) use advance::steps_of;

use glam::{DQuat, DVec3};

pub use self::policy::ContactPolicy;
use self::rest::Rest;
use self::snapshot::{picture, push_crowd};
use super::constraint::Solver;
use super::contact::Collider;
use super::presence::PresenceSchedule;
use super::{
    Balance, BodyId, Breakdown, ContactSnapshot, Dynamics, EnergyLedger, Impact, Integrator, LawResidual,
    Loads, METHODS, Method, Model, PairCounter, RigidBody, Snapshot, State, System,
};

/// The default longest time step of a world, s.
const DEFAULT_STEP: f64 = 1.0 / 240.0;

/// Bodies that move under forces, advanced by one of the [`METHODS`].
///
/// A world does not store its initial state: to reset it, build it again. A clone continues exactly as the original would, and the two are
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
    /// True if the state satisfies the constraints, because nothing has changed from outside since the last correction.
    is_settled: bool,
    ledger: EnergyLedger,
    calendar: PresenceSchedule,
    /// The search for contacts between bodies; `None` if bodies do not collide.
    collider: Option<Collider>,
    /// How contacts are handled within a step.
    policy: ContactPolicy,
    /// The bodies held at rest, with their contacts.
    rest: Rest,
    /// The contacts of bodies in the crowd. Filled only in the copy of the world that is made for a snapshot.
    crowd: Vec<ContactSnapshot>,
    steps: u64,
    /// Working memory for the forces and torques at one moment.
    loads: Loads,
    /// The time at which the present step ends, s.
    end: f64,
    /// True if the modes of all contacts (such as sticking or sliding) are decided; false after a step that advanced groups of bodies
    /// separately.
    is_decided: bool,
    /// The contact solvers of the groups of bodies that the last step advanced separately, one per group with contacts.
    parts: Vec<Solver>,
    /// The number of steps for which all bodies are still advanced together, before the world looks for separate groups again.
    together: u32,
    /// True if a given velocity changes suddenly within the current step.
    is_sudden: bool,
    /// The state at the start of the present piece of a step. The piece is repeated from this state, and the states within it are computed
    /// from it.
    before: State,
}

/// The parts of a world that another engine takes over: the bodies with their forces and state, the energy ledger, and the schedule of
/// births and deaths.
pub(super) struct Parts {
    pub(super) time: f64,
    pub(super) step: f64,
    pub(super) model: Model,
    pub(super) state: State,
    pub(super) ledger: EnergyLedger,
    pub(super) calendar: PresenceSchedule,
}

impl World {
    /// Creates an empty world at time 0, with the default method and a longest step of 1/240 s.
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
            calendar: PresenceSchedule::default(),
            collider: None,
            policy: ContactPolicy::default(),
            rest: Rest::default(),
            crowd: Vec::new(),
            steps: 0,
            loads: Loads::default(),
            end: 0.0,
            is_decided: true,
            parts: Vec::new(),
            together: 0,
            is_sudden: false,
            before: State::default(),
        }
    }

    /// Returns the parts of the world for another engine.
    pub(super) fn into_parts(self) -> Parts {
        let World { time, step, model, state, ledger, calendar, .. } = self;
        Parts { time, step, model, state, ledger, calendar }
    }

    /// Makes the state satisfy the constraints after changes from outside. Must be called before anything is measured or time advances.
    fn settle(&mut self) {
        if !self.is_settled {
            self.is_settled = true;
            let accounts = self.state.accounts;
            self.solver.expect_step(self.step);
            let mut system = System::new(&self.model, &mut self.solver);
            if system.is_constrained() {
                self.ledger.see_given(&self.model, &self.state);
            }
            system.start(self.time, &mut self.state, &mut self.loads);
            self.is_decided = true;
            self.begin_contacts();
            // The energy of these corrections is booked together with the change that caused them.
            self.state.accounts = accounts;
        }
    }

    /// Selects the integration method that is used from now on.
    pub fn set_integrator(&mut self, method: &'static Method) {
        self.method = method;
        self.integrator = (method.create)();
    }

    /// Returns the current integration method.
    #[must_use]
    pub fn integrator(&self) -> &'static Method {
        self.method
    }

    /// Sets the longest step that [`advance_to`](Self::advance_to) may take, s. It must be positive. With `f64::INFINITY`, every call
    /// makes one step.
    pub fn set_step(&mut self, step: f64) {
        self.step = step;
    }

    /// Returns the time that the world has reached, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Returns the current state of all bodies.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Returns the angular velocity of a body, world axes, rad/s.
    #[must_use]
    pub fn angular_velocity(&self, body: BodyId) -> DVec3 {
        self.model.angular_velocity(body.index(), &self.state)
    }

    /// Computes the resultant force on each body at the current time, world axes, N. It is zero for bodies that do not move, and m a for
    /// bodies with a given motion.
    pub fn forces(&mut self) -> &[DVec3] {
        self.settle();
        let mut copy = self.decided();
        let World { model, state, solver, crowd, loads, time, .. } = copy.as_mut().unwrap_or(self);
        let mut system = System::new(model, solver);
        system.begin(*time, state);
        system.evaluate(*time, state, loads);
        if model.constraints().is_empty() {
            push_crowd(crowd, model, loads);
        }
        model.guide(*time, loads);
        if let Some(copy) = copy {
            self.loads = copy.loads;
        }
        &self.loads.force
    }

    /// Computes the largest error of all constraint equations, in meters, or in radians for rotations.
    pub fn violation(&mut self) -> f64 {
        self.settle();
        self.solver.violation(&self.model, self.time, &self.state)
    }

    /// Measures the energies and momenta at the current time. The drift is relative to the largest kinetic energy among all measurements
    /// so far.
    pub fn balance(&mut self) -> Balance {
        self.settle();
        self.ledger.measure(&self.model, self.time, &self.state)
    }

    /// Counts the pair interactions in `pair_counter` from now on.
    pub fn watch(&mut self, pair_counter: &PairCounter) {
        self.model.watch(pair_counter.clone());
    }

    /// Returns the number of bodies in the world.
    #[must_use]
    pub fn len(&self) -> usize {
        self.state.len()
    }

    /// Returns true if the world has no bodies.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.state.is_empty()
    }

    /// Returns the model: all quantities that are constant in time, such as masses, inertia and forces.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Returns the position of a body's center of mass, world axes, m.
    #[must_use]
    pub fn location(&self, body: BodyId) -> DVec3 {
        self.state.location[body.index()]
    }

    /// Returns the velocity of a body's center of mass, world axes, m/s.
    #[must_use]
    pub fn velocity(&self, body: BodyId) -> DVec3 {
        self.state.velocity[body.index()]
    }

    /// Returns the orientation of a body: the rotation from body axes to world axes.
    #[must_use]
    pub fn orientation(&self, body: BodyId) -> DQuat {
        self.model.world_from_body(body.index(), &self.state)
    }

    /// Returns the properties and the current motion of a body.
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
        let broken = broken.or(self.solver.take_failure());
        broken.map_or(Ok(()), |error| Err(self.model.cause(error)))
    }

    fn snapshot(&mut self) -> Result<Snapshot, Breakdown> {
        let balance = self.balance();
        // The modes of the contacts are decided in a copy, because a snapshot must not change the world.
        let mut copy = self.decided();
        let World { model, state, solver, rest, crowd, collider, loads, time, policy, .. } =
            copy.as_mut().unwrap_or(self);
        let laws = laws_of(collider.as_ref());
        let mut system = System::new(model, solver);
        let mut snapshot = picture(&mut system, *time, state, (balance, rest, crowd, laws), loads);
        snapshot.penetration = penetration(*policy, collider.as_ref(), model, state);
        let snapshot = snapshot.checked();
        let snapshot = solver.take_failure().map_or(snapshot, Err);
        snapshot.map_err(|error| model.cause(error))
    }

    fn impacts(&mut self) -> Vec<Impact> {
        self.collider.as_mut().map(Collider::take_impacts).unwrap_or_default()
    }

    fn law_residuals(&self) -> &[LawResidual] {
        laws_of(self.collider.as_ref())
    }

    fn steps(&self) -> u64 {
        self.steps
    }
}

/// Returns the worst residual so far of each law that no contact can break.
fn laws_of(collider: Option<&Collider>) -> &[LawResidual] {
    collider.map_or(&[], Collider::law_residuals)
}

/// Returns the largest overlap of two bodies, m. Event-driven contacts let no bodies overlap.
fn penetration(policy: ContactPolicy, collider: Option<&Collider>, model: &Model, state: &State) -> f64 {
    let collider = collider.filter(|_| policy == ContactPolicy::TimeStepping);
    collider.map_or(0.0, |collider| collider.penetration(model, state))
}

#[cfg(test)]
mod tests {
    use super::super::{Anchor, Rod, Shape, UniformGravity};
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

    #[test]
    fn a_joint_whose_body_has_no_finite_place_is_not_called_broken() {
        for method in METHODS {
            let mut world = World::new();
            world.set_integrator(method);
            let id = world.add(RigidBody::new(&Shape::Sphere { radius: 0.1 }, 1.0).with_location(DVec3::X));
            world.add_constraint(Rod {
                between: [Anchor::Point(DVec3::ZERO), Anchor::centre(id)],
                length: 1.0,
            });
            let _ = world.snapshot();
            world.apply_force(id, DVec3::NAN);
            let failure = world.advance(0.01, &[], &mut |_| {});
            assert!(
                matches!(failure, Err(Breakdown::Diverged { body, .. }) if body == id),
                "{}: {failure:?}",
                method.name
            );
        }
    }
}

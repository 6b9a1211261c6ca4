//! The values of measures, such as `ball.speed` or `kinetic`: for labels, plots, and everything else that shows them.
//!
//! What is expensive is computed at most once per moment, and only if a shown measure needs it: sums over many bodies, and the loads of
//! named forces. A recording has no loads of single forces. They are computed from the bodies of the moment, by the same types of forces
//! as in the simulation.

use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeMap, HashMap};
use std::fmt;
use std::rc::Rc;
use std::sync::Arc;

use glam::DVec3;

use super::build::{forces, forces_of};
use super::populations::Population;
use super::simulation::Entry;
use super::tallies::SoFar;
use super::{AngleNow, DistanceNow, Frame, Ghost, ImpactCounts, shown};
use crate::physics::{
    Balance, BodyId, BodySnapshot, ContactSnapshot, Coordinate, Force, Kinematics, Loads, Moment, Motion,
    Presence, Reaction, RigidBody, World, find,
};
use crate::scene::{
    Aggregate, Angle, Body, BodyMeasure, Distance, FileColumns, ForceMeasure, JointState, Measure,
    MeasureFormula, Quantity, RunMeasure, Scene, Subject,
};

/// What is known at a moment: at a frame, or at the time of a ghost.
pub struct MomentState<'a> {
    time: f64,
    frame: usize,
    balance: Option<&'a Balance>,
    bodies: &'a [BodySnapshot],
    /// The constraint forces of the joints. Empty for a ghost.
    reactions: &'a [Reaction],
    /// The angles of the joints, counted through full turns, rad. Empty for a ghost.
    angles: &'a [f64],
    /// The contacts that persist. `None` for a ghost.
    contacts: Option<&'a [ContactSnapshot]>,
    /// The numbers of impacts up to the moment. `None` for a ghost.
    impacts: Option<&'a ImpactCounts>,
    /// What is known of earlier frames. Empty for a ghost.
    past: SoFar<'a>,
    computed: Computed,
}

/// Values that have already been computed for a moment.
#[derive(Default)]
struct Computed {
    /// The values of aggregates, by their indices in the scene.
    aggregates: RefCell<HashMap<usize, f64>>,
    /// The loads of forces, by their indices in the scene.
    loads: RefCell<HashMap<usize, Rc<Loads>>>,
    /// The potential energies of forces, J, by their indices in the scene: the share of each body.
    potentials: RefCell<HashMap<usize, Rc<[f64]>>>,
    /// The share of each body in the potential energy of all forces, J.
    potential: OnceCell<Vec<f64>>,
    /// The bodies of the moment, for forces.
    world: OnceCell<World>,
}

impl<'a> MomentState<'a> {
    /// Returns the moment of a frame, at which all measures are known.
    pub fn now(frame: &'a Frame) -> MomentState<'a> {
        MomentState {
            time: frame.time,
            frame: frame.index,
            balance: Some(&frame.balance),
            bodies: &frame.bodies,
            reactions: &frame.reactions,
            angles: &frame.angles,
            contacts: Some(&frame.contacts),
            impacts: Some(&frame.impacts),
            past: SoFar { areas: &frame.past.areas, closest: &frame.past.closest },
            computed: Computed::default(),
        }
    }

    /// Returns the moment of a frame without a past, with what is known of earlier frames.
    pub(super) fn with_past(frame: &'a Frame, past: SoFar<'a>) -> MomentState<'a> {
        MomentState { past, ..MomentState::now(frame) }
    }

    /// Returns a moment of the run, which may lie between two frames. `latest` is the number of the frame before it; `past` is what is known
    /// up to that frame.
    pub(super) fn of_entry(entry: &'a Entry, latest: usize, past: SoFar<'a>) -> MomentState<'a> {
        let moment = &entry.snapshot;
        MomentState {
            time: moment.time,
            frame: entry.frame.unwrap_or(latest),
            balance: Some(&moment.balance),
            bodies: &moment.bodies,
            reactions: &moment.reactions,
            angles: &moment.angles,
            contacts: Some(&moment.contacts),
            impacts: Some(&entry.counts),
            past,
            computed: Computed::default(),
        }
    }

    /// The time of the moment, s.
    pub(super) fn time(&self) -> f64 {
        self.time
    }

    /// Returns the moment of a ghost, at which only the values of its body are known.
    pub fn then(ghost: &'a Ghost) -> MomentState<'a> {
        MomentState {
            time: ghost.time,
            frame: 0,
            balance: None,
            bodies: std::slice::from_ref(&ghost.body),
            reactions: &[],
            angles: &[],
            contacts: None,
            impacts: None,
            past: SoFar::default(),
            computed: Computed::default(),
        }
    }
}

/// Forces that measures show: those of one name, or all.
#[derive(Clone)]
struct ShownForces(Vec<Arc<dyn Force>>);

impl fmt::Debug for ShownForces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("ShownForces").field(&self.0.len()).finish()
    }
}

/// Computes the measures of a scene.
#[derive(Clone, Debug)]
pub struct Measures {
    angles: Vec<Angle>,
    distances: Vec<Distance>,
    /// The bodies of the scene. Empty if the scene shows no measures.
    bodies: Vec<Body>,
    /// The coordinates of hinges and sliders, indexed by joint. `None` for other joints.
    joints: Vec<Option<Coordinate>>,
    aggregates: Vec<Aggregate>,
    emitters: Vec<Population>,
    file_columns: FileColumns,
    /// The forces that measures show, by their indices in the scene.
    forces: BTreeMap<usize, ShownForces>,
    /// All forces, if measures show potential energies of bodies.
    all_forces: ShownForces,
}

impl Measures {
    /// Prepares the measures of a scene.
    pub fn new(scene: &Scene) -> Measures {
        let joints = scene.joints.iter().map(|joint| joint.kind.coordinate()).collect();
        let shown =
            scene.formulas().flat_map(|formula| &formula.inputs).filter_map(|measure| match measure {
                Measure::Force(force, ..) => Some((*force, ShownForces(forces(&scene.forces[*force].kind)))),
                _ => None,
            });
        let with_arrows = scene.forces.iter().enumerate().filter(|(_, force)| force.arrow.is_some());
        let with_arrows = with_arrows.map(|(number, force)| (number, ShownForces(forces(&force.kind))));
        let shows_potential = scene.shows_of_bodies(|measure| measure == BodyMeasure::Potential);
        Measures {
            bodies: if scene.shows_measures() { scene.bodies.clone() } else { Vec::new() },
            joints,
            angles: scene.angles.clone(),
            distances: scene.distances.clone(),
            aggregates: scene.aggregates.clone(),
            file_columns: scene.file_columns.clone(),
            emitters: scene.emitters.iter().map(|emitter| Population::new(scene, emitter)).collect(),
            forces: shown.chain(with_arrows).collect(),
            all_forces: ShownForces(if shows_potential { forces_of(scene).collect() } else { Vec::new() }),
        }
    }

    /// Returns the bodies of a scene that shows measures.
    pub(crate) fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Returns a body of a scene that shows measures.
    pub(crate) fn body(&self, id: usize) -> &Body {
        &self.bodies[id]
    }

    /// Returns the value of a formula at a moment, in the unit that the scene asks for. NaN if a measure is unknown then, such as the speed
    /// of an absent body.
    pub fn value(&self, formula: &MeasureFormula, moment: &MomentState<'_>) -> f64 {
        let inputs: Vec<f64> = formula.inputs.iter().map(|measure| self.measure(*measure, moment)).collect();
        let value = formula.program.eval(&inputs);
        formula.asked_unit.as_ref().map_or(value, |asked| value / asked.size)
    }

    #[allow(clippy::cast_precision_loss, reason = "there are fewer frames than that")]
    fn measure(&self, measure: Measure, moment: &MomentState<'_>) -> f64 {
        let energy = |of: fn(&Balance) -> f64| moment.balance.map_or(f64::NAN, of);
        let impacts = |of: fn(&ImpactCounts) -> f64| moment.impacts.map_or(f64::NAN, of);
        match measure {
            Measure::Run(RunMeasure::Time) => moment.time,
            Measure::Run(RunMeasure::Frame) => moment.frame as f64,
            Measure::Run(RunMeasure::Energy) => energy(Balance::total_of_all),
            Measure::Run(RunMeasure::Kinetic) => energy(Balance::kinetic_of_all),
            Measure::Run(RunMeasure::Potential) => energy(|balance| balance.potential),
            Measure::Run(RunMeasure::Momentum(axis)) => {
                moment.balance.map_or(f64::NAN, |balance| balance.linear_momentum[axis])
            }
            Measure::Run(RunMeasure::AngularMomentum(axis)) => {
                moment.balance.map_or(f64::NAN, |balance| balance.angular_momentum[axis])
            }
            Measure::Run(RunMeasure::Drift) => energy(|balance| balance.drift),
            Measure::Run(RunMeasure::Account(number)) => {
                moment.balance.map_or(f64::NAN, |balance| balance.accounts.to_array()[number])
            }
            Measure::Run(RunMeasure::Impacts) => impacts(ImpactCounts::of_run),
            Measure::Impacts(pair) => moment.impacts.map_or(f64::NAN, |impacts| impacts.of_pair(pair)),
            Measure::Body(Subject::One(number), BodyMeasure::Impacts) => {
                moment.impacts.map_or(f64::NAN, |impacts| impacts.of_body(number))
            }
            Measure::Body(Subject::One(number), BodyMeasure::Potential) => self.potential(number, moment),
            Measure::Body(Subject::One(number), measure) if measure.is_contact_force() => {
                let at = moment.contacts.zip(find(moment.bodies, number));
                at.map_or(f64::NAN, |(contacts, _)| of_contacts(number, contacts, measure))
            }
            Measure::Body(Subject::One(number), measure) => {
                let at = find(moment.bodies, number);
                at.map_or(f64::NAN, |at| of_body(&self.bodies[number], at, measure))
            }
            Measure::Distance(Subject::One(one), other) => {
                let place = |body| find(moment.bodies, body).map(|at| at.location);
                place(one).zip(place(other)).map_or(f64::NAN, |(one, other)| one.distance(other))
            }
            Measure::FileColumn(Subject::One(body), column) => {
                let present = find(moment.bodies, body);
                present.map_or(f64::NAN, |_| self.file_columns.value(body, column, moment.time))
            }
            Measure::Closest(pair) => moment.past.closest.get(pair).copied().unwrap_or(f64::NAN),
            Measure::Emitter(number, measure) => self.emitters[number].value(measure, moment.time),
            Measure::Joint(number, measure) => {
                let Some(reaction) = moment.reactions.get(number) else { return f64::NAN };
                let body = |id: BodyId| find(moment.bodies, id.index()).copied();
                let total_angle = moment.angles.get(number).copied().unwrap_or(f64::NAN);
                measure.of(&JointState::of(self.joints[number], (*reaction, total_angle), body))
            }
            Measure::Force(force, None, ForceMeasure::Potential) => {
                self.potential_of_force(force, moment).map_or(f64::NAN, |shares| shares.iter().sum())
            }
            Measure::Force(force, Some(Subject::One(body)), ForceMeasure::Potential) => {
                let shares = self.potential_of_force(force, moment).zip(find(moment.bodies, body));
                shares.map_or(f64::NAN, |(shares, _)| shares[body])
            }
            Measure::Force(force, None, _) => {
                self.loads(force, moment).map_or(f64::NAN, |loads| total_power(&loads, moment.bodies))
            }
            Measure::Force(force, Some(Subject::One(body)), measure) => {
                let loads = self.loads(force, moment).zip(find(moment.bodies, body));
                loads.map_or(f64::NAN, |(loads, at)| of_force(&loads, at, measure))
            }
            Measure::Angle(number) => {
                let now = AngleNow::of(&self.angles[number], &self.bodies, moment.bodies);
                now.map_or(f64::NAN, |now| now.value.to_degrees())
            }
            Measure::Length(number) => {
                DistanceNow::of(&self.distances[number], moment.bodies).map_or(f64::NAN, |now| now.value)
            }
            Measure::Area(number) => {
                let last = moment.past.areas.get(number).and_then(|sectors| sectors.last());
                last.map_or(f64::NAN, |sector| sector.area)
            }
            Measure::Aggregate(number) => self.aggregate(number, moment),
            // An aggregate asks for the measures of one body after the other.
            Measure::Body(Subject::Each, _)
            | Measure::Distance(Subject::Each, _)
            | Measure::FileColumn(Subject::Each, _)
            | Measure::Force(_, Some(Subject::Each), _) => f64::NAN,
        }
    }

    /// Returns the value of a formula for each of several bodies, in the unit that the scene asks for.
    pub fn of_each<'a>(
        &'a self,
        formula: &'a MeasureFormula,
        bodies: impl Iterator<Item = usize> + 'a,
        moment: &'a MomentState<'_>,
    ) -> impl Iterator<Item = f64> + 'a {
        // What is the same for all bodies is computed once.
        let mut inputs: Vec<f64> = formula
            .inputs
            .iter()
            .map(|measure| if measure.is_of_each() { f64::NAN } else { self.measure(*measure, moment) })
            .collect();
        let of_each = formula.inputs.iter().enumerate().filter(|(_, measure)| measure.is_of_each());
        let of_each: Vec<(usize, Measure)> = of_each.map(|(slot, measure)| (slot, *measure)).collect();
        let unit = formula.unit_size();
        bodies.map(move |body| {
            for (slot, measure) in &of_each {
                inputs[*slot] = self.measure(measure.of_one(body), moment);
            }
            formula.program.eval(&inputs) / unit
        })
    }

    /// Returns the values that a formula has for each of several bodies, as [`of_each`](Self::of_each). Absent bodies are left out.
    pub fn of_present<'a>(
        &'a self,
        formula: &'a MeasureFormula,
        bodies: &'a [usize],
        moment: &'a MomentState<'_>,
    ) -> impl Iterator<Item = f64> + 'a {
        let present = bodies.iter().copied().filter(|body| find(moment.bodies, *body).is_some());
        self.of_each(formula, present, moment)
    }

    /// Returns the value of an aggregate of the scene. Absent bodies are left out.
    fn aggregate(&self, number: usize, moment: &MomentState<'_>) -> f64 {
        if let Some(known) = moment.computed.aggregates.borrow().get(&number) {
            return *known;
        }
        let Aggregate { how, bodies, formula } = &self.aggregates[number];
        let value = how.of(self.of_present(formula, bodies, moment));
        moment.computed.aggregates.borrow_mut().insert(number, value);
        value
    }

    /// Returns a named force on a body, N, without the other forces. `None` if the body is absent, for a ghost, and if no measure and no arrow
    /// shows the force.
    pub(crate) fn force_on(&self, body: usize, force: usize, moment: &MomentState<'_>) -> Option<DVec3> {
        moment.balance?;
        let at = find(moment.bodies, body)?;
        Some(self.loads(force, moment)?.force[at.id])
    }

    /// Returns the loads of a named force on all bodies. `None` if the force is not shown.
    fn loads(&self, force: usize, moment: &MomentState<'_>) -> Option<Rc<Loads>> {
        if let Some(known) = moment.computed.loads.borrow().get(&force) {
            return Some(known.clone());
        }
        let ShownForces(parts) = self.forces.get(&force)?;
        let world = moment.computed.world.get_or_init(|| self.world(moment.bodies));
        let zero = vec![DVec3::ZERO; self.bodies.len()];
        let mut loads = Loads { force: zero.clone(), torque: zero, ..Loads::default() };
        let at = Moment { time: moment.time, state: world.state(), model: world.model() };
        parts.iter().for_each(|part| part.apply(&at, &mut loads));
        let loads = Rc::new(loads);
        moment.computed.loads.borrow_mut().insert(force, loads.clone());
        Some(loads)
    }

    /// Returns the share of each body in the potential energy of a named force, J. `None` if the force is not shown.
    fn potential_of_force(&self, force: usize, moment: &MomentState<'_>) -> Option<Rc<[f64]>> {
        if let Some(known) = moment.computed.potentials.borrow().get(&force) {
            return Some(known.clone());
        }
        let ShownForces(parts) = self.forces.get(&force)?;
        let world = moment.computed.world.get_or_init(|| self.world(moment.bodies));
        let mut shares = vec![0.0; self.bodies.len()];
        let at = Moment { time: moment.time, state: world.state(), model: world.model() };
        parts.iter().for_each(|part| part.share_potential(&at, &mut shares));
        let shares: Rc<[f64]> = shares.into();
        moment.computed.potentials.borrow_mut().insert(force, shares.clone());
        Some(shares)
    }

    /// Returns the share of a body in the potential energy, J. NaN if the body is absent, and for a ghost, which stands alone.
    fn potential(&self, body: usize, moment: &MomentState<'_>) -> f64 {
        if moment.balance.is_none() || find(moment.bodies, body).is_none() {
            return f64::NAN;
        }
        let shares = moment.computed.potential.get_or_init(|| {
            let world = moment.computed.world.get_or_init(|| self.world(moment.bodies));
            world.model().potential_of_each(moment.time, world.state())
        });
        shares[body]
    }

    /// Returns a world in which the bodies have the poses and the velocities of a moment. It has forces only if measures show potential energies
    /// of bodies.
    fn world(&self, bodies: &[BodySnapshot]) -> World {
        let mut world = World::new();
        world.reserve(self.bodies.len());
        for (id, body) in self.bodies.iter().enumerate() {
            let Some(at) = find(bodies, id) else {
                let id = world.add(body.start);
                world.limit(id, &Presence::during(&[]));
                continue;
            };
            let id = world.add(RigidBody {
                location: at.location,
                orientation: at.orientation,
                velocity: at.velocity,
                angular_velocity: at.angular_velocity,
                ..body.start
            });
            if body.motion.is_some() {
                world.follow(id, Arc::new(Held(*at)));
            }
        }
        self.all_forces.0.iter().for_each(|force| world.add_shared_force(force.clone()));
        world
    }
}

/// The motion of a body at a moment, for a world of this moment alone.
#[derive(Debug)]
struct Held(BodySnapshot);

impl Motion for Held {
    fn at(&self, _: f64) -> Kinematics {
        let BodySnapshot { location, orientation, velocity, angular_velocity, .. } = self.0;
        Kinematics { location, orientation, velocity, angular_velocity, acceleration: DVec3::ZERO }
    }

    fn angular_acceleration(&self, _: f64) -> DVec3 {
        DVec3::ZERO
    }
}

/// The power of loads on all bodies, W.
fn total_power(loads: &Loads, bodies: &[BodySnapshot]) -> f64 {
    bodies.iter().map(|at| power(loads, at)).sum()
}

/// The power of loads on a body, W.
fn power(loads: &Loads, at: &BodySnapshot) -> f64 {
    let [force, torque] =
        [&loads.force, &loads.torque].map(|all| all.get(at.id).copied().unwrap_or_default());
    force.dot(at.velocity) + torque.dot(at.angular_velocity)
}

/// Returns whether the value of a condition means that it holds. An undefined value means that it does not.
pub fn is_true(value: f64) -> bool {
    value.is_finite() && value != 0.0
}

fn of_force(loads: &Loads, at: &BodySnapshot, measure: ForceMeasure) -> f64 {
    match measure {
        ForceMeasure::Component(axis) => loads.force[at.id][axis],
        ForceMeasure::Size => loads.force[at.id].length(),
        ForceMeasure::Power => power(loads, at),
        // Loads have no potential.
        ForceMeasure::Potential => f64::NAN,
    }
}

fn of_body(body: &Body, at: &BodySnapshot, measure: BodyMeasure) -> f64 {
    let acceleration = || shown(Quantity::Acceleration, body, at);
    let mass = body.start.mass;
    match measure {
        BodyMeasure::Location(axis) => at.location[axis],
        BodyMeasure::Speed => at.velocity.length(),
        BodyMeasure::Velocity(axis) => at.velocity[axis],
        BodyMeasure::AccelerationMagnitude => acceleration().length(),
        BodyMeasure::Acceleration(axis) => acceleration()[axis],
        BodyMeasure::ForceMagnitude => at.force.length(),
        BodyMeasure::Force(axis) => at.force[axis],
        BodyMeasure::AngularSpeed => at.angular_velocity.length(),
        BodyMeasure::AngularVelocity(axis) => at.angular_velocity[axis],
        BodyMeasure::Mass => mass,
        BodyMeasure::Momentum => mass * at.velocity.length(),
        BodyMeasure::MomentumComponent(axis) => mass * at.velocity[axis],
        BodyMeasure::Power => at.force.dot(at.velocity),
        BodyMeasure::Kinetic => {
            let spin = angular_velocity_in_principal_axes(body, at);
            0.5 * (mass * at.velocity.length_squared() + body.start.inertia.dot(spin * spin))
        }
        BodyMeasure::AngularMomentum => angular_momentum(body, at).length(),
        BodyMeasure::AngularMomentumComponent(axis) => angular_momentum(body, at)[axis],
        // These do not follow from the state of a body alone.
        BodyMeasure::Impacts
        | BodyMeasure::Potential
        | BodyMeasure::NormalForce
        | BodyMeasure::FrictionForce => f64::NAN,
    }
}

fn angular_velocity_in_principal_axes(body: &Body, at: &BodySnapshot) -> DVec3 {
    (at.orientation * body.start.principal_axes).conjugate() * at.angular_velocity
}

/// The angular momentum of a body about the origin, x × m v + I ω, kg·m²/s.
fn angular_momentum(body: &Body, at: &BodySnapshot) -> DVec3 {
    let spin = body.start.inertia * angular_velocity_in_principal_axes(body, at);
    let own = (at.orientation * body.start.principal_axes) * spin;
    body.start.mass * at.location.cross(at.velocity) + own
}

/// The magnitude of the sum of the normal forces, or of the forces of friction, on a body, N.
fn of_contacts(body: usize, contacts: &[ContactSnapshot], measure: BodyMeasure) -> f64 {
    let sum: DVec3 = contacts
        .iter()
        .map(|contact| {
            let force = if measure == BodyMeasure::NormalForce { contact.force } else { contact.friction };
            match contact.bodies {
                [first, _] if first == body => -force,
                [_, second] if second == body => force,
                _ => DVec3::ZERO,
            }
        })
        .sum();
    sum.length()
}

#[cfg(test)]
mod tests;

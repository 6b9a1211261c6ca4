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

use super::build::forces;
use super::simulation::Entry;
use super::{AngleNow, DistanceNow, Frame, Ghost, ImpactCounts, Sector, shown};
use crate::physics::{
    Balance, BodyId, BodySnapshot, Coordinate, Force, Loads, Moment, Presence, Reaction, RigidBody, World,
    find,
};
use crate::scene::{
    Aggregate, Angle, Body, BodyMeasure, Distance, ForceMeasure, JointState, Measure, MeasureFormula, Piece,
    Quantity, RunMeasure, Scene, Subject,
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
    /// The numbers of impacts up to the moment. `None` for a ghost.
    impacts: Option<&'a ImpactCounts>,
    /// The complete sectors of each swept area. Empty for a ghost.
    areas: &'a [Vec<Arc<Sector>>],
    computed: Computed,
}

/// Values that have already been computed for a moment.
#[derive(Default)]
struct Computed {
    /// The values of aggregates, by their indices in the scene.
    aggregates: RefCell<HashMap<usize, f64>>,
    /// The loads of forces, by their indices in the scene.
    loads: RefCell<HashMap<usize, Rc<Loads>>>,
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
            impacts: Some(&frame.impacts),
            areas: &frame.past.areas,
            computed: Computed::default(),
        }
    }

    /// Returns the moment of a frame without a past, with these complete sectors of each swept area.
    pub(super) fn with_areas(frame: &'a Frame, areas: &'a [Vec<Arc<Sector>>]) -> MomentState<'a> {
        MomentState { areas, ..MomentState::now(frame) }
    }

    /// Returns a moment of the run, which may lie between two frames. `latest` is the number of the frame before it; `areas` has the
    /// complete sectors of each swept area up to that frame.
    pub(super) fn of_entry(
        entry: &'a Entry,
        latest: usize,
        areas: &'a [Vec<Arc<Sector>>],
    ) -> MomentState<'a> {
        let moment = &entry.snapshot;
        MomentState {
            time: moment.time,
            frame: entry.frame.unwrap_or(latest),
            balance: Some(&moment.balance),
            bodies: &moment.bodies,
            reactions: &moment.reactions,
            angles: &moment.angles,
            impacts: Some(&entry.counts),
            areas,
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
            impacts: None,
            areas: &[],
            computed: Computed::default(),
        }
    }
}

/// The types of a named force, for the forces that measures show.
#[derive(Clone)]
struct ShownForce(Vec<Arc<dyn Force>>);

impl fmt::Debug for ShownForce {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("ShownForce").field(&self.0.len()).finish()
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
    /// The forces that measures show, by their indices in the scene.
    forces: BTreeMap<usize, ShownForce>,
}

impl Measures {
    /// Prepares the measures of a scene.
    pub fn new(scene: &Scene) -> Measures {
        let joints = scene.joints.iter().map(|joint| joint.kind.coordinate()).collect();
        let of_texts = scene.texts().flatten().filter_map(|piece| match piece {
            Piece::Value { formula, .. } => Some(formula),
            Piece::Words(_) => None,
        });
        let of_plots = scene
            .plots
            .iter()
            .flat_map(|plot| std::iter::once(&plot.x).chain(plot.curves.iter().map(|curve| &curve.y)));
        let of_aggregates = scene.aggregates.iter().map(|it| &it.formula);
        let of_colors = scene.color_maps.iter().map(|map| &map.of);
        let of_numbers = scene.value_maps.iter().map(|map| &map.of);
        let formulas = of_texts
            .chain(of_plots)
            .chain(of_aggregates)
            .chain(of_colors)
            .chain(of_numbers)
            .chain(&scene.conditions);
        let shown = formulas.flat_map(|formula| &formula.inputs).filter_map(|measure| match measure {
            Measure::Force(force, ..) => Some((*force, ShownForce(forces(&scene.forces[*force].kind)))),
            _ => None,
        });
        Measures {
            bodies: if scene.shows_measures() { scene.bodies.clone() } else { Vec::new() },
            joints,
            angles: scene.angles.clone(),
            distances: scene.distances.clone(),
            aggregates: scene.aggregates.clone(),
            forces: shown.collect(),
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
            Measure::Run(RunMeasure::Impacts) => impacts(ImpactCounts::of_run),
            Measure::Impacts(pair) => moment.impacts.map_or(f64::NAN, |impacts| impacts.of_pair(pair)),
            Measure::Body(Subject::One(number), BodyMeasure::Impacts) => {
                moment.impacts.map_or(f64::NAN, |impacts| impacts.of_body(number))
            }
            Measure::Body(Subject::One(number), measure) => {
                let at = find(moment.bodies, number);
                at.map_or(f64::NAN, |at| of_body(&self.bodies[number], at, measure))
            }
            Measure::Distance(Subject::One(one), other) => {
                let place = |body| find(moment.bodies, body).map(|at| at.location);
                place(one).zip(place(other)).map_or(f64::NAN, |(one, other)| one.distance(other))
            }
            Measure::Joint(number, measure) => {
                let Some(reaction) = moment.reactions.get(number) else { return f64::NAN };
                let body = |id: BodyId| find(moment.bodies, id.index()).copied();
                let total_angle = moment.angles.get(number).copied().unwrap_or(f64::NAN);
                measure.of(&JointState::of(self.joints[number], (*reaction, total_angle), body))
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
                let last = moment.areas.get(number).and_then(|sectors| sectors.last());
                last.map_or(f64::NAN, |sector| sector.area)
            }
            Measure::Aggregate(number) => self.aggregate(number, moment),
            // An aggregate asks for the measures of one body after the other.
            Measure::Body(Subject::Each, _)
            | Measure::Distance(Subject::Each, _)
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

    /// Returns the loads of a named force on all bodies. `None` if the force is not shown.
    fn loads(&self, force: usize, moment: &MomentState<'_>) -> Option<Rc<Loads>> {
        if let Some(known) = moment.computed.loads.borrow().get(&force) {
            return Some(known.clone());
        }
        let ShownForce(parts) = self.forces.get(&force)?;
        let world = moment.computed.world.get_or_init(|| self.world(moment.bodies));
        let zero = vec![DVec3::ZERO; self.bodies.len()];
        let mut loads = Loads { force: zero.clone(), torque: zero, ..Loads::default() };
        let at = Moment { time: moment.time, state: world.state(), model: world.model() };
        parts.iter().for_each(|part| part.apply(&at, &mut loads));
        let loads = Rc::new(loads);
        moment.computed.loads.borrow_mut().insert(force, loads.clone());
        Some(loads)
    }

    /// Returns a world in which the bodies have the poses and the velocities of a moment.
    fn world(&self, bodies: &[BodySnapshot]) -> World {
        let mut world = World::new();
        world.reserve(self.bodies.len());
        for (id, body) in self.bodies.iter().enumerate() {
            let Some(at) = find(bodies, id) else {
                let id = world.add(body.start);
                world.limit(id, &Presence::during(&[]));
                continue;
            };
            world.add(RigidBody {
                location: at.location,
                orientation: at.orientation,
                velocity: at.velocity,
                angular_velocity: at.angular_velocity,
                ..body.start
            });
        }
        world
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
        BodyMeasure::Mass => mass,
        BodyMeasure::Momentum => mass * at.velocity.length(),
        BodyMeasure::MomentumComponent(axis) => mass * at.velocity[axis],
        BodyMeasure::Power => at.force.dot(at.velocity),
        // Impacts are counted per run, not in the state of a body.
        BodyMeasure::Impacts => f64::NAN,
        BodyMeasure::Kinetic => {
            let turned = at.orientation * body.start.principal_axes;
            let spin = turned.conjugate() * at.angular_velocity;
            0.5 * (mass * at.velocity.length_squared() + body.start.inertia.dot(spin * spin))
        }
    }
}

#[cfg(test)]
mod tests;

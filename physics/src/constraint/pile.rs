//! A pile: the contacts of bodies without joints, in flat arrays that sweeps pass through quickly.
//!
//! Joints need a matrix, contacts alone do not. A pile keeps each contact point and each body in one small record. Bodies that touch form an
//! island; the sweeps over each island end as soon as its impulses have converged. The laws are those of the general solver.

mod closing;
mod forces;
mod impacts;
mod island;
mod point;
mod separate;

use std::ops::Range;

use glam::{DMat3, DVec3};

use self::point::{Point, Roll};
use super::super::contact::{LastingContact, pose};
use super::super::sets::Sets;
use super::super::{Model, State};
use super::refine::Pause;

/// The contacts of bodies without joints, with their last forces.
#[derive(Clone, Default)]
pub(crate) struct Pile {
    /// The contacts, in the order of their bodies.
    contacts: Vec<Contact>,
    /// Contacts with forces in an earlier substep, between pairs of bodies that have no contact at present, in the same order.
    others: Vec<Contact>,
    bodies: Vec<Body>,
    /// The contact points and the rolling frictions, island by island.
    points: Vec<Point>,
    rolls: Vec<Roll>,
    /// The impulse of each point on its second body, N s: its components along the normal and the two tangents.
    impulses: Vec<[f64; 3]>,
    islands: Vec<Island>,
    /// For each body of the model, its index in `bodies`, or [`NO_INDEX`]. Working memory.
    numbers: Vec<u32>,
    /// The largest absolute rate at a contact before the forces of the last substep acted, m/s.
    fastest: f64,
    /// Whether Newton's method is left out at present.
    pause: Pause,
    /// True if all bodies that can move belong to the pile. Then impacts without a rebound are recorded, too, and contacts that pushed before
    /// get no impulse.
    holds_all: bool,
}

/// Stands for the index of a body that has no contact.
const NO_INDEX: u32 = u32::MAX;

/// A contact, with its forces in the last substep.
#[derive(Clone, Debug)]
struct Contact {
    place: LastingContact,
    /// The normal force, N.
    push: f64,
    /// The friction force on the second body, world axes, N, and the torque of rolling friction, N m.
    friction: DVec3,
    rolling: DVec3,
}

/// A body with contacts.
#[derive(Clone, Copy, Debug)]
struct Body {
    velocity: DVec3,
    angular_velocity: DVec3,
    /// The inverse inertia tensor in world axes, 1/(kg m²). Zero for a body that forces cannot move.
    inverse_inertia: DMat3,
    /// The inverse mass, 1/kg; 0 for a body that forces cannot move.
    inverse_mass: f64,
    /// The velocity and the angular velocity without the impulses of contacts.
    free: [DVec3; 2],
    /// The index of the body in the model.
    index: usize,
    /// The largest radius of gyration, m; 0 for a body that forces cannot move.
    size: f64,
}

/// Bodies that touch each other: the ranges of their points, rolling frictions and bodies. Bodies that cannot move connect nothing.
#[derive(Clone, Debug)]
struct Island {
    points: Range<usize>,
    rolls: Range<usize>,
    bodies: Range<usize>,
    /// The largest radius of gyration of its bodies, m. It weighs angles against lengths.
    length: f64,
}

impl Body {
    fn of(index: usize, model: &Model, state: &State) -> Body {
        let inverse_mass = model.inverse_mass()[index];
        let mut body = Body {
            velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            inverse_inertia: DMat3::ZERO,
            inverse_mass,
            free: [DVec3::ZERO; 2],
            index,
            size: (model.inertia()[index].max_element() * inverse_mass).sqrt(),
        };
        body.follow(model, state);
        body
    }

    fn moves(&self) -> bool {
        self.inverse_mass != 0.0
    }

    /// Takes the velocities and the orientation from a state.
    fn follow(&mut self, model: &Model, state: &State) {
        if self.moves() {
            let moments = model.inverse_inertia()[self.index];
            self.inverse_inertia = if moments.x == moments.y && moments.y == moments.z {
                DMat3::from_diagonal(moments)
            } else {
                let turn = DMat3::from_quat(state.orientation[self.index]);
                turn * (DMat3::from_diagonal(moments) * turn.transpose())
            };
        }
        self.take_velocity(model, state);
    }

    /// Takes the velocities from a state.
    fn take_velocity(&mut self, model: &Model, state: &State) {
        self.velocity = state.velocity[self.index];
        self.angular_velocity = if self.moves() {
            self.inverse_inertia * state.angular_momentum[self.index]
        } else {
            model.angular_velocity(self.index, state)
        };
        self.free = [self.velocity, self.angular_velocity];
    }
}

impl Pile {
    /// Takes the possible contacts of a substep, in the order of their bodies, measured at a state. Contacts that were there in the last
    /// substep keep their forces. A pile that does not hold all bodies also keeps the forces of pairs that have no contact at present.
    pub(crate) fn take_contacts(&mut self, contacts: Vec<LastingContact>, model: &Model, state: &State) {
        let mut known = std::mem::take(&mut self.contacts);
        if !self.others.is_empty() {
            known.append(&mut self.others);
            known.sort_by_key(|contact| contact.place.bodies);
        }
        self.contacts = with_forces(contacts, &known);
        self.lay_out(model, state);
        self.impulses.clear();
        self.impulses.resize(self.points.len(), [0.0; 3]);
        if !self.holds_all {
            let has = |pair: &[usize; 2]| {
                self.contacts.binary_search_by_key(pair, |contact| contact.place.bodies).is_ok()
            };
            known.retain(|contact| !has(&contact.place.bodies));
            self.others = known;
        }
        for point in &mut self.points {
            let place = &self.contacts[point.contact].place;
            let locations = place.bodies.map(|body| state.location[body]);
            point.set(&place.touch.meeting, locations);
            point.respond(&self.bodies);
        }
        self.respond_to_rolling();
    }

    /// Lets the pile hold all bodies that can move.
    pub(crate) fn hold_all(&mut self) {
        self.holds_all = true;
    }

    /// Forgets the contacts of these bodies.
    pub(crate) fn lose(&mut self, bodies: &[usize]) {
        let stays = |contact: &Contact| !contact.place.bodies.iter().any(|body| bodies.contains(body));
        self.contacts.retain(stays);
        self.others.retain(stays);
    }

    /// Finds the islands, and creates their points and bodies in the order in which sweeps visit them.
    fn lay_out(&mut self, model: &Model, state: &State) {
        let Pile { contacts, bodies, points, rolls, islands, numbers, .. } = self;
        let moves = |body: usize| model.inverse_mass()[body] != 0.0;
        let mut sets = Sets::new(model.len());
        for contact in &*contacts {
            let [a, b] = contact.place.bodies;
            if moves(a) && moves(b) {
                sets.unite(a, b);
            }
        }
        let set = |contact: &Contact| {
            let [a, b] = contact.place.bodies;
            sets.first(if moves(a) { a } else { b })
        };
        let sets: Vec<usize> = contacts.iter().map(set).collect();
        let mut order: Vec<usize> = (0..contacts.len()).collect();
        order.sort_by_key(|&contact| sets[contact]);

        for body in bodies.drain(..) {
            if let Some(number) = numbers.get_mut(body.index) {
                *number = NO_INDEX;
            }
        }
        numbers.resize(model.len(), NO_INDEX);
        points.clear();
        rolls.clear();
        islands.clear();
        let mut last = None;
        for contact in order {
            if last != Some(sets[contact]) {
                last = Some(sets[contact]);
                let (points, rolls, bodies) = (points.len(), rolls.len(), bodies.len());
                let [points, rolls, bodies] = [points..points, rolls..rolls, bodies..bodies];
                islands.push(Island { points, rolls, bodies, length: 0.0 });
            }
            let place = &contacts[contact].place;
            let number = |body: usize| {
                if numbers[body] == NO_INDEX {
                    numbers[body] = bodies.len() as u32;
                    bodies.push(Body::of(body, model, state));
                }
                numbers[body]
            };
            points.push(Point::new(contact, place.bodies.map(number), place.law.friction));
            if place.law.rolling_friction > 0.0 {
                rolls.push(Roll::new(points.len() - 1, place.law.rolling_friction));
            }
            if let Some(island) = islands.last_mut() {
                island.points.end = points.len();
                island.rolls.end = rolls.len();
                island.bodies.end = bodies.len();
            }
        }
        for island in islands {
            let size = bodies[island.bodies.clone()].iter().map(|body| body.size).fold(0.0, f64::max);
            island.length = if size > 0.0 && size.is_finite() { size } else { 1.0 };
        }
    }

    /// Measures all contacts again at a state shortly after that of [`take_contacts`](Self::take_contacts), but for those whose later moment
    /// is known.
    pub(crate) fn measure(&mut self, model: &Model, state: &State) {
        self.bodies.iter_mut().for_each(|body| body.follow(model, state));
        for point in &mut self.points {
            let place = &self.contacts[point.contact].place;
            if !point.is_foreseen {
                let meeting = place.meet(place.bodies.map(|body| pose(body, model, state)));
                point.set(&meeting, place.bodies.map(|body| state.location[body]));
            }
            point.respond(&self.bodies);
        }
        self.respond_to_rolling();
    }

    fn respond_to_rolling(&mut self) {
        for roll in &mut self.rolls {
            roll.respond(&self.points[roll.point], &self.bodies);
        }
    }

    /// Takes the velocities of all bodies from a state.
    fn take_velocities(&mut self, model: &Model, state: &State) {
        self.bodies.iter_mut().for_each(|body| body.take_velocity(model, state));
    }

    /// Returns the impulse of a point, N s.
    fn impulse(&self, point: usize) -> DVec3 {
        DVec3::from_array(self.impulses[point])
    }

    /// Returns the points of an island, each with its impulse, N s.
    fn pushed<'a>(&'a self, island: &Island) -> impl Iterator<Item = (&'a Point, DVec3)> {
        let impulses = self.impulses[island.points.clone()].iter().map(|impulse| DVec3::from_array(*impulse));
        self.points[island.points.clone()].iter().zip(impulses)
    }

    /// Returns the contacts of the last substep.
    pub(crate) fn contacts(&self) -> impl Iterator<Item = &LastingContact> {
        self.contacts.iter().map(|contact| &contact.place)
    }

    /// Returns the largest rate of a contact before the contact forces acted, in the last substep, m/s.
    pub(crate) fn fastest(&self) -> f64 {
        self.fastest
    }

    /// Returns the typical length of the smallest body in contact, m.
    pub(crate) fn least_size(&self) -> f64 {
        self.contacts.iter().map(|contact| contact.place.size).fold(f64::MAX, f64::min)
    }
}

/// Gives the forces of known contacts to the same contacts found anew. Both lists are in the order of their bodies.
fn with_forces(new: Vec<LastingContact>, known: &[Contact]) -> Vec<Contact> {
    let mut at = 0;
    let with_force = |place: LastingContact| {
        while known.get(at).is_some_and(|contact| contact.place.bodies < place.bodies) {
            at += 1;
        }
        let mut same = known[at..].iter().take_while(|contact| contact.place.bodies == place.bodies);
        match same.find(|contact| contact.place.is(&place)) {
            Some(&Contact { push, friction, rolling, .. }) => Contact { place, push, friction, rolling },
            None => Contact { place, push: 0.0, friction: DVec3::ZERO, rolling: DVec3::ZERO },
        }
    };
    new.into_iter().map(with_force).collect()
}

//! Impacts in a pile: all impacts within one substep are solved together. See `rebound.rs` for the laws.

use std::collections::BTreeMap;

use glam::DVec3;

use super::super::super::{Impact, Loads, Model, State};
use super::super::rebound::{CLOSING_LEFT_TO_FORCES, Struck, newtons_goal, of_pairs};
use super::super::sweep::Purpose;
use super::island::Limits;
use super::point::Point;
use super::{Island, Pile};

/// The velocity and the angular velocity of bodies before an impact, by the index of each body.
type Velocities = BTreeMap<usize, [DVec3; 2]>;

/// A contact at which two bodies rebound in this substep.
struct Rebound {
    /// The index of the point in the pile.
    point: usize,
    /// The time from the start of the substep until the bodies touch, s.
    time: f64,
    /// The part of the impulse that the contact repeats.
    restitution: f64,
    /// The change of the closing rate by the loads until the bodies touch, m/s.
    fall: f64,
    /// The rates before the impact, m/s.
    before: DVec3,
    /// The impulses of both phases, N s.
    impulse: DVec3,
}

impl Pile {
    /// Applies the impulses of all contacts that close within `part` seconds after `time`. [`aim`](Self::aim) must have set the goals. For a contact that
    /// rebounds, the goal becomes 0, so its bodies approach no further in this substep.
    pub(crate) fn strike_all(
        &mut self,
        model: &Model,
        (time, part): (f64, f64),
        (state, loads): (&mut State, &Loads),
    ) -> Struck {
        self.take_velocities(model, state);
        let limits = self.limits(Purpose::Impact);
        let (mut rebounds, mut velocities) = (Vec::new(), Velocities::new());
        self.for_each_island(|pile, island| {
            if !pile.holds_all || pile.is_closing(island, part) {
                let new = pile.strike(island, (model, part, limits), (state, loads), &mut velocities);
                pile.forget_foreseen(island, &new);
                rebounds.extend(new);
            }
        });
        self.take_velocities(model, state);
        if rebounds.is_empty() {
            return Struck::default();
        }
        let early = self.early(&rebounds, &velocities, (model, state));
        let mut impacts: Vec<Impact> =
            rebounds.iter().map(|rebound| self.impact(rebound, time, (&velocities, state))).collect();
        if self.holds_all {
            impacts = of_pairs(impacts);
        }
        impacts.sort_by(|a, b| a.time.total_cmp(&b.time));
        let fallen = rebounds.iter().map(|rebound| rebound.impulse.x * rebound.fall).sum();
        Struck { impacts, early, fallen }
    }

    /// Forgets the later moments of points without an impulse, if others have changed the motion that leads there.
    fn forget_foreseen(&mut self, island: &Island, rebounds: &[Rebound]) {
        let pushes = |impulses: &[[f64; 3]], point: usize| impulses[point][0] > 0.0;
        if rebounds.is_empty() && !island.points.clone().any(|point| pushes(&self.impulses, point)) {
            return;
        }
        for number in island.points.clone() {
            let is_struck = rebounds.iter().any(|rebound| rebound.point == number);
            self.points[number].is_foreseen &= is_struck || pushes(&self.impulses, number);
        }
    }

    /// Returns true if a contact of an island closes faster than its last force explains. What already pushed keeps its rate by forces:
    /// impulses would only take the energy of the small rates that a substep of turning bodies leaves.
    fn is_closing(&self, island: &Island, part: f64) -> bool {
        self.points[island.points.clone()].iter().any(|point| {
            let slow = CLOSING_LEFT_TO_FORCES * part * self.contacts[point.contact].push * point.weight();
            let rate = point.rate(&self.bodies).x;
            rate < point.goal.x && rate < point.goal.x - slow
        })
    }

    /// Finds and applies the impulses of the impacts of an island, in two phases. Records the velocities of the rebounding bodies before.
    fn strike(
        &mut self,
        island: &Island,
        (model, part, limits): (&Model, f64, Limits),
        (state, loads): (&mut State, &Loads),
        velocities: &mut Velocities,
    ) -> Vec<Rebound> {
        let mut rebounds = self.rebounds(island, (model, loads), part);
        for rebound in &rebounds {
            // The loads act until the bodies touch. What they add to the approach is reversed with it.
            self.points[rebound.point].goal.x = -rebound.fall;
            for body in self.contacts[self.points[rebound.point].contact].place.bodies {
                if model.inverse_mass()[body] != 0.0 {
                    velocities.insert(body, [state.velocity[body], model.angular_velocity(body, state)]);
                }
            }
        }
        if self.rebounds_alone(island, &mut rebounds, limits) {
            self.apply(island, Purpose::Impact, model, state);
            return rebounds;
        }
        self.find(island, Purpose::Impact, limits);
        self.apply(island, Purpose::Impact, model, state);
        if rebounds.is_empty() {
            return rebounds;
        }
        for rebound in &mut rebounds {
            rebound.impulse = self.impulse(rebound.point);
            self.points[rebound.point].least = rebound.restitution * rebound.impulse.x;
        }
        for body in &mut self.bodies[island.bodies.clone()] {
            body.free = [body.velocity, body.angular_velocity];
        }
        self.find(island, Purpose::Impact, limits);
        self.apply(island, Purpose::Impact, model, state);
        for rebound in &mut rebounds {
            rebound.impulse += self.impulse(rebound.point);
            let point = &mut self.points[rebound.point];
            (point.least, point.goal.x) = (0.0, 0.0);
        }
        rebounds
    }

    /// Finds the impulses of the impact of two bodies that touch no others, by Newton's law. Returns false if the island is another, or if
    /// friction would add energy; then Poisson's law applies.
    fn rebounds_alone(&mut self, island: &Island, rebounds: &mut [Rebound], limits: Limits) -> bool {
        let bodies = |point: &Point| self.contacts[point.contact].place.bodies;
        let [first, others @ ..] = &self.points[island.points.clone()] else { return false };
        if rebounds.is_empty() || others.iter().any(|point| bodies(point) != bodies(first)) {
            return false;
        }
        for rebound in &*rebounds {
            self.points[rebound.point].goal.x =
                newtons_goal(rebound.before.x, rebound.fall, rebound.restitution);
        }
        self.find(island, Purpose::Impact, limits);
        let work = |(point, impulse): (&Point, DVec3)| {
            impulse.dot(0.5 * (point.free_rate(&self.bodies) + point.rate(&self.bodies)))
        };
        let takes_energy = self.pushed(island).map(work).sum::<f64>() <= 0.0;
        for rebound in rebounds {
            rebound.impulse = if takes_energy { self.impulse(rebound.point) } else { DVec3::ZERO };
            self.points[rebound.point].goal.x = if takes_energy { 0.0 } else { -rebound.fall };
        }
        takes_energy
    }

    /// Returns the contacts of an island that close within the substep, and fast enough to rebound. A contact does not rebound if the loads
    /// would undo the rebound within about another substep, unless its restitution is 1.
    fn rebounds(&self, island: &Island, (model, loads): (&Model, &Loads), part: f64) -> Vec<Rebound> {
        let change = |body: &usize| part * model.inverse_mass()[*body] * loads.force[*body].length();
        let rebound = |number: usize| {
            let point = &self.points[number];
            let contact = &self.contacts[point.contact];
            let restitution = contact.place.law.restitution;
            let (before, goal) = (point.rate(&self.bodies), point.goal.x);
            let rate = before.x;
            if rate >= goal {
                return None;
            }
            let slow = if restitution < 1.0 { contact.place.bodies.iter().map(change).sum() } else { 0.0 };
            // A rebound that the loads would undo is none.
            let rebounds = -restitution * rate > slow;
            let is_new = self.holds_all && contact.push <= 0.0;
            let time = goal / rate * part;
            let falls = rebounds && self.holds_all;
            (rebounds || -rate > slow && is_new).then(|| Rebound {
                point: number,
                time,
                restitution: if rebounds { restitution } else { 0.0 },
                fall: if falls { time * self.pull(number, model, loads) } else { 0.0 },
                before,
                impulse: DVec3::ZERO,
            })
        };
        island.points.clone().filter_map(rebound).collect()
    }

    /// Returns the rate by which the loads alone change the normal rate of a point, m/s².
    fn pull(&self, point: usize, model: &Model, loads: &Loads) -> f64 {
        let point = &self.points[point];
        let at = |side: usize| {
            let body = &self.bodies[point.bodies[side] as usize];
            let acceleration = model.inverse_mass()[body.index] * loads.force[body.index];
            acceleration + (body.inverse_inertia * loads.torque[body.index]).cross(point.arms()[side])
        };
        point.components(at(1) - at(0)).x
    }

    /// Computes, for each rebounding body, the displacement (m) and the rotation vector (rad) that impulses caused before the bodies touched.
    fn early(
        &self,
        rebounds: &[Rebound],
        before: &Velocities,
        (model, after): (&Model, &State),
    ) -> Vec<(usize, [DVec3; 2])> {
        // A body with several rebounds uses the mean time of these, weighted by the impulses.
        let mut sums: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        for rebound in rebounds {
            for body in self.contacts[self.points[rebound.point].contact].place.bodies {
                let [weighted, all] = sums.entry(body).or_default();
                *weighted += rebound.impulse.x * rebound.time;
                *all += rebound.impulse.x;
            }
        }
        let early = |(&body, [velocity, angular_velocity]): (&usize, &[DVec3; 2])| {
            let [weighted, all] = sums[&body];
            let time = if all > 0.0 { weighted / all } else { 0.0 };
            let changes =
                [after.velocity[body] - *velocity, model.angular_velocity(body, after) - *angular_velocity];
            (body, changes.map(|change| time * change))
        };
        before.iter().map(early).collect()
    }

    /// Describes the impact of one rebound in the substep that starts at `time`, s, in this state. `velocities` are those of the bodies before
    /// the impact.
    fn impact(&self, rebound: &Rebound, time: f64, (velocities, state): (&Velocities, &State)) -> Impact {
        let point = &self.points[rebound.point];
        let place = &self.contacts[point.contact].place;
        let way =
            |body: usize| velocities.get(&body).map_or(DVec3::ZERO, |[velocity, _]| rebound.time * *velocity);
        let on = |side: usize| {
            let body = place.bodies[side];
            state.location[body] + point.arms()[side] + way(body)
        };
        let mean = 0.5 * (rebound.before + point.rate(&self.bodies));
        Impact {
            time: time + rebound.time,
            bodies: place.bodies,
            place: 0.5 * (on(0) + on(1)),
            normal: point.axes()[0],
            impulse: point.vector(rebound.impulse),
            energy: (-rebound.impulse.dot(mean) - rebound.impulse.x * rebound.fall).max(0.0),
        }
    }
}

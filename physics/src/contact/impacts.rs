//! Impacts between touching bodies: one pair after another, the fastest approach first.
//!
//! Bodies that touch at the same instant take part with a gap of zero: the impulse of one pair can make another pair approach, which then
//! has an impact as well. Among equal approaches, the order of the bodies decides. Impacts of one pair at several points are simultaneous,
//! and joints react at the same instant as each impact.

use std::sync::Arc;

use glam::DVec3;

use super::super::constraint::{PIVOT_TOLERANCE, Solver};
use super::super::motion::Twist;
use super::super::{BodyId, Breakdown, Model, State};
use super::Impact;
use super::closest_points::ClosestPoints;
use super::collider::{Collider, ContactScale, SPEED_ROUNDING, Touching};
use super::impulse::{Bounce, changed, impulses};
use super::lasting_contact::{LastingContact, spoke};
use super::laws::LawResidual;
use super::path::pose;
use super::touch::Touch;

/// A rebound is suppressed if its speed is below this fraction of the largest closing speed, because it would be invisible.
const MIN_REBOUND_SPEED: f64 = 1e-8;

/// A rebound below this fraction of the largest closing speed is suppressed as well, if rounding errors of coordinates hide the separation
/// before it.
const SLOW_REBOUND: f64 = 1e-5;

/// Contact points may stay closed if they separate at no more than this fraction of the largest closing speed. Elastic bodies are jammed if
/// they approach faster than this after [`MAX_IMPACTS_PER_INSTANT`].
const NORMAL_SPEED_TOLERANCE: f64 = 1e-9;

/// Two bodies may have this many more impacts in a step than their restitution explains. After that, slow impacts count as rest. Bodies
/// that others press together would otherwise bounce endlessly.
const EXCESS_IMPACTS_BEFORE_REST: f64 = 10.0;

/// After [`EXCESS_IMPACTS_BEFORE_REST`], the speed below which bodies count as at rest doubles with each further group of this many
/// impacts.
const IMPACTS_PER_DOUBLING: f64 = 5.0;
/// The largest factor by which further impacts raise the speed below which bodies count as at rest.
const MAX_REST_SPEED_FACTOR: f64 = 1000.0;

/// Moreau's scheme replaces the search for single events if one pair has this many more impacts within a step than its restitution
/// explains.
const EXCESS_IMPACTS_BEFORE_MOREAU: f64 = 40.0;
/// Moreau's scheme also replaces the search for single events if all pairs together have more impacts than this within a step.
const IMPACTS_BEFORE_MOREAU: u32 = 1_000;

/// Velocities count as equal if they differ by at most this fraction of the speed.
const VELOCITY_TOLERANCE: f64 = 1e-13;

/// An impact adds energy if its work exceeds this fraction of the work that stops the approach. Rounding errors are smaller. The
/// coefficient of restitution that adds no energy is found to this accuracy.
const ENERGY_GAIN_TOLERANCE: f64 = 1e-12;

/// The largest number of impacts in one instant per touching pair.
const MAX_IMPACTS_PER_INSTANT: usize = 2_000;

/// The largest number of impacts in one instant per touching pair, if every impact dissipates energy. Wedged bodies have many impacts that
/// each dissipate little. After this number, the remaining approach is stopped at once.
const MAX_IMPACTS_WITH_LOSSES: usize = 100;

/// A contact point of an impact: the unit vectors of its normal and its two tangents, and its position.
#[derive(Clone, Copy)]
struct ImpactPoint {
    axes: [DVec3; 3],
    /// The vectors from both centers of mass to the contact point, world axes, m.
    arms: [DVec3; 2],
}

/// The impacts of two bodies in the current step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Hits {
    count: u32,
    /// The time of the last one, s.
    time: f64,
}

/// The result of the impacts between touching bodies at one instant.
pub(crate) struct StruckBodies {
    /// The contacts at which bodies may stay in touch.
    pub(crate) closed: Vec<Arc<LastingContact>>,
    /// The indices of the bodies that had an impact. A body may occur several times.
    pub(crate) struck: Vec<usize>,
}

impl ImpactPoint {
    fn of(meeting: &ClosestPoints, bodies: [usize; 2], state: &State) -> ImpactPoint {
        let (u, w) = meeting.normal.any_orthonormal_pair();
        let arm = |i: usize| meeting.on[i] - state.location[bodies[i]];
        ImpactPoint { axes: [meeting.normal, u, w], arms: [arm(0), arm(1)] }
    }

    /// Computes the velocity of the second body relative to the first at the contact point, along the normal and the two tangents, m/s.
    fn rate(&self, [a, b]: [Twist; 2]) -> DVec3 {
        let apart = b.0 + b.1.cross(self.arms[1]) - a.0 - a.1.cross(self.arms[0]);
        DVec3::from_array(self.axes.map(|axis| axis.dot(apart)))
    }
}

impl Collider {
    /// Applies the impacts of touching bodies that approach each other, until none approach.
    ///
    /// # Errors
    ///
    /// Returns a breakdown if elastic impacts at one instant do not end, or if an impact adds energy.
    pub(crate) fn strike(
        &mut self,
        model: &Model,
        time: f64,
        state: &mut State,
        solver: &mut Solver,
    ) -> Result<StruckBodies, Breakdown> {
        // Bodies that start from rest have no closing speeds yet: their rounding errors are measured against what forces change in a step.
        self.fastest = self.fastest.max(solver.speed_by_loads());
        // A body held at rest and a body with a given motion that does not approach it have nothing to pass on to each other.
        let moves = |body: &usize| model.inverse_mass()[*body] != 0.0;
        let mut touching = self.touching(model, state);
        touching.retain(|pair| pair.bodies.iter().any(moves));
        let places: Vec<Vec<ImpactPoint>> = touching
            .iter()
            .map(|pair| {
                pair.touches.iter().map(|touch| ImpactPoint::of(&touch.meeting, pair.bodies, state)).collect()
            })
            .collect();
        let jointed: Vec<bool> = touching
            .iter()
            .map(|pair| pair.bodies.iter().any(|&body| Collider::is_jointed(model, body)))
            .collect();
        if jointed.contains(&true) {
            solver.hold_joints(model, time, state);
        }
        let approach = |i: usize, state: &State| {
            let twists = touching[i].bodies.map(|body| twist(body, model, state));
            places[i].iter().map(|place| -place.rate(twists).x).fold(0.0, f64::max)
        };
        for (pair, places) in touching.iter().zip(&places) {
            let twists = pair.bodies.map(|body| twist(body, model, state));
            // In pure rolling, the relative velocities are only rounding errors. The speeds of the bodies therefore set the scale for
            // negligible velocities.
            let speeds = places.iter().map(|place| place.rate(twists).length());
            let speeds = speeds.chain(twists.map(|(velocity, _)| velocity.length()));
            self.fastest = speeds.fold(self.fastest, f64::max);
        }
        let mut speeds: Vec<f64> = (0..touching.len()).map(|i| approach(i, state)).collect();
        let mut struck = Vec::new();
        let is_elastic = touching.iter().any(|pair| pair.law.restitution == 1.0);
        let rounds = if is_elastic { MAX_IMPACTS_PER_INSTANT } else { MAX_IMPACTS_WITH_LOSSES };
        for round in 0.. {
            let fastest =
                (0..touching.len()).max_by(|&i, &j| speeds[i].total_cmp(&speeds[j]).then(j.cmp(&i)));
            let Some(i) = fastest.filter(|&i| speeds[i] > 0.0) else { break };
            self.fastest = self.fastest.max(speeds[i]);
            if speeds[i] <= SPEED_ROUNDING * self.fastest {
                break;
            }
            if round > rounds * touching.len() {
                if is_elastic && speeds[i] > NORMAL_SPEED_TOLERANCE * self.fastest {
                    return Err(Breakdown::Jammed { bodies: touching[i].bodies.map(BodyId::new), time });
                }
                // The decision of modes afterwards stops the remaining approach at all contact points at once.
                break;
            }
            let joints = if jointed[i] { Some(&mut *solver) } else { None };
            let residual =
                self.strike_pair(&touching[i], &places[i], speeds[i], (model, time, state), joints);
            if residual.is_broken() {
                return Err(residual.breakdown());
            }
            struck.extend(touching[i].bodies);
            for (j, speed) in speeds.iter_mut().enumerate() {
                let shares = |body: &usize| touching[j].bodies.contains(body);
                if jointed[j] || touching[i].bodies.iter().any(shares) {
                    *speed = approach(j, state);
                }
            }
        }
        let mut closed = Vec::new();
        for (pair, places) in touching.iter().zip(&places) {
            let twists = pair.bodies.map(|body| twist(body, model, state));
            let size = self.size(pair.bodies);
            let still = NORMAL_SPEED_TOLERANCE * self.fastest * self.haste(pair);
            let near = pair.touches.iter().zip(places).filter(|(_, place)| place.rate(twists).x <= still);
            let near: Vec<&Touch> = near.map(|(touch, _)| touch).collect();
            let is_still = |touch: &&Touch| {
                ImpactPoint::of(&touch.meeting, pair.bodies, state).rate(twists).x.abs() <= still
            };
            let snug = pair.snug.iter().filter(|_| !near.is_empty()).filter(is_still);
            for touch in near.iter().copied().chain(snug) {
                let (bodies, law) = (pair.bodies, pair.law);
                let [a, b] = bodies.map(|body| pose(body, model, state));
                let spoke = spoke(&touch.patches, [&a, &b], &touch.meeting);
                closed.push(Arc::new(LastingContact {
                    bodies,
                    touch: *touch,
                    law,
                    size,
                    still,
                    may_miss: false,
                    spoke,
                }));
            }
        }
        Ok(StruckBodies { closed, struck })
    }

    /// Returns the factor on the speed below which two bodies count as at rest. It grows with repeated impacts.
    fn haste(&self, pair: &Touching) -> f64 {
        let hits = self.hits.get(&pair.bodies).map_or(0, |hits| hits.count);
        if pair.law.restitution == 1.0 {
            return 1.0;
        }
        let more = (f64::from(hits) - bounces(pair.law.restitution) - EXCESS_IMPACTS_BEFORE_REST)
            / IMPACTS_PER_DOUBLING;
        libm::exp2(more.max(0.0)).min(MAX_REST_SPEED_FACTOR)
    }

    /// Returns true if two bodies have hit each other too often in the current step, beyond what their restitution explains, or if all
    /// bodies together have had too many impacts.
    pub(crate) fn hits_too_often(&self, bodies: [usize; 2]) -> bool {
        let Some(law) = self.pairs.law(bodies).filter(|law| law.restitution < 1.0) else { return false };
        let hits = self.hits.get(&bodies).map_or(0, |hits| hits.count);
        let all: u32 = self.hits.values().map(|hits| hits.count).sum();
        f64::from(hits) - bounces(law.restitution) > EXCESS_IMPACTS_BEFORE_MOREAU
            || all > IMPACTS_BEFORE_MOREAU
    }

    /// Returns true if two bodies that meet at `speed`, m/s, have separated since their last impact by no more than the rounding errors of
    /// their coordinates. These errors, and no motion, then give the time of the impact and its speed. Impacts at the same instant do not
    /// count: other bodies cause them.
    fn hits_unseen(
        &self,
        bodies: [usize; 2],
        speed: f64,
        time: f64,
        (model, state): (&Model, &State),
    ) -> bool {
        let (Some(last), [Some(a), Some(b)]) =
            (self.hits.get(&bodies), bodies.map(|body| self.solids[body].as_ref()))
        else {
            return false;
        };
        // Bodies that meet again with the speed at which they left were apart by a quarter of the product of speed and time.
        let height = 0.25 * speed * (time - last.time);
        height > 0.0 && height <= ContactScale::of(bodies, [a, b], (model, state)).touch()
    }

    /// Returns a typical length of the smaller of two bodies, m.
    pub(super) fn size(&self, bodies: [usize; 2]) -> f64 {
        let size = |body: usize| self.solids[body].as_ref().map_or(f64::INFINITY, super::solid::Solid::size);
        size(bodies[0]).min(size(bodies[1])).min(f64::MAX)
    }

    /// Applies the impact of two bodies that approach each other at `speed`, m/s, and records it. Returns the energy that it has added, as
    /// no impact can.
    fn strike_pair(
        &mut self,
        pair: &Touching,
        places: &[ImpactPoint],
        speed: f64,
        (model, time, state): (&Model, f64, &mut State),
        mut joints: Option<&mut Solver>,
    ) -> LawResidual {
        let twists = |state: &State| pair.bodies.map(|body| twist(body, model, state));
        let before: Vec<DVec3> = places.iter().map(|place| place.rate(twists(state))).collect();
        let rest = MIN_REBOUND_SPEED * self.fastest * self.haste(pair);
        let rebound = pair.law.restitution * speed;
        let is_slow = rebound <= rest
            || (rebound <= SLOW_REBOUND * self.fastest
                && self.hits_unseen(pair.bodies, speed, time, (model, state)));
        let rests = pair.law.restitution < 1.0 && is_slow;
        let hits = self.hits.entry(pair.bodies).or_default();
        (hits.count, hits.time) = (hits.count + 1, time);
        let bounce = Bounce {
            restitution: if rests { 0.0 } else { pair.law.restitution },
            friction: pair.law.friction,
        };
        let mut moved = joints.as_deref().map_or(Vec::new(), Solver::bodies);
        moved.extend(pair.bodies.iter().filter(|body| !moved.contains(body)).collect::<Vec<_>>());
        let energy = |state: &State| moved.iter().map(|&body| kinetic(body, model, state)).sum::<f64>();
        let (kinetic, given) = (energy(state), state.accounts.work + state.accounts.motors);
        let context = (model, &*state);
        let middle = middle(pair.bodies, places, &before, bounce, context, joints.as_deref_mut());
        let (places, before, all) = match &middle {
            Some((place, rate, impulse)) => (std::slice::from_ref(place), vec![*rate], vec![*impulse]),
            None => {
                let response = response(pair.bodies, places, context, joints.as_deref_mut());
                let all = without_gain(bounce, &before, &response);
                (places, before, all)
            }
        };
        let (mut impulse, mut place, mut normal, mut weight) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, 0.0);
        let (mut moment, mut moments) = (DVec3::ZERO, 0.0);
        let apart = state.location[pair.bodies[1]] - state.location[pair.bodies[0]];
        for (at, pushed) in places.iter().zip(&all) {
            let push = at.axes[0] * pushed.x + at.axes[1] * pushed.y + at.axes[2] * pushed.z;
            for (i, &body) in pair.bodies.iter().enumerate() {
                let push = if i == 0 { -push } else { push };
                let turn = at.arms[i].cross(push);
                let inverse_mass = model.inverse_mass()[body];
                if inverse_mass != 0.0 {
                    state.velocity[body] += inverse_mass * push;
                    state.angular_momentum[body] += turn;
                } else {
                    // The guide of a body (whatever makes it follow its given motion) absorbs the impulse on this body. The guide's work is
                    // booked.
                    let turning = turn.dot(model.angular_velocity(body, state));
                    state.accounts.work -= push.dot(state.velocity[body]) + turning;
                }
            }
            moment += (apart + at.arms[1] - at.arms[0]).cross(push);
            moments += push.length() * (at.arms[0].length() + at.arms[1].length());
            impulse += push;
            place += pushed.x * (at.arms[1] + state.location[pair.bodies[1]]);
            normal += pushed.x * at.axes[0];
            weight += pushed.x;
        }
        if let Some(joints) = joints {
            joints.obey_joints(model, state);
        }
        let after = places.iter().map(|place| place.rate(twists(state)));
        let work = before
            .iter()
            .zip(after)
            .zip(&all)
            .map(|((before, after), pushed)| 0.5 * pushed.dot(*before + after));
        let work: f64 = work.sum();
        state.accounts.impacts += work;
        let given = state.accounts.work + state.accounts.motors - given;
        let residual = self.laws.weigh(energy(state) - kinetic - given, kinetic, pair.bodies, time);
        self.laws.note(residual);
        self.laws.note_moment(moment.length(), moments, pair.bodies, time);
        if (pair.law.restitution == 1.0 || speed > MIN_REBOUND_SPEED * self.fastest) && weight > 0.0 {
            let (place, normal) = (place / weight, normal.normalize_or_zero());
            let energy = (-work).max(0.0);
            self.impacts.push(Impact { time, bodies: pair.bodies, place, normal, impulse, energy });
        }
        residual
    }
}

/// Computes the impulses of an impact, as [`impulses`] does. With friction, Newton's law of restitution can add energy (Kane's paradox);
/// the restitution is then the largest that adds none. Source: W. J. Stronge, Proc. R. Soc. Lond. A 431 (1990) 169.
fn without_gain(bounce: Bounce, before: &[DVec3], response: &[f64]) -> Vec<DVec3> {
    let find = |restitution: f64| {
        let all = impulses(&vec![Bounce { restitution, ..bounce }; before.len()], before, response);
        let (mut work, mut size) = (0.0, 0.0);
        for (place, (impulse, before)) in all.iter().zip(before).enumerate() {
            work += impulse.dot(*before + 0.5 * changed(response, &all, place));
            size += (*impulse * *before).abs().element_sum();
        }
        (all, work > ENERGY_GAIN_TOLERANCE * size)
    };
    let (all, gains) = find(bounce.restitution);
    if !gains {
        return all;
    }
    let (mut least, mut most) = (0.0, bounce.restitution);
    while most - least > ENERGY_GAIN_TOLERANCE {
        let middle = 0.5 * (least + most);
        *if find(middle).1 { &mut most } else { &mut least } = middle;
    }
    find(least).0
}

/// Returns the number of bounces in which a coefficient of restitution reduces the fastest approach to rest.
fn bounces(restitution: f64) -> f64 {
    libm::log(MIN_REBOUND_SPEED) / libm::log(restitution)
}

/// Replaces an impact at several points by one at their middle, if the impact causes no rotation. Returns the contact point, its velocity
/// before the impact, and its impulse. `None` if the impact causes rotation, so that the points behave differently.
fn middle(
    bodies: [usize; 2],
    places: &[ImpactPoint],
    before: &[DVec3],
    bounce: Bounce,
    context: (&Model, &State),
    joints: Option<&mut Solver>,
) -> Option<(ImpactPoint, DVec3, DVec3)> {
    let [first, .., _] = places else { return None };
    let rate = before[0];
    let speed = rate.length();
    let is_same = |place: &ImpactPoint| place.axes[0].dot(first.axes[0]) > 1.0 - 1e-14;
    let is_alike = |other: &DVec3| (*other - rate).length() <= VELOCITY_TOLERANCE * speed;
    if !(places.iter().all(is_same) && before.iter().all(is_alike)) {
        return None;
    }
    let mean = |i: usize| places.iter().map(|place| place.arms[i]).sum::<DVec3>() / places.len() as f64;
    let place = ImpactPoint { arms: [mean(0), mean(1)], ..*first };
    let all: Vec<ImpactPoint> = std::iter::once(place).chain(places.iter().copied()).collect();
    let n = 3 * all.len();
    let response = response_to(bodies, &all, 1, context, joints);
    let own: Vec<f64> = (0..9).map(|i| response[i / 3 * 3 + i % 3]).collect();
    let impulse = impulses(&[bounce], &[rate], &own)[0];
    let moved = |row: usize| (0..3).map(|column| response[row * 3 + column] * impulse[column]).sum::<f64>();
    let after = |at: usize| DVec3::new(moved(3 * at), moved(3 * at + 1), moved(3 * at + 2));
    let is_turned = (1..n / 3).any(|at| (after(at) - after(0)).length() > VELOCITY_TOLERANCE * speed);
    (!is_turned).then_some((place, rate, impulse))
}

/// Computes the kinetic energy of a body that loads can move, J.
pub(crate) fn kinetic(body: usize, model: &Model, state: &State) -> f64 {
    let mass = if model.inverse_mass()[body] == 0.0 { 0.0 } else { model.mass()[body] };
    let turning = state.angular_momentum[body].dot(model.angular_velocity(body, state));
    0.5 * (mass * state.velocity[body].length_squared() + if mass == 0.0 { 0.0 } else { turning })
}

fn twist(body: usize, model: &Model, state: &State) -> Twist {
    (state.velocity[body], model.angular_velocity(body, state))
}

/// Computes J M⁻¹ Jᵀ for some contact points, row by row, under the constraints of the joints.
fn response(
    bodies: [usize; 2],
    places: &[ImpactPoint],
    (model, state): (&Model, &State),
    joints: Option<&mut Solver>,
) -> Vec<f64> {
    response_to(bodies, places, places.len(), (model, state), joints)
}

/// Computes the columns of J M⁻¹ Jᵀ that belong to impulses at the first `pushed` contact points. Where joints block all motion along the
/// normal, or along all tangents, the response would be only a rounding error. Instead, such axes respond as without joints, and are not
/// coupled to others: since their rates are 0, their impulses are 0, too.
fn response_to(
    bodies: [usize; 2],
    places: &[ImpactPoint],
    pushed: usize,
    (model, state): (&Model, &State),
    mut joints: Option<&mut Solver>,
) -> Vec<f64> {
    let n = 3 * pushed;
    let mut response = vec![0.0; 3 * places.len() * n];
    let mut all_free = Vec::with_capacity(n);
    for column in 0..n {
        let place = &places[column / 3];
        let push = place.axes[column % 3];
        let pushes = [(-push, -place.arms[0].cross(push)), (push, place.arms[1].cross(push))];
        let free = std::array::from_fn(|i| model.respond(bodies[i], state, pushes[i]));
        let twists = match joints.as_deref_mut() {
            Some(joints) => joints.respond(model, state, bodies, pushes),
            None => free,
        };
        for (row, place) in places.iter().enumerate() {
            let rate = place.rate(twists);
            for axis in 0..3 {
                response[(3 * row + axis) * n + column] = rate[axis];
            }
        }
        all_free.push(place.rate(free)[column % 3]);
    }
    // The two tangents count together, since their directions are arbitrary.
    let along = (0..n).step_by(3).flat_map(|first| [first..first + 1, first + 1..first + 3]);
    for axes in along.filter(|_| joints.is_some()) {
        let own: f64 = axes.clone().map(|axis| response[axis * n + axis]).sum();
        if own > PIVOT_TOLERANCE * all_free[axes.clone()].iter().sum::<f64>() {
            continue;
        }
        for axis in axes {
            response.iter_mut().skip(axis).step_by(n).for_each(|coupling| *coupling = 0.0);
            response[axis * n..(axis + 1) * n].fill(0.0);
            response[axis * n + axis] = all_free[axis];
        }
    }
    response
}

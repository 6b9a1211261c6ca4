//! Impacts in Moreau's scheme: all impacts within one substep are solved together.
//!
//! Two bodies that touch no others rebound by Newton's law: each point leaves with its approach speed, times the coefficient of restitution.
//! For many bodies, this law can gain energy. Poisson's law never does. It has two phases. In the first phase, bodies stop each other. In the
//! second, each contact repeats its impulse, times its coefficient of restitution. Without friction and joints, this is Newton's law for two
//! bodies.
//! Source: C. Glocker & F. Pfeiffer, *Multiple impacts with friction in rigid multibody systems*, Nonlinear Dynamics 7 (1995) 471.
//!
//! A contact that closes within the substep gets its impulse at the start of the substep, which is too early. The positions of its bodies
//! are corrected afterwards, as if they had kept their old velocities until they touched.

use std::collections::BTreeMap;

use glam::DVec3;

use super::super::{Impact, Loads, Model, State};
use super::solver::Solver;
use super::structure::ConstraintBlock;
use super::sweep::Purpose;
use super::{Direction, Law};

/// Bodies that press on each other often approach slowly at the start of a substep. The contact force stops them within the substep, so they
/// need no impulse. Slowly means: slower than this fraction of the change of the rate by the contact force in a substep.
pub(super) const CLOSING_LEFT_TO_FORCES: f64 = 0.1;

/// The impacts within one substep, and the corrections of positions that they cause.
#[derive(Default)]
pub(crate) struct Struck {
    /// The impacts, in order of time.
    pub(crate) impacts: Vec<Impact>,
    /// For each rebounding body, its index, and the displacement (m) and the rotation vector (rad) that the impulse caused before the bodies
    /// touched. These have to be undone.
    pub(crate) early: Vec<(usize, [DVec3; 2])>,
    /// The energy that the impulses gave too much because the loads had not yet worked until the bodies touched, J: 0 or negative.
    pub(crate) fallen: f64,
}

/// A contact at which two bodies rebound in this substep.
struct Rebound {
    contact: usize,
    /// The index of the contact's normal row, which is its first row. `rows` is its number of rows.
    row: usize,
    rows: usize,
    /// The time from the start of the substep until the bodies touch, s.
    time: f64,
    /// The part of the impulse that the contact repeats.
    restitution: f64,
    /// The change of the closing rate by the loads until the bodies touch, m/s.
    fall: f64,
}

/// Returns the rate of a contact after the impulse of an impact by Newton's law, m/s. The impulse acts at the start of the substep, with the
/// rate `before`. The loads change the rate by `fall` until the bodies touch.
pub(super) fn newtons_goal(before: f64, fall: f64, restitution: f64) -> f64 {
    -fall - restitution * (before + fall)
}

/// Combines the impacts at all points of two bodies into one, at the center of their normal impulses.
pub(super) fn of_pairs(points: Vec<Impact>) -> Vec<Impact> {
    let mut pairs: BTreeMap<[usize; 2], Vec<Impact>> = BTreeMap::new();
    points.into_iter().for_each(|point| pairs.entry(point.bodies).or_default().push(point));
    let one = |points: Vec<Impact>| {
        let normal: DVec3 = points.iter().map(|point| point.normal).sum();
        let push = |point: &Impact| point.impulse.dot(point.normal).max(0.0);
        let all: f64 = points.iter().map(push).sum();
        let part = |point: &Impact| if all > 0.0 { push(point) / all } else { 1.0 / points.len() as f64 };
        Impact {
            time: points.iter().map(|point| part(point) * point.time).sum(),
            bodies: points[0].bodies,
            place: points.iter().map(|point| part(point) * point.place).sum(),
            normal: normal.normalize_or_zero(),
            impulse: points.iter().map(|point| point.impulse).sum(),
            energy: points.iter().map(|point| point.energy).sum(),
        }
    };
    pairs.into_values().map(|points| if points.len() == 1 { points[0] } else { one(points) }).collect()
}

impl Solver {
    /// Applies the impulses of all contacts that close within `part` seconds after `time`. [`prepare_sweeps`](Self::prepare_sweeps) must
    /// have run before. The rates of stops (inequalities c ≥ 0) may not fall below their `goals`. For a contact that rebounds, this
    /// function sets the goal to 0, so its bodies approach no further in this substep.
    pub(crate) fn strike_all(
        &mut self,
        model: &Model,
        (time, part): (f64, f64),
        goals: &mut [f64],
        (state, loads): (&mut State, &Loads),
    ) -> Struck {
        let before = self.rates_of(model, state);
        if self.counts_soft_impacts && !self.are_closing((&before, goals), part) {
            return Struck::default();
        }
        let rebounds = self.rebounds((model, loads), (&before, goals), part);
        let velocities: BTreeMap<usize, DVec3> =
            self.rebounding(&rebounds, model).map(|body| (body, state.velocity[body])).collect();
        let alone = self.rebound_alone(&rebounds, &before, (model, goals), state);
        let impulses = alone.unwrap_or_else(|| self.rebound_in_phases(&rebounds, (model, goals), state));
        if rebounds.is_empty() {
            return Struck::default();
        }
        for rebound in &rebounds {
            goals[rebound.row] = 0.0;
        }
        let early = self.early(&rebounds, &impulses, (&velocities, state));
        let after = self.rates_of(model, state);
        let impact = |rebound| self.impact(rebound, time, (&impulses, &velocities), (&before, &after));
        let mut impacts: Vec<Impact> = rebounds.iter().filter_map(impact).collect();
        if self.counts_soft_impacts {
            impacts = of_pairs(impacts);
        }
        impacts.sort_by(|a, b| a.time.total_cmp(&b.time));
        let fallen = rebounds.iter().map(|rebound| impulses[rebound.row] * rebound.fall).sum();
        Struck { impacts, early, fallen }
    }

    /// Applies the impulses of an impact by Newton's law, if the only contacts are those of two bodies. `before` are the rates of all rows.
    /// Returns the impulses of all rows. `None` if there are other contacts, or if friction would add energy; then Poisson's law applies.
    fn rebound_alone(
        &mut self,
        rebounds: &[Rebound],
        before: &[f64],
        (model, goals): (&Model, &mut [f64]),
        state: &mut State,
    ) -> Option<Vec<f64>> {
        let [first, others @ ..] = &self.contacts[..] else { return None };
        if rebounds.is_empty() || others.iter().any(|contact| contact.bodies != first.bodies) {
            return None;
        }
        let unstruck = state.clone();
        for rebound in rebounds {
            goals[rebound.row] = newtons_goal(before[rebound.row], rebound.fall, rebound.restitution);
        }
        self.push_all(model, goals, Purpose::Impact, state);
        let impulses = self.unknown.clone();
        let after = self.rates_of(model, state);
        let rates = before.iter().zip(&after).map(|(before, after)| 0.5 * (before + after));
        let work: f64 = impulses.iter().zip(rates).map(|(impulse, rate)| impulse * rate).sum();
        if work > 0.0 {
            state.clone_from(&unstruck);
            self.rates_of(model, state);
            return None;
        }
        Some(impulses)
    }

    /// Applies the impulses of impacts by the two phases of Poisson's law. Returns the impulses of all rows.
    fn rebound_in_phases(
        &mut self,
        rebounds: &[Rebound],
        (model, goals): (&Model, &mut [f64]),
        state: &mut State,
    ) -> Vec<f64> {
        // The loads act until the bodies touch. What they add to the approach is reversed with it.
        for rebound in rebounds {
            goals[rebound.row] = -rebound.fall;
        }
        self.push_all(model, goals, Purpose::Impact, state);
        let mut impulses = self.unknown.clone();
        if rebounds.is_empty() {
            return impulses;
        }
        self.least = vec![0.0; impulses.len()];
        for rebound in rebounds {
            self.least[rebound.row] = rebound.restitution * impulses[rebound.row];
        }
        self.push_all(model, goals, Purpose::Impact, state);
        self.least.clear();
        impulses.iter_mut().zip(&self.unknown).for_each(|(sum, more)| *sum += more);
        impulses
    }

    /// Records impacts without a rebound from now on, too.
    pub(crate) fn count_soft_impacts(&mut self) {
        self.counts_soft_impacts = true;
    }

    /// Returns the smallest impulse that a constraint row may have: the second phase of Poisson's law for a contact that rebounds,
    /// otherwise 0.
    pub(super) fn least(&self, row: usize) -> f64 {
        self.least.get(row).copied().unwrap_or(0.0)
    }

    /// Returns the contacts that close within `part` seconds and fast enough to rebound. A contact does not rebound if the loads would undo
    /// the rebound within about another `part` seconds, unless its restitution is 1.
    fn rebounds(
        &self,
        (model, loads): (&Model, &Loads),
        (rates, goals): (&[f64], &[f64]),
        part: f64,
    ) -> Vec<Rebound> {
        let change = |body: &usize| part * model.inverse_mass()[*body] * loads.force[*body].length();
        let rebound = |place: &ConstraintBlock| {
            let contact = place.constraint.checked_sub(self.joints())?;
            let (restitution, bodies) =
                (self.contacts[contact].law.restitution, self.contacts[contact].bodies);
            let (rate, goal) = (rates[place.row], goals[place.row]);
            let slow = if restitution < 1.0 { bodies.iter().map(change).sum() } else { 0.0 };
            // A rebound that the loads would undo is none.
            let rebounds = -restitution * rate > slow;
            let is_fast = rate < goal && (rebounds || -rate > slow && self.is_new(contact));
            is_fast.then(|| Rebound {
                contact,
                row: place.row,
                rows: place.rows,
                time: goal / rate * part,
                restitution: if rebounds { restitution } else { 0.0 },
                fall: if rebounds && self.counts_soft_impacts {
                    goal / rate * part * self.pull(place.row, model, loads)
                } else {
                    0.0
                },
            })
        };
        self.structure.iter().flat_map(|structure| &structure.places).filter_map(rebound).collect()
    }

    /// Returns true if a stop (an inequality c ≥ 0) closes faster than its last force explains. What already pushed keeps its rate by forces:
    /// impulses would only take the energy of the small rates that a substep of turning bodies leaves.
    fn are_closing(&self, (rates, goals): (&[f64], &[f64]), part: f64) -> bool {
        let closes = |row: usize, place: &ConstraintBlock| {
            if self.laws[row] != Law::Inequality || rates[row] >= goals[row] {
                return false;
            }
            let force = match place.constraint.checked_sub(self.joints()) {
                Some(contact) => self.last_push(contact),
                None => {
                    let is_it = |(constraint, of, _): &&(usize, usize, f64)| {
                        *constraint == place.constraint && *of == row - place.row
                    };
                    self.joint_forces.iter().find(is_it).map_or(0.0, |(.., force)| *force)
                }
            };
            rates[row] < goals[row] - CLOSING_LEFT_TO_FORCES * part * force * self.columns.weights()[row]
        };
        let mut places = self.structure.iter().flat_map(|structure| &structure.places);
        places.any(|place| (place.row..place.row + place.rows).any(|row| closes(row, place)))
    }

    /// Returns the normal force of a contact in the last substep, N.
    fn last_push(&self, contact: usize) -> f64 {
        self.warm.find(&self.contacts[contact]).map_or(0.0, |forces| forces[0])
    }

    /// Returns true if a contact did not push in the last substep, and impacts without a rebound are recorded.
    fn is_new(&self, contact: usize) -> bool {
        self.counts_soft_impacts && self.last_push(contact) <= 0.0
    }

    /// Returns the rate by which the loads alone change the rate of a constraint row, m/s².
    fn pull(&self, row: usize, model: &Model, loads: &Loads) -> f64 {
        let Some(structure) = &self.structure else { return 0.0 };
        let of = |direction: &Direction| {
            let (member, body) = (&self.members[direction.member], structure.bodies[direction.member]);
            direction.linear.dot(model.inverse_mass()[body] * loads.force[body])
                + direction.angular.dot(member.turn(loads.torque[body]))
        };
        self.jacobian[structure.directions_of(row)].iter().map(of).sum()
    }

    /// Returns the movable bodies of rebounding contacts, by index.
    fn rebounding(&self, rebounds: &[Rebound], model: &Model) -> impl Iterator<Item = usize> {
        let bodies = rebounds.iter().flat_map(|rebound| self.contacts[rebound.contact].bodies);
        bodies.filter(|&body| model.inverse_mass()[body] != 0.0)
    }

    /// Computes, for each rebounding body, the displacement that impulses caused before the bodies touched, m. Rotations are left as they are:
    /// joints would have to be closed again after them.
    fn early(
        &self,
        rebounds: &[Rebound],
        impulses: &[f64],
        (before, after): (&BTreeMap<usize, DVec3>, &State),
    ) -> Vec<(usize, [DVec3; 2])> {
        // A body with several rebounds uses the mean time of these, weighted by the impulses.
        let mut sums: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        for rebound in rebounds {
            for body in self.contacts[rebound.contact].bodies {
                let [weighted, all] = sums.entry(body).or_default();
                *weighted += impulses[rebound.row] * rebound.time;
                *all += impulses[rebound.row];
            }
        }
        let early = |(&body, velocity): (&usize, &DVec3)| {
            let [weighted, all] = sums[&body];
            let time = if all > 0.0 { weighted / all } else { 0.0 };
            (body, [time * (after.velocity[body] - *velocity), DVec3::ZERO])
        };
        before.iter().map(early).collect()
    }

    /// Describes the impact of one rebound in the substep that starts at `time`, s. `velocities` are those of the bodies before the
    /// impact. `before` and `after` are the rates of all constraint rows before and after it.
    fn impact(
        &self,
        rebound: &Rebound,
        time: f64,
        (impulses, velocities): (&[f64], &BTreeMap<usize, DVec3>),
        (before, after): (&[f64], &[f64]),
    ) -> Option<Impact> {
        let structure = self.structure.as_ref()?;
        let Rebound { contact, row, rows, .. } = *rebound;
        let contact = &self.contacts[contact];
        let of = |row: usize| &self.jacobian[structure.directions_of(row)];
        let members = [of(row).first()?, of(row).last()?].map(|direction| &self.members[direction.member]);
        let add = |i: usize, force: &mut DVec3| {
            let linear = of(row + i).last().map_or(DVec3::ZERO, |direction| direction.linear);
            *force += impulses[row + i] * linear;
        };
        let seen = contact.snapshot(members, add);
        let way =
            |body: &usize| velocities.get(body).map_or(DVec3::ZERO, |velocity| rebound.time * *velocity);
        let work = |row: usize| 0.5 * impulses[row] * (before[row] + after[row]);
        Some(Impact {
            time: time + rebound.time,
            bodies: contact.bodies,
            place: seen.place + 0.5 * contact.bodies.iter().map(way).sum::<DVec3>(),
            normal: seen.normal,
            impulse: seen.force + seen.friction,
            energy: (-(row..row + rows).map(work).sum::<f64>() - impulses[row] * rebound.fall).max(0.0),
        })
    }
}

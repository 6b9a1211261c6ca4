//! The Lennard-Jones force between neutral atoms.

use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;

use super::super::BodyId;
use super::cells::Cells;
use super::{Force, ForceBetween, Loads, Moment, share};

/// The Lennard-Jones force between bodies. Any two bodies that are nearer than the cutoff r_c have the potential U(r) = u(r) − u(r_c) with
/// u = 4ε ((σ/r)¹² − (σ/r)⁶). They repel each other below 2^(1/6) σ, and attract each other beyond that distance.
///
/// The cutoff makes the computing time linear in the number of bodies. The shift −u(r_c) makes the potential continuous at the cutoff, so
/// that the energy is conserved. The force still jumps by 0.039 ε/σ at the usual cutoff of 2.5 σ. With `smooth`, the force is shifted as
/// well, U(r) = u(r) − u(r_c) − (r − r_c) u′(r_c), so that integration methods keep their order across the cutoff. Source: M. P. Allen & D.
/// J. Tildesley, *Computer Simulation of Liquids*, 2nd ed. (2017), 1.2.1 and 5.2.3 (cells).
///
/// The order in which the forces are summed depends only on the positions of the bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct LennardJones {
    /// The bodies that act on each other.
    pub bodies: Vec<BodyId>,
    /// A second group of bodies, disjoint from the first. If present, each body acts only on the bodies of the other group.
    pub against: Option<Vec<BodyId>>,
    /// The depth ε of the potential well, J.
    pub epsilon: f64,
    /// The distance σ at which the unshifted potential is 0, m.
    pub sigma: f64,
    /// The cutoff r_c: the distance beyond which two bodies exert no force on each other, m.
    pub cutoff: f64,
    /// Whether the force is continuous at the cutoff. If not, only the potential is.
    pub smooth: bool,
}

/// Working memory for one evaluation of the force. It is reused, so that a run allocates no memory.
#[derive(Debug, Default)]
struct WorkingMemory {
    sorted: Sorted,
    /// The forces on the sorted bodies, N: one list for each axis.
    force: [Vec<f64>; 3],
}

/// The present bodies with their properties. `bodies` and `places` hold the first group, then the second. `is_second` (true for bodies of
/// the second group) and `movable` are in the order of the cells.
#[derive(Debug, Default)]
struct Sorted {
    bodies: Vec<BodyId>,
    places: Vec<DVec3>,
    cells: Cells,
    is_second: Vec<bool>,
    movable: Vec<bool>,
    /// Whether there are two groups of bodies, which act only on each other.
    has_groups: bool,
    /// Whether some pairs exert no force: true if there are two groups, or if some bodies cannot move.
    is_mixed: bool,
}

/// A pool of working memory. An evaluation takes an entry, or makes a new one if the pool is empty, so concurrent evaluations never wait
/// for each other.
static POOL: Mutex<Vec<WorkingMemory>> = Mutex::new(Vec::new());

impl LennardJones {
    /// The usual cutoff distance, in units of σ.
    pub const CUTOFF: f64 = 2.5;

    /// Returns the unshifted potential u = 4ε ((σ/r)¹² − (σ/r)⁶) and −u′/r, where `square` is r².
    #[inline(always)]
    fn pure(&self, square: f64) -> (f64, f64) {
        let inverse = 1.0 / square;
        let two = self.sigma * self.sigma * inverse;
        let six = two * two * two;
        let potential = 4.0 * self.epsilon * six * (six - 1.0);
        (potential, 24.0 * self.epsilon * inverse * six * (2.0 * six - 1.0))
    }

    /// Returns the constant u(r_c) that is subtracted from the potential, and the force −u′(r_c) that is subtracted from the force. The
    /// subtracted force is 0 unless `smooth` is set.
    fn shifts(&self) -> (f64, f64) {
        let (potential, push) = self.pure(self.cutoff * self.cutoff);
        (potential, if self.smooth { push * self.cutoff } else { 0.0 })
    }

    /// Returns the energy of a pair of bodies as a function of the square of their distance (m²), J.
    fn energy(&self) -> impl Fn(f64) -> f64 + '_ {
        let (shift, less) = self.shifts();
        move |square| {
            let over = if less == 0.0 { 0.0 } else { less * (square.sqrt() - self.cutoff) };
            self.pure(square).0 - shift + over
        }
    }

    /// Takes working memory from the pool, sorts the present bodies in it, and calls `work` with it. Returns the result of `work`.
    fn with_working_memory<T>(&self, moment: &Moment, work: impl FnOnce(&mut WorkingMemory) -> T) -> T {
        let taken = POOL.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut memory = taken.unwrap_or_default();
        memory.sorted.fill(self, moment);
        let done = work(&mut memory);
        POOL.lock().unwrap_or_else(PoisonError::into_inner).push(memory);
        done
    }

    /// Calls `see` for each pair of interacting bodies with their indices in the order of cells, the vector from the second to the first
    /// (m), and its square. `see` returns the force on the first body. After each range of second bodies, calls `end` with the first body
    /// and the sum of these forces.
    #[inline]
    fn each_pair<S>(
        &self,
        sorted: &Sorted,
        state: &mut S,
        mut see: impl FnMut(&mut S, usize, usize, [f64; 3], f64) -> [f64; 3],
        mut end: impl FnMut(&mut S, usize, [f64; 3]),
    ) {
        let (limit, at) = (self.cutoff * self.cutoff, &sorted.cells.at);
        sorted.cells.each(|one, others: Range<usize>| {
            let here = [at[0][one], at[1][one], at[2][one]];
            let mut sum = [0.0; 3];
            for other in others {
                let d = [here[0] - at[0][other], here[1] - at[1][other], here[2] - at[2][other]];
                let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                if square < limit && !(sorted.is_mixed && sorted.is_no_pair(one, other)) {
                    let part = see(state, one, other, d, square);
                    sum = [sum[0] + part[0], sum[1] + part[1], sum[2] + part[2]];
                }
            }
            end(state, one, sum);
        });
    }
}

impl Sorted {
    fn fill(&mut self, force: &LennardJones, moment: &Moment) {
        self.bodies.clear();
        self.bodies.extend_from_slice(&moment.model.present(&force.bodies));
        let first = self.bodies.len();
        if let Some(against) = &force.against {
            self.bodies.extend_from_slice(&moment.model.present(against));
        }
        self.places.clear();
        self.places.extend(self.bodies.iter().map(|body| moment.state.location[body.index()]));
        self.cells.sort(&self.places, force.cutoff);
        self.is_second.clear();
        self.movable.clear();
        for number in self.cells.number.iter().map(|number| *number as usize) {
            self.is_second.push(number >= first);
            self.movable.push(moment.model.movable()[self.bodies[number].index()]);
        }
        self.is_mixed = force.against.is_some() || self.movable.iter().any(|movable| !movable);
        self.has_groups = force.against.is_some();
    }

    /// Returns true if two bodies do not interact: both belong to the same one of two groups, or neither can move.
    fn is_no_pair(&self, one: usize, other: usize) -> bool {
        self.has_groups && self.is_second[one] == self.is_second[other]
            || !self.movable[one] && !self.movable[other]
    }
}

impl Force for LennardJones {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        let (_, less) = self.shifts();
        self.with_working_memory(moment, |WorkingMemory { sorted, force }| {
            for force in force.iter_mut() {
                force.clear();
                force.resize(sorted.bodies.len(), 0.0);
            }
            let push = |force: &mut [Vec<f64>; 3], _: usize, other: usize, d: [f64; 3], square: f64| {
                let mut push = self.pure(square).1;
                if less != 0.0 {
                    push -= less / square.sqrt();
                }
                let part = d.map(|d| push * d);
                for (force, part) in force.iter_mut().zip(part) {
                    force[other] -= part;
                }
                part
            };
            self.each_pair(sorted, force, push, |force, one, sum| {
                for (force, sum) in force.iter_mut().zip(sum) {
                    force[one] += sum;
                }
            });
            for (place, number) in sorted.cells.number.iter().enumerate() {
                let body = sorted.bodies[*number as usize].index();
                loads.force[body] += DVec3::new(force[0][place], force[1][place], force[2][place]);
            }
        });
    }

    fn potential(&self, moment: &Moment) -> f64 {
        self.with_working_memory(moment, |WorkingMemory { sorted, .. }| {
            let energy = self.energy();
            let mut sum = 0.0;
            let add = |sum: &mut f64, _: usize, _: usize, _: [f64; 3], square: f64| {
                *sum += energy(square);
                [0.0; 3]
            };
            self.each_pair(sorted, &mut sum, add, |_, _, _| {});
            sum
        })
    }

    fn share_potential(&self, moment: &Moment, shares: &mut [f64]) {
        self.with_working_memory(moment, |WorkingMemory { sorted, .. }| {
            let body = |place: usize| sorted.bodies[sorted.cells.number[place] as usize].index();
            let (energy, mut shares) = (self.energy(), shares);
            let add = |shares: &mut &mut [f64], one: usize, other: usize, _: [f64; 3], square: f64| {
                share(energy(square), [body(one), body(other)], moment, shares);
                [0.0; 3]
            };
            self.each_pair(sorted, &mut shares, add, |_, _, _| {});
        });
    }

    fn depends_on_motion(&self) -> bool {
        false
    }
}

impl ForceBetween for LennardJones {
    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn against(&self) -> Option<&[BodyId]> {
        self.against.as_deref()
    }

    fn on_particles(&self, particles: Vec<BodyId>, sources: Vec<BodyId>) -> Arc<dyn Force> {
        Arc::new(LennardJones { bodies: particles, against: Some(sources), ..*self })
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{assert_minus_gradient, bodies, loads};
    use super::*;

    fn gas(count: usize, smooth: bool) -> LennardJones {
        let bodies = (0..count).map(BodyId::new).collect();
        LennardJones { bodies, against: None, epsilon: 1.5, sigma: 0.8, cutoff: 2.0, smooth }
    }

    /// Known values: at r = σ, u = 0 and −u′ = 24 ε/σ. At r = 2^(1/6) σ, u = −ε and −u′ = 0.
    #[test]
    fn two_atoms_by_hand() {
        let force = gas(2, false);
        let (shift, _) = force.shifts();
        let (r, _) = (0.8_f64 / 2.0, ());
        let six = r * r * r * r * r * r;
        assert!((shift - 6.0 * six * (six - 1.0)).abs() < 1e-16, "{shift}");
        let lowest = 0.8 * libm::pow(2.0, 1.0 / 6.0);
        for (distance, potential, push) in
            [(0.8, 0.0, 24.0 * 1.5 / 0.8), (lowest, -1.5, 0.0), (2.0, shift, 0.0)]
        {
            let (model, state) = bodies(&[(DVec3::ZERO, DVec3::ZERO), (distance * DVec3::Y, DVec3::ZERO)]);
            let loads = loads(&force, &model, &state);
            assert!(loads.force[1].abs_diff_eq(push * DVec3::Y, 1e-12), "{loads:?}");
            assert_eq!(loads.force[0], -loads.force[1]);
            let given = force.potential(&Moment { time: 0.0, state: &state, model: &model });
            assert!((given - (potential - shift)).abs() < 1e-12, "{given}");
        }
    }

    /// A lattice of 27 slightly displaced atoms. Some pairs of atoms are farther apart than the cutoff.
    #[test]
    fn the_force_is_minus_the_gradient_and_falls_to_zero_if_it_is_smooth() {
        let place = |i: usize| DVec3::new((i % 3) as f64, (i / 3 % 3) as f64, (i / 9) as f64);
        let jitter = |i: usize| DVec3::splat((i as f64 * 0.618).fract() * 0.1);
        let located: Vec<_> = (0..27).map(|i| (1.1 * place(i) + jitter(i), DVec3::ZERO)).collect();
        let (model, state) = bodies(&located);
        for smooth in [false, true] {
            assert_minus_gradient(&gas(27, smooth), &model, &state);
        }
        let (model, state) = bodies(&[(DVec3::ZERO, DVec3::ZERO), ((2.0 - 1e-9) * DVec3::Y, DVec3::ZERO)]);
        let [step, none] =
            [false, true].map(|smooth| loads(&gas(2, smooth), &model, &state).force[1].length());
        assert!(step > 1e-3 && none < 1e-8, "{step} {none}");
    }

    /// The forces found by cells must equal the sum over all pairs of bodies. With two groups, only pairs of one body from each group
    /// count.
    #[test]
    fn cells_give_the_plain_double_sum() {
        let at = |i: usize, k: f64| (i as f64 * k).fract() * 9.0;
        let located: Vec<_> = (0..300)
            .map(|i| (DVec3::new(at(i, 0.618_033), at(i, 0.414_213), at(i, 0.732_050)), DVec3::ZERO))
            .collect();
        let (model, state) = bodies(&located);
        for split in [None, Some(120)] {
            let ids = |range: Range<usize>| range.map(BodyId::new).collect::<Vec<_>>();
            let mut force = gas(300, false);
            if let Some(split) = split {
                (force.bodies, force.against) = (ids(0..split), Some(ids(split..300)));
            }
            let loads = loads(&force, &model, &state);
            let mut total = DVec3::ZERO;
            for (i, (here, _)) in located.iter().enumerate() {
                let (mut sum, mut magnitude) = (DVec3::ZERO, 0.0);
                for (j, (there, _)) in located.iter().enumerate() {
                    let d = *here - *there;
                    let acts = split.is_none_or(|split| (i < split) != (j < split));
                    if i != j && acts && d.length() < 2.0 {
                        let part = force.pure(d.length_squared()).1 * d;
                        sum += part;
                        magnitude += part.length();
                    }
                }
                assert!((loads.force[i] - sum).length() <= 1e-13 * magnitude, "{i}");
                total += loads.force[i];
            }
            let most = loads.force.iter().map(|force| force.length()).fold(0.0, f64::max);
            assert!(total.length() < 1e-13 * 300.0 * most, "what one gets the other loses: {total}");
        }
    }
}

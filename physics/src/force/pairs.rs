//! Inverse-square forces between all pairs of bodies, such as gravitation and Coulomb's force.

use glam::DVec3;

use super::super::BodyId;
use super::{Loads, Moment, share};

/// The number of bodies in a tile. Two tiles and their sums fit into the first-level cache, and are kept on the stack.
const TILE_SIZE: usize = 128;
/// The largest number of bodies for which tiles are not used. For so few bodies, it takes as long to copy a tile as to visit all pairs.
const MAX_BODIES_WITHOUT_TILES: usize = 16;
/// The number of interactions that are computed side by side, so that the compiler can vectorize the loop.
const LANES: usize = 4;

/// The force and the potential of all pairs of some bodies:
///
/// Fᵢⱼ = c sᵢ sⱼ d / (d² + ε²)^(3/2) on i, with d = xᵢ − xⱼ; Uᵢⱼ = c sᵢ sⱼ / √(d² + ε²).
///
/// With c > 0, strengths s of equal sign repel each other; with c < 0, they attract each other. The softening ε (Plummer's) replaces a
/// point by a small cloud, so that forces stay finite in close encounters. Source: S. J. Aarseth, *Gravitational N-Body Simulations*
/// (2003), 1.2.
///
/// Every pair is visited once, and adds opposite forces to its two bodies. Absent bodies are left out, because two absent bodies may be at
/// the same position. The sums run over tiles, which hold copies of bodies, one list for each coordinate. The order of the sums depends
/// only on the number of bodies.
#[derive(Clone, Copy)]
pub(super) struct Pairs<'a> {
    /// The bodies that act on each other.
    pub(super) bodies: &'a [BodyId],
    /// A second group of bodies. If present, each body acts only on the bodies of the other group.
    pub(super) against: Option<&'a [BodyId]>,
    /// The strength s of every body in the world, such as its mass or its charge.
    pub(super) strength: &'a [f64],
    /// The constant c of the force law; positive if equal signs repel each other.
    pub(super) constant: f64,
    /// The softening length ε, m.
    pub(super) softening: f64,
}

/// Returns the number of pairs within one group of bodies, or between two groups.
pub(super) fn count(bodies: &[BodyId], against: Option<&[BodyId]>) -> u64 {
    let count = bodies.len() as u64;
    match against {
        Some(others) => count.saturating_mul(others.len() as u64),
        None => count.saturating_mul(count.saturating_sub(1)) / 2,
    }
}

impl Pairs<'_> {
    /// Adds the forces of all pairs to the loads of their bodies.
    pub(super) fn apply(&self, moment: &Moment, loads: &mut Loads) {
        if self.against.is_none() && self.bodies.len() <= MAX_BODIES_WITHOUT_TILES {
            return self.apply_to_few(moment, loads);
        }
        let softening = self.softening * self.softening;
        self.each_pair_of_tiles(moment, |first, second, last| {
            match second {
                None => first.attract_itself(softening),
                Some(second) => {
                    first.attract(second, softening);
                    second.add_to(loads, self.constant);
                }
            }
            if last {
                first.add_to(loads, self.constant);
            }
        });
    }

    /// Does the same as [`apply`](Self::apply) for few bodies, without tiles: the same sums in the same order.
    fn apply_to_few(&self, moment: &Moment, loads: &mut Loads) {
        let (bodies, places) = (moment.model.present(self.bodies), moment.state.location.as_slice());
        let softening = self.softening * self.softening;
        let mut pulls = [DVec3::ZERO; MAX_BODIES_WITHOUT_TILES];
        for (j, there) in bodies.iter().map(|body| body.index()).enumerate().skip(1) {
            let (at, strength) = (places[there], self.strength[there]);
            let mut back = DVec3::ZERO;
            for (pull, here) in pulls[..j].iter_mut().zip(bodies.iter().map(|body| body.index())) {
                let d = places[here] - at;
                let square = d.length_squared() + softening;
                let weight = 1.0 / (square * square.sqrt());
                *pull += (strength * weight) * d;
                back -= (self.strength[here] * weight) * d;
            }
            pulls[j] = back;
        }
        moment.model.pair_counter().add(bodies.len() * bodies.len().saturating_sub(1) / 2);
        for (body, pull) in bodies.iter().zip(pulls) {
            loads.force[body.index()] += self.constant * self.strength[body.index()] * pull;
        }
    }

    /// Returns the potential energy of all pairs in which at least one body can move, J.
    pub(super) fn potential(&self, moment: &Moment) -> f64 {
        let softening = self.softening * self.softening;
        let mut sum = 0.0;
        self.each_pair_of_tiles(moment, |first, second, _| {
            sum += match second {
                None => first.potential_of_itself(softening),
                Some(second) => first.potential(second, softening),
            };
        });
        self.constant * sum
    }

    /// Adds the share of each body in the potential energy to `shares`, J.
    pub(super) fn share_potential(&self, moment: &Moment, shares: &mut [f64]) {
        let softening = self.softening * self.softening;
        let mut add = |one: usize, other: usize| {
            let square =
                moment.state.location[one].distance_squared(moment.state.location[other]) + softening;
            let energy = self.constant * self.strength[one] * self.strength[other] / square.sqrt();
            share(energy, [one, other], moment, shares);
        };
        let bodies = moment.model.present(self.bodies);
        let index = |body: &BodyId| body.index();
        for (number, one) in bodies.iter().map(index).enumerate() {
            match self.against {
                None => bodies[number + 1..].iter().map(index).for_each(|other| add(one, other)),
                Some(against) => {
                    moment.model.present(against).iter().map(index).for_each(|other| add(one, other));
                }
            }
        }
    }

    /// With one group, calls `see` for every tile alone, and then for that tile with each later tile. With two groups, calls `see` for
    /// every tile with each tile of the other group. The flag that `see` receives is true at the last call with the same first tile.
    fn each_pair_of_tiles(&self, moment: &Moment, mut see: impl FnMut(&mut Tile, Option<&mut Tile>, bool)) {
        let counter = moment.model.pair_counter();
        let bodies = moment.model.present(self.bodies);
        if let Some(against) = self.against {
            let against = moment.model.present(against);
            for head in bodies.chunks(TILE_SIZE) {
                let mut first = self.tile(head, moment);
                let mut others = against.chunks(TILE_SIZE).peekable();
                while let Some(other) = others.next() {
                    let mut second = self.tile(other, moment);
                    see(&mut first, Some(&mut second), others.peek().is_none());
                    counter.add(first.len() * second.len());
                }
            }
            return;
        }
        let mut rest = &*bodies;
        while !rest.is_empty() {
            let (head, behind) = rest.split_at(TILE_SIZE.min(rest.len()));
            let mut first = self.tile(head, moment);
            see(&mut first, None, behind.is_empty());
            counter.add(first.len() * (first.len() - 1) / 2);
            let mut others = behind.chunks(TILE_SIZE).peekable();
            while let Some(other) = others.next() {
                let mut second = self.tile(other, moment);
                see(&mut first, Some(&mut second), others.peek().is_none());
                counter.add(first.len() * second.len());
            }
            rest = behind;
        }
    }

    fn tile<'b>(&self, bodies: &'b [BodyId], moment: &Moment) -> Tile<'b> {
        let zero = [0.0; TILE_SIZE];
        let mut tile =
            Tile { bodies, at: [zero; 3], strength: zero, movable: [false; TILE_SIZE], pull: [zero; 3] };
        for (k, body) in bodies.iter().enumerate() {
            let i = body.index();
            let location = moment.state.location[i];
            (tile.at[0][k], tile.at[1][k], tile.at[2][k]) = location.into();
            tile.strength[k] = self.strength[i];
            tile.movable[k] = moment.model.movable()[i];
        }
        tile
    }
}

/// Copies of up to [`TILE_SIZE`] bodies, with one array for each coordinate.
struct Tile<'a> {
    bodies: &'a [BodyId],
    at: [[f64; TILE_SIZE]; 3],
    strength: [f64; TILE_SIZE],
    movable: [bool; TILE_SIZE],
    /// The sum Σ sⱼ d / (d² + ε²)^(3/2) for each body, over the bodies j visited so far: one array for each axis.
    pull: [[f64; TILE_SIZE]; 3],
}

impl Tile<'_> {
    fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Adds the interactions of all pairs within this tile.
    fn attract_itself(&mut self, softening: f64) {
        for j in 1..self.len() {
            let (at, strength) = (self.at.map(|at| at[j]), self.strength[j]);
            let mut back = [[0.0]; 3];
            for i in 0..j {
                self.attract_lanes(i, at, strength, softening, &mut back);
            }
            self.pull_back(j, back);
        }
    }

    /// Adds the interactions of all pairs of one body in this tile and one body in `other`.
    fn attract(&mut self, other: &mut Tile<'_>, softening: f64) {
        // For full tiles, the compiler knows the number of lanes. The first tile can be partly filled only if there are two groups.
        let full = if self.len() == TILE_SIZE { TILE_SIZE } else { 0 };
        for j in 0..other.len() {
            let (at, strength) = (other.at.map(|at| at[j]), other.strength[j]);
            let mut back = [[0.0; LANES]; 3];
            for i in (0..full).step_by(LANES) {
                self.attract_lanes(i, at, strength, softening, &mut back);
            }
            other.pull_back(j, back);
            if full == 0 {
                let mut back = [[0.0]; 3];
                for i in 0..self.len() {
                    self.attract_lanes(i, at, strength, softening, &mut back);
                }
                other.pull_back(j, back);
            }
        }
    }

    /// Adds the interactions of `N` bodies of this tile, from index `i` on, with one body at the position `at`. `back` receives the sums
    /// for that body, one for each lane.
    #[inline(always)]
    fn attract_lanes<const N: usize>(
        &mut self,
        i: usize,
        at: [f64; 3],
        strength: f64,
        softening: f64,
        [back_x, back_y, back_z]: &mut [[f64; N]; 3],
    ) {
        for lane in 0..N {
            let k = i + lane;
            let d = [self.at[0][k] - at[0], self.at[1][k] - at[1], self.at[2][k] - at[2]];
            let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + softening;
            let weight = 1.0 / (square * square.sqrt());
            let (here, there) = (strength * weight, self.strength[k] * weight);
            self.pull[0][k] += here * d[0];
            self.pull[1][k] += here * d[1];
            self.pull[2][k] += here * d[2];
            back_x[lane] -= there * d[0];
            back_y[lane] -= there * d[1];
            back_z[lane] -= there * d[2];
        }
    }

    fn pull_back<const N: usize>(&mut self, j: usize, back: [[f64; N]; 3]) {
        for (pull, back) in self.pull.iter_mut().zip(back) {
            pull[j] += back.iter().sum::<f64>();
        }
    }

    fn add_to(&self, loads: &mut Loads, constant: f64) {
        for (k, body) in self.bodies.iter().enumerate() {
            let pull = DVec3::new(self.pull[0][k], self.pull[1][k], self.pull[2][k]);
            loads.force[body.index()] += constant * self.strength[k] * pull;
        }
    }

    /// Returns the sum Σ sᵢ sⱼ / √(d² + ε²) over all pairs within the tile.
    fn potential_of_itself(&self, softening: f64) -> f64 {
        let mut sum = 0.0;
        for j in 1..self.len() {
            sum +=
                self.potential_of(self.at.map(|at| at[j]), self.movable[j], j, softening) * self.strength[j];
        }
        sum
    }

    /// Returns the sum Σ sᵢ sⱼ / √(d² + ε²) over all pairs of one body in this tile and one body in `other`.
    fn potential(&self, other: &Tile<'_>, softening: f64) -> f64 {
        let mut sum = 0.0;
        for j in 0..other.len() {
            let potential =
                self.potential_of(other.at.map(|at| at[j]), other.movable[j], self.len(), softening);
            sum += potential * other.strength[j];
        }
        sum
    }

    /// Returns the sum Σ sᵢ / √(d² + ε²) over the first `bodies` bodies of the tile, where d is the vector from `at` to the body. Pairs in
    /// which neither body can move are left out; `movable` tells whether the body at `at` can.
    #[inline(always)]
    fn potential_of(&self, at: [f64; 3], movable: bool, bodies: usize, softening: f64) -> f64 {
        let mut lanes = [0.0; LANES];
        for i in 0..bodies {
            let d = [self.at[0][i] - at[0], self.at[1][i] - at[1], self.at[2][i] - at[2]];
            let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + softening;
            // Two fixed bodies may be at the same position, where the potential is infinite.
            lanes[i % LANES] +=
                if movable || self.movable[i] { self.strength[i] / square.sqrt() } else { 0.0 };
        }
        lanes.iter().sum()
    }
}

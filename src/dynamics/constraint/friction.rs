//! Coulomb friction: pairs of rows that hold as far as the normal force allows.
//!
//! A pair sticks with c' = 0 and |λ| ≤ μ λₙ, or slides and pushes with μ λₙ against its slip. λₙ depends on which pairs slide, so both
//! are found together. Source: F. Pfeiffer & C. Glocker, *Multibody Dynamics with Unilateral Contacts* (1996), chapter 8.

use glam::DVec2;

use super::super::Loads;
use super::events::PASSED;
use super::modes::{Mode, TOUCHED};
use super::solver::Solver;
use super::structure::Structure;
use super::{Law, jacobian};

/// A slip counts as slow if it is below this multiple of its change by friction in a step.
const SLOWLY: f64 = 2.0;

/// When contact points share friction by their loads, the loads count as at most this factor away from their mean.
const UNLIKE: f64 = 10.0;

/// Two directions are nearly equal if the cosine of their angle is larger than this.
const ABOUT: f64 = 0.99;

/// A restless contact sticks below this fraction of the largest rate.
const RESTING: f64 = 1e-5;

/// Below this fraction of the largest rate, a slip has no usable direction.
pub(super) const SLOW: f64 = 1e-9;

/// Two rows of friction.
#[derive(Clone, Debug)]
pub(super) struct Grip {
    /// The first row; the second follows.
    pub(super) row: usize,
    /// The row whose multiplier bounds it.
    pub(super) normal: usize,
    /// The largest ratio of the friction to the multiplier of `normal`.
    pub(super) coefficient: f64,
    /// The direction in which it pushes while it slides: a unit vector in the plane of its two rows.
    pub(super) push: DVec2,
    /// The direction of the slip at the beginning of the step.
    pub(super) heading: DVec2,
    /// Whether it has just begun to slide, and has no speed yet.
    pub(super) is_beginning: bool,
    /// Whether friction can stop it within the step. It then keeps its direction until it stops; otherwise the slip would turn around
    /// endlessly.
    pub(super) is_slow: bool,
    /// Whether the two bodies also touch at other points.
    pub(super) is_shared: bool,
    /// Whether it must stick at once, since no force fits its slip.
    pub(super) is_caught: bool,
    /// Whether it has changed too often in this step. It then sticks until the end of the step, with any friction that this needs.
    pub(super) is_restless: bool,
    /// The strongest coupling with all friction rows: for its two rows, the larger sum of the absolute values of their entries of A.
    pub(super) stiffness: f64,
    /// The largest change of slips by friction at the last decision, m/s² or rad/s².
    pub(super) strength: f64,
}

impl Grip {
    /// All pairs of a structure with known laws.
    pub(super) fn all(structure: &Structure, laws: &[Law]) -> Vec<Grip> {
        let mut grips = Vec::new();
        for place in &structure.places {
            let mut row = place.row;
            while row < place.row + place.rows {
                if let Law::Friction { coefficient } = laws[row] {
                    let (push, heading) = (DVec2::ZERO, DVec2::ZERO);
                    grips.push(Grip {
                        row,
                        normal: place.row,
                        coefficient,
                        push,
                        heading,
                        is_beginning: false,
                        is_slow: false,
                        is_shared: structure
                            .places
                            .iter()
                            .filter(|other| other.bodies == place.bodies)
                            .count()
                            > 1,
                        is_caught: false,
                        is_restless: false,
                        stiffness: 0.0,
                        strength: 0.0,
                    });
                    row += 1;
                }
                row += 1;
            }
        }
        grips
    }

    /// Whether the slip is so slow that friction would reverse it within a step of `span` seconds, and its direction is nearly the same
    /// as before. If several points share a body, rounding errors of the directions would otherwise grow from step to step.
    fn keeps_heading(&self, slip: DVec2, span: f64) -> bool {
        self.is_shared
            && slip.length() < SLOWLY * self.strength * span
            && slip.dot(self.heading) > ABOUT * slip.length()
    }

    /// Its two values in a list with one value for each row.
    pub(super) fn of(&self, values: &[f64]) -> DVec2 {
        DVec2::new(values[self.row], values[self.row + 1])
    }
}

impl Solver {
    /// Whether any contact slides.
    pub(super) fn slides(&self) -> bool {
        self.grips.iter().any(|grip| self.modes[grip.row] == Mode::Slid)
    }

    /// Updates the slips at the current velocities, and sets friction against them.
    pub(super) fn see_slips(&mut self) {
        if !self.slides() {
            return;
        }
        let mut rates = std::mem::take(&mut self.slips);
        rates.resize(self.rows.len(), 0.0);
        if let Some(structure) = &self.structure {
            jacobian::products(structure, &self.jacobian, &self.members, &mut rates);
        }
        let slow = SLOW * self.largest_rate;
        for grip in self.grips.iter_mut().filter(|grip| self.modes[grip.row] == Mode::Slid) {
            let slip = grip.of(&rates);
            let speed = slip.length();
            // A slip that begins or ends keeps the direction found before. Friction keeps this direction even after the slip ends, so
            // that forces are smooth until the step is repeated up to that moment.
            let goes_on = speed > slow && slip.dot(grip.heading) > 0.0;
            if !grip.is_beginning && !grip.is_slow && !grip.keeps_heading(slip, self.span) {
                grip.push = if goes_on { -slip / speed } else { -grip.heading };
            }
        }
        self.slips = rates;
    }

    /// Stores the directions of sliding at the start of a step.
    pub(super) fn head(&mut self) {
        self.see_slips();
        let slow = SLOW * self.largest_rate;
        for grip in self.grips.iter_mut().filter(|grip| self.modes[grip.row] == Mode::Slid) {
            grip.is_beginning = false;
            let slip = grip.of(&self.slips);
            if slip.length() > slow && !grip.keeps_heading(slip, self.span) {
                grip.heading = slip.normalize();
            }
            grip.push = -grip.heading;
            grip.is_slow = slip.length() < SLOWLY * grip.strength * self.span;
        }
    }

    /// Adds the power of friction to the loads.
    pub(super) fn book_friction(&self, loads: &mut Loads) {
        for grip in self.grips.iter().filter(|grip| self.modes[grip.row] == Mode::Slid) {
            loads.power.friction += grip.of(&self.unknown).dot(grip.of(&self.slips));
        }
    }

    /// Sets the first mode of a pair of rows: it sticks without slip and slides with slip, but only while its normal row holds.
    pub(super) fn take_grip(&mut self, grip: usize, rates: &[f64]) {
        let Grip { row, normal, is_restless, is_caught, .. } = self.grips[grip];
        let slow = if is_restless { RESTING } else { SLOW } * self.largest_rate;
        let slip = self.grips[grip].of(rates);
        let mode = if self.modes[normal] != Mode::Held {
            Mode::Open
        } else if is_caught || slip.length() <= slow {
            Mode::Held
        } else {
            let grip = &mut self.grips[grip];
            grip.heading = slip.normalize();
            (grip.push, grip.is_beginning, grip.is_slow) = (-grip.heading, false, false);
            Mode::Slid
        };
        (self.modes[row], self.modes[row + 1]) = (mode, mode);
    }

    /// Whether closed contacts still move by more than an event tolerates. This motion must then be removed, or sliding would begin in
    /// the wrong direction.
    pub(super) fn still_moves(&self, rates: &[f64]) -> bool {
        let moves = |row: usize, speed: f64, part: f64| {
            self.modes[row] == Mode::Held && speed > part * self.largest_rate
        };
        let grips = &self.grips;
        grips.iter().any(|grip| moves(grip.row, grip.of(rates).length(), PASSED))
            || grips.iter().any(|grip| moves(grip.normal, rates[grip.normal].abs(), TOUCHED))
    }

    /// Makes a sliding contact stick at once if no mode of its normal row is right: Painlevé's paradox. Friction then grows without bound
    /// until the slip ends, as in an impact without restitution. Returns whether there is such a contact. Source: D. E. Stewart, SIAM
    /// Review 42 (2000) 3.
    pub(super) fn catch(&mut self, wrong: usize) -> bool {
        let is_wrong = |grip: &&mut Grip| (grip.normal == wrong || grip.row == wrong) && !grip.is_caught;
        let grip = self.grips.iter_mut().find(is_wrong);
        grip.map(|grip| grip.is_caught = true).is_some()
    }

    fn grip_at(&self, row: usize) -> Option<&Grip> {
        let at = self.grips.binary_search_by_key(&row, |grip| grip.row).ok()?;
        Some(&self.grips[at])
    }

    /// The error of the present mode of a pair, asked by its first row. A sticking pair may need more friction than allowed; a pair that
    /// begins to slide may be pushed along its slip.
    pub(super) fn grip_is_wrong(&self, row: usize, accelerations: &[f64]) -> f64 {
        let Some(grip) = self.grip_at(row).filter(|grip| !grip.is_restless) else { return 0.0 };
        match self.modes[row] {
            Mode::Held => {
                let most = grip.coefficient * self.unknown[grip.normal].max(0.0);
                (grip.of(&self.unknown).length() - most) * self.weight(row)
            }
            Mode::Slid if grip.is_beginning => grip.of(accelerations).dot(grip.push),
            _ => 0.0,
        }
    }

    /// Switches a pair of rows between sticking and sliding.
    pub(super) fn change_grip(&mut self, row: usize) {
        let force = match self.grip_at(row) {
            Some(grip) => grip.of(&self.unknown),
            None => return,
        };
        let mode = if self.modes[row] == Mode::Slid { Mode::Held } else { Mode::Slid };
        if let Ok(at) = self.grips.binary_search_by_key(&row, |grip| grip.row) {
            let grip = &mut self.grips[at];
            grip.push = force.normalize_or_zero();
            (grip.heading, grip.is_beginning) = (-grip.push, true);
        }
        (self.modes[row], self.modes[row + 1]) = (mode, mode);
    }

    /// Weights the friction rows by the last normal forces. Points with larger normal forces then carry more of the
    /// friction, so that all points reach their friction limits together.
    pub(super) fn share_load(&mut self) {
        let loads: Vec<f64> = self.grips.iter().map(|grip| self.unknown[grip.normal].max(0.0)).collect();
        let sum: f64 = loads.iter().sum();
        let weight = |load: f64| (sum / (self.grips.len() as f64 * load)).clamp(1.0 / UNLIKE, UNLIKE);
        let weights = self.grips.iter().zip(&loads).filter(|_| sum > 0.0);
        let weights = weights.flat_map(|(grip, load)| [0, 1].map(|i| (grip.row + i, weight(*load))));
        self.factor.weigh(weights);
    }

    /// Updates the couplings between pairs of rows.
    pub(super) fn see_stiffness(&mut self) {
        let sizes = self.factor.row_sizes(|row| matches!(self.laws[row], Law::Friction { .. }));
        for grip in &mut self.grips {
            grip.stiffness = sizes[grip.row].max(sizes[grip.row + 1]);
        }
    }

    /// Updates the strength of friction.
    pub(super) fn see_strength(&mut self) {
        for i in 0..self.grips.len() {
            let Grip { row, normal, coefficient, .. } = self.grips[i];
            if self.modes[row] == Mode::Slid {
                let grip = &mut self.grips[i];
                grip.strength = coefficient * self.unknown[normal].max(0.0) * grip.stiffness;
            }
        }
    }

    /// Updates all pairs without slip, from their forces and accelerations. Pairs with enough friction stick; the others begin to slide
    /// in the direction of their load. Returns whether anything has changed. Source: P. Alart & A. Curnier, Comput. Methods Appl. Mech.
    /// Eng. 92 (1991) 353, for the criterion.
    pub(super) fn change_grips(&mut self, accelerations: &[f64], slight: f64) -> bool {
        let mut has_changed = false;
        for i in 0..self.grips.len() {
            let Grip { row, normal, coefficient, push, is_beginning, is_restless, .. } = self.grips[i];
            let slips = self.modes[row] == Mode::Slid && !is_beginning;
            if slips || is_restless || self.modes[normal] != Mode::Held {
                continue;
            }
            let weight = self.grips[i].stiffness;
            let most = coefficient * self.unknown[normal].max(0.0);
            let grip = &mut self.grips[i];
            let pulled = grip.of(&self.unknown) - grip.of(accelerations) / weight;
            // A pair at its limit keeps its mode.
            let left = (most - pulled.length()) * weight;
            let is_enough = if self.modes[row] == Mode::Slid { left > slight } else { left >= -slight };
            let mode = if is_enough { Mode::Held } else { Mode::Slid };
            if !is_enough {
                grip.push = pulled.normalize();
                (grip.heading, grip.is_beginning) = (-grip.push, true);
                has_changed |= (grip.push - push).length() * most * weight > slight;
            }
            has_changed |= mode != self.modes[row];
            (self.modes[row], self.modes[row + 1]) = (mode, mode);
        }
        has_changed
    }
}

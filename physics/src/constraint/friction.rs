//! Coulomb friction: pairs of constraint rows whose force is bounded by the normal force.
//!
//! A pair sticks with c' = 0 and |λ| ≤ μ λₙ, or slides and pushes with μ λₙ against its slip velocity. The normal multiplier λₙ depends on
//! which pairs slide, so both are found together. Source: F. Pfeiffer & C. Glocker, *Multibody Dynamics with Unilateral Contacts* (1996),
//! chapter 8.

use glam::DVec2;

use super::super::Loads;
use super::events::VIOLATION_TOLERANCE;
use super::row_modes::{Mode, STOP_TOLERANCE};
use super::solver::Solver;
use super::structure::Structure;
use super::{Law, jacobian};

/// A slip counts as slow if friction could stop it within this number of steps.
const SLOW_SLIP_STEPS: f64 = 2.0;

/// Several contact points share friction in proportion to their normal forces. Each weight differs from the mean by at most this factor.
const MAX_WEIGHT_RATIO: f64 = 10.0;

/// Two directions count as nearly equal if the cosine of the angle between them exceeds this value.
const PARALLEL_COSINE: f64 = 0.99;

/// A slip counts as zero if its speed is below this fraction of the largest rate. It then has no usable direction.
pub(super) const SLIP_TOLERANCE: f64 = 1e-9;

/// The two friction rows of a contact, one per tangent, and their state. Rolling friction has a pair of its own.
#[derive(Clone, Debug)]
pub(super) struct FrictionPair {
    /// The index of the first friction row. The second row follows it.
    pub(super) row: usize,
    /// The index of the normal row, whose multiplier bounds the friction.
    pub(super) normal: usize,
    /// The coefficient of friction: the largest ratio of the friction to the normal multiplier.
    pub(super) coefficient: f64,
    /// The direction of the friction force while the contact slides: a unit vector in the basis of the two tangents.
    pub(super) push: DVec2,
    /// The direction of the slip velocity at the beginning of the step, a unit vector in the basis of the two tangents.
    pub(super) heading: DVec2,
    /// True if the contact has just begun to slide, and its slip velocity is still zero.
    pub(super) is_beginning: bool,
    /// True if friction can stop the slip within [`SLOW_SLIP_STEPS`] steps. The friction then keeps its direction until the slip ends. If
    /// it turned with the slip, the slip would change its sign endlessly.
    pub(super) is_slow: bool,
    /// True if the two bodies also touch at other contact points.
    pub(super) is_shared: bool,
    /// True if the contact must stick at once, because no sliding force is consistent with its slip.
    pub(super) is_caught: bool,
    /// The strongest coupling of this pair with all friction rows: the sum of the norms of its 2 × 2 blocks in A = J M⁻¹ Jᵀ.
    pub(super) stiffness: f64,
    /// The largest acceleration of slip velocities by this contact's friction at the last decision of modes, m/s² or rad/s².
    pub(super) strength: f64,
}

impl FrictionPair {
    /// Creates the pairs of friction rows for a layout of constraints. `laws` holds the law of each row.
    pub(super) fn all(structure: &Structure, laws: &[Law]) -> Vec<FrictionPair> {
        let mut grips = Vec::new();
        for place in &structure.places {
            let mut row = place.row;
            while row < place.row + place.rows {
                if let Law::Friction { coefficient } = laws[row] {
                    let (push, heading) = (DVec2::ZERO, DVec2::ZERO);
                    grips.push(FrictionPair {
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

    /// Returns true if the friction keeps its previous direction: the bodies touch at several points, friction could stop the slip within
    /// [`SLOW_SLIP_STEPS`] steps of `span` seconds, and the slip's direction has hardly changed. Rounding errors of the directions would
    /// otherwise grow from step to step.
    fn keeps_heading(&self, slip: DVec2, span: f64) -> bool {
        self.is_shared
            && slip.length() < SLOW_SLIP_STEPS * self.strength * span
            && slip.dot(self.heading) > PARALLEL_COSINE * slip.length()
    }

    /// Returns the two entries that belong to this pair of friction rows, from a list with one value per constraint row.
    pub(super) fn of(&self, values: &[f64]) -> DVec2 {
        DVec2::new(values[self.row], values[self.row + 1])
    }
}

impl Solver {
    /// Returns true if any contact slides.
    pub(super) fn slides(&self) -> bool {
        self.grips.iter().any(|grip| self.modes[grip.row] == Mode::Slid)
    }

    /// Computes the slip velocities of sliding contacts, and turns their friction against the slip.
    pub(super) fn see_slips(&mut self) {
        if !self.slides() {
            return;
        }
        let mut rates = std::mem::take(&mut self.slips);
        rates.resize(self.rows.len(), 0.0);
        if let Some(structure) = &self.structure {
            jacobian::products(structure, &self.jacobian, &self.members, &mut rates);
        }
        let length = self.structure.as_ref().map_or(1.0, |structure| structure.length);
        for grip in self.grips.iter_mut().filter(|grip| self.modes[grip.row] == Mode::Slid) {
            let unit = if self.rows[grip.row].scale.is_length { 1.0 } else { length.recip() };
            let slow = SLIP_TOLERANCE * self.largest_rate * unit;
            let slip = grip.of(&rates);
            let speed = slip.length();
            // A contact whose slip begins or ends keeps the friction direction found before, even after the slip has ended. The forces then
            // stay smooth until the step is repeated up to the moment at which the slip begins or ends.
            let goes_on = speed > slow && slip.dot(grip.heading) > 0.0;
            if !grip.is_beginning && !grip.is_slow && !grip.keeps_heading(slip, self.span) {
                grip.push = if goes_on { -slip / speed } else { -grip.heading };
            }
        }
        self.slips = rates;
    }

    /// Computes the slip velocities of sliding contacts as [`see_slips`](Self::see_slips) does, without velocities that violate the active
    /// constraint rows of a mechanism. The equations must be measured and factorized. Within a step, velocities are predictions: they would
    /// let parts of a rigid mechanism slip on each other, and friction would seem to do work there.
    pub(super) fn see_slips_that_constraints_allow(&mut self) {
        if self.joints() == 0 || !self.slides() {
            self.see_slips();
            return;
        }
        let predicted = self.members.clone();
        if let Solver { structure: Some(structure), members, jacobian, unknown, rows, .. } = self {
            jacobian::rates(structure, jacobian, members, rows, unknown);
        }
        self.unknown.iter_mut().for_each(|rate| *rate = -*rate);
        self.solve();
        if let Solver { structure: Some(structure), members, jacobian, unknown, .. } = self {
            jacobian::move_members(structure, jacobian, unknown, members);
        }
        self.see_slips();
        self.members = predicted;
    }

    /// Stores the slip direction of each sliding contact at the start of a step.
    pub(super) fn head(&mut self) {
        self.see_slips();
        let length = self.structure.as_ref().map_or(1.0, |structure| structure.length);
        for grip in self.grips.iter_mut().filter(|grip| self.modes[grip.row] == Mode::Slid) {
            let unit = if self.rows[grip.row].scale.is_length { 1.0 } else { length.recip() };
            let slow = SLIP_TOLERANCE * self.largest_rate * unit;
            grip.is_beginning = false;
            let slip = grip.of(&self.slips);
            if slip.length() > slow && !grip.keeps_heading(slip, self.span) {
                grip.heading = slip.normalize();
            }
            grip.push = -grip.heading;
            grip.is_slow = slip.length() < SLOW_SLIP_STEPS * grip.strength * self.span;
        }
    }

    /// Adds the power of sliding friction to the loads, W.
    pub(super) fn book_friction(&self, loads: &mut Loads) {
        for grip in self.grips.iter().filter(|grip| self.modes[grip.row] == Mode::Slid) {
            loads.power.friction += grip.of(&self.unknown).dot(grip.of(&self.slips));
        }
    }

    /// Sets the initial mode of a pair of friction rows: open if the normal row is not held; otherwise sticking if the slip velocity is
    /// zero, and sliding if not.
    pub(super) fn take_grip(&mut self, grip: usize, rates: &[f64]) {
        let FrictionPair { row, normal, is_caught, .. } = self.grips[grip];
        let slow = SLIP_TOLERANCE * self.largest_rate * self.unit(row);
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

    /// Returns true if a held contact still has a normal rate or slip that exceeds the tolerance of events. This motion must be removed;
    /// otherwise sliding would begin in the wrong direction.
    pub(super) fn still_moves(&self, rates: &[f64]) -> bool {
        let moves = |row: usize, speed: f64, part: f64| {
            self.modes[row] == Mode::Held && speed > part * self.largest_rate * self.unit(row)
        };
        let grips = &self.grips;
        grips.iter().any(|grip| moves(grip.row, grip.of(rates).length(), VIOLATION_TOLERANCE))
            || grips.iter().any(|grip| moves(grip.normal, rates[grip.normal].abs(), STOP_TOLERANCE))
    }

    /// Makes a sliding contact stick at once if no mode of its constraint row `wrong` is consistent (Painlevé's paradox). Friction then
    /// grows without bound until the slip ends, as in an impact without restitution. Returns true if such a contact was found. Source: D.
    /// E. Stewart, SIAM Review 42 (2000) 3.
    pub(super) fn catch(&mut self, wrong: usize) -> bool {
        let is_wrong =
            |grip: &&mut FrictionPair| (grip.normal == wrong || grip.row == wrong) && !grip.is_caught;
        let grip = self.grips.iter_mut().find(is_wrong);
        grip.map(|grip| grip.is_caught = true).is_some()
    }

    /// Weights the softness of friction rows by the last normal forces. Contact points with larger normal forces then carry more of the
    /// friction, and all points reach their friction limits together.
    pub(super) fn share_load(&mut self) {
        let loads: Vec<f64> = self.grips.iter().map(|grip| self.unknown[grip.normal].max(0.0)).collect();
        let sum: f64 = loads.iter().sum();
        let weight = |load: f64| {
            (sum / (self.grips.len() as f64 * load)).clamp(1.0 / MAX_WEIGHT_RATIO, MAX_WEIGHT_RATIO)
        };
        let weights = self.grips.iter().zip(&loads).filter(|_| sum > 0.0);
        let weights = weights.flat_map(|(grip, load)| [0, 1].map(|i| (grip.row + i, weight(*load))));
        self.factor.weigh(weights);
    }

    /// Computes the `stiffness` of each pair of friction rows: its strongest coupling with all friction rows.
    pub(super) fn see_stiffness(&mut self) {
        let pairs: Vec<_> = self.grips.iter().map(|grip| (grip.row, self.unit(grip.row))).collect();
        let sizes = self.factor.pair_sizes(&pairs);
        self.grips.iter_mut().zip(sizes).for_each(|(grip, size)| grip.stiffness = size);
    }

    /// Computes the `strength` of each sliding pair: the largest change of slip velocities by its friction.
    pub(super) fn see_strength(&mut self) {
        for i in 0..self.grips.len() {
            let FrictionPair { row, normal, coefficient, .. } = self.grips[i];
            if self.modes[row] == Mode::Slid {
                let grip = &mut self.grips[i];
                grip.strength = coefficient * self.unknown[normal].max(0.0) * grip.stiffness;
            }
        }
    }
}

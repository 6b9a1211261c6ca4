//! Coulomb friction: pairs of rows that hold as far as the normal force lets them.
//!
//! A pair sticks, with c' = 0 and |λ| ≤ μ λₙ, or slides and pushes with μ λₙ against its slip. λₙ depends on what slides, so both
//! are found together. Source: F. Pfeiffer & C. Glocker, *Multibody Dynamics with Unilateral Contacts* (1996), chapter 8.

use glam::DVec2;

use super::super::Loads;
use super::events::PASSED;
use super::modes::{Mode, TOUCHED};
use super::solver::Solver;
use super::structure::Structure;
use super::{Law, jacobian};

/// What slides slower than so many times what friction changes in a step slides slowly.
const SLOWLY: f64 = 2.0;

/// The loads of places may be so many times more or less than their mean for friction to be shared accordingly.
const UNLIKE: f64 = 10.0;

/// Directions are about the same where the cosine of their angle is larger.
const ABOUT: f64 = 0.99;

/// What is restless sticks below this part of the largest rate.
const RESTING: f64 = 1e-5;

/// A slip below this part of the largest rate has no direction of its own.
pub(super) const SLOW: f64 = 1e-9;

/// Two rows that hold by friction.
#[derive(Clone, Debug)]
pub(super) struct Grip {
    /// Its first row; the second one follows.
    pub(super) row: usize,
    /// The row whose multiplier bounds it.
    pub(super) normal: usize,
    /// The largest ratio of the two.
    pub(super) coefficient: f64,
    /// Where it pushes while it slides: a unit vector in its two rows.
    pub(super) push: DVec2,
    /// The direction of the slip at the beginning of the step.
    pub(super) heading: DVec2,
    /// Whether it has just begun to slide, and does not yet move.
    pub(super) is_beginning: bool,
    /// Whether friction can stop it within the step. Its direction is kept until then, or it would turn and not end.
    pub(super) is_slow: bool,
    /// Whether the two bodies touch at other places as well.
    pub(super) is_shared: bool,
    /// Whether it is caught at once, since no force fits its slip.
    pub(super) is_caught: bool,
    /// Whether it has changed too often in the present step: it sticks then until the end, whatever friction that takes.
    pub(super) is_restless: bool,
    /// How much all pairs of rows change each other at most: the largest sum of the sizes of the entries of A between one of its rows
    /// and all of friction.
    pub(super) stiffness: f64,
    /// By how much friction could change slips, m/s² or rad/s², when it was decided last.
    pub(super) strength: f64,
}

impl Grip {
    /// All of a structure, whose laws are known.
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

    /// Whether it slides so slowly, in about the same direction as before, that friction would turn the slip around within a step of
    /// `span` seconds. Where several places share a body, what rounding makes of the directions would then grow from step to step.
    fn keeps_heading(&self, slip: DVec2, span: f64) -> bool {
        self.is_shared
            && slip.length() < SLOWLY * self.strength * span
            && slip.dot(self.heading) > ABOUT * slip.length()
    }

    /// Its part of a list with one value for each row.
    pub(super) fn of(&self, values: &[f64]) -> DVec2 {
        DVec2::new(values[self.row], values[self.row + 1])
    }
}

impl Solver {
    /// Whether some contact slides.
    pub(super) fn slides(&self) -> bool {
        self.grips.iter().any(|grip| self.modes[grip.row] == Mode::Slid)
    }

    /// Notes how contacts slide at the present velocities: friction pushes against it.
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
            // Where a slip only begins or ends, it goes where it was found to go. Once it is over, that goes on until the step is
            // made anew up to there, so that forces are smooth in it.
            let goes_on = speed > slow && slip.dot(grip.heading) > 0.0;
            if !grip.is_beginning && !grip.is_slow && !grip.keeps_heading(slip, self.span) {
                grip.push = if goes_on { -slip / speed } else { -grip.heading };
            }
        }
        self.slips = rates;
    }

    /// Notes, at the beginning of a step, where contacts slide.
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

    /// Sets what a pair of rows does first: it sticks where it does not slip, and slides where it does, as long as its normal row
    /// holds.
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

    /// Whether contacts that hold still move by more than an event tolerates: that is to be taken out then, or what begins to slide would
    /// go the wrong way.
    pub(super) fn still_moves(&self, rates: &[f64]) -> bool {
        let moves = |row: usize, speed: f64, part: f64| {
            self.modes[row] == Mode::Held && speed > part * self.largest_rate
        };
        let grips = &self.grips;
        grips.iter().any(|grip| moves(grip.row, grip.of(rates).length(), PASSED))
            || grips.iter().any(|grip| moves(grip.normal, rates[grip.normal].abs(), TOUCHED))
    }

    /// Lets a contact stick at once that slides, but whose normal row is wrong whatever it does: that is Painlevé's paradox. Friction grows
    /// without end then, until the slip is over, as in an impact without restitution. Returns whether there is such a contact. Source:
    /// D. E. Stewart, SIAM Review 42 (2000) 3.
    pub(super) fn catch(&mut self, wrong: usize) -> bool {
        let is_wrong = |grip: &&mut Grip| (grip.normal == wrong || grip.row == wrong) && !grip.is_caught;
        let grip = self.grips.iter_mut().find(is_wrong);
        grip.map(|grip| grip.is_caught = true).is_some()
    }

    fn grip_at(&self, row: usize) -> Option<&Grip> {
        let at = self.grips.binary_search_by_key(&row, |grip| grip.row).ok()?;
        Some(&self.grips[at])
    }

    /// By how much what a pair of rows does is wrong, at its first row: it sticks and would need more friction than there is, or it
    /// begins to slide and is pushed along.
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

    /// Lets a pair of rows that sticks slide, and the other way round.
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

    /// Lets places where bodies press harder take more of what friction has to hold: all reach their limits together. The normal forces
    /// are those that were found last.
    pub(super) fn share_load(&mut self) {
        let loads: Vec<f64> = self.grips.iter().map(|grip| self.unknown[grip.normal].max(0.0)).collect();
        let sum: f64 = loads.iter().sum();
        let weight = |load: f64| (sum / (self.grips.len() as f64 * load)).clamp(1.0 / UNLIKE, UNLIKE);
        let weights = self.grips.iter().zip(&loads).filter(|_| sum > 0.0);
        let weights = weights.flat_map(|(grip, load)| [0, 1].map(|i| (grip.row + i, weight(*load))));
        self.factor.weigh(weights);
    }

    /// Notes how much pairs of rows change each other.
    pub(super) fn see_stiffness(&mut self) {
        let sizes = self.factor.row_sizes(|row| matches!(self.laws[row], Law::Friction { .. }));
        for grip in &mut self.grips {
            grip.stiffness = sizes[grip.row].max(sizes[grip.row + 1]);
        }
    }

    /// Notes how strong friction is.
    pub(super) fn see_strength(&mut self) {
        for i in 0..self.grips.len() {
            let Grip { row, normal, coefficient, .. } = self.grips[i];
            if self.modes[row] == Mode::Slid {
                let grip = &mut self.grips[i];
                grip.strength = coefficient * self.unknown[normal].max(0.0) * grip.stiffness;
            }
        }
    }

    /// Changes all pairs of rows that do not slip yet, by what they push and how they accelerate: those stick for which the friction
    /// is enough, and the others begin to slide where they are pulled. Returns whether something has changed. Source: P. Alart &
    /// A. Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353, for the criterion.
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
            // What is at the limit stays what it is.
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

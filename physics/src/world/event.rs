//! The events that end a piece of a step, and the limits on their number.

use std::collections::BTreeMap;

/// The largest number of mode changes of constraint rows within a step. More of them count as endless.
const MAX_CHANGES_PER_STEP: u32 = 10_000;

/// The largest number of impacts within a step. More of them count as endless. Two colliding blocks whose number of impacts gives π to
/// seven digits have fewer impacts, nearly all of them in one step.
const MAX_IMPACTS_PER_STEP: u32 = 4_000_000;

/// After more consecutive events at the same instant than this, or more consecutive quick mode changes, Moreau's scheme advances their
/// bodies until the end of the step.
const EVENTS_BEFORE_MOREAU: u32 = 10;

/// A mode change counts as quick if the piece before it is at most as long as this fraction of the remaining step.
const QUICK_CHANGE_FRACTION: f64 = 1e-4;

/// After more mode changes than this within a step, Moreau's scheme advances their bodies until the end of the step.
const CHANGES_BEFORE_MOREAU: u32 = 100;

/// After more mode changes than this at the contacts of two bodies within a step, Moreau's scheme advances these bodies until the end of
/// the step.
const PAIR_CHANGES_BEFORE_MOREAU: u32 = 6;

/// The largest number of consecutive events at the same instant. More of them count as endless, since each event already resolves all
/// impacts of its instant.
const MAX_EVENTS_PER_INSTANT: u32 = 1_000;

/// An event that ends a piece of a time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Event {
    /// A constraint row, given by its index, changes its mode: a rope becomes taut, a contact opens, a contact begins to slide.
    Row(usize),
    /// Two bodies, given by their indices, touch.
    Touch([usize; 2]),
}

/// Counts of the events within a step.
#[derive(Default)]
pub(super) struct Counts {
    changes: u32,
    /// For each two bodies, the number of mode changes at their contacts.
    of_pairs: BTreeMap<[usize; 2], u32>,
    impacts: u32,
    /// The number of consecutive events at the same instant.
    at_once: u32,
    /// The number of consecutive mode changes that follow each other quickly.
    quick: u32,
}

impl Counts {
    /// Returns true if so many events have happened that the bodies of this event should be advanced by Moreau's scheme.
    pub(super) fn is_crowded(&self, event: Event) -> bool {
        self.at_once > EVENTS_BEFORE_MOREAU
            || (matches!(event, Event::Row(_))
                && (self.changes > CHANGES_BEFORE_MOREAU || self.quick > EVENTS_BEFORE_MOREAU))
    }

    /// Counts a mode change at the contacts of two bodies. Returns true if there are so many that the bodies should be advanced by Moreau's
    /// scheme.
    pub(super) fn are_restless(&mut self, bodies: [usize; 2]) -> bool {
        let changes = self.of_pairs.entry(bodies).or_default();
        *changes += 1;
        *changes > PAIR_CHANGES_BEFORE_MOREAU
    }

    /// Counts an event at the end of a piece of `length` seconds, with `left` seconds of the step remaining. `is_idle` marks a touch
    /// without an impact. Returns true if there are endlessly many events.
    pub(super) fn are_too_many(&mut self, event: Event, length: f64, left: f64, is_idle: bool) -> bool {
        let is_at_once = length == 0.0 || (is_idle && length <= QUICK_CHANGE_FRACTION * left);
        self.at_once = if is_at_once { self.at_once + 1 } else { 0 };
        match event {
            Event::Row(_) => {
                self.changes += 1;
                self.quick = if length > QUICK_CHANGE_FRACTION * left { 0 } else { self.quick + 1 };
            }
            Event::Touch(_) => self.impacts += 1,
        }
        self.changes > MAX_CHANGES_PER_STEP
            || self.impacts > MAX_IMPACTS_PER_STEP
            || self.at_once > MAX_EVENTS_PER_INSTANT
    }
}

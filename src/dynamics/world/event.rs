//! The events that end a piece of a step, and limits on their number.

/// With this many changes of constraints within a step, they count as endless.
const CHANGES: u32 = 10_000;

/// With this many impacts within a step, they count as endless. The impacts that compute π to seven digits are fewer, nearly all in one
/// step.
const IMPACTS: u32 = 4_000_000;

/// After this many events at the same instant, their bodies are advanced by time-stepping until the end of the step.
const STAY: u32 = 10;

/// A change counts as quick if it follows within this fraction of the rest of the step.
const QUICK: f64 = 1e-4;

/// After this many changes within a step, their bodies are advanced by time-stepping as well.
const MANY: u32 = 100;

/// With this many events at the same instant, they count as endless: each settles all touches of that instant.
const AT_ONCE: u32 = 1_000;

/// An event that ends a piece of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Event {
    /// A row of the constraints changes its mode.
    Row(usize),
    /// Two bodies touch.
    Touch([usize; 2]),
}

/// The numbers of events within a step.
#[derive(Default)]
pub(super) struct Counts {
    changes: u32,
    impacts: u32,
    /// Consecutive events at the same instant.
    at_once: u32,
    /// Consecutive quick changes.
    quick: u32,
}

impl Counts {
    /// Whether there were so many events that they are no longer followed one by one.
    pub(super) fn is_crowded(&self, event: Event) -> bool {
        self.at_once > STAY || (matches!(event, Event::Row(_)) && (self.changes > MANY || self.quick > STAY))
    }

    /// Counts an event at the end of a piece of the given length, s. Returns whether there are too many. `is_idle` marks a touch without
    /// an impact.
    pub(super) fn are_too_many(&mut self, event: Event, length: f64, left: f64, is_idle: bool) -> bool {
        let is_at_once = length == 0.0 || (is_idle && length <= QUICK * left);
        self.at_once = if is_at_once { self.at_once + 1 } else { 0 };
        match event {
            Event::Row(_) => {
                self.changes += 1;
                self.quick = if length > QUICK * left { 0 } else { self.quick + 1 };
            }
            Event::Touch(_) => self.impacts += 1,
        }
        self.changes > CHANGES || self.impacts > IMPACTS || self.at_once > AT_ONCE
    }
}

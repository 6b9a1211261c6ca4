//! What ends a piece of a step, and how often that may be.

/// So many changes of constraints within a step mean that they do not end.
const CHANGES: u32 = 10_000;

/// So many impacts within a step mean the same. The impacts that spell π to seven digits are fewer, nearly all in one step.
const IMPACTS: u32 = 4_000_000;

/// After so many at the same instant, what touches or changes again is advanced by time-stepping until the end of the step.
const STAY: u32 = 10;

/// Changes follow each other in next to no time where that is below this part of the rest of the step.
const QUICK: f64 = 1e-4;

/// After so many changes within a step, what changes is advanced by time-stepping as well.
const MANY: u32 = 100;

/// So many events at the same instant mean the same: each settles what touches then.
const AT_ONCE: u32 = 1_000;

/// What ends a piece of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Event {
    /// A row of the constraints changes what it does.
    Row(usize),
    /// Two bodies touch.
    Touch([usize; 2]),
}

/// How many events there have been within a step.
#[derive(Default)]
pub(super) struct Counts {
    changes: u32,
    impacts: u32,
    /// Those one after another at the same instant.
    at_once: u32,
    /// Changes one after another in next to no time.
    quick: u32,
}

impl Counts {
    /// Whether there have been so many that they are followed no longer one by one.
    pub(super) fn is_crowded(&self, event: Event) -> bool {
        self.at_once > STAY || (matches!(event, Event::Row(_)) && (self.changes > MANY || self.quick > STAY))
    }

    /// Counts one more, at the end of a piece that has been so long, s, and says whether that is too many.
    /// `is_idle` is a touch that struck nothing.
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

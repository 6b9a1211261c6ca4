//! The presence of bodies in time: their births and deaths.
//!
//! While a body is absent, it has no mass, charge or inertia, and rests (`model/away.rs`). Most forces need not check this; forces that
//! depend on positions (springs, pairs) do. A list holds the times at which bodies appear and disappear. Each of these times ends a step.
//! The accounts include the energy that the body adds or removes, so it does not count as drift.
//!
//! If the motion of all bodies is given, there are no steps, and a step for each appearance would make n bodies cost n². Bodies then appear
//! and disappear at the end of an interval, and moments within it are computed on a copy of the world.

use std::sync::Arc;

/// The times at which a body is present: always, or during some closed intervals.
///
/// An absent body does not move, has no energy and no momentum, and neither exerts nor feels forces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Presence(Option<Arc<[[f64; 2]]>>);

impl Presence {
    /// The presence of a body that exists at all times.
    pub const ALWAYS: Presence = Presence(None);

    /// Creates the presence during these intervals (s). The intervals are in ascending order and do not touch each other.
    #[must_use]
    pub fn during(intervals: &[[f64; 2]]) -> Presence {
        if let [[start, end]] = *intervals
            && start == f64::NEG_INFINITY
            && end == f64::INFINITY
        {
            return Presence::ALWAYS;
        }
        Presence(Some(intervals.into()))
    }

    /// Returns true if the body is present at all times.
    #[must_use]
    pub fn is_always(&self) -> bool {
        self.0.is_none()
    }

    /// Returns the intervals in which the body is present, s.
    #[must_use]
    pub fn intervals(&self) -> &[[f64; 2]] {
        self.0.as_deref().unwrap_or(&[[f64::NEG_INFINITY, f64::INFINITY]])
    }

    /// Returns true if the body is present at time `t`, s.
    #[must_use]
    pub fn at(&self, t: f64) -> bool {
        let Some(intervals) = &self.0 else { return true };
        let begun = intervals.partition_point(|[start, _]| *start <= t);
        begun > 0 && t <= intervals[begun - 1][1]
    }

    /// Returns true if the body is present at some time from `start` to `end`, s.
    #[must_use]
    pub fn overlaps(&self, start: f64, end: f64) -> bool {
        self.intervals().iter().any(|[from, to]| *from <= end && start <= *to)
    }

    /// Returns the first time from `t` on at which the body is present, s. `None` if it is absent from then on.
    #[must_use]
    pub fn first_from(&self, t: f64) -> Option<f64> {
        let mut ahead = self.intervals().iter().filter(|[_, end]| *end >= t);
        ahead.next().map(|[start, _]| start.max(t))
    }

    /// Returns the intersection of two presences: the times that belong to both.
    #[must_use]
    pub fn and(&self, other: &Presence) -> Presence {
        match (&self.0, &other.0) {
            (None, _) => other.clone(),
            (_, None) => self.clone(),
            (Some(_), Some(_)) => {
                let mut both = Vec::new();
                for [start, end] in self.intervals() {
                    let within = other.intervals().iter().filter(|[from, to]| from <= end && start <= to);
                    both.extend(within.map(|[from, to]| [start.max(*from), end.min(*to)]));
                }
                Presence::during(&both)
            }
        }
    }
}

/// A change of a body's presence. At equal times, births are ordered before deaths, so a body whose interval is a single moment is present
/// at this moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum PresenceChange {
    Birth,
    Death,
}

/// The birth or death of a body at a given time.
#[derive(Clone, Copy, Debug)]
struct Event {
    time: f64,
    change: PresenceChange,
    body: usize,
}

/// The schedule of the births and deaths of all bodies in a run.
#[derive(Clone, Default)]
pub(super) struct PresenceSchedule {
    /// The births and deaths. They are in order of time if `is_sorted` is true.
    events: Vec<Event>,
    /// The number of events at the beginning of the list that have already happened.
    over: usize,
    is_sorted: bool,
}

/// An interval of time without births or deaths, with the requested moments in it.
pub(super) struct Leg<'a> {
    /// The time at which the interval ends, s.
    pub(super) end: f64,
    /// The requested moments before the end of the interval, s.
    pub(super) within: &'a [f64],
    /// The requested moments at the end of the interval, s. At this time, newborn bodies are already present, and dying bodies are still
    /// present.
    pub(super) at_end: &'a [f64],
    /// The requested moments after the interval, s.
    pub(super) later: &'a [f64],
}

impl PresenceSchedule {
    /// Schedules the births and deaths of a body after time `t`, s. Returns true if the body is present at `t`.
    pub(super) fn note(&mut self, body: usize, presence: &Presence, t: f64) -> bool {
        self.events.drain(..std::mem::take(&mut self.over));
        self.is_sorted = false;
        for &[start, end] in presence.intervals() {
            for (time, change) in [(start, PresenceChange::Birth), (end, PresenceChange::Death)] {
                // A death at time `t` itself lies ahead: at `t`, the body is still present.
                if time > t && time < f64::INFINITY || time == t && change == PresenceChange::Death {
                    self.events.push(Event { time, change, body });
                }
            }
        }
        presence.at(t)
    }

    /// Returns the time of the next birth or death, s. `None` if no more are scheduled.
    pub(super) fn next(&mut self) -> Option<f64> {
        self.sort();
        self.events.get(self.over).map(|event| event.time)
    }

    /// Returns the interval up to the next birth or death, or up to `t` if that is earlier. `moments` are the requested times (s), in
    /// ascending order.
    pub(super) fn leg<'a>(&mut self, t: f64, moments: &'a [f64]) -> Leg<'a> {
        let end = self.next().map_or(t, |next| next.min(t));
        let (within, rest) = moments.split_at(moments.partition_point(|&moment| moment < end));
        let (at_end, later) = rest.split_at(rest.partition_point(|&moment| moment <= end));
        Leg { end, within, at_end, later }
    }

    /// Returns the changes of presence that take effect when time `t` (s) is reached, and marks them as past. A body born at `t` is then
    /// present, and a body that dies at `t` is still present. Each change holds the index of the body and its new presence.
    pub(super) fn arrive(&mut self, t: f64) -> Vec<(usize, bool)> {
        self.pass(|event| event.time < t || event.time == t && event.change == PresenceChange::Birth)
    }

    /// Returns the changes of presence that take effect when time continues from `t` (s), and marks them as past. A body that dies at `t`
    /// is then absent.
    pub(super) fn depart(&mut self, t: f64) -> Vec<(usize, bool)> {
        self.pass(|event| event.time <= t)
    }

    fn pass(&mut self, is_over: impl Fn(&Event) -> bool) -> Vec<(usize, bool)> {
        self.sort();
        let begin = self.over;
        self.over += self.events[begin..].iter().take_while(|event| is_over(event)).count();
        self.events[begin..self.over]
            .iter()
            .map(|event| (event.body, event.change == PresenceChange::Birth))
            .collect()
    }

    fn sort(&mut self) {
        if !std::mem::replace(&mut self.is_sorted, true) {
            let order = |event: &Event| (event.change, event.body);
            self.events.sort_by(|a, b| a.time.total_cmp(&b.time).then(order(a).cmp(&order(b))));
        }
    }
}

/// Functions for the checkpoints of the engine for time-stepping.
#[cfg(all(feature = "checkpoints", feature = "time-stepping"))]
impl PresenceSchedule {
    /// Returns the number of births and deaths that have already happened.
    pub(super) fn over(&self) -> usize {
        self.over
    }

    /// Sets the number of births and deaths that have already happened, when a checkpoint is resumed.
    pub(super) fn set_over(&mut self, over: usize) {
        self.sort();
        self.over = over.min(self.events.len());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_belong_to_an_interval() {
        let presence = Presence::during(&[[0.5, 1.0], [2.0, 2.0], [3.0, f64::INFINITY]]);
        for (t, there) in
            [(0.4, false), (0.5, true), (1.0, true), (1.1, false), (2.0, true), (2.5, false), (9.0, true)]
        {
            assert_eq!(presence.at(t), there, "{t}");
        }
        assert_eq!(presence.first_from(0.0), Some(0.5));
        assert_eq!(presence.first_from(0.7), Some(0.7));
        assert_eq!(presence.first_from(1.5), Some(2.0));
        assert!(presence.overlaps(0.0, 0.5) && !presence.overlaps(1.2, 1.8) && presence.overlaps(1.2, 2.1));
        assert!(Presence::ALWAYS.at(-1e9) && Presence::ALWAYS.overlaps(0.0, 0.0));
        assert_eq!(Presence::during(&[]).first_from(0.0), None);
    }

    #[test]
    fn two_presences_together_are_what_they_share() {
        let file = Presence::during(&[[0.0, 1.0], [2.0, 3.0]]);
        let keys = Presence::during(&[[0.5, 2.5]]);
        assert_eq!(file.and(&keys), Presence::during(&[[0.5, 1.0], [2.0, 2.5]]));
        assert_eq!(keys.and(&file), file.and(&keys));
        assert_eq!(Presence::ALWAYS.and(&keys), keys);
        assert_eq!(keys.and(&Presence::ALWAYS), keys);
    }

    #[test]
    fn at_one_time_births_come_on_arrival_and_deaths_on_departure() {
        let mut calendar = PresenceSchedule::default();
        assert!(calendar.note(0, &Presence::during(&[[-1.0, 1.0]]), 0.0));
        assert!(!calendar.note(1, &Presence::during(&[[1.0, 1.0], [2.0, 3.0]]), 0.0));
        assert_eq!(calendar.next(), Some(1.0));
        assert_eq!(calendar.arrive(1.0), [(1, true)]);
        assert_eq!(calendar.depart(1.0), [(0, false), (1, false)]);
        // Several changes since the last call are returned together.
        assert_eq!(calendar.arrive(9.0), [(1, true), (1, false)]);
        assert_eq!(calendar.next(), None);
    }
}

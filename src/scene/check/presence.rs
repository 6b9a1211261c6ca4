//! Reads the times at which a body is present, from its keys `start` and `end` and from the rows of its trajectory file.

use super::Context;
use super::read::figure;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::{Keyframe, Presence};
use crate::scene::SimulationSettings;
use crate::scene::grammar::bodies::body;
use crate::scene::grammar::motion::{motion, trajectory};

/// The largest ratio of an interval between two rows of a body to the median interval at which the body is certainly present. In a longer
/// interval, it may be absent.
const MAX_INTERVAL_RATIO: f64 = 1.5;

/// Reads the times at which a body is present from its keys `start` and `end`.
pub(super) fn read(
    name: &str,
    view: &View<'_>,
    simulation: &SimulationSettings,
    context: &mut Context<'_>,
) -> Presence {
    let (start, end) = (view.get(&body::START), view.get(&body::END));
    if let (Some(start), Some(end)) = (start, end)
        && end <= start
    {
        let message = format!("`{name}` starts at {} s and ends at {} s", figure(start), figure(end));
        let error = Diagnostic::error(Code::EndBeforeStart, message);
        let spans = [(&body::END.spec, "this must be later"), (&body::START.spec, "than this")];
        let spans = spans.into_iter().filter_map(|(key, label)| Some((view.span(key)?, label)));
        context.diagnostics.push(spans.fold(error, |error, (span, label)| error.at(span, label)));
        return Presence::ALWAYS;
    }
    let at = |time: f64| simulation.timeline.without_rounding(time);
    Presence::during(&[[start.map_or(f64::NEG_INFINITY, at), end.map_or(f64::INFINITY, at)]])
}

/// Warns of a body that is never present during the run.
pub(super) fn never(
    name: &str,
    view: &View<'_>,
    presence: &Presence,
    simulation: &SimulationSettings,
    context: &mut Context<'_>,
) {
    let end = simulation.timeline.end();
    if presence.overlaps(0.0, end) {
        return;
    }
    let file = view
        .variant(&body::MOTION)
        .and_then(|motion| motion.variant(&motion::TRAJECTORY)?.span(&trajectory::FILE));
    let Some(span) = view.span(&body::START).or(view.span(&body::END)).or(file) else { return };
    let warning = Diagnostic::warning(Code::NeverThere, format!("`{name}` is never there"));
    let label = format!("the scene goes from 0 to {} s", figure(end));
    context.diagnostics.push(warning.at(span, label));
}

/// Returns the times at which a body is present according to its trajectory file: from its first row to its last row, except in gaps. Also
/// returns the index of each row after a gap.
///
/// A gap is an interval between two rows of the body that is longer than [`MAX_INTERVAL_RATIO`] times the median interval, and in which the
/// file has rows of other bodies.
pub(super) fn of_rows(
    keys: &[Keyframe],
    times: &[f64],
    simulation: &SimulationSettings,
) -> (Presence, Vec<usize>) {
    let (Some(first), Some(last)) = (keys.first(), keys.last()) else {
        return (Presence::ALWAYS, Vec::new());
    };
    let mut intervals: Vec<f64> = keys.windows(2).map(|pair| pair[1].time - pair[0].time).collect();
    let middle = intervals.len().saturating_sub(1) / 2;
    let usual = match intervals.is_empty() {
        true => f64::INFINITY,
        false => *intervals.select_nth_unstable_by(middle, f64::total_cmp).1,
    };
    let place = |time: f64| times.partition_point(|other| *other < time);
    let is_gap = |i: &usize| {
        let (from, to) = (keys[i - 1].time, keys[*i].time);
        to - from > MAX_INTERVAL_RATIO * usual && place(to) > place(from) + 1
    };
    let gaps: Vec<usize> = (1..keys.len()).filter(is_gap).collect();

    let [begin, end] = reach([first.time, last.time], simulation);
    let at = |i: usize| simulation.timeline.without_rounding(keys[i].time);
    let starts = std::iter::once(begin).chain(gaps.iter().map(|&gap| at(gap)));
    let ends = gaps.iter().map(|&gap| at(gap - 1)).chain([end]);
    let intervals: Vec<[f64; 2]> = starts.zip(ends).map(|(start, end)| [start, end]).collect();
    (Presence::during(&intervals), gaps)
}

/// Rounds the first and the last time of a file to frames. A time less than one frame from the start or the end of the run becomes
/// infinite.
fn reach([first, last]: [f64; 2], simulation: &SimulationSettings) -> [f64; 2] {
    let frame = simulation.timeline.interval() - simulation.timeline.slack();
    let begin = if first < frame { f64::NEG_INFINITY } else { simulation.timeline.without_rounding(first) };
    let end = if last > simulation.timeline.end() - frame {
        f64::INFINITY
    } else {
        simulation.timeline.without_rounding(last)
    };
    [begin, end]
}

/// Warns of a trajectory file that begins after the start of the run or ends before the end of the run.
pub(super) fn short(
    file: &str,
    times: &[f64],
    span: Span,
    simulation: &SimulationSettings,
    context: &mut Context<'_>,
) {
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else { return };
    let [begin, end] = reach([first, last], simulation);
    let before = begin.is_finite().then(|| format!("before {} s", figure(first)));
    let after = end.is_finite().then(|| format!("after {} s", figure(last)));
    let help = after.is_some().then_some("let `simulation.duration` end with the file");
    let when: Vec<String> = [before, after].into_iter().flatten().collect();
    if when.is_empty() {
        return;
    }
    let message = format!("`{file}` has no rows {}: its bodies are not there then", when.join(", and none "));
    let label = format!("the scene goes from 0 to {} s", figure(simulation.timeline.end()));
    let warning = Diagnostic::warning(Code::ShortTrajectory, message).at(span, label);
    context.diagnostics.push(match help {
        Some(help) => warning.help(help),
        None => warning,
    });
}

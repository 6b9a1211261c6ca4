//! Writes the report as text.

use std::fmt::Write;

use super::neighbours::INITIAL_DISTANCE;
use super::other_scheme::{Agreement, OtherScheme};
use super::verdict::{AccurateUntil, BrokenLaw, Conserved, Order, Verdict};
use super::{Assessment, Separation, Trial, Untested};
use crate::physics::Method;

/// The largest number of bodies in the table of errors.
const MAX_LISTED_BODIES: usize = 5;

/// The indent of the rows of tables and of continued lines.
const INDENT: &str = "          ";

impl Assessment {
    /// Returns the whole report as text. `shown` is the name of the scene in suggested commands, quoted for a shell.
    pub fn to_text(&self, shown: &str) -> String {
        let mut out = format!("{shown}: {}, {}\n", self.integrator, self.fineness());
        match &self.verdict {
            Some(verdict) => {
                self.say_verdict(&mut out, verdict);
                self.say_trials(&mut out, verdict);
            }
            None if self.bodies_moved == 0 => {
                out = format!("{shown}: no body is moved by forces, so nothing is integrated\n");
            }
            None => {
                out = format!("{shown}: a single frame, so nothing is integrated\n");
            }
        }
        if self.has_particles {
            line(&mut out, "particles", "their errors are not measured");
        }
        out
    }

    /// Returns the tolerance of an adaptive method as text. For other methods, returns the timestep, with the number of timesteps per
    /// frame unless they are independent of frames.
    fn fineness(&self) -> String {
        if let Some(tolerance) = self.tolerance {
            return format!("tolerance {}", digits(tolerance, 3));
        }
        let step = digits(self.timestep.unwrap_or_default(), 4);
        match Method::by_name(self.integrator) {
            Some(Method { take_over: Some(_), .. }) => format!("timestep {step} s"),
            _ => format!("timestep {step} s, {} a frame", self.steps_per_frame),
        }
    }

    fn say_verdict(&self, out: &mut String, verdict: &Verdict) {
        for broken in &verdict.broken {
            let kept = match broken.after {
                Some(after) => format!("the frames up to t = {} s count", digits(after, 4)),
                None => "it has no frame".to_owned(),
            };
            line(out, "broken", &format!("{}: {}; {kept}", broken.run, broken.why));
        }
        let tree = if self.has_tree { ", with the potential of the tree" } else { "" };
        line(
            out,
            "energy",
            &format!("drifts by {} of the {}{tree}", percent(verdict.drift), verdict.drift_scale.name()),
        );
        if !verdict.accounts.is_empty() {
            let held = verdict.accounts.iter().map(|(name, held)| format!("{name} {} J", digits(*held, 3)));
            let held: Vec<String> = held.collect();
            line(out, "", &format!("not counted as drift: {}", held.join(", ")));
        }
        line(out, "momentum", &momenta(verdict));
        self.say_error(out, verdict);
        self.say_bodies(out, verdict);
        let order = verdict.order_in_words(self);
        line(out, "order", &order);
        if let Some(other) = &verdict.other_scheme {
            line(out, "contacts", &other.in_words(verdict));
        }
        for BrokenLaw { law, amount, unit, time } in &verdict.broken_laws {
            let amount = digits(*amount, 2);
            let text =
                format!("contacts change the {law} by {amount} {unit} at t = {time} s, which no contact can");
            line(out, "laws", &text);
        }
        line(out, "motion", &self.motion_in_words(verdict));
        self.say_convergence(out, verdict);
    }

    fn say_error(&self, out: &mut String, verdict: &Verdict) {
        let error = digits(verdict.error, 2);
        let part = percent(part(verdict.error, verdict.size));
        let about = match verdict.order {
            Order::None { .. } => "a point is off by at least",
            _ if verdict.is_confirmed() => "a point is off by at most about",
            // The runs under one contact law agree on its mistakes, too.
            _ => "smaller steps move a point by at most about",
        };
        let size = digits(verdict.size, 3);
        line(out, "error", &format!("{about} {error} m, {part} of the size of the scene ({size} m)"));
    }

    fn say_bodies(&self, out: &mut String, verdict: &Verdict) {
        let named: Vec<&super::BodyError> = verdict.bodies.iter().take(MAX_LISTED_BODIES).collect();
        // Distances up to this limit are rounding errors; a percentage of the path would mean nothing.
        let is_seen = |place: f64| place > 1e-12 * verdict.size;
        let mut rows = vec![["body", "place off by", "of its way", "turned by", "at t"].map(str::to_owned)];
        rows.extend(named.iter().map(|body| {
            [
                body.body.clone(),
                format!("{} m", digits(body.place, 2)),
                if is_seen(body.place) && body.way > 0.0 {
                    percent(body.place / body.way)
                } else {
                    "-".to_owned()
                },
                format!("{}°", digits(body.orientation, 2)),
                format!("{} s", digits(body.time, 4)),
            ]
        }));
        table(out, &rows);
        match verdict.bodies.len() - named.len() {
            0 => {}
            1 => line(out, "", "1 other body is off by less"),
            others => line(out, "", &format!("{others} other bodies are off by less")),
        }
    }

    fn motion_in_words(&self, verdict: &Verdict) -> String {
        match verdict.neighbours {
            Separation::Unknown => "too few frames tell whether it is chaotic".to_owned(),
            Separation::Regular { growth } => format!("regular so far: {}", apart(growth)),
            Separation::Sudden { time } => format!(
                "unpredictable: neighbours that begin {INITIAL_DISTANCE:e} of the size apart are torn apart by t = {} s",
                digits(time, 3)
            ),
            Separation::Unclear { growth } => {
                format!("perhaps chaotic: {}; a longer run would tell", apart(growth))
            }
            Separation::Chaotic { lyapunov_time, doubling_time } => {
                let start = format!(
                    "chaotic: a small difference doubles every {} s (Lyapunov time {} s)",
                    digits(doubling_time, 2),
                    digits(lyapunov_time, 2)
                );
                // The time in which rounding errors grow to 1 % of the size of the scene.
                let by_rounding = lyapunov_time * libm::log(0.01 / f64::EPSILON);
                match by_rounding < self.end {
                    true => format!(
                        "{start};\n{INDENT}after about {} s even rounding has grown to 1 % of the scene, at any step",
                        digits(by_rounding, 2)
                    ),
                    false => start,
                }
            }
        }
    }

    fn say_convergence(&self, out: &mut String, verdict: &Verdict) {
        let wanted = format!("to {} of the size", percent(self.accuracy));
        line(out, "converged", &format!("{wanted}: {}", until(verdict.trusted)));
        let looser = verdict.trusted_to_a_percent;
        if self.accuracy < 0.01 && !verdict.trusted.to_the_end {
            line(out, "", &format!("to 1 % of the size: {}", until(looser)));
        }
    }

    fn say_trials(&self, out: &mut String, verdict: &Verdict) {
        let least = self.accuracy * verdict.size;
        let wanted = percent(self.accuracy);
        line(out, "tried", &format!("to converge to {wanted} of the size, {} m:", digits(least, 2)));
        let mut rows = vec![
            ["integrator", "step", "steps", "force evaluations", "error", "drift", ""].map(str::to_owned),
        ];
        rows.extend(self.trials.iter().enumerate().map(|(place, trial)| {
            [
                trial.integrator.to_owned(),
                match (trial.timestep, trial.tolerance) {
                    (_, Some(tolerance)) => format!("by {}", digits(tolerance, 2)),
                    (step, None) => format!("{} s", digits(step.unwrap_or_default(), 4)),
                },
                trial.steps.to_string(),
                trial.evaluations.to_string(),
                trial.error.map_or_else(|| broke_down(trial), |error| format!("{} m", digits(error, 2))),
                percent(trial.drift),
                match trial.reaches {
                    true if self.recommended == Some(place) => "enough, cheapest".to_owned(),
                    true => "enough".to_owned(),
                    false => String::new(),
                },
            ]
        }));
        table(out, &rows);
        let mut said: Vec<&str> = Vec::new();
        for Untested { why, .. } in &self.untried {
            if !said.contains(&why.as_str()) {
                let names = self.untried.iter().filter(|other| other.why == *why);
                let names: Vec<&str> = names.map(|untried| untried.integrator).collect();
                line(out, "", &format!("{}: {why}", names.join(", ")));
                said.push(why);
            }
        }
        self.say_advice(out, verdict);
    }

    fn say_advice(&self, out: &mut String, verdict: &Verdict) {
        let own = self.trials.iter().find(|trial| self.is_own(trial));
        let Some(best) = self.recommended.map(|place| &self.trials[place]) else {
            let is_contradicted = |other: &OtherScheme| other.contradicts(self.accuracy * verdict.size);
            let why = match verdict.neighbours {
                _ if !verdict.broken_laws.is_empty() => {
                    "first find a step at which contacts break no law: what follows from one is not right"
                }
                _ if verdict.other_scheme.as_ref().is_some_and(is_contradicted) => {
                    "first find out which contacts are right: try both on a simple case with a known result"
                }
                Separation::Chaotic { .. } | Separation::Sudden { .. } => {
                    "nothing that was tried reaches this to the end: small differences grow too fast"
                }
                _ if matches!(verdict.order, Order::None { .. }) => {
                    "nothing that was tried reaches this: small steps change the course of the run"
                }
                _ => "nothing that was tried reaches this; a looser `--accuracy` may do",
            };
            line(out, "advice", why);
            return;
        };
        let reached = own.is_some_and(|own| own.reaches);
        let saved = own.map_or(1.0, |own| ratio(own.evaluations, best.evaluations));
        if self.is_own(best) || reached && saved < 1.5 {
            line(out, "advice", "keep the method and the step: they reach this");
            return;
        }
        let why = match (reached, saved) {
            (true, saved) => {
                format!("the run reaches this; so does the following, {} times as fast:", digits(saved, 2))
            }
            (false, saved) if saved >= 1.5 => {
                format!("write this, which is {} times as fast as your run:", digits(saved, 2))
            }
            (false, saved) if saved <= 0.67 => {
                format!("write this, which takes {} times as long as your run:", digits(1.0 / saved, 2))
            }
            (false, _) => "write this, which takes about as long as your run:".to_owned(),
        };
        line(out, "advice", &why);
        for written in self.lines_to_write(best) {
            line(out, "", &written);
        }
    }

    /// Returns true for the trial with the scene's own method and timestep.
    fn is_own(&self, trial: &Trial) -> bool {
        trial.integrator == self.integrator && trial.steps_per_frame == self.steps_per_frame
    }

    /// Returns the lines of TOML that set a trial's method and timestep, or tolerance, in a scene.
    fn lines_to_write(&self, trial: &Trial) -> [String; 3] {
        [
            "[simulation]".to_owned(),
            format!("integrator = \"{}\"", trial.integrator),
            match (trial.step, trial.tolerance) {
                (_, Some(tolerance)) => format!("tolerance = {}", digits(tolerance, 2)),
                (step, None) => format!("step = {}", step.unwrap_or_default()),
            },
        ]
    }
}

impl Verdict {
    fn order_in_words(&self, assessment: &Assessment) -> String {
        let (method, nominal) = (assessment.integrator, assessment.order);
        match self.order {
            Order::Rounding => "not measured: the runs differ by rounding alone".to_owned(),
            Order::Adaptive => {
                format!("`{method}` chooses its steps: the runs at smaller tolerances are the measure")
            }
            Order::Unknown => "not measured: the runs part at once, and the error is a guess".to_owned(),
            Order::Nominal { measured } => {
                let is_good = if self.is_confirmed() { ", and the estimate is good" } else { "" };
                format!("{measured:.1} measured, as `{method}` has it: the runs converge{is_good}")
            }
            Order::Other { measured } if measured > f64::from(nominal) => {
                format!(
                    "{measured:.1} measured, more than the {nominal} of `{method}`: the motion is an easy one"
                )
            }
            Order::Other { measured } => format!(
                "{measured:.1} measured, less than the {nominal} of `{method}`: {}",
                match self.neighbours {
                    Separation::Chaotic { .. } => "in chaos, the estimate is a rough one",
                    _ => "impacts or a coarse step do this, and the estimate is a rough one",
                }
            ),
            Order::None { measured } => format!(
                "{measured:.1} measured: smaller steps do not bring the run nearer to the truth, so its error is not known"
            ),
        }
    }
}

impl OtherScheme {
    /// Describes what the run under the other contact law says about the run.
    fn in_words(&self, verdict: &Verdict) -> String {
        match self {
            OtherScheme::NotRun { contacts, why } => format!(
                "`{contacts}` is not compared: {why};\n{INDENT}smaller steps do not show a fault of the contacts themselves"
            ),
            OtherScheme::Run { contacts, ended: Some(ended), .. } => format!(
                "`{contacts}` does not reach the end: it stops at t = {} s, so it confirms nothing",
                digits(*ended, 4)
            ),
            OtherScheme::Run { contacts, body, distance, time, agreement, parted, .. } => {
                let size = percent(part(*distance, verdict.size));
                let apart = format!("{} m, {size} of the size", digits(*distance, 2));
                let place = format!("`{body}`, t = {} s", digits(*time, 4));
                match agreement {
                    Agreement::Within => {
                        format!("`{contacts}` agrees: no point is farther away than {apart}")
                    }
                    Agreement::Explained => format!(
                        "`{contacts}` parts by {apart} ({place}), which the errors of both explain: it confirms nothing"
                    ),
                    Agreement::Parted => {
                        let from = parted.map_or(String::new(), |from| {
                            format!(", by more than wanted from t = {} s", digits(from, 4))
                        });
                        let why = match verdict.neighbours {
                            Separation::Chaotic { .. } | Separation::Sudden { .. } => {
                                "at least one of the two is wrong, unless the motion is too sensitive to tell"
                            }
                            _ => "at least one of the two is wrong, and smaller steps do not show which",
                        };
                        format!("`{contacts}` parts by {apart} ({place}){from}:\n{INDENT}{why}")
                    }
                }
            }
        }
    }
}

/// Returns a text that says when a trial broke down.
fn broke_down(trial: &Trial) -> String {
    match trial.ended.as_ref().and_then(|ended| ended.after) {
        Some(after) => format!("breaks down after {} s", digits(after, 3)),
        None => "breaks down at once".to_owned(),
    }
}

/// Describes the growth of the distance between two neighboring runs. `growth` is the ratio of the final distance to the initial one.
fn apart(growth: f64) -> String {
    match growth {
        growth if growth < 2.0 => "neighbours stay together".to_owned(),
        growth => format!(
            "neighbours that begin {INITIAL_DISTANCE:e} of the size apart end {} times as far apart",
            digits(growth, 2)
        ),
    }
}

fn momenta(verdict: &Verdict) -> String {
    let said = |conserved: Conserved| match conserved {
        Conserved::Still => "none".to_owned(),
        Conserved::Changed => "changed from outside".to_owned(),
        Conserved::Kept { drift } if drift < 1e-12 => "kept to rounding".to_owned(),
        Conserved::Kept { drift } if drift < 1e-9 => format!("kept to {}", percent(drift)),
        Conserved::Kept { drift } => format!("drifts by {}", percent(drift)),
    };
    let [linear, angular] = [verdict.linear_momentum, verdict.angular_momentum].map(said);
    if linear == angular {
        format!("linear and angular: {linear}")
    } else {
        format!("linear: {linear}; angular: {angular}")
    }
}

fn until(trusted: AccurateUntil) -> String {
    match trusted {
        AccurateUntil { to_the_end: true, .. } => "to the end".to_owned(),
        AccurateUntil { until: Some(time), frame, .. } => {
            format!("until t = {} s, frame {frame}", digits(time, 4))
        }
        AccurateUntil { until: None, .. } => "not even the first frame after the start".to_owned(),
    }
}

#[allow(clippy::cast_precision_loss, reason = "two digits of it are shown")]
fn ratio(one: u64, two: u64) -> f64 {
    one as f64 / two.max(1) as f64
}

fn part(of: f64, whole: f64) -> f64 {
    if whole > 0.0 { of / whole } else { 0.0 }
}

fn line(out: &mut String, about: &str, what: &str) {
    // Writing to a string cannot fail.
    let _ = writeln!(out, "{about:<10}{what}");
}

/// Appends a table. The first column is text, aligned left; the other columns are numbers, aligned right, except words in the last column.
fn table<const N: usize>(out: &mut String, rows: &[[String; N]]) {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    for row in rows {
        let mut text = INDENT.to_owned();
        for (column, cell) in row.iter().enumerate() {
            let width = width(column);
            let _ = match column {
                0 => write!(text, "{cell:<width$}"),
                _ if column + 1 == N && row[column].chars().all(char::is_alphabetic) => {
                    write!(text, "  {cell}")
                }
                _ => write!(text, "  {cell:>width$}"),
            };
        }
        let _ = writeln!(out, "{}", text.trim_end());
    }
}

fn percent(part: f64) -> String {
    let percent = part * 100.0;
    if percent == 0.0 { "0 %".to_owned() } else { format!("{} %", digits(percent, 2)) }
}

/// Formats a number with at most this many significant digits.
pub(super) fn digits(number: f64, digits: usize) -> String {
    if number == 0.0 {
        return "0".to_owned();
    }
    let rounded: f64 = format!("{number:.*e}", digits - 1).parse().unwrap_or(number);
    if (1e-4..1e6).contains(&rounded.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

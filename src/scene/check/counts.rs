//! Computes the numbers of frames and timesteps of a scene, and checks their limits.

use super::Context;
use super::corrections::{insertion, is_file};
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Severity, Span};
use crate::physics::Spring;
use crate::scene::grammar::KeySpec;
use crate::scene::grammar::scene::{output, scene, simulation};
use crate::scene::{Body, Force, ForceKind, Timeline};

/// The maximum number of frames, which is eleven hours at 25 frames per second.
pub(in crate::scene) const MAX_FRAMES: f64 = 1_000_000.0;
/// The maximum number of timesteps of a scene.
pub(super) const MAX_STEPS: f64 = 1e11;
/// The number of timesteps above which a scene without the key `step` gets a warning. This is five days at 1/240 s.
const MANY_STEPS: f64 = 1e8;
/// The suggested timestep is the shortest time scale of the initial state divided by this number.
const STEPS_OF_A_TIME: f64 = 100.0;
/// The number of frames that a suggested frame rate gives: a film of 20 seconds at 25 frames per second.
const USUAL_FRAMES: f64 = 500.0;
/// The maximum number of bodies among which all pairs are compared for the shortest time scale.
const MAX_BODIES: usize = 1000;

/// The times of the frames and the timestep (s) of a scene. The numbers of frames and timesteps follow from them.
#[derive(Clone)]
pub(super) struct Counts {
    pub(super) timeline: Timeline,
    pub(super) step: f64,
    /// Whether the scene needs timesteps. False if no body moves freely and there are no emitters.
    pub(super) needs_steps: bool,
}

impl Counts {
    fn steps(&self) -> f64 {
        if self.needs_steps { self.timeline.duration / self.step.min(self.timeline.interval()) } else { 0.0 }
    }

    /// Returns whether the number of frames or of timesteps exceeds its limit.
    pub(super) fn are_too_many(&self) -> bool {
        self.timeline.frame_count() > MAX_FRAMES || self.steps() > MAX_STEPS
    }

    /// Returns a suitable timestep, s: a hundredth of the shortest time scale of the initial state, but at most the time from one frame to
    /// the next. If there is no time scale, the timestep is a tenth of that time.
    fn sensible_step(&self, bodies: &[Body], forces: &[Force]) -> f64 {
        let shortest = shortest_time(bodies, forces);
        let step =
            if shortest.is_finite() { shortest / STEPS_OF_A_TIME } else { 0.1 * self.timeline.interval() };
        step.min(self.timeline.interval())
    }
}

/// Reports too many frames or timesteps, and suggests a frame rate or a timestep.
pub(super) fn check(
    root: &View<'_>,
    counts: &Counts,
    bodies: &[Body],
    forces: &[Force],
    context: &mut Context<'_>,
) {
    let view = root.table(&scene::SIMULATION);
    let frames = counts.timeline.frame_count();
    if frames > MAX_FRAMES {
        let Timeline { duration, frame_rate, ref speed } = counts.timeline;
        let message =
            format!("the scene has {} frames; at most {} are written", count(frames), count(MAX_FRAMES));
        if let Some(span) = root.table(&scene::OUTPUT).span(&output::SPEED).filter(|_| !speed.is_even()) {
            let film = written(one_digit(speed.film_time(duration)));
            let help = format!("at these speeds, the film of {duration} s lasts {film} s");
            let error =
                Diagnostic::error(Code::TooManyFrames, message).at(span, "a larger speed gives fewer");
            context.diagnostics.push(error.help(help));
            return;
        }
        let rate = written(one_digit(USUAL_FRAMES / duration));
        let longest = written(digit_below((MAX_FRAMES - 1.0) / frame_rate));
        let help = format!(
            "frames = duration × frame_rate + 1: `frame_rate = {rate}` makes some {USUAL_FRAMES}, \
             or `duration = {longest}` fits"
        );
        let error = Diagnostic::error(Code::TooManyFrames, message).help(help);
        let timeline = Timeline { frame_rate: one_digit(USUAL_FRAMES / duration), ..counts.timeline.clone() };
        let slower = Counts { timeline, ..counts.clone() };
        let mut values = vec![(&simulation::FRAME_RATE.spec, rate)];
        if slower.steps() > MANY_STEPS && !view.has(&simulation::STEP) {
            values.push((&simulation::STEP.spec, written(one_digit(slower.sensible_step(bodies, forces)))));
        }
        let error = point(error, &view, &[&simulation::DURATION.spec, &simulation::FRAME_RATE.spec]);
        context.diagnostics.push(with_values(error, root, &view, &values, context));
        return;
    }
    let steps = counts.steps();
    let severity = match steps {
        steps if steps > MAX_STEPS => Severity::Error,
        steps if steps > MANY_STEPS && !view.has(&simulation::STEP) => Severity::Warning,
        _ => return,
    };
    let step = one_digit(counts.sensible_step(bodies, forces));
    let said = if severity == Severity::Error {
        let message =
            format!("the scene has {} timesteps; at most {} are taken", count(steps), count(MAX_STEPS));
        let help = "timesteps = duration / step, where a step is at most one frame long";
        point(
            Diagnostic::error(Code::TooManySteps, message).help(help),
            &view,
            &[&simulation::STEP.spec, &simulation::DURATION.spec, &simulation::FRAME_RATE.spec],
        )
    } else {
        let message = format!("the scene has {} timesteps: without `step`, each is 1/240 s", count(steps));
        let help = format!(
            "with `step = {}`, there are {}",
            written(step),
            count(Counts { step, ..counts.clone() }.steps().ceil())
        );
        let warning = Diagnostic::warning(Code::TooManySteps, message).help(help);
        point(warning, &view, &[&simulation::DURATION.spec])
    };
    let suits = Counts { step, ..counts.clone() }.steps() <= MANY_STEPS;
    let values = [(&simulation::STEP.spec, written(step))];
    context.diagnostics.push(if suits { with_values(said, root, &view, &values, context) } else { said });
}

/// Returns the shortest time scale of the initial state, s. The time scale of two bodies is their distance divided by their relative
/// speed; that of a spring is √(m / k). Infinite if there is no time scale.
fn shortest_time(bodies: &[Body], forces: &[Force]) -> f64 {
    let free = |body: &Body| body.motion.is_none() && !body.start.fixed;
    let bounded: Vec<&Body> =
        bodies.iter().filter(|body| body.motion.is_none() && !body.shape.is_unbounded()).collect();
    let bounded = &bounded[..bounded.len().min(MAX_BODIES)];
    let velocity = |body: &Body| if body.start.fixed { glam::DVec3::ZERO } else { body.start.velocity };
    let pairs = bounded
        .iter()
        .enumerate()
        .flat_map(|(i, one)| bounded[i + 1..].iter().map(move |two| (*one, *two)))
        .filter(|(one, two)| free(one) || free(two));
    let meetings = pairs.map(|(one, two)| {
        one.start.location.distance(two.start.location) / velocity(one).distance(velocity(two))
    });
    let links = forces.iter().flat_map(|force| match &force.kind {
        ForceKind::Spring { links, .. } => links.as_slice(),
        _ => &[],
    });
    let swings = links.map(|Spring { between, stiffness, .. }| {
        let bodies = between.iter().filter_map(|end| bodies.get(end.body()?.index()));
        let lightest =
            bodies.filter(|body| free(body)).map(|body| body.start.mass).fold(f64::INFINITY, f64::min);
        (lightest / stiffness).sqrt()
    });
    // Skip pairs of bodies at the same location or at relative rest, which have no time scale.
    meetings.chain(swings).filter(|time| *time > 0.0).fold(f64::INFINITY, f64::min)
}

/// Adds to the diagnostic a label at the value of each given key.
fn point(error: Diagnostic, view: &View<'_>, keys: &[&KeySpec]) -> Diagnostic {
    keys.iter().filter_map(|key| view.span(key)).fold(error, |error, span| error.at(span, ""))
}

/// Adds to the diagnostic a fix that sets keys of `[simulation]` to the given values.
fn with_values(
    said: Diagnostic,
    root: &View<'_>,
    view: &View<'_>,
    values: &[(&KeySpec, String)],
    context: &Context<'_>,
) -> Diagnostic {
    let edit = |(key, value): &(&KeySpec, String)| -> Option<(Span, String)> {
        match view.span(key) {
            Some(span) => Some((span, value.clone())),
            None => insertion(root.key_span(&scene::SIMULATION)?, &format!("{key} = {value}"), context),
        }
    };
    let Some(mut edits) = values.iter().map(edit).collect::<Option<Vec<_>>>() else { return said };
    // Join two insertions at the same source position into one.
    if let [(one, first), (two, second)] = edits.as_mut_slice()
        && one == two
    {
        first.push_str(second);
        edits.truncate(1);
    }
    let source = edits[0].0.source();
    if !is_file(source, &context.sources) || edits.iter().any(|(span, _)| span.source() != source) {
        return said;
    }
    edits.into_iter().fold(said, |said, (span, text)| said.fix(span, text))
}

/// Rounds a number to one significant digit.
fn one_digit(number: f64) -> f64 {
    format!("{number:.0e}").parse().unwrap_or(number)
}

/// Returns the largest number with one significant digit that does not exceed `number`.
fn digit_below(number: f64) -> f64 {
    let text = format!("{number:e}");
    let cut = text.split_once('e').map(|(digits, power)| format!("{}e{power}", &digits[..1]));
    cut.and_then(|cut| cut.parse().ok()).unwrap_or(number)
}

/// Formats a number in TOML notation, such as `0.02`, `2e-7` or `30000`.
fn written(number: f64) -> String {
    if (0.001..1e7).contains(&number) { number.to_string() } else { format!("{number:e}") }
}

/// Formats a large number with separators, such as `1,000,001`.
fn count(number: f64) -> String {
    if number >= 1e15 {
        let most = f64::MAX.min(number);
        return format!("{}{most:.1e}", if number.is_finite() { "" } else { "more than " });
    }
    let digits = format!("{number:.0}");
    let mut text = String::new();
    for (place, digit) in digits.char_indices() {
        if place > 0 && (digits.len() - place) % 3 == 0 {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;

    const YEAR_LONG_SIMULATION: &str = "simulation = { duration = 3.16e7, frame_rate = 1e-5 }\n";

    fn warnings(text: &str) -> String {
        Scene::parse(&format!("{YEAR_LONG_SIMULATION}{text}")).unwrap().warnings.to_text(false)
    }

    #[test]
    fn suggested_numbers_have_one_digit_and_stay_below_a_limit() {
        assert_eq!(written(one_digit(500.0 / 86_400.0)), "0.006");
        assert_eq!(written(one_digit(1.58e-5)), "2e-5");
        assert_eq!(written(digit_below(999_999.0 / 25.0)), "30000");
        assert_eq!(written(digit_below(999_999.0)), "900000");
    }

    /// The third body would reach the second body after 1000 s. The body at the spring has a mass of 4 kg, so the time scale of the spring
    /// is √(4/1e-6) = 2000 s.
    #[test]
    fn the_step_is_a_hundredth_of_the_shortest_time_of_the_start() {
        let bodies = "
            [body.one]
            shape.sphere.radius = 1
            mass = 4
            location = [0, 1e6, 0]
            [body.two]
            shape.sphere.radius = 1
            fixed = true
            [force.a.spring]
            between = ['one', [0, 2e6, 0]]
            stiffness = 1e-6
            ";
        let third = "
            [body.three]
            shape.sphere.radius = 1
            location = [3000, 4000, 0]
            velocity = [0, 5, 0]
            ";
        assert!(warnings(bodies).contains("`step = 20`"), "{}", warnings(bodies));
        let text = format!("{bodies}{third}");
        assert!(warnings(&text).contains("`step = 10`"), "{}", warnings(&text));
    }

    #[test]
    fn what_takes_no_steps_gets_no_warning() {
        let moved = "[body.a]\nshape.sphere.radius = 1\nmotion.formula.location = ['t', 0, 0]\n";
        assert_eq!(warnings(moved), "");
        let free = "[body.a]\nshape.sphere.radius = 1\nvelocity = [1, 0, 0]\n";
        assert!(warnings(free).contains("too-many-steps"), "{}", warnings(free));
    }
}

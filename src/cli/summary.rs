//! Summarizes a compiled scene in a few lines for the user.

use std::path::Path;
use std::time::Duration;

use crate::diagnostic::visible_path;
use crate::output::Written;
use crate::physics::LawResidual;
use crate::scene::{ContactLaw, why_for_many_bodies};
use crate::simulate::{ContactTotals, EnergyScale};
use crate::{Run, Scene};

use super::shell;

/// The largest energy error without a hint in the summary, as a fraction of the energy that [`EnergyScale`] names. A larger error suggests
/// `jabuka report`. The summary also gives the energy that joints take if it exceeds the same fraction.
const MAX_RELATIVE_ENERGY_ERROR: f64 = 0.01;

/// Returns a summary of the written files and of the accuracy of the run. `path` is the path of the scene file.
pub(super) fn summary(
    run: &Run<'_>,
    path: &Path,
    folder: &Path,
    written: &Written,
    took: Duration,
) -> String {
    let scene = run.scene();
    let survey = run.survey();
    let frames = scene.simulation.timeline.frames();
    let others = match (written.kept, written.removed) {
        (0, 0) => String::new(),
        (0, removed) => format!(", {removed} others of another scene removed"),
        (kept, _) => format!(", {kept} others kept"),
    };
    let unit = run.emitter().unit();
    #[allow(clippy::float_cmp, reason = "a unit that is not chosen is exactly 1")]
    let unit = if unit == 1.0 {
        String::new()
    } else {
        format!("unit      1 unit of POV-Ray's is {} m\n", short(unit))
    };
    let blur = run.shutter().map_or(String::new(), |shutter| {
        format!("shutter   open for {} s, {} moments a frame\n", short(shutter.open), shutter.samples)
    });
    format!(
        "{folder}: {scripts} of {frames} frames{others}\n\
         bodies    {bodies}\n\
         {particles}\
         timestep  {steps}, by {method}\n\
         {drift}\
         {contacts}\
         {laws}\
         {unit}\
         {blur}\
         written   {bytes} in {seconds:.2} s\n\
         {report}\
         render    jabuka render {word}\n",
        folder = visible_path(folder),
        word = shell::path(folder),
        scripts = written.scripts,
        bodies = scene.bodies.len(),
        particles = particles(scene),
        steps = if scene.simulation.method.adaptive {
            format!("as the tolerance of {} asks for", short(scene.simulation.tolerance))
        } else if scene.simulation.method.take_over.is_some() || !scene.simulation.timeline.speed.is_even() {
            format!("{} s", short(scene.simulation.step))
        } else {
            format!("{} s, {} a frame", short(survey.timestep), survey.steps_per_frame)
        },
        method = scene.simulation.method.name,
        drift = drift(survey.drift, survey.drift_scale, scene),
        contacts = survey
            .contacts
            .zip(scene.simulation.contacts)
            .map(|(totals, law)| contacts(totals, law, &scheme(scene), survey.drift_energy))
            .unwrap_or_default(),
        laws = laws(&survey.laws),
        report = report(scene, path, survey.drift),
        bytes = bytes(written.bytes),
        seconds = took.as_secs_f64(),
    )
}

/// Returns the line with the number of emitters and the maximum number of particles at one time. Empty for a scene without emitters.
fn particles(scene: &Scene) -> String {
    let most: f64 =
        scene.emitters.iter().map(|emitter| emitter.most_alive(scene.simulation.timeline.end())).sum();
    let count = scene.emitters.len();
    let emitters = if count == 1 { "1 emitter".to_owned() } else { format!("{count} emitters") };
    if count == 0 { String::new() } else { format!("particles {emitters}, up to {most} particles at once\n") }
}

/// Returns the line with the energy error of a run. `drift` is a fraction of the energy that `scale` names.
pub(super) fn drift(drift: f64, scale: EnergyScale, scene: &Scene) -> String {
    let tree = if scene.has_tree() { ", with the potential of the tree" } else { "" };
    format!("drift     {} of the {}{tree}\n", percent(drift), scale.name())
}

/// Returns the line that suggests `jabuka report`, with the user's settings. Empty if the energy drift is small.
fn report(scene: &Scene, path: &Path, drift: f64) -> String {
    if drift.abs() <= MAX_RELATIVE_ENERGY_ERROR {
        return String::new();
    }
    let set = scene.overrides.iter().map(|value| format!(" --set {}", shell::word(value)));
    format!("accuracy  jabuka report {}{}\n", shell::path(path), set.collect::<String>())
}

/// Returns the lines with the number of impacts and the energy lost in contacts. With time stepping, also returns the largest overlap of
/// bodies, the largest error of joints, and the energy that joints take if it exceeds the fraction [`MAX_RELATIVE_ENERGY_ERROR`] of
/// `scale`. `scale` is the energy to which the energy error is relative, J. `scheme` says how contacts are solved.
fn contacts(totals: ContactTotals, law: ContactLaw, scheme: &str, scale: f64) -> String {
    let ContactTotals { impacts, lost, rubbed, penetration, joints, taken_by_joints } = totals;
    let taken =
        format!("impacts   {impacts}; contacts {}; friction {}\n", energy_taken(lost), energy_taken(rubbed));
    if law == ContactLaw::EventDriven {
        return taken;
    }
    let [depth, gap] = [penetration, joints].map(two_digits);
    let gap = if joints > 0.0 { format!("; joints {gap} m off at most") } else { String::new() };
    let gap = match taken_by_joints {
        taken if joints > 0.0 && taken.abs() > MAX_RELATIVE_ENERGY_ERROR * scale => {
            format!("{gap}; joints and limits {}", energy_taken(taken))
        }
        _ => gap,
    };
    format!("{taken}contacts  {scheme}bodies {depth} m within each other at most{gap}\n")
}

/// Returns which engine computes the contacts with time stepping; for the engine for many bodies, also the reason.
fn scheme(scene: &Scene) -> String {
    let reason = why_for_many_bodies(&scene.bodies);
    let by = reason
        .map_or_else(|| "Moreau's scheme".to_owned(), |why| format!("the engine for many bodies ({why})"));
    format!("by {by}; ")
}

/// Returns the line with the worst residual of the laws that no contact can break. Empty if there are none.
fn laws(residuals: &[LawResidual]) -> String {
    let worst = residuals.iter().filter(|residual| residual.amount > 0.0);
    let Some(worst) = worst.max_by(|a, b| a.part.total_cmp(&b.part)) else { return String::new() };
    let LawResidual { law, time, amount, .. } = *worst;
    let (name, unit) = (law.name(), law.unit());
    format!("laws      {name} kept within {} {unit}, at t = {} s\n", two_digits(amount), short(time))
}

/// Formats an energy in J that contacts have taken from the bodies. A negative energy is one that contacts have added.
fn energy_taken(energy: f64) -> String {
    let verb = if energy < 0.0 { "added" } else { "took" };
    format!("{verb} {} J", short(energy.abs()))
}

/// Formats a number with four significant digits, without trailing zeros.
fn short(number: f64) -> String {
    let rounded: f64 = format!("{number:.3e}").parse().unwrap_or(number);
    if number == 0.0 || (1e-5..1e6).contains(&number.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

fn percent(part: f64) -> String {
    let percent = part * 100.0;
    if percent == 0.0 { "0 %".to_owned() } else { format!("{} %", two_digits(percent)) }
}

/// Formats a number with two significant digits.
pub(super) fn two_digits(number: f64) -> String {
    if number == 0.0 {
        return "0".to_owned();
    }
    let rounded: f64 = format!("{number:.1e}").parse().unwrap_or(number);
    if (1e-3..1e6).contains(&rounded.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

#[allow(clippy::cast_precision_loss, reason = "three digits of it are shown")]
pub(super) fn bytes(bytes: u64) -> String {
    let (mut amount, mut unit) = (bytes as f64, "B");
    for larger in ["kB", "MB", "GB", "TB"] {
        if amount < 1000.0 {
            break;
        }
        (amount, unit) = (amount / 1000.0, larger);
    }
    if unit == "B" || amount >= 100.0 { format!("{amount:.0} {unit}") } else { format!("{amount:.1} {unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_short() {
        assert_eq!([short(0.01), short(1.0 / 240.0), short(1e-9)], ["0.01", "0.004167", "1e-9"]);
        let totals = ContactTotals {
            impacts: 31415.0,
            lost: 0.123_456,
            penetration: 0.00123,
            ..ContactTotals::default()
        };
        let taken = "impacts   31415; contacts took 0.1235 J; friction took 0 J\n";
        assert_eq!(contacts(totals, ContactLaw::EventDriven, "", 1.0), taken);
        let added = ContactTotals { lost: -159.94, ..totals };
        let line = "impacts   31415; contacts added 159.9 J; friction took 0 J\n";
        assert_eq!(contacts(added, ContactLaw::EventDriven, "", 1.0), line);
        let depth = "contacts  bodies 0.0012 m within each other at most\n";
        assert_eq!(contacts(totals, ContactLaw::TimeStepping, "", 1.0), format!("{taken}{depth}"));
        let joined = ContactTotals { joints: 2.5e-5, ..totals };
        let said = |taken_by_joints: f64| {
            contacts(ContactTotals { taken_by_joints, ..joined }, ContactLaw::TimeStepping, "", 1000.0)
        };
        assert!(said(-10.0).ends_with("; joints 2.5e-5 m off at most\n"));
        assert!(said(284.04).ends_with("; joints 2.5e-5 m off at most; joints and limits took 284 J\n"));
        assert_eq!([percent(0.0), percent(-0.00123), percent(3e-17)], ["0 %", "-0.12 %", "3e-15 %"]);
        assert_eq!([bytes(999), bytes(1_000), bytes(123_456_789)], ["999 B", "1.0 kB", "123 MB"]);
    }
}

//! Warnings about the motion in a simulation, whatever is made of it.

use crate::diagnostic::{Code, Diagnostic};
use crate::physics::LawResidual;
use crate::picture::number::rounded;
use crate::scene::{ContactLaw, Scene, thinnest};
use crate::simulate::{ContactTotals, Corrected, Crossing, Overlap, StretchedJoint, Survey};

/// Returns all warnings about the motion in a simulated scene, such as bodies that pass through planes or each other, and an energy that drifts.
pub fn all(scene: &Scene, survey: &Survey) -> Vec<Diagnostic> {
    let corrected = survey.corrected.iter().map(corrected);
    corrected
        .chain(survey.crossings.iter().map(crossing))
        .chain(survey.fall.iter().map(fall))
        .chain(survey.overlap.iter().map(overlap))
        .chain(survey.stretched.iter().map(stretched))
        .chain(sunken(scene, survey))
        .chain(energy_added(scene, survey))
        .chain(survey.broken_laws().map(|residual| broken(scene, residual)))
        .chain(first_order(scene, survey).or_else(|| drift(scene, survey)))
        .collect()
}

/// Returns a warning if the energy error of the simulation exceeds 5 %.
fn drift(scene: &Scene, survey: &Survey) -> Option<Diagnostic> {
    const NOTICEABLE: f64 = 0.05;
    let help = match scene.simulation.contacts {
        Some(ContactLaw::TimeStepping) => "take a smaller `simulation.step`",
        _ => "take a smaller `simulation.step`, or an `integrator` of higher order",
    };
    let Survey { drift, drift_scale, .. } = survey;
    let message = format!("the energy drifts by {:.0} % of the {}", drift * 100.0, drift_scale.name());
    (drift.abs() > NOTICEABLE).then(|| Diagnostic::warning(Code::EnergyDrift, message).help(help))
}

/// Returns a warning if a first-order method makes event-driven contacts inaccurate. The warning gives the energy error.
fn first_order(scene: &Scene, survey: &Survey) -> Option<Diagnostic> {
    const NOTICEABLE: f64 = 1e-6;
    let simulation = &scene.simulation;
    let method = simulation.method;
    let is_exact = simulation.contacts == Some(ContactLaw::EventDriven);
    let is_said = is_exact && method.order == 1 && survey.drift.abs() > NOTICEABLE;
    let percent = rounded(survey.drift * 100.0);
    let message = format!(
        "`{}` is of first order, so this run is not exact: the energy drifts by {percent} % of the {}",
        method.name,
        survey.drift_scale.name()
    );
    let warning = Diagnostic::warning(Code::FirstOrder, message);
    let help = "leave `simulation.integrator` out, or write `\"velocity-verlet\"` or `\"rk4\"`";
    is_said.then(|| warning.help(help))
}

/// Returns the warning that a body starts with a velocity that differs from the one in the scene, because of its joints.
fn corrected(corrected: &Corrected) -> Diagnostic {
    let vector = |vector: glam::DVec3| vector.to_array().map(rounded).join(", ");
    let others = match corrected.others {
        0 => String::new(),
        1 => ", and so does 1 other body".to_owned(),
        others => format!(", and so do {others} other bodies"),
    };
    let name = &corrected.body;
    let message =
        format!("`{name}` starts with another velocity than it is given, since joints hold it{others}");
    let help = format!(
        "it starts with `velocity = [{}]` and `angular_velocity = [{}]`; write these, or others that the joints allow",
        vector(corrected.velocity),
        vector(corrected.angular_velocity)
    );
    Diagnostic::warning(Code::CorrectedStart, message).help(help)
}

/// The advice, for warnings, that turns on contacts between bodies.
const STOPS: &str = "`simulation.contacts = \"event-driven\"` stops bodies where they touch";

/// Returns the warning that a body passes through a plane.
fn crossing(crossing: &Crossing) -> Diagnostic {
    let plane = crossing.plane.as_ref().map_or("the ground".to_owned(), |name| format!("the plane `{name}`"));
    let others = match crossing.others {
        0 => String::new(),
        1 => ", and 1 other body later".to_owned(),
        others => format!(", and {others} other bodies later"),
    };
    let message = format!("`{}` goes through {plane} at t = {} s{others}", crossing.body, crossing.time);
    Diagnostic::warning(Code::Crossing, message).help(format!("nothing stops it; {STOPS}"))
}

/// Returns the warning that a body falls without end.
fn fall(fall: &Crossing) -> Diagnostic {
    let others = match fall.others {
        0 => String::new(),
        1 => ", and so does 1 other body".to_owned(),
        others => format!(", and so do {others} other bodies"),
    };
    let message =
        format!("`{}` falls below height 0 at t = {} s, and keeps falling{others}", fall.body, fall.time);
    let help = "nothing stops it; with `simulation.contacts = \"event-driven\"`, bodies land on the ground at height 0; without a \
                ground, `environment.ground = false` ends this warning";
    Diagnostic::warning(Code::Crossing, message).help(help)
}

/// Returns the warning that a joint gives way.
fn stretched(stretched: &StretchedJoint) -> Diagnostic {
    let StretchedJoint { joint, gap, time, others } = stretched;
    let others = match others {
        0 => String::new(),
        1 => ", and so does 1 other joint".to_owned(),
        others => format!(", and so do {others} other joints"),
    };
    let message = format!("the joint `{joint}` gives way by {} m at t = {time} s{others}", rounded(*gap));
    let help = "take a smaller `simulation.step`, or make the bodies more alike in mass";
    Diagnostic::warning(Code::JointGivesWay, message).help(help)
}

/// Returns a warning if bodies sink deeply into each other under time-stepping.
fn sunken(scene: &Scene, survey: &Survey) -> Option<Diagnostic> {
    /// The largest penetration without a warning, as a fraction of the thickness of the thinnest moving body.
    const ALLOWED: f64 = 0.25;
    let (totals, thinnest) = (survey.contacts?, thinnest(&scene.bodies)?);
    let is_stepped = scene.simulation.contacts == Some(ContactLaw::TimeStepping);
    let part = totals.penetration / thinnest;
    let message = format!(
        "bodies sink into each other by up to {} m, {:.0} % of the thickness of the thinnest moving body",
        rounded(totals.penetration),
        100.0 * part
    );
    let help = "take a smaller `simulation.step`, or make the bodies more alike in mass";
    (is_stepped && part > ALLOWED).then(|| Diagnostic::warning(Code::DeepOverlap, message).help(help))
}

/// Returns the warning that contacts have broken a law that no contact can break.
fn broken(scene: &Scene, residual: &LawResidual) -> Diagnostic {
    let LawResidual { law, time, bodies: [one, two], amount, part } = *residual;
    let name = |body: usize| scene.bodies.get(body).map_or("ground", |body| &body.name);
    let bodies =
        if one == two { format!("`{}`", name(one)) } else { format!("`{}` and `{}`", name(one), name(two)) };
    let message = format!(
        "contacts of {bodies} change the {} by {} {} at t = {time} s, {:.1} % of it, which no contact can do",
        law.name(),
        rounded(amount),
        law.unit(),
        100.0 * part
    );
    Diagnostic::warning(Code::EnergyAdded, message)
        .help("what follows is not right; take a smaller `simulation.step`")
}

/// Returns a warning if contacts or joints give much energy to the bodies.
fn energy_added(scene: &Scene, survey: &Survey) -> Option<Diagnostic> {
    /// The largest energy that needs no warning, as a fraction of the energy that the drift is relative to.
    const ALLOWED: f64 = 0.05;
    let totals = survey.contacts?;
    let (source, taken) = largest_gain(&totals, !scene.is_for_many_bodies())?;
    let adds = if source == "friction" { "adds" } else { "add" };
    let message = format!(
        "{source} {adds} {} J to the energy of the bodies, but can only take energy",
        rounded(-taken)
    );
    let is_much = -taken > ALLOWED * survey.drift_energy.max(fall_in_a_step(scene, survey.timestep));
    is_much.then(|| Diagnostic::warning(Code::EnergyAdded, message).help("take a smaller `simulation.step`"))
}

/// Returns the name of what takes the least energy from the bodies, and the energy that it takes, J. It is negative if energy is added.
fn largest_gain(totals: &ContactTotals, has_exact_joints: bool) -> Option<(&'static str, f64)> {
    let sources = if has_exact_joints {
        // Moreau's scheme checks the sum of all impulses at each part of a step, but impacts can take what friction adds, and the reverse.
        vec![("friction", totals.rubbed), ("contacts", totals.lost)]
    } else {
        vec![("contacts", totals.lost + totals.rubbed), ("joints and limits", totals.taken_by_joints)]
    };
    sources.into_iter().min_by(|one, two| one.1.total_cmp(&two.1))
}

/// Returns the kinetic energy that gravity alone would give all bodies in a timestep, J. Contacts that hold bodies at rest are exact to a
/// small part of it.
fn fall_in_a_step(scene: &Scene, timestep: f64) -> f64 {
    let moving = scene.bodies.iter().filter(|body| !body.start.fixed && body.motion.is_none());
    let speed = timestep * scene.simulation.gravity.length();
    moving.map(|body| 0.5 * body.start.mass * speed * speed).sum()
}

/// Returns the warning that two bodies overlap.
fn overlap(overlap: &Overlap) -> Diagnostic {
    let [one, two] = &overlap.bodies;
    let message = format!("`{one}` and `{two}` overlap at t = {} s", overlap.time);
    Diagnostic::warning(Code::Overlap, message).help(format!("they pass through each other; {STOPS}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What friction adds cannot hide behind what impacts take, nor the reverse, if both are exact but for the errors of impulses.
    #[test]
    fn neither_friction_nor_impacts_may_add_energy() {
        let totals = |lost, rubbed| ContactTotals { lost, rubbed, ..ContactTotals::default() };
        assert_eq!(largest_gain(&totals(178.0, -157.0), true), Some(("friction", -157.0)));
        assert_eq!(largest_gain(&totals(-606.0, 626.0), true), Some(("contacts", -606.0)));
        assert_eq!(largest_gain(&totals(178.0, -157.0), false), Some(("joints and limits", 0.0)));
    }
}

//! Checks scenes with `simulation.contacts = "time-stepping"`: reports unsupported features and inaccurate rebounds.

use std::collections::{HashMap, HashSet};

use super::Context;
use super::counts::Counts;
use super::read::figure;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::{METHODS, Motor, suitable_step};
use crate::scene::grammar::Key;
use crate::scene::grammar::bodies::body;
use crate::scene::grammar::joints::hinge;
use crate::scene::grammar::scene::{environment, scene, simulation};
use crate::scene::grammar::showing::joint_arrows;
use crate::scene::{Body, ContactLaw, Joint, SimulationSettings, is_by_moreau, thinnest};

/// The smallest restitution for which a warning says that rebounds lose height.
const MIN_RESTITUTION_TO_WARN: f64 = 0.9;

/// The help text that suggests event-driven contacts, or time stepping of few bodies.
pub(super) const FEWER_BODIES_HELP: &str = "the other scheme can: `simulation.contacts = \"event-driven\"`; so can time stepping of at most sixty moving bodies \
                            and no torus";

/// Chooses a timestep that suits the thinnest colliding body, if the scene does not give `step`.
pub(super) fn choose_step(
    root: &View<'_>,
    simulation: SimulationSettings,
    counts: Counts,
    bodies: &[Body],
) -> (SimulationSettings, Counts) {
    let gravity = simulation.gravity.length();
    let is_chosen = root.table(&scene::SIMULATION).has(&simulation::STEP);
    if simulation.contacts != Some(ContactLaw::TimeStepping) || is_chosen || gravity == 0.0 {
        return (simulation, counts);
    }
    let Some(thinnest) = thinnest(bodies) else { return (simulation, counts) };
    let step = suitable_step(thinnest, gravity).min(counts.step);
    (SimulationSettings { step, ..simulation }, Counts { step, ..counts })
}

/// Reports rolling friction and all integrators that time stepping does not support, and warns of nearly elastic surfaces.
pub(super) fn check(
    root: &View<'_>,
    simulation: &SimulationSettings,
    bodies: &[Body],
    context: &mut Context<'_>,
) {
    let table = root.table(&scene::SIMULATION);
    let is_by_moreau = is_by_moreau(bodies);
    if !cfg!(feature = "time-stepping") && !is_by_moreau {
        let error = Diagnostic::error(Code::BadContacts, "this build of jabuka has no time stepping");
        let help = "build jabuka with its feature `time-stepping`, or take the other scheme: `contacts = \"event-driven\"`";
        let span = table.span(&simulation::CONTACTS);
        context.diagnostics.extend(span.map(|span| error.at(span, "").help(help)));
    }
    let own = METHODS[0].name;
    if simulation.method.name != own {
        let message = format!("time stepping does not take the integrator `{}`", simulation.method.name);
        let span = table.span(&simulation::INTEGRATOR).or(table.span(&simulation::CONTACTS));
        let help = format!(
            "write `integrator = \"{own}\"`, or leave it out; with `contacts = \"event-driven\"`, any integrator will do"
        );
        let error = Diagnostic::error(Code::BadContacts, message).help(help);
        let why = format!("it solves contacts and motion together, by steps of `{own}`");
        context.diagnostics.extend(span.map(|span| error.at(span, why)));
    }
    let ground = root.table(&scene::ENVIRONMENT).variant(&environment::GROUND);
    let of_ground = |key: &Key<Option<f64>>| {
        let ground = ground.as_ref()?;
        Some((ground.key_span(key)?, ground.get(key)?))
    };
    let (mut said, mut rolling) = (HashSet::new(), Vec::new());
    let mut elastic = None;
    let mut see = |is_rebound: bool, span: Span, value: f64| {
        if is_rebound && value >= MIN_RESTITUTION_TO_WARN && elastic.is_none() {
            elastic = Some((span, value));
        } else if !is_rebound && value > 0.0 && said.insert(span) {
            rolling.push(span);
        }
    };
    for (is_rebound, key) in [(false, &body::ROLLING_FRICTION), (true, &body::RESTITUTION)] {
        for (table, checked) in root.bodies().zip(bodies) {
            // Take the value that was checked with the body: copies of a body share their keys, but not always their values.
            let Some(surface) = checked.collider.as_ref().map(|collider| collider.surface) else { continue };
            let value = if is_rebound { surface.restitution } else { surface.rolling_friction };
            let span = value.and_then(|_| table.look(|view| view.key_span(key)));
            span.zip(value).into_iter().for_each(|(span, value)| see(is_rebound, span, value));
        }
        of_ground(key).into_iter().for_each(|(span, value)| see(is_rebound, span, value));
    }
    for span in rolling.into_iter().filter(|_| !is_by_moreau) {
        let error = Diagnostic::error(Code::BadContacts, "time stepping has no rolling friction");
        context.diagnostics.push(error.at(span, "").help(FEWER_BODIES_HELP));
    }
    // Report this warning only once: it is the same for all bodies. Moreau's scheme keeps the height.
    if let Some((span, value)) = elastic.filter(|_| !is_by_moreau) {
        let message = format!("a rebound with restitution {} loses height in time stepping", figure(value));
        let label = "a rebound begins at the end of a step, and not at its own time";
        let help = format!(
            "with restitution 1 and steps of 1/240 s, a ball that falls from 1 m has {} m left at its 10th rebound, and lies still after \
             some {}; `contacts = \"event-driven\"` keeps the height",
            MEASURED_REBOUNDS[0], MEASURED_REBOUNDS[1]
        );
        context.diagnostics.push(Diagnostic::warning(Code::LosesHeight, message).at(span, label).help(help));
    }
}

/// The height of the 10th rebound (m), and the number of rebounds until rest, for a ball with restitution 1 that falls from 1 m. A test of
/// the engine measures both numbers.
const MEASURED_REBOUNDS: [&str; 2] = ["0.82", "95"];

/// Reports joints, motors and joint arrows that time stepping does not support.
pub(super) fn check_joints(
    root: &View<'_>,
    simulation: &SimulationSettings,
    bodies: &[Body],
    joints: &[Joint],
    context: &mut Context<'_>,
) {
    if simulation.contacts != Some(ContactLaw::TimeStepping) || is_by_moreau(bodies) {
        return;
    }
    let by_name: HashMap<&str, &Joint> = joints.iter().map(|joint| (&*joint.name, joint)).collect();
    for (name, span, view) in root.named(&scene::JOINT) {
        let Some(joint) = by_name.get(name) else { continue };
        let before = context.diagnostics.len();
        let mut wrong = |what: String, span: Span, label: &str, help: &str| {
            let error = Diagnostic::error(Code::BadContacts, what).at(span, label.to_owned());
            context.diagnostics.push(error.help(help.to_owned()));
        };
        if let Some(kind) = joint.kind.unknown_to_rapier() {
            wrong(format!("time stepping has no {kind}, as `{name}` is one"), span, "", FEWER_BODIES_HELP);
        }
        let kind = super::joint::kind(&view);
        if matches!(joint.kind.motor(), Some(Motor::Value(_))) {
            let place = kind.as_ref().and_then(|kind| kind.key_span(&hinge::MOTOR)).unwrap_or(span);
            let help = format!("give the motor a `stiffness` and a `damping`; {FEWER_BODIES_HELP}");
            wrong(format!("the motor of `{name}` cannot keep its value exactly"), place, "", &help);
        }
        let arrows = kind.map(|kind| kind.table(&hinge::ARROWS));
        for key in [&joint_arrows::FORCE.spec, &joint_arrows::TORQUE.spec] {
            let place = arrows.as_ref().and_then(|arrows| arrows.key_span(key));
            if let Some(place) = place.filter(|_| joint.arrows.iter().any(Option::is_some)) {
                let what = format!("time stepping does not know the {key} of the joint `{name}`");
                wrong(what, place, "", FEWER_BODIES_HELP);
            }
        }
        context.once(before, name, span);
    }
}

#[cfg(all(test, not(feature = "time-stepping")))]
mod tests {
    use crate::Scene;

    #[test]
    fn a_build_without_time_stepping_says_so_at_the_place() {
        let text = "simulation.contacts = 'time-stepping'\n[body.a]\nshape.sphere.radius = 1\nlocation = ['3*i', 2, 0]\nrepeat = 6\n";
        let report = Scene::parse(text).unwrap_err();
        let error = &report.diagnostics[0];
        assert_eq!(error.message, "this build of jabuka has no time stepping");
        let span = error.span().unwrap();
        assert!(report.sources.raw(span).contains("time-stepping"), "{span:?}");
    }
}

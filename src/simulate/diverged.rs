//! The error of a run in which a position or a velocity becomes infinite or too large to compute with. It names the force that causes
//! this, and says whether a shorter step helps.

use super::build;
use crate::diagnostic::{Sources, Span};
use crate::physics::{self, BodyId};
use crate::scene::Scene;

/// The error of a run in which a position or a velocity becomes infinite or too large to compute with. Either the timestep is too long for
/// the method, or the forces are too large.
#[derive(Clone, Debug)]
pub struct Diverged {
    /// The name of the first body with such a position or velocity.
    pub body: String,
    /// The time of the frame with this state, s.
    pub time: f64,
    /// What pushes the body far more than all others, at the start or after the first step.
    pub cause: Option<Cause>,
    /// What a shorter step changes.
    pub shorter: ShorterStep,
    /// The span of the name of the force that causes the motion, or else of the body, and the texts that the scene was read from.
    pub place: (Option<Span>, Sources),
}

/// What pushes a body, alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Cause {
    /// The force, as a message names it, such as "the force `wind`" or "gravity".
    pub force: String,
    /// The size of the force at the time, N, or of its torque, N m, if that is the larger number.
    pub size: f64,
    /// The time at which the force has this size, s: 0, or the end of the first step.
    pub time: f64,
}

/// What a shorter step changes for a run that diverges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShorterStep {
    /// With this step, s, the run keeps its energy until then.
    Helps(f64),
    /// The run diverges also with far shorter steps.
    IsUseless,
    /// The trial would take too long.
    IsUntried,
}

impl PartialEq for Diverged {
    /// Ignores the span and the texts of the scene.
    fn eq(&self, other: &Diverged) -> bool {
        (&self.body, self.time, &self.cause) == (&other.body, other.time, &other.cause)
    }
}

impl Diverged {
    /// The smallest ratio of a force to the sum of all others at which it causes the motion alone.
    const DOMINANT_FORCE_RATIO: f64 = 10.0;
    /// The largest cost of a trial with a shorter step: the number of steps times the number of bodies.
    const MAX_TRIAL_COST: f64 = 1e5;

    pub(super) fn of(scene: &Scene, body: BodyId, time: f64) -> Diverged {
        // Forces such as springs at rest are zero at the start.
        let step = Some(scene.simulation.step).filter(|step| *step < time);
        let cause =
            [Some(0.0), step].into_iter().flatten().find_map(|at| Diverged::cause(scene, body.index(), at));
        let (cause, name) = cause.unzip();
        let of_force = name.and_then(|name: String| scene.places.forces.get(&name));
        let span = of_force.or(scene.places.bodies.get(body.index()));
        let place = (span.copied(), scene.warnings.sources.clone());
        let shorter = ShorterStep::of(scene, time);
        Diverged { body: scene.bodies[body.index()].name.to_string(), time, cause, shorter, place }
    }

    /// Returns what alone moves a body at a time, s, with its name among the forces.
    fn cause(scene: &Scene, body: usize, time: f64) -> Option<(Cause, String)> {
        let mut world = build::world(scene);
        if time > 0.0 {
            physics::Dynamics::advance(&mut world, time, &[], &mut |_| {}).ok()?;
        }
        let moment = physics::Moment { time, state: world.state(), model: world.model() };
        let size = |force: &crate::scene::Force| {
            let room = vec![glam::DVec3::ZERO; world.len()];
            let mut loads = physics::Loads { force: room.clone(), torque: room, ..Default::default() };
            build::forces(&force.kind).iter().for_each(|force| force.apply(&moment, &mut loads));
            loads.force[body].abs().max_element().max(loads.torque[body].abs().max_element())
        };
        let own = &scene.bodies[body].start;
        let mut all = vec![
            ("gravity".to_owned(), String::new(), (own.mass * scene.simulation.gravity).abs().max_element()),
            ("its own `force`".to_owned(), String::new(), own.force.abs().max_element()),
            ("its own `torque`".to_owned(), String::new(), own.torque.abs().max_element()),
        ];
        all.extend(
            scene
                .forces
                .iter()
                .map(|force| (format!("the force `{}`", force.name), force.name.clone(), size(force))),
        );
        all.sort_by(|(_, _, a), (_, _, b)| b.total_cmp(a));
        let others: f64 = all[1..].iter().map(|(_, _, size)| size).sum();
        let (force, name, size) = all.swap_remove(0);
        (size.is_finite() && size > Diverged::DOMINANT_FORCE_RATIO * others)
            .then_some((Cause { force, size, time }, name))
    }
}

impl ShorterStep {
    /// Repeats a run that diverges at `time`, s, with shorter steps.
    fn of(scene: &Scene, time: f64) -> ShorterStep {
        let simulation = &scene.simulation;
        // A method that chooses its steps has chosen them short enough, and no step changes the start.
        if !simulation.step.is_finite() || time == 0.0 {
            return ShorterStep::IsUseless;
        }
        let mut trial = scene.clone();
        let mut shorter = ShorterStep::IsUntried;
        for part in [1e1, 1e2, 1e3, 1e4] {
            // One digit is enough.
            let step = format!("{:.0e}", simulation.step / part).parse().unwrap_or(simulation.step / part);
            #[allow(clippy::cast_precision_loss, reason = "no scene has 2^53 bodies")]
            if time / step * scene.bodies.len() as f64 > Diverged::MAX_TRIAL_COST {
                return shorter;
            }
            trial.simulation.step = step;
            let mut dynamics = build::dynamics(&trial, &physics::PairCounter::default());
            let reached = dynamics.advance(time, &[], &mut |_| {}).and_then(|()| dynamics.snapshot());
            let is_kept = |snapshot: &physics::Snapshot| snapshot.balance.drift.abs() < 1.0;
            if reached.and_then(physics::Snapshot::checked).is_ok_and(|snapshot| is_kept(&snapshot)) {
                return ShorterStep::Helps(step);
            }
            shorter = ShorterStep::IsUseless;
        }
        shorter
    }
}

impl Diverged {
    /// Recommends a shorter step where that helps.
    pub(super) fn help(&self) -> Option<String> {
        match (self.shorter, &self.cause) {
            (ShorterStep::Helps(step), _) => Some(format!(
                "a smaller `simulation.step` helps: with {step:e} s, the motion stays in bounds until then"
            )),
            (ShorterStep::IsUntried, _) => Some(
                "take a smaller `simulation.step`: below √(mass / stiffness) for a stiff spring, and below 2 mass / damping for a strong damper"
                    .to_owned(),
            ),
            (ShorterStep::IsUseless, Some(_)) => None,
            (ShorterStep::IsUseless, None) => Some(
                "a smaller `simulation.step` does not help: look for a value in another unit, or a force that grows with the motion"
                    .to_owned(),
            ),
        }
    }

    /// Says which force moves the body, for the label at its line. Empty if no force alone does.
    pub(super) fn label(&self) -> String {
        let Some(Cause { force, size, time }) = &self.cause else { return String::new() };
        let when = if *time == 0.0 { "the start".to_owned() } else { format!("t = {time} s") };
        format!("at {when}, {force} acts on `{}` with {size:.1e} N or N m", self.body)
    }
}

impl std::fmt::Display for Diverged {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Diverged { body, time, .. } = self;
        write!(
            f,
            "the run diverged: at t = {time} s `{body}` is at no finite place, or beyond 1e100 m, m/s or rad/s"
        )
    }
}

impl std::error::Error for Diverged {}

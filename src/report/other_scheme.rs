//! Compares a run with contacts with the same run under the other contact law. Runs under one law agree on its mistakes, too: halving the
//! timestep shows that they converge, not that they converge to the right motion.

use serde::Serialize;

use super::compare::points;
use super::lockstep::{ComparedRun, Ended};
use super::measure::ComparedBodies;
use super::setting::Setting;
use super::trials::factor;
use crate::physics::{METHODS, Method, Motor, Snapshot, suitable_step};
use crate::scene::{ContactLaw, Scene, is_by_moreau, thinnest};

/// The comparison of a run with contacts with the same run under the other contact law.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum OtherScheme {
    /// The scene was not simulated under the other law.
    NotRun {
        /// The name of the other contact law.
        contacts: &'static str,
        /// The reason.
        why: &'static str,
    },
    /// The scene was simulated under both laws.
    Run {
        /// The name of the other contact law.
        contacts: &'static str,
        /// The body with the largest distance between the two runs. Empty if nothing could be compared.
        body: String,
        /// The largest distance of a point of this body between the two runs, m.
        distance: f64,
        /// The time of this distance, s.
        time: f64,
        /// The time of the first frame at which the runs are farther apart than the requested accuracy, s. `None` if they never are.
        parted: Option<f64>,
        /// The estimated error of the other run, m, from the same run at half its timestep.
        error: f64,
        /// How the distance compares with the estimated errors.
        agreement: Agreement,
        /// The time of the other run's last frame, s, if that run stopped early.
        ended: Option<f64>,
    },
}

/// How the distance between the runs under both contact laws compares with the errors that smaller timesteps show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Agreement {
    /// No distance is larger than the estimated error of the run, and the other run reached its end.
    Within,
    /// The distance is larger than that, but the estimated errors of both runs explain it.
    Explained,
    /// The errors do not explain the distance, or the other run stopped early: at least one of the two is wrong.
    Parted,
}

/// The other contact law of a scene: the law, and the scene under it, or the reason why it is not run.
#[derive(Debug)]
pub(super) struct Other {
    law: ContactLaw,
    /// The scene under this law, at its timestep and at half of it.
    scenes: Result<[Scene; 2], &'static str>,
}

/// The distances between the run and the run under the other law, frame by frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Apart {
    /// The time of each frame that both runs have (s), and the largest distance of any point at this frame (m).
    moments: Vec<(f64, f64)>,
    /// The body with the largest distance (its index among the compared bodies), the distance (m), and the time (s).
    largest: Option<(usize, f64, f64)>,
    /// The largest distance between the run under the other law and the same run at half its timestep, m.
    halved: f64,
    /// The end of the other run, if it stopped early.
    pub(super) ended: Option<Ended>,
    /// True if the other run took more steps than are allowed.
    pub(super) is_long: bool,
}

/// The largest number of timesteps that the other run may take, as a multiple of those that its setting gives. Impacts divide steps.
const MAX_STEP_RATIO: f64 = 20.0;

impl Other {
    /// Returns the other contact law of a scene. `None` without contacts.
    pub(super) fn of(scene: &Scene, measured: &ComparedBodies) -> Option<Other> {
        let law = match scene.simulation.contacts? {
            ContactLaw::EventDriven => ContactLaw::TimeStepping,
            ContactLaw::TimeStepping => ContactLaw::EventDriven,
        };
        let scenes = under(scene, law, measured).map(|coarse| {
            let mut fine = coarse.clone();
            fine.simulation.step *= 0.5;
            [coarse, fine]
        });
        Some(Other { law, scenes })
    }

    /// Returns the number of force evaluations of all runs under the other law.
    pub(super) fn cost(&self) -> f64 {
        self.scenes.iter().flatten().map(|scene| Setting::of(scene).cost(scene)).sum()
    }

    /// Starts the runs under the other law: at its timestep, and at half of it. None if the scene is not simulated under it.
    pub(super) fn runs(&self) -> impl Iterator<Item = ComparedRun<'_>> {
        self.scenes.iter().flatten().map(|scene| {
            let cost = Setting::of(scene).cost(scene);
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                clippy::cast_precision_loss,
                reason = "the number of steps is limited"
            )]
            let (each, most) = (
                cost / scene.simulation.timeline.frames().max(1) as f64,
                (MAX_STEP_RATIO * cost) as u64 + 100,
            );
            ComparedRun::new(scene, each).of_at_most(most)
        })
    }

    /// Judges the distances between the two runs. `name` returns the name of a compared body. `error` is the estimated error of the run,
    /// `wanted` is the requested accuracy, and `size` is the size of the scene, all in m.
    pub(super) fn judge(
        &self,
        name: impl Fn(usize) -> String,
        apart: &Apart,
        error: f64,
        wanted: f64,
        size: f64,
    ) -> OtherScheme {
        /// Distances below this fraction of the size of the scene count as rounding errors.
        const RELATIVE_ROUNDING: f64 = 1e-11;
        let contacts = self.law.name();
        let why = match &self.scenes {
            Err(why) => Some(*why),
            Ok(_) => apart.is_long.then_some("its impacts take too many steps"),
        };
        if let Some(why) = why {
            return OtherScheme::NotRun { contacts, why };
        }
        let (body, distance, time) = apart.largest.unwrap_or_default();
        let is_whole = apart.ended.is_none() && apart.largest.is_some();
        // Impacts make both schemes methods of first order. The places of impacts in their steps differ, so the difference of two runs
        // fluctuates, and may be a third of what it usually is.
        let other_error = 3.0 * factor(1.0) * apart.halved;
        let agreement = match error.max(RELATIVE_ROUNDING * size) {
            error if is_whole && distance <= error => Agreement::Within,
            error if is_whole && distance <= error + other_error => Agreement::Explained,
            _ => Agreement::Parted,
        };
        OtherScheme::Run {
            contacts,
            body: apart.largest.map_or_else(String::new, |_| name(body)),
            distance,
            time,
            parted: apart.moments.iter().find(|(_, distance)| *distance > wanted).map(|(time, _)| *time),
            error: other_error,
            agreement,
            ended: apart.ended.as_ref().map(|ended| ended.after.unwrap_or_default()),
        }
    }
}

impl OtherScheme {
    /// Returns true if the run agrees with the run under the other law within its own estimated error.
    pub(super) fn confirms(&self) -> bool {
        matches!(self, OtherScheme::Run { agreement: Agreement::Within, .. })
    }

    /// Returns true if the two laws give different motions, and the difference is larger than `wanted`, m.
    pub(super) fn contradicts(&self, wanted: f64) -> bool {
        match self {
            OtherScheme::Run { agreement: Agreement::Parted, distance, ended, .. } => {
                *distance > wanted || ended.is_some()
            }
            _ => false,
        }
    }
}

impl Apart {
    /// Adds the distances between the run and the two runs under the other law at one frame.
    pub(super) fn see(&mut self, measured: &ComparedBodies, run: &Snapshot, others: &[Option<Snapshot>]) {
        let Some(Some(other)) = others.first() else { return };
        let mut most = 0.0_f64;
        for (body, distance) in points(measured, [run, other]) {
            most = most.max(distance.point);
            if self.largest.is_none_or(|(_, largest, _)| distance.point > largest) {
                self.largest = Some((body, distance.point, run.time));
            }
        }
        self.moments.push((run.time, most));
        if let Some(Some(half)) = others.get(1) {
            let distances = points(measured, [other, half]).map(|(_, distance)| distance.point);
            self.halved = distances.fold(self.halved, f64::max);
        }
    }
}

/// Returns the scene under another contact law, or the reason why it is not simulated under that law.
fn under(scene: &Scene, law: ContactLaw, measured: &ComparedBodies) -> Result<Scene, &'static str> {
    if let Some(why) = refused(scene, law) {
        return Err(why);
    }
    let mut other = scene.clone();
    let simulation = &mut other.simulation;
    simulation.contacts = Some(law);
    match law {
        ContactLaw::TimeStepping => {
            simulation.method = &METHODS[0];
            let firm = |thinnest| suitable_step(thinnest, simulation.gravity.length());
            let firm = thinnest(&other.bodies).map_or(f64::INFINITY, firm);
            other.simulation.step = scene.simulation.step.min(firm);
        }
        // The first method that computes contacts and is no less accurate at impacts than between them.
        ContactLaw::EventDriven => {
            let fits =
                |method: &&Method| method.constraints && method.order == 2 && method.take_over.is_none();
            simulation.method = Method::all().find(fits).unwrap_or(&METHODS[0]);
        }
    }
    let steps = Setting::of(&other).cost(&other);
    let (bodies, work) = match law {
        ContactLaw::EventDriven => (BODIES_IN_EVENTS, WORK_IN_EVENTS),
        ContactLaw::TimeStepping => (usize::MAX, WORK_IN_STEPS),
    };
    #[allow(clippy::cast_precision_loss, reason = "a scene has fewer bodies")]
    let is_cheap = measured.bodies.len() <= bodies && steps * measured.bodies.len() as f64 <= work;
    if is_cheap { Ok(other) } else { Err("it would take too long") }
}

/// The largest number of moving bodies that is simulated with event-driven contacts. Impacts of more bodies at once take long.
const BODIES_IN_EVENTS: usize = 100;

/// The largest product of moving bodies and timesteps that is simulated with event-driven contacts: a few seconds.
const WORK_IN_EVENTS: f64 = 3e4;

/// The largest product of moving bodies and timesteps that is simulated with time-stepping contacts: a few seconds.
const WORK_IN_STEPS: f64 = 3e5;

/// Returns the reason why a contact law cannot simulate a scene. `None` if it can.
fn refused(scene: &Scene, law: ContactLaw) -> Option<&'static str> {
    if law == ContactLaw::EventDriven {
        let has_torus = |body: &crate::scene::Body| body.collider.is_some() && body.shape.has_torus();
        return scene.bodies.iter().any(has_torus).then_some("it computes no contacts of a torus");
    }
    if !cfg!(feature = "time-stepping") {
        return Some("this build of jabuka has no time stepping");
    }
    if is_by_moreau(&scene.bodies) {
        return None;
    }
    let rolls =
        |surface: crate::physics::Surface| surface.rolling_friction.is_some_and(|rolling| rolling > 0.0);
    let surfaces = scene.bodies.iter().filter_map(|body| Some(body.collider.as_ref()?.surface));
    if surfaces.chain(scene.ground_that_stops().map(|(_, surface)| surface)).any(rolls) {
        return Some("it has no rolling friction");
    }
    scene.joints.iter().find_map(|joint| {
        if joint.kind.unknown_to_rapier().is_some() {
            return Some("it does not have all joints of the scene");
        }
        matches!(joint.kind.motor(), Some(Motor::Value(_)))
            .then_some("it has no motors that keep a value exactly")
    })
}

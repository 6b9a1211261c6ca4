//! The survey of a whole run, before its frames are drawn.
//!
//! It is made while frames are recorded, or while a recording is read.

mod corrected;
mod crossing;
#[cfg(test)]
mod tests;

pub use corrected::Corrected;
pub use crossing::Crossing;
use crossing::{Watched, free, planes};

use super::asked::Asked;
use super::overlap::{Overlap, Watch};
use super::particles::Clouds;
use super::span::{JointArrow, Spans};
use super::vectors::JointEnd;
use super::{Bounds, Frame, Frames, SimulateError, Span, world};
use crate::dynamics::BodySnapshot;
use crate::scene::{Arrow, Joint, Quantity, Scene};

/// Figures on a whole run.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// The space that the run takes, from the start to several moments; the last is the end. A body counts until it passes through a
    /// plane. Empty if all bodies are planes.
    pub spans: Vec<Span>,
    /// The space of the whole run without the bodies that fly far away; only their starts count. `None` if there are none.
    pub without_strays: Option<Span>,
    /// The first passage of a body through each given plane or ground; empty if contacts stop bodies.
    pub crossings: Vec<Crossing>,
    /// The first two bodies that move into each other; `None` if contacts stop bodies.
    pub overlap: Option<Overlap>,
    /// The first body whose start differs from the scene, because of joints.
    pub corrected: Option<Corrected>,
    /// The largest sizes of the things shown beside the bodies.
    pub asked: Asked,
    /// The largest energy error, relative to the largest kinetic energy of the whole run. (The drift of a single
    /// [`Balance`](crate::dynamics::Balance) is relative to the largest so far, which is small at the start of a run from rest.)
    pub drift: f64,
    /// The same error relative to the converted energy: the largest kinetic energy, or the energy taken by contacts, if that is more.
    /// Bodies that only settle hardly move, while a first-order method has an error of ½ Δt F·v.
    pub drift_of_turnover: f64,
    /// Totals of the contacts up to the last frame. `None` without contacts.
    pub contacts: Option<ContactTotals>,
    /// The real timestep, s.
    pub timestep: f64,
    /// The number of timesteps from one frame to the next.
    pub steps_per_frame: u32,
}

/// Totals of the contacts in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactTotals {
    /// The number of impacts.
    pub impacts: f64,
    /// The energy that they have taken, J.
    pub lost: f64,
    /// The energy that friction has taken between impacts, J.
    pub rubbed: f64,
    /// The greatest penetration of bodies in any frame, m.
    pub penetration: f64,
    /// The largest error of a joint in any frame, m.
    pub joints: f64,
}

impl ContactTotals {
    /// The same totals; amounts within the rounding error of the largest kinetic energy (J) become 0.
    fn rounded(self, largest_kinetic: f64) -> ContactTotals {
        const ROUNDING: f64 = 1e-11;
        let round = |taken: f64| if taken.abs() <= ROUNDING * largest_kinetic { 0.0 } else { taken };
        ContactTotals { lost: round(self.lost), rubbed: round(self.rubbed), ..self }
    }
}

/// Simulates a scene to find the space that it takes; `seen` receives every frame.
///
/// # Errors
/// If the run becomes non-finite.
pub fn survey(scene: &Scene, mut seen: impl FnMut(&Frame)) -> Result<Survey, SimulateError> {
    let mut surveyor = Surveyor::new(scene);
    for frame in Frames::new(scene) {
        let frame = frame?;
        surveyor.see(&frame);
        seen(&frame);
    }
    Ok(surveyor.finish())
}

/// The number of particles of an emitter that are followed, to estimate the space of all.
const SOME_PARTICLES: f64 = 500.0;

/// Surveys a run whose frames come from elsewhere.
pub struct Surveyor<'a> {
    scene: &'a Scene,
    spans: Spans,
    /// The watched planes. Each knows the bodies that may pass through it, from their first frame on.
    planes: Vec<Watched>,
    /// The bodies that forces move, listed once for all planes.
    free: Vec<usize>,
    /// The bodies that forces move and that have not been present yet.
    awaited: Vec<usize>,
    /// For each body, whether it has passed through a plane.
    crossed: Vec<bool>,
    overlaps: Watch<'a>,
    /// Some of the particles, to estimate their space.
    clouds: Clouds,
    corrected: Option<Corrected>,
    asked: Asked,
    /// The arrows of joints: their ends, quantities and scales.
    joint_arrows: Vec<(JointEnd, Quantity, Option<f64>)>,
    contacts: Option<ContactTotals>,
    /// The largest energy error, J.
    error: f64,
    largest_kinetic: f64,
}

impl Survey {
    /// The box around the whole run; `None` if all bodies are planes.
    pub fn bounds(&self) -> Option<Bounds> {
        self.spans.last().map(|span| span.bounds)
    }
}

impl<'a> Surveyor<'a> {
    /// A surveyor of a run that has not begun.
    pub fn new(scene: &'a Scene) -> Surveyor<'a> {
        Surveyor {
            scene,
            spans: Spans::default(),
            planes: planes(scene),
            free: free(scene).collect(),
            awaited: free(scene).collect(),
            crossed: vec![false; scene.bodies.len()],
            overlaps: Watch::new(scene),
            clouds: Clouds::thinned(scene, SOME_PARTICLES),
            corrected: None,
            asked: Asked::new(scene),
            joint_arrows: joint_arrows(scene),
            contacts: scene.simulation.contacts.map(|_| ContactTotals::default()),
            error: 0.0,
            largest_kinetic: 0.0,
        }
    }

    /// Updates the survey with the next frame of the run.
    pub fn see(&mut self, frame: &Frame) {
        let scene = self.scene;
        let mut come: Vec<&BodySnapshot> = Vec::new();
        self.awaited.retain(|&id| {
            come.extend(frame.body(id));
            frame.body(id).is_none()
        });
        for plane in &mut self.planes {
            plane.see(scene, frame, (&self.free, &come), &mut self.crossed);
        }
        self.overlaps.see(frame);
        if frame.index == 0 {
            self.corrected = Corrected::find(scene, frame);
        }
        let loads = super::loads(scene, frame);
        self.asked.see(scene, frame, &loads);
        // A body that has passed through a plane is behind the scenery, so the camera need not follow it.
        let counts = |body: &&BodySnapshot| !self.crossed[body.id];
        let joints = self.joint_arrows.iter().filter_map(|(end, quantity, scale)| {
            let (root, vector) = end.arrow(*quantity, frame)?;
            Some(JointArrow { quantity: *quantity, scale: *scale, root, vector })
        });
        let loads = loads.into_iter().map(|load| JointArrow {
            quantity: load.quantity,
            scale: load.arrow.scale,
            root: load.root,
            vector: load.vector,
        });
        self.spans.see(scene, frame.time, frame.bodies.iter().filter(counts), joints.chain(loads));
        self.clouds.note(frame);
        if let Some(here) = self.clouds.bounds(scene) {
            self.spans.see_particles(scene, frame.time, here);
        }
        if let Some(contacts) = &mut self.contacts {
            let accounts = &frame.balance.accounts;
            // Both remove energy; the subtraction avoids a negative zero.
            let [lost, rubbed] = [accounts.impacts, accounts.friction].map(|account| 0.0 - account);
            let penetration = contacts.penetration.max(frame.penetration);
            let gap = |joint: &Joint| joint.kind.gap(|id| frame.body(id.index()).copied());
            let joints = scene.joints.iter().filter_map(gap).fold(contacts.joints, f64::max);
            *contacts = ContactTotals { impacts: frame.impacts.of_run(), lost, rubbed, penetration, joints };
        }
        self.largest_kinetic = self.largest_kinetic.max(frame.balance.kinetic);
        let error_now = frame.balance.drift * self.largest_kinetic;
        if error_now.abs() > self.error.abs() {
            self.error = error_now;
        }
    }

    /// The survey after the last frame.
    pub fn finish(self) -> Survey {
        let Surveyor {
            scene,
            spans,
            planes,
            overlaps,
            clouds,
            corrected,
            asked,
            contacts,
            error,
            largest_kinetic,
            ..
        } = self;
        let interval = 1.0 / scene.simulation.frame_rate;
        // Particles need steps even if no body does.
        let steps_per_frame = world(scene).steps_within(interval).max(clouds.steps());
        let taken = contacts.map_or(0.0, |totals| totals.lost + totals.rubbed);
        let turnover = largest_kinetic.max(taken);
        Survey {
            without_strays: spans.without_strays(scene),
            spans: spans.finish(),
            crossings: planes.into_iter().filter_map(Watched::finish).collect(),
            overlap: overlaps.finish(),
            corrected,
            asked,
            contacts: contacts.map(|contacts| contacts.rounded(largest_kinetic)),
            drift: if largest_kinetic > 0.0 { error / largest_kinetic } else { 0.0 },
            drift_of_turnover: if turnover > 0.0 { error / turnover } else { 0.0 },
            timestep: interval / f64::from(steps_per_frame),
            steps_per_frame,
        }
    }

    /// The box around everything so far.
    pub fn bounds(&self) -> Option<Bounds> {
        self.spans.bounds()
    }
}

/// The requested arrows of joints in a scene.
fn joint_arrows(scene: &Scene) -> Vec<(JointEnd, Quantity, Option<f64>)> {
    let joints = scene.joints.iter().enumerate();
    let of_joint = |(number, joint): (usize, &Joint)| {
        let arrows = Quantity::OF_JOINTS.into_iter().zip(joint.arrows);
        let arrow = move |(quantity, arrow): (Quantity, Option<Arrow>)| {
            Some((JointEnd::new(scene, number), quantity, arrow?.scale))
        };
        arrows.filter_map(arrow)
    };
    joints.flat_map(of_joint).collect()
}

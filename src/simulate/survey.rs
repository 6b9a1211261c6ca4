//! Collects statistics of a whole run, before its frames are drawn.
//!
//! The survey is made while frames are recorded, or while a recording is read.

mod arrows;
mod corrected;
mod crossing;
mod curves;
mod ranges;
mod samples;
mod spreads;
mod stretched;
#[cfg(test)]
mod tests;

use arrows::Arrows;
pub use corrected::Corrected;
pub use crossing::Crossing;
use crossing::{Falls, Watched, free, planes};
use curves::Curves;
pub use curves::{CurvePoint, LeftOut};
use ranges::Ranges;
use samples::Samples;
pub use spreads::Spread;
use spreads::Spreads;
use stretched::Gaps;
pub use stretched::StretchedJoint;

use super::course::Stretch;
use super::overlap::{Overlap, Watch};
use super::particles::Clouds;
use super::requested_sizes::RequestedSizes;
use super::span::{ArrowNow, Spans};
use super::tallies::Tallies;
use super::{
    Bounds, EnergyError, EnergyScale, Frame, Frames, Measures, MomentState, SimulateError, Span, world,
};
use crate::physics::{BodySnapshot, LawResidual};
use crate::scene::Scene;

/// Bodies that fly far away from most others.
#[derive(Clone, Debug, PartialEq)]
pub struct Outliers {
    /// The indices of the bodies, the one that gets farthest first.
    pub bodies: Vec<usize>,
    /// The space of the whole run without these bodies. Of each of them, only its first frame is included.
    pub without: Span,
}

/// Statistics of a whole run.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// The space that the run takes from its start to each of several times. The last of these times is the end of the run. A body is
    /// ignored after it has passed through a plane. Empty if all bodies are planes.
    pub spans: Vec<Span>,
    /// The bodies that fly far away from most others. `None` if there are none.
    pub outliers: Option<Outliers>,
    /// Where the moving bodies are in the course of the run, without bodies that have passed through a plane. Empty if nothing moves.
    pub course: Vec<Stretch>,
    /// The first passage of a body through each plane, including a ground with a given height. Empty in scenes with contacts.
    pub crossings: Vec<Crossing>,
    /// The first body that falls below height 0 without end, in a scene with a ground and gravity, but no contacts.
    pub fall: Option<Crossing>,
    /// The first two bodies that move into each other. `None` if there are none, or if the scene has contacts.
    pub overlap: Option<Overlap>,
    /// The first body whose initial velocity was changed by joints. `None` if the joints changed nothing.
    pub corrected: Option<Corrected>,
    /// The largest sizes of the requested arrows, trails, ghosts, springs and sliders.
    pub requested: RequestedSizes,
    /// The largest energy error, relative to the energy that `drift_scale` names. (The drift of a single
    /// [`Balance`](crate::physics::Balance) is relative to the largest kinetic energy so far, which is small at the start of a run from rest.)
    pub drift: f64,
    /// The energy that the drift is relative to.
    pub drift_scale: EnergyScale,
    /// The amount of the energy that the drift is relative to, J.
    pub drift_energy: f64,
    /// Statistics of the contacts up to the last frame. `None` in scenes without contacts.
    pub contacts: Option<ContactTotals>,
    /// The worst residual in the run of each law that no contact can break. Empty without event-driven contacts.
    pub laws: Vec<LawResidual>,
    /// The joint that gives way most under time-stepping. `None` if all joints hold well.
    pub stretched: Option<StretchedJoint>,
    /// The points of each curve of all plots, in the order of the scene. In long runs, only the points with the lowest and the highest
    /// values of neighboring frames.
    pub curves: Vec<Vec<CurvePoint>>,
    /// The values of the first and the last color of each color map, in the order of the scene.
    pub color_ranges: Vec<[f64; 2]>,
    /// The values of the first and the last number of each map of other looks, in the order of the scene.
    pub value_ranges: Vec<[f64; 2]>,
    /// How many values of each of these curves a logarithmic axis leaves out.
    pub left_out: Vec<LeftOut>,
    /// The values of the bodies in each histogram, in the order of the scene.
    pub spreads: Vec<Spread>,
    /// A sample of the frames, without trails and particles, to choose the places of texts. Empty if all texts of the scene stand still.
    pub samples: Vec<Frame>,
    /// The actual timestep, s: the interval between frames, divided into equal steps.
    pub timestep: f64,
    /// The number of timesteps from one frame to the next.
    pub steps_per_frame: u32,
}

/// Statistics of the contacts in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactTotals {
    /// The number of impacts.
    pub impacts: f64,
    /// The energy removed by impacts, J.
    pub lost: f64,
    /// The energy removed by friction between impacts, J.
    pub rubbed: f64,
    /// The largest penetration between two bodies in any frame, m.
    pub penetration: f64,
    /// The largest gap of a joint in any frame, m.
    pub joints: f64,
    /// The energy removed by joints, J: when they hit limits, and in time stepping also when they give way.
    pub taken_by_joints: f64,
}

impl ContactTotals {
    /// Replaces energies by 0 if they are within the rounding error of all energies. `magnitude` is the largest sum of the kinetic energy and
    /// the magnitude of the potential energy, J.
    fn rounded(self, magnitude: f64) -> ContactTotals {
        /// Energies up to this fraction of `magnitude` count as rounding errors.
        const RELATIVE_ROUNDING: f64 = 1e-11;
        let round = |taken: f64| if taken.abs() <= RELATIVE_ROUNDING * magnitude { 0.0 } else { taken };
        ContactTotals { lost: round(self.lost), rubbed: round(self.rubbed), ..self }
    }
}

/// Simulates a scene and returns its survey. Calls `seen` with every frame.
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

/// The number of particles of each emitter that the survey follows, to estimate the space of all particles.
const SOME_PARTICLES: f64 = 500.0;

/// Makes the survey of a run from its frames.
pub struct Surveyor<'a> {
    scene: &'a Scene,
    spans: Spans,
    /// The planes that are watched for bodies passing through them. Each has a list of bodies that were not in contact with it at first.
    planes: Vec<Watched>,
    falls: Falls,
    /// The indices of the bodies that forces move, shared by all planes.
    free: Vec<usize>,
    /// The indices of the bodies that forces move and that have not yet been present.
    awaited: Vec<usize>,
    /// For each body, whether it has passed through a plane.
    crossed: Vec<bool>,
    overlaps: Watch<'a>,
    /// A selection of the particles, to estimate the space of all.
    clouds: Clouds,
    corrected: Option<Corrected>,
    requested: RequestedSizes,
    arrows: Arrows<'a>,
    measures: Measures,
    contacts: Option<ContactTotals>,
    laws: Vec<LawResidual>,
    gaps: Gaps,
    /// The largest energy error so far.
    error: EnergyError,
    tallies: Tallies,
    curves: Curves<'a>,
    ranges: Ranges<'a>,
    spreads: Spreads<'a>,
    samples: Samples,
}

impl Survey {
    /// The laws that no contact can break, but that the run has broken by more than rounding errors, with the worst time of each.
    pub fn broken_laws(&self) -> impl Iterator<Item = &LawResidual> {
        self.laws.iter().filter(|residual| residual.is_broken())
    }

    /// The box around all bodies and particles in the whole run. `None` if all bodies are planes.
    pub fn bounds(&self) -> Option<Bounds> {
        self.spans.last().map(|span| span.bounds)
    }
}

impl<'a> Surveyor<'a> {
    /// Creates a surveyor at the start of a run.
    pub fn new(scene: &'a Scene) -> Surveyor<'a> {
        Surveyor {
            scene,
            spans: Spans::new(scene),
            planes: planes(scene),
            falls: Falls::new(scene),
            free: free(scene).collect(),
            awaited: free(scene).collect(),
            crossed: vec![false; scene.bodies.len()],
            overlaps: Watch::new(scene),
            clouds: Clouds::thinned(scene, SOME_PARTICLES),
            corrected: None,
            requested: RequestedSizes::new(scene),
            arrows: Arrows::new(scene),
            measures: Measures::new(scene),
            contacts: scene.simulation.contacts.map(|_| ContactTotals::default()),
            laws: Vec::new(),
            gaps: Gaps::new(scene),
            error: EnergyError::default(),
            tallies: Tallies::new(scene),
            curves: Curves::new(scene),
            ranges: Ranges::new(scene),
            spreads: Spreads::new(scene),
            samples: Samples::new(scene),
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
            plane.see(scene, frame, &self.free, &come, &mut self.crossed);
        }
        self.falls.see(scene, frame);
        self.overlaps.see(frame);
        if frame.index == 0 {
            self.corrected = Corrected::find(scene, frame);
        }
        let loads = super::loads(scene, frame);
        self.requested.see(scene, frame, &loads);
        // The camera need not show a body behind a plane that it has passed through.
        let counts = |body: &&BodySnapshot| !self.crossed[body.id];
        let loads = loads.into_iter().map(|load| ArrowNow {
            quantity: load.quantity,
            scale: load.arrow.scale,
            root: load.root,
            vector: load.vector,
        });
        self.tallies.note(frame);
        self.samples.see(frame, self.tallies.so_far());
        let moment = MomentState::with_past(frame, self.tallies.so_far());
        let of_forces = self.arrows.of_forces(frame, &moment, &self.measures);
        self.requested.see_forces(&of_forces);
        let of_forces = of_forces.into_iter().map(|(_, arrow)| arrow);
        let arrows = self.arrows.of_joints(frame).chain(loads).chain(of_forces);
        self.spans.see(scene, frame.time, frame.bodies.iter().filter(counts), arrows);
        self.clouds.note(frame);
        if let Some(here) = self.clouds.bounds(scene) {
            self.spans.see_particles(scene, frame.time, here);
        }
        if let Some(contacts) = &mut self.contacts {
            let accounts = &frame.balance.accounts;
            // The accounts are negative, since contacts remove energy. `0.0 - account` avoids a negative zero.
            let [lost, rubbed, taken_by_joints] =
                [accounts.impacts, accounts.friction, accounts.limits].map(|account| 0.0 - account);
            let penetration = contacts.penetration.max(frame.penetration);
            self.gaps.add(scene, frame);
            let joints = self.gaps.largest();
            *contacts = ContactTotals {
                impacts: frame.impacts.of_run(),
                lost,
                rubbed,
                penetration,
                joints,
                taken_by_joints,
            };
        }
        self.laws.clone_from(&frame.laws);
        self.error.add(&frame.balance);
        self.curves.see(&moment, &self.measures);
        self.ranges.see(&moment, &self.measures);
        self.spreads.see(&moment, &self.measures, frame.index);
    }

    /// Returns the survey after the last frame.
    pub fn finish(self) -> Survey {
        let Surveyor {
            scene,
            spans,
            planes,
            falls,
            overlaps,
            clouds,
            corrected,
            requested,
            contacts,
            laws,
            gaps,
            error,
            curves,
            ranges,
            spreads,
            samples,
            ..
        } = self;
        let interval = scene.simulation.timeline.interval();
        // A scene without bodies still has particle steps.
        let steps_per_frame = world(scene).steps_within(interval).max(clouds.steps());
        let law = scene.simulation.contacts;
        let (drift_scale, drift_energy) = error.scale(law);
        let (curves, left_out) = curves.finish();
        let outliers = spans.outliers(scene);
        let (spans, course) = spans.finish();
        let (color_ranges, value_ranges) = ranges.finish();
        Survey {
            outliers,
            spans,
            course,
            crossings: planes.into_iter().filter_map(Watched::finish).collect(),
            fall: falls.finish(),
            overlap: overlaps.finish(),
            corrected,
            requested,
            contacts: contacts.map(|contacts| contacts.rounded(error.magnitude)),
            laws,
            stretched: gaps.finish(scene),
            curves,
            left_out,
            spreads: spreads.finish(),
            samples: samples.finish(),
            color_ranges,
            value_ranges,
            drift: error.drift(law),
            drift_scale,
            drift_energy,
            timestep: interval / f64::from(steps_per_frame),
            steps_per_frame,
        }
    }

    /// The box around all bodies and particles so far. `None` if all bodies are planes.
    pub fn bounds(&self) -> Option<Bounds> {
        self.spans.bounds()
    }
}

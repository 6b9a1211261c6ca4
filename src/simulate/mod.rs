//! Checked scene → world → recording → frames.
//!
//! Only this module connects a [`Scene`] with the [`physics`]. A scene is simulated once; all code that draws, measures or exports reads
//! the recording.
//!
//! | what | where |
//! | --- | --- |
//! | the world of a scene | `build` |
//! | the requested moments | `moments` |
//! | the run while it is computed | `simulation` |
//! | all moments of a run, readable in any order | `recording`, `record` |
//! | the frames in order, with trails and ghosts | `frames`, `past`, `followed_points` |
//! | the frames in order, without a recording | `snapshots` |
//! | the particles of emitters | `particles`, `swarms` |
//! | the moments while a shutter is open | `exposure` |
//! | errors of a run, and their diagnostics | this file, `diverged`, `diagnose` |
//! | statistics of the whole run | `survey`, `span`, `reach`, `overlap`, `energy_error`, `requested_sizes` |
//!
//! # From the scene to the world
//!
//! `build.rs` chooses the engine and makes its world: `build/forces.rs` makes the forces of a world from those of the scene,
//! `build/joints.rs` its joints. It passes the surfaces of the bodies, and the pairs without contacts, to the world. The ground is a plane
//! that is added to the world after all bodies of the scene, and removed from each snapshot. Frame k is at time k / frame_rate. The timestep
//! divides the interval between frames evenly. If the motion of every body is given, there are no steps.
//!
//! # The recording
//!
//! A scene is simulated once. The recording holds every frame, and each moment between frames that a picture shows: for ghosts, motion blur
//! and stills (`moments.rs`). During the recording, `survey.rs` collects the extent of the motion, the drift, and overlapping bodies.
//! Drawing, measuring and exporting read the recording, in any order.
//!
//! A recording consists of pages of 32 moments or a megabyte (`recording/`). Within a page, a moment holds only the bodies and joints that
//! changed since the previous moment, so bodies at rest cost nothing. A moving body takes up to 128 bytes in each moment. A `Store` keeps
//! the pages, so that memory does not grow with the number of frames.
//!
//! Impacts are events. Each moment of a recording holds the impacts since the previous moment, its contacts, and the counts of impacts so
//! far, so that each frame can be read without the others. `impacts.rs` counts them for the run, for each body, and for the pairs that a
//! label asks for.
//!
//! # Frames
//!
//! A frame holds the present bodies, in the order of their ids. All code looks bodies up by id: `Frame::body` returns `None` while a body is
//! absent. An absent body has no line in any script or table, and no arrows, coils or labels; its ghosts and its trail stay. A camera that
//! follows it stays where it was (`followed_points.rs`), and in a model it has the size 0.
//!
//! A trail has a corner at each impact of its body (`past/corners.rs`): two points at the same time, with the velocities before and after
//! the impact. The recorded impact does not contain the location of the body's center, which is computed from the neighboring frames.
//!
//! `joint_angles.rs` adds servos to the reactions of joints, and counts the full turns of hinges from the rates at successive moments.
//!
//! # Particles
//!
//! Particles (`particles.rs`) are not recorded. Each depends only on the seed, the name of its emitter, its number, the forces and the
//! recorded bodies, so particles are computed while frames are read. Reading may begin at a later frame. Then the computation begins at the
//! birth of the oldest particle that can still exist in that frame; the longest lifetime is known beforehand. The bits are the same. For the
//! camera, the survey follows about 500 particles of each emitter.
//!
//! # Survey and camera
//!
//! The default camera must show the tips of arrows, whose scale depends on its view. So the survey stores, for each direction, the reach of
//! the tips as a function of the scale (`reach.rs`: the upper envelope of lines), and one simulation is enough. It also stores the extents
//! of the motion up to several times (`span.rs`).
//!
//! The total number of pair interactions of a run is computed beforehand (`workload.rs`), so that the progress bar can move within a frame.

mod approaches;
mod build;
mod course;
mod diagnose;
mod diverged;
mod energy_error;
mod exposure;
mod fields;
mod followed_points;
mod frame;
mod frames;
mod impacts;
mod joint_angles;
mod loads;
mod marks;
mod measures;
mod moments;
mod outliers;
mod overlap;
mod particles;
mod past;
mod populations;
mod reach;
mod record;
mod recording;
mod requested_sizes;
mod sectors;
mod selection;
mod simulation;
mod snapshots;
mod span;
mod survey;
mod swarms;
mod tallies;
#[cfg(test)]
mod tests;
mod vectors;
mod workload;

use crate::diagnostic::{self, Sources};
use crate::physics::{self, BodyId, Breakdown};
use crate::scene::force_formula::quantities_at;
use crate::scene::{ForceKind, Scene, in_string};

pub(crate) use build::forces;
pub use build::{lists_contacts, world};
pub use course::Stretch;
pub use diverged::{Cause, Diverged, ShorterStep};
pub(crate) use energy_error::EnergyError;
pub use energy_error::EnergyScale;
pub use exposure::Exposure;
pub use fields::{FieldSampler, FieldSource};
pub use followed_points::Lagging;
pub use frame::Frame;
pub use frames::{Frames, within};
pub use impacts::ImpactCounts;
pub use loads::{Load, loads, loads_on};
pub use marks::{AngleNow, DistanceNow};
pub(crate) use marks::{direction, place};
pub use measures::{Measures, MomentState, is_true};
pub use moments::Moments;
pub use overlap::Overlap;
pub(crate) use overlap::touch_at_start;
pub use particles::Swarm;
pub use past::{Ghost, GhostLook, Past, TrailPath, TrailPoint};
pub use reach::Reach;
pub use record::{Checkpoint, Recorded, Recorder};
pub use recording::{Counts, MemoryStore, Reader, Recording, Store};
pub use requested_sizes::{
    RequestedArrow, RequestedGhosts, RequestedSizes, RequestedSlider, RequestedSpring, RequestedTrail,
};
pub use sectors::Sector;
pub use selection::Selection;
pub use snapshots::Snapshots;
pub use span::{Bounds, Span};
pub use survey::{
    ContactTotals, Corrected, Crossing, CurvePoint, LeftOut, Outliers, Spread, StretchedJoint, Survey,
    Surveyor, survey,
};
pub use swarms::Swarms;
pub(crate) use vectors::anchors;
pub use vectors::{JointEnd, axis, root, shown, surface};
pub use workload::{Workload, evaluations};

/// The reason why a run cannot be simulated or read.
#[derive(Clone, Debug, PartialEq)]
pub enum SimulateError {
    /// The state became non-finite.
    Diverged(Box<Diverged>),
    /// The formula of a force has no finite value.
    Undefined(Box<Undefined>),
    /// The constraints of a joint cannot be satisfied.
    Broken(Box<Broken>),
    /// The contact between two bodies cannot be computed.
    Stuck(Box<Stuck>),
    /// No timestep is short enough for the motion of a body.
    Stalled(Box<Stalled>),
    /// The recording cannot be written or read. The text is the message.
    Recording(String),
}

/// The error of a force whose formula has no finite value for a body.
#[derive(Clone, Debug)]
pub struct Undefined {
    /// The name of the force.
    pub force: String,
    /// The name of the body on which the force acts.
    pub body: String,
    /// The time of the evaluation, s.
    pub time: f64,
    /// The cause: the code and the message of the diagnostic, and the label at its span.
    pub why: (diagnostic::Code, String, String),
    /// The span of the failed operation, and the texts that the scene was read from.
    pub place: (Option<diagnostic::Span>, Sources),
}

impl PartialEq for Undefined {
    /// Ignores the span and the texts of the scene.
    fn eq(&self, other: &Undefined) -> bool {
        (&self.force, &self.body, self.time, &self.why) == (&other.force, &other.body, other.time, &other.why)
    }
}

impl Undefined {
    /// Creates the error for a force, given by its index in the world. Returns `None` if the force has no formula.
    fn of(scene: &Scene, force: usize, at: &physics::Undefined) -> Option<Undefined> {
        let gravity = usize::from(scene.simulation.gravity != glam::DVec3::ZERO);
        let mut number = force.checked_sub(gravity)?;
        let force = scene.forces.iter().find(|force| {
            let count = build::forces(&force.kind).len();
            let is_it = number < count;
            number = number.saturating_sub(count);
            is_it
        })?;
        let ForceKind::Formula { law, .. } = &force.kind else { return None };
        let body = scene.bodies.get(at.body.index())?;
        let sources = scene.warnings.sources.clone();
        let (why, span) = match law.explain(&quantities_at(at, body.start.mass, body.start.charge)) {
            Some((formula, error)) => {
                let span = formula.span();
                let raw = sources.raw(span);
                let place = in_string(raw, formula.text(), &error.range, span);
                ((error.code, error.message, error.label), Some(place))
            }
            None => ((diagnostic::Code::NotFinite, "it has no finite value".to_owned(), String::new()), None),
        };
        Some(Undefined {
            force: force.name.clone(),
            body: body.name.to_string(),
            time: at.time,
            why,
            place: (span, sources),
        })
    }
}

impl std::fmt::Display for Undefined {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Undefined { force, body, time, why: (_, message, _), .. } = self;
        write!(f, "at t = {time} s the force `{force}` has no value on `{body}`: {message}")
    }
}

impl std::error::Error for Undefined {}

/// The error of an adaptive method that found no timestep short enough.
#[derive(Clone, Debug)]
pub struct Stalled {
    /// The name of the body whose motion changes too fast.
    pub body: String,
    /// The time at which the method failed, s.
    pub time: f64,
    /// The span of the body's name, and the texts that the scene was read from.
    pub place: (Option<diagnostic::Span>, Sources),
}

impl PartialEq for Stalled {
    /// Ignores the span and the texts of the scene.
    fn eq(&self, other: &Stalled) -> bool {
        (&self.body, self.time) == (&other.body, other.time)
    }
}

/// The error of a joint whose constraints cannot be satisfied.
#[derive(Clone, Debug)]
pub struct Broken {
    /// The name of the joint.
    pub joint: String,
    /// The time at which the joint failed, s.
    pub time: f64,
    /// The remaining violation of the joint's constraints: m, or rad for a rotation.
    pub missing: f64,
    /// Whether a motion that the scene prescribes may pull the joint apart, so that no smaller step helps.
    pub is_driven: bool,
    /// The span of the joint's name, and the texts that the scene was read from.
    pub place: (Option<diagnostic::Span>, Sources),
}

impl PartialEq for Broken {
    /// Ignores the span and the texts of the scene.
    fn eq(&self, other: &Broken) -> bool {
        (&self.joint, self.time, self.missing) == (&other.joint, other.time, other.missing)
    }
}

/// The reason why a contact cannot be computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Why {
    /// The bodies overlap by this depth, m, when their contact begins.
    Overlaps(f64),
    /// The bodies are jammed: their impacts have no end.
    Jams,
    /// No impulses were found that do not add energy. The number is the energy that they would add, J.
    AddsEnergy(f64),
}

/// The error of a contact that cannot be computed.
#[derive(Clone, Debug)]
pub struct Stuck {
    /// The names of the two touching bodies; `None` for the ground.
    pub bodies: [Option<String>; 2],
    /// The time at which the contact failed, s.
    pub time: f64,
    /// Why the contact cannot be computed.
    pub why: Why,
    /// The spans of the bodies' names, and the texts that the scene was read from.
    pub place: (Vec<diagnostic::Span>, Sources),
}

impl PartialEq for Stuck {
    /// Ignores the spans and the texts of the scene.
    fn eq(&self, other: &Stuck) -> bool {
        (&self.bodies, self.time, self.why) == (&other.bodies, other.time, other.why)
    }
}

impl Stuck {
    fn of(scene: &Scene, ids: [BodyId; 2], time: f64, why: Why) -> Stuck {
        let ids = ids.map(BodyId::index);
        let bodies = ids.map(|id| Some(scene.bodies.get(id)?.name.to_string()));
        let spans = ids.iter().filter_map(|&id| scene.places.bodies.get(id).copied()).collect();
        Stuck { bodies, time, why, place: (spans, scene.warnings.sources.clone()) }
    }
}

impl SimulateError {
    /// Converts a breakdown of the dynamics into an error that gives the bodies, joints and forces their names in the scene.
    fn of(scene: &Scene, error: Breakdown) -> SimulateError {
        match error {
            Breakdown::Diverged { body, time } => {
                SimulateError::Diverged(Box::new(Diverged::of(scene, body, time)))
            }
            Breakdown::Undefined { force, at } => match Undefined::of(scene, force, &at) {
                Some(undefined) => SimulateError::Undefined(Box::new(undefined)),
                None => SimulateError::of(scene, Breakdown::Diverged { body: at.body, time: at.time }),
            },
            Breakdown::Overlapping { bodies, time, depth } => {
                SimulateError::Stuck(Box::new(Stuck::of(scene, bodies, time, Why::Overlaps(depth))))
            }
            Breakdown::Jammed { bodies, time } => {
                SimulateError::Stuck(Box::new(Stuck::of(scene, bodies, time, Why::Jams)))
            }
            Breakdown::AddsEnergy { bodies, time, energy } => {
                SimulateError::Stuck(Box::new(Stuck::of(scene, bodies, time, Why::AddsEnergy(energy))))
            }
            Breakdown::Stalled { body, time } => {
                let span = scene.places.bodies.get(body.index()).copied();
                let place = (span, scene.warnings.sources.clone());
                let body = scene.bodies[body.index()].name.to_string();
                SimulateError::Stalled(Box::new(Stalled { body, time, place }))
            }
            Breakdown::Broken { constraint, time, missing } => {
                let joint = scene.joints[constraint].name.clone();
                let span = scene.places.joints.get(constraint).copied();
                let place = (span, scene.warnings.sources.clone());
                let is_driven = diagnose::is_driven(scene);
                SimulateError::Broken(Box::new(Broken { joint, time, missing, is_driven, place }))
            }
        }
    }
}

impl std::fmt::Display for Stalled {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Stalled { body, time, .. } = self;
        write!(f, "the run cannot go on: at t = {time} s no step is short enough for `{body}`")
    }
}

impl std::error::Error for Stalled {}

impl std::fmt::Display for Broken {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Broken { joint, time, missing, .. } = self;
        if *time == 0.0 {
            return write!(f, "the joint `{joint}` does not hold at the start: {missing:.3e} m are missing");
        }
        write!(f, "the joint `{joint}` cannot be kept: at t = {time} s it is off by {missing:.3e} m")
    }
}

impl std::error::Error for Broken {}

impl std::fmt::Display for Stuck {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names =
            self.bodies.clone().map(|name| name.map_or("the ground".to_owned(), |name| format!("`{name}`")));
        let ([one, two], time) = (names, self.time);
        let short = |value: f64| format!("{value:.3e}").parse().unwrap_or(value);
        match self.why {
            Why::Overlaps(depth) => {
                let depth = short(depth);
                write!(f, "{one} and {two} overlap by {depth} m at t = {time} s, where their contact begins")
            }
            Why::Jams => {
                write!(f, "the impacts of {one} and {two} do not end: at t = {time} s they are jammed")
            }
            Why::AddsEnergy(gained) => {
                let gained = short(gained);
                write!(
                    f,
                    "contacts of {one} and {two} would add {gained} J at t = {time} s, which no contact can"
                )
            }
        }
    }
}

impl std::error::Error for Stuck {}

impl std::fmt::Display for SimulateError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            SimulateError::Diverged(error) => error.fmt(f),
            SimulateError::Undefined(error) => error.fmt(f),
            SimulateError::Broken(error) => error.fmt(f),
            SimulateError::Stuck(error) => error.fmt(f),
            SimulateError::Stalled(error) => error.fmt(f),
            SimulateError::Recording(message) => f.write_str(message),
        }
    }
}

impl std::error::Error for SimulateError {}

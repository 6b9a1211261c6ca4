//! Records the poses of all moving objects in all frames: first bodies, then cameras, lights, springs and joints.

use glam::{DQuat, DVec3};

use super::container::MAX_FILE_SIZE;
use super::visibility::Visibility;
use crate::export::ExportError;
use crate::picture::Pace;
use crate::scene::Body;
use crate::simulate::{Recorded, Selection};

/// The motion of all bodies, cameras, lights, springs and joints in the selected frames.
pub(super) struct SampledMotion {
    /// The times of the frames in the animation, s.
    times: Vec<f32>,
    /// The ratio of the time of the animation to the simulated time.
    slower: f64,
    ways: Vec<NodeMotion>,
    /// The size of the binary data in the file so far, checked against the size of the largest possible file.
    pub(super) budget: SizeBudget,
}

/// A location in world axes, m, and an orientation.
#[derive(Clone, Copy)]
pub(super) struct NodePose {
    pub(super) location: DVec3,
    pub(super) orientation: DQuat,
}

/// The recorded motion of one object.
pub(super) struct NodeMotion {
    /// The pose of the object in the first frame.
    pub(super) start: NodePose,
    /// The locations in all frames, m, with three numbers for each. Empty if the location never changes.
    pub(super) translations: Vec<f32>,
    /// The orientations in all frames as quaternions x, y, z, w. Empty if the orientation never changes.
    pub(super) rotations: Vec<f32>,
    /// The size of the object along its own axes in the first frame.
    pub(super) size: DVec3,
    /// The sizes in all frames, with three numbers for each. Empty if the size never changes.
    pub(super) scales: Vec<f32>,
    /// The times at which the object is present.
    pub(super) shown: Visibility,
    /// The orientation in the latest frame. The quaternions q and −q are the same orientation; this is the one nearer to the previous
    /// frame's.
    last: DQuat,
}

impl SampledMotion {
    /// Records the motion of the bodies in the selected frames of a run.
    pub(super) fn of(run: &Recorded<'_>, selection: &Selection) -> Result<SampledMotion, ExportError> {
        let scene = run.scene();
        let count = selection.count_within(scene.simulation.timeline.frames());
        let mut rate = scene.simulation.timeline.frame_rate;
        if !Pace::RATES.contains(&rate) {
            rate = Pace::USUAL_RATE;
        }
        let slower = scene.simulation.timeline.frame_rate / rate;
        let mut times = Vec::with_capacity(count);
        let mut budget = SizeBudget::default();
        budget.take(count)?;
        let mut bodies = Recorder::new(count);
        let pose = |location, orientation: DQuat| NodePose { location, orientation: orientation.normalize() };
        // An absent body stays at its last pose, or waits at the pose at which it will appear.
        let start = |body: &Body| pose(body.start.location, body.start.orientation);
        let mut poses: Vec<NodePose> = scene.bodies.iter().map(start).collect();
        for exposure in run.exposures(selection) {
            let frame = exposure?.frame;
            times.push((scene.simulation.timeline.speed.film_time(frame.time) * slower) as f32);
            for body in &frame.bodies {
                poses[body.id] = pose(body.location, body.orientation);
            }
            let name = |body: usize| scene.bodies[body].name.to_string();
            bodies.add(poses.iter().copied(), frame.time, name, &mut budget)?;
            for (id, way) in bodies.ways.iter_mut().enumerate() {
                way.shown.add(frame.body(id).is_some(), &times, &mut budget)?;
            }
        }
        Ok(SampledMotion { times, slower, ways: bodies.ways, budget })
    }

    /// Appends the motion of cameras, lights, springs or joints.
    pub(super) fn append(&mut self, recorder: Recorder) {
        self.ways.extend(recorder.ways);
    }

    /// Returns the times of the frames in the animation, s.
    pub(super) fn times(&self) -> &[f32] {
        &self.times
    }

    /// Returns the ratio of the simulated time to the time of the animation.
    pub(super) fn faster(&self) -> f64 {
        1.0 / self.slower
    }

    /// Returns the motion of all bodies, in the order of the scene, and then of the appended objects.
    pub(super) fn ways(&self) -> &[NodeMotion] {
        &self.ways
    }

    /// Yields all numbers in the order of the file: the times of the frames, and for each object its locations, orientations, sizes and
    /// presence.
    pub(super) fn numbers(&self) -> impl Iterator<Item = &[f32]> {
        let ways =
            self.ways.iter().flat_map(|NodeMotion { translations, rotations, scales, shown, .. }| {
                [&translations[..], &rotations[..], &scales[..], &shown.times[..], &shown.scales[..]]
            });
        std::iter::once(&self.times[..]).chain(ways)
    }
}

/// Records the poses of several objects, frame after frame.
pub(super) struct Recorder {
    ways: Vec<NodeMotion>,
    /// The number of frames recorded so far (`known`), and the total number of frames (`count`).
    known: usize,
    count: usize,
}

impl Recorder {
    /// Makes an empty recorder for this number of frames.
    pub(super) fn new(count: usize) -> Recorder {
        Recorder { ways: Vec::new(), known: 0, count }
    }

    /// Records the poses of all objects in a frame. Fails if the file would become too large or a location is not finite as `f32`. `name`
    /// returns the name of an object for the error.
    pub(super) fn add(
        &mut self,
        poses: impl Iterator<Item = NodePose>,
        time: f64,
        name: impl Fn(usize) -> String,
        budget: &mut SizeBudget,
    ) -> Result<(), ExportError> {
        self.add_sized(poses.map(|pose| (pose, DVec3::ONE)), time, name, budget)
    }

    /// Records the poses of all objects in a frame, and their sizes along their own axes. Fails as [`Recorder::add`] does.
    pub(super) fn add_sized(
        &mut self,
        poses: impl Iterator<Item = (NodePose, DVec3)>,
        time: f64,
        name: impl Fn(usize) -> String,
        budget: &mut SizeBudget,
    ) -> Result<(), ExportError> {
        for (i, (pose, size)) in poses.enumerate() {
            if !pose.location.as_vec3().is_finite() {
                return Err(ExportError::OutOfRange { what: name(i), time });
            }
            match self.ways.get_mut(i) {
                Some(way) => way.add(pose, size, self.known, self.count, budget)?,
                None => self.ways.push(NodeMotion::new(pose, size)),
            }
        }
        self.known += 1;
        Ok(())
    }
}

impl NodeMotion {
    fn new(start: NodePose, size: DVec3) -> NodeMotion {
        let (translations, rotations, scales) = (Vec::new(), Vec::new(), Vec::new());
        NodeMotion {
            start,
            translations,
            rotations,
            size,
            scales,
            shown: Visibility::default(),
            last: start.orientation,
        }
    }

    /// Records the pose and size of one frame. `known` is the number of frames recorded before, and `count` the total number.
    fn add(
        &mut self,
        pose: NodePose,
        size: DVec3,
        known: usize,
        count: usize,
        budget: &mut SizeBudget,
    ) -> Result<(), ExportError> {
        let NodePose { location, orientation } = pose;
        // The quaternions q and −q are the same orientation. With the one farther from the previous frame's, viewers would rotate the long
        // way round.
        self.last = if orientation.dot(self.last) < 0.0 { -orientation } else { orientation };
        let start = self.start.location.as_vec3().to_array();
        follow(&mut self.translations, start, location.as_vec3().to_array(), known, count, budget)?;
        let start = self.start.orientation.as_quat().to_array();
        follow(&mut self.rotations, start, self.last.as_quat().to_array(), known, count, budget)?;
        let start = self.size.as_vec3().to_array();
        follow(&mut self.scales, start, size.as_vec3().to_array(), known, count, budget)
    }
}

/// Records one value after `known` earlier ones. Nothing is stored as long as all values equal `start`. At the first different value, the
/// `known` earlier values are stored, too.
fn follow<const N: usize>(
    values: &mut Vec<f32>,
    start: [f32; N],
    value: [f32; N],
    known: usize,
    count: usize,
    budget: &mut SizeBudget,
) -> Result<(), ExportError> {
    if values.is_empty() {
        if value == start {
            return Ok(());
        }
        budget.take(N * count)?;
        values.reserve_exact(N * count);
        (0..known).for_each(|_| values.extend(start));
    }
    values.extend(value);
    Ok(())
}

/// The number of bytes that the recorded numbers will take in the file.
#[derive(Default)]
pub(super) struct SizeBudget(u64);

impl SizeBudget {
    /// Counts this many further numbers of 4 bytes. Fails if the file would become too large.
    pub(super) fn take(&mut self, numbers: usize) -> Result<(), ExportError> {
        self.0 += 4 * numbers as u64;
        if self.0 > MAX_FILE_SIZE { Err(ExportError::TooLarge(self.0)) } else { Ok(()) }
    }
}

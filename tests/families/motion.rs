//! The runs of drawn scenes, and how far two runs part.

use glam::{DQuat, DVec3};
use jabuka::{Run, Scene};

use super::change::Change;
use super::drawn::{Body, Drawn, Shape};
use super::random::Random;

/// What a run shows of a body at one moment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    pub(crate) location: DVec3,
    pub(crate) velocity: DVec3,
    pub(crate) orientation: DQuat,
    pub(crate) angular_velocity: DVec3,
}

/// A run: for each frame and each body, what it shows; `None` while the body is absent.
pub(crate) struct Course(pub(crate) Vec<Vec<Option<Seen>>>);

/// Why there is no run.
pub(crate) enum Failure {
    /// The scene is not valid, or cannot be started.
    Scene(String),
    /// The run ends early.
    Run(String),
}

/// Runs a scene.
pub(crate) fn run(scene: &Drawn) -> Result<Course, Failure> {
    let text = scene.text();
    let parsed = Scene::parse(&text).map_err(|report| Failure::Scene(format!("{report}\n{text}")))?;
    let failed = |error: String| Failure::Run(error);
    let run = Run::new(&parsed).map_err(|error| failed(format!("{error}\n{text}")))?;
    let mut course = Vec::new();
    for frame in run.frames() {
        let frame = frame.map_err(|error| failed(format!("{error}\n{text}")))?;
        let seen = |i: usize| {
            frame.body(i).map(|body| Seen {
                location: body.location,
                velocity: body.velocity,
                orientation: body.orientation,
                angular_velocity: body.angular_velocity,
            })
        };
        course.push((0..scene.bodies.len()).map(seen).collect());
    }
    Ok(Course(course))
}

/// Returns the size of a scene, m: the largest distance from the mean of its bodies, including their own sizes.
pub(crate) fn size(scene: &Drawn) -> f64 {
    let count = scene.bodies.len() as f64;
    let mean = scene.bodies.iter().map(|body| body.location).sum::<DVec3>() / count;
    let own = |shape: Shape| match shape {
        Shape::Sphere { radius } => radius,
        Shape::Box { size } => 0.5 * size.length(),
        Shape::Cylinder { radius, height } | Shape::Capsule { radius, height } => radius + 0.5 * height,
        Shape::Plane { .. } => 0.0,
    };
    let sizes = scene.bodies.iter().map(|body| body.location.distance(mean) + own(body.shape));
    sizes.fold(0.0, f64::max)
}

/// Returns, for each frame, how far two runs have parted: the largest difference of places, as a fraction of the size of `scene`; of directions, rad; of
/// velocities and of angular velocities, as fractions of the largest speeds of the run; and what differs so much. `change` leads from the first run to the
/// second.
pub(crate) fn differences(
    scene: &Drawn,
    one: &Course,
    other: &Course,
    change: &Change,
) -> Vec<(f64, String)> {
    let size = size(scene);
    let all = || one.0.iter().flatten().flatten();
    let speed = all().map(|seen| seen.velocity.length().max(size * seen.angular_velocity.length()));
    let speed = speed.fold(SLOW * size / scene.duration, f64::max);
    let mut most = (0.0_f64, String::new());
    let mut differences = Vec::new();
    for (one, other) in one.0.iter().zip(&other.0) {
        for (i, first) in one.iter().enumerate() {
            match (first, &other[change.index(i)]) {
                (None, None) => {}
                (Some(first), Some(second)) => {
                    let second = change.undone(*second);
                    let turned = (first.orientation - second.orientation).length();
                    let turned = turned.min((first.orientation + second.orientation).length());
                    let faster = (first.velocity - second.velocity).length();
                    let spin = size * (first.angular_velocity - second.angular_velocity).length();
                    let apart = first.location.distance(second.location) / size;
                    let all = [
                        ("place", apart),
                        ("direction", 2.0 * turned),
                        ("velocity", faster / speed),
                        ("rotation", spin / speed),
                    ];
                    for (what, apart) in all {
                        let apart = if apart.is_nan() { f64::INFINITY } else { apart };
                        if apart > most.0 {
                            most = (apart, format!("{what} of {}", scene.bodies[i].name));
                        }
                    }
                }
                _ => most = (f64::INFINITY, format!("presence of {}", scene.bodies[i].name)),
            }
        }
        differences.push(most.clone());
    }
    if one.0.len() != other.0.len() {
        differences.push((f64::INFINITY, "number of frames".to_owned()));
    }
    differences
}

/// Speeds below this part of the scene's size in its duration count as rest.
const SLOW: f64 = 0.1;

/// Returns the scene with all places and velocities changed at random, by the fraction `nudge` of the scene's size and of the largest
/// speed. It tells how fast errors of this size grow.
pub(crate) fn nudged(scene: &Drawn, nudge: f64, random: &mut Random) -> Drawn {
    let mut nudged = scene.clone();
    let size = size(scene);
    let speed = scene.bodies.iter().map(|body| body.velocity.length()).fold(0.0, f64::max);
    let moves =
        |body: &&mut Body| !body.fixed && body.motion.is_none() && !matches!(body.shape, Shape::Plane { .. });
    for body in nudged.bodies.iter_mut().filter(moves) {
        body.location += random.vector(nudge * size);
        body.orientation = DQuat::from_scaled_axis(random.vector(nudge)) * body.orientation;
        body.velocity += random.vector(nudge * speed);
        body.angular_velocity += random.vector(nudge * (speed / size + body.angular_velocity.length()));
    }
    nudged
}

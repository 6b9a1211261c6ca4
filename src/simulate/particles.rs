//! The particles of a scene's emitters.
//!
//! Particles are not recorded. Each particle depends only on its number, the recorded bodies and the forces, so particles are computed
//! while frames are read. A reader that starts at a later frame computes the living particles from their births, and gets the same bits.
//! Memory does not grow with time.

use std::sync::Arc;

use glam::DVec3;

use super::{Bounds, Frame};
use crate::physics::{
    BodyId, BodySnapshot, Buoyancy, Cloud, Field, FormulaForce, J2, Method, Obstacle, Particle,
    RecordedMotion, RigidBody, Scenery, Shape, UniformGravity, World, find,
};
use crate::scene::{Body, Emitter, Force, ForceKind, Scene};

/// The particles of one emitter at one moment, in order of birth.
pub type Swarm = Arc<[Particle]>;

/// The particles of all emitters of a scene, advanced frame by frame.
#[derive(Clone)]
pub(super) struct Clouds {
    makers: Arc<[Maker]>,
    /// The obstacles that stop particles. Empty if no particles collide.
    obstacles: Arc<[Obstacle]>,
    method: &'static Method,
    clouds: Vec<Cloud>,
    /// The stride n of each emitter: only every n-th of its particles is computed.
    strides: Vec<u64>,
    /// The time between two frames (s), and the number of particle steps in this time.
    interval: f64,
    steps: u32,
    /// The time of the last frame (s), and the bodies in that frame.
    before: Option<(f64, Arc<[BodySnapshot]>)>,
    /// The first frame that the particles are computed from. Earlier frames are ignored.
    begin: usize,
}

/// An emitter, and the forces on its particles.
struct Maker {
    emitter: Emitter,
    fields: Vec<Field>,
}

impl Clouds {
    /// Creates the particles of a scene, at the start of a run.
    pub(super) fn new(scene: &Scene) -> Clouds {
        let maker = |(number, emitter): (usize, &Emitter)| {
            let fields = fields(scene, number);
            Maker { emitter: emitter.clone(), fields }
        };
        let makers: Arc<[Maker]> = scene.emitters.iter().enumerate().map(maker).collect();
        let interval = scene.simulation.timeline.interval();
        let steps = if makers.is_empty() { 1 } else { steps(scene, interval) };
        Clouds {
            strides: vec![1; makers.len()],
            makers,
            obstacles: obstacles(scene),
            method: scene.simulation.method,
            clouds: Vec::new(),
            interval,
            steps,
            before: None,
            begin: 0,
        }
    }

    /// Creates the particles of a scene, but computes only every n-th, so that at most about `most` particles of each emitter live at
    /// once.
    pub(super) fn thinned(scene: &Scene, most: f64) -> Clouds {
        let mut clouds = Clouds::new(scene);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the check of a scene limits the number of particles"
        )]
        let stride = |emitter: &Emitter| {
            (emitter.most_alive(scene.simulation.timeline.end()) / most).ceil().max(1.0) as u64
        };
        clouds.strides = scene.emitters.iter().map(stride).collect();
        clouds
    }

    /// The stride n of each emitter: only every n-th of its particles is computed.
    pub(super) fn strides(&self) -> &[u64] {
        &self.strides
    }

    /// The number of particle steps from one frame to the next.
    pub(super) fn steps(&self) -> u32 {
        self.steps
    }

    fn step(&self) -> f64 {
        self.interval / f64::from(self.steps)
    }

    /// True if the scene has no emitters.
    pub(super) fn is_idle(&self) -> bool {
        self.makers.is_empty()
    }

    /// True if the fastest way to the particles of `frame` is to continue with frame `next`. Otherwise, the caller must restart with
    /// [`begin_at`](Self::begin_at) at [`first_frame`](Self::first_frame).
    pub(super) fn go_on_to(&self, frame: usize, next: usize) -> bool {
        let first = self.first_frame(frame);
        !self.clouds.is_empty() && self.begin <= first && first <= next && next <= frame
    }

    /// The first frame that must be read to compute the particles of `frame`.
    #[allow(clippy::cast_precision_loss, reason = "the check of a scene limits the number of frames")]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the conversion saturates, and a frame too early is none too late"
    )]
    pub(super) fn first_frame(&self, frame: usize) -> usize {
        let time = frame as f64 * self.interval;
        let needed = |maker: &Maker| Cloud::needed_from(&maker.emitter.source, time);
        let from = self.makers.iter().map(needed).fold(time, f64::min);
        // Start one frame earlier, because the quotient may be rounded up.
        ((from / self.interval).floor() as usize).saturating_sub(1).min(frame)
    }

    /// Removes all particles, and restarts at this frame.
    pub(super) fn begin_at(&mut self, frame: usize) {
        self.clouds.clear();
        self.before = None;
        self.begin = frame;
    }

    /// Advances the particles to the next frame.
    pub(super) fn note(&mut self, frame: &Frame) {
        if self.is_idle() || frame.index < self.begin {
            return;
        }
        let bodies: Arc<[BodySnapshot]> = frame.bodies.as_slice().into();
        match self.before.take() {
            None => self.start(frame, &bodies),
            Some(before) => self.advance(&before, frame.time, &bodies),
        }
        self.before = Some((frame.time, bodies));
    }

    /// Creates the particles of the first frame. For particles born before the run, the bodies rest at their initial poses.
    fn start(&mut self, frame: &Frame, bodies: &[BodySnapshot]) {
        let step = self.step();
        let Clouds { makers, method, interval, strides, .. } = &*self;
        let course = |body: BodyId| find(bodies, body.index()).copied().map(RecordedMotion::still);
        let scenery = self.scenery(&course);
        let cloud = |(maker, stride): (&Maker, &u64)| {
            let Maker { emitter: Emitter { source, carrier, radius, collides, .. }, fields } = maker;
            let early = (frame.time - Cloud::needed_from(source, frame.time)) / *interval;
            let early = if frame.index == 0 { early.max(0.0).ceil() } else { 0.0 };
            let from = frame.time - early * *interval;
            let mut cloud = Cloud::new(source.clone(), *carrier, fields, method, (from, *stride));
            if let Some(surface) = collides {
                cloud = cloud.colliding(*radius, *surface);
            }
            cloud.advance_among(frame.time, step, &course, scenery.as_ref());
            cloud
        };
        let clouds = makers.iter().zip(strides).map(cloud).collect();
        self.clouds = clouds;
    }

    fn advance(&mut self, before: &(f64, Arc<[BodySnapshot]>), to: f64, bodies: &[BodySnapshot]) {
        let (begin, last) = (before.0, &before.1);
        let course = |body: BodyId| {
            let (from, now) = (find(last, body.index()), find(bodies, body.index()));
            match (from.copied(), now.copied()) {
                (Some(from), Some(now)) => Some(RecordedMotion::new(begin, from, to, now)),
                // A body that is present only at the start or only at the end of the interval rests at that pose for the whole interval.
                (Some(only), None) | (None, Some(only)) => Some(RecordedMotion::still(only)),
                (None, None) => None,
            }
        };
        let step = self.step();
        let scenery = self.scenery(&course);
        self.clouds.iter_mut().for_each(|cloud| cloud.advance_among(to, step, &course, scenery.as_ref()));
    }

    /// The obstacles with their motions in an interval between frames. `None` if no particles collide.
    fn scenery(&self, course: &dyn Fn(BodyId) -> Option<RecordedMotion>) -> Option<Scenery> {
        (!self.obstacles.is_empty()).then(|| Scenery::new(&self.obstacles, course))
    }

    /// The box around all particles at the last frame, except those below the ground. `None` if there are no particles.
    pub(super) fn bounds(&self, scene: &Scene) -> Option<Bounds> {
        let ground = scene.environment.ground.as_ref().and_then(|ground| ground.height);
        let lowest = ground.unwrap_or(f64::NEG_INFINITY);
        let of_cloud = |(maker, cloud): (&Maker, &Cloud)| {
            let emitter = &maker.emitter;
            let reach = DVec3::splat(emitter.radius * emitter.sizes.iter().copied().fold(0.0, f64::max));
            let seen = cloud.particles().iter().map(|particle| particle.location);
            let seen = seen.filter(|location| location.is_finite() && location.y + reach.y >= lowest);
            let boxes = seen.map(|location| Bounds { min: location - reach, max: location + reach });
            let Bounds { min, max } = boxes.reduce(Bounds::union)?;
            Some(Bounds { min: min.with_y(min.y.max(lowest)), max })
        };
        self.makers.iter().zip(&self.clouds).filter_map(of_cloud).reduce(Bounds::union)
    }

    /// Returns the particles at the last frame, for each emitter.
    pub(super) fn now(&self) -> Vec<Swarm> {
        self.clouds.iter().map(|cloud| cloud.particles().into()).collect()
    }

    /// Computes the particles at a moment between the last frame and the next, for each emitter.
    pub(super) fn at(&self, moment: &Frame) -> Vec<Swarm> {
        let mut later = self.clone();
        if let Some(before) = &self.before
            && moment.time > before.0
        {
            later.advance(before, moment.time, &moment.bodies);
        }
        later.now()
    }
}

/// The number of particle steps in an interval (s). Particles use the timestep of bodies.
fn steps(scene: &Scene, interval: f64) -> u32 {
    let mut world = World::new();
    world.set_step(scene.simulation.step);
    world.steps_within(interval)
}

/// The obstacles that stop particles: the colliding bodies and the ground. The scene's check has refused unsupported shapes.
fn obstacles(scene: &Scene) -> Arc<[Obstacle]> {
    if scene.emitters.iter().all(|emitter| emitter.collides.is_none()) {
        return [].into();
    }
    let body = |(number, body): (usize, &Body)| {
        Obstacle::body(BodyId::new(number), &body.shape, body.collider.as_ref()?.surface)
    };
    let ground = scene.ground_that_stops().and_then(|(height, surface)| Obstacle::ground(height, surface));
    scene.bodies.iter().enumerate().filter_map(body).chain(ground).collect()
}

/// The forces on the particles of an emitter, including gravity.
fn fields(scene: &Scene, emitter: usize) -> Vec<Field> {
    let mut fields = Vec::new();
    let acceleration = scene.simulation.gravity;
    if acceleration != DVec3::ZERO {
        fields.push(Field::new(move |_| Arc::new(UniformGravity { acceleration })));
    }
    let acting = scene.forces.iter().filter(|force| force.emitters.contains(&emitter));
    fields.extend(
        acting.filter_map(|force| field(scene, force, scene.emitters[emitter].radius, Sources::FirstGroup)),
    );
    fields
}

/// The bodies whose force between pairs acts on particles.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Sources {
    FirstGroup,
    BothGroups,
}

/// Converts a force into a field that acts on particles with this radius (m). `None` for forces that act on bodies only.
pub(super) fn field(scene: &Scene, force: &Force, radius: f64, sources: Sources) -> Option<Field> {
    let started = |bodies: &[BodyId]| -> Vec<(BodyId, RigidBody)> {
        bodies.iter().map(|body| (*body, scene.bodies[body.index()].start)).collect()
    };
    Some(match &force.kind {
        ForceKind::OnEach(force) => {
            let force = force.clone();
            Field::new(move |particles| force.on_particles(particles))
        }
        ForceKind::Between(force) => {
            let mut all = force.bodies().to_vec();
            all.extend(force.against().into_iter().flatten().filter(|_| sources == Sources::BothGroups));
            let force = force.clone();
            Field::from_bodies(started(&all), move |particles, sources| {
                force.on_particles(particles, sources)
            })
        }
        ForceKind::Formula { law, .. } => {
            let law = law.clone();
            Field::new(move |bodies| Arc::new(FormulaForce::new(bodies, law.clone())))
        }
        ForceKind::Buoyancy { liquid: Buoyancy { density, level, gravity, .. }, .. } => {
            let (density, level, gravity) = (*density, *level, *gravity);
            Field::new(move |bodies| {
                let balls = bodies.into_iter().map(|body| (body, Shape::Sphere { radius })).collect();
                Arc::new(Buoyancy { bodies: balls, density, level, gravity })
            })
        }
        ForceKind::J2(j2) => {
            let J2 { planet, .. } = *j2;
            let j2 = J2 { bodies: Vec::new(), ..j2.clone() };
            Field::from_bodies(started(&[planet]), move |bodies, planet| {
                Arc::new(J2 { planet: planet.first().copied().unwrap_or(j2.planet), bodies, ..j2.clone() })
            })
        }
        ForceKind::Dipoles(_) | ForceKind::Spring { .. } => return None,
    })
}

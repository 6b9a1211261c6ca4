//! A run looked over as a whole, before its frames are drawn.
//!
//! The frames are looked over while they are recorded, or while a recording is read.

use glam::DVec3;

use super::asked::Asked;
use super::overlap::{Overlap, Watch};
use super::span::{JointArrow, Spans};
use super::vectors::JointEnd;
use super::{Bounds, Frame, Frames, SimulateError, Span, world};
use crate::dynamics::{BodySnapshot, RigidBody, Shape};
use crate::scene::{Arrow, Body, Joint, Quantity, Scene};

/// What is known of a run as a whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// Where everything takes place, from the start until several moments; the last is the end. A body counts until
    /// it goes through a plane. Empty if the scene has no body but planes.
    pub spans: Vec<Span>,
    /// The first passage of a body through each plane or ground that is given; none where contacts stop bodies.
    pub crossings: Vec<Crossing>,
    /// The first two bodies that go into each other; none where contacts stop bodies.
    pub overlap: Option<Overlap>,
    /// The first body that starts otherwise than the scene says, since joints hold it.
    pub corrected: Option<Corrected>,
    /// How large what is to be shown beside the bodies gets.
    pub asked: Asked,
    /// The error of the energy where it is largest, relative to the largest kinetic energy of the whole run. (The drift
    /// of a single [`Balance`](crate::dynamics::Balance) is relative to the largest so far, which is little where a
    /// run begins at rest.)
    pub drift: f64,
    /// What contacts have done up to the last frame; none without them.
    pub contacts: Option<ContactTotals>,
    /// The real timestep, s.
    pub timestep: f64,
    /// The number of timesteps from one frame to the next.
    pub steps_per_frame: u32,
}

/// What contacts have done in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactTotals {
    /// The number of impacts.
    pub impacts: f64,
    /// The energy that they have taken, J.
    pub lost: f64,
    /// The energy that friction has taken between impacts, J.
    pub rubbed: f64,
}

/// That bodies go through a plane, since nothing keeps them from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// The name of the plane; none for the ground of the environment.
    pub plane: Option<String>,
    /// The name of the first body that goes through it.
    pub body: String,
    /// The time of the first frame in which it is seen to, s.
    pub time: f64,
    /// How many other bodies go through the plane later.
    pub others: usize,
}

/// That a body starts otherwise than the scene says, since joints hold it.
#[derive(Clone, Debug, PartialEq)]
pub struct Corrected {
    /// Its name.
    pub body: String,
    /// The velocity that it starts with, m/s.
    pub velocity: DVec3,
    /// The angular velocity that it starts with, rad/s.
    pub angular_velocity: DVec3,
    /// How many other bodies do so.
    pub others: usize,
}

impl Corrected {
    /// Compares the first frame with the scene.
    fn find(scene: &Scene, frame: &Frame) -> Option<Corrected> {
        // Rounding is far smaller, and what is larger may be seen.
        const NOTICEABLE: f64 = 1e-6;
        if scene.joints.is_empty() {
            return None;
        }
        let differs = |now: DVec3, given: DVec3| now.distance(given) > NOTICEABLE * given.length().max(1e-3);
        let is_other = |&&BodySnapshot { id, velocity, angular_velocity, .. }: &&BodySnapshot| {
            let body = &scene.bodies[id];
            let is_free = !body.start.fixed && body.motion.is_none();
            let start = &body.start;
            // One that is given none is set in motion by what guides or drives it.
            let is_given = start.velocity != DVec3::ZERO || start.angular_velocity != DVec3::ZERO;
            is_free
                && is_given
                && (differs(velocity, start.velocity) || differs(angular_velocity, start.angular_velocity))
        };
        let mut others = frame.bodies.iter().filter(is_other);
        let first = others.next()?;
        Some(Corrected {
            body: scene.bodies[first.id].name.to_string(),
            velocity: first.velocity,
            angular_velocity: first.angular_velocity,
            others: others.count(),
        })
    }
}

/// Simulates a scene to learn where it takes place; `seen` is told of every frame.
///
/// # Errors
/// Where the run leaves the numbers.
pub fn survey(scene: &Scene, mut seen: impl FnMut(&Frame)) -> Result<Survey, SimulateError> {
    let mut surveyor = Surveyor::new(scene);
    for frame in Frames::new(scene) {
        let frame = frame?;
        surveyor.see(&frame);
        seen(&frame);
    }
    Ok(surveyor.finish())
}

/// Looks over a run whose frames somebody else makes.
pub struct Surveyor<'a> {
    scene: &'a Scene,
    spans: Spans,
    /// The planes that are watched; each knows the bodies that may go through it, from the frame on in which they come.
    planes: Vec<Watched>,
    /// The bodies that forces move, gone through once and not for each plane.
    free: Vec<usize>,
    /// The bodies that forces move and that have not come yet.
    awaited: Vec<usize>,
    /// For each body: whether it has gone through a plane.
    crossed: Vec<bool>,
    overlaps: Watch<'a>,
    corrected: Option<Corrected>,
    asked: Asked,
    /// The arrows of joints: where they begin, what they show, and their scales.
    joint_arrows: Vec<(JointEnd, Quantity, Option<f64>)>,
    contacts: Option<ContactTotals>,
    /// The error of the energy where it is largest, J.
    error: f64,
    largest_kinetic: f64,
}

impl Survey {
    /// The box in which everything takes place; none if the scene has no body but planes.
    pub fn bounds(&self) -> Option<Bounds> {
        self.spans.last().map(|span| span.bounds)
    }
}

impl<'a> Surveyor<'a> {
    /// Of a run that has not begun.
    pub fn new(scene: &'a Scene) -> Surveyor<'a> {
        Surveyor {
            scene,
            spans: Spans::default(),
            planes: planes(scene),
            free: free(scene).collect(),
            awaited: free(scene).collect(),
            crossed: vec![false; scene.bodies.len()],
            overlaps: Watch::new(scene),
            corrected: None,
            asked: Asked::new(scene),
            joint_arrows: joint_arrows(scene),
            contacts: scene.simulation.contacts.map(|_| ContactTotals::default()),
            error: 0.0,
            largest_kinetic: 0.0,
        }
    }

    /// Looks at the next frame of the run.
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
        self.asked.see(scene, frame);
        // A body that has gone through a plane is behind the scenery: the camera need not follow it.
        let counts = |body: &&BodySnapshot| !self.crossed[body.id];
        let joints = self.joint_arrows.iter().filter_map(|(end, quantity, scale)| {
            let (root, vector) = end.arrow(*quantity, frame)?;
            Some(JointArrow { quantity: *quantity, scale: *scale, root, vector })
        });
        let loads = super::loads(scene, frame).into_iter().map(|load| JointArrow {
            quantity: load.quantity,
            scale: load.arrow.scale,
            root: load.root,
            vector: load.vector,
        });
        self.spans.see(scene, frame.time, frame.bodies.iter().filter(counts), joints.chain(loads));
        if let Some(contacts) = &mut self.contacts {
            let accounts = &frame.balance.accounts;
            // They take energy; zero has no sign.
            let [lost, rubbed] = [accounts.impacts, accounts.friction].map(|account| 0.0 - account);
            *contacts = ContactTotals { impacts: frame.impacts.of_run(), lost, rubbed };
        }
        self.largest_kinetic = self.largest_kinetic.max(frame.balance.kinetic);
        let error_now = frame.balance.drift * self.largest_kinetic;
        if error_now.abs() > self.error.abs() {
            self.error = error_now;
        }
    }

    /// What is known after the last frame.
    pub fn finish(self) -> Survey {
        let Surveyor {
            scene,
            spans,
            planes,
            overlaps,
            corrected,
            asked,
            contacts,
            error,
            largest_kinetic,
            ..
        } = self;
        let interval = 1.0 / scene.simulation.frame_rate;
        let steps_per_frame = world(scene).steps_within(interval);
        Survey {
            spans: spans.finish(),
            crossings: planes.into_iter().filter_map(|plane| plane.crossing).collect(),
            overlap: overlaps.finish(),
            corrected,
            asked,
            contacts,
            drift: if largest_kinetic > 0.0 { error / largest_kinetic } else { 0.0 },
            timestep: interval / f64::from(steps_per_frame),
            steps_per_frame,
        }
    }

    /// The box in which everything has taken place so far.
    pub fn bounds(&self) -> Option<Bounds> {
        self.spans.bounds()
    }
}

/// The arrows of joints that a scene asks for.
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

/// The bodies that forces move: only these can go through a plane. A scene of many planes has few of them.
fn free(scene: &Scene) -> impl Iterator<Item = usize> {
    let bodies = scene.bodies.iter().enumerate();
    bodies.filter(|(_, body)| !body.start.fixed && body.motion.is_none()).map(|(id, _)| id)
}

/// A plane that is watched for bodies that go through it.
struct Watched {
    name: Option<String>,
    /// The body that it is, if it is one.
    body: Option<usize>,
    /// Whether it was there in the frame before.
    is_there: bool,
    point: DVec3,
    normal: DVec3,
    /// The bodies that may still go through it, by their numbers, and the side on which each began.
    bodies: Vec<(usize, f64)>,
    crossing: Option<Crossing>,
}

fn planes(scene: &Scene) -> Vec<Watched> {
    if scene.simulation.contacts.is_some() {
        return Vec::new();
    }
    let watched = |name: Option<String>, body: Option<usize>, point: DVec3, normal: DVec3| Watched {
        name,
        body,
        is_there: false,
        point,
        normal,
        bodies: Vec::new(),
        crossing: None,
    };
    let plane = |(id, body): (usize, &Body)| match body.shape {
        Shape::Plane { normal } => {
            let RigidBody { location, orientation, .. } = body.start;
            Some(watched(Some(body.name.to_string()), Some(id), location, orientation * normal))
        }
        _ => None,
    };
    let height = scene.environment.ground.as_ref().and_then(|ground| ground.height);
    let ground = height.map(|height| watched(None, None, DVec3::Y * height, DVec3::Y));
    scene.bodies.iter().enumerate().filter_map(plane).chain(ground).collect()
}

impl Watched {
    /// Looks at a frame in which some bodies have come.
    fn see(
        &mut self,
        scene: &Scene,
        frame: &Frame,
        (free, come): (&[usize], &[&BodySnapshot]),
        crossed: &mut [bool],
    ) {
        let was_there =
            std::mem::replace(&mut self.is_there, self.body.is_none_or(|id| frame.body(id).is_some()));
        match (was_there, self.is_there) {
            (_, false) => return self.bodies.clear(),
            (true, true) => self.begin(scene, come.iter().copied()),
            // It comes itself: now all begin.
            (false, true) => self.begin(scene, free.iter().filter_map(|id| frame.body(*id))),
        }
        self.watch(scene, frame, crossed);
    }

    /// Notes those of some bodies that do not touch the plane as they come.
    fn begin<'a>(&mut self, scene: &Scene, come: impl Iterator<Item = &'a BodySnapshot>) {
        for body in come {
            self.bodies.extend(self.beginner(scene, body).map(|side| (body.id, side)));
        }
    }

    /// Looks for bodies that have gone through the plane, and marks them in `crossed`.
    fn watch(&mut self, scene: &Scene, frame: &Frame, crossed: &mut [bool]) {
        let mut gone = Vec::new();
        let mut bodies = std::mem::take(&mut self.bodies);
        bodies.retain(|&(id, side)| {
            let Some(body) = frame.body(id) else { return true };
            let is_through = self.gap(&scene.bodies[id].shape, body, side) < -self.tolerance(body);
            if is_through {
                gone.push(id);
            }
            !is_through
        });
        self.bodies = bodies;
        for id in gone {
            crossed[id] = true;
            match &mut self.crossing {
                Some(crossing) => crossing.others += 1,
                None => {
                    let (plane, body) = (self.name.clone(), scene.bodies[id].name.to_string());
                    self.crossing = Some(Crossing { plane, body, time: frame.time, others: 0 });
                }
            }
        }
    }

    /// The side on which a body begins, if it does not touch the plane then.
    fn beginner(&self, scene: &Scene, body: &BodySnapshot) -> Option<f64> {
        let side = if (body.location - self.point).dot(self.normal) < 0.0 { -1.0 } else { 1.0 };
        let shape = &scene.bodies[body.id].shape;
        (self.gap(shape, body, side) >= -self.tolerance(body)).then_some(side)
    }

    /// The distance between the plane and the nearest point of a body that should be on the given side, m.
    fn gap(&self, shape: &Shape, body: &BodySnapshot, side: f64) -> f64 {
        let towards_plane = -side * self.normal;
        let reach = shape.support(body.orientation, towards_plane).unwrap_or(0.0);
        side * (body.location - self.point).dot(self.normal) - reach
    }

    /// What rounding may make of a body that just touches, m.
    fn tolerance(&self, body: &BodySnapshot) -> f64 {
        1e-9 * (body.location.abs().max_element() + self.point.abs().max_element())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surveyed(text: &str) -> Survey {
        survey(&Scene::parse(text).unwrap(), |_| {}).unwrap()
    }

    #[test]
    fn bounds_hold_the_whole_motion() {
        let survey = surveyed(
            "
            [simulation]
            duration = 2
            [body.ball]
            shape.sphere.radius = 0.5
            velocity = [3, 0, 0]
            [body.box]
            shape.box.size = [2, 2, 2]
            orientation = [0, 0, 45]
            location = [0, 4, 0]
            [body.floor]
            shape.plane = {}
            location = [0, -9, 0]
            ",
        );
        let Bounds { min, max } = survey.bounds().unwrap();
        assert!((min - DVec3::new(-2f64.sqrt(), -0.5, -1.0)).length() < 1e-12, "{min}");
        assert!((max - DVec3::new(6.5, 4.0 + 2f64.sqrt(), 1.0)).length() < 1e-12, "{max}");
    }

    #[test]
    fn bounds_hold_what_is_drawn_and_planes_are_crossed_by_what_is_there() {
        let survey = surveyed(
            "
            [body.earth]
            shape.sphere.radius = 0.5
            look.scale = 10
            velocity = [1, 0, 0]
            [environment]
            ground.height = -3
            ",
        );
        let Bounds { min, max } = survey.bounds().unwrap();
        assert!((min - DVec3::splat(-5.0)).length() < 1e-12, "{min}");
        assert!((max - DVec3::new(15.0, 5.0, 5.0)).length() < 1e-12, "{max}");
        assert_eq!(survey.crossings, []);
    }

    #[test]
    fn the_drift_is_relative_to_the_whole_run() {
        let survey = surveyed(
            "
            [simulation]
            duration = 10
            step = 0.01
            gravity = [0, -10, 0]
            [body.ball]
            shape.sphere.radius = 1
            ",
        );
        // Per kilogram: Euler–Cromer falls ½ g t dt too far, so its energy is g × that too small, 5 J at the end of 10 s;
        // and ½ (g t)² is 5000 J. At the first frame, relative to what was kinetic by then, it would be a quarter.
        assert!((survey.drift + 1e-3).abs() < 1e-9, "{}", survey.drift);
    }

    #[test]
    fn a_scene_of_nothing_but_planes_has_no_bounds() {
        assert_eq!(surveyed("[body.floor]\nshape.plane = {}").bounds(), None);
        assert_eq!(surveyed("").bounds(), None);
    }

    #[test]
    fn the_first_body_through_a_plane_is_named_with_its_time() {
        let survey = surveyed(
            "
            [simulation]
            duration = 2
            frame_rate = 10
            gravity = [0, -2, 0]
            [body.floor]
            shape.plane = {}
            [body.slow]
            shape.sphere.radius = 0.5
            location = [0, 1.5, 0]
            [body.fast]
            shape.sphere.radius = 0.5
            location = [2, 1.5, 0]
            velocity = [0, -3, 0]
            [body.below]                # already through, and on its way out
            shape.sphere.radius = 0.5
            location = [4, -3, 0]
            velocity = [0, -1, 0]
            [body.lying]                # touches from the start
            shape.sphere.radius = 0.5
            location = [6, 0.5, 0]
            fixed = true
            [environment]
            ground.height = -100
            ",
        );
        // 3 t + t² reaches the gap of 1 m at t = 0.303 s, so the frame at 0.4 s is the first to see it.
        let expected =
            Crossing { plane: Some("floor".to_owned()), body: "fast".to_owned(), time: 0.4, others: 1 };
        assert_eq!(survey.crossings, [expected]);
    }

    #[test]
    fn what_has_gone_through_a_plane_is_not_followed() {
        let survey = surveyed(
            "
            [simulation]
            duration = 10
            gravity = [0, -9.81, 0]
            [body.floor]
            shape.plane = {}
            [body.ball]
            shape.sphere.radius = 0.5
            location = [0, 2, 0]
            ",
        );
        let bounds = survey.bounds().unwrap();
        assert!(bounds.min.y > -0.2 && bounds.max.y == 2.5, "{bounds:?}");
    }

    #[test]
    fn the_given_ground_counts_and_the_default_one_does_not() {
        let fall = "
            [simulation]
            gravity = [0, -9.81, 0]
            [body.ball]
            shape.sphere.radius = 1
            location = [0, 5, 0]
            ";
        assert_eq!(surveyed(fall).crossings, []);
        let survey = surveyed(&format!("{fall}\n[environment]\nground.height = 0"));
        assert_eq!(survey.crossings.len(), 1);
        assert_eq!(survey.crossings[0].plane, None);
    }
}

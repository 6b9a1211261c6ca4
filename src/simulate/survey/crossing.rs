//! Finds planes that bodies pass through in scenes without contacts.

use glam::DVec3;

use super::super::Frame;
use crate::physics::{BodySnapshot, RigidBody, Shape};
use crate::scene::{Body, ForceKind, Scene};

/// The passage of bodies through a plane, in a scene without contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// The name of the plane. `None` for the ground of the environment.
    pub plane: Option<String>,
    /// The name of the first body that passes through the plane.
    pub body: String,
    /// The time of the first frame after the passage of this body, s.
    pub time: f64,
    /// The number of other bodies that pass through the plane later.
    pub others: usize,
}

/// The indices of the bodies that forces move. Only these bodies can pass through a plane unintentionally.
pub(super) fn free(scene: &Scene) -> impl Iterator<Item = usize> {
    let bodies = scene.bodies.iter().enumerate();
    bodies.filter(|(_, body)| !body.start.fixed && body.motion.is_none()).map(|(id, _)| id)
}

/// A plane that is watched for bodies passing through it.
pub(super) struct Watched {
    name: Option<String>,
    /// The index of the plane's body. `None` for the ground.
    body: Option<usize>,
    /// Whether the plane was present in the last frame.
    is_there: bool,
    point: DVec3,
    normal: DVec3,
    /// The bodies that may still pass through the plane: the index of each, and its initial side (1 along the normal, −1 opposite).
    bodies: Vec<(usize, f64)>,
    crossing: Option<Crossing>,
}

/// Lists the planes of a scene, including a ground with a given height. Empty in scenes with contacts.
pub(super) fn planes(scene: &Scene) -> Vec<Watched> {
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

/// The bodies that may fall without end, since nothing stops them: the scene has gravity and a ground without a given height, but no
/// contacts.
pub(super) struct Falls {
    bodies: Vec<Faller>,
    found: Option<Crossing>,
}

/// A body that began above height 0.
struct Faller {
    id: usize,
    /// The largest height of its lowest point, m.
    highest: f64,
    /// The time of the first frame in which its lowest point is below 0, s. `None` while it is above.
    below_since: Option<f64>,
}

impl Falls {
    /// Lists the bodies that no joint and no spring holds. Empty if the scene has contacts, no ground, or a ground with a height.
    pub(super) fn new(scene: &Scene) -> Falls {
        let gravity = scene.simulation.gravity;
        let has_ground = scene.environment.ground.as_ref().is_some_and(|ground| ground.height.is_none());
        let is_vertical = gravity.y < 0.0 && gravity.x == 0.0 && gravity.z == 0.0;
        let is_plain =
            |kind: &ForceKind| matches!(kind, ForceKind::OnEach(force) if !force.depends_on_charge());
        // Joints and other forces may hold bodies.
        let is_held = !scene.joints.is_empty() || !scene.forces.iter().all(|force| is_plain(&force.kind));
        let is_watched = has_ground && is_vertical && !is_held && scene.simulation.contacts.is_none();
        let bodies = if is_watched {
            free(scene).map(|id| Faller { id, highest: f64::NEG_INFINITY, below_since: None }).collect()
        } else {
            Vec::new()
        };
        Falls { bodies, found: None }
    }

    /// Updates the heights with a frame. A body falls without end if it falls further below height 0 than it has been above.
    pub(super) fn see(&mut self, scene: &Scene, frame: &Frame) {
        let Falls { bodies, found } = self;
        bodies.retain_mut(|faller| {
            let Some(body) = frame.body(faller.id) else { return true };
            let shape = &scene.bodies[faller.id].shape;
            let Some(reach) = shape.support(body.orientation, -DVec3::Y) else { return false };
            let height = body.location.y - reach;
            if faller.highest == f64::NEG_INFINITY
                && height < -RELATIVE_ROUNDING * (body.location.y.abs() + reach.abs())
            {
                // The body begins below height 0, which is no ground for it.
                return false;
            }
            faller.highest = faller.highest.max(height);
            if height < 0.0 && faller.below_since.is_none() {
                faller.below_since = Some(frame.time);
            }
            let is_far = height < -faller.highest.max(2.0 * reach.abs()) && body.velocity.y < 0.0;
            let Some(time) = faller.below_since.filter(|_| is_far) else { return true };
            match found {
                Some(found) => found.others += 1,
                None => {
                    let body = scene.bodies[faller.id].name.to_string();
                    *found = Some(Crossing { plane: None, body, time, others: 0 });
                }
            }
            false
        });
    }

    /// Returns the first body that falls without end, with the number of others.
    pub(super) fn finish(self) -> Option<Crossing> {
        self.found
    }
}

/// The largest rounding error of a height, relative to the height of the body's location and its extent downwards.
const RELATIVE_ROUNDING: f64 = 1e-9;

impl Watched {
    /// Updates the plane with a frame. `free` are the bodies that forces move, and `come` those of them that appear in this frame. Sets
    /// `crossed` for bodies that have passed through the plane.
    pub(super) fn see(
        &mut self,
        scene: &Scene,
        frame: &Frame,
        free: &[usize],
        come: &[&BodySnapshot],
        crossed: &mut [bool],
    ) {
        let was_there =
            std::mem::replace(&mut self.is_there, self.body.is_none_or(|id| frame.body(id).is_some()));
        match (was_there, self.is_there) {
            (_, false) => return self.bodies.clear(),
            (true, true) => self.begin(scene, come.iter().copied()),
            // The plane itself appears in this frame, so watch all present bodies from now on.
            (false, true) => self.begin(scene, free.iter().filter_map(|id| frame.body(*id))),
        }
        self.watch(scene, frame, crossed);
    }

    /// Starts to watch the new bodies that do not touch the plane.
    fn begin<'a>(&mut self, scene: &Scene, come: impl Iterator<Item = &'a BodySnapshot>) {
        for body in come {
            self.bodies.extend(self.beginner(scene, body).map(|side| (body.id, side)));
        }
    }

    /// Finds the bodies that have passed through the plane since the last frame, and marks them in `crossed`.
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

    /// The initial side of a body: 1 along the plane's normal, −1 opposite. `None` if the body overlaps the plane.
    fn beginner(&self, scene: &Scene, body: &BodySnapshot) -> Option<f64> {
        let side = if (body.location - self.point).dot(self.normal) < 0.0 { -1.0 } else { 1.0 };
        let shape = &scene.bodies[body.id].shape;
        (self.gap(shape, body, side) >= -self.tolerance(body)).then_some(side)
    }

    /// The signed distance from the plane to the nearest point of a body, m. Negative if the body reaches beyond the plane, seen from
    /// `side`.
    fn gap(&self, shape: &Shape, body: &BodySnapshot, side: f64) -> f64 {
        let towards_plane = -side * self.normal;
        let reach = shape.support(body.orientation, towards_plane).unwrap_or(0.0);
        side * (body.location - self.point).dot(self.normal) - reach
    }

    /// The tolerance for rounding errors in the distance between the plane and a touching body, m.
    fn tolerance(&self, body: &BodySnapshot) -> f64 {
        1e-9 * (body.location.abs().max_element() + self.point.abs().max_element())
    }

    /// Returns the first passage, with the number of later ones. `None` if no body passed through the plane.
    pub(super) fn finish(self) -> Option<Crossing> {
        self.crossing
    }
}

//! Converts cameras and lights, with their motion, to glTF.

use glam::{DMat3, DQuat, DVec3};

use super::document::{Camera, CameraLens, Light, Orthographic, Perspective};
use super::materials::MappedLook;
use super::motion::{NodePose, Recorder, SampledMotion};
use crate::export::ExportError;
use crate::picture::{Lamp, Lens, Lost, Placed, PlacedLight, Plan, Stage};
use crate::scene::{Body, LookAspect, Output, Visibility};
use crate::simulate::{Frame, Recorded, Selection};

/// The widest angle of view in the file, degrees. glTF does not allow 180 degrees.
const MAX_ANGLE_OF_VIEW: f64 = 179.9;

/// The cameras and lights of a scene. In the list of recorded motions, they come after the bodies, cameras first.
pub(super) struct CamerasAndLights {
    /// The surroundings of the bodies.
    pub(super) stage: Stage,
    /// The main camera, followed by the cameras of the views.
    pub(super) cameras: Vec<Camera>,
    pub(super) lights: Vec<Light>,
    /// The look of each body in the first frame, if it follows a value. Models cannot animate looks.
    pub(super) looks: Vec<Option<MappedLook>>,
    /// The size of each body in the first frame, as a part of its largest size in the run. 0 for a body that is not drawn then.
    pub(super) sizes: Vec<f64>,
}

impl CamerasAndLights {
    /// Converts the cameras and lights of a run, and appends their motion in the selected frames to `motion`.
    pub(super) fn of(
        run: &Recorded<'_>,
        selection: &Selection,
        motion: &mut SampledMotion,
    ) -> Result<CamerasAndLights, ExportError> {
        let (scene, survey) = (run.scene(), run.survey());
        let views = scene.views.iter().map(|view| (format!("camera {}", view.name), &view.camera));
        let all = std::iter::once(("camera".to_owned(), &scene.camera)).chain(views);
        let (names, plans): (Vec<String>, Vec<Plan>) =
            all.map(|(name, camera)| (name, Plan::new(scene, camera, survey))).unzip();
        let stage = plans[0].stage().clone();
        let mut seen: Vec<CameraRange> = plans.iter().map(|_| CameraRange::default()).collect();
        let mut see = |time: f64, placed: Vec<Placed>, motion: &mut SampledMotion, ways: &mut Recorder| {
            seen.iter_mut().zip(&placed).for_each(|(seen, placed)| seen.see(placed, &stage));
            ways.add(placed.iter().map(pose), time, |i| names[i].clone(), &mut motion.budget)
        };
        let mut ways = Recorder::new(motion.times().len());
        if plans.iter().any(Plan::camera_moves) {
            for exposure in run.exposures(selection) {
                let frame = exposure?.frame;
                known(&plans, &frame)?;
                let placed = plans.iter().map(|plan| plan.camera(&frame)).collect();
                see(frame.time, placed, motion, &mut ways)?;
            }
        } else {
            see(0.0, plans.iter().map(|plan| *plan.placed()).collect(), motion, &mut ways)?;
        }
        motion.append(ways);
        let cameras = names.into_iter().zip(seen);
        let cameras = cameras.map(|(name, seen)| seen.camera(name, scene.output, &stage)).collect();
        let lights = lights(run, &plans[0], selection, motion)?;
        let (looks, sizes) = looks(run, &plans[0], selection)?;
        Ok(CamerasAndLights { cameras, lights, stage, looks, sizes })
    }
}

/// Returns an error if a camera or a light follows a measure that is unknown in a frame.
fn known(plans: &[Plan], frame: &Frame) -> Result<(), ExportError> {
    let lost = plans.iter().find_map(|plan| plan.lost(frame)).filter(|lost| lost.follows_measures);
    match lost {
        Some(Lost { what, .. }) => Err(ExportError::NoValue { what, time: frame.time }),
        None => Ok(()),
    }
}

/// Returns the look of each body in the first of the selected frames, if it follows a value, and its relative size; 0 if it is not drawn.
fn looks(
    run: &Recorded<'_>,
    plan: &Plan,
    selection: &Selection,
) -> Result<(Vec<Option<MappedLook>>, Vec<f64>), ExportError> {
    let scene = run.scene();
    let is_usual = |body: &Body| {
        let mut numbers = LookAspect::ALL.into_iter();
        let follows = numbers.any(|aspect| scene.value_map_of(body, aspect).is_some());
        !follows && scene.color_map_of(body).is_none() && body.look.visible == Visibility::Always
    };
    let first = match scene.bodies.iter().all(is_usual) {
        true => None,
        false => run.exposures(selection).next().transpose()?,
    };
    let bodies = scene.bodies.len();
    let Some(first) = first else { return Ok((vec![None; bodies], vec![1.0; bodies])) };
    let (maps, looks) = (plan.mapped_colors(), plan.looks(&first.frame));
    let size = |body: usize| if looks.draws(body) { looks.scale_of(body) } else { 0.0 };
    let sizes = (0..bodies).map(size).collect();
    let look = |(number, body): (usize, &Body)| {
        let color = scene.color_map_of(body);
        let color = color.and_then(|map| maps[map].get(usize::from(*looks.colors.get(number)?)).copied());
        let part = |aspect, numbers: &[f64]| {
            scene.value_map_of(body, aspect)?;
            numbers.get(number).copied()
        };
        let transparency = part(LookAspect::Transparency, &looks.transparency);
        let glow = part(LookAspect::Glow, &looks.glow);
        let follows = color.is_some() || transparency.is_some() || glow.is_some();
        follows.then(|| MappedLook::new(color, transparency, glow))
    };
    Ok((scene.bodies.iter().enumerate().map(look).collect(), sizes))
}

/// Returns the pose of a camera in glTF's convention: it looks along −z, with y up.
fn pose(camera: &Placed) -> NodePose {
    let screen = camera.screen();
    let (right, up) = (screen.right(), screen.up());
    let turn = DMat3::from_cols(right, up, right.cross(up));
    NodePose { location: camera.location(), orientation: DQuat::from_mat3(&turn).normalize() }
}

/// The lens of a camera in the first frame, and the distances in all frames from which the clipping planes follow.
#[derive(Default)]
struct CameraRange {
    lens: Option<Lens>,
    /// The shortest distance between the camera and the scene in all frames, m.
    near: Option<f64>,
    /// The longest distance between the camera and the center of the scene in all frames, m.
    far: f64,
}

impl CameraRange {
    fn see(&mut self, camera: &Placed, stage: &Stage) {
        self.lens.get_or_insert(camera.lens());
        let (location, bounds) = (camera.location(), stage.whole);
        let mut near = location.clamp(bounds.min, bounds.max).distance(location);
        if let Some(ground) = stage.ground.filter(|ground| ground.height < location.y) {
            near = near.min(location.y - ground.height);
        }
        self.near = Some(self.near.map_or(near, |nearest| nearest.min(near)));
        self.far = self.far.max(location.distance(stage.center));
    }

    fn camera(self, name: String, output: Output, stage: &Stage) -> Camera {
        // The far clipping plane is beyond the corners of the ground.
        let zfar = self.far + 2.5 * stage.size;
        // The depth buffer has 24 bits. The closer the near clipping plane is, the fewer bits are left for distant objects.
        let znear = (self.near.unwrap_or(0.0) / 10.0).max(zfar * 1e-6);
        let aspect = f64::from(output.width) / f64::from(output.height);
        let perspective = |angle: f64| {
            let half = libm::tan(angle.min(MAX_ANGLE_OF_VIEW).to_radians() / 2.0) / aspect;
            let yfov = 2.0 * libm::atan(half);
            CameraLens::Perspective { perspective: Perspective { aspect_ratio: aspect, yfov, znear, zfar } }
        };
        let lens = match self.lens.unwrap_or(Lens::Orthographic { width: stage.size }) {
            Lens::Perspective { angle } => perspective(angle),
            // glTF has no such camera. It gets the part that a 360° viewer shows at once.
            Lens::Spherical => perspective(Lens::SPHERICAL_WINDOW_ANGLE),
            Lens::Orthographic { width } => CameraLens::Orthographic {
                orthographic: Orthographic { xmag: width / 2.0, ymag: width / 2.0 / aspect, znear, zfar },
            },
        };
        Camera { name, lens }
    }
}

/// Converts the lights of the scene, or the default lights if it has none. Appends their motion to `motion`.
fn lights(
    run: &Recorded<'_>,
    plan: &Plan,
    selection: &Selection,
    motion: &mut SampledMotion,
) -> Result<Vec<Light>, ExportError> {
    let timeline = &run.scene().simulation.timeline;
    let first = (0..timeline.frames()).find(|&frame| selection.contains(frame));
    let first = first.map_or(0.0, |frame| timeline.time(frame));
    let mut exposures = if plan.lights_move() { Some(run.exposures(selection)) } else { None };
    let mut shining = match exposures.as_mut().and_then(Iterator::next).transpose()? {
        Some(exposure) => {
            known(std::slice::from_ref(plan), &exposure.frame)?;
            plan.lights(&exposure.frame)
        }
        None => plan.lights_at_start(),
    };
    if shining.is_empty() {
        shining = plan.usual_lights();
    }
    let center = plan.stage().center;
    let poses = |lights: &[PlacedLight]| -> Vec<NodePose> {
        let pose = |light: &PlacedLight| NodePose {
            location: light.location,
            orientation: match light.kind {
                Lamp::Sun => towards(center - light.location),
                Lamp::Point | Lamp::Area => DQuat::IDENTITY,
            },
        };
        lights.iter().map(pose).collect()
    };
    let name = |i: usize| format!("light {}", shining[i].name);
    let mut ways = Recorder::new(motion.times().len());
    ways.add(poses(&shining).into_iter(), first, name, &mut motion.budget)?;
    for exposure in exposures.into_iter().flatten() {
        let frame = exposure?.frame;
        known(std::slice::from_ref(plan), &frame)?;
        ways.add(poses(&plan.lights(&frame)).into_iter(), frame.time, name, &mut motion.budget)?;
    }
    motion.append(ways);
    Ok((0..shining.len()).map(|i| light(name(i), &shining[i], plan.stage())).collect())
}

/// Returns the rotation that turns −z into this direction. A light in glTF shines along −z of its node.
fn towards(direction: DVec3) -> DQuat {
    DQuat::from_rotation_arc(DVec3::NEG_Z, direction.normalize_or(DVec3::NEG_Y))
}

/// Converts a light to glTF. POV-Ray's lights are equally bright at any distance, but glTF's lights fade. So a light gets POV-Ray's
/// brightness at the center of the scene, where a white surface that faces a light of intensity 1 is white. Such a surface reflects 1/π of
/// its light into each direction, so it needs π lux.
fn light(name: String, light: &PlacedLight, stage: &Stage) -> Light {
    let largest = light.color.into_iter().fold(0.0, f64::max);
    let color = if largest > 0.0 { light.color.map(|c| (c / largest).max(0.0)) } else { [1.0; 3] };
    let lux = largest * std::f64::consts::PI;
    let (kind, intensity) = match light.kind {
        Lamp::Sun => ("directional", lux),
        // A lamp inside the scene gets the intensity of a lamp whose distance from the center is half the size of the scene. Otherwise, a
        // lamp very close to the center would be too dim elsewhere.
        Lamp::Point | Lamp::Area => {
            let distance = light.location.distance(stage.center).max(stage.size / 2.0);
            ("point", lux * distance * distance)
        }
    };
    // Viewers store the intensity as `f32`, so a larger number is limited to the largest `f32`.
    Light { name, kind, color, intensity: intensity.min(f64::from(f32::MAX)) }
}

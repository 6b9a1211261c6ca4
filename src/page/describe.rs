//! Describes a run for the page: all values that are constant during the run.

use std::collections::HashMap;

use glam::{DQuat, DVec3};
use serde::Serialize;

use super::run::{Outcome, PageRun, TrailValues};
use crate::diagnostic::{Range, Sources};
use crate::font::{Typeface, Weight};
use crate::physics::{self, Shape};
use crate::picture::{PlacedLight, Plan, Thing, has_texts, pale};
use crate::scene::{
    Body, Color, Handle, HandleKind, HandlePlace, Look, LookNumber, Scene, Sky, Timeline, VariableSlider,
    Visibility,
};
use crate::simulate::{Bounds, lists_contacts};
use crate::surface::{Appearance, BaseShape, Detail, Piece, SurfacePattern, appearance_of, ground, pieces};

/// The description of a run, without its frames. Unless noted otherwise, lengths are in meters, angles in degrees, and colors in linear
/// light.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Description<'a> {
    id: String,
    name: &'a str,
    title: Option<&'a str>,
    integrator: &'static str,
    step: f64,
    frames: usize,
    frame_rate: f64,
    /// The time of each frame, s, if the film has a speed of its own. Empty if frame k is at time k / `frame_rate`.
    times: Vec<f64>,
    methods: Vec<Method>,
    size: [u32; 2],
    preset: &'static str,
    /// The color of a plain sky in sRGB. `None` for a gradient.
    sky: Option<Color3>,
    dark: bool,
    bodies: Vec<BodyText<'a>>,
    pieces: Vec<PieceText>,
    materials: Vec<Surface>,
    tiles: Surface,
    views: Vec<&'a str>,
    sliders: Vec<SliderText<'a>>,
    handles: Vec<HandleText<'a>>,
    bounds: Option<[[f64; 3]; 2]>,
    /// True if frames contain more to draw than the bodies, such as arrows, springs or labels.
    pub(super) shows: bool,
    /// True if the scene has particle emitters.
    pub(super) particles: bool,
    /// True if frames list the points of contact and the forces there.
    pub(super) contacts: bool,
    /// The sizes of the files of the fonts that labels have of their own, bytes.
    fonts: Vec<usize>,
    /// True if the run is finished. Until then, its surroundings are those of the run before it, and no results are known.
    settled: bool,
    /// The surroundings of the bodies: camera, lights, ground. `None` while they are unknown.
    stage: Option<Stage>,
}

/// The largest number of handles. More would hide the picture.
const MAX_HANDLES: usize = 400;

type Color3 = [f64; 3];

/// The slider of a variable.
#[derive(Serialize)]
struct SliderText<'a> {
    variable: &'a str,
    title: &'a str,
    unit: Option<&'a str>,
    value: f64,
    min: f64,
    max: f64,
    step: Option<f64>,
    /// Where the value stands in the text of the scene.
    place: Range<'a>,
}

/// A vector that the user drags in the picture.
#[derive(Serialize)]
struct HandleText<'a> {
    key: &'a str,
    /// What the vector is: `point` or `velocity`.
    kind: &'static str,
    /// The index of the body to which it belongs.
    body: Option<usize>,
    value: [f64; 3],
    /// Where its three components stand in the text of the scene. `None` if the text does not give them.
    places: Option<[Range<'a>; 3]>,
    /// Where the name of the table stands that lacks the vector.
    table: Option<Range<'a>>,
}

#[derive(Serialize)]
struct Method {
    name: &'static str,
    summary: &'static str,
}

#[derive(Serialize)]
struct BodyText<'a> {
    name: &'a str,
    mass: f64,
    /// The kind of the body's motion: `free`, `fixed`, or `driven` for a prescribed motion.
    kind: &'static str,
    /// The index of the body's material.
    material: Option<usize>,
    ghosts: bool,
    trail: Option<TrailText>,
    /// The length of the arms, m, if the body is drawn as a triad of axes.
    axes: Option<f64>,
}

#[derive(Serialize)]
struct TrailText {
    /// The time that the trail covers, s. `None` for the whole motion.
    duration: Option<f64>,
    /// The point of the body that draws the trail, m, in body axes.
    at: [f64; 3],
}

/// A piece of a drawn body: a base shape (a shape in a standard size), with its scale and its pose in body axes.
#[derive(Serialize)]
struct PieceText {
    body: usize,
    /// The index of the base shape.
    form: usize,
    scale: [f64; 3],
    location: [f64; 3],
    turn: [f64; 4],
    /// The color of the piece in sRGB. `None` for the material of the body.
    color: Option<Color3>,
    /// True if the piece is an infinite plane.
    plane: bool,
    /// True if the piece is a ball.
    ball: bool,
    /// The radius of a ball with the body's volume, m. The size of patterns depends on it.
    radius: f64,
}

#[derive(Serialize)]
struct Surface {
    color: [f64; 4],
    metallic: f64,
    roughness: f64,
    glow: f64,
    motif: &'static str,
    second: Option<Color3>,
    /// The color of ghosts (earlier poses) of bodies with this material, linear.
    pale: Color3,
    /// The index of the color map that gives each body its own color. `None` if the color never changes.
    map: Option<usize>,
    /// True if the material has a transparency, fixed or following a value.
    transparent: bool,
    /// True if the transparency of each body follows a value.
    clears: bool,
    /// True if the glow of each body follows a value.
    glows: bool,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Stage {
    center: [f64; 3],
    size: f64,
    tile: f64,
    tiles_fade: f64,
    fade: f64,
    fog: bool,
    ambient: Option<Color3>,
    ground: Option<Ground>,
    timestep: f64,
    steps_per_frame: u32,
    drift: f64,
    /// The energy that the drift is relative to, in words.
    drift_scale: &'static str,
    /// The trails, with the indices of their bodies. Colors are in sRGB.
    trails: Vec<Trail>,
    /// The lines of the grid for each camera. `None` without a grid, or for a camera that moves.
    grids: Vec<Option<Thing<'static>>>,
    /// The plots of the scene, with their curves over the whole run, then the color bars.
    plots: Vec<super::shown::Plot>,
    /// The colors of each color map, linear, from the lowest value to the highest; the last one is for undefined values.
    maps: Vec<Vec<Color3>>,
    /// The initial position and direction of each camera.
    cameras: Vec<super::shown::Camera>,
    lights: Vec<super::shown::Light>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Ground {
    height: f64,
    tile: f64,
    tiles_fade: f64,
}

#[derive(Serialize)]
struct Trail {
    body: usize,
    /// The radius of the trail, m. `None` if the scene sets no width: the trail then has the line width of the frame.
    radius: Option<f64>,
    color: Color3,
    /// The width at the oldest point, relative to that at the body.
    tail: f64,
    /// The index of the color map. `None` for a trail of one color.
    map: Option<usize>,
    /// The color at each `every`-th frame, as an index into the colors of the map. Empty for a trail of one color.
    shades: Vec<u16>,
    every: usize,
}

fn slider<'a>(slider: &'a VariableSlider, sources: &'a Sources) -> SliderText<'a> {
    SliderText {
        variable: &slider.variable,
        title: slider.title.as_deref().unwrap_or(&slider.variable),
        unit: slider.unit.as_deref(),
        value: slider.value,
        min: slider.range[0],
        max: slider.range[1],
        step: slider.step,
        place: sources.range(slider.span),
    }
}

fn handle<'a>(handle: &'a Handle, sources: &'a Sources) -> HandleText<'a> {
    let (places, table) = match handle.place {
        HandlePlace::Given(spans) => (Some(spans.map(|span| sources.range(span))), None),
        HandlePlace::Missing(name) => (None, Some(sources.range(name))),
    };
    HandleText {
        key: &handle.key,
        kind: match handle.kind {
            HandleKind::Point => "point",
            HandleKind::Velocity => "velocity",
        },
        body: handle.body,
        value: handle.value.to_array(),
        places,
        table,
    }
}

/// Returns the time of each frame, s. Empty if the film shows simulated time evenly.
fn times(timeline: &Timeline) -> Vec<f64> {
    let frames = if timeline.speed.is_even() { 0 } else { timeline.frames() };
    (0..frames).map(|frame| timeline.time(frame)).collect()
}

/// Describes a run, as far as it has been simulated.
pub(super) fn describe(run: &PageRun) -> Description<'_> {
    let scene: &Scene = &run.scene;
    let (dark, preset) = (scene.environment.is_dark(), scene.environment.preset);
    let (simulation, outcome) = (&scene.simulation, run.look());
    Description {
        id: run.id.to_string(),
        name: &scene.name,
        title: scene.title.as_deref(),
        integrator: simulation.method.name,
        step: simulation.step,
        frames: simulation.timeline.frames(),
        frame_rate: simulation.timeline.frame_rate,
        times: times(&simulation.timeline),
        methods: physics::Method::all().map(|m| Method { name: m.name, summary: m.summary }).collect(),
        size: [scene.output.width, scene.output.height],
        preset: preset.name(),
        sky: match scene.environment.sky {
            Sky::Plain(color) => Some(color.0),
            Sky::Gradient => None,
        },
        dark,
        bodies: scene.bodies.iter().map(body).collect(),
        pieces: placed(scene),
        materials: scene
            .materials
            .iter()
            .map(|m| Surface {
                map: m.color_map,
                transparent: m.transparency != LookNumber::Fixed(0.0),
                clears: m.transparency.map().is_some(),
                glows: m.glow.map().is_some(),
                ..surface(&appearance_of(m, preset), Some(&m.look), dark)
            })
            .collect(),
        tiles: surface(&ground(preset), None, dark),
        views: scene.views.iter().map(|view| view.name.as_str()).collect(),
        sliders: scene
            .variable_sliders
            .iter()
            .map(|slider| self::slider(slider, &scene.warnings.sources))
            .collect(),
        handles: scene
            .handles
            .iter()
            .take(MAX_HANDLES)
            .map(|handle| self::handle(handle, &scene.warnings.sources))
            .collect(),
        bounds: run.bounds().map(|Bounds { min, max }| [min.to_array(), max.to_array()]),
        shows: shows(scene, outcome),
        particles: !scene.emitters.is_empty(),
        contacts: simulation.contacts.is_some() && lists_contacts(scene),
        fonts: fonts(scene).map(|font| font.font(Weight::Regular).bytes().len()).collect(),
        settled: run.outcome().is_some_and(|outcome| outcome.is_ok()),
        stage: outcome.map(|outcome| stage(run, outcome)),
    }
}

/// The fonts that labels have of their own, each once.
pub(super) fn fonts(scene: &Scene) -> impl Iterator<Item = &Typeface> {
    let labels = scene.labels.iter().enumerate();
    labels.filter_map(|(number, label)| {
        let font = label.own_typeface.as_deref()?;
        let is_known = scene.labels[..number].iter().any(|other| other.own_typeface.as_deref() == Some(font));
        (!is_known).then_some(font)
    })
}

/// Encodes the triangles of all base shapes, one shape after another. Each shape has its number of vertices and of indices, then
/// positions, normals and indices, as little-endian 32-bit numbers.
pub(super) fn triangles(scene: &Scene) -> Vec<u8> {
    let detail = detail(scene);
    let mut bytes = Vec::new();
    for form in forms(scene) {
        let triangles = form.triangles(detail);
        let counts = [triangles.positions.len(), triangles.indices.len()];
        let counts = counts.map(|count| u32::try_from(count).unwrap_or(u32::MAX));
        let floats = triangles.positions.iter().chain(&triangles.normals).flatten();
        counts.iter().for_each(|count| bytes.extend_from_slice(&count.to_le_bytes()));
        floats.for_each(|number| bytes.extend_from_slice(&number.to_le_bytes()));
        triangles.indices.iter().for_each(|index| bytes.extend_from_slice(&index.to_le_bytes()));
    }
    bytes
}

/// Chooses how finely curved surfaces are divided. If a scene has many bodies, they are small in the picture, and coarse triangles
/// suffice.
fn detail(scene: &Scene) -> Detail {
    /// The largest number of bodies for which all surfaces are drawn with fine triangles.
    const MAX_FINELY_DRAWN_BODIES: usize = 1_000;
    if scene.bodies.len() > MAX_FINELY_DRAWN_BODIES { Detail::Coarse } else { Detail::Fine }
}

/// Returns the base shapes of a scene, each once, in the order of the bodies.
fn forms(scene: &Scene) -> Vec<BaseShape> {
    let mut known = HashMap::new();
    let mut forms = Vec::new();
    for piece in scene.bodies.iter().flat_map(|body| pieces(&body.drawn())) {
        known.entry(piece.form.clone()).or_insert_with(|| forms.push(piece.form));
    }
    forms
}

fn placed(scene: &Scene) -> Vec<PieceText> {
    let numbers: HashMap<BaseShape, usize> =
        forms(scene).into_iter().enumerate().map(|(i, form)| (form, i)).collect();
    let mut all = Vec::new();
    for (number, body) in scene.bodies.iter().enumerate() {
        let drawn = body.drawn();
        let radius = drawn.radius_of_ball().unwrap_or(1.0);
        all.extend(pieces(&drawn).into_iter().map(|piece| {
            let Piece { form, scale, location, orientation, color } = piece;
            PieceText {
                body: number,
                form: numbers.get(&form).copied().unwrap_or_default(),
                scale: DVec3::to_array(&scale),
                location: DVec3::to_array(&location),
                turn: DQuat::to_array(&orientation),
                color: color.map(|Color(color)| color),
                plane: form == BaseShape::PLANE,
                ball: form == BaseShape::BALL,
                radius,
            }
        }));
    }
    all
}

fn body(body: &Body) -> BodyText<'_> {
    BodyText {
        name: &body.name,
        mass: body.start.mass,
        kind: match (&body.motion, body.start.fixed) {
            (Some(_), _) => "driven",
            (None, true) => "fixed",
            (None, false) => "free",
        },
        material: body.material,
        ghosts: body.showing.ghosts.is_some(),
        axes: match body.drawn() {
            Shape::Axes { length } => Some(length),
            _ => None,
        },
        trail: body
            .showing
            .trail
            .map(|trail| TrailText { duration: trail.duration, at: (trail.at * body.look.scale).to_array() }),
    }
}

fn surface(look: &Appearance, of: Option<&Look>, dark: bool) -> Surface {
    let [red, green, blue, _] = look.mean();
    let pale = of.and_then(Look::color).map_or([red, green, blue], |color| pale(color, dark).linear());
    Surface {
        color: look.color,
        metallic: look.metallic,
        roughness: look.roughness,
        glow: look.glow,
        motif: match look.pattern {
            SurfacePattern::None => "none",
            SurfacePattern::Checkered => "checkered",
            SurfacePattern::Striped => "striped",
            SurfacePattern::BeachBall => "beach-ball",
            SurfacePattern::Ground => "ground",
        },
        second: look.second,
        pale,
        map: None,
        transparent: false,
        clears: false,
        glows: false,
    }
}

fn shows(scene: &Scene, outcome: Option<&Outcome>) -> bool {
    let bodies = scene.bodies.iter().any(|body| body.showing.axes.is_some() || body.showing.has_arrows());
    let joints =
        scene.joints.iter().any(|joint| joint.look.is_some() || joint.arrows.iter().any(Option::is_some));
    let springs = scene
        .forces
        .iter()
        .any(|force| matches!(force.kind, crate::scene::ForceKind::Spring { look: Some(_), .. }));
    let trails = scene.bodies.iter().any(|body| body.showing.trail.is_some());
    let texts = has_texts(scene);
    let moves = |plan: &Plan| plan.camera_moves() || plan.lights_move();
    bodies
        || springs
        || joints
        || trails
        || texts
        || !scene.color_maps.is_empty()
        || !scene.value_maps.is_empty()
        || scene.bodies.iter().any(|body| body.look.visible != Visibility::Always)
        || outcome.is_some_and(|outcome| outcome.plans.iter().any(moves))
}

fn lights(lights: &[PlacedLight]) -> Vec<super::shown::Light> {
    lights.iter().map(super::shown::Light::of).collect()
}

fn trail(scene: &Scene, plan: &Plan, values: &TrailValues, planned: &crate::picture::Trail) -> Trail {
    let (body, map) = (planned.body, planned.map);
    let values_of_body = values.of_bodies.get(&body).into_iter().flatten();
    let shades = map.map(|map| values_of_body.map(|value| plan.shade(map, *value)).collect());
    let width = scene.bodies[planned.body].showing.trail.and_then(|trail| trail.width);
    let radius = width.map(|width| width / 2.0);
    Trail {
        body,
        radius,
        color: planned.color.0,
        tail: planned.tail / planned.radius,
        map,
        shades: shades.unwrap_or_default(),
        every: values.every,
    }
}

fn stage(run: &PageRun, outcome: &Outcome) -> Stage {
    let (plan, survey) = (&outcome.plans[0], &outcome.survey);
    let (stage, values) = (plan.stage(), run.trail_values());
    Stage {
        center: stage.center.to_array(),
        size: stage.size,
        tile: stage.tile,
        tiles_fade: stage.tiles_fade,
        fade: stage.fade,
        fog: stage.fog,
        ambient: stage.ambient,
        ground: stage.ground.as_ref().map(|ground| Ground {
            height: ground.height,
            tile: ground.tile,
            tiles_fade: ground.tiles_fade,
        }),
        timestep: survey.timestep,
        steps_per_frame: survey.steps_per_frame,
        drift: survey.drift,
        drift_scale: survey.drift_scale.name(),
        trails: plan.planned_trails().iter().map(|it| trail(&run.scene, plan, &values, it)).collect(),
        grids: outcome.plans.iter().map(|plan| plan.still_grid().cloned()).collect(),
        plots: super::shown::plots(&run.scene, plan),
        maps: plan
            .mapped_colors()
            .iter()
            .map(|map| map.iter().map(|color| color.linear()).collect())
            .collect(),
        cameras: outcome.plans.iter().map(|plan| super::shown::Camera::of(plan.placed())).collect(),
        lights: match plan.lights_at_start() {
            given if given.is_empty() => lights(&plan.usual_lights()),
            given => lights(&given),
        },
    }
}

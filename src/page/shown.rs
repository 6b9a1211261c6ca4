//! Describes the objects that are drawn beside the bodies in a frame, for the page. Lengths are in meters, colors in sRGB.

use std::io;

use glam::DVec3;
use serde::Serialize;

use super::describe;
use super::run::PageRun;
use crate::font::Weight;
use crate::lettering;
use crate::picture::{self, Lens, Placed, PlacedLight, Plan, Thing, Vertical};
use crate::scene::{Color, LabelPlace, Scene, Side};
use crate::simulate::Frame;

type Vector = [f64; 3];

/// The objects that are drawn beside the bodies in a frame.
#[derive(Serialize)]
pub(super) struct Shown<'a> {
    camera: Camera,
    /// The lights of the frame. `None` if lights do not move.
    lights: Option<Vec<Light>>,
    /// The line width of trails whose width the scene does not set, m.
    stroke: f64,
    /// The lines of the grid. `None` without a grid, or if the camera does not move.
    grid: Option<Thing<'a>>,
    /// Everything else: springs, joints, arrows, axes, marks.
    things: Vec<Thing<'a>>,
    texts: Vec<Text>,
    bar: Option<Bar>,
    /// What the frame shows of each plot.
    plots: Vec<PlotNow>,
    /// The color of each body, as an index into the colors of its material's map. Empty if no color follows a value.
    colors: Vec<u16>,
    /// The transparency of each body, from 0 to 255. Empty if none follows a value.
    transparency: Vec<u8>,
    /// The glow of each body, from 0 to 255. Empty if none follows a value.
    glow: Vec<u8>,
    /// The size of each body, relative to its largest one. Empty if none follows a value.
    scale: Vec<f64>,
    /// Whether each body is drawn. Empty if all are.
    drawn: Vec<bool>,
}

/// The position, direction and lens of a camera at one time, for the page.
#[derive(Serialize)]
pub(super) struct Camera {
    location: Vector,
    look_at: Vector,
    /// The direction that points up in the picture. `None` for an upright camera.
    up: Option<Vector>,
    /// The horizontal angle of view of a perspective camera, degrees.
    angle: Option<f64>,
    /// The width of the view of an orthographic camera, m.
    width: Option<f64>,
}

/// The position and color of a light at one time, for the page.
#[derive(Serialize)]
pub(super) struct Light {
    location: Vector,
    /// The linear color of the light, multiplied by its intensity.
    color: Vector,
    shadows: bool,
    /// True for parallel light. `location` is then a far point in the direction from which the light comes.
    sun: bool,
}

#[derive(Serialize)]
struct Text {
    name: String,
    /// The letters of the text, in parts: their size and their height above the line, both relative to the size of the text, and whether they
    /// are bold.
    says: Vec<(String, f64, f64, bool)>,
    /// The number of the text's own font in the description of the run. `None` for the usual font.
    font: Option<usize>,
    /// The distance between two lines, relative to the size of the text.
    line: f64,
    /// The position of the text in the image plane: x goes from −1 to 1, and y has the same scale, with 0 in the middle.
    x: f64,
    y: f64,
    height: f64,
    align: f64,
    color: Vector,
    /// The index of the body that the text belongs to, and the side of the body where the text stands. `None` for a text in a corner of
    /// the picture.
    beside: Option<(usize, &'static str)>,
    /// The point of the world that the text names, m, and the way from there to the text in the image plane. `None` for other texts.
    anchor: Option<(Vector, [f64; 2])>,
    /// True if the text is right only in the view of the scene's camera, as are the numbers of the grid and the scale bar.
    in_world: bool,
}

/// What a frame shows of a plot.
#[derive(Serialize)]
struct PlotNow {
    curves: Vec<CurveNow>,
    bars: Vec<PlotBar>,
}

/// A bar of a plot: its lower left and its upper right corner.
#[derive(Serialize)]
struct PlotBar {
    from: [f64; 2],
    to: [f64; 2],
    color: Vector,
}

/// What a frame shows of a curve: the number of points up to its time, and the position of its own values.
#[derive(Serialize)]
struct CurveNow {
    count: usize,
    here: Option<[f64; 2]>,
}

/// A plot of the scene. Positions are relative to the lower left corner of the panel, in units of the image plane; those of texts are in the
/// image plane.
#[derive(Serialize)]
pub(super) struct Plot {
    name: String,
    left: f64,
    bottom: f64,
    size: [f64; 2],
    paper: Vector,
    /// The strip of a color bar: its corners, and its colors from left to right.
    strip: Option<Strip>,
    lines: Vec<PlotLine>,
    texts: Vec<Text>,
    curves: Vec<Curve>,
    dot: f64,
}

#[derive(Serialize)]
struct Strip {
    from: [f64; 2],
    to: [f64; 2],
    colors: Vec<Vector>,
}

#[derive(Serialize)]
struct PlotLine {
    from: [f64; 2],
    to: [f64; 2],
    color: Vector,
    is_axis: bool,
}

#[derive(Serialize)]
struct Curve {
    color: Vector,
    /// The color of the part that is still ahead. `None` if this part is not drawn.
    pale: Option<Vector>,
    /// The points of the whole run. `None` is a gap.
    points: Vec<Option<[f64; 2]>>,
}

#[derive(Serialize)]
struct Bar {
    from: f64,
    to: f64,
    y: f64,
    thickness: f64,
    color: Vector,
}

/// A ghost: the pose of a body at an earlier time.
#[derive(Serialize)]
pub(super) struct Ghost {
    time: f64,
    body: usize,
    location: Vector,
    orientation: [f64; 4],
    /// The linear color of the ghost. `None` for the pale color of its material.
    color: Option<Vector>,
    /// The size of the ghost, relative to the largest one of its body.
    scale: f64,
}

impl Camera {
    pub(super) fn of(placed: &Placed) -> Camera {
        let (angle, width) = match placed.lens() {
            Lens::Perspective { angle } => (Some(angle), None),
            Lens::Orthographic { width } => (None, Some(width)),
            Lens::Spherical => (Some(Lens::SPHERICAL_WINDOW_ANGLE), None),
        };
        let (location, look_at) = (placed.location().to_array(), placed.look_at().to_array());
        let up = placed.sky().map(|sky| sky.to_array());
        Camera { location, look_at, up, angle, width }
    }
}

impl Light {
    pub(super) fn of(light: &PlacedLight) -> Light {
        let sun = light.kind == picture::Lamp::Sun;
        Light { location: light.location.to_array(), color: light.color, shadows: light.shadows, sun }
    }
}

/// Returns the objects drawn beside the bodies in some frames, as one camera sees them. The list is empty while the
/// positions of cameras are unknown.
pub(super) fn frames(
    run: &PageRun,
    view: usize,
    frames: impl Iterator<Item = usize>,
) -> io::Result<Vec<Shown<'_>>> {
    let Some(outcome) = run.look() else { return Ok(Vec::new()) };
    let plan = outcome.plans.get(view).unwrap_or(&outcome.plans[0]);
    frames.map(|frame| Ok(shown(&run.scene, plan, &run.frame(frame)?))).collect()
}

/// Returns the ghosts that are known so far, in order of time.
pub(super) fn ghosts(run: &PageRun) -> Vec<Ghost> {
    let plan = run.outcome().and_then(Result::ok).map(|outcome| &outcome.plans[0]);
    let ghost = |ghost: &crate::simulate::Ghost| Ghost {
        time: ghost.time,
        body: ghost.body.id,
        location: ghost.body.location.to_array(),
        orientation: ghost.body.orientation.to_array(),
        color: plan.and_then(|plan| plan.ghost_color(ghost)).map(Color::linear),
        scale: plan.map_or(1.0, |plan| plan.ghost_scale(ghost)),
    };
    run.ghosts().iter().filter(|each| each.look.is_drawn).map(|each| ghost(each)).collect()
}

fn shown<'a>(scene: &Scene, plan: &'a Plan, frame: &Frame) -> Shown<'a> {
    let height = |y: Vertical| y.above_middle(aspect(scene));
    let screen = plan.screen(frame);
    let mut things = plan.links(frame);
    things.extend(plan.marks(frame));
    things.extend(plan.ghosts(frame).flat_map(|ghost| plan.ghost_marks(frame, ghost)));
    let curve = |now: &picture::CurveNow| CurveNow { count: now.count, here: now.here };
    let of_plot = |bar: &picture::PlotBar| PlotBar { from: bar.from, to: bar.to, color: bar.color.0 };
    let now = |now: &picture::PlotNow| PlotNow {
        curves: now.curves.iter().map(curve).collect(),
        bars: now.bars.iter().map(of_plot).collect(),
    };
    let bar = |bar: picture::Bar| Bar {
        from: bar.from,
        to: bar.to,
        y: height(bar.y),
        thickness: bar.thickness,
        color: bar.color.0,
    };
    let looks = plan.looks(frame);
    Shown {
        camera: Camera::of(&plan.camera(frame)),
        lights: plan.lights_move().then(|| plan.lights(frame).iter().map(Light::of).collect()),
        stroke: plan.stroke(frame),
        grid: plan.grid(frame).filter(|_| plan.camera_moves()),
        things,
        texts: plan.texts(frame).iter().map(|each| text(scene, screen.as_ref(), each)).collect(),
        bar: plan.bar(frame).map(bar),
        plots: plan.plots(frame).iter().map(now).collect(),
        colors: looks.colors,
        transparency: bytes(&looks.transparency),
        glow: bytes(&looks.glow),
        scale: looks.scale,
        drawn: looks.is_drawn,
    }
}

/// Returns parts from 0 to 1 as bytes, which are shorter in JSON, and as fine as the colors of a screen.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the conversion saturates")]
fn bytes(parts: &[f64]) -> Vec<u8> {
    parts.iter().map(|part| (part * 255.0).round() as u8).collect()
}

/// The height of the picture, relative to its width.
fn aspect(scene: &Scene) -> f64 {
    f64::from(scene.output.height) / f64::from(scene.output.width)
}

fn text(scene: &Scene, screen: Option<&picture::Screen>, text: &picture::Text<'_>) -> Text {
    let anchor = |point: DVec3| {
        let spot = screen?.project(point)?;
        Some((point.to_array(), [text.x - spot.x, text.y.above_middle(aspect(scene)) - spot.y]))
    };
    Text {
        name: text.name.to_owned(),
        says: lettering::runs(&text.says)
            .map(|run| {
                let is_bold = run.weight == Weight::Bold;
                (run.letters.to_owned(), run.level.size(), run.level.rise(), is_bold)
            })
            .collect(),
        font: describe::fonts(scene).position(|font| font == text.typeface),
        line: picture::LINE,
        x: text.x,
        y: text.y.above_middle(aspect(scene)),
        height: text.height,
        align: text.align,
        color: text.color.0,
        beside: beside(scene, text.name),
        anchor: text.anchor.and_then(anchor),
        in_world: ["grid", "scale bar"].contains(&text.name),
    }
}

/// Describes the plots of a scene: what all frames have in common.
pub(super) fn plots(scene: &Scene, plan: &Plan) -> Vec<Plot> {
    let curve = |curve: &picture::PlannedCurve| Curve {
        color: curve.color.0,
        pale: curve.pale.map(|color| color.0),
        points: curve.points.iter().map(|point| point.at).collect(),
    };
    let strip = |strip: &picture::Strip| Strip {
        from: strip.from,
        to: strip.to,
        colors: strip.colors.iter().map(|color| color.0).collect(),
    };
    let line = |line: &picture::PlotLine| PlotLine {
        from: line.from,
        to: line.to,
        color: line.color.0,
        is_axis: line.is_axis,
    };
    let plot = |plot: &picture::PlannedPlot| Plot {
        name: plot.name.clone(),
        left: plot.left,
        bottom: plot.bottom.above_middle(aspect(scene)),
        size: plot.size,
        paper: plot.paper.0,
        strip: plot.strip.as_ref().map(strip),
        lines: plot.lines.iter().map(line).collect(),
        texts: plot.texts.iter().map(|each| text(scene, None, each)).collect(),
        curves: plot.curves.iter().map(curve).collect(),
        dot: plot.dot,
    };
    plan.planned_plots().iter().map(plot).collect()
}

/// Returns the body that the label with this name belongs to, and the side of the body where the label stands. `None` for a label in a
/// corner of the picture.
fn beside(scene: &Scene, name: &str) -> Option<(usize, &'static str)> {
    let label = scene.labels.iter().find(|label| label.name == name)?;
    match label.place {
        LabelPlace::Body { body, side, .. } => Some((body, Side::name(side))),
        LabelPlace::Corner(_) | LabelPlace::Center => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Frames, survey};

    #[test]
    fn arrows_that_the_ground_would_hide_stand_where_scripts_have_them() {
        let text = "simulation = { duration = 1, gravity = [0, -9.81, 0] }
            [body.ball]\nshape.sphere.radius = 0.5\nlocation = [0, 0.5, 0]\nvelocity = [1, 9, 0]
            arrows.force.scale = 0.01\nghosts = { every = 0.5, arrows = true }\n[environment]\nground.height = 0";
        let scene = Scene::parse(text).unwrap();
        let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
        let frame = Frames::at(&scene, 1.0).unwrap();
        let ghosts: Vec<_> = plan.ghosts(&frame).collect();
        assert_eq!(ghosts.len(), 2);
        let ground = plan.stage().ground.unwrap().height;
        let [picture::Thing { form: picture::Form::Arrow { to: seen, .. }, .. }, ..] =
            plan.ghost_marks(&frame, ghosts[0])[..]
        else {
            panic!("it has an arrow")
        };
        assert!(seen.y > ground, "the force points into the ground, but is drawn above it");
        let tips = shown(&scene, &plan, &frame).things.into_iter().filter_map(|thing| match thing.form {
            picture::Form::Arrow { to, .. } => Some(to),
            _ => None,
        });
        assert!(tips.collect::<Vec<_>>().contains(&seen));
    }
}

//! Plans the pictures of a run. The plan then gives the contents of each frame's picture.

mod largest;
mod marks;
#[cfg(test)]
mod tests;
mod written;

use std::borrow::Cow;
use std::sync::Arc;

pub use largest::Largest;
pub use written::Written;

use self::largest::narrowest_view;
use super::arrows::{Arrow, ArrowSizes, Arrows, round_scales};
use super::bar::{Bar, ScaleBars};
use super::camera::{Lens, MovingCamera, Placed};
use super::direction_hints::DirectionHints;
use super::favored_places::Favored;
use super::followed::FollowedValues;
use super::framed_run::{FramedPart, FramedRun};
use super::ghosts::Ghosts;
use super::grid::{GridLayout, GridPlan};
use super::in_front::Planes;
use super::labels::Labels;
use super::lights::{self, Lights, PlacedLight};
use super::links::Links;
use super::looks::{LookMaps, Looks};
use super::marks::{ArrowMarks, Marks, with_lines};
use super::not_drawn::{self, NotDrawn};
use super::plots::{PlannedPlot, PlotNow, Plots, UnseenPlot};
use super::screen::Screen;
use super::stage::{LineWidths, Scenery, Stage};
use super::thing::{PlannedThing, Thing};
use super::trails::{Trail, Trails};
use super::{colors, framing};
use crate::scene::{Camera, Color, MeasureFormula, Quantity, Scene};
use crate::simulate::{Bounds, Frame, Ghost, Survey};

/// Everything that the pictures of one camera have in common in all frames of a run. The plan is made once, and gives the contents of each
/// picture.
#[derive(Clone, Debug)]
pub struct Plan {
    stage: Stage,
    eye: MovingCamera,
    followed: FollowedValues,
    lights: Lights,
    lights_move: bool,
    arrows: Arrows,
    /// The planes that may hide arrows.
    planes: Planes,
    links: Links,
    ghosts: Ghosts,
    trails: Trails,
    ruler: Option<GridPlan>,
    /// The grid of all frames. `None` without a grid, or if the camera moves.
    ruled: Option<GridLayout>,
    bar: Option<ScaleBars>,
    labels: Labels,
    /// The favored places of the texts that can move.
    favored: Favored,
    plots: Plots,
    looks: LookMaps,
    /// Angles and dimension lines.
    marks: Marks,
    arrow_marks: ArrowMarks,
    /// The image plane at the start. `None` if the pictures have no texts.
    screen: Option<Screen>,
    /// The sizes of arrows and lines for the camera at the start.
    sizes: Sizes,
    largest: Option<Largest>,
    /// The part of the run that the camera frames.
    part: FramedPart,
    /// The indices of the bodies that fly out of the picture.
    left_out: Vec<usize>,
    not_drawn: Vec<NotDrawn>,
    unseen_plots: Vec<UnseenPlot>,
}

/// A camera or a light without a finite place.
pub(crate) struct Lost {
    /// The camera or the light, in words.
    pub(crate) what: String,
    /// Whether it follows measures, which are unknown while a body is absent.
    pub(crate) follows_measures: bool,
}

/// The sizes of arrows and lines in a picture.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    /// The width in view of the camera, m.
    view: f64,
    lines: LineWidths,
    arrows: ArrowSizes,
}

/// True if the pictures of a scene have texts: labels, plots, color bars, names of arrows, angles, distances, a grid or a scale bar.
pub(crate) fn has_texts(scene: &Scene) -> bool {
    scene.writes_measures() || scene.grid.is_some() || scene.scale_bar.is_some()
}

impl Plan {
    /// Plans the pictures of a scene by one of its cameras.
    pub fn new(scene: &Scene, camera: &Camera, survey: &Survey) -> Plan {
        let followed = FollowedValues::new(scene, survey);
        let measures = Arc::clone(followed.measures());
        let framed_run = FramedRun::new(scene, camera, survey, &followed);
        let (span, whole) = (&framed_run.span, framed_run.whole);
        let towards = framing::towards_camera(span.moving, DirectionHints::of(scene));
        let eye_on = |bounds: Bounds| {
            let bounds = framing::rounded_outward(bounds);
            let still = MovingCamera::new(camera, bounds, towards, scene, &followed);
            match &framed_run.track {
                Some(track) => still.along(Arc::clone(track)),
                None => still,
            }
        };
        // The sizes of arrows and grid are chosen for a camera that sees the bodies. The final camera also sees the ends of arrows and
        // grid.
        let first = eye_on(span.seen);
        let view = first.early(0.0).width_of_view(whole);
        let ink = colors::ink(scene.environment.is_dark());
        let scenery = Scenery::new(scene, &framed_run, view);
        let part = first.moves().then_some(view);
        let ruler = scene.grid.map(|grid| GridPlan::new(scene, grid, &scenery, part, ink));
        let longest = std::array::from_fn(|kind: usize| span.arrows[kind].largest);
        let scales = round_scales(longest, view);
        let mut seen = span.seen;
        for tips in (0..Quantity::SCALE_COUNT).filter_map(|kind| span.arrows[kind].tips(scales[kind])) {
            seen = seen.union(tips);
        }
        if let Some(grid) = ruler.as_ref().filter(|_| !first.moves()) {
            seen = seen.union(grid.bounds());
        }
        seen = with_lines(scene, seen);
        let eye = eye_on(seen);
        let placed = eye.placed();
        let early = eye.early(0.0).width_of_view(whole);
        let arrows = Arrows::new(scene, longest, measures.clone());
        let lines = LineWidths::new(early, scene.output);
        let sizes = Sizes {
            view: early,
            lines,
            // Use the rounded scales that the camera was placed for.
            arrows: arrows.still_sizes(scales, early, lines.stroke),
        };
        // The ground is placed below the bodies. Arrows and axes may extend below the ground.
        let stage = Stage::new(scene, scenery, whole, placed);
        let distance = placed.location().distance(stage.center);
        let lights = Lights::new(scene, stage.center, stage.size.max(distance), &followed);
        let still = ruler.as_ref().filter(|_| !eye.moves());
        let links = Links::new(scene, survey);
        let narrowest = narrowest_view(scene, &eye, whole);
        let bar = scene.scale_bar.map(|bar| ScaleBars::new(scene, bar, &scenery, ink));
        let plots = Plots::new(scene, survey, Arc::clone(&measures));
        let bar_at_start = bar.as_ref().and_then(|bar| bar.extent(&placed.screen()));
        let mut plan = Plan {
            lights_move: lights.moves(),
            lights,
            arrows,
            planes: Planes::new(scene, &stage),
            not_drawn: not_drawn::find(scene, survey, &links, narrowest, bar_at_start),
            unseen_plots: plots.unseen(scene, survey),
            links,
            ghosts: Ghosts::new(scene),
            trails: Trails::new(scene, LineWidths::new(narrowest, scene.output).stroke, &survey.color_ranges),
            ruled: still.map(|ruler| ruler.whole(lines.stroke, sizes.view)),
            ruler,
            bar,
            labels: Labels::new(scene, ink, plots.areas(), measures.clone()),
            favored: Favored::default(),
            plots,
            looks: LookMaps::new(scene, survey, measures.clone()),
            marks: Marks::new(scene, &measures, &stage, (placed, early), ink),
            arrow_marks: ArrowMarks::new(scene),
            screen: has_texts(scene).then(|| placed.screen()),
            largest: Largest::seen(scene, camera, survey, &eye, &followed),
            part: framed_run.part,
            left_out: framed_run.left_out,
            sizes,
            stage,
            eye,
            followed,
        };
        plan.favored = plan.favored(&survey.samples);
        plan
    }

    /// The sizes of arrows and lines in a frame. They are constant for a fixed camera.
    fn sizes(&self, frame: &Frame) -> Sizes {
        if !self.eye.moves() {
            return self.sizes;
        }
        let view = self.eye.at(frame).width_of_view(self.stage.whole);
        let lines = self.sizes.lines.scaled(view / self.sizes.view);
        Sizes { view, lines, arrows: self.arrows.sizes(view, lines.stroke) }
    }

    /// The surroundings of the bodies: ground, sky and haze.
    pub fn stage(&self) -> &Stage {
        &self.stage
    }

    /// The camera of a frame.
    pub fn camera(&self, frame: &Frame) -> Placed {
        self.eye.at(frame)
    }

    /// Finds the camera or a light whose place in a frame is not finite. Formulas of the time were checked at the times of frames only, and
    /// measures are known in each frame only.
    pub(crate) fn lost(&self, frame: &Frame) -> Option<Lost> {
        let is_lost = |camera: &Placed| {
            let has_angle = !matches!(camera.lens(), Lens::Perspective { angle } if !angle.is_finite());
            let has_sky = camera.sky().is_none_or(glam::DVec3::is_finite);
            !has_angle || !has_sky || !camera.location().is_finite() || !camera.look_at().is_finite()
        };
        if self.camera_moves() && is_lost(&self.camera(frame)) {
            return Some(Lost {
                what: "the camera".to_owned(),
                follows_measures: self.eye.follows_measures(),
            });
        }
        let lights = if self.lights_move { self.lights(frame) } else { Vec::new() };
        let number = lights.iter().position(|light| !light.location.is_finite())?;
        let what = format!("the light `{}`", lights[number].name);
        Some(Lost { what, follows_measures: self.lights.follows_measures(number) })
    }

    /// The camera before it moves. A fixed camera is the same in all frames.
    pub fn placed(&self) -> &Placed {
        self.eye.placed()
    }

    /// True if the camera moves.
    pub fn camera_moves(&self) -> bool {
        self.eye.moves()
    }

    /// The lights of the scene in a frame. If the list is empty, renderers use the default lights.
    pub fn lights(&self, frame: &Frame) -> Vec<PlacedLight> {
        self.lights.at(frame)
    }

    /// The lights of the scene at the start of the run. If the list is empty, renderers use the default lights.
    pub fn lights_at_start(&self) -> Vec<PlacedLight> {
        self.lights.at_start()
    }

    /// The values of formulas of measures in a frame. NaN if a measure is unknown then.
    pub fn values<'a>(&'a self, frame: &'a Frame) -> impl Fn(&MeasureFormula) -> f64 + 'a {
        self.followed.at(frame)
    }

    /// The default lights, which never move.
    pub fn usual_lights(&self) -> Vec<PlacedLight> {
        lights::usual_lights(&self.stage)
    }

    /// True if any light of the scene moves.
    pub fn lights_move(&self) -> bool {
        self.lights_move
    }

    /// The arrows of a frame: first those of bodies, then those of joints.
    pub(super) fn arrows(&self, frame: &Frame) -> Vec<Arrow> {
        self.arrows.arrows(frame, self.sizes(frame).arrows, &self.eye.at(frame))
    }

    /// The parts of springs and joints that are drawn in a frame.
    pub fn links(&self, frame: &Frame) -> Vec<Thing<'_>> {
        // The sizes of a moving camera take time.
        if self.links.is_empty() {
            Vec::new()
        } else {
            self.links.at(frame, self.sizes(frame).lines.thinnest)
        }
    }

    /// All parts of springs and joints, including those that are not drawn in some frames.
    pub fn planned_links(&self) -> impl Iterator<Item = PlannedThing<'_>> {
        self.links.planned()
    }

    /// For each part of [`planned_links`](Self::planned_links), its shape in a frame. `None` if the part is not drawn.
    pub fn each_link(&self, frame: &Frame) -> impl Iterator<Item = Option<Thing<'_>>> {
        self.links.each(frame, self.sizes(frame).lines.thinnest)
    }

    /// The visible ghosts of a frame: those with another pose than their body.
    pub fn ghosts<'a>(&self, frame: &'a Frame) -> impl Iterator<Item = &'a Ghost> {
        self.ghosts.drawn(frame)
    }

    /// The color of a ghost, which follows the value at the time of the ghost. `None` if the color of its body stays.
    pub fn ghost_color(&self, ghost: &Ghost) -> Option<Color> {
        self.looks.colors.of_ghost(ghost)
    }

    /// The size of a ghost, relative to the largest drawn size of its body.
    pub fn ghost_scale(&self, ghost: &Ghost) -> f64 {
        self.looks.scale_of_ghost(ghost)
    }

    /// The arrows of a ghost in the picture of a frame. Empty if the ghosts of its body have no arrows.
    pub(super) fn ghost_arrows(&self, frame: &Frame, ghost: &Ghost) -> Vec<Arrow> {
        self.arrows.of_ghost(ghost, self.sizes(frame).arrows, &self.eye.at(frame))
    }

    /// The trails of bodies up to a frame.
    pub fn trails(&self, frame: &Frame) -> Vec<Trail> {
        self.trails.up_to(frame, self.sizes(frame).lines)
    }

    /// The width of a clearly visible line in a frame, m. It is the default width of trails.
    pub fn stroke(&self, frame: &Frame) -> f64 {
        self.sizes(frame).lines.stroke
    }

    /// The requested trails without points, with their widths at the start.
    pub fn planned_trails(&self) -> Vec<Trail> {
        self.trails.planned(self.sizes.lines).collect()
    }

    /// The lines of the grid for a fixed camera, the same in all frames. `None` if the camera moves.
    pub fn still_grid(&self) -> Option<&Thing<'static>> {
        self.ruled.as_ref().map(GridLayout::lines)
    }

    /// The lines of the grid in a frame. `None` without a grid.
    pub fn grid(&self, frame: &Frame) -> Option<Thing<'static>> {
        Some(self.ruled(frame)?.lines().clone())
    }

    /// The grid with its numbers in a frame. For a moving camera, only the part around the camera's aim.
    fn ruled(&self, frame: &Frame) -> Option<Cow<'_, GridLayout>> {
        if let Some(ruled) = &self.ruled {
            return Some(Cow::Borrowed(ruled));
        }
        let sizes = self.sizes(frame);
        let camera = self.eye.at(frame);
        self.ruler.as_ref().map(|ruler| Cow::Owned(ruler.seen_by(&camera, sizes.lines.stroke, sizes.view)))
    }

    /// The grid spacing that the scene gives and the drawn spacing, m. `None` if they are equal; the drawn one is larger if there would be
    /// too many lines.
    pub fn too_fine_grid(&self) -> Option<(f64, f64)> {
        self.ruler.as_ref()?.too_fine()
    }

    /// The scale bar of a frame. `None` if the scene has none, or if its reference point is behind the camera.
    pub fn bar(&self, frame: &Frame) -> Option<Bar> {
        let bar = self.bar.as_ref()?;
        Some(bar.on(&self.screen(frame)?)?.0)
    }

    /// The plots, which all frames have in common.
    pub fn planned_plots(&self) -> &[PlannedPlot] {
        self.plots.planned()
    }

    /// What a frame shows of each plot.
    pub fn plots(&self, frame: &Frame) -> Vec<PlotNow> {
        self.plots.at(frame)
    }

    /// The colors of each color map, from the lowest value to the highest; the last one is for undefined values.
    pub fn mapped_colors(&self) -> Vec<Vec<Color>> {
        self.looks.colors.colors()
    }

    /// The color of a value, as an index into the [colors](Plan::mapped_colors) of a map. `None` means an undefined value.
    pub fn shade(&self, map: usize, value: Option<f64>) -> u16 {
        self.looks.colors.shade(map, value)
    }

    /// The color maps of trails, as indices in the scene, in increasing order.
    pub fn maps_of_trails(&self) -> Vec<usize> {
        let mut maps: Vec<usize> = self.planned_trails().iter().filter_map(|trail| trail.map).collect();
        maps.sort_unstable();
        maps.dedup();
        maps
    }

    /// The looks of the bodies in a frame, as far as they follow values.
    pub fn looks(&self, frame: &Frame) -> Looks {
        self.looks.at(frame)
    }

    /// The image plane of a frame's camera. `None` if the pictures have no texts.
    pub fn screen(&self, frame: &Frame) -> Option<Screen> {
        self.screen.map(|still| if self.camera_moves() { self.camera(frame).screen() } else { still })
    }

    /// The part of the run that the camera frames.
    pub fn part(&self) -> FramedPart {
        self.part
    }

    /// The requested things that no picture shows, except plots.
    pub fn not_drawn(&self) -> &[NotDrawn] {
        &self.not_drawn
    }

    /// The plots without room in the picture, and the curves of which no picture shows a point.
    pub fn unseen_plots(&self) -> &[UnseenPlot] {
        &self.unseen_plots
    }

    /// The indices of the bodies that fly out of the picture, the one that gets farthest first. The camera shows the other bodies.
    pub fn left_out(&self) -> &[usize] {
        &self.left_out
    }

    /// The largest body, if a warning about its size is needed: it is too small to be seen, or would be too small in a picture of the whole
    /// run.
    pub fn too_small(&self) -> Option<&Largest> {
        self.largest.as_ref().filter(|largest| largest.is_too_small(self.part))
    }
}

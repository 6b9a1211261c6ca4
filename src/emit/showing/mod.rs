//! Writes the objects that are drawn beside the bodies in SDL: arrows, axes, ghosts, trails, springs, joints, texts.
//!
//! The [`Plan`] contains these objects and their positions. Unused features add nothing to a script.

mod ghosts;
mod plots;
mod texts;
mod things;
mod trails;

use std::sync::Arc;

use serde::Serialize;

use self::ghosts::Ghosts;
use self::trails::Trails;
use super::materials::MaterialText;
use super::meshes::Meshes;
use super::sdl::Style;
use crate::picture::{Plan, Thing, Written, has_texts};
use crate::scene::{Body, Color, ForceKind, Layout, PlotKind, Scene, SpringLine, SpringLook};
use crate::simulate::Frame;

pub use trails::{TrailFile, is_trail_file};

/// The part of the drawn objects beside the bodies that is equal in all frames.
pub(super) struct Showing {
    ghosts: Ghosts,
    trails: Trails,
    /// The SDL text of the grid's lines. It is empty if the camera moves, since the grid then differs from frame to frame.
    grid: String,
    layout: Layout,
    style: Style,
}

/// The POV-Ray macros that a scene needs, as values for templates.
#[derive(Serialize)]
pub(super) struct NeededMacros {
    /// True if bodies, joints, forces or fields have arrows.
    arrows: bool,
    /// True if the pictures contain areas.
    areas: bool,
    /// True if springs are drawn as coils.
    coils: bool,
    /// True if the pictures contain texts.
    labels: bool,
    /// True if the pictures contain plots or color bars.
    plots: bool,
    /// True if the pictures contain color bars.
    color_bars: bool,
    /// True if plots contain bars.
    bars: bool,
    /// True if bodies have trails of one color.
    trails: bool,
    /// True if bodies have trails whose color follows a value.
    shaded_trails: bool,
}

impl NeededMacros {
    pub(super) fn of(scene: &Scene) -> NeededMacros {
        let is_coil = |look: &SpringLook| matches!(look.line, SpringLine::Coil { .. });
        let is_wound = |kind: &ForceKind| matches!(kind, ForceKind::Spring { look: Some(look), links } if is_coil(look) && !links.is_empty());
        let has_surface = |kind: &ForceKind| matches!(kind, ForceKind::Buoyancy { surface: Some(_), .. });
        let has_trail = |body: &Body| body.showing.trail.is_some();
        let has_color_bars = scene.color_maps.iter().any(|map| map.bar.is_some());
        NeededMacros {
            arrows: scene.bodies.iter().any(|body| body.showing.has_arrows())
                || scene.joints.iter().any(|joint| joint.arrows.iter().any(Option::is_some))
                || scene.forces.iter().any(|force| force.arrow.is_some())
                || !scene.fields.is_empty(),
            areas: !scene.areas.is_empty() || scene.forces.iter().any(|force| has_surface(&force.kind)),
            coils: scene.forces.iter().any(|force| is_wound(&force.kind)),
            labels: has_texts(scene),
            plots: !scene.plots.is_empty() || has_color_bars,
            color_bars: has_color_bars,
            bars: scene.plots.iter().any(|plot| plot.kind != PlotKind::Curves),
            trails: scene.bodies.iter().any(|body| has_trail(body) && scene.trail_map_of(body).is_none()),
            shaded_trails: scene.bodies.iter().any(|body| scene.trail_map_of(body).is_some()),
        }
    }
}

impl Showing {
    /// Prepares the part of the drawn objects that is equal in all frames.
    pub(super) fn new(
        scene: &Scene,
        plan: &Plan,
        materials: &[MaterialText],
        meshes: &Meshes,
        style: Style,
    ) -> Showing {
        Showing {
            ghosts: Ghosts::new(scene, materials, meshes, style),
            trails: Trails::new(scene.output.layout, style),
            grid: text_of(plan.still_grid(), style),
            layout: scene.output.layout,
            style,
        }
    }

    /// Appends the declarations of plots and trails to the common part of all scripts.
    pub(super) fn declare(out: &mut String, plan: &Plan, layout: Layout, style: Style) {
        trails::declare(out, plan, layout, style);
        plots::declare(out, plan.planned_plots(), layout, style);
    }

    /// Returns the trail files that the script of a frame includes, except those whose names `has` accepts.
    pub(super) fn trail_files(
        &self,
        plan: &Plan,
        frame: &Frame,
        has: &dyn Fn(&str) -> bool,
    ) -> Vec<TrailFile> {
        self.trails.files(plan, frame, has)
    }

    /// Appends the drawn objects of a frame. `names` are the names of the bodies.
    pub(super) fn write(&self, out: &mut String, plan: &Plan, frame: &Frame, names: &[Arc<str>]) {
        let style = self.style;
        plan.links(frame).iter().for_each(|thing| things::write(out, thing, style));
        self.ghosts.write(out, plan, frame);
        for ghost in plan.ghosts(frame) {
            plan.ghost_marks(frame, ghost).iter().for_each(|thing| things::write(out, thing, style));
        }
        self.trails.write(out, plan, frame, names);
        plan.marks(frame).iter().for_each(|thing| things::write(out, thing, style));
        if let Some(Written { screen, grid, bar, named, labels }) = plan.written(frame) {
            out.push_str(&format!("#local Screen = transform {{ {} }}\n", texts::transform(&screen, style)));
            match plan.camera_moves() {
                true => out.push_str(&text_of(plan.grid(frame).as_ref(), style)),
                false => out.push_str(&self.grid),
            }
            plots::write(out, plan.planned_plots(), &plan.plots(frame), self.layout, style);
            grid.iter().for_each(|text| texts::write(out, text, style));
            if let Some((bar, number)) = bar {
                texts::write_bar(out, &bar, &number, style);
            }
            named.iter().chain(&labels).for_each(|text| texts::write(out, text, style));
        }
    }
}

/// Returns the SDL text of a thing. The text is empty if there is none.
fn text_of(thing: Option<&Thing<'_>>, style: Style) -> String {
    let mut out = String::new();
    thing.into_iter().for_each(|thing| things::write(&mut out, thing, style));
    out
}

/// Returns an sRGB color as the argument of a macro: `<0.1, 0.2, 0.3>`.
pub(super) fn color(color: Color, style: Style) -> String {
    let mut out = String::new();
    style.vector(&mut out, glam::DVec3::from_array(color.0));
    out
}

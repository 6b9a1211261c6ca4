//! What shows the physics of a frame beside its bodies: arrows, axes, ghosts, trails and coils.
//!
//! Each is planned once, when the emitter is made; a frame puts places into the plans. What nobody asks for leaves no
//! trace in a script.

mod arrows;
mod coils;
mod ghosts;
mod labels;
mod rulers;
mod trails;

use serde::Serialize;

use self::arrows::Arrows;
use self::coils::Coils;
use self::ghosts::Ghosts;
use self::labels::Labels;
use self::rulers::Rulers;
use self::trails::Trails;
use super::camera::Moving;
use super::materials::MaterialText;
use super::meshes::Meshes;
use super::screen::Screen;
use super::sdl::Style;
use super::stage::Stage;
use crate::scene::{Color, ForceKind, Scene};
use crate::simulate::{Frame, Survey};

/// The plans of what is shown beside the bodies.
pub(super) struct Showing {
    coils: Coils,
    ghosts: Ghosts,
    trails: Trails,
    arrows: Arrows,
    rulers: Rulers,
    labels: Labels,
    /// The plane on which texts stand, if there are any.
    screen: Option<Screen>,
    /// The camera before which it is, if that moves.
    moving: Option<Moving>,
    style: Style,
}

/// Which macros a scene needs, as templates see it.
#[derive(Serialize)]
pub(super) struct Shows {
    /// Whether bodies have arrows.
    arrows: bool,
    /// Whether springs are drawn.
    coils: bool,
    /// Whether something is written.
    labels: bool,
}

impl Shows {
    pub(super) fn of(scene: &Scene) -> Shows {
        let is_drawn = |kind: &ForceKind| matches!(kind, ForceKind::Spring { coil: Some(_), links, .. } if !links.is_empty());
        Shows {
            arrows: scene.bodies.iter().any(|body| body.showing.arrows.iter().any(Option::is_some)),
            coils: scene.forces.iter().any(|force| is_drawn(&force.kind)),
            labels: !scene.labels.is_empty() || scene.grid.is_some() || scene.scale_bar.is_some(),
        }
    }
}

impl Showing {
    /// Plans what a scene asks for.
    pub(super) fn new(
        scene: &Scene,
        materials: &[MaterialText],
        meshes: &Meshes,
        stage: &Stage,
        survey: &Survey,
        style: Style,
    ) -> Showing {
        Showing {
            coils: Coils::new(scene, style),
            ghosts: Ghosts::new(scene, materials, meshes, style),
            trails: Trails::new(scene, materials, stage.scenery.stroke, style),
            arrows: Arrows::new(scene, survey.arrow_scales, stage.scenery.stroke, style),
            rulers: Rulers::new(scene, &stage.scenery, style),
            labels: Labels::new(scene, style),
            screen: Shows::of(scene).labels.then_some(stage.scenery.screen),
            moving: stage.moving.camera.clone(),
            style,
        }
    }

    /// Appends what is to be shown of a frame.
    pub(super) fn write(&self, out: &mut String, frame: &Frame) {
        self.coils.write(out, frame);
        self.ghosts.write(out, frame);
        for ghost in &frame.past.ghosts {
            if self.ghosts.is_drawn(ghost, frame) {
                self.arrows.write_ghost(out, &ghost.body);
            }
        }
        self.trails.write(out, frame);
        self.arrows.write(out, frame);
        if let Some(still) = &self.screen {
            let screen = &self.moving.as_ref().map_or(*still, |camera| camera.screen(frame));
            out.push_str(&format!("#local Screen = transform {{ {} }}\n", screen.transform(self.style)));
            self.rulers.write(out, screen);
            self.labels.write(out, frame, screen);
        }
    }
}

/// A color in the words of a macro's argument: `<0.1, 0.2, 0.3>`.
fn color(color: Color, style: Style) -> String {
    let mut out = String::new();
    style.vector(&mut out, glam::DVec3::from_array(color.0));
    out
}

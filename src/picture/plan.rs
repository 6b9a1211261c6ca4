//! What all frames of a run have in common, and with it what the picture of each shows.

use glam::DQuat;

use super::arrows::{Arrow, Arrows, Axes};
use super::bar::{Bar, ScaleBars};
use super::camera::{Eye, Placed};
use super::coils::{Coil, Coils};
use super::ghosts::Ghosts;
use super::grid::{Grid, Ruled};
use super::labels::Labels;
use super::lights::{self, Lights, PlacedLight};
use super::screen::Screen;
use super::stage::{self, Stage};
use super::text::Text;
use super::trails::{Trail, Trails};
use super::{colors, framing};
use crate::scene::{Body, Camera, Scene};
use crate::simulate::{BodyFrame, Frame, Ghost, Survey};

/// What all frames of a run, seen by one camera, have in common; made once.
#[derive(Clone, Debug)]
pub struct Plan {
    stage: Stage,
    eye: Eye,
    lights: Lights,
    lights_move: bool,
    arrows: Arrows,
    coils: Coils,
    ghosts: Ghosts,
    trails: Trails,
    grid: Option<Ruled>,
    bar: Option<ScaleBars>,
    labels: Labels,
    /// The plane before the camera as it is at the start, if anything is written on it.
    screen: Option<Screen>,
    largest_in_pixels: Option<f64>,
}

/// Whether a scene writes anything into its pictures.
pub(crate) fn has_texts(scene: &Scene) -> bool {
    !scene.labels.is_empty() || scene.grid.is_some() || scene.scale_bar.is_some()
}

impl Plan {
    /// The plan of a scene that one of its cameras sees, and whose run has been looked over.
    pub fn new(scene: &Scene, camera: &Camera, survey: &Survey) -> Plan {
        let exact = stage::bounds(survey);
        // What stands around is made for the bodies; arrows and axes are no reason to lower the ground.
        let seen = framing::rounded_outward(survey.seen.unwrap_or(exact));
        let eye = Eye::new(camera, seen, scene);
        let placed = eye.placed();
        let stage = Stage::new(scene, exact, placed);
        let distance = placed.location().distance(stage.center);
        let lights = Lights::new(scene, stage.center, stage.size.max(distance));
        let stroke = stage.scenery.stroke;
        let ink = colors::ink(scene);
        Plan {
            lights_move: lights.moves(),
            lights,
            arrows: Arrows::new(scene, survey.arrow_scales, stroke),
            coils: Coils::new(scene),
            ghosts: Ghosts::new(scene),
            trails: Trails::new(scene, stroke),
            grid: scene.grid.and_then(|grid| Ruled::new(scene, grid, &stage.scenery, ink)),
            bar: scene.scale_bar.map(|bar| ScaleBars::new(scene, bar, &stage.scenery, ink)),
            labels: Labels::new(scene, ink),
            screen: has_texts(scene).then(|| placed.screen()),
            largest_in_pixels: largest_in_pixels(scene, placed, distance),
            stage,
            eye,
        }
    }

    /// What surrounds the bodies.
    pub fn stage(&self) -> &Stage {
        &self.stage
    }

    /// The camera of a frame, whether it moves or not.
    pub fn camera(&self, frame: &Frame) -> Placed {
        self.eye.at(frame)
    }

    /// What sees or shines from no finite place at a moment, in words: formulas are checked at the times of frames only.
    pub(crate) fn lost(&self, frame: &Frame) -> Option<String> {
        let is_lost = |camera: &Placed| !camera.location().is_finite() || !camera.look_at().is_finite();
        if self.camera_moves() && is_lost(&self.camera(frame)) {
            return Some("the camera".to_owned());
        }
        let lights = if self.lights_move { self.lights(frame.time) } else { Vec::new() };
        lights
            .iter()
            .find(|light| !light.location.is_finite())
            .map(|light| format!("the light `{}`", light.name))
    }

    /// The camera before it moves: of all frames, if it does not.
    pub fn placed(&self) -> &Placed {
        self.eye.placed()
    }

    /// Whether the camera is not the same in all frames.
    pub fn camera_moves(&self) -> bool {
        self.eye.moves()
    }

    /// The lights that are given, at a time (s). None of them means that the usual ones shine.
    pub fn lights(&self, time: f64) -> Vec<PlacedLight> {
        self.lights.at(time)
    }

    /// The lights of the surroundings, which shine where none is given. They never move.
    pub fn usual_lights(&self) -> Vec<PlacedLight> {
        lights::usual_lights(&self.stage)
    }

    /// Whether the lights are not the same in all frames.
    pub fn lights_move(&self) -> bool {
        self.lights_move
    }

    /// The arrows of a frame, in the order of the bodies.
    pub fn arrows(&self, frame: &Frame) -> Vec<Arrow> {
        self.arrows.arrows(frame)
    }

    /// The axes that are drawn on bodies of a frame, in the order of the bodies.
    pub fn axes(&self, frame: &Frame) -> Vec<Axes> {
        self.arrows.axes(frame)
    }

    /// The springs that are drawn, as they are in a frame.
    pub fn coils(&self, frame: &Frame) -> Vec<Coil<'_>> {
        self.coils.at(frame)
    }

    /// The ghosts of a frame that are drawn: those that are elsewhere than their bodies.
    pub fn ghosts<'a>(&self, frame: &'a Frame) -> impl Iterator<Item = &'a Ghost> {
        self.ghosts.drawn(frame)
    }

    /// The arrows of a body as it was, if its ghosts have any.
    pub fn ghost_arrows(&self, ghost: &BodyFrame) -> Vec<Arrow> {
        self.arrows.of_ghost(ghost)
    }

    /// The trails up to a frame.
    pub fn trails(&self, frame: &Frame) -> Vec<Trail> {
        self.trails.up_to(frame)
    }

    /// The trails that are asked for, without their points.
    pub fn planned_trails(&self) -> &[Trail] {
        self.trails.planned()
    }

    /// What is written in a frame: the numbers of the grid, that of the scale bar, the labels.
    pub fn texts<'a>(&'a self, frame: &Frame) -> Vec<Text<'a>> {
        let Some(screen) = self.screen(frame) else { return Vec::new() };
        let mut texts = self.numbers(&screen);
        texts.extend(self.bar_on(&screen).map(|(_, number)| number));
        texts.extend(self.labels(frame, &screen));
        texts
    }

    /// The lines of the grid, which are the same in all frames.
    pub fn grid(&self) -> Option<&Grid> {
        self.grid.as_ref().map(Ruled::grid)
    }

    /// The scale bar of a frame.
    pub fn bar(&self, frame: &Frame) -> Option<Bar> {
        let bar = self.bar.as_ref()?;
        Some(bar.on(&self.screen(frame)?)?.0)
    }

    /// The plane before the camera of a frame on which texts stand, if there are any.
    pub fn screen(&self, frame: &Frame) -> Option<Screen> {
        self.screen.map(|still| if self.camera_moves() { self.camera(frame).screen() } else { still })
    }

    /// The numbers of the grid on a plane.
    pub(crate) fn numbers(&self, screen: &Screen) -> Vec<Text<'_>> {
        self.grid.as_ref().map_or_else(Vec::new, |grid| grid.numbers(screen))
    }

    /// The scale bar on a plane, and its number.
    pub(crate) fn bar_on(&self, screen: &Screen) -> Option<(Bar, Text<'static>)> {
        self.bar.as_ref()?.on(screen)
    }

    /// The labels of a frame on a plane.
    pub(crate) fn labels<'a>(&'a self, frame: &Frame, screen: &Screen) -> Vec<Text<'a>> {
        self.labels.at(frame, screen)
    }

    /// How many pixels the largest body is wide in the middle of the picture, if that is too little to be seen.
    pub fn too_small(&self) -> Option<f64> {
        self.largest_in_pixels.filter(|&pixels| pixels < SMALLEST_SEEN)
    }
}

/// So many pixels across, a body is a dot.
const SMALLEST_SEEN: f64 = 4.0;

/// The width of the largest body in the picture, if it is as far from the camera as the middle of the motion.
fn largest_in_pixels(scene: &Scene, camera: &Placed, distance: f64) -> Option<f64> {
    let reach = |body: &Body| body.drawn().support(DQuat::IDENTITY, glam::DVec3::Y);
    let largest = scene.bodies.iter().filter_map(reach).reduce(f64::max)?;
    Some(camera.pixels(largest, distance))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Quantity;
    use crate::simulate::{Frames, survey};

    fn plan(keys: &str) -> (Plan, Frame) {
        let text = format!(
            "simulation = {{ duration = 1, gravity = [0, -10, 0] }}
            [body.ball]\nshape.sphere.radius = 0.1\nvelocity = [1, 5, 0]\n{keys}"
        );
        let scene = Scene::parse(&text).unwrap();
        let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
        let frame = Frames::at(&scene, 0.5).unwrap();
        (plan, frame)
    }

    #[test]
    fn what_nobody_asks_for_is_not_there() {
        let (plan, frame) = plan("");
        assert!(plan.arrows(&frame).is_empty() && plan.axes(&frame).is_empty());
        assert!(plan.coils(&frame).is_empty() && plan.trails(&frame).is_empty());
        assert!(plan.texts(&frame).is_empty() && plan.ghosts(&frame).next().is_none());
        assert!(plan.grid().is_none() && plan.bar(&frame).is_none() && plan.screen(&frame).is_none());
        assert!(plan.lights(0.5).is_empty() && !plan.camera_moves() && !plan.lights_move());
    }

    #[test]
    fn lengths_are_metres_whatever_the_unit_of_scripts_is() {
        let keys = "arrows.velocity.scale = 0.2\naxes.length = 2\n[povray]\nunit = 0.001";
        let (plan, frame) = plan(keys);
        let ball = frame.bodies[0];
        let [arrow] = plan.arrows(&frame)[..] else { panic!("one is asked for") };
        assert_eq!((arrow.body, arrow.quantity), (0, Quantity::Velocity));
        assert!((arrow.from.distance(ball.location) - 0.1).abs() < 1e-9);
        assert!((arrow.to - arrow.from).abs_diff_eq(0.2 * ball.velocity, 1e-12));
        let [axes] = plan.axes(&frame)[..] else { panic!("they are asked for") };
        assert_eq!((axes.location, axes.length), (ball.location, 2.0));
        assert!((1.0..5.0).contains(&plan.stage().size));
    }

    #[test]
    fn ghosts_have_their_arrows_and_are_not_where_their_body_is() {
        let (plan, frame) = plan("arrows.velocity = true\nghosts.every = 0.25");
        let ghosts: Vec<f64> = plan.ghosts(&frame).map(|ghost| ghost.time).collect();
        assert_eq!(ghosts, [0.0, 0.25]);
        for ghost in plan.ghosts(&frame) {
            let [arrow] = plan.ghost_arrows(&ghost.body)[..] else { panic!("they have arrows") };
            assert!(arrow.from.distance(ghost.body.location) < 0.1 + 1e-9);
        }
    }

    #[test]
    fn texts_say_of_what_they_are_and_the_bar_is_below_its_number() {
        let (plan, frame) = plan("[label.now]\ntext = '${t:.1} s'\n[scale_bar]\nlength = 1\n[grid]");
        let texts = plan.texts(&frame);
        let says = |name: &str| texts.iter().find(|text| text.name == name).map(|text| text.says.as_ref());
        assert_eq!((says("now"), says("scale bar")), (Some("0.5 s"), Some("1 m")));
        assert!(says("grid").is_some() && plan.grid().is_some_and(|grid| !grid.lines.is_empty()));
        let (bar, number) = plan.bar_on(&plan.screen(&frame).unwrap()).unwrap();
        assert_eq!(Some(bar), plan.bar(&frame));
        assert!(number.y.above_middle(0.5) > bar.y.above_middle(0.5));
        assert!((number.x - (bar.from + bar.to) / 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_camera_that_follows_looks_at_its_body() {
        let (plan, frame) = plan("[camera]\nfollow = { body = 'ball' }\n[label.now]\ntext = 'x'");
        assert!(plan.camera_moves());
        assert_eq!(plan.camera(&frame).look_at(), frame.bodies[0].location);
        let spot = plan.screen(&frame).unwrap().spot(frame.bodies[0].location).unwrap();
        assert!(spot.x.abs() < 1e-12 && spot.y.abs() < 1e-12);
    }
}

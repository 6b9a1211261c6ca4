//! The values that templates can use. Together with the names of the templates, they are an interface for users. `templates/README.md`
//! documents the interface, and a test compares both.

use minijinja::context;
use minijinja::value::{Serde, Value};
use serde::Serialize;

use super::materials::MaterialText;
use super::names;
use super::sdl::{self, Style};
use super::showing::NeededMacros;
use super::span::Span;
use super::stage::{self, CameraText, StageText};
use crate::physics::{BodySnapshot, Shape};
use crate::picture::Plan;
use crate::scene::{Body, Include, Layout, Scene};
use crate::simulate::Frame;

/// Returns the values for the template `common.inc`.
pub(super) fn common(scene: &Scene, stage: &StageText, materials: &[MaterialText]) -> Value {
    let include = |include: &Include| match include {
        Include::Standard(name) => context! { name => name.clone(), text => () },
        Include::Text { name, text } => context! { name => name.clone(), text => text.clone() },
    };
    context! {
        title => scene.title.clone(),
        includes => scene.povray.include.iter().map(include).collect::<Vec<_>>(),
        sdl => sdl::constant(&scene.povray.sdl),
        materials => Value::from(Serde(materials)),
        scope => match scene.output.layout {
            Layout::SelfContained => "local",
            Layout::Shared => "declare",
        },
        rounded_boxes => scene.bodies.iter().any(|body| {
            has_rounded_box(&body.shape) && body.look.object.is_none()
        }),
        axes => scene.bodies.iter().any(|body| {
            matches!(body.shape, Shape::Axes { .. }) || body.showing.axes.is_some()
        }),
        shows => Value::from(Serde(NeededMacros::of(scene))),
        ..Value::from(Serde(stage))
    }
}

/// Returns the values for the templates `animation.pov` and `animation.ini`.
pub(super) fn sequence(scene: &Scene, span: Span) -> Value {
    let frames = scene.simulation.timeline.frames();
    let last = frames.saturating_sub(1);
    let digits = names::width(frames);
    context! {
        title => scene.title.clone(),
        frames,
        last,
        digits,
        // POV-Ray numbers images with as many digits as the last number has, and does not number a single image. These zeros supply the
        // missing digits.
        padding => "0".repeat(if last == 0 { digits } else { digits - last.to_string().len() }),
        width => scene.output.width,
        height => scene.output.height,
        transparent => scene.output.transparent,
        frame_rate => scene.simulation.timeline.frame_rate,
        assets => !scene.povray.assets.is_empty(),
        end => scene.simulation.timeline.time(last),
        first_script => span.first,
        last_script => span.last,
        script_step => span.step,
        gaps => span.gaps,
        partial => span != Span { first: 0, last, step: 1, gaps: false },
    }
}

/// The values for the template `frame.pov` that are equal in all frames.
pub(super) struct FrameConstants {
    title: Value,
    frames: usize,
    common: Value,
    style: Style,
    /// The constant values of each body, by index. `None` if no template uses `bodies`; the built-in templates do not.
    bodies: Option<Vec<BodyConstants>>,
    /// True if a template uses `bodies_sdl`, which combines `solids_sdl` and `showing_sdl`.
    with_all: bool,
}

/// The values of a body that are equal in all frames.
#[derive(Serialize)]
struct BodyConstants {
    name: String,
    shape: &'static str,
    material: Option<String>,
}

/// The values of a body in one frame, for templates. Location and matrix are in POV-Ray units; velocity and force are in SI units.
#[derive(Serialize)]
struct BodyValues<'a> {
    #[serde(flatten)]
    constants: &'a BodyConstants,
    location: [f64; 3],
    matrix: String,
    velocity: [f64; 3],
    angular_velocity: [f64; 3],
    force: [f64; 3],
}

impl FrameConstants {
    /// Collects the constant values of a scene. `common` is the text of `common.inc`, or the line that includes it. `mentions` returns
    /// true if a template uses the value of a given name.
    pub(super) fn new(
        scene: &Scene,
        common: String,
        materials: &[MaterialText],
        style: Style,
        mentions: impl Fn(&str) -> bool,
    ) -> FrameConstants {
        let body = |body: &Body| BodyConstants {
            name: body.name.to_string(),
            shape: if body.look.object.is_some() { "sdl" } else { body.shape.name() },
            material: body.material.map(|material| materials[material].identifier.clone()),
        };
        FrameConstants {
            title: Value::from(scene.title.clone()),
            frames: scene.simulation.timeline.frames(),
            common: Value::from(common),
            style,
            bodies: mentions("bodies").then(|| scene.bodies.iter().map(body).collect()),
            with_all: mentions("bodies_sdl"),
        }
    }

    /// Returns all values of a frame. `solids_sdl` is the text of the bodies, `showing_sdl` the text of all other drawn objects, and `sdl` the
    /// scene's own SDL, if it changes from frame to frame.
    pub(super) fn of(
        &self,
        plan: &Plan,
        frame: &Frame,
        [solids_sdl, showing_sdl]: [String; 2],
        sdl: Option<String>,
    ) -> Value {
        let bodies = self.bodies.as_ref().map(|constants| {
            let values = frame.bodies.iter().map(|body| self.body(&constants[body.id], body));
            Value::from(Serde(values.collect::<Vec<_>>()))
        });
        let unit = self.style.unit;
        // A camera that does not move is in the part that all scripts share.
        let camera = plan.camera_moves().then(|| CameraText::new(&plan.camera(frame), unit));
        let lights = plan.lights_move().then(|| stage::lights(plan.lights(frame), unit));
        let center = plan.lights_move().then(|| (plan.stage().center / unit).to_array());
        context! {
            camera => camera.map(|camera| Value::from(Serde(camera))),
            lights => lights.map(|lights| Value::from(Serde(lights))),
            center,
            frame => frame.index,
            time => frame.time,
            frames => self.frames,
            title => self.title.clone(),
            common => self.common.clone(),
            bodies_sdl => if self.with_all { format!("{solids_sdl}{showing_sdl}") } else { String::new() },
            solids_sdl,
            showing_sdl,
            sdl,
            bodies,
        }
    }

    fn body<'a>(&self, constants: &'a BodyConstants, body: &BodySnapshot) -> BodyValues<'a> {
        let mut matrix = String::new();
        self.style.matrix(&mut matrix, body.orientation, body.location);
        BodyValues {
            constants,
            location: (body.location / self.style.unit).to_array(),
            matrix,
            velocity: body.velocity.to_array(),
            angular_velocity: body.angular_velocity.to_array(),
            force: body.force.to_array(),
        }
    }
}

fn has_rounded_box(shape: &Shape) -> bool {
    match shape {
        Shape::RoundedBox { .. } => true,
        Shape::Compound(compound) => compound.parts().iter().any(|part| has_rounded_box(&part.shape)),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use minijinja::value::ValueKind;

    use super::*;
    use crate::emit::materials;
    use crate::simulate::{Frames, survey};

    /// Collects the names of all values within a value: `camera.angle`, `lights[].name`.
    fn names(value: &Value, path: &str, found: &mut BTreeSet<String>) {
        match value.kind() {
            ValueKind::Map => {
                for key in value.try_iter().unwrap() {
                    let dot = if path.is_empty() { "" } else { "." };
                    names(&value.get_item(&key).unwrap(), &format!("{path}{dot}{key}"), found);
                }
            }
            ValueKind::Seq if value.try_iter().unwrap().any(|item| item.kind() == ValueKind::Map) => {
                value.try_iter().unwrap().for_each(|item| names(&item, &format!("{path}[]"), found));
            }
            _ => {
                found.insert(path.to_owned());
            }
        }
    }

    /// Returns the names in the first column of the table below a heading of `templates/README.md`.
    fn documented(heading: &str) -> BTreeSet<String> {
        let page = include_str!("../../templates/README.md");
        let (_, rest) = page.split_once(heading).unwrap();
        let section = rest.split("\n## ").next().unwrap();
        let rows = section.lines().filter_map(|line| line.strip_prefix("| `")?.split_once('`'));
        rows.map(|(name, _)| name.to_owned()).collect()
    }

    #[test]
    fn the_documentation_names_every_value_and_no_other() {
        let scene = Scene::parse(
            "
            [body.ball]
            shape.sphere.radius = 1
            [light.lamp]
            point.location = [1, 2, 3]
            [povray]
            include = ['colors.inc']
            ",
        )
        .unwrap();
        let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
        let stage = StageText::new(&plan, 1.0);
        let materials = materials::texts(&scene);
        let style = Style { unit: 1.0, digits: 9 };
        let constants = FrameConstants::new(&scene, String::new(), &materials, style, |_| true);
        let frame = Frames::new(&scene).next().unwrap().unwrap();

        for (heading, value) in [
            ("## The values of `common.inc`", common(&scene, &stage, &materials)),
            ("## The values of `frame.pov`", constants.of(&plan, &frame, Default::default(), None)),
            ("## The values of `animation.pov` and `animation.ini`", sequence(&scene, Span::of([0]))),
        ] {
            let mut found = BTreeSet::new();
            names(&value, "", &mut found);
            assert_eq!(found, documented(heading), "{heading}");
        }
    }

    #[test]
    fn the_documentation_names_every_template_and_no_other() {
        let names = crate::emit::TEMPLATES.iter().map(|(name, _)| (*name).to_owned());
        assert_eq!(names.collect::<BTreeSet<_>>(), documented("# The templates"));
    }
}

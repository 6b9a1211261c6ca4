//! Reads the `look` of bodies, `[light.NAME]`, `[environment]` and `[output]`.

use glam::DVec3;

use super::view::View;
use super::{Context, motion};
use crate::diagnostic::{Code, Diagnostic};
use crate::physics::Shape;
use crate::scene::{
    Body, BodyLook, Color, Environment, Ground, Layout, Light, LightKind, Output, Preset, SimulationSettings,
    Sky,
};

/// Reads the `look` of a body: the scale at which it is drawn, and its raw SDL.
pub(super) fn of_body(name: &str, view: &View<'_>, shape: &Shape, context: &mut Context<'_>) -> BodyLook {
    let look = view.table("look");
    if shape.is_unbounded() {
        let warning = Diagnostic::warning(Code::NoEffect, format!("`scale` of `{name}` has no effect"));
        context.diagnostics.extend(look.key_span("scale").map(|span| warning.at(span, "a plane is endless")));
        // The template for a plane without a material draws the whole plane and cannot insert raw SDL.
        for key in ["sdl_before", "sdl_after"].into_iter().filter(|_| !view.has("material")) {
            let message = format!("`material` is missing in [body.{name}]");
            let error = Diagnostic::error(Code::MissingKey, message);
            let label = "only stands in planes with a material";
            context.diagnostics.extend(look.key_span(key).map(|span| error.at(span, label)));
        }
    }
    BodyLook {
        scale: look.number("scale").unwrap_or_default(),
        object: view.table("shape").table("sdl").shared_text("object"),
        sdl_before: look.shared_text("sdl_before"),
        sdl_after: look.shared_text("sdl_after"),
    }
}

pub(super) fn lights(
    root: &View<'_>,
    simulation: &SimulationSettings,
    context: &mut Context<'_>,
) -> Vec<Light> {
    let read = |(name, _, view): (&str, _, View<'_>)| {
        for key in ["point", "area"] {
            motion::finite(view.table(key).raw("location"), simulation, context);
        }
        Some(Light {
            name: name.to_owned(),
            kind: light_kind(&view)?,
            color: view.color("color")?,
            intensity: view.number("intensity")?,
            shadows: view.boolean("shadows")?,
        })
    };
    root.named("light").into_iter().filter_map(read).collect()
}

fn light_kind(view: &View<'_>) -> Option<LightKind> {
    if let Some(point) = view.variant("point") {
        return Some(LightKind::Point { location: point.timed_vector("location")? });
    }
    if let Some(area) = view.variant("area") {
        return Some(LightKind::Area {
            location: area.timed_vector("location")?,
            size: area.number("size")?,
        });
    }
    let direction = view.variant("sun")?.direction::<3>("direction")?;
    Some(LightKind::Sun { direction: DVec3::from_array(direction) })
}

pub(super) fn environment(root: &View<'_>, bodies: &[Body]) -> Environment {
    let view = root.table("environment");
    let name = root.text("environment").or_else(|| view.text("preset"));
    let preset = name.and_then(Preset::named).unwrap_or_default();
    let has_plane = bodies.iter().any(|body| matches!(body.shape, Shape::Plane { .. }));
    let table = view.variant("ground");
    let given = table.map(|t| Ground { height: t.number("height"), tile: t.number("tile"), surface: None });
    let wanted = view.boolean("ground").unwrap_or(preset.has_ground() && !has_plane);
    let sky = match (view.boolean("sky"), view.color("sky")) {
        (_, Some(color)) => Sky::Plain(color),
        (Some(false), None) => Sky::Plain(Color([0.0; 3])),
        (_, None) => Sky::Gradient,
    };
    Environment {
        preset,
        ground: given.or_else(|| wanted.then(Ground::default)),
        fog: view.boolean("fog").unwrap_or_default(),
        sky,
    }
}

pub(super) fn output(view: &View<'_>) -> Output {
    let size = view.integers("size").unwrap_or_default();
    let pixels = |i: usize| size.get(i).and_then(|n| u32::try_from(*n).ok()).unwrap_or_default();
    Output {
        width: pixels(0),
        height: pixels(1),
        layout: view.choice("layout", Layout::ALL, Layout::name),
        transparent: view.boolean("transparent").unwrap_or_default(),
        video_rate: view.number("video_rate"),
    }
}

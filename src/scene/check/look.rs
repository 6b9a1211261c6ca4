//! `[camera]`, `[light.NAME]`, `[environment]`, `[output]`.

use glam::DVec3;

use super::Context;
use super::view::View;
use crate::diagnostic::Diagnostic;
use crate::dynamics::Shape;
use crate::scene::{Body, Camera, Color, Environment, Ground, Light, LightKind, Output, Preset, Sky};

pub(super) fn camera(view: &View<'_>, context: &mut Context<'_>) -> Camera {
    let camera = Camera {
        location: view.vector("location"),
        look_at: view.vector("look_at"),
        angle: view.number("angle").unwrap_or(40.0),
    };
    if let (Some(location), Some(look_at)) = (camera.location, camera.look_at) {
        // POV-Ray draws nothing sensible from a camera that is nearer to its aim than rounding reaches.
        let near = location.distance(look_at) <= 1e-9 * location.abs().max(look_at.abs()).max_element();
        if near {
            let error = Diagnostic::error("camera-at-look-at", "the camera is at the point that it looks at");
            let spans = view.span("look_at").into_iter().chain(view.span("location"));
            context.diagnostics.push(spans.fold(error, |error, span| error.at(span, "the same point")));
        }
    }
    camera
}

pub(super) fn lights(root: &View<'_>) -> Vec<Light> {
    let read = |(name, _, view): (&str, _, View<'_>)| {
        Some(Light {
            name: name.to_owned(),
            kind: light_kind(&view)?,
            color: view.color("color").unwrap_or(Color::WHITE),
            intensity: view.number("intensity").unwrap_or(1.0),
            shadows: view.boolean("shadows").unwrap_or(true),
        })
    };
    root.named("light").into_iter().filter_map(read).collect()
}

fn light_kind(view: &View<'_>) -> Option<LightKind> {
    if let Some(point) = view.variant("point") {
        return Some(LightKind::Point { location: point.vector("location")? });
    }
    if let Some(area) = view.variant("area") {
        return Some(LightKind::Area { location: area.vector("location")?, size: area.number("size")? });
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
    let given = table.map(|t| Ground { height: t.number("height"), tile: t.number("tile") });
    let wanted = view.boolean("ground").unwrap_or(preset.has_ground() && !has_plane);
    let sky = match (view.boolean("sky"), view.color("sky")) {
        (_, Some(color)) => Sky::Plain(color),
        (Some(false), None) => Sky::Plain(Color([0.0; 3])),
        (_, None) => Sky::Gradient,
    };
    Environment {
        preset,
        ground: given.or_else(|| wanted.then(Ground::default)),
        fog: view.boolean("fog").unwrap_or(true),
        sky,
    }
}

pub(super) fn output(view: &View<'_>) -> Output {
    let mut output =
        Output { width: 1280, height: 720, transparent: view.boolean("transparent").unwrap_or(false) };
    if let Some([width, height]) = view.list("size") {
        let pixels = |node| super::read::integer(node, 1, 65535).ok().and_then(|n| u32::try_from(n).ok());
        output.width = pixels(width).unwrap_or(output.width);
        output.height = pixels(height).unwrap_or(output.height);
    }
    output
}

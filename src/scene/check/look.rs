//! Reads the `look` of bodies, `[light.NAME]`, `[environment]` and `[output]`.

use glam::DVec3;

use super::marks::Known;
use super::view::View;
use super::{Context, motion, value_map};
use crate::diagnostic::{Code, Diagnostic};
use crate::physics::Shape;
use crate::scene::grammar::bodies::{body, look};
use crate::scene::grammar::forces::force;
use crate::scene::grammar::lights::{area, light, point, sun};
use crate::scene::grammar::scene::{environment, ground, output, scene};
use crate::scene::grammar::shapes::{sdl, shape};
use crate::scene::value::{self, Text};
use crate::scene::{
    Body, BodyLook, Camera, Color, DecimalSign, Environment, Ground, Layout, Light, LightKind, LookNumber,
    Output, Preset, Projection, SimulationSettings, Sky, Visibility,
};

/// Reads the `look` of a body: the scale at which it is drawn, whether it is drawn, and its raw SDL.
pub(super) fn of_body(name: &str, view: &View<'_>, shape: &Shape, context: &mut Context<'_>) -> BodyLook {
    let look = view.table(&body::LOOK);
    if shape.is_unbounded() {
        let warning = Diagnostic::warning(Code::NoEffect, format!("`scale` of `{name}` has no effect"));
        context
            .diagnostics
            .extend(look.key_span(&look::SCALE).map(|span| warning.at(span, "a plane is endless")));
        // The template for a plane without a material draws the whole plane and cannot insert raw SDL.
        for key in [&look::SDL_BEFORE, &look::SDL_AFTER].into_iter().filter(|_| !view.has(&body::MATERIAL)) {
            let message = format!("`material` is missing in [body.{name}]");
            let error = Diagnostic::error(Code::MissingKey, message);
            let label = "only stands in planes with a material";
            context.diagnostics.extend(look.key_span(key).map(|span| error.at(span, label)));
        }
    }
    let scale = value_map::number(&look, &look::SCALE, [1.0, 2.0], context);
    let scale = scale.filter(|_| !shape.is_unbounded()).unwrap_or(LookNumber::Fixed(1.0));
    let condition = look.get_as::<Text>(&look::VISIBLE).zip(look.span(&look::VISIBLE));
    let visible = match (look.get_as::<bool>(&look::VISIBLE), condition) {
        (Some(false), _) => Visibility::Never,
        (_, Some((condition, span))) => Visibility::While(value_map::condition(condition, span, context)),
        _ => Visibility::Always,
    };
    BodyLook {
        scale: match scale {
            LookNumber::Fixed(number) => number,
            LookNumber::Mapped(map) => value_map::largest(map, context),
        },
        scale_map: scale.map(),
        visible,
        object: view.table(&body::SHAPE).table(&shape::SDL).get(&sdl::OBJECT),
        sdl_before: look.get(&look::SDL_BEFORE),
        sdl_after: look.get(&look::SDL_AFTER),
    }
}

pub(super) fn lights(known: Known<'_, '_>, context: &mut Context<'_>) -> Vec<Light> {
    let simulation = known.simulation;
    let read = |(name, _, view): (&str, _, View<'_>)| {
        motion::finite(view.table(&light::POINT).node(&point::LOCATION), simulation, context);
        motion::finite(view.table(&light::AREA).node(&area::LOCATION), simulation, context);
        Some(Light {
            name: name.to_owned(),
            kind: light_kind(&view, known, context)?,
            color: view.get(&light::COLOR),
            intensity: view.get(&light::INTENSITY),
            shadows: view.get(&light::SHADOWS),
        })
    };
    known.root.named(&scene::LIGHT).into_iter().filter_map(read).collect()
}

fn light_kind(view: &View<'_>, known: Known<'_, '_>, context: &mut Context<'_>) -> Option<LightKind> {
    let mut place = |written| known.point("light", written, context);
    if let Some(point) = view.variant(&light::POINT) {
        return Some(LightKind::Point { location: place(point.get(&point::LOCATION)?) });
    }
    if let Some(area) = view.variant(&light::AREA) {
        return Some(LightKind::Area {
            location: place(area.get(&area::LOCATION)?),
            size: area.get(&area::SIZE)?,
        });
    }
    let direction = view.variant(&light::SUN)?.get(&sun::DIRECTION)?;
    Some(LightKind::Sun { direction })
}

pub(super) fn environment(root: &View<'_>, simulation: &SimulationSettings, bodies: &[Body]) -> Environment {
    let view = root.table(&scene::ENVIRONMENT);
    let name = root.get_as::<value::Text>(&scene::ENVIRONMENT).or_else(|| view.get(&environment::PRESET));
    let usual = if is_in_space(root, simulation) { Preset::Space } else { Preset::default() };
    let preset = name.and_then(Preset::named).unwrap_or(usual);
    let has_plane = bodies.iter().any(|body| matches!(body.shape, Shape::Plane { .. }));
    let table = view.variant(&environment::GROUND);
    let given =
        table.map(|t| Ground { height: t.get(&ground::HEIGHT), tile: t.get(&ground::TILE), surface: None });
    let wanted = view.get_as::<bool>(&environment::GROUND).unwrap_or(preset.has_ground() && !has_plane);
    let sky = match (view.get_as::<bool>(&environment::SKY), view.get_as::<value::Color>(&environment::SKY)) {
        (_, Some(color)) => Sky::Plain(color),
        (Some(false), None) => Sky::Plain(Color([0.0; 3])),
        (_, None) => Sky::Gradient,
    };
    Environment {
        preset,
        ground: given.or_else(|| wanted.then(Ground::default)),
        fog: view.get(&environment::FOG),
        sky,
    }
}

/// True if the scene shows planets or stars, as far as one can tell: gravitation acts, and nothing stands on the ground or speaks of it.
fn is_in_space(root: &View<'_>, simulation: &SimulationSettings) -> bool {
    let forces = root.named(&scene::FORCE);
    let does_attract = |force: &View<'_>| force.variant(&force::GRAVITATION).is_some();
    !root.has(&scene::ENVIRONMENT)
        && simulation.gravity == DVec3::ZERO
        && simulation.contacts.is_none()
        && forces.into_iter().any(|(_, _, force)| does_attract(&force))
}

/// Reads `[output]`. `camera` is the main camera, on which the default size depends.
pub(super) fn output(view: &View<'_>, camera: &Camera) -> Output {
    let size = view.get(&output::SIZE);
    let pixels = |i: usize| size.get(i).and_then(|n| u32::try_from(*n).ok()).unwrap_or_default();
    let [width, height] = [pixels(0), pixels(1)];
    let is_chosen = camera.projection == Projection::Spherical && !view.has(&output::SIZE);
    Output {
        width: if is_chosen { Projection::SPHERICAL_ASPECT * height } else { width },
        height,
        layout: view.choice(&output::LAYOUT, Layout::ALL, Layout::name),
        transparent: view.get(&output::TRANSPARENT),
        video_rate: view.get(&output::VIDEO_RATE),
        decimal: view.choice(&output::DECIMAL, DecimalSign::ALL, DecimalSign::name),
    }
}

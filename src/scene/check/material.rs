//! Reads materials from `[material.NAME]` and from the `material` of bodies.

use super::view::View;
use super::{Context, color_map, value_map};
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::grammar::materials::material;
use crate::scene::grammar::scene::{povray, scene};
use crate::scene::{Color, Finish, LibraryMaterial, Look, LookNumber, Material, value};

/// Reads the materials in all `[material.NAME]` tables.
pub(super) fn read(root: &View<'_>, context: &mut Context<'_>) -> Vec<Material> {
    let tables = root.named(&scene::MATERIAL).into_iter();
    tables.map(|(name, _, view)| look(name, &view, root, context)).collect()
}

/// Reads the look of a material from its table. `name` is the name of the material.
pub(super) fn look(name: &str, view: &View<'_>, root: &View<'_>, context: &mut Context<'_>) -> Material {
    if let Some(texture) = view.get(&material::TEXTURE) {
        is_declared(&texture, view, root, context);
        return Material::new(name, Look::Texture(texture));
    }
    if let Some(sdl) = view.get(&material::SDL) {
        return Material::new(name, Look::Sdl(sdl));
    }
    let (look, color_map) = colored(view, context);
    let zero = LookNumber::Fixed(0.0);
    let mut number = |key| value_map::number(view, key, [0.0, 1.0], context).unwrap_or(zero);
    let (transparency, glow) = (number(&material::TRANSPARENCY), number(&material::GLOW));
    report_meaningless(&look, view, context);
    Material { color_map, transparency, glow, ..Material::new(name, look) }
}

/// Reads a look that has a color, or is like a material of the library, and its color map, as an index in the scene.
fn colored(view: &View<'_>, context: &mut Context<'_>) -> (Look, Option<usize>) {
    let map = color_map::of_color(view, context);
    let color = match &map {
        Some((_, middle)) => Some(*middle),
        None => view.get_as::<value::Color>(&material::COLOR),
    };
    let map = map.map(|(number, _)| number);
    if let Some(material) = view.get(&material::LIKE).and_then(LibraryMaterial::named) {
        if let (Some(span), None) = (view.key_span(&material::COLOR), material.color) {
            let message = format!("a color has no effect on a material that is like `{}`", material.name);
            let warning = Diagnostic::warning(Code::NoEffect, message);
            context.diagnostics.push(warning.at(span, "it has colors of its own"));
        }
        return (material.look(color), map.filter(|_| material.color.is_some()));
    }
    let finish = view.choice(&material::FINISH, Finish::ALL, Finish::name);
    (Look::Plain { color: color.unwrap_or(Color::WHITE), finish }, map)
}

/// Reports a transparency of a look that is transparent already, and a glow of a look that shines already or has no single color.
fn report_meaningless(look: &Look, view: &View<'_>, context: &mut Context<'_>) {
    let clear = match look {
        Look::Library { material, .. } if material.ior.is_some() => {
            Some(format!("a material that is like `{}` lets light through already", material.name))
        }
        _ => None,
    };
    let shining = match look {
        Look::Library { material, color: None } => {
            Some(format!("a material that is like `{}` has no single color that could glow", material.name))
        }
        look if look.glows() => Some("this material shines by itself already".to_owned()),
        _ => None,
    };
    for (key, why) in [(&material::TRANSPARENCY, clear), (&material::GLOW, shining)] {
        if let (Some(span), Some(why)) = (view.key_span(key), why) {
            let help = format!(
                "leave `{key}` out, or write `color = \"#4080c0\"` instead of the other keys",
                key = key.spec
            );
            context
                .diagnostics
                .push(Diagnostic::error(Code::BadLook, why).at(span, "has no meaning here").help(help));
        }
    }
}

/// Reports `transparency` and `glow` of the material of a plane. `table` is the table of the material.
pub(super) fn report_of_plane(name: &str, table: &View<'_>, context: &mut Context<'_>) {
    for key in [&material::TRANSPARENCY, &material::GLOW] {
        if let Some(span) = table.key_span(key) {
            let message = format!("a plane has no `{}`", key.spec);
            let help = "a wide thin box can have it: `shape.box.size = [10, 0.01, 10]` and `fixed = true`";
            context.diagnostics.push(
                Diagnostic::error(Code::BadLook, message)
                    .at(span, format!("the plane is `{name}`"))
                    .help(help),
            );
        }
    }
}

/// Reports a texture in a scene that has neither include files nor SDL, so that nothing can declare the texture.
fn is_declared(texture: &str, view: &View<'_>, root: &View<'_>, context: &mut Context<'_>) {
    let povray = root.table(&scene::POVRAY);
    if povray.has(&povray::INCLUDE) || povray.has(&povray::SDL) {
        return;
    }
    let error =
        Diagnostic::error(Code::UndeclaredTexture, format!("nothing declares the texture `{texture}`"));
    let help = "name the include file that does: `[povray]` `include = [\"metals.inc\"]`";
    context.diagnostics.extend(view.span(&material::TEXTURE).map(|span| error.at(span, "").help(help)));
}

//! Reads materials from `[material.NAME]` and from the `material` of bodies.

use super::view::View;
use super::{Context, color_map};
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::grammar::materials::material;
use crate::scene::grammar::scene::{povray, scene};
use crate::scene::{Color, Finish, LibraryMaterial, Look, Material, value};

/// Reads the materials in all `[material.NAME]` tables.
pub(super) fn read(root: &View<'_>, context: &mut Context<'_>) -> Vec<Material> {
    let tables = root.named(&scene::MATERIAL).into_iter();
    tables
        .map(|(name, _, view)| {
            let (look, color_map) = look(&view, root, context);
            Material { name: name.to_owned(), look, color_map }
        })
        .collect()
}

/// Reads the look of a material from its table, and its color map, as an index in the scene.
pub(super) fn look(view: &View<'_>, root: &View<'_>, context: &mut Context<'_>) -> (Look, Option<usize>) {
    if let Some(texture) = view.get(&material::TEXTURE) {
        is_declared(&texture, view, root, context);
        return (Look::Texture(texture), None);
    }
    if let Some(sdl) = view.get(&material::SDL) {
        return (Look::Sdl(sdl), None);
    }
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

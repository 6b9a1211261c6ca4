//! Reads materials from `[material.NAME]` and from the `material` of bodies.

use super::Context;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::grammar::materials::material;
use crate::scene::grammar::scene::{povray, scene};
use crate::scene::{Color, Finish, LibraryMaterial, Look, Material};

/// Reads the materials in all `[material.NAME]` tables.
pub(super) fn read(root: &View<'_>, context: &mut Context<'_>) -> Vec<Material> {
    let tables = root.named(&scene::MATERIAL).into_iter();
    tables
        .map(|(name, _, view)| Material { name: name.to_owned(), look: look(&view, root, context) })
        .collect()
}

/// Reads the look of a material from its table.
pub(super) fn look(view: &View<'_>, root: &View<'_>, context: &mut Context<'_>) -> Look {
    if let Some(texture) = view.get(&material::TEXTURE) {
        is_declared(&texture, view, root, context);
        return Look::Texture(texture);
    }
    if let Some(sdl) = view.get(&material::SDL) {
        return Look::Sdl(sdl);
    }
    if let Some(material) = view.get(&material::LIKE).and_then(LibraryMaterial::named) {
        if let (Some(span), None) = (view.key_span(&material::COLOR), material.color) {
            let message = format!("a color has no effect on a material that is like `{}`", material.name);
            let warning = Diagnostic::warning(Code::NoEffect, message);
            context.diagnostics.push(warning.at(span, "it has colors of its own"));
        }
        return material.look(view.get(&material::COLOR));
    }
    Look::Plain {
        color: view.get(&material::COLOR).unwrap_or(Color::WHITE),
        finish: view.choice(&material::FINISH, Finish::ALL, Finish::name),
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

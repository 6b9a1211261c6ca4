//! The materials of a scene as the scripts know them.

use serde::Serialize;

use super::text::Identifiers;
use crate::scene::{Look, Material};

/// A material as templates see it.
#[derive(Clone, Debug, Serialize)]
pub(super) struct MaterialText {
    /// Its name in the scene.
    pub(super) name: String,
    /// Its identifier in the scripts.
    pub(super) identifier: String,
    /// `plain`, `checkered`, `texture` or `sdl`.
    kind: &'static str,
    /// Of a plain one: its color in sRGB.
    color: Option<[f64; 3]>,
    /// Of a plain one: the name of its finish.
    finish: Option<&'static str>,
    /// The name of the texture that an include file declares.
    texture: Option<String>,
    /// POV-Ray's own words.
    sdl: Option<String>,
    /// What stands in an object that is made of it.
    #[serde(skip)]
    pub(super) usage: String,
    /// Whether it looks the same however it is turned.
    #[serde(skip)]
    pub(super) is_uniform: bool,
    /// Whether it is a macro that makes a whole plane of a transform.
    #[serde(skip)]
    pub(super) makes_plane: bool,
}

/// The materials of a scene, each with an identifier of its own.
pub(super) fn texts(materials: &[Material]) -> Vec<MaterialText> {
    let mut identifiers = Identifiers::default();
    materials.iter().map(|material| text(material, &mut identifiers)).collect()
}

fn text(material: &Material, identifiers: &mut Identifiers) -> MaterialText {
    let identifier = identifiers.add("Material", &material.name);
    let usage = match &material.look {
        // Raw SDL may hold more than a texture, so it is a macro, whose text stands wherever it is called.
        Look::Sdl(_) => format!("{identifier}()"),
        _ => format!("material {{ {identifier} }}"),
    };
    let mut text = MaterialText {
        name: material.name.clone(),
        identifier,
        kind: "plain",
        color: None,
        finish: None,
        texture: None,
        sdl: None,
        usage,
        is_uniform: material.look.is_uniform(),
        makes_plane: matches!(material.look, Look::Checkered),
    };
    match &material.look {
        Look::Plain { color, finish } => {
            text.color = Some(color.0);
            text.finish = Some(finish.name());
        }
        Look::Checkered => text.kind = "checkered",
        Look::Texture(texture) => {
            text.kind = "texture";
            text.texture = Some(texture.clone());
        }
        Look::Sdl(sdl) => {
            text.kind = "sdl";
            text.sdl = Some(sdl.clone());
        }
    }
    text
}

//! The grammar of `[material.NAME]`: the keys that describe a material.

use super::Kind::{Choice, Color, Identifier, Sdl};
use super::key::table;
use super::{KeySpec, Rule};
use crate::scene::sdl::Where;
use crate::scene::{Finish, MATERIALS};

fn finishes() -> Vec<&'static str> {
    Finish::ALL.iter().map(|finish| finish.name()).collect()
}

fn library() -> Vec<&'static str> {
    MATERIALS.iter().map(|material| material.name).collect()
}

table! {
    material: "a material", Rule::AtMostOne(&[&["color", "texture", "sdl"], &["finish", "like", "texture", "sdl"]]);
    COLOR: Option<value::Color> = KeySpec::new(
        "color",
        Color,
        "Its color: [red, green, blue] in sRGB from 0 to 1, \"#rrggbb\", \"#rgb\", or a CSS name",
    )
    .default("white, or that of the `like` material")
    .also(&["colour", "rgb", "pigment", "diffuse"]),
    LIKE: Option<value::Text> = KeySpec::new(
        "like",
        Choice(library),
        "A material of [the library](materials.md), which `color` tints",
    )
    .default("given by `color` and `finish`")
    .also(&["base", "kind", "extends"]),
    FINISH: value::Text = KeySpec::new("finish", Choice(finishes), "How its surface reflects light").default_word("glossy"),
    TEXTURE: Option<value::SharedText> = KeySpec::new("texture", Identifier, "The name of a texture from an include file")
        .default("given by `color` and `finish`"),
    SDL: Option<value::SharedText> = KeySpec::new(
        "sdl",
        Sdl(Where::Inside),
        "SDL for the inside of an object: `texture { … }`, `interior { … }`",
    )
    .default("given by `color` and `finish`"),
}

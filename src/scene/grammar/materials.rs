//! The grammar of `[material.NAME]`: the keys that describe a material.

use super::Kind::{Choice, Color, Identifier, Sdl};
use super::{KeySpec, Rule, TableSpec};
use crate::scene::sdl::Where;
use crate::scene::{Finish, MATERIALS};

fn finishes() -> Vec<&'static str> {
    Finish::ALL.iter().map(|finish| finish.name()).collect()
}

fn library() -> Vec<&'static str> {
    MATERIALS.iter().map(|material| material.name).collect()
}

pub(super) static MATERIAL: TableSpec = TableSpec {
    noun: "a material",
    rule: Rule::AtMostOne(&[&["color", "texture", "sdl"], &["finish", "like", "texture", "sdl"]]),
    keys: &[
        KeySpec::new(
            "color",
            Color,
            "Its color: [red, green, blue] in sRGB from 0 to 1, \"#rrggbb\", \"#rgb\", or a CSS name",
        )
        .default("white, or that of the `like` material")
        .also(&["colour", "rgb", "pigment", "diffuse"]),
        KeySpec::new(
            "like",
            Choice(library),
            "A material of [the library](materials.md), which `color` tints",
        )
        .default("given by `color` and `finish`")
        .also(&["base", "kind", "extends"]),
        KeySpec::new("finish", Choice(finishes), "How its surface reflects light").default_word("glossy"),
        KeySpec::new("texture", Identifier, "The name of a texture from an include file")
            .default("given by `color` and `finish`"),
        KeySpec::new(
            "sdl",
            Sdl(Where::Inside),
            "SDL for the inside of an object: `texture { … }`, `interior { … }`",
        )
        .default("given by `color` and `finish`"),
    ],
};

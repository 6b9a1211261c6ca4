//! The grammar of `[material.NAME]`: the keys that describe a material.

use super::Kind::{Boolean, Choice, Color, Either, Identifier, List, Number, Sdl, Table, Text};
use super::key::table;
use super::labels::{TWO_NUMBERS, corners};
use super::{Bound, KeySpec, Kind, Rule};
use crate::scene::sdl::Where;
use crate::scene::{Finish, MATERIALS, Palette};

fn finishes() -> Vec<&'static str> {
    Finish::ALL.iter().map(|finish| finish.name()).collect()
}

fn library() -> Vec<&'static str> {
    MATERIALS.iter().map(|material| material.name).collect()
}

fn palettes() -> Vec<&'static str> {
    Palette::NAMED.iter().map(|(name, ..)| *name).collect()
}

static COLOR_KINDS: [Kind; 2] = [Color, Table(&mapped_color::TABLE)];
static PALETTE_KINDS: [Kind; 2] = [Choice(palettes), List { of: &Color, min: 2, max: 16 }];
static PART_KINDS: [Kind; 2] = [Number(Bound::From(0.0, 1.0)), Table(&mapped_number::TABLE)];
static BAR_KINDS: [Kind; 2] = [Boolean, Choice(corners)];

table! {
    mapped_color: "a color that follows a value", Rule::Any;
    MAP: Any = KeySpec::new("map", Table(&color_map::TABLE), "The value that the color follows, and the colors of its values")
        .required(),
}

table! {
    color_map: "a color map", Rule::Any;
    OF: Option<value::Text> = KeySpec::new(
        "of",
        Text,
        "The measure that the color follows: `\"speed\"` is that of each body itself, or a formula of measures",
    )
    .required()
    .also(&["by", "value", "measure", "quantity"]),
    PALETTE: Any = KeySpec::new("palette", Either(&PALETTE_KINDS), "The colors from the lowest to the highest value: a name, or a list of colors")
        .default_word("viridis")
        .also(&["colormap", "cmap", "colors", "gradient", "scale"]),
    RANGE: Option<Vec<f64>> = KeySpec::new("range", TWO_NUMBERS, "The values of the first and the last color; values outside get the nearer one")
        .default("the lowest and the highest value of the run")
        .also(&["limits", "domain", "clim"]),
    TITLE: Option<value::Text> = KeySpec::new("title", Text, "The title of its color bar")
        .default("the formula")
        .also(&["label", "name"]),
    BAR: Any = KeySpec::new("bar", Either(&BAR_KINDS), "The corner of its color bar, or `false` for none")
        .default_word("bottom-right")
        .also(&["colorbar", "color_bar", "legend"]),
}

table! {
    mapped_number: "a number that follows a value", Rule::Any;
    MAP: Any = KeySpec::new("map", Table(&value_map::TABLE), "The value that the number follows, and the numbers of its values")
        .required(),
}

table! {
    value_map: "a map from values to numbers", Rule::Any;
    OF: Option<value::Text> = KeySpec::new(
        "of",
        Text,
        "The measure that the number follows: `\"speed\"` is that of each body itself, or a formula of measures",
    )
    .required()
    .also(&["by", "value", "measure", "quantity"]),
    RANGE: Option<Vec<f64>> = KeySpec::new("range", TWO_NUMBERS, "The values of the first and the last number; values outside get the nearer one")
        .default("the lowest and the highest value of the run")
        .also(&["limits", "domain", "from"]),
    TO: Option<Vec<f64>> = KeySpec::new("to", TWO_NUMBERS, "The first and the last number")
        .default("[0, 1]")
        .also(&["numbers", "values", "between", "output"]),
}

table! {
    material: "a material", Rule::AtMostOne(&[
        &["color", "texture", "sdl"],
        &["finish", "like", "texture", "sdl"],
        &["transparency", "texture", "sdl"],
        &["glow", "texture", "sdl"],
    ]);
    COLOR: Any = KeySpec::new(
        "color",
        Either(&COLOR_KINDS),
        "Its color: [red, green, blue] in sRGB from 0 to 1, \"#rrggbb\", \"#rgb\", or a CSS name; \
         or `{ map = { … } }` for a color that follows a value",
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
    TRANSPARENCY: Any = KeySpec::new(
        "transparency",
        Either(&PART_KINDS),
        "The part of the light that passes through a convex body: 0 is opaque, 1 invisible; or `{ map = { … } }`",
    )
    .default("0")
    .also(&["transparent", "transmit", "clear"]),
    GLOW: Any = KeySpec::new(
        "glow",
        Either(&PART_KINDS),
        "The part of its color that shines by itself: 0 is none, 1 as by the finish `luminous`; or `{ map = { … } }`",
    )
    .default("0")
    .also(&["emission", "emissive", "shines", "luminosity"]),
    TEXTURE: Option<value::SharedText> = KeySpec::new("texture", Identifier, "The name of a texture from an include file")
        .default("given by `color` and `finish`"),
    SDL: Option<value::SharedText> = KeySpec::new(
        "sdl",
        Sdl(Where::Inside),
        "SDL for the inside of an object: `texture { … }`, `interior { … }`",
    )
    .default("given by `color` and `finish`"),
}

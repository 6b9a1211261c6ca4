//! Reads color maps of materials: `color.map`.
//!
//! A material is read before the bodies, and a formula needs their names. So a map is noted first, and its formula is read at the end.

use super::Context;
use super::label::MAX_LENGTH;
use super::measures::{OwnBody, Reader, Things};
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::Shape;
use crate::scene::grammar::materials::{color_map, mapped_color, material};
use crate::scene::read;
use crate::scene::value::Text;
use crate::scene::{Color, ColorMap, Corner, Material, Palette, Subject};

/// A color map as it is written in the scene.
pub(super) struct Written {
    of: (String, Span),
    palette: Palette,
    range: Option<[f64; 2]>,
    title: Option<(String, Span)>,
    bar: Option<Corner>,
    /// The color in the middle of the palette.
    middle: Color,
}

impl Written {
    /// Returns whether two maps are written alike, so that they need one color bar.
    fn is_same(&self, other: &Written) -> bool {
        let title = |map: &Written| map.title.as_ref().map(|(title, _)| title.clone());
        self.of.0 == other.of.0
            && self.palette == other.palette
            && self.range == other.range
            && title(self) == title(other)
            && self.bar == other.bar
    }
}

/// Notes the color map in the color of a material. Returns its index in the scene, and the color in the middle of its palette. `None` if the
/// color follows no value.
pub(super) fn of_color(material: &View<'_>, context: &mut Context<'_>) -> Option<(usize, Color)> {
    let map = material.variant(&material::COLOR)?.variant(&mapped_color::MAP)?;
    let written = |key| Some((map.get::<Option<Text>>(key)?.to_owned(), map.span(key)?));
    let of = written(&color_map::OF)?;
    // A wrong palette has been reported. The rest of the map is read as if it were the usual one.
    let palette = match map.get_as::<Text>(&color_map::PALETTE) {
        Some(name) => Palette::named(name),
        None => {
            let nodes = map.list(&color_map::PALETTE).unwrap_or_default();
            Palette::through(nodes.iter().filter_map(|node| read::color(node).ok()).collect())
        }
    };
    let palette = palette.or_else(|| Palette::named("viridis"))?;
    let range = map.get(&color_map::RANGE).and_then(|range| <[f64; 2]>::try_from(range).ok());
    if range.is_some_and(|[low, high]| low >= high) {
        let error = Diagnostic::error(Code::BadColorMap, "this range is empty");
        context
            .diagnostics
            .extend(map.span(&color_map::RANGE).map(|span| error.at(span, "the lower value comes first")));
    }
    let bar = match map.get_as::<bool>(&color_map::BAR) {
        Some(false) => None,
        _ => {
            let name = map.get_as::<Text>(&color_map::BAR);
            let corner = Corner::ALL.into_iter().find(|corner| Some(corner.name()) == name);
            Some(corner.unwrap_or(Corner::BottomRight))
        }
    };
    let new = Written { middle: Color::WHITE, of, palette, range, title: written(&color_map::TITLE), bar };
    let maps = &mut context.color_maps;
    let number = maps.iter().position(|known| known.is_same(&new)).unwrap_or_else(|| {
        maps.push(Written { middle: new.palette.middle(), ..new });
        maps.len() - 1
    });
    Some((number, maps[number].middle))
}

/// Reads the formulas of the color maps that materials have. Reports a plane whose color would follow a value.
pub(super) fn read(
    root: &View<'_>,
    things: Things<'_>,
    materials: &[Material],
    context: &mut Context<'_>,
) -> Vec<ColorMap> {
    let maps = std::mem::take(&mut context.color_maps);
    for body in things.bodies.iter().filter(|body| matches!(body.shape, Shape::Plane { .. })) {
        let map = body.material.and_then(|material| maps.get(materials[material].color_map?));
        if let Some(Written { of: (_, span), .. }) = map {
            let error = Diagnostic::error(Code::BadColorMap, "the color of a plane cannot follow a value");
            context.diagnostics.push(error.at(*span, format!("the plane is `{}`", body.name)));
        }
    }
    maps.into_iter()
        .filter_map(|Written { of: (of, span), palette, range, title, bar, .. }| {
            let belongs = ("color", Code::BadColorMap);
            let formula = text(root, belongs, (&of, span), things, context, |reader| {
                reader.formula_with_unit(0..reader.text.len())
            });
            let name = of.rsplit_once(':').map_or(of.as_str(), |(formula, _)| formula).trim();
            let title = match &title {
                Some((title, span)) => text(root, belongs, (title, *span), things, context, set),
                None => Some(name.to_owned()),
            };
            Some(ColorMap { of: formula?, palette, range, title: title?, bar })
        })
        .collect()
}

/// Reads a text of a map. A name such as `speed` in it means the measure of each body itself. Reports a text that is too long. Messages call the
/// owner of the text by `noun`, and errors have the code `code`.
pub(super) fn text<T>(
    root: &View<'_>,
    (noun, code): (&'static str, Code),
    (text, span): (&str, Span),
    things: Things<'_>,
    context: &mut Context<'_>,
    read: impl FnOnce(&mut Reader<'_, '_, '_>) -> Option<T>,
) -> Option<T> {
    if text.len() > MAX_LENGTH {
        let error = Diagnostic::error(code, format!("this text has more than {MAX_LENGTH} bytes"));
        context.diagnostics.push(error.at(span, "write a shorter one"));
        return None;
    }
    let own = OwnBody { body: Subject::Each, ghosts: false };
    read(&mut Reader::new(noun, (text, span), root, Some(own), things, context))
}

/// Sets the scripts and the bold letters of a title. Reports the letters that the font does not have.
fn set(reader: &mut Reader<'_, '_, '_>) -> Option<String> {
    let all = 0..reader.text.len();
    reader.note_letters(all.clone());
    let set = reader.set(all);
    reader.finish();
    set
}

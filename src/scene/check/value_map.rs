//! Reads what in a look may follow a value: the numbers `transparency`, `glow` and `look.scale`, and the condition `look.visible`.
//!
//! Looks are read before all bodies are known, and a formula needs their names. So a map is noted first, and its formula is read at the end.

use super::Context;
use super::color_map::text;
use super::measures::Things;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::grammar::materials::{mapped_number, value_map};
use crate::scene::grammar::{Any, Bound, Key, KeySpec, Kind};
use crate::scene::read::figure;
use crate::scene::value::Text;
use crate::scene::{LookNumber, MeasureFormula, ValueMap};

/// A map as it is written in the scene.
#[derive(PartialEq)]
pub(super) struct Written {
    of: String,
    span: Span,
    range: Option<[f64; 2]>,
    to: [f64; 2],
}

/// Reads a number of a look from a table, and notes its map. `usual` are the numbers of a map that gives none. `None` without the key.
pub(super) fn number(
    table: &View<'_>,
    key: &Key<Any>,
    usual: [f64; 2],
    context: &mut Context<'_>,
) -> Option<LookNumber> {
    if let Some(number) = table.get_as::<f64>(key) {
        return Some(LookNumber::Fixed(number));
    }
    let map = table.variant(key)?.variant(&mapped_number::MAP)?;
    let of = map.get::<Option<Text>>(&value_map::OF)?.to_owned();
    let span = map.span(&value_map::OF)?;
    let two = |key: &Key<Option<Vec<f64>>>| map.get(key).and_then(|list| <[f64; 2]>::try_from(list).ok());
    let range = two(&value_map::RANGE);
    if range.is_some_and(|[low, high]| low >= high) {
        let error = Diagnostic::error(Code::BadLook, "this range is empty");
        let help = "to let the number fall with the value, swap the numbers of `to`";
        context.diagnostics.extend(
            map.span(&value_map::RANGE).map(|span| error.at(span, "the lower value comes first").help(help)),
        );
    }
    let to = two(&value_map::TO).unwrap_or(usual);
    report_numbers(&key.spec, to, map.span(&value_map::TO), context);
    let new = Written { of, span, range, to };
    // Copies of a body share the map of the first one, since all of them have the same position in the text.
    let maps = &mut context.value_maps;
    let number = maps.iter().rposition(|known| *known == new).unwrap_or_else(|| {
        maps.push(new);
        maps.len() - 1
    });
    Some(LookNumber::Mapped(number))
}

/// Returns the largest number of a map that has been noted.
pub(super) fn largest(map: usize, context: &Context<'_>) -> f64 {
    let [first, last] = context.value_maps[map].to;
    first.max(last)
}

/// Notes the condition under which a body is drawn. Returns its index in the scene.
pub(super) fn condition(text: &str, span: Span, context: &mut Context<'_>) -> usize {
    let conditions = &mut context.conditions;
    let new = (text.to_owned(), span);
    conditions.iter().rposition(|known| *known == new).unwrap_or_else(|| {
        conditions.push(new);
        conditions.len() - 1
    })
}

/// Reports numbers of a map that the key itself does not take.
fn report_numbers(key: &KeySpec, to: [f64; 2], span: Option<Span>, context: &mut Context<'_>) {
    let Some(Kind::Number(bound)) = key.kind.one_of(|kind| matches!(kind, Kind::Number(_))) else { return };
    if to.into_iter().all(|number| bound.admits(number)) {
        return;
    }
    let message = format!("`{}` is a number{}", key.name, bound.in_words());
    let ends = match bound {
        Bound::From(low, high) => to.map(|number| number.clamp(*low, *high)),
        Bound::Any | Bound::Positive | Bound::NonNegative => to,
    };
    let label = format!("write `[{}, {}]`", figure(ends[0]), figure(ends[1]));
    let error = Diagnostic::error(Code::BadLook, message);
    context.diagnostics.extend(span.map(|span| error.at(span, label)));
}

/// Reads the formulas of the conditions under which bodies are drawn.
pub(super) fn conditions(
    root: &View<'_>,
    things: Things<'_>,
    context: &mut Context<'_>,
) -> Vec<MeasureFormula> {
    let conditions = std::mem::take(&mut context.conditions);
    let read = |(of, span): (String, Span)| {
        text(root, ("look", Code::BadLook), (&of, span), things, context, |reader| {
            reader.formula(0..reader.text.len())
        })
    };
    conditions.into_iter().filter_map(read).collect()
}

/// Reads the formulas of the maps that looks have.
pub(super) fn read(root: &View<'_>, things: Things<'_>, context: &mut Context<'_>) -> Vec<ValueMap> {
    let maps = std::mem::take(&mut context.value_maps);
    maps.into_iter()
        .filter_map(|Written { of, span, range, to }| {
            let of = text(root, ("look", Code::BadLook), (&of, span), things, context, |reader| {
                reader.formula_with_unit(0..reader.text.len())
            });
            Some(ValueMap { of: of?, range, to })
        })
        .collect()
}

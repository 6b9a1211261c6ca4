//! Reads single values of a scene and checks them against the grammar.
//!
//! Each function is called twice: the validation uses its errors, and the later check uses its values.

use glam::DVec3;

use crate::diagnostic::{Code, Diagnostic, Span, nearest};
use crate::scene::Color;
use crate::scene::force_formula::OfBody;
use crate::scene::grammar::{Bound, Kind};
use crate::scene::sampled_number::SampledNumber;
use crate::scene::source::{Node, Value};
use crate::scene::timed::{Timed, TimedVector};

/// The smallest allowed magnitude of a nonzero number. Squares, and products of three such numbers, do not underflow.
const MIN_MAGNITUDE: f64 = 1e-100;
/// The largest allowed magnitude of a number. Squares, and products of three such numbers, do not overflow.
const MAX_MAGNITUDE: f64 = 1e100;

/// Returns the error for a value of the wrong type.
pub(super) fn wrong_type(node: &Node, expected: &Kind) -> Diagnostic {
    let message = format!("expected {}, found {}", expected.in_words(), node.in_words());
    Diagnostic::error(Code::WrongType, message).at(node.span, "")
}

/// Formats a number for messages, as it would be written in a scene. Very large and very small numbers get an exponent.
pub(super) fn figure(number: f64) -> String {
    if number.is_nan() {
        "nan".to_owned()
    } else if number == 0.0 || !number.is_finite() || (1e-5..1e15).contains(&number.abs()) {
        number.to_string()
    } else {
        format!("{number:e}")
    }
}

/// Reads a finite number within a bound.
pub(super) fn number(node: &Node, bound: Bound) -> Result<f64, Diagnostic> {
    let Some(number) = node.as_number() else { return Err(wrong_type(node, &Kind::Number(bound))) };
    if !number.is_finite() {
        let message = format!("expected a finite number{}, found {}", bound.in_words(), figure(number));
        return Err(Diagnostic::error(Code::NotFinite, message).at(node.span, ""));
    }
    if number != 0.0 && !(MIN_MAGNITUDE..=MAX_MAGNITUDE).contains(&number.abs()) {
        let message = format!(
            "a scene's numbers are 0, or from {MIN_MAGNITUDE:e} to {MAX_MAGNITUDE:e}; this one is {number:e}"
        );
        return Err(Diagnostic::error(Code::OutOfRange, message).at(node.span, ""));
    }
    if !bound.admits(number) {
        let message = format!("expected a number{}, found {}", bound.in_words(), figure(number));
        return Err(Diagnostic::error(Code::OutOfRange, message).at(node.span, ""));
    }
    Ok(number)
}

/// Reads an integer from `low` to `high`, both inclusive.
pub(super) fn integer(node: &Node, low: i64, high: i64) -> Result<i64, Diagnostic> {
    match node.value {
        Value::Integer(number) if (low..=high).contains(&number) => Ok(number),
        Value::Integer(number) => {
            let message = format!("expected a whole number from {low} to {high}, found {number}");
            Err(Diagnostic::error(Code::OutOfRange, message).at(node.span, ""))
        }
        Value::Float(_) => {
            let message = format!("expected a whole number from {low} to {high}, found a decimal number");
            Err(Diagnostic::error(Code::WrongType, message)
                .at(node.span, "")
                .help("write it without a point"))
        }
        _ => Err(wrong_type(node, &Kind::Integer(low, high))),
    }
}

/// Returns the items of a list. Returns an error if the list has fewer than `min` or more than `max` items.
fn items<'a>(node: &'a Node, expected: &Kind, min: usize, max: usize) -> Result<&'a [Node], Diagnostic> {
    let Value::Array(items) = &node.value else { return Err(wrong_type(node, expected)) };
    if (min..=max).contains(&items.len()) {
        return Ok(items);
    }
    let found = match items.len() {
        0 => "an empty list".to_owned(),
        length => format!("a list of {length}"),
    };
    let message = format!("expected {}, found {found}", expected.in_words());
    Err(Diagnostic::error(Code::WrongLength, message).at(node.span, ""))
}

/// Returns the items of a list of the given kind. Checks the number of items, but not the items themselves.
pub(super) fn list<'a>(node: &'a Node, kind: &Kind) -> Result<&'a [Node], Diagnostic> {
    match kind {
        Kind::List { of, min, max } => {
            let items = items(node, kind, *min, *max)?;
            // Three numbers are a point: the one item, without the list around it.
            let is_item = items.len() == 3 && items.iter().all(|item| item.as_number().is_some());
            if is_item && of.takes(&node.value) && !items.iter().any(|item| of.takes(&item.value)) {
                let message =
                    format!("expected {}, found such a value without a list around it", kind.in_words());
                return Err(Diagnostic::error(Code::WrongType, message).at(node.span, ""));
            }
            Ok(items)
        }
        _ => Err(wrong_type(node, kind)),
    }
}

/// Reads a list of `N` numbers within a bound. Returns one error for each wrong number.
pub(super) fn numbers<const N: usize>(node: &Node, bound: Bound) -> Result<[f64; N], Vec<Diagnostic>> {
    let items = items(node, &Kind::Numbers(N, bound), N, N).map_err(|error| vec![error])?;
    let (mut numbers, mut errors) = ([0.0; N], Vec::new());
    for (slot, item) in numbers.iter_mut().zip(items) {
        match number(item, bound) {
            Ok(number) => *slot = number,
            Err(error) => errors.push(error),
        }
    }
    if errors.is_empty() { Ok(numbers) } else { Err(errors) }
}

/// Reads a number within a bound, or a formula of the time. Does not check the values of a formula, because the times are not known yet.
pub(super) fn timed(node: &Node, bound: Bound) -> Result<Timed, Diagnostic> {
    match &node.value {
        Value::Formula(formula) => Ok(Timed::Formula(formula.clone())),
        Value::Integer(_) | Value::Float(_) => number(node, bound).map(Timed::Constant),
        _ => Err(wrong_type(node, &Kind::Timed(bound))),
    }
}

/// Reads a number within a bound, or a formula with random numbers. Does not check the values of a formula.
pub(super) fn drawn(node: &Node, bound: Bound) -> Result<SampledNumber, Diagnostic> {
    match &node.value {
        Value::Sampled(formula) => Ok(SampledNumber::Formula(formula.clone())),
        Value::Integer(_) | Value::Float(_) => number(node, bound).map(SampledNumber::Constant),
        _ => Err(wrong_type(node, &Kind::Sampled(bound))),
    }
}

/// A number, a formula of the time, or the text of a formula of measures. The names in that text are not resolved yet.
#[derive(Clone, Debug)]
pub(in crate::scene) enum UncheckedVarying<'a> {
    Timed(Timed),
    Measured(&'a str, Span),
}

/// Reads a number within a bound, or a formula of the time and of measures. Does not check the values of a formula.
pub(super) fn varying(node: &Node, bound: Bound) -> Result<UncheckedVarying<'_>, Diagnostic> {
    match &node.value {
        Value::String(text) => Ok(UncheckedVarying::Measured(text, node.span)),
        Value::Formula(formula) => Ok(UncheckedVarying::Timed(Timed::Formula(formula.clone()))),
        Value::Integer(_) | Value::Float(_) => {
            number(node, bound).map(|number| UncheckedVarying::Timed(Timed::Constant(number)))
        }
        // The formula of the time has been reported. Formulas of measures beside it are still read.
        Value::Invalid => Ok(UncheckedVarying::Timed(Timed::Constant(f64::NAN))),
        _ => Err(wrong_type(node, &Kind::Varying(bound))),
    }
}

/// Reads a list of three items: numbers within a bound, or formulas of the time and of measures. Returns one error for each wrong item.
pub(super) fn varying_point(node: &Node, bound: Bound) -> Result<[UncheckedVarying<'_>; 3], Vec<Diagnostic>> {
    let items = items(node, &Kind::VaryingNumbers(3, bound), 3, 3).map_err(|error| vec![error])?;
    let mut errors = Vec::new();
    let mut read = |item| {
        varying(item, bound).unwrap_or_else(|error| {
            errors.push(error);
            UncheckedVarying::Timed(Timed::Constant(0.0))
        })
    };
    let point = [read(&items[0]), read(&items[1]), read(&items[2])];
    if errors.is_empty() { Ok(point) } else { Err(errors) }
}

/// Reads a list of three items: numbers within a bound, or formulas of the time. Returns one error for each wrong item.
pub(super) fn timed_vector(node: &Node, bound: Bound) -> Result<TimedVector, Vec<Diagnostic>> {
    let items = items(node, &Kind::TimedNumbers(3, bound), 3, 3).map_err(|error| vec![error])?;
    let mut errors = Vec::new();
    let mut read = |item: &Node| {
        timed(item, bound).unwrap_or_else(|error| {
            errors.push(error);
            Timed::Constant(0.0)
        })
    };
    let vector = TimedVector::Each([read(&items[0]), read(&items[1]), read(&items[2])]);
    if errors.is_empty() { Ok(vector) } else { Err(errors) }
}

/// Reads a number, or a formula of a body's quantities. Does not check the values of a formula.
pub(super) fn of_body(node: &Node, names: &'static [&'static str]) -> Result<OfBody, Diagnostic> {
    match &node.value {
        Value::OfBody(formula) => Ok(OfBody::Formula(formula.clone())),
        Value::Integer(_) | Value::Float(_) => number(node, Bound::Any).map(OfBody::Constant),
        _ => Err(wrong_type(node, &Kind::OfBody(names))),
    }
}

/// Reads a list of three items: numbers, or formulas of a body's quantities. Returns one error for each wrong item.
pub(super) fn list_of_body(
    node: &Node,
    names: &'static [&'static str],
) -> Result<[OfBody; 3], Vec<Diagnostic>> {
    let items = items(node, &Kind::ListOfBody(3, names), 3, 3).map_err(|error| vec![error])?;
    let mut errors = Vec::new();
    let mut read = |item: &Node| {
        of_body(item, names).unwrap_or_else(|error| {
            errors.push(error);
            OfBody::Constant(0.0)
        })
    };
    let list = [read(&items[0]), read(&items[1]), read(&items[2])];
    if errors.is_empty() { Ok(list) } else { Err(errors) }
}

/// Checks that a list has `count` items that are formulas or numbers. Returns one error for each wrong item.
pub(super) fn formulas(node: &Node, count: usize) -> Result<(), Vec<Diagnostic>> {
    let items = items(node, &Kind::Formulas(count), count, count).map_err(|error| vec![error])?;
    let is_formula = |item: &&Node| matches!(item.value, Value::String(_) | Value::Invalid);
    let errors =
        items.iter().filter(|item| !is_formula(item)).filter_map(|item| number(item, Bound::Any).err());
    let errors: Vec<Diagnostic> = errors.collect();
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// Reads a direction and returns it as a unit vector. Returns an error if all numbers are 0.
pub(super) fn direction<const N: usize>(node: &Node) -> Result<[f64; N], Vec<Diagnostic>> {
    let numbers = numbers::<N>(node, Bound::Any)?;
    // Divide by the largest number first, so that the squares neither overflow nor underflow.
    let largest = numbers.iter().fold(0.0, |largest: f64, n| largest.max(n.abs()));
    if largest == 0.0 {
        let message = format!("expected {}", Kind::Direction(N).in_words());
        let error = Diagnostic::error(Code::ZeroLength, message);
        return Err(vec![error.at(node.span, "this has no direction")]);
    }
    let scaled = numbers.map(|n| n / largest);
    let length = scaled.iter().map(|n| n * n).sum::<f64>().sqrt();
    Ok(scaled.map(|n| n / length))
}

/// Reads a color: a hexadecimal code, a CSS name, or a list of three numbers from 0 to 1.
pub(super) fn color(node: &Node) -> Result<Color, Vec<Diagnostic>> {
    match &node.value {
        Value::String(text) => Color::parse(text).ok_or_else(|| {
            let names = crate::scene::color_names::NAMES.iter().map(|(name, _)| *name);
            let error = Diagnostic::error(Code::UnknownColor, format!("`{text}` is not a color"));
            vec![match nearest(text, names) {
                Some(near) => error
                    .at(node.span, format!("did you mean `{near}`?"))
                    .fix(node.span, format!("\"{near}\""))
                    .fix_is_said(),
                None => error.at(node.span, "expected \"#rrggbb\", \"#rgb\" or a name of CSS"),
            }]
        }),
        Value::Array(items) => {
            let bytes = bytes(items);
            numbers::<3>(node, Bound::From(0.0, 1.0)).map(Color).map_err(|errors| match bytes {
                Some([r, g, b]) => {
                    let message = "the numbers of a color go from 0 to 1, not to 255";
                    let help = format!("write \"#{r:02x}{g:02x}{b:02x}\", or divide by 255");
                    let error = Diagnostic::error(Code::OutOfRange, message).at(node.span, "").help(help);
                    vec![error.fix(node.span, format!("\"#{r:02x}{g:02x}{b:02x}\"")).fix_is_said()]
                }
                None => errors,
            })
        }
        _ => Err(vec![wrong_type(node, &Kind::Color)]),
    }
}

/// Reads a color, or a list of one or more colors. Returns the errors of all wrong colors.
pub(super) fn colors(node: &Node) -> Result<Vec<Color>, Vec<Diagnostic>> {
    let Value::Array(items) = &node.value else { return color(node).map(|color| vec![color]) };
    if items.first().is_none_or(|item| item.as_number().is_some()) {
        return color(node).map(|color| vec![color]);
    }
    let (mut colors, mut errors) = (Vec::new(), Vec::new());
    for item in items.iter() {
        match color(item) {
            Ok(color) => colors.push(color),
            Err(wrong) => errors.extend(wrong),
        }
    }
    if errors.is_empty() { Ok(colors) } else { Err(errors) }
}

/// Returns the red, green and blue of a color that was written with numbers from 0 to 255. `None` for other lists.
fn bytes(items: &[Node]) -> Option<[u8; 3]> {
    let byte = |node: &Node| match node.as_number() {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is within 0 and 255")]
        Some(number) if (0.0..=255.0).contains(&number) => Some(number.round() as u8),
        _ => None,
    };
    match items {
        [r, g, b] => Some([byte(r)?, byte(g)?, byte(b)?]).filter(|bytes| bytes.iter().any(|&byte| byte > 1)),
        _ => None,
    }
}

/// Reads an identifier for POV-Ray: letters, digits and underscores, with at most 255 characters.
pub(super) fn identifier(node: &Node) -> Result<&str, Diagnostic> {
    let text = node.as_str().ok_or_else(|| wrong_type(node, &Kind::Identifier))?;
    let starts_well = text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    if starts_well && text.len() <= 255 && text.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_') {
        return Ok(text);
    }
    let message = format!("`{text}` is not {}", Kind::Identifier.in_words());
    Err(Diagnostic::error(Code::BadIdentifier, message).at(node.span, ""))
}

/// Reads a vector of three numbers within a bound. `None` if a number is wrong.
pub(super) fn vector(node: &Node, bound: Bound) -> Option<DVec3> {
    numbers::<3>(node, bound).ok().map(DVec3::from_array)
}

/// Reads a list, each item by a function that gets the item and its kind. `None` if the list or an item is wrong.
pub(super) fn list_of<T>(
    node: &Node,
    kind: &Kind,
    read: impl Fn(&Node, &Kind) -> Option<T>,
) -> Option<Vec<T>> {
    let Kind::List { of, .. } = kind else { return None };
    list(node, kind).ok()?.iter().map(|item| read(item, of)).collect()
}

//! Other values of a key, to replace its value in a scene.

use std::fs;

use super::document::{Document, KeyInFile, Step, written};
use crate::scene::grammar::{Bound, Collection, Kind};
use crate::scene::source::{Node, Value};

/// Returns other values for a key, as TOML. Some may be invalid. `None` means to remove the key.
pub(super) fn others(place: &KeyInFile<'_>) -> Vec<Option<String>> {
    let own = written(place.node, None);
    let mut others = of_kind(&place.key.kind, place.node, place.document);
    others.retain(|other| *other != own);
    others.into_iter().map(Some).chain([None]).collect()
}

/// Returns values of a kind that resemble the value `node`.
fn of_kind(kind: &Kind, node: &Node, document: &Document) -> Vec<String> {
    let text = node.as_str();
    let quoted = |text: &str| serde_json::to_string(text).unwrap();
    match kind {
        Kind::Text => {
            // Some texts are formulas.
            let text = text.unwrap_or_default();
            vec![quoted(&format!("{text} too")), quoted(&format!("({text}) + 1"))]
        }
        Kind::Sdl(_) => vec![quoted(&format!("{}\n// This is a comment.", text.unwrap_or_default()))],
        Kind::Identifier => vec![quoted("Another")],
        Kind::Include => vec![quoted("metals.inc"), quoted("woods.inc")],
        Kind::Boolean => vec!["true".to_owned(), "false".to_owned()],
        Kind::Color | Kind::Colors => vec![quoted("#123456")],
        Kind::Choice(words) => words().into_iter().map(quoted).collect(),
        Kind::Number(bound) | Kind::Timed(bound) | Kind::Varying(bound) | Kind::Sampled(bound) => {
            numbers(*bound, node)
        }
        Kind::OfBody(_) => numbers(Bound::Any, node),
        Kind::Integer(low, high) => {
            let Some(number) = node.as_number() else { return numbers(Bound::Any, node) };
            let near = [number + 1.0, number - 1.0].into_iter();
            #[allow(clippy::cast_precision_loss, reason = "bounds of whole numbers are small")]
            let near = near.filter(|number| (*low as f64..=*high as f64).contains(number));
            near.map(|number| number.to_string()).collect()
        }
        Kind::Numbers(_, bound) | Kind::TimedNumbers(_, bound) | Kind::VaryingNumbers(_, bound) => {
            of_items(node, document, &Kind::Number(*bound))
        }
        Kind::ListOfBody(..) | Kind::Formulas(_) | Kind::Direction(_) => {
            of_items(node, document, &Kind::Number(Bound::Any))
        }
        Kind::List { of, .. } => of_items(node, document, of),
        Kind::Asset | Kind::File => files(text.unwrap_or_default(), document),
        Kind::Reference(collection) => names(*collection, document),
        Kind::Variables(_) => {
            let Value::Table(table) = &node.value else { return Vec::new() };
            let entries = table.entries.iter().map(|entry| (Step::Key(entry.name.text.clone()), &entry.node));
            entries.flat_map(|(step, value)| exchanged(node, &step, numbers(Bound::Any, value))).collect()
        }
        Kind::Table(_) | Kind::Named(_) | Kind::Partial(_) => vec!["{}".to_owned()],
        Kind::Either(kinds) => kinds.iter().flat_map(|kind| of_kind(kind, node, document)).collect(),
    }
}

/// Returns numbers near the number of a node. If the node is a formula, returns formulas with other results.
fn numbers(bound: Bound, node: &Node) -> Vec<String> {
    if let Some(text) = node.as_str() {
        let formula = [format!("({text}) * 1.25"), format!("({text}) * 0.75"), format!("({text}) + 0.1")];
        return formula.iter().map(|text| serde_json::to_string(text).unwrap()).collect();
    }
    let Some(number) = node.as_number() else { return Vec::new() };
    let near = [
        number * 1.25,
        number * 0.75,
        number + 0.1,
        number - 0.1,
        number + 1.0,
        number * 2.0,
        number * 1.000_000_1,
    ];
    let near = near.into_iter().filter(|other| *other != number && bound.admits(*other));
    near.map(|number| format!("{number:?}")).collect()
}

/// Returns variants of a list: with one item replaced, with one item removed, and in reverse order.
fn of_items(node: &Node, document: &Document, of: &Kind) -> Vec<String> {
    let Value::Array(items) = &node.value else { return Vec::new() };
    let others = items.iter().enumerate().flat_map(|(number, item)| {
        let others = of_kind(of, item, document);
        exchanged(node, &Step::Item(number), others)
    });
    let shorter = (0..items.len()).map(|number| written(node, Some((&[Step::Item(number)], None))));
    let turned: Vec<String> = items.iter().rev().map(|item| written(item, None)).collect();
    others.chain(shorter).chain([format!("[{}]", turned.join(", "))]).collect()
}

/// Returns variants of a value, in which each of the given texts replaces one of its parts.
fn exchanged(node: &Node, part: &Step, texts: Vec<String>) -> Vec<String> {
    texts.into_iter().map(|text| written(node, Some((std::slice::from_ref(part), Some(&text))))).collect()
}

/// Returns the other files with the same extension in the folder of a file.
fn files(path: &str, document: &Document) -> Vec<String> {
    let path = std::path::Path::new(path);
    let Some(folder) = document.path.parent().zip(path.parent()).map(|(own, folder)| own.join(folder)) else {
        return Vec::new();
    };
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
    let mut files: Vec<_> = entries.map(|name| path.with_file_name(name)).collect();
    files.retain(|file| file.extension() == path.extension() && file != path);
    files.sort();
    files.iter().map(|file| serde_json::to_string(file).unwrap()).collect()
}

/// Returns the names of the bodies, materials or joints of a scene.
fn names(collection: Collection, document: &Document) -> Vec<String> {
    let table = document.root.get(collection.key()).and_then(|entry| entry.node.as_table());
    let entries = table.into_iter().flat_map(|table| &table.entries);
    entries.map(|entry| serde_json::to_string(&*entry.name.text).unwrap()).collect()
}

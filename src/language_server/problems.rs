//! The errors and warnings of a document, and their fixes.

use serde_json::{Value, json};

use super::document::Document;
use crate::diagnostic::Report;
use crate::scene::{Options, Scene};

/// Returns the errors and warnings of a document, as the protocol wants them. They have the fix in their data.
pub(super) fn of(document: &Document) -> Vec<Value> {
    if !document.is_scene() {
        return Vec::new();
    }
    entries(document).iter().map(|entry| diagnostic(document, entry)).collect()
}

/// Returns the fixes of the problems that overlap a range.
pub(super) fn fixes(document: &Document, range: &Value) -> Value {
    let line = |place: &Value| (place["line"].as_u64(), place["character"].as_u64());
    let overlaps = |other: &Value| {
        line(&other["start"]) <= line(&range["end"]) && line(&range["start"]) <= line(&other["end"])
    };
    let actions: Vec<Value> = entries_of_scene(document)
        .iter()
        .filter_map(|entry| {
            let problem = diagnostic(document, entry);
            overlaps(&problem["range"]).then(|| action(document, entry, &problem)).flatten()
        })
        .collect();
    json!(actions)
}

fn entries_of_scene(document: &Document) -> Vec<Value> {
    if document.is_scene() { entries(document) } else { Vec::new() }
}

/// Checks the text. Returns what was found, as `jabuka check --format json` does.
fn entries(document: &Document) -> Vec<Value> {
    let options = Options::default();
    let read = match document.path() {
        Some(path) => Scene::from_text_at(path, &document.text, &options),
        None => Scene::parse_with(&document.text, &options),
    };
    let report: Report = match read {
        Ok(scene) => scene.warnings,
        Err(report) => report,
    };
    report.to_json().into_iter().filter_map(|entry| serde_json::to_value(entry).ok()).collect()
}

/// Returns whether a range lies in the document, not in a file that it includes. A text without a path has no other files.
fn is_here(document: &Document, range: &Value) -> bool {
    let path = document.path().map(|path| path.display().to_string());
    range["file"].as_str().is_some_and(|file| path.is_none_or(|path| path == file))
}

fn range(document: &Document, range: &Value) -> Value {
    let place = |line: &str, column: &str| {
        let number = |key: &str| range[key].as_u64().unwrap_or(1);
        document.to_place(number(line), number(column))
    };
    json!({ "start": place("line", "column"), "end": place("end_line", "end_column") })
}

fn diagnostic(document: &Document, entry: &Value) -> Value {
    let text = |key: &str| entry[key].as_str().filter(|text| !text.is_empty());
    let here = is_here(document, entry);
    let elsewhere = entry["file"].as_str().filter(|_| !here).map(|file| {
        let line = entry["line"].as_u64().unwrap_or(1);
        format!("in {file}, line {line}")
    });
    let help = text("help").map(|help| format!("help: {help}"));
    let parts = [text("message").map(str::to_owned), text("label").map(str::to_owned), elsewhere, help];
    let message: Vec<String> = parts.into_iter().flatten().collect();
    // A problem without a place, or in another file, stands at the beginning.
    let start = json!({ "line": 0, "character": 0 });
    let at = if here { range(document, entry) } else { json!({ "start": start, "end": start }) };
    let related: Vec<Value> = entry["related"]
        .as_array()
        .into_iter()
        .flatten()
        .filter(|related| is_here(document, related))
        .map(|related| {
            let location = json!({ "uri": document.uri, "range": range(document, related) });
            json!({ "location": location, "message": related["label"] })
        })
        .collect();
    json!({
        "range": at,
        "severity": if entry["severity"] == "error" { 1 } else { 2 },
        "code": entry["code"],
        "source": "jabuka",
        "message": message.join("\n"),
        "relatedInformation": related,
    })
}

/// Returns the action that mends a problem. `None` if no fix is known, or a part of it lies in another file.
fn action(document: &Document, entry: &Value, problem: &Value) -> Option<Value> {
    let fix = entry["fix"].as_array().filter(|fix| !fix.is_empty())?;
    if !fix.iter().all(|edit| is_here(document, edit)) {
        return None;
    }
    let edits: Vec<Value> =
        fix.iter().map(|edit| json!({ "range": range(document, edit), "newText": edit["text"] })).collect();
    let written = fix.first().and_then(|edit| edit["text"].as_str()).map(str::trim).unwrap_or_default();
    let title = match written {
        "" => "Mend it".to_owned(),
        text if fix.len() > 1 || text.contains('\n') => "Mend it".to_owned(),
        text => format!("Write {text}"),
    };
    Some(json!({
        "title": title,
        "kind": "quickfix",
        "diagnostics": [problem],
        "isPreferred": true,
        "edit": { "changes": { document.uri.clone(): edits } },
    }))
}

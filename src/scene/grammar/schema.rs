//! Converts the grammar of scenes into a JSON Schema, with which editors check and complete scenes.
//!
//! TOML plugins of editors support draft 7, which ignores all keywords beside a `$ref`. The schema therefore contains every table in full
//! at each use.

use serde_json::{Map, Value, json};

use super::{Bound, Collection, KeySpec, Kind, Rule, SCENE, TableSpec};
use crate::scene::MATERIALS;
use crate::scene::color::NAMES;

/// Returns a JSON Schema (draft 7) of scenes.
///
/// The schema checks each key and value alone. Only the check of a scene finds out whether keys fit together and whether names exist.
pub fn schema() -> Value {
    let mut schema = table(&SCENE, RequireKeys::No);
    // A table may lack a required key if `[defaults]` or an included file provides it. Required keys are checked only in a scene without
    // these.
    let by_itself =
        json!({ "not": { "anyOf": [{ "required": ["defaults"] }, { "required": ["include"] }] } });
    schema.insert("if".to_owned(), by_itself);
    schema.insert("then".to_owned(), requirements(&SCENE).into());
    schema.insert("$schema".to_owned(), json!("http://json-schema.org/draft-07/schema#"));
    schema.insert("title".to_owned(), json!("A scene of jabuka"));
    schema.into()
}

/// Determines if the schema of a table demands the table's required keys.
#[derive(Clone, Copy, PartialEq)]
enum RequireKeys {
    Yes,
    No,
}

/// Returns a schema that only demands the required keys, of a table and of all tables within it.
fn requirements(spec: &TableSpec) -> Map<String, Value> {
    let inner = |key: &KeySpec| {
        let required = match &key.kind {
            Kind::Named(spec) => match requirements(spec) {
                required if required.is_empty() => required,
                required => object(json!({ "additionalProperties": required })),
            },
            kind => kind.table().map(requirements).unwrap_or_default(),
        };
        (!required.is_empty()).then(|| (key.name.to_owned(), Value::from(required)))
    };
    let properties: Map<_, _> = spec.keys().filter_map(inner).collect();
    let mut schema = Map::new();
    if !properties.is_empty() {
        schema.insert("properties".to_owned(), properties.into());
    }
    let required: Vec<_> = spec.keys().filter(|key| key.required).map(|key| key.name).collect();
    if !required.is_empty() {
        schema.insert("required".to_owned(), json!(required));
    }
    if let Rule::ExactlyOne(names) = &spec.rule {
        let one: Vec<_> = names.iter().map(|name| json!({ "required": [name] })).collect();
        schema.insert("anyOf".to_owned(), one.into());
    }
    schema
}

fn table(spec: &TableSpec, whole: RequireKeys) -> Map<String, Value> {
    let properties: Map<_, _> = spec.keys().map(|key| (key.name.to_owned(), property(key, whole))).collect();
    let required: Vec<_> = spec.keys().filter(|key| key.required).map(|key| key.name).collect();
    let mut schema = object(json!({
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
    }));
    if whole == RequireKeys::Yes && !required.is_empty() {
        schema.insert("required".to_owned(), json!(required));
    }
    match &spec.rule {
        Rule::Any => {}
        Rule::AtMostOne(groups) => {
            let pairs: Vec<_> = groups.iter().flat_map(|names| pairs(names)).collect();
            schema.insert("not".to_owned(), json!({ "anyOf": pairs }));
        }
        Rule::ExactlyOne(names) if whole == RequireKeys::No => {
            let pairs: Vec<_> = pairs(names).collect();
            // A group with a single key yields no pairs, so nothing is excluded.
            if !pairs.is_empty() {
                schema.insert("not".to_owned(), json!({ "anyOf": pairs }));
            }
        }
        Rule::ExactlyOne(names) => {
            let one: Vec<_> = names.iter().map(|name| json!({ "required": [name] })).collect();
            schema.insert("oneOf".to_owned(), one.into());
        }
    }
    schema
}

/// Returns, for each pair of keys, a schema that matches a table with both keys.
fn pairs(names: &'static [&'static str]) -> impl Iterator<Item = Value> {
    let with = |(i, name): (usize, &'static &str)| {
        names[i + 1..].iter().map(move |other| json!({ "required": [name, other] }))
    };
    names.iter().enumerate().flat_map(with)
}

fn property(key: &KeySpec, whole: RequireKeys) -> Value {
    let mut schema = kind(&key.kind, whole);
    let unit = if key.unit.is_empty() { String::new() } else { format!(", in {}", key.unit) };
    let default = match key.default.in_words() {
        words if words.is_empty() => words,
        words => format!(" Without it: {words}."),
    };
    schema.insert("description".to_owned(), format!("{}{unit}.{default}", key.meaning).into());
    if let Some(default) = key.default.to_json() {
        schema.insert("default".to_owned(), default);
    }
    schema.into()
}

fn kind(kind: &Kind, whole: RequireKeys) -> Map<String, Value> {
    match kind {
        // The list of materials serves for completion in editors. Every other name is valid, too, because scenes define materials.
        Kind::Reference(Collection::Material) => {
            let library: Vec<_> = MATERIALS.iter().map(|material| material.name).collect();
            object(json!({ "anyOf": [{ "type": "string", "enum": library }, { "type": "string" }] }))
        }
        Kind::Text | Kind::Sdl(_) | Kind::Reference(_) => object(json!({ "type": "string" })),
        Kind::Boolean => object(json!({ "type": "boolean" })),
        Kind::Number(bound) => number(*bound),
        Kind::Integer(low, high) => {
            object(json!({ "type": ["integer", "string"], "minimum": low, "maximum": high }))
        }
        Kind::Timed(bound) | Kind::Varying(bound) | Kind::Sampled(bound) => number(*bound),
        Kind::Numbers(count, bound)
        | Kind::TimedNumbers(count, bound)
        | Kind::VaryingNumbers(count, bound) => list(number(*bound), *count, *count),
        Kind::OfBody(_) => number(Bound::Any),
        Kind::Formulas(count) | Kind::ListOfBody(count, _) => list(number(Bound::Any), *count, *count),
        Kind::Direction(count) => {
            let mut numbers = list(number(Bound::Any), *count, *count);
            numbers.insert("contains".to_owned(), json!({ "not": { "enum": [0] } }));
            numbers
        }
        Kind::Color => {
            let names: Vec<_> = NAMES.iter().map(|(name, _)| name).collect();
            object(json!({ "anyOf": [
                { "type": "string", "enum": names },
                // A JSON Schema cannot ignore case, so it accepts every word with a capital letter. The check of the scene knows the
                // names.
                { "type": "string", "pattern": "^[a-zA-Z]*[A-Z][a-zA-Z]*$" },
                { "type": "string", "pattern": "^#([0-9a-fA-F]{3}|[0-9a-fA-F]{6})$" },
                list(number(Bound::From(0.0, 1.0)), 3, 3),
            ] }))
        }
        Kind::Colors => {
            let colors = list(self::kind(&Kind::Color, whole), 1, usize::MAX);
            object(json!({ "anyOf": [self::kind(&Kind::Color, whole), colors] }))
        }
        Kind::Identifier => {
            object(json!({ "type": "string", "pattern": "^[A-Za-z_][A-Za-z0-9_]*$", "maxLength": 255 }))
        }
        Kind::Include | Kind::Asset | Kind::File => {
            object(json!({ "type": "string", "pattern": r#"^[^"\\\u0000-\u001f\u007f-\u009f]+$"# }))
        }
        Kind::Choice(words) => object(json!({ "type": "string", "enum": words() })),
        // A list cannot be replaced by a formula, only its items can.
        Kind::List { of, min, max } => list(self::kind(of, RequireKeys::Yes), *min, *max),
        Kind::Table(spec) => table(spec, whole),
        Kind::Partial(spec) => table(spec, RequireKeys::No),
        Kind::Named(spec) => object(json!({ "type": "object", "additionalProperties": table(spec, whole) })),
        Kind::Variables(spec) => object(json!({
            "type": "object",
            "propertyNames": { "pattern": "^[A-Za-z_][A-Za-z0-9_]*$" },
            "additionalProperties": { "anyOf": [number(Bound::Any), table(spec, RequireKeys::Yes)] },
        })),
        Kind::Either(kinds) => {
            let kinds: Vec<_> = kinds.iter().map(|kind| self::kind(kind, whole)).collect();
            object(json!({ "anyOf": kinds }))
        }
    }
}

/// Returns the schema of a number within a bound, or of a formula (a string). The bound applies to numbers only.
fn number(bound: Bound) -> Map<String, Value> {
    let mut number = object(match bound {
        Bound::Any => json!({}),
        Bound::Positive => json!({ "exclusiveMinimum": 0 }),
        Bound::NonNegative => json!({ "minimum": 0 }),
        Bound::From(low, high) => json!({ "minimum": low, "maximum": high }),
    });
    number.insert("type".to_owned(), json!(["number", "string"]));
    number
}

fn list(of: Map<String, Value>, min: usize, max: usize) -> Map<String, Value> {
    let mut list = object(json!({ "type": "array", "minItems": min }));
    list.insert("items".to_owned(), of.into());
    if max < usize::MAX {
        list.insert("maxItems".to_owned(), json!(max));
    }
    list
}

/// Returns the members of a JSON object. Empty for all other values.
fn object(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(members) => members,
        _ => Map::new(),
    }
}

//! Tests that the JSON Schema of scenes and `jabuka check` agree about keys and values, according to the crate `jsonschema`.

use std::path::{Path, PathBuf};

use crate::support::{jabuka, root, stdout};
use jabuka::Scene;
use jabuka::diagnostic::{Code, Diagnostic};
use serde_json::{Value, json};
use toml::de::{DeTable, DeValue};

/// Bad scenes that the check rejects with one of the [`STRUCTURAL`] codes and the schema cannot reject: JSON has no dates, a schema cannot
/// compute the value of a formula, and it has the same bounds for all numbers of a list.
const BEYOND: [&str; 5] = [
    "axis_without_angle",
    "date_and_time",
    "film_speed",
    "formula_not_finite",
    "formula_with_a_value_out_of_range",
];

/// Codes of mistakes that are visible in a single key or value, so that a schema can find them.
const STRUCTURAL: [Code; 14] = [
    Code::UnknownKey,
    Code::MissingKey,
    Code::ExclusiveKeys,
    Code::WrongType,
    Code::WrongLength,
    Code::OutOfRange,
    Code::NotFinite,
    Code::ZeroLength,
    Code::UnknownColor,
    Code::BadIdentifier,
    Code::BadInclude,
    Code::BadAsset,
    Code::NumberTooLarge,
    Code::UnnamedTable,
];

#[test]
fn every_scene_of_the_gallery_is_valid() {
    let validator = validator();
    for path in scenes("scenes") {
        let scene = json(&path).unwrap();
        let errors: Vec<_> = validator.iter_errors(&scene).map(|error| error.to_string()).collect();
        assert!(errors.is_empty(), "{}: {errors:?}", path.display());
    }
}

#[test]
fn bad_scenes_are_invalid_where_a_key_or_a_value_alone_is_wrong() {
    let validator = validator();
    let (mut valid, mut invalid, mut surprises) = (0, 0, Vec::new());
    for path in scenes("tests/bad") {
        // A file that is not valid TOML cannot be validated by a schema.
        let Some(scene) = json(&path) else { continue };
        let name = path.file_stem().unwrap().to_str().unwrap();
        let found = match Scene::from_path(&path) {
            Ok(scene) => scene.warnings.diagnostics,
            Err(report) => report.diagnostics,
        };
        let wrong = found.iter().any(is_structural) && !BEYOND.contains(&name);
        if validator.is_valid(&scene) == wrong {
            surprises.push((name.to_owned(), found));
        }
        *if wrong { &mut invalid } else { &mut valid } += 1;
    }
    assert!(surprises.is_empty(), "the schema and the check disagree: {surprises:#?}");
    assert!(valid > 10 && invalid > 20, "{valid} valid, {invalid} invalid");
}

fn is_structural(diagnostic: &Diagnostic) -> bool {
    // The schema knows the names that the language defines, but not the names of bodies.
    STRUCTURAL.contains(&diagnostic.code) || diagnostic.message.starts_with("unknown ")
}

#[test]
fn the_schema_tells_what_a_key_means() {
    let schema = schema();
    let radius = "/properties/body/additionalProperties/properties/shape/properties/sphere/properties/radius";
    assert_eq!(
        schema.pointer(radius),
        Some(
            &json!({ "type": ["number", "string"], "exclusiveMinimum": 0, "description": "Its radius, in m." })
        )
    );
    let rate = schema.pointer("/properties/simulation/properties/frame_rate").unwrap();
    assert_eq!(rate["default"], 25);
    let description =
        "Frames per second: frame k shows the time k / frame_rate, in frames/s. Without it: 25.";
    assert_eq!(rate["description"], description);
    let integrator = schema.pointer("/properties/simulation/properties/integrator").unwrap();
    assert_eq!(integrator["default"], serde_json::Value::Null, "it depends on the scene");
    let description = integrator["description"].as_str().unwrap();
    assert!(
        description.contains("`velocity-verlet` with joints or event-driven contacts, else `euler-cromer`")
    );
}

/// Checks that schema and check accept the same colors: names in upper or lower case, and three or six hexadecimal digits.
#[test]
fn the_schema_knows_a_color_as_the_check_does() {
    let validator = validator();
    let scene = |color: &str| format!("[body.ball]\nshape.sphere.radius = 1\nmaterial.color = \"{color}\"\n");
    for (color, good) in [
        ("tomato", true),
        ("SlateGrey", true),
        ("#f08", true),
        ("#FF0088", true),
        ("#ff", false),
        ("#ff00gg", false),
        ("blurple", false),
    ] {
        let text = scene(color);
        assert_eq!(Scene::parse(&text).is_ok(), good, "{color}");
        assert_eq!(validator.is_valid(&of_table(DeTable::parse(&text).unwrap().get_ref())), good, "{color}");
    }
}

/// Returns the schema that `jabuka schema` prints.
fn schema() -> Value {
    let output = jabuka().arg("schema").output().unwrap();
    assert!(output.status.success());
    serde_json::from_str(&stdout(&output)).unwrap()
}

fn validator() -> jsonschema::Validator {
    let schema = schema();
    assert!(jsonschema::meta::is_valid(&schema));
    jsonschema::draft7::new(&schema).unwrap()
}

fn scenes(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join(folder)).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    paths
}

/// Returns a TOML scene as JSON, or `None` if the file is not valid TOML.
fn json(path: &Path) -> Option<Value> {
    let text = std::fs::read_to_string(path).unwrap();
    DeTable::parse(&text).ok().map(|table| of_table(table.get_ref()))
}

fn of_table(table: &DeTable<'_>) -> Value {
    table.iter().map(|(key, value)| (key.get_ref().to_string(), of_value(value.get_ref()))).collect()
}

fn of_value(value: &DeValue<'_>) -> Value {
    match value {
        DeValue::String(text) => json!(text),
        DeValue::Integer(digits) => json!(digits.as_str().parse::<i64>().unwrap_or(i64::MAX)),
        // JSON has no infinity and no NaN; these become `null`.
        DeValue::Float(digits) => json!(digits.as_str().parse::<f64>().unwrap()),
        DeValue::Boolean(value) => json!(value),
        DeValue::Datetime(time) => json!(time.to_string()),
        DeValue::Array(items) => items.iter().map(|item| of_value(item.get_ref())).collect(),
        DeValue::Table(table) => of_table(table),
    }
}

//! The JSON Schema of scenes says of keys and values what the check of a scene says, by a validator of other hands.

use std::path::{Path, PathBuf};

use crate::support::{jabuka, root, stdout};
use jabuka::Scene;
use jabuka::diagnostic::{Code, Diagnostic};
use serde_json::{Value, json};
use toml::de::{DeTable, DeValue};

/// Bad scenes with a mistake that the check finds by a code of the schema's, and the schema cannot know: JSON has no dates, and
/// what a string comes to as a formula is not for a schema to say.
const BEYOND: [&str; 4] =
    ["axis_without_angle", "date_and_time", "formula_not_finite", "formula_with_a_value_out_of_range"];

/// The codes of mistakes that a key or a value alone makes.
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
        // What is no TOML is not for a schema to judge.
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
    // A word of the language is known to the schema, the name of a body is not.
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
    assert_eq!(integrator["default"], "euler-cromer");
}

/// Colors are known by names in any case, and by three digits or six.
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

/// The schema as the command prints it.
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

/// A scene as JSON, if it is TOML.
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
        // What is not finite becomes `null`.
        DeValue::Float(digits) => json!(digits.as_str().parse::<f64>().unwrap()),
        DeValue::Boolean(value) => json!(value),
        DeValue::Datetime(time) => json!(time.to_string()),
        DeValue::Array(items) => items.iter().map(|item| of_value(item.get_ref())).collect(),
        DeValue::Table(table) => of_table(table),
    }
}

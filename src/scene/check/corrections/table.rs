//! Corrects a simple value where a table is expected, such as `trail = 2` or `follow = "ball"`.

use super::super::Context;
use super::missing::example_of;
use super::text::raw;
use crate::scene::Color;
use crate::scene::grammar::{KeySpec, Kind, Rule, TableSpec};
use crate::scene::source::{Node, Value};
use crate::scene::units;

/// Returns the TOML text of a table that holds the given value under the required key. Without a required key, guesses the key from the
/// type of the value.
pub(super) fn as_table(
    spec: &'static TableSpec,
    node: &Node,
    name: &str,
    context: &Context<'_>,
) -> Option<String> {
    let raw = raw(node.span, context);
    let entry = |key: &KeySpec, value: &str| Some(format!("{{ {} = {value} }}", key.name));
    let required: Vec<&KeySpec> = spec.keys().filter(|key| key.required).collect();
    if matches!(node.value, Value::Table(_)) || matches!(spec.rule, Rule::ExactlyOne(_)) {
        return None;
    }
    match (required.as_slice(), &node.value) {
        ([count, rest @ ..], Value::Integer(_)) if count.name == "count" && count.kind.takes(&node.value) => {
            let example = |key: &&KeySpec| Some(format!(", {} = {}", key.name, example_of(key, context)?));
            let rest = rest.iter().map(example).collect::<Option<Vec<_>>>()?.concat();
            Some(format!("{{ count = {raw}{rest} }}"))
        }
        ([_, _, ..], _) => None,
        ([only], Value::String(text)) if matches!(only.kind, Kind::Number(_)) => {
            let (number, unit) = units::quantity(text)?;
            entry(only, &units::converted(number, unit, only.unit)?)
        }
        ([only], value) if only.kind.takes(value) => entry(only, raw),
        ([only], Value::Boolean(true)) => entry(only, &example_of(only, context)?),
        ([_], _) => None,
        // Show the first kind of arrow as an example.
        ([], Value::Boolean(true)) if name == "arrows" => entry(spec.keys.first()?, "true"),
        ([], Value::Boolean(true)) => Some("{}".to_owned()),
        ([], Value::Integer(_) | Value::Float(_)) => {
            let is_number = |kind: &Kind| matches!(kind, Kind::Number(_));
            // A first key that also takes something else, such as the `scale` of a look, counts as well.
            let first = spec.keys().next().filter(|key| key.kind.one_of(is_number).is_some());
            entry(spec.keys().find(|key| is_number(&key.kind)).or(first)?, raw)
        }
        ([], Value::String(word)) => {
            let text = by_word(spec, word)?;
            Some(format!("{{ {text} }}"))
        }
        ([], Value::Array(items))
            if items.len() == 3 && !matches!(items[0].value, Value::String(_)) || name == "formula" =>
        {
            let is_vector = |key: &&KeySpec| {
                matches!(
                    key.kind,
                    Kind::Numbers(3, _) | Kind::TimedNumbers(3, _) | Kind::VaryingNumbers(3, _)
                )
            };
            entry(spec.keys().find(is_vector)?, raw)
        }
        ([], Value::Array(items)) => {
            let switches = items.iter().map(|item| Some(format!("{} = true", switch(spec, item.as_str()?)?)));
            let switches = switches.collect::<Option<Vec<_>>>().filter(|switches| !switches.is_empty())?;
            Some(format!("{{ {} }}", switches.join(", ")))
        }
        _ => None,
    }
}

/// Returns the TOML text of the entry that a user probably meant by a single word. The word is a choice, a color, a number with its unit,
/// or the name of a switch.
fn by_word(spec: &'static TableSpec, word: &str) -> Option<String> {
    let find = |is: &dyn Fn(&KeySpec) -> bool| spec.keys().find(|key| is(key));
    let is_choice = |key: &KeySpec| matches!(key.kind, Kind::Choice(words) if words().contains(&word));
    if let Some(key) = find(&is_choice) {
        return Some(format!("{} = \"{word}\"", key.name));
    }
    if let Some(key) = find(&|key| matches!(key.kind, Kind::Color)).filter(|_| Color::parse(word).is_some()) {
        return Some(format!("{} = \"{word}\"", key.name));
    }
    if let Some((number, unit)) = units::quantity(word) {
        let measured =
            |key: &KeySpec| matches!(key.kind, Kind::Number(_)) && units::factor(unit, key.unit).is_some();
        let key = find(&measured)?;
        return Some(format!("{} = {}", key.name, units::converted(number, unit, key.unit)?));
    }
    Some(format!("{} = true", switch(spec, word)?))
}

/// Returns the key of a table that a word switches on, such as `velocity` for `arrows`. `None` if the table has no such switch.
fn switch(spec: &'static TableSpec, word: &str) -> Option<&'static str> {
    super::key_of(word, spec).filter(|key| key.kind.takes(&Value::Boolean(true))).map(|key| key.name)
}

//! Lists the names that a scene can use: integrators, shapes, colors and so on, each with a one-line description; and the example scenes.
//!
//! The names come from the same tables that the check of a scene uses. A new category is one line in [`CATEGORIES`].

use std::borrow::Cow;

use crate::physics::Method;
use crate::scene::color_names;
use crate::scene::expression::{CONSTANTS, FUNCTIONS};
use crate::scene::grammar::{KeySpec, Kind, Rule, SCENE, TableSpec};
use crate::scene::{ContactLaw, Finish, ListedMeasure, MATERIALS, Measure, Palette, Preset};
use crate::starter::Example;

/// A name, with a one-line description.
pub type NamedLine = (Cow<'static, str>, String);

/// A category of names, such as the shapes that scenes can use.
pub struct Category {
    /// The name of the category, such as `shapes`.
    pub name: &'static str,
    /// The key or table of a scene, or the command, in which these names are used.
    pub place: &'static str,
    /// Returns all names of the category, each with a one-line description.
    pub entries: fn() -> Vec<NamedLine>,
}

/// All categories, in the order in which `jabuka list` shows them.
pub static CATEGORIES: &[Category] = &[
    Category { name: "integrators", place: "`integrator` of [simulation]", entries: integrators },
    Category { name: "contacts", place: "`contacts` of [simulation]", entries: contacts },
    Category { name: "shapes", place: "`shape` of [body.NAME]", entries: || variants(&["body", "shape"]) },
    Category { name: "forces", place: "[force.NAME]", entries: || variants(&["force"]) },
    Category { name: "joints", place: "[joint.NAME]", entries: || variants(&["joint"]) },
    Category { name: "repeats", place: "`repeat` of [body.NAME]", entries: || variants(&["body", "repeat"]) },
    Category {
        name: "origins",
        place: "`from` of [emitter.NAME]",
        entries: || variants(&["emitter", "from"]),
    },
    Category { name: "lights", place: "[light.NAME]", entries: || variants(&["light"]) },
    Category { name: "finishes", place: "`finish` of [material.NAME]", entries: finishes },
    Category { name: "materials", place: "`material` of [body.NAME]", entries: materials },
    Category { name: "palettes", place: "`palette` of `color.map` in [material.NAME]", entries: palettes },
    Category { name: "environments", place: "`environment`", entries: environments },
    Category { name: "functions", place: "formulas, wherever a number stands", entries: functions },
    Category {
        name: "measures",
        place: "`text` of [label.NAME], `x` and `y` of [plot.NAME], `of` of `color.map`",
        entries: measures,
    },
    Category { name: "scenes", place: "`jabuka new NAME --like SCENE`", entries: scenes },
    Category { name: "colors", place: "`color` of [material.NAME] and elsewhere", entries: colors },
];

impl Category {
    /// Returns the category with this name, in the plural or in the singular.
    pub fn named(name: &str) -> Option<&'static Category> {
        let is_it = |plural: &str| ["", "s", "es"].iter().any(|end| plural.strip_suffix(end) == Some(name));
        CATEGORIES.iter().find(|category| is_it(category.name))
    }
}

fn integrators() -> Vec<NamedLine> {
    Method::all().map(|method| (method.name.into(), method.summary.to_owned())).collect()
}

fn contacts() -> Vec<NamedLine> {
    ContactLaw::ALL.iter().map(|law| (law.name().into(), law.summary().to_owned())).collect()
}

fn finishes() -> Vec<NamedLine> {
    Finish::ALL.iter().map(|finish| (finish.name().into(), finish.summary().to_owned())).collect()
}

/// Returns the example scenes, with their titles.
fn scenes() -> Vec<NamedLine> {
    Example::gallery().map(|example| (example.name.into(), example.title().to_owned())).collect()
}

fn materials() -> Vec<NamedLine> {
    MATERIALS.iter().map(|material| (material.name.into(), material.meaning.to_owned())).collect()
}

fn palettes() -> Vec<NamedLine> {
    Palette::NAMED.iter().map(|(name, _, meaning)| ((*name).into(), (*meaning).to_owned())).collect()
}

fn environments() -> Vec<NamedLine> {
    Preset::ALL.iter().map(|preset| (preset.name().into(), preset.meaning().to_owned())).collect()
}

/// Returns the functions and constants of formulas, with their descriptions.
fn functions() -> Vec<NamedLine> {
    let functions = FUNCTIONS.iter().map(|f| (f.name.into(), format!("`{}`: {}", f.usage(), f.meaning)));
    let constants = CONSTANTS.iter().map(|(name, _, meaning)| ((*name).into(), (*meaning).to_owned()));
    functions.chain(constants).collect()
}

/// Returns the quantities that labels and plots can show, with their units and meanings.
fn measures() -> Vec<NamedLine> {
    let list = Measure::listed();
    let width = list.iter().map(|line| line.unit.chars().count()).max().unwrap_or_default();
    let line = |ListedMeasure { name, unit, meaning }| (name.into(), format!("{unit:width$}  {meaning}"));
    list.into_iter().map(line).collect()
}

fn colors() -> Vec<NamedLine> {
    color_names().into_iter().map(|(name, what)| (name.into(), what)).collect()
}

/// Returns the alternatives of a table that must have exactly one of several keys, such as the shapes of a body. Each alternative has a
/// name and a line with its meaning and its own keys. `way` is the path of keys that leads to the table.
fn variants(way: &[&str]) -> Vec<NamedLine> {
    let Some(TableSpec { keys, rule: Rule::ExactlyOne(names), .. }) = table(way) else { return Vec::new() };
    let variants = keys.iter().copied().filter(|key| names.contains(&key.name));
    let entry = |key: &'static KeySpec| {
        let inner = key.kind.table().map_or_else(Vec::new, |table| table.keys().collect());
        let inner: Vec<_> = inner.iter().map(|key| format!("`{}`", key.name)).collect();
        let keys = if inner.is_empty() { String::new() } else { format!(" ({})", inner.join(", ")) };
        (key.name.into(), format!("{}{keys}", key.meaning))
    };
    variants.map(entry).collect()
}

/// Returns the grammar of the table that a path of keys leads to.
fn table(way: &[&str]) -> Option<&'static TableSpec> {
    way.iter().try_fold(&SCENE, |table, name| match &table.key(name)?.kind {
        Kind::Named(inner) => Some(*inner),
        kind => kind.table(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_category_has_entries_and_every_entry_a_line() {
        for Category { name, entries, .. } in CATEGORIES {
            let entries = entries();
            assert!(entries.len() > 1, "{name}");
            for (entry, what) in entries {
                assert!(!what.is_empty() && !what.contains('\n'), "{name}: {entry}");
            }
        }
    }

    #[test]
    fn of_a_table_with_variants_each_is_there_with_its_keys() {
        let shapes = variants(&["body", "shape"]);
        assert_eq!(shapes[0], ("sphere".into(), "A ball (`radius`)".to_owned()));
        let lights = variants(&["light"]);
        assert!(lights.iter().all(|(name, _)| *name != "color"));
        assert!(variants(&["body"]).is_empty() && variants(&["nothing"]).is_empty());
    }
}

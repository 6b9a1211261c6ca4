//! The grammar of scenes: describes every key.
//!
//! The one description of each key serves for validation, for reading, for documentation, and for suggestions for unknown keys. The
//! description is data: all tables of the language are reached from [`SCENE`].

pub(in crate::scene) mod bodies;
pub(in crate::scene) mod camera;
pub(in crate::scene) mod contact;
mod default;
pub(in crate::scene) mod emitters;
mod find;
pub(in crate::scene) mod forces;
pub(in crate::scene) mod joints;
mod key;
mod kind;
pub(in crate::scene) mod labels;
pub(in crate::scene) mod lights;
pub(in crate::scene) mod marks;
pub(in crate::scene) mod materials;
pub(in crate::scene) mod motion;
mod reference;
pub(in crate::scene) mod repeat;
pub(in crate::scene) mod scene;
mod schema;
pub(in crate::scene) mod shapes;
pub(in crate::scene) mod showing;

pub use default::DefaultValue;
pub use find::{FoundKey, all_keys, find_keys, key_at, keys_inside};
pub(in crate::scene) use key::{Any, Declared, Key, ReadAs};
pub(crate) use kind::quoted;
pub use kind::{Bound, Collection, Kind};
pub use reference::reference;
pub use repeat::MAX_COPIES;
pub use scene::scene::TABLE as SCENE;
pub use schema::schema;

/// The description of one key of a table.
#[derive(Debug)]
pub struct KeySpec {
    /// The name of the key.
    pub name: &'static str,
    /// The type of the key's value.
    pub kind: Kind,
    /// The unit of the key's value. Empty for a value without a unit.
    pub unit: &'static str,
    /// The default that applies if a scene leaves the key out.
    pub default: DefaultValue,
    /// The meaning of the key for the documentation, in one sentence without a full stop.
    pub meaning: &'static str,
    /// True if every table of this type must have the key.
    pub required: bool,
    /// Names of the same setting in other programs. A scene that uses one of them gets a suggestion.
    pub also: &'static [&'static str],
}

/// The description of a table and of its keys.
#[derive(Debug)]
pub struct TableSpec {
    /// The noun for the table in messages, such as "a body".
    pub noun: &'static str,
    /// The keys of the table, in the order of the documentation.
    pub keys: &'static [&'static KeySpec],
    /// The rule for keys that exclude each other.
    pub rule: Rule,
}

/// The rule for keys of a table that exclude each other.
#[derive(Debug)]
pub enum Rule {
    /// All combinations of keys are allowed.
    Any,
    /// A table may have at most one key of each listed group.
    AtMostOne(&'static [&'static [&'static str]]),
    /// A table must have exactly one of the listed keys, such as one shape.
    ExactlyOne(&'static [&'static str]),
}

impl TableSpec {
    /// Returns the keys of the table, in the order of the documentation.
    pub fn keys(&self) -> impl DoubleEndedIterator<Item = &'static KeySpec> + Clone + use<> {
        self.keys.iter().copied()
    }

    /// Returns the description of a key. `None` if the table has no key with this name.
    pub fn key(&self, name: &str) -> Option<&'static KeySpec> {
        self.keys().find(|key| key.name == name)
    }
}

impl KeySpec {
    /// Describes an optional key without unit or default.
    const fn new(name: &'static str, kind: Kind, meaning: &'static str) -> KeySpec {
        KeySpec { name, kind, unit: "", default: DefaultValue::Nothing, meaning, required: false, also: &[] }
    }

    const fn unit(mut self, unit: &'static str) -> KeySpec {
        self.unit = unit;
        self
    }

    /// Sets a description of the default in words.
    const fn default(self, words: &'static str) -> KeySpec {
        self.or(DefaultValue::Words(words))
    }

    const fn default_number(self, number: f64) -> KeySpec {
        self.or(DefaultValue::Number(number))
    }

    const fn default_fraction(self, dividend: f64, divisor: f64) -> KeySpec {
        self.or(DefaultValue::Fraction(dividend, divisor))
    }

    const fn default_numbers(self, numbers: &'static [f64]) -> KeySpec {
        self.or(DefaultValue::Numbers(numbers))
    }

    const fn default_flag(self, flag: bool) -> KeySpec {
        self.or(DefaultValue::Flag(flag))
    }

    const fn default_word(self, word: &'static str) -> KeySpec {
        self.or(DefaultValue::Word(word))
    }

    const fn or(mut self, default: DefaultValue) -> KeySpec {
        self.default = default;
        self
    }

    const fn required(mut self) -> KeySpec {
        self.required = true;
        self
    }

    const fn also(mut self, also: &'static [&'static str]) -> KeySpec {
        self.also = also;
        self
    }
}

/// Returns the unit of the first key, in any table, that has this name and a unit.
pub(crate) fn unit_of_key(name: &str) -> Option<&'static str> {
    fn within(table: &'static TableSpec, name: &str) -> Option<&'static str> {
        let inside = |kind: &'static Kind| match kind {
            Kind::Table(table) | Kind::Named(table) => within(table, name),
            Kind::Either(kinds) => kinds.iter().find_map(Kind::table).and_then(|table| within(table, name)),
            Kind::List { of, .. } => of.table().and_then(|table| within(table, name)),
            _ => None,
        };
        let own = table.key(name).map(|key| key.unit).filter(|unit| !unit.is_empty());
        own.or_else(|| table.keys().find_map(|key| inside(&key.kind)))
    }
    within(&SCENE, name)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Calls `see` for every table of the scene language that is reached from `table`.
    fn visit(table: &'static TableSpec, see: &mut impl FnMut(&'static TableSpec)) {
        fn inside(kind: &'static Kind, see: &mut impl FnMut(&'static TableSpec)) {
            match kind {
                Kind::Table(table) | Kind::Named(table) | Kind::Variables(table) => visit(table, see),
                Kind::Either(kinds) => kinds.iter().for_each(|kind| inside(kind, see)),
                Kind::List { of, .. } => inside(of, see),
                _ => {}
            }
        }
        see(table);
        table.keys().for_each(|key| inside(&key.kind, see));
    }

    #[test]
    fn every_key_is_described_and_says_what_holds_without_it() {
        visit(&SCENE, &mut |table| {
            for key in table.keys {
                assert!(!key.meaning.is_empty() && !key.meaning.ends_with('.'), "{}", key.name);
                let variant = matches!(&table.rule, Rule::ExactlyOne(names) if names.contains(&key.name));
                let table_like = matches!(key.kind, Kind::Table(_) | Kind::Named(_));
                assert!(
                    key.required || variant || table_like || !key.default.in_words().is_empty(),
                    "`{}` of {} has no default",
                    key.name,
                    table.noun
                );
            }
        });
    }

    /// A missing key is replaced by its default, so the default must be a valid value of the key's type.
    #[test]
    fn defaults_are_values_that_could_be_written() {
        fn fits(default: DefaultValue, kind: &Kind) -> bool {
            let admits = |bound: &Bound| default.number().is_some_and(|number| bound.admits(number));
            match (kind, default) {
                (_, DefaultValue::Nothing | DefaultValue::Words(_)) => true,
                (
                    Kind::Number(bound) | Kind::Timed(bound) | Kind::Varying(bound) | Kind::Sampled(bound),
                    _,
                ) => admits(bound),
                (Kind::Integer(low, high), _) => {
                    default.integer().is_some_and(|number| (*low..=*high).contains(&number))
                }
                (Kind::Boolean, _) => default.flag().is_some(),
                (Kind::Numbers(count, bound), DefaultValue::Numbers(numbers)) => {
                    numbers.len() == *count && numbers.iter().all(|number| bound.admits(*number))
                }
                (Kind::Direction(count), DefaultValue::Numbers(numbers)) => {
                    numbers.len() == *count
                        && (numbers.iter().map(|n| n * n).sum::<f64>() - 1.0).abs() < 1e-15
                }
                (Kind::List { min, max, .. }, DefaultValue::Numbers(numbers)) => {
                    (*min..=*max).contains(&numbers.len()) || numbers.is_empty()
                }
                (Kind::Text, DefaultValue::Word(_)) => true,
                (Kind::Choice(words), DefaultValue::Word(word)) => words().contains(&word),
                (Kind::Color, DefaultValue::Word(word)) => crate::scene::Color::parse(word).is_some(),
                (Kind::Either(kinds), _) => kinds.iter().any(|kind| fits(default, kind)),
                _ => false,
            }
        }
        visit(&SCENE, &mut |table| {
            for key in table.keys {
                assert!(fits(key.default, &key.kind), "`{}` of {}", key.name, table.noun);
            }
        });
    }

    #[test]
    fn rules_speak_of_keys_that_exist() {
        visit(&SCENE, &mut |table| {
            let names: Vec<&str> = match &table.rule {
                Rule::Any => vec![],
                Rule::AtMostOne(groups) => groups.concat(),
                Rule::ExactlyOne(names) => names.to_vec(),
            };
            for name in names {
                assert!(table.key(name).is_some(), "{} has no key `{name}`", table.noun);
            }
        });
    }

    #[test]
    fn no_key_is_what_people_write_instead_of_another() {
        visit(&SCENE, &mut |table| {
            for key in table.keys {
                for also in key.also {
                    assert!(table.key(also).is_none(), "`{also}` is a key of {}", table.noun);
                }
            }
        });
    }
}

//! Types of values.

use super::TableSpec;
use crate::scene::sdl::Where;
use crate::scene::source::Value;

/// The type of a value.
#[derive(Debug)]
pub enum Kind {
    /// A string for people to read.
    Text,
    /// `true` or `false`.
    Boolean,
    /// A number within a bound.
    Number(Bound),
    /// A whole number in a range, both ends included.
    Integer(i64, i64),
    /// A number within a bound, or a formula of the time.
    Timed(Bound),
    /// A number within a bound, or a formula with random numbers, drawn anew for each particle.
    Drawn(Bound),
    /// A list of a fixed number of numbers within a bound, or formulas of the time.
    TimedNumbers(usize, Bound),
    /// A number, or a formula of these quantities of a body.
    OfBody(&'static [&'static str]),
    /// A list of a fixed number of numbers, or formulas of these quantities of a body.
    ListOfBody(usize, &'static [&'static str]),
    /// A list of a fixed number of numbers, each within a bound.
    Numbers(usize, Bound),
    /// A list of a fixed number of formulas of a parameter, each a string or a number.
    Formulas(usize),
    /// Three or four numbers, not all zero. Only their direction counts.
    Direction(usize),
    /// A color: `[red, green, blue]` in sRGB from 0 to 1, `"#rrggbb"`, `"#rgb"`, or a name of CSS.
    Color,
    /// A color, or a list of colors.
    Colors,
    /// SDL, POV-Ray's own language, and its position in the script.
    Sdl(Where),
    /// A name that POV-Ray knows: letters, digits and underscores.
    Identifier,
    /// The name of an include file.
    Include,
    /// The path of a file beside the scene that its SDL reads.
    Asset,
    /// The path of a file beside the scene that jabuka reads.
    File,
    /// One of a list of words.
    Choice(fn() -> Vec<&'static str>),
    /// The name of something in the scene.
    Reference(Collection),
    /// A list of values of one kind, with a smallest and a largest length.
    List {
        /// The type of each value.
        of: &'static Kind,
        /// The smallest number of values.
        min: usize,
        /// The largest number of values.
        max: usize,
    },
    /// A table with the given keys.
    Table(&'static TableSpec),
    /// Tables of a given kind, each with a name: `[body.ball]`.
    Named(&'static TableSpec),
    /// A table with any of the given keys. None is required.
    Partial(&'static TableSpec),
    /// A table of named numbers.
    Variables,
    /// One of several kinds, distinguished by the value's TOML type.
    Either(&'static [Kind]),
}

/// Which numbers are allowed. All numbers are finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// Every finite number.
    Any,
    /// Greater than zero.
    Positive,
    /// Zero or greater.
    NonNegative,
    /// From the first to the second, both included.
    From(f64, f64),
}

/// The named things that keys can refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Collection {
    /// `[body.NAME]`
    Body,
    /// `[material.NAME]`
    Material,
    /// `[joint.NAME]`
    Joint,
    /// `[body.NAME]`, or `[emitter.NAME]` for its particles
    Target,
}

impl Bound {
    /// Whether the bound admits a finite number.
    pub fn admits(self, number: f64) -> bool {
        match self {
            Bound::Any => true,
            Bound::Positive => number > 0.0,
            Bound::NonNegative => number >= 0.0,
            Bound::From(low, high) => low <= number && number <= high,
        }
    }

    /// The bound as words to follow “a number”: ` greater than 0`.
    pub fn in_words(self) -> String {
        match self {
            Bound::Any => String::new(),
            Bound::Positive => " greater than 0".to_owned(),
            Bound::NonNegative => " of at least 0".to_owned(),
            Bound::From(low, high) => format!(" from {low} to {high}"),
        }
    }
}

impl Collection {
    /// The key of the things in a scene. It is also the noun for one of them.
    pub fn key(self) -> &'static str {
        match self {
            Collection::Body | Collection::Target => "body",
            Collection::Material => "material",
            Collection::Joint => "joint",
        }
    }

    /// The plural noun.
    pub fn plural(self) -> &'static str {
        match self {
            Collection::Body | Collection::Target => "bodies",
            Collection::Material => "materials",
            Collection::Joint => "joints",
        }
    }
}

impl Kind {
    /// The table that a value of this kind is or may be, except named tables.
    pub fn table(&self) -> Option<&'static TableSpec> {
        match self {
            Kind::Table(table) => Some(table),
            Kind::Either(kinds) => kinds.iter().find_map(Kind::table),
            _ => None,
        }
    }

    /// Whether a value of this kind can name one of these things.
    pub fn names(&self, collection: Collection) -> bool {
        match self {
            Kind::Reference(Collection::Target) => collection == Collection::Body,
            Kind::Reference(named) => *named == collection,
            Kind::Either(kinds) => kinds.iter().any(|kind| kind.names(collection)),
            _ => false,
        }
    }

    /// Whether a value has the TOML type of the kind, or is a formula for a number.
    pub fn takes(&self, value: &Value) -> bool {
        match self {
            Kind::Text
            | Kind::Sdl(_)
            | Kind::Identifier
            | Kind::Include
            | Kind::Asset
            | Kind::File
            | Kind::Choice(_)
            | Kind::Reference(_) => matches!(value, Value::String(_)),
            Kind::Boolean => matches!(value, Value::Boolean(_)),
            Kind::Number(_) => matches!(value, Value::Integer(_) | Value::Float(_) | Value::String(_)),
            Kind::Timed(_) => {
                matches!(value, Value::Integer(_) | Value::Float(_) | Value::String(_) | Value::Formula(_))
            }
            Kind::Drawn(_) => {
                matches!(value, Value::Integer(_) | Value::Float(_) | Value::String(_) | Value::Drawn(_))
            }
            Kind::OfBody(_) => {
                matches!(value, Value::Integer(_) | Value::Float(_) | Value::String(_) | Value::OfBody(_))
            }
            Kind::Integer(..) => matches!(value, Value::Integer(_) | Value::String(_)),
            Kind::Numbers(..)
            | Kind::ListOfBody(..)
            | Kind::TimedNumbers(..)
            | Kind::Formulas(_)
            | Kind::Direction(_)
            | Kind::List { .. } => {
                matches!(value, Value::Array(_))
            }
            Kind::Color | Kind::Colors => matches!(value, Value::Array(_) | Value::String(_)),
            Kind::Table(_) | Kind::Named(_) | Kind::Partial(_) | Kind::Variables => {
                matches!(value, Value::Table(_))
            }
            Kind::Either(kinds) => kinds.iter().any(|kind| kind.takes(value)),
        }
    }

    /// The expected value in words: `a number greater than 0`.
    pub fn in_words(&self) -> String {
        match self {
            Kind::Text => "a string".to_owned(),
            Kind::Boolean => "`true` or `false`".to_owned(),
            Kind::Number(bound) => format!("a number{}", bound.in_words()),
            Kind::Integer(low, high) => format!("a whole number from {low} to {high}"),
            Kind::Numbers(count, bound) => match bound {
                Bound::Any => format!("a list of {count} numbers"),
                bound => format!("a list of {count} numbers, each{}", bound.in_words()),
            },
            Kind::Timed(bound) => format!("a number{} or a formula of `t`", bound.in_words()),
            Kind::Drawn(bound) => format!("a number{} or a formula", bound.in_words()),
            Kind::OfBody(names) => format!("a number or a formula of {}", quoted(names)),
            Kind::ListOfBody(count, names) => {
                format!("a list of {count} numbers or formulas of {}", quoted(names))
            }
            Kind::TimedNumbers(count, _) => format!("a list of {count} numbers or formulas of `t`"),
            Kind::Formulas(count) => format!("a list of {count} formulas"),
            Kind::Direction(count) => format!("a list of {count} numbers that are not all 0"),
            Kind::Color => "a color ([red, green, blue] from 0 to 1, \"#rrggbb\" or a CSS name)".to_owned(),
            Kind::Colors => format!("{} or a list of colors", Kind::Color.in_words()),
            Kind::Sdl(_) => "a string of SDL, POV-Ray's scene description language".to_owned(),
            Kind::Identifier => {
                "a POV-Ray identifier (letters, digits and underscores, no digit first)".to_owned()
            }
            Kind::Include => "the name of an include file".to_owned(),
            Kind::Asset | Kind::File => "the path of a file beside the scene".to_owned(),
            Kind::Choice(words) => match words().as_slice() {
                [only] => format!("`{only}`"),
                words => format!("one of {}", quoted(words)),
            },
            Kind::Reference(Collection::Target) => "the name of a body or an emitter".to_owned(),
            Kind::Reference(collection) => format!("the name of a {}", collection.key()),
            Kind::List { of, min, max } if min == max => {
                format!("a list of {min} values, each {}", of.in_words())
            }
            Kind::List { of, min: 0, .. } => format!("a list of values, each {}", of.in_words()),
            Kind::List { of, min: 1, .. } => format!("a list of at least 1 value, each {}", of.in_words()),
            Kind::List { of, min, .. } => format!("a list of at least {min} values, each {}", of.in_words()),
            Kind::Table(table) => format!("a table with the keys of {}", table.noun),
            Kind::Named(table) => format!("tables with names, each {}", table.noun),
            Kind::Partial(table) => format!("a table with keys of {}", table.noun),
            Kind::Variables => "a table of numbers with names".to_owned(),
            Kind::Either(kinds) => kinds.iter().map(Kind::in_words).collect::<Vec<_>>().join(" or "),
        }
    }
}

/// Words in backquotes, with commas between them.
pub(crate) fn quoted(words: &[&str]) -> String {
    words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

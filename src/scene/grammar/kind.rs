//! The types of values that the keys of a scene can have.

use super::TableSpec;
use crate::scene::sdl::Where;
use crate::scene::source::Value;

/// The type of a key's value.
#[derive(Debug)]
pub enum Kind {
    /// A string without a meaning to the program, such as a title.
    Text,
    /// A Boolean value, `true` or `false`.
    Boolean,
    /// A number within a bound.
    Number(Bound),
    /// A whole number within a range that includes both bounds.
    Integer(i64, i64),
    /// A number within a bound, or a formula of the time `t`.
    Timed(Bound),
    /// A number within a bound, or a formula of the time `t` and of measures, such as `ball.x`.
    Varying(Bound),
    /// A number within a bound, or a formula with random numbers. Each particle evaluates the formula with its own random numbers.
    Sampled(Bound),
    /// A list of a fixed length. Each item is a number within a bound, or a formula of the time `t`.
    TimedNumbers(usize, Bound),
    /// A list of a fixed length. Each item is a number within a bound, or a formula of the time `t` and of measures.
    VaryingNumbers(usize, Bound),
    /// A number, or a formula of the listed quantities of a body, such as its velocity.
    OfBody(&'static [&'static str]),
    /// A list of a fixed length. Each item is a number, or a formula of the listed quantities of a body.
    ListOfBody(usize, &'static [&'static str]),
    /// A list of a fixed length whose items are numbers within a bound.
    Numbers(usize, Bound),
    /// A list of a fixed length. Each item is a number, or a formula of a parameter `u`.
    Formulas(usize),
    /// A vector of three numbers, or a quaternion of four, not all zero. Its length is ignored.
    Direction(usize),
    /// A color: `[red, green, blue]` in sRGB from 0 to 1, `"#rrggbb"`, `"#rgb"`, or a CSS name of a color.
    Color,
    /// A color, or a list of colors.
    Colors,
    /// A string of SDL, POV-Ray's scene description language, for a given position in the script.
    Sdl(Where),
    /// A POV-Ray identifier, made of letters, digits and underscores.
    Identifier,
    /// The name of a POV-Ray include file.
    Include,
    /// The path, relative to the scene's folder, of a file that POV-Ray reads.
    Asset,
    /// The path, relative to the scene's folder, of a file that jabuka reads.
    File,
    /// One of several words. The function returns all of them.
    Choice(fn() -> Vec<&'static str>),
    /// The name of a body, material or joint of the scene.
    Reference(Collection),
    /// A list of values of the same type.
    List {
        /// The type of each item.
        of: &'static Kind,
        /// The minimum length of the list.
        min: usize,
        /// The maximum length of the list.
        max: usize,
    },
    /// A table with the keys that the given grammar describes.
    Table(&'static TableSpec),
    /// A table of named tables, all with the same keys, such as `[body.ball]`.
    Named(&'static TableSpec),
    /// A table with some of the given keys, none of which is required.
    Partial(&'static TableSpec),
    /// The table `[variables]`: named numbers, or tables with the given keys, each a number and its slider.
    Variables(&'static TableSpec),
    /// A value of one of several types, which differ in their TOML types.
    Either(&'static [Kind]),
}

/// Any number.
pub(super) const ANY: Kind = Kind::Number(Bound::Any);
/// A positive number.
pub(super) const POSITIVE: Kind = Kind::Number(Bound::Positive);
/// A number that is not negative.
pub(super) const NON_NEGATIVE: Kind = Kind::Number(Bound::NonNegative);
/// A list of three numbers.
pub(super) const VECTOR: Kind = Kind::Numbers(3, Bound::Any);
/// A list of three numbers or formulas of the time and of measures.
pub(super) const VARYING_POINT: Kind = Kind::VaryingNumbers(3, Bound::Any);
/// A list of three numbers that are not all 0: a direction.
pub(super) const AXIS: Kind = Kind::Direction(3);

/// The range of numbers that a key accepts. All numbers must be finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// All finite numbers.
    Any,
    /// Numbers greater than zero.
    Positive,
    /// Zero and greater numbers.
    NonNegative,
    /// Numbers from the first bound to the second, including both.
    From(f64, f64),
}

/// What the value of a key can refer to by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Collection {
    /// A body, defined by `[body.NAME]`.
    Body,
    /// A material, defined by `[material.NAME]`.
    Material,
    /// A joint, defined by `[joint.NAME]`.
    Joint,
    /// A force, defined by `[force.NAME]`.
    Force,
    /// A body (`[body.NAME]`), or the particles of an emitter (`[emitter.NAME]`).
    Target,
}

impl Bound {
    /// Returns true if a finite number is within the bound.
    pub fn admits(self, number: f64) -> bool {
        match self {
            Bound::Any => true,
            Bound::Positive => number > 0.0,
            Bound::NonNegative => number >= 0.0,
            Bound::From(low, high) => low <= number && number <= high,
        }
    }

    /// Describes the bound in words that follow "a number", such as " greater than 0".
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
    /// Returns the key of a scene that defines the members of the collection, such as `body`. The key is also the singular noun in
    /// messages.
    pub fn key(self) -> &'static str {
        match self {
            Collection::Body | Collection::Target => "body",
            Collection::Material => "material",
            Collection::Joint => "joint",
            Collection::Force => "force",
        }
    }

    /// Returns the plural noun for the members of the collection, such as "bodies".
    pub fn plural(self) -> &'static str {
        match self {
            Collection::Body | Collection::Target => "bodies",
            Collection::Material => "materials",
            Collection::Joint => "joints",
            Collection::Force => "forces",
        }
    }
}

impl Kind {
    /// Returns the grammar of the table that a value of this type is or may be. `None` for other types, and for tables of named tables.
    pub fn table(&self) -> Option<&'static TableSpec> {
        match self {
            Kind::Table(table) => Some(table),
            Kind::Either(kinds) => kinds.iter().find_map(Kind::table),
            _ => None,
        }
    }

    /// Returns true if a value of this type can be the name of a member of `collection`.
    pub fn names(&self, collection: Collection) -> bool {
        match self {
            Kind::Reference(Collection::Target) => collection == Collection::Body,
            Kind::Reference(named) => *named == collection,
            Kind::Either(kinds) => kinds.iter().any(|kind| kind.names(collection)),
            _ => false,
        }
    }

    /// Returns true if a value has the TOML type of this kind. A string is accepted as a number, because it may be a formula.
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
            Kind::Timed(_) | Kind::Varying(_) => {
                matches!(value, Value::Integer(_) | Value::Float(_) | Value::String(_) | Value::Formula(_))
            }
            Kind::Sampled(_) => {
                matches!(value, Value::Integer(_) | Value::Float(_) | Value::String(_) | Value::Sampled(_))
            }
            Kind::OfBody(_) => {
                matches!(value, Value::Integer(_) | Value::Float(_) | Value::String(_) | Value::OfBody(_))
            }
            Kind::Integer(..) => matches!(value, Value::Integer(_) | Value::String(_)),
            Kind::Numbers(..)
            | Kind::ListOfBody(..)
            | Kind::TimedNumbers(..)
            | Kind::VaryingNumbers(..)
            | Kind::Formulas(_)
            | Kind::Direction(_)
            | Kind::List { .. } => {
                matches!(value, Value::Array(_))
            }
            Kind::Color | Kind::Colors => matches!(value, Value::Array(_) | Value::String(_)),
            Kind::Table(_) | Kind::Named(_) | Kind::Partial(_) | Kind::Variables(_) => {
                matches!(value, Value::Table(_))
            }
            Kind::Either(kinds) => kinds.iter().any(|kind| kind.takes(value)),
        }
    }

    /// Describes the expected value in words, such as "a number greater than 0".
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
            Kind::Varying(bound) => {
                format!("a number{} or a formula of `t` and of measures", bound.in_words())
            }
            Kind::Sampled(bound) => format!("a number{} or a formula", bound.in_words()),
            Kind::OfBody(names) => format!("a number or a formula of {}", quoted(names)),
            Kind::ListOfBody(count, names) => {
                format!("a list of {count} numbers or formulas of {}", quoted(names))
            }
            Kind::TimedNumbers(count, _) => format!("a list of {count} numbers or formulas of `t`"),
            Kind::VaryingNumbers(count, _) => {
                format!("a list of {count} numbers or formulas of `t` and of measures")
            }
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
            Kind::List { of, min: 1, max: usize::MAX } => {
                format!("a list of at least 1 value, each {}", of.in_words())
            }
            Kind::List { of, min, max } if *max < usize::MAX => {
                format!("a list of {min} to {max} values, each {}", of.in_words())
            }
            Kind::List { of, min, .. } => format!("a list of at least {min} values, each {}", of.in_words()),
            Kind::Table(table) => format!("a table with the keys of {}", table.noun),
            Kind::Named(table) => format!("tables with names, each {}", table.noun),
            Kind::Partial(table) => format!("a table with keys of {}", table.noun),
            Kind::Variables(_) => "a table of numbers with names".to_owned(),
            Kind::Either(kinds) => kinds.iter().map(Kind::in_words).collect::<Vec<_>>().join(" or "),
        }
    }
}

/// Joins words with commas, each in backquotes.
pub(crate) fn quoted(words: &[&str]) -> String {
    words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

//! The declaration of a table: its keys, each with the type that a reader gets.

use std::fmt;
use std::marker::PhantomData;

use super::{DefaultValue, KeySpec, Kind, TableSpec};

/// A key of a table, with the type `T` that [`View::get`](crate::scene::view::View::get) reads its value as.
///
/// `T` is a [`Value`](crate::scene::value::Value) if the key has a default value, and an `Option` of one if the key is required or has no
/// default value. It is [`Any`] if a single type cannot tell what the key takes, such as a table, or a number or a table.
#[derive(Debug)]
pub(in crate::scene) struct Key<T> {
    pub(in crate::scene) spec: KeySpec,
    read_as: PhantomData<fn() -> T>,
}

/// The type of keys that are read in a way of their own.
#[derive(Clone, Copy, Debug)]
pub(in crate::scene) struct Any;

/// A type of Rust that keys can be read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::scene) enum ReadAs {
    Any,
    Number,
    Integer,
    Boolean,
    Vector,
    Axis,
    Quaternion,
    Color,
    Colors,
    Text,
    Timed,
    TimedVector,
    Varying,
    VaryingPoint,
    Sampled,
    OfBody,
    ListOfBody,
    Integers,
    Numbers,
    Vectors,
    Pairs,
}

/// What a key can be declared to be read as.
pub(in crate::scene) trait Declared {
    /// The type of the value.
    const TYPE: ReadAs;
    /// Whether the key must have a default value.
    const NEEDS_DEFAULT: bool;
}

impl Declared for Any {
    const TYPE: ReadAs = ReadAs::Any;
    const NEEDS_DEFAULT: bool = false;
}

impl<T: Declared> Key<T> {
    /// Declares a key. Does not compile if the key's kind or default does not fit the type `T`.
    pub(super) const fn new(spec: KeySpec) -> Key<T> {
        assert!(spec.kind.reads_as(T::TYPE), "the type does not fit the kind of the key");
        assert!(
            !T::NEEDS_DEFAULT || spec.default.is_value(),
            "the key has no default value: use an `Option`"
        );
        Key { spec, read_as: PhantomData }
    }
}

impl<T> AsRef<KeySpec> for Key<T> {
    fn as_ref(&self) -> &KeySpec {
        &self.spec
    }
}

/// A key is shown by its name, as it stands in scenes and messages.
impl fmt::Display for KeySpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl AsRef<KeySpec> for KeySpec {
    fn as_ref(&self) -> &KeySpec {
        self
    }
}

impl Kind {
    /// Returns true if values of this kind are read as the given type.
    const fn reads_as(&self, wanted: ReadAs) -> bool {
        let own = match self {
            Kind::Number(_) => ReadAs::Number,
            Kind::Integer(..) => ReadAs::Integer,
            Kind::Boolean => ReadAs::Boolean,
            Kind::Numbers(3, _) => ReadAs::Vector,
            Kind::Direction(3) => ReadAs::Axis,
            Kind::Direction(4) => ReadAs::Quaternion,
            Kind::Color => ReadAs::Color,
            Kind::Colors => ReadAs::Colors,
            Kind::Text
            | Kind::Sdl(_)
            | Kind::Identifier
            | Kind::Include
            | Kind::Asset
            | Kind::File
            | Kind::Choice(_)
            | Kind::Reference(_) => ReadAs::Text,
            Kind::Timed(_) => ReadAs::Timed,
            Kind::TimedNumbers(3, _) => ReadAs::TimedVector,
            Kind::Varying(_) => ReadAs::Varying,
            Kind::VaryingNumbers(3, _) => ReadAs::VaryingPoint,
            Kind::Sampled(_) => ReadAs::Sampled,
            Kind::OfBody(_) => ReadAs::OfBody,
            Kind::ListOfBody(3, _) => ReadAs::ListOfBody,
            Kind::List { of: Kind::Integer(..), .. } => ReadAs::Integers,
            Kind::List { of: Kind::Number(_), .. } => ReadAs::Numbers,
            Kind::List { of: Kind::Numbers(3, _), .. } => ReadAs::Vectors,
            Kind::List { of: Kind::Numbers(2, _), .. } => ReadAs::Pairs,
            _ => ReadAs::Any,
        };
        wanted as u8 == ReadAs::Any as u8 || own as u8 == wanted as u8
    }

    /// Returns the kind that is read as the given type: this one, or one of several that a key takes.
    pub(in crate::scene) fn for_type(&self, wanted: ReadAs) -> Option<&Kind> {
        self.one_of(|kind| kind.reads_as(wanted))
    }

    /// Returns this kind, or the first of several that a key takes, if `is` accepts it.
    pub(in crate::scene) fn one_of(&self, is: impl Fn(&Kind) -> bool) -> Option<&Kind> {
        match self {
            Kind::Either(kinds) => kinds.iter().find(|kind| is(kind)),
            kind => is(kind).then_some(kind),
        }
    }

    /// Returns the grammar of the named tables that a value of this kind holds. `None` for other kinds.
    pub(in crate::scene) fn named(&self) -> Option<&'static TableSpec> {
        match self {
            Kind::Named(spec) => Some(spec),
            _ => None,
        }
    }
}

impl KeySpec {
    /// Returns true if another key of this name is read the same way, so that tables which share the key can be read by one function.
    pub(in crate::scene) fn reads_like(&self, other: &KeySpec) -> bool {
        std::mem::discriminant(&self.kind) == std::mem::discriminant(&other.kind)
            && self.default.value() == other.default.value()
    }
}

impl DefaultValue {
    /// Returns the default if it is a value, and not only words.
    fn value(self) -> Option<DefaultValue> {
        Some(self).filter(|default| default.is_value())
    }

    /// Returns true for a default that is a value, and not only words.
    const fn is_value(self) -> bool {
        !matches!(self, DefaultValue::Nothing | DefaultValue::Words(_))
    }
}

/// Declares a table of the language as a module: a [`Key`] for each key, and `TABLE` with all of them.
macro_rules! table {
    (
        $(#[$doc:meta])*
        $module:ident: $noun:literal, $rule:expr;
        $($(#[$about:meta])* $key:ident: $read_as:ty = $spec:expr,)*
    ) => {
        $(#[$doc])*
        pub(in crate::scene) mod $module {
            #![allow(unused_imports, reason = "a table needs some of the names only")]
            use glam::DVec3;

            use super::*;
            use crate::scene::grammar::key::{Any, Key};
            use crate::scene::value;

            $($(#[$about])* pub(in crate::scene) static $key: Key<$read_as> = Key::new($spec);)*

            /// The grammar of the table.
            #[allow(unreachable_pub, reason = "the grammar of the scene is public")]
            pub static TABLE: $crate::scene::grammar::TableSpec = $crate::scene::grammar::TableSpec {
                noun: $noun,
                rule: $rule,
                keys: &[$(&$key.spec),*],
            };

            #[cfg(test)]
            #[test]
            fn each_default_has_the_type_of_its_key() {
                let empty = $crate::scene::view::View::new(&TABLE, None);
                $(let _ = empty.get(&$key);)*
            }
        }
    };
}
pub(super) use table;

//! Reads the values of a table by their keys.

use std::sync::Arc;

use glam::DVec3;

use super::read;
use crate::diagnostic::Span;
use crate::scene::Color;
use crate::scene::drawn::Drawn;
use crate::scene::grammar::{Any, DefaultValue, Key, KeySpec, Kind, Rule, TableSpec};
use crate::scene::law::OfBody;
use crate::scene::source::{Entry, Node, Table, Value};
use crate::scene::timed::{Timed, TimedVector};
use crate::scene::value::{Text, Value as Read};

/// A table with its grammar, from which values are read by key. A missing or invalid value reads as its default, or as `None` if the key
/// has no default. The validation has already reported invalid values.
#[derive(Clone, Copy)]
pub(in crate::scene) struct View<'a> {
    spec: &'static TableSpec,
    table: Option<&'a Table>,
}

/// A named table, such as `[body.ball]`. The table of a copy made by `repeat` is rebuilt only when it is read.
#[derive(Clone, Copy)]
pub(super) struct NamedTable<'a> {
    spec: &'static TableSpec,
    entry: &'a Entry,
}

/// The name of a key.
pub(in crate::scene) trait KeyName {
    fn name(&self) -> &str;
}

impl<T> KeyName for Key<T> {
    fn name(&self) -> &str {
        self.spec.name
    }
}

impl KeyName for KeySpec {
    fn name(&self) -> &str {
        self.name
    }
}

impl KeyName for &str {
    fn name(&self) -> &str {
        self
    }
}

impl<T: KeyName> KeyName for &T {
    fn name(&self) -> &str {
        (*self).name()
    }
}

/// What [`View::get`] returns for a key of a type.
pub(in crate::scene) trait Get {
    type Read<'a>;

    fn get<'a>(view: &View<'a>, key: &KeySpec) -> Self::Read<'a>;
}

/// A key with a default value always has a value.
impl<T: Read> Get for T {
    type Read<'a> = T::Read<'a>;

    fn get<'a>(view: &View<'a>, key: &KeySpec) -> T::Read<'a> {
        view.value::<T>(key).expect("the declaration of a key without `Option` has a default value")
    }
}

/// A key without a default value may have none, or an invalid one.
impl<T: Read> Get for Option<T> {
    type Read<'a> = Option<T::Read<'a>>;

    fn get<'a>(view: &View<'a>, key: &KeySpec) -> Option<T::Read<'a>> {
        view.value::<T>(key)
    }
}

impl<'a> NamedTable<'a> {
    pub(super) fn name(self) -> &'a Arc<str> {
        &self.entry.name.text
    }

    /// Returns the source span of the table's name.
    pub(super) fn span(self) -> Span {
        self.entry.name.span
    }

    /// Rebuilds the table if it belongs to a copy, and calls `work` with a view of the table.
    pub(super) fn look<T>(self, work: impl FnOnce(&View<'_>) -> T) -> T {
        let table = self.entry.node.table();
        work(&View { spec: self.spec, table: table.as_deref() })
    }
}

impl<'a> View<'a> {
    pub(in crate::scene) fn new(spec: &'static TableSpec, table: Option<&'a Table>) -> View<'a> {
        View { spec, table }
    }

    /// Reads the value of a key as the type that its declaration names.
    pub(in crate::scene) fn get<T: Get>(&self, key: &Key<T>) -> T::Read<'a> {
        T::get(self, &key.spec)
    }

    /// Reads a value as one of several types that the key takes. `None` if the value has another type or is invalid.
    pub(in crate::scene) fn get_as<T: Read>(&self, key: &Key<Any>) -> Option<T::Read<'a>> {
        self.value::<T>(&key.spec)
    }

    /// Reads a value, or returns the default of the key. A key that takes several kinds of values has no default of this type if a value
    /// of another kind is given.
    fn value<T: Read>(&self, key: &KeySpec) -> Option<T::Read<'a>> {
        debug_assert!(
            self.spec.key(key.name).is_some_and(|own| own.reads_like(key)),
            "`{}` of {} is another key",
            key.name,
            self.spec.noun
        );
        let kind = key.kind.for_type(T::TYPE);
        debug_assert!(kind.is_some(), "`{}` of {} is {:?}", key.name, self.spec.noun, key.kind);
        let given = self.table.and_then(|table| table.get(key.name)).map(|entry| &entry.node);
        let value = given.and_then(|node| T::read(node, kind?));
        let is_of_other_kind = given.is_some() && matches!(key.kind, Kind::Either(_));
        value.or_else(|| T::default(key.default).filter(|_| !is_of_other_kind))
    }

    /// Returns the tree node of a key's value. `None` if the key is missing.
    pub(super) fn node(&self, key: impl KeyName) -> Option<&'a Node> {
        let name = key.name();
        debug_assert!(self.spec.key(name).is_some(), "{} has no key `{name}`", self.spec.noun);
        self.table?.get(name).map(|entry| &entry.node)
    }

    /// Returns the kind of value that a key takes, if `is` accepts the kind. If the key takes several kinds, returns the first that `is`
    /// accepts.
    fn kind_of(&self, name: &str, is: impl Fn(&Kind) -> bool) -> Option<&'static Kind> {
        let KeySpec { kind, .. } = self.spec.key(name)?;
        let found = match kind {
            Kind::Either(kinds) => kinds.iter().find(|kind| is(kind)),
            kind => is(kind).then_some(kind),
        };
        debug_assert!(found.is_some(), "`{name}` of {} is {kind:?}", self.spec.noun);
        found
    }

    /// Returns the source span of a key's value. `None` if the key is missing.
    pub(in crate::scene) fn span(&self, key: impl KeyName) -> Option<Span> {
        let name = key.name();
        self.node(name).map(|node| node.span)
    }

    /// Returns the source span of a key. `None` if the key is missing.
    pub(in crate::scene) fn key_span(&self, key: impl KeyName) -> Option<Span> {
        let name = key.name();
        self.table?.get(name).map(|entry| entry.name.span)
    }

    /// Returns whether the table has a key that its grammar does not contain.
    pub(super) fn has_unknown(&self) -> bool {
        let mut entries = self.table.iter().flat_map(|table| table.entries.iter());
        entries.any(|entry| self.spec.key(&entry.name.text).is_none())
    }

    /// Returns whether the table has the key, with a valid or an invalid value.
    pub(in crate::scene) fn has(&self, key: impl KeyName) -> bool {
        let name = key.name();
        self.node(name).is_some()
    }

    /// Reads a value, or returns the default of the key. Returns `None` if the key takes several kinds of values and the function `read`
    /// does not accept the kind of the value.
    fn read<T>(
        &self,
        name: &str,
        read: impl FnOnce(&'a Node) -> Option<T>,
        default: impl FnOnce(DefaultValue) -> Option<T>,
    ) -> Option<T> {
        let key = self.spec.key(name)?;
        match self.node(name) {
            Some(node) if matches!(key.kind, Kind::Either(_)) => read(node),
            Some(node) => read(node).or_else(|| default(key.default)),
            None => default(key.default),
        }
    }

    pub(in crate::scene) fn number(&self, name: &str) -> Option<f64> {
        let Kind::Number(bound) = self.kind_of(name, |kind| matches!(kind, Kind::Number(_)))? else {
            return None;
        };
        self.read(name, |node| read::number(node, *bound).ok(), DefaultValue::number)
    }

    pub(in crate::scene) fn integer(&self, name: &str) -> Option<i64> {
        let kind = self.kind_of(name, |kind| matches!(kind, Kind::Integer(..)))?;
        let Kind::Integer(low, high) = kind else { return None };
        self.read(name, |node| read::integer(node, *low, *high).ok(), DefaultValue::integer)
    }

    /// Reads a nonnegative integer.
    pub(in crate::scene) fn count(&self, name: &str) -> Option<u32> {
        self.integer(name).and_then(|count| u32::try_from(count).ok())
    }

    pub(in crate::scene) fn vector(&self, name: &str) -> Option<DVec3> {
        let kind = self.kind_of(name, |kind| matches!(kind, Kind::Numbers(3, _)))?;
        let Kind::Numbers(_, bound) = kind else { return None };
        let default = |default: DefaultValue| default.numbers().map(DVec3::from_array);
        self.read(name, |node| read::vector(node, *bound), default)
    }

    /// Reads a number or a formula of the time.
    pub(super) fn timed(&self, name: &str) -> Option<Timed> {
        let Kind::Timed(bound) = self.kind_of(name, |kind| matches!(kind, Kind::Timed(_)))? else {
            return None;
        };
        let default = |default: DefaultValue| default.number().map(Timed::Constant);
        self.read(name, |node| read::timed(node, *bound).ok(), default)
    }

    /// Reads a number, or a formula with random numbers that is sampled for each particle. `None` if the key is missing and has no
    /// default.
    pub(super) fn drawn(&self, name: &str) -> Option<Drawn> {
        let Kind::Drawn(bound) = self.kind_of(name, |kind| matches!(kind, Kind::Drawn(_)))? else {
            return None;
        };
        let default = |default: DefaultValue| default.number().map(Drawn::Constant);
        self.read(name, |node| read::drawn(node, *bound).ok(), default)
    }

    /// Reads a number, or a formula of a body's quantities.
    pub(super) fn of_body(&self, name: &str) -> Option<OfBody> {
        let kind = self.kind_of(name, |kind| matches!(kind, Kind::OfBody(_)))?;
        let Kind::OfBody(names) = kind else { return None };
        read::of_body(self.node(name)?, names).ok()
    }

    /// Reads a list of three items: numbers, or formulas of a body's quantities.
    pub(super) fn list_of_body(&self, name: &str) -> Option<[OfBody; 3]> {
        let kind = self.kind_of(name, |kind| matches!(kind, Kind::ListOfBody(3, _)))?;
        let Kind::ListOfBody(_, names) = kind else { return None };
        let node = self.node(name).filter(|node| matches!(node.value, Value::Array(_)))?;
        read::list_of_body(node, names).ok()
    }

    /// Reads a color or a list of colors. `None` if the key is missing or a color is invalid.
    pub(super) fn colors(&self, name: &str) -> Option<Vec<Color>> {
        read::colors(self.node(name)?).ok()
    }

    /// Reads a list of three items: numbers, or formulas of the time.
    pub(super) fn timed_vector(&self, name: &str) -> Option<TimedVector> {
        let kind = self.kind_of(name, |kind| matches!(kind, Kind::TimedNumbers(3, _)))?;
        let Kind::TimedNumbers(_, bound) = kind else { return None };
        let node = self.node(name).filter(|node| matches!(node.value, Value::Array(_)))?;
        read::timed_vector(node, *bound).ok()
    }

    /// Returns the tree node of a key's value, without checking the value. `None` if the key is missing.
    pub(super) fn raw(&self, key: impl KeyName) -> Option<&'a Node> {
        let name = key.name();
        self.node(name)
    }

    /// Reads a direction, and returns it as a unit vector.
    pub(in crate::scene) fn direction<const N: usize>(&self, name: &str) -> Option<[f64; N]> {
        self.kind_of(name, |kind| matches!(kind, Kind::Direction(n) if *n == N))?;
        self.read(name, |node| read::direction(node).ok(), DefaultValue::numbers)
    }

    pub(in crate::scene) fn boolean(&self, name: &str) -> Option<bool> {
        self.kind_of(name, |kind| matches!(kind, Kind::Boolean))?;
        let read = |node: &Node| match node.value {
            Value::Boolean(value) => Some(value),
            _ => None,
        };
        self.read(name, read, DefaultValue::flag)
    }

    pub(in crate::scene) fn color(&self, name: &str) -> Option<Color> {
        self.kind_of(name, |kind| matches!(kind, Kind::Color))?;
        self.read(name, |node| read::color(node).ok(), |default| default.word().and_then(Color::parse))
    }

    /// Reads a string.
    pub(in crate::scene) fn text(&self, name: &str) -> Option<&'a str> {
        self.read(name, |node| node.as_str(), DefaultValue::word)
    }

    /// Reads a word, and returns the item of `all` that has this name. An unknown word reads as the default of the key.
    pub(in crate::scene) fn choice<T: Copy, const N: usize>(
        &self,
        key: &Key<Text>,
        all: [T; N],
        word_of: impl Fn(T) -> &'static str,
    ) -> T {
        let named = |word: &str| all.into_iter().find(|one| word_of(*one) == word);
        // The default in the grammar is always one of the items, as a test checks.
        named(self.get(key)).or_else(|| named(key.spec.default.word()?)).unwrap_or(all[0])
    }

    /// Like [`View::text`], but returns a string that all copies of a body share in memory.
    pub(in crate::scene) fn shared_text(&self, name: &str) -> Option<Arc<str>> {
        match &self.node(name)?.value {
            Value::String(text) => Some(text.clone()),
            _ => None,
        }
    }

    /// Returns the table itself. `None` if the view is empty. The clone shares its memory with the original.
    pub(super) fn to_table(self) -> Option<Table> {
        self.table.cloned()
    }

    /// Returns whether this view shows the same table in memory as `other`. If so, all values are equal.
    pub(super) fn is_same(&self, other: Option<&Table>) -> bool {
        match (self.table, other) {
            (Some(one), Some(two)) => one.entries.is_same(&two.entries),
            (one, two) => one.is_none() && two.is_none(),
        }
    }

    /// Returns the items of a list. `None` if the key is missing or the list has a wrong length.
    pub(in crate::scene) fn list(&self, key: impl KeyName) -> Option<&'a [Node]> {
        let name = key.name();
        let kind = self.kind_of(name, |kind| matches!(kind, Kind::List { .. }))?;
        read::list(self.node(name)?, kind).ok()
    }

    /// Reads a list of integers. `None` if an integer is invalid.
    pub(in crate::scene) fn integers(&self, name: &str) -> Option<Vec<i64>> {
        let kind = self.kind_of(name, |kind| matches!(kind, Kind::List { of: Kind::Integer(..), .. }))?;
        let Kind::List { of: Kind::Integer(low, high), .. } = kind else { return None };
        let whole = |item| read::integer(item, *low, *high).ok();
        self.read(name, |_| self.list(name)?.iter().map(whole).collect(), DefaultValue::integers)
    }

    /// Reads a list of numbers. `None` if a number is invalid.
    pub(in crate::scene) fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let kind = self.kind_of(name, |kind| matches!(kind, Kind::List { of: Kind::Number(_), .. }))?;
        let Kind::List { of: Kind::Number(bound), .. } = kind else { return None };
        let items = read::list(self.node(name)?, kind).ok()?;
        items.iter().map(|item| read::number(item, *bound).ok()).collect()
    }

    /// Reads a list of vectors. `None` if a vector is invalid.
    pub(in crate::scene) fn vectors(&self, name: &str) -> Option<Vec<DVec3>> {
        let kind = self.kind_of(name, |kind| matches!(kind, Kind::List { of: Kind::Numbers(3, _), .. }))?;
        let Kind::List { of: Kind::Numbers(_, bound), .. } = kind else { return None };
        self.list(name)?.iter().map(|item| read::vector(item, *bound)).collect()
    }

    /// Returns a view of an inner table. The view is empty if the key is missing.
    pub(in crate::scene) fn table(&self, key: impl KeyName) -> View<'a> {
        let name = key.name();
        let spec = match self.kind_of(name, |kind| matches!(kind, Kind::Table(_))) {
            Some(Kind::Table(spec)) => *spec,
            _ => self.spec,
        };
        View { spec, table: self.node(name).and_then(Node::as_table) }
    }

    /// Returns a view of an inner table. `None` if the key is missing or its value is not a table.
    pub(in crate::scene) fn variant(&self, key: impl KeyName) -> Option<View<'a>> {
        let name = key.name();
        let view = self.table(name);
        view.table.is_some().then_some(view)
    }

    /// Returns the name and the view of the variant that the table has, of those of which it must have exactly one. `None` if it has none.
    pub(in crate::scene) fn chosen(&self) -> Option<(&'static str, View<'a>)> {
        let Rule::ExactlyOne(names) = &self.spec.rule else { return None };
        names.iter().find_map(|name| Some((*name, self.variant(name)?)))
    }

    /// Returns whether the grammar of the table contains a key.
    pub(in crate::scene) fn takes(&self, name: &str) -> bool {
        self.spec.key(name).is_some()
    }

    /// Returns a view of each table in a list of tables.
    pub(in crate::scene) fn tables(&self, key: impl KeyName) -> Vec<View<'a>> {
        let name = key.name();
        let Some(Kind::List { of: Kind::Table(spec), .. }) =
            self.kind_of(name, |kind| matches!(kind, Kind::List { of: Kind::Table(_), .. }))
        else {
            return Vec::new();
        };
        let items = self.list(name).unwrap_or_default();
        items.iter().map(|node| View { spec, table: node.as_table() }).collect()
    }

    /// Returns the name and the value of each variable of the scene that has a value.
    pub(super) fn variables(&self) -> impl Iterator<Item = (&'a str, f64)> {
        let table = self.node("variables").and_then(Node::as_table);
        let entries = table.map_or(&[][..], |table| &table.entries);
        entries.iter().filter_map(|entry| Some((&*entry.name.text, entry.node.as_number()?)))
    }

    /// Returns the tables of all bodies of the scene, including copies.
    pub(super) fn bodies(&self) -> impl ExactSizeIterator<Item = NamedTable<'a>> + use<'a> {
        let spec = match self.kind_of("body", |kind| matches!(kind, Kind::Named(_))) {
            Some(Kind::Named(spec)) => *spec,
            _ => self.spec,
        };
        let entries = self.node("body").and_then(Node::as_table).map_or(&[][..], |table| &table.entries);
        entries.iter().map(move |entry| NamedTable { spec, entry })
    }

    /// Returns the name, the source span of the name, and a view of each named table under a key. Use [`View::bodies`] for bodies instead.
    pub(in crate::scene) fn named(&self, key: impl KeyName) -> Vec<(&'a str, Span, View<'a>)> {
        let name = key.name();
        let Some(Kind::Named(spec)) = self.kind_of(name, |kind| matches!(kind, Kind::Named(_))) else {
            return Vec::new();
        };
        let entries = self.node(name).and_then(Node::as_table).map_or(&[][..], |table| &table.entries);
        let view = |node: &'a Node| View { spec, table: node.as_table() };
        entries.iter().map(|e| (&*e.name.text, e.name.span, view(&e.node))).collect()
    }
}

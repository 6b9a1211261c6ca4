//! Reads the values of a table by the keys that the grammar declares.

use std::sync::Arc;

use super::read;
use crate::diagnostic::Span;
use crate::scene::grammar::scene::{scene, variable};
use crate::scene::grammar::{Any, Key, KeySpec, Kind, Rule, TableSpec};
use crate::scene::source::{Entry, Node, Table};
use crate::scene::value::{Text, Value};

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

/// What [`View::get`] returns for a key of a type.
pub(in crate::scene) trait Get {
    type Read<'a>;

    fn get<'a>(view: &View<'a>, key: &KeySpec) -> Self::Read<'a>;
}

/// A key with a default value always has a value.
impl<T: Value> Get for T {
    type Read<'a> = T::Read<'a>;

    fn get<'a>(view: &View<'a>, key: &KeySpec) -> T::Read<'a> {
        // A test of each table reads the defaults of all its keys.
        view.value::<T>(key).unwrap_or_else(|| unreachable!("`{key}` has no default value of its type"))
    }
}

/// A key that is read in a way of its own has no value of a single type.
impl Get for Any {
    type Read<'a> = ();

    fn get<'a>(_: &View<'a>, _: &KeySpec) {}
}

/// A key without a default value may have none, or an invalid one.
impl<T: Value> Get for Option<T> {
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

    /// Returns a view of the table as it stands in the text. `None` for a copy made by `repeat` that is stored as its differences.
    pub(super) fn original(self) -> Option<View<'a>> {
        let table = self.entry.node.as_table()?;
        Some(View { spec: self.spec, table: Some(table) })
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
    pub(in crate::scene) fn get_as<T: Value>(&self, key: impl AsRef<KeySpec>) -> Option<T::Read<'a>> {
        self.value::<T>(key.as_ref())
    }

    /// Reads a value, or returns the default of the key. The default does not count if the key takes several kinds of values, and one of
    /// another kind is given.
    fn value<T: Value>(&self, key: &KeySpec) -> Option<T::Read<'a>> {
        let kind = key.kind.for_type(T::TYPE);
        debug_assert!(kind.is_some(), "`{key}` of {} has another type", self.spec.noun);
        let given = self.node(key);
        let value = given.and_then(|node| T::read(node, kind?));
        let is_of_other_kind = given.is_some() && matches!(key.kind, Kind::Either(_));
        value.or_else(|| T::default(key.default).filter(|_| !is_of_other_kind))
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

    /// Returns the tree node of a key's value, without checking the value. `None` if the key is missing.
    pub(in crate::scene) fn node(&self, key: impl AsRef<KeySpec>) -> Option<&'a Node> {
        self.entry(key.as_ref()).map(|entry| &entry.node)
    }

    /// Returns the source span of a key's value. `None` if the key is missing.
    pub(in crate::scene) fn span(&self, key: impl AsRef<KeySpec>) -> Option<Span> {
        self.node(key).map(|node| node.span)
    }

    /// Returns the source span of a key. `None` if the key is missing.
    pub(in crate::scene) fn key_span(&self, key: impl AsRef<KeySpec>) -> Option<Span> {
        self.entry(key.as_ref()).map(|entry| entry.name.span)
    }

    /// Returns whether the table has the key, with a valid or an invalid value.
    pub(in crate::scene) fn has(&self, key: impl AsRef<KeySpec>) -> bool {
        self.node(key).is_some()
    }

    /// Returns the key of the table with its value. `None` if the table has no such key: a joint of any kind can be asked for its motor.
    /// Tables that share a key may name each other's, if they read it alike.
    fn entry(&self, key: &KeySpec) -> Option<&'a Entry> {
        debug_assert!(
            self.spec.key(key.name).is_none_or(|own| own.reads_like(key)),
            "{} has another key `{key}`",
            self.spec.noun
        );
        self.table?.get(key.name)
    }

    /// Returns whether the table has a key that its grammar does not contain.
    pub(super) fn has_unknown(&self) -> bool {
        let mut entries = self.table.iter().flat_map(|table| table.entries.iter());
        entries.any(|entry| self.spec.key(&entry.name.text).is_none())
    }

    /// Returns whether the grammar of the table contains a key.
    pub(in crate::scene) fn takes(&self, key: impl AsRef<KeySpec>) -> bool {
        self.spec.key(key.as_ref().name).is_some()
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
    pub(in crate::scene) fn list(&self, key: impl AsRef<KeySpec>) -> Option<&'a [Node]> {
        let key = key.as_ref();
        read::list(self.node(key)?, key.kind.one_of(|kind| matches!(kind, Kind::List { .. }))?).ok()
    }

    /// Returns a view of an inner table. The view is empty if the key is missing.
    pub(in crate::scene) fn table(&self, key: impl AsRef<KeySpec>) -> View<'a> {
        let node = self.node(&key);
        let spec = self.spec.key(key.as_ref().name).and_then(|own| own.kind.table());
        debug_assert!(spec.is_some(), "`{}` of {} is no table", key.as_ref(), self.spec.noun);
        View { spec: spec.unwrap_or(self.spec), table: node.and_then(Node::as_table) }
    }

    /// Returns a view of an inner table. `None` if the key is missing or its value is not a table.
    pub(in crate::scene) fn variant(&self, key: impl AsRef<KeySpec>) -> Option<View<'a>> {
        let view = self.table(key);
        view.table.is_some().then_some(view)
    }

    /// Returns the name and the view of the variant that the table has, of those of which it must have exactly one. `None` if it has none.
    pub(in crate::scene) fn chosen(&self) -> Option<(&'static str, View<'a>)> {
        let Rule::ExactlyOne(names) = &self.spec.rule else { return None };
        names.iter().find_map(|name| Some((*name, self.variant(self.spec.key(name)?)?)))
    }

    /// Returns a view of each table in a list of tables.
    pub(in crate::scene) fn tables(&self, key: impl AsRef<KeySpec>) -> Vec<View<'a>> {
        let Kind::List { of: Kind::Table(spec), .. } = key.as_ref().kind else { return Vec::new() };
        let items = self.list(key).unwrap_or_default();
        items.iter().map(|node| View { spec, table: node.as_table() }).collect()
    }

    /// Returns the name and the value of each variable of the scene that has a value.
    pub(super) fn variables(&self) -> impl Iterator<Item = (&'a str, f64)> {
        let entries = self.entries(&scene::VARIABLES.spec).iter();
        entries.filter_map(|entry| Some((&*entry.name.text, value_of_variable(&entry.node).as_number()?)))
    }

    /// Returns the name and the table of each variable of the scene that has a slider.
    pub(super) fn variables_with_sliders(&self) -> impl Iterator<Item = (&'a str, View<'a>)> {
        let entries = self.entries(&scene::VARIABLES.spec).iter();
        entries.filter_map(|entry| {
            let table = entry.node.as_table()?;
            Some((&*entry.name.text, View { spec: &variable::TABLE, table: Some(table) }))
        })
    }

    /// Returns the tables of all bodies of the scene, including copies.
    pub(super) fn bodies(&self) -> impl ExactSizeIterator<Item = NamedTable<'a>> + use<'a> {
        let key = &scene::BODY.spec;
        let spec = key.kind.named().unwrap_or(self.spec);
        self.entries(key).iter().map(move |entry| NamedTable { spec, entry })
    }

    /// Returns the name, the source span of the name, and a view of each named table under a key. Use [`View::bodies`] for bodies instead.
    pub(in crate::scene) fn named(&self, key: impl AsRef<KeySpec>) -> Vec<(&'a str, Span, View<'a>)> {
        let Some(spec) = key.as_ref().kind.named() else { return Vec::new() };
        let view = |node: &'a Node| View { spec, table: node.as_table() };
        self.entries(key.as_ref()).iter().map(|e| (&*e.name.text, e.name.span, view(&e.node))).collect()
    }

    /// Returns the entries of an inner table. Empty if the key is missing.
    fn entries(&self, key: &KeySpec) -> &'a [Entry] {
        self.node(key).and_then(Node::as_table).map_or(&[][..], |table| &table.entries)
    }
}

/// Returns the node of the value of a variable: that of the number itself, or of `value` in the table of a variable with a slider.
pub(super) fn value_of_variable(variable: &Node) -> &Node {
    let table = variable.as_table();
    table.and_then(|table| table.get(variable::VALUE.spec.name)).map_or(variable, |entry| &entry.node)
}

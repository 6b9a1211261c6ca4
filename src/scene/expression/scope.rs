//! The names that a formula may use.

use std::cell::Cell;
use std::collections::HashMap;

use super::function::{CONSTANTS, Function};
use crate::diagnostic::nearest;

/// The meaning of a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Binding {
    /// A number that is known when the formula is resolved.
    Constant(f64),
    /// The number in this slot when the formula is evaluated.
    Slot(usize),
}

/// The names that a formula may use, besides the constants that every formula knows.
#[derive(Clone, Debug)]
pub struct Scope {
    names: HashMap<String, Binding>,
    slots: usize,
    /// Names that come before all others, with the slots behind those of `names`.
    fields: &'static [&'static str],
    is_random: bool,
    /// How many more names may be compared with unknown ones.
    comparisons: Cell<usize>,
}

impl Default for Scope {
    /// No names, and no `uniform` and `normal`.
    fn default() -> Scope {
        Scope {
            names: HashMap::new(),
            slots: 0,
            fields: &[],
            is_random: false,
            comparisons: Cell::new(200_000),
        }
    }
}

impl Scope {
    /// Lets formulas have random numbers: see [`Draw`](super::Draw).
    #[must_use]
    pub fn with_draws(mut self) -> Scope {
        self.is_random = true;
        self
    }

    /// Makes a name stand for a number that is known when the formula is resolved.
    pub fn constant(&mut self, name: impl Into<String>, value: f64) {
        self.names.insert(name.into(), Binding::Constant(value));
    }

    /// Makes a name stand for a number that is given at every evaluation, and says its place among those.
    pub fn slot(&mut self, name: impl Into<String>) -> usize {
        self.names.insert(name.into(), Binding::Slot(self.slots));
        self.slots += 1;
        self.slots - 1
    }

    /// Makes these names stand for numbers that are given at every evaluation, in this order behind those of all other slots.
    /// They take the place of those that were set before.
    pub(in crate::scene) fn set_fields(&mut self, fields: &'static [&'static str]) {
        self.fields = fields;
    }

    /// Forgets a name that was the last to get a slot.
    pub(in crate::scene) fn remove_slot(&mut self, name: &str) {
        if self.names.remove(name).is_some_and(|it| it == Binding::Slot(self.slots - 1)) {
            self.slots -= 1;
        }
    }

    /// How many numbers an evaluation needs for the names, before those for random draws.
    pub fn slots(&self) -> usize {
        self.slots + self.fields.len()
    }

    /// Whether a name can be given to something: letters, digits and `_`, no digit first, and no word of all formulas.
    ///
    /// # Errors
    /// Why it cannot.
    pub fn is_free(name: &str) -> Result<(), &'static str> {
        /// The name `t` means the same everywhere, also where it has no value.
        const WORDS: [&str; 4] = ["and", "or", "not", "t"];
        let mut bytes = name.bytes();
        let starts_well = bytes.next().is_some_and(|first| first.is_ascii_alphabetic() || first == b'_');
        if !starts_well || !bytes.all(|byte| byte.is_ascii_alphanumeric() || byte == b'_') {
            return Err("a name is made of the letters a to z, digits and `_`, with no digit first");
        }
        match name {
            name if Function::named(name).is_some() => Err("this is a function of all formulas"),
            name if super::function::constant(name).is_some() => Err("this is a constant of all formulas"),
            "t" => Err("in formulas, `t` is the time"),
            name if WORDS.contains(&name) => Err("this is a word of formulas"),
            _ => Ok(()),
        }
    }

    /// The number that a name stands for, if it stands for one that is known.
    pub fn value(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Binding::Constant(value) => Some(value),
            Binding::Slot(_) => None,
        }
    }

    pub(super) fn get(&self, name: &str) -> Option<Binding> {
        if let Some(field) = self.fields.iter().position(|field| *field == name) {
            return Some(Binding::Slot(self.slots + field));
        }
        self.names.get(name).copied().or_else(|| super::function::constant(name).map(Binding::Constant))
    }

    pub(super) fn is_random(&self) -> bool {
        self.is_random
    }

    /// A suggestion for an unknown name: the name that was meant, or all names.
    pub(super) fn suggest(&self, name: &str) -> String {
        if self.names.is_empty() && self.fields.is_empty() {
            return "the scene declares no variables".to_owned();
        }
        let Some(left) = self.comparisons.get().checked_sub(self.names.len()) else { return String::new() };
        self.comparisons.set(left);
        let fields = self.fields.iter().copied();
        let mut names: Vec<&str> = self.names.keys().map(String::as_str).chain(fields).collect();
        // Always in the same order.
        names.sort_unstable();
        let all = || names.iter().copied().chain(CONSTANTS.iter().map(|(name, ..)| *name));
        // A single letter is near to every other one.
        let near = if name.len() == 1 {
            all().find(|other| other.eq_ignore_ascii_case(name))
        } else {
            nearest(name, all())
        };
        match near {
            Some(near) => format!("did you mean `{near}`?"),
            None if names.len() == 1 => format!("there is only `{}`", names[0]),
            None if names.len() <= 12 => format!("there are `{}`", names.join("`, `")),
            None => format!("none of the {} variables is called so", names.len()),
        }
    }
}

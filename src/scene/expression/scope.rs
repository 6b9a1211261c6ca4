//! The names that a formula can use, with their values or inputs.

use std::cell::Cell;
use std::collections::HashMap;

use super::function::{CONSTANTS, Function};
use crate::diagnostic::nearest;

/// What a name in a formula stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Binding {
    /// A constant, whose value is known when the formula is resolved.
    Constant(f64),
    /// The index of an input, whose value is passed at each evaluation.
    Slot(usize),
}

/// The names that a formula can use, besides constants such as `pi` that every formula knows.
#[derive(Clone, Debug)]
pub struct Scope {
    names: HashMap<String, Binding>,
    slots: usize,
    /// Names that take precedence over `names`, such as the quantities of a body. Their slots come after the slots of `names`.
    fields: &'static [&'static str],
    is_random: bool,
    /// The remaining number of comparisons in the search for similar names. The limit bounds the time for a scene with many unknown names.
    comparisons: Cell<usize>,
}

impl Default for Scope {
    /// Returns a scope without names, in which formulas must not use `uniform` and `normal`.
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
    /// Allows the random numbers `uniform` and `normal` in formulas: see [`Draw`](super::Draw).
    #[must_use]
    pub fn with_draws(mut self) -> Scope {
        self.is_random = true;
        self
    }

    /// Defines a name as a constant, whose value is known when the formula is resolved.
    pub fn constant(&mut self, name: impl Into<String>, value: f64) {
        self.names.insert(name.into(), Binding::Constant(value));
    }

    /// Defines a name as an input, whose value is passed at each evaluation. Returns the index (slot) of the input.
    pub fn slot(&mut self, name: impl Into<String>) -> usize {
        self.names.insert(name.into(), Binding::Slot(self.slots));
        self.slots += 1;
        self.slots - 1
    }

    /// Replaces the field names, such as the quantities of a body. Their values are passed at each evaluation, in this order, after all
    /// other inputs.
    pub(in crate::scene) fn set_fields(&mut self, fields: &'static [&'static str]) {
        self.fields = fields;
    }

    /// Removes the name that was defined last by [`Scope::slot`], and frees its slot.
    pub(in crate::scene) fn remove_slot(&mut self, name: &str) {
        if self.names.remove(name).is_some_and(|it| it == Binding::Slot(self.slots - 1)) {
            self.slots -= 1;
        }
    }

    /// Returns the number of slots: the inputs that an evaluation needs before the random numbers.
    pub fn slots(&self) -> usize {
        self.slots + self.fields.len()
    }

    /// Checks that a scene may define a variable with this name: letters, digits and `_`, no digit first, and no word that formulas
    /// reserve.
    ///
    /// # Errors
    /// The reason why the scene may not define the name.
    pub fn is_free(name: &str) -> Result<(), &'static str> {
        /// The reserved words. `t` is the time; it is reserved even in formulas that do not depend on the time.
        const RESERVED_WORDS: [&str; 4] = ["and", "or", "not", "t"];
        let mut bytes = name.bytes();
        let starts_well = bytes.next().is_some_and(|first| first.is_ascii_alphabetic() || first == b'_');
        if !starts_well || !bytes.all(|byte| byte.is_ascii_alphanumeric() || byte == b'_') {
            return Err("a name is made of the letters a to z, digits and `_`, with no digit first");
        }
        match name {
            name if Function::named(name).is_some() => Err("this is a function of all formulas"),
            name if super::function::constant(name).is_some() => Err("this is a constant of all formulas"),
            "t" => Err("in formulas, `t` is the time"),
            name if RESERVED_WORDS.contains(&name) => Err("this is a word of formulas"),
            _ => Ok(()),
        }
    }

    /// Returns the value of a name that is a constant. `None` for inputs and unknown names.
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

    /// Returns whether formulas know the quantities of a body.
    pub(super) fn has_fields(&self) -> bool {
        !self.fields.is_empty()
    }

    pub(super) fn is_random(&self) -> bool {
        self.is_random
    }

    /// Returns the text of a suggestion for an unknown name: a similar name, or the list of all names.
    pub(super) fn suggest(&self, name: &str) -> String {
        /// The maximum number of names that a message lists. The quantities of a body and some variables of the scene are fewer.
        const MAX_LISTED_NAMES: usize = 24;
        if self.names.is_empty() && self.fields.is_empty() {
            return "the scene declares no variables".to_owned();
        }
        let Some(left) = self.comparisons.get().checked_sub(self.names.len()) else { return String::new() };
        self.comparisons.set(left);
        let fields = self.fields.iter().copied();
        let mut names: Vec<&str> = self.names.keys().map(String::as_str).chain(fields).collect();
        // Sorting makes the message independent of the order in the hash map.
        names.sort_unstable();
        names.dedup();
        let all = || names.iter().copied().chain(CONSTANTS.iter().map(|(name, ..)| *name));
        /// Each name that other programs and textbooks use for a quantity, with the name of the quantity here.
        const QUANTITY_SYNONYMS: [(&str, &str); 5] =
            [("m", "mass"), ("q", "charge"), ("v", "speed"), ("time", "t"), ("velocity", "speed")];
        let other = QUANTITY_SYNONYMS.iter().find(|(other, _)| *other == name).map(|(_, own)| *own);
        if let Some(own) = other.filter(|own| self.has_fields() && names.contains(own)) {
            return format!("did you mean `{own}`?");
        }
        if matches!(name, "theta" | "phi" | "angle") && names.contains(&"x") && names.contains(&"y") {
            return "the angle of a place about the z axis is `atan2(y, x)`, in radians".to_owned();
        }
        // A single letter differs from every other letter by one edit, so single letters are compared only by case.
        let near = if name.len() == 1 {
            all().find(|other| other.eq_ignore_ascii_case(name))
        } else {
            nearest(name, all())
        };
        match near {
            Some(near) => format!("did you mean `{near}`?"),
            None if names.len() == 1 => format!("there is only `{}`", names[0]),
            None if names.len() <= MAX_LISTED_NAMES => format!("there are `{}`", names.join("`, `")),
            None => format!("none of the {} names that formulas know here", names.len()),
        }
    }
}

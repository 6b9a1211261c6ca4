//! The copies of repeated bodies, forces and joints, and names such as `brick[*,0]` that mean several copies.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::Expander;
use super::repeat::{copy_name, indices};
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::grammar::Collection;
use crate::scene::source::{Node, Value};

/// The maximum total number of body names in all lists of the scene. A name for several bodies counts once for each of these bodies.
const MAX_NAMES: usize = 2_000_000;

/// The bodies, forces and joints that the scene repeats, by name.
#[derive(Default)]
pub(in crate::scene) struct Groups {
    bodies: HashMap<String, Group>,
    /// The names of repeated forces and joints. They are stored apart from bodies, because a body and a force may share a name.
    links: HashSet<String>,
    /// The number of copies of each repeated joint.
    joints: HashMap<String, [usize; 1]>,
}

/// The copies of one repeated body.
pub(super) struct Group {
    /// The number of copies along each direction of the pattern, one to three numbers.
    pub(super) counts: Vec<usize>,
    /// The names of the copies; the last index varies fastest.
    pub(super) names: Vec<Arc<str>>,
    /// True if the number of copies is known. If the scene gives an invalid number, every index is accepted, to avoid follow-up errors.
    pub(super) is_known: bool,
}

impl Groups {
    pub(super) fn add(&mut self, name: &str, group: Group) {
        self.bodies.insert(name.to_owned(), group);
    }

    pub(super) fn add_link(&mut self, name: &str) {
        self.links.insert(name.to_owned());
    }

    /// Returns the name of the repeated force or joint that the copy `name` belongs to. `None` if `name` is not the name of a copy.
    pub(in crate::scene) fn original_link<'a>(&self, name: &'a str) -> Option<&'a str> {
        let (original, _) = split(name)?;
        self.links.contains(original).then_some(original)
    }

    pub(super) fn add_joint(&mut self, name: &str, count: usize) {
        self.joints.insert(name.to_owned(), [count]);
    }

    /// Returns the number of copies of a body or joint along each direction. `None` if the body or joint is not repeated.
    pub(super) fn counts(&self, of: Collection, original: &str) -> Option<&[usize]> {
        match of {
            Collection::Body | Collection::Target => {
                self.bodies.get(original).map(|group| group.counts.as_slice())
            }
            Collection::Joint => self.joints.get(original).map(<[usize; 1]>::as_slice),
            Collection::Material | Collection::Force => None,
        }
    }

    /// Returns the name of the repeated body that a copy belongs to: `brick` for `brick[3,0]`. `None` if no repeated body has that name.
    pub(in crate::scene) fn original<'a>(&self, name: &'a str) -> Option<&'a str> {
        let (original, _) = split(name)?;
        self.bodies.contains_key(original).then_some(original)
    }

    /// Returns true if `name` belongs to a repeated body with an unknown number of copies, so that the named copy may exist.
    pub(in crate::scene) fn may_hold(&self, name: &str) -> bool {
        let original = split(name).map_or(name, |(original, _)| original);
        self.bodies.get(original).is_some_and(|group| !group.is_known)
    }

    /// Returns the names of the first and the last copy of a repeated body or joint. `name` is the name of the body or joint itself, or
    /// that of any copy.
    pub(in crate::scene) fn ends(&self, of: Collection, name: &str) -> Option<[String; 2]> {
        let original = split(name).map_or(name, |(original, _)| original);
        let counts = self.counts(of, original)?;
        let last: Vec<usize> = counts.iter().map(|count| count.saturating_sub(1)).collect();
        Some([copy_name(original, &vec![0; counts.len()]), copy_name(original, &last)])
    }

    /// Returns the names of the repeated bodies, in alphabetical order.
    pub(in crate::scene) fn originals(&self) -> impl Iterator<Item = &str> {
        let mut names: Vec<&str> = self.bodies.keys().map(String::as_str).collect();
        // The order of the hash map differs from run to run.
        names.sort_unstable();
        names.into_iter()
    }

    /// Returns true if a list item names several bodies, such as `brick` or `brick[*,0]`.
    pub(super) fn means_several(&self, item: &Node) -> bool {
        body_of(item).is_some_and(|name| self.several(name).is_some())
    }

    /// Returns the names of the copies that `name` means, such as `brick` or `brick[*,0]`. `None` if it means a single body.
    pub(in crate::scene) fn several<'a>(
        &'a self,
        name: &str,
    ) -> Option<Box<dyn Iterator<Item = &'a Arc<str>> + 'a>> {
        if let Some(Group { names, is_known: true, .. }) = self.bodies.get(name) {
            return Some(Box::new(names.iter()));
        }
        let (original, inside) = split(name)?;
        let Group { counts, names, is_known: true } = self.bodies.get(original)? else { return None };
        let wanted: Vec<Option<usize>> = inside
            .split(',')
            .map(|number| match number.trim() {
                "*" => Some(None),
                number => number.parse().ok().map(Some),
            })
            .collect::<Option<_>>()?;
        let in_range = wanted.iter().zip(counts).all(|(number, count)| number.is_none_or(|n| n < *count));
        if wanted.len() != counts.len() || !in_range || !wanted.contains(&None) {
            return None;
        }
        let is_wanted =
            move |index: &[usize; 3]| wanted.iter().zip(index).all(|(w, n)| w.is_none_or(|w| w == *n));
        let all = indices(counts).zip(names).filter(move |(index, _)| is_wanted(index));
        Some(Box::new(all.map(|(_, name)| name)))
    }
}

impl Expander<'_> {
    /// Replaces each list item that means several bodies (`brick`, `brick[*,0]`) by one item for each copy.
    pub(super) fn spread(&mut self, list: &mut Node) {
        let Value::Array(items) = &list.value else { return };
        if self.groups.bodies.is_empty() || !items.iter().any(|item| self.groups.means_several(item)) {
            return;
        }
        let mut all = Vec::new();
        for item in items {
            let names = body_of(item).and_then(|name| self.groups.several(name));
            let Some(mut names) = names else {
                all.push(item.clone());
                continue;
            };
            let room = MAX_NAMES.saturating_sub(self.names);
            let before = all.len();
            all.extend(names.by_ref().take(room).map(|name| of_body(item, name)));
            self.names += all.len() - before;
            if names.next().is_some() {
                let message = format!("the lists of this scene name copies more than {MAX_NAMES} times");
                let error = Diagnostic::error(Code::TooManyCopies, message);
                let help = "a force without `on` acts on all bodies that it can";
                self.diagnostics.push(error.at(item.span, "each of these copies counts").help(help));
                list.value = Value::Invalid;
                return;
            }
        }
        list.value = Value::Array(all.into());
    }
}

/// Returns the name of the body in a list item. The item is the name itself or a table with the key `body`.
pub(super) fn body_of(item: &Node) -> Option<&str> {
    match item.as_table() {
        Some(table) => table.get("body")?.node.as_str(),
        None => item.as_str(),
    }
}

/// Returns a copy of a list item in which the name of the body is replaced by `name`.
fn of_body(item: &Node, name: &Arc<str>) -> Node {
    let text = Value::String(name.clone());
    let mut item = item.clone();
    match &mut item.value {
        Value::Table(table) => {
            if let Some(entry) = table.get_mut("body") {
                entry.node.value = text;
            }
        }
        value => *value = text,
    }
    item
}

/// Splits the name of a copy into the name of the repeated body and the indices: `brick[3,0]` → `brick`, `3,0`.
pub(super) fn split(name: &str) -> Option<(&str, &str)> {
    name.strip_suffix(']')?.rsplit_once('[')
}

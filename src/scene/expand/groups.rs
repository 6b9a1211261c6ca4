//! The bodies that are copies of one: which there are, and how they are called together.

use std::collections::HashMap;

use super::repeat::{copy_name, indices};
use crate::scene::source::{Node, Value};

/// The bodies with a `repeat`, by their names.
#[derive(Default)]
pub(in crate::scene) struct Groups(HashMap<String, Group>);

/// The copies of one body.
pub(super) struct Group {
    /// How many there are in each direction.
    pub(super) counts: Vec<usize>,
    /// Whether that is known; where a count is wrong, any copy may have been meant.
    pub(super) is_known: bool,
}

impl Groups {
    pub(super) fn add(&mut self, name: &str, group: Group) {
        self.0.insert(name.to_owned(), group);
    }

    /// The name of the body that a copy is one of: `brick` for `brick[3,0]`.
    pub(in crate::scene) fn original<'a>(&self, name: &'a str) -> Option<&'a str> {
        let (original, _) = split(name)?;
        self.0.contains_key(original).then_some(original)
    }

    /// Whether the name may be that of a copy of which nothing is known.
    pub(in crate::scene) fn may_hold(&self, name: &str) -> bool {
        let original = split(name).map_or(name, |(original, _)| original);
        self.0.get(original).is_some_and(|group| !group.is_known)
    }

    /// The names of the first and the last copy of a body, or of the body that a name is of.
    pub(in crate::scene) fn ends(&self, name: &str) -> Option<[String; 2]> {
        let original = split(name).map_or(name, |(original, _)| original);
        let counts = &self.0.get(original)?.counts;
        let last: Vec<usize> = counts.iter().map(|count| count.saturating_sub(1)).collect();
        Some([copy_name(original, &vec![0; counts.len()]), copy_name(original, &last)])
    }

    /// Puts the names of all copies in the place of every name that means several: `brick`, `brick[*,0]`.
    pub(super) fn spread(&self, items: &mut Vec<Node>) {
        let means_several = |item: &Node| item.as_str().is_some_and(|name| self.several(name).is_some());
        if self.0.is_empty() || !items.iter().any(means_several) {
            return;
        }
        *items = std::mem::take(items)
            .into_iter()
            .flat_map(|item| match item.as_str().and_then(|name| self.several(name)) {
                Some(names) => {
                    let node = |name| Node { span: item.span, value: Value::String(name) };
                    names.into_iter().map(node).collect()
                }
                None => vec![item],
            })
            .collect();
    }

    /// The copies that a name means, if it means more than one body.
    fn several(&self, name: &str) -> Option<Vec<String>> {
        if let Some(Group { counts, is_known: true }) = self.0.get(name) {
            return Some(indices(counts).map(|index| copy_name(name, &index[..counts.len()])).collect());
        }
        let (original, inside) = split(name)?;
        let Group { counts, is_known: true } = self.0.get(original)? else { return None };
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
        let is_wanted = |index: &[usize; 3]| wanted.iter().zip(index).all(|(w, n)| w.is_none_or(|w| w == *n));
        let all = indices(counts).filter(is_wanted);
        Some(all.map(|index| copy_name(original, &index[..counts.len()])).collect())
    }
}

/// `brick[3,0]` → `brick`, `3,0`.
fn split(name: &str) -> Option<(&str, &str)> {
    name.strip_suffix(']')?.rsplit_once('[')
}

//! Scenes as trees of TOML, in which a test replaces one value at a time.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::{fmt, fs};

use super::super::{CacheKey, of};
use crate::diagnostic::Sources;
use crate::scene::grammar::{KeySpec, Kind, SCENE, TableSpec};
use crate::scene::source::{self, Entry, Node, Override, Table, Value};
use crate::scene::{Options, Scene};
use crate::simulate::Moments;

/// A scene file: its tree, and the digest of its run.
pub(super) struct Document {
    pub(super) path: PathBuf,
    pub(super) root: Table,
    pub(super) digest: CacheKey,
    /// The number of bodies of the scene.
    pub(super) bodies: usize,
}

/// A step of the path from the root of a tree to a value.
#[derive(Clone, PartialEq)]
pub(super) enum Step {
    Key(Arc<str>),
    Item(usize),
}

/// A key of a table of the grammar: the noun of the table, and the name of the key.
pub(super) type Id = (&'static str, &'static str);

/// A key in a scene file, with its value.
pub(super) struct KeyInFile<'a> {
    pub(super) document: &'a Document,
    pub(super) key: &'static KeySpec,
    pub(super) node: &'a Node,
    pub(super) way: Vec<Step>,
    /// The keys of all tables that contain the key, from the root on, then the key itself.
    pub(super) ids: Vec<Id>,
}

impl Document {
    pub(super) fn read(path: &Path) -> Document {
        let text = fs::read_to_string(path).unwrap();
        let mut diagnostics = Vec::new();
        let tree = source::parse(&text, Sources::default().add("", text.as_str()), &mut diagnostics);
        let Value::Table(root) = tree.value else { panic!("{}", path.display()) };
        let scene =
            Scene::from_path_with(path, &options(Vec::new())).unwrap_or_else(|report| panic!("{report:?}"));
        let digest = of(&scene, &Moments::of(&scene));
        Document { path: path.to_owned(), root, digest, bodies: scene.bodies.len() }
    }

    /// Returns all keys in the scene file that the grammar knows, with their values.
    pub(super) fn places(&self) -> Vec<KeyInFile<'_>> {
        let mut places = Vec::new();
        self.add_table(&SCENE, &self.root, &[], &[], &mut places);
        places
    }

    fn add_table<'a>(
        &'a self,
        spec: &'static TableSpec,
        table: &'a Table,
        way: &[Step],
        ids: &[Id],
        places: &mut Vec<KeyInFile<'a>>,
    ) {
        for Entry { name, node } in &table.entries {
            let Some(key) = spec.key(&name.text) else { continue };
            let way = [way, &[Step::Key(Arc::clone(&name.text))]].concat();
            let ids = [ids, &[(spec.noun, key.name)]].concat();
            places.push(KeyInFile { document: self, key, node, way: way.clone(), ids: ids.clone() });
            self.add_inside(&key.kind, node, &way, &ids, places);
        }
    }

    fn add_inside<'a>(
        &'a self,
        kind: &'static Kind,
        node: &'a Node,
        way: &[Step],
        ids: &[Id],
        places: &mut Vec<KeyInFile<'a>>,
    ) {
        match (kind, &node.value) {
            (Kind::Table(spec) | Kind::Partial(spec), Value::Table(table)) => {
                self.add_table(spec, table, way, ids, places);
            }
            (Kind::Named(spec) | Kind::Variables(spec), Value::Table(table)) => {
                for Entry { name, node } in &table.entries {
                    let way = [way, &[Step::Key(Arc::clone(&name.text))]].concat();
                    if let Some(table) = node.as_table() {
                        self.add_table(spec, table, &way, ids, places);
                    }
                }
            }
            (Kind::Either(kinds), _) => {
                kinds.iter().for_each(|kind| self.add_inside(kind, node, way, ids, places));
            }
            (Kind::List { of, .. }, Value::Array(items)) => {
                for (number, item) in items.iter().enumerate() {
                    self.add_inside(of, item, &[way, &[Step::Item(number)]].concat(), ids, places);
                }
            }
            _ => {}
        }
    }
}

/// Displays the key and its path in the file.
impl fmt::Display for KeyInFile<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (noun, name) = self.id();
        let way = self.way.iter().map(|step| match step {
            Step::Key(key) => key.to_string(),
            Step::Item(number) => number.to_string(),
        });
        let (way, file) = (way.collect::<Vec<_>>().join("."), self.document.path.display());
        write!(f, "the key `{name}` of {noun}, as `{way}` in {file},")
    }
}

impl KeyInFile<'_> {
    pub(super) fn id(&self) -> Id {
        *self.ids.last().unwrap()
    }

    /// Returns true if the value is a table, whose keys are tried instead.
    pub(super) fn is_table(&self) -> bool {
        self.node.as_table().is_some()
    }

    /// Returns the digest of the scene after the value is replaced by `value`, a text in TOML, or removed if `value` is `None`. `None` if the
    /// scene then has an error.
    pub(super) fn digest_with(&self, value: Option<&str>) -> Option<CacheKey> {
        let Some((Step::Key(first), rest)) = self.way.split_first() else { return None };
        let text = match (rest, value) {
            // An override cannot remove a key of the scene, so an empty table replaces its value.
            ([], None) => "{}".to_owned(),
            change => written(&self.document.root.get(first)?.node, Some(change)),
        };
        let set = Override::new(format!("{first}={text}"));
        let scene = Scene::from_path_with(&self.document.path, &options(vec![set])).ok()?;
        Some(of(&scene, &Moments::of(&scene)))
    }
}

fn options(overrides: Vec<Override>) -> Options {
    Options { overrides, trust: true, ..Options::default() }
}

/// Writes a value as TOML in one line. `change` is the path to a part of the value, and the text that replaces this part, or `None` to remove
/// it.
pub(super) fn written(node: &Node, change: Option<(&[Step], Option<&str>)>) -> String {
    if let Some(([], Some(text))) = change {
        return text.to_owned();
    }
    // Returns the change, relative to a part, if it concerns this part.
    let within = |part: &Step| match change {
        Some(([first, rest @ ..], text)) if first == part => Some((rest, text)),
        _ => None,
    };
    let kept = |change: &Option<(&[Step], Option<&str>)>| !matches!(change, Some(([], None)));
    match &node.value {
        // Every JSON string is a TOML string.
        Value::String(text) => serde_json::to_string(&**text).unwrap(),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) => format!("{number:?}"),
        Value::Boolean(flag) => flag.to_string(),
        Value::Array(items) => {
            let items = items.iter().enumerate().map(|(number, item)| (item, within(&Step::Item(number))));
            let items = items.filter(|(_, change)| kept(change));
            format!("[{}]", items.map(|(item, change)| written(item, change)).collect::<Vec<_>>().join(", "))
        }
        Value::Table(table) => {
            let entries = table.entries.iter().map(|entry| {
                let change = within(&Step::Key(Arc::clone(&entry.name.text)));
                (serde_json::to_string(&*entry.name.text).unwrap(), &entry.node, change)
            });
            let entries = entries.filter(|(.., change)| kept(change));
            let entries = entries.map(|(name, node, change)| format!("{name} = {}", written(node, change)));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        }
        value => panic!("{value:?}"),
    }
}

//! Tree → [`Scene`], or all that is wrong with it.

mod asset;
mod body;
mod braces;
mod camera;
mod consequence;
mod effect;
mod force;
mod label;
mod look;
mod material;
mod povray;
mod read;
mod sdl;
mod shape;
mod showing;
mod simulation;
mod suggest;
mod templates;
mod validate;
mod view;

use std::collections::HashMap;
use std::path::Path;

use sha2::{Digest, Sha256};

use self::view::View;
use super::expand;
use super::grammar::{Collection, SCENE};
use super::source::{self, Table};
use super::{Include, Options, PovRay, Scene};
use crate::diagnostic::{Diagnostic, Report, Severity, Sources};

/// What a scene is made from.
pub(super) struct Input<'a> {
    /// The name of the scene.
    pub(super) name: &'a str,
    /// How messages call its file.
    pub(super) shown: &'a str,
    /// The folder that its paths start from, if it has one.
    pub(super) folder: Option<&'a Path>,
    /// Its text.
    pub(super) text: &'a str,
}

/// What every part of the check works with.
struct Context<'a> {
    folder: Option<&'a Path>,
    trust: bool,
    sources: &'a Sources,
    names: Names,
    /// How many more names may be compared with unknown ones.
    comparisons: usize,
    diagnostics: Vec<Diagnostic>,
}

/// The names that others may refer to, each with its number in the order of the file.
struct Names {
    bodies: HashMap<String, usize>,
    materials: HashMap<String, usize>,
}

impl Names {
    fn of(root: &Table) -> Names {
        let collect = |collection: Collection| {
            let table = root.get(collection.key()).and_then(|entry| entry.node.as_table());
            let names = table.into_iter().flat_map(|table| &table.entries);
            names.enumerate().map(|(number, entry)| (entry.name.text.clone(), number)).collect()
        };
        Names { bodies: collect(Collection::Body), materials: collect(Collection::Material) }
    }

    fn get(&self, collection: Collection) -> &HashMap<String, usize> {
        match collection {
            Collection::Body => &self.bodies,
            Collection::Material => &self.materials,
        }
    }
}

/// Reads and checks a scene.
pub(super) fn check(input: &Input<'_>, options: &Options) -> Result<Scene, Report> {
    let mut sources = Sources::default();
    let mut diagnostics = Vec::new();
    // An editor does not show a byte order mark, and does not count it as a column.
    let text = input.text.strip_prefix('\u{feff}').unwrap_or(input.text);
    let id = sources.add(input.shown, text);
    let mut tree = source::parse(text, id, &mut diagnostics);
    let unreadable = diagnostics.len();
    let mut root = match &mut tree.value {
        source::Value::Table(table) => std::mem::take(table),
        _ => Table::default(),
    };
    for set in &options.overrides {
        set.apply(&mut root, &mut sources, &mut diagnostics);
    }

    let mut context = Context {
        folder: input.folder,
        trust: options.trust,
        sources: &sources,
        names: Names::of(&root),
        comparisons: suggest::MAX_COMPARISONS,
        diagnostics: Vec::new(),
    };
    expand::expand(&mut root, &sources, &mut context.diagnostics);
    validate::validate(&root, &mut context);
    let scene = build(input, options, &root, &mut context);
    let mut found = context.diagnostics;
    consequence::drop(&mut found, &diagnostics[..unreadable], &sources);
    diagnostics.append(&mut found);

    let mut report = Report { sources, diagnostics };
    report.sort();
    if report.diagnostics.iter().any(|d| d.severity == Severity::Error) {
        return Err(report);
    }
    Ok(Scene { warnings: report, ..scene })
}

/// Makes the scene. Where a value is missing or wrong, which has been said, any other takes its place.
fn build(input: &Input<'_>, options: &Options, root: &Table, context: &mut Context<'_>) -> Scene {
    let root = View::new(&SCENE, Some(root));
    let simulation = simulation::read(&root.table("simulation"), context);
    let mut materials = material::read(&root, context);
    let mut bodies = body::read(&root, &mut materials, context);
    for (number, body) in bodies.iter_mut().enumerate() {
        showing::count(&root, &mut body.showing, number, &simulation, context);
    }
    let forces = force::read(&root, &bodies, context);
    effect::check(&root, &bodies, &forces, context);
    if bodies.is_empty() {
        let message = "the scene has no bodies";
        let help = "a body is two lines: `[body.ball]` and `shape.sphere.radius = 1`";
        context.diagnostics.push(Diagnostic::warning("no-bodies", message).help(help));
    }
    let mut povray = povray::read(&root, context);
    povray.templates = templates::read(&root.table("povray"), options.templates.as_deref(), context);
    Scene {
        name: input.name.to_owned(),
        title: root.text("title").map(str::to_owned),
        camera: camera::read(&root, &simulation, context),
        views: camera::views(&root, &simulation, context),
        simulation,
        lights: look::lights(&root),
        environment: look::environment(&root, &bodies),
        labels: label::read(&root, &bodies, context),
        scale_bar: label::scale_bar(&root),
        grid: label::grid(&root),
        output: look::output(&root.table("output")),
        digest: digest(input, options, &povray),
        bodies,
        forces,
        materials,
        povray,
        warnings: Report::default(),
    }
}

/// A digest of all texts that the scene was read from.
fn digest(input: &Input<'_>, options: &Options, povray: &PovRay) -> String {
    let mut hash = Sha256::new();
    let mut add = |text: &str| {
        // The length keeps two texts from reading as one.
        hash.update((text.len() as u64).to_le_bytes());
        hash.update(text);
    };
    add(input.text);
    options.overrides.iter().for_each(|set| add(set.as_str()));
    for template in &povray.templates {
        add(&template.name);
        add(&template.text);
    }
    for include in &povray.include {
        match include {
            Include::Standard(name) => add(name),
            Include::Text { text, .. } => add(text),
        }
    }
    // What is in them is in no script.
    povray.assets.iter().for_each(|asset| add(&asset.name));
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

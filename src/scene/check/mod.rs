//! Checks the parsed tree of a scene and builds the [`Scene`], or reports all errors.

mod asset;
mod body;
mod braces;
mod camera;
mod color_map;
mod consequence;
mod contact;
mod corrections;
mod counts;
mod effect;
mod emitter;
mod end;
mod field;
mod fonts;
mod force;
mod geometry;
mod handles;
mod joint;
mod label;
mod look;
mod marks;
mod material;
mod measures;
mod mesh;
mod motion;
mod planets;
mod plot;
mod povray;
mod presence;
mod sdl;
mod shape;
mod showing;
mod simulation;
mod speed;
mod stepping;
mod suggest;
mod templates;
mod trajectory;
mod usable;
mod validate;
mod value_map;
mod variable_sliders;
mod varying;

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;

pub(super) use self::counts::MAX_FRAMES;

use super::expand::{self, Expansion, Groups};
use super::grammar::scene::scene;
use super::grammar::shapes::shape as shape_keys;
use super::grammar::{self, Collection, SCENE, bodies};
use super::sdl::FileKind;
use super::source::{self, Table};
use super::view::{NamedTable, View};
use super::{Aggregate, FileColumns, Include, Options, Places, PovRay, Scene, read, view};
use crate::diagnostic::{Code, Diagnostic, Report, Severity, Sources, Span};
use crate::physics::{Presence, Track};
use sha2::{Digest, Sha256};

/// The inputs of [`check`].
pub(super) struct Input<'a> {
    /// The name of the scene, which is the file name without its extension.
    pub(super) name: &'a str,
    /// The name under which diagnostics show the scene's file.
    pub(super) shown: &'a str,
    /// The path of the scene's file. `None` if the scene was not read from a file.
    pub(super) path: Option<&'a Path>,
    /// The folder that relative paths in the scene start from. `None` if the scene has no folder.
    pub(super) folder: Option<&'a Path>,
    /// The TOML text of the scene.
    pub(super) text: &'a str,
}

/// The state that all parts of the check share.
struct Context<'a> {
    folder: Option<&'a Path>,
    trust: bool,
    names: Names,
    /// The source spans of the scene's top-level tables, by table name.
    tables: HashMap<Arc<str>, Span>,
    /// Maps each copy made by `repeat` to its original body.
    groups: Groups,
    /// Whether a force has an error. If true, the check does not warn about missing forces.
    forces_are_wrong: bool,
    /// Whether a body has an error. If true, a body's location may be a placeholder.
    bodies_are_wrong: bool,
    /// The names of the forces in which an error was found.
    wrong_forces: HashSet<Arc<str>>,
    /// Whether the table being checked gives defaults, such as `[defaults.body]`. If true, required keys may be missing.
    is_partial: bool,
    /// The code and source span of each reported error. Copies of a body share one source text, and their common error is reported only
    /// once.
    reported: HashSet<(Code, Span)>,
    /// The number of copies with errors, by the name of the original body.
    wrong_copies: HashMap<String, usize>,
    /// The number of comparisons between unknown and known names that the check may still make.
    comparisons: usize,
    meshes: mesh::Meshes,
    /// The files that the scene's raw SDL may name.
    assets: sdl::Assets,
    /// The kind and the name of each file that is named in trusted raw SDL.
    reads: Vec<(FileKind, String)>,
    diagnostics: Vec<Diagnostic>,
    /// All source texts of the scene. Spans of diagnostics point into these texts.
    sources: Sources,
    /// The trajectory files that have been read. Each file is read only once.
    recordings: trajectory::Recordings,
    /// The tracks from trajectory files, each with the times at which its bodies are present. Bodies with the same rows share one track.
    tracks: HashMap<motion::Rows, (Arc<Track>, Presence)>,
    /// The addresses of the recordings whose duration has already been compared with the duration of the simulation.
    measured: HashSet<usize>,
    /// The `motion.trajectory` table of the body read before, and the recording from the file that this table names.
    last_recording: Option<(Option<Table>, Option<Arc<trajectory::Recording>>)>,
    /// The addresses of the trajectory rows that bodies already use.
    rows: HashSet<usize>,
    /// The total number of locations in all tracks.
    places: usize,
    /// The number of formula operations that the search for non-finite values may still take.
    operations: u64,
    /// The addresses of the copies' tables that have been validated, each with the value of `is_partial` at that time.
    validated: HashSet<(usize, bool)>,
    /// The SHA-256 digests of the other files that the scene reads.
    files: Vec<[u8; 32]>,
    /// The fonts of labels.
    fonts: fonts::Fonts,
    /// The pairs of bodies whose impacts are counted, as indices of bodies.
    pairs: Vec<[usize; 2]>,
    /// The further columns of trajectory files that formulas can name.
    file_columns: FileColumns,
    /// The pairs of bodies whose smallest distances formulas use, as indices of bodies.
    approaches: Vec<[usize; 2]>,
    /// The sums, means and extremes over several bodies in the formulas of measures.
    aggregates: Vec<Aggregate>,
    /// The color maps of materials as they are written, each once.
    color_maps: Vec<color_map::Written>,
    /// The maps of the numbers of looks as they are written, each once.
    value_maps: Vec<value_map::Written>,
    /// The conditions under which bodies are drawn, each once, with their places.
    conditions: Vec<(String, Span)>,
}

impl Context<'_> {
    /// Returns an empty context for the check of a scene with these texts.
    fn new(sources: Sources) -> Context<'static> {
        Context {
            folder: None,
            trust: false,
            names: Names::default(),
            tables: HashMap::new(),
            groups: Groups::default(),
            forces_are_wrong: false,
            bodies_are_wrong: false,
            wrong_forces: HashSet::new(),
            is_partial: false,
            reported: HashSet::new(),
            wrong_copies: HashMap::new(),
            comparisons: 0,
            meshes: mesh::Meshes::default(),
            assets: sdl::Assets::default(),
            reads: Vec::new(),
            diagnostics: Vec::new(),
            sources,
            recordings: trajectory::Recordings::new(),
            tracks: HashMap::new(),
            measured: HashSet::new(),
            last_recording: None,
            rows: HashSet::new(),
            places: 0,
            operations: motion::MAX_OPERATIONS,
            validated: HashSet::new(),
            files: Vec::new(),
            fonts: fonts::Fonts::default(),
            pairs: Vec::new(),
            file_columns: FileColumns::default(),
            approaches: Vec::new(),
            aggregates: Vec::new(),
            color_maps: Vec::new(),
            value_maps: Vec::new(),
            conditions: Vec::new(),
        }
    }

    /// Adds the SHA-256 digest of a file's contents to the digests of the files that the scene reads.
    fn add_file(&mut self, bytes: &[u8]) {
        self.files.push(Sha256::digest(bytes).into());
    }

    /// Returns whether the diagnostics from index `before` on contain an error.
    fn has_errors(&self, before: usize) -> bool {
        self.diagnostics[before..].iter().any(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// Returns whether the body `name` is one of many copies and a large number of these copies have errors. The check then skips the
    /// remaining copies.
    fn has_too_many_wrong_copies(&self, name: &str) -> bool {
        /// The number of copies with errors after which the remaining copies are skipped. Each copy may have different errors.
        const MAX_WRONG_COPIES: usize = 1000;
        let wrong =
            |original| self.wrong_copies.get(original).is_some_and(|wrong| *wrong >= MAX_WRONG_COPIES);
        !self.wrong_copies.is_empty() && self.groups.original(name).is_some_and(wrong)
    }

    /// Deduplicates the diagnostics from index `before` on, since all copies of a body have the same mistakes. Drops each diagnostic with a
    /// code and span that have been reported before. `name` and `span` belong to the copy being checked.
    fn once(&mut self, before: usize, name: &str, span: Span) {
        if self.diagnostics.len() == before {
            return;
        }
        let mut said = self.diagnostics.split_off(before);
        if said.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
            && let Some(original) = self.groups.original(name)
        {
            *self.wrong_copies.entry(original.to_owned()).or_default() += 1;
        }
        said.retain(|diagnostic| {
            diagnostic.span().is_none_or(|span| !self.reported.contains(&(diagnostic.code, span)))
        });
        if said.is_empty() {
            return;
        }
        let is_later = self.groups.original(name).is_some()
            && self.groups.ends(Collection::Body, name).is_some_and(|[first, _]| first != name);
        self.reported
            .extend(said.iter().filter_map(|diagnostic| Some((diagnostic.code, diagnostic.span()?))));
        self.diagnostics.extend(said.into_iter().map(|diagnostic| match is_later {
            true => diagnostic.at(span, format!("in `{name}`")),
            false => diagnostic,
        }));
    }
}

/// The names that other tables may refer to. Maps each name to its index in the order of the file.
#[derive(Default)]
struct Names {
    bodies: HashMap<Arc<str>, usize>,
    materials: HashMap<Arc<str>, usize>,
    joints: HashMap<Arc<str>, usize>,
    forces: HashMap<Arc<str>, usize>,
    emitters: HashSet<Arc<str>>,
}

impl Names {
    fn of(root: &Table) -> Names {
        let collect = |collection: Collection| {
            let table = root.get(collection.key()).and_then(|entry| entry.node.as_table());
            let names = table.into_iter().flat_map(|table| &table.entries);
            names.enumerate().map(|(number, entry)| (entry.name.text.clone(), number)).collect()
        };
        let [bodies, materials, joints, forces] =
            [Collection::Body, Collection::Material, Collection::Joint, Collection::Force].map(collect);
        let table = root.get("emitter").and_then(|entry| entry.node.as_table());
        let emitters = table.into_iter().flat_map(|table| &table.entries);
        let emitters = emitters.map(|entry| entry.name.text.clone()).collect();
        Names { bodies, materials, joints, forces, emitters }
    }

    fn get(&self, collection: Collection) -> &HashMap<Arc<str>, usize> {
        match collection {
            Collection::Body | Collection::Target => &self.bodies,
            Collection::Material => &self.materials,
            Collection::Joint => &self.joints,
            Collection::Force => &self.forces,
        }
    }
}

/// Parses and checks a scene. Returns the [`Scene`] with its warnings.
///
/// # Errors
///
/// Returns all diagnostics if at least one of them is an error.
pub(super) fn check(input: &Input<'_>, options: &Options) -> Result<Scene, Report> {
    let mut sources = Sources::default();
    let mut diagnostics = Vec::new();
    // Drop a byte order mark: editors hide it and do not count it as a column.
    let text = input.text.strip_prefix('\u{feff}').unwrap_or(input.text);
    let id = sources.add(input.shown, text);
    input.path.iter().for_each(|path| sources.note_file(*path));
    let mut tree = source::parse(text, id, &mut diagnostics);
    let mut root = match &mut tree.value {
        source::Value::Table(table) => std::mem::take(table),
        _ => Table::default(),
    };
    for set in &options.overrides {
        set.apply(&mut root, &mut sources, &mut diagnostics);
    }

    let included = expand::include(&mut root, input.path, options.trust, &mut sources, &mut diagnostics);
    let unreadable = diagnostics.len();

    let mut found = Vec::new();
    let mut geometer = geometry::BodyReader::new(input.folder, options.trust, sources.clone());
    let Expansion { groups, of_defaults } = expand::expand(&mut root, &mut geometer, &sources, &mut found);
    let mut context = Context {
        folder: input.folder,
        trust: options.trust,
        names: Names::of(&root),
        tables: root.entries.iter().map(|entry| (entry.name.text.clone(), entry.name.span)).collect(),
        groups,
        comparisons: suggest::MAX_COMPARISONS,
        assets: sdl::Assets::of(&root, input.folder, options.trust),
        diagnostics: found,
        ..Context::new(sources)
    };
    context.bodies_are_wrong = context.has_errors(0);
    validate::validate(&root, &mut context);
    let scene = build(input, options, &root, &included, &mut context);
    let (mut found, sources) = (context.diagnostics, context.sources);
    // Drop the warning `NoEffect` for a default value: the default may have an effect on other bodies or forces.
    let of_default =
        |diagnostic: &Diagnostic| diagnostic.span().is_some_and(|span| of_defaults.contains(&span));
    found.retain(|diagnostic| diagnostic.code != Code::NoEffect || !of_default(diagnostic));
    consequence::drop(&mut found, &diagnostics[..unreadable], &sources);
    diagnostics.append(&mut found);

    let mut report = Report { sources, diagnostics };
    report.sort();
    usable::drop_other(&mut report);
    if report.diagnostics.iter().any(|d| d.severity == Severity::Error) {
        return Err(report);
    }
    Ok(Scene { warnings: report, ..scene })
}

/// Builds the scene from the validated tree. Uses a placeholder for each value that is missing or wrong, since these errors have already
/// been reported.
fn build(
    input: &Input<'_>,
    options: &Options,
    root: &Table,
    included: &[String],
    context: &mut Context<'_>,
) -> Scene {
    let root = View::new(&SCENE, Some(root));
    let speed = speed::read(&root, context);
    let (simulation, counts) = simulation::read(&root, needs_steps(&root), speed);
    simulation::check(&root.table(&scene::SIMULATION), &simulation, context);
    speed::check_emitters(&root, &simulation, context);
    let mut materials = material::read(&root, context);
    let bodies = body::read(&root, &simulation, &mut materials, context);
    let (simulation, counts) = stepping::choose_step(&root, simulation, counts, &bodies);
    let before = context.diagnostics.len();
    let emitters = emitter::read(&root, &simulation, &bodies, context);
    let forces = force::read(&root, &bodies, &emitters, &simulation, context);
    context.forces_are_wrong |= context.has_errors(before);
    counts::check(&root, &counts, &bodies, &forces, context);
    // If a force has an error, skip these checks: that force may be the one that uses a mass or a charge.
    if !context.forces_are_wrong {
        planets::check(&root, &simulation, &bodies, &forces, context);
        effect::check(&root, &bodies, &forces, context);
    }
    let mut environment = look::environment(&root, &simulation, &bodies);
    contact::ground(&root, &simulation, &mut environment);
    contact::check(&root, &simulation, &bodies, &environment, context);
    let joints = joint::read(&root, &bodies, &simulation, context);
    stepping::check_joints(&root, &simulation, &bodies, &joints, context);
    let mut bodies = bodies;
    joint::swing(&joints, &mut bodies);
    let spans: HashMap<&str, Span> =
        root.named(&scene::JOINT).into_iter().map(|(name, span, _)| (name, span)).collect();
    let places_of_joints =
        joints.iter().filter_map(|joint| spans.get(joint.name.as_str()).copied()).collect();
    if bodies.is_empty() && emitters.is_empty() {
        let message = "the scene has no bodies";
        let help = "a body is two lines: `[body.ball]` and `shape.sphere.radius = 1`";
        context.diagnostics.push(Diagnostic::warning(Code::NoBodies, message).help(help));
    }
    let things = measures::Things { bodies: &bodies, forces: &forces, joints: &joints, emitters: &emitters };
    let known = marks::Known { root: &root, things, simulation: &simulation };
    let mut povray = povray::read(known, context);
    povray.templates = templates::read(&root.table(&scene::POVRAY), options.templates.as_deref(), context);
    let labels = label::read(&root, things, &simulation.timeline, context);
    let (plots, places_of_plots) = plot::read(&root, things, context);
    let measures = measures::read(&root, &options.measures, things, context);
    let color_maps = color_map::read(&root, things, &materials, context);
    let value_maps = value_map::read(&root, things, context);
    let conditions = value_map::conditions(&root, things, context);
    let camera = camera::read(known, context);
    let views = camera::views(known, &camera, context);
    let output = look::output(&root.table(&scene::OUTPUT), &camera);
    camera::check_size(&root, output, context);
    context.diagnostics.extend(context.meshes.too_large_to_repeat(&simulation, &camera, output));
    let angles = marks::angles(known, context);
    let distances = marks::distances(known, context);
    let areas = marks::areas(known, context);
    let fields = field::read(&root, &forces, context);
    let arrow_marks = marks::arrow_marks(known, context);
    let sliders = variable_sliders::read(&root, context);
    let (scale_bar, grid) = (label::scale_bar(&root), label::grid(&root));
    let has_labels = !labels.is_empty()
        || !plots.is_empty()
        || color_maps.iter().any(|map| map.bar.is_some())
        || scale_bar.is_some()
        || grid.is_some();
    let has_marks = !angles.is_empty() || !distances.is_empty() || !arrow_marks.is_empty();
    if has_labels || has_marks {
        std::mem::take(&mut context.fonts).add_to(&mut povray.assets, context);
    }
    Scene {
        name: input.name.to_owned(),
        title: root.get(&scene::TITLE).map(str::to_owned),
        camera,
        views,
        lights: look::lights(known, context),
        pairs: std::mem::take(&mut context.pairs),
        file_columns: std::mem::take(&mut context.file_columns),
        approaches: std::mem::take(&mut context.approaches),
        aggregates: std::mem::take(&mut context.aggregates),
        simulation,
        environment,
        labels,
        plots,
        angles,
        distances,
        areas,
        fields,
        measures,
        arrow_marks,
        scale_bar,
        grid,
        variable_sliders: sliders,
        handles: handles::read(&root, &bodies, &context.sources),
        color_maps,
        value_maps,
        conditions,
        output,
        digest: digest(input, options, included, &povray, context),
        bodies,
        forces,
        joints,
        emitters,
        materials,
        povray,
        places: Places {
            joints: places_of_joints,
            forces: root
                .named(&scene::FORCE)
                .iter()
                .map(|(name, span, _)| ((*name).to_owned(), *span))
                .collect(),
            bodies: root.bodies().map(NamedTable::span).collect(),
            contacts: root.table(&scene::SIMULATION).span(&grammar::scene::simulation::CONTACTS),
            camera: root.key_span(&scene::CAMERA),
            plots: places_of_plots,
            unit: root.table(&scene::POVRAY).span(&grammar::scene::povray::UNIT),
        },
        overrides: options.overrides.iter().map(|set| set.as_str().to_owned()).collect(),
        warnings: Report::default(),
    }
}

/// Returns whether the scene needs timesteps: true if a body moves freely or there is an emitter.
fn needs_steps(root: &View<'_>) -> bool {
    let is_free = |body: &View<'_>| {
        let shape = body.table(&bodies::body::SHAPE);
        let is_scenery = shape.has(&shape_keys::PLANE) || shape.has(&shape_keys::HEIGHTFIELD);
        !is_scenery && !body.has(&bodies::body::MOTION) && !body.get(&bodies::body::FIXED)
    };
    root.bodies().any(|body| body.look(is_free)) || !root.named(&scene::EMITTER).is_empty()
}

/// Computes the SHA-256 digest of all texts and other files that the scene was read from, in hexadecimal.
fn digest(
    input: &Input<'_>,
    options: &Options,
    included: &[String],
    povray: &PovRay,
    context: &Context<'_>,
) -> String {
    let mut hash = Sha256::new();
    let mut add = |text: &str| {
        // The length separates the texts. Without the length, two different lists of texts could have the same digest.
        hash.update((text.len() as u64).to_le_bytes());
        hash.update(text);
    };
    add(input.text);
    included.iter().for_each(|text| add(text));
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
    // Hash only the names of assets: scripts contain the names of assets, but not their contents.
    povray.assets.iter().for_each(|asset| add(&asset.name));
    context.files.iter().for_each(|digest| hash.update(digest));
    context.meshes.digests().for_each(|digest| hash.update(digest));
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

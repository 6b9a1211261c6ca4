//! Tests that every public function with a text argument accepts any text without a panic.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::Path;
use std::sync::{Arc, LazyLock};

use jabuka::Scene;
use jabuka::catalog::Category;
use jabuka::diagnostic::{Code, Diagnostic, Report, Sources, Span, nearest, visible, visible_lines};
use jabuka::explain::Explanation;
use jabuka::font::{Step, Typeface, Weight};
use jabuka::lettering;
use jabuka::page::{Frames, Host, PageRun, Session, answer, text_version};
use jabuka::physics::Method;
use jabuka::report::plot::{Chart, Curve, Picture, png, svg};
use jabuka::report::{Assessment, assess};
use jabuka::scene::expression::{Formula, Function, Program, Scope};
use jabuka::scene::grammar::{SCENE, find_keys, key_at, keys_inside};
use jabuka::scene::sdl::{Where, files, refusals};
use jabuka::scene::source::parse;
use jabuka::scene::{Color, Finish, LibraryMaterial, Options, Override, Preset};
use jabuka::simulate::Selection;
use proptest::prelude::*;

/// The public functions with a text argument that are tried here, as `file: name`.
const TRIED: [&str; 58] = [
    "catalog.rs: named",
    "diagnostic/code.rs: named",
    "diagnostic/mod.rs: at",
    "diagnostic/mod.rs: error",
    "diagnostic/mod.rs: fix",
    "diagnostic/mod.rs: help",
    "diagnostic/mod.rs: of_error",
    "diagnostic/mod.rs: warning",
    "diagnostic/nearest.rs: nearest",
    "diagnostic/source.rs: add",
    "diagnostic/visible.rs: visible",
    "diagnostic/visible.rs: visible_lines",
    "explain.rs: of",
    "font.rs: ink",
    "font.rs: outline",
    "font.rs: width",
    "integrator/mod.rs: by_name",
    "lettering.rs: adapted",
    "lettering.rs: has_bold",
    "lettering.rs: is_script",
    "lettering.rs: plain",
    "lettering.rs: runs",
    "lettering.rs: set",
    "lettering.rs: spaces",
    "lettering.rs: width",
    "lettering.rs: without_marks",
    "page/answers.rs: answer",
    "page/answers.rs: answer_of_run",
    "page/session.rs: set_variable",
    "page/session.rs: text_version",
    "report/plot/chart.rs: of_charts",
    "report/plot/mod.rs: of",
    "report/text.rs: to_text",
    "scene/color.rs: parse",
    "scene/mark.rs: usual_text",
    "scene/expression/function.rs: named",
    "scene/expression/parser.rs: parse",
    "scene/expression/program.rs: compile",
    "scene/expression/scope.rs: constant",
    "scene/expression/scope.rs: is_free",
    "scene/expression/scope.rs: slot",
    "scene/expression/scope.rs: value",
    "scene/grammar/find.rs: find_keys",
    "scene/grammar/find.rs: key_at",
    "scene/grammar/find.rs: keys_inside",
    "scene/grammar/mod.rs: key",
    "scene/library.rs: named",
    "scene/look.rs: named",
    "scene/mod.rs: from_text_at",
    "scene/mod.rs: parse",
    "scene/mod.rs: parse_with",
    "scene/preset.rs: named",
    "scene/sdl/files.rs: files",
    "scene/sdl/filter.rs: refusals",
    "scene/source/overrides.rs: new",
    "scene/source/toml.rs: parse",
    "scene/source/tree.rs: get",
    "scene/source/tree.rs: get_mut",
];

/// Public functions whose text argument is made by jabuka itself and never by a user: names of frames, files and meshes, and options of
/// POV-Ray.
const NAMES: [&str; 16] = [
    "emit/mod.rs: shutter",
    "emit/mod.rs: trail_files",
    "emit/showing/trails.rs: is_trail_file",
    "output/folder.rs: write",
    "random.rs: new",
    "render/images.rs: copy_out",
    "render/images.rs: image",
    "render/images.rs: read",
    "render/record.rs: expected",
    "render/record.rs: path",
    "render/record.rs: read",
    "render/record.rs: state",
    "render/record.rs: write",
    "scene/color_map.rs: named",
    "shape/mesh/mod.rs: new",
    "shape/mesh/mod.rs: surface",
];

/// The host of a page that shows one ball.
struct OneBall;

impl Host for OneBall {
    fn read(&self, options: &Options) -> Result<Scene, Report> {
        Scene::parse_with("simulation.duration = 0.1\nbody.a.shape.sphere.radius = 1", options)
    }

    fn start(&self, run: Arc<PageRun>) -> io::Result<()> {
        let mut work = run.work();
        while work.advance() {}
        Ok(())
    }

    fn changed(&self) {}

    fn report(&self, _report: &Report) {}
}

/// The session of a page that shows one ball, whose run has the number 1.
static SESSION: LazyLock<Session> = LazyLock::new(|| {
    let session = Session::new(Options::default(), Arc::new(OneBall));
    session.read();
    assert!(answer(&session, "/api/runs/1/poses", &Frames::default()).is_ok());
    session
});

/// Generates texts of arbitrary characters, and texts of words from scenes, formulas, labels and SDL.
fn texts() -> impl Strategy<Value = String> {
    let word = prop::sample::select(vec![
        "[body.a]",
        "[[body]]",
        "shape.sphere.radius",
        "=",
        "\n",
        "\r\n",
        "\"",
        "'''",
        "{",
        "}",
        "[",
        "]",
        "1e308",
        "-0",
        "nan",
        "0x1F",
        "·",
        "−1",
        "π",
        "é",
        "\u{202e}",
        "\u{0}",
        "${a.x:.3}",
        "${",
        "2*t^2",
        "sin(",
        ")",
        "i",
        "uniform(0, 1)",
        "repeat = 3",
        "location",
        "#include",
        "#macro A()",
        "/*",
        "*/",
        "//",
        "#",
        "#ff8800",
        "rgb(",
        "0-3,7",
        "-",
        ",",
        ".",
        "simulation.step=0.1",
        "body: {",
        "- a",
        "%",
        " ",
        "\t",
        "\\u",
        "\\",
        "red",
        "rk4",
    ]);
    prop_oneof![".{0,80}", "(?s).{0,40}", prop::collection::vec(word, 0..14).prop_map(|words| words.concat())]
}

/// The accuracy report of a small scene.
static ASSESSMENT: LazyLock<Assessment> = LazyLock::new(|| {
    let text = "simulation.duration = 0.2\n[body.a]\nshape.sphere.radius = 1\nvelocity = [1, 0, 0]\n";
    assess(&Scene::parse(text).unwrap(), 1e-3, &mut |_, _| true).unwrap()
});

proptest! {
    #[test]
    fn no_text_stops_a_public_function(text in texts(), other in texts()) {
        let _ = (Code::named(&text), Explanation::of(&text), Method::by_name(&text), Function::named(&text));
        let _ = (Preset::named(&text), Finish::named(&text), LibraryMaterial::named(&text), SCENE.key(&text));
        let _ = (Category::named(&text), find_keys(&text));
        let path: Vec<&str> = text.split('.').collect();
        let _ = (key_at(&path), keys_inside(&path));
        let _ = (Color::parse(&text), text.parse::<Selection>(), nearest(&text, [other.as_str(), "red"]));
        prop_assert_eq!(visible_lines(&text).lines().count(), text.lines().count());
        let is_visible = !visible(&text).contains(['\u{202e}', '\u{0}', '\n']);
        prop_assert!(is_visible);

        let mut scope = Scope::default().with_draws();
        if Scope::is_free(&other).is_ok() {
            scope.constant(other.as_str(), 2.0);
            scope.slot("x");
            prop_assert_eq!(scope.value(&other), Some(2.0));
        }
        let _ = (Formula::parse(&text).is_ok(), Program::compile(&text, &scope).is_ok());

        for place in [Where::Top, Where::Inside] {
            let (refused, _) = refusals(&text, place, |name| name == other);
            prop_assert!(refused.iter().all(|refusal| text.get(refusal.range.clone()).is_some()));
        }
        prop_assert!(files(&text).all(|file| text.get(file.range.clone()).is_some()));

        let mut sources = Sources::default();
        let id = sources.add(other.as_str(), text.as_str());
        let mut said = Vec::new();
        let mut tree = parse(&text, id, &mut said);
        if let jabuka::scene::source::Value::Table(table) = &mut tree.value {
            let _ = (table.get(&other).is_some(), table.get_mut(&other).is_some());
        }
        let span = Span::new(id, 0..text.len());
        for diagnostic in [Diagnostic::error(Code::UnknownKey, &other), Diagnostic::warning(Code::Crossing, &text)] {
            said.push(diagnostic.at(span, &other).help(&text).fix(span, &other));
        }
        let report = Report { sources, diagnostics: said };
        let _ = (report.to_text(false), report.to_text(true), report.to_json(), report.fixed(id));
        let _ = Report::of_error(Code::CannotRead, &text).to_text(false);

        let curve = Curve { name: text.clone(), points: vec![[1.0, 1.0], [2.0, 0.5]] };
        let axes = [text.clone(), text.clone()];
        svg(&Picture::of_charts(&text, &[Chart { title: text.clone(), axes, curves: vec![curve] }]));
        let picture = Picture::of(&ASSESSMENT, &text).unwrap();
        let svg = svg(&picture);
        prop_assert!(ASSESSMENT.to_text(&text).starts_with(&text) && svg.ends_with("</svg>\n"));
        let _ = png(&picture).unwrap();
        let font = Typeface::usual().font(Weight::Bold);
        let width = font.width(&text);
        prop_assert!(width.is_finite() && width >= 0.0, "{width}");
        prop_assert!(font.ink(&text).is_none_or(|ends| ends.iter().all(|end| end.is_finite())));
        let is_finite = |step| match step {
            Step::Move(to) | Step::Line(to) | Step::Curve { to, .. } => to.iter().all(|part| part.is_finite()),
        };
        prop_assert!(font.outline(&text).into_iter().all(is_finite));
        let _ = Typeface::of_file(text.clone(), text.clone().into_bytes());
        match lettering::set(&text, 0..text.len(), &mut None) {
            Ok(set) => {
                prop_assert!(lettering::width(&set, Typeface::usual()).is_finite());
                prop_assert!(lettering::runs(&lettering::adapted(&set, font)).all(|run| !run.letters.is_empty()));
                let _ = lettering::has_bold(&set);
                prop_assert!(lettering::without_marks(&set).len() <= set.len());
                prop_assert!(lettering::plain(&set).len() <= set.len());
                prop_assert!(lettering::runs(&set).all(|run| !run.letters.is_empty()));
                prop_assert!(lettering::spaces(&set).all(|at| set.is_char_boundary(at)));
            }
            Err(wrong) => prop_assert!(wrong.iter().all(|script| text.get(script.range.clone()).is_some())),
        }
        let braces = text.match_indices('{').filter(|(at, _)| lettering::is_script(&text, *at));
        prop_assert!(braces.count() <= text.len());
        prop_assert!(text.is_empty() || !jabuka::scene::Angle::usual_text(&text).is_empty());

        for path in [text.clone(), format!("/api/runs/{text}"), format!("/api/runs/1/{text}")] {
            let _ = answer(&SESSION, &path, &Frames::default());
        }
        prop_assert!(SESSION.set_variable(&text, 1.0).is_err());
        prop_assert_eq!(text_version(&text) == text_version(&other), text == other);

        let _ = Scene::parse(&text).map_err(|report| report.to_text(false));
        let options = Options { overrides: vec![Override::new(&other)], trust: true, ..Options::default() };
        let _ = Scene::parse_with(&text, &options).map_err(|report| report.to_text(false));
        let _ = Scene::from_text_at("nowhere/scene.toml", &text, &options).map_err(|report| report.to_text(false));
    }
}

/// Adds to `found` the public functions below a folder that take a text, as `file: name`.
fn functions(folder: &Path, root: &Path, found: &mut BTreeSet<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            functions(&path, root, found);
            continue;
        }
        let text = fs::read_to_string(&path).unwrap_or_default();
        for (at, _) in text.match_indices("pub fn ") {
            let declared = text[at + 7..].split('{').next().unwrap_or_default();
            let (name, rest) = declared.split_once(['(', '<']).unwrap();
            let arguments = rest.rsplit_once("->").map_or(rest, |(arguments, _)| arguments);
            if ["&str", "Into<String>", "&'a str,", "AsRef<str>"].iter().any(|kind| arguments.contains(kind))
            {
                let file = path.strip_prefix(root).unwrap().display().to_string();
                found.insert(format!("{file}: {name}"));
            }
        }
    }
}

#[test]
fn every_public_function_that_takes_a_text_is_tried() {
    let mut found = BTreeSet::new();
    for root in ["src", "physics/src"].map(|folder| Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)) {
        functions(&root, &root, &mut found);
    }
    // The functions of the command line and of the preview are not part of the library's interface.
    found.retain(|function| !function.starts_with("cli/") && !function.starts_with("preview/"));
    let listed: BTreeSet<String> = TRIED.iter().chain(&NAMES).map(|&function| function.to_owned()).collect();
    let untried: Vec<&String> = found.difference(&listed).collect();
    assert!(untried.is_empty(), "try them above, or list them as names: {untried:#?}");
    let gone: Vec<&String> = listed.difference(&found).collect();
    assert!(gone.is_empty(), "these are there no more: {gone:#?}");
}

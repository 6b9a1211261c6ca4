//! The fuzz targets: each function runs one part of jabuka on an input. The tests beside this file call them with mutated inputs, and
//! `fuzz/` calls them from cargo-fuzz. A panic or a contradictory result is a failure.

use std::fs;
use std::path::Path;

use jabuka::diagnostic::{Code, Diagnostic, Report, Severity, Sources, visible, visible_lines};
use jabuka::output::{MANIFEST, Manifest};
use jabuka::render::Record;
use jabuka::scene::source::parse;
use jabuka::scene::{Color, Options, Override};
use jabuka::simulate::Selection;
use jabuka::{Run, Scene};

/// Places of a scene whose string holds a formula, a label or SDL: a fragment of TOML with `TEXT` for the string, and a valid string.
pub const PLACES: [(&str, &str); 8] = [
    ("location = [TEXT, 0, 0]", "2*sin(3*t)^2 + min(1, abs(t - 3)) % (1 + exp(-t))"),
    ("[variables]\na = TEXT\nb = \"a + 1\"", "sqrt(2) * pi / (1 - 0.5)"),
    ("[label.l]\ntext = TEXT", "t = ${t:.3} s, v = ${ball.speed} · ${2*ball.x}"),
    (
        "[povray]\nsdl = TEXT",
        "#declare A = 3; sphere { <0, A, 1>, 0.5 texture { pigment { rgb <1, 0, 0> } } } // x",
    ),
    ("[material.m]\nsdl = TEXT", "pigment { image_map { png \"a.png\" } } finish { phong 1 } #if (1) #end"),
    ("[light.l]\npoint.location = [0, TEXT, 0]", "3 + uniform(0, 1) * normal(0, 2)"),
    ("repeat = TEXT", "3 + 2"),
    ("material = TEXT", "brass"),
];

/// Extensions of the files that a scene can name, each with a fragment of a scene that names `FILE`.
pub const FILES: [(&str, &str); 4] = [
    ("obj", "shape.mesh.file = 'FILE'"),
    ("stl", "shape.mesh.file = 'FILE'"),
    ("png", "fixed = true\nshape.heightfield = { file = 'FILE', size = [4, 1, 4] }"),
    ("csv", "shape.sphere.radius = 1\nmotion.trajectory.file = 'FILE'"),
];

/// Parses a text as a scene, and checks its diagnostics.
pub fn scene(text: &str) {
    say(&Scene::parse(text));
}

/// Parses a scene with a string at one of [`PLACES`].
pub fn string(place: &str, text: &str) {
    let quoted = serde_json::to_string(text).unwrap().replace('\u{7f}', "");
    scene(&format!("[body.ball]\nshape.sphere.radius = 1\n{}", place.replace("TEXT", &quoted)));
}

/// Parses scenes with a text at each place that takes a formula.
pub fn formula(text: &str) {
    [0, 1, 5, 6].into_iter().for_each(|place: usize| string(PLACES[place].0, text));
}

/// Parses a scene with this text as a label.
pub fn label(text: &str) {
    string(PLACES[2].0, text);
}

/// Parses scenes with a text at the places that take SDL, POV-Ray's scene language, which is filtered.
pub fn sdl(text: &str) {
    [3, 4].into_iter().for_each(|place: usize| string(PLACES[place].0, text));
}

/// Parses a text as each kind of command-line argument: an override, a selection of frames, a color. Checks that it is shown safely.
pub fn argument(text: &str) {
    let options = Options { overrides: vec![Override::new(text)], ..Options::default() };
    say(&Scene::parse_with("[body.ball]\nshape.sphere.radius = 1", &options));
    let _ = (text.parse::<Selection>(), Color::parse(text));
    assert!(!visible(text).contains('\u{202e}') && !visible_lines(text).contains('\u{202e}'));
}

/// Reads a scene with a text that it includes and with `--set` arguments. Returns the number of diagnostics and of fixes.
pub fn texts_together(folder: &Path, text: &str, included: &str, settings: &[String]) -> (usize, usize) {
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    fs::write(folder.join(INCLUDED), included).unwrap();
    let overrides = settings.iter().map(Override::new).collect();
    say(&Scene::from_path_with(&path, &Options { overrides, ..Options::default() }))
}

/// The name of the file that scenes of [`texts_together`] include.
pub const INCLUDED: &str = "part.toml";

/// Writes a file of one of the kinds of [`FILES`] into a folder for this test, and reads a scene that names it. Returns true if the file
/// is valid.
pub fn file(folder: &Path, (ending, scene): (&str, &str), bytes: &[u8]) -> bool {
    let name = format!("input.{ending}");
    fs::write(folder.join(&name), bytes).unwrap();
    let path = folder.join("scene.toml");
    fs::write(&path, format!("[body.ball]\n{}\n", scene.replace("FILE", &name))).unwrap();
    let scene = Scene::from_path_with(&path, &Options::default());
    say(&scene);
    scene.is_ok()
}

/// Writes a manifest into a folder for this test, and reads it. Returns true if it is valid.
pub fn manifest(folder: &Path, bytes: &[u8]) -> bool {
    fs::write(folder.join(MANIFEST), bytes).unwrap();
    let manifest = Manifest::read(folder);
    if let Some(manifest) = &manifest {
        manifest.warnings();
    }
    manifest.is_some()
}

/// Writes the record of an image into a folder for this test, and reads it. Returns true if it is valid.
pub fn record(folder: &Path, bytes: &[u8]) -> bool {
    let path = Record::path(folder, "frame_0001");
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(&path, bytes).unwrap();
    Record::read(folder, "frame_0001").is_some()
}

/// Returns a valid manifest, as jabuka writes it.
pub fn a_manifest(folder: &Path) -> Vec<u8> {
    let scene = Scene::parse("simulation.duration = 0.04\n[body.ball]\nshape.sphere.radius = 1").unwrap();
    let run = Run::new(&scene).unwrap();
    let opened = jabuka::output::Folder::open(folder).unwrap();
    jabuka::output::write(&run, &opened, &Selection::first(2), &|| {}).unwrap();
    fs::read(folder.join(MANIFEST)).unwrap()
}

/// Returns a valid record of an image, as jabuka writes it.
pub fn a_record() -> Vec<u8> {
    let digest = "0123456789abcdef".repeat(4);
    let lines = format!(
        "script {digest}\nfiles {digest}\noptions +W16 +H9\nframe 3\npovray 3.7\nbytes 900\nimage {digest}\n"
    );
    lines.into_bytes()
}

/// Formats all diagnostics of a result as text and as JSON, and checks that they are consistent with it and that their fixes can be
/// applied. Returns the number of diagnostics and of fixes.
fn say(result: &Result<Scene, Report>) -> (usize, usize) {
    let report = result.as_ref().map_or_else(|report| report, |scene| &scene.warnings);
    assert_eq!(result.is_ok(), report.errors() == 0);
    assert_eq!(report.to_text(true).is_empty(), report.diagnostics.is_empty());
    report.to_json();
    let mut fixes = 0;
    for diagnostic in &report.diagnostics {
        if let Some(span) = diagnostic.span() {
            report.fixed(span.source());
        }
        fixes += usize::from(diagnostic.fix.is_some());
        check_fix(diagnostic, &report.sources);
    }
    (report.diagnostics.len(), fixes)
}

/// Checks that the fix of a diagnostic can be applied, and that the text can then be parsed. In a text with errors of syntax, the fix adds
/// none, and the fix of one of them removes at least this one.
fn check_fix(diagnostic: &Diagnostic, sources: &Sources) {
    let Some(fix) = &diagnostic.fix else { return };
    let (source, fixed) = fix.applied(sources).unwrap_or_else(|| panic!("{diagnostic:?}"));
    let source = sources.get(source);
    if source.name == "--set" {
        assert!(Override::new(fixed.as_str()).is_setting(), "{fixed}\n{diagnostic:?}");
        return;
    }
    let errors = |text: &str| {
        let (mut sources, mut said) = (Sources::default(), Vec::new());
        parse(text, sources.add("", text), &mut said);
        said.iter().filter(|it| it.severity == Severity::Error).count()
    };
    let is_syntax =
        matches!(diagnostic.code, Code::TomlSyntax | Code::TomlUnclosed | Code::Toml11 | Code::DuplicateKey);
    let (before, after) = (errors(&source.text), errors(&fixed));
    let most = if is_syntax { before.saturating_sub(1) } else { before };
    assert!(after <= most, "{}\nbecomes\n{fixed}\n{diagnostic:?}", source.text);
}

//! Tests that POV-Ray parses every script of the gallery without warnings.

use std::fs;
use std::path::Path;

use crate::{povray, support};

/// Warnings that POV-Ray prints whenever several scripts are read into one scene. A single script does not cause them.
const OF_READING_SEVERAL: [&str; 3] = [
    "New instance of assumed_gamma ignored",
    "More than one camera in scene. Ignoring previous camera(s).",
    "Only one sky-sphere allowed (last one will be used).",
];

#[test]
fn every_script_of_the_gallery_is_parsed_without_a_word() {
    let scenes: Vec<_> =
        fs::read_dir(support::root().join("scenes")).unwrap().map(|entry| entry.unwrap().path()).collect();
    let scenes: Vec<_> = scenes.iter().filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    assert!(!scenes.is_empty());
    std::thread::scope(|scope| {
        for scene in scenes {
            scope.spawn(|| check(scene));
        }
    });
}

/// Parses a script, and renders a single pixel without light, since all bodies of many scripts stand in one scene.
fn parse(folder: &Path, input: &str) -> povray::Said {
    povray::run(folder, &[input, "+Oparsed.png", "+W1", "+H1", "+WT1", "+Q0", "-MB"])
}

/// The largest number of bytes of a scene's scripts that POV-Ray reads, about a minute's work.
const READ: usize = 40_000_000;

/// Parses the first and the last script of a scene alone. Then one process parses the other scripts together, since one process for each
/// would take minutes. If the scripts are long, it reads only every second of them, every third, and so on.
fn check(scene: &Path) {
    let folder = tempfile::tempdir().unwrap();
    let scripts = folder.path().join("scripts");
    support::compile(scene, &scripts, support::shorter(scene));
    let names = support::contents(&scripts).into_iter().map(|(name, _)| name);
    let names: Vec<_> = names.filter(|name| name.starts_with("frame_")).collect();
    assert!(!names.is_empty());
    for name in [&names[0], &names[names.len() - 1]] {
        let input = format!("+I{name}");
        parse(&scripts, &input).nothing(&format!("{name} of {}", scene.display()));
    }

    let size = fs::metadata(scripts.join(&names[names.len() - 1])).unwrap().len() as usize * names.len();
    let names: Vec<_> = names.into_iter().step_by(size.div_ceil(READ).max(1)).collect();
    let includes = names.iter().map(|name| format!("#include \"scripts/{name}\"\n")).collect::<String>();
    // The warning in the last line shows that no script ended the parsing early.
    let all = format!("#version 3.7;\n{includes}#warning \"read to the end\"\n");
    fs::write(folder.path().join("all.pov"), all).unwrap();

    let said = parse(folder.path(), "+Iall.pov");
    assert!(said.success && said.errors.is_empty(), "{}: {}", scene.display(), said.errors);
    let (end, warnings): (Vec<_>, Vec<_>) = said
        .warnings
        .split("File: ")
        .filter(|warning| !warning.is_empty())
        .filter(|warning| {
            let is_first = warning.contains(names[0].as_str());
            is_first || !OF_READING_SEVERAL.iter().any(|usual| warning.contains(usual))
        })
        .partition(|warning| warning.contains("read to the end"));
    assert!(warnings.is_empty(), "{}: {}", scene.display(), warnings.concat());
    assert_eq!(end.len(), 1, "{}", scene.display());
}

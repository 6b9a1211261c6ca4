//! Inputs that are almost right, in great number: nothing panics, and every error has its text.
//!
//! By default each target gets a few hundred inputs. For a long run, `JABUKA_FUZZ=1000000 cargo test --release --test fuzz -- --nocapture`
//! tries so many on each, and `JABUKA_FUZZ_SEED` begins elsewhere. A failure names the seed of its input.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "this is a test program")]

mod mutator;

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use jabuka::Scene;
use jabuka::diagnostic::{Report, visible, visible_lines};
use jabuka::output::Manifest;
use jabuka::render::Record;
use jabuka::scene::{Color, Options, Override};
use jabuka::simulate::Selection;
use mutator::{Random, mutate, mutate_text};

/// Tries a target with many inputs, each made from a seed.
fn fuzz(name: &str, mut target: impl FnMut(&mut Random)) {
    let number = |variable: &str| std::env::var(variable).ok().and_then(|text| text.parse::<u64>().ok());
    let (count, first) = (number("JABUKA_FUZZ").unwrap_or(150), number("JABUKA_FUZZ_SEED").unwrap_or(1));
    let mut slowest = (Duration::ZERO, first);
    for seed in first..first + count {
        let begun = Instant::now();
        let tried = catch_unwind(AssertUnwindSafe(|| target(&mut Random::new(seed))));
        assert!(tried.is_ok(), "{name}: the input of JABUKA_FUZZ_SEED={seed} JABUKA_FUZZ=1 panics");
        slowest = slowest.max((begun.elapsed(), seed));
    }
    println!("{name}: {count} inputs, the slowest {:.3} s (seed {})", slowest.0.as_secs_f64(), slowest.1);
}

/// Files of the project with an ending.
fn files(ending: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders =
        ["scenes", "scenes/meshes", "tests/bad", "tests/bad/meshes", "tests/bad/csv", "tests/mistakes"];
    let entries = folders.iter().flat_map(|folder| fs::read_dir(root.join(folder)).unwrap());
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|found| found == ending));
    files.sort();
    assert!(!files.is_empty(), "{ending}");
    files
}

fn texts(ending: &str) -> Vec<String> {
    files(ending).iter().map(|path| String::from_utf8_lossy(&fs::read(path).unwrap()).into_owned()).collect()
}

/// Whatever is said of an input can be said.
fn say(result: &Result<Scene, Report>) {
    let report = result.as_ref().map_or_else(|report| report, |scene| &scene.warnings);
    assert_eq!(result.is_ok(), report.errors() == 0);
    assert_eq!(report.to_text(true).is_empty(), report.diagnostics.is_empty());
    report.to_json();
    for diagnostic in &report.diagnostics {
        if let Some(span) = diagnostic.span() {
            report.fixed(span.source);
        }
    }
}

/// A scene with a string at some place of it.
fn scene_with(place: &str, text: &str) -> String {
    let quoted = serde_json::to_string(text).unwrap().replace('\u{7f}', "");
    format!("[body.ball]\nshape.sphere.radius = 1\n{}", place.replace("TEXT", &quoted))
}

#[test]
fn texts_of_scenes() {
    let seeds = texts("toml");
    fuzz("scenes", |random| {
        let (seed, other) = (random.choose(&seeds), random.choose(&seeds));
        let text = mutate_text(random, seed, other);
        say(&Scene::parse(&text));
    });
}

#[test]
fn formulas_labels_and_sdl() {
    let places = [
        ("location = [TEXT, 0, 0]", "2*sin(3*t)^2 + min(1, abs(t - 3)) % (1 + exp(-t))"),
        ("[variables]\na = TEXT\nb = \"a + 1\"", "sqrt(2) * pi / (1 - 0.5)"),
        ("[label.l]\ntext = TEXT", "t = ${t:.3} s, v = ${ball.speed} · ${2*ball.x}"),
        (
            "[povray]\nsdl = TEXT",
            "#declare A = 3; sphere { <0, A, 1>, 0.5 texture { pigment { rgb <1, 0, 0> } } } // x",
        ),
        (
            "[material.m]\nsdl = TEXT",
            "pigment { image_map { png \"a.png\" } } finish { phong 1 } #if (1) #end",
        ),
        ("[light.l]\npoint.location = [0, TEXT, 0]", "3 + uniform(0, 1) * normal(0, 2)"),
        ("repeat = TEXT", "3 + 2"),
        ("material = TEXT", "brass"),
    ];
    fuzz("formulas, labels, SDL", |random| {
        let (place, seed) = random.choose(&places);
        let (_, other) = random.choose(&places);
        say(&Scene::parse(&scene_with(place, &mutate_text(random, seed, other))));
    });
}

#[test]
fn short_texts() {
    let seeds = [
        "simulation.step=0.001",
        "body.ball.velocity=[1, 2, 3]",
        "0,50,90-100",
        "#ff8800",
        "rgb(1,2,3)",
        "a\u{202e}b\n",
    ];
    fuzz("short texts", |random| {
        let (seed, other) = (*random.choose(&seeds), *random.choose(&seeds));
        let text = mutate_text(random, seed, other);
        let options = Options { overrides: vec![Override::new(text.as_str())], ..Options::default() };
        say(&Scene::parse_with("[body.ball]\nshape.sphere.radius = 1", &options));
        let _ = (text.parse::<Selection>(), Color::parse(&text));
        assert!(!visible(&text).contains('\u{202e}') && !visible_lines(&text).contains('\u{202e}'));
    });
}

#[test]
fn files_that_scenes_name() {
    let scenes = [
        ("obj", "shape.mesh.file = 'FILE'"),
        ("stl", "shape.mesh.file = 'FILE'"),
        ("png", "fixed = true\nshape.heightfield = { file = 'FILE', size = [4, 1, 4] }"),
        ("csv", "shape.sphere.radius = 1\nmotion.trajectory.file = 'FILE'"),
    ];
    let table = b"t [s],body,x [m],y [m],z [m]\n0,ball,0,0,0\n1,ball,1,2,3\n2,ball,0,1,0\n".to_vec();
    let inputs = scenes.map(|(ending, scene)| {
        let mut inputs: Vec<Vec<u8>> = files(ending).iter().map(|path| fs::read(path).unwrap()).collect();
        inputs.extend((ending == "csv").then(|| table.clone()));
        (ending, scene, inputs)
    });
    let folder = tempfile::tempdir().unwrap();
    let mut read = 0;
    fuzz("meshes, heightfields, tables", |random| {
        let (ending, scene, inputs) = random.choose(&inputs);
        let (seed, other) = (random.choose(inputs).clone(), random.choose(inputs));
        // Some go through as they are: else nothing would be read to its end.
        let bytes = if random.below(8) == 0 { seed } else { mutate(random, &seed, other) };
        let name = format!("input.{ending}");
        fs::write(folder.path().join(&name), bytes).unwrap();
        let path = folder.path().join("scene.toml");
        fs::write(&path, format!("[body.ball]\n{}\n", scene.replace("FILE", &name))).unwrap();
        let scene = Scene::from_path_with(&path, &Options::default());
        read += usize::from(scene.is_ok());
        say(&scene);
    });
    assert!(read > 0, "no file was read to its end");
}

#[test]
fn manifests_and_records() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Scene::parse("simulation.duration = 0.04\n[body.ball]\nshape.sphere.radius = 1").unwrap();
    let out = folder.path().join("out");
    let run = jabuka::Run::new(&scene).unwrap();
    let opened = jabuka::output::Folder::open(&out).unwrap();
    jabuka::output::write(&run, &opened, &Selection::first(2), &|| {}).unwrap();
    let manifest = fs::read(out.join(jabuka::output::MANIFEST)).unwrap();
    assert!(Manifest::read(&out).is_some());
    let digest = "0123456789abcdef".repeat(4);
    let record = format!(
        "script {digest}\nfiles {digest}\noptions +W16 +H9\nframe 3\npovray 3.7\nbytes 900\nimage {digest}\n"
    );
    let path = Record::path(folder.path(), "frame_0001");
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(&path, &record).unwrap();
    assert!(Record::read(folder.path(), "frame_0001").is_some());
    fuzz("manifests, records", |random| {
        fs::write(out.join(jabuka::output::MANIFEST), mutate(random, &manifest, record.as_bytes())).unwrap();
        if let Some(manifest) = Manifest::read(&out) {
            manifest.warnings();
        }
        fs::write(&path, mutate(random, record.as_bytes(), &manifest)).unwrap();
        let _ = Record::read(folder.path(), "frame_0001");
    });
}

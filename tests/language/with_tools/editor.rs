//! Tests of what an editor reports on scenes, by the TOML language server taplo and the schema that `jabuka schema` prints.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use crate::support::{jabuka, root, stderr, stdout};
use jabuka::Scene;
use serde::Deserialize;

/// The first line of a scene. It tells an editor where the schema is.
const DIRECTIVE: &str = "#:schema ./jabuka.schema.json\n";

/// Makes a temporary folder that contains the schema.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let schema = jabuka().arg("schema").output().unwrap();
    fs::write(folder.path().join("jabuka.schema.json"), schema.stdout).unwrap();
    folder
}

fn taplo(folder: &Path) -> Command {
    let mut command = Command::new(root().join("tests/language/with_tools/editor/taplo"));
    command.current_dir(folder);
    command
}

fn lint(folder: &Path, files: &[PathBuf]) -> Output {
    taplo(folder).args(["lint", "--no-auto-config"]).args(files).output().unwrap()
}

/// Writes a scene with the schema directive into a folder. Returns its path.
fn write(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, format!("{DIRECTIVE}{text}")).unwrap();
    path
}

/// Returns the TOML blocks of a page, each with the file name in its first line.
fn snippets(page: &str) -> Vec<(String, String)> {
    let text = fs::read_to_string(root().join(page)).unwrap();
    let blocks = text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.map(|block| (block.lines().next().unwrap().replace("# ", ""), block.to_owned())).collect()
}

#[test]
fn every_scene_that_is_good_is_so_for_an_editor() {
    let folder = folder();
    let mut files = Vec::new();
    for entry in fs::read_dir(root().join("scenes")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let name = path.file_name().unwrap().to_str().unwrap();
            files.push(write(folder.path(), name, &fs::read_to_string(&path).unwrap()));
        }
    }
    let scenes = files.len();
    for page in ["README.md", "docs/scenes.md", "docs/tutorial.md"] {
        for (name, text) in snippets(page) {
            let path = write(folder.path(), &name, &text);
            // Skip scenes that show mistakes.
            if Scene::from_path(&path).is_ok() {
                files.push(path);
            }
        }
    }
    assert!(scenes >= 15 && files.len() > scenes + 8, "{scenes} scenes of {}", files.len());
    let output = lint(folder.path(), &files);
    assert!(output.status.success(), "{}", stderr(&output));
}

#[test]
fn what_is_wrong_in_a_key_or_a_value_is_wrong_for_an_editor() {
    let folder = folder();
    let ball = "[body.ball]\nshape.sphere.radius = 1\n";
    let wrong = [
        (format!("{ball}velosity = [1, 0, 0]\n"), "'velosity' was unexpected"),
        (format!("{ball}velocity = [1, 0]\n"), "[1,0] has less than 3 items"),
        (format!("[simulation]\nintegrator = \"rk5\"\n{ball}"), "\"rk5\" is not one of"),
        ("[body.ball]\nshape.sphere.radius = -1\n".to_owned(), "-1 is less than or equal to"),
    ];
    let file = |(n, (text, _)): (usize, &(String, _))| write(folder.path(), &format!("wrong_{n}.toml"), text);
    let files: Vec<_> = wrong.iter().enumerate().map(file).collect();
    let output = lint(folder.path(), &files);
    let said = stderr(&output);
    assert!(!output.status.success());
    assert_eq!(said.matches("schema validation failed").count(), wrong.len(), "{said}");
    for (_, about) in &wrong {
        assert!(said.contains(about), "{about}: {said}");
    }
}

/// Checks that the `.taplo.toml` of `docs/commands.md` applies the schema to all scenes of a folder.
#[test]
fn a_file_of_settings_gives_a_whole_folder_the_schema() {
    let folder = folder();
    let (name, settings) =
        snippets("docs/commands.md").into_iter().find(|(name, _)| name == ".taplo.toml").unwrap();
    fs::write(folder.path().join(name), settings).unwrap();
    fs::write(folder.path().join("good.toml"), "[body.ball]\nshape.sphere.radius = 1\n").unwrap();
    assert!(taplo(folder.path()).args(["lint", "good.toml"]).output().unwrap().status.success());
    fs::write(folder.path().join("wrong.toml"), "[body.ball]\nshape.sfere.radius = 1\n").unwrap();
    let output = taplo(folder.path()).args(["lint", "wrong.toml"]).output().unwrap();
    assert!(!output.status.success() && stderr(&output).contains("sfere"), "{}", stderr(&output));
}

/// The completions and the help text that an editor shows at one place of a scene.
#[derive(Deserialize)]
struct Offer {
    labels: Vec<String>,
    hover: String,
}

/// Asks the language server for completions and help at the place marked by `|` in each document.
fn offers<const N: usize>(documents: [&str; N]) -> [Offer; N] {
    let folder = folder();
    let documents = documents.map(|document| format!("{DIRECTIVE}{document}"));
    let mut child = taplo(folder.path())
        .arg("--ask")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let question = serde_json::to_string(&documents.as_slice()).unwrap();
    child.stdin.take().unwrap().write_all(question.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let offers: Vec<Offer> = serde_json::from_str(&stdout(&output)).unwrap();
    offers.try_into().ok().unwrap()
}

#[test]
fn an_editor_completes_keys_and_values_and_says_what_they_mean() {
    let [key, integrator, material, color, radius] = offers([
        "[body.ball]\nshape.sphere.radius = 1\nvelo|\n",
        "[simulation]\nintegrator = \"|\"\n",
        "[body.ball]\nmaterial = \"|\"\n",
        "[body.ball]\nmaterial.color = \"|\"\n",
        "[body.ball]\nshape.sphere.rad|ius = 1\n",
    ]);
    let has = |offer: &Offer, label: &str| offer.labels.iter().any(|l| l == label);
    assert!(has(&key, "velocity") && has(&key, "fixed") && !has(&key, "integrator"), "{:?}", key.labels);
    let methods = [
        "euler-cromer",
        "explicit-euler",
        "velocity-verlet",
        "rk4",
        "yoshida4",
        "dop853",
        "gauss-radau",
        "wisdom-holman",
    ];
    assert_eq!(integrator.labels, methods.map(|method| format!("\"{method}\"")));
    // The schema offers the library's materials; it cannot know the materials that a scene declares.
    assert!(has(&material, "\"brass\"") && has(&material, "\"marble\""), "{:?}", material.labels);
    assert_eq!(material.labels[0], "\"matte\"");
    assert!(has(&color, "\"tomato\""), "{:?}", color.labels);
    assert_eq!(radius.hover, "Its radius, in m.");
}

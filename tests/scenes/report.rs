//! Tests of the text and the JSON of `jabuka report`, which describes the accuracy of a run.

use std::fs;
use std::process::Output;

use crate::support::{jabuka, root, stderr, stdout};

fn report(arguments: &[&str]) -> Output {
    jabuka().current_dir(root()).arg("report").args(arguments).output().unwrap()
}

#[test]
fn each_kind_of_scene_gets_words_that_fit() {
    for name in
        ["explicit_euler", "double_pendulum", "parabola", "planets", "tumbling_box", "fountain", "dominoes"]
    {
        let output = report(&[&format!("scenes/{name}.toml")]);
        assert!(output.status.success(), "{}", stderr(&output));
        insta::assert_snapshot!(format!("report_{name}"), stdout(&output));
    }
}

#[test]
fn a_pendulum_that_swings_for_long_is_chaotic() {
    let output = report(&["scenes/double_pendulum.toml", "--set", "simulation.duration=20"]);
    let said = stdout(&output);
    assert!(said.contains("motion    chaotic: a small difference doubles every 0."), "{said}");
}

#[test]
fn programs_get_json() {
    let output = report(&["scenes/explicit_euler.toml", "--format", "json", "--accuracy", "0.01"]);
    let found: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(found["integrator"], "explicit-euler");
    assert_eq!(found["accuracy"], 0.01);
    assert_eq!(found["verdict"]["neighbours"]["kind"], "regular");
    assert_eq!(found["verdict"]["linear_momentum"]["kind"], "changed");
    let recommended = usize::try_from(found["recommended"].as_u64().unwrap()).unwrap();
    assert_eq!(found["trials"][recommended]["reaches"], true);
}

#[test]
fn a_plot_is_the_same_bytes_each_time_and_replaces_nothing_that_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    for ending in ["svg", "PNG"] {
        let plots = ["one", "two"].map(|name| {
            let plot = path(&format!("{name}.{ending}"));
            let output = report(&["scenes/explicit_euler.toml", "--plot", &plot]);
            assert!(stdout(&output).ends_with(&format!("plot      {plot}\n")), "{}", stderr(&output));
            fs::read(plot).unwrap()
        });
        assert_eq!(plots[0], plots[1]);
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4, "nothing else is left");
    let svg = fs::read_to_string(path("one.svg")).unwrap();
    assert!(svg.contains(">Explicit Euler, gone wrong</text>"), "{svg}");

    // A scene's file may have any extension.
    fs::copy(root().join("scenes/explicit_euler.toml"), path("scene.svg")).unwrap();
    let output = report(&[&path("scene.svg"), "--plot", &path("scene.svg")]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("the scene is made from it"), "{}", stderr(&output));
    let output = report(&["scenes/explicit_euler.toml", "--plot", &path("plot.gif")]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("a plot is an `.svg` or a `.png`"), "{}", stderr(&output));
}

#[test]
fn where_nothing_is_integrated_there_is_no_plot() {
    let folder = tempfile::tempdir().unwrap();
    let plot = folder.path().join("plot.svg");
    let output = report(&["scenes/dominoes.toml", "--plot", &plot.display().to_string()]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("nothing is integrated, so there is no plot"), "{}", stderr(&output));
    assert!(!plot.exists());
}

#[test]
fn an_accuracy_is_a_part() {
    for wrong in ["0", "1", "nan", "-0.1", "many"] {
        let output = report(&["scenes/parabola.toml", &format!("--accuracy={wrong}")]);
        assert_eq!(output.status.code(), Some(2), "{wrong}");
        assert!(stderr(&output).contains("from 1e-12 to 0.5"), "{}", stderr(&output));
    }
}

#[test]
fn a_summary_names_the_report_where_the_energy_drifts() {
    let folder = tempfile::tempdir().unwrap();
    let compile = |scene: &str, more: &[&str]| {
        let mut command = jabuka();
        command
            .current_dir(root())
            .args(["compile", scene, "--frames", "0", "-o"])
            .arg(folder.path().join("out"));
        stdout(&command.args(more).output().unwrap())
    };
    let said = compile("scenes/explicit_euler.toml", &["--set", "title=It's wrong"]);
    let line = "accuracy  jabuka report scenes/explicit_euler.toml --set 'title=It'\\''s wrong'\n";
    assert!(said.contains(line), "{said}");
    assert!(!compile("scenes/euler_cromer.toml", &[]).contains("jabuka report"));
}

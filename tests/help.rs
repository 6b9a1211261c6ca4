//! What helps in writing scenes: `jabuka list` and its kin.
#![allow(clippy::unwrap_used, reason = "helpers of tests are tests")]

mod support;

use jabuka::catalog::CATEGORIES;
use support::{jabuka, stderr, stdout};

#[test]
fn list_shows_what_there_is_to_choose_from() {
    let output = jabuka().args(["list", "shapes"]).output().unwrap();
    assert!(output.status.success());
    insta::assert_snapshot!(stdout(&output), @r"
    sphere  A ball (`radius`)
    box     A box (`size`)
    plane   An endless plane, which is always fixed (`normal`)
    axes    A triad of arrows along x, y, z, as heavy as a ball of half their length (`length`)
    ");
    let said = stdout(&jabuka().args(["list", "colors"]).output().unwrap());
    assert!(said.starts_with("white    #ffffff\n"), "{said}");
    let said = stdout(&jabuka().arg("list").output().unwrap());
    assert_eq!(said.lines().count(), CATEGORIES.len());
}

#[test]
fn what_cannot_be_listed_is_an_error() {
    let output = jabuka().args(["list", "shape"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(stderr(&output), "error: there is no list of `shape`; did you mean `shapes`?\n");
}

#[test]
fn a_new_scene_compiles_without_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let new = |name: &str| jabuka().current_dir(folder.path()).args(["new", name]).output().unwrap();
    let output = new("first");
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stdout(&output).starts_with("first.toml: "));
    let scene = folder.path().join("first.toml");
    let output = support::compile(&scene, &folder.path().join("out"), &[]);
    assert_eq!(stderr(&output), "");

    // What is there stays, whatever the name it is called by.
    std::fs::write(&scene, "mine").unwrap();
    for name in ["first", "first.toml"] {
        let output = new(name);
        assert_eq!(output.status.code(), Some(1));
        assert_eq!(stderr(&output), format!("error: the scene `{name}` is there already\n"));
    }
    assert_eq!(std::fs::read_to_string(&scene).unwrap(), "mine");
    assert_eq!(new("no/such/folder/x").status.code(), Some(1));
    assert!(new("a.b").status.success() && folder.path().join("a.b.toml").is_file());
}

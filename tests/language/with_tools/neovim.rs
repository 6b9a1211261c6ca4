//! A slip in a scene, found and mended in Neovim by the language server.

use std::fs;
use std::process::Command;

use serde_json::{Value, json};

use crate::support::{jabuka, root, stderr};

#[test]
fn a_slip_is_mended_by_an_action_in_neovim() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, report] = ["throw.toml", "report.json"].map(|name| folder.path().join(name));
    let text = "[simulation]\nduration = 1\n\n[body.ball]\nshape.sphere.radius = 0.5\nvelosity = [1, 0, 0]\n";
    fs::write(&scene, text).unwrap();
    let mut neovim = Command::new("nvim");
    neovim.args(["--headless", "-u", "NONE", "-i", "NONE", "-n", "-c"]);
    neovim.arg(format!("luafile {}", root().join("tests/language/with_tools/neovim/mend.lua").display()));
    neovim.env("JABUKA", jabuka().get_program()).env("SCENE", &scene).env("REPORT", &report);
    let output = neovim.output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let report: Value = serde_json::from_slice(&fs::read(report).unwrap()).unwrap();
    assert_eq!(report["before"], json!([{ "line": 5, "column": 0, "code": "unknown-key" }]));
    assert_eq!((&report["action"], &report["after"]), (&json!("Write velocity"), &json!(0)));
    assert!(report["hover"].as_str().unwrap().contains("body.NAME.velocity"), "{report}");
    assert_eq!(fs::read_to_string(scene).unwrap(), text.replace("velosity", "velocity"));
}

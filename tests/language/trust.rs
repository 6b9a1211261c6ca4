//! Tests that hostile SDL is refused without `--trust`. `tests/povray/trust.rs` checks with POV-Ray that the refused SDL is dangerous.

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::support::{jabuka, stderr};

/// A hostile scene: the word that the error must quote, the TOML with the SDL, and the files beside the scene as names and texts.
type Hostile = (&'static str, &'static str, &'static [(&'static str, &'static str)]);

/// Scenes whose SDL would overwrite, include or read files of the user.
const HOSTILE: [Hostile; 13] = [
    ("`include`", "[povray]\nsdl = '''\n  include \"VICTIM\"\n'''", &[]),
    ("`#`", "[povray]\nsdl = '#macro A() # #end A() include \"VICTIM\"'", &[]),
    ("`save_file`", "[povray]\nsdl = 'global_settings { photons { count 9 save_file \"VICTIM\" } }'", &[]),
    ("`load_file`", "[povray]\nsdl = 'global_settings { photons { count 9 load_file \"VICTIM\" } }'", &[]),
    ("`VICTIM`", "[material.red]\nsdl = 'pigment { image_map { png \"VICTIM\" } }'", &[]),
    ("`png`", "[povray]\nsdl = '#declare F = \"VICTIM\"; #declare P = pigment { image_map { png F } }'", &[]),
    ("`concat`", "[povray]\nsdl = 'height_field { concat(\"VICT\", \"IM\") }'", &[]),
    ("`fopen`", "[body.box]\nshape.box.size = [1, 1, 1]\nlook.sdl_after = '#fopen F \"VICTIM\" write'", &[]),
    ("`Parse_String`", "[povray]\nsdl = 'Parse_String(\"#fopen F \\\"VICTIM\\\" write\")'", &[]),
    ("`fopen`", "[povray]\nassets = [\"a.inc\"]", &[("a.inc", "#fopen F \"VICTIM\" write")]),
    (
        "`write`",
        "[povray]\nassets = [\"a.txt\"]\nsdl = '#include \"a.txt\"'",
        &[("a.txt", "\n\n  #write(F, 1)")],
    ),
    (
        "`VICTIM`",
        "[povray]\nassets = [\"a.txt\", \"b\"]\nsdl = '#include \"a.txt\"'",
        &[("a.txt", "#include \"b\""), ("b", "#include \"VICTIM\"")],
    ),
    ("`fopen`", "[povray]\ninclude = [\"a.inc\"]", &[("a.inc", "/* /* */ */ #fopen F \"VICTIM\" write")]),
];

#[test]
fn hostile_sdl_is_refused_at_its_place_and_its_victim_stays_as_it_was() {
    for (named, scene, files) in HOSTILE {
        let folder = tempfile::tempdir().unwrap();
        let victim = folder.path().join("victim.txt");
        fs::write(&victim, "precious").unwrap();
        let beside = folder.path().join("scene");
        fs::create_dir(&beside).unwrap();
        let name = victim.display().to_string();
        let with_victim = |text: &str| text.replace("VICTIM", &name);
        for (file, text) in files {
            fs::write(beside.join(file), with_victim(text)).unwrap();
        }
        let body = "\n[body.ball]\nshape.sphere.radius = 1\n";
        fs::write(beside.join("scene.toml"), with_victim(scene) + body).unwrap();
        let output = compile(&beside);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{scene}\n{said}");
        let named = if named == "`concat`" { "`height_field`".to_owned() } else { with_victim(named) };
        assert!(said.contains(&named) || named == "`#`" && said.contains("this `#`"), "{scene}\n{said}");
        assert!(said.contains("error[untrusted-sdl]"), "{scene}\n{said}");
        let place = said.lines().find(|line| line.trim_start().starts_with("--> ")).unwrap_or_default();
        assert!(place.split(':').count() >= 3, "a line and a column: {scene}\n{said}");
        assert_eq!(fs::read_to_string(&victim).unwrap(), "precious");
        assert!(!beside.join("out").exists(), "{scene}");
    }
}

#[test]
fn an_asset_that_is_sdl_may_name_other_assets_and_what_comes_with_povray() {
    let folder = tempfile::tempdir().unwrap();
    let parts = "#include \"colors.inc\"\n#include \"maps/wood\"\n#declare Font = 1; // Latin-1: \u{e9}\n";
    fs::create_dir(folder.path().join("maps")).unwrap();
    fs::write(folder.path().join("parts.inc"), parts.chars().map(|c| c as u8).collect::<Vec<u8>>()).unwrap();
    fs::write(folder.path().join("maps/wood"), "#declare Wood = pigment { image_map { png \"x.png\" } }\n")
        .unwrap();
    fs::write(folder.path().join("x.png"), "").unwrap();
    let scene = "[povray]\nassets = [\"parts.inc\", \"./maps/wood\", \"x.png\"]\n\
                 sdl = '#include \"parts.inc\" #declare T = text { ttf \"timrom.ttf\" \"/etc/passwd\" 1, 0 }'\n\
                 [body.ball]\nshape.sphere.radius = 1\nmaterial = \"wood\"\n\
                 [material.wood]\nsdl = 'pigment { Wood }'\n";
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let output = compile(folder.path());
    assert!(output.status.success(), "{}", stderr(&output));
}

#[test]
fn an_error_in_a_file_that_is_included_and_an_asset_is_reported_once() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("parts.inc"), "#fopen F \"x\" write\n").unwrap();
    for lists in [
        "include = ['parts.inc']\nassets = ['parts.inc']",
        "assets = ['parts.inc']\ninclude = ['./parts.inc']",
    ] {
        let scene = format!("[povray]\n{lists}\n[body.ball]\nshape.sphere.radius = 1\n");
        fs::write(folder.path().join("scene.toml"), scene).unwrap();
        let said = stderr(&compile(folder.path()));
        assert_eq!(said.matches("`fopen`").count(), 1, "{said}");
    }
}

fn compile(folder: &Path) -> Output {
    jabuka().current_dir(folder).args(["compile", "scene.toml", "-o", "out"]).output().unwrap()
}

/// Files that a scene lists and that cannot be read: each is one error, in the list, and not a second one where SDL names the file.
#[test]
fn a_listed_asset_that_is_missing_is_one_error() {
    for (name, sdl) in [
        ("textures/wood.png", "[material.m]\nsdl = 'pigment { image_map { png \"NAME\" } }'"),
        ("./wood.png", "[material.m]\nsdl = 'pigment { image_map { png \"wood.png\" } }'"),
        ("walls.inc", "povray.sdl = '#include \"NAME\"'"),
        ("a.ttf", "povray.sdl = 'text { ttf \"NAME\" \"a\" 1, 0 }'"),
        ("hills.png", "povray.sdl = 'height_field { png \"NAME\" }'"),
        ("../wood.png", "[material.m]\nsdl = 'pigment { image_map { png \"NAME\" } }'"),
        (
            "wood.png",
            "[material.m]\nsdl = 'pigment { image_map { png \"NAME\" } }'\n[material.n]\nsdl = 'pigment { image_map { png \"NAME\" } }'",
        ),
    ] {
        let sdl = sdl.replace("NAME", name);
        let scene = format!("# Assets.\npovray.assets = [\"{name}\"]\n{sdl}\n");
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.toml"), &scene).unwrap();
        let report = jabuka::Scene::from_path(folder.path().join("scene.toml")).unwrap_err();
        let lines: Vec<usize> = report
            .diagnostics
            .iter()
            .map(|diagnostic| report.sources.start(diagnostic.span().unwrap()).line)
            .collect();
        assert_eq!(lines, [2], "{report}");
    }
}

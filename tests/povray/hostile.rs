//! Tests that names and titles are never executed as SDL code.

use std::fs;

use crate::{povray, support};

const SCENE: &str = r##"
title = "x\n#fopen A \"stolen\" write\r#write (A, 1)\u2028#error \"title\" */ \\"

[simulation]
duration = 0

[body."*/ #fopen B \"stolen\" write"]
shape.sphere.radius = 1
material = "\" }\n#fopen C \"stolen\" write //\\"

[body."line\r#error \"body\""]
shape.box.size = [1, 1, 1]
location = [2, 0, 0]
material = "\" }\n#fopen C \"stolen\" write //\\"

[body."\n} #error \"floor\" {"]
shape.plane = {}
location = [0, -1, 0]

[body."/* $\{name} <% raise %> é 🫐"]
shape.axes.length = 1
material = "\n#error \"sdl\""

[material."\" }\n#fopen C \"stolen\" write //\\"]
color = "red"

[material."\n#error \"sdl\""]
sdl = "pigment { rgb 1 } // no line break at the end"

[light."a\n#error \"light\""]
point.location = [3, 4, 5]

[povray]
include = ["x; #fopen D; y.inc"]
sdl = "#declare Two = One + 1; // no line break at the end"
"##;

#[test]
fn nothing_in_a_name_is_code() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    // TOML needs no escape for `$`. The constant is written with a backslash, since `${` looks like a template in a Rust file.
    fs::write(&scene, SCENE.replace("$\\{", "${")).unwrap();
    let include = folder.path().join("x; #fopen D; y.inc");
    fs::write(&include, "#declare One = 1; // */ ${name} \"no line break at the end").unwrap();
    let out = folder.path().join("out");
    support::compile(&scene, &out, &[]);
    let before = support::contents(&out).len();

    let arguments = ["+Iframe_0000.pov", "+Oframe_0000.png", "+W16", "+H9"];
    povray::run(&out, &arguments).nothing("the hostile scene");
    let names = support::contents(&out).into_iter().map(|(name, _)| name);
    let new: Vec<_> = names.filter(|name| name.ends_with(".txt") || name.ends_with(".png")).collect();
    assert!(new.iter().any(|name| name == "frame_0000.png"), "the scene was rendered");
    assert_eq!(support::contents(&out).len(), before + new.len(), "there is a file more: {new:?}");
    assert!(!out.join("stolen").exists());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3, "the scene, its include and its scripts");
}

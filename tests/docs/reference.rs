//! Tests of the pages that are generated from the code: keys, materials, and SDL without trust.
//!
//! After a change of the code, this command writes the pages again: `JABUKA_UPDATE_DOCS=1 cargo test --test docs reference`.

use jabuka::scene::MATERIALS;

#[test]
fn the_page_of_keys_is_up_to_date() {
    is_up_to_date("scene-language.md", &jabuka::scene::grammar::reference());
}

#[test]
fn the_page_of_sdl_without_trust_is_up_to_date() {
    is_up_to_date("sdl-without-trust.md", &jabuka::scene::sdl::reference());
}

#[test]
fn the_examples_of_the_page_of_keys_are_scenes() {
    let page = jabuka::scene::grammar::reference();
    let examples: Vec<&str> =
        page.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert_eq!(examples.len(), 16);
    for example in examples {
        let scene = jabuka::Scene::parse(example).unwrap_or_else(|report| panic!("{report}"));
        assert!(scene.warnings.diagnostics.is_empty(), "{}", scene.warnings);
    }
}

#[test]
fn the_page_of_materials_is_up_to_date() {
    let row = |m: &jabuka::scene::LibraryMaterial| {
        let color = m.color.map_or("its own".to_owned(), |color| format!("`#{color:06x}`"));
        format!("| `{}` | {} | {color} |\n", m.name, m.meaning)
    };
    let rows: String = MATERIALS.iter().map(row).collect();
    let page = format!("{MATERIALS_HEAD}\n| name | look | color |\n| --- | --- | --- |\n{rows}");
    is_up_to_date("materials.md", &page);
}

pub(crate) fn is_up_to_date(name: &str, page: &str) {
    let path = format!("{}/docs/{name}", env!("CARGO_MANIFEST_DIR"));
    if std::env::var_os("JABUKA_UPDATE_DOCS").is_some() {
        std::fs::write(&path, page).expect("docs/ can be written to");
    }
    let written = std::fs::read_to_string(&path).expect("the page is there");
    assert!(page == written, "docs/{name} is out of date: see the comment on this test");
}

const MATERIALS_HEAD: &str = r##"# The built-in materials

![A ball and a box of every material, each with its name](materials.png)

A body takes any of these materials by its name. If the scene has a `[material.NAME]` with the same name, the body takes
that one.

```toml
[body.crate]
shape.box.size = [1, 1, 1]
material = "wood"
```

A body can also have a material of its own, with the same keys: `material.color = "tomato"`.

With `like`, a material starts from a built-in one. `color` tints it:

```toml
[body.table]
shape.box.size = [4, 0.2, 2]
material = "mahogany"

[material.mahogany]
like = "dark_wood"
color = "#7a2f22"
```

A pattern turns with its body and scales with it: a crate has as many rings of wood as a matchbox. A body gets the
pattern of a ball with the same volume. On a plane, the pattern is as large as the tiles of the ground. The name of a body
decides from which part of the tree its wood is cut, so two crates look different. Materials that shine by themselves cast
no shadow, so a lamp inside a `luminous` ball lights the scene.

`docs/materials.sh` renders the picture. The POV-Ray code of the materials is in
[templates/library/](../templates/library).
"##;

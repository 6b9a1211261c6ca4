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
    assert_eq!(examples.len(), 10);
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
    let page =
        format!("{MATERIALS_HEAD}\n| name | what it looks like | its color |\n| --- | --- | --- |\n{rows}");
    is_up_to_date("materials.md", &page);
}

fn is_up_to_date(name: &str, page: &str) {
    let path = format!("{}/docs/{name}", env!("CARGO_MANIFEST_DIR"));
    if std::env::var_os("JABUKA_UPDATE_DOCS").is_some() {
        std::fs::write(&path, page).expect("docs/ can be written to");
    }
    let written = std::fs::read_to_string(&path).expect("the page is there");
    assert!(page == written, "docs/{name} is out of date: see the comment on this test");
}

const MATERIALS_HEAD: &str = r##"# The materials that every scene knows

![A ball and a box of every material, each with its name](materials.png)

A body takes any of these by its name, without a declaration. A `[material.NAME]` of the scene with the same name comes
first.

```toml
[body.crate]
shape.box.size = [1, 1, 1]
material = "wood"
```

Or it has a material of its own, with the keys of a `[material.NAME]`: `material.color = "tomato"`.

With `like`, a material of the scene starts from one of these, and `color` tints it:

```toml
[body.table]
shape.box.size = [4, 0.2, 2]
material = "mahogany"

[material.mahogany]
like = "dark_wood"
color = "#7a2f22"
```

A pattern turns with its body, and is as large as the body asks for: a crate has as many rings of wood as a matchbox. In
numbers, it is made for a ball of radius 1, and on any body as large as on a ball of the same volume; on a plane it is as
large as the tiles of the ground. Two bodies of wood are cut from different places of the tree, by their names.
What shines by itself casts no shadow, so that a lamp inside a `luminous` ball lights the scene.

The picture is made by `docs/materials.sh`, and POV-Ray's words for each of these stand in
[templates/library/](../templates/library).
"##;

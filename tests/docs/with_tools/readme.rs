//! Tests that every scene, command and output of the README and of the pages that it links to is real. This command writes the real
//! outputs into the pages: `JABUKA_UPDATE_DOCS=1 cargo test --features tests-with-tools --test docs readme`.

use std::fs;

use crate::page::Page;
use crate::support;

#[test]
fn the_readme_is_real_and_short() {
    // Scripts in `docs/*.sh` make some of the pictures, so commands of the README need not make all of them.
    Page::check("README.md", &[]).check_pictures();
    let lines = fs::read_to_string(support::root().join("README.md")).unwrap().lines().count();
    assert!(lines <= 250, "{lines} lines: move some to docs/");
}

#[test]
fn the_page_of_scenes_is_real() {
    Page::check("docs/scenes.md", &[]).check_pictures();
}

#[test]
fn the_page_of_commands_is_real() {
    Page::check("docs/commands.md", &["README.md"]).check_pictures();
}

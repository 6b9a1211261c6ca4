//! Tests that every scene, command, output and picture of the tutorial is real. This command writes the real outputs and pictures:
//! `JABUKA_UPDATE_DOCS=1 cargo test --features tests-with-tools --test docs tutorial`.

use crate::page::Page;

#[test]
fn every_command_prints_and_draws_what_the_page_shows() {
    let others = Page::check("docs/tutorial.md", &[]).check_pictures();
    assert!(others.is_empty(), "pictures that no command of the page makes: {others:?}");
}

//! Every scene, command, output and picture of the tutorial is real. To see what it should say:
//! `JABUKA_UPDATE_DOCS=1 cargo test --features tests-with-tools --test docs tutorial` writes outputs and pictures.

use crate::page::Page;

#[test]
fn every_command_prints_and_draws_what_the_page_shows() {
    let others = Page::check("docs/tutorial.md", &[]).check_pictures();
    assert!(others.is_empty(), "pictures that no command of the page makes: {others:?}");
}

//! Every scene, command and output that the README shows is real. To see what it should say:
//! `JABUKA_UPDATE_DOCS=1 cargo test --test readme` writes the outputs into it.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test stops at the first surprise")]

#[path = "support/page.rs"]
mod page;
#[path = "support/mod.rs"]
mod support;

use page::Page;

#[test]
fn every_command_prints_what_the_page_shows() {
    // Not all of its pictures are made by its own commands: see `docs/*.sh`.
    Page::check("README.md").check_pictures();
}

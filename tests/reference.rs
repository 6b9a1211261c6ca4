//! The page of all keys is made from their description.

/// After a change of the keys: `JABUKA_UPDATE_DOCS=1 cargo test --test reference`.
#[test]
fn the_page_of_keys_is_up_to_date() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/scene-language.md");
    let page = jabuka::scene::grammar::reference();
    if std::env::var_os("JABUKA_UPDATE_DOCS").is_some() {
        std::fs::write(path, &page).expect("docs/ can be written to");
    }
    let written = std::fs::read_to_string(path).expect("docs/scene-language.md is there");
    assert!(page == written, "docs/scene-language.md is out of date: see the comment on this test");
}

//! The page in real browsers: all tests of `page.mjs` in Chromium, or in the browser that `JABUKA_BROWSER_NAME` names, and some in Firefox.

use crate::site::Site;
use crate::support::{compile, root, scene};

/// Declares tests of `page.mjs`, each with a server of its own. The first argument is the method of [`Site`] that runs them.
macro_rules! in_the_browser {
    ($shows:ident: $($test:ident),+ $(,)?) => {
        $(
            #[test]
            fn $test() {
                Site::served().$shows(stringify!($test), "");
            }
        )+
    };
}

in_the_browser!(shows:
    the_first_visit_shows_a_scene,
    an_edit_is_run_and_an_older_run_is_never_drawn_again,
    an_error_is_marked_at_its_place_and_mended_by_a_click,
    keys_are_completed_and_explained,
    keys_typed_in_the_editor_do_not_control_the_player,
    a_slider_changes_the_text_and_the_motion,
    sliders_on_one_line_do_not_write_into_each_other,
    a_link_holds_the_scene,
    damaged_and_hostile_links_are_refused,
    a_scene_that_takes_for_ever_gives_way_to_the_next,
    every_scene_of_the_shelf_opens,
    files_that_are_dropped_lie_beside_the_scene,
    an_address_chooses_the_parts_of_the_page,
    small_windows_show_all_of_it,
    accessibility_rules_hold,
);

/// The zip file has the scripts that the program writes.
#[test]
fn the_scripts_are_those_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    compile(&scene("hammer"), folder.path(), &[]);
    let site = Site::served();
    for shows in [Site::shows, Site::shows_in_firefox] {
        shows(&site, "the_zip_file_has_these_files", folder.path().to_str().unwrap());
    }
}

/// The test ends the server, which is a better test than a browser that pretends to be offline.
#[test]
fn it_works_without_a_network_after_the_first_visit() {
    for shows in [Site::shows, Site::shows_in_firefox] {
        let site = Site::served();
        shows(&site, "it_works_without_a_network_after_the_first_visit", &site.process());
    }
}

mod firefox {
    use super::Site;

    in_the_browser!(shows_in_firefox:
        the_first_visit_shows_a_scene,
        an_edit_is_run_and_an_older_run_is_never_drawn_again,
        an_error_is_marked_at_its_place_and_mended_by_a_click,
        a_slider_changes_the_text_and_the_motion,
        a_link_holds_the_scene,
        files_that_are_dropped_lie_beside_the_scene,
        small_windows_show_all_of_it,
        accessibility_rules_hold,
    );
}

/// Checks that every test in the script is listed here; otherwise it would never run.
#[test]
fn every_test_in_the_script_is_run() {
    let read = |name: &str| std::fs::read_to_string(root().join("tests/playground").join(name)).unwrap();
    let (script, tests) = (read("page.mjs"), read("page.rs"));
    let names = script.split("\n  async ").skip(1).map(|rest| rest.split('(').next().unwrap());
    let unknown: Vec<&str> = names.filter(|name| !tests.contains(name)).collect();
    assert_eq!(unknown, [""; 0]);
}

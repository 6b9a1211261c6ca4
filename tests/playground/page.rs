//! The page in real browsers: all tests of `page.mjs` in Chromium, or in the browser that `JABUKA_BROWSER_NAME` names, and some in Firefox.

use crate::site::Site;
use crate::support::{compile, jabuka, root, scene, stderr};

in_the_browser! { "page.mjs":
    the_first_visit_shows_a_scene,
    an_edit_is_run_and_an_older_run_is_never_drawn_again,
    an_error_is_marked_at_its_place_and_mended_by_a_click,
    warnings_are_folded_and_errors_are_not,
    twenty_faulty_scenes_are_mended_by_a_click_each,
    keys_are_completed_and_explained,
    keys_typed_in_the_editor_do_not_control_the_player,
    a_slider_changes_the_text_and_the_motion,
    a_number_follows_the_pointer_and_the_keys,
    sliders_on_one_line_do_not_write_into_each_other,
    bodies_are_moved_in_the_picture,
    velocities_are_pulled_and_keys_move_handles,
    formulas_are_not_moved_and_all_kinds_of_points_are,
    the_tutorial_goes_from_a_ball_to_a_link,
    the_trail_and_the_arrows_of_the_chosen_body_are_drawn,
    the_script_of_a_body_is_shown,
    a_link_holds_the_scene,
    damaged_and_hostile_links_are_refused,
    a_link_to_a_faulty_scene_opens_and_can_be_mended,
    an_edit_outlives_a_reload,
    a_scene_that_takes_for_ever_gives_way_to_the_next,
    every_scene_of_the_shelf_opens,
    files_that_are_dropped_lie_beside_the_scene,
    a_picture_has_the_chosen_size_and_its_labels,
    a_film_has_all_of_its_frames_in_order,
    a_film_can_be_stopped_and_the_page_goes_on,
    without_an_encoder_the_menu_says_so,
    an_address_chooses_the_parts_of_the_page,
    small_windows_show_all_of_it,
    accessibility_rules_hold,
}

/// The zip file has the scripts that the program writes.
#[test]
fn the_scripts_are_those_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    compile(&scene("hammer"), folder.path(), &[]);
    let site = Site::served();
    for shows in [Site::shows, Site::shows_in_firefox] {
        shows(&site, "page.mjs", "the_zip_file_has_these_files", folder.path().to_str().unwrap());
    }
}

/// The test ends the server, which is a better test than a browser that pretends to be offline.
#[test]
fn it_works_without_a_network_after_the_first_visit() {
    for shows in [Site::shows, Site::shows_in_firefox] {
        let site = Site::served();
        shows(&site, "page.mjs", "it_works_without_a_network_after_the_first_visit", &site.process());
    }
}

mod firefox {
    in_the_browser! { "page.mjs", shows_in_firefox:
        the_first_visit_shows_a_scene,
        an_edit_is_run_and_an_older_run_is_never_drawn_again,
        an_error_is_marked_at_its_place_and_mended_by_a_click,
        a_slider_changes_the_text_and_the_motion,
        a_link_holds_the_scene,
        files_that_are_dropped_lie_beside_the_scene,
        small_windows_show_all_of_it,
        accessibility_rules_hold,
    }
}

/// The model and the table are those that the program writes.
#[test]
fn the_model_and_the_table_are_those_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["hammer.glb", "hammer.csv"] {
        let file = folder.path().join(name);
        let output = jabuka().arg("export").arg(scene("hammer")).arg("-o").arg(file).output().unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
    }
    Site::served().shows(
        "page.mjs",
        "the_model_and_the_table_have_these_bytes",
        folder.path().to_str().unwrap(),
    );
}

/// Checks that every test in a script is listed in the file beside it; otherwise it would never run.
#[test]
fn every_test_in_a_script_is_run() {
    let read = |name: &str| std::fs::read_to_string(root().join("tests/playground").join(name)).unwrap();
    for name in ["page", "plots"] {
        let (script, tests) = (read(&format!("{name}.mjs")), read(&format!("{name}.rs")));
        let names = script.split("\n  async ").skip(1).map(|rest| rest.split('(').next().unwrap());
        let unknown: Vec<&str> = names.filter(|name| !tests.contains(name)).collect();
        assert_eq!(unknown, [""; 0]);
    }
}

/// The libraries of the page are committed as bundles, which their build makes from the versions that it names.
#[test]
fn the_libraries_are_those_that_their_build_makes() {
    let build = root().join("src/page/libraries/build");
    let made = std::process::Command::new(build).arg("--check").output().unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
}

//! Tests of the page: what is drawn, how the film is played, and that all controls can be reached.

use crate::server::{Scene, Server};
use crate::support;

fn parabola() -> Scene {
    Scene::gallery("parabola")
}

in_the_browser! { parabola(), "drawing.mjs":
    the_first_frame_is_drawn_by_itself,
    the_ball_is_red_the_sky_above_is_blue_and_the_ground_below_is_not,
    a_ball_that_has_moved_is_drawn_where_it_is_now,
    a_camera_of_ones_own_shows_another_picture_and_the_scenes_the_same_as_before,
}

in_the_browser! { parabola(), "player.mjs":
    the_space_key_goes_back_to_the_initial_state,
    the_reset_button_does_the_same,
    played_again_every_pose_is_what_it_was,
    keys_and_buttons_step_from_frame_to_frame,
    the_slider_scrubs_by_keyboard_and_by_mouse,
    a_click_in_the_plot_goes_to_that_time,
}

in_the_browser! { parabola(), "reach.mjs":
    all_controls_are_in_reach_on_a_phone,
    the_tab_key_reaches_all_controls_and_shows_where_it_is,
    keys_do_what_a_mouse_does,
}

/// The number of scenes that one browser draws, one after another. Their previews run at the same time.
const TOGETHER: usize = 8;

/// Draws a quarter of the gallery: every fourth scene in alphabetical order, from the one with the index `first` on. Four tests draw the whole
/// gallery, so that they can run at the same time.
fn is_drawn_without_a_complaint(first: usize) {
    let scenes = std::fs::read_dir(support::root().join("scenes")).unwrap().filter_map(|entry| {
        let name = entry.unwrap().file_name().into_string().unwrap();
        name.strip_suffix(".toml").map(str::to_owned)
    });
    let mut scenes: Vec<String> = scenes.collect();
    scenes.sort_unstable();
    assert!(scenes.len() > 15, "{scenes:?}");
    let quarter: Vec<String> = scenes.into_iter().skip(first).step_by(4).collect();
    for names in quarter.chunks(TOGETHER) {
        let served = |name: &String| {
            Scene::gallery(name).previewed_with(support::shorter(&support::scene(name))).served()
        };
        let servers: Vec<Server> = names.iter().map(served).collect();
        let addresses: Vec<&str> = servers.iter().map(|server| server.address.as_str()).collect();
        servers[0].shows_at(&addresses.join("\n"), "drawing.mjs", "is_drawn_without_a_complaint");
    }
}

#[test]
fn the_first_quarter_of_the_gallery_is_drawn_without_a_complaint() {
    is_drawn_without_a_complaint(0);
}

#[test]
fn the_second_quarter_of_the_gallery_is_drawn_without_a_complaint() {
    is_drawn_without_a_complaint(1);
}

#[test]
fn the_third_quarter_of_the_gallery_is_drawn_without_a_complaint() {
    is_drawn_without_a_complaint(2);
}

#[test]
fn the_last_quarter_of_the_gallery_is_drawn_without_a_complaint() {
    is_drawn_without_a_complaint(3);
}

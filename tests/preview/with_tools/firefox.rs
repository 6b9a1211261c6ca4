//! The tests of the page that run in Firefox, too: drawing, playing, and changes that are saved.

use crate::server::Scene;

/// Declares tests of a JavaScript file that preview the parabola.
macro_rules! in_firefox {
    ($script:literal: $($test:ident),+ $(,)?) => {
        $(
            #[test]
            fn $test() {
                Scene::gallery("parabola").served().shows_in_firefox($script, stringify!($test));
            }
        )+
    };
}

in_firefox! { "drawing.mjs":
    the_first_frame_is_drawn_by_itself,
    the_ball_is_red_the_sky_above_is_blue_and_the_ground_below_is_not,
    a_ball_that_has_moved_is_drawn_where_it_is_now,
    a_camera_of_ones_own_shows_another_picture_and_the_scenes_the_same_as_before,
}

in_firefox! { "player.mjs":
    the_space_key_goes_back_to_the_initial_state,
    keys_and_buttons_step_from_frame_to_frame,
    the_slider_scrubs_by_keyboard_and_by_mouse,
    a_click_in_the_plot_goes_to_that_time,
}

in_firefox! { "live.mjs":
    a_change_that_is_saved_is_shown_at_the_same_time_without_a_reload,
    a_mistake_is_shown_as_in_the_terminal_and_the_last_good_run_stays,
}

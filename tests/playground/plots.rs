//! The plots below the picture. The tests in a real browser are in `plots.mjs`, those of parts that need no page in `plot_units.mjs`.

use std::process::Command;

use crate::support::root;

in_the_browser! { "plots.mjs":
    both_axes_have_numbers_and_units_that_can_be_read,
    curves_have_names_at_their_ends_in_wide_windows_and_values_in_the_legend,
    a_click_and_a_drag_go_to_that_time,
    the_pointer_shows_values_and_leaves_nothing_behind,
    the_wheel_zooms_about_the_pointer_and_a_drag_with_shift_shifts,
    keys_zoom_the_plot_that_has_the_focus_and_move_the_time,
    values_are_told_when_they_are_asked_for,
    two_fingers_zoom,
    a_zoomed_plot_has_every_frame,
    a_path_and_a_phase_plot_are_of_the_chosen_body,
    two_runs_are_compared_and_subtracted,
    a_table_has_every_digit_of_what_is_shown,
    a_drawing_can_be_opened_anywhere,
    a_plot_can_be_enlarged_for_the_blackboard,
    a_run_of_one_frame_and_a_body_that_comes_later_are_plotted,
}

#[test]
fn parts_of_plots_that_need_no_page_do_what_they_should() {
    let script = root().join("tests/playground/plot_units.mjs");
    let output = Command::new("node").arg(script).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}

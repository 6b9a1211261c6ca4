//! Tests of the editor on the page, which writes into the file of the scene.

use crate::server::Scene;

const BALL: &str = "[simulation]\r\nduration = 1\r\n\r\n[variables]\r\nfast = { value = 1, min = 0, max = 3, step = 0.5 }\r\n\r\n\
    [body.ball]\r\nshape.sphere.radius = 0.5\r\nvelocity = ['fast', 0, 0]\r\n";

in_the_browser! { Scene::of(BALL), "editing.mjs":
    an_edit_is_written_into_the_file_and_run,
    an_error_is_mended_by_a_click_in_the_file,
    a_change_from_outside_is_shown_and_can_be_taken_back,
    a_file_that_changed_meanwhile_is_not_overwritten,
    a_text_is_kept_although_a_write_before_the_choice_comes_late,
    a_slider_writes_into_the_open_text,
    a_file_that_cannot_be_written_says_so,
    the_text_opens_by_a_key_and_breaks_no_rule,
}

in_the_browser! { Scene::of(BALL).previewed_with(&["--read-only"]), "editing.mjs":
    a_read_only_preview_has_no_editor,
}

in_the_browser! { Scene::of(&BALL.replace("velocity", "velosity")), "editing.mjs":
    a_scene_that_is_faulty_from_the_beginning_is_mended,
}

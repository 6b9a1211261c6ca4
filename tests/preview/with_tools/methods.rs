//! Tests of the page's choice of another integration method, in place of the scene's or next to it.

use crate::server::Scene;

/// A scene in which a ball falls so fast that different methods give visibly different results.
const FALL: &str = "
    [simulation]
    duration = 10
    integrator = 'euler-cromer'
    frame_rate = 25
    step = 0.04
    gravity = [0, -20, 0]
    [body.ball]
    shape.sphere.radius = 3
    [camera]
    location = [0, -1000, 100]
    look_at = [0, -1000, 0]
    ";

in_the_browser! { Scene::of(FALL), "methods.mjs":
    another_method_is_a_ghost_beside_the_scenes_with_its_distance,
}

in_the_browser! { Scene::gallery("parabola"), "methods.mjs":
    another_method_is_shown_in_place_of_the_scenes_and_the_file_stays,
    a_step_that_is_none_is_said_as_in_the_terminal_and_changes_nothing,
}

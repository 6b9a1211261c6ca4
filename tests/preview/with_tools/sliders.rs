//! Tests of the sliders of variables on the page.

use crate::server::Scene;

const THROW: &str = "
    [variables]
    fast = { value = 1, min = 0, max = 3, step = 0.5, unit = 'm/s' }
    back = { value = 0, min = 0, max = 1, step = 1 }
    [simulation]
    duration = 1
    [body.ball]
    shape.sphere.radius = 0.5
    velocity = ['fast * (1 - 2*back)', 0, 0]
    ";

in_the_browser! { Scene::of(THROW), "sliders.mjs":
    a_slider_runs_the_scene_again_and_the_file_stays,
}

in_the_browser! { Scene::gallery("parabola"), "sliders.mjs":
    without_sliders_there_is_no_place_for_them,
}

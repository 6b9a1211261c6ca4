//! Tests of the plots of a scene on the page.

use crate::server::Scene;

in_the_browser! { Scene::gallery("damped_oscillator"), "plots.mjs":
    the_plots_of_a_scene_are_drawn_as_far_as_time_has_come,
}

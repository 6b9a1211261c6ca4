//! Tests that the page follows changes of the scene's files when they are saved.

use std::fs;

use crate::server::Scene;

in_the_browser! { Scene::gallery("parabola"), "live.mjs":
    a_change_that_is_saved_is_shown_at_the_same_time_without_a_reload,
    a_scene_may_change_while_the_page_is_being_opened,
    two_pages_have_their_own_times_and_see_the_same_scene,
}

#[test]
fn a_mistake_is_shown_as_in_the_terminal_and_the_last_good_run_stays() {
    let server = Scene::gallery("parabola").served();
    let shown = server
        .shows("live.mjs", "a_mistake_is_shown_as_in_the_terminal_and_the_last_good_run_stays")
        .trim()
        .to_owned();
    // The terminal of the command shows the same messages, and each mistake only once.
    let said = server.said();
    for text in shown.split("\nerror").map(|text| text.trim_start_matches("error")) {
        assert_eq!(said.matches(text).count(), 1, "{text}\n… in …\n{said}");
    }
}

const BALL: &str = "[body.ball]\nshape.sphere.radius = 1\nvelocity = [1, 0, 0]\n";
const RING: &str = "include = ['parts/ball.toml']\nsimulation.duration = 2\n\
    [body.ring]\nshape.mesh = { file = 'meshes/twisted_ring.obj', scale = 0.001 }\nmass = 1\nlocation = [0, 4, 0]\n";

fn of_several_files() -> Scene {
    let ring = fs::read_to_string(crate::support::root().join("scenes/meshes/twisted_ring.obj")).unwrap();
    Scene::of(RING).with("parts/ball.toml", BALL).with("meshes/twisted_ring.obj", &ring)
}

in_the_browser! { Scene::of(BALL), "live.mjs":
    after_ten_scenes_that_are_shown_each_the_page_shows_the_last,
    after_ten_scenes_that_are_saved_at_once_the_page_shows_the_last,
}

in_the_browser! { of_several_files(), "live.mjs":
    files_that_a_scene_takes_in_count_as_well,
}

in_the_browser! { Scene::of("include = ['later.toml']\n"), "live.mjs":
    a_file_that_is_not_there_yet_is_waited_for,
}

in_the_browser! { Scene::of("[body.ball]\nshape.sphere.radius = -1\n"), "live.mjs":
    a_scene_with_errors_is_shown_once_they_are_mended,
}

/// A scene with a spring of 10,000 N/m, which is far too stiff for the explicit Euler method with steps of 0.02 s.
const STIFF: &str = "
    [simulation]
    duration = 30
    step = 0.02
    integrator = 'explicit-euler'
    [body.hook]
    shape.sphere.radius = 0.1
    fixed = true
    [body.ball]
    shape.sphere.radius = 0.1
    location = [0, -1, 0]
    [force.spring]
    spring.between = ['hook', 'ball']
    spring.stiffness = 10000
    spring.rest_length = 0.5
    ";

in_the_browser! { Scene::of(STIFF), "live.mjs":
    a_run_that_diverges_says_so,
}

#[test]
fn the_end_of_the_server_is_said() {
    let server = Scene::gallery("parabola").served();
    fs::write(server.scene.folder().join("process"), server.process().to_string()).unwrap();
    server.shows("live.mjs", "the_end_of_the_server_is_said");
}

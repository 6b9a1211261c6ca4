//! Tests of the viewer's own camera as a camera of the scene.

use crate::server::Scene;

const BALLS: &str = "
    simulation.duration = 0.2
    [body.near]
    shape.sphere.radius = 0.5
    [body.far]
    shape.sphere.radius = 0.5
    location = [2, 1, -3]
    [body.low]
    shape.sphere.radius = 0.3
    location = [-2, -1, 1]
    ";

in_the_browser! { Scene::of(BALLS), "camera.mjs":
    the_viewers_camera_becomes_that_of_the_scene,
}

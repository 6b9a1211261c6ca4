//! Tests of looks that follow values, on the page.

use crate::server::Scene;

/// A ball that leaves a trail, and one above it that leaves ghosts. The color of both follows their place.
const ALONG: &str = "
    simulation = { duration = 2, frame_rate = 10 }
    environment = 'blackboard'
    [defaults.body]
    shape.sphere.radius = 0.4
    velocity = [3, 0, 0]
    [defaults.body.material]
    finish = 'luminous'
    color.map = { of = 'x', palette = ['red', 'blue'], range = [-3, 3], bar = false }
    [body.ball]
    location = [-3, 0, 0]
    trail.width = 0.3
    [body.other]
    location = [-3, 1.5, 0]
    ghosts.every = 0.8
    [camera]
    location = [0, 0, 12]
    look_at = [0, 0, 0]
    ";

in_the_browser! { Scene::of(ALONG), "colors.mjs":
    bodies_trails_and_ghosts_have_the_colors_of_their_values,
}

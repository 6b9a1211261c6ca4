//! Tests of looks that follow values, on the page.

use crate::server::Scene;

/// One ball leaves a trail, and another one above it leaves ghosts. Trail and ghosts are red on the left and blue on the right.
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

/// Bodies before a white wall, whose looks follow the time: one becomes transparent, one begins to glow, one grows, and one is hidden after
/// 1 s.
const CHANGING: &str = "
    simulation = { duration = 2, frame_rate = 10 }
    environment = 'blackboard'
    light.weak = { sun.direction = [0, 0, -1], intensity = 0.1 }
    [defaults.body]
    shape.sphere.radius = 0.5
    fixed = true
    material = 'red'
    [material.red]
    color = 'red'
    finish = 'luminous'
    [body.wall]
    shape.box.size = [20, 20, 0.1]
    location = [0, 0, -3]
    material = { color = 'white', finish = 'luminous' }
    [body.veil]
    location = [-3, 0, 0]
    material = { color = 'red', finish = 'luminous', transparency.map = { of = 't', range = [0, 2] } }
    [body.lamp]
    material = { color = 'blue', finish = 'matte', glow.map = { of = 't', range = [0, 2] } }
    [body.grows]
    location = [3, 0, 0]
    look.scale.map = { of = 't', range = [0, 2], to = [1, 2] }
    [body.hides]
    location = [0, 2, 0]
    look.visible = 't < 1'
    [camera]
    location = [0, 0, 12]
    look_at = [0, 0, 0]
    ";

in_the_browser! { Scene::of(CHANGING), "colors.mjs":
    transparency_glow_size_and_visibility_follow_values,
}

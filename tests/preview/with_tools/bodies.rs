//! Tests that the page places bodies where the scripts place them.

use std::collections::BTreeMap;
use std::fs;

use serde::Deserialize;

use crate::server::Scene;
use crate::support::stderr;

in_the_browser! { Scene::gallery("parabola"), "bodies.mjs":
    a_click_on_a_body_shows_its_values_at_that_time,
    a_click_beside_all_bodies_chooses_none_and_names_can_be_typed,
}

/// A scene with two balls, of which one exists only from 1 s to 2 s. The camera looks from the front.
const COMING: &str = "
    simulation = { duration = 3, frame_rate = 4 }
    environment = 'blackboard'
    [body.stays]
    shape.sphere.radius = 1
    location = [-2, 0, 0]
    fixed = true
    material = { color = 'red', finish = 'luminous' }
    [body.comes]
    shape.sphere.radius = 1
    location = [2, 0, 0]
    velocity = [0, 1, 0]
    material = { color = 'red', finish = 'luminous' }
    trail = true
    start = 1
    end = 2
    [camera]
    location = [0, 0, 12]
    look_at = [0, 0, 0]
    ";

in_the_browser! { Scene::of(COMING), "bodies.mjs":
    a_body_is_seen_while_it_is_there,
}

/// A crate with a ball on it, at rest on the ground. A force pulls the crate, which friction holds.
const CRATE_AT_REST: &str = "
    simulation = { duration = 1, gravity = [0, -10, 0], contacts = 'event-driven' }
    [body.crate]
    shape.box.size = [1, 1, 1]
    mass = 8
    location = [0, 0.5, 0]
    material = 'wood'
    [body.ball]
    shape.sphere.radius = 0.3
    mass = 2
    location = [0, 1.3, 0]
    [force.pull.constant]
    force = [10, 0, 0]
    on = ['crate']
    [camera]
    location = [0, 1, 3]
    look_at = [0, 0.8, 0]
    ";

in_the_browser! { Scene::of(CRATE_AT_REST), "bodies.mjs":
    contacts_are_shown_with_their_forces,
}

/// A scene with a particle that exists from 1 s to 2 s and moves up. The camera looks from the front.
const PARTICLE: &str = "
    simulation = { duration = 3, frame_rate = 4 }
    environment = 'blackboard'
    [body.stays]
    shape.sphere.radius = 1
    location = [-2, 0, 0]
    fixed = true
    material = { color = 'red', finish = 'luminous' }
    [emitter.one]
    shape.sphere.radius = 1
    from.point = [2, 0, 0]
    burst = 1
    start = 0.9
    lifetime = 1.2
    speed = 1
    color = 'red'
    glow = 1
    [camera]
    location = [0, 0, 12]
    look_at = [0, 0, 0]
    ";

in_the_browser! { Scene::of(PARTICLE), "bodies.mjs":
    a_particle_is_seen_while_it_lives,
}

/// The names of the bodies and their poses in each frame, as the page holds them.
#[derive(Deserialize)]
struct Held {
    names: Vec<String>,
    frames: Vec<Vec<Pose>>,
}

#[derive(Deserialize)]
struct Pose {
    location: [f64; 3],
    orientation: [f64; 4],
}

/// The place of a body in a script: its location, and the images of its unit vectors if the script contains them, in units of the script.
#[derive(Debug)]
struct Put {
    location: [f64; 3],
    axes: Option<[[f64; 3]; 3]>,
}

/// Returns the numbers in the first `<…>` after a word.
fn numbers(line: &str, word: &str) -> Option<Vec<f64>> {
    let (_, rest) = line.split_once(word)?;
    let (list, _) = rest.split_once('>')?;
    list.trim_start_matches([' ', '<']).split(',').map(|number| number.trim().parse().ok()).collect()
}

/// Returns the place of each body in a script, found by the comments with the bodies' names.
fn put(script: &str) -> BTreeMap<&str, Put> {
    let three = |numbers: &[f64]| [numbers[0], numbers[1], numbers[2]];
    let of_line = |line: &str| {
        if let Some(n) = numbers(line, "matrix <") {
            let axes = [three(&n[0..3]), three(&n[3..6]), three(&n[6..9])];
            return Some(Put { location: three(&n[9..12]), axes: Some(axes) });
        }
        let n = numbers(line, "translate <").or_else(|| numbers(line, "sphere { <"))?;
        Some(Put { location: three(&n), axes: None })
    };
    script
        .lines()
        .filter_map(|line| line.rsplit_once(" // ").and_then(|(line, name)| Some((name, of_line(line)?))))
        .collect()
}

/// Returns the length of a script's unit in meters, from the comment at its top.
fn unit(script: &str) -> f64 {
    let said = script.lines().find_map(|line| line.split_once("one unit is ")?.1.strip_suffix(" m"));
    said.unwrap().parse().unwrap()
}

/// Returns a vector rotated by the quaternion x y z w.
fn turned([x, y, z, w]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    glam::DQuat::from_xyzw(x, y, z, w).mul_vec3(v.into()).to_array()
}

/// Asserts that the page and the scripts of a scene of the gallery place all bodies equally.
fn assert_same_poses(name: &str) {
    let server = Scene::gallery(name).served();
    let held: Held = serde_json::from_str(&server.shows("bodies.mjs", "poses")).unwrap();
    let output =
        server.scene.jabuka(&["compile", "-o", "compiled"]).arg(server.scene.path()).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let (mut seen, mut matrices) = (0, 0);
    for (frame, poses) in held.frames.iter().enumerate() {
        let digits = (held.frames.len() - 1).to_string().len().max(4);
        let path = server.scene.folder().join(format!("compiled/frame_{frame:0digits$}.pov"));
        let script = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let (put, unit) = (put(&script), unit(&script));
        // If the script's unit is not the meter, the nine digits of a number are relative to the size of the scene.
        let size = if unit == 1.0 {
            1.0
        } else {
            put.values().flat_map(|put| put.location).fold(1.0, |most: f64, c| most.max(c.abs()))
        };
        for (body, pose) in held.names.iter().zip(poses) {
            let Some(put) = put.get(body.as_str()) else { continue };
            seen += 1;
            let close = |a: f64, b: f64, size: f64| {
                assert!((a - b).abs() <= 1e-6 * size.max(1.0), "{name}, frame {frame}, {body}: {a} {b}");
            };
            for (there, here) in put.location.into_iter().zip(pose.location) {
                close(there, here / unit, size);
            }
            let Some(axes) = put.axes else { continue };
            matrices += 1;
            for (n, axis) in axes.into_iter().enumerate() {
                // A body that is drawn larger than it is has longer axis vectors in the script.
                let long = glam::DVec3::from(axis).length();
                let mut along = [0.0; 3];
                along[n] = long;
                axis.into_iter()
                    .zip(turned(pose.orientation, along))
                    .for_each(|(there, here)| close(there, here, long));
            }
        }
    }
    assert!(matrices > 0, "{name}: nothing says how it is turned");
    assert!(seen >= held.frames.len() * (held.names.len() / 2).max(1), "{name}: {seen}");
}

#[test]
fn a_ball_is_where_the_scripts_put_it() {
    assert_same_poses("parabola");
}

#[test]
fn what_turns_is_where_the_scripts_put_it() {
    assert_same_poses("tumbling_box");
    assert_same_poses("wing_nut");
    assert_same_poses("mesh");
}

#[test]
fn the_very_small_and_the_very_large_are_where_the_scripts_put_them() {
    assert_same_poses("atom");
    assert_same_poses("planets");
}

//! Tests that need no program that reads glTF. Tests with such programs are in `tests/output/with_tools/gltf.rs`.

use glam::DQuat;
use serde_json::Value;

use super::container::{MAX_FILE_SIZE, write};
use super::document_builder::document;
use super::motion::{SampledMotion, SizeBudget};
use super::*;
use crate::scene::Scene;

const SCENE: &str = "
    title = 'Two balls'
    [simulation]
    duration = 4
    frame_rate = 10
    [body.wheel]
    shape.cylinder = { radius = 1, height = 0.5 }
    angular_velocity = [0, 0, 5]
    [body.ball]
    shape.sphere.radius = 1
    location = [3, 0, 0]
    velocity = [1, 0, 0]
    [body.stone]
    shape.sphere.radius = 2
    location = [9, 0, 0]
    fixed = true
    ";

fn scene(text: &str) -> Scene {
    Scene::parse(text).unwrap()
}

fn file(scene: &Scene, frames: &str) -> Vec<u8> {
    let mut out = Vec::new();
    let exported = write_glb(&Recorded::new(scene).unwrap(), &frames.parse().unwrap(), &mut out).unwrap();
    assert_eq!(exported.bytes, out.len() as u64);
    out
}

fn number(bytes: &[u8], at: usize) -> usize {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

/// Returns the JSON chunk of a file, and checks all lengths in the file.
fn json(file: &[u8]) -> Value {
    assert_eq!((&file[..4], number(file, 4), number(file, 8)), (&b"glTF"[..], 2, file.len()));
    let length = number(file, 12);
    assert_eq!((length % 4, &file[16..20]), (0, &b"JSON"[..]));
    let json: Value = serde_json::from_slice(&file[20..20 + length]).unwrap();
    let binary = number(file, 20 + length);
    assert_eq!((binary % 4, &file[24 + length..28 + length]), (0, &b"BIN\0"[..]));
    assert_eq!(28 + length + binary, file.len());
    assert_eq!(json["buffers"][0]["byteLength"], binary);
    json
}

#[test]
fn only_what_moves_has_channels_and_only_for_how_it_moves() {
    let json = json(&file(&scene(SCENE), "0-40"));
    let nodes = json["nodes"].as_array().unwrap();
    let channels = json["animations"][0]["channels"].as_array().unwrap();
    let channels = channels.iter().map(|channel| {
        let node = channel["target"]["node"].as_u64().unwrap() as usize;
        (nodes[node]["name"].as_str().unwrap(), channel["target"]["path"].as_str().unwrap())
    });
    assert_eq!(channels.collect::<Vec<_>>(), [("wheel", "rotation"), ("ball", "translation")]);
    assert_eq!(json["asset"]["extras"]["title"], "Two balls");
}

#[test]
fn balls_share_their_triangles() {
    let json = json(&file(&scene(SCENE), "0"));
    let meshes = json["meshes"].as_array().unwrap().iter();
    let balls: Vec<_> = meshes.filter(|mesh| mesh["name"].as_str().unwrap().starts_with("ball")).collect();
    assert_eq!(balls.len(), 2, "of two colors");
    let positions = |mesh: &Value| mesh["primitives"][0]["attributes"]["POSITION"].clone();
    assert_eq!(positions(balls[0]), positions(balls[1]));
    assert!(json.get("animations").is_none(), "a single frame does not move");
}

/// The quaternions q and −q are the same orientation. If the sign changed between two keyframes, viewers would turn the wheel back all the
/// way.
#[test]
fn orientations_go_on_with_the_nearer_sign() {
    let motion = SampledMotion::of(&Recorded::new(&scene(SCENE)).unwrap(), &Selection::first(41)).unwrap();
    let keys = motion.ways()[0].rotations.chunks_exact(4);
    let keys: Vec<_> = keys.map(|key| DQuat::from_array([0, 1, 2, 3].map(|i| f64::from(key[i])))).collect();
    assert_eq!(keys.len(), 41);
    assert!(keys.iter().any(|key| key.w < 0.0), "it turns more than once");
    assert!(keys.windows(2).all(|pair| pair[0].dot(pair[1]) > 0.9));
}

#[test]
fn the_same_scene_is_the_same_bytes() {
    assert_eq!(file(&scene(SCENE), "0-40"), file(&scene(SCENE), "0-40"));
}

#[test]
fn a_scene_without_bodies_is_a_file() {
    let empty = "environment.ground = false\nsimulation.duration = 1\n";
    let mut out = Vec::new();
    write_glb(&Recorded::new(&scene(empty)).unwrap(), &Selection::first(2), &mut out).unwrap();
    assert_eq!(number(&out, 8), out.len());
    assert_eq!(20 + number(&out, 12), out.len(), "there are no numbers");
}

#[test]
fn what_is_too_large_is_refused_before_anything_is_written() {
    let scene = scene(SCENE);
    let frames = Selection::first(2);
    let mut motion = SampledMotion::of(&Recorded::new(&scene).unwrap(), &frames).unwrap();
    let sight = CamerasAndLights::of(&Recorded::new(&scene).unwrap(), &frames, &mut motion).unwrap();
    let (mut document, geometry) = document(&scene, sight, &[], &motion);
    document.buffers[0].byte_length = MAX_FILE_SIZE - 8;
    let mut out = Vec::new();
    let refused = write(&document, &geometry, &motion, &mut out);
    assert!(matches!(refused, Err(ExportError::TooLarge(_))) && out.is_empty());

    // A thousand bodies in a thousand frames take 28 MB. Two hundred bodies in a million frames take too much.
    let mut budget = SizeBudget::default();
    assert!(budget.take(7 * 1_000 * 1_000).is_ok());
    assert!(matches!(budget.take(7 * 200 * 1_000_000), Err(ExportError::TooLarge(5_628_000_000))));
}

#[test]
fn what_no_film_can_show_is_shown_as_one_can() {
    let slow = "
        simulation = { duration = 1e9, frame_rate = 1e-8, step = 1e7 }
        body.b.shape.sphere.radius = 1
        ";
    let exported =
        write_glb(&Recorded::new(&scene(slow)).unwrap(), &Selection::first(11), Vec::new()).unwrap();
    assert!((exported.faster / 2.5e9 - 1.0).abs() < 1e-12);
    let motion = SampledMotion::of(&Recorded::new(&scene(slow)).unwrap(), &Selection::first(11)).unwrap();
    assert_eq!(motion.times().last(), Some(&0.4));
}

#[test]
fn a_camera_beyond_the_numbers_is_an_error() {
    let far = format!("camera.location = [0, 0, 1e39]\n{SCENE}");
    let refused = write_glb(&Recorded::new(&scene(&far)).unwrap(), &Selection::first(2), Vec::new());
    let Err(ExportError::OutOfRange { what, .. }) = refused else { panic!("it is written") };
    assert_eq!(what, "camera");
}

/// glTF cannot animate the angle of view, and allows only angles below 180 degrees.
#[test]
fn an_angle_is_that_of_the_first_of_the_frames_and_less_than_half_a_turn() {
    for (angle, frames, degrees) in
        [("'60 + 10*t'", "0-40", 60.0), ("'60 + 10*t'", "20-30", 80.0), ("'120 + 60*t'", "20,30", 179.9)]
    {
        let text = format!("camera.angle = {angle}\noutput.size = [100, 100]\n{SCENE}");
        let json = json(&file(&scene(&text), frames));
        let perspective = &json["cameras"][0]["perspective"];
        let yfov = perspective["yfov"].as_f64().unwrap().to_degrees();
        assert!((yfov - degrees).abs() < 1e-9, "{angle}: {perspective}");
    }
}

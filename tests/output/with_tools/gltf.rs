//! Tests of `jabuka export SCENE -o FILE.glb`: models are checked by the Khronos glTF validator and loaded by three.js.

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::{jabuka, root, shorter, stderr, stdout};
use glam::{DQuat, DVec3};
use jabuka::Scene;
use jabuka::export::{write_csv, write_glb};
use jabuka::physics::Shape;
use jabuka::picture::{Form, FormKind, Lamp, Plan};
use jabuka::scene::{Options, Override};
use jabuka::simulate::{Frame, Frames, Recorded, Selection, survey};
use serde::Deserialize;

/// The contents of a model file, as `look.mjs` reports them after loading it with three.js.
#[derive(Deserialize)]
struct Seen {
    errors: u32,
    warnings: u32,
    messages: serde_json::Value,
    triangles: u32,
    times: Vec<f64>,
    bodies: Vec<SeenBody>,
    cameras: Vec<SeenCamera>,
    lights: Vec<SeenLight>,
}

#[derive(Deserialize)]
struct SeenCamera {
    name: String,
    near: f64,
    far: f64,
    /// The position of each body in the picture, one list for each time.
    spots: Vec<Vec<[f64; 2]>>,
}

#[derive(Deserialize)]
struct SeenLight {
    name: String,
    #[serde(rename = "type")]
    kind: String,
    color: [f64; 3],
    intensity: f64,
    places: Vec<[f64; 3]>,
    toward: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct SeenBody {
    name: String,
    /// The lower and upper corner of the body's bounding box at the first time, m, world axes.
    #[serde(rename = "box")]
    bounds: [[f64; 3]; 2],
    poses: Vec<[f64; 7]>,
    /// The scale of the body at each time, and just before each time but the first.
    sizes: Vec<f64>,
}

/// Loads model files with `look.mjs`, and asserts that the validator reports no errors or warnings.
fn look(files: &[PathBuf]) -> Vec<Seen> {
    let output = Command::new(root().join("tests/output/with_tools/gltf/look")).args(files).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let seen: Vec<Seen> = stdout(&output).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(seen.len(), files.len());
    for (file, seen) in files.iter().zip(&seen) {
        assert_eq!((seen.errors, seen.warnings), (0, 0), "{}: {}", file.display(), seen.messages);
    }
    seen
}

fn export(scene: &Path, file: &Path, arguments: &[&str]) -> String {
    let output = jabuka().arg("export").arg(scene).arg("-o").arg(file).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    stdout(&output)
}

/// One frame of an exported table: its time, and the name, location and orientation of each body.
type Rows = (f64, Vec<(String, DVec3, DQuat)>);

fn table(file: &Path) -> Vec<Rows> {
    let rows = csv::Reader::from_path(file).unwrap().into_records();
    let rows: Vec<csv::StringRecord> = rows.map(Result::unwrap).collect();
    let body = |row: &csv::StringRecord| {
        let number = |i: usize| row[i].parse::<f64>().unwrap();
        let location = DVec3::new(number(2), number(3), number(4));
        (row[1].to_owned(), location, DQuat::from_xyzw(number(5), number(6), number(7), number(8)))
    };
    let frames = rows.chunk_by(|one, next| one[0] == next[0]);
    frames.map(|rows| (rows[0][0].parse().unwrap(), rows.iter().map(body).collect())).collect()
}

/// Asserts that the bodies of a model are where the table says, to the accuracy of `f32`.
fn assert_same_motion(name: &str, seen: &Seen, table: &[Rows]) {
    // A model without motion has only one time.
    assert!(seen.times.len() == table.len() || seen.times == [0.0], "{name}");
    let end = seen.times.len() - 1;
    let faster = if end == 0 { 1.0 } else { table[end].0 / seen.times[end] };
    for (i, &shown) in seen.times.iter().enumerate() {
        let (time, bodies) = &table[i];
        assert!(seen.bodies.len() >= bodies.len() && !bodies.is_empty(), "{name}");
        assert!((shown * faster - time).abs() <= 3e-7 * time, "{name}: {shown} for {time}");
        let mut places = seen.bodies.iter();
        for (known, location, orientation) in bodies {
            // Both lists follow the order of the scene; a body that does not exist in a frame has no row in the table.
            let body = places.find(|body| body.name == *known).unwrap();
            let [x, y, z, ref turn @ ..] = body.poses[i];
            let off = (DVec3::new(x, y, z) - location).length();
            assert!(off <= 1.2e-7 * location.length(), "{name}, {known} at {time} s: {off} m");
            let turn = orientation.conjugate() * DQuat::from_array(*turn);
            let off = 2.0 * DVec3::new(turn.x, turn.y, turn.z).length();
            assert!(off < 1e-6, "{name}, {known} at {time} s: {off} rad");
        }
    }
}

/// Asserts that the triangles of each body have the same extent as its shape.
fn assert_same_extent(name: &str, seen: &Seen, scene: &Scene) {
    let first = Frames::new(scene).next().unwrap().unwrap();
    // Only bodies that exist at the beginning can be compared.
    for place in &first.bodies {
        let (body, drawn) = (&seen.bodies[place.id], &scene.bodies[place.id]);
        let shape = drawn.drawn();
        let Some(size) = shape.bounding_radius() else { continue };
        // Curves are drawn with chords of 7.5° and 15°. Along the whole length of an axes triad, the dynamics uses the thickness of the
        // arrow heads.
        let tolerance = if matches!(shape, Shape::Axes { .. }) { 0.1 } else { 0.02 };
        for (axis, direction) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
            for (end, sign) in [(1, 1.0), (0, -1.0)] {
                let reach = shape.support(place.orientation, sign * direction).unwrap();
                let found = sign * (body.bounds[end][axis] - place.location[axis]);
                let most = tolerance * size + 1e-6 * place.location.length();
                assert!((found - reach).abs() <= most, "{name}, {}: {found} for {reach}", body.name);
            }
        }
    }
}

/// Asserts that the model's cameras show each body at the same place as the pictures do. Returns the number of compared places.
fn assert_same_picture(name: &str, seen: &Seen, scene: &Scene, frames: &[Frame]) -> usize {
    let survey = survey(scene, |_| {}).unwrap();
    let views = scene.views.iter().map(|view| (format!("camera {}", view.name), &view.camera));
    let cameras: Vec<_> = std::iter::once(("camera".to_owned(), &scene.camera)).chain(views).collect();
    assert_eq!(seen.cameras.len(), cameras.len(), "{name}");
    let aspect = f64::from(scene.output.width) / f64::from(scene.output.height);
    let mut compared = 0;
    for (found, (known, camera)) in seen.cameras.iter().zip(cameras) {
        assert_eq!(found.name, known, "{name}");
        let plan = Plan::new(scene, camera, &survey);
        let lens = plan.camera(&frames[0]).lens();
        for (frame, spots) in frames.iter().zip(&found.spots) {
            let placed = plan.camera(frame);
            // A model's camera keeps its first angle of view, so frames with another angle are skipped.
            if placed.lens() != lens {
                continue;
            }
            for body in &frame.bodies {
                let Some([x, y]) = spots.get(body.id) else { continue };
                let Some(spot) = placed.screen().project(body.location) else { continue };
                let (of_x, of_y) = (spot.x, spot.y * aspect);
                if of_x.abs().max(of_y.abs()) > 1.5 {
                    continue;
                }
                // The model stores locations as `f32`.
                let far = body.location.length().max(placed.location().length());
                let most = 1e-5 + 2e-7 * far * spot.scale * aspect;
                let off = (of_x - x).abs().max((of_y - y).abs());
                assert!(off < most, "{name}, {known} at {} s: {spot:?}, seen at {x} {y}", frame.time);
                let depth =
                    (placed.look_at() - placed.location()).normalize().dot(body.location - placed.location());
                let within = (found.near..found.far).contains(&depth);
                assert!(within, "{name}, {known}: {depth} not in {}..{}", found.near, found.far);
                compared += 1;
            }
        }
    }
    compared
}

/// Asserts that a model has the same lights as the picture, with the same brightness at the center of the scene.
fn assert_same_lights(name: &str, seen: &Seen, scene: &Scene, frames: &[Frame]) {
    let plan = Plan::new(scene, &scene.camera, &survey(scene, |_| {}).unwrap());
    let stage = plan.stage();
    let at = |frame: &Frame| Some(plan.lights(frame)).filter(|lights| !lights.is_empty());
    let at = |frame: &Frame| at(frame).unwrap_or_else(|| plan.usual_lights());
    assert_eq!(seen.lights.len(), at(&frames[0]).len(), "{name}");
    for (frame, i) in frames.iter().zip(0..seen.times.len()) {
        for (found, light) in seen.lights.iter().zip(at(frame)) {
            let off = DVec3::from_array(found.places[i]).distance(light.location);
            assert!(off <= 1.2e-7 * light.location.length(), "{name}, {}: {off} m off", light.name);
        }
    }
    for (found, light) in seen.lights.iter().zip(at(&frames[0])) {
        assert_eq!(found.name, format!("light {}", light.name), "{name}");
        let distance = light.location.distance(stage.center).max(stage.size / 2.0);
        let sun = light.kind == Lamp::Sun;
        let (kind, fades) = if sun { ("DirectionalLight", 1.0) } else { ("PointLight", distance * distance) };
        assert_eq!(found.kind, kind, "{name}");
        let here = DVec3::from_array(found.color) * found.intensity / (std::f64::consts::PI * fades);
        assert!(here.abs_diff_eq(light.color.into(), 1e-9), "{name}, {}: {here}", light.name);
        let toward = (stage.center - light.location).normalize();
        let same = |found: [f64; 3]| DVec3::from_array(found).abs_diff_eq(toward, 1e-6);
        assert!(found.toward.map_or(!sun, same), "{name}, {}: {:?}", light.name, found.toward);
    }
}

/// A scene, with its frames and the model file that was made of its run.
struct Exported {
    scene: Scene,
    frames: Vec<Frame>,
    model: PathBuf,
}

/// Simulates a scene once, and writes a model and a table of the run.
fn exported(path: &Path, folder: &Path) -> Exported {
    let overrides = shorter(path).iter().skip(1).step_by(2).map(|setting| Override::new(*setting)).collect();
    let scene = Scene::from_path_with(path, &Options { overrides, ..Options::default() }).unwrap();
    let model = folder.join(path.file_name().unwrap()).with_extension("glb");
    let run = Recorded::new(&scene).unwrap();
    let all = Selection::first(scene.simulation.timeline.frames());
    write_glb(&run, &all, BufWriter::new(File::create(&model).unwrap())).unwrap();
    write_csv(&run, &all, File::create(model.with_extension("csv")).unwrap()).unwrap();
    let frames = run.frames().map(Result::unwrap).collect();
    Exported { scene, frames, model }
}

/// Exports scenes as models and as tables, and compares each model with its table and its scene.
fn check(scenes: &[PathBuf], folder: &Path) {
    let exported: Vec<Exported> = scenes.iter().map(|path| exported(path, folder)).collect();
    let files: Vec<PathBuf> = exported.iter().map(|one| one.model.clone()).collect();
    for (Exported { scene, frames, model }, seen) in exported.iter().zip(look(&files)) {
        let name = model.file_stem().unwrap().to_str().unwrap();
        assert_same_motion(name, &seen, &table(&model.with_extension("csv")));
        let spots = assert_same_picture(name, &seen, scene, frames);
        assert!(spots > 0, "{name}: something is seen");
        assert_same_lights(name, &seen, scene, frames);
        // In scenes with many bodies, each body has fewer triangles, so its extent is less accurate.
        if scene.bodies.len() < 50 {
            assert_same_extent(name, &seen, scene);
        }
    }
}

/// Checks every second scene of the gallery, in alphabetical order, from the one with the index `first` on. Two tests check the whole gallery,
/// so that they can run at the same time.
fn are_valid_and_move_as_their_tables_say(first: usize) {
    let folder = tempfile::tempdir().unwrap();
    let scenes = fs::read_dir(root().join("scenes")).unwrap().map(|entry| entry.unwrap().path());
    let mut scenes: Vec<PathBuf> =
        scenes.filter(|path| path.extension().is_some_and(|ending| ending == "toml")).collect();
    scenes.sort();
    assert!(scenes.len() >= 15);
    let half: Vec<PathBuf> = scenes.into_iter().skip(first).step_by(2).collect();
    check(&half, folder.path());
}

#[test]
fn the_first_half_of_the_gallery_is_valid_and_moves_as_its_tables_say() {
    are_valid_and_move_as_their_tables_say(0);
}

#[test]
fn the_second_half_of_the_gallery_is_valid_and_moves_as_its_tables_say() {
    are_valid_and_move_as_their_tables_say(1);
}

/// A scene with features that the gallery lacks: a tilted plane, compounds, patterns, materials of all kinds, and a body drawn larger than
/// it is.
const ODD: &str = r##"
    simulation.duration = 1
    [material.words]
    sdl = 'pigment { color rgb 1 }'
    [body.slope]
    shape.plane.normal = [1, 2, -0.5]
    location = [0, -3, 0]
    [body."a, b"]
    shape.sphere.radius = 1
    material = 'glass'
    look.scale = 2
    velocity = [1, 0, 0]
    [body.same]
    shape.sphere.radius = 0.5
    location = [4, 0, 0]
    material = 'words'
    angular_velocity = [0, 1, 0]
    [body.lamp]
    shape.capsule = { radius = 0.2, height = 1 }
    location = [0, 4, 0]
    material = 'neon'
    [body.crate]
    shape.box.size = [1, 2, 1.5]
    location = [-4, 4, 5]
    material = 'checkered'
    [body.beach]
    shape.sphere.radius = 1
    location = [-4, 0, 5]
    material = 'beach_ball'
    angular_velocity = [1, 2, 3]
    [body.triad]
    shape.axes.length = 2
    location = [0, 4, 5]
    angular_velocity = [0, 5, 1]
    [body.top]
    location = [0, 0, 5]
    orientation = { axis = [1, 0, 0], angle = 30 }
    angular_velocity = [0, 9, 1]
    [[body.top.shape.compound.parts]]
    cone = { radius = 0.5, height = 1 }
    [[body.top.shape.compound.parts]]
    torus = { radius = 0.4, tube_radius = 0.1 }
    location = [0, 0.4, 0]
    orientation = [0, 0, 20]
    "##;

/// A scene with cameras that stand still, look straight down or up, or move, and with lights of all kinds.
const VIEWS: &str = "
    simulation = { duration = 2, gravity = [0, -9.81, 0] }
    output.size = [300, 400]
    [body.ball]
    shape.sphere.radius = 0.3
    velocity = [3, 9, 0]
    [body.post]
    shape.box.size = [1, 1, 1]
    location = [2, 1, -1]
    fixed = true
    [camera]
    follow = { body = 'ball', distance = 6, lag = 0.3 }
    [view.down]
    location = [2, 12, 0]
    look_at = [2, 0, 0]
    [view.up]
    location = [2, -9, 0]
    look_at = [2, 1, 0]
    [view.flat]
    projection = 'orthographic'
    location = [9, 4, 8]
    look_at = [2, 1, 0]
    [view.wide]
    angle = 150
    location = [3, 3, 7]
    look_at = [2, 1, 0]
    [view.round]
    location = [3, 3, 14]
    look_at = [2, 1, 0]
    orbit.period = 1
    [view.zoom]
    angle = '60 - 20*t'
    location = ['3 + t', 3, 14]
    look_at = [2, 1, 0]
    [light.lamp]
    point.location = ['5*cos(3*t)', 6, '5*sin(3*t)']
    color = 'orange'
    intensity = 1.4
    [light.soft]
    area = { location = [-9, 8, 9], size = 2 }
    [light.day]
    sun.direction = [1, -2, -0.5]
    [light.noon]
    sun.direction = [0, -1, 0]
    intensity = 0
    ";

#[test]
fn cameras_see_and_lights_shine_as_in_the_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("views.toml");
    fs::write(&path, VIEWS).unwrap();
    check(std::slice::from_ref(&path), folder.path());

    // Selected frames look as in the full run, including traces of the time before them.
    let file = folder.path().join("some.glb");
    export(&path, &file, &["--frames", "30-40"]);
    let scene = Scene::from_path(&path).unwrap();
    let frames: Vec<Frame> = Frames::new(&scene).map(Result::unwrap).skip(30).take(11).collect();
    let seen = look(&[file]).remove(0);
    assert!(assert_same_picture("some", &seen, &scene, &frames) > 11 * 5);
    assert_eq!(seen.times.len(), 11);
}

const COMING: &str = "
    simulation = { duration = 1, frame_rate = 10 }
    [defaults.body]
    shape.sphere.radius = 0.5
    velocity = [1, 0, 0]
    [body.always]
    [body.born]
    location = [0, 2, 0]
    start = 0.25
    [body.dies]
    location = [0, 4, 0]
    end = 0.5
    [body.never]
    start = 9
    [body.still]
    shape.compound.parts = [{ sphere.radius = 0.2 }, { sphere.radius = 0.3, location = [1, 0, 0] }]
    fixed = true
    velocity = [0, 0, 0]
    start = 0.1
    end = 0.4
    ";

/// Checks that an absent body has size 0, exactly from the time of its end to the time of its next start.
#[test]
fn bodies_that_come_and_go_are_hidden_while_they_are_away() {
    let folder = tempfile::tempdir().unwrap();
    let [path, file] = ["coming.toml", "coming.glb"].map(|name| folder.path().join(name));
    fs::write(&path, COMING).unwrap();
    export(&path, &file, &[]);
    let seen = look(&[file]).remove(0);
    let scene = Scene::from_path(&path).unwrap();
    let frames: Vec<Frame> = Frames::new(&scene).map(Result::unwrap).collect();
    // The entries after the bodies are the ground and other parts of the scene.
    for (id, body) in seen.bodies.iter().take(scene.bodies.len()).enumerate() {
        assert_eq!(body.sizes.len(), 2 * frames.len() - 1);
        for (i, frame) in frames.iter().enumerate() {
            let at = frame.body(id);
            // A body keeps its size until the next frame.
            let size = if at.is_some() { 1.0 } else { 0.0 };
            let until_next =
                body.sizes.get(2 * i + 1).is_none_or(|next| (next - size).abs() < 1e-6 || id == 0);
            let is_at = (body.sizes[2 * i] - size).abs() < 1e-6 || id == 0;
            assert!(is_at && until_next, "{} in frame {i}: {:?}", body.name, body.sizes);
            if let Some(at) = at {
                let [x, y, z, ..] = body.poses[i];
                assert!(DVec3::new(x, y, z).abs_diff_eq(at.location, 1e-6), "{} in frame {i}", body.name);
            }
        }
    }
    assert_eq!(seen.bodies[3].sizes[0], 0.0);
}

const EMPTY: &str = "environment.ground = false";

const FAR: &str = "
    [body.ball]
    shape.sphere.radius = 1e3
    location = [1e12, 0, 0]
    velocity = [0, 1e9, 0]
    ";

#[test]
fn odd_scenes_are_valid_too() {
    let folder = tempfile::tempdir().unwrap();
    let [odd, empty, far] = [("odd", ODD), ("empty", EMPTY), ("far", FAR)].map(|(name, text)| {
        let path = folder.path().join(name).with_extension("toml");
        fs::write(&path, text).unwrap();
        path
    });
    check(&[odd], folder.path());
    let files = [&empty, &far].map(|scene| scene.with_extension("glb"));
    export(&empty, &files[0], &[]);
    export(&far, &files[1], &[]);
    let seen = look(&files);
    assert_eq!((seen[0].triangles, seen[0].bodies.len()), (0, 0));
}

#[test]
fn some_frames_are_those_at_their_times() {
    let folder = tempfile::tempdir().unwrap();
    let [model, again, rows] = ["run.glb", "again.glb", "run.csv"].map(|name| folder.path().join(name));
    let scene = crate::support::scene("projectile");
    let frames = ["--frames", "10,20-22"];
    let said = export(&scene, &model, &frames);
    assert!(said.contains(": 1 body, 4 frames, "), "{said}");
    export(&scene, &again, &frames);
    assert_eq!(fs::read(&model).unwrap(), fs::read(&again).unwrap());
    export(&scene, &rows, &frames);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3, "nothing is left over");
    let seen = look(&[model]);
    assert_eq!(seen[0].times, [0.2f32, 0.4, 0.42, 0.44].map(f64::from));
    assert_same_motion("projectile", &seen[0], &table(&rows));
}

/// A scene with springs and joints of all kinds. One of its ropes is slack.
const LINKS: &str = "
    simulation = { duration = 1, gravity = [0, -9.81, 0], integrator = 'rk4', frame_rate = 10 }
    [body.bob]
    shape.sphere.radius = 0.1
    location = [1, 0, 0]
    [body.bar]
    shape.box.size = [0.1, 1, 0.1]
    location = [2, 0.5, 0]
    angular_velocity = [0, 0, 9]
    [body.load]
    shape.sphere.radius = 0.2
    location = [3, -0.5, 0]
    [body.cart]
    shape.box.size = [0.3, 0.2, 0.2]
    location = [4, 0, 0]
    velocity = [1, 0, 0]
    [body.calf]
    shape.sphere.radius = 0.1
    location = [5, -1, 0]
    velocity = [0.5, 0, 0]
    end = 0.55
    [joint.string.rod]
    between = [[0, 0, 0], 'bob']
    [joint.pivot.hinge]
    between = [[2, 0, 0], 'bar']
    axis = [0, 0, 1]
    [joint.rail.slider]
    between = [[4, 0, 0], 'cart']
    axis = [1, 0, 0]
    [joint.tether.rope]
    between = [[5, 0, 0], 'calf']
    length = 2
    [body.shade]
    shape.sphere.radius = 0.1
    location = [1, 1, 0]
    [joint.hidden.rod]
    between = [[0, 1, 0], 'shade']
    look = 'none'
    [force.coil.spring]
    between = [[3, 1, 0], 'load']
    stiffness = 30
    [force.cord.spring]
    between = ['cart', 'load']
    stiffness = 3
    line = 'straight'
    ";

#[test]
fn springs_and_joints_are_where_the_picture_has_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("links.toml");
    fs::write(&path, LINKS).unwrap();
    let file = path.with_extension("glb");
    export(&path, &file, &[]);
    let [seen] = &look(&[file])[..] else { panic!("one is looked at") };
    let scene = Scene::from_path(&path).unwrap();
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let nodes: Vec<&SeenBody> = seen.bodies.iter().filter(|node| node.name.starts_with("link ")).collect();
    let near = |pose: &[f64; 7], place: DVec3| DVec3::new(pose[0], pose[1], pose[2]).abs_diff_eq(place, 1e-6);
    let axis = |pose: &[f64; 7]| DQuat::from_xyzw(pose[3], pose[4], pose[5], pose[6]) * DVec3::Y;
    let mut compared = 0;
    for (i, frame) in Frames::new(&scene).map(Result::unwrap).enumerate() {
        let mut rest = &nodes[..];
        for (planned, link) in plan.planned_links().zip(plan.each_link(&frame)) {
            let count = if planned.kind == FormKind::Rope { 24 } else { 1 };
            let (its, others) = rest.split_at(count);
            rest = others;
            assert_eq!(its[0].name, format!("link {}", planned.name));
            // `sizes` also holds values between the times, so frame i has the index 2 i.
            let size = its[0].sizes[2 * i];
            match link.map(|link| link.form) {
                None => assert_eq!(size, 0.0, "{} in {i}", planned.name),
                Some(Form::Ball { at, radius }) => {
                    assert!(near(&its[0].poses[i], at) && (size - radius).abs() < 1e-6);
                }
                Some(Form::Coil { ends: [a, b], radius, .. } | Form::Rod { ends: [a, b], radius }) => {
                    let pose = &its[0].poses[i];
                    assert!(near(pose, a.midpoint(b)) && (size - radius).abs() < 1e-6, "{}", planned.name);
                    assert!(axis(pose).cross((b - a).normalize()).length() < 1e-5, "{} in {i}", planned.name);
                }
                Some(Form::Rope { points, .. }) if points.len() == 25 => {
                    let places = points.windows(2).map(|pair| pair[0].midpoint(pair[1]));
                    for (node, place) in its.iter().zip(places) {
                        assert!(near(&node.poses[i], place), "{} in {i}", planned.name);
                    }
                }
                Some(Form::Rope { .. }) => {}
                Some(other) => panic!("no spring or joint is {other:?}"),
            }
            compared += 1;
        }
        assert!(rest.is_empty());
    }
    // The eleven frames each have: two parts for string, rail and coil, one for pivot and cord, and one for the tether's knob or rope.
    assert_eq!(compared, 11 * (2 + 1 + 1 + 2 + 2 + 1), "{}", nodes.len());
}

//! Tests of meshes: each mesh is written once, scripts stay small, and compiling takes little memory.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use crate::memory::peak;
use crate::support::{compile, jabuka};

/// Writes a torus with about this number of triangles as an OBJ file. Returns the length of the file, bytes.
fn torus(path: &Path, triangles: u32) -> u64 {
    let n = (f64::from(triangles) / 2.0).sqrt().round() as u32;
    let mut text = String::new();
    let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let from_axis = 2.0 + 0.7 * libm::cos(angle(j));
        let (x, z) = (from_axis * libm::sin(angle(i)), from_axis * libm::cos(angle(i)));
        writeln!(text, "v {x:.6} {:.6} {z:.6}", 0.7 * libm::sin(angle(j))).unwrap();
    }
    let number = |i: u32, j: u32| i % n * n + j % n + 1;
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").unwrap();
    }
    fs::write(path, &text).unwrap();
    text.len() as u64
}

/// Writes a scene with two bodies that share one mesh, in this layout. Returns its path.
fn scene(folder: &Path, layout: &str) -> PathBuf {
    let path = folder.join("scene.toml");
    let body = |name: &str, x: f64| {
        format!(
            "[body.{name}]\nshape.mesh.file = 'part.obj'\nlocation = [{x}, 0, 0]\nangular_velocity = [0, 2, 1]\n"
        )
    };
    let head = format!("simulation.duration = 0.4\noutput.layout = '{layout}'\n");
    fs::write(&path, head + &body("one", 0.0) + &body("two", 6.0)).unwrap();
    path
}

#[test]
fn a_shared_mesh_stands_once_and_its_scripts_are_small() {
    let folder = tempfile::tempdir().unwrap();
    let length = torus(&folder.path().join("part.obj"), 100_000);
    assert!(length > 3_000_000);
    let out = folder.path().join("out");
    compile(&scene(folder.path(), "shared"), &out, &[]);
    let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
    assert_eq!(read("common.inc").matches("#declare Mesh_part = mesh2 {").count(), 1);
    for frame in 0..=10 {
        let script = read(&format!("frame_{frame:04}.pov"));
        assert_eq!(script.matches("object { Mesh_part scale 0.1 ").count(), 2, "{script}");
        assert!(script.len() < 1_000, "{} bytes", script.len());
    }
}

#[test]
fn a_script_that_is_complete_holds_its_mesh_once() {
    let folder = tempfile::tempdir().unwrap();
    torus(&folder.path().join("part.obj"), 200);
    let out = folder.path().join("out");
    compile(&scene(folder.path(), "self-contained"), &out, &[]);
    let script = fs::read_to_string(out.join("frame_0010.pov")).unwrap();
    assert_eq!(script.matches("mesh2 {").count(), 1);
    assert_eq!(script.matches("object { Mesh_part ").count(), 2);
}

/// Checks that a changed mesh changes the scene's digest, so that old scripts count as out of date although the scene's text is the same.
#[test]
fn another_mesh_is_another_scene() {
    let folder = tempfile::tempdir().unwrap();
    let digest = |triangles: u32| {
        torus(&folder.path().join("part.obj"), triangles);
        jabuka::Scene::from_path(scene(folder.path(), "shared")).unwrap().digest
    };
    let first = digest(200);
    assert_ne!(digest(800), first);
    assert_eq!(digest(200), first);
}

#[test]
fn a_mesh_takes_less_than_six_times_the_memory_of_its_file() {
    takes_little(100_000, "shared");
    takes_little(100_000, "self-contained");
}

#[test]
fn so_does_one_of_a_million_triangles() {
    takes_little(1_000_000, "shared");
}

/// Checks that a mesh takes little memory, beyond what the program takes for a mesh of a few triangles.
fn takes_little(triangles: u32, layout: &str) {
    let (_, own) = memory(200, layout);
    let (length, used) = memory(triangles, layout);
    assert!(used > own + length, "nothing was measured");
    assert!(
        used - own < 6 * length,
        "{layout}: {used} bytes, of which {own} for the program, for a file of {length}"
    );
}

/// Compiles a scene with a mesh. Returns the length of the mesh's file and the peak memory of the program, in bytes.
fn memory(triangles: u32, layout: &str) -> (u64, u64) {
    let folder = tempfile::tempdir().unwrap();
    let length = torus(&folder.path().join("part.obj"), triangles);
    let out = folder.path().join("out");
    let scene = scene(folder.path(), layout);
    let mut command = jabuka();
    command.arg("compile").arg(scene).arg("-o").arg(&out);
    // Each thread holds the script that it writes, so memory grows with the number of threads in the self-contained layout.
    let child = command.env("RAYON_NUM_THREADS", "2").stdout(Stdio::null()).spawn();
    (length, peak(child.unwrap()))
}

//! Tests of particles that start from meshes, and of particles stopped by meshes and by several moving bodies.

use std::fs;

use glam::DVec3;
use jabuka::simulate::{Frame, Frames};

use crate::support::place::Place;
use crate::support::{jabuka, stderr, stdout};

/// An OBJ file of a closed cube with edges of 2.
const CUBE: &str = "
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6
";
/// An OBJ file of the same cube without its upper face.
const TRAY: &str = "
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 1 5 8 4\nf 2 3 7 6
";
const SCHEMES: [(&str, &str); 2] = [("event-driven", "velocity-verlet"), ("time-stepping", "euler-cromer")];

fn frames(text: &str) -> Vec<Frame> {
    let place = Place::new(&[("cube.obj", CUBE), ("tray.obj", TRAY), ("scene.toml", text)]);
    Frames::new(&place.read("scene.toml")).map(Result::unwrap).collect()
}

/// Checks that particles emitted by a mesh without a speed of their own move with the mesh.
#[test]
fn particles_leave_the_surface_of_a_mesh_that_moves() {
    let all = frames(
        "simulation.duration = 1
        [body.cube]\nshape.mesh = { file = 'cube.obj', scale = 0.5 }\nvelocity = [3, 0, 1]
        [emitter.dust]\nshape.sphere.radius = 0.01\nrate = 500\nfrom.surface = 'cube'",
    );
    let last = all.last().unwrap();
    assert_eq!(last.particles[0].len(), 501);
    for particle in last.particles[0].iter() {
        let place = particle.location - last.bodies[0].location;
        assert!((place.abs().max_element() - 0.5).abs() < 1e-12, "{place}");
        assert!(particle.velocity.distance(DVec3::new(3.0, 0.0, 1.0)) < 1e-12);
    }
}

/// Checks that particles bounce off a cubic mesh as off a box. Each bounce off an edge amplifies the rounding error, which is 1e-16 at
/// first.
#[test]
fn a_cube_of_triangles_stops_particles_as_a_box_does() {
    for (scheme, method) in SCHEMES {
        let run = |shape: &str| {
            frames(&format!(
                "simulation = {{ duration = 1.2, gravity = [0, -9.81, 0], contacts = '{scheme}', integrator = '{method}' }}
                environment.ground.height = -3
                [body.cube]\n{shape}\norientation = [20, 30, 40]\nangular_velocity = [0, 1, 0]\nmass = 5
                motion.formula.orientation = [20, '30 + 40*t', 40]
                [emitter.rain]\nshape.sphere.radius = 0.03\nfrom.box = {{ location = [0, 2, 0], size = [1, 0.1, 1] }}
                burst = 150\ncollides = true\nrestitution = 0.6\nfriction = 0.3"
            ))
        };
        let [boxed, meshed] =
            ["shape.box.size = [1, 1, 1]", "shape.mesh = { file = 'cube.obj', scale = 0.5 }"].map(run);
        let (boxed, meshed) = (&boxed.last().unwrap().particles[0], &meshed.last().unwrap().particles[0]);
        let aside = |place: DVec3| libm::hypot(place.x, place.z);
        assert!(boxed.iter().any(|one| aside(one.location) > 1.0), "the cube has thrown them aside");
        for (one, other) in boxed.iter().zip(meshed.iter()) {
            let apart = one.location.distance(other.location);
            assert!(apart < 1e-6, "{scheme} {}: {apart}", one.number);
        }
    }
}

/// Checks that grains stay in a tray, a mesh without thickness whose walls they hit from inside.
#[test]
fn grains_stay_in_a_tray_of_triangles() {
    for (scheme, method) in SCHEMES {
        let all = frames(&format!(
            "simulation = {{ duration = 3, gravity = [0, -9.81, 0], contacts = '{scheme}', integrator = '{method}' }}
            environment.ground = false
            [body.tray]\nshape.mesh = {{ file = 'tray.obj', scale = 0.5 }}\nfixed = true
            [emitter.grains]\nshape.sphere.radius = 0.02\nfrom.point = [0, 0.4, 0]\nrate = 300\nend = 0.599
            spread = 60\nspeed = 1.5\ncollides = true\nrestitution = 0.4\nfriction = 0.4"
        ));
        let (tray, grains) = (all[0].bodies[0].location, &all.last().unwrap().particles[0]);
        assert_eq!(grains.len(), 180);
        let floor = grains.iter().map(|grain| grain.location.y).fold(f64::INFINITY, f64::min);
        let inside = |grain: DVec3| (grain - tray).with_y(0.0).abs().max_element() < 0.48 + 1e-9;
        let stayed = grains.iter().filter(|grain| (grain.location.y - floor).abs() < 1e-6);
        assert_eq!(stayed.filter(|grain| inside(grain.location)).count(), 180, "{scheme}");
    }
}

/// Checks a ball between two plates, boxes or meshes, that approach each other at 0.5 m/s: every bounce adds twice this speed (Fermi
/// acceleration). The test computes the expected path bounce by bounce.
#[test]
fn a_ball_between_two_plates_becomes_faster() {
    for (scheme, method) in SCHEMES {
        for shape in ["shape.box.size = [2, 2, 2]", "shape.mesh = { file = 'cube.obj' }"] {
            let all = frames(&format!(
                "simulation = {{ duration = 1.4, contacts = '{scheme}', integrator = '{method}' }}
                environment.ground = false
                [body.left]\n{shape}\nmotion.formula.location = ['-2 + 0.5*t', 0, 0]
                [body.right]\n{shape}\nmotion.formula.location = ['2 - 0.5*t', 0, 0]
                [emitter.one]\nshape.sphere.radius = 0.05\nburst = 1\ndirection = [1, 0, 0]\nspeed = 2
                collides = true\nrestitution = 1\nfriction = 0"
            ));
            let wall = |t: f64| 0.95 - 0.5 * t;
            let (mut place, mut velocity, mut now, mut bounces) = (0.0, 2.0, 0.0, 0);
            for frame in &all {
                // The ball hits the plate ahead when the path of both in this time adds up to the distance between them.
                loop {
                    let speed = f64::abs(velocity);
                    let hit = now + (wall(now) - place * f64::signum(velocity)) / (speed + 0.5);
                    if hit > frame.time {
                        break;
                    }
                    place += velocity * (hit - now);
                    velocity = -(speed + 1.0) * f64::signum(velocity);
                    now = hit;
                    bounces += 1;
                }
                let expected = place + velocity * (frame.time - now);
                let particle = frame.particles[0][0];
                let (found, speed) = (particle.location.x, particle.velocity.x);
                assert!(
                    (found - expected).abs() < 1e-6 && (speed - velocity).abs() < 1e-6,
                    "{scheme} {shape} {}: {found} {expected}, {speed} {velocity}",
                    frame.time
                );
            }
            assert!(bounces >= 5, "{bounces}");
        }
    }
}

/// Checks that exporting joint forces of time stepping of many bodies is an error, as they are unknown there; a table of zeros would be
/// misleading.
#[test]
fn no_table_has_forces_of_joints_that_time_stepping_does_not_know() {
    let text = "simulation = { duration = 0.1, contacts = 'time-stepping' }
        [body.a]\nshape.sphere.radius = 0.1\nlocation = [0, 1, 0]
        [body.others]\nshape.sphere.radius = 0.1\nlocation = ['i', 1, 3]\nrepeat = 60
        [joint.j.ball]\nbetween = [[0, 1, 0], 'a']\n";
    let place = Place::new(&[("scene.toml", text)]);
    let words = ["export", "scene.toml", "--joints", "-o", "j.csv"];
    let output = jabuka().current_dir(place.0.path()).args(words).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "the arguments are right, the scene is not");
    assert!(!stderr(&output).contains("--help"), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("time stepping of these bodies does not know the forces of joints"),
        "{}",
        stderr(&output)
    );
    assert!(!place.path("j.csv").exists());
}

#[test]
fn a_table_has_the_particles_of_each_frame() {
    let text = "simulation = { duration = 0.2, frame_rate = 10 }
        [emitter.drops]\nshape.sphere.radius = 0.1\nburst = 2\nevery = 0.1\nlifetime = 0.15\nspeed = 3
        [emitter.stones]\nshape.sphere.radius = 0.1\nburst = 1\nfrom.point = [1, 2, 3]\n";
    let place = Place::new(&[("scene.toml", text), ("none.toml", "[body.a]\nshape.sphere.radius = 1\n")]);
    let export =
        |words: &[&str]| jabuka().current_dir(place.0.path()).arg("export").args(words).output().unwrap();
    let output = export(&["scene.toml", "-o", "p.csv", "--particles"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(stdout(&output), "p.csv: 13 rows, 3 times of 2 emitters\n");
    let table = fs::read_to_string(place.path("p.csv")).unwrap();
    let rows: Vec<_> = table.lines().collect();
    assert_eq!(
        rows[0],
        "t [s],emitter,particle,x [m],y [m],z [m],vx [m/s],vy [m/s],vz [m/s],born [s],dies [s]"
    );
    assert_eq!(
        &rows[1..4],
        ["0,drops,0,0,0,0,0,3,0,0,0.15", "0,drops,1,0,0,0,0,3,0,0,0.15", "0,stones,0,1,2,3,0,0,0,0,"]
    );
    assert!(!rows[9..].iter().any(|row| row.starts_with("0.2,drops,0,")), "it is dead: {rows:?}");
    // The output says that particles are left out, and how to export them.
    let output = export(&["scene.toml", "-o", "b.csv"]);
    assert!(stdout(&output).ends_with("; particles are left out: `--particles` makes a table of them\n"));
    let output = export(&["scene.toml", "-o", "b.glb"]);
    assert!(stdout(&output).contains("; particles are left out"), "{}", stdout(&output));
    let output = export(&["none.toml", "-o", "n.csv", "--particles"]);
    assert!(stderr(&output).contains("this scene has no emitters"), "{}", stderr(&output));
}

//! Tests of joints in scenes, apart from their physics.

use glam::DVec3;
use jabuka::Scene;

/// Checks the initial velocity of a door of 0.8 m on a hinge that turns at 2 rad/s: its center moves at 0.8 m/s, as if this velocity were
/// given.
#[test]
fn a_body_that_turns_about_a_hinge_moves_with_it() {
    let door = |velocity: &str, hinge: &str| {
        Scene::parse(&format!(
            "[body.post]\nshape.sphere.radius = 0.1\nfixed = true\n\
             [body.door]\nshape.box.size = [0.8, 2, 0.04]\nlocation = [0.4, 1, 0]\n\
             angular_velocity = [0, 2, 0]\n{velocity}\n{hinge}"
        ))
        .unwrap()
    };
    let hinge = "[joint.h.hinge]\nbetween = [[0, 1, 0], 'door']\naxis = [0, 1, 0]";
    let at_post = "[joint.h.hinge]\nbetween = ['door', { body = 'post', at = [0, 1, 0] }]\naxis = [0, 1, 0]";
    let ball = "[joint.h.ball]\nbetween = [[0, 1, 0], 'door']";
    for joint in [hinge, at_post, ball] {
        let start = door("", joint).bodies[1].start;
        assert!(start.velocity.distance(DVec3::new(0.0, 0.0, -0.8)) < 1e-15, "{joint}: {}", start.velocity);
    }
    // A given velocity stays, and so does the velocity of a body that no hinge holds.
    assert_eq!(door("velocity = [0, 0, -0.5]", hinge).bodies[1].start.velocity, DVec3::new(0.0, 0.0, -0.5));
    let rod = "[joint.h.rod]\nbetween = [[0, 0, 0], 'door']";
    assert_eq!(door("", rod).bodies[1].start.velocity, DVec3::ZERO);
}

/// Checks labels with the angle of a hinge driven at 30° sin t, and the displacement of a slider at 0.5 sin t m, half a period later.
#[test]
fn labels_show_the_angle_of_a_hinge_and_the_way_of_a_slider() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text = "
        simulation = { duration = 2, frame_rate = 1, integrator = 'rk4' }
        [body.door]
        shape.box.size = [0.8, 2, 0.04]
        location = [0.4, 1, 0]
        [body.block]
        shape.box.size = [0.2, 0.2, 0.2]
        location = [0, 3, 0]
        [joint.h.hinge]
        between = [[0, 1, 0], 'door']
        axis = [0, 1, 0]
        motor = { angle = '30*sin(pi/4*t)' }
        [joint.s.slider]
        between = [[0, 3, 0], 'block']
        axis = [1, 0, 0]
        motor = { position = '0.5*sin(pi/4*t)' }
        [label.numbers]
        text = 'angle ${joint.h.angle:.6}, way ${joint.s.position:.6}, rate ${joint.s.speed:.6}!'
        corner = 'top-left'
    ";
    std::fs::write(&scene, text).unwrap();
    let out = folder.path().join("out");
    let done = std::process::Command::new(env!("CARGO_BIN_EXE_jabuka"))
        .args(["compile", "--no-cache", "-o"])
        .args([&out, &scene])
        .output()
        .unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let script = std::fs::read_to_string(out.join("frame_0002.pov")).unwrap();
    assert!(script.contains("angle 30.000000, way 0.500000, rate 0.000000!"), "{script}");
}

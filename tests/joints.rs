//! What a scene with joints means, beside their physics.

use glam::DVec3;
use jabuka::Scene;

/// A door of 0.8 m at 2 rad/s: its centre moves at 0.8 m/s, as a velocity that is written would say.
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
    // What is written stays, and so does a body that no joint holds there.
    assert_eq!(door("velocity = [0, 0, -0.5]", hinge).bodies[1].start.velocity, DVec3::new(0.0, 0.0, -0.5));
    let rod = "[joint.h.rod]\nbetween = [[0, 0, 0], 'door']";
    assert_eq!(door("", rod).bodies[1].start.velocity, DVec3::ZERO);
}

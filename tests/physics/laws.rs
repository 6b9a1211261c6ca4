//! Tests of the laws that no contact can break: impulses between bodies conserve momentum and angular momentum, and friction and
//! restitution take energy.

use glam::DVec3;

use crate::common::frames;

/// An arm hangs on a turning rotor by a hinge, with the edges of both pressed together right beside the hinge, so that the contact hardly
/// differs from a bearing. Nothing moves against anything else: the energy and the angular momentum about the rotor's axis stay.
#[test]
fn a_contact_beside_a_hinge_conserves_angular_momentum() {
    for middle in [DVec3::new(1.0, 3.0, 0.0), DVec3::ZERO, DVec3::new(-7.0, 0.0, 2.0)] {
        let DVec3 { x, y, z } = middle;
        let frames = frames(&format!(
            "[simulation]
            duration = 0.4
            frame_rate = 25
            gravity = [0, 0, 0]
            contacts = 'event-driven'
            integrator = 'velocity-verlet'
            [environment]
            ground = false
            [body.rotor]
            location = [{x}, {y}, {z}]
            shape.box.size = [2, 0.2, 0.2]
            angular_velocity = [0, 0, 5]
            mass = 4
            [body.arm]
            location = ['{x} + 1.5', '{y} + 0.15', {z}]
            shape.box.size = [1, 0.1, 0.1]
            velocity = [-0.75, 7.5, 0]
            angular_velocity = [0, 0, 5]
            mass = 1
            [joint.axle.hinge]
            between = [[{x}, {y}, {z}], 'rotor']
            axis = [0, 0, 1]
            [joint.elbow.hinge]
            between = ['rotor', 'arm']
            at = ['{x} + 1', '{y} + 0.15', {z}]
            axis = [0, 0, 1]
            collides = true
            [force.band.spring]
            between = [{{ body = 'rotor', at = [0, 0, 0] }}, {{ body = 'arm', at = [0.2, 0, 0] }}]
            stiffness = 50
            rest_length = 0.5"
        ));
        let about = |i: usize| {
            let balance = &frames[i].balance;
            balance.angular_momentum.z - middle.cross(balance.linear_momentum).z
        };
        for (i, frame) in frames.iter().enumerate() {
            let (momentum, energy) =
                (about(i) / about(0) - 1.0, frame.balance.total / frames[0].balance.total - 1.0);
            assert!(
                momentum.abs() < 1e-5 && energy.abs() < 1e-5,
                "{middle}, t = {}: {momentum:e} {energy:e}",
                frame.time
            );
        }
    }
}

/// A chain slides over the edge of a table without friction. Each link lies on many points, and each turn at the edge couples all of
/// them. The contacts take energy and never add any.
#[test]
fn a_chain_loses_energy_at_an_edge() {
    let frames = frames(
        "[simulation]
        duration = 0.5
        frame_rate = 50
        gravity = [0, -9.81, 0]
        contacts = 'event-driven'
        integrator = 'velocity-verlet'
        [environment]
        ground = false
        [defaults.body]
        friction = 0
        [body.table]
        shape.box.size = [4, 0.2, 1]
        location = [-2, -0.1, 0]
        fixed = true
        [body.link]
        repeat = 20
        shape.capsule = { radius = 0.02, height = 0.12 }
        location = ['if(i < 5, 0.02, 0.47 - 0.1*i)', 'if(i < 5, -0.43 + 0.1*i, 0.02)', 0]
        orientation = [0, 0, 'if(i < 5, 0, 90)']
        mass = 0.05
        [joint.link.ball]
        between = ['link[i]', 'link[i+1]']
        at = ['if(i < 5, 0.02, 0.42 - 0.1*i)', 'if(i < 5, -0.38 + 0.1*i, 0.02)', 0]",
    );
    let mut before = 0.0;
    for frame in &frames {
        let contacts = frame.balance.accounts.impacts + frame.balance.accounts.friction;
        assert!(contacts <= before + 1e-6, "t = {}: {before:e} {contacts:e}", frame.time);
        before = contacts;
        assert!(frame.balance.total <= frames[0].balance.total + 1e-5, "t = {}", frame.time);
    }
    assert!(before < -0.01, "{before}");
}

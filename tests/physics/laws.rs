//! Tests of the laws that no contact can break: impulses between bodies conserve momentum and angular momentum, and friction and
//! restitution take energy.

use glam::DVec3;
use jabuka::physics::Balance;

use crate::common::{arm_on_rotor, frames, pressed_arm};

/// An arm hangs on a turning rotor by a hinge, with the edges of both pressed together right beside the hinge, so that the contact hardly
/// differs from a bearing. Nothing moves against anything else: the energy and the angular momentum about the rotor's axis stay, and
/// neither contacts nor friction do work.
#[test]
fn a_contact_beside_a_hinge_conserves_angular_momentum() {
    let places = [DVec3::new(1.0, 3.0, 0.0), DVec3::ZERO, DVec3::new(-7.0, 0.0, 2.0)];
    // Over some seconds, the contacts open and close hundreds of times.
    for (middle, duration) in [(places[0], 0.4), (places[1], 0.4), (places[2], 0.4), (places[0], 4.0)] {
        let bodies = format!(
            "[body.rotor]
            location = {:?}
            shape.box.size = [2, 0.2, 0.2]
            angular_velocity = [0, 0, 5]
            mass = 4
            [body.arm]
            location = {:?}
            shape.box.size = [1, 0.1, 0.1]
            velocity = [-0.75, 7.5, 0]
            angular_velocity = [0, 0, 5]
            mass = 1
            [force.band.spring]
            between = [{{ body = 'rotor', at = [0, 0, 0] }}, {{ body = 'arm', at = [0.2, 0, 0] }}]
            stiffness = 50
            rest_length = 0.5",
            middle.to_array(),
            (middle + DVec3::new(1.5, 0.15, 0.0)).to_array(),
        );
        let times = format!("duration = {duration}\nframe_rate = 25");
        let frames = frames(&arm_on_rotor(&times, &bodies, [middle, middle + DVec3::new(1.0, 0.15, 0.0)]));
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
            let balance = &frame.balance;
            let taken = (balance.accounts.impacts.abs() + balance.accounts.friction.abs()) / balance.total;
            assert!(
                taken < 2e-5 && balance.drift.abs() < 3e-5,
                "{middle}, t = {}: {:?} {:e}",
                frame.time,
                balance.accounts,
                balance.drift
            );
            assert!(frame.laws.iter().all(|residual| residual.part < 1e-6), "{middle}: {:?}", frame.laws);
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

/// A ball on a lever slides down a wedge on a rail, and its friction brakes the wedge. The work of friction is that of the motion that the
/// method computes, so the accounts close to the order of the method, 2.
#[test]
fn the_account_of_friction_beside_a_hinge_closes_with_the_order_of_the_method() {
    let missing = |step: f64| {
        let frames = frames(&format!(
            "[simulation]
            duration = 0.5
            step = {step}
            gravity = [0, -9.81, 0]
            contacts = 'event-driven'
            integrator = 'velocity-verlet'
            [environment]
            ground = false
            [defaults.body]
            friction = 0.4
            restitution = 0
            [body.wedge]
            shape.box.size = [4, 0.2, 0.4]
            orientation = [0, 0, -10]
            velocity = [1.5, 0, 0]
            mass = 2
            [joint.rail.slider]
            between = [[0, 0, 0], 'wedge']
            axis = [1, 0, 0]
            [body.ball]
            shape.sphere.radius = 0.1
            location = [0, '0.2/cos(rad(10))', 0]
            mass = 1
            [joint.pin.hinge]
            between = [[-0.8, 0.3, 0], 'ball']
            axis = [0, 0, 1]"
        ));
        let end = &frames[frames.len() - 1].balance;
        assert!(end.accounts.friction < -1.0, "{:?}", end.accounts);
        end.error.abs() / -end.accounts.friction
    };
    let errors = [0.01, 0.005, 0.0025].map(missing);
    assert!(errors[0] < 2e-5, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((3.2..5.0).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
}

/// A torque presses an arm on the rotor that carries it. Where the contacts are solved by substeps, the torque works on along the motion
/// that the bodies really have, and what presses on does no work: after the first impact, all work becomes kinetic energy.
#[test]
fn a_torque_that_presses_an_arm_on_its_rotor_loses_nothing() {
    for step in [0.004, 0.002] {
        let frames = pressed_arm(DVec3::ZERO, (0.8, 25, step));
        // The first impact, within the first frame, takes 1.9 mJ.
        let first = frames[1].balance.accounts;
        for frame in &frames[1..] {
            let Balance { accounts, error, .. } = frame.balance;
            let taken = accounts.impacts + accounts.friction - first.impacts - first.friction;
            assert!(taken.abs() < 2e-4, "{step}, t = {}: {taken:e}", frame.time);
            assert!(error.abs() < 1e-5, "{step}, t = {}: {error:e}", frame.time);
        }
    }
}

/// With Newton's law of restitution and friction, a rod that touches the floor with one end could leave it with more energy (Kane's
/// paradox). Restitution gives way then, and no energy is added.
#[test]
fn no_rod_rebounds_with_more_energy() {
    for angle in [20.0, 35.0, 50.0, 65.0] {
        for (speed, friction) in [(-0.5, 0.3), (-0.5, 1.0), (1.0, 0.3), (1.0, 1.0)] {
            let frames = frames(&format!(
                "[simulation]
                duration = 0.1
                frame_rate = 20
                gravity = [0, 0, 0]
                contacts = 'event-driven'
                integrator = 'velocity-verlet'
                [environment]
                ground = false
                [defaults.body]
                friction = {friction}
                restitution = 0.95
                [body.floor]
                shape.box.size = [10, 1, 10]
                location = [0, -0.5, 0]
                fixed = true
                [body.rod]
                shape.capsule = {{ radius = 0.02, height = 1 }}
                orientation = [0, 0, {angle}]
                location = [0, '0.03 + 0.5*cos(rad({angle}))', 0]
                velocity = [{speed}, -1, 0]
                mass = 1"
            ));
            let (start, end) = (&frames[0], &frames[frames.len() - 1]);
            assert!(
                end.balance.kinetic <= start.balance.kinetic * (1.0 + 1e-9),
                "{angle} {speed} {friction}"
            );
            let lost = 1.0 - end.balance.kinetic / start.balance.kinetic;
            // Only where friction pushes along the motion would Newton's law add energy.
            assert!(
                if speed < 0.0 { lost.abs() < 1e-9 } else { lost > 0.1 },
                "{angle} {speed} {friction}: {lost}"
            );
        }
    }
}

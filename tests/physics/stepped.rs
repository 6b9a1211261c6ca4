//! Tests of time stepping by Moreau's scheme, which advances small scenes with `contacts = "time-stepping"`: impacts, friction and rest at the
//! default step, against closed forms. The scheme is of first order, so tolerances are a small multiple of what a step can change.

use std::f64::consts::PI;

use glam::DVec3;
use jabuka::physics::random::Stream;
use jabuka::physics::{Dynamics as _, Impact};
use jabuka::simulate::{Frame, survey, world};
use jabuka::{Run, Scene};

use crate::common::{boxes_that_a_ball_hits, drift, frames};

/// An arm that leans on a stop of its own base, which turns at 6 rad/s about its middle. Nothing brakes them.
const ARM_ON_STOP: &str = r#"
    [simulation]
    duration = 2
    contacts = "time-stepping"
    [environment]
    ground = false
    [defaults.body]
    friction = 0
    [body.base]
    shape.box.size = [2, 0.2, 0.2]
    angular_velocity = [0, 0, 6]
    mass = 4
    [body.arm]
    shape.box.size = [1, 0.1, 0.1]
    location = [0.5, 0.15, 0]
    velocity = [-0.9, 3, 0]
    angular_velocity = [0, 0, 6]
    mass = 1
    [joint.axle.hinge]
    between = [[0, 0, 0], "base"]
    axis = [0, 0, 1]
    [joint.elbow.hinge]
    between = ["base", "arm"]
    at = [0.05, -0.1, 0]
    axis = [0, 0, 1]
    collides = true
"#;

/// Returns the last of some frames.
fn last(frames: &[Frame]) -> &Frame {
    &frames[frames.len() - 1]
}

/// Returns all impacts of a scene until the time `end`, s.
#[allow(clippy::unwrap_used, reason = "only tests call it")]
fn impacts(text: &str, end: f64) -> Vec<Impact> {
    let mut world = world(&Scene::parse(text).unwrap());
    world.advance(end, &[], &mut |_| {}).unwrap();
    world.impacts()
}

/// Checks the impact of a tilted crate. It falls on an edge after √(2 · 0.3 m / g) = 0.24731 s, and the edge sticks. With moments of inertia
/// m/6 and the arm r of the edge, Newton's law for the normal and a point without slip give the velocities after the impact. Each is off by
/// at most what gravity changes in a step of 1/1000 s.
#[test]
fn a_tilted_crate_gets_the_spin_of_an_edge_that_sticks() {
    for (restitution, vx, vy, spin) in [(0.2, 0.702, 0.230, -1.056), (0.0, 0.585, -0.213, -0.880)] {
        let text = format!(
            r#"
            [simulation]
            duration = 0.26
            frame_rate = 1000
            gravity = [0, -9.81, 0]
            contacts = "time-stepping"
            [body.crate]
            shape.box.size = [1, 1, 1]
            location = [0, "0.3 + 0.5*cos(rad(25)) + 0.5*sin(rad(25))", 0]
            orientation = [0, 0, 25]
            friction = 0.5
            restitution = {restitution}
            "#
        );
        let frames = frames(&text);
        let body = frames[248].bodies[0];
        let of_step = 9.81 / 1000.0;
        // Gravity has acted since the impact.
        let vy = vy - 9.81 * (0.248 - 0.24731);
        assert!((body.velocity - DVec3::new(vx, vy, 0.0)).length() < of_step, "{}", body.velocity);
        assert!((body.angular_velocity - DVec3::Z * spin).length() < of_step, "{}", body.angular_velocity);
        let impacts = impacts(&text, 0.25);
        assert_eq!(impacts.len(), 1, "two corners hit as one");
        assert!((impacts[0].time - 0.24731).abs() < 1e-5, "{}", impacts[0].time);
    }
}

/// Checks a wheel at 60 m/s, which rolls straight on: without slip, no force acts along the ground.
#[test]
fn a_fast_wheel_rolls_straight() {
    let frames = frames(
        r#"
        [simulation]
        duration = 5
        gravity = [0, -9.81, 0]
        contacts = "time-stepping"
        [body.wheel]
        shape.cylinder = { radius = 0.3, height = 0.2 }
        location = [0, 0.3, 0]
        orientation = [90, 0, 0]
        velocity = [60, 0, 0]
        angular_velocity = [0, 0, -200]
        friction = 0.8
        "#,
    );
    let place = last(&frames).bodies[0].location;
    assert!((place - DVec3::new(300.0, 0.3, 0.0)).length() < 1e-6, "{place}");
}

/// Checks a disk that slides and spins on its rim. Friction opposes the slip of each point of the rim, and slows both down together: it comes
/// to rest 1.303 m on.
#[test]
fn a_disk_that_slides_and_spins_slides_far() {
    let frames = frames(
        r#"
        [simulation]
        duration = 3
        gravity = [0, -9.81, 0]
        contacts = "time-stepping"
        [environment]
        ground = { friction = 0.1 }
        [body.disk]
        shape.cylinder = { radius = 0.14, height = 0.1 }
        location = [0, 0.05, 0]
        velocity = [1, 0, 0]
        angular_velocity = [0, 20, 0]
        friction = 0.1
        mass = 20
        "#,
    );
    let body = last(&frames).bodies[0];
    // In a step, the disk moves up to 4 mm.
    assert!((body.location.x - 1.303).abs() < 4e-3, "{}", body.location);
}

/// Checks a thin stick that falls on its end: each impact takes energy, and it ends lying on the floor.
#[test]
fn a_falling_stick_comes_to_lie() {
    let frames = frames(
        r#"
        [simulation]
        duration = 6
        gravity = [0, -9.81, 0]
        contacts = "time-stepping"
        [body.stick]
        shape.cylinder = { radius = 0.02, height = 2 }
        location = [0, 1.2, 0]
        orientation = [0, 0, 25]
        friction = 0.5
        restitution = 0.2
        "#,
    );
    let highest =
        frames.windows(2).map(|two| two[1].balance.total - two[0].balance.total).fold(0.0, f64::max);
    assert!(highest < 1e-4 * frames[0].balance.total, "energy rises by {highest} J");
    let body = last(&frames).bodies[0];
    assert!((body.location.y - 0.02).abs() < 1e-6, "{}", body.location);
    assert_eq!(body.velocity, DVec3::ZERO);
}

/// Checks two cards that lean on each other at 40 degrees. They need a friction of tan(40°)/2 = 0.42. With 0.5 they stand, with 0.35 they
/// fall.
#[test]
fn two_cards_lean_by_their_friction() {
    for (friction, stands) in [(0.5, true), (0.35, false)] {
        let frames = frames(&format!(
            r#"
            [simulation]
            duration = 1
            gravity = [0, -9.81, 0]
            contacts = "time-stepping"
            [environment]
            ground = {{ friction = {friction} }}
            [defaults.body]
            friction = {friction}
            mass = 0.05
            shape.box.size = [0.02, 1, 0.7]
            [body.a]
            location = [-0.3290542492744594, 0.3894500976563544, 0]
            orientation = [0, 0, -40]
            [body.b]
            location = [0.3290542492744594, 0.3894500976563544, 0]
            orientation = [0, 0, 40]
            "#
        ));
        let moved = (last(&frames).bodies[0].location - frames[0].bodies[0].location).length();
        assert!(if stands { moved < 1e-6 } else { moved > 0.1 }, "friction {friction}: moved by {moved}");
    }
}

/// Checks two equal balls that meet head-on at 0.0195 s and exchange their velocities. Without forces the scheme gives the closed form, also
/// if they move far in a step.
#[test]
fn fast_balls_exchange_their_velocities() {
    let frames = frames(
        r#"
        [simulation]
        duration = 0.04
        frame_rate = 100
        step = 0.01
        contacts = "time-stepping"
        [environment]
        ground = false
        [defaults.body]
        shape.sphere.radius = 0.05
        restitution = 1
        [body.a]
        location = [-2, 0, 0]
        velocity = [100, 0, 0]
        [body.b]
        location = [2, 0, 0]
        velocity = [-100, 0, 0]
        "#,
    );
    let [a, b] = [last(&frames).bodies[0], last(&frames).bodies[1]];
    assert!((a.location.x + 2.1).abs() < 1e-9 && (b.location.x - 2.1).abs() < 1e-9, "{}", a.location);
    assert!((a.velocity.x + 100.0).abs() < 1e-9 && (b.velocity.x - 100.0).abs() < 1e-9, "{}", a.velocity);
}

/// Checks that no impact of a die pulls at the floor or rubs more than Coulomb's law allows, and that friction never gives energy.
#[test]
fn impacts_of_a_die_obey_the_laws() {
    let text = r#"
        [simulation]
        duration = 0.5
        frame_rate = 1000
        gravity = [0, -9.81, 0]
        contacts = "time-stepping"
        [body.die]
        shape.box.size = [0.02, 0.02, 0.02]
        location = [0, 0.3, 0]
        orientation = [20, 0, 30]
        velocity = [0.5, 0, 0]
        density = 1200
        friction = 0.4
        restitution = 0.3
        "#;
    let (frames, impacts) = (frames(text), impacts(text, 0.5));
    assert!(!impacts.is_empty());
    for impact in impacts {
        let push = impact.impulse.dot(impact.normal);
        let rub = (impact.impulse - push * impact.normal).length();
        assert!(push > 0.0 && rub <= 0.4 * push * (1.0 + 1e-9), "{impact:?}");
        assert!(impact.energy >= 0.0, "{impact:?}");
    }
    for two in frames.windows(2) {
        assert!(two[1].balance.accounts.friction <= two[0].balance.accounts.friction + 1e-12);
    }
}

/// Checks a coin that rolls on its rim, leaning at 20 degrees. It does not slip, so it keeps its energy but for 0.1 %.
#[test]
fn a_leaning_disk_keeps_its_energy() {
    let frames = frames(
        r#"
        [simulation]
        duration = 1
        frame_rate = 200
        gravity = [0, -9.81, 0]
        contacts = "time-stepping"
        [environment]
        ground = { friction = 1 }
        [body.disk]
        shape.cylinder = { radius = 0.1, height = 0.004 }
        location = [0, 0.03608139957413869, 0]
        orientation = [0, 0, -20]
        angular_velocity = [-10.886196221431137, 3.9622513889821374, 0]
        friction = 1
        "#,
    );
    let (first, end) = (frames[0].balance.total, last(&frames).balance.total);
    assert!((end / first - 1.0).abs() < 1e-3, "{first} J, then {end} J");
}

/// Checks a ball with restitution 1 that falls from 1 m: it keeps its height over ten rebounds to within the path of a step at its highest
/// speed.
#[test]
fn an_elastic_ball_keeps_its_height() {
    let frames = frames(
        r#"
        [simulation]
        duration = 9.5
        frame_rate = 100
        gravity = [0, -9.81, 0]
        contacts = "time-stepping"
        [body.ball]
        shape.sphere.radius = 0.1
        location = [0, 1.1, 0]
        restitution = 1
        friction = 0
        "#,
    );
    let heights = frames.iter().filter(|frame| frame.time > 8.6).map(|frame| frame.bodies[0].location.y);
    let height = heights.fold(0.0, f64::max) - 0.1;
    assert!((height - 1.0).abs() < 4.43 / 240.0, "{height}");
}

/// Checks a tower of twenty boxes for 10 s. Until it rests, each box may move by a few 1e-9 of its size. Then nothing moves any more.
/// Gauss–Seidel sweeps alone would let the tower fall. There is no warning.
#[test]
fn a_tower_of_twenty_stands_still() {
    let text = r#"
        [simulation]
        duration = 10
        frame_rate = 5
        gravity = [0, -9.81, 0]
        contacts = "time-stepping"
        [body.block]
        repeat = 20
        shape.box.size = [1, 1, 1]
        mass = 1
        friction = 0.5
        location = [0, "0.5+i", 0]
        "#;
    let scene = Scene::parse(text).unwrap();
    let found = survey(&scene, |_| {}).unwrap();
    let warnings = jabuka::motion_warnings::all(&scene, &found);
    assert!(warnings.is_empty(), "{warnings:?}");
    let frames = frames(text);
    for (level, (block, early)) in last(&frames).bodies.iter().zip(&frames[2].bodies).enumerate().take(20) {
        let place = DVec3::Y * (level as f64 + 0.5);
        assert!((block.location - place).length() < 1e-6, "{level}: {}", block.location);
        assert_eq!(block.location, early.location, "{level} still moves");
        assert_eq!(block.velocity, DVec3::ZERO, "{level}");
    }
}

/// Checks a disk that spins on a smooth floor by one whole turn in each step. It must go on, although each step leaves it as it was.
#[test]
fn what_turns_once_in_a_step_is_not_at_rest() {
    let frames = frames(
        r#"
        [simulation]
        duration = 0.2
        step = 0.004
        frame_rate = 25
        gravity = [0, -9.81, 0]
        contacts = "time-stepping"
        [body.disk]
        shape.cylinder = { radius = 0.1, height = 0.05 }
        mass = 1
        location = [0, 0.025, 0]
        angular_velocity = [0, "2*pi/0.004", 0]
        friction = 0
        "#,
    );
    let spin = last(&frames).bodies[0].angular_velocity.y;
    assert!((spin * 0.004 / std::f64::consts::TAU - 1.0).abs() < 1e-9, "{spin}");
}

/// Checks bodies that overlap deeply at the start, which would shoot apart. Bodies that overlap by less than a tenth of their thickness are
/// moved apart.
#[test]
fn what_overlaps_at_the_start_is_an_error() {
    let stacked = |height: f64| {
        let text = format!(
            r#"
            [simulation]
            duration = 0.1
            gravity = [0, -9.81, 0]
            contacts = "time-stepping"
            [body.box]
            repeat = 2
            shape.box.size = [0.4, 0.4, 0.4]
            mass = 1
            location = [0, "0.2 + {height}*i", 0]
            "#
        );
        let scene = Scene::parse(&text).unwrap();
        Run::new(&scene).err().map(|error| error.to_string())
    };
    assert_eq!(stacked(0.37), None);
    let error = stacked(0.35).unwrap();
    assert!(error.contains("overlap by 0.05 m"), "{error}");
}

/// Checks boxes that stand on each other until a ball hits them: they rest exactly, press with their weight, and wake.
#[test]
fn what_stands_is_held_until_it_is_hit() {
    let frames = boxes_that_a_ball_hits(r#"contacts = "time-stepping""#);
    let early: Vec<_> = frames.iter().filter(|frame| frame.time > 0.1 && frame.time < 0.5).collect();
    for frame in &early {
        assert_eq!(frame.bodies[..2], early[0].bodies[..2], "{}", frame.time);
    }
    let on_floor = early[5]
        .contacts
        .iter()
        .filter(|contact| contact.bodies[1] != 1)
        .map(|contact| contact.force.length());
    assert!((on_floor.sum::<f64>() - 2.0 * 9.81).abs() < 1e-6);
    assert!(
        (last(&frames).bodies[1].location - early[0].bodies[1].location).length() > 1e-3,
        "it was not hit"
    );
    let drift = drift(&frames);
    assert!(drift < 1e-3, "{drift}");
}

/// Checks the joint of a bar that leans on the floor: at rest, the hinge and the floor bear half of its weight each. The bar is 2 m long and lies
/// level, its hinge at one end.
#[test]
fn joints_bear_what_contacts_leave() {
    let frames = frames(
        r#"
        [simulation]
        duration = 0.5
        gravity = [0, -9.81, 0]
        contacts = "time-stepping"
        [body.bar]
        shape.box.size = [2, 0.1, 0.1]
        location = [0, 0.15, 0]
        mass = 3
        [body.foot]
        shape.sphere.radius = 0.05
        location = [0.95, 0.05, 0]
        fixed = true
        [joint.end.hinge]
        between = [[-1, 0.15, 0], "bar"]
        at = [-1, 0.15, 0]
        axis = [0, 0, 1]
        "#,
    );
    let end = last(&frames);
    // The foot is 1.95 m from the hinge, the weight 1 m.
    let on_foot = 3.0 * 9.81 / 1.95;
    let pushed: DVec3 = end.contacts.iter().map(|contact| contact.force).sum();
    assert!((pushed.length() - on_foot).abs() < 1e-3 * on_foot, "{pushed}");
    let reaction = end.reactions[0].force;
    assert!((reaction - DVec3::Y * (3.0 * 9.81 - on_foot)).length() < 1e-2, "{reaction}");
}

/// Checks an arm on a stop of its own turning base, without friction and with it: in two turns, they keep their angular velocity of 6 rad/s to
/// a tenth of the square of the angle in half a step. With friction, the joints and four contacts hold the arm in more ways than one, so
/// impulses could grow without end.
#[test]
fn an_arm_on_a_stop_turns_with_its_base() {
    for friction in [0.0, 0.5] {
        let frames = frames(&ARM_ON_STOP.replace("friction = 0", &format!("friction = {friction}")));
        for body in &last(&frames).bodies {
            let angle = 6.0 / 480.0;
            let allowed = 0.1 * angle * angle * 6.0;
            let off = (body.angular_velocity.z - 6.0).abs();
            assert!(off < allowed, "friction {friction}: {}", body.angular_velocity);
        }
    }
}

/// Checks that moments within steps show the motion, and change no bit of the run. A falling ball follows the parabola, for which the scheme is
/// exact.
#[test]
fn moments_within_steps_change_nothing() {
    let text = r#"
        [simulation]
        gravity = [0, -9.81, 0]
        contacts = "time-stepping"
        [body.ball]
        shape.sphere.radius = 0.1
        location = [0, 5, 0]
        [body.box]
        repeat = 3
        shape.box.size = [0.2, 0.2, 0.2]
        location = ["1 + 0.05*i", "0.3 + 0.3*i", 0]
        orientation = [0, 20, 10]
        "#;
    let scene = Scene::parse(text).unwrap();
    let [mut plain, mut seen] = [world(&scene), world(&scene)];
    plain.advance(0.9, &[], &mut |_| {}).unwrap();
    let mut moments = Vec::new();
    seen.advance(0.9, &[0.101, 0.3333, 0.5, 0.7], &mut |moment| moments.push(moment)).unwrap();
    assert_eq!(plain.state(), seen.state());
    assert_eq!(moments.len(), 4);
    for moment in moments {
        let height = 5.0 - 0.5 * 9.81 * moment.time * moment.time;
        assert!((moment.bodies[0].location.y - height).abs() < 1e-12, "{}", moment.time);
    }
}

/// Checks rolling friction: a ball that rolls on the ground slows down by a = g c/r / (1 + 2/5), with the coefficient c and the radius r.
#[test]
fn rolling_friction_slows_a_ball() {
    let frames = frames(
        r#"
        [simulation]
        duration = 4
        gravity = [0, -9.81, 0]
        contacts = "time-stepping"
        [environment]
        ground = { height = 0, friction = 0.5, rolling_friction = 0.01 }
        [body.ball]
        shape.sphere.radius = 0.2
        location = [0, 0.2, 0]
        velocity = [1.5, 0, 0]
        angular_velocity = [0, 0, -7.5]
        "#,
    );
    let (slowing, ball) = (9.81 * 0.01 / 0.2 / 1.4, &last(&frames).bodies[0]);
    let place = 1.5 * 4.0 - 0.5 * slowing * 16.0;
    assert!((ball.location.x - place).abs() < 1e-5, "{} {place}", ball.location);
    assert!((ball.velocity.x - (1.5 - 4.0 * slowing)).abs() < 1e-9, "{}", ball.velocity);
}

/// Checks a rope over two fixed points with m₁ = 1 kg and m₂ = 2 kg at its ends: the heavier one falls by g/3, and the rope pulls with
/// 2 m₁ m₂ g / (m₁ + m₂).
#[test]
fn a_pulley_carries_two_balls() {
    let frames = frames(
        r#"
        [simulation]
        duration = 1
        gravity = [0, -9.81, 0]
        contacts = "time-stepping"
        [defaults.body]
        shape.sphere.radius = 0.1
        [body.left]
        location = [-1, 3, 0]
        mass = 1
        [body.right]
        location = [1, 3, 0]
        mass = 2
        [joint.over.pulley]
        between = ["left", "right"]
        over = [[-1, 5, 0], [1, 5, 0]]
        "#,
    );
    let way = 0.5 * 9.81 / 3.0;
    for (body, height) in last(&frames).bodies.iter().zip([3.0 + way, 3.0 - way]) {
        assert!((body.location.y - height).abs() < 1e-9, "{} {height}", body.location);
    }
    for frame in &frames[1..] {
        let force = frame.reactions[0].force;
        assert!((force - 4.0 / 3.0 * 9.81 * DVec3::Y).length() < 1e-6, "t = {}: {force}", frame.time);
    }
}

/// Checks two wheels in gear: a torque τ on the first turns both by I α = τ, with the inertia I = I₁ + r² I₂ for the ratio r. They go on
/// beyond half a turn, wherever they stand, and however they are turned at the start. A step of length h changes the angle by at most
/// ½ α t h.
#[test]
fn a_gear_turns_two_wheels() {
    for (x, turned) in [(0.0, 0.0), (3.0, 30.0)] {
        let frames = frames(&format!(
            r#"
            [simulation]
            duration = 1
            contacts = "time-stepping"
            [environment]
            ground = false
            [defaults.body]
            shape.cylinder = {{ radius = 0.5, height = 0.1 }}
            orientation = [0, {turned}, 0]
            [body.a]
            location = [{a}, 0, 0]
            mass = 1
            torque = [0, 9, 0]
            [body.b]
            location = [{b}, 0, 0]
            mass = 2
            [joint.left.hinge]
            between = [[{a}, 0, 0], "a"]
            axis = [0, 1, 0]
            [joint.right.hinge]
            between = [[{b}, 0, 0], "b"]
            axis = [0, 1, 0]
            [joint.teeth.gear]
            joints = ["left", "right"]
            ratio = -2
            "#,
            a = x - 1.0,
            b = x + 1.0
        ));
        let acceleration = 9.0 / (0.125 + 4.0 * 0.25);
        let (mut angle, mut before) = (0.0, frames[0].bodies[0].orientation);
        for frame in &frames {
            let [first, second] = [0, 1].map(|body| frame.bodies[body]);
            angle += 2.0 * libm::asin((first.orientation * before.conjugate()).normalize().y);
            before = first.orientation;
            let [expected, rate] = [0.5 * acceleration * frame.time * frame.time, acceleration * frame.time];
            let of_step = 0.5 * rate / 240.0 + 1e-9;
            assert!((angle - expected).abs() <= of_step, "t = {}: {angle} instead of {expected}", frame.time);
            for (body, rate) in [(first, rate), (second, -2.0 * rate)] {
                assert!((body.angular_velocity.y - rate).abs() < 1e-9, "{} {rate}", body.angular_velocity);
            }
        }
        assert!(angle > PI, "{angle}");
    }
}

/// Checks that a heap falls alike wherever it stands. Eighteen boxes of random sizes make an island with more than sixty contact points. The
/// search for impacts ends at 1e-5 of the largest rate, about 1 m/s. In a step of 1/256 s, this error moves a body by 4e-8 m, and it grows
/// during the next impacts. A search that ends at 1e-3 fails the test. The test ends early: later, an impact may fall into one step or the
/// next, and then the motions differ by more.
#[test]
fn a_heap_falls_alike_wherever_it_is() {
    let heap = |x: f64| {
        let mut text = format!(
            "[simulation]\ncontacts = 'time-stepping'\nstep = '1/256'\ngravity = [0, -9.81, 0]\nduration = 0.1875\nframe_rate = 32\n\
             [defaults.body]\nfriction = 0.4\nrestitution = 0.3\n\
             [body.floor]\nshape.box.size = [8, 1, 8]\nfixed = true\nlocation = [{x}, -0.5, 0]\n"
        );
        let mut random = Stream::new(5, "heap");
        let mut within = |from: f64, to: f64| from + (to - from) * random.uniform();
        for number in 0..18 {
            let [i, j, k] = [number / 6, number / 3 % 2, number % 3].map(f64::from);
            let size: [f64; 3] = std::array::from_fn(|_| within(0.3, 0.5));
            let place = [x + 0.6 * i + within(-0.05, 0.05), 0.3 + 0.55 * j, 0.6 * k + within(-0.05, 0.05)];
            text += &format!("[body.b{number}]\nshape.box.size = {size:?}\nlocation = {place:?}\n");
        }
        frames(&text).remove(6)
    };
    let here = heap(0.0);
    for shift in [1e-3, 1.0, 1000.0] {
        let there = heap(shift);
        for (one, other) in here.bodies.iter().zip(&there.bodies) {
            let apart = (one.location + shift * DVec3::X - other.location).length();
            assert!(apart < 1e-5, "{shift}: {apart}");
        }
    }
}

/// Returns a rope of links that lies on a fixed drum by half a turn. Its ends carry 1 kg and `load` kg.
fn capstan(load: f64) -> String {
    let (links, radius, rope) = (36, 0.3, 0.02);
    let (around, bend) = (24, 180.0 / 24.0);
    let arm: f64 = radius + rope + 0.001;
    // The links over the drum are chords of it, between joints at this distance from its axis.
    let chord = 2.0 * arm * libm::sin(0.5 * f64::to_radians(bend));
    let mut text = format!(
        "[simulation]\nduration = 1\ngravity = [0, -9.81, 0]\ncontacts = 'time-stepping'\n\
         [environment]\nground = false\n[defaults.body]\nfriction = 0.3\n\
         [body.drum]\nshape.cylinder = {{ radius = {radius}, height = 0.3 }}\norientation = [90, 0, 0]\nfixed = true\n"
    );
    let hanging = (links - around) / 2;
    let joint = |k: i32| {
        let over = k - hanging;
        if over < 0 {
            return [-arm, f64::from(over) * chord];
        }
        if over > around {
            return [arm, f64::from(around - over) * chord];
        }
        let angle = f64::to_radians(180.0 - bend * f64::from(over));
        [arm * libm::cos(angle), arm * libm::sin(angle)]
    };
    for k in 0..links {
        let [[x0, y0], [x1, y1]] = [joint(k), joint(k + 1)];
        let (x, y) = (0.5 * (x0 + x1), 0.5 * (y0 + y1));
        let turn = libm::atan2(y1 - y0, x1 - x0).to_degrees() - 90.0;
        text += &format!(
            "[body.l{k}]\nshape.capsule = {{ radius = {rope}, height = {} }}\nlocation = [{x}, {y}, 0]\norientation = [0, 0, {turn}]\n\
             mass = 0.01\ncollision_group = 'rope'\n",
            chord + 2.0 * rope
        );
        if k > 0 {
            text += &format!("[joint.j{k}.ball]\nbetween = ['l{}', 'l{k}']\nat = [{x0}, {y0}, 0]\n", k - 1);
        }
    }
    for (name, mass, k, link) in [("light", 1.0, 0, 0), ("heavy", load, links, links - 1)] {
        let [x, y] = joint(k);
        text += &format!(
            "[body.{name}]\nshape.sphere.radius = 0.08\nmass = {mass}\nlocation = [{x}, {}, 0]\ncollision_group = 'rope'\n\
             [joint.{name}.ball]\nbetween = ['l{link}', '{name}']\nat = [{x}, {y}, 0]\n",
            y - 0.08
        );
    }
    text
}

/// Checks the equation of Euler and Eytelwein: a rope with friction µ = 0.3 around half a drum holds loads as unequal as exp(0.3 π) = 2.566
/// to 1. A load of 2.2 kg settles by less than a centimeter, until all links lie on the drum; one of 3 kg falls by more than 10 cm.
#[test]
fn a_rope_around_a_drum_holds_what_its_friction_can() {
    for (load, moved) in [(2.2, 0.0..0.01), (3.0, 0.1..2.0)] {
        let frames = frames(&capstan(load));
        let height = |frame: &Frame| frame.bodies.last().unwrap().location.y;
        let fallen = height(&frames[0]) - height(last(&frames));
        assert!(moved.contains(&fallen), "{load} kg: {fallen} m");
    }
}

/// Checks that a heap moves as it does alone while a pendulum with a limit swings far away from it: each is computed by itself. Free flight
/// differs by rounding. The search for impulses ends at 1e-7 of the largest rate, some 5 m/s, which moves a body by 2e-9 m in a step, and the next impacts make
/// this some hundred times larger.
#[test]
fn a_heap_beside_a_mechanism_moves_as_it_does_alone() {
    let heap = "
        simulation = { duration = 0.48, gravity = [0, -9.81, 0], contacts = 'time-stepping' }
        [defaults.body]
        friction = 0.4
        restitution = 0.2
        [body.box]
        shape.box.size = [0.4, 0.3, 0.5]
        location = ['0.1*sin(2*i)', '0.6 + 0.65*i', '0.1*cos(3*i)']
        orientation = [0, '20*i', '5*i']
        repeat = 12
        [body.ball]
        shape.sphere.radius = 0.2
        location = ['0.7*cos(i)', 0.2, '0.7*sin(i)']
        repeat = 6
        ";
    let mechanism = "
        [body.arm]
        shape.box.size = [1, 0.1, 0.1]
        location = [20.5, 3, 0]
        [joint.hinge.hinge]
        between = [[20, 3, 0], 'arm']
        axis = [0, 0, 1]
        limits = [-60, 10]
        ";
    let [alone, beside] = [heap.to_owned(), format!("{heap}{mechanism}")].map(|text| frames(&text));
    assert!(beside.iter().any(|frame| !frame.contacts.is_empty()));
    for (alone, beside) in alone.iter().zip(&beside) {
        for (one, other) in alone.bodies.iter().zip(&beside.bodies) {
            let apart = one.location.distance(other.location);
            assert!(apart < 1e-6, "{apart} m at {} s", alone.time);
        }
    }
}

/// Checks the force of a hinge that carries a swinging bar of length ℓ, released level: along the bar, it is 5/2 m g sin α at the angle α below
/// the level; across it, m g cos α / 4. The scheme is of second order in free motion: at 5.4 rad/s, half a step turns the bar by 0.011 rad.
#[test]
fn a_hinge_carries_a_swinging_bar() {
    let frames = frames(
        "
        [simulation]
        duration = 2
        gravity = [0, -9.81, 0]
        contacts = 'time-stepping'
        [environment]
        ground = false
        [body.bar]
        shape.box.size = [1, 1e-3, 1e-3]
        location = [0.5, 0, 0]
        mass = 2
        [joint.hinge.hinge]
        between = [[0, 0, 0], 'bar']
        at = [0, 0, 0]
        axis = [0, 0, 1]
        ",
    );
    for frame in &frames[1..] {
        let along = frame.bodies[0].location.normalize();
        let [sine, cosine] = [-along.y, along.x];
        let across = DVec3::Z.cross(along);
        let force = 2.0 * 9.81 * (0.25 * cosine * across - 2.5 * sine * along);
        let off = frame.reactions[0].force.distance(force);
        assert!(off < 0.011 * 0.011 * 50.0, "t = {} s: off by {off} N of {}", frame.time, force.length());
    }
}

/// Checks a motor that keeps an angle exactly while a box lies on its arm and slides off it.
#[test]
fn an_exact_motor_keeps_its_angle_under_a_load() {
    let frames = frames(
        "
        [simulation]
        duration = 1
        gravity = [0, -9.81, 0]
        contacts = 'time-stepping'
        [defaults.body]
        friction = 0.2
        [body.arm]
        shape.box.size = [2, 0.1, 0.4]
        location = [0, 1, 0]
        mass = 5
        [body.box]
        shape.box.size = [0.2, 0.2, 0.2]
        location = [0.5, 1.15, 0]
        mass = 1
        [joint.hinge.hinge]
        between = [[0, 1, 0], 'arm']
        axis = [0, 0, 1]
        motor.angle = '40*t'
        ",
    );
    for frame in &frames {
        let (axis, angle) = frame.bodies[0].orientation.to_axis_angle();
        let off = (axis.z * angle).to_degrees() - 40.0 * frame.time;
        assert!(off.abs() < 1e-9, "t = {} s: {off}°", frame.time);
    }
    // At 11.3°, the slope becomes steeper than the friction can hold.
    let slid = last(&frames).bodies[1].location;
    assert!(slid.distance(DVec3::new(0.5, 1.15, 0.0)) > 0.3, "{slid}");
}

/// Checks that an arm on a hinge rebounds by the coefficient of restitution, whatever the friction: the speed of the point that hits is
/// proportional to the angular velocity. Gravity changes this by 3 g / 2ℓ · Δt in a step, 0.06 rad/s.
#[test]
fn an_arm_on_a_hinge_rebounds_by_its_restitution() {
    for friction in [0.0, 0.3, 1.0] {
        let text = format!(
            "
            [simulation]
            duration = 0.7
            frame_rate = 240
            gravity = [0, -9.81, 0]
            contacts = 'time-stepping'
            [defaults.body]
            restitution = 0.5
            friction = {friction}
            [body.arm]
            shape.box.size = [0.1, 1, 0.1]
            location = [0.5, 1.5, 0]
            orientation = [0, 0, 90]
            [body.block]
            shape.box.size = [0.2, 0.4, 0.4]
            location = [-0.4, 0.7, 0]
            fixed = true
            [joint.axle.hinge]
            between = [[0, 1.5, 0], 'arm']
            axis = [0, 0, 1]
            "
        );
        let speeds: Vec<f64> = frames(&text).iter().map(|frame| frame.bodies[0].angular_velocity.z).collect();
        let hit = speeds.windows(2).find(|two| two[0] < 0.0 && two[1] > 0.0).unwrap();
        assert!((hit[1] + 0.5 * hit[0]).abs() < 0.06, "friction {friction}: {hit:?}");
    }
}

//! Tests of particles that collide with bodies and the ground.

use glam::DVec3;
use jabuka::simulate::{Frame, Frames, Recorded, Selection};
use jabuka::{Run, Scene};

const G: f64 = 9.81;

fn scene(text: &str) -> Scene {
    Scene::parse(text).unwrap_or_else(|report| panic!("{}", report.to_text(false)))
}

fn frames(text: &str) -> Vec<Frame> {
    Frames::new(&scene(text)).map(Result::unwrap).collect()
}

/// Simulates a scene with one particle. Returns its time, location and velocity in each frame.
fn path(text: &str) -> Vec<(f64, DVec3, DVec3)> {
    let one = |frame: Frame| {
        let particle = frame.particles[0][0];
        (frame.time, particle.location, particle.velocity)
    };
    frames(text).into_iter().map(one).collect()
}

/// Checks the height of rebounds. Under gravity alone, methods of order 2 and higher are exact up to rounding. In flight, y − r + v²/2g is
/// the height of the next apex; each impact multiplies it by the square of the restitution.
#[test]
fn a_rebound_is_as_high_as_the_restitution_says() {
    for method in ["velocity-verlet", "rk4"] {
        let path = path(&format!(
            "simulation = {{ duration = 3, gravity = [0, -{G}, 0], integrator = '{method}', contacts = 'event-driven' }}
            environment.ground.height = 0
            [emitter.one]\nshape.sphere.radius = 0.1\nburst = 1\nfrom.point = [0, 1.1, 0]
            collides = true\nrestitution = 0.8"
        ));
        let mut impacts = 0;
        let mut seen = vec![1.0];
        for (time, place, velocity) in path {
            let apex = place.y - 0.1 + velocity.y * velocity.y / (2.0 * G);
            if apex < 0.9 * seen[impacts] {
                impacts += 1;
                seen.push(apex);
            }
            let expected = libm::pow(0.64, f64::from(u32::try_from(impacts).unwrap()));
            assert!((apex - expected).abs() < 1e-9, "{method} {time}: {apex} {expected}");
        }
        assert!(impacts >= 5, "{impacts}");
    }
}

/// Checks sliding friction: under a constant acceleration each step is exact, so the states at the frames are exact up to rounding.
#[test]
fn friction_slows_down_what_slides_and_stops_it() {
    let (mu, speed) = (0.3, 2.0);
    for (scheme, method) in
        [("event-driven", "velocity-verlet"), ("event-driven", "rk4"), ("time-stepping", "euler-cromer")]
    {
        let path = path(&format!(
            "simulation = {{ duration = 1.5, gravity = [0, -{G}, 0], integrator = '{method}', contacts = '{scheme}' }}
            environment.ground.height = 0
            [emitter.one]\nshape.sphere.radius = 0.05\nburst = 1\nfrom.point = [0, 0.05, 0]
            direction = [0.6, 0, 0.8]\nspeed = {speed}\ncollides = true\nfriction = {mu}"
        ));
        let along = DVec3::new(0.6, 0.0, 0.8);
        let stop = speed / (mu * G);
        assert!(stop < 1.0);
        let mut last = None;
        for (time, place, velocity) in path {
            let t = time.min(stop);
            let way = speed * t - 0.5 * mu * G * t * t;
            let expected = way * along + 0.05 * DVec3::Y;
            assert!(place.distance(expected) < 1e-6, "{method} {time}: {place} {expected}");
            assert!(velocity.distance((speed - mu * G * t) * along) < 1e-6, "{method} {time}: {velocity}");
            if time > stop + 0.05 {
                assert_eq!(*last.get_or_insert(place), place, "it stays");
                assert_eq!(velocity, DVec3::ZERO);
            }
        }
    }
}

/// Returns the path of a particle on a slope of 30°, with this coefficient of friction.
fn slope(mu: f64) -> Vec<(f64, DVec3, DVec3)> {
    let (normal, radius) = (DVec3::new(-0.5, 0.75_f64.sqrt(), 0.0), 0.02);
    // The upper face of the box contains the origin.
    let start = normal * radius;
    let centre = normal * -0.5;
    path(&format!(
        "simulation = {{ duration = 1, gravity = [0, -{G}, 0], integrator = 'velocity-verlet', contacts = 'event-driven' }}
        environment.ground = false
        [body.slope]\nshape.box.size = [20, 1, 20]\nlocation = [{}, {}, 0]\norientation = [0, 0, 30]\nfixed = true
        friction = {mu}
        [emitter.one]\nshape.sphere.radius = {radius}\nburst = 1\nfrom.point = [{}, {}, 0]\ncollides = true",
        centre.x, centre.y, start.x, start.y
    ))
}

#[test]
fn a_slope_holds_up_to_the_angle_of_friction() {
    // The angle of friction is reached at tan 30° = 0.577.
    let held = slope(0.6);
    for (time, place, velocity) in &held {
        assert!(place.distance(held[0].1) < 1e-12 && velocity.length() < 1e-12, "{time}: {place} {velocity}");
    }
    let down = -DVec3::new(0.75_f64.sqrt(), 0.5, 0.0);
    let acceleration = G * (0.5 - 0.5 * 0.75_f64.sqrt());
    let slid = slope(0.5);
    for (time, place, velocity) in &slid {
        assert!(velocity.distance(acceleration * time * down) < 1e-6, "{time}: {velocity}");
        let way = 0.5 * acceleration * time * time * down;
        assert!((*place - slid[0].1).distance(way) < 1e-6, "{time}: {place}");
    }
}

/// Checks that a fast particle does not pass through a thin wall: it moves 8 m within a step of 4 ms.
#[test]
fn no_wall_is_too_thin_for_what_is_fast() {
    let path = path(
        "simulation = { duration = 0.2, step = 0.004, contacts = 'event-driven', integrator = 'velocity-verlet' }
        environment.ground = false
        [body.wall]\nshape.box.size = [0.01, 50, 50]\nlocation = [3, 0, 0]\nfixed = true
        [emitter.one]\nshape.sphere.radius = 0.001\nburst = 1\ndirection = [1, 0, 0]\nspeed = 2000
        collides = true\nrestitution = 0.5",
    );
    let last = path.last().unwrap();
    assert!(path.iter().all(|(_, place, _)| place.x < 2.995 - 0.001 + 1e-9));
    assert!((last.2.x + 1000.0).abs() < 1e-6, "{}", last.2);
    // The particle hits the wall after 2.994 m, and returns at half its speed.
    let expected = 2.994 - (last.0 - 2.994 / 2000.0) * 1000.0;
    assert!((last.1.x - expected).abs() < 1e-6, "{} {expected}", last.1);
}

/// Checks the rebound from a moving paddle. Between frames, the location of a paddle with constant speed is exact up to rounding.
#[test]
fn a_paddle_throws_with_twice_its_speed() {
    let path = path(
        "simulation = { duration = 1, contacts = 'event-driven', integrator = 'velocity-verlet' }
        environment.ground = false
        [body.paddle]\nshape.box.size = [0.1, 1, 1]\nmotion.formula.location = ['3*t - 1', 0, 0]
        [emitter.one]\nshape.sphere.radius = 0.05\nburst = 1\ncollides = true\nrestitution = 1",
    );
    let (first, last) = (path[0], path[path.len() - 1]);
    assert_eq!((first.1, first.2), (DVec3::ZERO, DVec3::ZERO));
    assert!(last.2.distance(6.0 * DVec3::X) < 1e-9, "{}", last.2);
    // The paddle moves 1 m, less half its thickness and the particle's radius, before it hits the particle.
    let hit = 0.9 / 3.0;
    assert!((last.1.x - 6.0 * (last.0 - hit)).abs() < 1e-9, "{}", last.1);
}

/// Checks that grains move with a body that carries them: a lift that starts and stops, and a turntable.
#[test]
fn what_moves_carries_what_rests_on_it() {
    let lift = path(&format!(
        "simulation = {{ duration = 2, gravity = [0, -{G}, 0], contacts = 'event-driven', integrator = 'rk4' }}
        environment.ground = false
        [body.lift]\nshape.box.size = [1, 0.1, 1]\nmotion.formula.location = ['0.3*sin(3*t)', '0.5*sin(2*t)', 0]
        [emitter.one]\nshape.sphere.radius = 0.05\nburst = 1\nfrom.point = [0, 0.1, 0]\nspeed = 0
        collides = true\nfriction = 2"
    ));
    for (time, place, _) in &lift[2..] {
        let height = 0.5 * libm::sin(2.0 * time) + 0.1;
        // Within a frame of 40 ms, the lift's path is interpolated by a cubic, with an error of (0.04)⁴ · 16 · 0.5/384 m.
        assert!((place.y - height).abs() < 1e-7, "{time}: {} {height}", place.y);
        let aside = place.x - 0.3 * libm::sin(3.0 * time);
        assert!(aside.abs() < 1e-6, "{time}: {aside}");
    }
    // The acceleration 2² · 0.5 m/s² is less than 0.5 g, and more than 0.2 g.
    for (time, place, _) in &table(0.5) {
        let expected = DVec3::new(0.5 * libm::cos(2.0 * time), 0.15, -0.5 * libm::sin(2.0 * time));
        assert!(place.distance(expected) < 1e-9, "{time}: {place} {expected}");
    }
    let thrown = table(0.2).last().unwrap().1;
    assert!(libm::hypot(thrown.x, thrown.z) > 0.52 && (thrown.y - 0.15).abs() < 1e-9, "{thrown}");
}

/// Returns the path of a grain on a turntable, with this coefficient of friction.
fn table(friction: f64) -> Vec<(f64, DVec3, DVec3)> {
    path(&format!(
        "simulation = {{ duration = 2, gravity = [0, -{G}, 0], contacts = 'event-driven', integrator = 'rk4' }}
        environment.ground = false
        [body.table]\nshape.cylinder = {{ radius = 2, height = 0.2 }}\nmotion.formula.orientation = [0, 'deg(2*t)', 0]
        [emitter.one]\nshape.sphere.radius = 0.05\nburst = 1\nfrom = {{ point = [0.5, 0.15, 0], body = 'table' }}
        speed = 0\ncollides = true\nfriction = {friction}"
    ))
}

/// A scene with an open box of five walls, rotated about two axes.
const BOX: &str = "
    environment.ground = false
    [body.box]
    shape.compound.parts = [
        { box.size = [1, 0.1, 1] },
        { box.size = [0.1, 0.8, 1], location = [-0.5, 0.4, 0] },
        { box.size = [0.1, 0.8, 1], location = [0.5, 0.4, 0] },
        { box.size = [1, 0.8, 0.1], location = [0, 0.4, -0.5] },
        { box.size = [1, 0.8, 0.1], location = [0, 0.4, 0.5] },
    ]
    orientation = [15, 30, 20]
    fixed = true
    [emitter.grains]
    shape.sphere.radius = 0.02
    from.box = { location = [0, 0.8, 0], size = [0.3, 0.3, 0.3] }
    rate = 400
    end = 0.4975
    spread = 180
    speed = 0.5
    collides = true
    restitution = 0.3
    friction = 0.4
    ";

#[test]
fn grains_stay_in_a_box_that_they_are_poured_into() {
    for (scheme, method) in [("event-driven", "velocity-verlet"), ("time-stepping", "euler-cromer")] {
        let text = format!(
            "simulation = {{ duration = 4, gravity = [0, -{G}, 0], contacts = '{scheme}', integrator = '{method}' }}{BOX}"
        );
        let all = frames(&text);
        let body = all[0].bodies[0];
        let within = |place: DVec3| {
            let local = body.orientation.conjugate() * (place - body.location);
            // The walls raise the center of mass above the center of the floor, so only x and z are simple limits.
            local.x.abs() < 0.43 + 1e-9 && local.z.abs() < 0.43 + 1e-9
        };
        let last = all.last().unwrap();
        assert_eq!(last.particles[0].len(), 200);
        for grain in last.particles[0].iter() {
            assert!(within(grain.location), "{method} {}: {}", grain.number, grain.location);
            assert!(
                grain.velocity.length() < 1e-6,
                "{method} {} is at rest: {}",
                grain.number,
                grain.velocity
            );
        }
        // All grains lie on the floor or in its corners; none has fallen through.
        let lowest = |grain: DVec3| (body.orientation.conjugate() * (grain - body.location)).y;
        let low = last.particles[0].iter().map(|grain| lowest(grain.location)).fold(f64::INFINITY, f64::min);
        let high =
            last.particles[0].iter().map(|grain| lowest(grain.location)).fold(f64::NEG_INFINITY, f64::max);
        assert!(high - low < 1e-6, "{low} {high}");
    }
}

#[test]
fn frames_alone_have_the_grains_of_the_whole_run() {
    let poured = BOX.replace("end = 0.4975", "");
    let text = format!(
        "simulation = {{ duration = 2.4, gravity = [0, -{G}, 0], contacts = 'event-driven', integrator = 'velocity-verlet' }}{poured}
        lifetime = 'uniform(0.5, 1.5)'
        [body.paddle]\nshape.box.size = [0.3, 0.1, 0.3]
        motion.formula = {{ location = ['0.2*sin(4*t)', 0.6, 0], orientation = [0, 0, '90*t'] }}"
    );
    let scene = scene(&text);
    let run = Run::new(&scene).unwrap();
    let whole: Vec<String> = run.frames().map(|frame| run.script(&frame.unwrap()).unwrap()).collect();
    let recorded = Recorded::new(&scene).unwrap();
    for list in ["50", "7,31-33", "60"] {
        let selection: Selection = list.parse().unwrap();
        for exposure in recorded.exposures(&selection) {
            let frame = exposure.unwrap().frame;
            assert!(frame.index < 10 || frame.particles[0].len() > 20);
            assert_eq!(run.script(&frame).unwrap(), whole[frame.index], "{} of {list}", frame.index);
        }
    }
}

/// Checks that a particle far from all obstacles moves as without them, to the last bit.
#[test]
fn what_touches_nothing_moves_as_without_obstacles() {
    let text = |collides: bool| {
        format!(
            "simulation = {{ duration = 1, gravity = [0, -{G}, 0], contacts = 'event-driven', integrator = 'velocity-verlet' }}
            environment.ground.height = -20
            [body.far]\nshape.sphere.radius = 1\nlocation = [9, 0, 0]\nfixed = true
            [emitter.a]\nshape.sphere.radius = 0.01\nrate = 500\nspeed = 3\nspread = 30\ncollides = {collides}
            [force.air.drag]\nlinear = 0.4"
        )
    };
    let [with, without] = [true, false].map(|collides| frames(&text(collides)));
    for (with, without) in with.iter().zip(&without) {
        assert_eq!(with.particles, without.particles);
    }
}

/// Checks that a particle emitted inside a body passes out of it.
#[test]
fn what_begins_within_a_body_leaves_it() {
    let path = path(
        "simulation = { duration = 1, contacts = 'event-driven', integrator = 'velocity-verlet' }
        environment.ground = false
        [body.nozzle]\nshape.sphere.radius = 0.5\nfixed = true
        [emitter.one]\nshape.sphere.radius = 0.01\nburst = 1\nfrom.point = [0, -0.3, 0]\nspeed = 2
        collides = true",
    );
    assert!(path.iter().all(|(time, place, _)| (place.y + 0.3 - 2.0 * time).abs() < 1e-12));
}

/// Checks a particle that slides down a ball without friction: it leaves the ball when its height above the center has fallen to two
/// thirds of the initial height. It slides in steps of 1 ms, with an error of second order.
#[test]
fn what_slides_down_a_ball_leaves_it_at_two_thirds_of_its_height() {
    let (radius, small) = (1.0, 0.01);
    let (sin, cos) = libm::sincos(0.1);
    let reach = radius + small;
    let path = path(&format!(
        "simulation = {{ duration = 1.6, frame_rate = 1000, step = 0.001, gravity = [0, -{G}, 0], contacts = 'event-driven', integrator = 'rk4' }}
        environment.ground = false
        [body.ball]\nshape.sphere.radius = {radius}\nfixed = true\nfriction = 0
        [emitter.one]\nshape.sphere.radius = {small}\nburst = 1\nfrom.point = [{}, {}, 0]\nspeed = 0
        collides = true",
        reach * sin, reach * cos
    ));
    let left = path.iter().find(|(_, place, _)| place.length() > reach + 1e-7).unwrap();
    assert!((left.1.y / (reach * cos) - 2.0 / 3.0).abs() < 3e-3, "{}", left.1.y / (reach * cos));
    for (time, place, velocity) in &path {
        let energy = 0.5 * velocity.length_squared() + G * (place.y - reach * cos);
        assert!(energy.abs() < 1e-5, "{time}: {energy}");
    }
}

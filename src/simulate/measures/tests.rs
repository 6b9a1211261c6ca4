//! Tests measures against closed forms.

use super::*;

/// Two bodies, of 2 kg and 3 kg. Momenta and angular momenta are sums of m v and of x × m v; the power of gravity on the first is
/// F·v = 2 · (−10) · 4 W.
#[test]
fn momenta_and_power_are_those_of_mechanics() {
    let text = "simulation = { duration = 1, gravity = [0, -10, 0] }
        [body.a]\nshape.sphere.radius = 0.1\nmass = 2\nlocation = [1, 0, 0]\nvelocity = [3, 4, 0]
        [body.b]\nshape.sphere.radius = 0.1\nmass = 3\nlocation = [0, 2, 0]\nvelocity = [-1, 0, 5]
        [plot.all]\ny = ['px', 'py', 'pz', 'lx', 'ly', 'lz', 'a.px', 'b.pz']
        [plot.power]\ny = 'a.power'\n";
    let scene = Scene::parse(text).unwrap();
    let (measures, frame) =
        (Measures::new(&scene), crate::simulate::Frames::new(&scene).next().unwrap().unwrap());
    let values = |plot: usize| -> Vec<f64> {
        let curves = scene.plots[plot].curves.iter();
        curves.map(|curve| measures.value(&curve.y, &MomentState::now(&frame))).collect()
    };
    // x × m v: (1, 0, 0) × (6, 8, 0) = (0, 0, 8), and (0, 2, 0) × (−3, 0, 15) = (30, 0, 6).
    let expected = [3.0, 8.0, 15.0, 30.0, 0.0, 14.0, 6.0, 15.0];
    for (value, expected) in values(0).iter().zip(expected) {
        assert!((value - expected).abs() < 1e-12, "{:?}", values(0));
    }
    assert!((values(1)[0] + 80.0).abs() < 1e-12, "{:?}", values(1));
}

/// Returns the values of the curves of all plots in each frame of a scene, with the frames.
fn curves(text: &str) -> Vec<(Frame, Vec<f64>)> {
    let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{report}"));
    let measures = Measures::new(&scene);
    let frames = crate::simulate::Frames::new(&scene).map(Result::unwrap);
    let values = |frame: Frame| {
        let moment = MomentState::now(&frame);
        let curves = scene.plots.iter().flat_map(|plot| &plot.curves);
        let values = curves.map(|curve| measures.value(&curve.y, &moment)).collect();
        (frame, values)
    };
    frames.map(values).collect()
}

fn assert_near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12 * expected.abs().max(1.0), "{found} is not {expected}");
    }
}

/// Drag with a wind: F = −(c₁ + c₂ |u|) u, where u is the velocity in the air. A spring at a fixed body: F = −k (ℓ − ℓ₀) along its line.
/// A formula of location and time. Each in every frame, beside gravity, and while other bodies come and go.
#[test]
fn the_force_of_each_name_is_that_of_its_law() {
    let text = "simulation = { duration = 1, gravity = [0, -10, 0], integrator = 'rk4' }
        [body.guest]\nshape.sphere.radius = 0.1\nlocation = [0, 9, 0]\nstart = 0.3\nend = 0.6
        [body.ball]\nshape.sphere.radius = 0.1\nmass = 2\nlocation = [1, 2, 3]\nvelocity = [3, 4, 0]
        [body.wall]\nshape.sphere.radius = 0.1\nlocation = [-1, 0, 0]\nfixed = true
        [force.air.drag]\nlinear = 0.5\nquadratic = 0.2\nwind = [1, 0, -1]
        [force.rope.spring]\nbetween = ['ball', 'wall']\nstiffness = 7\nrest_length = 0.5
        [force.law.formula]\non = ['ball']\nforce = ['-x*t', '2*vy', 0]
        [plot.p]\ny = ['force.air.ball.x', 'force.air.ball.size', 'force.air.ball.power', 'force.rope.x', 'force.rope.y',
            'force.law.x', 'force.law.y', 'force.air.guest.y']\n";
    let mut seen = [false; 2];
    for (frame, values) in curves(text) {
        let ball = frame.body(1).unwrap();
        let relative = ball.velocity - DVec3::new(1.0, 0.0, -1.0);
        let drag = -(0.5 + 0.2 * relative.length()) * relative;
        let span = ball.location - DVec3::NEG_X;
        let pull = -7.0 * (span.length() - 0.5) * span.normalize();
        let law = [-ball.location.x * frame.time, 2.0 * ball.velocity.y];
        assert_near(
            &values[..7],
            &[drag.x, drag.length(), drag.dot(ball.velocity), pull.x, pull.y, law[0], law[1]],
        );
        let guest = frame.body(0);
        seen[usize::from(guest.is_some())] = true;
        assert_eq!(values[7].is_nan(), guest.is_none(), "{}", frame.time);
    }
    assert_eq!(seen, [true; 2]);
}

/// The force of a pair on its two bodies is opposite, and its total power is that at which the kinetic energy changes, dK/dt. The power of
/// a torque counts as well: 2 N·m at ω = t · 2 N·m / I.
#[test]
fn the_power_of_a_force_is_that_on_all_its_bodies() {
    let text = "simulation = { duration = 0.5, frame_rate = 1000, integrator = 'rk4' }
        [body.a]\nshape.sphere.radius = 0.1\nmass = 2
        [body.b]\nshape.sphere.radius = 0.1\nmass = 3\nlocation = [2, 0, 0]\nvelocity = [0, 1, 0]
        [force.g.gravitation]\nconstant = 5
        [plot.p]\ny = ['force.g.power', 'force.g.a.x', 'force.g.b.x', 'force.g.a.power + force.g.b.power', 'kinetic']\n";
    let frames = curves(text);
    for around in frames.windows(3) {
        let [before, now, after] = around else { unreachable!() };
        let rate = (after.1[4] - before.1[4]) / (after.0.time - before.0.time);
        assert!((now.1[0] - rate).abs() < 1e-4 * rate.abs().max(1.0), "{} {rate}", now.1[0]);
        assert_near(&[now.1[1], now.1[3]], &[-now.1[2], now.1[0]]);
    }
    assert_near(&[frames[0].1[1]], &[5.0 * 2.0 * 3.0 / 4.0]);
    let text = "simulation = { duration = 1, integrator = 'rk4' }
        [body.top]\nshape.sphere.radius = 0.5\nmass = 10
        [force.turn.constant]\ntorque = [0, 2, 0]
        [plot.p]\ny = 'force.turn.power'\n";
    for (frame, values) in curves(text) {
        assert!((values[0] - 2.0 * 2.0 * frame.time).abs() < 1e-9, "{values:?}");
    }
}

#[test]
fn a_distance_is_that_of_the_centers() {
    let text = "simulation = { duration = 1 }
        [body.a]\nshape.sphere.radius = 0.1\nvelocity = [3, 4, 0]
        [body.wall]\nshape.sphere.radius = 0.1\nlocation = [0, 0, 12]\nfixed = true
        [body.guest]\nshape.sphere.radius = 0.1\nlocation = [0, 9, 0]\nstart = 0.5
        [plot.p]\ny = ['a.distance.wall', 'wall.distance.a', 'a.distance.guest']\n";
    let frames = curves(text);
    for (frame, values) in &frames {
        let expected = (25.0 * frame.time * frame.time + 144.0).sqrt();
        assert_near(&values[..2], &[expected; 2]);
        assert_eq!(values[2].is_nan(), frame.body(2).is_none());
    }
}

/// A body on a given circle: ½ m (r ω)² + ½ I ω² with m = 2 kg, r = 3 m, ω = 2 rad/s, and I = 0.4 m 0.1² of a ball that turns at 1 rad/s. A
/// free body beside it has its own 9 J.
#[test]
fn the_kinetic_energy_of_the_scene_counts_bodies_with_a_given_motion() {
    let text = "simulation.duration = 1
        [body.a]\nshape.sphere.radius = 0.1\nmass = 2
        motion.formula.location = ['3*cos(2*t)', '3*sin(2*t)', 0]\nmotion.formula.orientation = [0, 'deg(t)', 0]
        [body.b]\nshape.sphere.radius = 0.1\nmass = 2\nlocation = [9, 0, 0]\nvelocity = [0, 0, 3]\n";
    let scene = Scene::parse(text).unwrap();
    for frame in crate::simulate::Frames::new(&scene).map(Result::unwrap) {
        let all: f64 = [0, 1]
            .map(|body| of_body(&scene.bodies[body], &frame.bodies[body], BodyMeasure::Kinetic))
            .iter()
            .sum();
        let found = frame.balance.kinetic_of_all();
        assert!((found - (36.0 + 0.5 * 0.4 * 2.0 * 0.01 + 9.0)).abs() < 1e-9, "{found}");
        assert!((found - all).abs() < 1e-9 && (frame.balance.total_of_all() - all).abs() < 1e-9);
        assert_eq!(frame.balance.error, 0.0);
    }
}

/// The kinetic energy of the only moving body equals that of the whole run, even for a tumbling compound.
#[test]
fn the_kinetic_energy_of_a_body_is_that_of_translation_and_rotation() {
    let scene = Scene::parse(
        "
        simulation = { duration = 1, integrator = 'rk4' }
        [body.hammer]
        mass = 3
        velocity = [1, 2, 0]
        angular_velocity = [1, 2, 3]
        shape.compound.parts = [
            { box.size = [3, 1, 2] },
            { sphere.radius = 0.5, location = [1, 2, 0] },
        ]
        ",
    )
    .unwrap();
    for frame in crate::simulate::Frames::new(&scene).map(Result::unwrap) {
        let kinetic = of_body(&scene.bodies[0], &frame.bodies[0], BodyMeasure::Kinetic);
        assert!((kinetic / frame.balance.kinetic - 1.0).abs() < 1e-9, "{kinetic} {}", frame.balance.kinetic);
    }
}

/// The work of the forces on a body is its kinetic energy. So its power equals the rate of its kinetic energy, here for a ball that does not
/// turn, on a spring with damping and in the wind. The rate follows from the neighboring frames with an error of (Δt)²/6 times the third
/// derivative.
#[test]
fn the_power_of_a_body_is_the_rate_of_its_kinetic_energy() {
    let text = "simulation = { duration = 2, frame_rate = 1000, gravity = [0, -10, 0], integrator = 'rk4' }
        [body.a]\nshape.sphere.radius = 0.1\nmass = 2\nlocation = [1, 0, 0]\nvelocity = [3, 4, 0]
        [force.s.spring]\nbetween = ['a', [0, 0, 0]]\nstiffness = 30\ndamping = 2
        [force.d.drag]\nlinear = 0.4\nwind = [0, 0, 3]
        [plot.p]\ny = ['a.power', 'a.kinetic']\n";
    let scene = Scene::parse(text).unwrap();
    let measures = Measures::new(&scene);
    let values = |frame: Frame| -> [f64; 2] {
        [0, 1].map(|curve| measures.value(&scene.plots[0].curves[curve].y, &MomentState::now(&frame)))
    };
    let values: Vec<[f64; 2]> =
        crate::simulate::Frames::new(&scene).map(|frame| values(frame.unwrap())).collect();
    let largest = values.iter().map(|[power, _]| power.abs()).fold(0.0, f64::max);
    assert!(largest > 50.0, "{largest} W");
    for near in values.windows(3) {
        let rate = (near[2][1] - near[0][1]) / 0.002;
        assert!((near[1][0] - rate).abs() < 1e-4 * largest, "{} W, and {rate} J/s", near[1][0]);
    }
}

/// The forces on a body add up to its net force, which the simulation computes by another way: with gravity, a spring with damping, drag in the
/// wind, and a force that grows with time.
#[test]
fn the_named_forces_add_up_to_the_net_force() {
    let text = "simulation = { duration = 2, gravity = [0, -10, 0], integrator = 'rk4' }
        [body.a]\nshape.sphere.radius = 0.1\nmass = 2\nlocation = [1, 0, 0]\nvelocity = [3, 4, 1]
        [force.s.spring]\nbetween = ['a', [0, 0, 0]]\nstiffness = 30\ndamping = 2
        [force.d.drag]\nlinear = 0.4\nquadratic = 0.1\nwind = [0, 0, 3]
        [force.f.formula]\nforce = ['t', 'x*y', 0]
        [plot.p]\ny = ['force.s.x + force.d.x + force.f.x - a.fx', 'force.s.y + force.d.y + force.f.y - 20 - a.fy',
            'force.s.z + force.d.z + force.f.z - a.fz', 'force.s.power + force.d.power + force.f.power - 20*a.vy - a.power', 'a.force']\n";
    let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{report}"));
    let measures = Measures::new(&scene);
    let mut largest = 0.0_f64;
    for frame in crate::simulate::Frames::new(&scene).map(Result::unwrap) {
        let value = |curve: usize| measures.value(&scene.plots[0].curves[curve].y, &MomentState::now(&frame));
        largest = largest.max(value(4));
        assert!((0..4).all(|curve| value(curve).abs() < 1e-9), "{:?}", [0, 1, 2, 3].map(value));
    }
    assert!(largest > 30.0, "{largest} N");
}

/// The shares of all bodies in the potential energy add up to that of the run, with all kinds of forces and with fixed, guided and absent
/// bodies. A body that a fixed one pulls has all of the energy: −G M m/r and ½ k x².
#[test]
fn the_potential_energies_of_bodies_add_up_to_that_of_the_run() {
    let text = "simulation = { duration = 1, gravity = [0, -10, 0], integrator = 'rk4' }
        [body.sun]\nshape.sphere.radius = 0.1\nmass = 50\nfixed = true
        [body.planet]\nshape.sphere.radius = 0.1\nmass = 2\nlocation = [3, 0, 4]\nvelocity = [0, 2, 0]\nforce = [1, 2, 3]
        [body.atom]\nshape.sphere.radius = 0.1\nmass = 3\nlocation = ['5 + i', 1, 0]\ncharge = '1 + i'\nrepeat.count = 4
        [body.guest]\nshape.sphere.radius = 0.1\nmass = 4\nlocation = [0, 7, 1]\ncharge = 2\nstart = 0.3\nend = 0.7
        [body.guide]\nshape.sphere.radius = 0.1\nmass = 5\nmotion.formula.location = ['t', 2, 't^2']\ncharge = 3
        [force.pull.gravitation]\nconstant = 0.7\non = ['sun', 'planet']
        [force.all.gravitation]\nconstant = 0.2\nopening_angle = 0.5
        [force.charges.coulomb]\nconstant = 2\nsoftening = 0.1
        [force.atoms.lennard_jones]\non = ['atom']\nepsilon = 1.5\nsigma = 0.9
        [force.field.lorentz]\nelectric = [1, 2, 3]\nmagnetic = [0, 0, 1]
        [force.rope.spring]\nbetween = ['planet', [0, 1, 0]]\nstiffness = 7\nrest_length = 0.5
        [force.tie.spring]\nbetween = ['planet', 'atom[0]']\nstiffness = 5\nrest_length = 0.5
        [force.law.formula]\non = ['atom']\nforce = ['-3*x', 0, 0]\npotential = '1.5*x^2'
        [force.push.constant]\non = ['planet']\nforce = [0, 0, 5]
        [plot.p]\ny = ['sum(atom.potential) + planet.potential + guide.potential', 'sun.potential', 'guest.potential', 'potential']
        [plot.q]\ny = ['force.pull.potential', 'force.pull.planet.potential', 'force.rope.potential', 'force.tie.planet.potential',
            'force.tie.potential', 'sum(force.charges.atom.potential)', 'force.atoms.potential', 'sum(force.atoms.atom.potential)']\n";
    let mut seen = [false; 2];
    for (frame, values) in curves(text) {
        let guest = values[2];
        seen[usize::from(!guest.is_nan())] = true;
        let sum = values[0] + if guest.is_nan() { 0.0 } else { guest };
        // The tree sums the forces of far groups up, with an error of some thousandths for each direction of a pair.
        assert!((sum - values[3]).abs() < 1e-4 * values[3].abs(), "{sum} of {}", values[3]);
        let planet = frame.body(1).unwrap().location;
        let stretch = (planet - DVec3::Y).length() - 0.5;
        let gravitation = -0.7 * 50.0 * 2.0 / planet.length();
        assert_near(&values[4..7], &[gravitation, gravitation, 3.5 * stretch * stretch]);
        assert_near(&[values[1], 2.0 * values[7], values[11]], &[0.0, values[8], values[10]]);
        assert!(values[9] > 1.0, "{values:?}");
    }
    assert_eq!(seen, [true; 2]);
}

/// The angular momenta of two bodies add up to that of the run, also for a tumbling hammer, whose principal axes are not its own.
#[test]
fn the_angular_momenta_of_bodies_add_up_to_that_of_the_run() {
    let text = "simulation = { duration = 1, integrator = 'rk4' }
        [body.a]\nmass = 2\nlocation = [1, 2, 3]\nvelocity = [3, 4, 1]\nangular_velocity = [1, 5, 2]
        shape.compound.parts = [{ box.size = [3, 1, 2] }, { sphere.radius = 0.5, location = [1, 2, 0] }]
        [body.b]\nshape.sphere.radius = 0.5\nmass = 3\nlocation = [-4, 0, 1]\nvelocity = [0, 1, 2]\nangular_velocity = [0, 2, 0]
        [plot.p]\ny = ['a.lx + b.lx', 'a.ly + b.ly', 'a.lz + b.lz', 'lx', 'ly', 'lz']
        [plot.q]\ny = ['a.angular_momentum', 'sqrt(a.lx^2 + a.ly^2 + a.lz^2)', 'b.ly']\n";
    for (_, values) in curves(text) {
        assert_near(&values[..3], &values[3..6]);
        // The angular momentum of the ball: (z vx − x vz) m + ⅖ m r² ω = 3 · 8 + ⅖ · 3 · 0.25 · 2.
        assert_near(&values[6..], &[values[7], values[7], 24.6]);
    }
}

/// A block of 2 kg lies on the ground and is pulled with 3 N, less than friction can hold: the ground carries 20 N and holds with 3 N. The
/// accounts are those of the balance: a block that slides to rest from 2 m/s has lost its ½ m v² to friction.
#[test]
fn contact_forces_and_accounts_are_those_of_statics_and_of_the_balance() {
    let text = "simulation = { duration = 1, gravity = [0, -10, 0], contacts = 'event-driven' }
        [environment]\nground.height = 0
        [body.block]\nshape.box.size = [1, 1, 1]\nmass = 2\nlocation = [0, 0.5, 0]\nforce = [3, 0, 0]\nfriction = 0.4
        [body.sled]\nshape.box.size = [1, 1, 1]\nmass = 3\nlocation = [0, 0.5, 5]\nvelocity = [2, 0, 0]\nfriction = 0.4
        [body.ball]\nshape.sphere.radius = 0.1\nlocation = [0, 90, 0]
        [plot.p]\ny = ['block.normal_force', 'block.friction_force', 'ball.normal_force', 'friction', 'motors', 'limits', 'work',
            'impact_energy']\n";
    let frames = curves(text);
    for (frame, values) in &frames[1..] {
        assert!((values[0] - 20.0).abs() < 1e-6 && (values[1] - 3.0).abs() < 1e-6, "{values:?}");
        let accounts = frame.balance.accounts;
        let expected = [0.0, accounts.friction, 0.0, 0.0, accounts.work, accounts.impacts];
        assert_near(&values[2..], &expected);
    }
    let lost = frames.last().unwrap().1[3];
    assert!((lost + 6.0).abs() < 1e-3, "{lost} J");
}

/// A block of 3 kg slides down a slope of 30°. The slope carries m g cos 30° and rubs with μ times as much, by both policies, and also if the
/// whole scene is turned about the vertical and shifted. The arrow of weight and the measures of contact forces need no common axes.
#[test]
fn contact_forces_on_a_slope_are_the_same_by_both_policies_and_in_turned_axes() {
    let slope = std::f64::consts::FRAC_PI_6;
    let [normal, friction] = [3.0 * 10.0 * libm::cos(slope), 0.2 * 3.0 * 10.0 * libm::cos(slope)];
    for policy in ["event-driven", "time-stepping"] {
        for (turn, shift) in [(0.0, 0.0), (50.0, 40.0)] {
            let text = format!(
                "simulation = {{ duration = 0.4, gravity = [0, -10, 0], contacts = '{policy}' }}
                variables = {{ s = 'rad(30)', q = 'rad({turn})', away = {shift} }}
                [environment]\nground = false
                [defaults.body]\norientation = {{ axis = ['sin(q)', 0, 'cos(q)'], angle = -30 }}
                [body.slope]\nshape.box.size = [8, 0.2, 8]\nlocation = ['away', 0, 0]\nfixed = true
                [body.block]\nshape.box.size = [0.5, 0.4, 0.6]\nmass = 3\nfriction = 0.2
                location = ['away + 0.3*sin(s)*cos(q)', '0.3*cos(s)', '-0.3*sin(s)*sin(q)']
                [plot.p]\ny = ['block.normal_force', 'block.friction_force', 'block.speed']\n"
            );
            let frames = curves(&text);
            let (_, values) = frames.last().unwrap();
            assert!((values[0] - normal).abs() < 0.01 * normal, "{policy} {turn}: {values:?}, not {normal}");
            assert!(
                (values[1] - friction).abs() < 0.01 * normal,
                "{policy} {turn}: {values:?}, not {friction}"
            );
            assert!(values[2] > 1.0, "it slides: {values:?}");
        }
    }
}

/// Both policies give the shares of the same potentials: those of gravity and a spring.
#[test]
fn potential_energies_do_not_depend_on_the_contact_policy() {
    for policy in ["event-driven", "time-stepping"] {
        let text = format!(
            "simulation = {{ duration = 0.5, gravity = [0, -10, 0], contacts = '{policy}' }}
            [environment]\nground.height = 0
            [body.ball]\nshape.sphere.radius = 0.1\nmass = 2\nlocation = [0, 1, 0]
            [body.block]\nshape.box.size = [1, 1, 1]\nmass = 5\nlocation = [3, 0.5, 0]
            [force.tie.spring]\nbetween = ['ball', 'block']\nstiffness = 3\nrest_length = 1
            [plot.p]\ny = ['ball.potential + block.potential', 'potential', 'ball.potential - force.tie.ball.potential', '20*ball.y']\n"
        );
        for (_, values) in curves(&text) {
            assert_near(&[values[0], values[2]], &[values[1], values[3]]);
        }
    }
}

//! The reference problems: scenes whose final states are known.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use jabuka::Scene;
use jabuka::physics::{Accuracy, Dynamics, Snapshot};
use jabuka::simulate::world;

use super::orders::Counter;

/// A problem whose final state is known.
pub(crate) struct Reference {
    pub(crate) name: &'static str,
    /// The source of the known values.
    pub(crate) source: &'static str,
    /// The quantity whose error is measured.
    pub(crate) what: &'static str,
    /// The text of the scene, or the path of its file. A placeholder in braces stands for the method with its step or tolerance.
    scene: &'static str,
    /// The runs: a method, its step or tolerance, and its largest allowed error.
    pub(crate) runs: &'static [(&'static str, f64, f64)],
    /// Runs the scene, and returns its error.
    error: fn(&mut dyn Dynamics) -> f64,
}

/// The error of a run and its cost.
pub(crate) struct Outcome {
    pub(crate) error: f64,
    pub(crate) steps: u64,
    pub(crate) evaluations: u64,
}

impl Reference {
    /// Returns the path of the scene's file if it is a scene of the gallery.
    pub(crate) fn file(&self) -> Option<&'static str> {
        self.scene.ends_with(".toml").then_some(self.scene)
    }

    /// Runs the scene by a method with this step or tolerance.
    #[allow(clippy::panic, clippy::unwrap_used, reason = "it is part of tests")]
    pub(crate) fn run(&self, method: &str, setting: f64) -> Outcome {
        let is_adaptive = jabuka::physics::Method::by_name(method).unwrap().adaptive;
        let key = if is_adaptive { "tolerance" } else { "step" };
        let mut text = match self.file() {
            Some(path) => {
                let text = std::fs::read_to_string(path).unwrap();
                assert!(
                    text.contains("integrator = \"gauss-radau\""),
                    "{path} says its method as the page does"
                );
                text.replace("integrator = \"gauss-radau\"", "{method}")
            }
            None => self.scene.to_owned(),
        };
        text = text.replace("{method}", &format!("integrator = \"{method}\"\n{key} = {setting:e}"));
        let scene = Scene::parse(&text).unwrap_or_else(|report| panic!("{}: {report}", self.name));
        let counter = Counter::default();
        let mut world = world(&scene);
        world.add_force(counter.clone());
        let accuracy =
            Accuracy { tolerance: scene.simulation.tolerance, end: scene.simulation.timeline.end() };
        let mut run: Box<dyn Dynamics> = match scene.simulation.method.take_over {
            Some(ahead) => ahead(world, accuracy),
            None => Box::new(world),
        };
        let error = (self.error)(&mut *run);
        Outcome { error, steps: run.steps(), evaluations: counter.count() }
    }
}

/// Advances a run to a time. Returns the snapshot at this time.
#[allow(clippy::unwrap_used, reason = "it is part of tests")]
fn at(run: &mut dyn Dynamics, time: f64) -> Snapshot {
    run.advance(time, &[], &mut |_| {}).unwrap();
    run.snapshot().unwrap()
}

fn largest(off: impl Iterator<Item = f64>) -> f64 {
    off.fold(0.0, f64::max)
}

/// Returns the angular velocity of the first body in body axes, rad/s.
fn in_body(snapshot: &Snapshot) -> DVec3 {
    let body = snapshot.bodies[0];
    body.orientation.conjugate() * body.angular_velocity
}

/// Returns the angle of a pendulum about the origin from the downward vertical, rad. `place` is the location of its bob.
fn angle(place: DVec3) -> f64 {
    libm::atan2(place.x, -place.y)
}

/// Returns the relative error of a pendulum's period: after 25¼ periods the pendulum passes its lowest point.
fn period(run: &mut dyn Dynamics, period: f64) -> f64 {
    let time = 25.25 * period;
    let body = at(run, time).bodies[0];
    (angle(body.location) / body.velocity.length() / time).abs()
}

pub(crate) const REFERENCES: &[Reference] = &[
    Reference {
        name: "Projectile with linear drag",
        source: "closed form",
        what: "place at 3 s, of 100 m",
        scene: "[simulation]\nduration = 3\ngravity = [0, -9.81, 0]\n{method}\n[body.ball]\nshape.sphere.radius = 0.1\nmass = 1
            velocity = [30, 40, 0]\n[force.air.drag]\nlinear = 0.1",
        runs: &[("velocity-verlet", 0.01, 1e-3), ("rk4", 0.01, 1e-9), ("dop853", 1e-9, 1e-6), ("gauss-radau", 1e-9, 1e-11)],
        error: |run| {
            let end = DVec3::new(77.754_533_795_484_6, 63.630_037_238_547_6, 0.0);
            (at(run, 3.0).bodies[0].location - end).length()
        },
    },
    Reference {
        name: "Damped spring",
        source: "closed form",
        what: "place at 5 s, of 1 m",
        scene: "[simulation]\nduration = 5\n{method}\n[body.ball]\nshape.sphere.radius = 0.1\nmass = 1\nlocation = [1, 0, 0]
            [force.spring.spring]\nbetween = [[0, 0, 0], 'ball']\nstiffness = 100\ndamping = 2\nrest_length = 0",
        runs: &[("velocity-verlet", 1e-3, 1e-5), ("rk4", 1e-3, 1e-10), ("yoshida4", 1e-3, 1e-9), ("dop853", 1e-9, 1e-7), ("gauss-radau", 1e-9, 1e-12)],
        error: |run| (at(run, 5.0).bodies[0].location.x - 0.005_526_103_306_932_69).abs(),
    },
    Reference {
        name: "Pendulum from the horizontal",
        source: "IFToMM benchmark A01, as re-run by OpenSim",
        what: "place at 10 s, of 1 m",
        scene: "[simulation]\nduration = 10\ngravity = [0, -9.81, 0]\n{method}\n[body.bob]\nshape.sphere.radius = 0.001\nmass = 1
            location = [-1, 0, 0]\n[joint.rod.rod]\nbetween = [[0, 0, 0], 'bob']",
        runs: &[("velocity-verlet", 1e-3, 1e-3), ("rk4", 1e-3, 1e-7)],
        error: |run| {
            let off = at(run, 10.0).bodies[0].location.truncate() - DVec2::new(-0.275_087_462_576, -0.961_419_205_099);
            off.length()
        },
    },
    Reference {
        name: "Period of a pendulum, 90°",
        source: "4 √(L/g) K(sin² 45°)",
        what: "relative, after 25 periods",
        scene: "[simulation]\nduration = 60\ngravity = [0, -9.81, 0]\n{method}\n[body.bob]\nshape.sphere.radius = 0.001\nmass = 1
            location = [1, 0, 0]\n[joint.rod.rod]\nbetween = [[0, 0, 0], 'bob']",
        runs: &[("velocity-verlet", 1.0 / 240.0, 1e-4), ("rk4", 1.0 / 240.0, 1e-7)],
        error: |run| period(run, 2.367_841_947_576_24),
    },
    Reference {
        name: "Double pendulum",
        source: "reference value, 12 digits",
        what: "angles at 5 s, rad",
        scene: "[simulation]\nduration = 5\ngravity = [0, -9.81, 0]\n{method}\n[body.upper]\nshape.sphere.radius = 0.001\nmass = 1
            location = [1, 0, 0]\n[body.lower]\nshape.sphere.radius = 0.001\nmass = 1\nlocation = [2, 0, 0]
            [joint.top.rod]\nbetween = [[0, 0, 0], 'upper']\n[joint.bottom.rod]\nbetween = ['upper', 'lower']",
        runs: &[("rk4", 1e-3, 1e-4), ("rk4", 2.5e-4, 1e-6)],
        error: |run| {
            let bodies = at(run, 5.0).bodies;
            let angles = [angle(bodies[0].location), angle(bodies[1].location - bodies[0].location)];
            largest(angles.into_iter().zip([-0.627_186_705_066_5, -1.301_315_550_21]).map(|(a, b)| (a - b).abs()))
        },
    },
    Reference {
        name: "Dzhanibekov's wing nut, first flip",
        source: "Euler's equations: 3.539 s, four digits",
        what: "s",
        scene: "scenes/wing_nut.toml",
        runs: &[("gauss-radau", 1e-9, 1e-3), ("dop853", 1e-13, 1e-3), ("velocity-verlet", 2.5e-4, 1e-3), ("rk4", 2.5e-4, 1e-3)],
        error: |run| {
            // Find the zero of the angular velocity about the intermediate axis, by linear interpolation between two times near it.
            let [one, two] = [3.5385, 3.5395].map(|time| in_body(&at(run, time)).y);
            (3.5385 + 1e-3 * one / (one - two) - 3.539).abs()
        },
    },
    Reference {
        name: "Dzhanibekov's wing nut at 10 s",
        source: "Euler's equations, 12 digits",
        what: "angular velocity, of 5 rad/s",
        scene: "scenes/wing_nut.toml",
        runs: &[("gauss-radau", 1e-9, 1e-7), ("dop853", 1e-14, 1e-4), ("velocity-verlet", 2.5e-4, 1e-3), ("rk4", 2.5e-4, 1e-3)],
        error: |run| {
            let end = DVec3::new(4.510_627_124_012, -2.157_369_682_769, 2.604_211_912_26);
            (in_body(&at(run, 10.0)) - end).length()
        },
    },
    Reference {
        name: "Dzhanibekov's wing nut, 60 s",
        source: "it is conserved",
        what: "angular momentum, relative",
        scene: "scenes/wing_nut.toml",
        runs: &[("gauss-radau", 1e-9, 1e-12), ("dop853", 1e-13, 1e-12), ("velocity-verlet", 2.5e-4, 1e-12), ("rk4", 2.5e-4, 1e-12)],
        error: |run| {
            let before = at(run, 0.0).balance.angular_momentum;
            (at(run, 60.0).balance.angular_momentum - before).length() / before.length()
        },
    },
    Reference {
        name: "Figure of eight, one period",
        source: "Chenciner & Montgomery 2000; nine digits, which return to 4.1e-8",
        what: "place, of 1 m",
        scene: "scenes/figure_eight.toml",
        runs: &[("gauss-radau", 1e-9, 1e-7), ("dop853", 1e-11, 1e-7), ("yoshida4", 5e-4, 1e-7), ("rk4", 5e-4, 1e-7)],
        error: |run| {
            let places = |snapshot: Snapshot| snapshot.bodies.iter().map(|body| body.location).collect::<Vec<_>>();
            let before = places(at(run, 0.0));
            let after = places(at(run, 6.325_913_98));
            largest(before.iter().zip(after).map(|(a, b)| (*a - b).length()))
        },
    },
    Reference {
        name: "Pleiades at 3 s",
        source: "IVP Test Set 2.4, problem PLEI",
        what: "place, of 5 m",
        scene: "scenes/pleiades.toml",
        runs: &[("gauss-radau", 1e-9, 1e-9), ("dop853", 1e-13, 1e-9), ("yoshida4", 5e-5, 1e-4), ("rk4", 5e-5, 1e-6)],
        error: |run| {
            let end = [
                [0.370_613_914_397_050_2, -3.943_437_585_517_392],
                [3.237_284_092_057_233, -3.271_380_973_972_55],
                [-3.222_559_032_418_324, 5.225_081_843_456_543],
                [0.659_709_145_577_531, -2.590_612_434_977_47],
                [0.342_558_170_715_658_4, 1.198_213_693_392_275],
                [1.562_172_101_400_631, -0.242_968_234_493_582_4],
                [-0.700_309_292_221_249_5, 1.091_449_240_428_98],
            ];
            let places = at(run, 3.0).bodies;
            largest(places.iter().zip(end).map(|(body, end)| (body.location.truncate() - DVec2::from(end)).length()))
        },
    },
    Reference {
        name: "Kepler, e = 0.9, 100 orbits",
        source: "it returns to its start; one ulp of the initial speed changes the end by 3e-11",
        what: "place, of half an axis",
        scene: "[simulation]\nduration = 630\n{method}\n[force.pull.gravitation]\nconstant = 1\n[body.star]\nshape.sphere.radius = 0.001\nmass = 1
            [body.planet]\nshape.sphere.radius = 0.001\nmass = 1e-20\nlocation = [0.1, 0, 0]\nvelocity = [0, 'sqrt(19)', 0]",
        runs: &[("gauss-radau", 1e-9, 1e-9), ("dop853", 1e-12, 2e-6), ("dop853", 1e-9, 1e-2)],
        error: |run| {
            let bodies = at(run, 100.0 * TAU).bodies;
            (bodies[1].location - bodies[0].location - 0.1 * DVec3::X).length()
        },
    },
    Reference {
        name: "L4 of Jupiter, 160 years",
        source: "Lagrange 1772: the triangle keeps its shape",
        what: "place, of 5.2 AU",
        scene: TROJAN,
        runs: &[("gauss-radau", 1e-9, 1e-11), ("dop853", 1e-12, 1e-7)],
        error: |run| {
            let places: Vec<DVec3> = at(run, 160.0).bodies.iter().map(|body| body.location).collect();
            let sides = [places[1] - places[0], places[2] - places[1], places[0] - places[2]];
            largest(sides.into_iter().map(|side| (side.length() - 5.2).abs()))
        },
    },
];

/// The first three bodies of `scenes/trojans.toml`: the sun, Jupiter, and a body at the Lagrange point L4.
const TROJAN: &str = r#"
variables = { m = 0.000954791938424, a = 5.2, n = "2*pi*sqrt((1 + m)/a^3)", sun = "-a*m/(1 + m)" }
[simulation]
duration = 160
{method}
[force.pull.gravitation]
constant = "4*pi^2"
[body.sun]
shape.sphere.radius = 0.001
mass = 1
location = ["sun", 0, 0]
velocity = [0, 0, "-n*sun"]
[body.jupiter]
shape.sphere.radius = 0.001
mass = "m"
location = ["sun + a", 0, 0]
velocity = [0, 0, "-n*(sun + a)"]
[body.greek]
shape.sphere.radius = 0.001
mass = 1e-20
location = ["sun + a/2", 0, "-a*sqrt(3)/2"]
velocity = ["-n*a*sqrt(3)/2", 0, "-n*(sun + a/2)"]
"#;

//! The values of measures, such as `ball.speed` or `kinetic`: for labels, plots, and everything else that shows them.

use super::{Frame, Ghost, ImpactCounts, shown};
use crate::physics::{Balance, BodyId, BodySnapshot, Coordinate, Reaction, find};
use crate::scene::{Body, BodyMeasure, JointState, Measure, MeasureFormula, Quantity, RunMeasure, Scene};

/// What is known at a moment: at a frame, or at the time of a ghost.
pub struct MomentState<'a> {
    time: f64,
    frame: usize,
    balance: Option<&'a Balance>,
    bodies: &'a [BodySnapshot],
    /// The constraint forces of the joints. Empty for a ghost.
    reactions: &'a [Reaction],
    /// The angles of the joints, counted through full turns, rad. Empty for a ghost.
    angles: &'a [f64],
    /// The numbers of impacts up to the moment. `None` for a ghost.
    impacts: Option<&'a ImpactCounts>,
}

impl<'a> MomentState<'a> {
    /// Returns the moment of a frame, at which all measures are known.
    pub fn now(frame: &'a Frame) -> MomentState<'a> {
        MomentState {
            time: frame.time,
            frame: frame.index,
            balance: Some(&frame.balance),
            bodies: &frame.bodies,
            reactions: &frame.reactions,
            angles: &frame.angles,
            impacts: Some(&frame.impacts),
        }
    }

    /// Returns the moment of a ghost, at which only the values of its body are known.
    pub fn then(ghost: &'a Ghost) -> MomentState<'a> {
        MomentState {
            time: ghost.time,
            frame: 0,
            balance: None,
            bodies: std::slice::from_ref(&ghost.body),
            reactions: &[],
            angles: &[],
            impacts: None,
        }
    }
}

/// Computes the measures of a scene.
#[derive(Clone, Debug)]
pub struct Measures {
    /// The bodies of the scene. Empty if the scene shows no measures.
    bodies: Vec<Body>,
    /// The coordinates of hinges and sliders, indexed by joint. `None` for other joints.
    joints: Vec<Option<Coordinate>>,
}

impl Measures {
    /// Prepares the measures of a scene.
    pub fn new(scene: &Scene) -> Measures {
        let joints = scene.joints.iter().map(|joint| joint.kind.coordinate()).collect();
        let has_labels = !scene.labels.is_empty() || !scene.plots.is_empty();
        let has_marks =
            !scene.angles.is_empty() || !scene.distances.is_empty() || !scene.arrow_marks.is_empty();
        Measures { bodies: if has_labels || has_marks { scene.bodies.clone() } else { Vec::new() }, joints }
    }

    /// Returns a body of a scene that shows measures.
    pub(crate) fn body(&self, id: usize) -> &Body {
        &self.bodies[id]
    }

    /// Returns the value of a formula at a moment. NaN if a measure is unknown then, such as the speed of an absent body.
    pub fn value(&self, formula: &MeasureFormula, moment: &MomentState<'_>) -> f64 {
        let inputs: Vec<f64> = formula.inputs.iter().map(|measure| self.measure(*measure, moment)).collect();
        formula.program.eval(&inputs)
    }

    #[allow(clippy::cast_precision_loss, reason = "there are fewer frames than that")]
    fn measure(&self, measure: Measure, moment: &MomentState<'_>) -> f64 {
        let energy = |of: fn(&Balance) -> f64| moment.balance.map_or(f64::NAN, of);
        let impacts = |of: fn(&ImpactCounts) -> f64| moment.impacts.map_or(f64::NAN, of);
        match measure {
            Measure::Run(RunMeasure::Time) => moment.time,
            Measure::Run(RunMeasure::Frame) => moment.frame as f64,
            Measure::Run(RunMeasure::Energy) => energy(Balance::total_of_all),
            Measure::Run(RunMeasure::Kinetic) => energy(Balance::kinetic_of_all),
            Measure::Run(RunMeasure::Potential) => energy(|balance| balance.potential),
            Measure::Run(RunMeasure::Momentum(axis)) => {
                moment.balance.map_or(f64::NAN, |balance| balance.linear_momentum[axis])
            }
            Measure::Run(RunMeasure::AngularMomentum(axis)) => {
                moment.balance.map_or(f64::NAN, |balance| balance.angular_momentum[axis])
            }
            Measure::Run(RunMeasure::Drift) => energy(|balance| balance.drift),
            Measure::Run(RunMeasure::Impacts) => impacts(ImpactCounts::of_run),
            Measure::Impacts(pair) => moment.impacts.map_or(f64::NAN, |impacts| impacts.of_pair(pair)),
            Measure::Body(number, BodyMeasure::Impacts) => {
                moment.impacts.map_or(f64::NAN, |impacts| impacts.of_body(number))
            }
            Measure::Body(number, measure) => {
                let at = find(moment.bodies, number);
                at.map_or(f64::NAN, |at| of_body(&self.bodies[number], at, measure))
            }
            Measure::Joint(number, measure) => {
                let Some(reaction) = moment.reactions.get(number) else { return f64::NAN };
                let body = |id: BodyId| find(moment.bodies, id.index()).copied();
                let total_angle = moment.angles.get(number).copied().unwrap_or(f64::NAN);
                measure.of(&JointState::of(self.joints[number], (*reaction, total_angle), body))
            }
        }
    }
}

fn of_body(body: &Body, at: &BodySnapshot, measure: BodyMeasure) -> f64 {
    let acceleration = shown(Quantity::Acceleration, body, at);
    let mass = body.start.mass;
    match measure {
        BodyMeasure::Location(axis) => at.location[axis],
        BodyMeasure::Speed => at.velocity.length(),
        BodyMeasure::Velocity(axis) => at.velocity[axis],
        BodyMeasure::AccelerationMagnitude => acceleration.length(),
        BodyMeasure::Acceleration(axis) => acceleration[axis],
        BodyMeasure::ForceMagnitude => at.force.length(),
        BodyMeasure::Force(axis) => at.force[axis],
        BodyMeasure::AngularSpeed => at.angular_velocity.length(),
        BodyMeasure::Mass => mass,
        BodyMeasure::Momentum => mass * at.velocity.length(),
        BodyMeasure::MomentumComponent(axis) => mass * at.velocity[axis],
        BodyMeasure::Power => at.force.dot(at.velocity),
        // Impacts are counted per run, not in the state of a body.
        BodyMeasure::Impacts => f64::NAN,
        BodyMeasure::Kinetic => {
            let turned = at.orientation * body.start.principal_axes;
            let spin = turned.conjugate() * at.angular_velocity;
            0.5 * (mass * at.velocity.length_squared() + body.start.inertia.dot(spin * spin))
        }
    }
}

#[cfg(test)]
mod tests {
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

    /// The work of the forces on a body is its kinetic energy. So its power equals the rate of its kinetic energy, here for a ball that does not
    /// turn, on a spring with damping and in the wind. The rate follows from the neighboring frames with an error of (Δt)²/6 times the third
    /// derivative.
    #[test]
    fn the_power_of_a_body_is_the_rate_of_its_kinetic_energy() {
        let text =
            "simulation = { duration = 2, frame_rate = 1000, gravity = [0, -10, 0], integrator = 'rk4' }
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
            assert!(
                (kinetic / frame.balance.kinetic - 1.0).abs() < 1e-9,
                "{kinetic} {}",
                frame.balance.kinetic
            );
        }
    }
}

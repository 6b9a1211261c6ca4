//! Estimates the cost of a run before it begins.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::{build, world};
use crate::physics::{Force, Loads, Method, Moment, RigidBody, Shape, World};
use crate::scene::Scene;

/// The number of pair interactions that take about as long as writing the script lines of one body.
const SCRIPT_COST_PER_BODY: u64 = 100;

/// The expected number of pair interactions in each frame of a run. It equals the count of a [`PairCounter`](crate::physics::PairCounter)
/// if all bodies are always present, and is approximate otherwise. Scenes without pair interactions have no cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Workload {
    first: u64,
    each: u64,
    frames: usize,
    /// The number of pair interactions that take about as long as writing one script.
    script: u64,
}

impl Workload {
    /// Computes the expected number of pair interactions in each frame of a scene.
    pub fn of(scene: &Scene) -> Workload {
        let forces = scene.forces.iter().flat_map(|force| build::forces(&force.kind));
        let pairs = forces.map(|force| force.pairs()).fold(0, u64::saturating_add);
        // The number of steps of an adaptive method is not known in advance.
        if pairs == 0 || scene.simulation.method.take_over.is_some() {
            return Workload::default();
        }
        let steps = u64::from(world(scene).steps_within(scene.simulation.timeline.interval()));
        let evaluations = steps.saturating_mul(evaluations(scene.simulation.method));
        // Each frame evaluates its potential energy and its forces. The first frame needs one more evaluation, for the start of the run.
        Workload {
            first: pairs.saturating_mul(3),
            each: pairs.saturating_mul(evaluations.saturating_add(2)),
            frames: scene.simulation.timeline.frames(),
            script: SCRIPT_COST_PER_BODY * scene.bodies.len() as u64,
        }
    }

    /// The expected number of pair interactions in the frame with this index.
    pub fn of_frame(&self, index: usize) -> u64 {
        if index == 0 { self.first } else { self.each }
    }

    /// The cost of one step of a command's progress, in pair interactions. The command first simulates one frame per step, then writes one
    /// script per step.
    pub fn of_step(&self, step: usize) -> u64 {
        if step < self.frames { self.of_frame(step) } else { self.script }
    }

    /// True if the run has no pair interactions.
    pub fn is_empty(&self) -> bool {
        self.each == 0
    }
}

/// Counts the force evaluations that an integration method makes per step, by a trial run.
pub fn evaluations(method: &'static Method) -> u64 {
    struct Counting(Arc<AtomicU64>);

    impl Force for Counting {
        fn apply(&self, _: &Moment, _: &mut Loads) {
            self.0.fetch_add(1, Ordering::Relaxed);
        }

        fn potential(&self, _: &Moment) -> f64 {
            0.0
        }

        // Pair forces, which take most of the time, do not depend on velocities either.
        fn depends_on_motion(&self) -> bool {
            false
        }
    }

    let count = Arc::new(AtomicU64::new(0));
    let mut world = World::new();
    world.set_integrator(method);
    world.add(RigidBody::new(&Shape::Sphere { radius: 1.0 }, 1.0));
    world.add_force(Counting(Arc::clone(&count)));
    // The first step may cost more, since some methods keep values for the next step.
    world.step(1.0);
    let before = count.load(Ordering::Relaxed);
    world.step(1.0);
    count.load(Ordering::Relaxed) - before
}

#[cfg(test)]
mod tests {
    use super::super::Frames;
    use super::*;
    use crate::physics::{METHODS, PairCounter};

    #[test]
    fn what_is_planned_is_what_is_counted_and_it_is_counted_within_an_evaluation() {
        let by_tree = ("opening_angle = 0.5", 300 * 300);
        for (method, (key, pairs)) in METHODS.iter().flat_map(|it| [(it, ("", 300 * 299 / 2)), (it, by_tree)])
        {
            let text = format!(
                "simulation = {{ duration = 0.2, step = 0.02, integrator = '{}' }}\n[body.star]\nrepeat = 300\n\
                 shape.sphere.radius = 0.1\nlocation = ['i', 'i % 7', 'i % 11']\n[force.f.gravitation]\n{key}\n",
                method.name
            );
            let scene = Scene::parse(&text).unwrap();
            let (workload, pair_counter) = (Workload::of(&scene), PairCounter::default());
            let mut before = 0;
            for (index, frame) in Frames::watched(&scene, &pair_counter).enumerate() {
                frame.unwrap();
                let counted = pair_counter.done() - before;
                // The first step of a run may need one more evaluation.
                let planned = workload.of_frame(index);
                assert!(counted.abs_diff(planned) <= pairs, "{} {index}: {counted} {planned}", method.name);
                before = pair_counter.done();
            }
            assert!(before > 10 * pairs);
        }
        assert!(Workload::of(&Scene::parse("[body.b]\nshape.sphere.radius = 1").unwrap()).is_empty());
    }
}

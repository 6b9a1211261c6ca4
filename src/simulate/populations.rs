//! The numbers of particles that emitters have at a time. They follow from births and lifetimes alone, so no particle has to be moved.

use std::sync::{Arc, OnceLock};

use crate::physics::{ParticleSource, Presence};
use crate::scene::{Emitter, EmitterMeasure, Scene, Timeline};

/// The largest number of births in a run whose times are kept. Of more, the living ones are counted at each moment.
const MOST_KEPT: u64 = 5_000_000;

/// The particles of an emitter in a run, by their births and deaths.
#[derive(Clone, Debug)]
pub(super) struct Population {
    source: Arc<ParticleSource>,
    /// The times at which the body is present that carries the emitter. `None` without such a body.
    carrier: Option<Presence>,
    timeline: Timeline,
    /// The times of all births and of all deaths in the run, s, each in ascending order. `None` if there are too many.
    lives: Arc<OnceLock<Option<[Vec<f64>; 2]>>>,
}

impl Population {
    /// Prepares the particles of an emitter.
    pub(super) fn new(scene: &Scene, emitter: &Emitter) -> Population {
        let carrier = emitter.carrier.map(|body| scene.bodies[body.index()].presence.clone());
        let timeline = scene.simulation.timeline.clone();
        Population { source: emitter.source.clone(), carrier, timeline, lives: Arc::default() }
    }

    /// Returns a measure of the emitter at a time, s.
    pub(super) fn value(&self, measure: EmitterMeasure, time: f64) -> f64 {
        match measure {
            EmitterMeasure::Count => self.living(time),
            EmitterMeasure::Rate => self.rate(time),
        }
    }

    /// The number of living particles at a time, s.
    #[allow(clippy::cast_precision_loss, reason = "the check of a scene limits the number of particles")]
    fn living(&self, time: f64) -> f64 {
        match self.lives.get_or_init(|| self.lives()) {
            Some([births, deaths]) => {
                let until = |times: &[f64]| times.partition_point(|at| *at <= time);
                (until(births) - until(deaths)) as f64
            }
            None => {
                let oldest = (time - self.source.longest_life).max(self.source.births.start);
                let first = self.source.births.first_from(oldest);
                self.born(first, time).filter(|[_, dies]| *dies > time).count() as f64
            }
        }
    }

    /// The times of birth and death of the particles from a number on that are born until a time, s.
    fn born(&self, first: u64, until: f64) -> impl Iterator<Item = [f64; 2]> {
        let births = (first..).map_while(move |number| {
            Some((number, self.source.births.time(number).filter(|at| *at <= until)?))
        });
        let emitted = births.filter(|(_, born)| self.may_emit(*born));
        emitted.map(|(number, born)| [born, born + self.source.life(number, born)])
    }

    /// The times of all births and of all deaths in the run. `None` if there are too many.
    fn lives(&self) -> Option<[Vec<f64>; 2]> {
        let end = self.timeline.latest();
        if self.source.births.time(MOST_KEPT).is_some_and(|birth| birth <= end) {
            return None;
        }
        let (births, mut deaths): (Vec<f64>, Vec<f64>) =
            self.born(0, end).map(|[born, dies]| (born, dies)).unzip();
        deaths.sort_unstable_by(f64::total_cmp);
        Some([births, deaths])
    }

    /// The mean number of births per second at a time (s), 1/s.
    #[allow(clippy::cast_precision_loss, reason = "the check of a scene limits the number of particles")]
    fn rate(&self, time: f64) -> f64 {
        let births = self.source.births;
        let emits = (births.start..=births.end).contains(&time) && self.may_emit(time);
        if emits { births.at_once as f64 / births.every } else { 0.0 }
    }

    /// Returns whether the carrier emits at a time, s. As for the particles, it is present between two frames if it is so at one of them.
    fn may_emit(&self, time: f64) -> bool {
        let Some(presence) = &self.carrier else { return true };
        let timeline = &self.timeline;
        let Some(next) = timeline.first_frame_from(time.max(0.0)) else { return presence.at(timeline.end()) };
        [next.saturating_sub(1), next].into_iter().any(|frame| presence.at(timeline.time(frame)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::Frames;

    /// The count is that of the particles that are drawn, also with random lifetimes, bursts, births before the run, and a carrier that
    /// comes and goes. The rate is that of the source while it emits.
    #[test]
    fn the_counts_are_those_of_the_particles() {
        let text = "
            simulation = { duration = 2, frame_rate = 10 }
            [body.boat]\nshape.sphere.radius = 0.1\nstart = 0.43\nend = 1.31
            [emitter.a]\nfrom.point = [0, 0, 0]\nspeed = 1\nshape.sphere.radius = 0.01\nrate = 37
            lifetime = 'uniform(0.1, 0.7)'\nstart = -0.5\nend = 1.2
            [emitter.b]\nfrom.point = [0, 0, 0]\nspeed = 1\nshape.sphere.radius = 0.01\nburst = 20\nevery = 0.45
            lifetime = 0.31
            [emitter.c]\nfrom = { point = [0, 0, 0], body = 'boat' }\nspeed = 1\nshape.sphere.radius = 0.01
            rate = 50\nlifetime = 0.25";
        let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{report}"));
        let populations: Vec<Population> =
            scene.emitters.iter().map(|emitter| Population::new(&scene, emitter)).collect();
        let mut total = 0;
        for frame in Frames::new(&scene) {
            let frame = frame.unwrap();
            for (population, swarm) in populations.iter().zip(&frame.particles) {
                let count = population.value(EmitterMeasure::Count, frame.time);
                assert_eq!(count as usize, swarm.len(), "{population:?} at {} s", frame.time);
                total += swarm.len();
            }
        }
        assert!(total > 300, "{total}");
        let rate = |number: usize, time: f64| populations[number].value(EmitterMeasure::Rate, time);
        assert_eq!([-0.6, 0.3, 1.3].map(|time| rate(0, time)), [0.0, 37.0, 0.0]);
        assert!((rate(1, 0.3) - 20.0 / 0.45).abs() < 1e-12);
        assert_eq!([0.2, 0.7, 1.9].map(|time| rate(2, time)), [0.0, 50.0, 0.0]);
    }
}

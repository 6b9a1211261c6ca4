//! Encodes the particles of frames for the page as little-endian 64-bit numbers.

use std::io;
use std::sync::{Mutex, PoisonError};

use super::numbers::put;
use super::run::PageRun;
use crate::physics::Particle;
use crate::scene::{Emitter, Scene};
use crate::simulate::Swarms;

/// The approximate largest number of drawn particles of all emitters together. The page draws all particles anew in each frame.
const MAX_DRAWN_PARTICLES: f64 = 10_000.0;

/// The computed particles of a run. `None` until a page requests them.
#[derive(Default)]
pub(super) struct KeptSwarms(Mutex<Option<Swarms>>);

/// Returns the largest number of drawn particles per emitter.
#[allow(clippy::cast_precision_loss, reason = "emitters are few")]
fn most_of_each(scene: &Scene) -> f64 {
    MAX_DRAWN_PARTICLES / scene.emitters.len().max(1) as f64
}

/// Returns the name of each emitter with too many particles, and the number n: only every n-th of its particles is drawn.
pub(super) fn thinned(run: &PageRun) -> Vec<(String, u64)> {
    let swarms = Swarms::thinned(&run.scene, run.recording(), most_of_each(&run.scene));
    let names = run.scene.emitters.iter().map(|emitter| emitter.name.to_string());
    names.zip(swarms.strides().iter().copied()).filter(|(_, stride)| *stride > 1).collect()
}

/// Encodes the particles of some frames. A frame has the number of its particles, and then for each particle: its location and the end of
/// its streak, m; its radius, m; its color, sRGB; 1 if it emits light, otherwise 0. Without a streak, the end of the streak is the
/// location.
pub(super) fn frames(run: &PageRun, frames: impl Iterator<Item = usize>) -> io::Result<Vec<u8>> {
    let mut kept = run.swarms.0.lock().unwrap_or_else(PoisonError::into_inner);
    let recording = run.recording();
    let mut swarms = match kept.take() {
        Some(swarms) if swarms.are_of(&recording) => swarms,
        _ => Swarms::thinned(&run.scene, recording, most_of_each(&run.scene)),
    };
    let mut bytes = Vec::new();
    for frame in frames {
        let time = run.scene.simulation.timeline.time(frame);
        let of_emitters = swarms.at(frame)?;
        let mut numbers = vec![0.0];
        for (emitter, swarm) in run.scene.emitters.iter().zip(&of_emitters) {
            for particle in swarm.iter().filter(|particle| particle.location.is_finite()) {
                numbers[0] += 1.0;
                numbers.extend(seen(emitter, particle, time));
            }
        }
        put(&mut bytes, &numbers);
    }
    *kept = Some(swarms);
    Ok(bytes)
}

/// Yields the numbers of a particle at `time` (s): its location, the end of its streak, its radius and color, and 1 if it emits light.
fn seen(emitter: &Emitter, particle: &Particle, time: f64) -> impl Iterator<Item = f64> {
    let age = if particle.dies.is_finite() { particle.age(time) } else { 0.0 };
    let past = emitter.streak.min(time - particle.born).max(0.0);
    let end = particle.location - past * particle.velocity;
    let end = if end.is_finite() { end } else { particle.location };
    let shines = if emitter.glow > 0.0 { 1.0 } else { 0.0 };
    let places = particle.location.to_array().into_iter().chain(end.to_array());
    places.chain([emitter.radius_at(age)]).chain(emitter.color_at(age).0).chain([shines])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;

    /// A frame contains the same particles, whatever frames were computed before. A run with many particles shows every n-th.
    #[test]
    fn particles_are_where_they_are_in_any_order() {
        let text = "simulation = { duration = 1, frame_rate = 10 }
            [emitter.drops]\nshape.sphere.radius = 0.1\nrate = 10\nlifetime = 0.35\nspeed = 2\nsize = [1, 0]
            color = ['red', 'blue']\nglow = 1\nstreak = 0.01
            [emitter.crowd]\nshape.sphere.radius = 0.1\nrate = 1e5\nfrom.point = [9, 0, 0]\n";
        let scene = Scene::parse(text).unwrap();
        let run = PageRun::whole(scene);
        assert_eq!(thinned(&run), [("crowd".to_owned(), 20)]);
        let numbers = |frame: usize| -> Vec<f64> {
            let bytes = frames(&run, std::iter::once(frame)).unwrap();
            bytes.chunks_exact(8).map(|chunk| f64::from_le_bytes(chunk.try_into().unwrap())).collect()
        };
        let (late, early) = (numbers(9), numbers(2));
        assert_eq!((&numbers(9), &numbers(2)), (&late, &early));
        // Four drops are alive, and every twentieth of about 90,000 other particles is shown.
        assert!((4504.0..=4506.0).contains(&late[0]), "{}", late[0]);
        assert_eq!(late[0], f64::from(u32::try_from(late.len() / 11).unwrap()));
        // The oldest drop was born at 0.6 s. At 0.9 s, its age is 0.3 s of its lifetime of 0.35 s.
        let old = &late[1..12];
        let part = 0.3 / 0.35;
        let expected = [0.0, 0.6, 0.0, 0.0, 0.58, 0.0, 0.1 * (1.0 - part), 1.0 - part, 0.0, part, 1.0];
        assert!(old.iter().zip(expected).all(|(found, is)| (found - is).abs() < 1e-9), "{old:?}");
    }
}

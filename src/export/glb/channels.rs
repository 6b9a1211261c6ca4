//! Describes the animation of nodes in a glTF document.

use super::document::{Accessor, Animation, Channel, FLOAT, Sampler, Target};
use super::motion::{NodeMotion, SampledMotion};

/// Makes the animation of the nodes, and returns the size of its keyframes in bytes. All keyframes are in the buffer view `view`. The
/// animation is `None` if nothing moves.
pub(super) fn animation(
    motion: &SampledMotion,
    nodes: &[u32],
    view: u32,
    accessors: &mut Vec<Accessor>,
) -> (Option<Animation>, u64) {
    let is_still = |way: &NodeMotion| {
        let NodeMotion { translations, rotations, scales, shown, .. } = way;
        translations.is_empty() && rotations.is_empty() && scales.is_empty() && shown.is_always()
    };
    if motion.ways().iter().all(is_still) {
        return (None, 0);
    }
    let mut offset = 0;
    let mut add = |kind, width: usize, count: usize, min: Vec<f64>, max: Vec<f64>| {
        let byte_offset = offset;
        offset += 4 * (width * count) as u64;
        let numbers =
            Accessor { buffer_view: view, byte_offset, component_type: FLOAT, count, kind, min, max };
        accessors.push(numbers);
        accessors.len() as u32 - 1
    };
    let end = |time: Option<&f32>| time.map(|&time| f64::from(time)).into_iter().collect();
    let count = motion.times().len();
    let input = add("SCALAR", 1, count, end(motion.times().first()), end(motion.times().last()));
    let mut animation = Animation { name: "motion".to_owned(), channels: Vec::new(), samplers: Vec::new() };
    for (way, &node) in motion.ways().iter().zip(nodes) {
        // The order must be that of `SampledMotion::numbers`, which yields the keyframes.
        let parts = [
            ("translation", "VEC3", 3, &way.translations),
            ("rotation", "VEC4", 4, &way.rotations),
            ("scale", "VEC3", 3, &way.scales),
        ];
        for (path, kind, width, values) in parts {
            if !values.is_empty() {
                let output = add(kind, width, count, Vec::new(), Vec::new());
                animation.add(Sampler { input, interpolation: None, output }, Target { node, path });
            }
        }
        if !way.shown.is_always() {
            let times = &way.shown.times;
            let input = add("SCALAR", 1, times.len(), end(times.first()), end(times.last()));
            let output = add("VEC3", 3, times.len(), Vec::new(), Vec::new());
            let sampler = Sampler { input, interpolation: Some("STEP"), output };
            animation.add(sampler, Target { node, path: "scale" });
        }
    }
    (Some(animation), offset)
}

impl Animation {
    /// Adds a channel, which applies a sampler's keyframes to a property of a node.
    fn add(&mut self, sampler: Sampler, target: Target) {
        self.channels.push(Channel { sampler: self.samplers.len() as u32, target });
        self.samplers.push(sampler);
    }
}

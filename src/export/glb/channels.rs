//! What moves nodes.

use super::document::{Accessor, Animation, Channel, FLOAT, Sampler, Target};
use super::motion::Motion;

/// What moves nodes, and how many bytes of keys that takes, which are those of a view; nothing where
/// nothing moves.
pub(super) fn animation(
    motion: &Motion,
    nodes: &[u32],
    view: u32,
    accessors: &mut Vec<Accessor>,
) -> (Option<Animation>, u64) {
    if motion.ways().iter().all(|way| way.translations.is_empty() && way.rotations.is_empty()) {
        return (None, 0);
    }
    let mut offset = 0;
    let mut add = |kind, width: usize, min: Vec<f64>, max: Vec<f64>| {
        let count = motion.times().len();
        let byte_offset = offset;
        offset += 4 * (width * count) as u64;
        let numbers =
            Accessor { buffer_view: view, byte_offset, component_type: FLOAT, count, kind, min, max };
        accessors.push(numbers);
        accessors.len() as u32 - 1
    };
    let end = |time: Option<&f32>| time.map(|&time| f64::from(time)).into_iter().collect();
    let input = add("SCALAR", 1, end(motion.times().first()), end(motion.times().last()));
    let mut animation = Animation { name: "motion".to_owned(), channels: Vec::new(), samplers: Vec::new() };
    for (way, &node) in motion.ways().iter().zip(nodes) {
        // In the order of `Motion::numbers`.
        let parts = [("translation", "VEC3", 3, &way.translations), ("rotation", "VEC4", 4, &way.rotations)];
        for (path, kind, width, values) in parts {
            if !values.is_empty() {
                let output = add(kind, width, Vec::new(), Vec::new());
                let sampler = animation.samplers.len() as u32;
                animation.samplers.push(Sampler { input, output });
                animation.channels.push(Channel { sampler, target: Target { node, path } });
            }
        }
    }
    (Some(animation), offset)
}

//! The triangles of a spring's coil: a tube along a helix.

use glam::DVec3;

use super::Triangles;
use super::angles::circle;

/// The length per turn for which the coil's wire is round, relative to the radius of the coil. It is typical of a spring at rest.
const ROUND_WIRE_PITCH: f64 = 1.5;

/// Computes the triangles of a coil of radius 1 around y, from y = -1 to 1. The cross-section of its wire becomes a circle of the given
/// radius when the coil is drawn with a length of 1.5 radii per turn. As in the POV-Ray scripts, the wire begins and ends on the axis.
pub(super) fn coil(turns: f64, wire: f64, sides: u32) -> Triangles {
    let length = ROUND_WIRE_PITCH * turns;
    let across = (sides / 6).max(4).next_multiple_of(4);
    let middles = path(turns, length, (sides / 3).max(8).next_multiple_of(4));
    let mut out = Triangles::default();
    let mut rings: Vec<Vec<u32>> = Vec::with_capacity(middles.len());
    // A direction across the wire, which is carried along the path.
    let mut aside = DVec3::X;
    for (i, middle) in middles.iter().enumerate() {
        let before = middles[i.saturating_sub(1)];
        let after = middles[(i + 1).min(middles.len() - 1)];
        let along = (after - before).normalize_or(DVec3::Y);
        aside = (aside - aside.dot(along) * along)
            .try_normalize()
            .unwrap_or_else(|| along.any_orthonormal_vector());
        let other = along.cross(aside);
        let ring = (0..across).map(|side| {
            let (cosine, sine) = circle(side, across);
            let normal = cosine * aside + sine * other;
            let point = *middle + wire * normal;
            // The vertices are scaled to a length of 2 along y. The normals are scaled inversely.
            let flat = 0.5 * length;
            out.vertex(
                DVec3::new(point.x, point.y / flat, point.z),
                (normal * DVec3::new(1.0, flat, 1.0)).normalize(),
            )
        });
        rings.push(ring.collect());
    }
    for pair in rings.windows(2) {
        for side in 0..pair[0].len() {
            let next = (side + 1) % pair[0].len();
            out.quad([pair[0][side], pair[0][next], pair[1][next], pair[1][side]]);
        }
    }
    out
}

/// The points on the center line of the wire, from end to end.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "turns are a small whole number")]
fn path(turns: f64, length: f64, per_turn: u32) -> Vec<DVec3> {
    let count = turns as u32 * per_turn;
    let begin = -0.42 * length;
    let wound = (0..=count).map(|i| {
        let (cosine, sine) = circle(i % per_turn, per_turn);
        DVec3::new(cosine, begin + 0.84 * length * f64::from(i) / f64::from(count), sine)
    });
    let at = |y: f64| DVec3::Y * y;
    [at(-0.5 * length), at(begin)].into_iter().chain(wound).chain([at(-begin), at(0.5 * length)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coil_fills_its_size_and_looks_outward() {
        let coil = coil(6.0, 0.14, 48);
        let reach = |axis: usize| coil.positions.iter().map(|p| p[axis].abs()).fold(0.0, f32::max);
        assert!(
            (reach(0) - 1.14).abs() < 0.02 && (reach(2) - 1.14).abs() < 0.02,
            "{} {}",
            reach(0),
            reach(2)
        );
        assert!((reach(1) - 1.0).abs() < 1e-6, "{}", reach(1));
        let mut folded = 0;
        for corners in coil.indices.chunks_exact(3) {
            let [a, b, c] =
                [0, 1, 2].map(|i| DVec3::from(coil.positions[corners[i] as usize].map(f64::from)));
            let normal = DVec3::from(coil.normals[corners[0] as usize].map(f64::from));
            // Compute the face normals in the drawn proportions of the coil.
            let drawn = DVec3::new(1.0, 4.5, 1.0);
            let face = ((b - a) * drawn).cross((c - a) * drawn);
            folded += usize::from(face.dot(normal / drawn) < 0.0);
        }
        // At the sharp bends near both ends, triangles on the inner side of the wire overlap.
        assert!(folded * 50 < coil.indices.len() / 3, "{folded}");
    }
}

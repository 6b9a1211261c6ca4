//! Angles that divide a circle evenly.

use std::f64::consts::TAU;

/// Returns the cosine and sine of the angle `part`/`count` of a full circle. `count` must be divisible by four. Mirror images agree to the
/// last bit, and points on an axis are exactly on it.
pub(super) fn circle(part: u32, count: u32) -> (f64, f64) {
    let quarter = count / 4;
    let (sine, cosine) = libm::sincos(TAU * f64::from(part % quarter) / f64::from(count));
    match (part / quarter) % 4 {
        0 => (cosine, sine),
        1 => (-sine, cosine),
        2 => (-cosine, -sine),
        _ => (sine, -cosine),
    }
}

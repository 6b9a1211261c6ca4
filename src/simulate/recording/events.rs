//! Converts contacts, impacts and residuals of laws to and from lists of numbers.

use glam::DVec3;

use crate::physics::{ContactSnapshot, Impact, LawResidual, MotionLaw};

/// The number of values that describe a contact: two bodies and four vectors.
pub(super) const CONTACT_NUMBERS: usize = 14;
/// The number of values that describe an impact: two bodies, time, three vectors and energy.
pub(super) const IMPACT_NUMBERS: usize = 13;

/// The number of values that describe the residual of a law.
pub(super) const LAW_NUMBERS: usize = 6;

pub(super) fn contact_numbers(contact: &ContactSnapshot) -> [f64; CONTACT_NUMBERS] {
    let ContactSnapshot { bodies: [one, two], place, normal, force, friction } = *contact;
    let [p, n, f, r] = [place, normal, force, friction].map(|vector| vector.to_array());
    let [one, two] = [one, two].map(number);
    [one, two, p[0], p[1], p[2], n[0], n[1], n[2], f[0], f[1], f[2], r[0], r[1], r[2]]
}

pub(super) fn contact_of(n: &[f64; CONTACT_NUMBERS]) -> ContactSnapshot {
    let vector = |at: usize| DVec3::new(n[at], n[at + 1], n[at + 2]);
    let bodies = [n[0], n[1]].map(id);
    ContactSnapshot { bodies, place: vector(2), normal: vector(5), force: vector(8), friction: vector(11) }
}

pub(super) fn impact_numbers(impact: &Impact) -> [f64; IMPACT_NUMBERS] {
    let Impact { time, bodies: [one, two], place, normal, impulse, energy } = *impact;
    let [p, n, i] = [place, normal, impulse].map(|vector| vector.to_array());
    let [one, two] = [one, two].map(number);
    [one, two, time, p[0], p[1], p[2], n[0], n[1], n[2], i[0], i[1], i[2], energy]
}

pub(super) fn impact_of(n: &[f64; IMPACT_NUMBERS]) -> Impact {
    let vector = |at: usize| DVec3::new(n[at], n[at + 1], n[at + 2]);
    let bodies = [n[0], n[1]].map(id);
    Impact { time: n[2], bodies, place: vector(3), normal: vector(6), impulse: vector(9), energy: n[12] }
}

pub(super) fn law_numbers(residual: &LawResidual) -> [f64; LAW_NUMBERS] {
    let LawResidual { law, time, bodies: [one, two], amount, part } = *residual;
    let at = MotionLaw::ALL.iter().position(|other| *other == law).unwrap_or(0);
    [number(at), time, number(one), number(two), amount, part]
}

pub(super) fn law_of(n: &[f64; LAW_NUMBERS]) -> LawResidual {
    let law = MotionLaw::ALL.get(id(n[0])).copied().unwrap_or(MotionLaw::Energy);
    LawResidual { law, time: n[1], bodies: [id(n[2]), id(n[3])], amount: n[4], part: n[5] }
}

/// Converts the index of a body to a floating-point number.
#[allow(clippy::cast_precision_loss, reason = "there are far fewer bodies than 2^53")]
fn number(id: usize) -> f64 {
    id as f64
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "it was written from a whole number"
)]
fn id(number: f64) -> usize {
    number as usize
}

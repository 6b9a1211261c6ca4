//! Corrects a velocity that the user gives by a speed and an angle above the ground.

use super::super::Context;
use super::text::operand;
use crate::scene::source::{Entry, Table};

/// The keys that other programs use for the initial speed.
pub(super) const SPEED_KEYS: [&str; 8] =
    ["speed", "v", "v0", "magnitude", "initial_speed", "launch_speed", "muzzle_speed", "norm"];
/// The keys that other programs use for the angle above the ground.
pub(super) const ANGLE_KEYS: [&str; 8] =
    ["angle", "launch_angle", "elevation", "theta", "alpha", "direction", "inclination", "pitch"];

/// Returns the text of a velocity vector from the speed (m/s) and the angle above the ground (degrees) in a table.
pub(super) fn by_angle(table: &Table, context: &Context<'_>) -> Option<String> {
    let (speed, angle) = (find(table, &SPEED_KEYS)?, find(table, &ANGLE_KEYS)?);
    let (speed, angle) = (operand(speed, "m/s", context)?, operand(angle, "degrees", context)?);
    Some(format!("[\"{speed}*cos(rad({angle}))\", \"{speed}*sin(rad({angle}))\", 0]"))
}

pub(super) fn find<'a>(table: &'a Table, words: &[&str]) -> Option<&'a Entry> {
    table.entries.iter().find(|entry| words.contains(&&*entry.name.text))
}

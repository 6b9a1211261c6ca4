//! A velocity that somebody has given by its size and its angle above the ground.

use super::super::Context;
use super::text::{operand, removal, whole};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::grammar::TableSpec;
use crate::scene::source::{Entry, Table};

const SPEEDS: [&str; 8] =
    ["speed", "v", "v0", "magnitude", "initial_speed", "launch_speed", "muzzle_speed", "norm"];
const ANGLES: [&str; 8] =
    ["angle", "launch_angle", "elevation", "theta", "alpha", "direction", "inclination", "pitch"];

/// The vector of a speed and of an angle in degrees that stand in a table.
pub(super) fn by_angle(table: &Table, context: &Context<'_>) -> Option<String> {
    let (speed, angle) = (find(table, &SPEEDS)?, find(table, &ANGLES)?);
    let (speed, angle) = (operand(speed, "m/s", context)?, operand(angle, "degrees", context)?);
    Some(format!("[\"{speed}*cos(rad({angle}))\", \"{speed}*sin(rad({angle}))\", 0]"))
}

fn find<'a>(table: &'a Table, words: &[&str]) -> Option<&'a Entry> {
    table.entries.iter().find(|entry| words.contains(&&*entry.name.text))
}

/// What is said of a speed and an angle that stand in a body, where its velocity should, and where they stand.
pub(in crate::scene::check) fn mend_launch(
    table: &Table,
    spec: &TableSpec,
    path: &str,
    context: &Context<'_>,
) -> Option<(Diagnostic, Vec<Span>, &'static str)> {
    let key = spec.key("velocity").filter(|_| spec.key("angular_velocity").is_some())?;
    if table.get(key.name).is_some() {
        return None;
    }
    let (speed, angle) = (find(table, &SPEEDS)?, find(table, &ANGLES)?);
    let vector = by_angle(table, context)?;
    let message = format!("unknown keys `{}` and `{}` in {path}", speed.name.text, angle.name.text);
    let error = Diagnostic::error(Code::UnknownKey, message)
        .at(speed.name.span, "`velocity` is a vector")
        .at(angle.name.span, "")
        .fix(whole(speed), format!("{} = {vector}", key.name))
        .fix(removal(whole(angle), context)?, "");
    Some((error, vec![speed.name.span, angle.name.span], key.name))
}

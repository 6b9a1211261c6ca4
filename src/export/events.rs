//! Impacts → a table with a row for each.

use std::io::Write;

use super::ExportError;
use super::table::Table;
use crate::simulate::Recorded;

/// The columns, with their units.
pub const EVENT_HEADER: [&str; 13] = [
    "t [s]",
    "body",
    "other",
    "x [m]",
    "y [m]",
    "z [m]",
    "nx",
    "ny",
    "nz",
    "jx [N·s]",
    "jy [N·s]",
    "jz [N·s]",
    "lost [J]",
];

/// Writes each impact: its time, the two bodies, the point of contact, the unit normal from the first to the second, the
/// impulse on the second, and the lost kinetic energy. The ground is called `ground`. Every number is the shortest text that
/// reads back as the same bits.
///
/// # Errors
/// If the table cannot be written, or the recording cannot be read.
pub fn write_events(run: &Recorded<'_>, out: impl Write) -> Result<usize, ExportError> {
    let scene = run.scene();
    let mut table = Table::new(out, &EVENT_HEADER)?;
    for impact in run.impacts() {
        let impact = impact?;
        table.numbers(&[impact.time])?;
        for id in impact.bodies {
            table.text(scene.bodies.get(id).map_or("ground", |body| &body.name))?;
        }
        for vector in [impact.place, impact.normal, impact.impulse] {
            table.numbers(&vector.to_array())?;
        }
        table.numbers(&[impact.energy])?;
        table.end_row()?;
    }
    table.finish()
}

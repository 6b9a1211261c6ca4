//! Writes impacts as a CSV table with one row for each impact.

use std::borrow::Cow;
use std::io::Write;

use super::ExportError;
use super::format::{Contents, Format};
use super::table::Table;
use crate::scene::Scene;
use crate::simulate::{Recorded, Selection};

/// A table of all impacts.
pub(super) struct Events;

impl Format for Events {
    fn option(&self) -> Option<&'static str> {
        Some("events")
    }

    fn lack(&self, scene: &Scene) -> Option<Cow<'static, str>> {
        let lack = "this scene has no impacts: `simulation.contacts = \"event-driven\"` finds them";
        scene.simulation.contacts.is_none().then_some(lack.into())
    }

    fn write(
        &self,
        run: &Recorded<'_>,
        _selection: &Selection,
        out: &mut dyn Write,
    ) -> Result<Contents, ExportError> {
        let rows = write_events(run, out)?;
        Ok(Contents::of_table(if rows == 1 { "1 impact".to_owned() } else { format!("{rows} impacts") }))
    }
}

/// The column names of the table of impacts, with units.
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

/// Writes all impacts of a run: the time, the two bodies, the contact point, the unit normal from the first to the second body, the
/// impulse on the second body, and the lost kinetic energy. The ground has the name `ground`. Every number is the shortest text that reads
/// back as the same bits. Returns the number of rows.
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

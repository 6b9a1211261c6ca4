//! Impacts → a table with a row for each.

use std::io::{self, Write};

use csv::WriterBuilder;

use super::ExportError;
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

/// Writes each impact: its time, the two bodies, where they touch, the unit normal from the first to the second, the impulse on the
/// second, and the kinetic energy that is lost. The ground is called `ground`. Every number is the shortest that reads back as the
/// same bits.
///
/// # Errors
/// If it cannot be written, or the recording cannot be read.
pub fn write_events(run: &Recorded<'_>, out: impl Write) -> Result<usize, ExportError> {
    let scene = run.scene();
    let mut csv = WriterBuilder::new().from_writer(out);
    csv.write_record(EVENT_HEADER).map_err(io::Error::from)?;
    let mut rows = 0;
    for impact in run.impacts() {
        let impact = impact?;
        csv.write_field(impact.time.to_string()).map_err(io::Error::from)?;
        for id in impact.bodies {
            let name = scene.bodies.get(id).map_or("ground", |body| &*body.name);
            csv.write_field(name).map_err(io::Error::from)?;
        }
        let vectors = [impact.place, impact.normal, impact.impulse].map(|vector| vector.to_array());
        for number in vectors.as_flattened().iter().chain([&impact.energy]) {
            csv.write_field(number.to_string()).map_err(io::Error::from)?;
        }
        csv.write_record(None::<&[u8]>).map_err(io::Error::from)?;
        rows += 1;
    }
    csv.flush()?;
    Ok(rows)
}

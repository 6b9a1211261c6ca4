//! Writes the motion of all bodies as a CSV table with a row for each time and body. A scene can read the table by `motion.trajectory`.

use std::io::Write;

use super::ExportError;
use super::format::{Contents, Format, count_of_bodies};
use super::table::Table;
use crate::simulate::{Recorded, Selection};

/// A table of all bodies.
pub(super) struct Bodies;

impl Format for Bodies {
    fn without_particles(&self) -> Option<&'static str> {
        Some("`--particles` makes a table of them")
    }

    fn write(
        &self,
        run: &Recorded<'_>,
        selection: &Selection,
        out: &mut dyn Write,
    ) -> Result<Contents, ExportError> {
        let rows = write_csv(run, selection, out)?;
        Ok(Contents::of_rows(rows, &count_of_bodies(run.scene()), run, selection))
    }
}

/// The column names of the table of bodies, with units.
pub const HEADER: [&str; 15] = [
    "t [s]",
    "body",
    "x [m]",
    "y [m]",
    "z [m]",
    "qx",
    "qy",
    "qz",
    "qw",
    "vx [m/s]",
    "vy [m/s]",
    "vz [m/s]",
    "wx [rad/s]",
    "wy [rad/s]",
    "wz [rad/s]",
];

/// Writes the motion of all bodies in the selected frames: center of mass, orientation as a quaternion, velocity, and angular velocity,
/// all in world axes. Every number is the shortest text that reads back as the same bits. Returns the number of rows.
///
/// # Errors
/// If the table cannot be written, or the recording cannot be read.
pub fn write_csv(run: &Recorded<'_>, selection: &Selection, out: impl Write) -> Result<usize, ExportError> {
    let scene = run.scene();
    let mut table = Table::new(out, &HEADER)?;
    for exposure in run.exposures(selection) {
        let frame = exposure?.frame;
        for body in &frame.bodies {
            table.numbers(&[frame.time])?;
            table.text(&scene.bodies[body.id].name)?;
            table.numbers(&body.location.to_array())?;
            table.numbers(&body.orientation.to_array())?;
            table.numbers(&body.velocity.to_array())?;
            table.numbers(&body.angular_velocity.to_array())?;
            table.end_row()?;
        }
    }
    table.finish()
}

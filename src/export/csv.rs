//! Frames → a table with a row for each time and body, which `motion.trajectory` reads.

use std::io::{self, Write};

use csv::WriterBuilder;

use super::ExportError;
use crate::simulate::{Recorded, Selection};

/// The columns, with their units.
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

/// Writes where all bodies are in some frames of a run: centre of mass, orientation as a quaternion,
/// velocity, and angular velocity in world axes. Every number is the shortest that reads back as the same bits.
///
/// # Errors
/// If it cannot be written, or the recording cannot be read.
pub fn write_csv(run: &Recorded<'_>, selection: &Selection, out: impl Write) -> Result<usize, ExportError> {
    let scene = run.scene();
    let mut csv = WriterBuilder::new().from_writer(out);
    csv.write_record(HEADER).map_err(io::Error::from)?;
    let mut rows = 0;
    for exposure in run.exposures(selection) {
        let frame = exposure?.frame;
        for body in &frame.bodies {
            csv.write_field(frame.time.to_string()).map_err(io::Error::from)?;
            csv.write_field(&*scene.bodies[body.id].name).map_err(io::Error::from)?;
            let vectors =
                [body.location.to_array(), body.velocity.to_array(), body.angular_velocity.to_array()];
            let [location, velocity, angular] = vectors;
            let numbers =
                location.into_iter().chain(body.orientation.to_array()).chain(velocity).chain(angular);
            for number in numbers {
                csv.write_field(number.to_string()).map_err(io::Error::from)?;
            }
            csv.write_record(None::<&[u8]>).map_err(io::Error::from)?;
            rows += 1;
        }
    }
    csv.flush()?;
    Ok(rows)
}

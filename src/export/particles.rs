//! Particles → a table with a row for each time and particle.

use std::io::{self, Write};

use csv::WriterBuilder;

use super::ExportError;
use crate::simulate::{Recorded, Selection};

/// The columns, with their units.
pub const PARTICLE_HEADER: [&str; 11] = [
    "t [s]", "emitter", "particle", "x [m]", "y [m]", "z [m]", "vx [m/s]", "vy [m/s]", "vz [m/s]",
    "born [s]", "dies [s]",
];

/// Writes the particles that are alive in some frames of a run: the emitter, the number of the particle, which it keeps for its life,
/// place, velocity, and the times of its birth and death; the latter is empty where it stays. Every number is the shortest that reads
/// back as the same bits.
///
/// # Errors
/// If it cannot be written, or the recording cannot be read.
pub fn write_particles(
    run: &Recorded<'_>,
    selection: &Selection,
    out: impl Write,
) -> Result<usize, ExportError> {
    let scene = run.scene();
    let mut csv = WriterBuilder::new().from_writer(out);
    csv.write_record(PARTICLE_HEADER).map_err(io::Error::from)?;
    let mut rows = 0;
    for exposure in run.exposures(selection) {
        let frame = exposure?.frame;
        for (emitter, swarm) in scene.emitters.iter().zip(&frame.particles) {
            for particle in swarm.iter() {
                csv.write_field(frame.time.to_string()).map_err(io::Error::from)?;
                csv.write_field(&*emitter.name).map_err(io::Error::from)?;
                csv.write_field(particle.number.to_string()).map_err(io::Error::from)?;
                let vectors = [particle.location, particle.velocity].map(|vector| vector.to_array());
                for number in vectors.as_flattened().iter().chain([&particle.born]) {
                    csv.write_field(number.to_string()).map_err(io::Error::from)?;
                }
                let dies = if particle.dies.is_finite() { particle.dies.to_string() } else { String::new() };
                csv.write_field(dies).map_err(io::Error::from)?;
                csv.write_record(None::<&[u8]>).map_err(io::Error::from)?;
                rows += 1;
            }
        }
    }
    csv.flush()?;
    Ok(rows)
}

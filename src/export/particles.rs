//! Writes particles as a CSV table with a row for each time and particle.

use std::borrow::Cow;
use std::io::Write;

use super::ExportError;
use super::format::{Contents, Format};
use super::table::Table;
use crate::scene::Scene;
use crate::simulate::{Recorded, Selection};

/// A table of all particles.
pub(super) struct Particles;

impl Format for Particles {
    fn option(&self) -> Option<&'static str> {
        Some("particles")
    }

    fn lack(&self, scene: &Scene) -> Option<Cow<'static, str>> {
        scene.emitters.is_empty().then_some("this scene has no emitters, which send out particles".into())
    }

    fn write(
        &self,
        run: &Recorded<'_>,
        selection: &Selection,
        out: &mut dyn Write,
    ) -> Result<Contents, ExportError> {
        let rows = write_particles(run, selection, out)?;
        Ok(Contents::of_rows(rows, &format!("{} emitters", run.scene().emitters.len()), run, selection))
    }
}

/// The column names of the table of particles, with units.
pub const PARTICLE_HEADER: [&str; 11] = [
    "t [s]", "emitter", "particle", "x [m]", "y [m]", "z [m]", "vx [m/s]", "vy [m/s]", "vz [m/s]",
    "born [s]", "dies [s]",
];

/// Writes the living particles in the selected frames of a run: the emitter, the number of the particle (constant during its life), its
/// location and velocity, and the times of its birth and death. The time of death is empty for a particle that lives forever. Every number
/// is the shortest text that reads back as the same bits. Returns the number of rows.
///
/// # Errors
/// If the table cannot be written, or the recording cannot be read.
pub fn write_particles(
    run: &Recorded<'_>,
    selection: &Selection,
    out: impl Write,
) -> Result<usize, ExportError> {
    let scene = run.scene();
    let mut table = Table::new(out, &PARTICLE_HEADER)?;
    for exposure in run.exposures(selection) {
        let frame = exposure?.frame;
        for (emitter, swarm) in scene.emitters.iter().zip(&frame.particles) {
            for particle in swarm.iter() {
                table.numbers(&[frame.time])?;
                table.text(&emitter.name)?;
                table.text(&particle.number.to_string())?;
                table.numbers(&particle.location.to_array())?;
                table.numbers(&particle.velocity.to_array())?;
                table.numbers(&[particle.born])?;
                match particle.dies {
                    dies if dies.is_finite() => table.numbers(&[dies])?,
                    _ => table.text("")?,
                }
                table.end_row()?;
            }
        }
    }
    table.finish()
}

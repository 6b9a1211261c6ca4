//! Writes the constraint forces and torques of joints as a CSV table with a row for each time and joint.

use std::io::Write;

use super::ExportError;
use super::table::Table;
use crate::simulate::{Recorded, Selection};

/// The column names of the table of joints, with units.
pub const JOINT_HEADER: [&str; 8] =
    ["t [s]", "joint", "fx [N]", "fy [N]", "fz [N]", "tx [N·m]", "ty [N·m]", "tz [N·m]"];

/// Writes the force of each joint on its second end, and its torque about the point of that end, in world axes. Both are zero while a body
/// of the joint is absent. Every number is the shortest text that reads back as the same bits. Returns the number of rows.
///
/// # Errors
/// If the table cannot be written, or the recording cannot be read.
pub fn write_joints(
    run: &Recorded<'_>,
    selection: &Selection,
    out: impl Write,
) -> Result<usize, ExportError> {
    let scene = run.scene();
    let mut table = Table::new(out, &JOINT_HEADER)?;
    for exposure in run.exposures(selection) {
        let frame = exposure?.frame;
        for (joint, reaction) in scene.joints.iter().zip(&frame.reactions) {
            table.numbers(&[frame.time])?;
            table.text(&joint.name)?;
            table.numbers(&reaction.force.to_array())?;
            table.numbers(&reaction.torque.to_array())?;
            table.end_row()?;
        }
    }
    table.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// The recording stores only changes. The table must contain a row for each frame, even where nothing changes.
    #[test]
    fn a_mass_that_hangs_has_a_row_of_its_weight_at_each_time() {
        let scene = Scene::parse(
            "simulation = { duration = 2, gravity = [0, -10, 0], integrator = 'rk4', frame_rate = 25 }
            [body.bob]\nshape.sphere.radius = 0.1\nmass = 3\nlocation = [0, -2, 0]
            [joint.string.rod]\nbetween = ['bob', [0, 0, 0]]
            [joint.other.rod]\nbetween = [[0, 0, 0], 'far']
            [body.far]\nshape.sphere.radius = 0.1\nlocation = [5, -5, 0]\nend = 0.99",
        )
        .unwrap();
        let mut table = Vec::new();
        let rows = write_joints(&Recorded::new(&scene).unwrap(), &Selection::first(51), &mut table).unwrap();
        let table = String::from_utf8(table).unwrap();
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!((rows, lines.len()), (102, 103));
        assert_eq!(lines[0], "t [s],joint,fx [N],fy [N],fz [N],tx [N·m],ty [N·m],tz [N·m]");
        for line in lines[1..].iter().filter(|line| line.contains("string")) {
            let numbers: Vec<f64> = line.split(',').skip(2).map(|number| number.parse().unwrap()).collect();
            assert!((numbers[1] + 30.0).abs() < 1e-9, "on the world: {line}");
        }
        assert!(lines[2].starts_with("0,other,") && !lines[2].ends_with(",0,0,0,0,0,0"), "{}", lines[2]);
        assert_eq!(lines[102], "2,other,0,0,0,0,0,0");
    }
}

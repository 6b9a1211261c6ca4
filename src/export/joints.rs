//! Writes the constraint forces and torques of joints as a CSV table with a row for each time and joint.

use std::borrow::Cow;
use std::io::Write;

use super::ExportError;
use super::format::{Contents, Format};
use super::table::Table;
use crate::physics::BodyId;
use crate::scene::{JointMeasure, JointState, Scene};
use crate::simulate::{Recorded, Selection};

/// A table of the forces and torques of joints.
pub(super) struct Joints;

impl Format for Joints {
    fn option(&self) -> Option<&'static str> {
        Some("joints")
    }

    fn lack(&self, scene: &Scene) -> Option<Cow<'static, str>> {
        if scene.is_for_many_bodies() {
            return Some(
                "time stepping of these bodies does not know the forces of joints: `simulation.contacts = \"event-driven\"` does"
                    .into(),
            );
        }
        scene.joints.is_empty().then_some("this scene has no joints".into())
    }

    fn write(
        &self,
        run: &Recorded<'_>,
        selection: &Selection,
        out: &mut dyn Write,
    ) -> Result<Contents, ExportError> {
        let rows = write_joints(run, selection, out)?;
        Ok(Contents::of_rows(rows, &format!("{} joints", run.scene().joints.len()), run, selection))
    }
}

/// The column names of the table of joints, with units.
pub const JOINT_HEADER: [&str; 12] = [
    "t [s]",
    "joint",
    "fx [N]",
    "fy [N]",
    "fz [N]",
    "tx [N·m]",
    "ty [N·m]",
    "tz [N·m]",
    "axial force [N]",
    "axial torque [N·m]",
    "motor [N or N·m]",
    "angle [°] or position [m]",
];

/// Writes the force of each joint on its second end, and its torque about the point of that end, in world axes. Both are zero while a body
/// of the joint is absent. For hinges and sliders, also writes the parts along the axis, the part of the motor, and the angle, counted through
/// full turns, or the position. These fields are empty for other joints. Every number is the shortest text that reads back as the same bits. Returns the number of rows.
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
        let body = |id: BodyId| frame.body(id.index()).copied();
        let moments = frame.reactions.iter().zip(&frame.angles);
        for (joint, (reaction, angle)) in scene.joints.iter().zip(moments) {
            table.numbers(&[frame.time])?;
            table.text(&joint.name)?;
            table.numbers(&reaction.force.to_array())?;
            table.numbers(&reaction.torque.to_array())?;
            let state = JointState::of(joint.kind.coordinate(), (*reaction, *angle), body);
            let coordinate = [JointMeasure::TotalAngle, JointMeasure::Position];
            let coordinate = coordinate.into_iter().find(|measure| measure.is_of(&joint.kind));
            let of_axis = [JointMeasure::AxialForce, JointMeasure::AxialTorque, JointMeasure::Motor];
            for measure in of_axis.into_iter().map(Some).chain([coordinate]) {
                match measure.filter(|measure| measure.is_of(&joint.kind)).map(|it| it.of(&state)) {
                    Some(number) if number.is_finite() => table.numbers(&[number])?,
                    _ => table.text("")?,
                }
            }
            table.end_row()?;
        }
    }
    table.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// A servo swings a wheel: φ = (φ'₀/ω) sin ωt, and its torque is −k φ. A wheel that turns freely counts its turns.
    #[test]
    fn motors_and_full_turns_are_in_the_table() {
        let wheel = "shape.sphere.radius = 0.5\nmass = 10";
        let scene = Scene::parse(&format!(
            "simulation = {{ duration = 2, gravity = [0, -10, 0], integrator = 'rk4', step = 0.001, frame_rate = 25 }}
            [body.wheel]\n{wheel}\nangular_velocity = [0, 3, 0]
            [joint.axle.hinge]\nbetween = [[0, 0, 0], 'wheel']\nat = [0, 0, 0]\naxis = [0, 1, 0]
            motor = {{ angle = 0, stiffness = 4 }}
            [body.free]\n{wheel}\nlocation = [3, 0, 0]\nangular_velocity = [0, 0, -20]
            [joint.pin.hinge]\nbetween = [[3, 0, 0], 'free']\nat = [3, 0, 0]\naxis = [0, 0, 1]"
        ))
        .unwrap();
        let mut table = Vec::new();
        write_joints(&Recorded::new(&scene).unwrap(), &Selection::first(51), &mut table).unwrap();
        for line in String::from_utf8(table).unwrap().lines().skip(1) {
            let number = |column: usize| line.split(',').nth(column).unwrap().parse::<f64>().unwrap();
            let t = number(0);
            let [axial_force, axial_torque, motor, angle] = [8, 9, 10, 11].map(number);
            if line.contains("axle") {
                // I = 0.4 m r² = 1 kg m², so ω = 2 rad/s.
                let expected = 1.5 * libm::sin(2.0 * t);
                assert!((angle - expected.to_degrees()).abs() < 1e-6, "{line}");
                assert!(
                    (motor + 4.0 * expected).abs() < 1e-6 && (axial_torque - motor).abs() < 1e-6,
                    "{line}"
                );
                assert!((axial_force - 100.0).abs() < 1e-6, "{line}");
            } else {
                assert!((angle + (20.0 * t).to_degrees()).abs() < 1e-6, "{line}");
                assert!(motor == 0.0 && axial_force.abs() < 1e-9, "{line}");
            }
        }
    }

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
        assert_eq!(
            lines[0],
            "t [s],joint,fx [N],fy [N],fz [N],tx [N·m],ty [N·m],tz [N·m],axial force [N],axial torque [N·m],motor [N or N·m],\
             angle [°] or position [m]"
        );
        for line in lines[1..].iter().filter(|line| line.contains("string")) {
            let numbers: Vec<f64> =
                line.split(',').skip(2).take(6).map(|number| number.parse().unwrap()).collect();
            assert!((numbers[1] + 30.0).abs() < 1e-9, "on the world: {line}");
        }
        assert!(lines[2].starts_with("0,other,") && !lines[2].ends_with(",0,0,0,0,0,0,,,,"), "{}", lines[2]);
        assert_eq!(lines[102], "2,other,0,0,0,0,0,0,,,,");
    }
}

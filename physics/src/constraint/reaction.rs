//! The reactions of constraints: the forces and torques that they exert on bodies.

use glam::DVec3;

use super::super::{Anchor, Model};
use super::solver::Solver;
use super::{Member, Members};

/// The force and the torque of a constraint on its second end, in world axes. Those on the first end are opposite. Both are zero while a
/// body of the constraint is absent. Redundant equations carry no load; the independent equations carry it all.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reaction {
    /// The force of the constraint on its second end, world axes, N.
    pub force: DVec3,
    /// The torque of the constraint on its second end, about the point of that end, world axes, N m.
    pub torque: DVec3,
    /// The part of the motor: the torque along the axis of a hinge, N m, or the force along the axis of a slider, N. 0 without a motor.
    pub motor: f64,
}

impl Reaction {
    /// Returns the same reaction with its torque about another point. `way` is the vector from the new reference point to the present one,
    /// m.
    fn about(self, way: DVec3) -> Reaction {
        Reaction { torque: self.torque + way.cross(self.force), ..self }
    }

    fn add(&mut self, other: Reaction) {
        self.force += other.force;
        self.torque += other.torque;
    }
}

impl Solver {
    /// Returns the reactions of all constraints of the model at the last evaluation of forces, in the order in which the constraints were
    /// added.
    pub(crate) fn reactions(&self, model: &Model) -> Vec<Reaction> {
        let joints = model.constraints().len();
        let mut all = vec![Reaction::default(); joints];
        let Some(structure) = &self.structure else { return all };
        for place in structure.places.iter().filter(|place| place.constraint < joints) {
            let width = place.bodies.len();
            // The reaction on each body of the constraint, about the body's center of mass.
            let mut on = vec![Reaction::default(); width];
            let motor_row = model.constraints()[place.constraint].motor_row();
            let mut motor = 0.0;
            let rows = place.row..place.row + place.rows;
            let multiplier = |row: usize| self.modes[row].given(self.laws[row]).unwrap_or(self.unknown[row]);
            let multipliers: Vec<f64> = rows.clone().map(multiplier).collect();
            for (row, &multiplier) in rows.zip(&multipliers) {
                if motor_row == Some(row - place.row) {
                    motor = multiplier;
                }
                let first = place.direction + (row - place.row) * width;
                for (on, direction) in on.iter_mut().zip(&self.jacobian[first..first + width]) {
                    on.add(Reaction {
                        force: multiplier * direction.linear,
                        torque: multiplier * direction.angular,
                        motor: 0.0,
                    });
                }
            }
            let member = |body: usize| -> &Member { &self.members[place.bodies[body]] };
            let ends = model.constraints()[place.constraint].ends();
            let Some(&second_end) = ends.last() else { continue };
            let members = Members {
                all: &self.members,
                of: &place.bodies,
                time: self.measured,
                origin: &self.origin,
                begun: self.begun,
                is_aiming: self.is_aiming,
            };
            let its = model.constraints()[place.constraint].force_on_last_end(&members, &multipliers);
            if let Some(force) = its {
                all[place.constraint] = Reaction { force, ..Reaction::default() };
                continue;
            }
            all[place.constraint] = match second_end {
                Anchor::Body { id, at } => {
                    let is_it = |member: &usize| structure.bodies[*member] == id.index();
                    let Some(body) = place.bodies.iter().position(is_it) else { continue };
                    on[body].about(-(member(body).orientation * at))
                }
                // A point of the world bears the reaction opposite to the sum over all bodies.
                Anchor::Point(point) => {
                    let mut sum = Reaction::default();
                    for (body, on) in on.into_iter().enumerate() {
                        sum.add(on.about(member(body).location - point));
                    }
                    Reaction { force: -sum.force, torque: -sum.torque, motor: 0.0 }
                }
            };
            all[place.constraint].motor = motor;
        }
        all
    }
}

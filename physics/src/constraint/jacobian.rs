//! Products with the constraint Jacobian J: rates and accelerations of constraint rows, and impulses and forces on bodies.

use glam::DVec3;

use super::super::{Model, State};
use super::friction::FrictionPair;
use super::member::Member;
use super::structure::Structure;
use super::{Direction, Row};

/// Adds M⁻¹ Jᵀ Λ, the velocity changes that the impulses Λ cause, to the velocities of the members. If the multipliers are forces, the
/// result is accelerations.
pub(super) fn move_members(
    structure: &Structure,
    jacobian: &[Direction],
    multipliers: &[f64],
    members: &mut [Member],
) {
    for_each_direction(structure, jacobian, multipliers, |member, direction, multiplier| {
        let member = &mut members[member];
        member.velocity += multiplier * member.inverse_mass * direction.linear;
        member.angular_velocity += member.turn(multiplier * direction.angular);
    });
}

/// Calls `act` for each direction of the Jacobian in rows with a nonzero multiplier, with the direction's member, the direction, and the
/// multiplier.
pub(super) fn for_each_direction(
    structure: &Structure,
    jacobian: &[Direction],
    multipliers: &[f64],
    mut act: impl FnMut(usize, &Direction, f64),
) {
    for (row, &multiplier) in multipliers.iter().enumerate() {
        if multiplier != 0.0 {
            for direction in &jacobian[structure.directions_of(row)] {
                act(direction.member, direction, multiplier);
            }
        }
    }
}

/// Computes the rate c' = J v + ∂c/∂t of each constraint row from the velocities of the members. Returns the magnitude of the terms, m/s:
/// the largest sum of absolute values in a row. Rates of angles count times the size of the mechanism.
pub(super) fn rates(
    structure: &Structure,
    jacobian: &[Direction],
    members: &[Member],
    rows: &[Row],
    out: &mut [f64],
) -> f64 {
    let mut largest = 0.0;
    for ((i, out), row) in out.iter_mut().enumerate().zip(rows) {
        let (sum, size) = product(structure, jacobian, members, i);
        *out = sum + row.rate;
        let unit = if row.scale.is_length { 1.0 } else { structure.length };
        for size in [unit * size, unit * row.rate.abs()] {
            if size > largest {
                largest = size;
            }
        }
    }
    largest
}

/// Returns the magnitude of the terms of all rates c', m/s: the largest sum of absolute values in a row. Rates of angles count times the
/// size of the mechanism. If the members hold accelerations in place of velocities, the result is that of c'', m/s². `more` returns what c'
/// or c'' of a row has in addition to J v. The two rows of friction at a contact count together, by the lengths of vectors: the result does
/// not depend on the directions of the tangents.
pub(super) fn magnitude(
    (structure, jacobian, members): (&Structure, &[Direction], &[Member]),
    rows: &[Row],
    grips: &[FrictionPair],
    more: impl Fn(&Row) -> f64,
) -> f64 {
    let mut pairs = grips.iter().map(|grip| grip.row).peekable();
    let (mut largest, mut i) = (0.0_f64, 0);
    while i < rows.len() {
        let unit = if rows[i].scale.is_length { 1.0 } else { structure.length };
        let (size, more) = if pairs.next_if_eq(&i).is_some() {
            i += 1;
            let both = [i - 1, i].map(|row| &jacobian[structure.directions_of(row)]);
            (pair_size(both, members), libm::hypot(more(&rows[i - 1]), more(&rows[i])))
        } else {
            (product(structure, jacobian, members, i).1, more(&rows[i]).abs())
        };
        largest = largest.max(unit * size).max(unit * more);
        i += 1;
    }
    largest
}

/// Returns the largest rate of two rows of friction that the speeds of their bodies can cause, from the directions of both rows.
fn pair_size([first, second]: [&[Direction]; 2], members: &[Member]) -> f64 {
    let mean = |a: DVec3, b: DVec3| (0.5 * (a.length_squared() + b.length_squared())).sqrt();
    let size = |(a, b): (&Direction, &Direction)| {
        let member = &members[a.member];
        mean(a.linear, b.linear) * member.velocity.length()
            + mean(a.angular, b.angular) * member.angular_velocity.length()
    };
    first.iter().zip(second).map(size).sum()
}

/// Computes J v for each constraint row from the velocities of the members. If the members hold accelerations in place of velocities, the
/// result is J a.
pub(super) fn products(structure: &Structure, jacobian: &[Direction], members: &[Member], out: &mut [f64]) {
    for (row, out) in out.iter_mut().enumerate() {
        *out = product(structure, jacobian, members, row).0;
    }
}

/// Computes J v for one constraint row. Returns J v and the sum of the absolute values of its terms.
#[inline(always)]
pub(super) fn product(
    structure: &Structure,
    jacobian: &[Direction],
    members: &[Member],
    row: usize,
) -> (f64, f64) {
    let (mut sum, mut size) = (0.0, 0.0);
    for direction in &jacobian[structure.directions_of(row)] {
        let member = &members[direction.member];
        let moving = direction.linear.dot(member.velocity);
        // A rod between centers of mass exerts no torque. Such rods are common, so the product is skipped.
        let turning = if direction.angular == DVec3::ZERO {
            0.0
        } else {
            direction.angular.dot(member.angular_velocity)
        };
        sum += moving + turning;
        size += moving.abs() + turning.abs();
    }
    (sum, size)
}

/// Books the work that the impulses Λ do through constraint rows that depend on time, such as motors: Λ J v, where J v = −∂c/∂t.
pub(super) fn book(rates: impl Iterator<Item = f64>, impulses: &[f64], state: &mut State) {
    for (rate, impulse) in rates.zip(impulses) {
        state.accounts.motors -= impulse * rate;
    }
}

/// Applies the impulses Jᵀ Λ to the bodies. A body with a given motion keeps its velocity: its guide, whatever makes it follow the motion,
/// absorbs the impulse. The work of the guide is booked.
pub(super) fn push(
    structure: &Structure,
    jacobian: &[Direction],
    impulses: &[f64],
    model: &Model,
    state: &mut State,
) {
    for_each_direction(structure, jacobian, impulses, |member, direction, impulse| {
        let i = structure.bodies[member];
        let inverse_mass = model.inverse_mass()[i];
        if inverse_mass != 0.0 {
            state.velocity[i] += impulse * inverse_mass * direction.linear;
            state.angular_momentum[i] += impulse * direction.angular;
        } else {
            let turning = direction.angular.dot(model.angular_velocity(i, state));
            state.accounts.work -= impulse * (direction.linear.dot(state.velocity[i]) + turning);
        }
    });
}

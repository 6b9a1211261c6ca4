//! The state of all advanced bodies as one list of numbers: the positions of all moving bodies, their velocities, the orientation and
//! angular momentum (in the body's [`axes`]) of each rotating body, and the work done so far.

use std::ops::Range;

use glam::{DQuat, DVec3};

use super::super::super::{Model, State};
use super::super::bodies::{Field, FreeRotation, axes};

/// The number of values for the rotation of a body: four for its orientation and three for its angular momentum.
const OF_TURN: usize = 7;

/// The allowed error of a rotation, as a fraction of that of a place. Tops and tumbling bodies multiply their errors more than places do.
const OF_ROTATION: f64 = 0.3;

/// The same fraction if no force has a torque. What such a rotation keeps is restored after each step, so a smaller error of the steps
/// pays off.
const OF_FREE_ROTATION: f64 = 0.1;

/// Returns the indices in the list at which the velocities, the rotations and the work begin.
fn places(field: &Field<'_>) -> [usize; 3] {
    let (moving, turning) = (field.bodies.moving.len(), field.bodies.turning.len());
    [3 * moving, 6 * moving, 6 * moving + OF_TURN * turning]
}

/// Writes the state of the advanced bodies at the current stage to the list `values`.
pub(super) fn read(field: &Field<'_>, values: &mut Vec<f64>) {
    let (bodies, stage) = (field.bodies, &*field.stage);
    values.clear();
    values.extend(bodies.moving.iter().flat_map(|&i| stage.location[i].to_array()));
    values.extend(bodies.moving.iter().flat_map(|&i| stage.velocity[i].to_array()));
    for &i in &bodies.turning {
        values.extend(stage.orientation[i].to_array());
        values.extend(field.momentum(i).to_array());
    }
    if bodies.works {
        values.push(stage.accounts.work);
    }
}

/// Writes the list `values` to the bodies of `state`.
pub(super) fn write(field: &Field<'_>, values: &[f64], state: &mut State) {
    let [velocities, turns, work] = places(field);
    let bodies = field.bodies;
    for ((&i, at), velocity) in
        bodies.moving.iter().zip(triples(&values[..velocities])).zip(triples(&values[velocities..turns]))
    {
        state.location[i] = at;
        state.velocity[i] = velocity;
    }
    write_turns(field.model, &bodies.turning, &values[turns..work], state);
    if bodies.works {
        state.accounts.work = values[work];
    }
}

/// Writes the values of rotations to the bodies `turning`.
fn write_turns(model: &Model, turning: &[usize], values: &[f64], state: &mut State) {
    for (&i, turn) in turning.iter().zip(values.as_chunks::<OF_TURN>().0) {
        let [x, y, z, w, momentum @ ..] = *turn;
        let orientation = DQuat::from_xyzw(x, y, z, w).normalize();
        state.orientation[i] = orientation;
        state.angular_momentum[i] = axes(model, i, orientation) * DVec3::from(momentum);
    }
}

fn triples(values: &[f64]) -> impl Iterator<Item = DVec3> {
    values.as_chunks::<3>().0.iter().map(|&triple| triple.into())
}

/// Normalizes the quaternions of all orientations in the list, and restores what `free` rotations keep.
pub(super) fn normalize(field: &Field<'_>, free: &[FreeRotation], values: &mut [f64]) {
    let [_, turns, work] = places(field);
    for (k, turn) in values[turns..work].as_chunks_mut::<OF_TURN>().0.iter_mut().enumerate() {
        let [x, y, z, w, momentum @ ..] = *turn;
        let mut orientation = DQuat::from_xyzw(x, y, z, w).normalize();
        if let Some(rotation) = free.get(k) {
            let inverse_inertia = field.model.inverse_inertia()[field.bodies.turning[k]];
            let (restored, momentum) = rotation.restore(inverse_inertia, orientation, momentum.into());
            turn[4..].copy_from_slice(&momentum.to_array());
            orientation = restored;
        }
        turn[..4].copy_from_slice(&orientation.to_array());
    }
}

/// Writes the time derivatives of all values of the list at time `t` (s) to `slope`.
pub(super) fn find_slope(field: &mut Field<'_>, t: f64, values: &[f64], slope: &mut [f64]) {
    let [velocities, turns, work] = places(field);
    {
        let bodies = field.bodies;
        let stage = &mut *field.stage;
        for (&i, at) in bodies.moving.iter().zip(triples(&values[..velocities])) {
            stage.location[i] = at;
        }
        for (&i, velocity) in bodies.moving.iter().zip(triples(&values[velocities..turns])) {
            stage.velocity[i] = velocity;
        }
        write_turns(field.model, &bodies.turning, &values[turns..work], stage);
    }
    field.evaluate(t);
    slope[..velocities].copy_from_slice(&values[velocities..turns]);
    for (&i, slope) in field.bodies.moving.iter().zip(slope[velocities..turns].as_chunks_mut::<3>().0) {
        *slope = field.acceleration(i).to_array();
    }
    for (&i, slope) in field.bodies.turning.iter().zip(slope[turns..work].as_chunks_mut::<OF_TURN>().0) {
        let (turning, momentum) = field.turning(i);
        slope[..4].copy_from_slice(&turning.to_array());
        slope[4..].copy_from_slice(&momentum.to_array());
    }
    if field.bodies.works {
        slope[work] = field.loads.power.work;
    }
}

/// Calls `see` for each body with the ranges of its values in the list, and with their largest size before and after a step. The work
/// comes last, as if it belonged to another body.
pub(super) fn each_body(
    field: &Field<'_>,
    before: &[f64],
    after: &[f64],
    mut see: impl FnMut(usize, [(Range<usize>, f64); 2]),
) {
    let [velocities, turns, work] = places(field);
    let scales = field.scales;
    let largest = |range: Range<usize>, least: f64| {
        let square = |values: &[f64]| values[range.clone()].iter().map(|value| value * value).sum::<f64>();
        square(before).max(square(after)).sqrt().max(least).max(f64::MIN_POSITIVE)
    };
    let mut energy = 0.0;
    for (k, &i) in field.bodies.moving.iter().enumerate() {
        let at = 3 * k..3 * k + 3;
        let velocity = velocities + 3 * k..velocities + 3 * k + 3;
        let (length, speed) = (largest(at.clone(), scales.length), largest(velocity.clone(), scales.speed));
        energy += field.model.mass()[i] * speed * speed;
        see(i, [(at, length), (velocity, speed)]);
    }
    let part = if field.model.turns_bodies() { OF_ROTATION } else { OF_FREE_ROTATION };
    for (k, &i) in field.bodies.turning.iter().enumerate() {
        let start = turns + OF_TURN * k;
        let momentum = start + 4..start + OF_TURN;
        let usual = field.model.inertia()[i].max_element() * scales.speed / scales.length;
        let size = largest(momentum.clone(), if usual.is_finite() { usual } else { 0.0 });
        see(i, [(start..start + 4, part), (momentum, part * size)]);
    }
    if field.bodies.works {
        let size = largest(work..work + 1, energy);
        see(0, [(work..work + 1, size), (0..0, 1.0)]);
    }
}

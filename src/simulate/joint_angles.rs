//! Completes the joints of each moment of a run: counts the full turns of hinges, and adds servos to the reactions of their joints.

use std::f64::consts::TAU;

use crate::physics::{BodyId, Snapshot, find};
use crate::scene::Scene;

/// The angles of all joints of a scene, counted through full turns.
pub(super) struct JointAngles {
    last: Vec<Seen>,
}

/// The angle of a joint at the last moment at which it was seen.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    /// The time, s.
    time: f64,
    /// The rate of the angle, rad/s.
    rate: f64,
    /// The angle, counted through full turns, rad.
    angle: f64,
}

impl JointAngles {
    /// The number of values that describe an angle in a checkpoint.
    const NUMBERS_PER_ANGLE: usize = 3;

    /// Starts to count at the start of a run, where all angles are 0.
    pub(super) fn new(scene: &Scene) -> JointAngles {
        JointAngles { last: vec![Seen::default(); scene.joints.len()] }
    }

    /// Sets the counted angles of a moment, and adds servos to its reactions. Moments must come in the order of their times.
    ///
    /// A snapshot shows an angle except for full turns. Of all angles that it may show, the one counts that is nearest to the angle
    /// predicted from the rates at both moments. So the count is right if the true mean rate between the moments differs from the mean of
    /// these two rates by less than half a turn in this time.
    pub(super) fn see(&mut self, scene: &Scene, snapshot: &mut Snapshot) {
        let Snapshot { time, bodies, reactions, angles, .. } = snapshot;
        let body = |id: BodyId| find(bodies, id.index()).copied();
        angles.clear();
        for (number, (joint, last)) in scene.joints.iter().zip(&mut self.last).enumerate() {
            if let (Some(servo), Some(reaction)) = (&joint.servo, reactions.get_mut(number)) {
                servo.join(reaction, *time, body);
            }
            let coordinate = joint.kind.coordinate().filter(crate::physics::Coordinate::is_angle);
            if let Some([angle, rate]) = coordinate.and_then(|coordinate| coordinate.seen(body)) {
                let predicted = last.angle + 0.5 * (last.rate + rate) * (*time - last.time);
                let turns = libm::round((predicted - angle) / TAU);
                *last = Seen { time: *time, rate, angle: angle + TAU * turns };
            }
            angles.push(last.angle);
        }
    }

    /// Returns the state of the count, for a checkpoint.
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> {
        self.last.iter().flat_map(|Seen { time, rate, angle }| [*time, *rate, *angle])
    }

    /// Returns the number of values that [`numbers`](Self::numbers) returns.
    pub(super) fn size(&self) -> usize {
        JointAngles::NUMBERS_PER_ANGLE * self.last.len()
    }

    /// Continues the count from a state that [`numbers`](Self::numbers) has returned.
    pub(super) fn resume(&mut self, numbers: &[f64]) {
        for (last, &[time, rate, angle]) in self.last.iter_mut().zip(numbers.as_chunks().0) {
            *last = Seen { time, rate, angle };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Snapshots;
    use super::*;

    /// A wheel turns at 100 rad/s, 0.6 turns between two frames, and a motor turns another one faster and faster, up to 0.4 turns.
    #[test]
    fn angles_are_counted_through_full_turns() {
        let scene = Scene::parse(
            "simulation = { duration = 1, frame_rate = 25, integrator = 'rk4', step = 0.0005 }
            [body.wheel]\nshape.cylinder = { radius = 0.5, height = 0.1 }\nangular_velocity = [0, -100, 0]
            [joint.axle.hinge]\nbetween = [[0, 0, 0], 'wheel']\nat = [0, 0, 0]\naxis = [0, 1, 0]
            [body.other]\nshape.cylinder = { radius = 0.5, height = 0.1 }\nlocation = [3, 0, 0]
            [joint.driven.hinge]\nbetween = [[3, 0, 0], 'other']\nat = [3, 0, 0]\naxis = [0, 1, 0]
            motor = { angle = '1000*t^2' }
            ",
        )
        .unwrap();
        for moment in Snapshots::new(&scene) {
            let moment = moment.unwrap();
            let expected = [-100.0 * moment.time, (1000.0 * moment.time * moment.time).to_radians()];
            for (found, expected) in moment.angles.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-5, "{} {found} {expected}", moment.time);
            }
        }
    }
}

//! A servo: a spring and a damper that pull a joint's coordinate towards a given function of time.

use std::sync::Arc;

use super::super::{BodyId, BodySnapshot, Force, Loads, Moment, WorkAccount};
use super::member::{End, Member};
use super::{Coordinate, Members, Reaction, Target, parts};

/// A servo motor with compliance: its force or torque is k (q₀(t) − q) + d (q₀'(t) − q'), where q is the joint's coordinate.
#[derive(Clone, Debug)]
pub struct Servo {
    /// q: the joint coordinate that the servo drives.
    pub coordinate: Coordinate,
    /// q₀: the target value of the coordinate as a function of time.
    pub target: Arc<dyn Target>,
    /// k: the stiffness of the spring, N m/rad or N/m.
    pub stiffness: f64,
    /// d: the damping coefficient, N m s/rad or N s/m.
    pub damping: f64,
}

impl Servo {
    /// Returns the torque (N m) or the force (N) of the servo at a time (s) from its coordinate and the rate of the coordinate.
    fn effort(&self, time: f64, [at, rate]: [f64; 2]) -> f64 {
        let [value, wanted, _] = self.target.at(time);
        self.stiffness * self.coordinate.difference(value, at) + self.damping * (wanted - rate)
    }

    /// Adds the servo to the reaction of its joint at a time, s. The closure `body` returns the snapshot of a body. Does nothing while a
    /// body of the joint is absent.
    pub fn join(&self, reaction: &mut Reaction, time: f64, body: impl Fn(BodyId) -> Option<BodySnapshot>) {
        let Some((seen, axis)) = self.coordinate.seen(&body).zip(self.coordinate.axis_seen(&body)) else {
            return;
        };
        let effort = self.effort(time, seen);
        reaction.motor += effort;
        if self.coordinate.is_angle() {
            reaction.torque += effort * axis;
        } else {
            reaction.force += effort * axis;
        }
    }
}

impl Force for Servo {
    fn apply(&self, moment: &Moment<'_>, loads: &mut Loads) {
        let ids = parts::bodies(&self.coordinate.between);
        if ids.iter().any(|id| !moment.model.is_present(id.index())) {
            return;
        }
        let mut all = [Member::default(); 2];
        for (member, id) in all.iter_mut().zip(&ids) {
            *member = Member::of(id.index(), moment.model, moment.state);
        }
        let members = Members {
            all: &all,
            of: &[0, 1],
            time: moment.time,
            origin: &all,
            begun: moment.time,
            is_aiming: false,
        };
        let ends = End::all(&self.coordinate.between, &members);
        let free = self.coordinate.measure(&ends);
        let rate = Coordinate::rate(&ends, &free);
        let effort = self.effort(moment.time, [free.value, rate]);
        for (body, linear, angular) in Coordinate::directions(&free) {
            if let Some(body) = body {
                let i = ids[body].index();
                loads.force[i] += effort * linear;
                loads.torque[i] += effort * angular;
            }
        }
        loads.power.motors += effort * rate;
    }

    fn potential(&self, _: &Moment<'_>) -> f64 {
        0.0
    }

    fn work_account(&self) -> Option<WorkAccount> {
        Some(WorkAccount::Motors)
    }
}

//! A servo: a spring and a damper that pull a joint's coordinate towards a given function of time.

use std::sync::Arc;

use super::super::{Force, Loads, Moment, WorkAccount};
use super::member::{End, Member};
use super::{Coordinate, Members, Target, parts};

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
        let [value, wanted, _] = self.target.at(moment.time);
        let effort =
            self.stiffness * self.coordinate.difference(value, free.value) + self.damping * (wanted - rate);
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

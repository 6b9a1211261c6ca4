//! Makes snapshots of time-stepping runs: the bodies, contacts and forces at one moment.

use rapier3d_f64::prelude::Pose;

use super::super::contact::ContactSnapshot;
use super::super::{Balance, BodySnapshot, Reaction, Snapshot, State};
use super::TimeStepping;
use super::touch::{Point, Touch};

impl TimeStepping {
    /// Returns a snapshot of the present state, or of `state` if it is given. The contacts and joints are those of the last step.
    pub(super) fn picture(&mut self, time: f64, balance: Balance, state: Option<&State>) -> Snapshot {
        let Self { model, state: own, loads, .. } = self;
        let seen = state.unwrap_or(own);
        model.sum(time, seen, loads);
        model.bear(seen, loads);
        model.guide(time, loads);
        self.add_contact_forces();
        let Self { model, state: own, loads, .. } = self;
        let state = state.unwrap_or(own);
        let bodies = BodySnapshot::of_all(model, state, loads);
        let contacts = if self.shows_contacts { self.contacts() } else { Vec::new() };
        let reactions = vec![Reaction::default(); self.joints.len()];
        let penetration = self.penetration();
        Snapshot { time, bodies, reactions, contacts, penetration, balance, ..Snapshot::default() }
    }

    /// Adds the contact forces of the last step to the loads, each averaged over the step.
    fn add_contact_forces(&mut self) {
        let Self { engine, model, loads, steps, .. } = self;
        if *steps == 0 {
            return;
        }
        let dt = engine.integration_parameters.dt;
        for touch in engine.narrow_phase.contact_pairs().flat_map(Touch::of_pair) {
            let Some(push) = touch.push() else { continue };
            let force = (push.impulse * touch.normal() + push.friction) / dt;
            let [one, two] = touch.bodies;
            for (body, force) in [(one, -force), (two, force)] {
                if model.inverse_mass()[body] != 0.0 {
                    loads.force[body] += force;
                }
            }
        }
    }

    /// Returns the contacts of the last step, ordered by their bodies.
    fn contacts(&self) -> Vec<ContactSnapshot> {
        let dt = self.engine.integration_parameters.dt;
        let mut all = Vec::new();
        if self.steps == 0 {
            return all;
        }
        for pair in self.engine.narrow_phase.contact_pairs() {
            for touch in Touch::of_pair(pair) {
                let [one, two] = touch.bodies;
                let sign = if one < two { 1.0 } else { -1.0 };
                let pushing: Vec<Point> = touch.points().filter(|point| point.impulse > 0.0).collect();
                let Some(push) = touch.push() else { continue };
                all.extend(pushing.iter().map(|point| ContactSnapshot {
                    bodies: [one.min(two), one.max(two)],
                    place: self.state.location[one] + point.arms[0],
                    normal: sign * touch.normal(),
                    force: sign * point.impulse / dt * touch.normal(),
                    // The physics engine computes one friction impulse for all points of a contact. Each point gets a share in proportion
                    // to its normal impulse.
                    friction: sign * point.impulse / push.impulse / dt * push.friction,
                }));
            }
        }
        all.sort_by_key(|contact| contact.bodies);
        all
    }

    /// The greatest penetration of two bodies at present, m; 0 if no bodies overlap.
    #[must_use]
    pub fn penetration(&self) -> f64 {
        self.deepest(None).map_or(0.0, |(_, depth)| depth.max(0.0))
    }

    /// Returns the two bodies with the greatest penetration, and their penetration, m (negative if they are apart). `None` if no bodies
    /// are near each other. If `some` are given, one of the two is among these.
    pub(super) fn deepest(&self, some: Option<&[usize]>) -> Option<([usize; 2], f64)> {
        let Self { engine, model, state, rolling, .. } = self;
        let pose = |i: usize| {
            let orientation = rolling.unturned(i).unwrap_or(state.orientation[i]);
            model.movable()[i].then(|| Pose::from_parts(state.location[i], orientation))
        };
        let touches = engine.narrow_phase.contact_pairs().flat_map(Touch::of_pair);
        let counts = |touch: &Touch<'_>| {
            some.is_none_or(|some| touch.bodies.iter().any(|body| some.binary_search(body).is_ok()))
        };
        let touches = touches.filter(counts);
        touches.map(|touch| (touch.bodies, touch.depth(pose))).max_by(|one, two| one.1.total_cmp(&two.1))
    }
}

//! The impulses of impacts, with exact joints.

use glam::DVec3;

use super::super::constraint::Solver;
use super::super::sets::Sets;
use super::super::{Model, State};
use super::bounce;
use super::rebound::{Onset, OnsetPoint};

/// A body counts as locked by its joints if an impulse changes its velocity by at most this fraction of the change without joints.
const MIN_RESPONSE_FRACTION: f64 = 1e-9;

/// Computes how bodies on joints respond to impulses.
#[derive(Default)]
pub(super) struct JointResponse {
    solver: Solver,
}

/// The impulses that end the approach of two bodies.
pub(super) struct Need {
    /// The impulse at each point of the contact, N s.
    pub(super) impulses: Vec<f64>,
    /// Whether the contact and all contacts that depend on it through joints have given at least these impulses together.
    pub(super) is_met: bool,
}

/// A point at which two bodies meet.
struct Meeting<'a> {
    /// The index of the contact.
    number: usize,
    onset: &'a Onset,
    point: &'a OnsetPoint,
}

impl Meeting<'_> {
    /// Returns the impulse on a body and its moment about the centre for a unit impulse at this point.
    fn push(&self, side: usize) -> (DVec3, DVec3) {
        let impulse = if side == 0 { -self.onset.normal } else { self.onset.normal };
        (impulse, self.point.arms[side].cross(impulse))
    }

    /// Returns the velocity of the point along the normal if it belongs to a body with this velocity and this angular velocity.
    fn speed(&self, side: usize, (velocity, turning): (DVec3, DVec3)) -> f64 {
        (velocity + turning.cross(self.point.arms[side])).dot(self.onset.normal)
    }
}

impl JointResponse {
    /// Must be called when bodies appear or disappear.
    pub(super) fn forget_bodies(&mut self) {
        self.solver.forget();
    }

    /// Computes the impulses at the points of all `onsets` that end the approach there. Joints hold exactly. Motors, limits, ropes and other
    /// contacts have no influence.
    pub(super) fn needs(
        &mut self,
        onsets: &[Onset],
        (model, time, state): (&Model, f64, &State),
    ) -> Vec<Need> {
        self.solver.hold_joints(model, time, state);
        let meetings: Vec<Meeting<'_>> = onsets
            .iter()
            .enumerate()
            .flat_map(|(number, onset)| {
                onset.points.iter().map(move |point| Meeting { number, onset, point })
            })
            .collect();
        let count = meetings.len();
        let mut response = Vec::with_capacity(count * count);
        let mut coupled = Sets::new(onsets.len());
        for pushed in &meetings {
            let bodies = pushed.onset.bodies;
            let own = self.solver.respond(model, state, bodies, [pushed.push(0), pushed.push(1)]);
            let motion = |body: usize| {
                let side = bodies.iter().position(|own| *own == body);
                side.map(|side| own[side]).or_else(|| self.solver.response_of(body)).unwrap_or_default()
            };
            let free = [0, 1].map(|side| model.respond(bodies[side], state, pushed.push(side)));
            let free = pushed.speed(1, free[1]) - pushed.speed(0, free[0]);
            for meeting in &meetings {
                let [one, two] = [0, 1].map(|side| meeting.speed(side, motion(meeting.onset.bodies[side])));
                if one != two {
                    coupled.unite(pushed.number, meeting.number);
                }
                // A body that a joint connects to a given motion may be unable to move. Its response is then only a rounding error.
                response.push(if (two - one).abs() > MIN_RESPONSE_FRACTION * free { two - one } else { 0.0 });
            }
        }
        let approach: Vec<f64> = meetings.iter().map(|meeting| meeting.point.approach).collect();
        let impulses = bounce::impulses(&approach, |i, j| response[j * count + i]);
        let mut missing = vec![0.0; onsets.len()];
        for (meeting, impulse) in meetings.iter().zip(&impulses) {
            missing[coupled.first(meeting.number)] += impulse - meeting.point.impulse;
        }
        let mut impulses = impulses.into_iter();
        let need = |(number, onset): (usize, &Onset)| Need {
            impulses: impulses.by_ref().take(onset.points.len()).collect(),
            is_met: missing[coupled.first(number)] <= 0.0,
        };
        onsets.iter().enumerate().map(need).collect()
    }
}

//! Separation of overlapping bodies of a pile, by moving them apart.

use glam::{DQuat, DVec3};

use super::super::super::contact::pose;
use super::super::super::{Model, State};
use super::super::separate::{IGNORED_OVERLAP, MAX_SHIFT, SEPARATION_SWEEP_TOLERANCE};
use super::super::sweep::Stopping;
use super::island::Rows;
use super::{Body, Island, Pile};

impl Pile {
    /// Measures the overlaps of bodies at a state. Returns true if any of them is too deep to be ignored.
    pub(crate) fn are_within(&mut self, model: &Model, state: &State) -> bool {
        let shallow = if self.points.is_empty() { 0.0 } else { IGNORED_OVERLAP * self.least_size() };
        let mut is_within = false;
        for point in &mut self.points {
            let place = &self.contacts[point.contact].place;
            let meeting = place.meet(place.bodies.map(|body| pose(body, model, state)));
            point.set(&meeting, place.bodies.map(|body| state.location[body]));
            is_within |= point.gap < -shallow;
        }
        is_within
    }

    /// Moves overlapping bodies apart. [`are_within`](Self::are_within) must have measured the overlaps at this state.
    pub(crate) fn separate(&mut self, model: &Model, state: &mut State) {
        let deepest = self.points.iter().map(|point| -point.gap).fold(0.0, f64::max);
        for body in &mut self.bodies {
            body.follow(model, state);
            // The velocities stand for shifts.
            body.free = [DVec3::ZERO; 2];
            [body.velocity, body.angular_velocity] = body.free;
        }
        let islands = std::mem::take(&mut self.islands);
        for island in &islands {
            if self.points[island.points.clone()].iter().any(|point| point.gap < 0.0) {
                self.part(island, SEPARATION_SWEEP_TOLERANCE * deepest, state);
            }
        }
        self.islands = islands;
    }

    /// The largest shift of a body of an island, m. Turns count times the size of the body.
    fn largest_shift(&self, island: &Island) -> f64 {
        let shift = |body: &Body| body.velocity.length() + body.size * body.angular_velocity.length();
        self.bodies[island.bodies.clone()].iter().filter(|body| body.moves()).map(shift).fold(0.0, f64::max)
    }

    /// Moves the bodies of an island apart, until a sweep moves none by more than `tolerance`, m.
    fn part(&mut self, island: &Island, tolerance: f64, state: &mut State) {
        // The shifts in a stack add up. Where bodies are wedged, the acceleration can go astray: shifts then grow without changing any gap.
        let points = &self.points[island.points.clone()];
        let deepest = points.iter().map(|point| -point.gap).fold(0.0, f64::max);
        let bound = MAX_SHIFT * deepest * points.len() as f64;
        for point in &mut self.points[island.points.clone()] {
            point.respond(&self.bodies);
            point.goal = DVec3::X * -point.gap;
        }
        self.impulses[island.points.clone()].fill([0.0; 3]);
        self.sweep(island, Stopping::fast(tolerance), Rows::Normals);
        if self.largest_shift(island) > bound {
            self.impulses[island.points.clone()].fill([0.0; 3]);
            for body in &mut self.bodies[island.bodies.clone()] {
                [body.velocity, body.angular_velocity] = body.free;
            }
            self.sweep(island, Stopping::patient(tolerance), Rows::Normals);
        }
        for body in self.bodies[island.bodies.clone()].iter().filter(|body| body.moves()) {
            state.location[body.index] += body.velocity;
            if body.angular_velocity != DVec3::ZERO {
                let turn = DQuat::from_scaled_axis(body.angular_velocity);
                state.orientation[body.index] = (turn * state.orientation[body.index]).normalize();
            }
        }
    }
}

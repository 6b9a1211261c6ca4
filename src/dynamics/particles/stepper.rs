//! Steps of particles: with the forces, the method and the time steps of bodies.

use std::sync::Arc;

use glam::DVec3;

use super::way::Leap;
use super::{Course, Particle};
use crate::dynamics::constraint::Solver;
use crate::dynamics::{BodyId, Force, Integrator, Method, Model, RigidBody, Shape, State, System};

/// Makes a force on these particles, from the bodies that it comes from.
type Make = dyn Fn(Vec<BodyId>, Vec<BodyId>) -> Arc<dyn Force> + Send + Sync;

/// A force on particles.
#[derive(Clone)]
pub struct Field {
    make: Arc<Make>,
    /// The bodies that it comes from, each as it enters the force.
    sources: Vec<(BodyId, RigidBody)>,
}

impl Field {
    /// A force that comes from no body, made for the particles that it is given.
    pub fn new(make: impl Fn(Vec<BodyId>) -> Arc<dyn Force> + Send + Sync + 'static) -> Field {
        Field { make: Arc::new(move |particles, _| make(particles)), sources: Vec::new() }
    }

    /// A force that comes from bodies. It is made for particles, with the numbers that the bodies have among them.
    pub fn from_bodies(
        sources: Vec<(BodyId, RigidBody)>,
        make: impl Fn(Vec<BodyId>, Vec<BodyId>) -> Arc<dyn Force> + Send + Sync + 'static,
    ) -> Field {
        Field { make: Arc::new(make), sources }
    }
}

/// The steps of an interval: all of the same length from `begin` on; the last one ends at `end`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    pub(super) begin: f64,
    pub(super) end: f64,
    pub(super) step: f64,
}

/// Steps that are longer than the longest by less than this part are not made two.
const ROUNDING: f64 = 1e-6;

impl Grid {
    /// The time at the end of a step, s; step 0 is the beginning.
    fn time(&self, number: u32) -> f64 {
        let time = self.begin + f64::from(number) * self.step;
        if time >= self.end - ROUNDING * self.step { self.end } else { time }
    }

    /// The first step that ends after time `t`, s.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the conversion saturates, and what is too early is stepped over"
    )]
    fn first_after(&self, t: f64) -> u32 {
        let mut number = ((t - self.begin) / self.step).floor() as u32;
        while self.time(number) <= t && self.time(number) < self.end {
            number += 1;
        }
        number
    }
}

/// Advances a fixed number of particles side by side.
#[derive(Clone)]
pub(super) struct Stepper {
    lanes: usize,
    model: Model,
    state: State,
    solver: Solver,
    integrator: Box<dyn Integrator>,
    /// The bodies that forces come from, which stand behind the particles.
    sources: Vec<BodyId>,
    /// Places and velocities at the beginning of a step, where somebody asks for them.
    before: Vec<(DVec3, DVec3)>,
}

impl Stepper {
    /// One for particles of a mass (kg) and a charge (C).
    pub(super) fn new(
        lanes: usize,
        (mass, charge): (f64, f64),
        fields: &[Field],
        method: &Method,
    ) -> Stepper {
        let (mut model, mut state) = (Model::default(), State::default());
        // It does not turn, so its size does not matter.
        let particle = RigidBody::new(&Shape::Sphere { radius: 1.0 }, mass).with_charge(charge);
        (0..lanes).for_each(|_| model.push(&particle, &mut state));
        let particles: Vec<BodyId> = (0..lanes).map(BodyId::new).collect();
        let mut sources = Vec::new();
        for Field { make, sources: bodies } in fields {
            let numbers = (model.len()..model.len() + bodies.len()).map(BodyId::new).collect();
            for (body, start) in bodies {
                model.push(start, &mut state);
                sources.push(*body);
            }
            model.push_force(make(particles.clone(), numbers));
        }
        let (solver, integrator) = (Solver::default(), (method.create)());
        Stepper { lanes, model, state, solver, integrator, sources, before: Vec::new() }
    }

    /// The number of particles that it advances side by side.
    pub(super) fn lanes(&self) -> usize {
        self.lanes
    }

    /// Says how the bodies move that forces come from. One that is not there has none, and stays away.
    pub(super) fn follow(&mut self, course: &dyn Fn(BodyId) -> Option<Course>) {
        for (place, &body) in self.sources.iter().enumerate() {
            let number = self.lanes + place;
            let course = course(body);
            self.model.let_come_and_go(&[(number, course.is_some())], &mut self.state);
            if let Some(course) = course {
                self.model.drive(number, Arc::new(course));
            }
        }
    }

    /// Advances at most as many particles as there are lanes, from time `t` (s) to the end of the grid.
    pub(super) fn advance(&mut self, particles: &mut [Particle], t: f64, grid: &Grid) {
        self.enter(particles, t);
        let (mut now, mut number) = (t, grid.first_after(t));
        while now < grid.end {
            let next = grid.time(number);
            self.step(now, next);
            (now, number) = (next, number + 1);
        }
        self.leave(particles);
    }

    /// The same, but `look` sees each step of each particle, by its place among them.
    pub(super) fn advance_seen(
        &mut self,
        particles: &mut [Particle],
        t: f64,
        grid: &Grid,
        look: &mut dyn FnMut(usize, &Leap),
    ) {
        self.enter(particles, t);
        let (mut now, mut number) = (t, grid.first_after(t));
        while now < grid.end {
            let next = grid.time(number);
            self.note(particles.len());
            self.step(now, next);
            (0..particles.len()).for_each(|lane| look(lane, &self.made(lane, [now, next])));
            (now, number) = (next, number + 1);
        }
        self.leave(particles);
    }

    /// The same, but `change` gives the end of each step of each particle. Each step begins anew, so that no particle depends on
    /// what happens to another.
    pub(super) fn advance_changed(
        &mut self,
        particles: &mut [Particle],
        t: f64,
        grid: &Grid,
        change: &mut dyn FnMut(&Leap) -> (DVec3, DVec3),
    ) {
        self.enter(particles, t);
        let (mut now, mut number) = (t, grid.first_after(t));
        while now < grid.end {
            let next = grid.time(number);
            self.note(particles.len());
            self.step(now, next);
            for lane in 0..particles.len() {
                (self.state.location[lane], self.state.velocity[lane]) =
                    change(&self.made(lane, [now, next]));
            }
            self.integrator.discontinuity();
            (now, number) = (next, number + 1);
        }
        self.leave(particles);
    }

    /// Makes one step of a single particle: from a place and a velocity to a place and a velocity.
    pub(super) fn leap(&mut self, (place, velocity): (DVec3, DVec3), times: [f64; 2]) -> (DVec3, DVec3) {
        (self.state.location[0], self.state.velocity[0]) = (place, velocity);
        self.integrator.discontinuity();
        self.model.place(times[0], &mut self.state);
        self.step(times[0], times[1]);
        let end = (self.state.location[0], self.state.velocity[0]);
        self.rest();
        end
    }

    fn enter(&mut self, particles: &[Particle], t: f64) {
        for (lane, particle) in particles.iter().enumerate() {
            self.state.location[lane] = particle.location;
            self.state.velocity[lane] = particle.velocity;
        }
        self.integrator.discontinuity();
        self.model.place(t, &mut self.state);
    }

    fn step(&mut self, now: f64, next: f64) {
        let mut system = System::new(&self.model, &mut self.solver);
        system.set_out(now, next - now, &self.state);
        self.integrator.advance(&mut system, now, next - now, &mut self.state);
        self.model.place(next, &mut self.state);
    }

    fn leave(&mut self, particles: &mut [Particle]) {
        for (lane, particle) in particles.iter_mut().enumerate() {
            particle.location = self.state.location[lane];
            particle.velocity = self.state.velocity[lane];
        }
        self.rest();
    }

    /// Notes where the first lanes are at the beginning of a step.
    fn note(&mut self, lanes: usize) {
        self.before.clear();
        let state = &self.state;
        self.before.extend((0..lanes).map(|lane| (state.location[lane], state.velocity[lane])));
    }

    /// The step that a lane has made.
    fn made(&self, lane: usize, times: [f64; 2]) -> Leap {
        let (place, velocity) = self.before[lane];
        Leap {
            times,
            places: [place, self.state.location[lane]],
            velocities: [velocity, self.state.velocity[lane]],
        }
    }

    /// Stops what is left in lanes that the next particles may not fill: it would fly on, and become non-finite.
    fn rest(&mut self) {
        self.state.velocity[..self.lanes].fill(DVec3::ZERO);
    }
}

//! Advances particles in steps, with the forces, the integrator and the timesteps of bodies.

use std::sync::Arc;

use glam::DVec3;

use super::particle_step::ParticleStep;
use super::{Particle, RecordedMotion};
use crate::constraint::Solver;
use crate::{BodyId, Force, Integrator, Method, Model, RigidBody, Shape, State, System};

/// Makes a force on particles. The first list holds the indices of the particles, the second those of the bodies that cause the force.
type Make = dyn Fn(Vec<BodyId>, Vec<BodyId>) -> Arc<dyn Force> + Send + Sync;

/// A force that acts on particles.
#[derive(Clone)]
pub struct Field {
    make: Arc<Make>,
    /// The bodies that cause the force, with their masses and charges.
    sources: Vec<(BodyId, RigidBody)>,
}

impl Field {
    /// Creates a force that no body causes, such as uniform gravity. `make` receives the indices of the particles.
    pub fn new(make: impl Fn(Vec<BodyId>) -> Arc<dyn Force> + Send + Sync + 'static) -> Field {
        Field { make: Arc::new(move |particles, _| make(particles)), sources: Vec::new() }
    }

    /// Creates a force that bodies cause, such as their gravitation. `make` receives the indices of the particles and the indices of these
    /// bodies.
    pub fn from_bodies(
        sources: Vec<(BodyId, RigidBody)>,
        make: impl Fn(Vec<BodyId>, Vec<BodyId>) -> Arc<dyn Force> + Send + Sync + 'static,
    ) -> Field {
        Field { make: Arc::new(make), sources }
    }

    /// Returns the bodies that cause the force, with their masses and charges.
    pub(super) fn sources(&self) -> &[(BodyId, RigidBody)] {
        &self.sources
    }

    /// Makes the force on particles, given the indices of the particles and of the bodies that cause the force.
    pub(super) fn force(&self, particles: Vec<BodyId>, sources: Vec<BodyId>) -> Arc<dyn Force> {
        (self.make)(particles, sources)
    }
}

/// The division of an interval into steps. All steps have the same length, except the last one, which ends at `end`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    pub(super) begin: f64,
    pub(super) end: f64,
    pub(super) step: f64,
}

/// The relative tolerance of step lengths: the last step may be longer than the others by this fraction.
const STEP_TOLERANCE: f64 = 1e-6;

impl Grid {
    /// Returns the time at the end of step `number`, s. Number 0 stands for the beginning of the interval.
    fn time(&self, number: u32) -> f64 {
        let time = self.begin + f64::from(number) * self.step;
        if time >= self.end - STEP_TOLERANCE * self.step { self.end } else { time }
    }

    /// Returns the number of the first step that ends after time `t`, s.
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

/// Advances up to a fixed number of particles side by side.
#[derive(Clone)]
pub(super) struct Stepper {
    lanes: usize,
    model: Model,
    state: State,
    solver: Solver,
    integrator: Box<dyn Integrator>,
    /// The bodies that cause forces. In the state, their entries come after those of the particles.
    sources: Vec<BodyId>,
    /// The position (m) and the velocity (m/s) of each particle at the beginning of a step. Empty if no caller needs them.
    before: Vec<(DVec3, DVec3)>,
}

impl Stepper {
    /// Creates a stepper for `lanes` particles with this mass (kg) and this charge (C).
    pub(super) fn new(
        lanes: usize,
        (mass, charge): (f64, f64),
        fields: &[Field],
        method: &Method,
    ) -> Stepper {
        let (mut model, mut state) = (Model::default(), State::default());
        // A particle does not rotate, so the radius does not matter.
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

    /// The number of particles that are advanced side by side.
    pub(super) fn lanes(&self) -> usize {
        self.lanes
    }

    /// Sets the motion of the bodies that cause forces. An absent body causes no force.
    pub(super) fn follow(&mut self, course: &dyn Fn(BodyId) -> Option<RecordedMotion>) {
        for (place, &body) in self.sources.iter().enumerate() {
            let number = self.lanes + place;
            let course = course(body);
            self.model.let_come_and_go(&[(number, course.is_some())], &mut self.state);
            if let Some(course) = course {
                self.model.drive(number, Arc::new(course));
            }
        }
    }

    /// Advances at most `lanes` particles from time `t` (s) to the end of the interval that `grid` divides into steps.
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

    /// Advances particles as `advance` does. Calls `look` for each step of each particle, with the index of the particle.
    pub(super) fn advance_seen(
        &mut self,
        particles: &mut [Particle],
        t: f64,
        grid: &Grid,
        look: &mut dyn FnMut(usize, &ParticleStep),
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

    /// Advances particles as `advance` does. For each step of each particle, `change` returns the position and the velocity at the end of
    /// the step. The integrator starts again at each step, so that no particle depends on an impact of another particle.
    pub(super) fn advance_changed(
        &mut self,
        particles: &mut [Particle],
        t: f64,
        grid: &Grid,
        change: &mut dyn FnMut(&ParticleStep) -> (DVec3, DVec3),
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

    /// Makes one step of a single particle. Takes its position (m) and velocity (m/s) at the beginning, and returns those at the end.
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

    /// Saves the positions and velocities of the first `lanes` particles at the beginning of a step.
    fn note(&mut self, lanes: usize) {
        self.before.clear();
        let state = &self.state;
        self.before.extend((0..lanes).map(|lane| (state.location[lane], state.velocity[lane])));
    }

    /// Returns the last step of the particle in a lane: its states at the beginning and at the end.
    fn made(&self, lane: usize, times: [f64; 2]) -> ParticleStep {
        let (place, velocity) = self.before[lane];
        ParticleStep {
            times,
            places: [place, self.state.location[lane]],
            velocities: [velocity, self.state.velocity[lane]],
        }
    }

    /// Sets the velocities in all lanes to zero. In a lane without a new particle, the old particle would otherwise move on and become
    /// non-finite.
    fn rest(&mut self) {
        self.state.velocity[..self.lanes].fill(DVec3::ZERO);
    }
}

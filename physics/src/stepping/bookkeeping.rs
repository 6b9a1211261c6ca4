//! Books the energy that contacts and joints take or give in each step.

use glam::DVec3;
use rapier3d_f64::prelude::PhysicsWorld;

use super::super::motion::Twist;
use super::super::{Accounts, Loads, Model, State};
use super::impacts::{Impacts, StepMotion};
use super::joint::{Joints, MotorPush};
use super::mean_velocity::MeanVelocity;
use super::mixing::Mixing;
use super::non_potential_work::NonPotentialWork;
use super::rebound::{Onset, Rebounds};
use super::sliding::Sliding;
use super::touch::{self, Touch};

/// The bookkeeping of contacts and joints: data of the last step from which their work follows.
pub(super) struct Bookkeeping {
    /// The twist of each body before the last step, and its mean during that step.
    pub(super) before: Vec<Twist>,
    pub(super) mean: Vec<Twist>,
    /// The position of each body's centre of mass before the last step, m.
    pub(super) places: Vec<DVec3>,
    /// For each body, whether it touched another body, or came near one, in the last step.
    touched: Vec<bool>,
    /// For each body, whether a joint holds it.
    held: Vec<bool>,
    /// The change of each body's angular momentum by contacts and joints in the last step, world axes, N m s. Zero for bodies that forces
    /// do not move.
    pub(super) turned: Vec<DVec3>,
    /// The impulses of the joints' motors in the last step.
    pub(super) motors: Vec<MotorPush>,
    pub(super) impacts: Impacts,
}

impl Bookkeeping {
    pub(super) fn new(bodies: usize, length: f64, held: Vec<bool>) -> Bookkeeping {
        let still = vec![(DVec3::ZERO, DVec3::ZERO); bodies];
        Bookkeeping {
            held,
            turned: vec![DVec3::ZERO; bodies],
            motors: Vec::new(),
            before: still.clone(),
            places: vec![DVec3::ZERO; bodies],
            touched: vec![false; bodies],
            mean: still,
            impacts: Impacts::new(length),
        }
    }

    /// Adds the work of contacts and joints in the last step to the accounts, and finds the impacts of the step. `time` is the end of the
    /// step, s. Returns the impacts that begin in the step and whose rebounds come in the next step.
    ///
    /// An impulse changes the kinetic energy of a body by its product with the mean of the velocities before and after it, also if other
    /// impulses act at the same time. The sum over both bodies of a contact is the energy loss. The contribution of a guided body is work.
    ///
    /// The physics engine also shifts overlapping bodies apart, or lets them sink in, without a lasting velocity. Forces with a potential
    /// do work during that displacement. Contacts absorb or release the same energy.
    pub(super) fn close(
        &mut self,
        engine: &PhysicsWorld,
        (model, joints, mean_velocity): (&Model, &Joints, &MeanVelocity),
        (state, loads, driven): (&mut State, &Loads, &NonPotentialWork),
        (rebounds, mixing, sliding): (&Rebounds, &Mixing, &mut Sliding),
        time: f64,
    ) -> Vec<Onset> {
        let mut pushing = self.impacts.begin();
        let mut touched = std::mem::take(&mut self.touched);
        touched.fill(false);
        let mut accounts = Accounts::default();
        // The energy that contacts give to the bodies held by joints in this step, J.
        let mut pressed = 0.0;
        let mut onsets = Vec::new();
        sliding.begin();
        self.book_rebounds(rebounds, model, &mut accounts, &mut pressed);
        let meet = |touch: &Touch<'_>| touch.bodies.into_iter().for_each(|body| touched[body] = true);
        touch::visit(engine.narrow_phase.contact_pairs(), meet, |pair, touch, push| {
            pushing.see(pair);
            sliding.see(touch, push, &self.mean);
            onsets.extend(rebounds.onset((pair, touch), &self.before, mixing));
            let Some([one, two]) = touch.work(push, &self.mean) else { return };
            accounts.impacts += two[0] - one[0];
            accounts.friction += two[1] - one[1];
            for (body, work) in touch.bodies.into_iter().zip([one[0] + one[1], -(two[0] + two[1])]) {
                if model.is_guided(body) {
                    accounts.work += work;
                }
                if self.held[body] && model.inverse_mass()[body] != 0.0 {
                    pressed -= work;
                }
            }
        });
        self.touched = touched;
        let dt = engine.integration_parameters.dt;
        accounts.add(1.0, driven.work(dt, &self.mean));
        let (mut pulled, mut led) = (0.0, 0.0);
        for i in (0..self.touched.len()).filter(|&i| self.touched[i] || self.held[i]) {
            let shift = state.location[i] - self.places[i] - dt * state.velocity[i];
            let account = if self.touched[i] { &mut accounts.impacts } else { &mut pulled };
            *account -= (loads.force[i] - driven.on(i)).dot(shift);
            if self.held[i] && model.inverse_mass()[i] != 0.0 {
                // Contacts and joints cause the part of the velocity change that does not follow from the body's force.
                let change = model.mass()[i] * (state.velocity[i] - self.before[i].0) - dt * loads.force[i];
                let work = change.dot(self.mean[i].0) + self.turned[i].dot(self.mean[i].1);
                pulled += work;
                if mean_velocity.is_led_by_motors(i) {
                    led += work;
                }
            }
        }
        // A body with its mean velocity moves by the first solution of the engine, which keeps only the motors' impulses of the second one.
        // Joints then do no work, so the work comes from the motors.
        let is_read = |push: &&MotorPush| !push.moves(|body| mean_velocity.is_led_by_motors(body));
        let read: f64 =
            self.motors.iter().filter(is_read).map(|push| push.work(|body| self.mean[body])).sum();
        let motors = led + read;
        accounts.motors += motors;
        // The remaining energy comes from joints: they yield and hit limits, and guided bodies do work through them.
        let others = pulled - pressed - motors;
        if joints.has_guide {
            accounts.work += others;
        } else {
            accounts.limits += others;
        }
        state.accounts.add(1.0, accounts);
        let motion = StepMotion { before: &self.before, mean: &self.mean, places: &self.places };
        self.impacts.complete(rebounds, &motion);
        self.impacts.find(engine, &pushing, (time, &motion), &mut onsets);
        onsets
    }

    /// Books the work of the rebounds of this step. Adds the energy that they give to the bodies held by joints to `pressed`, J.
    fn book_rebounds(&self, rebounds: &Rebounds, model: &Model, accounts: &mut Accounts, pressed: &mut f64) {
        for (body, work) in rebounds.due.iter().flat_map(|rebound| rebound.work(&self.mean)) {
            accounts.impacts += work;
            if model.is_guided(body) {
                accounts.work -= work;
            }
            if self.held[body] && model.inverse_mass()[body] != 0.0 {
                *pressed += work;
            }
        }
    }
}

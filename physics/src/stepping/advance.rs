//! Time integration with the physics engine. Steps have equal lengths between two births or deaths of bodies. Requested moments within a
//! step are interpolated.

use glam::{DQuat, DVec3};

use super::super::contact::crowded;
use super::super::world::steps_of;
use super::super::{Balance, BodyId, Breakdown, Snapshot, State};
use super::bounce::Bounce;
use super::engine_input::EngineInput;
use super::hooks::Hooks;
use super::mean_velocity::Stepped;
use super::{TimeStepping, bodies, kept_contacts, rotation, set_step};

/// The largest overlap of two bodies that is allowed at the start, as a fraction of the thickness of the thinnest moving body.
const MAX_INITIAL_OVERLAP: f64 = 0.1;
/// If at least this many bodies appear at once, their overlaps are checked before the step. The overlaps of fewer bodies are found in their
/// first step.
const MIN_NEWCOMERS_TO_CHECK: usize = 64;
/// Within a step, the physics engine may shorten a rope by this multiple of the length that the rope's rotation adds to it.
const ROPE_SHORTENING_FACTOR: f64 = 2.0;
/// The allowed difference between the path of a fast body on a joint and its velocity times the step, as a fraction of the latter. If the
/// path is shorter by more, the body counts as stopped at a surface.
const ARC_TOLERANCE: f64 = 0.2;

impl TimeStepping {
    /// Advances to time `t` in steps that end at each birth and death. Calls `see` with a snapshot for each of `moments`.
    pub(super) fn advance_by_events(
        &mut self,
        t: f64,
        moments: &[f64],
        see: &mut dyn FnMut(Snapshot),
    ) -> Result<(), Breakdown> {
        let mut left = moments;
        while self.time < t {
            let due = self.calendar.depart(self.time);
            self.change(&due);
            let leg = self.calendar.leg(t, left);
            left = leg.later;
            self.advance_evenly(leg.end, leg.within, see)?;
            let due = self.calendar.arrive(self.time);
            self.change(&due);
            self.ledger.close(&self.model, self.time, &self.state);
            for _ in leg.at_end {
                let balance = self.ledger.peek(&self.model, self.time, &self.state);
                see(self.picture(self.time, balance, None).checked()?);
            }
        }
        Ok(())
    }

    fn advance_evenly(
        &mut self,
        t: f64,
        moments: &[f64],
        see: &mut dyn FnMut(Snapshot),
    ) -> Result<(), Breakdown> {
        let (start, interval) = (self.time, t - self.time);
        let steps = steps_of(interval, self.step);
        let dt = interval / f64::from(steps);
        let mut left = moments;
        for k in 0..steps {
            let begin = start + f64::from(k) * dt;
            let end = if k + 1 == steps { t } else { start + f64::from(k + 1) * dt };
            let (within, later) = left.split_at(left.partition_point(|&moment| moment <= end));
            left = later;
            if !within.is_empty() {
                self.before.clone_from(&self.state);
            }
            self.make_step(begin, end, dt)?;
            for &moment in within {
                let balance = self.look_within((moment - begin) / dt);
                see(self.picture(moment, balance.1, Some(&balance.0)).checked()?);
            }
        }
        self.time = t;
        Ok(())
    }

    /// Returns the state and the energy balance after a fraction of the last step. Positions are interpolated; velocities are those at the
    /// end of the step.
    fn look_within(&self, part: f64) -> (State, Balance) {
        let (before, mut within) = (&self.before, self.state.clone());
        for i in 0..within.len() {
            within.location[i] = before.location[i].lerp(self.state.location[i], part);
            within.orientation[i] = before.orientation[i].slerp(self.state.orientation[i], part).normalize();
        }
        within.accounts = before.accounts;
        let mut change = self.state.accounts;
        change.add(-1.0, before.accounts);
        within.accounts.add(part, change);
        let balance = self.ledger.peek(&self.model, self.time, &within);
        (within, balance)
    }

    /// Makes one step of `dt` from time `begin` to time `end`, s. Fails if a state is not finite, or if bodies overlap deeply at the start
    /// of the run.
    fn make_step(&mut self, begin: f64, end: f64, dt: f64) -> Result<(), Breakdown> {
        self.ledger.close(&self.model, begin, &self.state);
        self.model.place(begin, &mut self.state);
        self.check_crowd(begin)?;
        self.model.sum(begin, &self.state, &mut self.loads);
        self.driven.begin(&self.model, begin, &self.state, &mut self.loads);
        self.model.bear(&self.state, &mut self.loads);
        self.state.accounts.add(dt, self.loads.power);
        let stretch = self.mean_velocity.begin(&self.engine, &self.joints, (&self.model, &self.state), dt);
        self.rebounds.begin(self.steps);
        self.push(end, dt);
        let Self { books, engine, rolling, mixing, joints, slow, rebounds, .. } = self;
        joints.set_speeds(engine, &self.state, |body| rolling.spin(body));
        set_step(&mut engine.integration_parameters, dt, ROPE_SHORTENING_FACTOR * stretch / dt);
        let bounce = Bounce { rebounds, dt, slow: *slow };
        engine.step_with_events(&Hooks { mixing, rolling, bounce }, &books.impacts.events);
        self.steps += 1;
        if let Some(body) = self.engine.quarantine().bodies().first() {
            let body = BodyId::new(body.into_raw_parts().0 as usize);
            let failure = Breakdown::Diverged { body, time: end };
            self.failure = Some(failure);
            return Err(failure);
        }
        self.pull(dt);
        self.check_newcomers(begin)?;
        self.close(end);
        Ok(())
    }

    /// Returns an error if a body overlaps another deeply when it appears, at the start of the run or later. Such bodies would shoot apart.
    /// Fails if very many bodies have appeared in one place. The physics engine would take memory in proportion to their pairs.
    fn check_crowd(&mut self, time: f64) -> Result<(), Breakdown> {
        if self.newcomers.len() < MIN_NEWCOMERS_TO_CHECK {
            return Ok(());
        }
        let (contacts, bodies) = (&self.mixing.contacts, (&self.model, &self.state));
        let found = crowded(contacts, &self.newcomers, self.deepest_allowed(), bodies);
        found.map_or(Ok(()), |found| self.overlapping(found, time))
    }

    /// Returns the largest overlap that is allowed when bodies appear, m.
    fn deepest_allowed(&self) -> f64 {
        MAX_INITIAL_OVERLAP * self.engine.integration_parameters.length_unit
    }

    fn overlapping(&mut self, (bodies, depth): ([usize; 2], f64), time: f64) -> Result<(), Breakdown> {
        let [one, two] = bodies;
        let bodies = [one.min(two), one.max(two)].map(BodyId::new);
        let failure = Breakdown::Overlapping { bodies, time, depth };
        self.failure = Some(failure);
        Err(failure)
    }

    fn check_newcomers(&mut self, time: f64) -> Result<(), Breakdown> {
        if self.newcomers.is_empty() {
            return Ok(());
        }
        let mut newcomers = std::mem::take(&mut self.newcomers);
        newcomers.sort_unstable();
        let allowed = self.deepest_allowed();
        let deepest = self.deepest(Some(&newcomers)).filter(|(_, depth)| *depth > allowed);
        deepest.map_or(Ok(()), |found| self.overlapping(found, time))
    }

    /// Passes the forces on the bodies and their angular velocities to the physics engine, before a step of `dt` that ends at time `end`,
    /// s.
    fn push(&mut self, end: f64, dt: f64) {
        let Self { model, state, loads, engine, handles, books, half_thickness, inputs, .. } = self;
        let Self { rolling, kept_contacts, mixing, thin_rods, slow, rebounds, reach, sliding, .. } = self;
        for (i, input) in inputs.iter_mut().enumerate() {
            books.before[i] = (state.velocity[i], model.angular_velocity(i, state));
            books.places[i] = state.location[i];
            if model.inverse_mass()[i] == 0.0 {
                continue;
            }
            let (impulse, moment) = rebounds.push(i);
            state.angular_momentum[i] += dt * loads.torque[i] + moment;
            let (orientation, momentum) = (state.orientation[i], state.angular_momentum[i]);
            let turning = model.angular_velocity(i, state);
            let leading = if thin_rods.is_steady(i, orientation, turning) {
                rotation::steady(turning, dt)
            } else {
                rotation::free(orientation, momentum, model.inverse_inertia()[i], dt)
            };
            let wanted = EngineInput {
                force: loads.force[i] + impulse / dt,
                turning: leading
                    - rolling.take(
                        engine,
                        kept_contacts.colliders(i),
                        i,
                        (orientation, turning, leading),
                        dt,
                    ),
                // Fast bodies must not pass through moving bodies. By default, the physics engine stops fast bodies only at bodies at
                // rest.
                is_fast: dt * (state.velocity[i] + model.inverse_mass()[i] * impulse).length()
                    > half_thickness[i],
            };
            let is_moving = state.velocity[i].length() + reach[i] * turning.length() > *slow;
            let is_bouncing = mixing.has_restitution && is_moving || rebounds.is_due(i);
            let is_sliding = is_moving && sliding.may_slide(i, *slow);
            let is_turning = !rolling.is_ball(i) && reach[i] * turning.length() > *slow;
            kept_contacts.set(engine, i, is_bouncing || is_sliding || is_turning || rolling.is_spun(i));
            if !rolling.is_ball(i) {
                kept_contacts.turn(engine, i, orientation);
            }
            if rolling.is_round(i) {
                kept_contacts.shift(
                    engine,
                    i,
                    state.location[i],
                    kept_contacts::MAX_KEPT_PATH * half_thickness[i],
                );
            }
            if !input.is_same(&wanted) {
                let Some(body) = engine.bodies.get_mut(handles[i]) else { continue };
                wanted.write(body);
                *input = wanted;
            }
            books.mean[i].1 = input.turning;
        }
        self.guide(end, dt);
    }

    /// Moves the guided bodies to their poses at time `end`, s, and passes these poses on to the physics engine, but not the spins of round
    /// bodies.
    fn guide(&mut self, end: f64, dt: f64) {
        self.model.place(end, &mut self.state);
        let Self { model, state, engine, handles, rolling, kept_contacts, reach, slow, .. } = self;
        for (i, handle) in handles.iter().enumerate().filter(|(i, _)| model.is_guided(*i)) {
            let Some(from) = engine.bodies.get(*handle).map(|body| *body.rotation()) else { continue };
            let mut pose = bodies::pose(state, i);
            let leading = rotation::leading(from, pose.rotation, dt);
            let turning = model.angular_velocity(i, state);
            let untaken =
                leading - rolling.take(engine, kept_contacts.colliders(i), i, (from, turning, leading), dt);
            let is_turning = reach[i] * turning.length() > *slow;
            kept_contacts.set(engine, i, is_turning || rolling.is_spun(i));
            kept_contacts.turn(engine, i, pose.rotation);
            if untaken != leading {
                pose.rotation = rotation::advanced(from, untaken, dt);
                // Remembers that the engine does not rotate the body by its spin.
                let _: Option<(DQuat, bool)> = rolling.turn(i, [from, pose.rotation], dt);
            } else {
                rolling.set(i);
            }
            if let Some(body) = engine.bodies.get_mut(*handle) {
                body.set_next_kinematic_position(pose);
            }
        }
    }

    /// Reads the positions and velocities of the bodies from the physics engine after a step of `dt`, s.
    fn pull(&mut self, dt: f64) {
        let Self { model, state, engine, handles, books, joints, inputs, rolling, mean_velocity, .. } = self;
        let rebounds = &self.rebounds;
        let slop = engine.integration_parameters.allowed_linear_error();
        let is_stopped = |i: usize| {
            let body = inputs[i].is_fast.then(|| engine.bodies.get(handles[i])).flatten();
            let Some(body) = body else { return false };
            let way = dt * body.linvel();
            // A body on a joint describes an arc, so it advances less along its velocity.
            let tolerance =
                if mean_velocity.is_held(i) { slop.max(ARC_TOLERANCE * way.length()) } else { slop };
            (way - (body.translation() - state.location[i])).dot(way) > tolerance * way.length()
        };
        let stopped: Vec<bool> = (0..handles.len()).map(is_stopped).collect();
        let stepped = |i: usize| {
            let (body, from) = (engine.bodies.get(handles[i])?, bodies::pose(state, i));
            Some(Stepped { body, from, is_stopped: stopped[i] })
        };
        mean_velocity.end((engine, handles), joints, stepped, dt);
        books.motors = joints.motor_pushes(engine, state);
        let (mut moved, mut carried) = (Vec::new(), Vec::new());
        for (i, handle) in handles.iter().enumerate() {
            if model.inverse_mass()[i] == 0.0 {
                let after = (state.velocity[i], model.angular_velocity(i, state));
                books.mean[i] = middle(books.before[i], after);
                if rolling.spin(i) != DVec3::ZERO && model.is_guided(i) {
                    moved.push((*handle, bodies::pose(state, i)));
                }
                continue;
            }
            let Some(body) = engine.bodies.get(*handle) else { continue };
            let from = state.orientation[i];
            let (mut velocity, mut turning) = (body.linvel(), body.angvel());
            inputs[i].turning = turning;
            let mut pose = *body.position();
            let (orientation, is_turned) =
                rolling.turn(i, [from, pose.rotation], dt).unwrap_or((pose.rotation, false));
            if is_turned {
                pose.rotation = orientation;
            }
            let way = dt * velocity;
            if stopped[i] {
                // The physics engine has stopped the body at a surface, or slightly inside it. Contacts there are soft, so the speed of
                // the body would carry it through the surface. To prevent this, the body is moved slightly in front of the surface.
                pose.translation -= 4.0 * slop * way.normalize();
            } else if let Some(mean) = mean_velocity.mean((i, body), bodies::pose(state, i), turning, dt) {
                (velocity, turning) = mean;
                carried.push((*handle, velocity));
            }
            if stopped[i] || is_turned {
                moved.push((*handle, pose));
            }
            state.velocity[i] = velocity;
            state.location[i] = pose.translation;
            state.orientation[i] = orientation;
            // Contacts and joints change the angular velocity for the inertia tensor at the start of the step.
            let change = turning - books.mean[i].1;
            books.turned[i] = rebounds.push(i).1;
            if change != DVec3::ZERO {
                let inertia = model.inertia()[i];
                let change = from * (inertia * (from.conjugate() * change));
                books.turned[i] += change;
                state.angular_momentum[i] += change;
            }
            let after = (state.velocity[i], model.angular_velocity(i, state));
            books.mean[i] = middle(books.before[i], after);
        }
        for (handle, pose) in moved {
            if let Some(body) = engine.bodies.get_mut(handle) {
                body.set_position(pose, false);
            }
        }
        for (handle, velocity) in carried {
            if let Some(body) = engine.bodies.get_mut(handle) {
                body.set_linvel(velocity, false);
            }
        }
    }

    /// Books the work of contacts and joints in a step that ends at time `end`, s, and finds the impacts and the rebounds.
    fn close(&mut self, end: f64) {
        let Self { books, engine, model, joints, state, loads, driven, mixing, rebounds, sliding, .. } = self;
        let bodies = (&*model, &*joints, &self.mean_velocity);
        let onsets = books.close(engine, bodies, (state, loads, driven), (rebounds, mixing, sliding), end);
        rebounds.prepare(onsets, (model, end, state));
    }

    /// Enables bodies that are born and disables bodies that die. `due` holds the index of each body, and true for a birth.
    fn change(&mut self, due: &[(usize, bool)]) {
        if due.is_empty() {
            return;
        }
        self.ledger.open(&self.model, self.time, &self.state);
        self.model.let_come_and_go(due, &mut self.state);
        self.rebounds.forget_bodies();
        self.model.place(self.time, &mut self.state);
        for &(i, comes) in due {
            let Some(body) = self.engine.bodies.get_mut(self.handles[i]) else { continue };
            body.set_enabled(comes);
            if comes {
                self.newcomers.push(i);
                body.set_position(bodies::pose(&self.state, i), false);
                body.set_linvel(self.state.velocity[i], false);
                self.inputs[i] = EngineInput::read(body);
                self.rolling.set(i);
            }
        }
    }
}

fn middle(one: (DVec3, DVec3), two: (DVec3, DVec3)) -> (DVec3, DVec3) {
    (0.5 * (one.0 + two.0), 0.5 * (one.1 + two.1))
}

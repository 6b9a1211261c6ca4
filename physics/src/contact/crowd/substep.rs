//! One substep of Moreau's scheme, for the bodies of the crowd.

use glam::{DQuat, DVec3};

use super::super::super::energy::mechanical;
use super::super::super::integrator::drift_body;
use super::super::super::{Loads, Model, State};
use super::super::impacts::kinetic;
use super::super::lasting_contact::LastingContact;
use super::super::laws::LawResidual;
use super::Crowd;
use super::impulses::{Impulses, Mixed};

impl Crowd {
    /// Advances the crowd by one substep of `part` seconds from time `t`. `closed` holds its possible contacts. Returns the energy that the
    /// impulses have added, which breaks a law; `None` without impulses.
    pub(super) fn advance(
        &mut self,
        closed: Vec<LastingContact>,
        model: &Model,
        (t, part): (f64, f64),
        now: &mut State,
        loads: &mut Loads,
    ) -> Option<LawResidual> {
        self.pushing.clear();
        if !model.constraints().is_empty() {
            let (mut pile, mut solver) = (std::mem::take(&mut self.pile), std::mem::take(&mut self.solver));
            let mut both = Mixed::of(&mut pile, &mut solver);
            let residual = self.advance_by(&mut both, closed, model, (t, part), (now, loads));
            (self.pile, self.solver) = (pile, solver);
            return residual;
        }
        let mut pile = std::mem::take(&mut self.pile);
        let residual = if closed.is_empty() {
            pile.take_contacts(closed, model, now);
            self.advance_freely(model, (t, part), (now, loads));
            None
        } else {
            self.advance_by(&mut pile, closed, model, (t, part), (now, loads))
        };
        self.pile = pile;
        residual
    }

    /// Advances bodies without contacts and joints by one substep.
    fn advance_freely(&self, model: &Model, (t, part): (f64, f64), (now, loads): (&mut State, &mut Loads)) {
        self.fly(model, 0.5 * part, now);
        if self.is_all {
            model.place(t + 0.5 * part, now);
        }
        model.sum(t + 0.5 * part, now, loads);
        if model.does_work() || self.is_all && model.has_guided() {
            let mut middle = now.clone();
            self.kick(model, 0.5 * part, &mut middle, loads);
            now.accounts.add(part, self.power(model, t + 0.5 * part, &middle));
        }
        self.kick(model, part, now, loads);
        self.fly(model, 0.5 * part, now);
    }

    /// Advances the crowd by one substep, with the impulses that `impulses` finds.
    fn advance_by(
        &mut self,
        impulses: &mut impl Impulses,
        closed: Vec<LastingContact>,
        model: &Model,
        (t, part): (f64, f64),
        (now, loads): (&mut State, &mut Loads),
    ) -> Option<LawResidual> {
        let half = 0.5 * part;
        let (energy, accounts) = (self.kinetic(model, now), now.accounts);
        impulses.begin(closed, model, (t, part), now);
        model.sum(t, now, loads);
        let struck = impulses.strike(model, (t, part), now, loads);
        self.impacts.extend(struck.impacts);
        let mut gain = self.kinetic(model, now) - energy + struck.fallen;
        self.fly(model, half, now);
        let first: Vec<_> = self.bodies.iter().map(|&i| (now.velocity[i], now.angular_momentum[i])).collect();
        model.place(t + half, now);
        // The joints have opened a little on the way. Their ends are brought together while the impulses are found: reactions that act at
        // two places instead of one would change the angular momentum.
        let flown: Vec<_> = self.bodies.iter().map(|&i| (now.location[i], now.orientation[i])).collect();
        impulses.join(model, t + half, now);
        model.sum(t + half, now, loads);
        let until_middle = now.accounts;
        impulses.measure(model, t + half, now);
        self.kick(model, half, now, loads);
        let kicked = self.kinetic(model, now);
        impulses.push(model, half, now);
        // The second half of the substep repeats the impulses, at the same velocities.
        let booked = now.accounts;
        now.accounts.add(1.0, booked);
        now.accounts.add(-1.0, until_middle);
        gain += self.given(model, half, (&first, now), loads);
        let power = self.power(model, t + half, now);
        let [work, motors] = [now.accounts.work - accounts.work, now.accounts.motors - accounts.motors];
        now.accounts.add(part, power);
        let mut residual = None;
        if let Some((bodies, sum)) = impulses.hardest_contact() {
            residual = Some(self.laws.weigh(gain - work - motors, energy.max(kicked), bodies, t));
            // An open joint between the bodies turns the impulses by their moments about its width.
            self.laws.note_moment(impulses.widest_joint() * sum, impulses.least_size() * sum, bodies, t);
        }
        for (&i, (location, orientation)) in self.bodies.iter().zip(flown) {
            (now.location[i], now.orientation[i]) = (location, orientation);
        }
        for (&i, (velocity, angular_momentum)) in self.bodies.iter().zip(first) {
            now.velocity[i] = 2.0 * now.velocity[i] - velocity;
            now.angular_momentum[i] = 2.0 * now.angular_momentum[i] - angular_momentum;
        }
        self.pushing.extend(impulses.pushing_pairs());
        self.pushing.sort_unstable();
        self.fly(model, half, now);
        model.place(t + part, now);
        shift(struck.early, model, t + part, now);
        separate(impulses, model, t + part, now);
        residual
    }

    /// Computes the kinetic energy of the crowd, J.
    fn kinetic(&self, model: &Model, now: &State) -> f64 {
        self.bodies.iter().map(|&body| kinetic(body, model, now)).sum()
    }

    /// Computes the work of all impulses but those of the loads in a substep, J. `first` holds the momenta at the start of the substep, as
    /// velocities and angular momenta, and `now` those in the middle, `half` seconds later.
    fn given(
        &self,
        model: &Model,
        half: f64,
        (first, now): (&[(DVec3, DVec3)], &State),
        loads: &Loads,
    ) -> f64 {
        let work = |(&i, (velocity, angular_momentum)): (&usize, &(DVec3, DVec3))| {
            let inverse_mass = model.inverse_mass()[i];
            let impulse = (now.velocity[i] - *velocity) / inverse_mass - half * loads.force[i];
            let turn = now.angular_momentum[i] - *angular_momentum - half * loads.torque[i];
            2.0 * (impulse.dot(now.velocity[i]) + turn.dot(model.angular_velocity(i, now)))
        };
        self.bodies.iter().zip(first).map(work).sum()
    }

    /// Moves the crowd freely for `time` seconds.
    fn fly(&self, model: &Model, time: f64, now: &mut State) {
        self.bodies.iter().for_each(|&i| drift_body(model, time, now, i));
    }

    /// Changes the momenta of the crowd by the loads, acting for `time` seconds.
    fn kick(&self, model: &Model, time: f64, now: &mut State, loads: &Loads) {
        for &i in &self.bodies {
            now.velocity[i] += time * model.inverse_mass()[i] * loads.force[i];
            now.angular_momentum[i] += time * loads.torque[i];
        }
    }
}

/// Undoes the displacements (m) and the rotations (rotation vectors, rad) of bodies that impulses caused before the bodies touched. The change
/// of energy is booked as work of impacts.
fn shift(ways: Vec<(usize, [DVec3; 2])>, model: &Model, t: f64, state: &mut State) {
    if !ways.is_empty() {
        let before = mechanical(model, t, state);
        for (body, [way, turn]) in ways {
            state.location[body] -= way;
            if turn != DVec3::ZERO {
                let back = DQuat::from_scaled_axis(-turn);
                state.orientation[body] = (back * state.orientation[body]).normalize();
            }
        }
        state.accounts.impacts += mechanical(model, t, state) - before;
    }
}

/// Moves overlapping bodies apart. The change of energy is booked as work of impacts.
pub(super) fn separate(impulses: &mut impl Impulses, model: &Model, t: f64, state: &mut State) {
    if impulses.are_within(model, t, state) {
        let before = mechanical(model, t, state);
        impulses.move_apart(model, state);
        state.accounts.impacts += mechanical(model, t, state) - before;
    }
}

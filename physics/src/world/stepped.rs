//! Steps by Moreau's scheme alone: no event is located, and all contacts of a part of a step are solved together.

use super::World;
use super::snapshot::picture;
use crate::contact::Collider;
use crate::{ContactSnapshot, Contacts, Model, Snapshot, State, System};

impl World {
    /// Makes a step of `dt` seconds by Moreau's scheme. Calls `see` with a snapshot at each of `moments`.
    pub(super) fn step_by_moreau(&mut self, t: f64, dt: f64, moments: &[f64], see: &mut dyn FnMut(Snapshot)) {
        self.begin_crowd();
        self.wake_hit(dt);
        self.before.clone_from(&self.state);
        self.note_accelerations(t);
        let Self { model, state, before, solver, collider: Some(collider), loads, .. } = self else { return };
        if let Some(breakdown) = collider.advance_all(model, (t, dt), state, loads) {
            solver.fail(breakdown);
        }
        model.place(t + dt, state);
        collider.note_rebounds(t + dt);
        collider.follow_step(model, (before, state), dt);
        self.steps += 1;
        for &moment in moments {
            see(self.picture_within(moment));
        }
        let Self { model, state, solver, collider: Some(collider), .. } = self else { return };
        if model.constraints().is_empty() {
            collider.end_pile(model, t + dt, state);
        } else if let Err(breakdown) = collider.end_course(model, t + dt, state) {
            solver.fail(breakdown);
        }
    }

    /// Makes all bodies that can move the crowd, except those held at rest.
    fn begin_crowd(&mut self) {
        let collider = self.collider.get_or_insert_with(|| Collider::new(Contacts::default()));
        collider.crowd_all(&self.model);
    }

    /// Releases the bodies held at rest that a moving body touches, or may hit within `dt` seconds.
    fn wake_hit(&mut self, dt: f64) {
        if self.rest.held().next().is_none() {
            return;
        }
        while let Some(collider) = &self.collider {
            let moves = |body: usize| !self.rest.is_calm(body);
            let hit = collider.may_be_hit(&self.model, &self.state, dt, moves);
            if !self.let_go(&hit) {
                return;
            }
            self.begin_crowd();
        }
    }

    /// Records the largest acceleration that the loads give to a body. Speeds far below its product with the step count as rest.
    fn note_accelerations(&mut self, t: f64) {
        let Self { model, state, loads, solver, .. } = self;
        model.sum(t, state, loads);
        let of = |(force, inverse_mass): (&glam::DVec3, &f64)| inverse_mass * force.length();
        let largest = loads.force.iter().zip(model.inverse_mass()).map(of).fold(0.0, f64::max);
        solver.note_acceleration(largest);
    }

    /// Returns a snapshot of a moment within the last step.
    fn picture_within(&mut self, time: f64) -> Snapshot {
        let mut within = self.before.clone();
        if let Some(mut collider) = self.collider.clone() {
            collider.crowd_at(time, &self.model, &mut within, &mut self.loads);
        }
        self.model.place(time, &mut within);
        let balance = self.ledger.peek(&self.model, time, &within);
        let mut copy = self.seen_by_moreau(time, &within);
        let World { model, solver, rest, crowd, collider, loads, .. } = &mut copy;
        let laws = super::laws_of(collider.as_ref());
        picture(&mut System::new(model, solver), time, &within, (balance, rest, crowd, laws), loads)
    }

    /// Returns a copy of the world for a snapshot of `state`. It holds the contacts of the crowd with their last forces.
    pub(super) fn seen_by_moreau(&self, time: f64, state: &State) -> World {
        let mut copy = self.clone();
        if let Some(collider) = &copy.collider {
            copy.crowd = collider.crowd_contacts(&copy.model, time, state);
            if !copy.model.constraints().is_empty() {
                copy.solver.give_joint_forces(&copy.model, collider.joint_forces());
                load_with(&copy.crowd, &mut copy.model, state);
            }
        }
        copy
    }
}

/// Adds the contact forces to the constant loads of the bodies, so that joints bear them.
fn load_with(contacts: &[ContactSnapshot], model: &mut Model, state: &State) {
    for contact in contacts {
        let force = contact.force + contact.friction;
        for (body, force) in contact.bodies.into_iter().zip([-force, force]) {
            if model.inverse_mass()[body] != 0.0 {
                let torque = (contact.place - state.location[body]).cross(force);
                model.set_constant_force(body, model.constant_force(body) + force);
                model.set_constant_torque(body, model.constant_torque(body) + torque);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};

    use super::super::super::constraint::{Pile, Purpose, Solver};
    use super::super::super::{
        Anchor, BodyId, Dynamics, Loads, RigidBody, Rod, Shape, Surface, UniformGravity,
    };
    use super::super::ContactPolicy;
    use super::*;

    const DT: f64 = 1.0 / 240.0;

    /// Returns a heap of boxes and balls after some steps, in which some still slide, roll and fall. `gravity` points down, m/s².
    fn heap(gravity: f64, rolling_friction: Option<f64>) -> World {
        let mut world = World::new();
        world.set_contact_policy(ContactPolicy::TimeStepping);
        let mut shapes = vec![Shape::Plane { normal: DVec3::Y }];
        world.add(RigidBody { fixed: true, ..RigidBody::new(&shapes[0], 1.0) });
        for i in 0..8 {
            let x = f64::from(i);
            let shape = if i % 2 == 0 {
                Shape::Box { size: DVec3::new(1.0, 0.5, 0.8) }
            } else {
                Shape::Sphere { radius: 0.4 }
            };
            let place = DVec3::new(0.2 * libm::sin(2.3 * x), 0.4 + 0.9 * x, 0.2 * libm::cos(1.7 * x));
            let turn = DQuat::from_rotation_y(x) * DQuat::from_rotation_x(0.1 * x);
            let body = RigidBody::new(&shape, 1.0 + 0.3 * x).with_location(place).with_orientation(turn);
            world.add(body.with_velocity(DVec3::new(0.3, -0.1 * x, 0.1)));
            shapes.push(shape);
        }
        world.add_force(UniformGravity { acceleration: -gravity * DVec3::Y });
        let surface = Surface { restitution: Some(0.1), friction: Some(0.4), rolling_friction };
        world.collide(Contacts { surfaces: vec![Some(surface); shapes.len()], ..Contacts::default() });
        world.add_shapes(shapes);
        world.set_step(DT);
        let _ = world.snapshot();
        world
    }

    /// The pile finds the same velocities as the general solver, which finds the impulses from another order of the rows.
    #[test]
    fn a_pile_obeys_the_laws_of_the_general_solver() {
        for rolling in [None, Some(0.02)] {
            let mut world = heap(9.81, rolling);
            let mut contacts = 0;
            for step in 0..120 {
                world.advance_to(f64::from(step + 1) * DT);
                let World { model, state, collider: Some(collider), .. } = &world else {
                    panic!("no contacts")
                };
                let places = collider.last_places(model, state);
                contacts += places.len();
                let mut loads = Loads::default();
                model.sum(world.time, state, &mut loads);
                let mut free = state.clone();
                for (i, velocity) in free.velocity.iter_mut().enumerate() {
                    *velocity += DT * model.inverse_mass()[i] * loads.force[i];
                }
                let (mut by_pile, mut by_solver) = (free.clone(), free.clone());

                let mut pile = Pile::default();
                pile.take_contacts(places.iter().map(|place| (**place).clone()).collect(), model, state);
                pile.aim(DT, 1e-5);
                pile.push_all(model, DT, &mut by_pile);

                let mut solver = Solver::default();
                solver.find_by_sweeps();
                solver.take_contacts(places);
                solver.forget();
                solver.prepare_sweeps(model, world.time, &mut by_solver);
                let goals: Vec<f64> = solver.gaps(1e-5).iter().map(|gap| -gap / DT).collect();
                solver.push_all(model, &goals, Purpose::Forces(DT), &mut by_solver);

                for body in 0..model.len() {
                    let off = by_pile.velocity[body].distance(by_solver.velocity[body]);
                    let fastest = free.velocity.iter().map(|velocity| velocity.length()).fold(0.0, f64::max);
                    assert!(
                        off < 1e-3 * fastest,
                        "step {step}: body {body} is off by {off} of {fastest} m/s"
                    );
                }
            }
            assert!(contacts > 300, "{contacts}");
        }
    }

    /// A solver that knows the layout of the joints and contacts finds the same velocities as one that lays them out anew.
    #[test]
    fn a_known_layout_changes_no_impulse() {
        let mut world = heap(9.81, None);
        let hook = DVec3::new(0.0, 12.0, 0.0);
        let between = [Anchor::Point(hook), Anchor::Body { id: BodyId::new(8), at: DVec3::ZERO }];
        let length = world.state.location[8].distance(hook);
        world.add_constraint(Rod { between, length });
        let (mut known, mut reused) = (Solver::default(), 0);
        for step in 0..60 {
            world.advance_to(f64::from(step + 1) * DT);
            let World { model, state, collider: Some(collider), .. } = &world else { panic!("no contacts") };
            let places = collider.last_places(model, state);
            let mut pushed = |solver: &mut Solver| {
                let mut state = state.clone();
                let before = solver.bodies();
                solver.take_contacts_for_sweeps(places.clone(), model);
                reused += usize::from(!before.is_empty() && solver.bodies() == before);
                solver.start_cold();
                solver.prepare_sweeps(model, world.time, &mut state);
                let goals: Vec<f64> = solver.gaps(1e-5).iter().map(|gap| -gap / DT).collect();
                solver.push_all(model, &goals, Purpose::Forces(DT), &mut state);
                state
            };
            let (one, other) = (pushed(&mut known), pushed(&mut Solver::default()));
            assert_eq!(one.velocity, other.velocity, "step {step}");
            assert_eq!(one.angular_momentum, other.angular_momentum, "step {step}");
        }
        assert!(reused > 10, "{reused}");
    }

    /// Impulses between bodies change neither their momentum nor their angular momentum, push only, and stay in the cones of friction.
    #[test]
    fn impulses_of_a_pile_keep_momenta_and_cones() {
        let mut world = heap(9.81, None);
        let mut pushing = 0;
        for step in 0..100 {
            world.advance_to(f64::from(step + 1) * DT);
            let World { model, state, collider: Some(collider), .. } = &world else { panic!("no contacts") };
            // Without the ground, nothing holds the heap, so its momenta stay.
            let mut places = collider.last_places(model, state);
            places.retain(|place| place.bodies[0] != 0);
            let places: Vec<_> = places.iter().map(|place| (**place).clone()).collect();
            let momenta = |state: &State| {
                let of = |body: usize| {
                    let momentum = model.mass()[body] * state.velocity[body];
                    [momentum, state.angular_momentum[body] + state.location[body].cross(momentum)]
                };
                (1..model.len()).map(of).fold([DVec3::ZERO; 2], |[a, b], [x, y]| [a + x, b + y])
            };
            let mut pushed = state.clone();
            for (i, velocity) in pushed.velocity.iter_mut().enumerate().skip(1) {
                *velocity += DVec3::Y * libm::sin(1.3 * i as f64);
            }
            let before = momenta(&pushed);
            let mut pile = Pile::default();
            pile.take_contacts(places.clone(), model, state);
            pile.aim(DT, 1e-5);
            pile.push_all(model, DT, &mut pushed);
            let forces = pile.last_forces(&places, model, state);
            // Friction acts at both ends of a gap, which is at most 1e-5 of a body's size here.
            let moments = 1e-5 * DT * forces.iter().map(|contact| contact.friction.length()).sum::<f64>();
            for ((before, after), slack) in before.into_iter().zip(momenta(&pushed)).zip([0.0, moments]) {
                let off = (after - before).length();
                assert!(off < 1e-12 * before.length().max(1.0) + slack, "{before} {after} {slack}");
            }
            for contact in forces {
                let push = contact.force.dot(contact.normal);
                assert!(push >= 0.0 && contact.friction.length() <= 0.4 * push * (1.0 + 1e-9), "{contact:?}");
                pushing += usize::from(push > 0.0);
            }
        }
        assert!(pushing > 30, "{pushing}");
    }
}

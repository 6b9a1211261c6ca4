//! The crowd: the bodies that Moreau's scheme advances, because their events would not end within a step, or because no consistent contact
//! forces were found for them.

use super::World;
use super::event::Event;
use crate::energy::mechanical;

impl World {
    /// Returns true if two bodies touch in this event and at least one of them is in the crowd.
    pub(super) fn is_in_crowd(&self, event: Event) -> bool {
        let Event::Touch(bodies) = event else { return false };
        self.collider.as_ref().is_some_and(|collider| collider.is_in_crowd(bodies))
    }

    /// Advances these bodies, and all bodies that touch them, by Moreau's scheme until the end of the step.
    pub(super) fn crowd(&mut self, t: f64, bodies: &[usize]) {
        while self.let_touched_go() {}
        let Some(collider) = &mut self.collider else { return };
        if collider.join(&self.model, &self.state, bodies) {
            self.meet(t, false);
        }
    }

    /// Returns the heap of bodies in which a constraint row changes its mode. Events in a heap are not followed one by one. Empty if the
    /// event concerns no heap.
    pub(super) fn heap_of(&mut self, event: Event, bodies: &[usize]) -> Vec<usize> {
        match (event, &mut self.collider) {
            (Event::Row(_), Some(collider)) => collider.heap_of(bodies, self.solver.contacts(), &self.model),
            _ => Vec::new(),
        }
    }

    /// Hands a heap to Moreau's scheme, from time `t`, s, if the friction of one of its contacts has reached its limit. Does nothing where
    /// only a few bodies touch: `cone.rs` finds their forces.
    pub(super) fn crowd_strained(&mut self, t: f64) {
        let bodies = self.solver.take_strained();
        let Some(collider) = self.collider.as_mut().filter(|_| !bodies.is_empty()) else { return };
        let heap = collider.heap_of(&bodies, self.solver.contacts(), &self.model);
        if !heap.is_empty() {
            self.crowd(t, &heap);
        }
    }

    /// Returns the bodies that take part in an event, by index.
    pub(super) fn bodies_of(&self, event: Event) -> Vec<usize> {
        match event {
            Event::Touch(bodies) => bodies.to_vec(),
            Event::Row(row) => self.solver.bodies_of(row),
        }
    }

    /// Returns the two bodies of the contact that an event changes, for example from sticking to sliding. `None` for other events.
    pub(super) fn pair_of(&self, event: Event) -> Option<[usize; 2]> {
        let Event::Row(row) = event else { return None };
        self.solver.contact_of(&self.model, row)
    }

    /// Returns true if two bodies hit each other so often that their events are no longer followed one by one.
    pub(super) fn happens_too_often(&self, event: Event) -> bool {
        let Event::Touch(bodies) = event else { return false };
        self.collider.as_ref().is_some_and(|collider| collider.hits_too_often(bodies))
    }

    /// Returns true if no contact forces were found for the last piece of the step, which ends at time `t`, s.
    pub(super) fn is_unsolved(&self, t: f64) -> bool {
        let is_finite = || self.state.location.iter().all(|location| location.is_finite());
        !self.solver.contacts().is_empty()
            && (self.solver.is_unsolved() || self.solver.has_failed() || !is_finite() || t.is_nan())
    }

    /// Returns to the start of the last piece, at time `t`, s, and lets Moreau's scheme advance the bodies in contact from there. Returns
    /// false, and changes nothing, if all of them already are in the crowd.
    pub(super) fn go_back(&mut self, t: f64) -> bool {
        let mut bodies: Vec<usize> =
            self.solver.contacts().iter().flat_map(|contact| contact.bodies).collect();
        bodies.dedup();
        let Some(collider) = &mut self.collider else { return false };
        let is_new = collider.join(&self.model, &self.before, &bodies);
        if is_new {
            self.state.take_over(&self.before, self.model.in_focus());
            self.solver.take_failure();
            self.integrator.discontinuity();
            self.meet(t, false);
        }
        is_new
    }

    /// Takes all bodies out of the crowd at the end of a step, unless they stay in the crowd for further steps.
    pub(super) fn disperse(&mut self, t: f64) {
        let Some(collider) = self.collider.as_mut().filter(|collider| collider.is_crowded()) else { return };
        let places = match collider.end_course(&self.model, t, &mut self.state) {
            Ok(places) => places,
            Err(breakdown) => {
                self.solver.fail(breakdown);
                return;
            }
        };
        let stays = collider.crowd_stays(&places);
        let mut contacts = self.solver.contacts().to_vec();
        contacts.extend(places);
        contacts.sort_by_key(|contact| contact.bodies);
        self.integrator.discontinuity();
        let is_due = self.rest.are_due(collider.crowded());
        if stays && !is_due {
            return;
        }
        collider.dissolve();
        self.solver.take_contacts(contacts);
        let before = mechanical(&self.model, t, &self.state);
        self.solver.close_all(&self.model, t, &mut self.state);
        self.state.accounts.impacts += mechanical(&self.model, t, &self.state) - before;
        if is_due {
            // The bodies' contacts belong to the event-driven solver again, and their modes are decided later.
            self.is_decided = false;
        } else {
            self.meet_at_rest(t);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use glam::DVec3;

    use super::super::super::{Contacts, Dynamics, RigidBody, Shape, Surface, UniformGravity};
    use super::*;

    /// A ball in the crowd approaches a wall at 1 m/s and hits it within a part of the step. It rebounds at that moment, with the speed that
    /// Newton's law of restitution gives, and the impact is recorded. Without forces, the result equals the closed form to within rounding
    /// errors.
    #[test]
    fn what_is_advanced_by_time_stepping_rebounds() {
        for (restitution, gap) in [(1.0, 0.002), (0.8, 0.002), (0.8, 0.003), (0.0, 0.001)] {
            let mut world = World::new();
            let ball = Shape::Sphere { radius: 0.1 };
            let wall = Shape::Box { size: DVec3::ONE };
            world.add(
                RigidBody::new(&ball, 2.0).with_location(DVec3::Y * (0.6 + gap)).with_velocity(-DVec3::Y),
            );
            world.add(RigidBody { fixed: true, ..RigidBody::new(&wall, 1.0) });
            world.add_shapes([ball, wall]);
            let surface =
                Surface { restitution: Some(restitution), friction: Some(0.5), rolling_friction: None };
            world.collide(Contacts { surfaces: vec![Some(surface); 2], ..Contacts::default() });
            let _ = world.snapshot();
            let dt = 1.0 / 240.0;
            world.end = dt;
            world.crowd(0.0, &[0]);
            world.before.clone_from(&world.state);
            world.make_step(0.0, dt);
            world.collider.as_mut().unwrap().note_rebounds(dt);
            let impacts = world.impacts();
            if restitution == 0.0 {
                assert!(impacts.is_empty());
                assert!((world.state.location[0].y - 0.6).abs() < 1e-12, "{}", world.state.location[0].y);
                continue;
            }
            let height = 0.6 + restitution * (dt - gap);
            assert!(
                (world.state.location[0].y - height).abs() < 1e-12,
                "{} {height}",
                world.state.location[0].y
            );
            assert!((world.state.velocity[0].y - restitution).abs() < 1e-12, "{}", world.state.velocity[0]);
            let lost = 1.0 - restitution * restitution;
            assert!((impacts[0].place - DVec3::Y * 0.5).length() < 1e-12, "{}", impacts[0].place);
            assert!((impacts[0].time - gap).abs() < 1e-12 && (impacts[0].energy - lost).abs() < 1e-12);
            assert!(
                (impacts[0].impulse.length() - 2.0 * (1.0 + restitution)).abs() < 1e-12 && impacts.len() == 1
            );
        }
    }

    /// Returns the largest speed of a stack of cubes, in units of g dt, one step after Moreau's scheme took them over at rest. `masses` are those of the
    /// cubes, from the ground up.
    fn speed_in_a_stack(masses: &[f64]) -> f64 {
        let mut world = World::new();
        let (cube, ground) =
            (Shape::Box { size: DVec3::ONE }, Shape::Box { size: DVec3::new(9.0, 1.0, 9.0) });
        world.add(RigidBody { fixed: true, ..RigidBody::new(&ground, 1.0) });
        let mut shapes = vec![ground];
        for (level, mass) in masses.iter().enumerate() {
            world.add(RigidBody::new(&cube, *mass).with_location(DVec3::Y * (level + 1) as f64));
            shapes.push(cube.clone());
        }
        world.add_force(UniformGravity { acceleration: -DVec3::Y });
        let surface = Surface { restitution: Some(0.0), friction: Some(0.5), rolling_friction: None };
        world.collide(Contacts { surfaces: vec![Some(surface); shapes.len()], ..Contacts::default() });
        world.add_shapes(shapes);
        let _ = world.snapshot();
        let dt = 1.0 / 240.0;
        world.end = dt;
        world.crowd(0.0, &(1..=masses.len()).collect::<Vec<_>>());
        world.before.clone_from(&world.state);
        world.make_step(0.0, dt);
        world.state.velocity.iter().map(|velocity| velocity.length()).fold(0.0, f64::max) / dt
    }

    /// A tower of thirty cubes stays at rest, and so does a cube on others of a hundredth of its mass. Gauss–Seidel sweeps alone leave
    /// a speed of 0.009 g dt in the tower.
    #[test]
    fn stacks_stay_at_rest() {
        let tower = speed_in_a_stack(&[1.0; 30]);
        assert!(tower < 1e-4, "{tower}");
        let heavy = speed_in_a_stack(&[1.0, 1.0, 1.0, 100.0]);
        assert!(heavy < 1e-4, "{heavy}");
    }

    /// Eight balls touch each other. A ninth ball is very near, but belongs to another group; no ball moves. Advancing the first group
    /// must not change the ninth ball: its motion would be lost, but its energy would be booked.
    #[test]
    fn what_is_advanced_by_time_stepping_leaves_other_groups_alone() {
        let mut world = World::new();
        let ball = Shape::Sphere { radius: 0.1 };
        for i in 0..9 {
            let gap = if i == 8 { 0.002 } else { 0.0 };
            world.add(RigidBody::new(&ball, 2.0).with_location(DVec3::X * (0.2 * f64::from(i) + gap)));
        }
        world.add_shapes(vec![ball; 9]);
        let surface = Surface { restitution: Some(0.5), friction: Some(0.5), rolling_friction: None };
        world.collide(Contacts { surfaces: vec![Some(surface); 9], ..Contacts::default() });
        let _ = world.snapshot();
        let World { model, state, collider: Some(collider), .. } = &mut world else { panic!("no contacts") };
        let dt = 1.0 / 240.0;
        assert!(collider.join(model, state, &[0]));
        let none = std::iter::empty();
        let mut parting = collider.part(model, (state, state), dt, &[], none, &[]);
        collider.focus(&mut parting.groups[0]);
        collider.stay(model, state, dt);
        assert_eq!(collider.crowded(), &BTreeSet::from_iter(0..8));
    }
}

//! Forces that are given by formulas.

use std::fmt::Debug;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;

use super::super::{BodyId, WorkAccount};
use super::{Force, Loads, Moment, share};

/// The largest number of bodies for which a [`ForceLaw`] computes forces in one call.
pub const FORCE_BLOCK: usize = 64;

/// The law of a force that depends only on a body's position, velocity, mass and charge, and on the time.
pub trait ForceLaw: Debug + Send + Sync {
    /// Writes the force on each of at most [`FORCE_BLOCK`] bodies to `out`, N. With `at_rest`, all velocities are taken as zero.
    fn force(&self, bodies: &[BodyId], moment: &Moment, at_rest: bool, out: &mut [DVec3]);

    /// Writes the potential energy of each of at most [`FORCE_BLOCK`] bodies to `out`, J; 0 for a law without a potential.
    fn potential(&self, bodies: &[BodyId], moment: &Moment, out: &mut [f64]);

    /// Whether the force on a body at rest is −∂U/∂x for a potential U.
    fn has_potential(&self) -> bool;

    /// Whether the force depends on velocities.
    fn depends_on_velocity(&self) -> bool;
}

/// A force F(x, v, t) on each of some bodies, given by a [`ForceLaw`].
///
/// A law with a potential U satisfies F(x, 0, t) = −∂U/∂x. The part F(x, v, t) − F(x, 0, t) that depends on the velocity has no potential,
/// so its work is added to the energy accounts. For a law without a potential, the work of the whole force is added.
#[derive(Debug)]
pub struct FormulaForce {
    bodies: Vec<BodyId>,
    law: Arc<dyn ForceLaw>,
    failure: Failure,
}

/// A body and its state at which the value of a force law is not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Undefined {
    /// The body for which the force is not finite.
    pub body: BodyId,
    /// The time at which the force is not finite, s.
    pub time: f64,
    /// The position of the body, m.
    pub location: DVec3,
    /// The velocity of the body, m/s.
    pub velocity: DVec3,
}

/// Remembers the body whose force is not finite. The memory is cleared when a later evaluation, such as that of a shorter step, gives a
/// finite force on this body.
#[derive(Debug, Default)]
struct Failure {
    is_there: AtomicBool,
    last: Mutex<Option<Undefined>>,
}

impl FormulaForce {
    /// Makes a force that acts on `bodies` by `law`.
    #[must_use]
    pub fn new(bodies: Vec<BodyId>, law: Arc<dyn ForceLaw>) -> FormulaForce {
        FormulaForce { bodies, law, failure: Failure::default() }
    }

    /// Calls `see` with the forces (N) on all present bodies, in blocks. The second list holds the forces on the same bodies at rest, if
    /// the law has a potential and depends on velocities.
    fn each_block(&self, moment: &Moment, mut see: impl FnMut(&[BodyId], &[DVec3], Option<&[DVec3]>)) {
        let (mut force, mut rest) = ([DVec3::ZERO; FORCE_BLOCK], [DVec3::ZERO; FORCE_BLOCK]);
        let has_rest = self.law.has_potential() && self.law.depends_on_velocity();
        for bodies in moment.model.present(&self.bodies).chunks(FORCE_BLOCK) {
            let (force, rest) = (&mut force[..bodies.len()], &mut rest[..bodies.len()]);
            self.law.force(bodies, moment, false, force);
            if has_rest {
                self.law.force(bodies, moment, true, rest);
            }
            see(bodies, force, has_rest.then_some(rest));
            self.failure.look(bodies, force, moment);
        }
    }
}

impl Force for FormulaForce {
    fn apply(&self, moment: &Moment, loads: &mut Loads) {
        let books = self.depends_on_motion();
        let mut power = 0.0;
        self.each_block(moment, |bodies, force, rest| {
            match (in_a_row(bodies), rest) {
                // In the most common case, the bodies have consecutive indices, so slices replace the look-up of each body.
                (Some(row), None) => {
                    let all = loads.force[row.clone()].iter_mut().zip(force);
                    all.for_each(|(sum, force)| *sum += *force);
                    if books {
                        let all = force.iter().zip(&moment.state.velocity[row]);
                        all.for_each(|(force, velocity)| power += force.dot(*velocity));
                    }
                }
                _ => {
                    for (lane, (body, force)) in bodies.iter().zip(force).enumerate() {
                        let i = body.index();
                        loads.force[i] += *force;
                        if books {
                            let free = rest.map_or(*force, |rest| *force - rest[lane]);
                            power += free.dot(moment.state.velocity[i]);
                        }
                    }
                }
            }
        });
        loads.power.work += power;
    }

    fn potential(&self, moment: &Moment) -> f64 {
        if !self.law.has_potential() {
            return 0.0;
        }
        let (mut out, mut sum) = ([0.0; FORCE_BLOCK], 0.0);
        for bodies in moment.model.present(&self.bodies).chunks(FORCE_BLOCK) {
            let out = &mut out[..bodies.len()];
            self.law.potential(bodies, moment, out);
            let each = bodies.iter().zip(out).filter(|(body, _)| moment.model.movable()[body.index()]);
            sum += each.map(|(_, potential)| *potential).sum::<f64>();
        }
        sum
    }

    fn share_potential(&self, moment: &Moment, shares: &mut [f64]) {
        if !self.law.has_potential() {
            return;
        }
        let mut out = [0.0; FORCE_BLOCK];
        for bodies in moment.model.present(&self.bodies).chunks(FORCE_BLOCK) {
            let out = &mut out[..bodies.len()];
            self.law.potential(bodies, moment, out);
            bodies.iter().zip(out).for_each(|(body, energy)| share(*energy, [body.index()], moment, shares));
        }
    }

    fn work_account(&self) -> Option<WorkAccount> {
        (!self.law.has_potential()).then_some(WorkAccount::Work)
    }

    fn is_local(&self) -> bool {
        self.law.has_potential() && !self.law.depends_on_velocity()
    }

    fn depends_on_motion(&self) -> bool {
        !self.is_local()
    }

    fn undefined(&self) -> Option<Undefined> {
        *self.failure.last.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns the range of the indices of `bodies` if these are consecutive, and `None` if not.
#[inline]
pub fn in_a_row(bodies: &[BodyId]) -> Option<Range<usize>> {
    let first = bodies.first()?.index();
    // This loop has no early exit, so that the compiler can vectorise it.
    let off = bodies.iter().zip(first..).fold(0, |off, (body, i)| off | body.index() ^ i);
    (off == 0).then(|| first..first + bodies.len())
}

impl Failure {
    /// Remembers the first body whose force is not finite although its position and velocity are finite. Forgets a remembered body whose
    /// force is finite again.
    fn look(&self, bodies: &[BodyId], force: &[DVec3], moment: &Moment) {
        // 0 · ∞ is NaN, and any sum with NaN is NaN, so the sums are zero exactly if all forces are finite. Four independent sums run in
        // parallel.
        let mut sums = [DVec3::ZERO; 4];
        let (fours, others) = force.as_chunks::<4>();
        for four in fours {
            sums.iter_mut().zip(four).for_each(|(sum, force)| *sum += 0.0 * *force);
        }
        others.iter().for_each(|force| sums[0] += 0.0 * *force);
        let is_finite = sums.iter().all(|sum| *sum == DVec3::ZERO);
        if is_finite && !self.is_there.load(Ordering::Relaxed) {
            return;
        }
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let is_mended = |last: &Undefined| {
            let place = bodies.iter().position(|body| *body == last.body);
            place.is_some_and(|lane| force[lane].is_finite())
        };
        if last.as_ref().is_some_and(is_mended) {
            *last = None;
        }
        let state = moment.state;
        let undefined = |(body, force): (&BodyId, &DVec3)| {
            let (location, velocity) = (state.location[body.index()], state.velocity[body.index()]);
            let is_new = !force.is_finite() && location.is_finite() && velocity.is_finite();
            is_new.then_some(Undefined { body: *body, time: moment.time, location, velocity })
        };
        if last.is_none() {
            *last = bodies.iter().zip(force).find_map(undefined);
        }
        self.is_there.store(last.is_some(), Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{assert_minus_gradient, bodies, loads};
    use super::*;

    /// The force F = (−4 x³ − c v_y, c v_x, −d v_z), with the potential U = x⁴ if `has_potential` is true.
    #[derive(Clone, Copy, Debug)]
    struct Quartic {
        turning: f64,
        damping: f64,
        has_potential: bool,
    }

    impl ForceLaw for Quartic {
        fn force(&self, bodies: &[BodyId], moment: &Moment, at_rest: bool, out: &mut [DVec3]) {
            for (body, out) in bodies.iter().zip(out) {
                let (x, v) = (moment.state.location[body.index()], moment.state.velocity[body.index()]);
                let v = if at_rest { DVec3::ZERO } else { v };
                let (c, d) = (self.turning, self.damping);
                *out = DVec3::new(-4.0 * x.x * x.x * x.x - c * v.y, c * v.x, -d * v.z);
            }
        }

        fn potential(&self, bodies: &[BodyId], moment: &Moment, out: &mut [f64]) {
            for (body, out) in bodies.iter().zip(out) {
                let square = moment.state.location[body.index()].x * moment.state.location[body.index()].x;
                *out = square * square;
            }
        }

        fn has_potential(&self) -> bool {
            self.has_potential
        }

        fn depends_on_velocity(&self) -> bool {
            self.turning != 0.0 || self.damping != 0.0
        }
    }

    fn force(law: Quartic, count: usize) -> FormulaForce {
        FormulaForce::new((0..count).map(BodyId::new).collect(), Arc::new(law))
    }

    #[test]
    fn what_velocity_adds_is_booked_beside_a_potential_and_all_without() {
        let (model, state) = bodies(&[(DVec3::new(0.5, 1.0, 2.0), DVec3::new(3.0, 4.0, 5.0))]);
        for (has_potential, work) in [(true, -0.5 * 25.0), (false, -0.5 * 25.0 - 0.5 * 3.0)] {
            let force = force(Quartic { turning: 2.0, damping: 0.5, has_potential }, 1);
            let loads = loads(&force, &model, &state);
            assert_eq!(loads.force, [DVec3::new(-0.5 - 8.0, 6.0, -2.5)]);
            assert_eq!(loads.power.work, work);
            assert!(force.depends_on_motion() && !force.is_local());
        }
    }

    /// The 150 bodies do not fit into one block.
    #[test]
    fn many_bodies_and_a_potential() {
        let located: Vec<_> = (0..150).map(|i| (DVec3::X * (f64::from(i) * 0.01 - 0.7), DVec3::Y)).collect();
        let (model, state) = bodies(&located);
        let force = force(Quartic { turning: 0.0, damping: 0.0, has_potential: true }, 150);
        assert_minus_gradient(&force, &model, &state);
        assert!(force.is_local() && !force.depends_on_motion());
        let expected: f64 = located.iter().map(|(place, _)| (place.x * place.x) * (place.x * place.x)).sum();
        let potential = force.potential(&Moment { time: 0.0, state: &state, model: &model });
        assert!((potential - expected).abs() < 1e-12 * expected, "{potential} {expected}");
    }

    #[test]
    fn the_first_place_without_a_force_is_noted_until_there_is_one() {
        let (model, mut state) = bodies(&[(DVec3::X, DVec3::ZERO), (DVec3::X, DVec3::ZERO)]);
        let force = force(Quartic { turning: 0.0, damping: 0.0, has_potential: true }, 2);
        loads(&force, &model, &state);
        assert_eq!(force.undefined(), None);
        state.location[1].x = 1e200;
        loads(&force, &model, &state);
        let found = force.undefined().unwrap();
        assert_eq!((found.body, found.location), (BodyId::new(1), 1e200 * DVec3::X));
        // A non-finite position must not replace the recorded cause, because the position is a result of the non-finite force.
        state.location[1].x = f64::NAN;
        loads(&force, &model, &state);
        assert_eq!(force.undefined(), Some(found));
        state.location[1].x = 2.0;
        loads(&force, &model, &state);
        assert_eq!(force.undefined(), None);
    }
}

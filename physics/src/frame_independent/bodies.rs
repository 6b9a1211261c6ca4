//! The bodies that an adaptive method advances, and their rates of change under the loads.

use glam::{DQuat, DVec3};

use super::super::integrator::{orientation_rate, turn_freely};
use super::super::model::is_isotropic;
use super::super::{Loads, Model, State};

/// The bodies that change with time, sorted by the kind of their motion.
#[derive(Clone, Default)]
pub(super) struct Bodies {
    /// The indices of the bodies that forces move.
    pub(super) moving: Vec<usize>,
    /// The indices of the bodies whose orientation and angular momentum must be integrated.
    pub(super) turning: Vec<usize>,
    /// The bodies that rotate uniformly without torque, each with its orientation at the start.
    spinning: Vec<(usize, DQuat)>,
    /// Whether forces without a potential or bodies with a given motion may do work. This work must then be integrated.
    pub(super) works: bool,
    /// Whether a force depends on velocities, or does work without a potential.
    pub(super) feels_motion: bool,
}

impl Bodies {
    /// Fills the lists with the bodies of a model. Absent bodies, fixed bodies and bodies with a given motion are in no list.
    pub(super) fn sort(&mut self, model: &Model, state: &State) {
        let can_turn = model.turns_bodies();
        self.moving.clear();
        self.turning.clear();
        self.spinning.clear();
        for i in (0..model.len()).filter(|&i| model.inverse_mass()[i] != 0.0) {
            self.moving.push(i);
            let inverse = model.inverse_inertia()[i];
            if inverse == DVec3::ZERO {
                continue;
            }
            let turns = state.angular_momentum[i] != DVec3::ZERO;
            if can_turn || turns && !is_isotropic(inverse) {
                self.turning.push(i);
            } else if turns {
                self.spinning.push((i, state.orientation[i]));
            }
        }
        self.feels_motion = model.depends_on_motion();
        self.works = self.feels_motion || model.has_guided();
    }

    /// Sets the orientations of uniformly rotating bodies to those `elapsed` seconds after the start.
    pub(super) fn spin(&self, model: &Model, elapsed: f64, state: &mut State) {
        for &(i, start) in &self.spinning {
            let momentum = state.angular_momentum[i];
            state.orientation[i] = turn_freely(start, momentum, model.inverse_inertia()[i], elapsed);
        }
    }
}

/// The data that a method needs to evaluate the loads: the bodies and forces, and working memory.
pub(super) struct Field<'a> {
    /// The masses of the bodies and the forces on them.
    pub(super) model: &'a Model,
    /// The bodies that the method advances.
    pub(super) bodies: &'a Bodies,
    /// The typical length and speed of the motion.
    pub(super) scales: &'a Scales,
    /// The state of the bodies at the current stage of the method.
    pub(super) stage: &'a mut State,
    /// The loads on the bodies at the current stage.
    pub(super) loads: &'a mut Loads,
}

impl Field<'_> {
    /// Evaluates the loads on the bodies at the current stage, at time `t`, s. Bodies with a given motion are placed first.
    pub(super) fn evaluate(&mut self, t: f64) {
        self.model.place(t, self.stage);
        self.model.evaluate(t, self.stage, self.loads);
    }

    /// Returns the acceleration of a body at the current stage, m/s².
    pub(super) fn acceleration(&self, i: usize) -> DVec3 {
        self.loads.force[i] * self.model.inverse_mass()[i]
    }

    /// Returns the time derivatives of a body's orientation (1/s) and of its angular momentum in its [`axes`] (N m) at the current stage.
    /// In principal axes, the latter is Euler's equation M' = Rᵀ (τ + L × ω).
    pub(super) fn turning(&self, i: usize) -> (DQuat, DVec3) {
        let Field { model, stage, loads, .. } = self;
        let (orientation, torque) = (stage.orientation[i], loads.torque[i]);
        let velocity = model.angular_velocity(i, stage);
        let rate = if can_flip(model.inverse_inertia()[i]) {
            orientation.conjugate() * (torque + stage.angular_momentum[i].cross(velocity))
        } else {
            torque
        };
        (orientation_rate(orientation, velocity), rate)
    }

    /// Returns the angular momentum of a body in its [`axes`] at the current stage, kg m²/s.
    pub(super) fn momentum(&self, i: usize) -> DVec3 {
        axes(self.model, i, self.stage.orientation[i]).conjugate() * self.stage.angular_momentum[i]
    }
}

/// Returns the rotation from the axes in which the angular momentum of a body is integrated to world axes.
///
/// If the moments of inertia differ, these are the principal axes: an error of the orientation then does not change the angular velocity in
/// the body, whose flips about the intermediate axis enlarge errors many times. A body with two equal moments does not flip, and its
/// angular momentum changes less often in world axes than in those of the body.
pub(super) fn axes(model: &Model, i: usize, orientation: DQuat) -> DQuat {
    if can_flip(model.inverse_inertia()[i]) { orientation } else { DQuat::IDENTITY }
}

/// Returns true if the three moments of inertia differ, so that rotations about the intermediate axis are unstable.
fn can_flip(inertia: DVec3) -> bool {
    let DVec3 { x, y, z } = inertia;
    x != y && y != z && z != x
}

/// What the rotation of a body without torque keeps, in quantities that stay exact close to the unstable axis: the angular momentum, and
/// D = Σ (1/Iᵢ − 1/I₂) Mᵢ², which is twice the energy minus |M|²/I₂. I₂ is the intermediate moment of inertia, so D depends only on the
/// small components Mᵢ of the angular momentum there.
#[derive(Clone, Copy, Debug)]
pub(super) struct FreeRotation {
    /// The angular momentum of the body, world axes, kg m²/s; not zero.
    momentum: DVec3,
    /// D, J.
    invariant: f64,
}

impl FreeRotation {
    /// Returns the rotations of the bodies in [`Bodies::turning`]. Empty if a force can have a torque.
    pub(super) fn all(field: &Field<'_>) -> impl Iterator<Item = FreeRotation> {
        let turning: &[usize] = if field.model.turns_bodies() { &[] } else { &field.bodies.turning };
        turning.iter().map(|&i| {
            let momentum = field.momentum(i);
            let invariant = momentum.dot(beyond_middle(field.model.inverse_inertia()[i]) * momentum);
            FreeRotation { momentum: field.stage.angular_momentum[i], invariant }
        })
    }

    /// Removes the errors of a step from the orientation and from the angular momentum in the body's [`axes`], as far as they change what
    /// the rotation keeps. A small error of D would otherwise grow to a large error of the time between two flips of the body.
    pub(super) fn restore(
        &self,
        inverse_inertia: DVec3,
        orientation: DQuat,
        momentum: DVec3,
    ) -> (DQuat, DVec3) {
        /// The smallest sin² of the angle between the gradients of |M|² and D at which D is restored. It is smaller only close to a stable
        /// axis, where errors do not grow.
        const MIN_SINE_SQUARED: f64 = 1e-3;
        if !can_flip(inverse_inertia) {
            // In world axes, the angular momentum stays as it is.
            return (orientation, momentum);
        }
        let factors = beyond_middle(inverse_inertia);
        let mut momentum = momentum;
        // Two steps of Newton's method along the gradients.
        for _ in 0..2 {
            let gradient = factors * momentum;
            let (mm, mg, gg) = (momentum.length_squared(), momentum.dot(gradient), gradient.length_squared());
            let size = 0.5 * (self.momentum.length_squared() - mm);
            let shape = 0.5 * (self.invariant - mg);
            let area = mm * gg - mg * mg;
            momentum += if area > MIN_SINE_SQUARED * mm * gg {
                ((size * gg - shape * mg) * momentum + (shape * mm - size * mg) * gradient) / area
            } else {
                (size / mm) * momentum
            };
        }
        let turned = (orientation * momentum).normalize_or_zero();
        let back = DQuat::from_rotation_arc(turned, self.momentum.normalize_or_zero());
        ((back * orientation).normalize(), momentum)
    }
}

/// Returns the inverse moments of inertia minus the one between the other two.
fn beyond_middle(inverse: DVec3) -> DVec3 {
    let DVec3 { x, y, z } = inverse;
    inverse - DVec3::splat(x.min(y).max(x.max(y).min(z)))
}

/// The error of a position or speed is relative to its value, but at least to this fraction of the typical value.
const MIN_SCALE_FRACTION: f64 = 0.1;

/// Lower limits of the values to which the errors of positions and speeds are relative. The error of a value below its limit is divided by
/// the limit instead of the value. The limits follow from the size of the whole motion.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Scales {
    /// A tenth of the root-mean-square distance of the bodies from their mean position, or of the largest radius of gyration of a body if
    /// that is longer, m.
    pub(super) length: f64,
    /// A tenth of the largest speed, or of √(a L) if that is larger, m/s. Here, a is the largest acceleration and L is ten times the
    /// length above.
    pub(super) speed: f64,
}

impl Scales {
    /// Computes the scales from the present bodies and the loads on them.
    pub(super) fn of(bodies: &Bodies, model: &Model, state: &State, loads: &Loads) -> Scales {
        let there = || (0..model.len()).filter(|&i| model.is_present(i));
        #[allow(clippy::cast_precision_loss, reason = "no scene has 2^53 bodies")]
        let count = (there().count() as f64).max(1.0);
        let mean = there().map(|i| state.location[i]).sum::<DVec3>() / count;
        let spread = there().map(|i| state.location[i].distance_squared(mean)).sum::<f64>() / count;
        let own = bodies.moving.iter().map(|&i| model.inertia()[i].max_element() * model.inverse_mass()[i]);
        let length = spread.sqrt().max(own.fold(0.0, f64::max).sqrt());
        let mut square: f64 = 0.0;
        for &i in &bodies.moving {
            let falling = loads.force[i].length() * model.inverse_mass()[i] * length;
            square = square.max(state.velocity[i].length_squared()).max(falling);
        }
        Scales { length: MIN_SCALE_FRACTION * length, speed: MIN_SCALE_FRACTION * square.sqrt() }
    }
}

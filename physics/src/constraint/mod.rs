//! Constraints between bodies: their common trait, one file for each kind, and one solver for all kinds.
//!
//! A constraint is a list of equations c(x, q) = 0, one per row. Its forces are Jᵀ λ with the Jacobian J = ∂c/∂(x, φ), where φ are
//! rotations about the world axes. Sources: for the equations, E. Hairer, C. Lubich & G. Wanner, *Geometric Numerical Integration*, 2nd
//! ed., VII.1; for the joints, D. Baraff, *Linear-time dynamics using Lagrange multipliers*, SIGGRAPH 96.
//!
//! # Solving
//!
//! A method works on a `System`, which combines forces and constraints. With A = J M⁻¹ Jᵀ, Runge–Kutta methods solve A λ = −(J a + J̇ v) at
//! every evaluation of the forces. Splitting methods compute the impulses that move free bodies to c = 0 (SHAKE and RATTLE). After every
//! step, positions and velocities are projected onto the nearest solution of c = 0 and J v = 0, so joints hold up to rounding.
//!
//! A is factorized as L D Lᵀ (`factor.rs`), in minimum-degree order (`structure.rs`), so the cost along chains is linear. The factorization
//! is our own, because no crate meets both requirements: it must leave out redundant equations while it runs, the same ones during a whole
//! step, and its sums must not depend on the processor. Motors and gears measure angles from the beginning of the step, so no full turns
//! need to be counted.
//!
//! # Tolerances
//!
//! Tolerances of constraints and contacts follow from the sizes of bodies and levers, never from coordinates (`scale.rs`, and `Scale` in
//! `contact/collider.rs`): the origin of the world is arbitrary. Coordinates only widen a tolerance to the rounding errors that they cause:
//! 1e-14 of them for joints, 4e-14 for contacts. Rates of angles are compared with rates of lengths by the size of the mechanism. The two
//! tangents of a contact are arbitrary, too: friction is bounded by a disc, the couplings of its equations count by the norms of their 2 × 2
//! blocks, and rates are compared with lengths of vectors. `tests/families/` of jabuka changes what is arbitrary in random scenes, and
//! compares the motion.
//!
//! # Laws, modes and events
//!
//! Each equation has a [`Law`]. An equality always holds. An inequality (a rope, a limit, a contact) is c ≥ 0 with λ ≥ 0. A speed motor
//! keeps a speed with |λ| up to its limit. Friction couples two equations with the normal force. The `Mode` of an equation tells whether it
//! is active and how it exerts force. It does not change within a step, so the right-hand side is smooth there.
//!
//! A step ends at each event that changes a mode: a rope becomes taut, a multiplier changes its sign, or a motor reaches its speed.
//! `world/step_pieces.rs` shortens the step until it ends just after the event, so each method keeps its order. Then `row_modes.rs` solves two linear
//! complementarity problems. The first gives the impulses of the inequalities that are hit. The second gives, from the accelerations, the
//! equations that stay active. The account `limits` holds the energy that these impacts take, the account `motors` the work of motors.
//!
//! # Friction at several points
//!
//! Bodies that touch at several points can share friction in many ways, and the factorization picks one of them. Where it lies outside a
//! cone of friction, sweeps look for forces within all cones (`cone.rs`): nothing slips as long as there are any. If they find neither these
//! nor a slip, Moreau's scheme takes over.
//!
//! # Impulses of many contacts
//!
//! Moreau's scheme (`contact/crowd/`) needs impulses at all contacts, limits and motors at once. Sweeps find them (`sweep.rs`). The contacts
//! of bodies that touch no mechanism form a `Pile` (`pile.rs`): flat arrays of points and bodies, which sweeps pass through quickly, island
//! by island. The sweeps start from the last forces (`last_forces.rs`), and Anderson acceleration speeds them up (`anderson.rs`). Towers, and heavy
//! bodies on light ones, would need too many sweeps: where these leave an error, Newton's method solves an island as a whole (`refine.rs`,
//! `newton.rs`). Bodies that approach stop, or rebound by Poisson's law (`rebound.rs`). Overlapping bodies are moved apart (`separate.rs`),
//! and the accounts include the energy that this takes.
//!
//! # Reactions
//!
//! A snapshot holds the reaction of each constraint on its second end (`reaction.rs`): the sum of the forces Jᵀ λ of its equations, and of
//! their torques about this end. For redundant equations λ is zero, so one hinge of a door may carry the whole load and the other none. The
//! forces of an impact are not included. The contact forces of a heap are those of its last part; for a resting heap, sweeps find them
//! (`contact_forces.rs`).
//!
//! # A new kind
//!
//! A new constraint is a file here and a line in this one.

mod anderson;
mod ball;
mod columns;
mod cone;
mod contact_forces;
mod contacts;
mod coordinate;
mod envelope;
mod events;
mod factor;
mod fixed;
mod freedom;
mod friction;
mod gear;
mod hinge;
mod jacobian;
mod last_forces;
mod member;
mod newton;
mod parts;
mod pile;
mod pulley;
mod react;
mod reaction;
mod rebound;
mod refine;
mod rod;
mod rope;
mod row_modes;
mod scale;
mod separate;
mod servo;
mod settle;
mod slider;
mod sliding;
mod solver;
mod structure;
mod sweep;

pub(super) use anderson::Anderson;
pub use ball::Ball;
pub use coordinate::Coordinate;
pub(super) use factor::PIVOT_TOLERANCE;
pub use fixed::Fixed;
pub use freedom::{Freedom, Motor, Target};
pub use gear::Gear;
pub use hinge::Hinge;
pub use member::Member;
pub(super) use pile::Pile;
pub use pulley::Pulley;
pub use reaction::Reaction;
pub(super) use rebound::Struck;
pub use rod::Rod;
pub use rope::Rope;
pub use scale::Scale;
pub use servo::Servo;
pub use slider::Slider;
pub(super) use solver::Solver;
pub(super) use sweep::Purpose;

use glam::DVec3;

use super::{Anchor, BodyId};

/// A constraint between bodies, such as a joint or a lasting contact: a list of equations that the motion has to satisfy.
///
/// Each kind of constraint is one type with this trait. The solver does not depend on the kinds.
pub trait Constraint: std::fmt::Debug + Send + Sync {
    /// Returns the ends of the constraint: the points that it connects. Its force and torque are measured on the last end.
    fn ends(&self) -> Vec<Anchor>;

    /// Returns the bodies of the constraint, each once, in the order of the ends.
    fn bodies(&self) -> Vec<BodyId> {
        parts::bodies(&self.ends())
    }

    /// Returns the number of equations of the constraint.
    fn rows(&self) -> usize;

    /// Returns the law of one equation, [`Law::Equality`] by default.
    fn law(&self, _row: usize) -> Law {
        Law::Equality
    }

    /// Returns the equation of the motor; `None` without a motor.
    fn motor_row(&self) -> Option<usize> {
        None
    }

    /// Writes all equations of the constraint at one moment. `members` holds the bodies in the order of [`bodies`](Self::bodies).
    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>);

    /// Returns the force on the last end, world axes, N, if the constraint also acts at other points of the end's body or of the world.
    /// `multipliers` holds those of its equations. `None` by default: all that acts there acts on the last end.
    fn force_on_last_end(&self, _members: &Members<'_>, _multipliers: &[f64]) -> Option<DVec3> {
        None
    }
}

/// The kind of a constraint equation: equality, inequality, friction, or motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// An equality: c = 0, with a force of any size and sign.
    Equality,
    /// An inequality: c ≥ 0. Its force keeps c from becoming negative. It only pushes and never pulls.
    Inequality,
    /// Coulomb friction along two tangents, by two consecutive rows of this law. Their combined multiplier is at most `coefficient` times
    /// that of the constraint's first row. If this suffices, the contact sticks: c' = 0 in both rows. Otherwise it slides, and friction
    /// has this maximum.
    Friction {
        /// Coulomb's coefficient of friction, or for rotations the coefficient of rolling friction, m. It is positive.
        coefficient: f64,
    },
    /// A motor that keeps c' = 0, as far as a multiplier between −`limit` and `limit` allows.
    SpeedMotor {
        /// The largest multiplier of the motor, a force in N or a torque in N m. It is positive.
        limit: f64,
    },
}

/// The value and derivatives of a constraint equation c = 0 at one moment.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row {
    /// The value of c, m or dimensionless; 0 if the equation holds.
    pub violation: f64,
    /// ∂c/∂t: the part of c' that does not depend on velocities.
    pub rate: f64,
    /// The part of c'' that does not depend on accelerations: J̇ v + ∂²c/∂t².
    pub bias: f64,
    /// The magnitudes to which the tolerances of the equation are relative.
    pub scale: Scale,
}

/// The entries of the Jacobian in one row for one body: c' = linear·v + angular·ω + …
#[derive(Clone, Copy, Debug, Default)]
pub struct Direction {
    /// ∂c/∂x: the derivative of the equation with respect to the body's position, world axes.
    pub linear: DVec3,
    /// ∂c/∂φ: the derivative of the equation with respect to the body's rotation, world axes.
    pub angular: DVec3,
    /// The index of the body among the members of the solver.
    member: usize,
}

impl Direction {
    /// Returns the dot product of two directions, over the linear and the angular components.
    fn dot(&self, other: &Direction) -> f64 {
        let linear = self.linear.dot(other.linear);
        if other.angular == DVec3::ZERO { linear } else { linear + self.angular.dot(other.angular) }
    }
}

/// The bodies of one constraint at one moment, and at the start of the step.
#[derive(Clone, Copy, Debug)]
pub struct Members<'a> {
    all: &'a [Member],
    of: &'a [usize],
    time: f64,
    /// The states of all members of the solver at the start of the step.
    origin: &'a [Member],
    begun: f64,
    /// True while [`Solver::aim`] corrects initial velocities, so that the constraints hold at the end of the step.
    is_aiming: bool,
}

impl Members<'_> {
    /// Returns the current time, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Returns the time since the start of the step, s.
    #[must_use]
    pub fn elapsed(&self) -> f64 {
        self.time - self.begun
    }

    /// Returns the same bodies as they were at the start of the step.
    #[must_use]
    pub fn at_origin(&self) -> Self {
        Self { all: self.origin, time: self.begun, ..*self }
    }

    /// Returns the first two bodies at the start of the step, with the corrected initial velocities, while [`Solver::aim`] runs. `None` at
    /// all other times.
    pub(crate) fn aimed(&self) -> Option<[Member; 2]> {
        let set_off = |i: usize| {
            let (now, then) = (&self[i], &self.at_origin()[i]);
            let angular_velocity = match then.inverse_mass {
                0.0 => then.angular_velocity,
                _ => then.turn(now.angular_momentum),
            };
            Member { velocity: now.velocity, angular_velocity, ..*then }
        };
        self.is_aiming.then(|| [set_off(0), set_off(1)])
    }
}

impl std::ops::Index<usize> for Members<'_> {
    type Output = Member;

    fn index(&self, body: usize) -> &Member {
        &self.all[self.of[body]]
    }
}

/// The buffer into which a constraint writes its equations and their Jacobian.
pub struct Equations<'a> {
    /// The equations of all constraints, one per row.
    rows: &'a mut [Row],
    jacobian: &'a mut [Direction],
    /// The position of the constraint that writes now: its first row, its first direction (`direction`), and its number of bodies
    /// (`bodies`).
    row: usize,
    direction: usize,
    bodies: usize,
}

impl Equations<'_> {
    /// Writes an equation of the constraint, with a time-independent c, and sets its Jacobian to zero. `row` counts from the constraint's
    /// first row.
    pub(crate) fn row(&mut self, row: usize, violation: f64, bias: f64, scale: Scale) {
        self.rows[self.row + row] = Row { violation, rate: 0.0, bias, scale };
        // A loop by index: the compiler would unroll an iterator's loop for many bodies, but most constraint rows have one or two.
        let mut i = self.direction + row * self.bodies;
        let end = i + self.bodies;
        while i != end {
            let direction = &mut self.jacobian[i];
            (direction.linear, direction.angular) = (DVec3::ZERO, DVec3::ZERO);
            i += 1;
        }
    }

    /// Sets ∂c/∂t of an equation that depends on time. `row` counts from the constraint's first row.
    pub(crate) fn moving(&mut self, row: usize, rate: f64) {
        self.rows[self.row + row].rate = rate;
    }

    /// Writes the single row of a constraint with two ends. `ends` holds, for each end, its body and that body's Jacobian entries.
    #[inline(always)]
    fn only_row(&mut self, row: Row, ends: [(Option<usize>, DVec3, DVec3); 2]) {
        self.rows[self.row] = row;
        let [first, second] = ends;
        if first.0 == second.0 {
            self.direction_is((first.0, first.1 + second.1, first.2 + second.2));
        } else {
            self.direction_is(first);
            self.direction_is(second);
        }
    }

    #[inline(always)]
    fn direction_is(&mut self, (body, linear, angular): (Option<usize>, DVec3, DVec3)) {
        if let Some(body) = body {
            let direction = &mut self.jacobian[self.direction + body];
            (direction.linear, direction.angular) = (linear, angular);
        }
    }

    /// Adds `linear` and `angular` to the Jacobian entries of one body in a row. For a point of the world, `body` is `None` and nothing is
    /// added.
    pub(crate) fn direction(&mut self, row: usize, body: Option<usize>, linear: DVec3, angular: DVec3) {
        if let Some(body) = body {
            let direction = &mut self.jacobian[self.direction + row * self.bodies + body];
            direction.linear += linear;
            direction.angular += angular;
        }
    }
}

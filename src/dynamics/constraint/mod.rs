//! Constraints: their interface, one file for each kind, and one solver for all.
//!
//! A constraint is a list of equations c(x, q) = 0, its rows. Its forces are Jᵀ λ with the Jacobian J = ∂c/∂(x, φ), where φ are rotations
//! about the world axes. Source: E. Hairer, C. Lubich & G. Wanner, *Geometric Numerical Integration*, 2nd ed., VII.1; the joints: D.
//! Baraff, *Linear-time dynamics using Lagrange multipliers*, SIGGRAPH 96.

mod anderson;
mod ball;
mod columns;
mod contacts;
mod coordinate;
mod events;
mod factor;
mod fixed;
mod freedom;
mod friction;
mod gear;
mod hinge;
mod islands;
mod jacobian;
mod member;
mod modes;
mod parts;
mod pulley;
mod react;
mod reaction;
mod rebound;
mod restless;
mod rod;
mod rope;
mod separate;
mod servo;
mod settle;
mod shown;
mod slider;
mod sliding;
mod solver;
mod structure;
mod sweep;
mod warm;

pub use ball::Ball;
pub use coordinate::Coordinate;
pub use fixed::Fixed;
pub use freedom::{Freedom, Motor, Target};
pub use gear::Gear;
pub use hinge::Hinge;
pub use member::Member;
pub use pulley::Pulley;
pub use reaction::Reaction;
pub use rod::Rod;
pub use rope::Rope;
pub use servo::Servo;
pub use slider::Slider;
pub(super) use solver::Solver;
pub(super) use sweep::Purpose;

use glam::DVec3;

use super::{Anchor, BodyId};

/// A constraint holds bodies together.
///
/// A new kind is one type with this trait. The solver does not know the kinds.
pub trait Constraint: std::fmt::Debug + Send + Sync {
    /// Its ends. Its force and torque are measured on the last end.
    fn ends(&self) -> Vec<Anchor>;

    /// Its bodies, each once, in the order of the ends.
    fn bodies(&self) -> Vec<BodyId> {
        parts::bodies(&self.ends())
    }

    /// The number of its equations.
    fn rows(&self) -> usize;

    /// The law of one of its equations.
    fn law(&self, _row: usize) -> Law {
        Law::Tie
    }

    /// Writes all equations at one moment. `members` has the bodies in the order of [`bodies`](Self::bodies).
    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>);
}

/// How an equation is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// c = 0, with any force.
    Tie,
    /// c ≥ 0. It pushes to keep c from becoming negative. It never pulls.
    Stop,
    /// Coulomb friction along two tangents, by two consecutive rows of this law. Their combined multiplier is at most `coefficient` times
    /// that of the first row of the constraint. If this is enough, both keep c' = 0; otherwise they push with the maximum.
    Friction {
        /// Coulomb's coefficient; for rotations, the coefficient of rolling friction, m. It is positive.
        coefficient: f64,
    },
    /// c' = 0, as far as a multiplier from −`limit` to `limit` allows.
    Drive {
        /// The largest multiplier; it is positive.
        limit: f64,
    },
}

/// One equation of a constraint at one moment.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row {
    /// c, in metres or dimensionless; 0 if the equation holds.
    pub violation: f64,
    /// ∂c/∂t, the part of c' that does not depend on velocities.
    pub rate: f64,
    /// The part of c'' that does not depend on accelerations: J̇ v + ∂²c/∂t².
    pub bias: f64,
    /// The size of the terms whose difference is c. The rounding error of c is about 1e-16 of this.
    pub scale: f64,
}

/// The entries of one row of the Jacobian for one body: c' = linear·v + angular·ω + …
#[derive(Clone, Copy, Debug, Default)]
pub struct Direction {
    /// ∂c/∂x.
    pub linear: DVec3,
    /// ∂c/∂φ, world axes.
    pub angular: DVec3,
    /// The index of its body among the members.
    member: usize,
}

impl Direction {
    /// The sum of the products of all components.
    fn dot(&self, other: &Direction) -> f64 {
        let linear = self.linear.dot(other.linear);
        if other.angular == DVec3::ZERO { linear } else { linear + self.angular.dot(other.angular) }
    }
}

/// The bodies of a constraint at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Members<'a> {
    all: &'a [Member],
    of: &'a [usize],
    time: f64,
    /// All members at the start of the step.
    origin: &'a [Member],
    begun: f64,
    /// Whether the end of a step is being aimed at: see [`Solver::aim`].
    is_aiming: bool,
}

impl Members<'_> {
    /// The time, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The time since the start of the step, s.
    #[must_use]
    pub fn elapsed(&self) -> f64 {
        self.time - self.begun
    }

    /// The same bodies at the start of the step.
    #[must_use]
    pub fn at_origin(&self) -> Self {
        Self { all: self.origin, time: self.begun, ..*self }
    }

    /// While a step is being aimed: the first two bodies at its start, with their initial velocities. `None` at all other times.
    pub(in crate::dynamics) fn aimed(&self) -> Option<[Member; 2]> {
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

/// Where a constraint writes its equations.
pub struct Equations<'a> {
    /// The rows of all constraints.
    rows: &'a mut [Row],
    jacobian: &'a mut [Direction],
    /// The first row and the first direction of the current constraint, and the number of its bodies.
    row: usize,
    direction: usize,
    bodies: usize,
}

impl Equations<'_> {
    /// Writes a row with all directions zero.
    pub(in crate::dynamics) fn row(&mut self, row: usize, violation: f64, bias: f64, scale: f64) {
        self.rows[self.row + row] = Row { violation, rate: 0.0, bias, scale };
        // By index: most rows have one or two bodies, and the compiler unrolls an iterator's loop for many.
        let mut i = self.direction + row * self.bodies;
        let end = i + self.bodies;
        while i != end {
            let direction = &mut self.jacobian[i];
            (direction.linear, direction.angular) = (DVec3::ZERO, DVec3::ZERO);
            i += 1;
        }
    }

    /// Sets ∂c/∂t of a row.
    pub(in crate::dynamics) fn moving(&mut self, row: usize, rate: f64) {
        self.rows[self.row + row].rate = rate;
    }

    /// Writes the only row of a constraint with two ends. Each end gives its body and that body's direction.
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

    /// Adds to the direction of one body in a row. A point of the world has no body, so this adds nothing.
    pub(in crate::dynamics) fn direction(
        &mut self,
        row: usize,
        body: Option<usize>,
        linear: DVec3,
        angular: DVec3,
    ) {
        if let Some(body) = body {
            let direction = &mut self.jacobian[self.direction + row * self.bodies + body];
            direction.linear += linear;
            direction.angular += angular;
        }
    }
}

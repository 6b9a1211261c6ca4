//! What holds bodies together: the interface of a constraint, one file for each kind, and the solver of all of them.
//!
//! A constraint is a list of equations c(x, q) = 0, its rows. With the Jacobian J = ∂c/∂(x, φ), where φ are turns about the
//! world's axes, the forces that keep them are Jᵀ λ. Source: E. Hairer, C. Lubich & G. Wanner, *Geometric Numerical
//! Integration*, 2nd ed., VII.1; the joints: D. Baraff, *Linear-time dynamics using Lagrange multipliers*, SIGGRAPH 96.

mod ball;
mod factor;
mod fixed;
mod hinge;
mod member;
mod parts;
mod rod;
mod slider;
mod solver;
mod structure;

pub use ball::Ball;
pub use fixed::Fixed;
pub use hinge::Hinge;
pub use member::Member;
pub use rod::Rod;
pub use slider::Slider;
pub(super) use solver::Solver;

use glam::DVec3;

use super::BodyId;

/// What holds bodies together.
///
/// A new kind is one type with this trait; the solver does not know which kinds there are.
pub trait Constraint: std::fmt::Debug + Send + Sync {
    /// The bodies that it concerns, each once.
    fn bodies(&self) -> Vec<BodyId>;

    /// The number of its equations.
    fn rows(&self) -> usize;

    /// Writes all equations at one moment. `members` are the bodies, in the order of [`bodies`](Self::bodies).
    fn measure(&self, members: &Members<'_>, equations: &mut Equations<'_>);
}

/// One equation of a constraint at one moment.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row {
    /// c, in metres or without unit: by how much it does not hold.
    pub violation: f64,
    /// J̇ v: the part of c'' that does not come from accelerations.
    pub bias: f64,
    /// The size of the terms that c is a difference of: rounding makes an error of about this times 1e-16.
    pub scale: f64,
}

/// The part of a row of the Jacobian that belongs to one body: c' = linear·v + angular·ω + …
#[derive(Clone, Copy, Debug, Default)]
pub struct Direction {
    /// ∂c/∂x.
    pub linear: DVec3,
    /// ∂c/∂φ, world axes.
    pub angular: DVec3,
}

/// The bodies of a constraint at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Members<'a> {
    all: &'a [Member],
    of: &'a [usize],
}

impl std::ops::Index<usize> for Members<'_> {
    type Output = Member;

    fn index(&self, body: usize) -> &Member {
        &self.all[self.of[body]]
    }
}

/// Where a constraint writes its equations.
pub struct Equations<'a> {
    rows: &'a mut [Row],
    jacobian: &'a mut [Direction],
    bodies: usize,
}

impl Equations<'_> {
    /// Writes a row; the directions that are not set are zero.
    fn row(&mut self, row: usize, violation: f64, bias: f64, scale: f64) {
        self.rows[row] = Row { violation, bias, scale };
        let first = row * self.bodies;
        self.jacobian[first..first + self.bodies].fill(Direction::default());
    }

    /// Sets the direction of one body in a row; a point of the world has none.
    fn direction(&mut self, row: usize, body: Option<usize>, linear: DVec3, angular: DVec3) {
        if let Some(body) = body {
            self.jacobian[row * self.bodies + body] = Direction { linear, angular };
        }
    }
}

//! The state of the bodies: all quantities that change with time.
//!
//! The state holds angular momentum instead of angular velocity, because a free body conserves angular momentum exactly.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// The state of all bodies at one moment: one list for each quantity, one entry for each body.
///
/// Rotation is stored as angular momentum instead of angular velocity: torque changes it directly, and a free body conserves it exactly.
/// [`Model::angular_velocity`](super::Model::angular_velocity) gives the angular velocity.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// The position of each body's center of mass, world axes, m.
    pub location: Vec<DVec3>,
    /// The velocity of each body's center of mass, world axes, m/s.
    pub velocity: Vec<DVec3>,
    /// The orientation of each body's principal axes of inertia, as a unit quaternion. It equals the rotation from body axes to world axes,
    /// except for compounds and meshes. [`World::orientation`](super::World::orientation) returns the rotation from body axes to world axes
    /// for all bodies.
    pub orientation: Vec<DQuat>,
    /// The angular momentum of each body about its center of mass, world axes, kg m²/s.
    pub angular_momentum: Vec<DVec3>,
    /// The energy that forces without a potential, impacts and motors have brought in so far, J. It is integrated along with the motion, so
    /// that the error of the energy balance is as small as that of the method.
    pub accounts: Accounts,
}

/// The energy that forces without a potential, impacts and motors have brought in so far, J; negative if they removed energy. To add an
/// account, add a field to this struct and to [`NAMES`](Self::NAMES), and extend the two functions that convert to and from arrays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Accounts {
    /// The work of the forces without a potential, J: the integral of their power over time.
    pub work: f64,
    /// The work of the motors of joints, J.
    pub motors: f64,
    /// The energy change when a joint hits a limit or a rope becomes taut, J: negative when energy is lost. In time-stepping, it also holds
    /// the energy that yielding joints absorb and release.
    pub limits: f64,
    /// The energy change at impacts, J: negative when energy is lost.
    pub impacts: f64,
    /// The energy change by sliding and rolling friction between bodies in contact, J: negative when energy is lost.
    pub friction: f64,
}

/// The account in which the work of a force without a potential is booked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WorkAccount {
    /// The general account for the work of forces, [`Accounts::work`].
    Work,
    /// The account for the work of motors, [`Accounts::motors`].
    Motors,
}

impl WorkAccount {
    /// Returns the entry of this account: energy in J, or power in W.
    pub fn of(self, accounts: &mut Accounts) -> &mut f64 {
        match self {
            WorkAccount::Work => &mut accounts.work,
            WorkAccount::Motors => &mut accounts.motors,
        }
    }
}

impl Accounts {
    /// The names of the accounts, in the order of [`to_array`](Self::to_array).
    pub const NAMES: [&'static str; 5] = ["work", "motors", "limits", "impacts", "friction"];

    /// Returns all entries as an array, in the order of [`NAMES`](Self::NAMES).
    #[must_use]
    pub fn to_array(self) -> [f64; Self::NAMES.len()] {
        [self.work, self.motors, self.limits, self.impacts, self.friction]
    }

    /// Creates accounts from an array of entries, in the order of [`NAMES`](Self::NAMES).
    #[must_use]
    pub fn from_array([work, motors, limits, impacts, friction]: [f64; Self::NAMES.len()]) -> Self {
        Self { work, motors, limits, impacts, friction }
    }

    /// Adds `factor` times each entry of `others`. If `others` holds powers (W) and `factor` is a time (s), this adds the energy brought
    /// in during that time.
    pub fn add(&mut self, factor: f64, others: Accounts) {
        let (own, others) = (self.to_array(), others.to_array());
        *self = Accounts::from_array(std::array::from_fn(|i| own[i] + factor * others[i]));
    }

    /// Returns the sum of all accounts, J.
    #[must_use]
    pub fn total(self) -> f64 {
        self.to_array().into_iter().sum()
    }

    /// Returns the energy that impacts and friction have taken from the bodies so far, J; negative if they have added energy.
    #[must_use]
    pub fn taken_by_contacts(self) -> f64 {
        // The subtraction avoids a negative zero.
        0.0 - (self.impacts + self.friction)
    }
}

impl State {
    /// Reserves memory for this many more bodies.
    pub(super) fn reserve(&mut self, bodies: usize) {
        self.location.reserve_exact(bodies);
        self.velocity.reserve_exact(bodies);
        self.orientation.reserve_exact(bodies);
        self.angular_momentum.reserve_exact(bodies);
    }

    /// Copies the given bodies (all if `None`) and the accounts from another state with the same number of bodies.
    pub(super) fn take_over(&mut self, source: &State, bodies: Option<&[usize]>) {
        let Some(bodies) = bodies else {
            self.clone_from(source);
            return;
        };
        for &i in bodies {
            self.location[i] = source.location[i];
            self.velocity[i] = source.velocity[i];
            self.orientation[i] = source.orientation[i];
            self.angular_momentum[i] = source.angular_momentum[i];
        }
        self.accounts = source.accounts;
    }

    /// Returns the number of bodies in the state.
    #[must_use]
    pub fn len(&self) -> usize {
        self.location.len()
    }

    /// Returns true if the state has no bodies.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.location.is_empty()
    }
}

// Implemented by hand because of `clone_from`: the derived version would allocate, and Runge–Kutta methods copy a state at every stage.
impl Clone for State {
    fn clone(&self) -> Self {
        Self {
            location: self.location.clone(),
            velocity: self.velocity.clone(),
            orientation: self.orientation.clone(),
            angular_momentum: self.angular_momentum.clone(),
            accounts: self.accounts,
        }
    }

    fn clone_from(&mut self, source: &Self) {
        self.location.clone_from(&source.location);
        self.velocity.clone_from(&source.velocity);
        self.orientation.clone_from(&source.orientation);
        self.angular_momentum.clone_from(&source.angular_momentum);
        self.accounts = source.accounts;
    }
}

//! Everything that changes with time.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// The state of all bodies at one moment: one list for each quantity, one entry for each body.
///
/// Rotation is stored as angular momentum instead of angular velocity: torque changes it directly, and a free body conserves it exactly.
/// [`Model::angular_velocity`](super::Model::angular_velocity) gives the angular velocity.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Locations of the centres of mass, m.
    pub location: Vec<DVec3>,
    /// Velocities of the centres of mass, m/s.
    pub velocity: Vec<DVec3>,
    /// Orientations of the principal axes of inertia, unit quaternions. They equal `world_from_body`, except for compounds and meshes.
    /// [`World::orientation`](super::World::orientation) is right for all bodies.
    pub orientation: Vec<DQuat>,
    /// Angular momenta, each about the body's own centre of mass, world axes, kg m²/s.
    pub angular_momentum: Vec<DVec3>,
    /// The energy brought in so far by everything without a potential. It is integrated along with the motion, so that energy balances to
    /// the accuracy of the method.
    pub accounts: Accounts,
}

/// The energy brought in so far by everything without a potential, J; negative if energy was removed. To add an account, add a field
/// here, in [`NAMES`](Self::NAMES), and in the two functions below.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Accounts {
    /// The work of the forces without a potential: the integral of their power over time.
    pub work: f64,
    /// The work of the motors of joints.
    pub motors: f64,
    /// The energy lost when a joint hits a limit or a rope becomes taut; never positive. In time-stepping, it also holds the energy that
    /// yielding joints absorb and release.
    pub limits: f64,
    /// The energy lost at impacts; never positive.
    pub impacts: f64,
    /// The energy lost to sliding and rolling friction between bodies in contact; never positive.
    pub friction: f64,
}

/// The account for the work of a force without a potential.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WorkAccount {
    /// [`Accounts::work`].
    Work,
    /// [`Accounts::motors`].
    Motors,
}

impl WorkAccount {
    /// The entry of this account, J or W.
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

    /// All entries, in the order of the names.
    #[must_use]
    pub fn to_array(self) -> [f64; Self::NAMES.len()] {
        [self.work, self.motors, self.limits, self.impacts, self.friction]
    }

    /// The accounts with these entries, in the order of the names.
    #[must_use]
    pub fn from_array([work, motors, limits, impacts, friction]: [f64; Self::NAMES.len()]) -> Self {
        Self { work, motors, limits, impacts, friction }
    }

    /// Adds `factor` times each entry of `others`: for powers (W) and a time (s), the energy brought in during that time.
    pub fn add(&mut self, factor: f64, others: Accounts) {
        let (own, others) = (self.to_array(), others.to_array());
        *self = Accounts::from_array(std::array::from_fn(|i| own[i] + factor * others[i]));
    }

    /// The sum of all, J.
    #[must_use]
    pub fn total(self) -> f64 {
        self.to_array().into_iter().sum()
    }
}

impl State {
    /// Reserves memory for more bodies.
    pub(super) fn reserve(&mut self, bodies: usize) {
        self.location.reserve_exact(bodies);
        self.velocity.reserve_exact(bodies);
        self.orientation.reserve_exact(bodies);
        self.angular_momentum.reserve_exact(bodies);
    }

    /// Copies some bodies, or all if `None`, from another state of as many bodies, and its accounts.
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

    /// The number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.location.len()
    }

    /// Whether there is no body.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.location.is_empty()
    }
}

// Written by hand for `clone_from`: the derived one allocates, and Runge–Kutta methods copy a state at every stage.
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

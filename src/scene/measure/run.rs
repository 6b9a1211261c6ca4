//! The quantities of the whole run.

/// A quantity of the whole run at one time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunMeasure {
    /// The simulated time, s.
    Time,
    /// The index of the frame. The first frame has index 0.
    Frame,
    /// The kinetic and potential energy of the whole scene, J.
    Energy,
    /// The kinetic energy of the whole scene, J.
    Kinetic,
    /// The potential energy of the whole scene, J.
    Potential,
    /// A component of the momentum of all bodies that forces move, kg·m/s. The number is the axis: 0 for x, 1 for y, 2 for z.
    Momentum(usize),
    /// A component of their angular momentum about the origin, kg·m²/s. The number is the axis: 0 for x, 1 for y, 2 for z.
    AngularMomentum(usize),
    /// The energy error so far, relative to the largest kinetic energy so far.
    Drift,
    /// An energy that has been brought in so far, J. The number is the index in
    /// [`Accounts::to_array`](crate::physics::Accounts::to_array).
    Account(usize),
    /// The number of impacts in the whole scene so far.
    Impacts,
}

impl RunMeasure {
    /// All quantities of the run, each with its name in formulas and its meaning.
    pub const ALL: [(&'static str, RunMeasure, &'static str); 21] = [
        ("t", RunMeasure::Time, "the time"),
        ("frame", RunMeasure::Frame, "the number of the frame"),
        ("total", RunMeasure::Energy, "kinetic and potential energy of the whole scene; also `energy`"),
        ("kinetic", RunMeasure::Kinetic, "its kinetic energy; also `kinetic_energy`"),
        ("potential", RunMeasure::Potential, "its potential energy; also `potential_energy`"),
        ("px", RunMeasure::Momentum(0), "the momentum of all bodies that forces move"),
        ("py", RunMeasure::Momentum(1), "the momentum of all bodies that forces move"),
        ("pz", RunMeasure::Momentum(2), "the momentum of all bodies that forces move"),
        ("lx", RunMeasure::AngularMomentum(0), "their angular momentum about the origin"),
        ("ly", RunMeasure::AngularMomentum(1), "their angular momentum about the origin"),
        ("lz", RunMeasure::AngularMomentum(2), "their angular momentum about the origin"),
        ("drift", RunMeasure::Drift, "the energy error so far, as part of the largest kinetic energy so far"),
        ("work", RunMeasure::Account(0), "the work so far of forces without a potential, such as drag"),
        ("motors", RunMeasure::Account(1), "the work of motors so far"),
        ("limits", RunMeasure::Account(2), "the energy so far from limits of joints; negative if lost"),
        ("impact_energy", RunMeasure::Account(3), "the energy so far from impacts; negative if lost"),
        ("friction", RunMeasure::Account(4), "the energy so far from friction of contacts; negative if lost"),
        ("impacts", RunMeasure::Impacts, "the number of impacts so far; needs `simulation.contacts`"),
        ("energy", RunMeasure::Energy, "the same as `total`"),
        ("kinetic_energy", RunMeasure::Kinetic, "the same as `kinetic`"),
        ("potential_energy", RunMeasure::Potential, "the same as `potential`"),
    ];

    /// Returns the symbol of the quantity's unit. It is empty for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            RunMeasure::Time => "s",
            RunMeasure::Energy | RunMeasure::Kinetic | RunMeasure::Potential | RunMeasure::Account(_) => "J",
            RunMeasure::Momentum(_) => "kg·m/s",
            RunMeasure::AngularMomentum(_) => "kg·m²/s",
            RunMeasure::Frame | RunMeasure::Drift | RunMeasure::Impacts => "",
        }
    }

    /// Returns whether the quantity is a count. A label shows all digits of a count.
    pub fn is_count(self) -> bool {
        self == RunMeasure::Impacts
    }
}

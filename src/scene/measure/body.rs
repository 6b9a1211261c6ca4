//! The quantities of bodies.

/// A quantity of a body at one time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyMeasure {
    /// A coordinate of the body's location, m. The number is the axis: 0 for x, 1 for y, 2 for z.
    Location(usize),
    /// The magnitude of the velocity, m/s.
    Speed,
    /// A component of the body's velocity, m/s. The number is the axis: 0 for x, 1 for y, 2 for z.
    Velocity(usize),
    /// The magnitude of the body's acceleration, m/s².
    AccelerationMagnitude,
    /// A component of the body's acceleration, m/s². The number is the axis: 0 for x, 1 for y, 2 for z.
    Acceleration(usize),
    /// The magnitude of the net force on the body, N.
    ForceMagnitude,
    /// A component of the net force on the body, N. The number is the axis: 0 for x, 1 for y, 2 for z.
    Force(usize),
    /// The magnitude of the body's angular velocity, rad/s.
    AngularSpeed,
    /// A component of the body's angular velocity in world axes, rad/s. The number is the axis: 0 for x, 1 for y, 2 for z.
    AngularVelocity(usize),
    /// The mass of the body, kg.
    Mass,
    /// The magnitude of the body's momentum, kg·m/s.
    Momentum,
    /// A component of the body's momentum, kg·m/s. The number is the axis: 0 for x, 1 for y, 2 for z.
    MomentumComponent(usize),
    /// The power of the net force on the body, W.
    Power,
    /// The kinetic energy of translation and rotation, J.
    Kinetic,
    /// The body's share of the potential energy, J: see [`Force::share_potential`](crate::physics::Force::share_potential).
    Potential,
    /// The magnitude of the body's angular momentum about the origin, kg·m²/s.
    AngularMomentum,
    /// A component of the body's angular momentum about the origin, kg·m²/s. The number is the axis: 0 for x, 1 for y, 2 for z.
    AngularMomentumComponent(usize),
    /// The magnitude of the sum of the normal forces on the body, N.
    NormalForce,
    /// The magnitude of the sum of the forces of friction on the body, N.
    FrictionForce,
    /// The number of impacts of the body so far.
    Impacts,
}

impl BodyMeasure {
    /// All quantities of a body, each with its name in formulas and its meaning.
    pub const ALL: [(&'static str, BodyMeasure, &'static str); 34] = [
        ("x", BodyMeasure::Location(0), "its location"),
        ("y", BodyMeasure::Location(1), "its location"),
        ("z", BodyMeasure::Location(2), "its location"),
        ("speed", BodyMeasure::Speed, "its speed"),
        ("vx", BodyMeasure::Velocity(0), "its velocity"),
        ("vy", BodyMeasure::Velocity(1), "its velocity"),
        ("vz", BodyMeasure::Velocity(2), "its velocity"),
        ("acceleration", BodyMeasure::AccelerationMagnitude, "the size of its acceleration"),
        ("ax", BodyMeasure::Acceleration(0), "its acceleration"),
        ("ay", BodyMeasure::Acceleration(1), "its acceleration"),
        ("az", BodyMeasure::Acceleration(2), "its acceleration"),
        ("force", BodyMeasure::ForceMagnitude, "the size of the sum of the forces on it"),
        ("fx", BodyMeasure::Force(0), "the sum of the forces on it"),
        ("fy", BodyMeasure::Force(1), "the sum of the forces on it"),
        ("fz", BodyMeasure::Force(2), "the sum of the forces on it"),
        ("spin", BodyMeasure::AngularSpeed, "the size of its angular velocity"),
        ("wx", BodyMeasure::AngularVelocity(0), "its angular velocity"),
        ("wy", BodyMeasure::AngularVelocity(1), "its angular velocity"),
        ("wz", BodyMeasure::AngularVelocity(2), "its angular velocity"),
        ("mass", BodyMeasure::Mass, "its mass"),
        ("momentum", BodyMeasure::Momentum, "the size of its momentum"),
        ("px", BodyMeasure::MomentumComponent(0), "its momentum"),
        ("py", BodyMeasure::MomentumComponent(1), "its momentum"),
        ("pz", BodyMeasure::MomentumComponent(2), "its momentum"),
        ("power", BodyMeasure::Power, "the power of the sum of the forces on it"),
        ("kinetic", BodyMeasure::Kinetic, "its kinetic energy, of translation and rotation"),
        (
            "potential",
            BodyMeasure::Potential,
            "its potential energy; of an energy that two moving bodies have together, each has half",
        ),
        (
            "angular_momentum",
            BodyMeasure::AngularMomentum,
            "the size of its angular momentum about the origin, of its path and its rotation",
        ),
        ("lx", BodyMeasure::AngularMomentumComponent(0), "its angular momentum about the origin"),
        ("ly", BodyMeasure::AngularMomentumComponent(1), "its angular momentum about the origin"),
        ("lz", BodyMeasure::AngularMomentumComponent(2), "its angular momentum about the origin"),
        (
            "normal_force",
            BodyMeasure::NormalForce,
            "the size of the sum of the normal forces on it; needs `simulation.contacts`",
        ),
        (
            "friction_force",
            BodyMeasure::FrictionForce,
            "the size of the sum of the forces of friction on it; needs `simulation.contacts`",
        ),
        ("impacts", BodyMeasure::Impacts, "the number of its impacts so far"),
    ];

    /// Returns the symbol of the quantity's unit. It is empty for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            BodyMeasure::Location(_) => "m",
            BodyMeasure::Speed | BodyMeasure::Velocity(_) => "m/s",
            BodyMeasure::AccelerationMagnitude | BodyMeasure::Acceleration(_) => "m/s²",
            BodyMeasure::ForceMagnitude
            | BodyMeasure::Force(_)
            | BodyMeasure::NormalForce
            | BodyMeasure::FrictionForce => "N",
            BodyMeasure::AngularSpeed | BodyMeasure::AngularVelocity(_) => "rad/s",
            BodyMeasure::Mass => "kg",
            BodyMeasure::Momentum | BodyMeasure::MomentumComponent(_) => "kg·m/s",
            BodyMeasure::Power => "W",
            BodyMeasure::Kinetic | BodyMeasure::Potential => "J",
            BodyMeasure::AngularMomentum | BodyMeasure::AngularMomentumComponent(_) => "kg·m²/s",
            BodyMeasure::Impacts => "",
        }
    }

    /// Returns whether the quantity exists only with contacts.
    pub fn needs_contacts(self) -> bool {
        self.is_contact_force() || self == BodyMeasure::Impacts
    }

    /// Returns whether the quantity is a force of the body's contacts.
    pub fn is_contact_force(self) -> bool {
        matches!(self, BodyMeasure::NormalForce | BodyMeasure::FrictionForce)
    }

    /// Returns whether the quantity follows from the state of the body alone, without its contacts, its past and other bodies.
    pub fn is_of_state(self) -> bool {
        !self.needs_contacts() && self != BodyMeasure::Potential
    }

    /// Returns whether the quantity is a count. A label shows all digits of a count.
    pub fn is_count(self) -> bool {
        self == BodyMeasure::Impacts
    }
}

//! The quantities of named forces.

/// A quantity of a named force at one time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceMeasure {
    /// A component of the force on a body, N. The number is the axis: 0 for x, 1 for y, 2 for z.
    Component(usize),
    /// The magnitude of the force on a body, N.
    Size,
    /// The power of the force and its torque, W: on one body, or on all its bodies together.
    Power,
    /// The potential energy of the force, J: of all its bodies together, or the share of one body.
    Potential,
}

impl ForceMeasure {
    /// All quantities of a force, each with the last part of its name and its meaning.
    pub const ALL: [(&'static str, ForceMeasure, &'static str); 6] = [
        ("x", ForceMeasure::Component(0), "the force on its body, without the other forces"),
        ("y", ForceMeasure::Component(1), "the force on its body, without the other forces"),
        ("z", ForceMeasure::Component(2), "the force on its body, without the other forces"),
        ("size", ForceMeasure::Size, "the size of the force on its body, without the other forces"),
        ("power", ForceMeasure::Power, "the power of the force and its torque, on all its bodies together"),
        (
            "potential",
            ForceMeasure::Potential,
            "the potential energy of the force, of all its bodies together",
        ),
    ];

    /// Returns the symbol of the quantity's unit.
    pub const fn unit(self) -> &'static str {
        match self {
            ForceMeasure::Component(_) | ForceMeasure::Size => "N",
            ForceMeasure::Power => "W",
            ForceMeasure::Potential => "J",
        }
    }

    /// Returns whether the quantity has a meaning only for one body.
    pub fn needs_body(self) -> bool {
        !matches!(self, ForceMeasure::Power | ForceMeasure::Potential)
    }
}

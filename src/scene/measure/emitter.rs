//! The quantities of particle emitters.

/// A quantity of an emitter at one time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmitterMeasure {
    /// The number of its living particles.
    Count,
    /// The mean number of particles that it emits per second, 1/s. 0 before its first and after its last birth.
    Rate,
}

impl EmitterMeasure {
    /// All quantities of an emitter, each with the last part of its name in formulas and its meaning.
    pub const ALL: [(&'static str, EmitterMeasure, &'static str); 2] = [
        ("count", EmitterMeasure::Count, "the number of its living particles"),
        ("rate", EmitterMeasure::Rate, "how many particles it emits per second, on average"),
    ];

    /// Returns the symbol of the quantity's unit. It is empty for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            EmitterMeasure::Count => "",
            EmitterMeasure::Rate => "1/s",
        }
    }

    /// Returns whether the quantity is a count. A label shows all digits of a count.
    pub fn is_count(self) -> bool {
        self == EmitterMeasure::Count
    }
}

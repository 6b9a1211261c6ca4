//! The arithmetic operations of formulas.
//!
//! Constant folding, the search for a non-finite operation, and the compiled program all use these definitions, so all three compute the
//! same bits.

/// An operation on one number, such as the sine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unary {
    Negate,
    Not,
    Square,
    Cube,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Log10,
    Log2,
    Sqrt,
    Cbrt,
    Abs,
    Sign,
    Floor,
    Ceil,
    Round,
    Trunc,
    Degrees,
    Radians,
}

/// An operation on two numbers, such as the sum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Modulo,
    Power,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    Atan2,
    Hypot,
    Min,
    Max,
    Step,
}

/// An operation on three numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ternary {
    Lerp,
    Smoothstep,
}

impl Unary {
    /// Returns the function that computes the operation.
    pub(super) fn function(self) -> fn(f64) -> f64 {
        match self {
            Unary::Negate => |x| -x,
            Unary::Not => |x| truth(x == 0.0),
            Unary::Square => |x| x * x,
            Unary::Cube => |x| x * x * x,
            Unary::Sin => libm::sin,
            Unary::Cos => libm::cos,
            Unary::Tan => libm::tan,
            Unary::Asin => libm::asin,
            Unary::Acos => libm::acos,
            Unary::Atan => libm::atan,
            Unary::Sinh => libm::sinh,
            Unary::Cosh => libm::cosh,
            Unary::Tanh => libm::tanh,
            Unary::Exp => libm::exp,
            Unary::Ln => libm::log,
            Unary::Log10 => libm::log10,
            Unary::Log2 => libm::log2,
            Unary::Sqrt => f64::sqrt,
            Unary::Cbrt => libm::cbrt,
            Unary::Abs => f64::abs,
            Unary::Sign => sign,
            Unary::Floor => f64::floor,
            Unary::Ceil => f64::ceil,
            Unary::Round => f64::round,
            Unary::Trunc => f64::trunc,
            Unary::Degrees => |x| x * (180.0 / std::f64::consts::PI),
            Unary::Radians => |x| x * (std::f64::consts::PI / 180.0),
        }
    }

    pub(super) fn apply(self, x: f64) -> f64 {
        self.function()(x)
    }
}

impl Binary {
    /// Returns the function that computes the operation.
    pub(super) fn function(self) -> fn(f64, f64) -> f64 {
        match self {
            Binary::Add => |x, y| x + y,
            Binary::Subtract => |x, y| x - y,
            Binary::Multiply => |x, y| x * y,
            Binary::Divide => |x, y| x / y,
            Binary::Modulo => modulo,
            Binary::Power => power,
            Binary::Less => |x, y| truth(x < y),
            Binary::LessEqual => |x, y| truth(x <= y),
            Binary::Greater => |x, y| truth(x > y),
            Binary::GreaterEqual => |x, y| truth(x >= y),
            Binary::Equal => |x, y| truth(x == y),
            Binary::NotEqual => |x, y| truth(x != y),
            Binary::Atan2 => libm::atan2,
            Binary::Hypot => libm::hypot,
            // `f64::min` and `f64::max` would ignore a NaN. These functions return NaN if either argument is NaN.
            Binary::Min => |x, y| if x < y || x.is_nan() { x } else { y },
            Binary::Max => |x, y| if x > y || x.is_nan() { x } else { y },
            Binary::Step => |edge, x| if x < edge { 0.0 } else { 1.0 },
        }
    }

    pub(super) fn apply(self, x: f64, y: f64) -> f64 {
        self.function()(x, y)
    }
}

impl Ternary {
    /// Returns the function that computes the operation.
    pub(super) fn function(self) -> fn(f64, f64, f64) -> f64 {
        match self {
            Ternary::Lerp => |from, to, part| from + (to - from) * part,
            Ternary::Smoothstep => |low, high, x| {
                let part = ((x - low) / (high - low)).clamp(0.0, 1.0);
                part * part * (3.0 - 2.0 * part)
            },
        }
    }

    pub(super) fn apply(self, x: f64, y: f64, z: f64) -> f64 {
        self.function()(x, y, z)
    }
}

fn truth(is: bool) -> f64 {
    if is { 1.0 } else { 0.0 }
}

fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        x
    }
}

/// Returns the remainder of x / y with the sign of the divisor y: `mod(-1, 4)` is 3. Rust's `%` takes the sign of x instead; its result is
/// exact.
fn modulo(x: f64, y: f64) -> f64 {
    let rest = x % y;
    if rest != 0.0 && (rest < 0.0) != (y < 0.0) { rest + y } else { rest }
}

/// The largest magnitude of a whole exponent for which a power is computed by repeated multiplication.
const MAX_MULTIPLIED_EXPONENT: f64 = 16.0;

/// Returns the exponent as an integer if the power is computed by repeated multiplication: a whole number from -16 to 16.
#[allow(clippy::cast_possible_truncation, reason = "it is a whole number from -16 to 16")]
pub(super) fn whole_exponent(y: f64) -> Option<i32> {
    (y.abs() <= MAX_MULTIPLIED_EXPONENT && y.trunc() == y).then_some(y as i32)
}

/// Computes x to the power of y. Small whole powers are computed by multiplication, which is faster than `pow`, and exact if all products
/// are exact.
fn power(x: f64, y: f64) -> f64 {
    match whole_exponent(y) {
        Some(exponent) => whole_power(x, exponent),
        None => libm::pow(x, y),
    }
}

/// Computes x to a whole power by multiplication. For a negative exponent, takes the reciprocal of the product.
pub(super) fn whole_power(x: f64, exponent: i32) -> f64 {
    let magnitude = match exponent.unsigned_abs() {
        0 => 1.0,
        1 => x,
        2 => x * x,
        3 => x * x * x,
        many => by_squares(x, many),
    };
    if exponent < 0 { 1.0 / magnitude } else { magnitude }
}

fn by_squares(x: f64, exponent: u32) -> f64 {
    let (mut product, mut square, mut rest) = (1.0, x, exponent);
    loop {
        if rest & 1 == 1 {
            product *= square;
        }
        rest >>= 1;
        if rest == 0 {
            return product;
        }
        square *= square;
    }
}

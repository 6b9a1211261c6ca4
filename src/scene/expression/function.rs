//! The functions and constants that formulas can use.

use std::f64::consts;

use super::operation::{Binary, Ternary, Unary};

/// The constants that every formula knows, each with its name, value and meaning.
pub static CONSTANTS: &[(&str, f64, &str)] = &[
    ("pi", consts::PI, "half the circumference of a circle of radius 1"),
    ("tau", consts::TAU, "2 pi, a full turn"),
    ("e", consts::E, "the base of the natural logarithm"),
];

/// A function that formulas can call.
#[derive(Debug)]
pub struct Function {
    /// The name by which formulas call the function.
    pub name: &'static str,
    /// The names of the function's parameters, in order.
    pub parameters: &'static [&'static str],
    /// True if the function takes further arguments of the same kind as its last parameter, as `max(x, y, …)` does.
    pub is_open: bool,
    /// The meaning of the function, in a phrase for the documentation.
    pub meaning: &'static str,
    /// The operation that computes the function.
    pub(super) work: Work,
}

/// How a function of formulas is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Work {
    One(Unary),
    Two(Binary),
    Three(Ternary),
    /// Applies the operation to the first two arguments, then to that result and the next argument, and so on.
    Chain(Binary),
    Clamp,
    If,
    Uniform,
    Normal,
}

const fn new(
    name: &'static str,
    parameters: &'static [&'static str],
    work: Work,
    meaning: &'static str,
) -> Function {
    Function { name, parameters, is_open: matches!(work, Work::Chain(_)), meaning, work }
}

const fn one(name: &'static str, operation: Unary, meaning: &'static str) -> Function {
    new(name, &["x"], Work::One(operation), meaning)
}

/// All functions that formulas can call, in the order of the documentation.
pub static FUNCTIONS: &[Function] = &[
    one("sin", Unary::Sin, "the sine of an angle in radians"),
    one("cos", Unary::Cos, "the cosine of an angle in radians"),
    one("tan", Unary::Tan, "the tangent of an angle in radians"),
    one("asin", Unary::Asin, "the angle whose sine is x, in radians"),
    one("acos", Unary::Acos, "the angle whose cosine is x, in radians"),
    one("atan", Unary::Atan, "the angle whose tangent is x, in radians"),
    new("atan2", &["y", "x"], Work::Two(Binary::Atan2), "the angle of the point (x, y), from -pi to pi"),
    one("sinh", Unary::Sinh, "the hyperbolic sine"),
    one("cosh", Unary::Cosh, "the hyperbolic cosine"),
    one("tanh", Unary::Tanh, "the hyperbolic tangent"),
    one("deg", Unary::Degrees, "an angle in radians as degrees"),
    one("rad", Unary::Radians, "an angle in degrees as radians"),
    one("exp", Unary::Exp, "e to the power of x"),
    one("ln", Unary::Ln, "the natural logarithm"),
    one("log10", Unary::Log10, "the logarithm to base 10"),
    one("log2", Unary::Log2, "the logarithm to base 2"),
    one("sqrt", Unary::Sqrt, "the square root"),
    one("cbrt", Unary::Cbrt, "the cube root"),
    new("hypot", &["x", "y"], Work::Chain(Binary::Hypot), "the length of a vector: √(x² + y² + …)"),
    one("abs", Unary::Abs, "the magnitude"),
    one("sign", Unary::Sign, "-1, 0 or 1"),
    one("floor", Unary::Floor, "the next whole number below"),
    one("ceil", Unary::Ceil, "the next whole number above"),
    one("round", Unary::Round, "the nearest whole number; a half is rounded away from 0"),
    one("trunc", Unary::Trunc, "the whole number towards 0"),
    new("mod", &["x", "y"], Work::Two(Binary::Modulo), "the same as x % y: the rest, with the sign of y"),
    new("min", &["x", "y"], Work::Chain(Binary::Min), "the smallest of all"),
    new("max", &["x", "y"], Work::Chain(Binary::Max), "the largest of all"),
    new("clamp", &["x", "low", "high"], Work::Clamp, "x, or the bound that it exceeds"),
    new("lerp", &["from", "to", "part"], Work::Three(Ternary::Lerp), "from + (to - from) * part"),
    new("mix", &["from", "to", "part"], Work::Three(Ternary::Lerp), "the same as `lerp`"),
    new("step", &["edge", "x"], Work::Two(Binary::Step), "0 below the edge, and 1 from there"),
    new(
        "smoothstep",
        &["low", "high", "x"],
        Work::Three(Ternary::Smoothstep),
        "0 below low, 1 above high, and a smooth way between",
    ),
    new(
        "if",
        &["condition", "then", "otherwise"],
        Work::If,
        "one of two; the condition is a comparison, or any number that is not 0",
    ),
    new("uniform", &["low", "high"], Work::Uniform, "a random number between the two, each as likely"),
    new("normal", &["mean", "deviation"], Work::Normal, "a random number after the normal distribution"),
];

impl Function {
    /// Returns the function with this name, or `None` if no function has the name.
    pub fn named(name: &str) -> Option<&'static Function> {
        FUNCTIONS.iter().find(|function| function.name == name)
    }

    /// Returns true if the function can be called with `count` arguments.
    pub(super) fn takes(&self, count: usize) -> bool {
        count == self.parameters.len() || (self.is_open && count > self.parameters.len())
    }

    /// Formats the function as a call with its parameters: `atan2(y, x)`.
    pub fn usage(&self) -> String {
        let more = if self.is_open { ", …" } else { "" };
        format!("{}({}{more})", self.name, self.parameters.join(", "))
    }
}

/// Returns the value of the constant with this name, such as `pi`.
pub(super) fn constant(name: &str) -> Option<f64> {
    CONSTANTS.iter().find(|(constant, ..)| *constant == name).map(|(_, value, _)| *value)
}

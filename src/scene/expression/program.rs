//! A formula as a program: a list of instructions for a machine with an accumulator and a small stack.
//!
//! Most instructions have their operands with them, so that `-k*x - c*v` is four of them: the time of an evaluation is nearly
//! that of going from one instruction to the next. The stack is an array on the caller's stack, and nothing is allocated.

use super::error::ExpressionError;
use super::operation::whole_power;
use super::parser::Formula;
use super::resolve::Resolved;
use super::scope::Scope;

/// A formula that has been compiled, to be evaluated many times. Its text for debugging is that of the formula, and not of the
/// code, which has addresses.
#[derive(Clone)]
pub struct Program {
    pub(super) code: Code,
    resolved: Box<Resolved>,
}

/// A program alone, without the formula that it was compiled from.
#[derive(Clone)]
pub struct Code {
    pub(super) instructions: Box<[Instruction]>,
    /// How much of the stack it uses.
    pub(super) depth: usize,
}

impl std::fmt::Debug for Program {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.resolved.fmt(f)
    }
}

/// The numbers that a program is given, by their places.
trait Inputs: Copy {
    fn at(self, place: u32) -> f64;
}

impl Inputs for &[f64] {
    #[inline]
    fn at(self, place: u32) -> f64 {
        self[place as usize]
    }
}

/// One number, and behind it those that are the same at every evaluation.
#[derive(Clone, Copy)]
struct Before<'a>(f64, &'a [f64]);

impl Inputs for Before<'_> {
    #[inline]
    fn at(self, place: u32) -> f64 {
        match place {
            0 => self.0,
            place => self.1[place as usize - 1],
        }
    }
}

/// The most that a program can use of the stack.
pub(super) const MAX_STACK: usize = 256;
/// The stack of most programs: an array is cleared at every evaluation, so a small one is quicker.
const SMALL_STACK: usize = 4;

/// One step. `acc` is the accumulator, `v` and `w` are inputs, `c` is a constant.
///
/// Those that begin a new value first save the accumulator in the stack, at the place `to`; where it holds nothing of worth, the
/// place is a free one. Operands on the stack are at the place `at`.
#[derive(Clone, Copy, Debug)]
#[rustfmt::skip]
pub(super) enum Instruction {
    // A new value.
    LoadV { to: u8, v: u32 },
    LoadC { to: u8, c: f64 },
    AddVV { to: u8, v: u32, w: u32 },
    AddVC { to: u8, v: u32, c: f64 },
    SubVV { to: u8, v: u32, w: u32 },
    SubCV { to: u8, v: u32, c: f64 },
    MulVV { to: u8, v: u32, w: u32 },
    MulVC { to: u8, v: u32, c: f64 },
    DivVV { to: u8, v: u32, w: u32 },
    DivVC { to: u8, v: u32, c: f64 },
    DivCV { to: u8, v: u32, c: f64 },
    CallV { to: u8, v: u32, f: fn(f64) -> f64 },
    // The accumulator with an operand.
    AddV { v: u32 },
    AddC { c: f64 },
    SubV { v: u32 },
    VSub { v: u32 },
    CSub { c: f64 },
    MulV { v: u32 },
    MulC { c: f64 },
    DivV { v: u32 },
    VDiv { v: u32 },
    DivC { c: f64 },
    CDiv { c: f64 },
    /// acc + v * w
    AddMulVV { v: u32, w: u32 },
    /// acc - v * w
    SubMulVV { v: u32, w: u32 },
    /// acc + v * c
    AddMulVC { v: u32, c: f64 },
    /// acc * v + c, as in Horner's scheme.
    MulVAddC { v: u32, c: f64 },
    // The accumulator with the stack.
    AddS { at: u8 },
    MulS { at: u8 },
    /// stack - acc
    SubS { at: u8 },
    /// acc - stack
    SubFromAcc { at: u8 },
    /// stack / acc
    DivS { at: u8 },
    /// acc / stack
    DivAcc { at: u8 },
    // The accumulator alone.
    Negate,
    Square,
    Cube,
    Sqrt,
    WholePower { exponent: i32 },
    Call { f: fn(f64) -> f64 },
    /// f(stack, acc)
    Call2 { at: u8, f: fn(f64, f64) -> f64 },
    /// f(acc, stack)
    Call2Swapped { at: u8, f: fn(f64, f64) -> f64 },
    /// f(stack, the next of the stack, acc)
    Call3 { at: u8, f: fn(f64, f64, f64) -> f64 },
    // The next step.
    JumpIfZero { to: u32 },
    Jump { to: u32 },
}

impl Program {
    /// Reads, resolves and compiles a formula.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub fn compile(text: &str, scope: &Scope) -> Result<Program, Vec<ExpressionError>> {
        Formula::parse(text)?.resolve(scope)?.compile().map_err(|error| vec![error])
    }

    pub(super) fn new(code: Code, resolved: Resolved) -> Program {
        Program { code, resolved: Box::new(resolved) }
    }

    /// The formula that it was compiled from.
    pub fn resolved(&self) -> &Resolved {
        &self.resolved
    }

    /// The value, which may be infinite or NaN: see [`Program::explain_non_finite`]. `inputs` are the numbers for the slots of
    /// the scope, then those for the draws.
    ///
    /// # Panics
    /// If there are fewer inputs than [`Resolved::inputs`].
    #[inline]
    pub fn eval(&self, inputs: &[f64]) -> f64 {
        self.code.run(inputs)
    }

    /// Why the value is not finite, with the place in the formula; none where it is.
    ///
    /// # Panics
    /// If there are fewer inputs than [`Resolved::inputs`].
    pub fn explain_non_finite(&self, inputs: &[f64]) -> Option<ExpressionError> {
        if self.eval(inputs).is_finite() { None } else { self.resolved.explain_non_finite(inputs) }
    }
}

impl Code {
    /// The value for the first input and those behind it; see [`Program::eval`].
    ///
    /// # Panics
    /// If there are fewer inputs than it uses.
    #[inline]
    pub fn eval(&self, first: f64, rest: &[f64]) -> f64 {
        self.run(Before(first, rest))
    }

    #[inline]
    fn run(&self, inputs: impl Inputs) -> f64 {
        if self.depth <= SMALL_STACK {
            run::<SMALL_STACK>(&self.instructions, inputs)
        } else {
            run::<MAX_STACK>(&self.instructions, inputs)
        }
    }
}

/// Runs a program on a stack of `N` numbers, where `N` is a power of two and at least what the program uses.
fn run<const N: usize>(code: &[Instruction], inputs: impl Inputs) -> f64 {
    use Instruction as I;
    let mut stack = [0.0; N];
    let mut acc = 0.0;
    let mut next = 0;
    // The remainder says to the compiler what is known of the place.
    macro_rules! stack {
        ($at:expr) => {
            stack[$at as usize % N]
        };
    }
    macro_rules! input {
        ($v:expr) => {
            inputs.at($v)
        };
    }
    macro_rules! begin {
        ($to:expr, $value:expr) => {{
            let value = $value;
            stack![$to] = acc;
            acc = value;
        }};
    }
    while let Some(&instruction) = code.get(next) {
        next += 1;
        match instruction {
            I::LoadV { to, v } => begin!(to, input!(v)),
            I::LoadC { to, c } => begin!(to, c),
            I::AddVV { to, v, w } => begin!(to, input!(v) + input!(w)),
            I::AddVC { to, v, c } => begin!(to, input!(v) + c),
            I::SubVV { to, v, w } => begin!(to, input!(v) - input!(w)),
            I::SubCV { to, v, c } => begin!(to, c - input!(v)),
            I::MulVV { to, v, w } => begin!(to, input!(v) * input!(w)),
            I::MulVC { to, v, c } => begin!(to, input!(v) * c),
            I::DivVV { to, v, w } => begin!(to, input!(v) / input!(w)),
            I::DivVC { to, v, c } => begin!(to, input!(v) / c),
            I::DivCV { to, v, c } => begin!(to, c / input!(v)),
            I::CallV { to, v, f } => begin!(to, f(input!(v))),
            I::AddV { v } => acc += input!(v),
            I::AddC { c } => acc += c,
            I::SubV { v } => acc -= input!(v),
            I::VSub { v } => acc = input!(v) - acc,
            I::CSub { c } => acc = c - acc,
            I::MulV { v } => acc *= input!(v),
            I::MulC { c } => acc *= c,
            I::DivV { v } => acc /= input!(v),
            I::VDiv { v } => acc = input!(v) / acc,
            I::DivC { c } => acc /= c,
            I::CDiv { c } => acc = c / acc,
            I::AddMulVV { v, w } => acc += input!(v) * input!(w),
            I::SubMulVV { v, w } => acc -= input!(v) * input!(w),
            I::AddMulVC { v, c } => acc += input!(v) * c,
            I::MulVAddC { v, c } => acc = acc * input!(v) + c,
            I::AddS { at } => acc += stack![at],
            I::MulS { at } => acc *= stack![at],
            I::SubS { at } => acc = stack![at] - acc,
            I::SubFromAcc { at } => acc -= stack![at],
            I::DivS { at } => acc = stack![at] / acc,
            I::DivAcc { at } => acc /= stack![at],
            I::Negate => acc = -acc,
            I::Square => acc *= acc,
            I::Cube => acc = acc * acc * acc,
            I::Sqrt => acc = acc.sqrt(),
            I::WholePower { exponent } => acc = whole_power(acc, exponent),
            I::Call { f } => acc = f(acc),
            I::Call2 { at, f } => acc = f(stack![at], acc),
            I::Call2Swapped { at, f } => acc = f(acc, stack![at]),
            I::Call3 { at, f } => acc = f(stack![at], stack![at + 1], acc),
            I::JumpIfZero { to } if acc == 0.0 => next = to as usize,
            I::JumpIfZero { .. } => {}
            I::Jump { to } => next = to as usize,
        }
    }
    acc
}

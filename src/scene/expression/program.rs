//! A compiled formula: a list of instructions for a machine with an accumulator and a small stack.
//!
//! Dispatching instructions takes most of the time of an evaluation. Most instructions contain their operands, so `-k*x - c*v` has only
//! four instructions. The stack is a local array, so an evaluation allocates no memory.

use super::error::ExpressionError;
use super::operation::whole_power;
use super::parser::Formula;
use super::resolve::Resolved;
use super::scope::Scope;

/// A compiled formula that can be evaluated many times. Its `Debug` text shows the formula in place of the code, because the code contains
/// function addresses, which change from run to run.
#[derive(Clone)]
pub struct Program {
    pub(super) code: Code,
    resolved: Box<Resolved>,
}

/// The instructions of a program, without the expression tree.
#[derive(Clone)]
pub struct Code {
    pub(super) instructions: Box<[Instruction]>,
    /// The number of stack entries that the code uses.
    pub(super) depth: usize,
}

impl std::fmt::Debug for Program {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.resolved.fmt(f)
    }
}

/// The inputs of a program, accessed by index.
trait Inputs: Copy {
    fn at(self, place: u32) -> f64;
}

impl Inputs for &[f64] {
    #[inline]
    fn at(self, place: u32) -> f64 {
        self[place as usize]
    }
}

/// The inputs of a program, in two parts: a first input that changes from evaluation to evaluation, and the inputs that stay the same.
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

/// The maximum number of stack entries that a program can use.
pub(super) const MAX_STACK: usize = 256;
/// The number of stack entries that is enough for most programs. Each evaluation clears the stack, so a smaller stack is faster.
const SMALL_STACK: usize = 4;

/// An instruction of a program. `acc` is the accumulator, `v` and `w` are indices of inputs, and `c` is a constant.
///
/// An instruction that loads a new value first saves the accumulator in the stack entry `to`. If the old value is not needed, `to` is an
/// unused entry. `at` is the stack entry of an operand.
#[derive(Clone, Copy, Debug)]
#[rustfmt::skip]
pub(super) enum Instruction {
    // These instructions save the accumulator and load a new value into it.
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
    // These instructions combine the accumulator with inputs or constants.
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
    /// Sets the accumulator to `acc + v * w`.
    AddMulVV { v: u32, w: u32 },
    /// Sets the accumulator to `acc - v * w`.
    SubMulVV { v: u32, w: u32 },
    /// Sets the accumulator to `acc + v * c`.
    AddMulVC { v: u32, c: f64 },
    /// Sets the accumulator to `acc * v + c`, a step of Horner's scheme.
    MulVAddC { v: u32, c: f64 },
    // These instructions combine the accumulator with a stack entry.
    AddS { at: u8 },
    MulS { at: u8 },
    /// Sets the accumulator to `stack[at] - acc`.
    SubS { at: u8 },
    /// Sets the accumulator to `acc - stack[at]`.
    SubFromAcc { at: u8 },
    /// Sets the accumulator to `stack[at] / acc`.
    DivS { at: u8 },
    /// Sets the accumulator to `acc / stack[at]`.
    DivAcc { at: u8 },
    // These instructions compute a new accumulator from the old one and, for some, from stack entries.
    Negate,
    Square,
    Cube,
    Sqrt,
    WholePower { exponent: i32 },
    Call { f: fn(f64) -> f64 },
    /// Sets the accumulator to `f(stack[at], acc)`.
    Call2 { at: u8, f: fn(f64, f64) -> f64 },
    /// Sets the accumulator to `f(acc, stack[at])`.
    Call2Swapped { at: u8, f: fn(f64, f64) -> f64 },
    /// Sets the accumulator to `f(stack[at], stack[at + 1], acc)`.
    Call3 { at: u8, f: fn(f64, f64, f64) -> f64 },
    // These instructions continue at another instruction.
    JumpIfZero { to: u32 },
    Jump { to: u32 },
}

impl Program {
    /// Parses, resolves and compiles the text of a formula.
    ///
    /// # Errors
    /// All errors in the formula.
    pub fn compile(text: &str, scope: &Scope) -> Result<Program, Vec<ExpressionError>> {
        Formula::parse(text)?.resolve(scope)?.compile().map_err(|error| vec![error])
    }

    pub(super) fn new(code: Code, resolved: Resolved) -> Program {
        Program { code, resolved: Box::new(resolved) }
    }

    /// Returns the formula that the program was compiled from.
    pub fn resolved(&self) -> &Resolved {
        &self.resolved
    }

    /// Returns the value of the formula, which may be infinite or NaN: see [`Program::explain_non_finite`]. `inputs` are the numbers for
    /// the slots of the scope, followed by the random numbers.
    ///
    /// # Panics
    /// If there are fewer inputs than [`Resolved::inputs`].
    #[inline]
    pub fn eval(&self, inputs: &[f64]) -> f64 {
        self.code.run(inputs)
    }

    /// Explains why the value of the formula is not finite, with the position in the text. `None` if the value is finite.
    ///
    /// # Panics
    /// If there are fewer inputs than [`Resolved::inputs`].
    pub fn explain_non_finite(&self, inputs: &[f64]) -> Option<ExpressionError> {
        if self.eval(inputs).is_finite() { None } else { self.resolved.explain_non_finite(inputs) }
    }
}

impl Code {
    /// Evaluates the code. `first` is the first input and `rest` are all further inputs, as for [`Program::eval`].
    ///
    /// # Panics
    /// If there are fewer inputs than the code uses.
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

/// Runs a program with a stack of `N` entries. `N` is a power of two, and at least the number of entries that the program uses.
fn run<const N: usize>(code: &[Instruction], inputs: impl Inputs) -> f64 {
    use Instruction as I;
    let mut stack = [0.0; N];
    let mut acc = 0.0;
    let mut next = 0;
    // The remainder proves to the compiler that the index is within the stack, so it omits the bounds check.
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

//! Evaluates formulas for many sets of inputs at once. Each step of the program runs over whole columns of numbers.
//!
//! A step is dispatched once per column, and the compiler vectorizes the loop over the lanes. Each lane gets the same bits as from
//! [`Program`](super::Program).

use std::cell::RefCell;
use std::collections::HashMap;

use super::operation::{Binary, Ternary, Unary, whole_exponent, whole_power};
use super::parser::Id;
use super::resolve::{Resolved, Value};

/// The maximum number of lanes. A lane is one set of inputs; a program evaluates all lanes at once. With 64 lanes, the columns of most
/// formulas fit into the first-level cache.
pub(in crate::scene) const MAX_LANES: usize = 64;

pub(in crate::scene) type Column = [f64; MAX_LANES];

thread_local! {
    /// The columns of the current evaluation. The memory is reused, so usually only the first evaluation allocates.
    static COLUMNS: RefCell<Vec<Column>> = const { RefCell::new(Vec::new()) };
}

/// Several formulas of the same scope, compiled into one program. A subexpression that several formulas contain is computed once.
#[derive(Clone)]
pub(in crate::scene) struct Wide {
    /// The steps of the program. Each step writes its own column; these columns follow those of the inputs.
    steps: Box<[Step]>,
    /// The columns or constants that hold the values of the formulas, one per formula.
    outputs: Box<[Operand]>,
    inputs: usize,
    /// For each input, true if the formulas use it.
    uses: Box<[bool]>,
}

/// An operand of a step: the index of a column, or one number for all lanes.
#[derive(Clone, Copy, Debug)]
enum Operand {
    Column(usize),
    Constant(f64),
}

/// One step of a program. It reads only columns before its own.
#[derive(Clone, Copy, Debug)]
enum Step {
    One(Unary, Operand),
    Power(Operand, i32),
    Two(Binary, Operand, Operand),
    Three(Ternary, [Operand; 3]),
    /// A conditional: the second operand where the first is not 0, otherwise the third. Both operands are computed, which is safe because
    /// operations have no side effects.
    Choice([Operand; 3]),
}

/// The values of one formula in all lanes.
#[derive(Clone, Copy)]
pub(in crate::scene) enum Output<'a> {
    /// One value for each lane.
    Each(&'a [f64]),
    /// One value for all lanes.
    Constant(f64),
}

impl<'a> Output<'a> {
    /// Returns the values of the formula in all lanes. A constant is written to every lane of the buffer `room`.
    pub(in crate::scene) fn column(self, room: &'a mut Column) -> &'a [f64] {
        match self {
            Output::Each(values) => values,
            Output::Constant(value) => {
                room.fill(value);
                room
            }
        }
    }

    /// Returns the value of the formula in one lane.
    #[inline]
    pub(in crate::scene) fn at(&self, lane: usize) -> f64 {
        match self {
            Output::Each(values) => values[lane],
            Output::Constant(value) => *value,
        }
    }
}

impl Wide {
    /// Compiles several formulas of the same scope into one program. All random numbers of the formulas must have been drawn before.
    pub(in crate::scene) fn new(formulas: &[&Resolved]) -> Wide {
        let inputs = formulas.iter().map(|formula| formula.inputs()).max().unwrap_or(0);
        let mut builder =
            Builder { steps: Vec::new(), known: HashMap::new(), inputs, uses: vec![false; inputs] };
        let outputs = formulas.iter().map(|formula| builder.formula(formula)).collect();
        Wide { steps: builder.steps.into(), outputs, inputs, uses: builder.uses.into() }
    }

    /// Returns true if any of the formulas uses the input with this index.
    pub(in crate::scene) fn uses(&self, input: usize) -> bool {
        self.uses.get(input).copied().unwrap_or(false)
    }

    /// Evaluates the formulas in `lanes` lanes, at most [`MAX_LANES`]. `fill` is called to write the column of each input that the formulas
    /// use. `read` receives the values of all formulas.
    pub(in crate::scene) fn run<const N: usize>(
        &self,
        lanes: usize,
        mut fill: impl FnMut(usize, &mut [f64]),
        read: impl FnOnce([Output<'_>; N]),
    ) {
        COLUMNS.with_borrow_mut(|columns| {
            let needed = self.inputs + self.steps.len();
            if columns.len() < needed {
                columns.resize(needed, [0.0; MAX_LANES]);
            }
            let used = self.uses.iter().enumerate().filter(|(_, uses)| **uses);
            used.for_each(|(input, _)| fill(input, &mut columns[input][..lanes]));
            for (number, step) in self.steps.iter().enumerate() {
                let (before, rest) = columns.split_at_mut(self.inputs + number);
                if let Some(to) = rest.first_mut() {
                    step.run(before, &mut to[..lanes]);
                }
            }
            read(std::array::from_fn(|number| match self.outputs.get(number) {
                Some(Operand::Column(column)) => Output::Each(&columns[*column][..lanes]),
                Some(Operand::Constant(value)) => Output::Constant(*value),
                None => Output::Constant(0.0),
            }));
        });
    }
}

struct Builder {
    steps: Vec<Step>,
    /// The column of each step so far. The key encodes the operation and the operands of the step.
    known: HashMap<[u64; 5], usize>,
    inputs: usize,
    uses: Vec<bool>,
}

impl Builder {
    fn formula(&mut self, formula: &Resolved) -> Operand {
        let is_used = formula.parts_in_use();
        let mut operands: Vec<Operand> = vec![Operand::Constant(0.0); formula.nodes.len()];
        let parts = formula.nodes.iter().enumerate().filter(|(id, _)| is_used[*id]);
        for (id, node) in parts {
            let of = |id: Id| operands[id];
            let step = match node.value {
                Value::Constant(value) => {
                    operands[id] = Operand::Constant(value);
                    continue;
                }
                Value::Slot(slot) => {
                    self.uses[slot] = true;
                    operands[id] = Operand::Column(slot);
                    continue;
                }
                Value::Unary(operation, a) => Step::One(operation, of(a)),
                Value::Binary(Binary::Power, a, b) => match of(b) {
                    Operand::Constant(exponent) => match whole_exponent(exponent) {
                        Some(exponent) => Step::Power(of(a), exponent),
                        None => Step::Two(Binary::Power, of(a), of(b)),
                    },
                    Operand::Column(_) => Step::Two(Binary::Power, of(a), of(b)),
                },
                Value::Binary(operation, a, b) => Step::Two(operation, of(a), of(b)),
                Value::Ternary(operation, a, b, c) => Step::Three(operation, [of(a), of(b), of(c)]),
                Value::If(a, b, c) => Step::Choice([of(a), of(b), of(c)]),
            };
            operands[id] = Operand::Column(self.column(step));
        }
        operands.get(formula.root).copied().unwrap_or(Operand::Constant(0.0))
    }

    /// Adds a step to the program and returns the index of its column. Steps that compute the same value share a column.
    fn column(&mut self, step: Step) -> usize {
        let next = self.inputs + self.steps.len();
        let column = *self.known.entry(step.spelled()).or_insert(next);
        if column == next {
            self.steps.push(step);
        }
        column
    }
}

impl Step {
    /// Returns a key that is equal for steps that compute the same value.
    fn spelled(&self) -> [u64; 5] {
        let (kind, operation, operands): (u64, u64, &[Operand]) = match self {
            Step::One(operation, a) => (0, *operation as u64, &[*a]),
            #[allow(clippy::cast_sign_loss, reason = "the bits count")]
            Step::Power(a, exponent) => (1, *exponent as u64, &[*a]),
            Step::Two(operation, a, b) => (2, *operation as u64, &[*a, *b]),
            Step::Three(operation, operands) => (3, *operation as u64, operands),
            Step::Choice(operands) => (4, 0, operands),
        };
        let (mut words, mut kinds) = ([0, operation, 0, 0, 0], kind);
        for (word, operand) in words[2..].iter_mut().zip(operands) {
            (kinds, *word) = match operand {
                Operand::Column(column) => (kinds << 1, *column as u64),
                Operand::Constant(value) => (kinds << 1 | 1, value.to_bits()),
            };
        }
        words[0] = kinds | kind << 8;
        words
    }

    fn run(self, columns: &[Column], to: &mut [f64]) {
        match self {
            Step::One(operation, a) => one(operation, a, columns, to),
            Step::Power(a, exponent) => map(a, columns, to, |x| whole_power(x, exponent)),
            Step::Two(operation, a, b) => two(operation, [a, b], columns, to),
            Step::Three(operation, operands) => {
                let function = operation.function();
                three(operands, columns, to, function);
            }
            Step::Choice(operands) => {
                three(
                    operands,
                    columns,
                    to,
                    |condition, then, other| if condition == 0.0 { other } else { then },
                );
            }
        }
    }
}

/// Runs an operation with one operand over a column. The operations with a `match` arm of their own are vectorized by the compiler.
fn one(operation: Unary, a: Operand, columns: &[Column], to: &mut [f64]) {
    match operation {
        Unary::Negate => map(a, columns, to, |x| -x),
        Unary::Square => map(a, columns, to, |x| x * x),
        Unary::Cube => map(a, columns, to, |x| x * x * x),
        Unary::Sqrt => map(a, columns, to, f64::sqrt),
        Unary::Abs => map(a, columns, to, f64::abs),
        other => map(a, columns, to, other.function()),
    }
}

fn two(operation: Binary, operands: [Operand; 2], columns: &[Column], to: &mut [f64]) {
    let truth = |is: bool| if is { 1.0 } else { 0.0 };
    match operation {
        Binary::Add => zip(operands, columns, to, |x, y| x + y),
        Binary::Subtract => zip(operands, columns, to, |x, y| x - y),
        Binary::Multiply => zip(operands, columns, to, |x, y| x * y),
        Binary::Divide => zip(operands, columns, to, |x, y| x / y),
        Binary::Less => zip(operands, columns, to, |x, y| truth(x < y)),
        Binary::LessEqual => zip(operands, columns, to, |x, y| truth(x <= y)),
        Binary::Greater => zip(operands, columns, to, |x, y| truth(x > y)),
        Binary::GreaterEqual => zip(operands, columns, to, |x, y| truth(x >= y)),
        other => zip(operands, columns, to, other.function()),
    }
}

#[inline(always)]
fn map(a: Operand, columns: &[Column], to: &mut [f64], f: impl Fn(f64) -> f64) {
    match a {
        Operand::Column(a) => to.iter_mut().zip(&columns[a]).for_each(|(to, a)| *to = f(*a)),
        Operand::Constant(a) => to.fill(f(a)),
    }
}

#[inline(always)]
fn zip(operands: [Operand; 2], columns: &[Column], to: &mut [f64], f: impl Fn(f64, f64) -> f64) {
    match operands {
        [Operand::Column(a), Operand::Column(b)] => {
            let both = columns[a].iter().zip(&columns[b]);
            to.iter_mut().zip(both).for_each(|(to, (a, b))| *to = f(*a, *b));
        }
        [Operand::Column(a), Operand::Constant(b)] => {
            to.iter_mut().zip(&columns[a]).for_each(|(to, a)| *to = f(*a, b));
        }
        [Operand::Constant(a), Operand::Column(b)] => {
            to.iter_mut().zip(&columns[b]).for_each(|(to, b)| *to = f(a, *b));
        }
        [Operand::Constant(a), Operand::Constant(b)] => to.fill(f(a, b)),
    }
}

fn three(operands: [Operand; 3], columns: &[Column], to: &mut [f64], f: impl Fn(f64, f64, f64) -> f64) {
    let value = |operand: Operand, lane: usize| match operand {
        Operand::Column(column) => columns[column][lane],
        Operand::Constant(value) => value,
    };
    let [a, b, c] = operands;
    for (lane, to) in to.iter_mut().enumerate() {
        *to = f(value(a, lane), value(b, lane), value(c, lane));
    }
}

//! Compiles the expression tree of a formula into a program for a machine with an accumulator and a stack.

use super::error::{ExpressionError, syntax};
use super::operation::{Binary, Unary, whole_exponent};
use super::parser::Id;
use super::program::{Code, Instruction as I, MAX_STACK, Program};
use super::resolve::{Resolved, Value};

impl Resolved {
    /// Compiles the formula into a program that also keeps the tree, to explain non-finite values.
    ///
    /// # Errors
    /// If the formula is nested too deeply.
    pub fn compile(self) -> Result<Program, ExpressionError> {
        Ok(Program::new(self.code()?, self))
    }

    /// Compiles the formula into bare code, without the tree. Bare code needs less memory, but cannot explain a non-finite value.
    ///
    /// # Errors
    /// If the formula is nested too deeply.
    pub fn code(&self) -> Result<Code, ExpressionError> {
        let mut emitter = ProgramWriter {
            needs: needs(self),
            resolved: self,
            code: Vec::new(),
            // The remaining tasks; the last one is done next. This list replaces recursion, because the tree of a long sum is deep.
            tasks: vec![Task::Value { id: self.root, depth: 0, to: 0 }],
            jumps: Vec::new(),
            deepest: 0,
        };
        while let Some(task) = emitter.tasks.pop() {
            emitter.take(task);
        }
        let (code, deepest) = (emitter.code, emitter.deepest);
        if deepest >= MAX_STACK {
            let range = self.nodes[self.root].range.clone();
            let error = syntax(range, "the formula is nested too deeply");
            return Err(error.help("give parts of it names in `[variables]`"));
        }
        Ok(Code { instructions: code.into(), depth: deepest + 1 })
    }
}

/// A remaining task of the compiler.
#[derive(Clone, Copy)]
enum Task {
    /// Emits code that computes a subexpression into the accumulator. The first `depth` stack entries are in use. The code first saves the
    /// old accumulator in the stack entry `to`.
    Value {
        id: Id,
        depth: usize,
        to: usize,
    },
    Instruction(I),
    /// After the code of a condition: emits a jump to the second branch, taken if the condition is zero.
    Then,
    /// After the first branch: emits a jump to the end of the second branch.
    Otherwise,
    /// After the second branch: sets the target of the jump at the end of the first branch.
    End,
}

/// An operand that an instruction contains: the index of an input (`V`) or a constant (`C`).
#[derive(Clone, Copy)]
enum Leaf {
    V(u32),
    C(f64),
}

struct ProgramWriter<'a> {
    /// The number of stack entries that the code of each subexpression needs, by id.
    needs: Vec<usize>,
    resolved: &'a Resolved,
    code: Vec<I>,
    tasks: Vec<Task>,
    /// The positions, in `code`, of jump instructions whose targets are not known yet.
    jumps: Vec<usize>,
    deepest: usize,
}

/// Computes the number of stack entries that the code of each subexpression needs (Sethi–Ullman numbers). Of two operands, the one that
/// needs more entries is computed first, which keeps the stack small.
fn needs(resolved: &Resolved) -> Vec<usize> {
    let mut needs: Vec<usize> = Vec::with_capacity(resolved.nodes.len());
    for node in &resolved.nodes {
        let need = match node.value {
            Value::Constant(_) | Value::Slot(_) => 0,
            Value::Unary(_, a) => needs[a],
            Value::Binary(_, a, b) => {
                let (a, b) = (needs[a], needs[b]);
                a.max(b).max(a.min(b) + 1)
            }
            Value::Ternary(_, a, b, c) => needs[a].max(needs[b] + 1).max(needs[c] + 2),
            Value::If(a, b, c) => needs[a].max(needs[b]).max(needs[c]),
        };
        needs.push(need);
    }
    needs
}

impl ProgramWriter<'_> {
    #[allow(clippy::cast_possible_truncation, reason = "a formula is at most ten thousand bytes long")]
    fn take(&mut self, task: Task) {
        match task {
            Task::Value { id, depth, to } => self.value(id, depth, to),
            Task::Instruction(instruction) => self.code.push(instruction),
            Task::Then => {
                self.jumps.push(self.code.len());
                self.code.push(I::JumpIfZero { to: 0 });
            }
            Task::Otherwise => {
                let next = self.code.len() as u32 + 1;
                self.aim(I::JumpIfZero { to: next });
                self.jumps.push(self.code.len());
                self.code.push(I::Jump { to: 0 });
            }
            Task::End => self.aim(I::Jump { to: self.code.len() as u32 }),
        }
    }

    /// Replaces the most recent jump without a target by `jump`, which has one.
    fn aim(&mut self, jump: I) {
        if let Some(place) = self.jumps.pop() {
            self.code[place] = jump;
        }
    }

    /// Schedules tasks before all remaining tasks. The new tasks run in the given order.
    fn next<const N: usize>(&mut self, tasks: [Task; N]) {
        self.tasks.extend(tasks.into_iter().rev());
    }

    #[allow(clippy::cast_possible_truncation, reason = "there are far fewer inputs than 2^32")]
    fn leaf(&self, id: Id) -> Option<Leaf> {
        match self.resolved.nodes[id].value {
            Value::Slot(slot) => Some(Leaf::V(slot as u32)),
            Value::Constant(value) => Some(Leaf::C(value)),
            _ => None,
        }
    }

    /// Returns the two factors of a subexpression that multiplies an input by another input or by a constant. `None` for all other
    /// subexpressions.
    fn product(&self, id: Id) -> Option<(u32, Leaf)> {
        let Value::Binary(Binary::Multiply, a, b) = self.resolved.nodes[id].value else { return None };
        match (self.leaf(a)?, self.leaf(b)?) {
            (Leaf::V(v), leaf) | (leaf, Leaf::V(v)) => Some((v, leaf)),
            _ => None,
        }
    }

    #[allow(clippy::cast_possible_truncation, reason = "deeper than the stack is an error in the end")]
    fn value(&mut self, id: Id, depth: usize, to: usize) {
        self.deepest = self.deepest.max(depth).max(to);
        let (save, at) = (to as u8, depth as u8);
        match self.resolved.nodes[id].value {
            Value::Constant(c) => self.code.push(I::LoadC { to: save, c }),
            Value::Slot(_) => {
                if let Some(Leaf::V(v)) = self.leaf(id) {
                    self.code.push(I::LoadV { to: save, v });
                }
            }
            Value::Unary(operation, a) => self.unary(operation, a, depth, to),
            Value::Binary(operation, a, b) => {
                if !self.arithmetic(operation, a, b, depth, to) {
                    self.binary(operation, a, b, depth, to);
                }
            }
            Value::Ternary(operation, a, b, c) => self.next([
                Task::Value { id: a, depth, to },
                Task::Value { id: b, depth: depth + 1, to: depth },
                Task::Value { id: c, depth: depth + 2, to: depth + 1 },
                Task::Instruction(I::Call3 { at, f: operation.function() }),
            ]),
            Value::If(a, b, c) => self.next([
                Task::Value { id: a, depth, to },
                Task::Then,
                Task::Value { id: b, depth, to: depth },
                Task::Otherwise,
                Task::Value { id: c, depth, to: depth },
                Task::End,
            ]),
        }
    }

    #[allow(clippy::cast_possible_truncation, reason = "deeper than the stack is an error in the end")]
    fn unary(&mut self, operation: Unary, a: Id, depth: usize, to: usize) {
        let f = operation.function();
        let instruction = match (operation, self.leaf(a)) {
            (Unary::Negate, _) => I::Negate,
            (Unary::Square, _) => I::Square,
            (Unary::Cube, _) => I::Cube,
            (Unary::Sqrt, _) => I::Sqrt,
            (_, Some(Leaf::V(v))) => {
                self.code.push(I::CallV { to: to as u8, v, f });
                return;
            }
            _ => I::Call { f },
        };
        self.next([Task::Value { id: a, depth, to }, Task::Instruction(instruction)]);
    }

    /// Emits code for an operation on two operands of any kind. The operand that needs more stack entries is computed first.
    #[allow(clippy::cast_possible_truncation, reason = "deeper than the stack is an error in the end")]
    fn binary(&mut self, operation: Binary, a: Id, b: Id, depth: usize, to: usize) {
        let at = depth as u8;
        if let (Binary::Power, Value::Constant(exponent)) = (operation, self.resolved.nodes[b].value)
            && let Some(exponent) = whole_exponent(exponent)
        {
            let power = Task::Instruction(I::WholePower { exponent });
            return self.next([Task::Value { id: a, depth, to }, power]);
        }
        let is_swapped = self.needs[b] > self.needs[a];
        let f = operation.function();
        let instruction = match (operation, is_swapped) {
            (Binary::Add, _) => I::AddS { at },
            (Binary::Multiply, _) => I::MulS { at },
            (Binary::Subtract, false) => I::SubS { at },
            (Binary::Subtract, true) => I::SubFromAcc { at },
            (Binary::Divide, false) => I::DivS { at },
            (Binary::Divide, true) => I::DivAcc { at },
            (_, false) => I::Call2 { at, f },
            (_, true) => I::Call2Swapped { at, f },
        };
        let (first, second) = if is_swapped { (b, a) } else { (a, b) };
        self.next([
            Task::Value { id: first, depth, to },
            Task::Value { id: second, depth: depth + 1, to: depth },
            Task::Instruction(instruction),
        ]);
    }

    /// Emits an arithmetic operation if an input or a constant among its operands fits into the instruction. Returns `false`, and emits
    /// nothing, if neither operand does.
    fn arithmetic(&mut self, operation: Binary, a: Id, b: Id, depth: usize, to: usize) -> bool {
        let (left, right) = (self.leaf(a), self.leaf(b));
        if let Some(instruction) = both(operation, left, right, to) {
            self.code.push(instruction);
            return true;
        }
        let (first, instruction) = match operation {
            Binary::Add | Binary::Subtract => {
                let fused = |product: Option<(u32, Leaf)>| {
                    Some(match (product?, operation) {
                        ((v, Leaf::V(w)), Binary::Add) => I::AddMulVV { v, w },
                        ((v, Leaf::V(w)), _) => I::SubMulVV { v, w },
                        ((v, Leaf::C(c)), Binary::Add) => I::AddMulVC { v, c },
                        ((v, Leaf::C(c)), _) => I::AddMulVC { v, c: -c },
                    })
                };
                if let Some(horner) = self.horner(operation, a, b) {
                    horner
                } else if let Some(instruction) = fused(self.product(b)) {
                    (a, instruction)
                } else if let (Binary::Add, Some(instruction)) = (operation, fused(self.product(a))) {
                    (b, instruction)
                } else {
                    match one(operation, a, b, left, right) {
                        Some(found) => found,
                        None => return false,
                    }
                }
            }
            _ => match one(operation, a, b, left, right) {
                Some(found) => found,
                None => return false,
            },
        };
        self.next([Task::Value { id: first, depth, to }, Task::Instruction(instruction)]);
        true
    }

    /// Returns the subexpression x and the instruction for `x*v + c`, if `operation` on `a` and `b` has that form, and x is neither an
    /// input nor a constant.
    fn horner(&self, operation: Binary, a: Id, b: Id) -> Option<(Id, I)> {
        let (sum, c) = match (operation, self.leaf(a), self.leaf(b)) {
            (Binary::Add, _, Some(Leaf::C(c))) => (a, c),
            (Binary::Add, Some(Leaf::C(c)), _) => (b, c),
            (Binary::Subtract, _, Some(Leaf::C(c))) => (a, -c),
            _ => return None,
        };
        let Value::Binary(Binary::Multiply, x, y) = self.resolved.nodes[sum].value else { return None };
        match (self.leaf(x), self.leaf(y)) {
            (None, Some(Leaf::V(v))) => Some((x, I::MulVAddC { v, c })),
            (Some(Leaf::V(v)), None) => Some((y, I::MulVAddC { v, c })),
            _ => None,
        }
    }
}

/// Returns the single instruction for an operation on two inputs, or on an input and a constant. Subtracting a constant becomes adding its
/// negative.
#[allow(clippy::cast_possible_truncation, reason = "deeper than the stack is an error in the end")]
fn both(operation: Binary, left: Option<Leaf>, right: Option<Leaf>, to: usize) -> Option<I> {
    let to = to as u8;
    Some(match (operation, left?, right?) {
        (Binary::Add, Leaf::V(v), Leaf::V(w)) => I::AddVV { to, v, w },
        (Binary::Add, Leaf::V(v), Leaf::C(c)) | (Binary::Add, Leaf::C(c), Leaf::V(v)) => {
            I::AddVC { to, v, c }
        }
        (Binary::Subtract, Leaf::V(v), Leaf::V(w)) => I::SubVV { to, v, w },
        (Binary::Subtract, Leaf::V(v), Leaf::C(c)) => I::AddVC { to, v, c: -c },
        (Binary::Subtract, Leaf::C(c), Leaf::V(v)) => I::SubCV { to, v, c },
        (Binary::Multiply, Leaf::V(v), Leaf::V(w)) => I::MulVV { to, v, w },
        (Binary::Multiply, Leaf::V(v), Leaf::C(c)) | (Binary::Multiply, Leaf::C(c), Leaf::V(v)) => {
            I::MulVC { to, v, c }
        }
        (Binary::Divide, Leaf::V(v), Leaf::V(w)) => I::DivVV { to, v, w },
        (Binary::Divide, Leaf::V(v), Leaf::C(c)) => I::DivVC { to, v, c },
        (Binary::Divide, Leaf::C(c), Leaf::V(v)) => I::DivCV { to, v, c },
        _ => return None,
    })
}

/// Returns the operand to compute into the accumulator, and the instruction that contains the other operand (an input or a constant).
fn one(operation: Binary, a: Id, b: Id, left: Option<Leaf>, right: Option<Leaf>) -> Option<(Id, I)> {
    Some(match (operation, left, right) {
        (Binary::Add, _, Some(Leaf::V(v))) => (a, I::AddV { v }),
        (Binary::Add, _, Some(Leaf::C(c))) => (a, I::AddC { c }),
        (Binary::Add, Some(Leaf::V(v)), _) => (b, I::AddV { v }),
        (Binary::Add, Some(Leaf::C(c)), _) => (b, I::AddC { c }),
        (Binary::Subtract, _, Some(Leaf::V(v))) => (a, I::SubV { v }),
        (Binary::Subtract, _, Some(Leaf::C(c))) => (a, I::AddC { c: -c }),
        (Binary::Subtract, Some(Leaf::V(v)), _) => (b, I::VSub { v }),
        (Binary::Subtract, Some(Leaf::C(c)), _) => (b, I::CSub { c }),
        (Binary::Multiply, _, Some(Leaf::V(v))) => (a, I::MulV { v }),
        (Binary::Multiply, _, Some(Leaf::C(c))) => (a, I::MulC { c }),
        (Binary::Multiply, Some(Leaf::V(v)), _) => (b, I::MulV { v }),
        (Binary::Multiply, Some(Leaf::C(c)), _) => (b, I::MulC { c }),
        (Binary::Divide, _, Some(Leaf::V(v))) => (a, I::DivV { v }),
        (Binary::Divide, _, Some(Leaf::C(c))) => (a, I::DivC { c }),
        (Binary::Divide, Some(Leaf::V(v)), _) => (b, I::VDiv { v }),
        (Binary::Divide, Some(Leaf::C(c)), _) => (b, I::CDiv { c }),
        _ => return None,
    })
}

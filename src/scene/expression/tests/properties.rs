//! Tests random formulas: printing and parsing gives the same formula, compiled programs give the same bits as the tree, and no text makes
//! the parser panic.

use crate::diagnostic::Code;
use proptest::prelude::*;

use super::super::function::{FUNCTIONS, Function, Work};
use super::super::operation::{Binary, Unary};
use super::super::parser::{Formula, Subexpression};
use super::super::wide::Wide;
use super::super::{Constants, MAX_LANES, Program, Scope};
use super::scope;

/// A random formula. It is printed and evaluated without the code under test.
#[derive(Clone, Debug, PartialEq)]
enum Tree {
    Number(f64),
    Name(&'static str),
    Sign(Box<Tree>),
    Not(Box<Tree>),
    Two(&'static str, Box<[Tree; 2]>),
    Call(&'static str, Vec<Tree>),
}

const OPERATORS: [(&str, u8); 14] = [
    ("or", 1),
    ("and", 2),
    ("<", 4),
    ("<=", 4),
    (">", 4),
    (">=", 4),
    ("==", 4),
    ("!=", 4),
    ("+", 5),
    ("-", 5),
    ("*", 6),
    ("/", 6),
    ("%", 6),
    ("^", 8),
];

impl Tree {
    /// Returns the precedence of the formula's outermost operator. Higher levels bind more tightly.
    fn level(&self) -> u8 {
        match self {
            Tree::Not(_) => 3,
            Tree::Sign(_) => 7,
            Tree::Two(operator, _) => OPERATORS.iter().find(|(other, _)| other == operator).unwrap().1,
            _ => 9,
        }
    }

    /// Prints the formula with as few parentheses as possible.
    fn print(&self) -> String {
        let inner = |tree: &Tree, least: u8| {
            if tree.level() >= least { tree.print() } else { format!("({})", tree.print()) }
        };
        match self {
            Tree::Number(number) => format!("{number:?}"),
            Tree::Name(name) => (*name).to_owned(),
            Tree::Sign(tree) => format!("-{}", inner(tree, 7)),
            Tree::Not(tree) => format!("not {}", inner(tree, 3)),
            // `^` is right-associative, so its right operand may be another power or a sign without parentheses.
            Tree::Two("^", both) => format!("{}^{}", inner(&both[0], 9), inner(&both[1], 7)),
            Tree::Two(operator, both) => {
                let level = self.level();
                let left = if level == 4 { 5 } else { level };
                format!("{} {operator} {}", inner(&both[0], left), inner(&both[1], level + 1))
            }
            Tree::Call(name, values) => {
                format!("{name}({})", values.iter().map(Tree::print).collect::<Vec<_>>().join(", "))
            }
        }
    }

    /// Converts a parsed formula, from the node `id` down, into a test tree.
    fn of(formula: &Formula, id: usize) -> Tree {
        let of = |id: &usize| Tree::of(formula, *id);
        let two = |operator, a, b| Tree::Two(operator, Box::new([of(a), of(b)]));
        match &formula.nodes[id].part {
            Subexpression::Number(number) => Tree::Number(*number),
            Subexpression::Name(range) => {
                let name = &formula.text()[range.clone()];
                Tree::Name(NAMES.iter().find(|other| **other == name).unwrap())
            }
            Subexpression::Unary(Unary::Not, a) => Tree::Not(Box::new(of(a))),
            Subexpression::Unary(_, a) => Tree::Sign(Box::new(of(a))),
            Subexpression::And(a, b) => two("and", a, b),
            Subexpression::Or(a, b) => two("or", a, b),
            Subexpression::Binary(operation, a, b) => {
                let operator = match operation {
                    Binary::Add => "+",
                    Binary::Subtract => "-",
                    Binary::Multiply => "*",
                    Binary::Divide => "/",
                    Binary::Modulo => "%",
                    Binary::Power => "^",
                    Binary::Less => "<",
                    Binary::LessEqual => "<=",
                    Binary::Greater => ">",
                    Binary::GreaterEqual => ">=",
                    Binary::Equal => "==",
                    _ => "!=",
                };
                two(operator, a, b)
            }
            Subexpression::Call(function, values) => {
                Tree::Call(function.name, values.iter().map(of).collect())
            }
        }
    }

    /// Computes the value of the formula by walking the tree.
    fn value(&self, inputs: &[f64; 3]) -> f64 {
        let truth = |is: bool| f64::from(u8::from(is));
        match self {
            Tree::Number(number) => *number,
            Tree::Name("r") => 2.5,
            Tree::Name("pi") => std::f64::consts::PI,
            Tree::Name(name) => inputs["xyz".find(name).unwrap()],
            Tree::Sign(a) => -a.value(inputs),
            Tree::Not(a) => truth(a.value(inputs) == 0.0),
            Tree::Two(operator, both) => {
                let (a, b) = (both[0].value(inputs), both[1].value(inputs));
                match *operator {
                    "or" => truth(a != 0.0 || b != 0.0),
                    "and" => truth(a != 0.0 && b != 0.0),
                    "<" => truth(a < b),
                    "<=" => truth(a <= b),
                    ">" => truth(a > b),
                    ">=" => truth(a >= b),
                    "==" => truth(a == b),
                    "!=" => truth(a != b),
                    "+" => a + b,
                    "-" => a - b,
                    "*" => a * b,
                    "/" => a / b,
                    "%" => Binary::Modulo.apply(a, b),
                    _ => Binary::Power.apply(a, b),
                }
            }
            Tree::Call(name, values) => {
                let v: Vec<f64> = values.iter().map(|value| value.value(inputs)).collect();
                match Function::named(name).unwrap().work {
                    Work::One(operation) => operation.apply(v[0]),
                    Work::Two(operation) => operation.apply(v[0], v[1]),
                    Work::Three(operation) => operation.apply(v[0], v[1], v[2]),
                    Work::Chain(operation) => v[1..].iter().fold(v[0], |a, b| operation.apply(a, *b)),
                    Work::Clamp => Binary::Min.apply(Binary::Max.apply(v[0], v[1]), v[2]),
                    Work::If if v[0] != 0.0 => v[1],
                    Work::If => v[2],
                    Work::Uniform | Work::Normal => unreachable!("they are not made"),
                }
            }
        }
    }
}

const NAMES: [&str; 5] = ["x", "y", "z", "r", "pi"];

fn trees() -> impl Strategy<Value = Tree> {
    let number =
        prop_oneof![(0u8..5).prop_map(f64::from), 0.0..1e3, (0.0f64..300.0).prop_map(|n| libm::pow(10.0, n))];
    let leaf =
        prop_oneof![number.prop_map(Tree::Number), prop::sample::select(&NAMES[..]).prop_map(Tree::Name)];
    let function = |inner: BoxedStrategy<Tree>| {
        let all: Vec<&Function> =
            FUNCTIONS.iter().filter(|f| f.name != "uniform" && f.name != "normal").collect();
        (prop::sample::select(all), prop::collection::vec(inner, 5), 0usize..3).prop_map(
            |(function, mut values, more)| {
                let most = function.parameters.len() + if function.is_open { more } else { 0 };
                values.truncate(most);
                Tree::Call(function.name, values)
            },
        )
    };
    leaf.prop_recursive(6, 60, 5, move |inner| {
        let inner = inner.boxed();
        // Arithmetic operators are drawn more often, because most formulas and most instructions are arithmetic.
        let operator =
            prop_oneof![prop::sample::select(&OPERATORS[..]), prop::sample::select(&OPERATORS[8..12])];
        prop_oneof![
            inner.clone().prop_map(|tree| Tree::Sign(Box::new(tree))),
            inner.clone().prop_map(|tree| Tree::Not(Box::new(tree))),
            (operator.clone(), inner.clone(), inner.clone())
                .prop_map(|((op, _), a, b)| Tree::Two(op, Box::new([a, b]))),
            (operator, inner.clone(), inner.clone())
                .prop_map(|((op, _), a, b)| Tree::Two(op, Box::new([a, b]))),
            function(inner),
        ]
    })
}

/// Returns the bits of a number. All NaNs get the same bits, so that they compare as equal.
fn bits(value: f64) -> u64 {
    if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_printed_is_read_as_the_same(tree in trees()) {
        let formula = Formula::parse(&tree.print()).map_err(|e| TestCaseError::fail(format!("{}: {e:?}", tree.print())))?;
        prop_assert_eq!(Tree::of(&formula, formula.nodes.len() - 1), tree);
    }

    #[test]
    fn a_program_gives_the_bits_that_the_tree_gives(tree in trees(), inputs in prop::array::uniform3(-10.0..10.0f64)) {
        let resolved = Formula::parse(&tree.print()).unwrap().resolve(&scope()).unwrap();
        let expected = tree.value(&inputs);
        let strict = resolved.value(&inputs);
        let program = resolved.compile().unwrap();
        prop_assert_eq!(bits(program.eval(&inputs)), bits(expected), "{} {:?}", tree.print(), program);
        match strict {
            Ok(value) => prop_assert_eq!(value.to_bits(), expected.to_bits()),
            // The strict evaluation fails if any step is not finite, even if the result is.
            Err(error) => {
                prop_assert!(error.range.end <= tree.print().len());
                prop_assert!(matches!(error.code, Code::NotFinite | Code::DivisionByZero));
            }
        }
        prop_assert_eq!(program.explain_non_finite(&inputs).is_none(), expected.is_finite());
    }

    #[test]
    fn numbers_as_inputs_give_the_bits_of_numbers_in_a_program(tree in trees(), inputs in prop::array::uniform3(-10.0..10.0f64)) {
        let resolved = Formula::parse(&tree.print()).unwrap().resolve(&scope()).unwrap();
        let mut constants = Constants::default();
        let lifted = resolved.lifted(&mut constants);
        let all: Vec<f64> = inputs.into_iter().chain(constants.into_values()).collect();
        let (program, lifted) = (resolved.compile().unwrap(), lifted.compile().unwrap());
        prop_assert_eq!(bits(lifted.eval(&all)), bits(program.eval(&inputs)), "{} {:?}", tree.print(), lifted);
        prop_assert_eq!(bits(lifted.resolved().code().unwrap().eval(all[0], &all[1..])), bits(program.eval(&inputs)));
        prop_assert_eq!(lifted.explain_non_finite(&all), program.explain_non_finite(&inputs));
    }

    #[test]
    fn every_lane_of_a_wide_program_gives_the_bits_of_a_program(
        trees in prop::array::uniform2(trees()),
        inputs in prop::collection::vec(prop::array::uniform3(-10.0..10.0f64), 1..=MAX_LANES)
    ) {
        let formulas = trees.map(|tree| Formula::parse(&tree.print()).unwrap().resolve(&scope()).unwrap());
        let wide = Wide::new(&formulas.each_ref());
        let programs = formulas.map(|formula| formula.compile().unwrap());
        let fill = |input: usize, column: &mut [f64]| {
            column.iter_mut().zip(&inputs).for_each(|(to, inputs)| *to = inputs[input]);
        };
        let mut found: Vec<[u64; 2]> = Vec::new();
        wide.run(inputs.len(), fill, |values: [_; 2]| {
            found = (0..inputs.len()).map(|lane| values.map(|value| bits(value.at(lane)))).collect();
        });
        for (inputs, found) in inputs.iter().zip(found) {
            let expected = programs.each_ref().map(|program| bits(program.eval(inputs)));
            prop_assert_eq!(found, expected, "{:?} {:?}", inputs, programs);
        }
    }

    #[test]
    fn no_text_stops_the_program(text in "\\PC{0,60}") {
        no_panic(&text)?;
    }

    #[test]
    fn no_mixture_of_words_stops_the_program(
        words in prop::collection::vec(prop::sample::select(&WORDS[..]), 0..40)
    ) {
        no_panic(&words.concat())?;
    }
}

const WORDS: [&str; 34] = [
    "x", "y", "r", "foo", "1", "2.5", "1e3", ".", "e", "(", ")", "(", ")", ",", "+", "-", "*", "/", "^", "%",
    "<", "==", " and ", " or ", " not ", " ", "sin(", "if(", "max(", "uniform(", "lerp(", "ö", "=", "|",
];

fn no_panic(text: &str) -> Result<(), TestCaseError> {
    match Program::compile(text, &scope()) {
        Ok(program) => {
            let inputs = vec![1.0; program.resolved().inputs()];
            let _ = (program.eval(&inputs), program.resolved().value(&inputs));
            prop_assert!(!text.trim().is_empty());
        }
        Err(errors) => {
            prop_assert!(!errors.is_empty());
            for error in errors {
                // `get` returns `None` for a range outside of the text or within a character.
                prop_assert!(text.get(error.range.clone()).is_some(), "{text}: {error:?}");
            }
        }
    }
    let _ = Program::compile(text, &Scope::default());
    Ok(())
}

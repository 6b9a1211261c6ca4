//! Tests of the language of formulas.

mod derivatives;
mod errors;
mod properties;
mod values;

use super::{Formula, Program, Scope};

/// Returns a scope with the inputs x, y and z, two constants, and random numbers allowed.
fn scope() -> Scope {
    let mut scope = Scope::default().with_draws();
    ["x", "y", "z"].into_iter().for_each(|name| _ = scope.slot(name));
    scope.constant("r", 2.5);
    scope.constant("zero", 0.0);
    scope
}

/// Evaluates a formula at x = 3, y = -2, z = 0.5 with a program and by walking the tree, and checks that both give the same bits.
fn value(text: &str) -> f64 {
    let inputs = [3.0, -2.0, 0.5, 0.25, 0.75];
    let resolved = Formula::parse(text).unwrap().resolve(&scope()).unwrap();
    let strict = resolved.value(&inputs).unwrap();
    let program = resolved.compile().unwrap();
    assert_eq!(program.eval(&inputs).to_bits(), strict.to_bits(), "{text}: {program:?}");
    assert_eq!(program.explain_non_finite(&inputs), None);
    strict
}

/// Formats the errors of a formula that does not compile, or whose value at x = 3, y = -2, z = 0.5 is not finite. Each error becomes the
/// marked text, the code, the message, and the label or the help.
fn said(text: &str) -> Vec<String> {
    let errors = match Program::compile(text, &scope()) {
        Err(errors) => errors,
        Ok(program) => match program.resolved().value(&[3.0, -2.0, 0.5]) {
            Ok(value) => panic!("{text} is {value}"),
            Err(error) => vec![error],
        },
    };
    let in_one = |error: super::ExpressionError| {
        let more = if error.label.is_empty() { error.help.unwrap_or_default() } else { error.label };
        format!("«{}» {}: {} | {more}", &text[error.range], error.code, error.message)
    };
    errors.into_iter().map(in_one).collect()
}

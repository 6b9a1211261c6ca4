//! Checks the messages for wrong formulas, and the positions of the errors in the text.

use super::super::{Formula, MAX_LENGTH, Program, Scope};
use super::said;
use crate::diagnostic::Code;

#[test]
fn a_mistake_is_shown_at_its_place() {
    for (text, expected) in [
        ("", "«» formula-syntax: the formula is empty | expected a number"),
        ("1 +", "«+» formula-syntax: the formula ends where a value should follow | "),
        ("2*(x + 1", "«(» formula-syntax: this parenthesis is not closed | "),
        ("sin(x", "«(» formula-syntax: this parenthesis is not closed | "),
        ("x + 1)", "«)» formula-syntax: a parenthesis is closed that has not been opened | "),
        ("x * / 2", "«/» formula-syntax: `/` stands where a value should | "),
        ("()", "«)» formula-syntax: `)` stands where a value should | "),
        ("2x", "«2x» formula-syntax: an operator is missing | write `2*x` to multiply"),
        ("2 (x + 1)", "«2 (» formula-syntax: an operator is missing | write `2*(` to multiply"),
        ("(x)(y)", "«)(» formula-syntax: an operator is missing | write `)*(` to multiply"),
        ("x y", "«x y» formula-syntax: an operator is missing | nothing stands between `x` and `y`"),
        ("sin x", "«sin» formula-syntax: the values of `sin` stand in parentheses | write `sin(x)`"),
        (
            "sin + 1",
            "«sin» formula-syntax: `sin` is a function, and its values stand in parentheses | write `sin(x)`",
        ),
        (
            "2 = x",
            "«=» formula-syntax: `=` is no part of a formula | write `==` to compare; a formula sets nothing",
        ),
        ("x ** 2", "«**» formula-syntax: `**` is no part of a formula | the power is written `^`"),
        ("2·π", "«·» formula-syntax: `·` is no part of a formula | write `*`"),
        (
            "größe",
            "«öße» formula-syntax: `öße` is no part of a formula | a name is made of the letters a to z",
        ),
        ("1.2.3", "«1.2.» formula-syntax: a number has one decimal point | "),
        ("1__0", "«1__0» formula-syntax: an underscore in a number stands between two digits | "),
        ("1e999", "«1e999» number-too-large: this number is too large | the largest number is about 1.8e308"),
        (
            "1,5",
            "«,» formula-syntax: a comma where the formula should end | a decimal point is a point: `1.5`; in a list, \
             every number has a string of its own",
        ),
        (
            "(1,5)",
            "«,» formula-syntax: a comma where no function has its values | a decimal point is a point: `1.5`",
        ),
        (
            "0 < x < 1",
            "«< x <» formula-syntax: comparisons do not follow each other | write `a < x and x < b` for «x is between a \
             and b»",
        ),
        (
            "2 * radus",
            "«radus» unknown-name: there is no variable `radus` | there are `r`, `x`, `y`, `z`, `zero`",
        ),
        ("2 * zeros", "«zeros» unknown-name: there is no variable `zeros` | did you mean `zero`?"),
        ("2 * w", "«w» unknown-name: there is no variable `w` | there are `r`, `x`, `y`, `z`, `zero`"),
        (
            "2 kg",
            "«2 kg» formula-syntax: an operator is missing | write `2*kg` to multiply; units are not written",
        ),
        ("2 * R", "«R» unknown-name: there is no variable `R` | did you mean `r`?"),
        ("t", "«t» unknown-name: there is no variable `t` | this number is set once, before the time begins"),
        ("sine(x)", "«sine» unknown-name: there is no function `sine` | did you mean `sin`?"),
        ("pow(x, 2)", "«pow» unknown-name: there is no function `pow` | write `x^y`"),
        ("x(2)", "«x» unknown-name: there is no function `x` | there are sin, "),
        ("atan2(x)", "«atan2(x)» wrong-count: `atan2` takes 2 values, found 1 | write `atan2(y, x)`"),
        ("max(x)", "«max(x)» wrong-count: `max` takes at least 2 values, found 1 | write `max(x, y, …)`"),
        ("sin()", "«sin()» wrong-count: `sin` takes 1 value, found none | write `sin(x)`"),
    ] {
        let said = said(text);
        assert!(said.len() == 1 && said[0].starts_with(expected), "{text}: {said:#?}");
    }
}

#[test]
fn several_unknown_names_are_told_at_once() {
    assert_eq!(said("a*b + c").len(), 3);
    assert_eq!(said("foo(1) + bar(2) + sin()").len(), 3);
}

#[test]
fn what_leaves_the_numbers_is_found() {
    for (text, expected) in [
        ("1/(x - 3)", "«(x - 3)» division-by-zero: a division by zero | this is 0"),
        ("x % zero", "«zero» division-by-zero: the rest of a division by zero | this is 0"),
        (
            "(x - 3)^-1",
            "«(x - 3)» division-by-zero: a negative power of zero is a division by zero | this is 0",
        ),
        ("min(1/zero, 5)", "«zero» division-by-zero: a division by zero | this is 0"),
        ("1 + sqrt(y)", "«sqrt(y)» not-finite: the square root of -2 is not a number | "),
        ("ln(y)", "«ln(y)» not-finite: the logarithm of -2 is not a number | "),
        ("ln(zero)", "«ln(zero)» not-finite: the logarithm of 0 is not a number | "),
        ("asin(x)", "«asin(x)» not-finite: no angle has the sine 3 | "),
        ("2*exp(1000)", "«exp(1000)» not-finite: exp(1000) is larger than any number | "),
        ("1e300*1e300", "«1e300*1e300» not-finite: 1e300 * 1e300 is larger than any number | "),
        ("y^0.5", "«y^0.5» not-finite: (-2)^0.5 is not a number | a negative number has only whole powers"),
        ("(x*1e200)^2", "«(x*1e200)^2» not-finite: 3e200^2 is larger than any number | "),
        ("smoothstep(1, 1, 1)", "«1» division-by-zero: the bounds of `smoothstep` are the same number | "),
        ("if(x > 0, 1/zero, 1)", "«zero» division-by-zero: a division by zero | this is 0"),
    ] {
        assert_eq!(said(text), [expected], "{text}");
    }
}

#[test]
fn a_program_explains_only_what_is_not_finite() {
    let mut scope = Scope::default();
    scope.slot("x");
    let program = Program::compile("1 + 1/x", &scope).unwrap();
    assert_eq!(program.explain_non_finite(&[1.0]), None);
    assert_eq!(program.explain_non_finite(&[0.0]).unwrap().range, 6..7);
    assert_eq!(program.explain_non_finite(&[f64::NAN]).unwrap().message, "this is not a number");
}

#[test]
fn what_is_too_long_or_too_deep_is_refused() {
    for text in ["(", "-", "sin(", "2^", "not ", "1+(", "if(1,"] {
        let deep = text.repeat(MAX_LENGTH / text.len());
        assert_eq!(Formula::parse(&deep).unwrap_err()[0].code, Code::FormulaSyntax, "{text}");
    }
    let long = "1+".repeat(MAX_LENGTH);
    assert!(Formula::parse(&long).unwrap_err()[0].message.contains("10000 characters"));
}

#[test]
fn names_are_free_unless_formulas_know_them() {
    for name in ["r", "_a1", "Radius", "x", "i"] {
        assert_eq!(Scope::is_free(name), Ok(()), "{name}");
    }
    for name in ["", "1a", "a-b", "é", "sin", "pi", "e", "and", "t", "if", "a b"] {
        assert!(Scope::is_free(name).is_err(), "{name}");
    }
}

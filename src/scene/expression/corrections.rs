//! Recognizes symbols and functions of other languages in formulas, and suggests their equivalents.

use super::error::{ExpressionError, syntax};

/// Returns the error for a symbol that formulas must not contain. `rest` is the text from the symbol on; `start` is the symbol's byte
/// offset in the formula.
pub(super) fn symbol(rest: &str, start: usize) -> ExpressionError {
    /// Each symbol of other languages, with the help text for it.
    const SYMBOL_HELP: [(&str, &str); 23] = [
        ("**", "the power is written `^`"),
        ("<>", "write `!=` for «is not»"),
        ("&&", "write `and`"),
        ("&", "write `and`"),
        ("||", "write `or`"),
        ("|", "the absolute value is written `abs(x)`, and «or» `or`"),
        ("!", "write `not`"),
        ("=", "write `==` to compare; a formula sets nothing"),
        ("?", "a choice is written `if(condition, then, otherwise)`"),
        (":", "a choice is written `if(condition, then, otherwise)`"),
        ("[", "write parentheses; a list is written outside of formulas"),
        ("{", "write parentheses"),
        (";", "write `,` between the values of a function"),
        ("²", "write `^2`"),
        ("³", "write `^3`"),
        ("√", "write `sqrt(x)`"),
        ("π", "write `pi`"),
        ("τ", "write `tau`"),
        ("−", "write the minus of the keyboard, `-`"),
        ("–", "write the minus of the keyboard, `-`"),
        ("×", "write `*`"),
        ("·", "write `*`"),
        ("÷", "write `/`"),
    ];
    /// Each symbol that a fix can replace, with its replacement.
    const SYMBOL_REPLACEMENTS: [(&str, &str); 15] = [
        ("**", "^"),
        ("<>", "!="),
        ("&&", " and "),
        ("||", " or "),
        ("=", "=="),
        (";", ","),
        ("²", "^2"),
        ("³", "^3"),
        ("π", "pi"),
        ("τ", "tau"),
        ("−", "-"),
        ("–", "-"),
        ("×", "*"),
        ("·", "*"),
        ("÷", "/"),
    ];
    if let Some((symbol, help)) = SYMBOL_HELP.iter().find(|(symbol, _)| rest.starts_with(symbol)) {
        let range = start..start + symbol.len();
        let error = syntax(range, format!("`{symbol}` is no part of a formula")).label(*help);
        return match SYMBOL_REPLACEMENTS.iter().find(|(replaced, _)| replaced == symbol) {
            Some((_, by)) => error.fix(*by),
            None => error,
        };
    }
    if let Some(name) = rest.strip_prefix('$') {
        let name = name.trim_start_matches('{');
        let length = name.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(name.len());
        let end = rest.len() - name.len() + length;
        let end = end + usize::from(rest.starts_with("${") && rest[end..].starts_with('}'));
        if length > 0 {
            let error = syntax(start..start + end, "`$` is no part of a formula");
            return error.label(format!("write `{}`", &name[..length])).fix(&name[..length]);
        }
    }
    // A word in another alphabet is one mistake, not one mistake per letter.
    let first = rest.chars().next().map_or(0, char::len_utf8);
    let letters: usize = rest.chars().take_while(|c| c.is_alphanumeric()).map(char::len_utf8).sum();
    let word = &rest[..letters.max(first)];
    let error =
        syntax(start..start + word.len(), format!("`{}` is no part of a formula", word.escape_debug()));
    if letters > 0 { error.label("a name is made of the letters a to z, digits and `_`") } else { error }
}

/// Returns the error for a degree sign at the byte offset `at`. The range of the error includes the number before the sign.
pub(super) fn degrees(text: &str, at: usize) -> ExpressionError {
    let before = text[..at].trim_end();
    let number = before.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
    let (begin, end) = (number.len(), at + '°'.len_utf8());
    let error = |range| syntax(range, "`°` is no part of a formula");
    match &before[begin..] {
        "" => error(at..end).label("write `rad(90)` for 90 degrees in radians"),
        angle => error(begin..end).label("the functions take radians").fix(format!("rad({angle})")),
    }
}

/// Returns advice on how to write a function that other languages know by this name.
pub(super) fn function(name: &str) -> Option<&'static str> {
    /// Each function of other languages, with the help text for it.
    const FUNCTION_HELP: [(&str, &str); 22] = [
        ("log", "write `ln` for the natural logarithm, `log10` or `log2`"),
        ("pow", "write `x^y`"),
        ("power", "write `x^y`"),
        ("sqr", "write `x^2`"),
        ("fabs", "write `abs`"),
        ("arcsin", "write `asin`"),
        ("arccos", "write `acos`"),
        ("arctan", "write `atan`"),
        ("arctan2", "write `atan2`"),
        ("sgn", "write `sign`"),
        ("int", "write `trunc` or `floor`"),
        ("fmod", "write `mod`"),
        ("ceiling", "write `ceil`"),
        ("radians", "write `rad`"),
        ("degrees", "write `deg`"),
        ("rand", "write `uniform(0, 1)`"),
        ("random", "write `uniform(0, 1)`"),
        ("rnd", "write `uniform(0, 1)`"),
        ("gauss", "write `normal(mean, deviation)`"),
        ("randn", "write `normal(0, 1)`"),
        ("length", "write `hypot`"),
        ("norm", "write `hypot`"),
    ];
    FUNCTION_HELP.iter().find(|(other, _)| *other == name).map(|(_, help)| *help)
}

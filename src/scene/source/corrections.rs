//! Recognizes notations of other languages, such as `(1, 2, 3)` or `0,5`, and rewrites them as TOML.

use std::ops::Range;

use super::toml::parse_value;
use crate::diagnostic::Sources;
use crate::scene::expression::Formula;
use crate::scene::grammar::{Kind, Rule, SCENE, TableSpec, unit_of_key};
use crate::scene::units;

/// The correction of a part of a line: its byte range in the line, the new text, and the explanation for the user.
pub(super) struct Correction {
    pub(super) range: Range<usize>,
    pub(super) text: String,
    pub(super) why: &'static str,
}

/// A corrected value as TOML, and the explanation for the user.
type CorrectedValue = (String, &'static str);

// The rules of syntax that explain corrections to the user.
const UNIT_RULE: &str = "numbers stand without units; the page of keys says what each is in";
const LIST_RULE: &str = "a list stands in square brackets, with commas between its values";
const DECIMAL_POINT_RULE: &str = "a decimal point is a point, with a digit on either side: `0.5`";
const QUOTES_RULE: &str = "text and formulas stand in quotes";
const BOOLEAN_RULE: &str = "there are `true` and `false`";
const INLINE_TABLE_RULE: &str = "a table in braces is `{ key = value, key = value }`";
const ENTRY_RULE: &str = "a line is `key = value`, without a sign at its end; `#` begins a comment";
const HEADER_RULE: &str = "a dot stands between the parts of a header";
const NAME_RULE: &str = "a name is one word; a name with spaces stands in quotes";
const COMMENT_RULE: &str = "`#` begins a comment";
const PERCENT_RULE: &str = "a percentage is a number: 80 % is 0.8";

/// Corrects a line that is not valid TOML. `None` if the intended text is unclear.
pub(super) fn correct(line: &str) -> Option<Correction> {
    if let Some(correction) = comment(line) {
        return Some(correction);
    }
    let (content, comment) = split_comment(line);
    let trimmed = content.trim();
    if trimmed.starts_with('[') && trimmed.ends_with(']') && !trimmed.contains('=') {
        return header(content, trimmed);
    }
    let split =
        top_level(content, &['=']).first().copied().or(top_level(content, &[':']).first().copied())?;
    let key = content[..split].trim();
    if key.is_empty()
        || key.starts_with(['[', '{', '('])
        || parse_value(&format!("{{ {key} = 0 }}"), no_source()).is_err()
    {
        return None;
    }
    let mut raw = content[split + 1..].trim();
    // A hexadecimal color without quotes, such as `#ff0000`, looks like a comment.
    let color = line[content.len()..].trim();
    if raw.is_empty() && color.len() > 3 && color[1..].bytes().all(|byte| byte.is_ascii_hexdigit()) {
        raw = color;
    }
    let (text, why) = value(raw, key.rsplit('.').next().unwrap_or(key).trim_matches(['"', '\'', ' ']))?;
    let text = format!(
        "{key} = {text}{}",
        comment.filter(|_| raw != color).map_or(String::new(), |it| format!("  # {it}"))
    );
    let start = line.len() - line.trim_start().len();
    let end = line.trim_end().len();
    (text != line[start..end]).then_some(Correction { range: start..end, text, why })
}

fn header(content: &str, trimmed: &str) -> Option<Correction> {
    let inner = trimmed.trim_matches(['[', ']']);
    let words = |text: &'_ str| {
        let words = text.split(char::is_whitespace).map(|word| word.trim_matches('"').to_owned());
        words.filter(|word| !word.is_empty()).collect::<Vec<String>>()
    };
    let mut parts: Vec<String> = Vec::new();
    let mut has_spaces = false;
    for part in inner.split([':', '/', '.']) {
        let mut words = words(part);
        // In `[body my ball]`, the first word is the key of a collection, and the others are the name.
        if parts.is_empty() && words.len() > 1 {
            parts.push(words.remove(0));
        }
        // In `[force.left spring]`, the last word is the kind.
        let kinds = parts.first().and_then(|first| match SCENE.key(first)?.kind {
            Kind::Named(spec) => Some(spec),
            _ => None,
        });
        let is_last = parts.len() + words.len() > 2;
        let kind = words.pop_if(|last| is_last && kinds.is_some_and(|kinds| is_kind(last, kinds)));
        has_spaces |= words.len() > 1;
        if !words.is_empty() {
            parts.push(words.join("_"));
        }
        parts.extend(kind);
    }
    let is_bare =
        |part: &String| part.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-'));
    let text = format!("[{}]", parts.join("."));
    let start = content.len() - content.trim_start().len();
    (!parts.is_empty() && parts.iter().all(is_bare) && text != trimmed).then(|| Correction {
        range: start..start + trimmed.len(),
        text,
        why: if has_spaces { NAME_RULE } else { HEADER_RULE },
    })
}

/// Returns whether a word is a kind of the tables of a collection, such as `spring` of forces.
fn is_kind(word: &str, spec: &TableSpec) -> bool {
    matches!(&spec.rule, Rule::ExactlyOne(kinds) if kinds.contains(&word))
}

/// Corrects a line that is a comment of another language, such as `// ball` or `/* ball */`.
fn comment(line: &str) -> Option<Correction> {
    let trimmed = line.trim();
    let words = ["//", "/*", "--", "%", ";"].iter().find_map(|sign| trimmed.strip_prefix(sign))?;
    let words = words.trim_start_matches(['/', '*', '-', '%', ';']).trim_end_matches("*/").trim();
    let start = line.len() - line.trim_start().len();
    Some(Correction {
        range: start..start + trimmed.len(),
        text: format!("# {words}").trim_end().to_owned(),
        why: COMMENT_RULE,
    })
}

/// Rewrites a value as TOML. `key` is the last part of the value's dotted key; it determines the unit. `None` if the intended value is
/// unclear.
fn value(raw: &str, key: &str) -> Option<CorrectedValue> {
    let is_toml = |text: &str| parse_value(text, no_source()).is_ok();
    let cut = raw.trim_end_matches([';', ',']).trim_end();
    if cut.is_empty() {
        return None;
    }
    if is_toml(cut) {
        return Some((cut.to_owned(), ENTRY_RULE));
    }
    if let Some((number, unit)) = units::quantity(cut) {
        return Some((units::converted(number, unit, unit_of_key(key).unwrap_or(""))?, UNIT_RULE));
    }
    if let Some(number) = number(cut) {
        return Some((number, DECIMAL_POINT_RULE));
    }
    if let Some(number) = units::percentage(cut) {
        return Some((number, PERCENT_RULE));
    }
    match cut.to_ascii_lowercase().as_str() {
        "true" | "yes" | "on" => return Some(("true".to_owned(), BOOLEAN_RULE)),
        "false" | "no" | "off" => return Some(("false".to_owned(), BOOLEAN_RULE)),
        _ => {}
    }
    for (open, close) in [('[', ']'), ('(', ')'), ('<', '>'), ('{', '}')] {
        if let Some(inner) = cut.strip_prefix(open).and_then(|rest| rest.strip_suffix(close)) {
            let is_table = open == '{' && !top_level(inner, &['=', ':']).is_empty();
            let better = if is_table { table(inner) } else { list(inner, key) };
            // If the brackets and commas are right, the fault is in an item.
            let better = better.map(|(text, why)| match open {
                '[' if why == LIST_RULE => (text, why_of_item(inner, key).unwrap_or(why)),
                _ => (text, why),
            });
            // The result must be valid TOML: a formula such as `(1 + 2) * (3 + 4)` begins and ends like a list.
            if better.as_ref().is_some_and(|(text, _)| is_toml(text)) {
                return better;
            }
        }
    }
    let has_commas = !top_level(cut, &[',']).is_empty();
    if let Some(better) = has_commas.then(|| list(cut, key)).flatten().filter(|(text, _)| is_toml(text)) {
        return Some(better);
    }
    let plain = cut.replace(['“', '”', '„', '«', '»'], "\"").replace(['‘', '’'], "'");
    if plain != cut && is_toml(&plain) {
        return Some((plain, "quotes are those of the keyboard"));
    }
    let is_word = |text: &str| {
        let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | '/' | '#' | ' ');
        text.starts_with(|c: char| c.is_alphabetic() || matches!(c, '#' | '/')) && text.chars().all(is_part)
    };
    let is_formula = || Formula::parse(cut).is_ok();
    (!cut.contains(['"', '\\']) && (is_word(cut) || is_formula()))
        .then(|| (format!("\"{cut}\""), QUOTES_RULE))
}

/// Rewrites a number that is not valid TOML, such as `.5`, `5.`, `0,5` or `007`.
fn number(text: &str) -> Option<String> {
    let (sign, digits) = match text.strip_prefix('-') {
        Some(rest) => ("-", rest),
        None => ("", text.strip_prefix('+').unwrap_or(text)),
    };
    let (mantissa, exponent) = digits.split_once(['e', 'E']).map_or((digits, None), |(m, e)| (m, Some(e)));
    let (whole, part) =
        mantissa.split_once(['.', ',']).map_or((mantissa, None), |(whole, part)| (whole, Some(part)));
    let is_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    let exponent_is_good = exponent.is_none_or(|e| {
        let digits = e.trim_start_matches(['+', '-']);
        !digits.is_empty() && is_digits(digits)
    });
    if !is_digits(whole)
        || !part.is_none_or(is_digits)
        || !exponent_is_good
        || whole.len() + part.map_or(0, str::len) == 0
    {
        return None;
    }
    let whole = whole.trim_start_matches('0');
    let whole = if whole.is_empty() { "0" } else { whole };
    let part = part.map_or(String::new(), |part| format!(".{}", if part.is_empty() { "0" } else { part }));
    Some(format!("{sign}{whole}{part}{}", exponent.map_or(String::new(), |exponent| format!("e{exponent}"))))
}

/// Rewrites a list as TOML, whatever separates its items. `inner` is the text between the brackets.
pub(in crate::scene) fn list(inner: &str, key: &str) -> Option<CorrectedValue> {
    let split = |by: &[char]| {
        let mut items = Vec::new();
        let mut start = 0;
        for at in top_level(inner, by) {
            items.push(inner[start..at].trim());
            start = at + 1;
        }
        items.push(inner[start..].trim());
        items.retain(|item| !item.is_empty());
        items
    };
    let corrected = |items: Vec<&str>| items.iter().map(|item| value(item, key)).collect::<Option<Vec<_>>>();
    let decimal = |item: &&str| number(item).is_some();
    // In `0,5; 1,5` and `0,5, 1,5`, a comma before a space separates two values. Any other comma is a decimal comma.
    let spaced: Vec<&str> = inner.split(", ").map(str::trim).collect();
    let has_decimal_commas = spaced.len() > 1
        && spaced.iter().all(decimal)
        && spaced.iter().any(|item| item.trim_end_matches(',').contains(','));
    let (items, why) = if !top_level(inner, &[';']).is_empty() {
        (split(&[';']), LIST_RULE)
    } else if has_decimal_commas {
        (spaced, DECIMAL_POINT_RULE)
    } else if !top_level(inner, &[',']).is_empty() {
        (split(&[',']), LIST_RULE)
    } else {
        (split(&[' ', '\t']), LIST_RULE)
    };
    let items: Vec<String> = corrected(items)?.into_iter().map(|(text, _)| text).collect();
    Some((format!("[{}]", items.join(", ")), why))
}

/// Returns the explanation for the first item of a list that is not valid TOML. `None` if the items are not separated by commas.
fn why_of_item(inner: &str, key: &str) -> Option<&'static str> {
    let mut ends = top_level(inner, &[',']);
    ends.push(inner.len());
    let starts = std::iter::once(0).chain(ends.iter().map(|end| end + 1));
    let mut items = starts.zip(&ends).map(|(start, end)| inner[start..*end].trim());
    let wrong = items.find(|item| parse_value(item, no_source()).is_err())?;
    if wrong.is_empty() || wrong.contains(char::is_whitespace) {
        return None;
    }
    value(wrong, key).map(|(_, why)| why)
}

/// Returns the number of items of a list in square brackets. 0 for any other text.
pub(in crate::scene) fn items(list: &str) -> usize {
    list.strip_prefix('[')
        .and_then(|rest| rest.strip_suffix(']'))
        .map_or(0, |inner| top_level(inner, &[',']).len() + 1)
}

/// Rewrites an inline table as TOML. `inner` is the text between the braces, with `=` or `:` between keys and values.
fn table(inner: &str) -> Option<CorrectedValue> {
    let mut entries = Vec::new();
    let mut ends = top_level(inner, &[',']);
    ends.push(inner.len());
    let mut start = 0;
    for end in ends {
        let entry = inner[start..end].trim();
        start = (end + 1).min(inner.len());
        if entry.is_empty() {
            continue;
        }
        let at = *top_level(entry, &['=', ':']).first()?;
        let (key, raw) = (entry[..at].trim(), entry[at + 1..].trim());
        let (text, _) = value(raw, key.trim_matches(['"', '\'']))?;
        entries.push(format!("{key} = {text}"));
    }
    Some((format!("{{ {} }}", entries.join(", ")), INLINE_TABLE_RULE))
}

/// Returns the byte offsets of the characters `signs` that are outside of quotes and brackets.
pub(super) fn top_level(text: &str, signs: &[char]) -> Vec<usize> {
    let (mut depth, mut quote, mut found) = (0usize, None, Vec::new());
    for (at, c) in text.char_indices() {
        match (quote, c) {
            (Some(open), c) if c == open => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, c) if depth == 0 && signs.contains(&c) => found.push(at),
            (None, '(' | '[' | '{') => depth += 1,
            (None, ')' | ']' | '}') => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    found
}

/// Splits a line into its content and the text of its comment, if any. A comment begins with `#` or, as in other languages, with `//`.
fn split_comment(line: &str) -> (&str, Option<&str>) {
    let mut quote = None;
    for (at, c) in line.char_indices() {
        match (quote, c) {
            (Some(open), c) if c == open => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '#') => {
                return (&line[..at], Some(line[at + 1..].trim()).filter(|words| !words.is_empty()));
            }
            (None, '/') if line[at..].starts_with("//") => return (&line[..at], Some(line[at + 2..].trim())),
            (None, '/') if line[at..].starts_with("/*") => {
                return (&line[..at], Some(line[at + 2..].trim_end().trim_end_matches("*/").trim()));
            }
            _ => {}
        }
    }
    (line, None)
}

/// Returns a source id for text that is parsed only to test if it is valid TOML.
fn no_source() -> crate::diagnostic::SourceId {
    Sources::default().add("", "")
}

/// Rewrites a YAML scalar or list as TOML. `key` is the last part of the dotted key that has this value.
pub(super) fn scalar(raw: &str, key: &str) -> Option<String> {
    value(raw, key).map(|(text, _)| text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_other_languages_become_toml() {
        for (line, expected) in [
            ("duration = 5 s", "duration = 5"),
            ("radius = 20 cm   # small", "radius = 0.2  # small"),
            ("angular_velocity = 180 deg", "angular_velocity = 3.14159265359"),
            ("location = (1,2,3)", "location = [1, 2, 3]"),
            ("location = <1, .5, -3>;", "location = [1, 0.5, -3]"),
            ("location = 1, 2, 3", "location = [1, 2, 3]"),
            ("location = [1 2 3]", "location = [1, 2, 3]"),
            ("location = {1, 2, 3}", "location = [1, 2, 3]"),
            ("location = [0,5; 1,5; 0]", "location = [0.5, 1.5, 0]"),
            ("radius = 0,5", "radius = 0.5"),
            ("radius = .5", "radius = 0.5"),
            ("radius = 1/3", "radius = \"1/3\""),
            ("fixed = True", "fixed = true"),
            ("integrator = rk4", "integrator = \"rk4\""),
            ("color = #ff0000", "color = \"#ff0000\""),
            ("title = “Fall”", "title = \"Fall\""),
            ("step: 0.01", "step = 0.01"),
            ("step = 0.01;", "step = 0.01"),
            ("step = 0.01 // fine", "step = 0.01  # fine"),
            ("shape.sphere = { radius: 1 }", "shape.sphere = { radius = 1 }"),
            ("[body ball]", "[body.ball]"),
            ("[body: ball]", "[body.ball]"),
            ("[body.my ball]", "[body.my_ball]"),
            ("[body my ball]", "[body.my_ball]"),
            ("[force.left spring]", "[force.left.spring]"),
            ("[force.left hand spring]", "[force.left_hand.spring]"),
            ("[joint door hinge]", "[joint.door.hinge]"),
            ("// a ball", "# a ball"),
            ("  /* a ball */", "  # a ball"),
            ("; a ball", "# a ball"),
            ("mass = 2 /* kg */", "mass = 2  # kg"),
            ("restitution = 80%", "restitution = 0.8"),
            ("velocity = [v0, 0, 0]", "velocity = [\"v0\", 0, 0]"),
        ] {
            let corrected = correct(line).map(|corrected| {
                let mut text = line.to_owned();
                text.replace_range(corrected.range, &corrected.text);
                text
            });
            assert_eq!(corrected.as_deref(), Some(expected), "{line}");
        }
    }

    #[test]
    fn what_is_toml_or_cannot_be_told_stays() {
        for line in ["a = 1", "a = [1, 2]", "[body.ball]", "# a: b", "a = \"b", "= 3", "a b c", "", "a = [1,"]
        {
            assert!(correct(line).is_none(), "{line}: {:?}", correct(line).map(|corrected| corrected.text));
        }
    }
}

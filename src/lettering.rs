//! Texts with subscripts, superscripts and bold letters.
//!
//! A scene writes `v_0`, `x_{max}` and `m/s^2`. Raised digits and signs become the letters that Unicode has for them: `m/s²`. The lowered digits
//! of the font hardly stand below the line, so a zero would look like the letter o, and the font has few such letters for words, with uneven
//! gaps. So other scripts are set in smaller letters that are lowered or raised. A *set text* is a text in which control characters
//! mark these letters, and those that are bold. No text of a scene can contain control characters.

use std::ops::Range;

use crate::font::{Font, Typeface, Weight};

/// The mark before lowered letters.
const LOWER_MARK: char = '\u{11}';
/// The mark before raised letters.
const RAISE_MARK: char = '\u{12}';
/// The mark after lowered or raised letters.
const END_MARK: char = '\u{13}';
/// The mark before bold letters. A bold stretch never contains a space of a scene's text, so that a text can be broken at any space.
const BOLD_MARK: char = '\u{14}';
/// The mark after bold letters.
const END_OF_BOLD_MARK: char = '\u{15}';
/// All marks.
const MARKS: [char; 5] = [LOWER_MARK, RAISE_MARK, END_MARK, BOLD_MARK, END_OF_BOLD_MARK];

/// The size of lowered and raised letters, relative to the other letters.
pub const SCRIPT_SIZE: f64 = 0.68;

/// The position of letters relative to the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// The letters are on the line.
    Line,
    /// The letters are a subscript.
    Lower,
    /// The letters are a superscript.
    Upper,
}

impl Level {
    /// The size of the letters, relative to those on the line.
    pub fn size(self) -> f64 {
        if self == Level::Line { 1.0 } else { SCRIPT_SIZE }
    }

    /// The height of the letters above the line, relative to the size of letters on the line.
    pub fn rise(self) -> f64 {
        match self {
            Level::Line => 0.0,
            Level::Lower => -0.14,
            Level::Upper => 0.33,
        }
    }
}

/// Letters of a set text that stand at the same level and have the same weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run<'a> {
    /// The level of the letters.
    pub level: Level,
    /// The weight of the letters.
    pub weight: Weight,
    /// The letters.
    pub letters: &'a str,
}

/// Splits a set text into runs of letters at the same level and with the same weight. There are no empty runs.
pub fn runs(text: &str) -> impl Iterator<Item = Run<'_>> {
    let (mut level, mut weight) = (Level::Line, Weight::Regular);
    text.split_inclusive(MARKS).filter_map(move |part| {
        let letters = part.trim_end_matches(MARKS);
        let run = Run { level, weight, letters };
        match part[letters.len()..].chars().next() {
            Some(LOWER_MARK) => level = Level::Lower,
            Some(RAISE_MARK) => level = Level::Upper,
            Some(END_MARK) => level = Level::Line,
            Some(BOLD_MARK) => weight = Weight::Bold,
            Some(END_OF_BOLD_MARK) => weight = Weight::Regular,
            Some(_) | None => {}
        }
        (!letters.is_empty()).then_some(run)
    })
}

/// Returns whether a set text has bold letters.
pub fn has_bold(text: &str) -> bool {
    runs(text).any(|run| run.weight == Weight::Bold)
}

/// Returns a set text without the marks at its ends.
pub fn without_marks(text: &str) -> &str {
    text.trim_matches(MARKS)
}

/// Returns a set text for people who read it as plain text, such as `x_0` or `m^-1`.
pub fn plain(text: &str) -> String {
    let mut plain = String::new();
    for run in runs(text) {
        match run.level {
            Level::Line => {}
            Level::Lower => plain.push('_'),
            Level::Upper => plain.push('^'),
        }
        plain.push_str(run.letters);
    }
    plain
}

/// Returns the width of a set text in a typeface, relative to the size of the font: that of its longest line.
pub fn width(text: &str, typeface: &Typeface) -> f64 {
    let wide = |run: Run<'_>| run.level.size() * typeface.font(run.weight).width(run.letters);
    let line = |line: &str| runs(line).map(wide).sum();
    text.split('\n').map(line).fold(0.0, f64::max)
}

/// Returns the bytes of the spaces and line breaks in a set text, except of those in subscripts and superscripts.
pub fn spaces(text: &str) -> impl Iterator<Item = usize> {
    let mut is_on_line = true;
    text.char_indices().filter_map(move |(at, letter)| {
        match letter {
            LOWER_MARK | RAISE_MARK => is_on_line = false,
            END_MARK => is_on_line = true,
            _ => {}
        }
        (is_on_line && matches!(letter, ' ' | '\n')).then_some(at)
    })
}

/// Returns a part of a set text that was cut at its end, with the marks that then miss.
pub fn closed(mut text: String) -> String {
    if text.rfind([LOWER_MARK, RAISE_MARK]) > text.rfind(END_MARK) {
        text.push(END_MARK);
    }
    if text.rfind(BOLD_MARK) > text.rfind(END_OF_BOLD_MARK) {
        text.push(END_OF_BOLD_MARK);
    }
    text
}

/// A script without an end, or without letters: the range of its bytes in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadScript {
    /// The range from the sign `_` or `^` on.
    pub range: Range<usize>,
    /// True if there is no `}`, false if nothing stands before it.
    pub is_open: bool,
}

impl BadScript {
    fn moved(self, by: usize) -> BadScript {
        BadScript { range: self.range.start + by..self.range.end + by, ..self }
    }
}

/// Sets the subscripts, superscripts and bold letters of a byte range of a text. A value stands before each range except the first.
///
/// A script in braces stands anywhere. Without braces, `^` needs a letter, a digit or a closing bracket before it, and `_` a single letter,
/// so that `my_ball` and `x_1_2` stay as they are. `**` begins bold letters right before a word, and ends them right after one. `\_`, `\^` and
/// `\*` are the signs themselves.
///
/// `bold_from` is the byte of the text at which bold letters begin that have not ended, before and after the range: a value may stand between
/// two ranges.
///
/// # Errors
///
/// Returns all scripts in braces without an end or without letters.
pub fn set(text: &str, range: Range<usize>, bold_from: &mut Option<usize>) -> Result<String, Vec<BadScript>> {
    let (begin, text) = (range.start, &text[range]);
    let mut out = Out {
        text: String::with_capacity(text.len()),
        bold_from: *bold_from,
        is_marked: bold_from.is_some(),
    };
    let mut wrong = Vec::new();
    let mut at = 0;
    // Whether a subscript or superscript ended right before `at`.
    let mut after_script = begin > 0;
    while let Some(letter) = text[at..].chars().next() {
        let rest = &text[at + letter.len_utf8()..];
        if let Some(sign) =
            rest.chars().next().filter(|sign| letter == '\\' && matches!(sign, '_' | '^' | '*'))
        {
            out.push(sign);
            (at, after_script) = (at + 2, false);
            continue;
        }
        if let Some(length) = sign_of_bold(text, at, out.is_bold()) {
            out.bold_from = if out.is_bold() { None } else { Some(begin + at) };
            at += length;
            continue;
        }
        match script(text, at, after_script) {
            Some(Ok((inside, end))) => {
                out.push_script(letter == '^', inside);
                (at, after_script) = (end, true);
            }
            found => {
                wrong.extend(found.and_then(Result::err).map(|bad| bad.moved(begin)));
                out.push(letter);
                (at, after_script) = (at + letter.len_utf8(), false);
            }
        }
    }
    *bold_from = out.bold_from;
    if wrong.is_empty() { Ok(out.finish()) } else { Err(wrong) }
}

/// Returns the length of a sign `**` at a byte of a text, if it begins bold letters or, with `is_bold`, ends them. More than two stars are
/// stars.
fn sign_of_bold(text: &str, at: usize, is_bold: bool) -> Option<usize> {
    let [before, rest] = [&text[..at], text[at..].strip_prefix("**")?];
    let beside = if is_bold { before.chars().next_back() } else { rest.chars().next() };
    let is_of_two = !before.ends_with('*') && !rest.starts_with('*');
    (is_of_two && beside.is_none_or(|letter| !letter.is_whitespace())).then_some(2)
}

/// A set text that is being written.
struct Out {
    text: String,
    /// The byte at which bold letters begin. `None` for regular letters.
    bold_from: Option<usize>,
    /// Whether the text ends inside of a mark for bold letters.
    is_marked: bool,
}

impl Out {
    /// Writes the mark that is needed before a letter: spaces are outside of marks.
    fn mark(&mut self, is_bold: bool) {
        if is_bold != self.is_marked {
            self.text.push(if is_bold { BOLD_MARK } else { END_OF_BOLD_MARK });
            self.is_marked = is_bold;
        }
    }

    fn push(&mut self, letter: char) {
        self.mark(self.is_bold() && !matches!(letter, ' ' | '\n'));
        self.text.push(letter);
    }

    fn is_bold(&self) -> bool {
        self.bold_from.is_some()
    }

    fn push_script(&mut self, is_raised: bool, inside: &str) {
        self.mark(self.is_bold());
        push(&mut self.text, is_raised, inside);
    }

    /// The text. If it ends in bold letters, a value behind it has them, too.
    fn finish(mut self) -> String {
        self.mark(self.is_bold());
        self.text
    }
}

/// True if a brace at this byte begins a script.
pub fn is_script(text: &str, brace: usize) -> bool {
    let before = &text[..brace];
    before.ends_with(['_', '^']) && !before[..before.len() - 1].ends_with('\\')
}

/// Returns the letters of the script whose sign is at the byte `at`, and the byte after the script. `None` if there is no script.
fn script(text: &str, at: usize, after_script: bool) -> Option<Result<(&str, usize), BadScript>> {
    let is_raised = text[at..].starts_with('^');
    if !is_raised && !text[at..].starts_with('_') {
        return None;
    }
    let rest = &text[at + 1..];
    if let Some(inside) = rest.strip_prefix('{') {
        let Some(length) = inside.find('}') else {
            return Some(Err(BadScript { range: at..at + 2, is_open: true }));
        };
        if inside[..length].trim().is_empty() {
            return Some(Err(BadScript { range: at..at + length + 3, is_open: false }));
        }
        return Some(Ok((&inside[..length], at + length + 3)));
    }
    let before = &text[..at];
    let has_base = match is_raised {
        true => {
            after_script || before.ends_with(|c: char| c.is_alphanumeric() || matches!(c, ')' | ']' | '°'))
        }
        false => after_script && at > 0 || is_base(before, &rest[..script_length(rest)]),
    };
    let length = if is_raised { raised_length(rest) } else { script_length(rest) };
    // A second `_` makes it a name, such as `a_b_c`.
    let is_name = !is_raised && rest[length..].strip_prefix('_').is_some_and(|next| word_length(next) > 0);
    (has_base && length > 0 && !is_name).then(|| Ok((&rest[..length], at + 1 + length)))
}

/// The length of the letters and digits at the start of a text, bytes.
fn word_length(text: &str) -> usize {
    text.find(|c: char| !c.is_alphanumeric()).unwrap_or(text.len())
}

/// The length of a script without braces at the start of a text, bytes: a number, a word, or a sign such as ∞.
fn script_length(text: &str) -> usize {
    match text.chars().next() {
        Some(first) if first.is_ascii_digit() => text.bytes().take_while(u8::is_ascii_digit).count(),
        Some(sign @ ('∞' | '∥' | '⊥' | '*')) => sign.len_utf8(),
        _ => word_length(text),
    }
}

/// The length of an exponent at the start of a text, bytes: a sign, and letters or a number.
fn raised_length(text: &str) -> usize {
    let digits = text.trim_start_matches(['+', '-', '−']);
    let sign = text.chars().next().filter(|_| digits.len() < text.len()).map_or(0, char::len_utf8);
    let word = script_length(&text[sign..]);
    let end = sign + word;
    let is_number = word > 0 && text[sign..end].bytes().all(|byte| byte.is_ascii_digit());
    match text[end..].strip_prefix('.').filter(|_| is_number) {
        Some(rest) => {
            let decimals = rest.bytes().take_while(u8::is_ascii_digit).count();
            if decimals > 0 { end + 1 + decimals } else { end }
        }
        None => end,
    }
}

/// True if a text ends with a letter that can have the subscript `script`. It is no part of a word: `v`, `2v` and `Δx` end so, and `my` and
/// `a_b` do not. Before a number or a single letter, it may also be the second factor of a product, as in `mv_0`.
fn is_base(text: &str, script: &str) -> bool {
    let is_greek = |c: char| matches!(c, '\u{370}'..='\u{3ff}' | '\u{1f00}'..='\u{1fff}');
    let Some(last) = text.chars().next_back().filter(|letter| letter.is_alphabetic()) else { return false };
    let before = &text[..text.len() - last.len_utf8()];
    let Some(letter) = before.chars().next_back().filter(|letter| letter.is_alphabetic()) else {
        return is_factor(before);
    };
    let is_short = script.chars().count() == 1 || script.bytes().all(|byte| byte.is_ascii_digit());
    is_greek(letter) != is_greek(last) || is_short && is_factor(&before[..before.len() - letter.len_utf8()])
}

/// True if a factor of a product can begin behind a text: behind a number that is no part of a name, and behind signs and spaces.
fn is_factor(text: &str) -> bool {
    let before = text.trim_end_matches(|c: char| c.is_ascii_digit());
    match before.chars().next_back() {
        Some('_') => before.len() < text.len() && is_base(&before[..before.len() - 1], &text[before.len()..]),
        Some(letter) => letter != '^' && !letter.is_alphabetic(),
        None => true,
    }
}

/// Appends a script to a set text.
fn push(out: &mut String, is_raised: bool, inside: &str) {
    let inside = with_minus(inside);
    let raised = |letter| if is_raised { superscript(letter) } else { None };
    let small: Option<String> = inside.chars().map(raised).collect();
    match small {
        Some(small) => out.push_str(&small),
        None => {
            out.push(if is_raised { RAISE_MARK } else { LOWER_MARK });
            out.push_str(&inside);
            out.push(END_MARK);
        }
    }
}

/// Replaces hyphens that are minus signs: those at the start and before digits.
fn with_minus(text: &str) -> String {
    let is_minus = |at: usize| at == 0 || text[at + 1..].starts_with(|next: char| next.is_ascii_digit());
    let letters = text.char_indices();
    letters.map(|(at, letter)| if letter == '-' && is_minus(at) { '−' } else { letter }).collect()
}

/// Digits and signs, and the letters of Unicode for them in superscripts.
const DIGITS_AND_SUPERSCRIPTS: [&str; 2] = ["0123456789+−=()", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁼⁽⁾"];

/// Returns the letter of Unicode for a digit or sign in a superscript.
fn superscript(letter: char) -> Option<char> {
    let number = DIGITS_AND_SUPERSCRIPTS[0].chars().position(|known| known == letter)?;
    DIGITS_AND_SUPERSCRIPTS[1].chars().nth(number)
}

/// Returns a set text with other letters for those that jabuka writes and a font does not have: raised digits for superscripts, and a hyphen
/// for a minus sign.
pub fn adapted(text: &str, font: &Font) -> String {
    let mut adapted = String::with_capacity(text.len());
    let mut is_raised = false;
    for letter in text.chars() {
        let is_missing = !MARKS.contains(&letter) && letter != '\n' && !font.has(letter);
        let digit =
            DIGITS_AND_SUPERSCRIPTS[1].chars().position(|known| known == letter).filter(|_| is_missing);
        let digit = digit.and_then(|number| DIGITS_AND_SUPERSCRIPTS[0].chars().nth(number));
        if digit.is_some() != is_raised {
            adapted.push(if is_raised { END_MARK } else { RAISE_MARK });
            is_raised = !is_raised;
        }
        let letter = digit.unwrap_or(letter);
        adapted.push(match letter {
            '−' if !font.has(letter) => '-',
            '·' if is_missing => '×',
            letter => letter,
        });
    }
    if is_raised {
        adapted.push(END_MARK);
    }
    adapted
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set_whole(text: &str) -> Result<String, Vec<BadScript>> {
        set(text, 0..text.len(), &mut None)
    }

    /// Sets a text, and shows the marks as `<`, `>` and `|`, and those of bold letters as `(` and `)`.
    fn shown(text: &str) -> String {
        let set = set_whole(text).unwrap_or_else(|wrong| panic!("{text}: {wrong:?}"));
        let shown = ["<", ">", "|", "(", ")"];
        MARKS.into_iter().zip(shown).fold(set, |set, (mark, shown)| set.replace(mark, shown))
    }

    #[test]
    fn raised_digits_are_letters_of_unicode() {
        for (text, expected) in [
            ("v_0", "v<0|"),
            ("x_12, ω_0", "x<12|, ω<0|"),
            ("10^{-6} m/s^2", "10⁻⁶ m/s²"),
            ("10^-6", "10⁻⁶"),
            ("x_0^2", "x<0|²"),
            ("(a+b)^2", "(a+b)²"),
            ("^{14}C, Na^+", "¹⁴C, Na⁺"),
            ("½mv_{0}^2", "½mv<0|²"),
            ("2v_0, Δx_0", "2v<0|, Δx<0|"),
        ] {
            assert_eq!(shown(text), expected, "{text}");
        }
    }

    #[test]
    fn other_scripts_are_lowered_and_raised_letters() {
        for (text, expected) in [
            ("x_{max} = 2", "x<max| = 2"),
            ("E_kin", "E<kin|"),
            ("e^x", "e>x|"),
            ("e^{-kt}", "e>−kt|"),
            ("x_{i-1}^{a-b}", "x<i−1|>a-b|"),
            ("v_x(t)", "v<x|(t)"),
            ("v_0t, H_2O, v^2t", "v<0|t, H<2|O, v²t"),
            ("p = mv_0, mg_x, 2x_1x_2", "p = mv<0|, mg<x|, 2x<1|x<2|"),
            ("v_∞, G_⊥", "v<∞|, G<⊥|"),
            ("10^1.5.", "10>1.5|."),
        ] {
            assert_eq!(shown(text), expected, "{text}");
        }
    }

    #[test]
    fn names_and_signs_alone_stay_as_they_are() {
        for text in [
            "my_ball",
            "ball_1",
            "ball_0",
            "part_1b_2",
            "a_b_c",
            "x_",
            "_0",
            "x _0",
            "a ^ b",
            "^_^",
            "1_000",
            "2^",
            "{t}",
            "k2v_0",
            "a\\b",
            "é_",
        ] {
            assert_eq!(shown(text), text);
        }
        assert_eq!(shown(r"v\_0 x\^2 v_0"), "v_0 x^2 v<0|");
        assert_eq!(set("1^2", 1..3, &mut None).unwrap(), "²", "a value stands before it");
    }

    #[test]
    fn two_stars_begin_and_end_bold_letters() {
        for (text, expected) in [
            ("**bold** and not", "(bold) and not"),
            ("**two words**, **E_{kin} = 2**", "(two) (words), (E<kin|) (=) (2)"),
            ("so**me**\n**a**", "so(me)\n(a)"),
            ("2 ** 3 * 4", "2 ** 3 * 4"),
            (r"\*\*no\*\*", "**no**"),
            ("*** stars ****", "*** stars ****"),
            ("**a ** b**", "(a) (**) (b)"),
        ] {
            assert_eq!(shown(text), expected, "{text}");
        }
        let (text, mut bold_from) = ("**v = 5 m/s**, **t", None);
        let pieces = [0..6, 7..18].map(|range| set(text, range, &mut bold_from).unwrap());
        let bold = |letters: &str| format!("\u{14}{letters}\u{15}");
        let expected = [bold("v"), bold("="), bold("5"), bold("m/s") + ",", "\u{14}t".to_owned()];
        assert_eq!(pieces.join("5"), expected.join(" "));
        assert_eq!(bold_from, Some(15), "these bold letters have no end");
    }

    #[test]
    fn a_script_without_an_end_is_a_mistake_at_its_place() {
        let wrong = |range, is_open| BadScript { range, is_open };
        assert_eq!(set_whole("é x_{max"), Err(vec![wrong(4..6, true)]));
        assert_eq!(set_whole("x_{} y^{ }"), Err(vec![wrong(1..4, false), wrong(6..10, false)]));
    }

    /// The font of the test has the letters of ASCII, `·` and `−` only.
    #[test]
    fn what_a_font_lacks_of_numbers_is_written_by_what_it_has() {
        let bytes = include_bytes!("../tests/keys/files/letters.ttf").to_vec();
        let own = Typeface::of_file("own.ttf".to_owned(), bytes).unwrap();
        let font = own.font(Weight::Regular);
        let text = set_whole("−7.5·10^{-6} m/s^2, v_0").unwrap();
        let marked = "−7.5·10\u{12}−6\u{13} m/s\u{12}2\u{13}, v\u{11}0\u{13}";
        assert_eq!(adapted(&text, font), marked);
        assert_eq!(adapted(&text, Typeface::usual().font(Weight::Regular)), text);
    }

    #[test]
    fn runs_are_as_wide_as_their_letters() {
        let text = set_whole("x_{max} and").unwrap();
        let split: Vec<Run<'_>> = runs(&text).collect();
        let run = |level, letters| Run { level, weight: Weight::Regular, letters };
        assert_eq!(split, [run(Level::Line, "x"), run(Level::Lower, "max"), run(Level::Line, " and")]);
        let usual = Typeface::usual();
        let [regular, bold] = [Weight::Regular, Weight::Bold].map(|weight| usual.font(weight));
        let expected = regular.width("x and") + SCRIPT_SIZE * regular.width("max");
        assert!((width(&text, usual) - expected).abs() < 1e-9);
        assert_eq!(closed(text[..4].to_owned()), "x\u{11}ma\u{13}");
        assert_eq!(closed("\u{14}bo".to_owned()), "\u{14}bo\u{15}");
        assert_eq!(plain("v\u{11}0\u{13} \u{14}m\u{12}-1\u{13}\u{15}"), "v_0 m^-1");
        assert_eq!(closed(text.clone()), text);
        let text = set_whole("**two** v_0").unwrap();
        let expected = bold.width("two") + regular.width(" v") + SCRIPT_SIZE * regular.width("0");
        assert!((width(&text, usual) - expected).abs() < 1e-9);
    }
}

//! Reads the labels, the scale bar and the grid of a scene from `[label.NAME]`, `[scale_bar]` and `[grid]`.

use std::ops::Range;

use super::measures::{OwnBody, Reader, Things};
use super::read::figure;
use super::showing::wanted;
use super::view::View;
use super::{Context, fonts};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::font::{Typeface, Weight};
use crate::lettering::{self, BadScript};
use crate::scene::grammar::labels::{grid, label, scale_bar};
use crate::scene::grammar::scene::scene;
use crate::scene::grammar::{Key, KeySpec, quoted};
use crate::scene::value;
use crate::scene::{
    Body, Corner, Format, Grid, GridPlane, Label, LabelPlace, Piece, ScaleBar, Side, Subject, Timeline,
};

/// The maximum length of a text in the picture, in bytes. POV-Ray limits the length of strings, and the values need room.
pub(super) const MAX_LENGTH: usize = 160;

pub(super) fn read(
    root: &View<'_>,
    things: Things<'_>,
    timeline: &Timeline,
    context: &mut Context<'_>,
) -> Vec<Label> {
    let read = |(name, _, view): (&str, Span, View<'_>)| {
        let visible = visible(name, &view, timeline, context);
        let place = place_of(&view, things.bodies, context);
        let own = match place {
            LabelPlace::Body { body, ghosts, .. } => Some(OwnBody { body: Subject::One(body), ghosts }),
            LabelPlace::Corner(_) | LabelPlace::Center => None,
        };
        let text = view.get(&label::TEXT).zip(view.span(&label::TEXT));
        let own_typeface = view.node(&label::FONT).and_then(|font| fonts::typeface(font, context));
        let typeface = own_typeface.as_deref().unwrap_or(Typeface::usual());
        let text = text.map(|text| {
            let mut reader = Reader::new("label", text, root, own, things, context);
            reader.typeface = typeface;
            pieces(reader)
        });
        Label {
            name: name.to_owned(),
            text: text.unwrap_or_default(),
            place,
            visible,
            size: view.get(&label::SIZE),
            color: view.get(&label::COLOR),
            own_typeface,
        }
    };
    root.named(&scene::LABEL).into_iter().map(read).collect()
}

/// Reads the times at which a label is visible.
fn visible(name: &str, view: &View<'_>, timeline: &Timeline, context: &mut Context<'_>) -> [f64; 2] {
    let (from, until) = (view.get(&label::FROM), view.get(&label::UNTIL));
    let spans = [(&label::UNTIL.spec, "this must be later"), (&label::FROM.spec, "than this")];
    if let (Some(from), Some(until)) = (from, until)
        && until <= from
    {
        let message =
            format!("the label `{name}` appears at {} s and disappears at {} s", figure(from), figure(until));
        let error = Diagnostic::error(Code::EndBeforeStart, message);
        let spans = spans.into_iter().filter_map(|(key, label)| Some((view.span(key)?, label)));
        context.diagnostics.push(spans.fold(error, |error, (span, label)| error.at(span, label)));
        return Label::ALWAYS;
    }
    let at = |time: f64| timeline.without_rounding(time);
    // The last frame keeps a label that stays as long as the scene.
    let until_end = until.map(at).filter(|until| *until < timeline.end());
    let visible = [from.map_or(f64::NEG_INFINITY, at), until_end.unwrap_or(f64::INFINITY)];
    let is_seen =
        timeline.first_frame_from(visible[0]).is_some_and(|first| timeline.time(first) < visible[1]);
    if let Some(span) = view.span(&label::FROM).or(view.span(&label::UNTIL)).filter(|_| !is_seen) {
        let warning = Diagnostic::warning(Code::NeverThere, format!("no frame shows the label `{name}`"));
        let between = match (from, until) {
            (Some(_), Some(_)) if visible[1] > 0.0 && visible[0] <= timeline.end() => {
                if timeline.speed.is_even() {
                    format!("the frames are {} s apart", figure(timeline.interval()))
                } else {
                    "no frame lies in this time, at the speed of the film".to_owned()
                }
            }
            _ => format!("the scene goes from 0 to {} s", figure(timeline.end())),
        };
        context.diagnostics.push(warning.at(span, between));
    }
    visible
}

pub(super) fn scale_bar(root: &View<'_>) -> Option<ScaleBar> {
    let bar = wanted(root, &scene::SCALE_BAR)?;
    Some(ScaleBar { length: bar.get(&scale_bar::LENGTH), corner: corner(&bar, &scale_bar::CORNER) })
}

pub(super) fn grid(root: &View<'_>) -> Option<Grid> {
    let grid = wanted(root, &scene::GRID)?;
    let plane = grid.choice(&grid::PLANE, GridPlane::ALL, GridPlane::name);
    Some(Grid { spacing: grid.get(&grid::SPACING), plane })
}

pub(super) fn corner(view: &View<'_>, key: &Key<value::Text>) -> Corner {
    view.choice(key, Corner::ALL, Corner::name)
}

fn place_of(view: &View<'_>, bodies: &[Body], context: &mut Context<'_>) -> LabelPlace {
    let body = view.get(&label::BODY).and_then(|name| context.names.bodies.get(name).copied());
    let mut useless = |key: &KeySpec, why: &str| {
        let warning = Diagnostic::warning(Code::NoEffect, format!("`{}` has no effect {why}", key.name));
        context.diagnostics.extend(view.key_span(key).map(|span| warning.at(span, "")));
    };
    let Some(body) = body else {
        if !view.has(&label::BODY) {
            useless(&label::SIDE.spec, "without `body`");
            useless(&label::GHOSTS.spec, "without `body`");
        }
        return match view.get(&label::CORNER) {
            Label::CENTER => LabelPlace::Center,
            _ => LabelPlace::Corner(corner(view, &label::CORNER)),
        };
    };
    let ghosts = view.get(&label::GHOSTS);
    if ghosts && bodies[body].showing.ghosts.is_none() {
        useless(&label::GHOSTS.spec, "where the body has none");
    }
    LabelPlace::Body { body, side: view.choice(&label::SIDE, Side::ALL, Side::name), ghosts }
}

/// Splits a text with values into words and values. Reports mistakes at their source positions.
pub(super) fn pieces(mut reader: Reader<'_, '_, '_>) -> Vec<Piece> {
    let text = reader.text;
    if text.len() > MAX_LENGTH {
        let message = format!("this label has {} bytes, and a label has at most {MAX_LENGTH}", text.len());
        let error = Diagnostic::error(Code::LabelSyntax, message);
        reader.report(error.help("write two labels, one below the other"), 0..0, "");
        return Vec::new();
    }
    let mut pieces = Vec::new();
    let mut at = 0;
    while let Some(begin) = text[at..].find("${").map(|found| at + found) {
        pieces.extend(reader.words(at..begin));
        let Some(length) = text[begin..].find('}') else {
            let error = Diagnostic::error(Code::LabelSyntax, "this value has no end");
            reader.report(error, begin..begin + 2, "needs a `}`");
            reader.finish();
            return pieces;
        };
        pieces.extend(reader.value(begin + 2..begin + length));
        at = begin + length + 1;
    }
    pieces.extend(reader.words(at..text.len()));
    reader.finish();
    pieces
}

/// A value in a label as another language writes it.
struct Other {
    range: Range<usize>,
    message: &'static str,
    /// The value as a label writes it.
    meant: String,
}

/// Finds values as other languages write them: `{t}` of Python, `$t` of a shell, and `%.2f` of C.
fn values_of_other_languages(words: &str) -> Vec<Other> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(begin) = words[at..].find(['{', '$', '%']).map(|found| at + found) {
        let rest = &words[begin..];
        at = begin + 1;
        let (length, message, meant) = if rest.starts_with('{') {
            if lettering::is_script(words, begin) {
                continue;
            }
            let Some(length) = rest.find('}').map(|end| end + 1) else { continue };
            (length, "text in braces is shown unchanged", format!("${}", &rest[..length]))
        } else if let Some(name) = rest.strip_prefix('$') {
            let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.');
            let name = &name[..name.find(|c| !is_part(c)).unwrap_or(name.len())];
            let name = name.trim_end_matches('.');
            if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
                continue;
            }
            (1 + name.len(), "a value without braces is shown unchanged", format!("${{{name}}}"))
        } else {
            let format =
                rest[1..].trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-'));
            let digits = &rest[1..rest.len() - format.len()];
            let is_alone = format.chars().nth(1).is_none_or(|next| !next.is_ascii_alphanumeric());
            let Some('d' | 'i' | 'f' | 'e' | 'g' | 's') = format.chars().next().filter(|_| is_alone) else {
                continue;
            };
            let decimals = digits.rsplit_once('.').map(|(_, decimals)| format!(":.{decimals}"));
            let message = "a format with `%` is shown unchanged";
            (digits.len() + 2, message, format!("${{t{}}}", decimals.unwrap_or_default()))
        };
        found.push(Other { range: begin..begin + length, message, meant });
        at = begin + length;
    }
    found
}

impl Reader<'_, '_, '_> {
    fn words(&mut self, range: Range<usize>) -> Option<Piece> {
        let words = &self.text[range.clone()];
        let mut begin = range.start;
        for line in words.split('\n') {
            self.note_letters(begin..begin + line.len());
            begin += line.len() + 1;
        }
        for Other { range: inner, message, meant } in values_of_other_languages(words) {
            let here = range.start + inner.start..range.start + inner.end;
            let at = self.at(&here);
            let warning = Diagnostic::warning(Code::LabelSyntax, message);
            let warning = warning.at(at, format!("did you mean `{meant}`?"));
            // In an escaped string, the span is the whole string, which the fix must not replace.
            let is_piece = at.len() == inner.len();
            self.context.diagnostics.push(if is_piece {
                warning.fix(at, meant).fix_is_said()
            } else {
                warning
            });
        }
        let set = self.set(range)?;
        (!set.is_empty()).then_some(Piece::Words(set))
    }

    /// Sets the subscripts, the superscripts and the bold letters in a byte range of the text. Reports scripts without an end.
    pub(super) fn set(&mut self, range: Range<usize>) -> Option<String> {
        let was_bold = self.bold_from.is_some();
        let set = lettering::set(self.text, range.clone(), &mut self.bold_from);
        let wrong = match set {
            Ok(set) => {
                // A value behind the range may be bold, too.
                if was_bold || self.bold_from.is_some() || lettering::has_bold(&set) {
                    self.note_bold(range);
                }
                return Some(set);
            }
            Err(wrong) => wrong,
        };
        for BadScript { range: inner, is_open } in wrong {
            let sign = &self.text[inner.start..][..1];
            let (message, label) = match is_open {
                true => ("this script has no end", format!("needs a `}}`; `\\{sign}` is the sign itself")),
                false => ("this script is empty", "needs letters in the braces".to_owned()),
            };
            let error = Diagnostic::error(Code::LabelSyntax, message);
            self.report(error, inner, &label);
        }
        None
    }

    /// Notes that a byte range of the text has bold letters. Warns if its font has none.
    fn note_bold(&mut self, range: Range<usize>) {
        if self.typeface.has_bold() {
            self.context.fonts.has_bold = true;
        } else if let Some(at) = self.text[range.clone()].find("**").map(|at| range.start + at) {
            let message = "the letters of the label's own `font` have one weight";
            let warning = Diagnostic::warning(Code::NoEffect, message);
            self.report(warning, at..at + 2, "these letters are not bold");
        }
    }

    /// Reports bold letters without an end, and all letters of the text that the font does not have.
    pub(super) fn finish(&mut self) {
        if let Some(from) = self.bold_from.take() {
            let error = Diagnostic::error(Code::LabelSyntax, "these bold letters have no end");
            self.report(error, from..from + 2, "needs another `**`; `\\*` is the sign itself");
        }
        self.report_missing();
    }

    /// Notes the letters of a byte range that the font does not have, for [`finish`](Self::finish).
    pub(super) fn note_letters(&mut self, range: Range<usize>) {
        let words = &self.text[range.clone()];
        let font = self.typeface.font(Weight::Regular);
        for (at, letter) in words.char_indices().filter(|(_, letter)| !font.has(*letter)) {
            if self.missing.iter().all(|(known, _)| *known != letter) {
                let here = range.start + at..range.start + at + letter.len_utf8();
                self.missing.push((letter, here));
            }
        }
    }

    /// Reports all letters of the text that the font does not have.
    fn report_missing(&mut self) {
        let missing = std::mem::take(&mut self.missing);
        let Some((_, first)) = missing.first() else { return };
        let letters: Vec<String> =
            missing.iter().map(|(letter, _)| letter.escape_debug().to_string()).collect();
        let letters: Vec<&str> = letters.iter().map(String::as_str).collect();
        let (noun, label) = match letters.len() {
            1 => ("letter", "it would be an empty box"),
            _ => ("letters", "each would be an empty box"),
        };
        let message = format!("the font has no {noun} {}", quoted(&letters));
        self.report(Diagnostic::error(Code::LabelLetter, message), first.clone(), label);
    }

    fn value(&mut self, range: Range<usize>) -> Option<Piece> {
        let inner = &self.text[range.clone()];
        let (formula, asked) =
            inner.rsplit_once(':').map_or((inner, None), |(formula, asked)| (formula, Some(asked)));
        let begin = range.start + formula.len() + 1;
        let (format, unit) = match asked.map(|asked| (format_of(asked), asked)) {
            None => (Format::Short, None),
            Some((Some((format, length)), asked)) => {
                let rest = asked[length..].trim_start();
                let unit = begin + asked.len() - rest.len()..begin + asked.trim_end().len();
                (format, (!unit.is_empty()).then_some(unit))
            }
            Some((None, _)) => {
                let message =
                    format!("`{}` is no format of a number, and no unit", &self.text[begin..range.end]);
                let label = "`.2` is two decimals, `.2e` has a power of ten, `km/h` is a unit";
                self.report(Diagnostic::error(Code::LabelSyntax, message), begin..range.end, label);
                return None;
            }
        };
        let mut formula = self.formula(range.start..range.start + formula.len())?;
        if let Some(unit) = unit {
            self.ask_unit(&mut formula, unit)?;
        }
        let format = match format {
            Format::Short if formula.is_count => Format::Decimals(0),
            format => format,
        };
        Some(Piece::Value { formula, format })
    }
}

/// Parses a number format at the beginning of a text, such as `.2` or `.2e`. Returns the format and its length. A text that begins with a
/// letter has no format: it is a unit. `None` for what is neither.
fn format_of(text: &str) -> Option<(Format, usize)> {
    let trimmed = text.trim_start();
    let before = text.len() - trimmed.len();
    if trimmed.starts_with(|c: char| c.is_alphabetic() || c == '°') {
        return Some((Format::Short, 0));
    }
    let rest = trimmed.strip_prefix('.')?;
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    let decimals = rest[..digits].parse::<usize>().ok().filter(|decimals| *decimals <= 12)?;
    let length = before + 1 + digits;
    let mut letters = rest[digits..].chars();
    let (first, second) = (letters.next(), letters.next());
    // In `.2eV`, the letter belongs to the unit.
    let is_alone = second.is_none_or(char::is_whitespace);
    match first {
        Some('e' | 'E') if is_alone => Some((Format::Scientific(decimals), length + 1)),
        Some('f') if is_alone => Some((Format::Decimals(decimals), length + 1)),
        None => Some((Format::Decimals(decimals), length)),
        Some(c) if c.is_whitespace() || c.is_alphabetic() || c == '°' => {
            Some((Format::Decimals(decimals), length))
        }
        Some(_) => None,
    }
}

#[cfg(test)]
mod tests;

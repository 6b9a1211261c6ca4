//! `[label.NAME]`, `[scale_bar]` and `[grid]`.

mod words;

use std::ops::Range;

use super::Context;
use super::showing::wanted;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::expand::place;
use crate::scene::expression::{ExpressionError, Formula, Scope};
use crate::scene::grammar::Collection;
use crate::scene::{
    Body, BodyMeasure, Corner, Format, Grid, GridPlane, Joint, JointMeasure, Label, LabelPlace, Measure,
    Piece, RunMeasure, ScaleBar, Side,
};

/// The longest text of a label, bytes: what POV-Ray's strings hold, less what values may need.
const MAX_LENGTH: usize = 160;

pub(super) fn read(
    root: &View<'_>,
    bodies: &[Body],
    joints: &[Joint],
    context: &mut Context<'_>,
) -> Vec<Label> {
    let read = |(name, _, view): (&str, Span, View<'_>)| {
        let place = place_of(&view, bodies, context);
        let text = view.text("text").zip(view.span("text"));
        let text = text.map(|(text, span)| pieces(text, span, root, place, (bodies, joints), context));
        Label {
            name: name.to_owned(),
            text: text.unwrap_or_default(),
            place,
            size: view.number("size"),
            color: view.color("color"),
        }
    };
    root.named("label").into_iter().map(read).collect()
}

pub(super) fn scale_bar(root: &View<'_>) -> Option<ScaleBar> {
    let bar = wanted(root, "scale_bar")?;
    Some(ScaleBar { length: bar.number("length"), corner: corner(&bar) })
}

pub(super) fn grid(root: &View<'_>) -> Option<Grid> {
    let grid = wanted(root, "grid")?;
    let plane = grid.choice("plane", GridPlane::ALL, GridPlane::name);
    Some(Grid { spacing: grid.number("spacing"), plane })
}

fn corner(view: &View<'_>) -> Corner {
    view.choice("corner", Corner::ALL, Corner::name)
}

fn place_of(view: &View<'_>, bodies: &[Body], context: &mut Context<'_>) -> LabelPlace {
    let body = view.text("body").and_then(|name| context.names.bodies.get(name).copied());
    let mut useless = |key: &str, why: &str| {
        let warning = Diagnostic::warning(Code::NoEffect, format!("`{key}` has no effect {why}"));
        context.diagnostics.extend(view.key_span(key).map(|span| warning.at(span, "")));
    };
    let Some(body) = body else {
        if !view.has("body") {
            useless("side", "without `body`");
            useless("ghosts", "without `body`");
        }
        return LabelPlace::Corner(corner(view));
    };
    let ghosts = view.boolean("ghosts") == Some(true);
    if ghosts && bodies[body].showing.ghosts.is_none() {
        useless("ghosts", "where the body has none");
    }
    LabelPlace::Body { body, side: view.choice("side", Side::ALL, Side::name), ghosts }
}

/// The pieces of a text. What is wrong with it is said at its place.
fn pieces(
    text: &str,
    span: Span,
    root: &View<'_>,
    place: LabelPlace,
    (bodies, joints): (&[Body], &[Joint]),
    context: &mut Context<'_>,
) -> Vec<Piece> {
    let mut reader = Reader { text, span, root, place, bodies, joints, context };
    if text.len() > MAX_LENGTH {
        let message = format!("a label has at most {MAX_LENGTH} bytes");
        reader.report(Diagnostic::error(Code::LabelSyntax, message), 0..0, "");
        return Vec::new();
    }
    let mut pieces = Vec::new();
    let mut at = 0;
    while let Some(begin) = text[at..].find("${").map(|found| at + found) {
        pieces.extend(reader.words(at..begin));
        let Some(length) = text[begin..].find('}') else {
            let error = Diagnostic::error(Code::LabelSyntax, "this value has no end");
            reader.report(error, begin..begin + 2, "needs a `}`");
            return pieces;
        };
        pieces.extend(reader.value(begin + 2..begin + length));
        at = begin + length + 1;
    }
    pieces.extend(reader.words(at..text.len()));
    pieces
}

struct Reader<'a, 'b, 'c> {
    text: &'a str,
    span: Span,
    root: &'a View<'b>,
    place: LabelPlace,
    bodies: &'a [Body],
    joints: &'a [Joint],
    context: &'a mut Context<'c>,
}

impl Reader<'_, '_, '_> {
    fn report(&mut self, error: Diagnostic, range: Range<usize>, label: &str) {
        let at = self.at(&range);
        self.context.diagnostics.push(error.at(at, label));
    }

    /// The place of a part of the text in the scene.
    fn at(&self, range: &Range<usize>) -> Span {
        let source = &self.context.sources.get(self.span.source).text;
        let raw = source.get(self.span.start..self.span.end).unwrap_or_default();
        place::in_string(raw, self.text, range, self.span)
    }

    fn words(&mut self, range: Range<usize>) -> Option<Piece> {
        let words = &self.text[range.clone()];
        if let Some((at, letter)) = words.char_indices().find(|(_, letter)| letter_of(*letter).is_none()) {
            let here = range.start + at..range.start + at + letter.len_utf8();
            let message = format!("POV-Ray's font has no letter `{}`", letter.escape_debug());
            self.report(Diagnostic::error(Code::LabelLetter, message), here, "it would be an empty box");
            return None;
        }
        if let Some((begin, length)) = words.find('{').and_then(|at| Some((at, words[at..].find('}')?))) {
            let here = range.start + begin..range.start + begin + length + 1;
            let message = "what stands in braces is shown as it is";
            let warning = Diagnostic::warning(Code::LabelSyntax, message);
            let meant = format!("${}", &self.text[here.clone()]);
            let at = self.at(&here);
            let warning = warning.at(at, format!("did you mean `{meant}`?"));
            // A place in a text that is escaped is all of it.
            let is_piece = at.end - at.start == length + 1;
            self.context.diagnostics.push(if is_piece {
                warning.fix(at, meant).fix_is_said()
            } else {
                warning
            });
        }
        (!words.is_empty()).then(|| Piece::Words(words.chars().filter_map(letter_of).collect()))
    }

    fn value(&mut self, range: Range<usize>) -> Option<Piece> {
        let inner = &self.text[range.clone()];
        let (formula, format) = match inner.rsplit_once(':') {
            None => (inner, Format::Short),
            Some((formula, format)) => {
                let begin = range.start + formula.len() + 1;
                let Some(format) = format_of(format) else {
                    let message = format!("`{format}` is no format of a number");
                    let label = "`.2` is two decimals, `.2e` has a power of ten";
                    self.report(Diagnostic::error(Code::LabelSyntax, message), begin..range.end, label);
                    return None;
                };
                (formula, format)
            }
        };
        let start = range.start;
        let (plain, dotted) = self.without_dots(formula, start)?;
        let name = plain.trim();
        let is_count = dotted.iter().any(|(known, measure)| known == name && measure.is_count());
        let format = match format {
            Format::Short if is_count || name == "impacts" => Format::Decimals(0),
            format => format,
        };
        let parsed = self.keep(Formula::parse(&plain), start)?;
        let (scope, inputs) = self.scope(dotted);
        let formula = parsed.resolve(&scope).and_then(|it| it.compile().map_err(|error| vec![error]));
        let formula = self.keep(formula, start)?;
        Some(Piece::Value { formula, inputs, format })
    }

    /// A formula in which `ball.speed` is one name, and what those names stand for. The formulas know no dots; another
    /// letter takes their place, so that no other letter moves.
    fn without_dots(&mut self, formula: &str, start: usize) -> Option<(String, Vec<(String, Measure)>)> {
        let variables: Vec<&str> = self.variables().map(|(name, _)| name).collect();
        let joint = std::iter::once('_').chain('A'..='Z').find(|joint| {
            let joined = formula.replace('.', &joint.to_string());
            !variables.iter().any(|name| name.contains(*joint) && joined.contains(name))
        });
        let joint = joint.unwrap_or('_').to_string();
        let mut plain = formula.to_owned();
        let mut dotted = Vec::new();
        let mut taken = 0;
        for (at, _) in formula.match_indices('.') {
            let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
            if at < taken {
                continue;
            }
            if let Some(name) =
                formula[..at].ends_with("joint").then(|| joint_name(&formula[at + 1..])).flatten()
                && !formula[..at - "joint".len()].ends_with(is_part)
            {
                let begin = at - "joint".len();
                let behind = at + 1 + name.len() + 1;
                let rest = &formula[behind..];
                taken = behind + rest.find(|c| !is_part(c)).unwrap_or(rest.len());
                let measure = self.of_joint(name, start + at + 1, &formula[behind..taken])?;
                let joined = formula[begin..taken].replace(|c| !is_part(c), &joint);
                plain.replace_range(begin..taken, &joined);
                self.note(&mut dotted, joined, measure, &formula[begin..taken], start + begin)?;
                continue;
            }
            // The name of a copy ends with its indices: `ball[0]`, `brick[3,1]`.
            let indices = formula[..at].ends_with(']').then(|| formula[..at].rfind('[')).flatten();
            let begin = formula[..indices.unwrap_or(at)].trim_end_matches(is_part).len();
            let rest = &formula[at + 1..];
            let end = at + 1 + rest.find(|c| !is_part(c)).unwrap_or(rest.len());
            let (body, measure) = (&formula[begin..at], &formula[at + 1..end]);
            let letter = |word: &str| word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
            if !letter(body) || !letter(measure) {
                continue;
            }
            let Some(number) = self.context.names.bodies.get(body).copied() else {
                let names = self.bodies.iter().map(|body| &*body.name);
                let label = crate::diagnostic::nearest(body, names.take(1000));
                let label = label.map_or(String::new(), |near| format!("did you mean `{near}`?"));
                let label = match self.context.groups.ends(Collection::Body, body) {
                    Some([first, last]) => format!("its copies are `{first}` to `{last}`"),
                    None => label,
                };
                let message = format!("there is no body `{body}`");
                self.report(Diagnostic::error(Code::UnknownName, message), start + begin..start + at, &label);
                return None;
            };
            let Some((_, known, _)) = BodyMeasure::ALL.into_iter().find(|(name, ..)| *name == measure) else {
                let names = BodyMeasure::ALL.map(|(name, ..)| name);
                let message = format!("a body has no `{measure}` that a label could show");
                let rest = formula[end..].strip_prefix('.');
                let axis = rest.map(|rest| &rest[..rest.find(|c| !is_part(c)).unwrap_or(rest.len())]);
                let other = words::of_body(measure, axis);
                let end = match (&other, axis) {
                    (Some(_), Some(axis @ ("x" | "y" | "z"))) => end + 1 + axis.len(),
                    _ => end,
                };
                let here = self.at(&(start + at + 1..start + end));
                let error = Diagnostic::error(Code::UnknownName, message);
                let known = format!("there are {}", crate::scene::grammar::quoted(&names));
                let near = || crate::diagnostic::nearest(measure, names).map(str::to_owned);
                self.context.diagnostics.push(match other.or_else(near) {
                    Some(near) => {
                        let error = error.at(here, format!("did you mean `{near}`?")).help(known);
                        self.mended(error, here, &near, end - at - 1)
                    }
                    None => error.at(here, "").help(known),
                });
                return None;
            };
            let mut measure = Measure::Body(number, known);
            let mut end = end;
            if known == BodyMeasure::Impacts {
                self.needs_contacts(start + begin..start + end)?;
                if let Some(other) = formula[end..].strip_prefix('.').and_then(body_name) {
                    let begin_of_other = end + 1;
                    end = begin_of_other + other.len();
                    measure = self.of_pair(number, other, start + begin_of_other)?;
                    taken = end;
                }
            }
            let joined = formula[begin..end].replace(|c| !is_part(c), &joint);
            plain.replace_range(begin..end, &joined);
            self.note(&mut dotted, joined, measure, &formula[begin..end], start + begin)?;
        }
        Some((plain, dotted))
    }

    /// Notes what a name stands for, as it is joined, unless another name of the formula looks the same then.
    fn note(
        &mut self,
        dotted: &mut Vec<(String, Measure)>,
        joined: String,
        measure: Measure,
        name: &str,
        begin: usize,
    ) -> Option<()> {
        if dotted.iter().any(|(other, another)| *other == joined && *another != measure) {
            let message = format!("`{name}` looks like another name in this formula");
            let label = "write the two in `${…}` of their own";
            self.report(Diagnostic::error(Code::LabelSyntax, message), begin..begin + name.len(), label);
            return None;
        }
        dotted.push((joined, measure));
        Some(())
    }

    /// Says it where impacts are asked for, and nothing finds them.
    fn needs_contacts(&mut self, range: Range<usize>) -> Option<()> {
        if self.root.table("simulation").has("contacts") {
            return Some(());
        }
        let error = Diagnostic::error(Code::NoContacts, "`impacts` needs `simulation.contacts`")
            .help("write `contacts = \"event-driven\"` in [simulation]");
        self.report(error, range, "without it, bodies pass through each other");
        None
    }

    /// The impacts of a body with another, whose name begins at a place of the text; `ground` is the ground, unless a body is called so.
    fn of_pair(&mut self, body: usize, other: &str, begin: usize) -> Option<Measure> {
        let named = self.context.names.bodies.get(other).copied();
        let Some(other) = named.or_else(|| (other == "ground").then_some(self.bodies.len())) else {
            let names = self.bodies.iter().map(|body| &*body.name);
            let near = crate::diagnostic::nearest(other, names.take(1000));
            let label = near.map_or(String::new(), |near| format!("did you mean `{near}`?"));
            let error = Diagnostic::error(Code::UnknownName, format!("there is no body `{other}`"));
            self.report(error, begin..begin + other.len(), &label);
            return None;
        };
        let pair = [body.min(other), body.max(other)];
        let pairs = &mut self.context.pairs;
        let known = pairs.iter().position(|known| *known == pair);
        Some(Measure::Impacts(known.unwrap_or_else(|| {
            pairs.push(pair);
            pairs.len() - 1
        })))
    }

    /// A measure of a joint whose name begins at a place of the text.
    fn of_joint(&mut self, name: &str, begin: usize, measure: &str) -> Option<Measure> {
        let found = self.joints.iter().enumerate().find(|(_, joint)| joint.name == name);
        let Some((number, joint)) = found else {
            let names = self.joints.iter().map(|joint| joint.name.as_str());
            let near = crate::diagnostic::nearest(name, names.take(1000));
            let label = near.map_or(String::new(), |near| format!("did you mean `{near}`?"));
            let error = Diagnostic::error(Code::UnknownName, format!("there is no joint `{name}`"));
            self.report(error, begin..begin + name.len(), &label);
            return None;
        };
        let its = || JointMeasure::names().filter(|(_, measure)| measure.is_of(&joint.kind));
        if let Some((_, known)) = its().find(|(known, _)| *known == measure) {
            return Some(Measure::Joint(number, known));
        }
        let names: Vec<&str> = its().map(|(name, _)| name).collect();
        let behind = begin + name.len() + 1;
        let here = self.at(&(behind..behind + measure.len()));
        let error = Diagnostic::error(
            Code::UnknownName,
            format!("this joint has no `{measure}` that a label could show"),
        );
        let known = format!("there are {}", crate::scene::grammar::quoted(&names));
        let near = words::of_joint(measure).or_else(|| crate::diagnostic::nearest(measure, names));
        self.context.diagnostics.push(match near {
            Some(near) => {
                let error = error.at(here, format!("did you mean `{near}`?")).help(known);
                self.mended(error, here, near, measure.len())
            }
            None => error.at(here, "").help(known),
        });
        None
    }

    /// An error with the word that belongs at its place, unless that is all of an escaped text.
    fn mended(&self, error: Diagnostic, at: Span, word: &str, length: usize) -> Diagnostic {
        if at.end - at.start == length { error.fix(at, word).fix_is_said() } else { error }
    }

    /// The variables of the scene that have values.
    fn variables(&self) -> impl Iterator<Item = (&str, f64)> {
        self.root.variables()
    }

    /// The names that a formula of the label knows, and what each of its inputs is.
    fn scope(&self, dotted: Vec<(String, Measure)>) -> (Scope, Vec<Measure>) {
        let mut scope = Scope::default();
        for (name, value) in self.variables() {
            scope.constant(name, value);
        }
        let mut inputs = Vec::new();
        let mut add = |name: &str, measure: Measure| {
            scope.slot(name);
            inputs.push(measure);
        };
        let mut with_run = true;
        let has_contacts = self.root.table("simulation").has("contacts");
        let of_body = matches!(self.place, LabelPlace::Body { .. });
        if let LabelPlace::Body { body, ghosts, .. } = self.place {
            with_run = !ghosts;
            let known = BodyMeasure::ALL.into_iter();
            let known =
                known.filter(|(_, measure, _)| *measure != BodyMeasure::Impacts || has_contacts && !ghosts);
            known.for_each(|(name, measure, _)| add(name, Measure::Body(body, measure)));
        }
        for (name, measure, _) in RunMeasure::ALL {
            // Beside a body, `impacts` are those of the body.
            let is_known = measure != RunMeasure::Impacts || has_contacts && !of_body;
            // Of ghosts, no more is kept than what they look like.
            if is_known && (with_run || measure == RunMeasure::Time) {
                add(name, Measure::Run(measure));
            }
        }
        for (name, measure) in dotted {
            let of_ghost = matches!(self.place, LabelPlace::Body { body, .. } if matches!(measure, Measure::Body(b, _) if b == body));
            if with_run || of_ghost {
                add(&name, measure);
            }
        }
        (scope, inputs)
    }

    /// Keeps what is wrong with a formula that begins at a place of the text.
    fn keep<T>(&mut self, found: Result<T, Vec<ExpressionError>>, start: usize) -> Option<T> {
        let errors = match found {
            Ok(value) => return Some(value),
            Err(errors) => errors,
        };
        for error in errors {
            let range = start + error.range.start..start + error.range.end;
            if self.text.get(range.clone()) == Some("impacts") && self.needs_contacts(range).is_none() {
                continue;
            }
            let at = self.at(&(start + error.range.start..start + error.range.end));
            // What is said of variables is not all that there is here.
            let own = error.code == Code::UnknownName && !error.label.starts_with("did you mean");
            let diagnostic = Diagnostic::error(error.code, error.message);
            let word = self.text.get(start + error.range.start..start + error.range.end).unwrap_or_default();
            if let Some(other) = words::of_run(word).filter(|_| own) {
                let diagnostic = diagnostic.at(at, format!("did you mean `{other}`?"));
                let diagnostic = self.mended(diagnostic, at, other, word.len());
                self.context.diagnostics.push(diagnostic);
                continue;
            }
            self.context.diagnostics.push(if own {
                let known = "`t`, `ball.speed` and their kin: see «Labels» in docs/scene-language.md";
                diagnostic.at(at, "not known to this label").help(known)
            } else {
                diagnostic.at(at, error.label)
            });
        }
        None
    }
}

/// The name of the joint in `knee.force` or `string[3].force`: what stands before the point behind it.
fn joint_name(text: &str) -> Option<&str> {
    let letters = text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_')?;
    let indices = match text[letters..].strip_prefix('[') {
        Some(rest) => rest.find(']')? + 2,
        None => 0,
    };
    let name = &text[..letters + indices];
    let measure = text[name.len()..].strip_prefix('.')?;
    let is_name = !name.is_empty() && measure.starts_with(|c: char| c.is_ascii_alphabetic());
    is_name.then_some(name)
}

/// The name of a body at the beginning of a text, with the indices of a copy.
fn body_name(text: &str) -> Option<&str> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let end = text.find(|c| !is_part(c)).unwrap_or(text.len());
    let indices = match text[end..].strip_prefix('[') {
        Some(rest) => rest.find(']')? + 2,
        None => 0,
    };
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_').then(|| &text[..end + indices])
}

/// A letter as POV-Ray's font has it; none: it has none. Dashes stand in for the minus sign, a raised point for its like.
fn letter_of(letter: char) -> Option<char> {
    match letter {
        '−' => Some('–'),
        '·' => Some('∙'),
        ' '..='~'
        | '¡'..='§'
        | '©'..='¶'
        | '¹'..='¿'
        | '–'
        | '—'
        | '‘'..='‚'
        | '“'..='„'
        | '†'
        | '‡'
        | '•'
        | '…'
        | '‰'
        | '‹'
        | '›'
        | '™'
        | '∙' => Some(letter),
        _ => None,
    }
}

/// `.2` or `.2e`.
fn format_of(text: &str) -> Option<Format> {
    let text = text.trim();
    let (digits, scientific) = match text.strip_suffix(['e', 'E']) {
        Some(digits) => (digits, true),
        None => (text.strip_suffix('f').unwrap_or(text), false),
    };
    let decimals = digits.strip_prefix('.')?.parse::<usize>().ok().filter(|decimals| *decimals <= 12)?;
    Some(if scientific { Format::Scientific(decimals) } else { Format::Decimals(decimals) })
}

#[cfg(test)]
mod tests;

//! Reads formulas of measures, such as `ball.speed` or `2 * kinetic`, in labels and plots.

mod aggregates;
mod bodies;
mod dotted;
mod emitters;
mod forces;
mod marks;
mod unit;
mod words;

use std::ops::Range;

use self::aggregates::Each;
pub(super) use self::aggregates::OfEach;
use super::Context;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::font::Typeface;
use crate::scene::expand::place;
use crate::scene::expression::{ExpressionError, Formula, Scope};
use crate::scene::grammar::scene::{scene, simulation};
use crate::scene::{Body, BodyMeasure, Emitter, Force, Joint, Measure, MeasureFormula, RunMeasure, Subject};

/// The body whose measures need no name in a text, since the text stands beside it.
#[derive(Clone, Copy)]
pub(super) struct OwnBody {
    /// The body, or each body of a color map.
    pub(super) body: Subject,
    /// Whether the text also stands beside the ghosts of the body, which keep only the body's own state.
    pub(super) ghosts: bool,
}

/// The things that a formula can name.
#[derive(Clone, Copy)]
pub(super) struct Things<'a> {
    pub(super) bodies: &'a [Body],
    pub(super) forces: &'a [Force],
    pub(super) joints: &'a [Joint],
    pub(super) emitters: &'a [Emitter],
}

/// Reads a text that contains formulas of measures.
pub(super) struct Reader<'a, 'b, 'c> {
    /// What the text belongs to, for messages: `label` or `plot`.
    pub(super) noun: &'static str,
    pub(super) text: &'a str,
    pub(super) span: Span,
    pub(super) root: &'a View<'b>,
    pub(super) own: Option<OwnBody>,
    pub(super) things: Things<'a>,
    pub(super) context: &'a mut Context<'c>,
    /// The fonts in which the text is set.
    pub(super) typeface: &'a Typeface,
    /// The byte at which bold letters begin that do not end yet.
    pub(super) bold_from: Option<usize>,
    /// The letters that the font does not have, each once, with its first range in the text.
    pub(super) missing: Vec<(char, Range<usize>)>,
    /// The aggregate that is being read. `None` outside of aggregates.
    each: Option<Each>,
}

/// Reads the formulas of [`Options::measures`](crate::scene::Options). Each is a text of its own, so that messages can point into it.
pub(super) fn read(
    root: &View<'_>,
    asked: &[String],
    things: Things<'_>,
    context: &mut Context<'_>,
) -> Vec<MeasureFormula> {
    let formula = |text: &String| {
        let span = Span::new(context.sources.add("measure", text.clone()), 0..text.len());
        let mut reader = Reader::new("formula", (text, span), root, None, things, context);
        reader.formula_with_unit(0..text.len())
    };
    asked.iter().filter_map(formula).collect()
}

impl<'a, 'b, 'c> Reader<'a, 'b, 'c> {
    /// Returns a reader of a text. `noun` is what the text belongs to, for messages.
    pub(super) fn new(
        noun: &'static str,
        (text, span): (&'a str, Span),
        root: &'a View<'b>,
        own: Option<OwnBody>,
        things: Things<'a>,
        context: &'a mut Context<'c>,
    ) -> Self {
        let typeface = Typeface::usual();
        let missing = Vec::new();
        Reader {
            noun,
            text,
            span,
            root,
            own,
            things,
            context,
            typeface,
            bold_from: None,
            missing,
            each: None,
        }
    }
}

impl Reader<'_, '_, '_> {
    pub(super) fn report(&mut self, error: Diagnostic, range: Range<usize>, label: &str) {
        let at = self.at(&range);
        self.context.diagnostics.push(error.at(at, label));
    }

    /// Returns the source span of a byte range of the label's text.
    pub(super) fn at(&self, range: &Range<usize>) -> Span {
        place::in_string(self.context.sources.raw(self.span), self.text, range, self.span)
    }

    /// Reads the formula in a byte range of the text. `None` if it has an error, which is reported.
    pub(super) fn formula(&mut self, range: Range<usize>) -> Option<MeasureFormula> {
        let start = range.start;
        let (plain, aggregates) = self.without_aggregates(&self.text[range], start)?;
        self.plain_formula(&plain, start, aggregates)
    }

    /// Reads a formula in which names stand for aggregates. It begins at the byte `start` of the text.
    fn plain_formula(
        &mut self,
        formula: &str,
        start: usize,
        aggregates: Vec<(String, Measure)>,
    ) -> Option<MeasureFormula> {
        let (plain, mut dotted) = self.without_dots(formula, start)?;
        dotted.extend(aggregates);
        if let Some(OwnBody { body: Subject::One(body), ghosts: true }) = self.own
            && !dotted.iter().all(|(_, measure)| is_of(*measure, body))
        {
            let message = "a label at ghosts shows only values of its own body";
            let error = Diagnostic::error(Code::LabelSyntax, message);
            let help = "a ghost keeps nothing else; a label without `ghosts` can show other values";
            self.report(error.help(help), start..start + formula.len(), "names something else");
            return None;
        }
        let parsed = self.keep(Formula::parse(&plain), start)?;
        let (all, inputs) = self.scope(dotted);
        // Errors suggest any known name, but the program gets only what the formula names: each input costs time for each body.
        self.keep(parsed.resolve(&all), start)?;
        let is_named = |name: &str| {
            plain.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').any(|word| word == name)
        };
        let inputs: Vec<(String, Measure)> = inputs.into_iter().filter(|(name, _)| is_named(name)).collect();
        let scope = self.scope_of(&inputs);
        let single = inputs.iter().find(|(name, _)| name == plain.trim()).map(|(_, measure)| *measure);
        let program = parsed.resolve(&scope).and_then(|it| it.compile().map_err(|error| vec![error]));
        let program = self.keep(program, start)?;
        let inputs = inputs.into_iter().map(|(_, measure)| measure).collect();
        let unit = single.map(|measure| self.unit_of(measure));
        Some(MeasureFormula {
            program,
            inputs,
            single,
            own_unit: unit.map(|(unit, _)| unit),
            is_count: unit.is_some_and(|(_, is_count)| is_count),
            asked_unit: None,
        })
    }

    /// Returns the name and the value of each variable of the scene.
    fn variables(&self) -> impl Iterator<Item = (&str, f64)> {
        self.root.variables()
    }

    /// Returns a scope of the scene's variables and these inputs, in their order.
    fn scope_of(&self, inputs: &[(String, Measure)]) -> Scope {
        let mut scope = Scope::default();
        for (name, value) in self.variables() {
            scope.constant(name, value);
        }
        for (name, _) in inputs {
            scope.slot(name);
        }
        scope
    }

    /// Returns the names that formulas can use, and the name and the measure of each of their inputs.
    fn scope(&self, dotted: Vec<(String, Measure)>) -> (Scope, Vec<(String, Measure)>) {
        let mut inputs = Vec::new();
        let mut add = |name: &str, measure: Measure| inputs.push((name.to_owned(), measure));
        let mut with_run = true;
        let has_contacts = self.root.table(&scene::SIMULATION).has(&simulation::CONTACTS);
        if let Some(OwnBody { body, ghosts }) = self.own {
            with_run = !ghosts;
            let known = BodyMeasure::ALL.into_iter();
            let known = known.filter(|(_, measure, _)| {
                (has_contacts || !measure.needs_contacts()) && (!ghosts || measure.is_of_state())
            });
            known.for_each(|(name, measure, _)| add(name, Measure::Body(body, measure)));
            let one = match body {
                Subject::One(body) => Some(body),
                Subject::Each => None,
            };
            let is_measure = |name: &str| BodyMeasure::ALL.iter().any(|(known, ..)| *known == name);
            let columns = self.context.file_columns.names(one).filter(|(_, name)| !is_measure(name));
            columns.for_each(|(column, name)| add(name, Measure::FileColumn(body, column)));
        }
        for (name, measure, _) in RunMeasure::ALL {
            // In a label beside a body, a name such as `kinetic` means the measure of that body. A variable of the scene hides a measure.
            let is_of_body = self.own.is_some() && BodyMeasure::ALL.iter().any(|(known, ..)| *known == name);
            let is_variable = self.variables().any(|(variable, _)| variable == name);
            let is_known = !is_of_body && !is_variable && (measure != RunMeasure::Impacts || has_contacts);
            // A ghost keeps only the state of its own body, so offer the time but no other measure of the run.
            if is_known && (with_run || measure == RunMeasure::Time) {
                add(name, Measure::Run(measure));
            }
        }
        inputs.extend(dotted);
        (self.scope_of(&inputs), inputs)
    }

    /// Returns the value in `found`, or reports the errors in it. The formula begins at the byte `start` of the label's text.
    fn keep<T>(&mut self, found: Result<T, Vec<ExpressionError>>, start: usize) -> Option<T> {
        let errors = match found {
            Ok(value) => return Some(value),
            Err(errors) => errors,
        };
        for error in errors {
            let range = start + error.range.start..start + error.range.end;
            let needs = |word: &str| {
                BodyMeasure::ALL.iter().any(|(name, measure, _)| *name == word && measure.needs_contacts())
            };
            if self.text.get(range.clone()).is_some_and(needs) && self.needs_contacts(range).is_none() {
                continue;
            }
            let at = self.at(&(start + error.range.start..start + error.range.end));
            // For an unknown name without a similar name, do not list all names that labels know.
            let own = error.code == Code::UnknownName && !error.label.starts_with("did you mean");
            let diagnostic = Diagnostic::error(error.code, error.message);
            let word = self.text.get(start + error.range.start..start + error.range.end).unwrap_or_default();
            if let Some(other) = words::of_run(word).filter(|_| own) {
                let diagnostic = diagnostic.at(at, format!("did you mean `{other}`?"));
                let diagnostic = self.corrected(diagnostic, at, other, word.len());
                self.context.diagnostics.push(diagnostic);
                continue;
            }
            self.context.diagnostics.push(if own {
                let known = "`t`, `ball.speed` and their kin: see «Labels» in docs/scene-language.md";
                diagnostic.at(at, format!("not known to this {}", self.noun)).help(known)
            } else {
                diagnostic.at(at, error.label)
            });
        }
        None
    }
}

/// Returns whether a measure belongs to a body alone.
fn is_of(measure: Measure, body: usize) -> bool {
    matches!(measure, Measure::Body(Subject::One(one), measure) if one == body && measure.is_of_state())
}

//! Reads the plots of a scene from `[plot.NAME]`.

use std::sync::Arc;

use super::Context;
use super::label::MAX_LENGTH;
use super::measures::{OfEach, Reader, Things};
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::grammar::camera::camera;
use crate::scene::grammar::labels::plot;
use crate::scene::grammar::scene::{output, scene};
use crate::scene::grammar::{Any, Key, KeySpec};
use crate::scene::read;
use crate::scene::source::Node;
use crate::scene::value::Text;
use crate::scene::{Color, Corner, Curve, MeasureFormula, Plot, PlotKind, PlotPlace, PlotSpans};

/// A text of a plot, with the place where it is written.
type Written<'a> = (&'a str, Span);

/// What a plot draws, as it is read.
struct Read<'a> {
    kind: PlotKind,
    of: Vec<Written<'a>>,
    /// The formulas of these texts. `None` for one with a mistake.
    formulas: Vec<Option<MeasureFormula>>,
    /// The names of the things that are drawn, if their formulas are not their names.
    names: Vec<String>,
}

/// Reads formulas and texts of plots.
struct Plots<'a, 'b, 'c> {
    root: &'a View<'b>,
    things: Things<'a>,
    context: &'a mut Context<'c>,
}

/// Returns the plots of a scene, and where they are written.
pub(super) fn read(
    root: &View<'_>,
    things: Things<'_>,
    context: &mut Context<'_>,
) -> (Vec<Plot>, Vec<PlotSpans>) {
    let mut plots = Plots { root, things, context };
    root.named(&scene::PLOT)
        .into_iter()
        .filter_map(|(name, span, view)| plots.plot((name, span), &view))
        .unzip()
}

impl<'b, 'c> Plots<'_, 'b, 'c> {
    /// Returns the place of a plot. Without a given one, a plot stands beside the bodies, where a camera without a given place shows nothing.
    fn place(&self, view: &View<'_>) -> PlotPlace {
        let named_corner = |word: &str| Corner::ALL.into_iter().find(|corner| corner.name() == word);
        match (view.get(&plot::SIDE), view.get(&plot::CORNER).and_then(named_corner)) {
            (Some("left"), _) => PlotPlace::Left,
            (Some(_), _) => PlotPlace::Right,
            (None, Some(corner)) => PlotPlace::Corner(corner),
            (None, None) => {
                let (seen_by, output) = (self.root.table(&scene::CAMERA), self.root.table(&scene::OUTPUT));
                let places = [&camera::LOCATION.spec, &camera::KEYFRAMES.spec, &camera::FOLLOW.spec];
                let is_narrow = |plot: &View<'_>| {
                    plot.get(&plot::WIDTH).is_none_or(|width| width <= Plot::MAX_WIDTH_AT_SIDE)
                };
                let is_given = places.into_iter().any(|key| seen_by.has(key));
                // Plots in corners share their room with those in the same corner, and not with those at the side.
                let plots = self.root.named(&scene::PLOT);
                let has_corners =
                    plots.iter().any(|(_, _, other)| other.has(&plot::CORNER) || !is_narrow(other));
                let is_wide = output.get(&output::SIZE).first() >= output.get(&output::SIZE).get(1);
                if is_given || has_corners || !is_wide {
                    PlotPlace::Corner(Corner::TopRight)
                } else {
                    PlotPlace::Right
                }
            }
        }
    }

    fn plot(&mut self, (name, span): (&str, Span), view: &View<'_>) -> Option<(Plot, PlotSpans)> {
        let x_formula = view.get(&plot::X);
        let x = self.formula((x_formula, view.span(&plot::X).unwrap_or(span)));
        self.check_keys((name, span), view);
        let Read { kind, of: written, formulas, names: own_names } = self.drawn(view);
        let across = match written.first() {
            Some((text, span)) if matches!(kind, PlotKind::Histogram { .. }) => (*text, *span),
            _ => (x_formula, span),
        };
        let names = texts(view, &plot::NAMES);
        let set_names: Vec<Option<String>> = names.iter().map(|name| self.set(*name)).collect();
        let [title, x_name] =
            [&plot::TITLE, &plot::X_NAME].map(|key| self.set(view.get(key).zip(view.span(key))?));
        self.check_count(view.span(&plot::NAMES), (&kind, formulas.len()), (names.len(), "name"));
        let colors: Vec<Color> = view
            .list(&plot::COLORS)
            .unwrap_or_default()
            .iter()
            .filter_map(|node| read::color(node).ok())
            .collect();
        self.check_count(view.span(&plot::COLORS), (&kind, formulas.len()), (colors.len(), "color"));
        let range = self.range(view, &plot::RANGE);
        let x_range = self.range(view, &plot::X_RANGE);
        let is_logarithmic = logarithmic(view);
        if is_logarithmic[1] && range.is_some_and(|[low, _]| low <= 0.0) {
            let message = "a logarithmic axis has no zero and no negative numbers".to_owned();
            self.report(view.span(&plot::RANGE), message, "both values must be greater than 0");
        }
        if is_logarithmic[0] && x_range.is_some_and(|[low, _]| low <= 0.0) {
            let message = "a logarithmic axis has no zero and no negative numbers".to_owned();
            self.report(view.span(&plot::X_RANGE), message, "both values must be greater than 0");
        }
        let width = view.get(&plot::WIDTH);
        let place = self.place(view);
        if !matches!(place, PlotPlace::Corner(_))
            && width.is_some_and(|width| width > Plot::MAX_WIDTH_AT_SIDE)
        {
            let message = format!("a plot at a side is at most {} wide", Plot::MAX_WIDTH_AT_SIDE);
            self.report(view.span(&plot::WIDTH), message, "the bodies need the rest of the picture");
        }
        // Curves of one unit share an axis that shows it.
        let mut units = formulas.iter().flatten().map(MeasureFormula::unit);
        let first = units.next();
        let is_one_unit = units.all(|unit| Some(unit) == first);
        let curve = |(number, formula): (usize, Option<MeasureFormula>)| {
            let own = written.get(number).map(|(text, _)| {
                let (name, unit) =
                    text.rsplit_once(':').map_or((*text, None), |(name, unit)| (name, Some(unit)));
                let unit =
                    unit.filter(|_| !is_one_unit).map_or(String::new(), |unit| format!(", {}", unit.trim()));
                format!("{}{unit}", name.trim())
            });
            let set = set_names.get(number).cloned().flatten();
            let name = set.or_else(|| own_names.get(number).cloned()).or(own)?;
            Some(Curve { name, y: formula?, color: colors.get(number).copied() })
        };
        let curves: Vec<Curve> = formulas.into_iter().enumerate().filter_map(curve).collect();
        let curves_at = written.iter().map(|(_, span)| *span).collect();
        let [range_at, x_range_at] = [&plot::RANGE, &plot::X_RANGE].map(|key| view.span(key));
        let spans = PlotSpans { name: span, curves: curves_at, range: range_at, x_range: x_range_at };
        let plot = Plot {
            name: name.to_owned(),
            title,
            x: x?,
            x_name: x_name.unwrap_or_else(|| without_unit(across.0).to_owned()).trim().to_owned(),
            kind,
            curves,
            place,
            width,
            x_range,
            range,
            is_logarithmic,
            has_names_at_ends: view.get(&plot::LEGEND) == Plot::PLACES_OF_NAMES[0],
            ahead: view.get(&plot::AHEAD),
        };
        (!plot.curves.is_empty()).then_some((plot, spans))
    }

    /// Reads what a plot draws.
    fn drawn<'t>(&mut self, view: &View<'t>) -> Read<'t> {
        if let Some(text) = view.get(&plot::HISTOGRAM).zip(view.span(&plot::HISTOGRAM)) {
            let read = self.of_copies("histogram", text);
            let bodies = read.as_ref().map_or(Arc::default(), |read| read.bodies.clone());
            let bins = view.get(&plot::BINS).and_then(|bins| u8::try_from(bins).ok());
            let kind = PlotKind::Histogram { bins: bins.unwrap_or_else(|| usual_bins(bodies.len())), bodies };
            let (name, formula) = read.map(|read| (read.name, read.formula)).unzip();
            return Read { kind, of: vec![text], formulas: vec![formula], names: name.into_iter().collect() };
        }
        let (kind, key) = match view.has(&plot::BARS) {
            true => (PlotKind::Bars { are_copies: false }, &plot::BARS),
            false => (PlotKind::Curves, &plot::Y),
        };
        let of = texts(view, key);
        if let ([text], PlotKind::Bars { .. }) = (of.as_slice(), &kind)
            && self.reader(*text).names_several(text.0)
        {
            return self.bars_of_copies(*text);
        }
        let formulas = of.iter().map(|text| self.formula(*text)).collect();
        Read { kind, of, formulas, names: Vec::new() }
    }

    /// Reads a bar for each copy of a body. Their names are the indices of the copies.
    fn bars_of_copies<'t>(&mut self, text: Written<'t>) -> Read<'t> {
        let read = self.of_copies("bars", text);
        let bodies = read.as_ref().map_or(Arc::default(), |read| read.bodies.clone());
        if bodies.len() > Plot::MAX_BARS {
            let message = format!("these are {} bars", bodies.len());
            self.report(Some(text.1), message, &format!("a plot has at most {}", Plot::MAX_BARS));
        }
        let index = |body: &usize| {
            let name = &*self.things.bodies[*body].name;
            let index = name.split_once('[').map_or(name, |(_, index)| index.trim_end_matches(']'));
            index.to_owned()
        };
        let names = bodies.iter().map(index).collect();
        let of_copy = |body: &usize| {
            let formula = read.as_ref()?.formula.clone();
            let inputs = formula.inputs.iter().map(|measure| measure.of_one(*body)).collect();
            let single = formula.single.map(|measure| measure.of_one(*body));
            Some(MeasureFormula { inputs, single, ..formula })
        };
        let formulas = bodies.iter().map(of_copy).collect();
        Read { kind: PlotKind::Bars { are_copies: true }, of: vec![text], formulas, names }
    }

    /// Reads the range of an axis. Reports one that is empty or extreme.
    fn range(&mut self, view: &View<'_>, key: &Key<Option<Vec<f64>>>) -> Option<[f64; 2]> {
        let [low, high] = <[f64; 2]>::try_from(view.get(key)?).ok()?;
        let largest = low.abs().max(high.abs());
        if low >= high {
            self.report(view.span(key), "this range is empty".to_owned(), "the lower value comes first");
        } else if largest > Plot::MAX_VALUE
            || high - low < 1e-12 * largest
            || high - low < 1.0 / Plot::MAX_VALUE
        {
            let message = "this range is too small or too large for numbers".to_owned();
            self.report(view.span(key), message, "the numbers of the axis could not be told apart");
        }
        Some([low, high])
    }

    /// Reports a list of names or colors with another length than that of the curves or bars. An empty list means that there is none.
    fn check_count(
        &mut self,
        span: Option<Span>,
        (kind, curves): (&PlotKind, usize),
        (found, noun): (usize, &str),
    ) {
        if found == 0 || found == curves {
            return;
        }
        let counted =
            |count: usize, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
        let message = format!("the plot has {}, and {}", counted(curves, kind.noun()), counted(found, noun));
        self.report(span, message, &format!("each {} has one {noun}", kind.noun()));
    }

    /// Reports a plot that draws nothing, and the keys that have no meaning for what it draws.
    fn check_keys(&mut self, (name, span): (&str, Span), view: &View<'_>) {
        if view.to_table().is_none() {
            // A key without a plot of its own has been reported.
            return;
        }
        let (has_bars, has_histogram) = (view.has(&plot::BARS), view.has(&plot::HISTOGRAM));
        if !view.has(&plot::Y) && !has_bars && !has_histogram && !view.has_unknown() {
            let message = "a plot needs one of `y`, `bars`, `histogram`".to_owned();
            let error = Diagnostic::error(Code::MissingKey, message);
            let error = error.at(span, format!("`plot.{name}` says none of them"));
            self.context.diagnostics.push(error.help("`y = \"ball.speed\"` draws a curve"));
        }
        let (drawn, meaningless): (_, &[&KeySpec]) = match (has_histogram, has_bars) {
            (true, _) => {
                ("a histogram", &[&plot::X.spec, &plot::LOG.spec, &plot::AHEAD.spec, &plot::LEGEND.spec])
            }
            (_, true) => (
                "bars",
                &[
                    &plot::X.spec,
                    &plot::X_RANGE.spec,
                    &plot::X_NAME.spec,
                    &plot::LOG.spec,
                    &plot::AHEAD.spec,
                    &plot::LEGEND.spec,
                    &plot::BINS.spec,
                ],
            ),
            _ => ("curves", &[&plot::BINS.spec]),
        };
        for key in meaningless {
            self.report(view.key_span(key), format!("`{key}` has no meaning for {drawn}"), "leave it out");
        }
    }

    /// Reads a formula of measures. Reports its mistakes at their source positions.
    fn formula(&mut self, written: Written<'_>) -> Option<MeasureFormula> {
        self.is_plain(written).then(|| self.reader(written).formula_with_unit(0..written.0.len()))?
    }

    /// Reads a formula that has a value for each of several bodies.
    fn of_copies(&mut self, function: &'static str, written: Written<'_>) -> Option<OfEach> {
        self.is_plain(written).then(|| self.reader(written).of_each(function, 0..written.0.len()))?
    }

    /// Returns false and reports an error if a text of a plot cannot be a formula.
    fn is_plain(&mut self, (text, span): Written<'_>) -> bool {
        if let Some(inner) = text.trim().strip_prefix("${").and_then(|rest| rest.strip_suffix('}')) {
            let error = Diagnostic::error(Code::BadPlot, "a plot takes a formula without `${…}`");
            self.context.diagnostics.push(error.at(span, format!("write `{inner}`")));
            return false;
        }
        !self.is_too_long((text, span))
    }

    /// Returns true and reports an error if a text of a plot is too long.
    fn is_too_long(&mut self, (text, span): Written<'_>) -> bool {
        if text.len() > MAX_LENGTH {
            let message = format!("a text of a plot has at most {MAX_LENGTH} bytes");
            self.report(Some(span), message, "this one is longer");
        }
        text.len() > MAX_LENGTH
    }

    /// Sets the subscripts and superscripts of a text. Reports the letters that the font does not have.
    fn set(&mut self, written: Written<'_>) -> Option<String> {
        let (text, span) = written;
        if self.is_too_long(written) {
            return None;
        }
        if text.contains("${") {
            let message = "titles and names of a plot show no values".to_owned();
            self.report(Some(span), message, "a label can: `[label.NAME]`");
        }
        let mut reader = self.reader(written);
        reader.note_letters(0..text.len());
        let set = reader.set(0..text.len());
        reader.finish();
        set
    }

    fn reader<'t>(&'t mut self, (text, span): Written<'t>) -> Reader<'t, 'b, 'c> {
        Reader::new("plot", (text, span), self.root, None, self.things, self.context)
    }

    fn report(&mut self, span: Option<Span>, message: String, label: &str) {
        let error = Diagnostic::error(Code::BadPlot, message);
        self.context.diagnostics.extend(span.map(|span| error.at(span, label)));
    }
}

/// Returns whether the horizontal and the vertical axis of a plot are logarithmic.
fn logarithmic(view: &View<'_>) -> [bool; 2] {
    let named = |word: &str| Plot::LOGARITHMIC.into_iter().find(|(axes, _)| *axes == word);
    match view.get_as::<Text>(&plot::LOG).and_then(named) {
        Some((_, axes)) => axes,
        None => [false, view.get_as::<bool>(&plot::LOG) == Some(true)],
    }
}

/// The usual number of bins of a histogram: the square root of the number of values, so that both the bins and their counts are many.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "it is between 5 and 30"
)]
fn usual_bins(values: usize) -> u8 {
    libm::round((values as f64).sqrt()).clamp(5.0, 30.0) as u8
}

/// Returns the formula of a text such as `ball.speed:km/h`.
fn without_unit(text: &str) -> &str {
    text.rsplit_once(':').map_or(text, |(formula, _)| formula)
}

/// Returns the texts of a key that takes one text or a list of them.
fn texts<'a>(view: &View<'a>, key: &Key<Any>) -> Vec<Written<'a>> {
    match view.get_as::<Text>(key) {
        Some(text) => view.span(key).map(|span| (text, span)).into_iter().collect(),
        None => {
            let nodes: &[Node] = view.list(key).unwrap_or_default();
            nodes.iter().filter_map(|node| Some((node.as_str()?, node.span))).collect()
        }
    }
}

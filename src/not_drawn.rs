//! Warnings about arrows, trails, plots and other things that a scene requests but no image shows.

use crate::diagnostic::{Code, Diagnostic};
use crate::lettering;
use crate::picture::number::rounded;
use crate::picture::{NotDrawn, Reason, RequestedItem, UnseenPlot};
use crate::scene::{Quantity, Scene};

/// Returns the warning that a requested arrow, trail, ghost or similar is not drawn. It gives the time, the reason, and the key to change.
pub(crate) fn warning(missing: &NotDrawn) -> Diagnostic {
    let NotDrawn { what, name, why, others } = missing;
    let (what, key) = match what {
        RequestedItem::Arrow(quantity) => {
            let words = if *quantity == Quantity::Normal { "normal force" } else { quantity.name() };
            let key = if matches!(missing.why, Reason::Untouched) { "" } else { ".scale" };
            (format!("the arrow for the {words} of `{name}`"), format!("arrows.{}{key}", quantity.name()))
        }
        RequestedItem::ForceArrow => (format!("the arrow of the force `{name}`"), "arrow.scale".to_owned()),
        RequestedItem::Axes => (format!("the axes of `{name}`"), "axes.length".to_owned()),
        RequestedItem::Trail => (format!("the trail of `{name}`"), "trail.width".to_owned()),
        RequestedItem::Ghosts => (format!("the ghosts of `{name}`"), "ghosts".to_owned()),
        RequestedItem::Coil => (format!("the coil of the spring `{name}`"), "coil.radius".to_owned()),
        RequestedItem::Line => (format!("the line of the spring `{name}`"), "coil.radius".to_owned()),
        RequestedItem::ScaleBar => ("the scale bar".to_owned(), "scale_bar.length".to_owned()),
    };
    let are = if matches!(missing.what, RequestedItem::Axes | RequestedItem::Ghosts) { "are" } else { "is" };
    let others = match others {
        0 => String::new(),
        1 => ", nor that of 1 other".to_owned(),
        others => format!(", nor those of {others} others"),
    };
    let (message, fit) = match *why {
        Reason::TooSmall { pixels, fit } => {
            let is_long = matches!(
                missing.what,
                RequestedItem::Arrow(_) | RequestedItem::ForceArrow | RequestedItem::Axes
            );
            let size = if is_long { "long" } else { "wide" };
            let pixels = rounded(pixels);
            (format!("{what} {are} not seen{others}: at most {pixels} pixels {size}"), Some(fit))
        }
        Reason::Lost { time, fit } => {
            let time = rounded(time);
            (format!("{what} is not drawn from t = {time} s on{others}: its tip is at no finite place"), fit)
        }
        Reason::Wide { way, width } => {
            let (way, width) = (rounded(way), rounded(width));
            (
                format!(
                    "{what} is not drawn{others}: the body goes {way} m, and its trail is {width} m wide"
                ),
                None,
            )
        }
        Reason::Untouched => (format!("{what} {are} not drawn{others}: nothing touches the body"), None),
        Reason::Still => (format!("{what} {are} not drawn{others}: the body stays where it is"), None),
        Reason::Gone => {
            (format!("{what} {are} not drawn{others}: the body is gone before the first of them"), None)
        }
        Reason::TooLong { length, fit } => {
            let length = rounded(length);
            (
                format!("{what} leaves the picture: in its middle, {length} m are more than its width"),
                Some(fit),
            )
        }
        Reason::NoRoom { radius, fit } => {
            let radius = rounded(radius);
            let why = format!("its ends leave no room for one with a radius of {radius} m");
            (format!("{what} is not drawn{others}: {why}"), fit)
        }
    };
    let help = match (fit, &missing.what) {
        (Some(fit), _) => format!("write `{key} = {}`, or leave `{key}` out", rounded(fit)),
        (None, RequestedItem::Coil | RequestedItem::Line) => {
            "move the ends apart, or write `line = \"none\"`".to_owned()
        }
        (None, _) => format!("leave `{key}` out"),
    };
    Diagnostic::warning(Code::NotDrawn, message).help(help)
}

/// Returns the warning about a plot without room in the picture, or about a curve of which no picture shows a point. It points to the plot or
/// the curve, and tells how to mend it.
pub(crate) fn of_plot(scene: &Scene, unseen: &UnseenPlot) -> Diagnostic {
    let warning = |message: String| Diagnostic::warning(Code::NotDrawn, message);
    let plot = |plot: usize| format!("the plot `{}`", scene.plots[plot].name);
    let curve = |of: usize, curve: usize| {
        let noun = scene.plots[of].kind.noun();
        format!("the {noun} `{}` of {}", lettering::plain(&scene.plots[of].curves[curve].name), plot(of))
    };
    let curve_at = |of: usize, curve: usize| scene.places.plots[of].curves[curve];
    match *unseen {
        UnseenPlot::Outside { plot: of } => {
            warning(format!("{} has no room: it leaves the picture", plot(of)))
                .at(scene.places.plots[of].name, "")
                .help("give it another `corner` or `side`, or have fewer plots and labels there")
        }
        UnseenPlot::Covers { plot: of, other, is_beside } => {
            let help = match is_beside {
                true => "give both a smaller `width`, or give one another `corner` or `side`",
                false => "give one of them another `corner` or `side`, or have fewer plots and labels there",
            };
            warning(format!("{} has no room: it covers {}", plot(of), plot(other)))
                .at(scene.places.plots[of].name, "")
                .at(scene.places.plots[other].name, "this one is covered")
                .help(help)
        }
        UnseenPlot::OutOfRange { axis, plot: of, curve: number, values: [low, high], fit } => {
            let (plot, places) = (&scene.plots[of], &scene.places.plots[of]);
            let (formula, key, range) = match axis {
                0 => (&plot.x, "x_range", places.x_range),
                _ => (&plot.curves[number].y, "range", places.range),
            };
            let unit = formula.unit().unwrap_or_default();
            let values = match (rounded(low), rounded(high)) {
                (low, high) if low == high => format!("all values are {low} {unit}"),
                (low, high) => format!("its values are from {low} to {high} {unit}"),
            };
            let message = format!("{} is not drawn: its values are outside of `{key}`", curve(of, number));
            let warning = warning(message).at(curve_at(of, number), values.trim_end());
            let warning = range.into_iter().fold(warning, |it, at| it.at(at, "this contains none of them"));
            let [low, high] = fit.map(rounded);
            warning.help(format!("write `{key} = [{low}, {high}]`, or leave `{key}` out"))
        }
        UnseenPlot::NotPositive { plot: of, curve: number, left_out } => {
            let values = match (left_out.frames, left_out.of) {
                (frames, all) if frames == all => "is not drawn: none of its values is positive".to_owned(),
                (1, all) => format!("has a gap: 1 of its {all} values is not positive"),
                (frames, all) => format!("has gaps: {frames} of its {all} values are not positive"),
            };
            let message = format!("{} {values}", curve(of, number));
            warning(message)
                .at(curve_at(of, number), "a logarithmic axis has a place for positive values only")
                .help("draw a positive formula, such as `abs(…)`, or leave `log` out")
        }
        UnseenPlot::NeverThere { plot: of, curve: number, body } => {
            let name = &scene.bodies[body].name;
            warning(format!("{} is not drawn: `{name}` is never there", curve(of, number)))
                .at(curve_at(of, number), "")
                .help(format!("let `{name}` be there during the run, or leave the curve out"))
        }
        UnseenPlot::Undefined { plot: of, curve: number } => {
            warning(format!("{} is not drawn: it has no finite value at any frame", curve(of, number)))
                .at(curve_at(of, number), "")
                .help("correct the formula, or leave the curve out")
        }
    }
}

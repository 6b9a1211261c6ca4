//! Warnings about arrows, trails and other things that a scene requests but no image shows.

use crate::diagnostic::{Code, Diagnostic};
use crate::picture::number::rounded;
use crate::picture::{NotDrawn, Reason, RequestedItem};
use crate::scene::Quantity;

/// Returns the warning that a requested arrow, trail, ghost or similar is not drawn. It gives the time, the reason, and the key to change.
pub(crate) fn warning(missing: &NotDrawn) -> Diagnostic {
    let NotDrawn { what, name, why, others } = missing;
    let (what, key) = match what {
        RequestedItem::Arrow(quantity) => {
            let words = if *quantity == Quantity::Normal { "normal force" } else { quantity.name() };
            let key = if matches!(missing.why, Reason::Untouched) { "" } else { ".scale" };
            (format!("the arrow for the {words} of `{name}`"), format!("arrows.{}{key}", quantity.name()))
        }
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
            let size = if matches!(missing.what, RequestedItem::Arrow(_) | RequestedItem::Axes) {
                "long"
            } else {
                "wide"
            };
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

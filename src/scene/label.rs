//! The labels, the scale bar and the grid of a scene.

use std::sync::Arc;

use super::{Color, MeasureFormula};
use crate::font::Typeface;

/// A text that is drawn in the picture.
#[derive(Clone, Debug)]
pub struct Label {
    /// The name of the label, unique among labels.
    pub name: String,
    /// The pieces of the label's text, in order.
    pub text: Vec<Piece>,
    /// The position of the label in the picture.
    pub place: LabelPlace,
    /// The times at which the label is visible, s: from the first until before the second.
    pub visible: [f64; 2],
    /// The line height as a fraction of the picture's height. `None` for a size that is easy to read.
    pub size: Option<f64>,
    /// The color of the text. `None` for the default color: dark on a light background, and light on a dark one.
    pub color: Option<Color>,
    /// The font of the text. `None` for the usual one.
    pub own_typeface: Option<Arc<Typeface>>,
}

impl Label {
    /// The name of the middle of the picture among the names of corners.
    pub const CENTER: &str = "center";

    /// The times of a label that is always visible.
    pub const ALWAYS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

    /// Returns the fonts in which the text is set.
    pub fn typeface(&self) -> &Typeface {
        self.own_typeface.as_deref().unwrap_or(Typeface::usual())
    }

    /// Returns whether the label is visible at a time, s.
    pub fn is_visible(&self, time: f64) -> bool {
        self.visible[0] <= time && time < self.visible[1]
    }
}

/// A piece of a label's text.
#[derive(Clone, Debug)]
pub enum Piece {
    /// Text that is the same in all frames.
    Words(String),
    /// The value of a formula at the time of the frame.
    Value {
        /// The formula.
        formula: MeasureFormula,
        /// The number format of the value.
        format: Format,
    },
}

/// The format of a number in a label.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A number with three significant digits.
    Short,
    /// A number with this many decimals.
    Decimals(usize),
    /// Scientific notation with this many decimals and a power of ten.
    Scientific(usize),
}

/// The position of a label in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LabelPlace {
    /// The label stands in a corner of the picture, or at the middle of an edge.
    Corner(Corner),
    /// The label stands in the middle of the picture.
    Center,
    /// The label stands beside a body and moves with it.
    Body {
        /// The index of the body beside which the label stands.
        body: usize,
        /// The side of the body on which the label stands.
        side: Side,
        /// Whether each ghost of the body also has a label, with the values at the time of the ghost.
        ghosts: bool,
    },
}

/// A corner of the picture, or the middle of its top or bottom edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// The top left corner.
    TopLeft,
    /// The middle of the top edge.
    Top,
    /// The top right corner.
    TopRight,
    /// The bottom left corner.
    BottomLeft,
    /// The middle of the bottom edge.
    Bottom,
    /// The bottom right corner.
    BottomRight,
}

impl Corner {
    /// All corners and edges.
    pub const ALL: [Corner; 6] = [
        Corner::TopLeft,
        Corner::Top,
        Corner::TopRight,
        Corner::BottomLeft,
        Corner::Bottom,
        Corner::BottomRight,
    ];

    /// Returns the name of the corner in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Corner::TopLeft => "top-left",
            Corner::Top => "top",
            Corner::TopRight => "top-right",
            Corner::BottomLeft => "bottom-left",
            Corner::Bottom => "bottom",
            Corner::BottomRight => "bottom-right",
        }
    }
}

/// The side of a body on which its label stands, as seen in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The label stands above the body.
    Above,
    /// The label stands below the body.
    Below,
    /// The label stands to the left of the body.
    Left,
    /// The label stands to the right of the body.
    Right,
}

impl Side {
    /// All sides of a body on which a label can stand.
    pub const ALL: [Side; 4] = [Side::Above, Side::Below, Side::Left, Side::Right];

    /// Returns the name of the side in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Side::Above => "above",
            Side::Below => "below",
            Side::Left => "left",
            Side::Right => "right",
        }
    }
}

/// A scale bar in the picture: a bar of known length, with that length written beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleBar {
    /// The length of the bar, m. `None` for about a fifth of the picture's width.
    pub length: Option<f64>,
    /// The corner of the picture in which the bar is drawn.
    pub corner: Corner,
}

/// A grid of numbered lines at regular distances, from which lengths in the picture can be read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The distance between two neighboring lines, m. `None` for a distance that suits the extent of the motion.
    pub spacing: Option<f64>,
    /// The plane in which the grid lies.
    pub plane: GridPlane,
}

/// The plane in which a grid lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridPlane {
    /// The plane of the ground.
    Ground,
    /// A vertical plane behind the motion.
    Wall,
    /// The plane z = 0.
    Xy,
    /// The plane y = 0.
    Xz,
    /// The plane x = 0.
    Yz,
}

impl GridPlane {
    /// All planes of grids.
    pub const ALL: [GridPlane; 5] =
        [GridPlane::Ground, GridPlane::Wall, GridPlane::Xy, GridPlane::Xz, GridPlane::Yz];

    /// Returns the name of the plane in scenes.
    pub fn name(self) -> &'static str {
        match self {
            GridPlane::Ground => "ground",
            GridPlane::Wall => "wall",
            GridPlane::Xy => "xy",
            GridPlane::Xz => "xz",
            GridPlane::Yz => "yz",
        }
    }

    /// Returns whether the plane is level, so that it is seen from above.
    pub fn is_level(self) -> bool {
        matches!(self, GridPlane::Ground | GridPlane::Xz)
    }
}

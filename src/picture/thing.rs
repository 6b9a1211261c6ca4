//! The kinds of things that are drawn beside the bodies.
//!
//! Springs, joints, arrows, axes, the grid, angles, dimension lines and areas all become lists of things. Everything that draws (scripts, the
//! page of the preview, models) knows these kinds only. A new drawing is a new list of things.

use std::borrow::Cow;

use glam::{DMat3, DQuat, DVec3};
use serde::Serialize;

use crate::scene::Color;

/// A thing that is drawn beside the bodies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Thing<'a> {
    /// What the thing shows, such as `spring` or `ball, velocity`.
    #[serde(skip)]
    pub name: Cow<'a, str>,
    /// The shape of the thing, with its position and size.
    #[serde(flatten)]
    pub form: Form,
    /// The color of the thing. Axes have their own colors.
    pub color: Color,
}

/// The shape of a thing. Lengths and positions are in meters, in world axes.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "form", rename_all = "lowercase")]
pub enum Form {
    /// A ball: the pin of a joint, or the end of a spring, rod or rope at a fixed point.
    Ball {
        /// The center of the ball.
        at: DVec3,
        /// The radius of the ball.
        radius: f64,
    },
    /// The coil of a spring.
    Coil {
        /// The two ends of the coil.
        ends: [DVec3; 2],
        /// The radius of the coil.
        radius: f64,
        /// The radius of the wire.
        wire: f64,
        /// The number of turns.
        turns: u32,
    },
    /// A straight cylinder: a rod, a straight spring, an axle, a rail or a wheel.
    Rod {
        /// The two ends of the cylinder's axis.
        ends: [DVec3; 2],
        /// The radius of the cylinder.
        radius: f64,
    },
    /// A rope. A taut rope has two points.
    Rope {
        /// The points that the rope passes through.
        points: Vec<DVec3>,
        /// The radius of the rope.
        radius: f64,
    },
    /// An arrow, which shines and casts no shadow.
    Arrow {
        /// The point where the arrow begins.
        from: DVec3,
        /// The tip of the arrow.
        to: DVec3,
        /// The radius of the arrow's shaft.
        radius: f64,
    },
    /// Coordinate axes: three arrows from one point.
    Axes {
        /// The origin of the axes.
        location: DVec3,
        /// The rotation from world axes to these axes.
        orientation: DQuat,
        /// The length of each axis.
        length: f64,
    },
    /// A thin translucent area, seen from both sides, which casts no shadow: triangles from the first point to each two neighboring others.
    Area {
        /// The points.
        points: Vec<DVec3>,
        /// The part of the light from behind that the area stops.
        opacity: f64,
        /// True for the surface of a liquid, which reflects a little. Other areas shine.
        is_liquid: bool,
    },
    /// Thin straight lines, which shine and cast no shadow: the lines of a grid, an arc, a dimension line.
    Lines {
        /// The lines.
        lines: Vec<Line>,
    },
}

/// A thing that a picture may show, independent of the frame. Some frames may not show it.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedThing<'a> {
    /// What the thing shows.
    pub name: &'a str,
    /// The kind of the thing's shape.
    pub kind: FormKind,
    /// The color of the thing.
    pub color: Color,
}

/// The kind of shape of a spring, a joint, or a part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FormKind {
    /// A ball.
    Ball,
    /// A coil.
    Coil {
        /// The number of turns.
        turns: u32,
        /// The radius of the wire, relative to the radius of the coil.
        wire: f64,
    },
    /// A straight rod.
    Rod,
    /// A rope.
    Rope,
}

/// A thin straight line, drawn as a cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Line {
    /// The start of the line, m.
    pub from: DVec3,
    /// The end of the line, m.
    pub to: DVec3,
    /// Half the width of the line, m.
    pub radius: f64,
}

impl Thing<'_> {
    /// The thin straight lines of the thing. Empty unless it consists of them.
    pub fn lines(&self) -> &[Line] {
        match &self.form {
            Form::Lines { lines } => lines,
            _ => &[],
        }
    }
}

impl Form {
    /// The line segments along the middle of a spring or joint, m. For a coil, the segment of its axis; for a ball, none.
    pub(super) fn middle_lines(&self) -> impl Iterator<Item = [DVec3; 2]> {
        let points: &[DVec3] = match self {
            Form::Coil { ends, .. } | Form::Rod { ends, .. } => ends,
            Form::Rope { points, .. } => points,
            Form::Ball { .. }
            | Form::Arrow { .. }
            | Form::Axes { .. }
            | Form::Area { .. }
            | Form::Lines { .. } => &[],
        };
        points.windows(2).map(|pair| [pair[0], pair[1]])
    }

    /// The lines that texts avoid, each with its width, m.
    pub(super) fn avoided(&self) -> Vec<([DVec3; 2], f64)> {
        match self {
            Form::Ball { .. } | Form::Coil { .. } | Form::Rod { .. } | Form::Rope { .. } => {
                self.middle_lines().map(|line| (line, 2.0 * self.reach())).collect()
            }
            Form::Arrow { from, to, radius } => vec![([*from, *to], 4.0 * radius)],
            Form::Axes { location, orientation, length } => {
                let arms = DMat3::from_quat(*orientation).to_cols_array_2d().map(DVec3::from_array);
                arms.map(|arm| ([*location, *location + arm * *length * 1.1], 0.1 * length)).to_vec()
            }
            Form::Area { .. } => Vec::new(),
            Form::Lines { lines } => {
                lines.iter().map(|line| ([line.from, line.to], 2.0 * line.radius)).collect()
            }
        }
    }

    /// The radius of a spring or joint around its middle line, m. For a coil, this includes the wire.
    pub(super) fn reach(&self) -> f64 {
        match self {
            Form::Coil { radius, wire, .. } => radius + wire,
            Form::Ball { radius, .. }
            | Form::Rod { radius, .. }
            | Form::Rope { radius, .. }
            | Form::Arrow { radius, .. } => *radius,
            Form::Axes { .. } | Form::Area { .. } | Form::Lines { .. } => 0.0,
        }
    }
}

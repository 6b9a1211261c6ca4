//! The patterns in which `repeat` places copies: grid, ring, line, curve and random scatter.

use glam::{DQuat, DVec3};

use super::CopyPose;
use super::curve::Curve;
use super::scatter::Scatter;
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::expand::Expander;
use crate::scene::grammar::TableSpec;
use crate::scene::grammar::bodies::body;
use crate::scene::grammar::repeat::{grid, line, repeat, ring};
use crate::scene::source::{Entry, Node, Table, Value};
use crate::scene::view::View;

/// The pattern in which the copies of a body are placed.
pub(super) enum Pattern {
    /// The number of copies, without a pattern. Formulas with the index `i` give the location of each copy.
    Count(usize),
    Grid {
        counts: Vec<usize>,
        spacing: DVec3,
    },
    Ring {
        count: usize,
        radius: f64,
        axis: DVec3,
        turned: bool,
    },
    Line {
        count: usize,
        from: DVec3,
        to: DVec3,
    },
    Curve(Curve),
    Scatter(Scatter),
}

/// Converts a positive number of copies to `usize`.
fn number(count: i64) -> usize {
    usize::try_from(count).unwrap_or(1)
}

#[allow(clippy::cast_precision_loss, reason = "there are few enough copies")]
pub(super) fn fraction(n: usize, of: usize) -> f64 {
    if of == 0 { 0.0 } else { n as f64 / of as f64 }
}

impl Expander<'_> {
    /// Reads the pattern of a `repeat`. `None` if the pattern has an error, which is reported now or by the later validation.
    pub(super) fn pattern(&mut self, repeat: &Entry, spec: &'static TableSpec) -> Option<Pattern> {
        let alone = Table { entries: vec![repeat.clone()].into() };
        let body = View::new(spec, Some(&alone));
        if matches!(repeat.node.value, Value::Integer(_)) {
            return Some(Pattern::Count(number(body.get_as::<i64>(&body::REPEAT)?)));
        }
        let view = body.variant(&body::REPEAT)?;
        if view.has(&repeat::COUNT) {
            return Some(Pattern::Count(number(view.get(&repeat::COUNT)?)));
        }
        if let Some(grid) = view.variant(&repeat::GRID) {
            return self.grid(&grid);
        }
        if let Some(ring) = view.variant(&repeat::RING) {
            return Some(Pattern::Ring {
                count: number(ring.get(&ring::COUNT)?),
                radius: ring.get(&ring::RADIUS)?,
                axis: ring.get(&ring::AXIS),
                turned: ring.get(&ring::TURNED),
            });
        }
        if let Some(line) = view.variant(&repeat::LINE) {
            let (count, to) = (number(line.get(&line::COUNT)?), line.get(&line::TO)?);
            return Some(Pattern::Line { count, from: line.get(&line::FROM), to });
        }
        if let Some(view) = view.variant(&repeat::CURVE) {
            let at = Curve::formulas(&repeat.node);
            return self.curve(&view, at).map(Pattern::Curve);
        }
        Scatter::read(&view.variant(&repeat::SCATTER)?).map(Pattern::Scatter)
    }

    fn grid(&mut self, view: &View<'_>) -> Option<Pattern> {
        let counts = view.get(&grid::COUNT)?;
        let counts: Vec<usize> = counts.into_iter().map(number).collect();
        let spacing = match view.get_as::<f64>(&grid::SPACING) {
            Some(spacing) => vec![spacing; counts.len()],
            None if view.has(&grid::SPACING) => view.get_as::<Vec<f64>>(&grid::SPACING)?,
            None => vec![0.0; counts.len()],
        };
        if spacing.len() != counts.len() {
            let directions = match counts.len() {
                1 => "1 direction".to_owned(),
                more => format!("{more} directions"),
            };
            let message = format!("expected spacings of {directions}, found {}", spacing.len());
            let error =
                Diagnostic::error(Code::WrongLength, message).help("one number is for all directions");
            let (spacings, spacing, count) =
                (spacing.len(), view.span(&grid::SPACING)?, view.span(&grid::COUNT)?);
            let error = error.at(spacing, "").at(count, format!("the grid has {directions}"));
            // The suggestion adds a count of 1 for each direction that only `spacing` has.
            let padded = counts.iter().map(usize::to_string).chain(std::iter::repeat("1".to_owned()));
            let padded: Vec<String> = padded.take(spacings).collect();
            let is_short = counts.len() < spacings && spacings <= 3;
            self.diagnostics.push(match is_short {
                true => error.fix(count, format!("[{}]", padded.join(", "))),
                false => error,
            });
            return None;
        }
        let along = |direction: usize| spacing.get(direction).copied().unwrap_or(0.0);
        Some(Pattern::Grid { counts, spacing: DVec3::new(along(0), along(1), along(2)) })
    }
}

impl Pattern {
    /// Returns the number of copies along each direction of the pattern.
    pub(super) fn counts(&self) -> Vec<usize> {
        match self {
            Pattern::Count(count) | Pattern::Ring { count, .. } | Pattern::Line { count, .. } => vec![*count],
            Pattern::Grid { counts, .. } => counts.clone(),
            Pattern::Curve(curve) => vec![curve.count()],
            Pattern::Scatter(scatter) => vec![scatter.count],
        }
    }

    /// Returns the offset and rotation of the copy with these indices. Scattered copies get none, because [`Scatter::places`] places all
    /// of them together.
    pub(super) fn place(&self, [i, j, k]: [usize; 3]) -> CopyPose {
        let here = |offset: DVec3| CopyPose { offset, turn: DQuat::IDENTITY };
        match self {
            Pattern::Count(_) | Pattern::Scatter(_) => here(DVec3::ZERO),
            Pattern::Grid { spacing, .. } => {
                #[allow(clippy::cast_precision_loss, reason = "there are few enough copies")]
                let index = DVec3::new(i as f64, j as f64, k as f64);
                here(index * *spacing)
            }
            Pattern::Ring { count, radius, axis, turned } => {
                let angle = std::f64::consts::TAU * fraction(i, *count);
                let across = if axis.x.abs() < 1.0 - 1e-9 { DVec3::X } else { DVec3::Y };
                let first = (across - *axis * axis.dot(across)).normalize();
                let second = axis.cross(first);
                let offset = *radius * (first * libm::cos(angle) + second * libm::sin(angle));
                let turn = if *turned { DQuat::from_axis_angle(*axis, angle) } else { DQuat::IDENTITY };
                CopyPose { offset, turn }
            }
            Pattern::Line { count, from, to } => here(from.lerp(*to, fraction(i, count.saturating_sub(1)))),
            Pattern::Curve(curve) => curve.place(i),
        }
    }
}

impl Curve {
    /// Returns the value of `curve.at` in a `repeat`, the list of coordinate formulas.
    fn formulas(repeat: &Node) -> Option<&Node> {
        let curve = repeat.as_table()?.get("curve")?.node.as_table()?;
        curve.get("at").map(|entry| &entry.node)
    }
}

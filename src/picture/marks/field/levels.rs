//! Lines of equal potential, by marching squares. Source: W. E. Lorensen & H. E. Cline, *Marching cubes*, SIGGRAPH 1987, in two dimensions.

use glam::DVec3;

use super::Region;
use crate::decimal::round_above;
use crate::picture::thing::Line;
use crate::simulate::FieldSampler;

/// The number of cells across and up.
const CELLS_ACROSS_AND_UP: [usize; 2] = [120, 68];
/// The part of the points whose potential is lower, and the part whose potential is higher, than those that the levels divide. Near its
/// sources, a potential can be arbitrarily large.
const EXTREME_PART: f64 = 0.06;
/// The number of levels between these potentials.
const USUAL_NUMBER_OF_LEVELS: f64 = 14.0;
/// The part of the points whose potential is lower, and the part whose potential is higher, than all levels. The lines of higher potentials
/// could not be told apart.
const PART_BEYOND_LEVELS: f64 = 0.03;

/// The levels of a potential: multiples of a spacing within bounds, J.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Levels {
    spacing: f64,
    low: f64,
    high: f64,
}

/// The potentials at the corners of all cells, row by row.
#[allow(clippy::cast_precision_loss, reason = "there are few cells")]
fn potentials(sampler: &mut FieldSampler, region: &Region) -> Vec<f64> {
    let at = |k: usize, cells: usize| 2.0 * k as f64 / cells as f64 - 1.0;
    let mut values = Vec::with_capacity((CELLS_ACROSS_AND_UP[0] + 1) * (CELLS_ACROSS_AND_UP[1] + 1));
    for up in 0..=CELLS_ACROSS_AND_UP[1] {
        for across in 0..=CELLS_ACROSS_AND_UP[0] {
            values.push(sampler.potential(
                region.point([at(across, CELLS_ACROSS_AND_UP[0]), at(up, CELLS_ACROSS_AND_UP[1])]),
            ));
        }
    }
    values
}

/// Chooses the levels of a potential. They are 1, 2 or 5 times a power of ten apart. There are none if the potential is the same everywhere.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the index is that of a point")]
#[allow(clippy::cast_precision_loss, reason = "there are few points")]
pub(super) fn levels(sampler: &mut FieldSampler, region: &Region) -> Levels {
    let mut values = potentials(sampler, region);
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    let at = |part: f64| values.get((part * values.len() as f64) as usize).copied();
    let range = |part: f64| at(part).zip(at(1.0 - part));
    let [Some((low, high)), Some((lowest, highest))] = [EXTREME_PART, PART_BEYOND_LEVELS].map(range) else {
        return Levels::default();
    };
    let spacing = if high > low { round_above((high - low) / USUAL_NUMBER_OF_LEVELS) } else { 0.0 };
    Levels { spacing, low: lowest, high: highest }
}

/// The lines of all levels.
#[allow(clippy::cast_precision_loss, reason = "there are few cells")]
pub(super) fn lines(sampler: &mut FieldSampler, region: &Region, levels: Levels, radius: f64) -> Vec<Line> {
    let spacing = levels.spacing;
    if spacing <= 0.0 {
        return Vec::new();
    }
    let values = potentials(sampler, region);
    let place = |across: usize, up: usize| {
        region.point([
            2.0 * across as f64 / CELLS_ACROSS_AND_UP[0] as f64 - 1.0,
            2.0 * up as f64 / CELLS_ACROSS_AND_UP[1] as f64 - 1.0,
        ])
    };
    let mut lines = Vec::new();
    for up in 0..CELLS_ACROSS_AND_UP[1] {
        for across in 0..CELLS_ACROSS_AND_UP[0] {
            let corners = [(across, up), (across + 1, up), (across + 1, up + 1), (across, up + 1)];
            let cell = corners.map(|(i, k)| (place(i, k), values[k * (CELLS_ACROSS_AND_UP[0] + 1) + i]));
            let [low, high] = [f64::min, f64::max]
                .map(|end| cell.iter().map(|(_, value)| *value).reduce(end).unwrap_or(f64::NAN));
            let last = libm::floor(high.min(levels.high) / spacing);
            let mut number = libm::ceil(low.max(levels.low) / spacing);
            while number <= last {
                lines.extend(crossing(&cell, number * spacing, radius));
                number += 1.0;
            }
        }
    }
    lines
}

/// The lines of a level in a cell, whose corners follow each other around it.
fn crossing(cell: &[(DVec3, f64); 4], level: f64, radius: f64) -> impl Iterator<Item = Line> {
    let mut points = Vec::with_capacity(4);
    for k in 0..4 {
        let ((from, one), (to, other)) = (cell[k], cell[(k + 1) % 4]);
        if (one < level) != (other < level) {
            points.push(from + (to - from) * ((level - one) / (other - one)));
        }
    }
    // Four crossings are a saddle. Both ways to join them are right within the size of a cell.
    let pairs: Vec<Line> =
        points.chunks_exact(2).map(|pair| Line { from: pair[0], to: pair[1], radius }).collect();
    pairs.into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_crosses_a_cell_where_the_potential_has_its_value() {
        let corner = |x: f64, y: f64, value: f64| (DVec3::new(x, y, 0.0), value);
        let cell =
            [corner(0.0, 0.0, 0.0), corner(1.0, 0.0, 4.0), corner(1.0, 1.0, 4.0), corner(0.0, 1.0, 0.0)];
        let lines: Vec<Line> = crossing(&cell, 1.0, 0.1).collect();
        assert_eq!(lines.len(), 1);
        assert_eq!([lines[0].from, lines[0].to], [DVec3::new(0.25, 0.0, 0.0), DVec3::new(0.25, 1.0, 0.0)]);
        assert_eq!(crossing(&cell, 5.0, 0.1).count(), 0);
    }
}

//! Lines of equal potential, by marching squares. Source: W. E. Lorensen & H. E. Cline, *Marching cubes*, SIGGRAPH 1987, in two dimensions.

use glam::DVec3;

use super::Region;
use crate::decimal::round_above;
use crate::picture::thing::Line;
use crate::simulate::FieldSampler;

/// The number of cells across and up.
const CELLS: [usize; 2] = [120, 68];
/// The part of the points whose potential is lower, and the part whose potential is higher, than those that the levels divide. Near its
/// sources, a potential can be arbitrarily large.
const EXTREME: f64 = 0.06;
/// The number of levels between these potentials.
const LEVELS: f64 = 14.0;
/// The largest number of levels of one cell.
const MAX_IN_CELL: f64 = 3.0;

/// The potentials at the corners of all cells, row by row.
#[allow(clippy::cast_precision_loss, reason = "there are few cells")]
fn potentials(sampler: &mut FieldSampler, region: &Region) -> Vec<f64> {
    let at = |k: usize, cells: usize| 2.0 * k as f64 / cells as f64 - 1.0;
    let mut values = Vec::with_capacity((CELLS[0] + 1) * (CELLS[1] + 1));
    for up in 0..=CELLS[1] {
        for across in 0..=CELLS[0] {
            values.push(sampler.potential(region.point([at(across, CELLS[0]), at(up, CELLS[1])])));
        }
    }
    values
}

/// The difference between two levels: 1, 2 or 5 times a power of ten, J. 0 if the potential is the same everywhere.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the index is that of a point")]
#[allow(clippy::cast_precision_loss, reason = "there are few points")]
pub(super) fn spacing_of_levels(sampler: &mut FieldSampler, region: &Region) -> f64 {
    let mut values = potentials(sampler, region);
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    let at = |part: f64| values.get((part * values.len() as f64) as usize).copied();
    let range = at(EXTREME).zip(at(1.0 - EXTREME)).map_or(0.0, |(low, high)| high - low);
    if range > 0.0 { round_above(range / LEVELS) } else { 0.0 }
}

/// The lines of all levels, which are multiples of `spacing`.
#[allow(clippy::cast_precision_loss, reason = "there are few cells")]
pub(super) fn lines(sampler: &mut FieldSampler, region: &Region, spacing: f64, radius: f64) -> Vec<Line> {
    if spacing <= 0.0 {
        return Vec::new();
    }
    let values = potentials(sampler, region);
    let place = |across: usize, up: usize| {
        region.point([2.0 * across as f64 / CELLS[0] as f64 - 1.0, 2.0 * up as f64 / CELLS[1] as f64 - 1.0])
    };
    let mut lines = Vec::new();
    for up in 0..CELLS[1] {
        for across in 0..CELLS[0] {
            let corners = [(across, up), (across + 1, up), (across + 1, up + 1), (across, up + 1)];
            let cell = corners.map(|(i, k)| (place(i, k), values[k * (CELLS[0] + 1) + i]));
            let [low, high] = [f64::min, f64::max]
                .map(|end| cell.iter().map(|(_, value)| *value).reduce(end).unwrap_or(f64::NAN));
            let (first, last) = (libm::ceil(low / spacing), libm::floor(high / spacing));
            // In a steep cell, the lines could not be told apart.
            if !(last - first < MAX_IN_CELL) {
                continue;
            }
            let mut number = first;
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

//! Writes the values of a plot as a CSV table with a row for each frame.

use std::io::Write;

use super::ExportError;
use super::table::Table;
use crate::lettering;
use crate::scene::{MeasureFormula, PlotKind, Scene};
use crate::simulate::{Measures, MomentState, Recorded, Selection};

/// Writes the time, the measure across, and the value of each curve or bar, or, for a histogram, of each of its bodies. Units stand behind the
/// names. A value that is not known, such as the speed of an absent body, is left empty. `number` is the index of the plot in the scene.
/// Returns the number of rows.
///
/// # Errors
/// If the table cannot be written, or the recording cannot be read.
pub(super) fn write(
    run: &Recorded<'_>,
    number: usize,
    selection: &Selection,
    out: impl Write,
) -> Result<usize, ExportError> {
    let scene = run.scene();
    let (plot, measures) = (&scene.plots[number], Measures::new(scene));
    let header = header(scene, number);
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let mut table = Table::new(out, &header)?;
    for exposure in run.exposures(selection) {
        let frame = exposure?.frame;
        let now = MomentState::now(&frame);
        table.numbers(&[frame.time])?;
        let across = has_x(scene, number).then(|| measures.value(&plot.x, &now));
        let values: Vec<f64> = match &plot.kind {
            PlotKind::Histogram { bodies, .. } => {
                let all = plot.curves.iter().flat_map(|curve| {
                    measures.of_each(&curve.y, bodies.iter().copied(), &now).collect::<Vec<_>>()
                });
                all.collect()
            }
            PlotKind::Curves | PlotKind::Bars { .. } => {
                plot.curves.iter().map(|curve| measures.value(&curve.y, &now)).collect()
            }
        };
        for value in across.into_iter().chain(values) {
            if value.is_finite() {
                // Zero has no sign in a table for people.
                table.numbers(&[value + 0.0])?;
            } else {
                table.text("")?;
            }
        }
        table.end_row()?;
    }
    table.finish()
}

/// Whether a plot has a measure across other than the time.
fn has_x(scene: &Scene, number: usize) -> bool {
    let plot = &scene.plots[number];
    plot.kind == PlotKind::Curves && !(plot.is_over_time() && plot.x.asked_unit.is_none())
}

/// The names of the columns, with their units.
fn header(scene: &Scene, number: usize) -> Vec<String> {
    let plot = &scene.plots[number];
    let named = |name: &str, formula: &MeasureFormula| {
        let name = lettering::plain(name);
        match formula.unit() {
            Some(unit) if !unit.is_empty() => format!("{name} [{unit}]"),
            _ => name,
        }
    };
    let mut header = vec!["t [s]".to_owned()];
    if has_x(scene, number) {
        header.push(named(&plot.x_name, &plot.x));
    }
    match (&plot.kind, plot.curves.first()) {
        (PlotKind::Histogram { bodies, .. }, Some(curve)) => {
            header.extend(bodies.iter().map(|body| named(&scene.bodies[*body].name, &curve.y)));
        }
        _ => header.extend(plot.curves.iter().map(|curve| named(&curve.name, &curve.y))),
    }
    header
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two balls fly at 3 m/s and 4 m/s; the second one comes later.
    #[test]
    fn a_plot_is_a_table_of_its_curves() {
        let text = "simulation = { duration = 1, frame_rate = 4, integrator = 'rk4' }
            [body.ball]\nshape.sphere.radius = 0.1\nlocation = [0, 'i', 0]\nvelocity = ['3 + i', 0, 0]\nstart = '0.5*i'
            repeat.count = 2
            [plot.way]\nx = 't:ms'\ny = ['ball[0].x:cm', '2*ball[0].speed']\nnames = ['x_0', 'twice']
            [plot.speeds]\nhistogram = 'ball.speed'\n";
        let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{report}"));
        let run = Recorded::new(&scene).unwrap();
        let table = |number: usize| {
            let mut out = Vec::new();
            let rows = write(&run, number, &Selection::first(5), &mut out).unwrap();
            assert_eq!(rows, 5);
            String::from_utf8(out).unwrap()
        };
        let way = table(0);
        let lines: Vec<&str> = way.lines().collect();
        assert_eq!(lines[0], "t [s],t [ms],x_0 [cm],twice");
        let numbers: Vec<f64> = lines[4].split(',').map(|number| number.parse().unwrap()).collect();
        let expected = [0.75, 750.0, 225.0, 6.0];
        assert!(numbers.iter().zip(expected).all(|(found, it)| (found - it).abs() < 1e-9), "{numbers:?}");
        let speeds = table(1);
        let lines: Vec<&str> = speeds.lines().collect();
        assert_eq!(lines[0], "t [s],ball[0] [m/s],ball[1] [m/s]");
        assert_eq!([lines[1], lines[5]], ["0,3,", "1,3,4"]);
    }
}

//! Writes the page `docs/validation.md` and its plot.

use std::fmt::Write as _;

use jabuka::physics::Method;
use jabuka::report::plot::{Chart, Curve, Picture, svg};

use super::orders::{self, Point};
use super::{REFERENCES, Reference, Solved};

/// Returns an SVG plot of the errors of all methods on all problems, over their costs.
pub(crate) fn plot(solved: &[Solved]) -> String {
    let chart = |(problem, methods): &Solved| {
        let curve = |(method, points): &(&Method, Vec<Point>)| {
            // The method for planets computes gravitation itself and evaluates no force, so its cost is the number of its steps.
            let cost = |point: &Point| match method.is_planetary() {
                true => f64::from(point.steps),
                false => point.evaluations as f64,
            };
            let points = points.iter().filter(|point| point.error > 1e-16 && point.error < 1.0);
            let points = points.map(|point| [cost(point), point.error]).collect();
            Curve { name: method.name.to_owned(), points }
        };
        let axes = ["evaluations of the forces", "error"].map(str::to_owned);
        Chart { title: problem.name.to_owned(), axes, curves: methods.iter().map(curve).collect() }
    };
    let charts: Vec<Chart> = solved.iter().map(chart).collect();
    svg(&Picture::of_charts("Errors of all methods", &charts))
}

/// Returns the text of the page.
pub(crate) fn page(solved: &[Solved]) -> String {
    let mut page = HEAD.to_owned();
    table_of_references(&mut page);
    page.push_str(ORDERS);
    table_of_orders(&mut page, solved);
    page.push_str(PEERS);
    table_of_peers(&mut page);
    page.push_str(TAIL);
    page
}

fn table_of_references(page: &mut String) {
    page.push_str(
        "| problem | reference | method | step or tolerance | steps | evaluations | error | of | allowed |\n",
    );
    page.push_str("| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for reference in REFERENCES {
        let Reference { name, source, what, .. } = reference;
        let name = match reference.file() {
            Some(path) => format!("[{name}](../{path})"),
            None => (*name).to_owned(),
        };
        for (number, &(method, setting, allowed)) in reference.runs.iter().enumerate() {
            let (name, source) = if number == 0 { (name.as_str(), *source) } else { ("", "") };
            let outcome = reference.run(method, setting);
            let (error, steps, evaluations) = (outcome.error, outcome.steps, outcome.evaluations);
            let _ = writeln!(
                page,
                "| {name} | {source} | `{method}` | {} | {steps} | {evaluations} | {} | {what} | {} |",
                short(setting),
                short(error),
                short(allowed)
            );
        }
    }
}

fn table_of_orders(page: &mut String, solved: &[Solved]) {
    page.push_str("\n| method | order |");
    solved.iter().for_each(|(problem, _)| page.push_str(&format!(" {} |", problem.name)));
    page.push_str("\n| --- | --- |");
    solved.iter().for_each(|_| page.push_str(" --- |"));
    for method in Method::all() {
        let _ = write!(page, "\n| `{}` | {} |", method.name, method.order);
        for (_, methods) in solved {
            let found = methods.iter().find(|(other, _)| other.name == method.name);
            let order = found.and_then(|(_, points)| orders::order(points));
            let exact = found.is_some_and(|(_, points)| points.iter().all(|point| point.error < 1e-12));
            let _ = match order {
                _ if exact => write!(page, " exact |"),
                Some(order) => write!(page, " {order:.2} |"),
                None => write!(page, " |"),
            };
        }
    }
    page.push_str("\n\nThe problems:\n\n");
    for (problem, _) in solved {
        let _ = writeln!(page, "- **{}**: {}.", problem.name, problem.meaning);
    }
}

/// Adds a table with the recorded results of other programs on the same problems. The files hold tables of lines `key = value`.
#[allow(clippy::unwrap_used, reason = "it is part of tests")]
fn table_of_peers(page: &mut String) {
    page.push_str("| problem | program | method | settings | steps or evaluations | error | seconds |\n");
    page.push_str("| --- | --- | --- | --- | --- | --- | --- |\n");
    for file in ["orbits.toml", "motions.toml"] {
        let path = format!("{}/benches/peers/{file}", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).unwrap();
        for record in text.split("[[record]]").skip(1) {
            let find = |key: &str| {
                let mut pairs = record.lines().filter_map(|line| line.split_once(" = "));
                pairs.find(|(name, _)| *name == key).map(|(_, value)| value.trim_matches('"'))
            };
            let word = |key: &str| find(key).unwrap();
            let number = |key: &str| find(key).map(|value| short(value.parse().unwrap()));
            let counted =
                ["steps", "evaluations"].iter().find_map(|key| find(key).map(|n| format!("{n} {key}")));
            let error = number("location_error").or_else(|| number("error"));
            let _ = writeln!(
                page,
                "| {} | {} | {} | {} | {} | {} | {} |",
                word("problem").replace('_', " "),
                word("program"),
                word("method"),
                word("settings"),
                counted.unwrap_or_default(),
                error.unwrap_or("the others' reference".to_owned()),
                find("seconds").unwrap_or_default()
            );
        }
    }
}

/// Formats a number with two significant digits, so that differences in rounding do not change the page.
fn short(number: f64) -> String {
    if number == 0.0 {
        return "0".to_owned();
    }
    format!("{number:.1e}").replace(".0e", "e")
}

#[allow(clippy::unwrap_used, reason = "it is part of tests")]
pub(crate) fn is_up_to_date(name: &str, text: &str) {
    let path = format!("{}/docs/{name}", env!("CARGO_MANIFEST_DIR"));
    if std::env::var_os("JABUKA_UPDATE_DOCS").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(text == written, "docs/{name} is out of date: see the comment on this module");
}

const HEAD: &str = "# How accurate the methods are

The tests write this page: `JABUKA_UPDATE_DOCS=1 cargo test --test physics validation`. It has the same bytes on every machine, and a test fails
if a number changes. Steps and evaluations of the forces are counted during the runs. The only times on this page are those of other programs,
from the records in [benches/peers/](../benches/peers).

## Problems with known solutions

Each problem is a scene. The linked scenes are in the gallery; the others are in
[references.rs](../tests/physics/validation/references.rs). A test fails if an error exceeds the allowed one.

";

const ORDERS: &str = "
An evaluation computes the forces on all bodies once. `gauss-radau` needs more evaluations per step than `dop853`, and often fewer steps. The
methods with a fixed step can also solve joints: each pendulum here hangs on a rod, which is a constraint.

## Orders

Half the step divides the error of a method of order p by 2ᵖ. The table shows the measured order: the slope of log(error) over log(step). It is
a least-squares fit to the four finest steps with an error between rounding (2e-14) and 0.2. The test requires at least the nominal order minus
0.2. For `gauss-radau` it requires 13: with shorter steps, its error is below rounding; with longer ones, higher terms count. For `dop853` and
`gauss-radau` on ellipses it requires nothing, because there the sign of the error changes with the step.

![Errors of all methods over evaluations of the forces](validation_orders.svg)

A straight line is a power law. For a given error, the leftmost method is the cheapest. For `wisdom-holman`, the axis shows steps.
";

const PEERS: &str = "
A cell is empty if the method was not tried on the problem, or if no step was short enough to show the order.

## Other programs

The scripts in [benches/peers/](../benches/peers) ran REBOUND, SciPy and MuJoCo on the same problems and recorded the results. The error is in the
position, in units of the problem; for the wing nut, it is in the angular velocity. The times include only the program's own computation.

";

const TAIL: &str = "
`gauss-radau` is the same method as IAS15, `wisdom-holman` as WHFast, and `dop853` as DOP853. The benches `kepler` and `planets` measure
jabuka's times on the machine on which REBOUND runs.

## Not on this page

Impacts, friction and heaps have their own tests in [tests/physics/](../tests/physics). For example, impacts between steps keep the order of the
method, a ball with restitution 1 keeps its height, and a cradle keeps its energy.
";

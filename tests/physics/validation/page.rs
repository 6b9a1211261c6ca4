//! Writes the page `docs/validation.md` and its plot.

use std::fmt::Write as _;

use jabuka::dynamics::Method;
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
        "| problem | known by | method | step or tolerance | steps | evaluations | error | of | allowed |\n",
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
    page.push_str("\n| method | its order |");
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

const HEAD: &str = "# How right the methods are

The tests make this page: `JABUKA_UPDATE_DOCS=1 cargo test --test physics validation`. On every machine they come to the same bytes, and they fail
where a figure changes. Steps and evaluations of the forces are counted while the problem is solved; times are none of ours, but those of
the records in [benches/peers/](../benches/peers).

## Problems with a known end

Each is a scene that is run to its end. What is linked is a scene of the gallery; the others stand in
[references.rs](../tests/physics/validation/references.rs). An error above the allowed one fails the test.

";

const ORDERS: &str = "
An evaluation sums up the forces on all bodies once. `gauss-radau` needs more of them for a step than `dop853`, and fewer steps. The methods of
equal steps solve joints as well: a pendulum on a rod is one with a constraint.

## Orders

A method of order p has 2ᵖ times less error at half the step. The table shows the slope of the logarithm of the error over that of the step, by least
squares over the four finest steps whose error is larger than rounding (2e-14) and less than 0.2. The test asks for at least the order in the
first column less 0.2, and for 13 of `gauss-radau`, whose error is only above rounding where its steps are so long that higher terms
count. On ellipses the orders of `dop853` and `gauss-radau` are not asked for: the sign of their errors changes there with the length of the step.

![Errors of all methods over evaluations of the forces](validation_orders.svg)

Each slope is a power law. For equal accuracy, the method farthest to the left is the cheapest; `wisdom-holman` is drawn over its steps.
";

const PEERS: &str = "
What is empty was not tried, or a step short enough to see the order was not among those that were tried.

## Beside other programs

REBOUND, SciPy and MuJoCo on the same problems, as the scripts in [benches/peers/](../benches/peers) have recorded them. The error is that of places in
the units of the problem, and of an angular velocity for the wing nut. Seconds are of the machine of the record, and of the program alone.

";

const TAIL: &str = "
IAS15 is the method that `gauss-radau` is, WHFast that of `wisdom-holman`, DOP853 that of `dop853`. The benches `kepler` and
`planets` measure how long ours take, on the machine where REBOUND runs, too.

## What is not here

Impacts, friction and heaps have tests of their own, in [tests/physics/](../tests/physics): located impacts keep the order of the
method, a ball with restitution 1 its height, a cradle its energy.
";

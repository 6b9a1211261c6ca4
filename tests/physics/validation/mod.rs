//! Measures the accuracy of the methods, and writes the results to `docs/validation.md`.
//!
//! After a change, this command writes the page again: `JABUKA_UPDATE_DOCS=1 cargo test --test physics validation`.

mod orders;
mod page;
mod references;

use jabuka::physics::Method;

use orders::{PROBLEMS, Point, Problem};
use references::{Outcome, REFERENCES, Reference};

/// A problem, and the measured errors of each method that can solve it.
type Solved = (&'static Problem, Vec<(&'static Method, Vec<Point>)>);

fn solved() -> Vec<Solved> {
    let of = |problem: &'static Problem| {
        let methods = Method::all().filter(|method| problem.is_planetary || !method.is_planetary());
        (problem, methods.map(|method| (method, problem.solve(method))).collect())
    };
    PROBLEMS.iter().map(of).collect()
}

#[test]
fn each_method_has_its_order() {
    for (problem, methods) in solved() {
        for (method, points) in methods {
            let Some(required) = orders::required(problem, method) else { continue };
            let order = orders::order(&points);
            let has_it = order.is_some_and(|order| order >= required);
            assert!(has_it, "{} of {}: {order:?} {points:?}", method.name, problem.name);
        }
    }
}

#[test]
fn the_reference_problems_end_as_they_must() {
    for reference in REFERENCES {
        for &(method, setting, allowed) in reference.runs {
            let Outcome { error, .. } = reference.run(method, setting);
            assert!(
                error < allowed,
                "{} by {method} at {setting:e}: {error:e} ≥ {allowed:e}",
                reference.name
            );
        }
    }
}

#[test]
fn the_page_is_up_to_date() {
    let solved = solved();
    page::is_up_to_date("validation.md", &page::page(&solved));
    page::is_up_to_date("validation_orders.svg", &page::plot(&solved));
}

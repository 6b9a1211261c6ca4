//! Tests that inner loops allocate no memory. The crate `allocation-counter` counts the allocations of the whole test program.

use std::hint::black_box;

use jabuka::scene::expression::{Program, Scope};

#[test]
fn a_million_evaluations_of_a_formula_allocate_nothing() {
    let mut scope = Scope::default();
    ["x", "v", "t"].into_iter().for_each(|name| _ = scope.slot(name));
    // The last formula needs more values than the evaluator's small stack holds.
    let tree = (0..6).fold("(x + sin(t))".to_owned(), |tree, _| format!("({tree} - v*{tree})"));
    for text in ["-4*x - 0.5*v", "if(x < 0, 0.5*sin(2*pi*t), max(x, v, t^3))", &tree] {
        let program = Program::compile(text, &scope).unwrap();
        let mut sum = 0.0;
        let counted = allocation_counter::measure(|| {
            let mut inputs = [0.5, -0.25, 0.0];
            for _ in 0..1_000_000 {
                inputs[2] += 1e-6;
                sum += program.eval(black_box(&inputs));
            }
        });
        assert!(sum.is_finite() && sum != 0.0);
        assert_eq!(counted.count_total, 0, "{text}");
    }
    let counted = allocation_counter::measure(|| _ = black_box(Program::compile("x", &scope)));
    assert!(counted.count_total > 0, "nothing is counted");
}

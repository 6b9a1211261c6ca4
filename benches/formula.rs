//! Compares a compiled formula with the same expression as a Rust function. Each is evaluated a million times, each time with other
//! numbers. The ratio of the medians counts. It should stay below 5.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::cast_precision_loss,
    reason = "a benchmark stops at the first surprise, and prints"
)]

use std::f64::consts::PI;
use std::hint::black_box;
use std::time::Instant;

use jabuka::scene::expression::{Program, Scope};

const EVALUATIONS: usize = 1_000_000;
const ROUNDS: usize = 15;

/// A formula of x, v, t, k, c and r, and the same expression as a Rust function.
type Pair = (&'static str, fn(&[f64; 6]) -> f64);

const PAIRS: [Pair; 9] = [
    ("-k*x - c*v", |&[x, v, _, k, c, _]| -k * x - c * v),
    ("-4*x - 0.5*v", |&[x, v, ..]| -4.0 * x - 0.5 * v),
    ("1 + x*(2 + x*(3 + x*(4 + x)))", |&[x, ..]| 1.0 + x * (2.0 + x * (3.0 + x * (4.0 + x)))),
    ("x^3 - 2*x^2 + 5*x - 7", |&[x, ..]| x * x * x - 2.0 * (x * x) + 5.0 * x - 7.0),
    ("(x - v)*(k + c)/(1 + r^2)", |&[x, v, _, k, c, r]| (x - v) * (k + c) / (1.0 + r * r)),
    ("-k*x/(x^2 + v^2)^1.5", |&[x, v, _, k, ..]| -k * x / libm::pow(x * x + v * v, 1.5)),
    ("if(x < 0, -k*x, 0)", |&[x, _, _, k, ..]| if x < 0.0 { -k * x } else { 0.0 }),
    ("0.5*sin(2*pi*t) + r*cos(t)", |&[_, _, t, _, _, r]| 0.5 * libm::sin(2.0 * PI * t) + r * libm::cos(t)),
    ("exp(-c*t)*cos(k*t)", |&[_, _, t, k, c, _]| libm::exp(-c * t) * libm::cos(k * t)),
];

fn main() {
    let mut scope = Scope::default();
    ["x", "v", "t", "k", "c", "r"].into_iter().for_each(|name| _ = scope.slot(name));
    let inputs = inputs();
    println!("{EVALUATIONS} evaluations, nanoseconds each, median of {ROUNDS} rounds");
    println!("    Rust  formula  ratio");
    for (text, plain) in PAIRS {
        let program = Program::compile(text, &scope).unwrap();
        let (mut plains, mut formulas) = (Vec::new(), Vec::new());
        for _ in 0..ROUNDS {
            // `black_box` hides both functions from the compiler, because in a run, it does not know the formula either.
            let plain = black_box(plain);
            let (seconds, expected) = timed(&inputs, plain);
            plains.push(seconds);
            let program = black_box(&program);
            let (seconds, sum) = timed(&inputs, |inputs| program.eval(inputs));
            formulas.push(seconds);
            assert!((sum - expected).abs() <= 1e-9 * expected.abs(), "{text}: {sum} {expected}");
        }
        let [plain, formula] = [plains, formulas].map(|times| median(times) / EVALUATIONS as f64 * 1e9);
        println!("{plain:8.2} {formula:8.2} {:6.2}  {text}", formula / plain);
    }
}

/// Returns the time of the evaluations, s, and the sum of their values.
fn timed(inputs: &[[f64; 6]], evaluate: impl Fn(&[f64; 6]) -> f64) -> (f64, f64) {
    let start = Instant::now();
    let mut sum = 0.0;
    for _ in 0..EVALUATIONS / inputs.len() {
        sum += inputs.iter().map(&evaluate).sum::<f64>();
    }
    (start.elapsed().as_secs_f64(), sum)
}

/// Returns numbers that need all digits. They are few enough to stay in the first-level cache.
fn inputs() -> Vec<[f64; 6]> {
    let row = |i: usize| {
        let part = |k: f64| (i as f64 * k).fract();
        [part(0.618_033_988) - 0.5, -part(0.414_213_562), 10.0 * part(0.732_050_807), 4.0, 0.125, 2.0]
    };
    (0..500).map(row).collect()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_unstable_by(f64::total_cmp);
    times[times.len() / 2]
}

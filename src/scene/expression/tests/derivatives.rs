//! Compares symbolic derivatives with difference quotients.

use super::super::{Formula, Scope};

/// Returns the derivative of a formula at `t`, and the central difference (f(t + h) − f(t − h)) / 2h. The central difference has a
/// truncation error of h² f'''/6, with h² = 1e-10, and a rounding error of about 1e-16 × |f| / h = 1e-11 × |f|.
fn both(text: &str, t: f64) -> (f64, f64) {
    /// The step h of the central difference.
    const DIFFERENCE_STEP: f64 = 1e-5;
    let mut scope = Scope::default();
    scope.slot("t");
    let resolved = Formula::parse(text).unwrap().resolve(&scope).unwrap();
    let derivative = resolved.derivative(0).compile().unwrap();
    let formula = resolved.compile().unwrap();
    let difference = (formula.eval(&[t + DIFFERENCE_STEP]) - formula.eval(&[t - DIFFERENCE_STEP]))
        / (2.0 * DIFFERENCE_STEP);
    (derivative.eval(&[t]), difference)
}

#[test]
fn every_operation_has_its_derivative() {
    for text in [
        "3",
        "t",
        "-t",
        "2*t - 7",
        "t*t",
        "t^3",
        "t^2.5",
        "t^-2",
        "2^t",
        "t^t",
        "(t+1)/(t*t+2)",
        "sin(3*t)",
        "cos(t^2)",
        "tan(t/2)",
        "asin(t/3)",
        "acos(t/3)",
        "atan(2*t)",
        "atan2(t, 2 - t)",
        "sinh(t)",
        "cosh(2*t)",
        "tanh(t)",
        "exp(-t)",
        "ln(t)",
        "log10(t)",
        "log2(3*t)",
        "sqrt(t)",
        "cbrt(t)",
        "hypot(t, 2*t, 1)",
        "abs(t - 2)",
        "sign(t)",
        "floor(t*7)",
        "deg(t)",
        "rad(t*t)",
        "t % 0.3",
        "7 % t",
        "min(t, 1)",
        "max(t, 1, t^2)",
        "clamp(t, 0, 0.9)",
        "lerp(t, t^2, sin(t))",
        "step(0.3, t)*t",
        "smoothstep(0, 2, t)",
        "smoothstep(t/2, 2 + t, t^2)",
        "if(t > 1, t^2, t^3)",
        "t > 0.2 and t < 4",
        "sin(cos(sin(t)))*exp(t)/t",
    ] {
        for t in [0.45, 0.73, 1.29] {
            let (derivative, difference) = both(text, t);
            let off = (derivative - difference).abs();
            assert!(
                off < 1e-8 * (1.0 + derivative.abs()),
                "({text})' at {t}: {derivative}, not {difference}"
            );
        }
    }
}

#[test]
fn what_stands_still_at_the_tip_of_a_root_does_not_move() {
    for text in ["sqrt(t*0)", "hypot(t, t)*0", "cbrt(t^3)"] {
        assert_eq!(both(text, 0.0).0, 0.0, "{text}");
    }
}

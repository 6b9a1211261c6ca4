//! Checks the values of formulas.

use std::f64::consts::{E, PI, TAU};

use super::super::{Draw, FUNCTIONS, Formula, Function, Program, Scope};
use super::{scope, value};

#[test]
fn operators_bind_as_in_mathematics() {
    for (text, expected) in [
        ("-x^2", -9.0),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("2^-x^2", 1.0 / 512.0),
        ("-2^2", -4.0),
        ("(-2)^2", 4.0),
        ("1 - 2 - 3", -4.0),
        ("24/4/2", 3.0),
        ("2*3 + 4*5", 26.0),
        ("2 + 3*4^2", 50.0),
        ("7 % 4 * 2", 6.0),
        ("-x*y", 6.0),
        ("x--y", 1.0),
        ("+x - -x", 6.0),
        ("1 + 2 < 4 and 1 < 2", 1.0),
        ("1 or 0 and 0", 1.0),
        ("not x == 2", 1.0),
        ("not 0 + 1", 0.0),
        ("x/y/z", -3.0),
        ("x - (y - z)", 5.5),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn numbers_are_written_in_many_ways() {
    for (text, expected) in [
        ("1", 1.0),
        ("1.5", 1.5),
        (".5", 0.5),
        ("1.", 1.0),
        ("1e-3", 1e-3),
        ("2.5E+2", 250.0),
        ("1_000", 1000.0),
        ("  7 ", 7.0),
        ("pi", PI),
        ("tau", TAU),
        ("e", E),
        ("2*e-3", 2.0 * E - 3.0),
        ("r", 2.5),
        ("(r)", 2.5),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn every_function_computes_what_its_name_says() {
    let values = [
        ("sin(z)", libm::sin(0.5)),
        ("cos(z)", libm::cos(0.5)),
        ("tan(z)", libm::tan(0.5)),
        ("asin(z)", libm::asin(0.5)),
        ("acos(z)", libm::acos(0.5)),
        ("atan(x)", libm::atan(3.0)),
        ("atan2(x, y)", libm::atan2(3.0, -2.0)),
        ("sinh(x)", libm::sinh(3.0)),
        ("cosh(x)", libm::cosh(3.0)),
        ("tanh(x)", libm::tanh(3.0)),
        ("deg(pi)", 180.0),
        ("rad(180)", PI),
        ("exp(x)", libm::exp(3.0)),
        ("ln(e)", 1.0),
        ("log10(1000)", 3.0),
        ("log2(x + 5)", 3.0),
        ("sqrt(x*x)", 3.0),
        ("cbrt(27)", 3.0),
        ("hypot(x, 4)", 5.0),
        ("hypot(2, x, 6)", 7.0),
        ("abs(y)", 2.0),
        ("sign(y) + sign(0) + sign(x)*10", 9.0),
        ("floor(-z)", -1.0),
        ("ceil(z)", 1.0),
        ("round(-2.5)", -3.0),
        ("trunc(-2.5)", -2.0),
        ("mod(-1, 4)", 3.0),
        ("mod(1, -4)", -3.0),
        ("-1 % 4", 3.0),
        ("mod(8, 4)", 0.0),
        ("min(x, y, z)", -2.0),
        ("max(y, x, z)", 3.0),
        ("clamp(x, 0, 1) + clamp(y, -1, 1) + clamp(z, 0, 1)", 0.5),
        ("lerp(10, 20, z)", 15.0),
        ("mix(x, y, 0.2)", 2.0),
        ("step(1, x) - step(1, z)", 1.0),
        ("smoothstep(0, 1, z) + smoothstep(0, 1, x)", 1.5),
        ("if(x > y, 10, 20)", 10.0),
        ("if(x < y, 10, 20)", 20.0),
        ("uniform(10, 20)", 12.5),
        ("normal(10, 20)", 15.0),
    ];
    for (text, expected) in values {
        assert!((value(text) - expected).abs() < 1e-14, "{text}: {}", value(text));
    }
    for Function { name, .. } in FUNCTIONS {
        assert!(values.iter().any(|(text, _)| text.contains(&format!("{name}("))), "{name} is not tested");
    }
}

#[test]
fn comparisons_give_one_or_zero_and_a_choice_computes_one_side_only() {
    for (text, expected) in [
        ("(x < 3) + (x <= 3)*10 + (x > 2)*100 + (x >= 4)*1000", 110.0),
        ("(x == 3) + (x != 3)*10", 1.0),
        ("if(zero == 0, 1, 1/zero)", 1.0),
        ("if(y + 2, 1/(y + 2), 7)", 7.0),
        ("y + 2 != 0 and 1/(y + 2) > 1", 0.0),
        ("y + 2 == 0 or 1/(y + 2) > 1", 1.0),
        ("x and y", 1.0),
        ("not (x or y)", 0.0),
        ("2*if(x > 0, if(y > 0, 1, 2), 3) + if(z, x, y)*if(y, z, x)", 5.5),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn what_is_constant_is_computed_once() {
    let constant = |text: &str| Formula::parse(text).unwrap().resolve(&scope()).unwrap().as_constant();
    assert_eq!(constant("2*pi*r^2"), Some(2.0 * PI * 6.25));
    assert_eq!(constant("if(r > 2, sqrt(16), x)"), Some(4.0));
    assert_eq!(constant("x - x"), None);
    assert_eq!(constant("1/zero"), None);
}

#[test]
fn powers_are_products_where_they_can_be() {
    for (text, expected) in [
        ("x^0", 1.0),
        ("y^3", -8.0),
        ("(x + 0)^2", 9.0),
        ("x^-2", 1.0 / 9.0),
        ("y^5", -32.0),
        ("y^-1", -0.5),
        ("x^16", 43_046_721.0),
        ("x^z", libm::pow(3.0, 0.5)),
        ("2^0.5", libm::pow(2.0, 0.5)),
        ("x^17", libm::pow(3.0, 17.0)),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn random_numbers_are_given_in_the_order_of_the_text() {
    let resolved =
        Formula::parse("uniform(0, 10) + 100*normal(0, 1) + x").unwrap().resolve(&scope()).unwrap();
    assert_eq!(resolved.draws(), [Draw::Uniform, Draw::Normal]);
    assert_eq!(resolved.inputs(), 5);
    assert_eq!(resolved.value(&[3.0, 0.0, 0.0, 0.5, 2.0]), Ok(208.0));
    let drawn = resolved.with_draws(&[0.5, 2.0]);
    assert_eq!((drawn.inputs(), drawn.draws().len()), (3, 0));
    assert_eq!(drawn.compile().unwrap().eval(&[3.0, 0.0, 0.0]), 208.0);
    assert!(Formula::parse("uniform(0, 1)").unwrap().resolve(&Scope::default()).is_err());
}

#[test]
fn a_long_formula_and_a_deep_one_compile() {
    let sum = vec!["x"; 3000].join("+");
    assert_eq!(Program::compile(&sum, &scope()).unwrap().eval(&[2.0, 0.0, 0.0]), 6000.0);
    let powers = vec!["x"; 99].join("^");
    assert_eq!(Program::compile(&powers, &scope()).unwrap().eval(&[1.0, 0.0, 0.0]), 1.0);
    let nested = format!("{}x{}", "lerp(0, y, ".repeat(98), ")".repeat(98));
    let program = Program::compile(&nested, &scope()).unwrap();
    assert_eq!(program.eval(&[3.0, 1.0, 0.0]), 3.0);
    let too_deep = format!("{}x{}", "lerp(0, y, ".repeat(190), ")".repeat(190));
    assert_eq!(
        Program::compile(&too_deep, &scope()).unwrap_err()[0].message,
        "the formula is nested too deeply"
    );
    let tree = |leaf: &str| (0..10).fold(leaf.to_owned(), |tree, _| format!("({tree}-{tree})"));
    assert_eq!(value(&tree("x")), 0.0);
}

#[test]
fn every_instruction_computes_what_the_tree_does() {
    let formulas = [
        "x",
        "2.5",
        "x + y",
        "x + 2",
        "2 + x",
        "x - y",
        "x - 2",
        "2 - x",
        "x*y",
        "x*2",
        "2*x",
        "x/y",
        "x/2",
        "2/x",
        "sin(x)",
        "sin(x) + y",
        "sin(x) + 2",
        "y + sin(x)",
        "2 + sin(x)",
        "sin(x) - y",
        "sin(x) - 2",
        "y - sin(x)",
        "2 - sin(x)",
        "sin(x)*y",
        "sin(x)*2",
        "y*sin(x)",
        "2*sin(x)",
        "sin(x)/y",
        "sin(x)/2",
        "y/sin(x)",
        "2/sin(x)",
        "sin(x) + y*z",
        "sin(x) - y*z",
        "sin(x) + y*2",
        "sin(x) - 2*y",
        "y*z + sin(x)",
        "2*y + sin(x)",
        "y*z - sin(x)",
        "sin(x)*y + 2",
        "sin(x)*y - 2",
        "2 + y*sin(x)",
        "2 - y*sin(x)",
        "sin(x) + cos(y)",
        "sin(x)*cos(y)",
        "sin(x) - cos(y)",
        "sin(x)/cos(y)",
        "sin(x) - (cos(y) - (sin(z) - cos(x)))",
        "sin(x)/((cos(y) + sin(z))*(sin(x) + cos(z)) + cos(x))",
        "sin(x) - ((cos(y) + sin(z))*(sin(x) + cos(z)) + cos(x))",
        "-x",
        "sin(-x)",
        "sin(x)^2",
        "x^2",
        "x^3",
        "sin(x)^3",
        "sqrt(x)",
        "x^5",
        "x^-5",
        "sin(cos(x))",
        "atan2(x, y)",
        "atan2(2, x)",
        "atan2(x, (cos(y) + sin(z))*(sin(x) + cos(z)))",
        "lerp(sin(x), cos(y), sin(z))",
        "if(x, y, z)",
    ];
    let mut used = std::collections::BTreeSet::new();
    for text in formulas {
        value(text);
        let program = Program::compile(text, &scope()).unwrap();
        let name = |instruction: &_| format!("{instruction:?}").split(' ').next().unwrap().to_owned();
        used.extend(program.code.instructions.iter().map(name));
    }
    let source = include_str!("../program.rs");
    let (_, list) = source.split_once("enum Instruction {").unwrap();
    let (list, _) = list.split_once("\n}").unwrap();
    let known = list.lines().map(|line| line.trim().split([' ', ',']).next().unwrap());
    let known: Vec<&str> = known.filter(|name| name.starts_with(char::is_uppercase)).collect();
    assert!(known.len() > 40, "{known:?}");
    for name in known {
        assert!(used.contains(name), "no formula uses {name}");
    }
}

#[test]
fn what_needs_more_of_the_stack_is_computed_first() {
    let right = (0..90).fold("sin(x)".to_owned(), |inner, _| format!("cos(y) - ({inner})"));
    assert!(Program::compile(&right, &scope()).unwrap().code.depth <= 3);
    assert!(Program::compile("-x*y - r*z + (x - y)*(y - z)", &scope()).unwrap().code.depth <= 3);
}

use glam::DVec3;

use crate::picture::{Form, Plan};
use crate::scene::Scene;
use crate::simulate::{Frames, survey};

/// Two opposite charges, seen from the front.
const CHARGES: &str = "
    simulation.duration = 0
    environment.ground = false
    [body.plus]
    shape.sphere.radius = 0.1
    location = [-1, 0, 0]
    charge = 2e-6
    [body.minus]
    shape.sphere.radius = 0.1
    location = [1, 0, 0]
    charge = -1e-6
    [force.q.coulomb]
    [camera]
    location = [0, 0, 10]
    look_at = [0, 0, 0]
    ";

/// Returns the lines and the arrows of a field.
fn drawn(text: &str) -> (Vec<[DVec3; 2]>, Vec<[DVec3; 2]>) {
    let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{report}"));
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let frame = Frames::new(&scene).next().unwrap().unwrap();
    let (mut lines, mut arrows) = (Vec::new(), Vec::new());
    for thing in plan.marks(&frame) {
        match thing.form {
            Form::Lines { lines: all } => lines.extend(all.into_iter().map(|line| [line.from, line.to])),
            Form::Arrow { from, to, .. } => arrows.push([from, to]),
            _ => {}
        }
    }
    (lines, arrows)
}

/// The number of lines at a charge is proportional to it, and along each line q₁ cos θ₁ + q₂ cos θ₂ is constant. Source: J. C. Maxwell, *A
/// Treatise on Electricity and Magnetism*, I, ch. VII.
#[test]
fn field_lines_enclose_constant_flux() {
    let (lines, arrows) = drawn(&format!("{CHARGES}[field.e]\nforce = 'q'\nshow = 'lines'\ncount = 20"));
    let [plus, minus] = [DVec3::new(-1.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 0.0)];
    let flux = |point: DVec3| {
        let cos = |of: DVec3| (point - of).normalize().x;
        2.0 * cos(plus) - cos(minus)
    };
    let near =
        |at: DVec3| lines.iter().filter(|line| line.iter().any(|end| end.distance(at) < 0.115)).count();
    assert!((18..=24).contains(&near(plus)), "{}", near(plus));
    assert!((8..=14).contains(&near(minus)), "{}", near(minus));
    assert!((15..=30).contains(&arrows.len()), "{}", arrows.len());
    let mut change: f64 = 0.0;
    for [from, to] in &lines {
        change = change.max((flux(*from) - flux(*to)).abs());
    }
    // A line has up to 300 steps. If each kept the flux to 3e-5, the whole line keeps it to 1 %.
    assert!(lines.len() > 500 && change < 3e-4, "{} lines, {change}", lines.len());
    let mean: f64 =
        lines.iter().map(|[from, to]| (flux(*from) - flux(*to)).abs()).sum::<f64>() / lines.len() as f64;
    assert!(mean < 3e-5, "{mean}");
}

/// A camera that looks from aside sees more of the plane on one side: lines reach all edges of the picture.
#[test]
fn lines_fill_the_picture() {
    let equal = CHARGES.replace("-1e-6", "2e-6");
    let aside = equal.replace("location = [0, 0, 10]", "location = [6, 2, 9]");
    for show in ["lines", "levels"] {
        let text = format!("{aside}[field.e]\nforce = 'q'\nshow = '{show}'");
        let scene = Scene::parse(&text).unwrap();
        let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
        let frame = Frames::new(&scene).next().unwrap().unwrap();
        let screen = plan.camera(&frame).screen();
        let aspect = f64::from(scene.output.height) / f64::from(scene.output.width);
        let (lines, _) = drawn(&text);
        let mut reached = [0.0_f64; 4];
        for point in lines.iter().flatten().filter_map(|end| screen.project(*end)) {
            let places = [-point.x, point.x, -point.y / aspect, point.y / aspect];
            reached = std::array::from_fn(|edge| reached[edge].max(places[edge]));
        }
        assert!(reached.iter().all(|reached| *reached > 0.95), "{show}: {reached:?}");
    }
}

/// Lines of equal potential are where k (q₁/r₁ + q₂/r₂) is a multiple of a round number.
#[test]
fn levels_are_multiples_of_a_round_potential() {
    let (lines, _) = drawn(&format!("{CHARGES}[field.e]\nforce = 'q'\nshow = 'levels'"));
    let potential = |point: DVec3| {
        let k = crate::physics::Coulomb::CONSTANT;
        k * (2e-6 / point.distance(DVec3::new(-1.0, 0.0, 0.0))
            - 1e-6 / point.distance(DVec3::new(1.0, 0.0, 0.0)))
    };
    let far: Vec<f64> = lines
        .iter()
        .map(|line| line[0])
        .filter(|point| point.x.abs() > 2.0 || point.y.abs() > 1.0)
        .map(potential)
        .collect();
    assert!(far.len() > 200, "{}", far.len());
    // Between the levels, potentials are missing.
    let steps = [1000.0, 2000.0, 5000.0, 500.0];
    let rest =
        |step: f64| far.iter().map(|value| (value / step - (value / step).round()).abs()).fold(0.0, f64::max);
    assert!(steps.iter().any(|step| rest(*step) < 0.05), "{:?}", steps.map(rest));
}

/// In a uniform field, all arrows are alike. A field towards the camera is a circle with a dot.
#[test]
fn arrows_show_direction_and_strength() {
    let uniform = "
        simulation.duration = 0\nenvironment.ground = false\n[body.a]\nshape.sphere.radius = 0.1\ncharge = 1\n
        [force.f.lorentz]\nelectric = [0, 2, 0]\nmagnetic = [0, 0, 3]\n[camera]\nlocation = [0, 0, 10]\nlook_at = [0, 0, 0]\n";
    let (lines, arrows) = drawn(&format!("{uniform}[field.e]\nforce = 'f'\nscale = 0.1"));
    assert!(arrows.len() > 50 && lines.is_empty(), "{} arrows", arrows.len());
    for [from, to] in &arrows {
        assert!((*to - *from).abs_diff_eq(DVec3::new(0.0, 0.2, 0.0), 1e-12), "{from} to {to}");
    }
    let (lines, arrows) = drawn(&format!("{uniform}[field.b]\nforce = 'f'\nmagnetic = true"));
    assert!(arrows.is_empty() && lines.len() > 500, "{} lines of circles", lines.len());
}

/// Along each line of a dipole, sin²θ/r is constant, where θ is the angle to its moment. The lines lie symmetrically about the magnet. Source:
/// D. J. Griffiths, *Introduction to Electrodynamics*, § 3.4.
#[test]
fn lines_of_a_magnet_are_closed_and_symmetric() {
    let magnet = "
        simulation.duration = 0\nenvironment.ground = false
        [body.magnet]\nshape.box.size = [0.2, 0.05, 0.05]\nmagnetic_moment = [1, 0, 0]\nfixed = true
        [body.needle]\nshape.sphere.radius = 0.01\nmagnetic_moment = [0, 1e-9, 0]\nlocation = [0.3, 0.3, 0]
        [force.m.dipoles]\n[field.b]\nforce = 'm'\nshow = 'lines'\ncount = 12
        [camera]\nlocation = [0, 0, 1.4]\nlook_at = [0, 0, 0]\n";
    let (lines, arrows) = drawn(magnet);
    let flux = |point: DVec3| (1.0 - point.x * point.x / point.length_squared()) / point.length();
    let far = |point: DVec3| point.length() > 0.05;
    let change = lines.iter().filter(|line| line.iter().all(|end| far(*end)));
    let change = change.map(|[from, to]| (flux(*from) / flux(*to) - 1.0).abs()).fold(0.0, f64::max);
    assert!(lines.len() > 300 && change < 1e-3, "{} lines, {change}", lines.len());
    assert!((10..=12).contains(&arrows.len()), "{} arrows", arrows.len());
    for line in &lines {
        let mirrored = |point: DVec3| DVec3::new(-point.x, point.y, point.z);
        let nearest =
            |point: DVec3| lines.iter().map(|[_, to]| to.distance(point)).fold(f64::INFINITY, f64::min);
        assert!(line[0].length() < 0.02 || nearest(mirrored(line[0])) < 0.01, "{line:?}");
    }
}

//! Tests of the warnings for requested drawings that no picture shows; each appears once for a run.

use jabuka::diagnostic::Code;
use jabuka::{Run, Scene};

/// Returns the warnings for a scene with these keys, each with its help.
fn said(keys: &str) -> Vec<String> {
    let text = format!(
        "simulation = {{ duration = 1, gravity = [0, -10, 0] }}
        [camera]\nlocation = [0, 0, 10]\nlook_at = [0, 0, 0]
        {keys}"
    );
    said_of(&text)
}

/// Returns the warnings of the code `not-drawn` for a scene, each with its help.
fn said_of(text: &str) -> Vec<String> {
    let scene = Scene::parse(text).unwrap();
    let run = Run::new(&scene).unwrap();
    // Every frame has a script, whatever is left out of it.
    for frame in run.frames() {
        run.script(&frame.unwrap()).unwrap();
    }
    let warnings = run.warnings().into_iter().filter(|warning| warning.code == Code::NotDrawn);
    warnings.map(|warning| format!("{}: {}", warning.message, warning.help.unwrap_or_default())).collect()
}

/// A thrown ball, as a part of a scene.
const BALL: &str = "[body.ball]\nshape.sphere.radius = 0.5\nvelocity = [1, 2, 0]\n";

#[test]
fn arrows_that_no_picture_shows() {
    let keys = format!("{BALL}arrows = {{ velocity.scale = 1e-5, force = true }}");
    assert_eq!(
        said(&keys),
        ["the arrow for the velocity of `ball` is not seen: at most 0.0142 pixels long: \
         write `arrows.velocity.scale = 0.1`, or leave `arrows.velocity.scale` out"]
    );
    // The change that the warning suggests makes the arrow visible.
    assert_eq!(said(&format!("{BALL}arrows.velocity.scale = 0.1")), [""; 0]);
    assert_eq!(said(&format!("{BALL}arrows.velocity = true")), [""; 0]);
    // A vector that is always zero has no arrow, and causes no warning.
    assert_eq!(
        said("[body.b]\nshape.sphere.radius = 0.5\nfixed = true\narrows.velocity.scale = 1e-5"),
        [""; 0]
    );
}

/// Nine balls stay where they are, and a tenth flies 200 m away, out of the picture.
#[test]
fn a_body_that_flies_out_of_the_picture() {
    let text = |velocity: f64| {
        format!(
            "simulation.duration = 2\n[body.row]\nshape.sphere.radius = 0.5\nlocation = ['i', 0, 0]\nrepeat = 9
            [body.runaway]\nshape.sphere.radius = 0.5\nlocation = [9, 0, 0]\nvelocity = [0, {velocity}, 0]\n"
        )
    };
    let [warning] = &said_of(&text(100.0))[..] else { panic!("one warning") };
    assert!(warning.contains("`runaway`") && !warning.contains("`row"), "{warning}");
    assert_eq!(said_of(&text(1.0)), [""; 0]);
}

#[test]
fn an_arrow_of_a_force_that_no_picture_shows() {
    let force = |scale: &str| format!("{BALL}[force.air.drag]\nlinear = 0.5\narrow.scale = {scale}\n");
    let [said_of_air] = &said(&force("1e-6"))[..] else { panic!("one warning") };
    assert!(
        said_of_air.starts_with("the arrow of the force `air` is not seen: at most 0.00"),
        "{said_of_air}"
    );
    assert!(said_of_air.contains("write `arrow.scale = 0."), "{said_of_air}");
    assert_eq!(said(&force("0.1")), [""; 0]);
}

#[test]
fn arrows_whose_tips_are_at_no_finite_place() {
    let text = "simulation.duration = 0\n[force.f.lorentz]\nelectric = [1e100, 0, 0]\n[body.ball]
        shape.sphere.radius = 0.5\nmass = 1e-100\ncharge = 1e100\narrows.acceleration.scale = 1e20";
    let scene = Scene::parse(text).unwrap();
    let run = Run::new(&scene).unwrap();
    let [warning] = &run.warnings()[..] else { panic!("{:?}", run.warnings()) };
    assert_eq!(
        warning.message,
        "the arrow for the acceleration of `ball` is not drawn from t = 0 s on: its tip is at no finite place"
    );
    assert_eq!(warning.help.as_deref(), Some("leave `arrows.acceleration.scale` out"));
    let script = run.script(&run.frames().next().unwrap().unwrap()).unwrap();
    assert!(!script.contains("inf") && !script.contains("\nArrow("));
}

#[test]
fn one_warning_stands_for_all_copies() {
    let keys = format!("{BALL}repeat = 9\narrows.velocity.scale = 1e-5");
    let said = said(&keys);
    assert_eq!(said.len(), 1);
    assert!(said[0].contains("of `ball[0]` is not seen, nor those of 8 others: at most"), "{said:?}");
}

#[test]
fn trails_and_axes_that_no_picture_shows() {
    let thin = said(&format!("{BALL}trail.width = 1e-6\naxes.length = 1e-4"));
    assert!(thin[0].starts_with("the axes of `ball` are not seen: at most 0.0"), "{thin:?}");
    assert!(thin[0].ends_with("write `axes.length = 1`, or leave `axes.length` out"), "{thin:?}");
    assert!(thin[1].starts_with("the trail of `ball` is not seen: at most 0.000"), "{thin:?}");
    assert!(thin[1].ends_with("write `trail.width = 0.01`, or leave `trail.width` out"), "{thin:?}");
    // Within one second the ball moves 1 m to the right, and by 2 − 5 m upward.
    let wide = said(&format!("{BALL}trail.width = 9"));
    assert_eq!(
        wide,
        [
            "the trail of `ball` is not drawn: the body goes 3.18 m, and its trail is 9 m wide: leave `trail.width` out"
        ]
    );
}

#[test]
fn coils_without_room_or_width() {
    let ball = BALL.replace("velocity = [1, 2, 0]\n", "");
    let spring = |place: &str, coil: &str| {
        said(&format!(
            "{ball}[body.other]\nshape.sphere.radius = 0.5\nlocation = {place}\n[force.s.spring]\n\
             between = ['ball', 'other']\nstiffness = 1\n{coil}",
        ))
    };
    assert_eq!(spring("[3, 0, 0]", ""), [""; 0]);
    assert_eq!(
        spring("[3, 0, 0]", "coil.radius = 9"),
        ["the coil of the spring `s` is not drawn: its ends leave no room for one with a radius of 9 m: \
         write `coil.radius = 0.1`, or leave `coil.radius` out"]
    );
    let touching = spring("[0.5, 0, 0]", "");
    assert!(touching[0].ends_with("move the ends apart, or write `line = \"none\"`"), "{touching:?}");
    // POV-Ray does not accept such a small number: if the coil were written, there would be no picture.
    let thin = spring("[3, 0, 0]", "coil.radius = 1e-13");
    assert!(thin[0].starts_with("the coil of the spring `s` is not seen: at most"), "{thin:?}");
}

#[test]
fn a_scale_bar_that_is_longer_than_the_picture() {
    assert_eq!(said(&format!("{BALL}[scale_bar]\nlength = 2")), [""; 0]);
    let long = said(&format!("{BALL}[scale_bar]\nlength = 9"));
    assert_eq!(
        long,
        ["the scale bar leaves the picture: in its middle, 9 m are more than its width: \
          write `scale_bar.length = 1`, or leave `scale_bar.length` out"]
    );
}

#[test]
fn ghosts_of_what_stays_where_it_is() {
    let ball = "[body.ball]\nshape.sphere.radius = 0.5\nghosts.every = 0.2\n";
    assert_eq!(said(ball), [""; 0], "it falls");
    let resting = format!("{ball}motion.formula.location = [0, 0, '0.005*sin(t)']");
    assert_eq!(
        said(&resting),
        ["the ghosts of `ball` are not drawn: the body stays where it is: leave `ghosts` out"]
    );
    assert_eq!(said(&resting.replace("0.005", "0.5")), [""; 0]);
    // A body that rotates in place has visible ghosts.
    let turning = format!("{ball}motion.formula = {{ location = [0, 0, 0], orientation = [0, '90*t', 0] }}");
    assert_eq!(said(&turning), [""; 0]);
    // A fixed body has no ghosts, and causes no warning.
    assert_eq!(said(&format!("{ball}fixed = true")), [""; 0]);
}

#[test]
fn arrows_for_what_never_touches_a_body() {
    let keys = |arrows: &str| {
        format!(
            "simulation = {{ duration = 1, gravity = [0, -10, 0], contacts = 'event-driven', integrator = 'rk4' }}
            environment.ground.height = -20\n[camera]\nlocation = [0, 0, 10]\nlook_at = [0, 0, 0]
            [body.ball]\nshape.sphere.radius = 0.5\nmass = 1\narrows = {{ {arrows} }}"
        )
    };
    let untouched = "the arrow for the normal force of `ball` is not drawn: nothing touches the body: \
                     leave `arrows.normal` out";
    assert_eq!(said_of(&keys("weight = true, normal = true")), [untouched]);
    let small = "the arrow for the weight of `ball` is not seen: at most 0.00352 pixels long: \
                 write `arrows.weight.scale = 0.08`, or leave `arrows.weight.scale` out";
    assert_eq!(said_of(&keys("weight.scale = 2e-6")), [small]);
    assert_eq!(said_of(&keys("weight.scale = 0.02")), [""; 0]);
}

/// Returns the warnings about plots without room and curves that are not drawn, for a scene with these plots. Each has the text that it points
/// to, and its help.
fn of_plots(keys: &str) -> Vec<String> {
    let text = format!(
        "simulation = {{ duration = 1, gravity = [0, -10, 0] }}\n{BALL}mass = 2\n[body.late]
        shape.sphere.radius = 0.5\nlocation = [2, 0, 0]\nstart = 9\n{keys}"
    );
    let scene = Scene::parse(&text).unwrap();
    let run = Run::new(&scene).unwrap();
    // Every frame has a script, whatever is left out of it.
    for frame in run.frames() {
        run.script(&frame.unwrap()).unwrap();
    }
    let report = run.report();
    let warnings = report.diagnostics.iter().filter(|warning| warning.code == Code::NotDrawn);
    let said = warnings.map(|warning| {
        let place = report.sources.raw(warning.labels[0].span);
        format!("{place}: {}: {}", warning.message, warning.help.as_deref().unwrap_or_default())
    });
    said.collect()
}

#[test]
fn plots_that_find_no_room_in_the_picture() {
    let plots = |names: &[&str], keys: &str| -> String {
        names.iter().map(|name| format!("[plot.{name}]\ny = 'kinetic'\n{keys}\n")).collect()
    };
    // Three plots have room below each other in a small picture, five have not.
    let (small, corner) = ("[output]\nsize = [160, 90]\n", "corner = 'top-right'");
    assert_eq!(of_plots(&format!("{small}{}", plots(&["a", "b", "c"], corner))), [""; 0]);
    let help = "give it another `corner` or `side`, or have fewer plots and labels there";
    assert_eq!(
        of_plots(&format!("{small}{}", plots(&["a", "b", "c", "d", "e"], corner))),
        ["d", "e"]
            .map(|name| format!("{name}: the plot `{name}` has no room: it leaves the picture: {help}"))
    );
    // Two that begin at the upper and two that begin at the lower edge.
    let (upper, lower) = (plots(&["a", "b"], ""), plots(&["c", "d"], "corner = 'bottom-right'"));
    let help = "give one of them another `corner` or `side`, or have fewer plots and labels there";
    let said = of_plots(&format!("{small}{upper}{lower}"));
    assert_eq!(said, [format!("d: the plot `d` has no room: it covers the plot `b`: {help}")]);
    // Three beside each other have room if they are narrow.
    let row = |width: f64| {
        let corners = [("a", "top-left"), ("b", "top"), ("c", "top-right")];
        let keys = |corner: &str| format!("width = {width}\ncorner = '{corner}'");
        corners.map(|(name, corner)| plots(&[name], &keys(corner))).concat()
    };
    assert_eq!(of_plots(&row(0.3)), [""; 0]);
    let help = "give both a smaller `width`, or give one another `corner` or `side`";
    assert_eq!(
        of_plots(&row(0.36)),
        [("b", "a"), ("c", "b")].map(|(name, other)| {
            format!("{name}: the plot `{name}` has no room: it covers the plot `{other}`: {help}")
        })
    );
}

#[test]
fn curves_of_which_no_picture_shows_a_point() {
    // The ball rises from 0 m with 2 m/s, and falls to -3 m.
    let plot = |y: &str, range: &str| format!("[plot.p]\ny = {y}\n{range}\n");
    assert_eq!(of_plots(&plot("['ball.y', 'late.y + ball.y']", "range = [-1, 1]")).len(), 1);
    let outside = "is not drawn: its values are outside of `range`";
    assert_eq!(
        of_plots(&plot("['ball.y', 'ball.speed + 5']", "range = [-4, 1]")),
        [format!(
            "'ball.speed + 5': the curve `ball.speed + 5` of the plot `p` {outside}: \
             write `range = [-4, 14]`, or leave `range` out"
        )]
    );
    // The change that the warning suggests makes the curve visible.
    assert_eq!(of_plots(&plot("['ball.y', 'ball.speed + 5']", "range = [-4, 14]")), [""; 0]);
    assert_eq!(of_plots(&plot("['ball.y', 'ball.speed + 5']", "")), [""; 0]);
    // The run takes 1 s or more, so no time is in this range. The horizontal axis has a key of its own.
    let said = of_plots(&plot("'ball.y'", "x_range = [-5, -4]"));
    assert_eq!(said.len(), 1);
    assert!(
        said[0].contains("outside of `x_range`") && said[0].contains("write `x_range = [-5, "),
        "{said:?}"
    );
    // A curve that crosses the range between two frames is visible.
    assert_eq!(of_plots(&plot("'ball.y'", "range = [-1.0001, -1]")), [""; 0]);
    assert_eq!(
        of_plots(&plot("'late.y'", "")),
        ["'late.y': the curve `late.y` of the plot `p` is not drawn: `late` is never there: \
          let `late` be there during the run, or leave the curve out"]
    );
    assert_eq!(
        of_plots(&plot("['ball.y', 'sqrt(-1 - ball.speed)']", "")),
        ["'sqrt(-1 - ball.speed)': the curve `sqrt(-1 - ball.speed)` of the plot `p` is not drawn: \
          it has no finite value at any frame: correct the formula, or leave the curve out"]
    );
}

#[test]
fn values_that_have_no_place_on_a_logarithmic_axis() {
    let plot = |y: &str, keys: &str| format!("[plot.p]\ny = '{y}'\n{keys}\n");
    let help = "draw a positive formula, such as `abs(…)`, or leave `log` out";
    let said = |y: &str, values: &str| [format!("'{y}': the curve `{y}` of the plot `p` {values}: {help}")];
    // The ball rises with 2 m/s in a gravity of 10 m/s²: it stands still after 0.2 s, the 6th of 26 frames.
    let vy = of_plots(&plot("ball.vy - 1e-9", "log = true"));
    assert_eq!(vy, said("ball.vy - 1e-9", "has gaps: 21 of its 26 values are not positive"));
    let start = of_plots(&plot("t", "log = true"));
    assert_eq!(start, said("t", "has a gap: 1 of its 26 values is not positive"));
    let none = of_plots(&plot("0 - 1 - t", "log = 'xy'"));
    assert_eq!(none, said("0 - 1 - t", "is not drawn: none of its values is positive"));
    // Across, the start of the run at time 0 has no place, and nothing is amiss.
    assert_eq!(of_plots(&plot("t", "log = 'xy'")), [""; 0]);
    assert_eq!(of_plots(&plot("ball.vy", "log = 'x'")), [""; 0]);
    assert_eq!(of_plots(&plot("ball.vy", "log = false")), [""; 0]);
}

/// Arrows need a macro, also if a force has the only one.
#[test]
fn the_only_arrow_of_a_scene_finds_its_macro() {
    for arrow in [
        "[force.air.drag]\nlinear = 0.3\narrow = true",
        "[force.air.drag]\nlinear = 0.3\n[joint.r.rod]\nbetween = [[0, 1, 0], 'b']\narrows.force = true",
        "[force.air.drag]\nlinear = 0.3\n[body.c]\nshape.sphere.radius = 1\narrows.velocity = true",
    ] {
        let text = format!(
            "simulation.duration = 1\n[body.b]\nshape.sphere.radius = 0.1\nvelocity = [1, 1, 0]\n{arrow}"
        );
        let scene = Scene::parse(&text).unwrap();
        let run = Run::new(&scene).unwrap();
        let script = run.emitter().script(&run.frames().next().unwrap().unwrap()).unwrap();
        assert!(script.contains("#macro Arrow("), "{arrow}");
    }
}

/// Nobody asked for what is turned off.
#[test]
fn what_is_turned_off_has_no_missing_effect() {
    let scene = Scene::parse(
        "simulation.duration = 1\n[defaults.body]\narrows.velocity = true
        [body.b]\nshape.sphere.radius = 0.1\nvelocity = [1, 1, 0]
        [body.wall]\nshape.box.size = [1, 1, 1]\nlocation = [0, -5, 0]\nfixed = true\narrows.velocity = false",
    )
    .unwrap();
    assert!(scene.warnings.diagnostics.is_empty(), "{}", scene.warnings);
}

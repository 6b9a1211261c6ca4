//! Tests of the plots of a scene on the page.

use crate::server::Scene;

in_the_browser! { Scene::gallery("damped_oscillator"), "plots.mjs":
    the_plots_of_a_scene_are_drawn_as_far_as_time_has_come,
}

const BARS: &str = r#"
    simulation = { duration = 2, frame_rate = 50 }
    output.size = [640, 360]
    [body.ball]
    shape.sphere.radius = 0.1
    motion.formula.location = ["t", "-t/2", "0"]
    [body.copy]
    shape.sphere.radius = 0.1
    location = ["i", 0, 0]
    repeat = 12
    [plot.now]
    bars = ["ball.x", "ball.y"]
    side = "right"
    [plot.spread]
    histogram = "copy.x"
    bins = 3
    side = "right"
    "#;

in_the_browser! { Scene::of(BARS), "plots.mjs":
    bars_are_as_high_as_the_values_of_the_moment,
}

const LETTERS: &str = r#"
    simulation.duration = 1
    output = { size = [640, 360], decimal = "," }
    [body.ball]
    shape.sphere.radius = 1
    [label.first]
    text = "x_{max} = ${t:.1}\nm/s^2"
    size = 0.1
    [label.card]
    text = "at the start"
    corner = "center"
    until = 0.5
    "#;

in_the_browser! { Scene::of(LETTERS), "plots.mjs":
    labels_have_subscripts_lines_and_times,
}

const FONTS: &str = r#"
    simulation.duration = 1
    output.size = [640, 360]
    [body.ball]
    shape.sphere.radius = 1
    [label.own]
    text = "Own 10^{-6}"
    font = "letters.ttf"
    size = 0.1
    [label.bold]
    text = "**Bold ${t:.1}** m_0"
    "#;

in_the_browser! { Scene::of(FONTS).with("letters.ttf", include_bytes!("../../keys/files/letters.ttf")), "plots.mjs":
    labels_have_bold_letters_and_fonts_of_their_own,
}

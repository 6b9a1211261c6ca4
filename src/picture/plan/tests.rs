//! Tests of the contents of pictures.

use glam::DVec3;

use super::*;
use crate::font::Typeface;
use crate::lettering;
use crate::physics::BodySnapshot;
use crate::picture::{Form, PlotBar};
use crate::scene::ArrowOwner;
use crate::simulate::{Frames, survey};

fn plan(keys: &str) -> (Plan, Frame) {
    let text = format!(
        "simulation = {{ duration = 1, gravity = [0, -10, 0] }}
        [body.ball]\nshape.sphere.radius = 0.1\nvelocity = [1, 5, 0]\n{keys}"
    );
    let scene = Scene::parse(&text).unwrap();
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let frame = Frames::at(&scene, 0.5).unwrap();
    (plan, frame)
}

#[test]
fn what_nobody_asks_for_is_not_there() {
    let (plan, frame) = plan("");
    assert!(plan.arrows(&frame).is_empty() && plan.marks(&frame).is_empty());
    assert!(plan.links(&frame).is_empty() && plan.trails(&frame).is_empty());
    assert!(plan.texts(&frame).is_empty() && plan.ghosts(&frame).next().is_none());
    assert!(plan.grid(&frame).is_none() && plan.bar(&frame).is_none() && plan.screen(&frame).is_none());
    assert!(plan.lights_at_start().is_empty() && !plan.camera_moves() && !plan.lights_move());
}

#[test]
fn lengths_are_metres_whatever_the_unit_of_scripts_is() {
    let keys = "arrows.velocity.scale = 0.2\naxes.length = 2\n[povray]\nunit = 0.001";
    let (plan, frame) = plan(keys);
    let ball = frame.bodies[0];
    let [arrow] = plan.arrows(&frame)[..] else { panic!("one is asked for") };
    assert_eq!((arrow.owner, arrow.quantity), (ArrowOwner::Body(0), Quantity::Velocity));
    assert!((arrow.from.distance(ball.location) - 0.1).abs() < 1e-9);
    assert!((arrow.to - arrow.from).abs_diff_eq(0.2 * ball.velocity, 1e-12));
    let marks = plan.marks(&frame);
    let [_, Thing { form: Form::Axes { location, length, .. }, .. }] = marks[..] else { panic!("{marks:?}") };
    assert_eq!((location, length), (ball.location, 2.0));
    assert!((1.0..5.0).contains(&plan.stage().size));
}

/// The arrows of a ghost show the contact forces at the time of the ghost.
#[test]
fn ghosts_have_the_arrows_of_what_touched_them() {
    let text = "[simulation]\nduration = 0.5\ngravity = [0, -10, 0]\ncontacts = 'event-driven'
        integrator = 'rk4'\n[body.block]\nshape.box.size = [1, 1, 1]\nmass = 2\nlocation = [0, 0.5, 0]
        velocity = [4, 0, 0]\nfriction = 0.2\nghosts = { every = 0.2, arrows = true }
        arrows = { normal.scale = 0.1, friction.scale = 0.1 }";
    let scene = Scene::parse(text).unwrap();
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let frame = Frames::at(&scene, 0.48).unwrap();
    let ghosts: Vec<_> = plan.ghosts(&frame).filter(|ghost| ghost.time > 0.1).collect();
    assert_eq!(ghosts.len(), 2);
    for ghost in ghosts {
        let [normal, friction] = plan.ghost_arrows(&frame, ghost)[..] else { panic!("two are asked for") };
        let along = |arrow: Arrow| (arrow.to - arrow.from).normalize();
        assert!(along(normal).dot(DVec3::Y) > 0.99, "{normal:?}");
        assert!(along(friction).dot(DVec3::X) < -0.99, "{friction:?}");
    }
}

#[test]
fn ghosts_have_their_arrows_and_are_not_where_their_body_is() {
    let (plan, frame) = plan("arrows.velocity = true\nghosts.every = 0.25");
    let ghosts: Vec<f64> = plan.ghosts(&frame).map(|ghost| ghost.time).collect();
    assert_eq!(ghosts, [0.0, 0.25]);
    for ghost in plan.ghosts(&frame) {
        let [arrow] = plan.ghost_arrows(&frame, ghost)[..] else { panic!("they have arrows") };
        assert!(arrow.from.distance(ghost.body.location) < 0.1 + 1e-9);
    }
}

#[test]
fn texts_say_of_what_they_are_and_the_bar_is_below_its_number() {
    let (plan, frame) = plan("[label.now]\ntext = '${t:.1} s'\n[scale_bar]\nlength = 1\n[grid]");
    let texts = plan.texts(&frame);
    let says = |name: &str| texts.iter().find(|text| text.name == name).map(|text| text.says.as_ref());
    assert_eq!((says("now"), says("scale bar")), (Some("0.5 s"), Some("1 m")));
    assert!(says("grid").is_some() && plan.grid(&frame).is_some_and(|grid| !grid.lines().is_empty()));
    let (bar, number) = plan.written(&frame).unwrap().bar.unwrap();
    assert_eq!(Some(bar), plan.bar(&frame));
    assert!(number.y.above_middle(0.5) > bar.y.above_middle(0.5));
    assert!((number.x - (bar.from + bar.to) / 2.0).abs() < 1e-12);
}

/// The plan and the frames of a scene with a ball and labels.
fn labelled(keys: &str) -> (Plan, Vec<Frame>) {
    let text = format!(
        "simulation = {{ duration = 1, frame_rate = 4 }}\noutput.size = [320, 180]\n[body.ball]\nshape.sphere.radius = 0.1\n{keys}"
    );
    let scene = Scene::parse(&text).unwrap();
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let frames = Frames::new(&scene).map(Result::unwrap).collect();
    (plan, frames)
}

#[test]
fn labels_are_there_from_their_first_time_until_before_their_second_and_leave_their_room_to_others() {
    let keys = "[label.first]\ntext = '1'\nuntil = 0.5\n[label.second]\ntext = '2'\n[label.third]\ntext = '3'\nfrom = 0.5\nuntil = 1\n\
        [label.ball]\ntext = 'b'\nbody = 'ball'\nfrom = 0.25\nuntil = 0.75";
    let (plan, frames) = labelled(keys);
    let texts: Vec<_> = frames.iter().map(|frame| plan.texts(frame)).collect();
    let said = texts.iter().map(|texts| texts.iter().map(|text| text.says.as_ref()).collect::<String>());
    assert_eq!(said.collect::<Vec<_>>(), ["12", "12b", "23b", "23", "23"]);
    let place = |frame: usize, number: usize| texts[frame][number].y;
    assert_eq!(place(0, 0), place(2, 0), "the second label moves into the place of the first");
    assert_eq!(place(0, 1), place(2, 1), "the third into that of the second");
}

#[test]
fn lines_of_labels_stand_below_each_other_at_their_corner() {
    let label =
        |name: &str, corner: &str| format!("[label.{name}]\ntext = \"a\\nb\\nc\"\ncorner = '{corner}'\n");
    let other = "[label.other]\ntext = 'd'\ncorner = 'bottom'\n";
    let keys =
        format!("{}{}{}{other}", label("top", "top"), label("bottom", "bottom"), label("center", "center"));
    let (plan, frames) = labelled(&keys);
    let texts = plan.texts(&frames[0]);
    let extent = |name: &str| {
        let text = texts.iter().find(|text| text.name == name).unwrap();
        let first = text.y.above_middle(180.0 / 320.0);
        // Letters are from the base line to 0.73 of the height above it.
        [first - 2.0 * crate::picture::LINE * text.height, first + 0.73 * text.height]
    };
    let ([top, ceiling], [floor, bottom], [low, high]) = (extent("top"), extent("bottom"), extent("center"));
    assert!(ceiling < 0.5625 - 0.035 && ceiling > 0.5625 - 0.07 && floor > 0.035 - 0.5625, "{texts:?}");
    assert!(bottom < low && high < top, "{texts:?}");
    let other = texts.iter().find(|text| text.name == "other").unwrap();
    assert!(other.y.above_middle(0.5625) > bottom, "the other label stands above all three lines");
}

#[test]
fn a_title_in_the_center_moves_away_from_long_captions() {
    let title = "[label.title]\ntext = 'Title'\ncorner = 'center'\n";
    let caption = "[label.caption]\ntext = \"1\\n2\\n3\\n4\\n5\\n6\"\ncorner = 'bottom'\nuntil = 0.5\n";
    let (plan, frames) = labelled(&format!("{title}{caption}"));
    let texts = [0, 3].map(|frame| plan.texts(&frames[frame]));
    let [with, without] = [&texts[0], &texts[1]].map(|texts| texts[0].y.above_middle(0.5625));
    let [title, caption] = &texts[0][..] else { panic!("{texts:?}") };
    assert!(without.abs() < 0.5 * title.height, "it stands in the middle: {without}");
    let top = caption.y.above_middle(0.5625) + 0.73 * caption.height;
    assert!(with > without && with - 0.25 * title.height > top, "{with} above {top}");
}

/// A label in the middle of the upper edge stays at the edge, beside a plot in the corner.
#[test]
fn a_caption_moves_aside_from_a_plot() {
    let keys = "[label.top]\ntext = 'after the crash'\ncorner = 'top'\n[plot.p]\ny = 't'\nwidth = 0.45\n";
    let (plan, frames) = labelled(keys);
    let texts = plan.texts(&frames[0]);
    let [text] = &texts[..] else { panic!("{texts:?}") };
    let panel = &plan.planned_plots()[0];
    assert!(text.y.above_middle(0.5625) > 0.5625 - 0.2, "it is at the edge: {text:?}");
    let right = text.x + 0.5 * crate::lettering::width(&text.says, text.typeface) * text.height;
    assert!(right < panel.left && right > panel.left - 0.1 && text.x < 0.0, "{right} beside {}", panel.left);
}

#[test]
fn a_decimal_comma_is_in_all_numbers_of_a_picture() {
    let keys = "[output]\nsize = [320, 180]\ndecimal = ','\n[label.l]\ntext = '0.5: ${t:.2}'\n[scale_bar]\nlength = 1.5\n\
        [grid]\nspacing = 0.25\n[plot.p]\ny = 't'";
    let text = format!(
        "simulation = {{ duration = 1, frame_rate = 4 }}\n[body.ball]\nshape.sphere.radius = 0.5\n{keys}"
    );
    let scene = Scene::parse(&text).unwrap();
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let frame = Frames::at(&scene, 0.5).unwrap();
    let mut texts = plan.texts(&frame);
    texts.extend(plan.planned_plots()[0].texts.iter().cloned());
    let said: Vec<&str> = texts.iter().map(|text| text.says.as_ref()).collect();
    assert!(said.contains(&"0.5: 0,50") && said.contains(&"1,5 m") && said.contains(&"0,5"), "{said:?}");
    let is_of_grid = texts.iter().any(|text| text.name == "grid" && text.says.contains(','));
    assert!(is_of_grid, "{said:?}");
    let points = said.iter().filter(|said| said.contains('.') && !said.contains(':'));
    assert_eq!(points.count(), 0, "{said:?}");
}

#[test]
fn a_camera_that_follows_looks_at_its_body() {
    let (plan, frame) = plan("[camera]\nfollow = { body = 'ball' }\n[label.now]\ntext = 'x'");
    assert!(plan.camera_moves());
    assert_eq!(plan.camera(&frame).look_at(), frame.bodies[0].location);
    let spot = plan.screen(&frame).unwrap().project(frame.bodies[0].location).unwrap();
    assert!(spot.x.abs() < 1e-12 && spot.y.abs() < 1e-12);
}

/// On a logarithmic axis, a decay is a straight line: exp(−2 t) is 0.1 at t = ln 10 / 2. On two logarithmic axes, a power is: t² is 0.01
/// at t = 0.1.
#[test]
fn decays_and_powers_are_straight_on_logarithmic_axes() {
    let text = "simulation = { duration = 4, frame_rate = 100 }\n[body.ball]\nshape.sphere.radius = 0.1
        motion.formula.location = ['exp(-2*t)', 't^2', '0']
        [plot.decay]\ny = 'ball.x'\nlog = true\nrange = [1e-4, 1]\n[plot.power]\ny = 'ball.y'\nlog = 'xy'\nrange = [1e-4, 100]\nahead = true";
    let scene = Scene::parse(text).unwrap();
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let [decay, power] = plan.planned_plots() else { panic!("two plots") };
    let ends = |plot: &PlannedPlot| {
        let axes: Vec<_> = plot.lines.iter().filter(|line| line.is_axis).collect();
        let [level, upright] = [axes[axes.len() - 2], axes[axes.len() - 1]];
        (level.from, [level.to[0], upright.to[1]])
    };
    let is_near = |one: [f64; 2], other: [f64; 2]| (0..2).all(|k| (one[k] - other[k]).abs() < 1e-6);
    let (origin, end) = ends(decay);
    let points: Vec<[f64; 2]> = decay.curves[0].points.iter().filter_map(|point| point.at).collect();
    let [first, last] = points[..] else { panic!("{points:?}") };
    // The curve falls by 8 / ln 10 of 4 decades in the whole run.
    let bottom = end[1] + (origin[1] - end[1]) * 8.0 / std::f64::consts::LN_10 / 4.0;
    assert!(is_near(first, [origin[0], end[1]]) && is_near(last, [end[0], bottom]), "{first:?} {last:?}");
    let (origin, end) = ends(power);
    let points: Vec<[f64; 2]> = power.curves[0].points.iter().filter_map(|point| point.at).collect();
    let [first, last] = points[..] else { panic!("{points:?}") };
    // Time 0 has no place. The axis of the time goes from the first frame after it, 0.01 s, to 4 s; there, the power is 16.
    let top = origin[1] + (end[1] - origin[1]) * (libm::log10(16.0) + 4.0) / 6.0;
    assert!(is_near(first, origin) && is_near(last, [end[0], top]), "{first:?} {last:?}");
    let said: Vec<&str> = decay.texts.iter().map(|text| text.says.as_ref()).collect();
    assert!(["10⁻⁴", "10⁻²", "1"].iter().all(|power| said.contains(power)), "{said:?}");
    // A frame shows its own value on the same line. At time 0, it has none.
    let now = |time: f64| plan.plots(&Frames::at(&scene, time).unwrap())[1].curves[0];
    assert_eq!((now(0.0).here, now(0.0).count), (None, 0));
    let [x, y] = now(0.4).here.unwrap();
    let slope = |[x, y]: [f64; 2]| (y - first[1]) / (x - first[0]);
    assert!((slope([x, y]) / slope(last) - 1.0).abs() < 1e-9);
}

/// In a run of more frames than a curve has points, the lowest positive value and the gaps between positive values are kept.
#[test]
fn long_curves_keep_their_lowest_positive_values() {
    let text = "simulation = { duration = 30, frame_rate = 100 }\n[body.ball]\nshape.sphere.radius = 0.1
        motion.formula.location = ['exp(-((t - 12)/0.02)^2)*(-1) + 1.001', 'sin(t)', '0']
        [plot.peak]\ny = ['ball.x', 'ball.y']\nlog = true";
    let scene = Scene::parse(text).unwrap();
    let survey = survey(&scene, |_| {}).unwrap();
    let values = |curve: usize| survey.curves[curve].iter().map(|point| point.at.map(|at| at[1]));
    let lowest = values(0).flatten().fold(f64::INFINITY, f64::min);
    assert!((lowest - 0.001).abs() < 1e-9, "{lowest}");
    assert!(values(1).flatten().all(|value| value > 0.0) && values(1).filter(Option::is_none).count() > 3);
    assert_eq!(survey.left_out[0].frames, 0);
    // sin(t) is positive in 16 of the 30 seconds: 5 half-periods of π.
    let positive = survey.left_out[1].of - survey.left_out[1].frames;
    assert!((positive as f64 - 500.0 * std::f64::consts::PI).abs() < 6.0, "{positive}");
}

/// The heights of bars are as their values: those of 2 and −1 have the ratio 2 : 1, and begin at the same zero. No frame moves the axis.
#[test]
fn bars_are_as_high_as_their_values() {
    let text = "simulation = { duration = 2, frame_rate = 50 }\n[body.ball]\nshape.sphere.radius = 0.1
        motion.formula.location = ['t', '-t/2', '0']\n[body.late]\nshape.sphere.radius = 0.1\nstart = 1.5
        [plot.p]\nbars = ['ball.x', 'ball.y', 'late.x + 1']\nnames = ['right', 'down', 'late']";
    let scene = Scene::parse(text).unwrap();
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let bars = |time: f64| plan.plots(&Frames::at(&scene, time).unwrap())[0].bars.clone();
    // Nothing of the bars is seen at first, and `late` is not there.
    assert_eq!((bars(0.0), bars(1.0).len(), bars(2.0).len()), (vec![], 2, 3));
    let (middle, end) = (bars(1.0), bars(2.0));
    let height = |bar: PlotBar| bar.to[1] - bar.from[1];
    for (one, other, ratio) in [(end[0], end[1], 2.0), (end[0], middle[0], 2.0), (end[0], end[2], 2.0)] {
        assert!((height(one) / height(other) - ratio).abs() < 1e-9, "{one:?} {other:?}");
    }
    assert!(end[0].from[1] == end[1].to[1] && end[0].from[1] == middle[1].to[1], "zero stays in its place");
    // A line of the axis stands at zero, and the names stand below the bars in their colors.
    let plot = &plan.planned_plots()[0];
    assert!(plot.lines.iter().any(|line| line.is_axis && line.from[1] == end[0].from[1]));
    for (name, bar) in ["right", "down", "late"].into_iter().zip(end) {
        let text = plot.texts.iter().find(|text| text.says == name).unwrap();
        let place = text.x - plot.left;
        assert!((place - (bar.from[0] + bar.to[0]) / 2.0).abs() < 1e-9 && text.align == 0.5);
        assert!(
            text.color == bar.color
                && text.y.above_middle(0.5625) < plot.bottom.above_middle(0.5625) + bar.from[1]
        );
    }
}

/// 100 copies at the squares from 0 to 99², which keep their places: of n bins, the k-th has those from √(k/n) to √((k+1)/n) of 99.
#[test]
fn a_histogram_counts_the_copies_in_each_bin() {
    let text = "simulation = { duration = 2, frame_rate = 10, gravity = [0, -1, 0] }\n[body.ball]\nshape.sphere.radius = 0.1
        repeat = { count = 100 }\nlocation = ['i^2', 0, 0]\n[plot.p]\nhistogram = 'ball.x'\nbins = 9\n[plot.q]\nhistogram = 'ball.speed:km/h'";
    let scene = Scene::parse(text).unwrap();
    let survey = survey(&scene, |_| {}).unwrap();
    assert_eq!(survey.spreads[0].span, Some([0.0, 9801.0]));
    assert_eq!(survey.spreads[1].span.map(|[low, high]| [low, (high * 1e6).round()]), Some([0.0, 7.2e6]));
    let plan = Plan::new(&scene, &scene.camera, &survey);
    let bars = |time: f64| plan.plots(&Frames::at(&scene, time).unwrap())[0].bars.clone();
    let expected: Vec<f64> = (0..9_u32)
        .map(|bin| (0..100_u32).filter(|i| i * i * 9 / 9801 == bin || (*i == 99 && bin == 8)).count() as f64)
        .collect();
    assert_eq!(expected.iter().sum::<f64>(), 100.0);
    assert_eq!(expected[0], 33.0, "those below 99/3");
    let now = bars(1.0);
    assert_eq!(now.len(), 9);
    let height = |bar: PlotBar| bar.to[1] - bar.from[1];
    for (bar, count) in now.iter().zip(&expected) {
        assert!((height(*bar) / height(now[0]) - count / 33.0).abs() < 1e-9, "{count}: {bar:?}");
    }
    assert_eq!(bars(0.0), bars(2.0), "the axes hold for the whole run");
    // All copies fall alike: all of them are in one of the 10 bins at any time.
    let falling = plan.plots(&Frames::at(&scene, 1.5).unwrap())[1].bars.clone();
    assert_eq!(falling.len(), 1);
    let said: Vec<&str> = plan.planned_plots()[1].texts.iter().map(|text| text.says.as_ref()).collect();
    assert!(["ball", "ball.speed (km/h)", "100"].iter().all(|word| said.contains(word)), "{said:?}");
}

/// Names at the ends of curves stand at the heights of these ends, or as near to them as their letters allow.
#[test]
fn names_stand_at_the_ends_of_curves() {
    let plan = |keys: &str| {
        let text = format!(
            "simulation = {{ duration = 2, frame_rate = 10 }}\n[body.ball]\nshape.sphere.radius = 0.1\n[plot.p]\nlegend = 'ends'\n{keys}"
        );
        let scene = Scene::parse(&text).unwrap();
        Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap()).planned_plots()[0].clone()
    };
    let names = |plot: &PlannedPlot, names: &[&str]| -> Vec<[f64; 2]> {
        let place = |name: &&str| {
            let text = plot.texts.iter().find(|text| text.says == **name).unwrap();
            let middle = text.y.above_middle(0.5625) - plot.bottom.above_middle(0.5625) + 0.27 * text.height;
            [(text.x - plot.left), middle]
        };
        names.iter().map(place).collect()
    };
    let line = |plot: &PlannedPlot| plot.texts[0].height;
    let plot = plan("y = ['t', '-t', '0.01*t', '0*t']\nnames = ['up', 'down', 'one', 'other']");
    let ends: Vec<[f64; 2]> =
        plot.curves.iter().map(|curve| curve.points.last().and_then(|point| point.at).unwrap()).collect();
    let places = names(&plot, &["up", "down", "one", "other"]);
    assert!(places.iter().zip(&ends).all(|(name, end)| name[0] > end[0] && name[0] < end[0] + line(&plot)));
    assert!((places[1][1] - ends[1][1]).abs() < 0.5 * line(&plot));
    // The two in the middle would cover each other: each moves half of the way.
    assert!((places[2][1] - places[3][1] - line(&plot)).abs() < 1e-9, "{places:?}");
    let middle = |both: [[f64; 2]; 2]| (both[0][1] + both[1][1]) / 2.0;
    assert!((middle([places[2], places[3]]) - middle([ends[2], ends[3]])).abs() < 1e-9);
    let (left, right) =
        (plot.size[0], places[0][0] + lettering::width("other", Typeface::usual()) * line(&plot));
    assert!(right <= left, "the longest name is inside of the panel");
    // Without room, they stand above the plot.
    let long = "a name that is far too long for the end of a curve in any plot";
    let plot = plan(&format!("y = 't'\nnames = '{long}'\nwidth = 0.2"));
    let above = plot.texts.iter().find(|text| text.says.starts_with("a name")).unwrap();
    assert!(above.x - plot.left < 0.3 * plot.size[0], "{above:?}");
    // A curve that ends early has no end beside its name.
    let plot = plan("y = ['t', '1 + 0/(t < 1)']\nnames = ['long', 'short']");
    let above = plot.texts.iter().find(|text| text.says == "long").unwrap();
    assert!(above.x - plot.left < 0.3 * plot.size[0], "{above:?}");
}

/// The arrow of a force shows this force alone: that of drag is −c v, whatever else acts on the ball.
#[test]
fn the_arrow_of_a_force_shows_this_force_alone() {
    let keys = "mass = 2\narrows.force.scale = 0.1
        [force.air.drag]\nlinear = 0.5\narrow = { scale = 2, label = \"R = ${force.air.size:.3}\" }
        [force.pull.spring]\nbetween = [\"ball\", [0, 9, 0]]\nstiffness = 3";
    let (plan, frame) = plan(keys);
    let ball = frame.bodies[0];
    let arrows = plan.arrows(&frame);
    let [_, air] = arrows[..] else { panic!("two are asked for: {arrows:?}") };
    assert_eq!((air.owner, air.body, air.quantity), (ArrowOwner::Force(0), Some(0), Quantity::NamedForce));
    let drag = -0.5 * ball.velocity;
    assert!((air.to - air.from).abs_diff_eq(2.0 * drag, 1e-12), "{air:?}");
    assert!(plan.marks(&frame).iter().any(|thing| thing.name == "air, force"));
    let texts = plan.texts(&frame);
    assert_eq!(texts[0].says, format!("R = {:.3}", drag.length()), "{texts:?}");
    let ghost_text = plan.ghosts(&frame).count();
    assert_eq!(ghost_text, 0);
}

/// The components of a force along and across the velocity of its body, and along the way to a point.
#[test]
fn components_follow_the_motion() {
    for (direction, expected) in [
        (
            "\"ball.velocity\"",
            (|ball: &BodySnapshot| ball.velocity.normalize()) as fn(&BodySnapshot) -> DVec3,
        ),
        ("{ point = [0, 9, 0] }", |ball| (DVec3::Y * 9.0 - ball.location).normalize()),
    ] {
        let keys = format!("arrows.weight = {{ scale = 0.1, components = {direction} }}");
        let (plan, _) = plan(&keys);
        let text = format!(
            "simulation = {{ duration = 1, gravity = [0, -10, 0] }}
            [body.ball]\nshape.sphere.radius = 0.1\nvelocity = [1, 5, 0]\n{keys}"
        );
        let frame = Frames::at(&Scene::parse(&text).unwrap(), 0.3).unwrap();
        let ball = frame.bodies[0];
        let weight = DVec3::NEG_Y * 10.0 * 0.1;
        let weight =
            weight * plan.arrows(&frame)[0].from.distance(plan.arrows(&frame)[0].to) / weight.length();
        let along = expected(&ball) * weight.dot(expected(&ball));
        let marks = plan.marks(&frame);
        let drawn: Vec<DVec3> = marks
            .iter()
            .filter_map(|thing| match thing.form {
                Form::Arrow { from, to, .. } => Some(to - from),
                _ => None,
            })
            .collect();
        let [_, one, other] = drawn[..] else { panic!("an arrow and two components: {drawn:?}") };
        assert!(one.abs_diff_eq(along, 1e-9) && (one + other).abs_diff_eq(weight, 1e-9), "{drawn:?} {along}");
    }
}

/// Curves have the colors that the scene gives them, and the horizontal axis has its range. A ball moves by 1 m/s, so the curve of x between
/// 0.25 s and 0.75 s goes from corner to corner of a plot from 0.25 to 0.75.
#[test]
fn curves_have_given_colors_and_axes_given_ranges() {
    let text = "simulation = { duration = 2, integrator = 'rk4' }\n[body.ball]\nshape.sphere.radius = 0.1\nvelocity = [1, 0, 0]
        [plot.p]\ny = ['ball.x', '1 - ball.x']\ncolors = ['red', '#00ff00']\nx_range = [0.25, 0.75]\nrange = [0.25, 0.75]";
    let scene = Scene::parse(text).unwrap();
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let plot = &plan.planned_plots()[0];
    let colors: Vec<Color> = plot.curves.iter().map(|curve| curve.color).collect();
    assert_eq!(colors, [Color([1.0, 0.0, 0.0]), Color([0.0, 1.0, 0.0])]);
    let axes: Vec<_> = plot.lines.iter().filter(|line| line.is_axis).collect();
    let corners = |k: usize| axes.iter().flat_map(move |line| [line.from[k], line.to[k]]);
    let [low, high] = [f64::min, f64::max].map(|of| [0, 1].map(|k| corners(k).reduce(of).unwrap()));
    let ends: Vec<[f64; 2]> = plot.curves[0].points.iter().filter_map(|point| point.at).collect();
    let near = |one: [f64; 2], other: [f64; 2]| one.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(near(ends[0], low) && near(ends[ends.len() - 1], high), "{ends:?}, not from {low:?} to {high:?}");
}

/// A bar for each copy of a body: their heights are as 1 to 2 to 3, their color is one, and their names are their indices.
#[test]
fn copies_have_a_bar_each() {
    let text = "simulation = { duration = 1, integrator = 'rk4' }\n[body.ball]\nshape.sphere.radius = 0.1
        repeat = 3\nvelocity = ['1 + i', 0, 0]\nlocation = [0, 'i', 0]\n[plot.p]\nbars = 'ball.speed'";
    let scene = Scene::parse(text).unwrap();
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let bars = plan.plots(&Frames::at(&scene, 0.5).unwrap())[0].bars.clone();
    let heights: Vec<f64> = bars.iter().map(|bar| bar.to[1] - bar.from[1]).collect();
    assert!((heights[1] / heights[0] - 2.0).abs() < 1e-9 && (heights[2] / heights[0] - 3.0).abs() < 1e-9);
    assert!(bars.iter().all(|bar| bar.color == bars[0].color));
    let said: Vec<&str> = plan.planned_plots()[0].texts.iter().map(|text| text.says.as_ref()).collect();
    assert!(["0", "1", "2", "m/s"].iter().all(|word| said.contains(word)), "{said:?}");
}

/// The texts of a swinging pendulum cross each other's ways. From one frame to the next, none moves by more than a few letters.
#[test]
fn texts_do_not_jump_from_frame_to_frame() {
    let text = "simulation = { duration = 4, gravity = [0, -10, 0], integrator = 'rk4' }
        [body.bob]\nshape.sphere.radius = 0.07\nlocation = ['sin(rad(40))', '1 - cos(rad(40))', 0]
        [joint.string.rod]\nbetween = [[0, 1, 0], 'bob']
        [angle.phi]\nat = [0, 1, 0]\nfrom = [0, -1, 0]\nto = 'bob'
        [distance.L]\nbetween = [[0, 1, 0], 'bob']
        [label.bob]\ntext = 'the bob'\nbody = 'bob'";
    let scene = Scene::parse(text).unwrap();
    let plan = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let mut before: Vec<[f64; 2]> = Vec::new();
    let mut jumps = 0;
    for frame in Frames::new(&scene) {
        let texts = plan.texts(&frame.unwrap());
        let places: Vec<[f64; 2]> = texts.iter().map(|text| [text.x, text.y.above_middle(0.5625)]).collect();
        assert_eq!(places.len(), 3);
        let is_jump =
            |(one, other): (&[f64; 2], &[f64; 2])| libm::hypot(one[0] - other[0], one[1] - other[1]) > 0.15;
        jumps += before.iter().zip(&places).filter(|pair| is_jump(*pair)).count();
        before = places;
    }
    assert_eq!(jumps, 0);
}

/// A plan depends on the run alone, not on the way in which its frames were surveyed: with the past of each frame, or from a recording.
#[test]
fn texts_have_the_same_places_by_frames_and_by_a_recording() {
    let text = "simulation = { duration = 2, gravity = [0, -9.81, 0] }
        [camera]\nlocation = [4, 3, 14]\nlook_at = [4, 3, 0]
        [body.ball]\nshape.sphere.radius = 0.3\nlocation = [0, 1, 0]\nvelocity = [4, 9, 0]
        ghosts.every = 0.2\narrows.velocity.label = 'v'
        [label.time]\nbody = 'ball'\nghosts = true\ntext = '${t:.1} s'\n[label.now]\nbody = 'ball'\ntext = 'a ball'";
    let scene = Scene::parse(text).unwrap();
    let by_frames = Plan::new(&scene, &scene.camera, &survey(&scene, |_| {}).unwrap());
    let run = crate::Run::new(&scene).unwrap();
    for frame in Frames::new(&scene).step_by(7) {
        let frame = frame.unwrap();
        let places = |plan: &Plan| -> Vec<String> {
            plan.texts(&frame).iter().map(|text| format!("{} {} {:?}", text.says, text.x, text.y)).collect()
        };
        assert_eq!(places(&by_frames), places(run.emitter().plan()), "at {} s", frame.time);
    }
}

//! Tests that a short scene needs little memory and time, or is refused: no scene of a few lines may fill the memory or run for minutes.

use std::fs;

use jabuka::diagnostic::Report;
use jabuka::scene::Options;
use jabuka::{Run, RunError, Scene};

const BALL: &str = "[body.a]\nshape.sphere.radius = 1\n";

/// Returns the peak memory while a scene is read, bytes. The scene may be invalid.
fn bytes(text: &str) -> u64 {
    allocation_counter::measure(|| drop(Scene::parse(text))).bytes_max
}

/// Returns the number of allocations while a scene is read, as a measure of work that is independent of time.
fn work(text: &str) -> u64 {
    allocation_counter::measure(|| drop(Scene::parse(text))).count_total
}

/// Returns the diagnostics of a scene: its errors, or its warnings if it is valid.
fn said(text: &str) -> Report {
    Scene::parse(text).map_or_else(|report| report, |scene| scene.warnings)
}

/// Returns the code, the line and the label of the only diagnostic in a report.
fn only(report: &Report) -> (&'static str, usize, String) {
    let [diagnostic] = report.diagnostics.as_slice() else { panic!("{report}") };
    let span = diagnostic.span().unwrap();
    let line = report.sources.start(span).line;
    (diagnostic.code.name(), line, diagnostic.labels[0].text.clone())
}

#[test]
fn a_copy_takes_less_than_a_kilobyte() {
    let of = |n: usize, body: &str, more: &str| bytes(&format!("{body}repeat = {n}\n{more}"));
    let long = "x".repeat(5000);
    let keyframes = (1..100).map(|n| format!("{{ time = {n}, location = [{n}, 0, 0] }}")).collect::<Vec<_>>();
    for more in [
        "",
        "mass = 3\nvelocity = [1, 2, 3]\narrows.velocity = true\ntrail = true\naxes = true",
        &format!("look.sdl_before = '// {long}'"),
        &format!("material.sdl = 'pigment {{ rgb 1 }} // {long}'"),
        &format!("location = ['i', 0, 0]\nlook.sdl_after = '// {long}'"),
        "shape.compound.parts = [{ sphere.radius = 1 }, { sphere.radius = 2, location = [3, 0, 0] }]",
        "[force.pull.constant]\non = ['a']\nforce = [1, 0, 0]",
        "[force.chain.spring]\nbetween = ['a']\nstiffness = 1",
    ] {
        // If `more` gives a shape, it replaces the ball's.
        let body = if more.starts_with("shape") { "[body.a]\n" } else { BALL };
        let each = (of(25_000, body, more) - of(5000, body, more)) / 20_000;
        // A formula gives each copy its own table, which takes 128 bytes for each key.
        let most = if more.starts_with("location") { 1400 } else { 1000 };
        assert!(each < most, "{each} bytes for each copy with `{more:.60}`");
    }
    // The data that each copy holds for itself are counted and limited.
    let text = |n: usize| format!("{BALL}repeat = {n}\nmotion.keyframes.at = [{}]", keyframes.join(", "));
    assert_eq!(said(&text(20_000)).diagnostics.len(), 0);
    let (code, line, _) = only(&said(&text(21_000)));
    assert_eq!((code, line), ("too-many-copies", 4));
}

#[test]
fn copies_with_formulas_are_refused_before_they_are_made() {
    let formula = ["sin(i)"; 100].join(" + ");
    let text = format!("{BALL}location = ['{formula}', 0, 0]\nrepeat = 500000\n");
    let (code, line, label) = only(&said(&text));
    assert_eq!(
        (code, line, label.as_str()),
        ("too-many-copies", 4, "at most 97847 copies of this body are made")
    );
    assert!(work(&text) < 10_000, "{}", work(&text));
    // Formulas of the time are stored with their derivatives, once for each copy.
    let text = format!("{BALL}motion.formula.location = ['sin(t + i)', 'cos(2*t)', 0]\nrepeat = 500000\n");
    assert_eq!(only(&said(&text)).0, "too-many-copies");
    assert!(work(&text) < 10_000, "{}", work(&text));
    assert_eq!(said(&text.replace("500000", "1000")).diagnostics.len(), 0);
}

#[test]
fn a_name_that_means_many_copies_counts_as_all_of_them() {
    let text = |times: usize| {
        let force = |n: usize| format!("[force.f{n}.drag]\nlinear = 1\non = ['a']\n");
        format!("{BALL}repeat = 100000\n{}", (0..times).map(force).collect::<String>())
    };
    assert_eq!(said(&text(2)).diagnostics.len(), 0);
    let report = said(&text(21));
    let (code, line, _) = only(&report);
    assert_eq!((code, line), ("too-many-copies", 3 + 3 * 21), "{report}");
}

#[test]
fn what_many_copies_have_wrong_is_said_once() {
    for (more, code) in [
        ("charge = 1", "no-effect"),
        ("fixed = true\nmass = 3", "no-effect"),
        ("ghosts.every = 1e-9", "too-many-ghosts"),
        ("restitusion = 1", "unknown-key"),
        ("location = ['ii', 0, 0]", "unknown-name"),
        ("location = ['i +', 0, 0]", "formula-syntax"),
        ("[force.g.gravitation]", "same-place"),
        ("[force.g.drag]\nlinear = 1\non = ['a', 'a']", "named-twice"),
    ] {
        let text = |n: usize| format!("{BALL}repeat = {n}\n{more}\n");
        let report = said(&text(2000));
        assert_eq!(report.diagnostics.iter().filter(|it| it.code.name() == code).count(), 1, "{report}");
        assert!(report.diagnostics.len() <= 2, "{report}");
        // Ten times as many copies may cost at most about ten times the work.
        let (few, many) = (work(&text(2000)), work(&text(20_000)));
        assert!(many < 11 * few, "{more}: {few} allocations become {many}");
    }
}

#[test]
fn a_long_formula_and_many_frames_are_looked_at_in_part() {
    // The run has a million frames, and the formula five thousand operations: evaluating all of them would take minutes.
    let formula = ["t"; 2400].join(" + ");
    let text = |rate: &str| {
        format!(
            "[simulation]\nduration = 1000\nframe_rate = {rate}\n{BALL}motion.formula.location = ['{formula}', 0, 0]\n"
        )
    };
    let report = said(&text("999"));
    assert_eq!(report.diagnostics.len(), 0, "{report}");
    // The first and the last frame are always evaluated.
    let text = text("999").replace("['t +", "['1/(t - 1000) + t +");
    assert_eq!(only(&said(&text)).0, "division-by-zero");
}

#[test]
fn a_heightfield_in_as_many_sizes_as_copies_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::copy(root.join("tests/bad/meshes/hills.png"), folder.path().join("hills.png")).unwrap();
    let path = folder.path().join("scene.toml");
    let read = |copies: usize| {
        let text = "fixed = true\nshape.heightfield = { file = 'hills.png', size = ['1 + i', 1, 1] }";
        fs::write(&path, format!("[body.a]\n{text}\nrepeat = {copies}\n")).unwrap();
        Scene::from_path_with(&path, &Options::default())
    };
    assert!(read(3).is_ok());
    let report = read(2000).err().unwrap();
    let (code, line, label) = only(&report);
    assert_eq!((code, line), ("bad-mesh", 3), "{report}");
    assert!(label.contains("1000 meshes or 4000000 triangles"), "{label}");
}

/// Many bodies in one place are an error. The memory until it is found is in proportion to the number of bodies, not of their pairs.
#[test]
fn bodies_in_one_place_are_found_in_linear_memory() {
    let of = |n: usize, law: &str, shape: &str| {
        let place = "location = ['1e-3*sin(i)', 5, '1e-3*cos(i)']";
        let scene = format!(
            "[simulation]\nduration = 0.1\ncontacts = '{law}'\n[body.a]\nshape.{shape}\nrepeat = {n}\n{place}\n"
        );
        let scene = Scene::parse(&scene).unwrap();
        let used = allocation_counter::measure(|| {
            let Err(RunError::Simulate(error)) = Run::new(&scene) else { panic!("{law}, {shape}") };
            assert!(error.to_string().contains("overlap by 0."), "{error}");
        });
        used.bytes_max
    };
    for law in ["event-driven", "time-stepping"] {
        for shape in
            ["sphere.radius = 0.1", "box.size = [0.2, 0.2, 0.2]", "cone = { radius = 0.1, height = 0.2 }"]
        {
            let [few, many] = [300, 900].map(|n| of(n, law, shape));
            assert!(many < 4 * few && many < 30_000 * 900, "{law}, {shape}: {few} B, {many} B");
        }
    }
}

//! Tests of scenes with very large or very small numbers: jabuka refuses each of them, or POV-Ray parses its scripts without warnings.

use std::fs;

use jabuka::emit::EmitError;
use jabuka::{Run, RunError, Scene};

use crate::povray::{self, Said};

/// Returns the script of the first frame. `None` if jabuka refuses the scene as too small or too far away for POV-Ray.
fn script(text: &str) -> Option<String> {
    let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{text}\n{report}"));
    let run = match Run::new(&scene) {
        Ok(run) => run,
        Err(RunError::Emit(EmitError::Indistinct(_))) => return None,
        Err(error) => panic!("{text}\n{error}"),
    };
    let frame = run.frames().next().unwrap().unwrap();
    Some(run.script(&frame).unwrap())
}

/// Parses scripts in one POV-Ray process for a picture of the given size, of which one pixel is drawn. Asserts that POV-Ray prints no
/// warnings.
fn parse(scripts: &[String], width: u32, height: u32) {
    said(scripts, width, height).nothing("extreme scenes");
}

fn said(scripts: &[String], width: u32, height: u32) -> Said {
    let folder = tempfile::tempdir().unwrap();
    for (number, script) in scripts.iter().enumerate() {
        fs::write(folder.path().join(format!("scene_{number}.pov")), script).unwrap();
    }
    let each = "#version 3.7;\n#include concat(\"scene_\", str(frame_number, 0, 0), \".pov\")\n";
    fs::write(folder.path().join("all.pov"), each).unwrap();
    let last = format!("+KFF{}", scripts.len() - 1);
    let (width, height) = (format!("+W{width}"), format!("+H{height}"));
    let pixel = ["+SR1", "+ER1", "+SC1", "+EC1"];
    let arguments = [&["+Iall.pov", "-F", "-A", "+KFI0", &last, &width, &height], &pixel[..]].concat();
    povray::run(folder.path(), &arguments)
}

/// A pseudorandom number generator with the same sequence in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self, below: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % below
    }

    fn choose<'a>(&mut self, all: &[&'a str]) -> &'a str {
        all[usize::try_from(self.next(all.len() as u64)).unwrap()]
    }

    /// Returns a random length, m: usually an ordinary one, in one of four cases an extreme one.
    fn length(&mut self) -> String {
        const EXTREME: [&str; 10] =
            ["1e-90", "1e-30", "1e-12", "1e-6", "1e-4", "1e4", "1e7", "1e10", "1e16", "1e60"];
        match self.next(8) {
            0 => self.choose(&EXTREME).to_owned(),
            1 => {
                let (sign, digit, power) = (self.choose(&["", "-"]), 1 + self.next(9), self.next(29));
                format!("{sign}{digit}e{}", i64::try_from(power).unwrap() - 12)
            }
            _ => format!("{}.5", self.next(5)),
        }
    }

    /// Returns a random length without a sign, m.
    fn size(&mut self) -> String {
        self.length().trim_start_matches('-').to_owned()
    }

    fn scene(&mut self) -> String {
        let mut text = "simulation.duration = 0\noutput.size = [64, 36]\n".to_owned();
        let shapes = [
            "sphere.radius = R",
            "box.size = [R, 2, 1]",
            "cylinder = { radius = R, height = 1.5 }",
            "cone = { radius = 1, height = R }",
            "torus = { radius = 2e60, tube_radius = R }",
            "axes.length = R",
        ];
        for body in ["a", "b"] {
            let shape = self.choose(&shapes).replace('R', &self.size());
            let shape = if shape.contains("1e60 }") { "sphere.radius = 1" } else { &shape };
            let location = [self.length(), self.length(), self.length()].join(", ");
            let more = self.choose(&["", "trail = true\n", "arrows.velocity = true\n", "axes = true\n"]);
            text += &format!(
                "\n[body.{body}]\nshape.{shape}\nlocation = [{location}]\nvelocity = [1, 2, 0]\n{more}"
            );
        }
        let camera = match self.next(7) {
            0 => "projection = 'orthographic'".to_owned(),
            1 => format!("location = [{}, 1, 9]", self.length()),
            2 => format!("look_at = [{}, 1, 0]", self.length()),
            3 => format!("projection = 'orthographic'\nwidth = {}", self.size()),
            4 => format!("angle = {}", self.choose(&["1", "20", "120", "170"])),
            5 => format!(
                "projection = 'orthographic'\nlocation = [{}, 1, 9]\nlook_at = [0, {}, 0]",
                self.length(),
                self.length()
            ),
            _ => String::new(),
        };
        let light = match self.next(6) {
            0 => format!("\n[light.l]\npoint.location = [{}, 5, 0]\n", self.length()),
            _ => String::new(),
        };
        let shown = ["", "[grid]\n", "[scale_bar]\n", "[label.now]\ntext = '${a.speed}'\n"];
        text + "\n[camera]\n" + &camera + "\n" + &light + self.choose(&shown)
    }
}

/// Checks random extreme scenes. `JABUKA_EXTREMES=400 JABUKA_EXTREMES_SEED=1000 cargo test --test povray extremes -- --nocapture` tries
/// 400 scenes, starting from another seed.
#[test]
fn povray_takes_whatever_is_not_refused() {
    const SIZES: [[u32; 2]; 5] = [[64, 36], [36, 64], [65_535, 2], [1, 1], [2, 4000]];
    let number = |variable: &str| std::env::var(variable).ok().and_then(|text| text.parse::<u64>().ok());
    let (count, first) =
        (number("JABUKA_EXTREMES").unwrap_or(60), number("JABUKA_EXTREMES_SEED").unwrap_or(1));
    let mut taken = 0;
    // One process parses the scenes for pictures of the same size.
    for (group, begin) in (first..first + count).step_by(30).enumerate() {
        let [width, height] = SIZES[group % SIZES.len()];
        let scene = |seed: u64| {
            let mut numbers = Numbers(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
            numbers.scene().replace("[64, 36]", &format!("[{width}, {height}]"))
        };
        let scenes: Vec<String> = (begin..(begin + 30).min(first + count)).map(scene).collect();
        let (scenes, scripts): (Vec<&String>, Vec<String>) =
            scenes.iter().filter_map(|scene| Some((scene, script(scene)?))).unzip();
        taken += scripts.len();
        if said(&scripts, width, height).is_nothing() {
            continue;
        }
        for (scene, script) in scenes.iter().zip(&scripts) {
            println!("{scene}");
            parse(std::slice::from_ref(script), width, height);
        }
        panic!("the scenes {begin} to {} are taken one by one, and not together", begin + 29);
    }
    println!("{taken} of {count} scenes of extreme numbers are not refused");
    assert!((count / 5..count * 4 / 5).contains(&(taken as u64)), "{taken} of {count} are not refused");
}

#[test]
fn wide_pictures_and_wide_parallel_rays_are_drawn_without_a_warning() {
    let scene = |more: &str| {
        let ball = "[body.ball]\nshape.sphere.radius = 1\nlocation = [3, 4, 5]\n";
        script(&format!("simulation.duration = 0\noutput.size = [65535, 2]\n{ball}{more}")).unwrap()
    };
    let texts = "[grid]\n[scale_bar]\n[label.now]\ntext = 'now'\n";
    parse(&[scene(texts), scene(&format!("[camera]\nangle = 20\n{texts}"))], 65_535, 2);
    let parallel = |width: &str| {
        scene(&format!(
            "[camera]\nlocation = [9, 8, 7]\nlook_at = [0, 1, 2]\nprojection = 'orthographic'\nwidth = {width}"
        ))
    };
    parse(&["3", "3e3", "1e5"].map(parallel), 64, 36);
}

#[test]
fn large_letters_in_a_large_picture_are_drawn_without_a_warning() {
    // Large letters are not thickened by copies, so each label is one object.
    let label = "output.size = [1920, 1080]\n[body.a]\nshape.sphere.radius = 1\n[label.now]\ntext = 'now'\n";
    let sizes = ["", "size = 0.08", "size = 0.3"];
    parse(&sizes.map(|size| script(&format!("{label}{size}")).unwrap()), 1920, 1080);
}

#[test]
fn a_camera_nearer_to_its_aim_than_povray_can_tell_is_refused() {
    let scene = "simulation.duration = 0\n[body.ball]\nshape.sphere.radius = 1e4\nlocation = [1e9, 0, 0]\n\
        [camera]\nlocation = [0, 0, 4]\nlook_at = [0, 0, 0]\nprojection = 'orthographic'\n";
    assert_eq!(script(scene), None);
    parse(&[script(&scene.replace("0, 4]", "0, 400]")).unwrap()], 64, 36);
}

#[test]
fn what_is_too_far_away_is_an_error_at_its_line() {
    let text = "simulation.duration = 0\n[grid]\n\n[body.near]\nshape.sphere.radius = 1e4\n\n\
        [body.far]\nshape.sphere.radius = 1\nlocation = [1e16, 0, 0]\n";
    let scene = Scene::parse(text).unwrap();
    let Err(RunError::Emit(EmitError::Indistinct(report))) = Run::new(&scene) else { panic!("it is drawn") };
    let [error] = report.diagnostics.as_slice() else { panic!("{report}") };
    let span = error.span().unwrap();
    assert_eq!(report.sources.start(span).line, 7, "{report}");
    assert!(error.message.contains("`far`"), "{report}");
}

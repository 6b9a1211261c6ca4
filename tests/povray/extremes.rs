//! Scenes of numbers that are very large or very small: jabuka refuses them, or POV-Ray takes their scripts without a word.

use std::fs;

use jabuka::emit::EmitError;
use jabuka::{Run, RunError, Scene};

use crate::povray;

/// The script of the first frame; none where jabuka refuses the scene as too small or too far for POV-Ray.
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

/// Has POV-Ray parse scripts in one process, for a picture of the given size, of which it draws one pixel.
fn parse(scripts: &[String], width: u32, height: u32) {
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
    povray::run(folder.path(), &arguments).nothing("extreme scenes");
}

/// Numbers that follow from each other, the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self, below: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % below
    }

    /// An ordinary length, or one in four times an extreme one, m.
    fn length(&mut self) -> String {
        const EXTREME: [&str; 10] =
            ["1e-90", "1e-30", "1e-12", "1e-6", "1e-4", "1e4", "1e7", "1e10", "1e16", "1e60"];
        match self.next(4) {
            0 => EXTREME[usize::try_from(self.next(10)).unwrap()].to_owned(),
            _ => format!("{}.5", self.next(5)),
        }
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
            let shape = shapes[usize::try_from(self.next(6)).unwrap()].replace('R', &self.length());
            let shape = if shape.contains("1e60 }") { "sphere.radius = 1" } else { &shape };
            let location = [self.length(), self.length(), self.length()].join(", ");
            let trail =
                ["", "trail = true\n", "arrows.velocity = true\n"][usize::try_from(self.next(3)).unwrap()];
            text += &format!(
                "[body.{body}]\nshape.{shape}\nlocation = [{location}]\nvelocity = [1, 2, 0]\n{trail}"
            );
        }
        match self.next(4) {
            0 => text += "camera.projection = 'orthographic'\n",
            1 => text += &format!("camera.location = [{}, 1, 9]\n", self.length()),
            2 => text += &format!("camera.look_at = [{}, 1, 0]\n", self.length()),
            _ => {}
        }
        text.replace("[body.", "\n[body.").replace("camera.", "\n[camera]\n")
            + ["", "[grid]\n", "[scale_bar]\n", "[label.now]\ntext = '${a.speed}'\n"]
                [usize::try_from(self.next(4)).unwrap()]
    }
}

#[test]
fn povray_takes_whatever_is_not_refused() {
    let mut numbers = Numbers(1);
    let scenes: Vec<String> = (0..60).map(|_| numbers.scene()).collect();
    let scripts: Vec<String> = scenes.iter().filter_map(|scene| script(scene)).collect();
    assert!((10..50).contains(&scripts.len()), "{} of 60 are not refused", scripts.len());
    parse(&scripts, 64, 36);
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
    assert_eq!(report.sources.position(span.source, span.start).line, 7, "{report}");
    assert!(error.message.contains("`far`"), "{report}");
}

//! Tests that jabuka recognizes an up-to-date output folder without running the scene.

use std::fs;

use jabuka::diagnostic::{Code, Report};
use jabuka::output::{Folder, Manifest, up_to_date, write};
use jabuka::scene::{Options, Override};
use jabuka::simulate::Selection;
use jabuka::{Run, Scene};

/// A ball on a spring, with a step so long that its energy drifts. Its script reads an image.
const SCENE: &str = "
    [simulation]
    duration = 0.4
    integrator = 'explicit-euler'
    step = 0.02
    [povray]
    assets = ['stars.png']
    [camera]
    shutter = 0.01
    [view.top]
    location = [0, 9, 0]
    [body.ball]
    shape.sphere.radius = 0.5
    location = [3, 0, 0]
    [force.spring.spring]
    between = ['ball', [0, 0, 0]]
    rest_length = 0
    stiffness = 90
    ";

struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Place {
        let place = Place(tempfile::tempdir().unwrap());
        fs::write(place.path("scene.toml"), SCENE).unwrap();
        fs::write(place.path("stars.png"), "an image").unwrap();
        place.write(&place.scene(None), &Selection::first(11));
        place
    }

    fn path(&self, name: &str) -> std::path::PathBuf {
        self.0.path().join(name)
    }

    fn scene(&self, set: Option<&str>) -> Scene {
        let overrides = set.map(|set| Override::new(set.to_owned())).into_iter().collect();
        let options = Options { overrides, ..Options::default() };
        Scene::from_path_with(self.path("scene.toml"), &options).unwrap()
    }

    fn write(&self, scene: &Scene, selection: &Selection) {
        let run = Run::new(scene).unwrap();
        write(&run, &Folder::open(&self.path("out")).unwrap(), selection, &|| {}).unwrap();
    }

    fn found(&self, scene: &Scene, selection: &Selection) -> Option<Manifest> {
        up_to_date(scene, None, selection, &Folder::open(&self.path("out")).unwrap())
    }
}

#[test]
fn what_was_written_is_known_with_what_was_noticed() {
    let place = Place::new();
    let scene = place.scene(None);
    let manifest = place.found(&scene, &Selection::first(11)).unwrap();
    let run = Run::new(&scene).unwrap();
    assert_eq!(manifest.head.drift, Some(run.survey().drift));
    let said = |warnings| Report { diagnostics: warnings, ..Report::default() }.to_text(false);
    assert_eq!(said(manifest.warnings()), said(run.warnings()));
    assert!(manifest.warnings().iter().any(|warning| warning.code == Code::EnergyDrift));
    // A part of the frames is up to date, too; the scripts of another camera are not.
    assert!(place.found(&scene, &"3-5".parse().unwrap()).is_some());
    let view = &scene.views[0];
    let folder = Folder::open(&place.path("out")).unwrap();
    assert_eq!(up_to_date(&scene, Some(view), &Selection::first(11), &folder), None);
}

#[test]
fn what_is_not_there_or_not_as_it_was_is_not_up_to_date() {
    let all = Selection::first(11);
    type Change<'a> = (&'a str, &'a dyn Fn(&Place));
    let changes: [Change<'_>; 7] = [
        ("a script that is gone", &|place| fs::remove_file(place.path("out/frame_0004.pov")).unwrap()),
        ("a script of the same length", &|place| {
            let path = place.path("out/shutter_0004.pov");
            let text = fs::read_to_string(&path).unwrap();
            fs::write(&path, text.replacen("sphere", "Sphere", 1)).unwrap();
        }),
        ("what renders them all", &|place| fs::write(place.path("out/animation.ini"), "").unwrap()),
        ("the copy of an asset", &|place| fs::write(place.path("out/assets/stars.png"), "an Image").unwrap()),
        ("an asset", &|place| fs::write(place.path("stars.png"), "an Image").unwrap()),
        ("the scene", &|place| fs::write(place.path("scene.toml"), format!("# new\n{SCENE}")).unwrap()),
        ("another program", &|place| {
            let path = place.path("out/manifest.json");
            let text = fs::read_to_string(&path).unwrap();
            let (before, rest) = text.split_once("\"build\": \"").unwrap();
            fs::write(&path, format!("{before}\"build\": \"x{rest}")).unwrap();
        }),
    ];
    for (what, change) in changes {
        let place = Place::new();
        change(&place);
        assert_eq!(place.found(&place.scene(None), &all), None, "{what}");
    }
    let place = Place::new();
    assert_eq!(place.found(&place.scene(Some("simulation.step=0.01")), &all), None);
}

#[test]
fn frames_that_were_not_asked_for_are_missing() {
    let place = Place::new();
    fs::remove_dir_all(place.path("out")).unwrap();
    let scene = place.scene(None);
    place.write(&scene, &"2,4".parse().unwrap());
    assert!(place.found(&scene, &"4".parse().unwrap()).is_some());
    assert_eq!(place.found(&scene, &"4-5".parse().unwrap()), None);
}

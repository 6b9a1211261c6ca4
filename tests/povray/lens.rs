//! Tests of the camera: orthographic projection, and a lens with depth of field.

use glam::DVec2;

use crate::image::{Image, Rgb, is_blue, is_green, is_red};
use crate::pinhole::SIZE;
use crate::povray::{render_all, run};
use crate::scene::{DARK, script, shining_ball};

#[test]
fn without_perspective_places_are_proportional_and_nearness_changes_nothing() {
    let camera =
        "\n[camera]\nprojection = 'orthographic'\nlocation = [0, 0, 9]\nlook_at = [0, 0, 0]\nwidth = 16\n";
    let bodies = shining_ball("right", [4.0, 2.0, -7.0], 0.5, "#ff0000")
        + &shining_ball("left", [-4.0, -2.0, 5.0], 0.5, "#0000ff");
    let [image] = render_all([script(&(bodies + DARK + camera))], SIZE);
    let (right, left) = (image.spot(is_red), image.spot(is_blue));
    // The scale is ten pixels per meter from the center at (80, 50); y points down.
    assert!(right.middle().distance(DVec2::new(120.0, 30.0)) < 0.3, "{}", right.middle());
    assert!(left.middle().distance(DVec2::new(40.0, 70.0)) < 0.3, "{}", left.middle());
    let ratio = right.area() / left.area();
    assert!((0.97..1.03).contains(&ratio), "{ratio}");
}

#[test]
fn a_lens_blurs_what_is_not_in_focus() {
    let camera = |lens: &str| format!("\n[camera]\nlocation = [0, 0, 9]\nlook_at = [0, 0, 0]\n{lens}\n");
    let bodies = shining_ball("near", [-1.5, 0.0, 0.0], 0.5, "#ff0000")
        + &shining_ball("far", [3.0, 0.0, -9.0], 1.0, "#0000ff")
        + DARK;
    let scripts = ["", "aperture = 0.5", "aperture = 0.5\nfocus = [0, 0, -9]"]
        .map(|lens| script(&(bodies.clone() + &camera(lens))));
    let [sharp, near, far] = render_all(scripts, SIZE);
    // Blur spreads the edge of a ball, and leaves fewer pixels that are fully red or blue.
    let area = |image: &Image| (image.spot(is_red).area(), image.spot(is_blue).area());
    let ((red, blue), (red_near, blue_near), (red_far, blue_far)) = (area(&sharp), area(&near), area(&far));
    assert!(
        (red_near / red - 1.0).abs() < 0.1 && (blue_near / blue - 1.0).abs() > 0.1,
        "{red_near} {blue_near}"
    );
    assert!((blue_far / blue - 1.0).abs() < 0.1 && (red_far / red - 1.0).abs() > 0.1, "{red_far} {blue_far}");
}

/// Pixels of a spherical test picture.
const ALL_AROUND: [u32; 2] = [320, 160];

/// The pixel at which a spherical picture shows a point at this azimuth (to the right) and elevation, degrees.
fn spherical_place(azimuth: f64, elevation: f64) -> DVec2 {
    DVec2::new(160.0 + azimuth / 360.0 * 320.0, 80.0 - elevation / 180.0 * 160.0)
}

#[test]
fn a_spherical_picture_shows_all_directions_and_is_level() {
    let bodies = shining_ball("right", [5.0, 1.0, 2.0], 0.3, "#ff0000")
        + &shining_ball("behind", [2.0, 4.0, 7.0], 0.3, "#0000ff")
        + &shining_ball("ahead", [1.0, -2.0, -3.0], 0.3, "#00ff00");
    // The first camera looks down, the second to the right.
    let [down, right] = [[1.0, -2.0, -3.0], [5.0, 1.0, 2.0]].map(|look_at: [f64; 3]| {
        let camera = "\n[camera]\nprojection = 'spherical'\nlocation = [1, 1, 2]\n";
        script(&format!("{bodies}{DARK}{camera}look_at = {look_at:?}\n"))
    });
    let [down, right] = render_all([down, right], ALL_AROUND);
    let elevation = |height: f64, level: f64| libm::atan2(height, level).to_degrees();
    // Seen from the camera: 4 m to the right; 1 m right, 5 m back and 3 m up; 5 m ahead and 3 m down.
    let behind = 180.0 - elevation(1.0, 5.0);
    let high = elevation(3.0, 26.0_f64.sqrt());
    for (image, turned) in [(down, 0.0), (right, 90.0)] {
        let at = |azimuth: f64, elevation: f64| {
            spherical_place((azimuth - turned + 180.0).rem_euclid(360.0) - 180.0, elevation)
        };
        let spots = [image.spot(is_red), image.spot(is_blue), image.spot(is_green)].map(|spot| spot.middle());
        let places = [at(90.0, 0.0), at(behind, high), at(0.0, elevation(-3.0, 5.0))];
        for (spot, place) in spots.into_iter().zip(places) {
            assert!(spot.distance(place) < 1.0, "{turned}: {spot} instead of {place}");
        }
    }
}

#[test]
fn two_eyes_see_what_they_look_at_in_one_place_and_near_things_apart() {
    let bodies = shining_ball("aim", [0.0, 1.0, 0.0], 0.3, "#ff0000")
        + &shining_ball("near", [0.0, -1.0, 5.0], 0.2, "#0000ff")
        + &shining_ball("far", [0.0, -3.0, -20.0], 0.8, "#00ff00");
    let camera = "\n[camera]\nlocation = [0, 0, 10]\nlook_at = [0, 0, 0]\nstereo = 1\n";
    let scene = jabuka::Scene::parse(&(bodies + DARK + camera)).unwrap();
    let whole = jabuka::Run::new(&scene).unwrap();
    let scripts: Vec<String> = ["left", "right"]
        .into_iter()
        .map(|name| {
            let view = scene.views.iter().find(|view| view.name == name).unwrap();
            let run = whole.seen_by(view).unwrap();
            let frame = run.frames().next().unwrap().unwrap();
            run.script(&frame).unwrap()
        })
        .collect();
    let folder = tempfile::tempdir().unwrap();
    let images: Vec<Image> = scripts
        .iter()
        .map(|script| {
            std::fs::write(folder.path().join("eye.pov"), script).unwrap();
            let said = run(folder.path(), &["+Ieye.pov", "+Oeye.png", "+FN8", "+W160", "+H100"]);
            // POV-Ray warns that the camera is sheared, and of nothing else.
            assert!(said.success && said.errors.is_empty(), "{}", said.errors);
            assert_eq!(said.warnings.matches("Warning").count(), 1, "{}", said.warnings);
            assert!(said.warnings.contains("not perpendicular"), "{}", said.warnings);
            Image::read(&folder.path().join("eye.png"))
        })
        .collect();
    let [left, right] = [&images[0], &images[1]];
    let apart =
        |is_wanted: fn(Rgb) -> bool| left.spot(is_wanted).middle().x - right.spot(is_wanted).middle().x;
    // By similar triangles, a point at distance d has the parallax e (1/d - 1/D), in a picture that is 2 tan(20°) wide at a distance of 1.
    let parallax = |distance: f64| {
        1.0 * (1.0 / distance - 1.0 / 10.0) / (2.0 * libm::tan(20.0_f64.to_radians())) * 160.0
    };
    for (seen, distance) in [(apart(is_red), 10.0), (apart(is_blue), 5.0), (apart(is_green), 30.0)] {
        assert!(
            (seen - parallax(distance)).abs() < 0.5,
            "{seen} at {distance} m, not {}",
            parallax(distance)
        );
    }
}

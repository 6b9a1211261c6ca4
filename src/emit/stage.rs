//! The surroundings of the bodies (camera, lights, ground, sky) as values for templates. Lengths are in POV-Ray units.

use glam::DVec3;
use serde::Serialize;

use crate::picture::{Lens, Placed, PlacedLight, Plan};

/// The surroundings of the bodies, as values for templates.
#[derive(Clone, Debug, Serialize)]
pub(super) struct StageText {
    /// The length of one POV-Ray unit, m.
    unit: f64,
    /// The diagonal of the box around the motion, POV-Ray units.
    size: f64,
    /// The center of the box around the motion, POV-Ray units.
    center: [f64; 3],
    /// The camera. `None` if it changes from frame to frame.
    camera: Option<CameraText>,
    /// The lights. `None` if they change from frame to frame. An empty list means the default lights.
    lights: Option<Vec<LightText>>,
    ground: Option<GroundText>,
    /// The edge length of a tile of a checkered plane, POV-Ray units.
    tile: f64,
    /// The distance from the center over which the tiles of a checkered plane fade, POV-Ray units.
    tiles_fade: f64,
    /// The distance from the center over which ground and checkered planes fade into the horizon, POV-Ray units.
    fade: f64,
    /// The name of the scene's environment preset.
    preset: &'static str,
    /// The ambient light, as a linear color. `None` for the default ambient light, for which materials are designed.
    ambient: Option<[f64; 3]>,
    sky: SkyText,
    /// True if the background of the images is transparent.
    transparent: bool,
    fog: bool,
}

/// A camera, as values for templates.
#[derive(Clone, Debug, Serialize)]
pub(super) struct CameraText {
    location: [f64; 3],
    look_at: [f64; 3],
    /// The horizontal angle of view of a perspective camera, degrees.
    angle: Option<f64>,
    /// The width of the view of an orthographic camera, POV-Ray units.
    width: Option<f64>,
    /// The direction that points up in the picture, a unit vector. `None` for a camera that is upright.
    sky: Option<[f64; 3]>,
    /// True if the camera looks straight up or down. The vertical then cannot be the upward direction of the picture.
    vertical: bool,
    /// True if the pictures are so wide that the view is measured by their width instead of their height.
    wide: bool,
    /// The diameter of the lens aperture, POV-Ray units. `None` if everything is in focus.
    aperture: Option<f64>,
    /// A point in the plane of focus, POV-Ray units.
    focus: Option<[f64; 3]>,
    blur_samples: Option<u32>,
    /// True if the picture shows all directions.
    spherical: bool,
    /// The shear of one of two eyes, as the twelve numbers of a POV-Ray matrix. `None` for other cameras.
    shear: Option<[f64; 12]>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct LightText {
    name: String,
    /// The kind of the light: `point`, `area` or `sun`.
    kind: &'static str,
    /// The location of the light, POV-Ray units. For a sun, a point in the direction from which its light comes.
    location: [f64; 3],
    /// The diameter of an area light, POV-Ray units.
    size: Option<f64>,
    /// The linear color of the light, multiplied by its intensity.
    color: [f64; 3],
    shadows: bool,
}

#[derive(Clone, Debug, Serialize)]
struct GroundText {
    height: f64,
    tile: f64,
    /// The distance from the center over which the tiles of the ground fade, POV-Ray units.
    tiles_fade: f64,
}

#[derive(Clone, Debug, Serialize)]
struct SkyText {
    /// The color of a plain sky in sRGB. `None` for the sky of the environment preset.
    color: Option<[f64; 3]>,
}

impl StageText {
    /// Converts the planned surroundings to values for templates. `unit` is the length of one POV-Ray unit, m.
    pub(super) fn new(plan: &Plan, unit: f64) -> StageText {
        let stage = plan.stage();
        StageText {
            unit,
            size: stage.size / unit,
            center: (stage.center / unit).to_array(),
            camera: (!plan.camera_moves()).then(|| CameraText::new(plan.placed(), unit)),
            lights: (!plan.lights_move()).then(|| lights(plan.lights_at_start(), unit)),
            ground: stage.ground.map(|ground| GroundText {
                height: ground.height / unit,
                tile: ground.tile / unit,
                tiles_fade: ground.tiles_fade / unit,
            }),
            tile: stage.tile / unit,
            tiles_fade: stage.tiles_fade / unit,
            fade: stage.fade / unit,
            preset: stage.preset.name(),
            ambient: stage.ambient,
            sky: SkyText { color: stage.sky.map(|color| color.0) },
            transparent: stage.transparent,
            fog: stage.fog,
        }
    }
}

impl CameraText {
    /// Converts a camera to values for templates. `unit` is the length of one POV-Ray unit, m.
    pub(super) fn new(camera: &Placed, unit: f64) -> CameraText {
        let (angle, width) = match camera.lens() {
            Lens::Perspective { angle } => (Some(angle), None),
            Lens::Orthographic { width } => (None, Some(width / unit)),
            Lens::Spherical => (None, None),
        };
        CameraText {
            spherical: camera.lens() == Lens::Spherical,
            shear: camera.shear().map(|way| shear(way, camera.back(), camera.location() / unit)),
            location: (camera.location() / unit).to_array(),
            look_at: (camera.look_at() / unit).to_array(),
            angle,
            width,
            sky: camera.sky().map(|sky| sky.to_array()),
            vertical: camera.is_vertical(),
            wide: camera.is_wide(),
            aperture: camera.blur().map(|blur| blur.aperture / unit),
            focus: camera.focus().map(|focus| (focus / unit).to_array()),
            blur_samples: camera.blur().map(|blur| blur.samples),
        }
    }
}

/// Returns the matrix of a shear that keeps the plane across `back` through `fixed` (POV-Ray units), and moves other points by the vector `way`
/// times their distance along `back` from it. POV-Ray multiplies rows, so the matrix has the images of x, y and z in its rows, and last the
/// image of the origin.
fn shear(way: DVec3, back: DVec3, fixed: DVec3) -> [f64; 12] {
    let rows = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis + way * back.dot(axis));
    let all = rows.into_iter().chain([way * -back.dot(fixed)]);
    let mut numbers = all.flat_map(|row| row.to_array());
    std::array::from_fn(|_| numbers.next().unwrap_or_default())
}

/// Returns planned lights as values for templates. `unit` is the length of one POV-Ray unit, m.
pub(super) fn lights(lights: Vec<PlacedLight>, unit: f64) -> Vec<LightText> {
    let text = |light: PlacedLight| LightText {
        name: light.name,
        kind: light.kind.name(),
        location: (light.location / unit).to_array(),
        size: light.size.map(|size| size / unit),
        color: light.color,
        shadows: light.shadows,
    };
    lights.into_iter().map(text).collect()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::emit::Emitter;
    use crate::picture::Lamp;
    use crate::scene::{Color, Preset, Scene};
    use crate::simulate::{Frames, survey};

    /// Parses a vector `<a, b, c>` at the start of a text. A single number stands for three equal ones.
    fn vector(text: &str) -> [f64; 3] {
        let text = text.trim_start();
        let number = |text: &str| text.trim().parse::<f64>().unwrap();
        match text.strip_prefix('<') {
            Some(rest) => {
                let parts: Vec<f64> = rest.split('>').next().unwrap().split(',').map(number).collect();
                parts.try_into().unwrap()
            }
            None => [number(text.split_whitespace().next().unwrap()); 3],
        }
    }

    /// Parses a light in a script. Returns its location, linear color, diameter, and whether it casts shadows.
    fn said(light: &str) -> (DVec3, [f64; 3], Option<f64>, bool) {
        let (_, color) = light.split_once("color ").unwrap();
        let color = match color.strip_prefix("srgb ") {
            Some(color) => {
                // POV-Ray multiplies the sRGB color by the factor before it converts the color to linear light.
                let factor = color.split_once(">*").map(|(_, rest)| rest.split_whitespace().next().unwrap());
                let factor: f64 = factor.map_or(1.0, |factor| factor.parse().unwrap());
                Color(vector(color).map(|c| c * factor)).linear()
            }
            None => vector(color.strip_prefix("rgb ").unwrap()),
        };
        let size = light.split_once("area_light x*").map(|(_, rest)| rest.split(',').next().unwrap());
        let size = size.map(|size| size.parse().unwrap());
        (DVec3::from_array(vector(light)), color, size, !light.contains("shadowless"))
    }

    /// The default lights are defined twice: in the templates and in the plan.
    #[test]
    fn the_usual_lights_are_those_of_the_templates() {
        for preset in Preset::ALL {
            let text = format!(
                "simulation.duration = 1\nenvironment.preset = '{}'
                [body.ball]\nshape.sphere.radius = 1e-4\nlocation = [3e-4, 2e-4, 1e-4]",
                preset.name()
            );
            let scene = Scene::parse(&text).unwrap();
            let survey = survey(&scene, |_| {}).unwrap();
            let emitter = Emitter::new(&scene, &scene.camera, &survey).unwrap();
            let script = emitter.script(&Frames::new(&scene).next().unwrap().unwrap()).unwrap();
            let unit = emitter.unit();
            assert_ne!(unit, 1.0);
            let written: Vec<_> = script.split("light_source {").skip(1).map(said).collect();
            let planned = emitter.plan().usual_lights();
            assert_eq!(written.len(), planned.len(), "{preset:?}");
            for ((location, color, size, shadows), light) in written.into_iter().zip(planned) {
                let far = emitter.plan().stage().size * 40.0;
                assert!((location * unit).abs_diff_eq(light.location, 1e-8 * far), "{preset:?}: {light:?}");
                assert!(
                    DVec3::from_array(color).abs_diff_eq(light.color.into(), 1e-8),
                    "{preset:?}: {light:?}"
                );
                assert_eq!(
                    (size.is_some(), shadows),
                    (light.kind == Lamp::Area, light.shadows),
                    "{preset:?}"
                );
                let off = size.unwrap_or(0.0) * unit - light.size.unwrap_or(0.0);
                assert!(off.abs() < 1e-8 * far, "{preset:?}: {light:?}");
            }
        }
    }
}

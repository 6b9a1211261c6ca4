//! Turns the materials of a scene into text and values for scripts.

use glam::{DQuat, DVec3};
use serde::Serialize;

use super::sdl::Style;
use super::text::Identifiers;
use crate::physics::Shape;
use crate::picture;
use crate::scene::{Body, Color, Look, LookNumber, Material, Pattern, Scene};
use sha2::{Digest, Sha256};

/// The kind of a material. Templates see it in lower case: `plain`.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Plain,
    Library,
    Checkered,
    Texture,
    Sdl,
}

/// The family of materials with fibers.
const WOODS: &str = "woods";
/// The identifier of the color of the next bodies in scripts, for materials whose color follows a value.
pub(super) const SHADE_IDENTIFIER: &str = "Shade";
/// The identifier of the transparency of the next bodies in scripts, for materials whose transparency follows a value.
pub(super) const TRANSPARENCY_IDENTIFIER: &str = "Transparency";
/// The identifier of the glow of the next bodies in scripts, for materials whose glow follows a value.
pub(super) const GLOW_IDENTIFIER: &str = "Glow";

/// The values of a material that templates can use.
#[derive(Clone, Debug, Serialize)]
pub(super) struct MaterialText {
    /// The name of the material in the scene.
    pub(super) name: String,
    /// The identifier of the material in the scripts.
    pub(super) identifier: String,
    kind: Kind,
    /// The color in sRGB, for a plain material or a material of the library.
    pub(super) color: Option<[f64; 3]>,
    /// True if the color follows a value.
    mapped: bool,
    /// The transparency: a number, or its identifier if it follows a value. `None` for an opaque material.
    transparency: Option<String>,
    /// The part of the color that shines by itself: a number, or its identifier if it follows a value. `None` for none.
    glow: Option<String>,
    /// The identifiers of what follows a value. If there are any, the material is a macro with these parameters, since each body has its own
    /// values.
    parameters: Vec<&'static str>,
    /// The name of the finish, for a plain material.
    finish: Option<&'static str>,
    /// The name of the material in the library, for a material of the library.
    like: Option<&'static str>,
    /// The name of the material family, which selects the template, for a material of the library.
    family: Option<&'static str>,
    /// The index of refraction, for a transparent material of the library.
    ior: Option<f64>,
    /// True if the material shines all by itself. Such a body casts no shadow.
    glows: bool,
    /// True if a plane has this material. The material of a plane must be able to fade into the haze.
    on_plane: bool,
    /// The identifier of a texture that one of the scene's include files declares.
    texture: Option<String>,
    /// The POV-Ray code of the material, if the scene contains such code.
    sdl: Option<String>,
    /// The kind of pattern whose size depends on the body.
    #[serde(skip)]
    pattern: Pattern,
    /// True if the material looks the same from all sides.
    #[serde(skip)]
    pub(super) is_uniform: bool,
    /// The index of the pale version of the material, which is used for ghosts (earlier poses of a body).
    #[serde(skip)]
    pub(super) pale: Option<usize>,
}

/// Returns the materials of a scene, each with a unique identifier. Pale versions for ghosts are at the end.
pub(super) fn texts(scene: &Scene) -> Vec<MaterialText> {
    let mut identifiers = Identifiers::default();
    let mut texts: Vec<_> = scene.materials.iter().map(|m| text(m, &mut identifiers)).collect();
    for body in scene.bodies.iter().filter(|body| body.shape.is_unbounded()) {
        if let Some(material) = body.material {
            texts[material].on_plane = true;
        }
    }
    for body in scene.bodies.iter().filter(|body| body.showing.ghosts.is_some()) {
        let Some(material) = body.material.filter(|&material| texts[material].pale.is_none()) else {
            continue;
        };
        if let Some(pale) = pale(&texts[material], scene.environment.is_dark(), &mut identifiers) {
            texts[material].pale = Some(texts.len());
            texts.push(pale);
        }
    }
    texts
}

/// Makes the pale version of a material, for ghosts. `None` if the material has no single color.
fn pale(material: &MaterialText, dark: bool, identifiers: &mut Identifiers) -> Option<MaterialText> {
    let color = picture::pale(Color(material.color?), dark).0;
    Some(MaterialText {
        name: format!("{}, ghost", material.name),
        identifier: identifiers.add("Ghost", &material.name),
        color: Some(color),
        on_plane: false,
        // A ghost does not know the value that the transparency or the glow of its body follows. So it is opaque, and does not glow.
        transparency: material.transparency.clone().filter(|it| it != TRANSPARENCY_IDENTIFIER),
        glow: material.glow.clone().filter(|glow| glow != GLOW_IDENTIFIER),
        parameters: material.parameters.iter().copied().filter(|it| *it == SHADE_IDENTIFIER).collect(),
        ..material.clone()
    })
}

fn text(material: &Material, identifiers: &mut Identifiers) -> MaterialText {
    let number = |number: LookNumber, identifier: &str| match number {
        LookNumber::Fixed(0.0) => None,
        LookNumber::Fixed(number) => Some(number.to_string()),
        LookNumber::Mapped(_) => Some(identifier.to_owned()),
    };
    let parameters = [
        (material.color_map.is_some(), SHADE_IDENTIFIER),
        (material.transparency.map().is_some(), TRANSPARENCY_IDENTIFIER),
        (material.glow.map().is_some(), GLOW_IDENTIFIER),
    ];
    let mut text = MaterialText {
        name: material.name.clone(),
        identifier: identifiers.add("Material", &material.name),
        kind: Kind::Plain,
        color: material.look.color().map(|color| color.0),
        mapped: material.color_map.is_some(),
        transparency: number(material.transparency, TRANSPARENCY_IDENTIFIER),
        glow: number(material.glow, GLOW_IDENTIFIER),
        parameters: parameters.into_iter().filter(|(is_one, _)| *is_one).map(|(_, name)| name).collect(),
        finish: None,
        like: None,
        family: None,
        ior: None,
        glows: material.glows(),
        on_plane: false,
        texture: None,
        sdl: None,
        pattern: Pattern::None,
        is_uniform: material.look.is_uniform(),
        pale: None,
    };
    match &material.look {
        Look::Plain { finish, .. } => text.finish = Some(finish.name()),
        Look::Library { material, .. } => {
            text.kind = Kind::Library;
            text.like = Some(material.name);
            text.family = Some(material.family);
            text.ior = material.ior;
            text.pattern = material.pattern;
        }
        Look::Checkered => text.kind = Kind::Checkered,
        Look::Texture(texture) => {
            text.kind = Kind::Texture;
            text.texture = Some(texture.to_string());
        }
        Look::Sdl(sdl) => {
            text.kind = Kind::Sdl;
            text.sdl = Some(sdl.to_string());
        }
    }
    text
}

impl MaterialText {
    /// Returns the name of the macro that draws a whole plane with its transform. `None` if planes of this material need no macro, because
    /// they neither fade into the haze nor have tiles.
    pub(super) fn plane_macro(&self) -> Option<String> {
        match self.kind {
            Kind::Checkered => Some(self.identifier.clone()),
            Kind::Plain | Kind::Library => self.on_plane.then(|| format!("{}_plane", self.identifier)),
            Kind::Texture | Kind::Sdl => None,
        }
    }

    /// Returns the SDL text that gives an object this material. The text is equal for all bodies.
    pub(super) fn usage(&self) -> String {
        match self.kind {
            // Raw SDL may contain more than a texture, so scripts declare it as a macro, which inserts its text at each call.
            Kind::Sdl => format!("{}()", self.identifier),
            Kind::Plain | Kind::Library | Kind::Checkered | Kind::Texture => {
                let no_shadow = if self.glows { " no_shadow" } else { "" };
                format!("material {{ {} }}{no_shadow}", self.inside())
            }
        }
    }

    /// Returns the SDL text of the material between the braces of `material { }`.
    fn inside(&self) -> String {
        match &self.parameters[..] {
            [] => self.identifier.clone(),
            parameters => format!("{}({})", self.identifier, parameters.join(", ")),
        }
    }

    /// Returns the SDL text that gives a body this material.
    ///
    /// A pattern is designed for a ball of radius 1. On a body, it is scaled as for a ball of the same volume. So a crate and a matchbox
    /// have equally many rings of wood. The fibers of wood run along the longest axis of the body.
    pub(super) fn usage_in(&self, body: &Body, style: Style) -> String {
        let (Pattern::Centred | Pattern::Cut, Some(radius)) = (self.pattern, body.drawn().radius_of_ball())
        else {
            return self.usage();
        };
        let mut place = String::new();
        if self.pattern == Pattern::Cut {
            place.push_str(" translate ");
            Style { unit: 1.0, ..style }.vector(&mut place, of_name(&body.name));
        }
        if self.family == Some(WOODS) {
            place.push_str(along_longest_axis(&body.shape));
        }
        place.push_str(" scale ");
        style.length(&mut place, radius);
        let no_shadow = if self.glows { " no_shadow" } else { "" };
        format!("material {{ {}{place} }}{no_shadow}", self.inside())
    }
}

/// Returns the rotation that turns x to the longest axis of a shape. It is empty if no axis is clearly longer than x.
fn along_longest_axis(shape: &Shape) -> &'static str {
    let length = |axis: DVec3| {
        let reach = |direction| shape.support(DQuat::IDENTITY, direction).unwrap_or(0.0);
        reach(axis) + reach(-axis)
    };
    let [x, y, z] = DVec3::AXES.map(length);
    match x * 1.01 {
        x if y > x && y >= z => " rotate z*90",
        x if z > x => " rotate y*90",
        _ => "",
    }
}

/// Returns the offset at which a body is cut from a block of patterned material. It is a hash of the body's name, and is small, so that
/// the center of the pattern, such as the rings of wood, stays visible.
fn of_name(name: &str) -> DVec3 {
    let digest = Sha256::digest(name);
    let [x, y, z] = [0, 1, 2].map(|i| f64::from(digest[i]) / 256.0);
    // Two decimals are enough to give two bodies different offsets.
    (DVec3::new(3.0 * x, 0.4 * y, 0.4 * z) * 100.0).round() / 100.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pattern_is_as_large_as_the_body() {
        let scene = |size: f64| {
            let text =
                format!("[body.crate]\nshape.box.size = [{size}, {size}, {size}]\nmaterial = \"striped\"\n");
            Scene::parse(&text).unwrap()
        };
        let usage = |size: f64, unit: f64| {
            let scene = scene(size);
            texts(&scene)[0].usage_in(&scene.bodies[0], Style { unit, digits: 4 })
        };
        assert_eq!(usage(1.0, 1.0), "material { Material_striped scale 0.6204 }");
        assert_eq!(usage(10.0, 1.0), "material { Material_striped scale 6.204 }");
        assert_eq!(usage(10.0, 10.0), usage(1.0, 1.0));
    }

    #[test]
    fn a_body_that_is_drawn_larger_has_a_larger_pattern() {
        let text = "[body.earth]\nshape.sphere.radius = 2\nlook.scale = 100\nmaterial = \"earth\"";
        let scene = Scene::parse(text).unwrap();
        let usage = texts(&scene)[0].usage_in(&scene.bodies[0], Style { unit: 1.0, digits: 4 });
        assert!(usage.ends_with("scale 200 }"), "{usage}");
    }

    #[test]
    fn fibers_run_along_the_longest_axis() {
        let along = |shape: &str| {
            let text = format!("[body.beam]\nshape.{shape}\nmaterial = 'wood'");
            along_longest_axis(&Scene::parse(&text).unwrap().bodies[0].shape)
        };
        assert_eq!(along("box.size = [3, 1, 1]"), "");
        assert_eq!(along("box.size = [1, 3, 2]"), " rotate z*90");
        assert_eq!(along("box.size = [1, 2, 3]"), " rotate y*90");
        assert_eq!(along("cylinder = { radius = 0.1, height = 2 }"), " rotate z*90");
        assert_eq!(along("cylinder = { radius = 2, height = 0.1 }"), "");
        assert_eq!(along("sphere.radius = 1"), "");
    }

    #[test]
    fn bodies_are_cut_from_different_places() {
        assert_ne!(of_name("a"), of_name("b"));
        assert!(of_name("a").abs().max_element() <= 3.0);
    }

    /// If rays end early, scenes with bubbles render fast, but dark glass and water turn black.
    #[test]
    fn rays_through_bubbles_end_early_unless_there_is_other_glass() {
        let ends_early = |materials: &[&str]| {
            let body = |(i, like): (usize, &&str)| {
                format!("[body.b{i}]\nshape.sphere.radius = 1\nmaterial = '{like}'\n")
            };
            let text: String = materials.iter().enumerate().map(body).collect();
            let scene = Scene::parse(&format!("simulation.duration = 0\n{text}")).unwrap();
            let run = crate::Run::new(&scene).unwrap();
            run.script(&run.frames().next().unwrap().unwrap()).unwrap().contains("adc_bailout 0.1")
        };
        assert!(ends_early(&["bubble", "ice", "chrome"]));
        assert!(!ends_early(&["bubble", "tinted_glass"]) && !ends_early(&["ice", "water"]));
        assert!(!ends_early(&["glass"]));
    }
}

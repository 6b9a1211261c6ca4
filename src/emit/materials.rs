//! The materials of a scene, as text for scripts.

use glam::DVec3;
use serde::Serialize;

use super::sdl::Style;
use super::text::Identifiers;
use crate::digest::Sha256;
use crate::picture;
use crate::scene::{Body, Color, Look, Material, Pattern, Scene};

/// The kind of a material, by its name in templates.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Plain,
    Library,
    Checkered,
    Texture,
    Sdl,
}

/// A material as templates see it.
#[derive(Clone, Debug, Serialize)]
pub(super) struct MaterialText {
    /// The name of the material in the scene.
    pub(super) name: String,
    /// The identifier of the material in the scripts.
    pub(super) identifier: String,
    kind: Kind,
    /// The color in sRGB, for a plain material or a material of the library.
    pub(super) color: Option<[f64; 3]>,
    /// The name of the finish, for a plain material.
    finish: Option<&'static str>,
    /// The name in the library, for a material of the library.
    like: Option<&'static str>,
    /// The template of the family, for a material of the library.
    family: Option<&'static str>,
    /// The index of refraction, for a clear material of the library.
    ior: Option<f64>,
    /// Whether the material gives light, and so casts no shadow.
    glows: bool,
    /// Whether a plane has this material. The material of a plane must be able to fade into the haze.
    on_plane: bool,
    /// The name of the texture that an include file declares.
    texture: Option<String>,
    /// POV-Ray code.
    sdl: Option<String>,
    /// The pattern, if its size depends on the body.
    #[serde(skip)]
    pattern: Pattern,
    /// Whether the material looks the same from all sides.
    #[serde(skip)]
    pub(super) is_uniform: bool,
    /// The index of the pale version of the material, which is used for ghosts.
    #[serde(skip)]
    pub(super) pale: Option<usize>,
}

/// The materials of a scene, each with a unique identifier.
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

/// The pale version of a material, for ghosts. `None` if the material has its own colors.
fn pale(material: &MaterialText, dark: bool, identifiers: &mut Identifiers) -> Option<MaterialText> {
    let color = picture::pale(Color(material.color?), dark).0;
    Some(MaterialText {
        name: format!("{}, ghost", material.name),
        identifier: identifiers.add("Ghost", &material.name),
        color: Some(color),
        on_plane: false,
        ..material.clone()
    })
}

fn text(material: &Material, identifiers: &mut Identifiers) -> MaterialText {
    let mut text = MaterialText {
        name: material.name.clone(),
        identifier: identifiers.add("Material", &material.name),
        kind: Kind::Plain,
        color: material.look.color().map(|color| color.0),
        finish: None,
        like: None,
        family: None,
        ior: None,
        glows: material.look.glows(),
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
    /// The name of a macro that draws a whole plane with its transform. `None` if planes of this material need no
    /// macro: they neither fade into the haze nor have a pattern of the size of the ground's tiles.
    pub(super) fn plane_macro(&self) -> Option<String> {
        match self.kind {
            Kind::Checkered => Some(self.identifier.clone()),
            Kind::Plain | Kind::Library => self.on_plane.then(|| format!("{}_plane", self.identifier)),
            Kind::Texture | Kind::Sdl => None,
        }
    }

    /// The text inside an object of this material. It is equal for all bodies.
    pub(super) fn usage(&self) -> String {
        match self.kind {
            // Raw SDL may contain more than a texture, so it is a macro, which inserts its text at each call.
            Kind::Sdl => format!("{}()", self.identifier),
            Kind::Plain | Kind::Library | Kind::Checkered | Kind::Texture => {
                let no_shadow = if self.glows { " no_shadow" } else { "" };
                format!("material {{ {} }}{no_shadow}", self.identifier)
            }
        }
    }

    /// The text inside a body of this material.
    ///
    /// A pattern is made for a ball of radius 1. On a body, it is scaled as for a ball of the same volume. So a crate
    /// and a matchbox have equally many rings of wood.
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
        place.push_str(" scale ");
        style.length(&mut place, radius);
        let no_shadow = if self.glows { " no_shadow" } else { "" };
        format!("material {{ {}{place} }}{no_shadow}", self.identifier)
    }
}

/// A place in a block of patterned material, from which the body with this name is cut. It is near the origin, so that
/// the centre of the pattern, as in rings of wood, stays visible.
fn of_name(name: &str) -> DVec3 {
    let digest = Sha256::digest(name);
    let [x, y, z] = [0, 1, 2].map(|i| f64::from(digest[i]) / 256.0);
    // Two decimals are enough to tell two bodies apart.
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
    fn bodies_are_cut_from_different_places() {
        assert_ne!(of_name("a"), of_name("b"));
        assert!(of_name("a").abs().max_element() <= 3.0);
    }

    /// Rays that are cut off early are cheap behind bubbles, and leave dark glass and water black.
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

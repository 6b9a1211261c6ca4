//! The materials of a scene as the scripts know them.

use glam::DVec3;
use serde::Serialize;

use super::sdl::Style;
use super::text::Identifiers;
use crate::digest::Sha256;
use crate::picture;
use crate::scene::{Body, Color, Look, Material, Pattern, Scene};

/// A material as templates see it.
#[derive(Clone, Debug, Serialize)]
pub(super) struct MaterialText {
    /// Its name in the scene.
    pub(super) name: String,
    /// Its identifier in the scripts.
    pub(super) identifier: String,
    /// `plain`, `library`, `checkered`, `texture` or `sdl`.
    kind: &'static str,
    /// The color in sRGB, for a plain material or one of the library.
    pub(super) color: Option<[f64; 3]>,
    /// The name of the finish, for a plain material.
    finish: Option<&'static str>,
    /// The name in the library, for a material of the library.
    like: Option<&'static str>,
    /// The template of the family, for a material of the library.
    family: Option<&'static str>,
    /// The index of refraction, for a clear material of the library.
    ior: Option<f64>,
    /// Whether it shines by itself, and casts no shadow.
    glows: bool,
    /// Whether a plane is made of it, which must be able to fade.
    on_plane: bool,
    /// The name of the texture that an include file declares.
    texture: Option<String>,
    /// POV-Ray's own words.
    sdl: Option<String>,
    /// Its pattern, if bodies have it in a size of their own.
    #[serde(skip)]
    pattern: Pattern,
    /// Whether it looks the same however it is turned.
    #[serde(skip)]
    pub(super) is_uniform: bool,
    /// The number of its pale twin, which ghosts are made of.
    #[serde(skip)]
    pub(super) pale: Option<usize>,
}

/// The materials of a scene, each with an identifier of its own.
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

/// A material for ghosts, paler than that of the body; none where it has colors of its own.
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
        kind: "plain",
        color: None,
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
        Look::Plain { color, finish } => {
            text.color = Some(color.0);
            text.finish = Some(finish.name());
        }
        Look::Library { material, color } => {
            text.kind = "library";
            text.color = color.map(|color| color.0);
            text.like = Some(material.name);
            text.family = Some(material.family);
            text.ior = material.ior;
            text.pattern = material.pattern;
        }
        Look::Checkered => text.kind = "checkered",
        Look::Texture(texture) => {
            text.kind = "texture";
            text.texture = Some(texture.to_string());
        }
        Look::Sdl(sdl) => {
            text.kind = "sdl";
            text.sdl = Some(sdl.to_string());
        }
    }
    text
}

impl MaterialText {
    /// The name of a macro that makes a whole plane of a transform, if planes of this material need one: to fade into
    /// the haze, or to have a pattern of the size of the ground's tiles.
    pub(super) fn plane_macro(&self) -> Option<String> {
        match self.kind {
            "checkered" => Some(self.identifier.clone()),
            "plain" | "library" if self.on_plane => Some(format!("{}_plane", self.identifier)),
            _ => None,
        }
    }

    /// The text inside an object of this material, equal for all bodies.
    pub(super) fn usage(&self) -> String {
        match self.kind {
            // Raw SDL may hold more than a texture, so it is a macro, whose text stands wherever it is called.
            "sdl" => format!("{}()", self.identifier),
            _ if self.glows => format!("material {{ {} }} no_shadow", self.identifier),
            _ => format!("material {{ {} }}", self.identifier),
        }
    }

    /// The text inside a body of this material.
    ///
    /// A pattern is made for a ball of radius 1. Its size on a body is that for a ball of the same drawn volume: a crate has as
    /// many rings of wood as a matchbox.
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

/// A place within a block of a patterned material, from which the body of a name is cut; not far, so that a place that
/// the pattern is centred on, as the rings of wood are, stays in sight.
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

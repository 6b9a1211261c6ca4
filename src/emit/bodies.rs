//! Writes the bodies of a frame as one block of SDL, POV-Ray's scene description language.
//!
//! The constant part of a body's text is written once, when the block is planned. For each frame, only the poses of the bodies are
//! inserted. All bodies of one uniform material form one union, and the union has the material. POV-Ray parses this form fastest and with
//! the least memory. The line of a body does not depend on the number of bodies in its union. So a new body at the end of a scene leaves
//! the lines of all other bodies unchanged.

use std::fmt::Write as _;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::materials::{GLOW_IDENTIFIER, MaterialText, SHADE_IDENTIFIER, TRANSPARENCY_IDENTIFIER};
use super::meshes::Meshes;
use super::sdl::Style;
use super::showing::color;
use super::{shapes, text};
use crate::physics::{BodySnapshot, Shape};
use crate::picture::Looks;
use crate::scene::{Body, Color, LookAspect, Scene};
use crate::simulate::Frame;

/// The planned text of all bodies, without their poses.
pub(super) struct Block {
    style: Style,
    groups: Vec<Group>,
    forms: Vec<TextTemplate>,
    /// The colors of each color map of the scene, as SDL vectors.
    shades: Vec<Vec<String>>,
}

/// Bodies that are written as one object: all bodies of one plain material, or a single body with its own look.
struct Group {
    bodies: Vec<Item>,
    /// The SDL text of the bodies' common material. `None` for a single body.
    shared: Option<String>,
    /// What in the look of the bodies follows a value.
    follows: Follows,
}

/// What in the look of bodies of one material follows a value of each body.
#[derive(Clone, Copy, Default)]
struct Follows {
    /// The color map of the bodies, by its index in the scene. `None` if their color stays.
    map: Option<usize>,
    transparency: bool,
    glow: bool,
}

impl Follows {
    fn of(scene: &Scene, body: &Body) -> Follows {
        let follows = |aspect| scene.value_map_of(body, aspect).is_some();
        Follows {
            map: scene.color_map_of(body),
            transparency: follows(LookAspect::Transparency),
            glow: follows(LookAspect::Glow),
        }
    }

    /// Returns the look of a body in a frame, as far as it follows a value: the index of its color, and the bits of its transparency and glow.
    /// Numbers that are not negative have the same order as their bits.
    fn key(self, id: usize, looks: &Looks) -> (usize, u64, u64) {
        let bits = |follows: bool, numbers: &[f64]| {
            if follows { numbers.get(id).map_or(0, |number| number.to_bits()) } else { 0 }
        };
        let color = self.map.and_then(|_| looks.colors.get(id)).map_or(0, |color| usize::from(*color));
        (color, bits(self.transparency, &looks.transparency), bits(self.glow, &looks.glow))
    }
}

/// One body in the block: its index in the scene, the index of its text template, and its name.
struct Item {
    id: usize,
    /// The index of the body's text template in [`Block`]'s `forms`.
    form: usize,
    name: Arc<str>,
}

/// A text template for bodies that differ only in pose and name: the text before the pose, how the pose is written, and the text after the
/// pose.
#[derive(PartialEq)]
struct TextTemplate {
    before: String,
    place: WrittenPose,
    /// The text between the pose and the name of the body.
    after: String,
}

/// How the pose of a body is written in SDL.
#[derive(PartialEq)]
enum WrittenPose {
    /// The center of the body, as a vector.
    Centre,
    /// The center and the radius of a ball whose size follows a value. The number is its largest radius, m.
    Ball(f64),
    /// A transform matrix. The quaternion rotates the shape before the orientation of the body is applied.
    Matrix(DQuat),
    /// The normal of a plane, and its distance from the origin. The vector is the normal in body axes.
    Plane(DVec3),
}

impl Block {
    /// Plans the text of all bodies in a scene. `materials` are in the order of the scene's materials; `colors` are those of its color maps.
    pub(super) fn new(
        scene: &Scene,
        materials: &[MaterialText],
        colors: &[Vec<Color>],
        meshes: &Meshes,
        style: Style,
    ) -> Block {
        let mut together: Vec<(Option<usize>, Vec<usize>)> = Vec::new();
        let mut group_of: Vec<Option<usize>> = vec![None; materials.len()];
        for (id, body) in scene.bodies.iter().enumerate() {
            match body.material.filter(|&m| stands_with_others(body, &materials[m])) {
                None => together.push((None, vec![id])),
                Some(material) => match group_of[material] {
                    Some(group) => together[group].1.push(id),
                    None => {
                        group_of[material] = Some(together.len());
                        together.push((Some(material), vec![id]));
                    }
                },
            }
        }
        let mut forms = Vec::new();
        let plan = |(material, bodies): &(Option<usize>, Vec<usize>)| {
            let group = match material {
                Some(material) => {
                    of_one_material(scene, &materials[*material], bodies, meshes, style, &mut forms)
                }
                None => single(&scene.bodies[bodies[0]], materials, bodies[0], meshes, style, &mut forms),
            };
            Group { follows: Follows::of(scene, &scene.bodies[bodies[0]]), ..group }
        };
        let groups = together.iter().map(plan).collect();
        let shades =
            colors.iter().map(|colors| colors.iter().map(|it| color(*it, style)).collect()).collect();
        Block { style, groups, forms, shades }
    }

    /// Appends the bodies that are present in a frame, with their looks. The error is the index of the first body whose location is not finite
    /// in POV-Ray units.
    pub(super) fn write(&self, out: &mut String, frame: &Frame, looks: &Looks) -> Result<(), usize> {
        for group in &self.groups {
            let drawn = group.bodies.iter().filter(|item| looks.draws(item.id));
            let there = drawn.filter_map(|item| Some((item, frame.body(item.id)?)));
            let follows = group.follows;
            if follows.map.is_none() && !follows.transparency && !follows.glow {
                self.together(out, group.shared.as_deref(), there, looks)?;
                continue;
            }
            // Bodies of one look stand together. The sort keeps their order.
            let key = |item: &Item| follows.key(item.id, looks);
            let mut sorted: Vec<(&Item, &BodySnapshot)> = there.collect();
            sorted.sort_by_cached_key(|(item, _)| key(item));
            for of_look in sorted.chunk_by(|(one, _), (other, _)| key(one) == key(other)) {
                let (color, transparency, glow) = key(of_look[0].0);
                if let Some(map) = follows.map {
                    let _ = writeln!(out, "#local {SHADE_IDENTIFIER} = {};", self.shades[map][color]);
                }
                self.local(out, TRANSPARENCY_IDENTIFIER, follows.transparency.then_some(transparency));
                self.local(out, GLOW_IDENTIFIER, follows.glow.then_some(glow));
                self.together(out, group.shared.as_deref(), of_look.iter().copied(), looks)?;
            }
        }
        Ok(())
    }

    /// Appends the declaration of a number for the next bodies, given its bits.
    fn local(&self, out: &mut String, identifier: &str, bits: Option<u64>) {
        if let Some(bits) = bits {
            let _ = write!(out, "#local {identifier} = ");
            self.style.number(out, f64::from_bits(bits));
            out.push_str(";\n");
        }
    }

    /// Appends bodies as one object with a common material, or a single body with its own.
    fn together<'a>(
        &self,
        out: &mut String,
        shared: Option<&str>,
        mut bodies: impl Iterator<Item = (&'a Item, &'a BodySnapshot)> + Clone,
        looks: &Looks,
    ) -> Result<(), usize> {
        if shared.is_some() {
            // POV-Ray warns about a union of one object. The texts for one body and for several differ only in the word before the
            // brace, so that a further body leaves all other lines unchanged.
            match bodies.clone().take(2).count() {
                0 => return Ok(()),
                1 => out.push_str("object {\n"),
                _ => out.push_str("union {\n"),
            }
        }
        bodies.try_for_each(|(item, body)| self.item(out, item, body, looks.scale_of(item.id)))?;
        if let Some(material) = shared {
            out.push_str("  ");
            out.push_str(material);
            out.push_str("\n}\n");
        }
        Ok(())
    }

    /// Plans a block of a single body.
    pub(super) fn of(body: &Body, materials: &[MaterialText], meshes: &Meshes, style: Style) -> Block {
        let mut forms = Vec::new();
        let groups = vec![single(body, materials, 0, meshes, style, &mut forms)];
        Block { style, groups, forms, shades: Vec::new() }
    }

    /// Appends the only body of a block at another pose, as for a ghost. `scale` is its size, relative to its largest one.
    pub(super) fn write_single(&self, out: &mut String, body: &BodySnapshot, scale: f64) {
        for item in self.groups.iter().flat_map(|group| &group.bodies) {
            // A ghost whose location cannot be written is left out: a body's earlier location is no reason to refuse the picture.
            let _ = self.item(out, item, body, scale);
        }
    }

    fn item(&self, out: &mut String, item: &Item, body: &BodySnapshot, scale: f64) -> Result<(), usize> {
        if !self.style.can_write(body.location) {
            return Err(item.id);
        }
        let form = &self.forms[item.form];
        out.push_str(&form.before);
        self.place(out, &form.place, body, scale);
        out.push_str(&form.after);
        out.push_str(&item.name);
        out.push('\n');
        Ok(())
    }

    fn place(&self, out: &mut String, place: &WrittenPose, body: &BodySnapshot, scale: f64) {
        match place {
            WrittenPose::Centre => self.style.point(out, body.location),
            WrittenPose::Ball(radius) => {
                self.style.point(out, body.location);
                out.push_str(", ");
                self.style.length(out, radius * scale);
            }
            WrittenPose::Matrix(turn) => {
                self.style.scaled_matrix(out, body.orientation * *turn, body.location, scale);
            }
            WrittenPose::Plane(normal) => {
                let normal = body.orientation * *normal;
                self.style.vector(out, normal);
                out.push_str(", ");
                self.style.length(out, normal.dot(body.location));
            }
        }
    }
}

/// Returns true if a body can be in one union with all other bodies of its material.
fn stands_with_others(body: &Body, material: &MaterialText) -> bool {
    material.is_uniform && !body.shape.is_unbounded() && !body.look.has_sdl()
}

/// Plans the bodies of one plain material as a union, with one line per body.
fn of_one_material(
    scene: &Scene,
    material: &MaterialText,
    bodies: &[usize],
    meshes: &Meshes,
    style: Style,
    forms: &mut Vec<TextTemplate>,
) -> Group {
    let item = |&id: &usize| {
        let body = &scene.bodies[id];
        let (before, place, after) = shape(body, true, meshes, style);
        let form = TextTemplate { before: format!("  {before}"), place, after: format!("{after} }} // ") };
        Item { id, form: number(form, forms), name: in_comment(body) }
    };
    Group {
        bodies: bodies.iter().map(item).collect(),
        shared: Some(material.usage()),
        follows: Follows::default(),
    }
}

/// Plans one body with its own material.
fn single(
    body: &Body,
    materials: &[MaterialText],
    id: usize,
    meshes: &Meshes,
    style: Style,
    forms: &mut Vec<TextTemplate>,
) -> Group {
    let material = body.material.map(|material| &materials[material]);
    let mut group = |form: TextTemplate| {
        let item = Item { id, form: number(form, forms), name: in_comment(body) };
        Group { bodies: vec![item], shared: None, follows: Follows::default() }
    };
    let plane_macro = material.and_then(MaterialText::plane_macro);
    if let (&Shape::Plane { normal }, Some(plane)) = (&body.shape, plane_macro) {
        let before = format!("{plane}(transform {{ ");
        let place = WrittenPose::Matrix(DQuat::from_rotation_arc(DVec3::Y, normal));
        return group(TextTemplate { before, place, after: " }) // ".to_owned() });
    }
    // An object from the scene's POV-Ray code may look different after a rotation, so its orientation must be written.
    let uniform = material.is_none_or(|m| m.is_uniform) && !body.look.has_sdl();
    let (mut before, place, mut after) = shape(body, uniform, meshes, style);
    let usage = material.map_or(String::new(), |material| format!(" {}", material.usage_in(body, style)));
    // The scene's POV-Ray code is on separate lines, since it may end with a `//` comment.
    let own = |sdl: &Option<Arc<str>>| sdl.as_ref().map_or(String::new(), |sdl| format!("\n{sdl}\n"));
    let usage = usage + &own(&body.look.sdl_before);
    after.push_str(&own(&body.look.sdl_after));
    // The transform comes after the pattern, so that the pattern moves with the body.
    match place {
        WrittenPose::Matrix(_) => {
            before.truncate(before.trim_end_matches(' ').len());
            let _ = write!(before, "{usage} ");
        }
        WrittenPose::Centre | WrittenPose::Ball(_) | WrittenPose::Plane(_) => after.push_str(&usage),
    }
    after.push_str(" } // ");
    group(TextTemplate { before, place, after })
}

/// Returns the name of a body, escaped for use in a `//` comment.
fn in_comment(body: &Body) -> Arc<str> {
    let name = text::comment(&body.name);
    if *name == *body.name { body.name.clone() } else { name.into() }
}

/// Returns the index of a text template in `forms`. Adds the template if it is not among the latest ones.
fn number(form: TextTemplate, forms: &mut Vec<TextTemplate>) -> usize {
    /// The number of latest templates that the search compares.
    const COMPARED_FORMS: usize = 16;
    if let Some(known) =
        forms.iter().enumerate().rev().take(COMPARED_FORMS).find(|(_, known)| **known == form)
    {
        return known.0;
    }
    forms.push(form);
    forms.len() - 1
}

/// Returns the text before the pose of a body, how the pose is written, and the text after the pose. `uniform` is true if the material
/// looks the same after any rotation.
fn shape(body: &Body, uniform: bool, meshes: &Meshes, style: Style) -> (String, WrittenPose, String) {
    if let Some(object) = &body.look.object {
        let place = WrittenPose::Matrix(DQuat::IDENTITY);
        return (shapes::open_sdl(object, body.look.scale, style), place, String::new());
    }
    match body.drawn() {
        Shape::Sphere { radius } if uniform && body.look.scale_map.is_some() => {
            ("sphere { ".to_owned(), WrittenPose::Ball(radius), String::new())
        }
        Shape::Sphere { radius } if uniform => {
            let mut after = ", ".to_owned();
            style.length(&mut after, radius);
            ("sphere { ".to_owned(), WrittenPose::Centre, after)
        }
        Shape::Plane { normal } if uniform => {
            ("plane { ".to_owned(), WrittenPose::Plane(normal), String::new())
        }
        Shape::Plane { normal } => {
            let turn = DQuat::from_rotation_arc(DVec3::Y, normal);
            ("plane { y, 0 ".to_owned(), WrittenPose::Matrix(turn), String::new())
        }
        shape => (shapes::open(&shape, meshes, style), WrittenPose::Matrix(DQuat::IDENTITY), String::new()),
    }
}

//! The bodies of a scene as nodes, with what moves them.

use std::collections::HashMap;

use glam::{DQuat, DVec3};

use super::document::{
    Accessor, Animation, Asset, Buffer, Channel, Document, Extras, FLOAT, Mesh, Node, Primitive, Sampler,
    SceneOfNodes, Target,
};
use super::geometry::Geometry;
use super::materials::{Paint, Paints, What};
use super::motion::{Motion, Way};
use crate::scene::{Body, Scene};
use crate::simulate::{Bounds, Survey};
use crate::surface::{Detail, Form, Piece, pieces};

/// With more pieces than this, each is drawn of fewer triangles.
const MANY: usize = 200;

/// The name of the node that has all others below it.
const ROOT: &str = "jabuka";

/// A scene on its way to a document.
struct Model<'a> {
    scene: &'a Scene,
    /// Where everything takes place.
    bounds: Bounds,
    nodes: Vec<Node>,
    meshes: Vec<Mesh>,
    /// The number of each mesh; the map is only asked, never walked through.
    known: HashMap<(Form, Paint), u32>,
    paints: Paints,
    accessors: Vec<Accessor>,
    geometry: Geometry,
}

/// A scene whose motion is known, as a document, and the triangles that belong to it.
pub(super) fn model(scene: &Scene, survey: &Survey, motion: &Motion) -> (Document, Geometry) {
    let drawn: Vec<Vec<Piece>> = scene.bodies.iter().map(|body| pieces(&body.drawn())).collect();
    let many = drawn.iter().map(Vec::len).sum::<usize>() > MANY;
    let nothing = Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE };
    let mut model = Model {
        scene,
        bounds: survey.bounds.unwrap_or(nothing),
        nodes: vec![Node { name: ROOT.to_owned(), ..Node::default() }],
        meshes: Vec::new(),
        known: HashMap::new(),
        paints: Paints::default(),
        accessors: Vec::new(),
        geometry: Geometry::new(if many { Detail::Coarse } else { Detail::Fine }),
    };
    let bodies = scene.bodies.iter().zip(motion.ways()).zip(drawn);
    let bodies: Vec<u32> = bodies.map(|((body, way), pieces)| model.body(body, way, pieces)).collect();
    let mut top = bodies.clone();
    top.extend(model.ground());
    model.nodes[0].children = top;
    let (animation, keys) = animation(motion, &bodies, model.geometry.keys(), &mut model.accessors);
    model.finish(motion, animation, keys)
}

impl Model<'_> {
    fn node(&mut self, node: Node) -> u32 {
        self.nodes.push(node);
        self.nodes.len() as u32 - 1
    }

    /// Adds the node of a body, with its pieces below it; a single piece that is where the body is, is the node itself.
    fn body(&mut self, body: &Body, way: &Way, pieces: Vec<Piece>) -> u32 {
        let number = self.node(Node { name: body.name.clone(), ..at(way.location, way.orientation) });
        let single = pieces.len() == 1;
        for mut piece in pieces {
            if piece.form == Form::Plane {
                self.spread(&mut piece, way);
            }
            let mesh = self.mesh(&piece, body.material.map_or(What::Unknown, What::Material));
            let centred = piece.location == DVec3::ZERO && piece.orientation == DQuat::IDENTITY;
            let scale = Some(piece.scale.to_array());
            if single && centred {
                let node = &mut self.nodes[number as usize];
                (node.mesh, node.scale) = (mesh, scale);
            } else {
                let name = format!("{}: {}", body.name, piece.form.name());
                let child = self.node(Node { name, mesh, scale, ..at(piece.location, piece.orientation) });
                self.nodes[number as usize].children.push(child);
            }
        }
        number
    }

    /// Makes the square of a plane as large as has to be, in the middle of everything.
    fn spread(&self, piece: &mut Piece, way: &Way) {
        let normal = piece.orientation * DVec3::Y;
        let middle = way.orientation.conjugate() * (self.middle() - way.location);
        piece.location = middle - normal * middle.dot(normal);
        piece.scale = DVec3::splat(self.half_of_ground());
    }

    fn middle(&self) -> DVec3 {
        (self.bounds.min + self.bounds.max) / 2.0
    }

    fn size(&self) -> f64 {
        (self.bounds.max - self.bounds.min).length()
    }

    /// Half the edge of what has no end.
    fn half_of_ground(&self) -> f64 {
        1.5 * self.size()
    }

    /// Adds the ground of the surroundings.
    fn ground(&mut self) -> Option<u32> {
        let ground = self.scene.environment.ground.as_ref().filter(|_| !self.scene.output.transparent)?;
        // Just under what is lowest, so that the two do not fight for what is seen.
        let height = ground.height.unwrap_or(self.bounds.min.y - self.size() / 1000.0);
        let scale = DVec3::splat(self.half_of_ground());
        let (location, orientation) = (self.middle().with_y(height), DQuat::IDENTITY);
        let piece = Piece { form: Form::Plane, scale, location, orientation, color: None };
        let mesh = self.mesh(&piece, What::Ground);
        let name = "ground".to_owned();
        Some(self.node(Node { name, mesh, scale: Some(scale.to_array()), ..at(location, orientation) }))
    }

    /// The number of the mesh that a piece is drawn of, unless it has no triangles.
    fn mesh(&mut self, piece: &Piece, material: What) -> Option<u32> {
        let what = piece.color.map_or(material, What::from);
        let paint = Paint { what, both_sides: !piece.form.is_closed() };
        let key = (piece.form.clone(), paint);
        if let Some(&number) = self.known.get(&key) {
            return Some(number);
        }
        let known = self.geometry.form(&piece.form, &mut self.accessors)?;
        let material = self.paints.number(paint, self.scene);
        let name = format!("{}, {}", piece.form.name(), self.paints.materials[material as usize].name);
        let primitive = Primitive { attributes: known.attributes, indices: known.indices, material };
        self.meshes.push(Mesh { name, primitives: [primitive] });
        let number = self.meshes.len() as u32 - 1;
        self.known.insert(key, number);
        Some(number)
    }

    /// What the scene is called.
    fn title(&self) -> String {
        self.scene.title.as_ref().unwrap_or(&self.scene.name).clone()
    }

    fn finish(self, motion: &Motion, animation: Option<Animation>, keys: u64) -> (Document, Geometry) {
        let views = self.geometry.views(keys);
        let bytes = views.iter().map(|view| view.byte_length).sum();
        let title = self.title();
        let document = Document {
            asset: Asset {
                version: "2.0",
                generator: format!("jabuka {}", env!("CARGO_PKG_VERSION")),
                extras: Extras {
                    title: title.clone(),
                    frame_rate: self.scene.simulation.frame_rate,
                    faster: motion.faster(),
                },
            },
            scene: 0,
            scenes: vec![SceneOfNodes { name: title, nodes: vec![0] }],
            nodes: self.nodes,
            meshes: self.meshes,
            materials: self.paints.materials,
            animations: animation.into_iter().collect(),
            accessors: self.accessors,
            buffers: if views.is_empty() { vec![] } else { vec![Buffer { byte_length: bytes }] },
            buffer_views: views,
        };
        (document, self.geometry)
    }
}

/// A node at a place.
fn at(location: DVec3, orientation: DQuat) -> Node {
    Node {
        translation: (location != DVec3::ZERO).then_some(location.to_array()),
        rotation: (orientation != DQuat::IDENTITY).then_some(orientation.to_array()),
        ..Node::default()
    }
}

/// What moves the nodes of the bodies, and how many bytes of keys that takes, which are those of a view; nothing where
/// nothing moves.
fn animation(
    motion: &Motion,
    nodes: &[u32],
    view: u32,
    accessors: &mut Vec<Accessor>,
) -> (Option<Animation>, u64) {
    if motion.ways().iter().all(|way| way.translations.is_empty() && way.rotations.is_empty()) {
        return (None, 0);
    }
    let mut offset = 0;
    let mut add = |kind, width: usize, min: Vec<f64>, max: Vec<f64>| {
        let count = motion.times().len();
        let byte_offset = offset;
        offset += 4 * (width * count) as u64;
        let numbers =
            Accessor { buffer_view: view, byte_offset, component_type: FLOAT, count, kind, min, max };
        accessors.push(numbers);
        accessors.len() as u32 - 1
    };
    let end = |time: Option<&f32>| time.map(|&time| f64::from(time)).into_iter().collect();
    let input = add("SCALAR", 1, end(motion.times().first()), end(motion.times().last()));
    let mut animation = Animation { name: "motion".to_owned(), channels: Vec::new(), samplers: Vec::new() };
    for (way, &node) in motion.ways().iter().zip(nodes) {
        // In the order of `Motion::numbers`.
        let parts = [("translation", "VEC3", 3, &way.translations), ("rotation", "VEC4", 4, &way.rotations)];
        for (path, kind, width, values) in parts {
            if !values.is_empty() {
                let output = add(kind, width, Vec::new(), Vec::new());
                let sampler = animation.samplers.len() as u32;
                animation.samplers.push(Sampler { input, output });
                animation.channels.push(Channel { sampler, target: Target { node, path } });
            }
        }
    }
    (Some(animation), offset)
}

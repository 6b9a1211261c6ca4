//! The bodies of a scene as nodes, with what moves them.

use glam::{DQuat, DVec3};

use super::channels::animation;
use super::document::{Animation, Asset, Buffer, Document, Extras, Node, SceneOfNodes};
use super::geometry::Geometry;
use super::materials::What;
use super::meshes::Meshes;
use super::motion::{Motion, Way};
use crate::scene::{Body, Look, Scene};
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
    meshes: Meshes,
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
        meshes: Meshes::new(if many { Detail::Coarse } else { Detail::Fine }),
    };
    let bodies = scene.bodies.iter().zip(motion.ways()).zip(drawn);
    let bodies: Vec<u32> = bodies.map(|((body, way), pieces)| model.body(body, way, pieces)).collect();
    let mut top = bodies.clone();
    top.extend(model.ground());
    model.nodes[0].children = top;
    let meshes = &mut model.meshes;
    let (animation, keys) = animation(motion, &bodies, meshes.geometry.keys(), &mut meshes.accessors);
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
        let material = body.material.map_or(What::Unknown, What::Material);
        // A pattern is made for a ball of radius 1, and on a body as large as on a ball of its volume.
        let ball = body.shape.volume().map(|volume| libm::cbrt(volume * 0.75 / std::f64::consts::PI));
        for mut piece in pieces {
            let mut pattern = ball;
            if piece.form == Form::Plane {
                self.spread(&mut piece, way);
                let checkered =
                    body.material.is_some_and(|m| self.scene.materials[m].look == Look::Checkered);
                pattern = checkered.then(|| self.tile());
            }
            let mesh = self.meshes.number(self.scene, &piece, material, pattern);
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

    /// The edge of a tile of the ground, m.
    fn tile(&self) -> f64 {
        let given = self.scene.environment.ground.as_ref().and_then(|ground| ground.tile);
        given.unwrap_or(self.size() / 12.0)
    }

    /// Adds the ground of the surroundings.
    fn ground(&mut self) -> Option<u32> {
        let ground = self.scene.environment.ground.as_ref().filter(|_| !self.scene.output.transparent)?;
        // Just under what is lowest, so that the two do not fight for what is seen.
        let height = ground.height.unwrap_or(self.bounds.min.y - self.size() / 1000.0);
        let scale = DVec3::splat(self.half_of_ground());
        let (location, orientation) = (self.middle().with_y(height), DQuat::IDENTITY);
        let piece = Piece { form: Form::Plane, scale, location, orientation, color: None };
        let mesh = self.meshes.number(self.scene, &piece, What::Ground, Some(self.tile()));
        let name = "ground".to_owned();
        Some(self.node(Node { name, mesh, scale: Some(scale.to_array()), ..at(location, orientation) }))
    }

    /// What the scene is called.
    fn title(&self) -> String {
        self.scene.title.as_ref().unwrap_or(&self.scene.name).clone()
    }

    fn finish(self, motion: &Motion, animation: Option<Animation>, keys: u64) -> (Document, Geometry) {
        let views = self.meshes.geometry.views(keys);
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
            meshes: self.meshes.meshes,
            materials: self.meshes.paints.materials,
            animations: animation.into_iter().collect(),
            accessors: self.meshes.accessors,
            buffers: if views.is_empty() { vec![] } else { vec![Buffer { byte_length: bytes }] },
            buffer_views: views,
        };
        (document, self.meshes.geometry)
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

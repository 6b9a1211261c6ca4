//! Builds the glTF document: the bodies, cameras and lights of a scene as nodes with their animation.

use glam::{DQuat, DVec3};

use super::cameras_and_lights::CamerasAndLights;
use super::channels::animation;
use super::document::{
    Animation, Asset, Buffer, Document, Extras, LIGHTS, LightOfNode, Lights, Node, OfLights, SceneOfNodes,
};
use super::geometry::Geometry;
use super::links::LinkNode;
use super::materials::PaintedObject;
use super::meshes::Meshes;
use super::motion::{NodeMotion, NodePose, SampledMotion};
use crate::scene::{Look, Scene};
use crate::surface::{BaseShape, Detail, Piece, pieces};

/// The number of pieces of bodies above which each piece gets fewer triangles.
const MAX_DETAILED_PIECES: usize = 200;

/// The name of the root node, which contains all other nodes.
const ROOT_NAME: &str = "jabuka";

/// A glTF document under construction.
struct DocumentBuilder<'a> {
    scene: &'a Scene,
    /// The surroundings, cameras and lights.
    sight: CamerasAndLights,
    nodes: Vec<Node>,
    meshes: Meshes,
}

/// Builds the glTF document of a scene whose motion is recorded. Also returns its triangles.
pub(super) fn document(
    scene: &Scene,
    sight: CamerasAndLights,
    links: &[LinkNode],
    motion: &SampledMotion,
) -> (Document, Geometry) {
    let drawn: Vec<Vec<Piece>> = scene.bodies.iter().map(|body| pieces(&body.drawn())).collect();
    let many = drawn.iter().map(Vec::len).sum::<usize>() > MAX_DETAILED_PIECES;
    let mut builder = DocumentBuilder {
        scene,
        sight,
        nodes: vec![Node { name: ROOT_NAME.to_owned(), ..Node::default() }],
        meshes: Meshes::new(if many { Detail::Coarse } else { Detail::Fine }),
    };
    let bodies = motion.ways().iter().zip(drawn).enumerate();
    let bodies: Vec<u32> = bodies.map(|(id, (way, pieces))| builder.body(id, way, pieces)).collect();
    let mut top = bodies.clone();
    top.extend(builder.ground());
    let beside = builder.beside(&motion.ways()[bodies.len()..]);
    top.extend(&beside);
    let ways = &motion.ways()[bodies.len() + beside.len()..];
    let links: Vec<u32> = links.iter().zip(ways).map(|(link, way)| builder.link(link, way)).collect();
    top.extend(&links);
    builder.nodes[0].children = top;
    let moving: Vec<u32> = bodies.into_iter().chain(beside).chain(links).collect();
    let meshes = &mut builder.meshes;
    let (animation, keys) = animation(motion, &moving, meshes.geometry.keys(), &mut meshes.accessors);
    builder.finish(motion, animation, keys)
}

impl DocumentBuilder<'_> {
    fn node(&mut self, node: Node) -> u32 {
        self.nodes.push(node);
        self.nodes.len() as u32 - 1
    }

    /// Adds the node of a body, with its pieces as child nodes. A single piece at the body's origin needs no child: the body's node draws
    /// it.
    fn body(&mut self, id: usize, way: &NodeMotion, pieces: Vec<Piece>) -> u32 {
        let body = &self.scene.bodies[id];
        let scale = (!way.shown.at_first()).then_some([0.0; 3]);
        let number = self.node(Node { name: body.name.to_string(), scale, ..at(way.start) });
        let single = pieces.len() == 1;
        let look = self.sight.looks.get(id).copied().flatten();
        let material = match (body.material, look) {
            (Some(material), Some(look)) => PaintedObject::Mapped(material, look),
            (Some(material), None) => PaintedObject::Material(material),
            (None, _) => PaintedObject::Unknown,
        };
        // A pattern is designed for a ball of radius 1. A body gets the pattern of a ball with the same volume.
        let ball = body.shape.radius_of_ball();
        let size = self.sight.sizes.get(id).copied().unwrap_or(1.0);
        // A body that is not drawn in the first frame keeps its node, which has no mesh.
        for mut piece in pieces.into_iter().filter(|_| size > 0.0) {
            piece.scale *= size;
            piece.location *= size;
            let mut pattern = ball;
            if piece.form == BaseShape::PLANE {
                self.spread(&mut piece, way);
                let checkered =
                    body.material.is_some_and(|m| self.scene.materials[m].look == Look::Checkered);
                pattern = checkered.then_some(self.sight.stage.tile);
            }
            let mesh = self.meshes.number(self.scene, &piece, material, pattern);
            let centred = piece.location == DVec3::ZERO && piece.orientation == DQuat::IDENTITY;
            let scale = Some(piece.scale.to_array());
            // A node has only one scale. For a body that comes and goes, that scale shows its presence (0 or 1), so its piece needs a
            // child node.
            if single && centred && way.shown.is_always() {
                let node = &mut self.nodes[number as usize];
                (node.mesh, node.scale) = (mesh, scale);
            } else {
                let name = format!("{}: {}", body.name, piece.form.name());
                let place = NodePose { location: piece.location, orientation: piece.orientation };
                let child = self.node(Node { name, mesh, scale, ..at(place) });
                self.nodes[number as usize].children.push(child);
            }
        }
        number
    }

    /// Scales and moves the square that shows an infinite plane, so that it extends beyond the scene and is centered on it.
    fn spread(&self, piece: &mut Piece, way: &NodeMotion) {
        let normal = piece.orientation * DVec3::Y;
        let NodePose { location, orientation } = way.start;
        let middle = orientation.conjugate() * (self.sight.stage.center - location);
        piece.location = middle - normal * middle.dot(normal);
        piece.scale = DVec3::splat(self.half_of_ground());
    }

    /// Returns half the edge of the square that shows an infinite plane, m.
    fn half_of_ground(&self) -> f64 {
        1.5 * self.sight.stage.size
    }

    /// Adds the ground of the surroundings. Returns its node, or `None` if the scene has no ground.
    fn ground(&mut self) -> Option<u32> {
        let ground = self.sight.stage.ground?;
        let scale = DVec3::splat(self.half_of_ground());
        let (location, orientation) = (self.sight.stage.center.with_y(ground.height), DQuat::IDENTITY);
        let piece = Piece { form: BaseShape::PLANE, scale, location, orientation, color: None };
        let mesh = self.meshes.number(self.scene, &piece, PaintedObject::Ground, Some(ground.tile));
        let name = "ground".to_owned();
        let place = NodePose { location, orientation };
        Some(self.node(Node { name, mesh, scale: Some(scale.to_array()), ..at(place) }))
    }

    /// Adds the nodes of the cameras and the lights. `ways` is their recorded motion.
    fn beside(&mut self, ways: &[NodeMotion]) -> Vec<u32> {
        let cameras = self.sight.cameras.iter().enumerate();
        let cameras = cameras.map(|(number, camera)| Node {
            name: camera.name.clone(),
            camera: Some(number as u32),
            ..Node::default()
        });
        let lights = self.sight.lights.iter().enumerate();
        let lights = lights.map(|(number, light)| Node {
            name: light.name.clone(),
            extensions: Some(OfLights { lights: LightOfNode { light: number as u32 } }),
            ..Node::default()
        });
        let nodes = cameras.chain(lights).zip(ways).map(|(node, way)| {
            let Node { translation, rotation, .. } = at(way.start);
            Node { translation, rotation, ..node }
        });
        let first = self.nodes.len() as u32;
        self.nodes.extend(nodes.collect::<Vec<_>>());
        (first..self.nodes.len() as u32).collect()
    }

    /// Adds the node of a part of a spring or joint.
    fn link(&mut self, link: &LinkNode, way: &NodeMotion) -> u32 {
        let (location, orientation) = (DVec3::ZERO, DQuat::IDENTITY);
        let piece = Piece { form: link.form.clone(), scale: DVec3::ONE, location, orientation, color: None };
        let mesh =
            self.meshes.number(self.scene, &piece, PaintedObject::Link(link.color.0.map(f64::to_bits)), None);
        let name = link.name.clone();
        self.node(Node { name, mesh, scale: Some(way.size.to_array()), ..at(way.start) })
    }

    /// Returns the title of the scene, or else its name.
    fn title(&self) -> String {
        self.scene.title.as_ref().unwrap_or(&self.scene.name).clone()
    }

    fn finish(self, motion: &SampledMotion, animation: Option<Animation>, keys: u64) -> (Document, Geometry) {
        let views = self.meshes.geometry.views(keys);
        let bytes = views.iter().map(|view| view.byte_length).sum();
        let title = self.title();
        let document = Document {
            asset: Asset {
                version: "2.0",
                generator: format!("jabuka {}", env!("CARGO_PKG_VERSION")),
                extras: Extras {
                    title: title.clone(),
                    frame_rate: self.scene.simulation.timeline.frame_rate,
                    faster: motion.faster(),
                },
            },
            scene: 0,
            scenes: vec![SceneOfNodes { name: title, nodes: vec![0] }],
            nodes: self.nodes,
            meshes: self.meshes.meshes,
            cameras: self.sight.cameras,
            materials: self.meshes.paints.materials,
            animations: animation.into_iter().collect(),
            accessors: self.meshes.accessors,
            buffers: if views.is_empty() { vec![] } else { vec![Buffer { byte_length: bytes }] },
            buffer_views: views,
            extensions_used: [LIGHTS],
            extensions: OfLights { lights: Lights { lights: self.sight.lights } },
        };
        (document, self.meshes.geometry)
    }
}

/// Makes a node with this pose.
fn at(pose: NodePose) -> Node {
    let NodePose { location, orientation } = pose;
    Node {
        translation: (location != DVec3::ZERO).then_some(location.to_array()),
        rotation: (orientation != DQuat::IDENTITY).then_some(orientation.to_array()),
        ..Node::default()
    }
}

//! The part of the glTF 2.0 format that jabuka uses, as types for serde.

use serde::Serialize;

/// A glTF document without its binary numbers. The format forbids empty lists, so empty lists are left out.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    pub(super) asset: Asset,
    pub(super) scene: u32,
    pub(super) scenes: Vec<SceneOfNodes>,
    pub(super) nodes: Vec<Node>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) meshes: Vec<Mesh>,
    pub(super) cameras: Vec<Camera>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) materials: Vec<Material>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) animations: Vec<Animation>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) accessors: Vec<Accessor>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) buffer_views: Vec<BufferView>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) buffers: Vec<Buffer>,
    pub(super) extensions_used: [&'static str; 1],
    pub(super) extensions: OfLights<Lights>,
}

#[derive(Serialize)]
pub(super) struct Asset {
    pub(super) version: &'static str,
    pub(super) generator: String,
    pub(super) extras: Extras,
}

/// Additional data about the scene, which viewers may show or ignore.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Extras {
    pub(super) title: String,
    /// The number of frames per second of simulated time.
    pub(super) frame_rate: f64,
    /// The ratio of the simulated time to the time of the animation: 2 for an animation at twice the real speed.
    pub(super) faster: f64,
}

#[derive(Serialize)]
pub(super) struct SceneOfNodes {
    pub(super) name: String,
    pub(super) nodes: Vec<u32>,
}

/// A glTF node. Its transform relative to its parent is a scaling, then a rotation, then a translation.
#[derive(Default, Serialize)]
pub(super) struct Node {
    pub(super) name: String,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) children: Vec<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) mesh: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) camera: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extensions: Option<OfLights<LightOfNode>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) translation: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) rotation: Option<[f64; 4]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) scale: Option<[f64; 3]>,
}

#[derive(Serialize)]
pub(super) struct Mesh {
    pub(super) name: String,
    pub(super) primitives: Vec<Primitive>,
}

#[derive(Serialize)]
pub(super) struct Primitive {
    pub(super) attributes: Attributes,
    pub(super) indices: u32,
    pub(super) material: u32,
}

#[derive(Clone, Copy, Serialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub(super) struct Attributes {
    pub(super) position: u32,
    pub(super) normal: u32,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material {
    pub(super) name: String,
    pub(super) pbr_metallic_roughness: Shading,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) emissive_factor: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) alpha_mode: Option<&'static str>,
    #[serde(skip_serializing_if = "is_false")]
    pub(super) double_sided: bool,
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
fn is_false(value: &bool) -> bool {
    !value
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Shading {
    pub(super) base_color_factor: [f64; 4],
    pub(super) metallic_factor: f64,
    pub(super) roughness_factor: f64,
}

/// A camera. It looks along −z of its node, with y up.
#[derive(Serialize)]
pub(super) struct Camera {
    pub(super) name: String,
    #[serde(flatten)]
    pub(super) lens: CameraLens,
}

/// The projection of a camera: perspective or orthographic.
#[derive(Serialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub(super) enum CameraLens {
    Perspective { perspective: Perspective },
    Orthographic { orthographic: Orthographic },
}

/// A perspective projection. `yfov` is the vertical angle of view, rad; `znear` and `zfar` are the distances of the clipping planes, m.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Perspective {
    pub(super) aspect_ratio: f64,
    pub(super) yfov: f64,
    pub(super) znear: f64,
    pub(super) zfar: f64,
}

/// An orthographic projection. `xmag` and `ymag` are half the width and half the height of the view, m.
#[derive(Serialize)]
pub(super) struct Orthographic {
    pub(super) xmag: f64,
    pub(super) ymag: f64,
    pub(super) znear: f64,
    pub(super) zfar: f64,
}

/// The name of the glTF extension for lights.
pub(super) const LIGHTS: &str = "KHR_lights_punctual";

/// The data that the glTF extension for lights adds to a document or a node.
#[derive(Serialize)]
pub(super) struct OfLights<T> {
    #[serde(rename = "KHR_lights_punctual")]
    pub(super) lights: T,
}

#[derive(Serialize)]
pub(super) struct Lights {
    pub(super) lights: Vec<Light>,
}

/// The light of a node, as an index into the document's list of lights.
#[derive(Serialize)]
pub(super) struct LightOfNode {
    pub(super) light: u32,
}

#[derive(Serialize)]
pub(super) struct Light {
    pub(super) name: String,
    #[serde(rename = "type")]
    pub(super) kind: &'static str,
    /// The linear color of the light. The largest component is 1.
    pub(super) color: [f64; 3],
    /// The intensity: in candela for a point light, in lux for a directional light.
    pub(super) intensity: f64,
}

#[derive(Serialize)]
pub(super) struct Animation {
    pub(super) name: String,
    pub(super) channels: Vec<Channel>,
    pub(super) samplers: Vec<Sampler>,
}

#[derive(Serialize)]
pub(super) struct Channel {
    pub(super) sampler: u32,
    pub(super) target: Target,
}

#[derive(Serialize)]
pub(super) struct Target {
    pub(super) node: u32,
    pub(super) path: &'static str,
}

/// The keyframes of an animated property: accessors of the times (`input`) and of the values (`output`).
#[derive(Serialize)]
pub(super) struct Sampler {
    pub(super) input: u32,
    /// The interpolation between two keyframes. If it is absent, glTF's default LINEAR applies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) interpolation: Option<&'static str>,
    pub(super) output: u32,
}

/// A list of numbers or vectors in a buffer view, from a byte offset on.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: u32,
    pub(super) byte_offset: u64,
    pub(super) component_type: u32,
    pub(super) count: usize,
    #[serde(rename = "type")]
    pub(super) kind: &'static str,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) min: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) max: Vec<f64>,
}

/// glTF's code for the component type `f32`.
pub(super) const FLOAT: u32 = 5126;
/// glTF's code for the component type `u32`.
pub(super) const UNSIGNED_INT: u32 = 5125;

/// A contiguous range of bytes in the buffer.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: u32,
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) byte_stride: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) target: Option<u32>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) byte_length: u64,
}

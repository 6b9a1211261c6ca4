//! The part of the glTF 2.0 format that jabuka uses.

use serde::Serialize;

/// The whole document except the binary numbers. The format forbids empty lists.
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

/// Additional data, which readers may show or ignore.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Extras {
    pub(super) title: String,
    /// Frames per second of the scene's time.
    pub(super) frame_rate: f64,
    /// How many times faster than real time the animation is.
    pub(super) faster: f64,
}

#[derive(Serialize)]
pub(super) struct SceneOfNodes {
    pub(super) name: String,
    pub(super) nodes: Vec<u32>,
}

/// A node: scaled, then turned, then moved, relative to its parent.
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

/// A camera. It looks along -z of its node, with y up.
#[derive(Serialize)]
pub(super) struct Camera {
    pub(super) name: String,
    #[serde(flatten)]
    pub(super) lens: CameraLens,
}

/// The projection of a camera.
#[derive(Serialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub(super) enum CameraLens {
    Perspective { perspective: Perspective },
    Orthographic { orthographic: Orthographic },
}

/// Angles are in radians.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Perspective {
    pub(super) aspect_ratio: f64,
    pub(super) yfov: f64,
    pub(super) znear: f64,
    pub(super) zfar: f64,
}

/// An orthographic camera, given by half its width and half its height.
#[derive(Serialize)]
pub(super) struct Orthographic {
    pub(super) xmag: f64,
    pub(super) ymag: f64,
    pub(super) znear: f64,
    pub(super) zfar: f64,
}

/// The extension of lights.
pub(super) const LIGHTS: &str = "KHR_lights_punctual";

/// The data of the lights extension for an object.
#[derive(Serialize)]
pub(super) struct OfLights<T> {
    #[serde(rename = "KHR_lights_punctual")]
    pub(super) lights: T,
}

#[derive(Serialize)]
pub(super) struct Lights {
    pub(super) lights: Vec<Light>,
}

/// The number of the light of a node.
#[derive(Serialize)]
pub(super) struct LightOfNode {
    pub(super) light: u32,
}

#[derive(Serialize)]
pub(super) struct Light {
    pub(super) name: String,
    #[serde(rename = "type")]
    pub(super) kind: &'static str,
    /// Linear, at most 1.
    pub(super) color: [f64; 3],
    /// Candela for a point light, lux for a directional one.
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

/// Values at times.
#[derive(Serialize)]
pub(super) struct Sampler {
    pub(super) input: u32,
    /// The interpolation between two times. If it is absent, glTF's default LINEAR applies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) interpolation: Option<&'static str>,
    pub(super) output: u32,
}

/// Numbers of a view, from a byte offset on.
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

/// `f32`.
pub(super) const FLOAT: u32 = 5126;
/// `u32`.
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

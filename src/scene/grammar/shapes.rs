//! The grammar of the shapes of bodies.

use super::Kind::{Asset, Boolean, Either, List, Number, Numbers, Sdl, Table};
use super::bodies;
use super::key::table;
use super::kind::{AXIS, NON_NEGATIVE, POSITIVE, VECTOR};
use super::{Bound, KeySpec, Rule};
use crate::scene::sdl::Where;

const SPHERE: KeySpec = KeySpec::new("sphere", Table(&sphere::TABLE), "A ball").also(&["ball"]);
const BOX: KeySpec = KeySpec::new("box", Table(&cuboid::TABLE), "A box, optionally with rounded edges")
    .also(&["cube", "cuboid", "brick"]);
const CYLINDER: KeySpec = KeySpec::new("cylinder", Table(&cylinder::TABLE), "A cylinder")
    .also(&["disk", "disc", "rod", "tube", "pipe"]);
const CAPSULE: KeySpec =
    KeySpec::new("capsule", Table(&capsule::TABLE), "A cylinder with a hemisphere on either end")
        .also(&["pill"]);
const CONE: KeySpec = KeySpec::new(
    "cone",
    Table(&cone::TABLE),
    "An upright cone or frustum; the center of mass of a cone is a quarter of the height above its base",
)
.also(&["frustum"]);
const TORUS: KeySpec =
    KeySpec::new("torus", Table(&torus::TABLE), "A ring around the y axis").also(&["ring", "donut"]);
const MESH: KeySpec =
    KeySpec::new("mesh", Table(&mesh::TABLE), "A solid with a triangle mesh from a file, in the file's axes")
        .also(&["obj", "stl", "model", "file", "trimesh", "triangles", "polyhedron", "mesh2"]);

table! {
    shape: "a shape", Rule::ExactlyOne(&[
        "sphere",
        "box",
        "cylinder",
        "capsule",
        "cone",
        "torus",
        "mesh",
        "plane",
        "axes",
        "heightfield",
        "compound",
        "sdl",
    ]);
    SPHERE: Any = super::SPHERE,
    BOX: Any = super::BOX,
    CYLINDER: Any = super::CYLINDER,
    CAPSULE: Any = super::CAPSULE,
    CONE: Any = super::CONE,
    TORUS: Any = super::TORUS,
    MESH: Any = super::MESH,
    PLANE: Any = KeySpec::new("plane", Table(&plane::TABLE), "An infinite plane, always fixed").also(&["floor", "ground"]),
    AXES: Any = KeySpec::new(
        "axes",
        Table(&axes::TABLE),
        "A triad of arrows along x, y, z, as heavy as a ball of half their length",
    )
    .also(&["axis", "triad", "frame"]),
    HEIGHTFIELD: Any = KeySpec::new(
        "heightfield",
        Table(&heightfield::TABLE),
        "A landscape with heights from the gray levels of an image, always fixed; its `location` is the \
         middle of its rectangle at the height of black",
    )
    .also(&["height_field", "terrain", "landscape", "heightmap", "image"]),
    COMPOUND: Any = KeySpec::new(
        "compound",
        Table(&compound::TABLE),
        "Several solids of one density as one body; its `location` is their common center of mass",
    )
    .also(&["union", "parts", "composite", "group"]),
    SDL: Any = KeySpec::new("sdl", Table(&sdl::TABLE), "An object in SDL, with a solid for mechanics").also(&[
        "povray",
        "custom",
        "isosurface",
    ]),
}

table! {
    compound: "a compound", Rule::Any;
    PARTS: Any = KeySpec::new(
    "parts",
    List { of: &Table(&part::TABLE), min: 1, max: usize::MAX },
    "Its parts; where they overlap, both count",
)
.required()
.also(&["shapes", "children", "of"]),
}

table! {
    part: "a part", Rule::ExactlyOne(&["sphere", "box", "cylinder", "capsule", "cone", "torus", "mesh"]);
    SPHERE: Any = super::SPHERE,
    BOX: Any = super::BOX,
    CYLINDER: Any = super::CYLINDER,
    CAPSULE: Any = super::CAPSULE,
    CONE: Any = super::CONE,
    TORUS: Any = super::TORUS,
    MESH: Any = super::MESH,
    LOCATION: DVec3 = KeySpec::new(
        "location",
        VECTOR,
        "The part's own center of mass, along the body's axes; their common origin does not matter",
    )
    .unit("m")
    .default_numbers(&[0.0, 0.0, 0.0])
    .also(&["position", "pos", "center", "translate", "origin", "offset"]),
    ORIENTATION: Any = KeySpec::new(
        "orientation",
        Either(&[VECTOR, Table(&bodies::orientation::TABLE)]),
        "Its orientation within the body",
    )
    .unit("degrees")
    .default("not turned")
    .also(&["rotation", "rotate", "angle", "attitude"]),
}

table! {
    sdl: "a shape in SDL", Rule::Any;
    OBJECT: Option<value::SharedText> = KeySpec::new(
        "object",
        Sdl(Where::Inside),
        "One object in SDL, in meters, with its center of mass at the origin; without `material` it \
         keeps its own textures, and is black without any",
    )
    .required()
    .also(&["sdl", "code", "text", "draw"]),
    STAND_IN: Any = KeySpec::new("stand_in", Table(&stand_in::TABLE), "The solid that gives its mass, inertia and extent")
        .required()
        .also(&["physics", "collider", "proxy", "bounds", "shape"]),
}

table! {
    stand_in: "a stand-in", Rule::ExactlyOne(&["sphere", "box", "cylinder", "capsule", "cone", "torus"]);
    SPHERE: Any = super::SPHERE,
    BOX: Any = super::BOX,
    CYLINDER: Any = super::CYLINDER,
    CAPSULE: Any = super::CAPSULE,
    CONE: Any = super::CONE,
    TORUS: Any = super::TORUS,
}

table! {
    sphere: "a sphere", Rule::Any;
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "Its radius")
    .unit("m")
    .required()
    .also(&["r", "size", "diameter"]),
}

table! {
    cuboid: "a box", Rule::Any;
    SIZE: Option<DVec3> = KeySpec::new("size", Numbers(3, Bound::Positive), "Its full edge lengths along its own x, y, z")
        .unit("m")
        .required()
        .also(&["edges", "extents", "dimensions", "half_extents"]),
    ROUNDING: f64 = KeySpec::new(
        "rounding",
        NON_NEGATIVE,
        "The radius of its edges and corners, at most half its smallest edge; included in `size`",
    )
    .unit("m")
    .default_number(0.0)
    .also(&["bevel", "corner_radius", "edge_radius", "radius", "round", "rounded"]),
}

table! {
    cylinder: "a cylinder", Rule::Any;
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "Its radius").unit("m").required().also(&["r", "size", "diameter"]),
    HEIGHT: Option<f64> = KeySpec::new("height", POSITIVE, "Its height, along its own y")
        .unit("m")
        .required()
        .also(&["h", "length"]),
}

table! {
    capsule: "a capsule", Rule::Any;
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "Its radius").unit("m").required().also(&["r", "size", "diameter"]),
    HEIGHT: Option<f64> = KeySpec::new("height", POSITIVE, "Its total height along its own y: at least twice its radius")
        .unit("m")
        .required()
        .also(&["h", "length"]),
}

table! {
    cone: "a cone", Rule::Any;
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "The radius of its base").unit("m").required().also(&[
        "r",
        "size",
        "diameter",
        "base_radius",
    ]),
    HEIGHT: Option<f64> = KeySpec::new("height", POSITIVE, "Its height, along its own y")
        .unit("m")
        .required()
        .also(&["h", "length"]),
    TOP_RADIUS: f64 = KeySpec::new("top_radius", NON_NEGATIVE, "The radius of its upper end; 0 gives it a tip")
        .unit("m")
        .default_number(0.0)
        .also(&["radius2", "r2", "tip_radius"]),
}

table! {
    torus: "a torus", Rule::Any;
    RADIUS: Option<f64> = KeySpec::new("radius", POSITIVE, "The distance from its center to the middle of its tube")
        .unit("m")
        .required()
        .also(&["r", "size", "diameter", "major_radius", "major"]),
    TUBE_RADIUS: Option<f64> = KeySpec::new("tube_radius", POSITIVE, "The radius of its tube, at most its `radius`")
        .unit("m")
        .required()
        .also(&["tube", "thickness", "minor_radius", "minor"]),
}

const SMOOTH: KeySpec = KeySpec::new(
    "smooth",
    Either(&[Boolean, Number(Bound::From(0.0, 180.0))]),
    "Which edges look smooth: all, none, or those between faces that meet at no more than this angle in \
     degrees",
)
.unit("°")
.default_flag(false)
.also(&["smoothing", "shading", "crease", "normals", "auto_smooth"]);

table! {
    mesh: "a mesh", Rule::Any;
    FILE: Option<value::Text> = KeySpec::new(
        "file",
        Asset,
        "The file, OBJ or STL, in the scene's folder. Its surface must be closed, unless the body is \
         fixed or has `mass` and `inertia`. The body's `location` is the center of its mass (of its area, \
         if it is open), not the origin of the file",
    )
    .required()
    .also(&["path", "name", "source", "obj", "stl", "filename"]),
    SCALE: f64 = KeySpec::new("scale", POSITIVE, "The length of one unit of the file: 0.001 for millimeters")
        .unit("m")
        .default_number(1.0)
        .also(&["unit", "units", "size", "factor"]),
    SMOOTH: Any = super::SMOOTH,
}

table! {
    heightfield: "a heightfield", Rule::Any;
    FILE: Option<value::Text> = KeySpec::new(
        "file",
        Asset,
        "A PNG in the scene's folder; each pixel is a point of the landscape, and the upper edge is the \
         far one",
    )
    .required()
    .also(&["image", "path", "png", "name", "source"]),
    SIZE: Option<DVec3> = KeySpec::new(
        "size",
        Numbers(3, Bound::Positive),
        "The distance between the centers of the first and last pixel along x; the height from black to \
         white; and the distance along z",
    )
    .unit("m")
    .required()
    .also(&["scale", "dimensions", "extents"]),
    SMOOTH: Any = super::SMOOTH,
}

table! {
    plane: "a plane", Rule::Any;
    NORMAL: value::Axis = KeySpec::new("normal", AXIS, "The direction out of the plane, in the body's own axes")
    .default_numbers(&[0.0, 1.0, 0.0])
    .also(&["direction", "up"]),
}

table! {
    axes: "axes", Rule::Any;
    LENGTH: Option<f64> = KeySpec::new("length", POSITIVE, "The length of each arrow")
    .unit("m")
    .required()
    .also(&["size"]),
}

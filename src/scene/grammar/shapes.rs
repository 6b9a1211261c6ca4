//! The grammar of the shapes of bodies.

use super::Kind::{Asset, Boolean, Either, List, Number, Numbers, Sdl, Table};
use super::bodies::ORIENTATION;
use super::kind::{AXIS, NON_NEGATIVE, POSITIVE, VECTOR};
use super::{Bound, KeySpec, Rule, TableSpec};
use crate::scene::sdl::Where;

const SPHERE: KeySpec = KeySpec::new("sphere", Table(&SPHERE_KEYS), "A ball").also(&["ball"]);
const BOX: KeySpec = KeySpec::new("box", Table(&BOX_KEYS), "A box, optionally with rounded edges")
    .also(&["cube", "cuboid", "brick"]);
const CYLINDER: KeySpec = KeySpec::new("cylinder", Table(&CYLINDER_KEYS), "A cylinder")
    .also(&["disk", "disc", "rod", "tube", "pipe"]);
const CAPSULE: KeySpec =
    KeySpec::new("capsule", Table(&CAPSULE_KEYS), "A cylinder with a hemisphere on either end")
        .also(&["pill"]);
const CONE: KeySpec = KeySpec::new(
    "cone",
    Table(&CONE_KEYS),
    "An upright cone or frustum; the center of mass of a cone is a quarter of the height above its base",
)
.also(&["frustum"]);
const TORUS: KeySpec =
    KeySpec::new("torus", Table(&TORUS_KEYS), "A ring around the y axis").also(&["ring", "donut"]);
const MESH: KeySpec =
    KeySpec::new("mesh", Table(&MESH_KEYS), "A solid with a triangle mesh from a file, in the file's axes")
        .also(&["obj", "stl", "model", "file", "trimesh", "triangles", "polyhedron", "mesh2"]);

pub(super) static SHAPE: TableSpec = TableSpec {
    noun: "a shape",
    rule: Rule::ExactlyOne(&[
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
    ]),
    keys: &[
        SPHERE,
        BOX,
        CYLINDER,
        CAPSULE,
        CONE,
        TORUS,
        MESH,
        KeySpec::new("plane", Table(&PLANE), "An infinite plane, always fixed").also(&["floor", "ground"]),
        KeySpec::new(
            "axes",
            Table(&AXES),
            "A triad of arrows along x, y, z, as heavy as a ball of half their length",
        )
        .also(&["axis", "triad", "frame"]),
        KeySpec::new(
            "heightfield",
            Table(&HEIGHTFIELD),
            "A landscape with heights from the gray levels of an image, always fixed; its `location` is the \
             middle of its rectangle at the height of black",
        )
        .also(&["height_field", "terrain", "landscape", "heightmap", "image"]),
        KeySpec::new(
            "compound",
            Table(&COMPOUND),
            "Several solids of one density as one body; its `location` is their common center of mass",
        )
        .also(&["union", "parts", "composite", "group"]),
        KeySpec::new("sdl", Table(&SDL), "An object in SDL, with a solid for mechanics").also(&[
            "povray",
            "custom",
            "isosurface",
        ]),
    ],
};

static COMPOUND: TableSpec = TableSpec {
    noun: "a compound",
    rule: Rule::Any,
    keys: &[KeySpec::new(
        "parts",
        List { of: &Table(&PART), min: 1, max: usize::MAX },
        "Its parts; where they overlap, both count",
    )
    .required()
    .also(&["shapes", "children", "of"])],
};

static PART: TableSpec = TableSpec {
    noun: "a part",
    rule: Rule::ExactlyOne(&["sphere", "box", "cylinder", "capsule", "cone", "torus", "mesh"]),
    keys: &[
        SPHERE,
        BOX,
        CYLINDER,
        CAPSULE,
        CONE,
        TORUS,
        MESH,
        KeySpec::new(
            "location",
            VECTOR,
            "The part's own center of mass, along the body's axes; their common origin does not matter",
        )
        .unit("m")
        .default_numbers(&[0.0, 0.0, 0.0])
        .also(&["position", "pos", "center", "translate", "origin", "offset"]),
        KeySpec::new(
            "orientation",
            Either(&[VECTOR, Table(&ORIENTATION)]),
            "Its orientation within the body",
        )
        .unit("degrees")
        .default("not turned")
        .also(&["rotation", "rotate", "angle", "attitude"]),
    ],
};

static SDL: TableSpec = TableSpec {
    noun: "a shape in SDL",
    rule: Rule::Any,
    keys: &[
        KeySpec::new(
            "object",
            Sdl(Where::Inside),
            "One object in SDL, in meters, with its center of mass at the origin; without `material` it \
             keeps its own textures, and is black without any",
        )
        .required()
        .also(&["sdl", "code", "text", "draw"]),
        KeySpec::new("stand_in", Table(&STAND_IN), "The solid that gives its mass, inertia and extent")
            .required()
            .also(&["physics", "collider", "proxy", "bounds", "shape"]),
    ],
};

static STAND_IN: TableSpec = TableSpec {
    noun: "a stand-in",
    rule: Rule::ExactlyOne(&["sphere", "box", "cylinder", "capsule", "cone", "torus"]),
    keys: &[SPHERE, BOX, CYLINDER, CAPSULE, CONE, TORUS],
};

static SPHERE_KEYS: TableSpec = TableSpec {
    noun: "a sphere",
    rule: Rule::Any,
    keys: &[KeySpec::new("radius", POSITIVE, "Its radius")
        .unit("m")
        .required()
        .also(&["r", "size", "diameter"])],
};

static BOX_KEYS: TableSpec = TableSpec {
    noun: "a box",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("size", Numbers(3, Bound::Positive), "Its full edge lengths along its own x, y, z")
            .unit("m")
            .required()
            .also(&["edges", "extents", "dimensions", "half_extents"]),
        KeySpec::new(
            "rounding",
            NON_NEGATIVE,
            "The radius of its edges and corners, at most half its smallest edge; included in `size`",
        )
        .unit("m")
        .default_number(0.0)
        .also(&["bevel", "corner_radius", "edge_radius", "radius", "round", "rounded"]),
    ],
};

static CYLINDER_KEYS: TableSpec = TableSpec {
    noun: "a cylinder",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("radius", POSITIVE, "Its radius").unit("m").required().also(&["r", "size", "diameter"]),
        KeySpec::new("height", POSITIVE, "Its height, along its own y")
            .unit("m")
            .required()
            .also(&["h", "length"]),
    ],
};

static CAPSULE_KEYS: TableSpec = TableSpec {
    noun: "a capsule",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("radius", POSITIVE, "Its radius").unit("m").required().also(&["r", "size", "diameter"]),
        KeySpec::new("height", POSITIVE, "Its total height along its own y: at least twice its radius")
            .unit("m")
            .required()
            .also(&["h", "length"]),
    ],
};

static CONE_KEYS: TableSpec = TableSpec {
    noun: "a cone",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("radius", POSITIVE, "The radius of its base").unit("m").required().also(&[
            "r",
            "size",
            "diameter",
            "base_radius",
        ]),
        KeySpec::new("height", POSITIVE, "Its height, along its own y")
            .unit("m")
            .required()
            .also(&["h", "length"]),
        KeySpec::new("top_radius", NON_NEGATIVE, "The radius of its upper end; 0 gives it a tip")
            .unit("m")
            .default_number(0.0)
            .also(&["radius2", "r2", "tip_radius"]),
    ],
};

static TORUS_KEYS: TableSpec = TableSpec {
    noun: "a torus",
    rule: Rule::Any,
    keys: &[
        KeySpec::new("radius", POSITIVE, "The distance from its center to the middle of its tube")
            .unit("m")
            .required()
            .also(&["r", "size", "diameter", "major_radius", "major"]),
        KeySpec::new("tube_radius", POSITIVE, "The radius of its tube, at most its `radius`")
            .unit("m")
            .required()
            .also(&["tube", "thickness", "minor_radius", "minor"]),
    ],
};

const SMOOTH: KeySpec = KeySpec::new(
    "smooth",
    Either(&[Boolean, Number(Bound::From(0.0, 180.0))]),
    "Which edges look smooth: all, none, or those between faces that meet at no more than this angle in \
     degrees",
)
.unit("°")
.default_flag(false)
.also(&["smoothing", "shading", "crease", "normals", "auto_smooth"]);

static MESH_KEYS: TableSpec = TableSpec {
    noun: "a mesh",
    rule: Rule::Any,
    keys: &[
        KeySpec::new(
            "file",
            Asset,
            "The file, OBJ or STL, in the scene's folder. Its surface must be closed, unless the body is \
             fixed or has `mass` and `inertia`. The body's `location` is the center of its mass (of its area, \
             if it is open), not the origin of the file",
        )
        .required()
        .also(&["path", "name", "source", "obj", "stl", "filename"]),
        KeySpec::new("scale", POSITIVE, "The length of one unit of the file: 0.001 for millimeters")
            .unit("m")
            .default_number(1.0)
            .also(&["unit", "units", "size", "factor"]),
        SMOOTH,
    ],
};

static HEIGHTFIELD: TableSpec = TableSpec {
    noun: "a heightfield",
    rule: Rule::Any,
    keys: &[
        KeySpec::new(
            "file",
            Asset,
            "A PNG in the scene's folder; each pixel is a point of the landscape, and the upper edge is the \
             far one",
        )
        .required()
        .also(&["image", "path", "png", "name", "source"]),
        KeySpec::new(
            "size",
            Numbers(3, Bound::Positive),
            "The distance between the centers of the first and last pixel along x; the height from black to \
             white; and the distance along z",
        )
        .unit("m")
        .required()
        .also(&["scale", "dimensions", "extents"]),
        SMOOTH,
    ],
};

static PLANE: TableSpec = TableSpec {
    noun: "a plane",
    rule: Rule::Any,
    keys: &[KeySpec::new("normal", AXIS, "The direction out of the plane, in the body's own axes")
        .default_numbers(&[0.0, 1.0, 0.0])
        .also(&["direction", "up"])],
};

static AXES: TableSpec = TableSpec {
    noun: "axes",
    rule: Rule::Any,
    keys: &[KeySpec::new("length", POSITIVE, "The length of each arrow")
        .unit("m")
        .required()
        .also(&["size"])],
};

//! Lists the reserved words of POV-Ray 3.7, by what a scene may do with them without `--trust`.
//!
//! Each of the 498 words is in exactly one of these lists, except `default` and `version`, which are in two. A test compares the lists
//! with POV-Ray itself.

/// The words that are directives. They are allowed only directly after a `#`, except `default` and `version`, which are also allowed
/// elsewhere.
pub(super) const DIRECTIVES: [&str; 24] = [
    "break",
    "case",
    "debug",
    "declare",
    "default",
    "else",
    "elseif",
    "end",
    "error",
    "for",
    "if",
    "ifdef",
    "ifndef",
    "include",
    "local",
    "macro",
    "range",
    "render",
    "statistics",
    "switch",
    "undef",
    "version",
    "warning",
    "while",
];

/// The words that begin a block with an image: `image_map { png "wood.png" }`.
pub(super) const IMAGE_BLOCKS: [&str; 5] =
    ["bump_map", "height_field", "image_map", "image_pattern", "material_map"];

/// The words for file formats, which are followed by a file name: `png "wood.png"`, `ttf "timrom.ttf"`.
pub(super) const FILE_TYPES: [&str; 15] = [
    "bmp", "df3", "exr", "gif", "hdr", "iff", "jpeg", "pgm", "png", "pot", "ppm", "sys", "tga", "tiff", "ttf",
];

/// The function that returns true if a file exists: `file_exists("wood.png")`.
pub(super) const FILE_EXISTS: &str = "file_exists";

/// The words that open, read or write files, and words that serve only POV-Ray's developers. They are refused.
pub(super) const REFUSED_WORDS: [&str; 16] = [
    "append",
    "dtag",
    "fclose",
    "fopen",
    "load_file",
    "read",
    "save_file",
    "sint16be",
    "sint16le",
    "sint32be",
    "sint32le",
    "sint8",
    "uint16be",
    "uint16le",
    "uint8",
    "write",
];

#[rustfmt::skip]
/// The words that access no file. They are allowed everywhere.
pub(super) const UNRESTRICTED_WORDS: [&str; 439] = [
    "aa_level", "aa_threshold", "abs", "absorption", "accuracy", "acos", "acosh", "adaptive", "adc_bailout",
    "agate", "agate_turb", "albedo", "all", "all_intersections", "alpha", "altitude", "always_sample",
    "ambient", "ambient_light", "angle", "anisotropy", "aoi", "aperture", "arc_angle", "area_illumination",
    "area_light", "array", "asc", "ascii", "asin", "asinh", "assumed_gamma", "atan", "atan2", "atanh",
    "autostop", "average", "b_spline", "background", "bezier_spline", "bicubic_patch", "bitwise_and",
    "bitwise_or", "bitwise_xor", "black_hole", "blob", "blue", "blur_samples", "bokeh", "bounded_by", "box",
    "boxed", "bozo", "brick", "brick_size", "brightness", "brilliance", "bump_size", "bumps", "camera",
    "caustics", "ceil", "cells", "charset", "checker", "chr", "circular", "clipped_by", "clock", "clock_on",
    "collect", "color", "color_map", "colour", "colour_map", "component", "composite", "concat", "cone",
    "confidence", "conic_sweep", "conserve_energy", "contained_by", "control0", "control1", "coords", "cos",
    "cosh", "count", "crackle", "crand", "cube", "cubic", "cubic_spline", "cubic_wave", "cutaway_textures",
    "cylinder", "cylindrical", "datetime", "default", "defined", "degrees", "density", "density_file", "density_map",
    "dents", "deprecated", "difference", "diffuse", "dimension_size", "dimensions", "direction", "disc",
    "dispersion", "dispersion_samples", "dist_exp", "distance", "div", "double_illuminate", "eccentricity",
    "emission", "error_bound", "evaluate", "exp", "expand_thresholds", "exponent", "exterior", "extinction",
    "face_indices", "facets", "fade_color", "fade_colour", "fade_distance", "fade_power", "falloff",
    "falloff_angle", "false", "filter", "finish", "fisheye", "flatness", "flip", "floor", "focal_point",
    "fog", "fog_alt", "fog_offset", "fog_type", "form", "frequency", "fresnel", "function", "gamma", "gather",
    "global_lights", "global_settings", "gradient", "granite", "gray", "gray_threshold", "green", "hexagon",
    "hf_gray_16", "hierarchy", "hollow", "hypercomplex", "importance", "inside", "inside_vector", "int",
    "interior", "interior_texture", "internal", "interpolate", "intersection", "intervals", "inverse", "ior",
    "irid", "irid_wavelength", "isosurface", "jitter", "julia", "julia_fractal", "lambda", "lathe", "leopard",
    "light_group", "light_source", "linear_spline", "linear_sweep", "ln", "location", "log", "look_at",
    "looks_like", "low_error_factor", "magnet", "major_radius", "mandel", "map_type", "marble", "material",
    "matrix", "max", "max_extent", "max_gradient", "max_intersections", "max_iteration", "max_sample",
    "max_trace", "max_trace_level", "maximum_reuse", "media", "media_attenuation", "media_interaction",
    "merge", "mesh", "mesh2", "mesh_camera", "metallic", "method", "metric", "min", "min_extent",
    "minimum_reuse", "mm_per_unit", "mod", "mortar", "natural_spline", "nearest_count", "no", "no_bump_scale",
    "no_image", "no_radiosity", "no_reflection", "no_shadow", "noise_generator", "normal", "normal_indices",
    "normal_map", "normal_vectors", "now", "number_of_sides", "number_of_tiles", "number_of_waves", "object",
    "octaves", "off", "offset", "omega", "omnimax", "on", "once", "onion", "open", "orient", "orientation",
    "orthographic", "ovus", "panoramic", "parallel", "parametric", "pass_through", "pattern", "pavement",
    "perspective", "phase", "phong", "phong_size", "photons", "pi", "pigment", "pigment_map",
    "pigment_pattern", "planar", "plane", "point_at", "poly", "poly_wave", "polygon", "polynomial", "pow",
    "precision", "precompute", "premultiplied", "pretrace_end", "pretrace_start", "prism", "prod",
    "projected_through", "pwr", "quadratic_spline", "quadric", "quartic", "quaternion", "quick_color",
    "quick_colour", "quilted", "radial", "radians", "radiosity", "radius", "rainbow", "ramp_wave", "rand",
    "ratio", "reciprocal", "recursion_limit", "red", "reflection", "reflection_exponent", "refraction",
    "repeat", "rgb", "rgbf", "rgbft", "rgbt", "right", "ripples", "rotate", "roughness", "samples", "scale",
    "scallop_wave", "scattering", "seed", "select", "shadowless", "sin", "sine_wave", "sinh", "size", "sky",
    "sky_sphere", "slice", "slope", "slope_map", "smooth", "smooth_triangle", "solid", "sor", "spacing",
    "specular", "sphere", "sphere_sweep", "spherical", "spiral1", "spiral2", "spline", "split_union",
    "spotlight", "spotted", "sqr", "sqrt", "square", "srgb", "srgbf", "srgbft", "srgbt", "steps", "str",
    "strcmp", "strength", "strlen", "strlwr", "strupr", "sturm", "substr", "subsurface", "sum",
    "superellipsoid", "t", "tan", "tanh", "target", "text", "texture", "texture_list", "texture_map",
    "thickness", "threshold", "tightness", "tile2", "tiles", "tiling", "tolerance", "toroidal", "torus",
    "trace", "transform", "translate", "translucency", "transmit", "triangle", "triangle_wave", "triangular",
    "true", "turb_depth", "turbulence", "type", "u", "u_steps", "ultra_wide_angle", "union", "up",
    "use_alpha", "use_color", "use_colour", "use_index", "utf8", "uv_indices", "uv_mapping", "uv_vectors",
    "v", "v_steps", "val", "variance", "vaxis_rotate", "vcross", "vdot", "version", "vertex_vectors",
    "vlength", "vnormalize", "vrotate", "vstr", "vturbulence", "warp", "water_level", "waves", "width",
    "wood", "wrinkles", "x", "xyz", "y", "yes", "z",
];

/// Returns all reserved words of POV-Ray, sorted.
pub fn reserved_words() -> Vec<&'static str> {
    let lists: [&[&str]; 5] = [&DIRECTIVES, &IMAGE_BLOCKS, &FILE_TYPES, &REFUSED_WORDS, &UNRESTRICTED_WORDS];
    let mut words = lists.concat();
    words.push(FILE_EXISTS);
    words.sort_unstable();
    words.dedup();
    words
}

//! Lists the files that come with POV-Ray 3.7: include files, color maps, fonts and images.

/// The include files of POV-Ray, including `makegrass.inc` and `meshmaker.inc`, which write files.
pub(crate) const INCLUDES: &[&str] = &[
    "arrays.inc",
    "chars.inc",
    "colors.inc",
    "consts.inc",
    "debug.inc",
    "finish.inc",
    "functions.inc",
    "glass.inc",
    "glass_old.inc",
    "golds.inc",
    "ior.inc",
    "logo.inc",
    "makegrass.inc",
    "math.inc",
    "meshmaker.inc",
    "metals.inc",
    "rad_def.inc",
    "rand.inc",
    "screen.inc",
    "shapes.inc",
    "shapes2.inc",
    "shapes3.inc",
    "shapes_old.inc",
    "shapesq.inc",
    "skies.inc",
    "stage1.inc",
    "stars.inc",
    "stdcam.inc",
    "stdinc.inc",
    "stoneold.inc",
    "stones.inc",
    "stones1.inc",
    "stones2.inc",
    "strings.inc",
    "sunpos.inc",
    "textures.inc",
    "transforms.inc",
    "woodmaps.inc",
    "woods.inc",
];

/// The include files of POV-Ray whose macros mainly write files.
pub(crate) const WRITING_INCLUDES: [&str; 2] = ["makegrass.inc", "meshmaker.inc"];

/// The color maps of POV-Ray. They are include files with the extension `.map`.
pub(super) const COLOR_MAPS: [&str; 10] = [
    "ash.map",
    "benediti.map",
    "bubinga.map",
    "cedar.map",
    "marbteal.map",
    "orngwood.map",
    "pinkmarb.map",
    "rdgranit.map",
    "teak.map",
    "whiteash.map",
];

/// The fonts that come with POV-Ray.
pub(super) const FONTS: [&str; 4] = ["crystal.ttf", "cyrvetic.ttf", "povlogo.ttf", "timrom.ttf"];

/// The images that come with POV-Ray, and a density file.
pub(super) const IMAGES: [&str; 11] = [
    "Mount1.png",
    "Mount2.png",
    "bumpmap_.png",
    "fract003.png",
    "mtmand.pot",
    "mtmandj.png",
    "plasma2.png",
    "plasma3.png",
    "povmap.png",
    "spiral.df3",
    "test.png",
];

/// The macros of POV-Ray's include files that write files, directly or through other macros. The macros of `WRITING_INCLUDES` are not
/// listed.
pub const WRITING_MACROS: [&str; 8] = [
    "ARRAYS_Temp_WriteDF3",
    "ARRAYS_WriteDF3",
    "HFCreate_",
    "HF_Cylinder",
    "HF_Sphere",
    "HF_Square",
    "HF_Torus",
    "Parse_String",
];

/// The macros of POV-Ray's include files whose first parameter is the name of a font file.
pub(super) const FONT_MACROS: [&str; 5] =
    ["Bevelled_Text", "Circle_Text", "Circle_Text_Valigned", "Text_Space", "Text_Width"];

/// Returns true if `name` means a file that comes with POV-Ray and is not in `WRITING_INCLUDES`. The extension may be missing, because
/// POV-Ray adds it.
pub(super) fn is_standard(name: &str) -> bool {
    let writes = |file: &str| WRITING_INCLUDES.contains(&file);
    let mut all = INCLUDES.iter().chain(&COLOR_MAPS).chain(&FONTS).chain(&IMAGES);
    all.any(|file| is_called(file, name) && !writes(file))
}

/// Returns true if `name` means a file of `WRITING_INCLUDES`, whose macros write files.
pub(super) fn is_writing(name: &str) -> bool {
    WRITING_INCLUDES.iter().any(|file| is_called(file, name))
}

/// Returns true if POV-Ray may open `file` for a script that contains `name`. The extension may be missing in `name`.
fn is_called(file: &str, name: &str) -> bool {
    file == name || file.rsplit_once('.').is_some_and(|(stem, _)| stem == name)
}

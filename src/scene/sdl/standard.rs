//! The files that come with POV-Ray 3.7: include files, fonts and images.

/// The include files. `makegrass.inc` and `meshmaker.inc` are among them.
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

/// The include files that serve to write files: most of their macros do.
pub(crate) const WRITING_INCLUDES: [&str; 2] = ["makegrass.inc", "meshmaker.inc"];

/// Color maps, which are include files with another ending.
pub(super) const MAPS: [&str; 10] = [
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

/// Fonts.
pub(super) const FONTS: [&str; 4] = ["crystal.ttf", "cyrvetic.ttf", "povlogo.ttf", "timrom.ttf"];

/// Images, and a density file.
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

/// Macros of the include files that write files, by themselves or by others that they call, apart from those of
/// `WRITING_INCLUDES`.
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

/// Macros of the include files whose first parameter is the file of a font.
pub(super) const FONT_MACROS: [&str; 5] =
    ["Bevelled_Text", "Circle_Text", "Circle_Text_Valigned", "Text_Space", "Text_Width"];

/// Whether a file of this name comes with POV-Ray and serves to write no files. POV-Ray adds the usual ending to a name
/// that has none.
pub(super) fn is_standard(name: &str) -> bool {
    let writes = |file: &str| WRITING_INCLUDES.contains(&file);
    let mut all = INCLUDES.iter().chain(&MAPS).chain(&FONTS).chain(&IMAGES);
    all.any(|file| is_called(file, name) && !writes(file))
}

/// Whether a name is that of an include file that serves to write files.
pub(super) fn is_writing(name: &str) -> bool {
    WRITING_INCLUDES.iter().any(|file| is_called(file, name))
}

/// Whether a script that says `name` may get the file, with or without its ending.
fn is_called(file: &str, name: &str) -> bool {
    file == name || file.rsplit_once('.').is_some_and(|(stem, _)| stem == name)
}

//! Generates the documentation page on what SDL may do without `--trust`.

use std::fmt::Write as _;

use super::standard::{FONT_MACROS, FONTS, IMAGES, INCLUDES, MAPS, WRITING_INCLUDES, WRITING_MACROS};
use super::words::{DIRECTIVES, FILE_EXISTS, FILE_TYPES, IMAGE_BLOCKS, OTHERS, REFUSED};

/// Returns the page that lists the words allowed without `--trust`, as Markdown.
pub fn reference() -> String {
    let mut page = HEAD.to_owned();
    let includes: Vec<&str> =
        INCLUDES.iter().copied().filter(|name| !WRITING_INCLUDES.contains(name)).collect();
    let mut file_words: Vec<&str> = [&IMAGE_BLOCKS[..], &FILE_TYPES[..], &[FILE_EXISTS, "include"]].concat();
    file_words.sort_unstable();
    for (title, text, words) in [
        ("Words that pass anywhere", "They touch no file.", &OTHERS[..]),
        ("Directives", "They pass directly behind a `#`.", &DIRECTIVES),
        (
            "Words with the name of a file",
            "They pass with the name of an asset or of a file of POV-Ray's, written as a plain string: \
             `#include \"parts.inc\"`,\n`image_map { png \"wood.png\" }`, `ttf \"timrom.ttf\"`. So do these macros, with the \
             name of a font first:",
            &FONT_MACROS,
        ),
        ("", "The words:", &file_words),
        ("Words that need `--trust`", "They open, read or write files.", &REFUSED),
        (
            "Macros that need `--trust`",
            "They write files. So do most macros of `makegrass.inc` and `meshmaker.inc`, so these two are refused as a \
             whole.",
            &WRITING_MACROS,
        ),
        ("POV-Ray's include files", "They pass in `povray.include` and behind `#include`.", &includes),
        ("", "And these color maps:", &MAPS),
        ("POV-Ray's fonts and images", "Fonts:", &FONTS),
        ("", "Images and densities:", &IMAGES),
    ] {
        if !title.is_empty() {
            let _ = write!(page, "\n## {title}\n");
        }
        let _ = write!(page, "\n{text}\n\n{}\n", lines(words));
    }
    page
}

/// Formats words in backquotes, in lines of at most 120 characters.
fn lines(words: &[&str]) -> String {
    let mut text = String::new();
    let mut length = 0;
    for word in words {
        if length > 0 {
            let breaks = length + word.len() + 3 > 120;
            text.push(if breaks { '\n' } else { ' ' });
            length = if breaks { 0 } else { length + 1 };
        }
        let _ = write!(text, "`{word}`");
        length += word.len() + 2;
    }
    text
}

const HEAD: &str = "# What POV-Ray's own words may do without `--trust`

This page is made from the lists that the check uses; the test `tests/docs/reference.rs` keeps it so.

POV-Ray opens, overwrites and includes any file of its user. A scene from somewhere else must not do that, so jabuka
cuts its SDL into POV-Ray's tokens and lets pass only what stands below. That holds for `povray.sdl`, the SDL of
materials, bodies and shapes, the files of `povray.include`, and for the assets that are SDL: those that end in `.inc`,
`.pov`, `.mcr` or `.map`, and those that are included. Everything else is an error at its line and column, which names
the word. With `--trust` all of SDL passes.

- Identifiers pass, but for [some macros](#macros-that-need---trust). Numbers, strings and comments pass.
- Where the name of a file belongs, only a plain string passes, with the name of a file that `povray.assets` lists, or
  that comes with POV-Ray. A name that is computed, or that an identifier or a parameter of a macro holds, could be that
  of any file.
- Each `#` has its directive directly behind it, and each `#if`, `#while` or `#macro` its `#end` in the same text.
- `#include` stands in `povray.sdl` or in an included file, outside of macros.

```toml
[povray]
include = [\"shapes.inc\"]
assets = [\"wood.png\", \"parts.inc\"]
sdl = '''
#include \"parts.inc\"
#declare Oak = pigment { image_map { png \"wood.png\" } }
'''
```
";

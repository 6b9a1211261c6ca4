//! Generates the documentation page on what SDL may do without `--trust`.

use std::fmt::Write as _;

use super::standard::{COLOR_MAPS, FONT_MACROS, FONTS, IMAGES, INCLUDES, WRITING_INCLUDES, WRITING_MACROS};
use super::words::{DIRECTIVES, FILE_EXISTS, FILE_TYPES, IMAGE_BLOCKS, REFUSED_WORDS, UNRESTRICTED_WORDS};

/// Returns the page that lists the words allowed without `--trust`, as Markdown.
pub fn reference() -> String {
    let mut page = PAGE_INTRODUCTION.to_owned();
    let includes: Vec<&str> =
        INCLUDES.iter().copied().filter(|name| !WRITING_INCLUDES.contains(name)).collect();
    let mut file_words: Vec<&str> = [&IMAGE_BLOCKS[..], &FILE_TYPES[..], &[FILE_EXISTS, "include"]].concat();
    file_words.sort_unstable();
    for (title, text, words) in [
        ("Words that are allowed everywhere", "They access no file.", &UNRESTRICTED_WORDS[..]),
        ("Directives", "They follow a `#` directly.", &DIRECTIVES),
        (
            "Words with the name of a file",
            "They are allowed with the name of an asset or of a file of POV-Ray, as a plain string: \
             `#include \"parts.inc\"`,\n`image_map { png \"wood.png\" }`, `ttf \"timrom.ttf\"`. So are these macros; their first \
             argument is the name of a font:",
            &FONT_MACROS,
        ),
        ("", "The words:", &file_words),
        ("Words that need `--trust`", "They open, read or write files.", &REFUSED_WORDS),
        (
            "Macros that need `--trust`",
            "They write files. Most macros of `makegrass.inc` and `meshmaker.inc` do so as well, so these two files are \
             refused.",
            &WRITING_MACROS,
        ),
        ("POV-Ray's include files", "They are allowed in `povray.include` and after `#include`.", &includes),
        ("", "And these color maps:", &COLOR_MAPS),
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

/// The text before the lists of the page.
const PAGE_INTRODUCTION: &str = "# SDL that is allowed without `--trust`

SDL is POV-Ray's scene language. It can open, overwrite and include any file of the user. A scene from somebody else must
not do that. So jabuka reads the SDL word by word and allows only what this page lists. All other words are errors at
their line and column. With `--trust`, jabuka allows all of SDL.

jabuka checks `povray.sdl`, the SDL of materials, bodies and shapes, the files of `povray.include`, and assets that are
SDL: files that end in `.inc`, `.pov`, `.mcr` or `.map`, and files that are included.

- Identifiers are allowed, except for [some macros](#macros-that-need---trust). So are numbers, strings and comments.
- The name of a file must be a plain string. It names a file in `povray.assets`, or one that comes with POV-Ray. A
  computed name, an identifier or a parameter of a macro is refused, because it could name any file.
- A directive follows its `#` directly. Each `#if`, `#while` or `#macro` has its `#end` in the same text.
- `#include` is allowed in `povray.sdl` and in included files, but not in macros.

The test `tests/docs/reference.rs` writes this page from the lists that the check uses.

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

//! Finds the names of the files that SDL (POV-Ray's scene description language) reads.

use std::ops::Range;

use super::standard::FONT_MACROS;
use super::tokens::{Token, Tokens};
use super::words::{FILE_EXISTS, FILE_TYPES, IMAGE_BLOCKS};

/// The type of a file that SDL reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FileKind {
    /// A file of SDL, read by `#include`.
    Include,
    /// An image or a density file, read by `image_map`, `height_field`, `df3` and similar keywords.
    Image,
    /// A font, read by `ttf` or passed to a macro.
    Font,
    /// A file of another type, read by `#fopen`, `load_file` or `file_exists`.
    Data,
}

/// A file name in SDL.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileName<'a> {
    /// The type of the file, according to the keyword before its name.
    pub kind: FileKind,
    /// The name as written between its quotes. `None` if an expression computes the name, so that only POV-Ray knows it.
    pub literal: Option<&'a str>,
    /// The byte range of the name with its quotes. If the name is computed, the range of the keyword that reads the file.
    pub range: Range<usize>,
}

/// Iterates over the names of all files that SDL reads, in the order of the text. Includes those in branches that POV-Ray would not
/// execute.
pub fn files(text: &str) -> impl Iterator<Item = FileName<'_>> {
    let mut tokens = Tokens::of(text);
    let mut before = None;
    std::iter::from_fn(move || {
        loop {
            let (token, range) = tokens.next()?;
            let file = file(token, &range, before, tokens.clone());
            before = Some(token);
            if file.is_some() {
                return file;
            }
        }
    })
}

/// Returns the name of the file that a token reads. `before` is the previous token and `after` are the following tokens. `None` if the
/// token reads no file.
pub(super) fn file<'a>(
    token: Token<'a>,
    range: &Range<usize>,
    before: Option<Token<'a>>,
    mut after: Tokens<'a>,
) -> Option<FileName<'a>> {
    let Token::Word(word) = token else { return None };
    let unknown = |kind| Some(FileName { kind, literal: None, range: range.clone() });
    match word {
        "include" => Some(named(FileKind::Include, range, after)),
        "ttf" => Some(named(FileKind::Font, range, after)),
        "load_file" => Some(named(FileKind::Data, range, after)),
        "fopen" => {
            // The identifier of the file handle comes before the file name.
            after.next();
            Some(named(FileKind::Data, range, after))
        }
        // In `charset sys`, the word `sys` is a character encoding, not an image format.
        "sys" if before == Some(Token::Word("charset")) => None,
        _ if FILE_TYPES.contains(&word) => Some(named(FileKind::Image, range, after)),
        _ if IMAGE_BLOCKS.contains(&word) => match opens(&mut after, '{').then(|| after.clone().next()) {
            // Either a function computes the image, or the keyword of an image format follows. In that case, the call for the format
            // keyword returns the file name.
            Some(Some((Token::Word(next), _))) if next == "function" || FILE_TYPES.contains(&next) => None,
            Some(_) => Some(named(FileKind::Image, range, after)),
            None => unknown(FileKind::Image),
        },
        _ if word == FILE_EXISTS || FONT_MACROS.contains(&word) => {
            let kind = if word == FILE_EXISTS { FileKind::Data } else { FileKind::Font };
            match opens(&mut after, '(') {
                true => Some(named(kind, range, after)),
                false => unknown(kind),
            }
        }
        _ => None,
    }
}

/// Returns true if the next token is the given opening bracket.
fn opens(after: &mut Tokens<'_>, bracket: char) -> bool {
    matches!(after.next(), Some((Token::Symbol(symbol), _)) if symbol == bracket)
}

/// Reads the next token as a file name. If it is no plain string, the name is computed, and the range is that of the keyword `word`.
fn named<'a>(kind: FileKind, word: &Range<usize>, mut after: Tokens<'a>) -> FileName<'a> {
    match after.next() {
        // A name with a backslash counts as computed, because operating systems interpret backslashes differently.
        Some((Token::Text(name), range)) if !name.contains('\\') => {
            FileName { kind, literal: Some(name), range }
        }
        _ => FileName { kind, literal: None, range: word.clone() },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Vec<(FileKind, Option<&str>)> {
        files(text).map(|file| (file.kind, file.literal)).collect()
    }

    #[test]
    fn every_file_is_found() {
        use FileKind::{Data, Font, Image, Include};
        for (text, expected) in [
            ("#include \"a.inc\"", (Include, Some("a.inc"))),
            ("include \"a.inc\"", (Include, Some("a.inc"))),
            ("#  include // a comment\n \"é.inc\"", (Include, Some("é.inc"))),
            ("#/* a /* b */ c */include/**/\"a.inc\" // #include \"b.inc\"", (Include, Some("a.inc"))),
            ("#declare Text = \"#include \\\"b.inc\\\"\"; #include \"a.inc\"", (Include, Some("a.inc"))),
            ("#if (0)\r#include \"a.inc\"\r#end", (Include, Some("a.inc"))),
            ("#\u{1}include \"a.inc\"", (Include, Some("a.inc"))),
            ("pigment { image_map { png \"a.png\" } }", (Image, Some("a.png"))),
            ("normal { bump_map { \"a.png\" } }", (Image, Some("a.png"))),
            ("height_field{/**/sys\"a\"}", (Image, Some("a"))),
            ("density_file df3 \"a.df3\"", (Image, Some("a.df3"))),
            ("text { ttf \"timrom.ttf\" \"a\" 1, 0 }", (Font, Some("timrom.ttf"))),
            ("Text_Width(\"timrom.ttf\", \"a\", 1, 0)", (Font, Some("timrom.ttf"))),
            ("#fopen F \"a.txt\" read", (Data, Some("a.txt"))),
            ("#if (file_exists(\"a.txt\")) #end", (Data, Some("a.txt"))),
            ("photons { load_file \"a\" }", (Data, Some("a"))),
            ("#include Name", (Include, None)),
            ("#include", (Include, None)),
            ("#include concat(\"a\")", (Include, None)),
            ("#include \"a\\\\b.inc\"", (Include, None)),
            ("image_map { png Name }", (Image, None)),
            ("image_map { Name }", (Image, None)),
            ("image_map { concat(\"a\", \"b\") }", (Image, None)),
            ("image_map Name", (Image, None)),
            ("image_map { #if (1) Name #end }", (Image, None)),
            ("ttf Font", (Font, None)),
            ("Text_Width(Font)", (Font, None)),
            ("Text_Width", (Font, None)),
        ] {
            assert_eq!(names(text), [expected], "{text:?}");
        }
        let several = "#include \"a.inc\" #include concat(\"a\", \".inc\") #include \"b/c.inc\"";
        assert_eq!(names(several), [(Include, Some("a.inc")), (Include, None), (Include, Some("b/c.inc"))]);
    }

    #[test]
    fn other_words_read_no_file() {
        for text in [
            "",
            "#included \"a.inc\"",
            "#",
            "\"#include",
            "/* #include",
            "global_settings { charset sys }",
            "image_map { function 9, 9 { pigment { bozo } } }",
            "#debug \"include\"",
        ] {
            assert_eq!(names(text), [], "{text:?}");
        }
    }
}

//! Decides which SDL may be used without `--trust`. SDL is POV-Ray's scene description language.
//!
//! POV-Ray opens, overwrites and includes every file that its user can access, and does so in surprising places: `include` works without
//! its `#`, and a macro may end between a `#` and its word. Searching for dangerous code would therefore miss cases. Instead, the filter
//! splits a text into POV-Ray's own tokens and accepts only tokens that are known to be safe:
//!
//! - reserved words that access no file, and all identifiers except those of macros that write files;
//! - directives, each directly after its `#`, and each `#if` or `#macro` with its own `#end` in the same text;
//! - as a file name, a plain string that names an asset of the scene or a file that comes with POV-Ray. A computed name could be that of
//!   any file.
//!
//! `#include` is refused inside a macro: POV-Ray finds the end of a macro by its position, even in an included file, and may resume in the
//! middle of a comment.

use std::ops::Range;

use super::files::{FileKind, FileName, file};
use super::standard::{WRITING_MACROS, is_standard, is_writing};
use super::tokens::{Token, Tokens, Unclosed};
use super::words::{DIRECTIVES, REFUSED_WORDS, UNRESTRICTED_WORDS};

/// The position in the script at which a text of SDL is inserted: at the top level, or within a body or material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Where {
    /// At the top level before the bodies, or in a file that is included at the top level.
    Top,
    /// Within a body or a material, which may itself be within a macro.
    Inside,
}

/// A part of a text of SDL that needs `--trust`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The byte range of the refused part in the text.
    pub range: Range<usize>,
    /// The reason why the part is refused.
    pub why: RefusalReason,
}

/// The reason why a part of SDL is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RefusalReason {
    /// This word opens, reads or writes files.
    Word(String),
    /// The named macro, from one of POV-Ray's include files, writes files.
    Macro(String),
    /// The file name after this word is computed.
    Computed(String),
    /// The named file is neither an asset of the scene nor a file that comes with POV-Ray.
    Unlisted(String),
    /// The named include file of POV-Ray contains mainly macros that write files.
    WritingInclude(String),
    /// `#include` is within a macro, a body or a material.
    InnerInclude,
    /// A `#` is not followed by a directive.
    Hash,
    /// The named directive has no `#` before it.
    NoHash(String),
    /// A comment, a string or a directive is not closed. The value shows how it begins.
    Open(&'static str),
    /// `#end`, `#else` or a similar directive is outside of the directive that it would belong to.
    Stray(String),
    /// The text contains a NUL character.
    Nul,
}

/// The maximum number of refusals that are reported for one text.
const MAX_REFUSALS: usize = 8;

/// Returns the parts of a text of SDL that need `--trust`, in order, and the names of the assets that the text includes. `is_asset`
/// returns true for the name of an asset of the scene.
pub fn refusals(text: &str, place: Where, is_asset: impl Fn(&str) -> bool) -> (Vec<Refusal>, Vec<&str>) {
    let mut filter =
        Filter { place, is_asset, open: Vec::new(), macros: 0, refusals: Vec::new(), includes: Vec::new() };
    let nul = text.find('\0');
    let mut tokens = Tokens::of(text);
    let (mut before, mut end) = (None, 0..0);
    while let Some((token, range)) = tokens.next() {
        filter.token(token, &range, before, &tokens);
        if filter.refusals.len() >= MAX_REFUSALS {
            if let Some(at) = nul.filter(|&at| at < range.start) {
                filter.refuse(at..at + 1, RefusalReason::Nul);
            }
            return (first(filter.refusals), filter.includes);
        }
        (before, end) = (Some(token), range);
    }
    if let Some(at) = nul {
        filter.refuse(at..at + 1, RefusalReason::Nul);
    }
    if before == Some(Token::Symbol('#')) {
        filter.refuse(end, RefusalReason::Hash);
    }
    match tokens.unclosed() {
        Some(Unclosed::Comment(range)) => filter.refuse(range.clone(), RefusalReason::Open("comment")),
        Some(Unclosed::Text(range)) => filter.refuse(range.clone(), RefusalReason::Open("string")),
        None => {}
    }
    for (word, range) in std::mem::take(&mut filter.open).into_iter().take(MAX_REFUSALS) {
        filter.refuse(range, RefusalReason::Open(word));
    }
    (first(filter.refusals), filter.includes)
}

/// Sorts the refusals by their positions in the text, and keeps the first [`MAX_REFUSALS`].
fn first(mut refusals: Vec<Refusal>) -> Vec<Refusal> {
    refusals.sort_by_key(|refusal| refusal.range.start);
    refusals.truncate(MAX_REFUSALS);
    refusals
}

struct Filter<'a, F> {
    place: Where,
    is_asset: F,
    /// The directives that are still open, such as `#if`, with their byte ranges. Each needs an `#end`.
    open: Vec<(&'static str, Range<usize>)>,
    /// The number of `#macro` directives among the open directives.
    macros: usize,
    refusals: Vec<Refusal>,
    includes: Vec<&'a str>,
}

/// The directives that need a closing `#end`.
const OPENING_DIRECTIVES: [&str; 7] = ["for", "if", "ifdef", "ifndef", "macro", "switch", "while"];
/// The directives that are valid only between an opening directive and its `#end`.
const INNER_DIRECTIVES: [&str; 5] = ["break", "case", "else", "elseif", "range"];

impl<'a, F: Fn(&str) -> bool> Filter<'a, F> {
    fn refuse(&mut self, range: Range<usize>, why: RefusalReason) {
        self.refusals.push(Refusal { range, why });
    }

    fn token(
        &mut self,
        token: Token<'a>,
        range: &Range<usize>,
        before: Option<Token<'a>>,
        after: &Tokens<'a>,
    ) {
        let behind_hash = before == Some(Token::Symbol('#'));
        let Token::Word(word) = token else {
            if behind_hash {
                self.refuse(range.clone(), RefusalReason::Hash);
            }
            return;
        };
        let is = |words: &[&str]| words.binary_search(&word).is_ok();
        if is(&REFUSED_WORDS) {
            return self.refuse(range.clone(), RefusalReason::Word(word.to_owned()));
        }
        if WRITING_MACROS.contains(&word) {
            return self.refuse(range.clone(), RefusalReason::Macro(word.to_owned()));
        }
        match (behind_hash, is(&DIRECTIVES)) {
            (true, true) => self.directive(word, range),
            (true, false) => return self.refuse(range.clone(), RefusalReason::Hash),
            (false, true) if !is(&UNRESTRICTED_WORDS) => {
                return self.refuse(range.clone(), RefusalReason::NoHash(word.to_owned()));
            }
            (false, _) => {}
        }
        if let Some(name) = file(token, range, before, after.clone()) {
            self.file(word, name);
        }
    }

    fn directive(&mut self, word: &str, range: &Range<usize>) {
        if let Some(opening) = OPENING_DIRECTIVES.into_iter().find(|opening| *opening == word) {
            self.open.push((opening, range.clone()));
            self.macros += usize::from(word == "macro");
        } else if word == "end" {
            match self.open.pop() {
                Some((opening, _)) => self.macros -= usize::from(opening == "macro"),
                None => self.refuse(range.clone(), RefusalReason::Stray(word.to_owned())),
            }
        } else if INNER_DIRECTIVES.contains(&word) && self.open.is_empty() {
            self.refuse(range.clone(), RefusalReason::Stray(word.to_owned()));
        } else if word == "include" && (self.place == Where::Inside || self.macros > 0) {
            self.refuse(range.clone(), RefusalReason::InnerInclude);
        }
    }

    fn file(&mut self, word: &str, name: FileName<'a>) {
        let why = match name.literal {
            None => RefusalReason::Computed(word.to_owned()),
            Some(literal) if (self.is_asset)(literal) => {
                if name.kind == FileKind::Include {
                    self.includes.push(literal);
                }
                return;
            }
            Some(literal) if is_writing(literal) => RefusalReason::WritingInclude(literal.to_owned()),
            Some(literal) if is_standard(literal) => return,
            Some(literal) => RefusalReason::Unlisted(literal.to_owned()),
        };
        self.refuse(name.range, why);
    }
}

#[cfg(test)]
mod tests {
    use super::super::words::{FILE_EXISTS, FILE_TYPES, IMAGE_BLOCKS, reserved_words};
    use super::*;

    fn first(text: &str) -> Option<RefusalReason> {
        let is_asset = |name: &str| ["wood.png", "parts.inc"].contains(&name);
        refusals(text, Where::Top, is_asset).0.into_iter().next().map(|refusal| refusal.why)
    }

    #[test]
    fn what_touches_files_is_refused() {
        let word = |word: &str| RefusalReason::Word(word.to_owned());
        let unlisted = |name: &str| RefusalReason::Unlisted(name.to_owned());
        let computed = |word: &str| RefusalReason::Computed(word.to_owned());
        for (text, why) in [
            ("#fopen F \"x\" write", word("fopen")),
            ("#write(F, 1)", word("write")),
            ("#\n\tread (F, A)", word("read")),
            ("photons { save_file \"/x\" }", word("save_file")),
            ("photons { load_file \"wood.png\" }", word("load_file")),
            ("include \"evil.inc\"", RefusalReason::NoHash("include".to_owned())),
            ("1einclude \"evil.inc\"", RefusalReason::NoHash("include".to_owned())),
            ("// a\rinclude \"evil.inc\"", RefusalReason::NoHash("include".to_owned())),
            ("#include \"evil.inc\"", unlisted("evil.inc")),
            ("#  /* /* */ */ include // a\n \"/etc/passwd\"", unlisted("/etc/passwd")),
            ("#macro A() # #end A() include \"x\"", RefusalReason::Hash),
            ("#macro A() \"x\" #end #include A()", computed("include")),
            ("#macro A() #include \"parts.inc\" #end", RefusalReason::InnerInclude),
            ("#include concat(\"a\", \"b\")", computed("include")),
            ("#include", computed("include")),
            ("#include \"meshmaker.inc\"", RefusalReason::WritingInclude("meshmaker.inc".to_owned())),
            ("#include \"makegrass\"", RefusalReason::WritingInclude("makegrass".to_owned())),
            ("pigment { image_map { png \"/abs/path\" } }", unlisted("/abs/path")),
            ("pigment { image_map { \"../x.png\" } }", unlisted("../x.png")),
            ("pigment { image_map { png Name } }", computed("png")),
            ("pigment { image_map { concat(\"/\", \"x\") } }", computed("image_map")),
            ("pigment { image_map { #if (1) png \"wood.png\" #end } }", computed("image_map")),
            ("#macro A() image_map #end", computed("image_map")),
            ("#macro A() png #end image_map { A() Name }", computed("png")),
            ("density_file df3 Name", computed("df3")),
            ("text { ttf \"/etc/passwd\" \"a\" 1, 0 }", unlisted("/etc/passwd")),
            ("Text_Width(Font, \"a\", 1, 0)", computed("Text_Width")),
            ("Text_Width(\"/etc/passwd\", \"a\", 1, 0)", unlisted("/etc/passwd")),
            ("#if (file_exists(\"/etc/passwd\")) #end", unlisted("/etc/passwd")),
            ("Parse_String(\"x\")", RefusalReason::Macro("Parse_String".to_owned())),
            ("HF_Square(f, 0, 0, 1, 1, \"x\", 0, 1)", RefusalReason::Macro("HF_Square".to_owned())),
            ("sphere { } # ", RefusalReason::Hash),
            ("# // x", RefusalReason::Hash),
            ("# sphere { }", RefusalReason::Hash),
            ("# /* x", RefusalReason::Hash),
            ("a /* x", RefusalReason::Open("comment")),
            ("a \" x", RefusalReason::Open("string")),
            ("#if (1)", RefusalReason::Open("if")),
            ("#macro A() #if (1) #end", RefusalReason::Open("macro")),
            ("#if (1) #end #end", RefusalReason::Stray("end".to_owned())),
            ("#else", RefusalReason::Stray("else".to_owned())),
            ("end", RefusalReason::NoHash("end".to_owned())),
            ("a\0b", RefusalReason::Nul),
        ] {
            assert_eq!(first(text), Some(why), "{text:?}");
        }
    }

    #[test]
    fn what_touches_no_file_passes() {
        for text in [
            "",
            "#declare A = 1;",
            "texture { T_Chrome_4C }",
            "#declare Include = \"#include\"; // #include",
            "#include \"parts.inc\" #include \"colors.inc\" #include \"shapes\"",
            "pigment { image_map { png \"wood.png\" once } }",
            "normal { bump_map { \"bumpmap_.png\" } }",
            "pigment { image_map { function 9, 9 { pigment { bozo } } } }",
            "text { ttf \"timrom.ttf\", \"any text: /etc/passwd\", 1, 0 }",
            "Circle_Text(\"cyrvetic.ttf\", \"a\", 1, 0, 1, 1, 1, 1, 0)",
            "global_settings { charset sys }",
            "#macro A(B) #for (I, 0, 9) #if (I = 3) #break #else sphere { I*x, B } #end #end #end",
            "#switch (1) #case (0) #range (1, 2) #break #else #end",
            "#if (version < 3.7) #version 3.7; #end",
            "cylinder { 0, y, 1 open }",
            "#debug concat(\"a\", str(1, 0, 0), \"\\n\")",
        ] {
            assert_eq!(first(text), None, "{text:?}");
        }
    }

    #[test]
    fn an_include_belongs_to_the_top() {
        let (refused, _) = refusals("#include \"colors.inc\"", Where::Inside, |_| false);
        assert_eq!(refused[0].why, RefusalReason::InnerInclude);
        let (refused, includes) = refusals("#include \"a\" #include \"b\"", Where::Top, |name| name == "b");
        assert_eq!((refused.len(), includes), (1, vec!["b"]));
    }

    #[test]
    fn a_refusal_has_a_place_and_there_are_not_too_many() {
        let (refused, _) = refusals("é { fopen } ", Where::Top, |_| false);
        assert_eq!(refused, [Refusal { range: 5..10, why: RefusalReason::Word("fopen".to_owned()) }]);
        assert_eq!(refusals(&"fopen ".repeat(100), Where::Top, |_| false).0.len(), MAX_REFUSALS);
    }

    #[test]
    fn the_first_refusals_are_reported_in_the_order_of_the_text() {
        let starts = |text: &str| -> Vec<usize> {
            refusals(text, Where::Top, |_| false).0.iter().map(|refusal| refusal.range.start).collect()
        };
        let first: Vec<usize> = (0..MAX_REFUSALS).map(|i| 6 * i).collect();
        assert_eq!(starts(&("fopen ".repeat(9) + "\0")), first);
        assert_eq!(starts(&("\0 ".to_owned() + &"fopen ".repeat(9)))[..2], [0, 2]);
        assert_eq!(starts(&("#if (1) ".repeat(9) + &"fopen ".repeat(7))).len(), MAX_REFUSALS);
        assert_eq!(starts("fopen \0 #if (1) fopen"), [0, 6, 9, 16]);
    }

    #[test]
    fn the_words_are_sorted_and_each_has_one_place() {
        let lists: [&[&str]; 5] =
            [&DIRECTIVES, &IMAGE_BLOCKS, &FILE_TYPES, &REFUSED_WORDS, &UNRESTRICTED_WORDS];
        for list in lists {
            assert!(list.is_sorted_by(|a, b| a < b), "{list:?}");
        }
        assert_eq!(reserved_words().len(), 498);
        let mut all: Vec<&str> = lists.concat();
        all.push(FILE_EXISTS);
        all.sort_unstable();
        let twice: Vec<_> = all.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
        assert_eq!(twice, ["default", "version"]);
    }

    proptest::proptest! {
        #[test]
        fn every_text_is_judged_and_places_are_on_bounds_of_characters(
            words in proptest::collection::vec(
                proptest::sample::select(vec![
                    "#", "include", "\"", "\"a.inc\"", "/*", "*/", "//", "\n", "image_map", "{", "}", "png", "macro",
                    "end", "if", "fopen", "é", "\0", "1e", "(", ")", "HF_Square", "ttf", " ", "\\", "\u{10ffff}", "x",
                ]),
                0..40,
            )
        ) {
            let text = words.concat();
            for place in [Where::Top, Where::Inside] {
                let refused = refusals(&text, place, |name| name == "a.inc").0;
                assert!(refused.len() <= MAX_REFUSALS && refused.is_sorted_by_key(|refusal| refusal.range.start));
                for refusal in refused {
                    assert!(text.get(refusal.range.clone()).is_some(), "{text:?} at {refusal:?}");
                }
            }
        }
    }
}

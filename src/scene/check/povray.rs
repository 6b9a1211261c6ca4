//! Reads the table `[povray]`.

use std::ops::Range;
use std::path::{Component, Path};

use super::marks::Known;
use super::measures::Reader;
use super::{Context, asset, suggest};
use crate::diagnostic::{Code, Diagnostic, Sources, Span};
use crate::scene::expand::in_string;
use crate::scene::grammar::scene::{povray, scene};
use crate::scene::sdl::{INCLUDES, Token, Tokens, WRITING_INCLUDES};
use crate::scene::source::{Node, file};
use crate::scene::{Include, PovRay, SdlPiece};
use crate::system;

/// The maximum size of an include file, in bytes. Every script contains the whole file.
const MAX_INCLUDE_BYTES: u64 = 1 << 20;

pub(super) fn read(known: Known<'_, '_>, context: &mut Context<'_>) -> PovRay {
    let view = known.root.table(&scene::POVRAY);
    let items = view.list(&povray::INCLUDE).unwrap_or_default();
    let assets = asset::read(&view, context);
    PovRay {
        assets,
        reads: std::mem::take(&mut context.reads),
        include: items.iter().filter_map(|item| include(item, context.folder, context.trust).ok()).collect(),
        sdl: view
            .get(&povray::SDL)
            .zip(view.span(&povray::SDL))
            .map_or_else(Vec::new, |sdl| pieces(sdl, known, context)),
        unit: view.get(&povray::UNIT),
        digits: view.get(&povray::DIGITS) as usize,
        templates: Vec::new(),
    }
}

/// Finds an include file: one of POV-Ray's own, or a file in the scene's folder. Does not check the text of the file.
///
/// # Errors
///
/// Returns an error if the name is unusable, or if the file is missing, too large or not allowed without `--trust`.
pub(super) fn include(node: &Node, folder: Option<&Path>, trust: bool) -> Result<Include, Diagnostic> {
    let name = node.as_str().unwrap_or_default();
    let error = |code, message: String| Diagnostic::error(code, message).at(node.span, "");
    // The script contains the name as a string literal, so the name must not contain quotes or backslashes.
    if name.is_empty() || name.chars().any(|c| c.is_control() || matches!(c, '"' | '\\')) {
        let message = format!("`{name}` cannot be the name of an include file");
        let help = "it cannot be empty, nor contain quotes, backslashes or control characters; `/` leads into folders";
        return Err(error(Code::BadInclude, message).help(help));
    }
    let below =
        Path::new(name).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if !below && !trust {
        return Err(error(Code::UntrustedPath, format!("`{name}` leads out of the scene's folder"))
            .help("if you know this scene and trust it, say `--trust`"));
    }
    if let Some(path) = folder.map(|folder| folder.join(name)).filter(|path| path.exists()) {
        return include_text(node, name, &path, folder, trust);
    }
    if !INCLUDES.contains(&name) && !trust {
        let label = suggest::nearest(name, INCLUDES.iter().copied())
            .map_or_else(|| "no such file".to_owned(), |near| format!("did you mean `{near}`?"));
        let message = format!("the include file `{name}` is neither POV-Ray's own nor beside the scene");
        return Err(Diagnostic::error(Code::MissingInclude, message)
            .at(node.span, label)
            .help("with `--trust`, POV-Ray is left to find it"));
    }
    if WRITING_INCLUDES.contains(&name) && !trust {
        let message = format!("the SDL reaches for files: the macros of `{name}` write them");
        return Err(
            error(Code::UntrustedSdl, message).help("if you know this scene and trust it, say `--trust`")
        );
    }
    Ok(Include::Standard(name.to_owned()))
}

fn include_text(
    node: &Node,
    name: &str,
    path: &Path,
    folder: Option<&Path>,
    trust: bool,
) -> Result<Include, Diagnostic> {
    let error = |code, message: String| Diagnostic::error(code, message).at(node.span, "");
    let cannot_read = |e: std::io::Error| error(Code::MissingInclude, format!("cannot read `{name}`: {e}"));
    // Resolve symbolic links: a link inside the folder may point outside it.
    let real = system::canonicalize(path).map_err(cannot_read)?;
    let inside = folder
        .and_then(|folder| system::canonicalize(folder).ok())
        .is_some_and(|folder| real.starts_with(folder));
    if !inside && !trust {
        return Err(error(Code::UntrustedPath, format!("`{name}` leads out of the scene's folder"))
            .help("if you know this scene and trust it, say `--trust`"));
    }
    let text = file::read_text(&real, MAX_INCLUDE_BYTES).map_err(|e| match e.kind() {
        std::io::ErrorKind::FileTooLarge => {
            let message = format!("`{name}` is larger than 1 MiB, and it would stand in every script");
            error(Code::FileTooLarge, message)
        }
        _ => cannot_read(e),
    })?;
    Ok(Include::Text { name: name.to_owned(), text })
}

/// Finds the values `${…}` in SDL, each with its braces. A value without an end reaches to the end of the text.
fn values(text: &str) -> impl Iterator<Item = Range<usize>> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let start = at + text[at..].find("${")?;
        at = text[start..].find('}').map_or(text.len(), |length| start + length + 1);
        Some(start..at)
    })
}

/// Returns SDL in which each value `${…}` is replaced by a number of the same length, between blanks. In scripts, values stand between blanks,
/// too, so they never become part of a word or of another number.
pub(super) fn with_numbers(text: &str) -> String {
    let mut filled = text.to_owned();
    for value in values(text) {
        filled.replace_range(value.clone(), &format!("{:<1$}", " 0", value.len()));
    }
    filled
}

/// Splits the scene's SDL into code that is the same in all scripts and values that change from frame to frame.
fn pieces((text, span): (&str, Span), known: Known<'_, '_>, context: &mut Context<'_>) -> Vec<SdlPiece> {
    let code = |range: Range<usize>| SdlPiece::Sdl(text[range].to_owned());
    let filled = with_numbers(text);
    let strings: Vec<Range<usize>> = Tokens::of(&filled)
        .filter_map(|(token, range)| matches!(token, Token::Text(_)).then_some(range))
        .collect();
    let mut pieces = Vec::new();
    let mut end = 0;
    for value in values(text) {
        pieces.push(code(end..value.start));
        end = value.end;
        let mut reader = Reader::new("SDL", (text, span), known.root, None, known.things, context);
        if !text[value.clone()].ends_with('}') {
            let error = Diagnostic::error(Code::ValueInSdl, "this value has no end");
            reader.report(error, value.start..value.start + 2, "needs a `}`");
            break;
        }
        if strings.iter().any(|string| string.start < value.end && value.start < string.end) {
            let error = Diagnostic::error(Code::ValueInSdl, "a value cannot stand within a string");
            let help = "POV-Ray makes a string of a number: `concat(\"t = \", str(${t}, 0, 2))`";
            reader.report(error.help(help), value.clone(), "a number");
            continue;
        }
        let inner = value.start + 2..value.end - 1;
        let formula = reader.formula_with_unit(inner.clone());
        pieces.extend(formula.map(|formula| SdlPiece::Value { text: text[inner].to_owned(), formula }));
    }
    pieces.push(code(end..text.len()));
    pieces
}

/// Returns a warning that raw SDL contains `${…}` where no value is filled in. `None` if the SDL has no `${`.
pub(super) fn value_in_sdl(text: &str, span: Span, sources: &Sources) -> Option<Diagnostic> {
    let value = values(text).next()?;
    let place = in_string(sources.raw(span), text, &value, span);
    let message = "values are filled only into `povray.sdl`";
    let help =
        "declare an identifier there, `#declare Value = ${t};`; `sdl_before` and `sdl_after` can use it";
    Some(Diagnostic::warning(Code::ValueInSdl, message).at(place, "this stays as it is").help(help))
}

//! Checks raw SDL: without `--trust`, SDL must not access files that the scene does not list.
//!
//! POV-Ray obeys a script: it opens, overwrites and includes any file that its user can access. Raw SDL in a scene is therefore code, and
//! a downloaded scene must not run code that accesses files.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use super::povray::with_numbers;
use super::{Context, asset, braces};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::expand::place;
use crate::scene::grammar::Kind;
use crate::scene::sdl::{FileKind, Refusal, RefusalReason, Where, files, refusals};
use crate::scene::source::{Node, Table, Value, file};

/// The maximum size of an asset that is read as SDL, in bytes.
const MAX_BYTES: u64 = 64 << 20;

/// The file extensions of assets that are checked as SDL.
const SDL_EXTENSIONS: [&str; 4] = ["inc", "pov", "mcr", "map"];

/// The files that the raw SDL of an untrusted scene may name.
#[derive(Default)]
pub(super) struct Assets {
    /// The path of each file, by the file's name in SDL.
    files: HashMap<String, PathBuf>,
    /// The names in the list whose files are missing or cannot be used, which is reported where they are listed.
    wrong: HashSet<String>,
    /// The names of the assets and include files that have been checked as SDL.
    read: HashSet<String>,
}

impl Assets {
    /// Reads the scene's list of assets. Skips wrong entries, which are reported elsewhere.
    pub(super) fn of(root: &Table, folder: Option<&Path>, trust: bool) -> Assets {
        let povray = root.get("povray").and_then(|entry| entry.node.as_table());
        let list = povray.and_then(|povray| povray.get("assets")).map(|entry| &entry.node.value);
        let items = match list {
            Some(Value::Array(items)) => items.as_slice(),
            _ => &[],
        };
        let mut assets = Assets::default();
        for item in items {
            match (asset::asset(item, folder, trust), item.as_str()) {
                (Ok(asset), _) => drop(assets.files.insert(asset.name, asset.path)),
                (Err(_), Some(name)) => {
                    assets.wrong.insert(asset::below(name).unwrap_or_else(|| name.to_owned()));
                }
                (Err(_), None) => {}
            }
        }
        assets
    }

    /// Returns true if the scene lists a file of this name, even if the file is missing.
    fn is_listed(&self, name: &str) -> bool {
        let plain = asset::below(name).unwrap_or_else(|| name.to_owned());
        self.files.contains_key(&plain) || self.wrong.contains(&plain)
    }

    fn path(&self, name: &str) -> Option<&Path> {
        self.files.get(&asset::below(name)?).map(PathBuf::as_path)
    }
}

/// Reports mistakes in the raw SDL of a value, such as file access without `--trust` and unmatched braces.
pub(super) fn check(node: &Node, place: Where, context: &mut Context<'_>) {
    let Some(written) = node.as_str() else {
        return context.diagnostics.push(super::read::wrong_type(node, &Kind::Sdl(place)));
    };
    // Values become numbers. Their formulas are checked elsewhere, so nothing else can hide in them.
    let filled = with_numbers(written);
    let text = if place == Where::Top { filled.as_str() } else { written };
    if context.trust {
        context.diagnostics.extend(braces::unbalanced(text, node.span));
        trusted(text, node.span, context);
        return;
    }
    let (refused, includes) = refusals(text, place, |name| context.assets.is_listed(name));
    for refusal in &refused {
        let raw = context.sources.raw(node.span);
        let at = place::in_string(raw, written, &refusal.range, node.span);
        context.diagnostics.push(diagnostic(refusal, at));
    }
    if refused.is_empty() {
        context.diagnostics.extend(braces::unbalanced(text, node.span));
    }
    for name in includes {
        included(name, node.span, context);
    }
}

/// Reports mistakes in the SDL of an include file. `span` is the source span that names the file in the scene. Does nothing if the scene is
/// not trusted and the file has been checked before, for example as an asset.
pub(super) fn check_include(name: &str, text: &str, span: Span, context: &mut Context<'_>) {
    if context.trust {
        trusted(text, span, context);
    } else if context.assets.read.insert(asset::below(name).unwrap_or_default()) {
        check_file(name, text, span, context);
    }
}

/// Reports mistakes in the SDL of a file of an untrusted scene. `span` is the source span that names the file in the scene.
fn check_file(name: &str, text: &str, span: Span, context: &mut Context<'_>) {
    let (refused, includes) = refusals(text, Where::Top, |name| context.assets.is_listed(name));
    if !refused.is_empty() {
        let source = context.sources.add(name, text);
        let errors = refused.iter().map(|refusal| {
            diagnostic(refusal, Span::new(source, refusal.range.clone())).at(span, "the file is named here")
        });
        context.diagnostics.extend(errors);
    }
    for name in includes {
        included(name, span, context);
    }
}

/// Reports mistakes in an asset if its file extension shows that it contains SDL.
pub(super) fn check_asset(name: &str, span: Span, context: &mut Context<'_>) {
    let ending = Path::new(name).extension().and_then(|ending| ending.to_str());
    if ending.is_some_and(|ending| SDL_EXTENSIONS.iter().any(|sdl| ending.eq_ignore_ascii_case(sdl))) {
        included(name, span, context);
    }
}

/// Reads an asset as SDL and reports mistakes. Does nothing if the scene is trusted, or if the asset has been checked before.
fn included(name: &str, span: Span, context: &mut Context<'_>) {
    let Some(path) = context.assets.path(name).map(Path::to_owned) else { return };
    if context.trust || !context.assets.read.insert(asset::below(name).unwrap_or_default()) {
        return;
    }
    match file::read(&path, MAX_BYTES) {
        // Replace invalid UTF-8: old include files have other encodings. These differ from UTF-8 only in comments and strings.
        Ok(bytes) => check_file(name, &String::from_utf8_lossy(&bytes), span, context),
        Err(error) => {
            let code = match error.kind() {
                std::io::ErrorKind::FileTooLarge => Code::FileTooLarge,
                _ => Code::MissingAsset,
            };
            let message = format!("cannot read `{name}`: {error}");
            context.diagnostics.push(Diagnostic::error(code, message).at(span, ""));
        }
    }
}

/// Finds the files that are named in trusted SDL, and adds them to `reads`. Warns of file names that POV-Ray computes.
fn trusted(text: &str, span: Span, context: &mut Context<'_>) {
    let mut is_computed = false;
    for file in files(text) {
        match file.literal {
            Some(name) => context.reads.push((file.kind, name.to_owned())),
            None => is_computed |= file.kind != FileKind::Font,
        }
    }
    if is_computed {
        let message = "the name of a file that the SDL reads is computed";
        let warning = Diagnostic::warning(Code::ComputedInclude, message).at(span, "");
        let help = "when that file changes, nothing tells that images are out of date";
        context.diagnostics.push(warning.help(help));
    }
}

/// The help text for SDL that is refused without `--trust`.
const TRUST_HELP: &str = "if you know this scene and trust it, say `--trust`";

fn diagnostic(refusal: &Refusal, at: Span) -> Diagnostic {
    let untrusted = |message: String, label: &str| {
        Diagnostic::error(Code::UntrustedSdl, message).at(at, label.to_owned())
    };
    let unbalanced = |message: String| Diagnostic::error(Code::UnbalancedSdl, message).at(at, "");
    match &refusal.why {
        RefusalReason::Word(word) => {
            untrusted(format!("the SDL reaches for files: `{word}`"), "").help(TRUST_HELP)
        }
        RefusalReason::Macro(name) => {
            untrusted(format!("the SDL reaches for files: the macro `{name}` writes one"), "")
                .help(TRUST_HELP)
        }
        RefusalReason::WritingInclude(name) => {
            untrusted(format!("the SDL reaches for files: the macros of `{name}` write them"), "")
                .help(TRUST_HELP)
        }
        RefusalReason::Computed(word) => {
            let message = format!("the name of the file that `{word}` reads is computed");
            let example = match word.as_str() {
                "include" => "#include \"parts.inc\"",
                "ttf" => "ttf \"timrom.ttf\"",
                _ => "image_map { png \"wood.png\" }",
            };
            let help =
                format!("write it between quotes, directly where it belongs: `{example}`; or say `--trust`");
            untrusted(message, "needs a plain string").help(help)
        }
        RefusalReason::Unlisted(name) => {
            let name = name.escape_debug();
            let message = format!("`{name}` is neither an asset of the scene nor a file of POV-Ray's");
            let help = "list it in `povray.assets`, by its path from the scene's folder";
            untrusted(message, "").help(format!("{help}; or, {TRUST_HELP}"))
        }
        RefusalReason::InnerInclude => {
            let message = "`#include` cannot stand in a macro, a body or a material";
            let help = "move it to `sdl` or `include` of [povray]";
            untrusted(message.to_owned(), "").help(format!("{help}; or, {TRUST_HELP}"))
        }
        RefusalReason::Hash => {
            untrusted("this `#` has no directive directly behind it".to_owned(), "").help(TRUST_HELP)
        }
        RefusalReason::NoHash(word) => untrusted(format!("the directive `{word}` needs a `#` before it"), "")
            .help(format!("write `#{word}`")),
        RefusalReason::Open(what) => unbalanced(match *what {
            "comment" | "string" => format!("the SDL opens a {what} that it does not close"),
            directive => format!("this `#{directive}` has no `#end` in the same text"),
        }),
        RefusalReason::Stray(word) => {
            unbalanced(format!("this `#{word}` belongs to no directive in the same text"))
        }
        RefusalReason::Nul => untrusted("the SDL contains a NUL character".to_owned(), ""),
    }
}

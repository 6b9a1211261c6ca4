//! Reads the user's own script templates.

use std::fs;
use std::path::Path;

use super::Context;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::scene::OwnTemplate;
use crate::scene::grammar::scene::povray;
use crate::scene::source::file;

/// The maximum size of a template, in bytes.
const MAX_BYTES: u64 = 1 << 20;

/// Reads the templates in the folder `given` on the command line, or else in the folder that the scene names.
pub(super) fn read(povray: &View<'_>, given: Option<&Path>, context: &mut Context<'_>) -> Vec<OwnTemplate> {
    if let Some(folder) = given {
        return load(folder, None, context);
    }
    let (Some(name), Some(span)) = (povray.get(&povray::TEMPLATES), povray.span(&povray::TEMPLATES)) else {
        return Vec::new();
    };
    if !context.trust {
        // Templates need trust because a template is code, like raw SDL.
        let error = Diagnostic::error(Code::UntrustedTemplates, "templates can make scripts do anything");
        let help =
            "if you know this scene and trust it, say `--trust`; or name the folder with `--templates`";
        context.diagnostics.push(error.at(span, "").help(help));
        return Vec::new();
    }
    let folder = context.folder.map_or_else(|| Path::new(name).to_owned(), |folder| folder.join(name));
    load(&folder, Some(span), context)
}

fn load(folder: &Path, span: Option<Span>, context: &mut Context<'_>) -> Vec<OwnTemplate> {
    match files(folder) {
        Ok(templates) => {
            templates.iter().for_each(|template| context.sources.note_file(&template.path));
            templates
        }
        Err(message) => {
            let error = Diagnostic::error(Code::NoTemplates, message);
            let help = "`jabuka templates DIR` writes the built-in ones, to be changed";
            let error = error.help(help);
            context.diagnostics.push(match span {
                Some(span) => error.at(span, ""),
                None => error,
            });
            Vec::new()
        }
    }
}

/// Reads the files with the extensions `.pov`, `.inc` and `.ini` in a folder and its direct subfolders.
///
/// # Errors
///
/// Returns a message if a file cannot be read, or if the folder has no such files.
fn files(folder: &Path) -> Result<Vec<OwnTemplate>, String> {
    let mut templates = Vec::new();
    collect(folder, "", &mut templates)?;
    // Sort the templates: the file system lists files in no fixed order.
    templates.sort_by(|a, b| a.name.cmp(&b.name));
    if templates.is_empty() {
        return Err(format!("there are no templates in `{}`", folder.display()));
    }
    Ok(templates)
}

/// Adds the templates in a folder to `templates`. `prefix` is the path of a subfolder, with which each name begins, as in
/// `library/metals.inc`.
fn collect(folder: &Path, prefix: &str, templates: &mut Vec<OwnTemplate>) -> Result<(), String> {
    let cannot_read = |error| format!("cannot read the templates in `{}`: {error}", folder.display());
    for entry in fs::read_dir(folder).map_err(cannot_read)? {
        let path = entry.map_err(cannot_read)?.path();
        let Some(name) = path.file_name().and_then(|name| name.to_str()) else { continue };
        let name = format!("{prefix}{name}");
        let metadata = fs::metadata(&path).map_err(cannot_read)?;
        if metadata.is_dir() && prefix.is_empty() {
            collect(&path, &format!("{name}/"), templates)?;
        }
        if !metadata.is_file() || !TEMPLATE_ENDINGS.iter().any(|ending| name.ends_with(ending)) {
            continue;
        }
        let text = file::read_text(&path, MAX_BYTES)
            .map_err(|error| format!("cannot read `{}`: {error}", path.display()))?;
        templates.push(OwnTemplate { name, path: path.display().to_string(), text });
    }
    Ok(())
}

/// The file extensions of templates.
const TEMPLATE_ENDINGS: [&str; 3] = [".pov", ".inc", ".ini"];

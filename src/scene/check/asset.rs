//! Reads `povray.assets`, the list of files in the scene's folder that the scene's raw SDL (POV-Ray code) reads.

use std::path::{Component, Path, PathBuf};

use super::Context;
use super::view::View;
use crate::diagnostic::{Code, Diagnostic};
use crate::scene::grammar::scene::povray;
use crate::scene::source::Node;
use crate::scene::{Asset, AssetSource};
use crate::system;

/// A file that a scene names.
#[derive(PartialEq, Eq)]
pub(super) struct FileOfScene {
    /// The path that its copy has among the assets.
    pub(super) name: String,
    pub(super) path: PathBuf,
}

/// Reads the list of assets. Reports two assets that would be copied to the same path.
pub(super) fn read(povray: &View<'_>, context: &mut Context<'_>) -> Vec<Asset> {
    let mut assets: Vec<(FileOfScene, &Node)> = Vec::new();
    for item in povray.list(&povray::ASSETS).unwrap_or_default() {
        let Ok(asset) = asset(item, context.folder, context.trust) else { continue };
        let clashes = |other: &FileOfScene| {
            let below = |a: &str, b: &str| b.strip_prefix(a).is_some_and(|rest| rest.starts_with('/'));
            other.name == asset.name || below(&other.name, &asset.name) || below(&asset.name, &other.name)
        };
        match assets.iter().find(|(other, _)| clashes(other)) {
            // Ignore an asset that is listed twice.
            Some((other, _)) if other == &asset => {}
            Some((_, node)) => {
                let message = format!("two assets would be copied to `assets/{}`", asset.name);
                let help = "a file from elsewhere is copied under its name alone: rename one of them";
                let error = Diagnostic::error(Code::SameAsset, message).at(item.span, "").help(help);
                context.diagnostics.push(error.at(node.span, "the other is here"));
            }
            None => assets.push((asset, item)),
        }
    }
    let asset =
        |(file, _): (FileOfScene, &Node)| Asset { name: file.name, source: AssetSource::File(file.path) };
    assets.into_iter().map(asset).collect()
}

/// Checks the name of an asset and finds its file.
///
/// # Errors
///
/// Returns an error if the name is unusable, or if the file is missing, not a regular file, or outside the scene's folder. With `trust`, a
/// file outside the folder is allowed.
pub(super) fn asset(node: &Node, folder: Option<&Path>, trust: bool) -> Result<FileOfScene, Diagnostic> {
    let name = node.as_str().unwrap_or_default();
    let error = |code, message: String| Diagnostic::error(code, message).at(node.span, "");
    // The SDL contains the name as a string literal, so the name must not contain quotes or backslashes.
    let bad = || {
        let help = "it cannot be empty, nor contain quotes, backslashes or control characters; `/` leads into folders";
        error(Code::BadAsset, format!("`{name}` cannot be the name of an asset")).help(help)
    };
    if name.is_empty() || name.chars().any(|c| c.is_control() || matches!(c, '"' | '\\')) {
        return Err(bad());
    }
    let outside = || {
        error(Code::UntrustedPath, format!("`{name}` leads out of the scene's folder"))
            .help("if you know this scene and trust it, say `--trust`")
    };
    let copied_to = match below(name) {
        Some(path) if path.is_empty() => return Err(bad()),
        Some(path) => path,
        None if !trust => return Err(outside()),
        None => Path::new(name).file_name().and_then(|name| name.to_str()).ok_or_else(bad)?.to_owned(),
    };
    let Some(folder) = folder else {
        let message = format!("there is no `{name}`: a scene that is no file has nothing beside it");
        return Err(error(Code::MissingAsset, message));
    };
    let missing = |e: std::io::Error| match e.kind() {
        std::io::ErrorKind::NotFound => error(Code::MissingAsset, format!("there is no file `{name}`")),
        _ => error(Code::MissingAsset, format!("cannot read `{name}`: {e}")),
    };
    // Resolve symbolic links: a link inside the folder may point outside it.
    let path = system::canonicalize(&folder.join(name)).map_err(missing)?;
    if !path.starts_with(system::canonicalize(folder).map_err(missing)?) && !trust {
        return Err(outside());
    }
    if let Some(what) = system::irregular(path.metadata().map_err(missing)?.file_type()) {
        let message = format!("`{name}` is {what}, and only regular files are read");
        return Err(error(Code::MissingAsset, message));
    }
    Ok(FileOfScene { name: copied_to, path })
}

/// Removes each component `.` from a relative path. Returns an empty string for the path `.`, and `None` for an absolute path or a path
/// with `..`.
pub(super) fn below(name: &str) -> Option<String> {
    let mut parts = Vec::new();
    for part in Path::new(name).components() {
        match part {
            Component::Normal(part) => parts.push(part.to_str()?),
            Component::CurDir => {}
            _ => return None,
        }
    }
    Some(parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_as_plain_as_can_be_or_leads_out() {
        for (name, plain) in [
            ("wood.png", Some("wood.png")),
            ("./maps//earth.png", Some("maps/earth.png")),
            ("maps/./a b.png", Some("maps/a b.png")),
            ("maps/../wood.png", None),
            ("../wood.png", None),
            ("/tmp/wood.png", None),
            (".", Some("")),
        ] {
            assert_eq!(below(name).as_deref(), plain, "{name}");
        }
    }
}

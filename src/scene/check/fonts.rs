//! Collects the fonts in which the texts of a scene are set, and reads the font files that labels name.

use std::sync::Arc;

use sha2::{Digest, Sha256};

use super::Context;
use super::asset::{FileOfScene, asset};
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::font::{self, Typeface};
use crate::scene::source::{Node, file};
use crate::scene::{Asset, AssetSource};

/// The fonts in which the texts of a scene are set.
#[derive(Default)]
pub(super) struct Fonts {
    /// The fonts that labels name, each with the place that names it first.
    own: Vec<(FileOfScene, Span, Arc<Typeface>)>,
    /// Whether a text has bold letters.
    pub(super) has_bold: bool,
}

impl Fonts {
    /// Adds the font files to the assets. If the scene already has a file of such a name among its assets, that file is taken for a font of
    /// jabuka. Reports a font of a label whose copy would have the path of another asset.
    pub(super) fn add_to(self, assets: &mut Vec<Asset>, context: &mut Context<'_>) {
        let [regular, bold] = font::files();
        for (name, bytes) in [Some(regular), Some(bold).filter(|_| self.has_bold)].into_iter().flatten() {
            if assets.iter().all(|asset| asset.name != name) {
                assets.push(Asset { name: name.to_owned(), source: AssetSource::BuiltIn(bytes) });
            }
        }
        for (file, span, _) in self.own {
            let asset = Asset { name: file.name, source: AssetSource::File(file.path) };
            match assets.iter().find(|other| other.name == asset.name) {
                Some(other) if *other == asset => {}
                Some(_) => {
                    let message = format!("two assets would be copied to `assets/{}`", asset.name);
                    let error = Diagnostic::error(Code::SameAsset, message).at(span, "");
                    context.diagnostics.push(error.help("rename this font file"));
                }
                None => assets.push(asset),
            }
        }
    }
}

/// Returns the fonts of a file that a label names. `None` for a file that is no font for POV-Ray, which is reported.
pub(super) fn typeface(node: &Node, context: &mut Context<'_>) -> Option<Arc<Typeface>> {
    /// The largest size of a font file, bytes. Fonts with all letters of Chinese are smaller.
    const MAX_BYTES: u64 = 64 << 20;
    // An error in the path has already been reported.
    let file = asset(node, context.folder, context.trust).ok()?;
    if let Some((.., typeface)) = context.fonts.own.iter().find(|(known, ..)| *known == file) {
        return Some(typeface.clone());
    }
    let read = file::read(&file.path, MAX_BYTES).map_err(|error| error.to_string()).and_then(|bytes| {
        context.files.push(Sha256::digest(&bytes).into());
        Typeface::of_file(file.name.clone(), bytes).map_err(str::to_owned)
    });
    match read {
        Ok(typeface) => {
            let typeface = Arc::new(typeface);
            context.fonts.own.push((file, node.span, typeface.clone()));
            Some(typeface)
        }
        Err(reason) => {
            let message = format!("`{}` cannot be the font of a label", node.as_str().unwrap_or_default());
            let error = Diagnostic::error(Code::BadFont, message).at(node.span, reason);
            context.diagnostics.push(error.help("any TrueType font, a file `….ttf`, can be"));
            None
        }
    }
}

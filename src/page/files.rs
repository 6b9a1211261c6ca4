//! The files of the page. They are built into the program.

use crate::font;

/// The content type of the page.
const HTML_TYPE: &str = "text/html; charset=utf-8";
/// The content type of style sheets.
const CSS_TYPE: &str = "text/css; charset=utf-8";
/// The content type of scripts.
const JAVASCRIPT_TYPE: &str = "text/javascript; charset=utf-8";
/// The content type of pictures.
const SVG_TYPE: &str = "image/svg+xml";
/// The content type of plain text.
const TEXT_TYPE: &str = "text/plain; charset=utf-8";
/// The content type of fonts.
const FONT_TYPE: &str = "font/ttf";

/// Lists files of the folder `web`, by their content types, with their paths on the page and their contents. Other files come first.
macro_rules! files {
    ([$($other:expr,)*] $($kind:ident: $($path:literal)*;)*) => {
        &[$($other,)* $($((concat!("/", $path), $kind, include_bytes!(concat!("web/", $path))),)*)*]
    };
}

/// The files of the page: path, content type and content of each.
pub const FILES: &[(&str, &str, &[u8])] = files! {
    [
        ("/", HTML_TYPE, include_bytes!("web/index.html")),
        ("/DejaVuSans.ttf", FONT_TYPE, font::BUILT_IN[0]),
        ("/DejaVuSans-Bold.ttf", FONT_TYPE, font::BUILT_IN[1]),
    ]
    CSS_TYPE: "style.css";
    SVG_TYPE: "icon.svg";
    TEXT_TYPE: "libraries/licences.txt";
    JAVASCRIPT_TYPE:
        "controls.js"
        "elements.js"
        "hook.js"
        "main.js"
        "math.js"
        "parts.js"
        "recorded.js"
        "source.js"
        "body/chosen_body.js"
        "body/contacts.js"
        "body/panel.js"
        "body/script_part.js"
        "libraries/codemirror.js"
        "libraries/video.js"
        "libraries/zip.js"
        "picture/gl.js"
        "picture/lines.js"
        "picture/overlay.js"
        "picture/painter.js"
        "picture/picture.js"
        "picture/scene_plots.js"
        "picture/shaders.js"
        "picture/surroundings.js"
        "picture/texts.js"
        "picture/viewpoint.js"
        "plots/axes.js"
        "plots/data.js"
        "plots/drawing.js"
        "plots/layout.js"
        "plots/legend.js"
        "plots/overlay.js"
        "plots/plots.js"
        "plots/pointer.js"
        "plots/quantities.js"
        "plots/saving.js"
        "plots/table.js"
        "plots/window.js"
        "run/packed_files.js"
        "run/player.js"
        "run/run.js"
        "run/runs.js"
        "saving/copied_camera.js"
        "saving/download.js"
        "saving/film.js"
        "saving/render.js"
        "saving/save.js"
        "saving/scripts_zip.js"
        "saving/snapshots.js"
        "text/dragged_numbers.js"
        "text/editor.js"
        "text/handle_planes.js"
        "text/handles.js"
        "text/scene_keys.js"
        "text/scene_text.js"
        "text/sliders.js"
        "text/undo_step.js";
};

#[cfg(test)]
mod tests {
    use super::*;

    /// The page must contain nothing that its own content security policy would forbid.
    #[test]
    fn nothing_comes_from_elsewhere() {
        let is_own = |path: &str, kind: &str| kind != FONT_TYPE && !path.starts_with("/libraries/");
        for (path, _, content) in FILES.iter().filter(|(path, kind, _)| is_own(path, kind)) {
            let text = std::str::from_utf8(content).unwrap().replace("http://www.w3.org/2000/svg", "");
            for forbidden in ["http:", "https:", "innerHTML", "eval(", "style=\"", "onclick="] {
                assert!(!text.contains(forbidden), "{path}: {forbidden}");
            }
        }
    }

    /// The skies are defined twice: in the templates and in the page.
    #[test]
    fn the_skies_are_those_of_the_templates() {
        let environment = include_str!("../../templates/environment.inc");
        let page = include_str!("web/picture/surroundings.js");
        let skies = page.split_once("const DAYLIGHT").unwrap().1.split_once("const even").unwrap().0;
        let stops: Vec<&str> = skies.split('[').filter_map(|stop| Some(stop.split_once(']')?.0)).collect();
        assert_eq!(stops.len(), 7 + 7 + 4);
        for (height, color) in stops.into_iter().filter_map(|stop| stop.split_once(", ")) {
            let stop = format!("[{height} color srgb <{color}>]");
            assert!(environment.contains(&stop), "{stop}");
        }
    }
}

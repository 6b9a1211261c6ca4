//! The files of the page. They are built into the program.

use crate::font;

/// The content type of the page.
const HTML_TYPE: &str = "text/html; charset=utf-8";
/// The content type of style sheets.
const CSS_TYPE: &str = "text/css; charset=utf-8";
/// The content type of scripts.
const JAVASCRIPT_TYPE: &str = "text/javascript; charset=utf-8";

/// The files of the page: path, content type and content of each.
pub const FILES: &[(&str, &str, &[u8])] = &[
    ("/", HTML_TYPE, include_bytes!("web/index.html")),
    ("/style.css", CSS_TYPE, include_bytes!("web/style.css")),
    ("/icon.svg", "image/svg+xml", include_bytes!("web/icon.svg")),
    ("/main.js", JAVASCRIPT_TYPE, include_bytes!("web/main.js")),
    ("/chosen_body.js", JAVASCRIPT_TYPE, include_bytes!("web/chosen_body.js")),
    ("/contacts.js", JAVASCRIPT_TYPE, include_bytes!("web/contacts.js")),
    ("/controls.js", JAVASCRIPT_TYPE, include_bytes!("web/controls.js")),
    ("/copied_camera.js", JAVASCRIPT_TYPE, include_bytes!("web/copied_camera.js")),
    ("/download.js", JAVASCRIPT_TYPE, include_bytes!("web/download.js")),
    ("/dragged_numbers.js", JAVASCRIPT_TYPE, include_bytes!("web/dragged_numbers.js")),
    ("/editor.js", JAVASCRIPT_TYPE, include_bytes!("web/editor.js")),
    ("/elements.js", JAVASCRIPT_TYPE, include_bytes!("web/elements.js")),
    ("/film.js", JAVASCRIPT_TYPE, include_bytes!("web/film.js")),
    ("/gl.js", JAVASCRIPT_TYPE, include_bytes!("web/gl.js")),
    ("/handle_planes.js", JAVASCRIPT_TYPE, include_bytes!("web/handle_planes.js")),
    ("/handles.js", JAVASCRIPT_TYPE, include_bytes!("web/handles.js")),
    ("/hook.js", JAVASCRIPT_TYPE, include_bytes!("web/hook.js")),
    ("/scene_keys.js", JAVASCRIPT_TYPE, include_bytes!("web/scene_keys.js")),
    ("/lines.js", JAVASCRIPT_TYPE, include_bytes!("web/lines.js")),
    ("/math.js", JAVASCRIPT_TYPE, include_bytes!("web/math.js")),
    ("/overlay.js", JAVASCRIPT_TYPE, include_bytes!("web/overlay.js")),
    ("/packed_files.js", JAVASCRIPT_TYPE, include_bytes!("web/packed_files.js")),
    ("/painter.js", JAVASCRIPT_TYPE, include_bytes!("web/painter.js")),
    ("/panel.js", JAVASCRIPT_TYPE, include_bytes!("web/panel.js")),
    ("/parts.js", JAVASCRIPT_TYPE, include_bytes!("web/parts.js")),
    ("/picture.js", JAVASCRIPT_TYPE, include_bytes!("web/picture.js")),
    ("/player.js", JAVASCRIPT_TYPE, include_bytes!("web/player.js")),
    ("/plot_axes.js", JAVASCRIPT_TYPE, include_bytes!("web/plot_axes.js")),
    ("/plot_data.js", JAVASCRIPT_TYPE, include_bytes!("web/plot_data.js")),
    ("/plot_drawing.js", JAVASCRIPT_TYPE, include_bytes!("web/plot_drawing.js")),
    ("/plot_layout.js", JAVASCRIPT_TYPE, include_bytes!("web/plot_layout.js")),
    ("/plot_legend.js", JAVASCRIPT_TYPE, include_bytes!("web/plot_legend.js")),
    ("/plot_overlay.js", JAVASCRIPT_TYPE, include_bytes!("web/plot_overlay.js")),
    ("/plot_pointer.js", JAVASCRIPT_TYPE, include_bytes!("web/plot_pointer.js")),
    ("/plot_quantities.js", JAVASCRIPT_TYPE, include_bytes!("web/plot_quantities.js")),
    ("/plot_saving.js", JAVASCRIPT_TYPE, include_bytes!("web/plot_saving.js")),
    ("/plot_table.js", JAVASCRIPT_TYPE, include_bytes!("web/plot_table.js")),
    ("/plot_window.js", JAVASCRIPT_TYPE, include_bytes!("web/plot_window.js")),
    ("/plots.js", JAVASCRIPT_TYPE, include_bytes!("web/plots.js")),
    ("/render.js", JAVASCRIPT_TYPE, include_bytes!("web/render.js")),
    ("/run.js", JAVASCRIPT_TYPE, include_bytes!("web/run.js")),
    ("/runs.js", JAVASCRIPT_TYPE, include_bytes!("web/runs.js")),
    ("/save.js", JAVASCRIPT_TYPE, include_bytes!("web/save.js")),
    ("/scene_plots.js", JAVASCRIPT_TYPE, include_bytes!("web/scene_plots.js")),
    ("/script_part.js", JAVASCRIPT_TYPE, include_bytes!("web/script_part.js")),
    ("/scripts_zip.js", JAVASCRIPT_TYPE, include_bytes!("web/scripts_zip.js")),
    ("/shaders.js", JAVASCRIPT_TYPE, include_bytes!("web/shaders.js")),
    ("/sliders.js", JAVASCRIPT_TYPE, include_bytes!("web/sliders.js")),
    ("/snapshots.js", JAVASCRIPT_TYPE, include_bytes!("web/snapshots.js")),
    ("/source.js", JAVASCRIPT_TYPE, include_bytes!("web/source.js")),
    ("/surroundings.js", JAVASCRIPT_TYPE, include_bytes!("web/surroundings.js")),
    ("/scene_text.js", JAVASCRIPT_TYPE, include_bytes!("web/scene_text.js")),
    ("/texts.js", JAVASCRIPT_TYPE, include_bytes!("web/texts.js")),
    ("/undo_step.js", JAVASCRIPT_TYPE, include_bytes!("web/undo_step.js")),
    ("/viewpoint.js", JAVASCRIPT_TYPE, include_bytes!("web/viewpoint.js")),
    ("/libraries/codemirror.js", JAVASCRIPT_TYPE, include_bytes!("web/libraries/codemirror.js")),
    ("/libraries/video.js", JAVASCRIPT_TYPE, include_bytes!("web/libraries/video.js")),
    ("/libraries/zip.js", JAVASCRIPT_TYPE, include_bytes!("web/libraries/zip.js")),
    ("/libraries/licences.txt", "text/plain; charset=utf-8", include_bytes!("web/libraries/licences.txt")),
    ("/DejaVuSans.ttf", "font/ttf", font::BUILT_IN[0]),
    ("/DejaVuSans-Bold.ttf", "font/ttf", font::BUILT_IN[1]),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The page must contain nothing that its own content security policy would forbid.
    #[test]
    fn nothing_comes_from_elsewhere() {
        let is_own = |path: &str, kind: &str| kind != "font/ttf" && !path.starts_with("/libraries/");
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
        let page = include_str!("web/surroundings.js");
        let skies = page.split_once("const DAYLIGHT").unwrap().1.split_once("const even").unwrap().0;
        let stops: Vec<&str> = skies.split('[').filter_map(|stop| Some(stop.split_once(']')?.0)).collect();
        assert_eq!(stops.len(), 7 + 7 + 4);
        for (height, color) in stops.into_iter().filter_map(|stop| stop.split_once(", ")) {
            let stop = format!("[{height} color srgb <{color}>]");
            assert!(environment.contains(&stop), "{stop}");
        }
    }
}

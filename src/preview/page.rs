//! The files of the page. They are built into the program.

/// The content type of the page.
const HTML_TYPE: &str = "text/html; charset=utf-8";
/// The content type of style sheets.
const CSS_TYPE: &str = "text/css; charset=utf-8";
/// The content type of scripts.
const JAVASCRIPT_TYPE: &str = "text/javascript; charset=utf-8";

/// The files of the page: path, content type and text of each.
pub(super) const FILES: &[(&str, &str, &str)] = &[
    ("/", HTML_TYPE, include_str!("page/index.html")),
    ("/style.css", CSS_TYPE, include_str!("page/style.css")),
    ("/icon.svg", "image/svg+xml", include_str!("page/icon.svg")),
    ("/main.js", JAVASCRIPT_TYPE, include_str!("page/main.js")),
    ("/controls.js", JAVASCRIPT_TYPE, include_str!("page/controls.js")),
    ("/gl.js", JAVASCRIPT_TYPE, include_str!("page/gl.js")),
    ("/hook.js", JAVASCRIPT_TYPE, include_str!("page/hook.js")),
    ("/lines.js", JAVASCRIPT_TYPE, include_str!("page/lines.js")),
    ("/math.js", JAVASCRIPT_TYPE, include_str!("page/math.js")),
    ("/painter.js", JAVASCRIPT_TYPE, include_str!("page/painter.js")),
    ("/panel.js", JAVASCRIPT_TYPE, include_str!("page/panel.js")),
    ("/parts.js", JAVASCRIPT_TYPE, include_str!("page/parts.js")),
    ("/picture.js", JAVASCRIPT_TYPE, include_str!("page/picture.js")),
    ("/player.js", JAVASCRIPT_TYPE, include_str!("page/player.js")),
    ("/plots.js", JAVASCRIPT_TYPE, include_str!("page/plots.js")),
    ("/render.js", JAVASCRIPT_TYPE, include_str!("page/render.js")),
    ("/run.js", JAVASCRIPT_TYPE, include_str!("page/run.js")),
    ("/runs.js", JAVASCRIPT_TYPE, include_str!("page/runs.js")),
    ("/server.js", JAVASCRIPT_TYPE, include_str!("page/server.js")),
    ("/shaders.js", JAVASCRIPT_TYPE, include_str!("page/shaders.js")),
    ("/surroundings.js", JAVASCRIPT_TYPE, include_str!("page/surroundings.js")),
    ("/texts.js", JAVASCRIPT_TYPE, include_str!("page/texts.js")),
    ("/viewpoint.js", JAVASCRIPT_TYPE, include_str!("page/viewpoint.js")),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The page must contain nothing that its own content security policy would forbid.
    #[test]
    fn nothing_comes_from_elsewhere() {
        for (path, _, text) in FILES {
            let text = text.replace("http://www.w3.org/2000/svg", "");
            for forbidden in ["http:", "https:", "innerHTML", "eval(", "style=\"", "onclick="] {
                assert!(!text.contains(forbidden), "{path}: {forbidden}");
            }
        }
    }
}

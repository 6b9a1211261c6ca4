//! The files of the page. They are built into the program.

const HTML: &str = "text/html; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";

/// The files of the page: path, content type and text of each.
pub(super) const FILES: &[(&str, &str, &str)] = &[
    ("/", HTML, include_str!("page/index.html")),
    ("/style.css", STYLE, include_str!("page/style.css")),
    ("/icon.svg", "image/svg+xml", include_str!("page/icon.svg")),
    ("/main.js", SCRIPT, include_str!("page/main.js")),
    ("/controls.js", SCRIPT, include_str!("page/controls.js")),
    ("/gl.js", SCRIPT, include_str!("page/gl.js")),
    ("/hook.js", SCRIPT, include_str!("page/hook.js")),
    ("/lines.js", SCRIPT, include_str!("page/lines.js")),
    ("/math.js", SCRIPT, include_str!("page/math.js")),
    ("/painter.js", SCRIPT, include_str!("page/painter.js")),
    ("/panel.js", SCRIPT, include_str!("page/panel.js")),
    ("/parts.js", SCRIPT, include_str!("page/parts.js")),
    ("/picture.js", SCRIPT, include_str!("page/picture.js")),
    ("/player.js", SCRIPT, include_str!("page/player.js")),
    ("/plots.js", SCRIPT, include_str!("page/plots.js")),
    ("/render.js", SCRIPT, include_str!("page/render.js")),
    ("/run.js", SCRIPT, include_str!("page/run.js")),
    ("/runs.js", SCRIPT, include_str!("page/runs.js")),
    ("/server.js", SCRIPT, include_str!("page/server.js")),
    ("/shaders.js", SCRIPT, include_str!("page/shaders.js")),
    ("/surroundings.js", SCRIPT, include_str!("page/surroundings.js")),
    ("/texts.js", SCRIPT, include_str!("page/texts.js")),
    ("/viewpoint.js", SCRIPT, include_str!("page/viewpoint.js")),
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

//! A run as one file: the page with its modules, and all data of the run. A browser shows it without jabuka, and without a network.
//!
//! The file answers the page's requests itself (`web/recorded.js`). So it holds the answer to each request that the page can make about a
//! finished run. The answers for all frames stand one after another, with the size of each, so that the page finds that of any frame.

use std::borrow::Cow;
use std::io::{self, Write};
use std::ops::Range;
use std::sync::Arc;

use base64::prelude::{BASE64_STANDARD, Engine as _};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde::Serialize;
use serde_json::json;

use super::numbers::{NUMBERS_PER_CONTACT, NUMBERS_PER_POSE};
use super::run::PageRun;
use super::session::State;
use super::{FILES, Failed, Frames, answer_of_run, describe};
use crate::Scene;
use crate::export::{Contents, ExportError, FileKind, Format, count_of_bodies};
use crate::simulate::{Recorded, Selection};

/// Pages in HTML.
pub static WEB_PAGE: FileKind = FileKind { noun: "a web page", extension: "html" };

/// The largest number of values of single bodies, bodies times frames, that a page holds. Their plots need 0.1 kB each.
const MAX_BODY_VALUES: usize = 100_000;

/// What the page may load: only what the file itself contains.
const CONTENT_SECURITY_POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' data:; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; form-action 'none'";

/// The module that answers the page's requests, and the one that it replaces.
const RECORDED_SOURCE: &str = "recorded.js";
const PREVIEW_SOURCE: &str = "source.js";

/// The number of frames whose answers are found together.
const FRAMES_AT_ONCE: usize = 64;

/// The largest size of the poses in a page, bytes. Browsers read no text that is much longer.
const MAX_BYTES_OF_POSES: u64 = 300 << 20;

/// The sizes of a pose and of a contact in an answer, bytes.
const BYTES_PER_POSE: u64 = 8 * NUMBERS_PER_POSE as u64;
const BYTES_PER_CONTACT: usize = 8 * NUMBERS_PER_CONTACT;

/// The format of a run as one file.
#[derive(Clone, Copy, Debug)]
pub struct OneFile;

impl Format for OneFile {
    fn file_kind(&self) -> &'static FileKind {
        &WEB_PAGE
    }

    fn needs_all_frames(&self) -> bool {
        true
    }

    fn lack(&self, scene: &Scene) -> Option<Cow<'static, str>> {
        let poses = BYTES_PER_POSE * (scene.bodies.len() * scene.simulation.timeline.frames()) as u64;
        (poses > MAX_BYTES_OF_POSES).then(|| {
            let megabytes = poses / 1_000_000;
            format!("the page would hold {megabytes} MB of motion, and browsers read about 300 MB: take a lower `simulation.frame_rate`").into()
        })
    }

    fn write(
        &self,
        run: &Recorded<'_>,
        selection: &Selection,
        out: &mut dyn Write,
    ) -> Result<Contents, ExportError> {
        let frames = run.scene().simulation.timeline.frames();
        if selection.count_within(run.recording().frames()) < frames {
            return Err(ExportError::NotWhole);
        }
        let run = PageRun::of(run).map_err(ExportError::Run)?;
        let has_values = write_page(&run, out)?;
        let without = if has_values { "" } else { ", without the values of single bodies" };
        let frames = if frames == 1 { "1 frame".to_owned() } else { format!("{frames} frames") };
        let words = format!("{}, {frames}{without}", count_of_bodies(&run.scene));
        Ok(Contents { words, bytes: None, faster: 1.0 })
    }
}

/// Writes the page with the data of a finished run. Returns true if it holds the values of single bodies.
fn write_page(run: &Arc<PageRun>, out: &mut dyn Write) -> Result<bool, ExportError> {
    let text = |path: &str| {
        let file = FILES.iter().find(|(name, _, _)| *name == path);
        file.map_or(Ok(""), |(_, _, bytes)| std::str::from_utf8(bytes)).map_err(io::Error::other)
    };
    let style: String = text("/style.css")?.lines().filter(|line| !line.starts_with("@font-face")).collect();
    let icon = format!("data:image/svg+xml;base64,{}", BASE64_STANDARD.encode(text("/icon.svg")?));
    let page: String = text("/")?
        .lines()
        .filter(|line| !line.contains("modulepreload"))
        .flat_map(|line| [line, "\n"])
        .collect();
    let page = page
        .replace(
            "<title>",
            &format!(
                "<meta http-equiv=\"Content-Security-Policy\" content=\"{CONTENT_SECURITY_POLICY}\">\n<title>"
            ),
        )
        .replace("<link rel=\"stylesheet\" href=\"style.css\">", &format!("<style>{style}</style>"))
        .replace("href=\"icon.svg\"", &format!("href=\"{icon}\""))
        .replace("<script type=\"module\" src=\"main.js\"></script>\n", "");
    let (before, after) = page.split_once("</body>").unwrap_or((&page, ""));
    write!(
        out,
        "{before}<script type=\"importmap\">{}</script>\n<script id=\"recorded\" type=\"application/json\">",
        modules()?
    )?;
    let has_values = write_data(run, out)?;
    write!(out, "</script>\n<script type=\"module\">import \"jabuka/main.js\";</script>\n</body>{after}")?;
    Ok(has_values)
}

/// Returns the import map of the page's modules. A module in a data URL cannot use relative names, so each
/// imports the others by whole names.
fn modules() -> io::Result<serde_json::Value> {
    let mut urls = serde_json::Map::new();
    for (path, _, content) in FILES.iter().filter(|(path, _, _)| path.ends_with(".js")) {
        let name = &path[1..];
        if name.starts_with("libraries/") || name == PREVIEW_SOURCE {
            continue;
        }
        let text = std::str::from_utf8(content).map_err(io::Error::other)?;
        let text = with_whole_names(text, name);
        let name = if name == RECORDED_SOURCE { PREVIEW_SOURCE } else { name };
        let url = format!("data:text/javascript;base64,{}", BASE64_STANDARD.encode(text));
        urls.insert(format!("jabuka/{name}"), url.into());
    }
    Ok(json!({ "imports": urls }))
}

/// Replaces the relative names of the modules that a module imports, such as "../math.js", by names that begin with "jabuka/".
fn with_whole_names(text: &str, name: &str) -> String {
    let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder);
    let in_folder = if folder.is_empty() { "jabuka/".to_owned() } else { format!("jabuka/{folder}/") };
    let mut whole = text.to_owned();
    for before in ["from ", "import ", "import("] {
        whole = whole.replace(&format!("{before}\"../"), &format!("{before}\"jabuka/"));
        whole = whole.replace(&format!("{before}\"./"), &format!("{before}\"{in_folder}"));
    }
    whole
}

/// The answers to a request for each frame, compressed by zlib one after another.
struct Answers {
    packed: ZlibEncoder<Vec<u8>>,
    /// The size of the answer for each frame, bytes. `None` if the answer does not depend on frames.
    sizes: Option<Vec<usize>>,
}

impl Answers {
    fn new() -> Answers {
        Answers { packed: ZlibEncoder::new(Vec::new(), Compression::default()), sizes: None }
    }

    /// Asks for each frame of a run. `at_once` frames are asked for together; `split` returns the size of the part that belongs to each of
    /// these frames.
    fn of_frames(
        run: &Arc<PageRun>,
        (what, frames): (&str, Frames),
        at_once: usize,
        split: impl Fn(&[u8], Range<usize>) -> Vec<usize>,
    ) -> Result<Answers, ExportError> {
        let (mut answers, mut sizes) = (Answers::new(), Vec::new());
        for from in (0..run.recorded()).step_by(at_once) {
            let asked = from..(from + at_once).min(run.recorded());
            let frames = Frames { from, to: Some(asked.end), ..frames };
            let bytes = answer_of_run(run, what, &frames).map_err(failed)?.into_bytes();
            sizes.extend(split(&bytes, asked));
            answers.packed.write_all(&bytes)?;
        }
        answers.sizes = Some(sizes);
        Ok(answers)
    }

    /// Writes the answers after their name. Base 64 has no letter that HTML could misread.
    fn write(self, name: &str, out: &mut dyn Write) -> io::Result<()> {
        let bytes = BASE64_STANDARD.encode(self.packed.finish()?);
        write!(out, ",\n{}:{{\"sizes\":{},\"bytes\":\"{bytes}\"}}", in_html(&name)?, in_html(&self.sizes)?)
    }
}

/// Returns the sizes of equal parts, one for each frame.
#[allow(clippy::needless_pass_by_value, reason = "as a function that splits answers")]
fn equal_parts(bytes: &[u8], frames: Range<usize>) -> Vec<usize> {
    vec![bytes.len() / frames.len(); frames.len()]
}

/// Returns the sizes of lists of contacts. Each contact begins with the number of its frame.
fn by_frame_number(bytes: &[u8], frames: Range<usize>) -> Vec<usize> {
    let mut sizes = vec![0; frames.len()];
    for contact in bytes.as_chunks::<BYTES_PER_CONTACT>().0 {
        let [number, ..] = contact.as_chunks::<8>().0 else { continue };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the number of a frame")]
        let frame = f64::from_le_bytes(*number) as usize;
        if let Some(size) = sizes.get_mut(frame.wrapping_sub(frames.start)) {
            *size += BYTES_PER_CONTACT;
        }
    }
    sizes
}

/// Writes the state of the session and the answers of the run, as JSON that HTML can contain. Returns true if the values of single bodies are
/// among them.
fn write_data(run: &Arc<PageRun>, out: &mut dyn Write) -> Result<bool, ExportError> {
    let id = run.id.to_string();
    let warnings = run.scene.warnings.to_text(false);
    let state = State {
        current: Some(id.clone()),
        integrator: Some(run.scene.simulation.method.name),
        problem: None,
        warnings: (!warnings.is_empty()).then_some(warnings),
        text: None,
        diagnostics: json!([]),
        runs: [(id, run.progress())].into(),
    };
    write!(out, "{{\"state\":{}", in_html(&state)?)?;
    let description = describe::describe(run);
    let bodies = run.scene.bodies.len();
    let has_values = bodies * run.recorded() <= MAX_BODY_VALUES;
    for what in ["", "forms", "fonts", "ghosts"] {
        let mut answers = Answers::new();
        answers
            .packed
            .write_all(&answer_of_run(run, what, &Frames::default()).map_err(failed)?.into_bytes())?;
        answers.write(if what.is_empty() { "description" } else { what }, out)?;
    }
    for what in ["poses", "balance"] {
        Answers::of_frames(run, (what, Frames::default()), FRAMES_AT_ONCE, equal_parts)?.write(what, out)?;
    }
    if description.particles {
        Answers::of_frames(run, ("particles", Frames::default()), 1, equal_parts)?.write("particles", out)?;
    }
    for view in if description.shows { 0..run.scene.views.len() + 1 } else { 0..0 } {
        let seen = Frames { view, ..Frames::default() };
        Answers::of_frames(run, ("shown", seen), 1, equal_parts)?
            .write(&format!("shown?view={view}"), out)?;
    }
    for body in if has_values { 0..bodies } else { 0..0 } {
        let of_body = Frames { body, ..Frames::default() };
        let series = Answers::of_frames(run, ("series", of_body), FRAMES_AT_ONCE, equal_parts)?;
        series.write(&format!("series?body={body}"), out)?;
        if description.contacts {
            let contacts = Answers::of_frames(run, ("contacts", of_body), FRAMES_AT_ONCE, by_frame_number)?;
            contacts.write(&format!("contacts?body={body}"), out)?;
        }
    }
    write!(out, "}}")?;
    Ok(has_values)
}

/// Writes a value as JSON that contains no end of an element of HTML.
fn in_html(value: &impl Serialize) -> io::Result<String> {
    Ok(serde_json::to_string(value)?.replace('<', "\\u003c"))
}

fn failed(error: Failed) -> ExportError {
    match error {
        Failed::Io(error) => ExportError::Io(error),
        Failed::Report(report) => ExportError::Run(report),
        error => ExportError::Io(io::Error::other(error.message())),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// Modules in data URLs import each other by the names of the import map. Only the editor and the libraries, which the page of one run
    /// never loads, have other names.
    #[test]
    fn modules_import_what_the_file_holds() {
        let map = modules().unwrap();
        let urls = map["imports"].as_object().unwrap();
        let mut missing = BTreeSet::new();
        let mut found = 0;
        for url in urls.values() {
            let (_, base64) = url.as_str().unwrap().split_once("base64,").unwrap();
            let text = String::from_utf8(BASE64_STANDARD.decode(base64).unwrap()).unwrap();
            for before in ["from ", "import ", "import("] {
                assert!(!text.contains(&format!("{before}\".")), "{text}");
                for rest in text.split(&format!("{before}\"jabuka/")).skip(1) {
                    let (name, _) = rest.split_once('"').unwrap();
                    found += 1;
                    if !urls.contains_key(&format!("jabuka/{name}")) {
                        missing.insert(name.to_owned());
                    }
                }
            }
        }
        assert!(found > 100, "{found}");
        let libraries = ["codemirror", "video", "zip"].map(|name| format!("libraries/{name}.js"));
        assert_eq!(missing, BTreeSet::from(libraries));
    }

    /// Each part that the page usually loads from its server is in the file.
    #[test]
    fn the_file_loads_nothing() {
        let scene = Scene::parse("simulation.duration = 0.1\n[body.a]\nshape.sphere.radius = 1\n").unwrap();
        let mut page = Vec::new();
        write_page(&PageRun::whole(scene), &mut page).unwrap();
        let page = String::from_utf8(page).unwrap();
        for part in [
            CONTENT_SECURITY_POLICY,
            "<style>",
            "href=\"data:image/svg+xml;base64,",
            "import \"jabuka/main.js\"",
            "</html>",
        ] {
            assert_eq!(page.matches(part).count(), 1, "{part}");
        }
        for loaded in ["rel=\"stylesheet\"", "modulepreload", " src=\"", "@font-face"] {
            assert!(!page.contains(loaded), "{loaded}");
        }
    }

    /// Text of the scene cannot close the element that holds the data.
    #[test]
    fn data_cannot_leave_their_element() {
        let text = in_html(&"</script><script>alert(1)</script>").unwrap();
        assert!(!text.contains('<'), "{text}");
        assert_eq!(serde_json::from_str::<String>(&text).unwrap(), "</script><script>alert(1)</script>");
    }
}

//! Runs POV-Ray, and asserts that it prints no warnings.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::image::Image;

/// The result of a run of POV-Ray.
pub(crate) struct Said {
    /// True if POV-Ray succeeded.
    pub(crate) success: bool,
    /// The warnings that POV-Ray printed.
    pub(crate) warnings: String,
    /// The errors that POV-Ray printed.
    pub(crate) errors: String,
}

impl Said {
    /// Returns true if POV-Ray succeeded without warnings or errors.
    pub(crate) fn is_nothing(&self) -> bool {
        self.success && self.warnings.is_empty() && self.errors.is_empty()
    }

    /// Panics unless POV-Ray succeeded without warnings or errors. `of` names the input in the message.
    pub(crate) fn nothing(&self, of: &str) {
        assert!(self.is_nothing(), "POV-Ray on {of}:\n{}{}", self.warnings, self.errors);
    }
}

/// Runs POV-Ray in a folder, and writes `warnings.txt` and `errors.txt` there. POV-Ray looks in jabuka's templates for
/// files that the folder does not have, such as the font of texts.
pub(crate) fn run(folder: &Path, arguments: &[&str]) -> Said {
    let status = Command::new("povray")
        .current_dir(folder)
        .args(arguments)
        .arg(concat!("+L", env!("CARGO_MANIFEST_DIR"), "/templates"))
        // Turn off the progress output, which takes megabytes. In files, lines of warnings and errors are not wrapped.
        .args(["-D", "-V", "-GA", "+GWwarnings.txt", "+GFerrors.txt"])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    let status = match status {
        Ok(status) => status,
        Err(error) => panic!("`povray` cannot be started ({error}): run the tests by `tests/run`"),
    };
    let said = |name| without_banners(&fs::read_to_string(folder.join(name)).unwrap_or_default());
    Said { success: status.success(), warnings: said("warnings.txt"), errors: said("errors.txt") }
}

/// Removes the banner that POV-Ray prints before the messages of each frame of a sequence, and empty lines.
fn without_banners(said: &str) -> String {
    said.lines()
        .filter(|line| !line.is_empty() && !line.starts_with('='))
        .map(|line| format!("{line}\n"))
        .collect()
}

/// Renders a script in a temporary folder with these arguments, and asserts that POV-Ray prints no warnings.
pub(crate) fn render_with(script: &str, size: [u32; 2], arguments: &[&str]) -> Image {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("script.pov"), script).unwrap();
    let [width, height] = size.map(|pixels| pixels.to_string());
    let (width, height) = (format!("+W{width}"), format!("+H{height}"));
    let mut all = vec!["+Iscript.pov", "+Oscript.png", "+FN8", "+WT1", &width, &height];
    all.extend(arguments);
    run(folder.path(), &all).nothing(script);
    Image::read(&folder.path().join("script.png"))
}

/// Renders a script without further arguments, and asserts that POV-Ray prints no warnings.
pub(crate) fn render(script: &str, size: [u32; 2]) -> Image {
    render_with(script, size, &[])
}

/// Renders several scripts at the same time.
pub(crate) fn render_all<const N: usize>(scripts: [String; N], size: [u32; 2]) -> [Image; N] {
    std::thread::scope(|scope| {
        let threads = scripts.map(|script| scope.spawn(move || render(&script, size)));
        threads.map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })
}

//! The command `jabuka export`: writes the motion of a scene as tables and models for other programs.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use crate::diagnostic::{Code, Diagnostic, Report, visible_path};
use crate::export::{Contents, ExportError, FORMATS, FileKind, Format, PlotDrawing, PlotFile};
use crate::motion_warnings;
use crate::output::OutputError;
use crate::overwrite::ProtectedFiles;
use crate::page::OneFile;
use crate::simulate::{Moments, Selection};
use crate::system::Dir;

use super::progress::Progress;
use super::run_arguments;
use super::scene_arguments::SceneArguments;
use super::summary::{bytes as size, two_digits};
use super::{Failure, terminal};

/// Write the positions of all bodies at every frame: as a table (CSV), as an animated model for Blender, three.js and other programs
/// (binary glTF), or as a web page that any browser plays
#[derive(clap::Args)]
#[command(
    override_usage = "jabuka export [OPTIONS] --output <FILE> <SCENE>\n       jabuka export [OPTIONS] --events <FILE> <SCENE>"
)]
pub(super) struct Arguments {
    /// The scene file
    #[arg(required_unless_present = "events")]
    scene: Option<PathBuf>,
    /// The file to write: FILE.csv, FILE.glb or FILE.html; with `--plot` FILE.svg, FILE.png, FILE.pdf or FILE.csv
    #[arg(short, long, value_name = "FILE", required_unless_present = "events")]
    output: Option<PathBuf>,
    /// Write the forces and torques of the joints as a table, instead of the positions of the bodies
    #[arg(long)]
    joints: bool,
    /// Write the positions of all particles as a table, instead of the positions of the bodies
    #[arg(long, conflicts_with_all = ["joints", "events"])]
    particles: bool,
    /// Write all impacts as a table into FILE.csv: time, place, bodies, impulse and lost energy. The file can also be given by `-o
    /// FILE.csv`
    #[arg(long, value_name = "FILE", num_args = 0..=1, conflicts_with_all = ["joints", "frames"])]
    events: Option<Option<PathBuf>>,
    /// Write the plot `[plot.NAME]` of the scene as a drawing (SVG or PDF) or an image (PNG), with its curves over the whole run, or with the bars
    /// of its last moment; or as a table (CSV) of its values in each frame
    #[arg(long, value_name = "NAME", conflicts_with_all = ["joints", "particles", "events", "frames"])]
    plot: Option<String>,
    /// The width of the image of a plot, in pixels
    #[arg(long, value_name = "PIXELS", requires = "plot", default_value_t = PlotFile::USUAL_WIDTH, value_parser = clap::value_parser!(u32).range(100..=i64::from(PlotFile::MAX_WIDTH)))]
    width: u32,
    /// Select frames by number, as in 0,50,90-100
    #[arg(long, value_name = "LIST")]
    frames: Option<Selection>,
    #[command(flatten)]
    of_scene: SceneArguments,
}

/// The paths of the scene to read and of the file to write.
struct Files<'a> {
    scene: &'a Path,
    output: &'a Path,
}

impl Arguments {
    /// Returns the paths of the scene and of the file to write. The optional value of `--events` is the file to write, or the scene if no
    /// other argument names the scene.
    fn files(&self) -> Result<Files<'_>, Failure> {
        let named = self.events.as_ref().and_then(Option::as_deref);
        match (self.scene.as_deref(), self.output.as_deref(), named) {
            (Some(scene), Some(output), None) | (None, Some(output), Some(scene)) => {
                Ok(Files { scene, output })
            }
            (Some(scene), None, Some(output)) => Ok(Files { scene, output }),
            (Some(_), Some(_), Some(_)) => {
                Err(Failure::Usage("`--events` and `--output` name two files: leave one out".to_owned()))
            }
            (None, ..) => Err(Failure::Usage("name the scene file".to_owned())),
            (_, None, None) => Err(Failure::Usage("name the file to write: `--events FILE.csv`".to_owned())),
        }
    }
}

impl Arguments {
    /// Returns the selected format: that of an option, or else that of the file's extension.
    fn format<'a>(&self, formats: &[&'a dyn Format], output: &Path) -> Result<&'a dyn Format, Failure> {
        let is_given = |option: &str| match option {
            "joints" => self.joints,
            "particles" => self.particles,
            "events" => self.events.is_some(),
            "plot" => self.plot.is_some(),
            option => unreachable!("the command has no option `--{option}`"),
        };
        let extension = output.extension().unwrap_or_default();
        let has_extension =
            |format: &dyn Format| extension.eq_ignore_ascii_case(format.file_kind().extension);
        let formats = formats.iter().copied();
        let given: Vec<&dyn Format> =
            formats.clone().filter(|format| format.option().is_some_and(is_given)).collect();
        if let Some(option) = given.first().and_then(|format| format.option()) {
            let kinds: Vec<String> = given.iter().map(|format| in_words(format.file_kind())).collect();
            let other = || Failure::Usage(format!("`--{option}` makes {}", kinds.join(", or ")));
            return given.into_iter().find(|format| has_extension(*format)).ok_or_else(other);
        }
        let formats = formats.filter(|format| format.option().is_none());
        formats.clone().find(|format| has_extension(*format)).ok_or_else(|| {
            let kinds = formats.map(Format::file_kind);
            let kinds: Vec<_> = kinds.map(in_words).collect();
            Failure::Usage(format!(
                "an export is {}; `{}` ends in none of these",
                kinds.join(", or "),
                visible_path(output)
            ))
        })
    }
}

fn in_words(FileKind { noun, extension }: &FileKind) -> String {
    format!("{noun}, `.{extension}`")
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let files = arguments.files()?;
    let output = files.output;
    let files_of_plot =
        [PlotFile::Svg, PlotFile::Png { width: arguments.width }, PlotFile::Pdf, PlotFile::Csv];
    let drawing = |name: &String| files_of_plot.map(|file| PlotDrawing { name: name.clone(), file });
    let drawings = arguments.plot.as_ref().map(drawing);
    let of_plot = drawings.iter().flatten().map(|drawing| drawing as &dyn Format);
    let formats: Vec<&dyn Format> =
        FORMATS.into_iter().chain(of_plot).chain([&OneFile as &dyn Format]).collect();
    let format = arguments.format(&formats, output)?;
    let scene = arguments.of_scene.read_with(files.scene, &[])?;
    if let Some(unknown) = drawings.iter().flatten().find_map(|drawing| drawing.unknown(&scene)) {
        return Err(Failure::Usage(unknown));
    }
    terminal::report_protected(ProtectedFiles::of_scene(&scene).check(output))?;
    if let Some(lack) = format.lack(&scene) {
        return Err(Failure::Scene(lack));
    }
    if format.needs_all_frames() && arguments.frames.is_some() {
        let noun = format.file_kind().noun;
        return Err(Failure::Usage(format!("{noun} holds all frames of a run: leave out `--frames`")));
    }
    let frames = scene.simulation.timeline.frames();
    let selection = arguments.frames.clone().unwrap_or_else(|| Selection::first(frames));
    if let Some(last) = selection.last().filter(|last| *last >= frames) {
        let message = format!("there is no frame {last}: the frames of this scene are 0 to {}", frames - 1);
        return Err(Failure::Usage(message));
    }
    let cache = arguments.of_scene.cache()?;
    let progress = Progress::of_run(&scene, 0);
    let run = run_arguments::simulated_to_breakdown(&scene, &cache, Moments::of(&scene), &progress);
    let run = run.map_err(|error| progress.failed(&error))?;
    progress.finish();
    let selection = run_arguments::whole(&run, &selection);
    if let Some(breakdown) = run.breakdown().filter(|_| format.needs_all_frames()) {
        return Err(run_arguments::report_breakdown(breakdown, "nothing is written"));
    }
    if selection.last().is_none() {
        return run_arguments::broken_down(&run, &selection);
    }
    let written = whole(output, |file| format.write(&run, &selection, file));
    let Contents { words, bytes, faster } = written.map_err(|error| {
        terminal::report(&report(error, output));
        Failure::Errors
    })?;
    let warnings = motion_warnings::all(&scene, run.survey());
    terminal::report(&Report { diagnostics: warnings, ..Report::default() });
    // The animation of a very slow or very fast run is sped up or slowed down. The summary then gives the factor.
    let speed = if faster == 1.0 {
        String::new()
    } else {
        format!(" ({} times as fast as in life)", two_digits(faster))
    };
    let size = bytes.map_or_else(String::new, |bytes| format!(", {}", size(bytes)));
    let left_out = format.without_particles().filter(|_| !scene.emitters.is_empty());
    let left_out = left_out.map_or_else(String::new, |why| format!("; particles are left out: {why}"));
    terminal::result(&format!("{}: {words}{speed}{size}{left_out}\n", visible_path(output)));
    run_arguments::broken_down(&run, &selection)
}

fn report(error: ExportError, path: &Path) -> Report {
    match error {
        ExportError::Io(error) => OutputError::Io(path.to_owned(), error).report(),
        ExportError::Simulate(error) => OutputError::from(error).report(),
        ExportError::Run(report) => report,
        ExportError::NotWhole
        | ExportError::TooLarge(_)
        | ExportError::NoValue { .. }
        | ExportError::OutOfRange { .. } => {
            let message = format!("`{}`: {error}", visible_path(path));
            let diagnostic = Diagnostic::error(Code::CannotExport, message);
            let help = error.help();
            Report {
                diagnostics: vec![match help {
                    Some(help) => diagnostic.help(help),
                    None => diagnostic,
                }],
                ..Report::default()
            }
        }
    }
}

/// Writes a file under a temporary name and renames it at the end, so that an error leaves no partial file.
pub(super) fn whole<T>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<T, ExportError>,
) -> Result<T, ExportError> {
    let (folder, name) = Dir::of_file(path, false)?;
    folder.write_whole(&name, write)
}

//! The command `jabuka batch`: writes a job folder, with scripts of a scene that a cluster renders.

use std::path::{Path, PathBuf};

use crate::diagnostic::visible_path;
use crate::output::{self, OutputError};
use crate::overwrite::ProtectedFiles;
use crate::render::Film;
use crate::render::batch::{self, JobFolder, Requirements, SCRIPTS_FOLDER, Settings};
use crate::simulate::Selection;
use clap::ValueEnum;

use super::picture_arguments::PictureArguments;
use super::progress::Progress;
use super::run_arguments::{self, RunArguments, seen};
use super::video_arguments::VideoArguments;
use super::{Failure, shell, terminal};

/// Write a job folder for a cluster: the scripts of a scene, and files that submit them to Slurm or to a render farm
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene file, or a folder that `jabuka compile` has written
    #[arg(value_name = "SCENE|DIR")]
    scene: PathBuf,
    /// The system that distributes the frames in the cluster
    #[arg(long, value_enum)]
    engine: Engine,
    /// The job folder to write [default: out/<name of the scene file>-job]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    of_scene: RunArguments,
    #[command(flatten)]
    picture: PictureArguments,
    #[command(flatten)]
    film: VideoArguments,
    /// The number of frames per cluster job [default: 10, or more if there are very many frames]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    chunk: Option<u32>,
    /// The maximum time for rendering one frame, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 3600)]
    limit: u64,
    /// The Slurm partition for the jobs
    #[arg(long, value_name = "NAME", value_parser = parse_word)]
    partition: Option<String>,
    /// The Slurm account for the jobs
    #[arg(long, value_name = "NAME", value_parser = parse_word)]
    account: Option<String>,
    /// The maximum time for one cluster job, in Slurm's format: 01:30:00
    #[arg(long, value_parser = parse_word)]
    time: Option<String>,
    /// The environment modules to load on each node: "povray/3.7 ffmpeg"
    #[arg(long, value_parser = parse_words)]
    modules: Option<String>,
    /// The number of processors for one cluster job [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    cpus: Option<u32>,
    /// The memory for one cluster job, in Slurm's format: 2G
    #[arg(long, value_parser = parse_word)]
    mem: Option<String>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Engine {
    /// Slurm: writes `render.sbatch`, `video.sbatch`, and the script `submit`, which submits both
    Slurm,
    /// An Open Job Description (OpenJD), for AWS Deadline Cloud and other render farms that read it
    Openjd,
}

/// Parses an argument that becomes the value of an option in a generated script. It must be a single word without special characters of
/// the shell.
fn parse_word(argument: &str) -> Result<String, String> {
    let plain = |c: char| c.is_ascii_alphanumeric() || ",.:/_+=%@-".contains(c);
    match !argument.is_empty() && argument.chars().all(plain) {
        true => Ok(argument.to_owned()),
        false => Err("it may have letters, digits and , . : / _ + = % @ -".to_owned()),
    }
}

/// Parses a list of words, separated by spaces, that is inserted into a command of a generated script. None of the words may be an option.
fn parse_words(argument: &str) -> Result<String, String> {
    let words: Vec<&str> = argument.split(' ').filter(|word| !word.is_empty()).collect();
    if words.is_empty() || words.iter().any(|word| word.starts_with('-')) {
        return Err("name modules, as in \"povray/3.7 ffmpeg\"".to_owned());
    }
    words.iter().try_for_each(|word| parse_word(word).map(drop))?;
    Ok(words.join(" "))
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.scene.is_dir() { of_scripts(arguments) } else { of_scene(arguments) }
}

/// Writes a job folder for a scene, or one for each view of the scene if several are requested.
fn of_scene(arguments: &Arguments) -> Result<(), Failure> {
    let scene = arguments.of_scene.read_with(&arguments.scene, &arguments.picture.overrides())?;
    let frames = scene.simulation.timeline.frames();
    let selection = arguments.of_scene.selection(frames)?;
    check_film([scene.output.width, scene.output.height], scene.output.video_rate)?;
    let folder = folder(arguments, &scene.name);
    let cameras = arguments.of_scene.cameras(&folder, arguments.output.is_some(), &scene)?;

    for (_, folder) in &cameras {
        let protected = ProtectedFiles::of_scene(&scene).and_folder(&folder.join(SCRIPTS_FOLDER));
        terminal::report_protected(
            protected.and_then(|protected| protected.and_folder(&folder.join("images"))),
        )?;
    }
    let cache = arguments.of_scene.cache()?;
    let progress = Progress::of_run(&scene, cameras.len() * selection.count_within(frames));
    let run = run_arguments::run(&scene, &cache, &progress)?;
    progress.phase("writing");
    for (view, folder) in &cameras {
        let seen = seen(&run, *view, &progress)?;
        let run = seen.as_ref().unwrap_or(&run);
        let write = |job: &JobFolder| {
            let scripts = job.scripts()?;
            let written = output::write(run, &scripts, &selection, &|| progress.step());
            progress.above(|| terminal::edits(&scripts));
            written?;
            Ok(([scene.output.width, scene.output.height], scene.output.transparent))
        };
        let said =
            make(arguments, folder, Some(&selection), write).map_err(|error| progress.failed(&error))?;
        progress.finish();
        terminal::report(&run.report());
        terminal::result(&said);
    }
    Ok(())
}

/// Writes a job folder for the existing scripts in a folder.
fn of_scripts(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.of_scene.change_the_scene() {
        let message =
            "a folder of scripts cannot be changed: `--set`, `--view` and `--templates` want the scene";
        return Err(Failure::Usage(message.to_owned()));
    }
    let from = &arguments.scene;
    // The settings are checked before the scripts are copied, so that no job folder is written that could not be submitted.
    let frames = arguments.of_scene.frames.as_ref();
    let settings = batch::settings(from, frames, String::new(), None).map_err(|error| failed(&error))?;
    if settings.frames.is_empty() {
        let asked = frames.map(|frames| format!(" of the frames {frames}")).unwrap_or_default();
        return Err(Failure::Usage(format!("the folder `{}` has no scripts{asked}", from.display())));
    }
    let name = from.file_name().unwrap_or(from.as_os_str()).to_string_lossy();
    let copy = |job: &JobFolder| {
        let scripts = job.scripts()?;
        let copied = batch::copy_scripts(from, &scripts);
        terminal::edits(&scripts);
        copied?;
        Ok(batch::size(from))
    };
    let head = output::Manifest::read(from).map(|manifest| manifest.head);
    check_film(arguments.picture.size_or(batch::size(from).0), head.and_then(|head| head.video_rate))?;
    let said = make(arguments, &folder(arguments, &name), frames, copy);
    terminal::result(&said.map_err(|error| failed(&error))?);
    Ok(())
}

/// Checks that a film can be made from images of this size (width and height in pixels), and at the frame rate `rate` if the scene gives
/// one. The film is the last step of a job, so errors are reported before the job is written.
fn check_film(size: [u32; 2], rate: Option<f64>) -> Result<(), Failure> {
    let film = Film::new("film.mp4");
    let check = film.and_then(|film| film.check_size(size).and(rate.map_or(Ok(()), Film::check_rate)));
    check.map_err(|error| {
        terminal::report(&error.report());
        Failure::Errors
    })
}

fn failed(error: &OutputError) -> Failure {
    terminal::report(&error.report());
    Failure::Errors
}

fn folder(arguments: &Arguments, name: &str) -> PathBuf {
    arguments.output.clone().unwrap_or_else(|| Path::new("out").join(format!("{name}-job")))
}

/// Writes a job folder and returns a summary for the user. `write` puts the scripts into the folder, and returns the size of their images
/// and true if they have an alpha channel.
fn make(
    arguments: &Arguments,
    folder: &Path,
    frames: Option<&Selection>,
    write: impl FnOnce(&JobFolder) -> Result<([u32; 2], bool), OutputError>,
) -> Result<String, OutputError> {
    let job = JobFolder::open(folder)?;
    let (size, transparent) = write(&job).inspect_err(|error| {
        if let OutputError::Run(_) = error {
            job.discard();
        }
    })?;
    let options = arguments.picture.options(size, transparent).join(" ");
    let settings = batch::settings(&folder.join(SCRIPTS_FOLDER), frames, options, arguments.film.video_rate)?;
    let cpus = arguments.cpus.map(|cpus| cpus as usize);
    let chunk = batch::chunk(settings.frames.len(), cpus.unwrap_or(1));
    let chunk = arguments.chunk.map_or(chunk, |chunk| chunk as usize);
    let (limit, trust) = (arguments.limit.max(1), arguments.of_scene.trust());
    let video_quality = arguments.film.quality().unwrap_or(settings.video_quality);
    let settings = Settings { chunk, limit, trust, video_quality, ..settings };
    let requirements = Requirements {
        partition: arguments.partition.clone(),
        account: arguments.account.clone(),
        time: arguments.time.clone(),
        cpus,
        memory: arguments.mem.clone(),
        modules: arguments.modules.clone(),
    };
    let engine = match arguments.engine {
        Engine::Slurm => batch::Engine::Slurm,
        Engine::Openjd => batch::Engine::OpenJd,
    };
    let edits = job.write(&settings, engine, &requirements)?;
    let (done, all) = batch::up_to_date(folder).map_err(|error| OutputError::Io(folder.to_owned(), error))?;

    let word = shell::path(folder);
    let chunks = all.div_ceil(chunk);
    let (s, c) = (if all == 1 { "" } else { "s" }, if chunks == 1 { "" } else { "s" });
    let mut said = format!(
        "{}: {all} frame{s} in {chunks} chunk{c} of {chunk}, for {}\n",
        visible_path(folder),
        engine.name()
    );
    said.push_str(&format!("images    {done} of {all} are there\n"));
    if let Some(speed) = settings.shown.and_then(crate::render::film::Pace::in_words) {
        said.push_str(&format!("film      {} frames a second, {speed}\n", settings.pace.rate));
    }
    for name in &edits.kept {
        let new = if edits.new.contains(name) {
            format!("; what jabuka would write now is {name}.new")
        } else {
            String::new()
        };
        said.push_str(&format!("kept      {name}, as you edited it{new}\n"));
    }
    for (name, old) in &edits.moved {
        said.push_str(&format!("replaced  {name}; as you edited it, it is {old}\n"));
    }
    said.push_str(&match engine {
        batch::Engine::Slurm => format!("send      cd {word} && ./submit\n"),
        batch::Engine::OpenJd => format!("send      deadline bundle submit {word}\n"),
    });
    said.push_str(&format!("watch     jabuka status {word} --watch\n"));
    Ok(said)
}

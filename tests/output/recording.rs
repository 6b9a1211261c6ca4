//! Tests of the cache of runs: a run is simulated once and kept between commands. Whatever happens to the kept files, the scripts have the
//! same bytes.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicU64, Ordering};

use jabuka::Run;
use jabuka::cache::Cache;
use jabuka::output::{self, Folder};
use jabuka::physics::{DenseOutput, Integrator, METHODS, Method, PairCounter, State, Step, System};
use jabuka::scene::Scene;
use jabuka::simulate::{Moments, Recorded, Selection};

use crate::support::{self, contents, stderr};

/// The number of integration steps taken by the method [`COUNTED`].
static STEPS: AtomicU64 = AtomicU64::new(0);

/// The default integration method, extended to count its steps.
static COUNTED: Method = Method {
    name: "counted",
    order: 1,
    symplectic: true,
    constraints: true,
    adaptive: false,
    summary: "",
    create: || Box::new(Counted::new()),
    take_over: None,
};

struct Counted(Box<dyn Integrator>);

impl Counted {
    fn new() -> Counted {
        Counted((METHODS[0].create)())
    }
}

impl Integrator for Counted {
    fn advance(&mut self, system: &mut System<'_>, t: f64, dt: f64, state: &mut State) {
        STEPS.fetch_add(1, Ordering::Relaxed);
        self.0.advance(system, t, dt, state);
    }

    fn dense<'a>(&self, system: &mut System<'_>, step: Step<'a>) -> Box<dyn DenseOutput + 'a> {
        self.0.dense(system, step)
    }

    fn clone_box(&self) -> Box<dyn Integrator> {
        Box::new(Counted(self.0.clone_box()))
    }
}

const STARS: &str = "
    simulation = { duration = 0.2, step = 0.004 }
    [defaults.body]
    ghosts.every = 0.07
    arrows.velocity = true
    [body.star]
    repeat = 300
    shape.sphere.radius = 0.01
    location = ['i % 7', 'i % 11', 'i / 100']
    [force.all.gravitation]
    constant = 1e-3
    softening = 0.1
    [camera]
    shutter = 0.02
    samples = 4
    [view.left]
    location = [-30, 0, 0]
    look_at = [0, 0, 0]
    [view.top]
    location = [0, 30, 0.1]
    look_at = [0, 0, 0]
    ";

fn write_all(recorded: Recorded<'_>, folder: &Path) {
    let scene = recorded.scene();
    let run = Run::of(recorded).unwrap();
    let write = |run: &Run<'_>, name: &str| {
        let folder = Folder::open(&folder.join(name)).unwrap();
        output::write(run, &folder, &Selection::first(scene.simulation.timeline.frames()), &|| ()).unwrap();
    };
    write(&run, "main");
    scene.views.iter().for_each(|view| write(&run.seen_by(view).unwrap(), &view.name));
}

#[test]
fn each_step_is_taken_once_and_the_second_time_none() {
    let mut scene = Scene::parse(STARS).unwrap();
    scene.simulation.method = &COUNTED;
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::new(folder.path().join("cache"), 1 << 30).keeping_all();
    let run = || cache.run(&scene, Moments::of(&scene), &PairCounter::default(), |_| {}).unwrap();
    write_all(run(), &folder.path().join("first"));
    // There are five intervals of 40 ms, and the shutter stays open for half an interval after the last frame.
    assert_eq!(STEPS.swap(0, Ordering::Relaxed), 60);
    write_all(run(), &folder.path().join("second"));
    assert_eq!(STEPS.load(Ordering::Relaxed), 0);
    for camera in ["main", "left", "top"] {
        let [first, second] =
            ["first", "second"].map(|which| contents(&folder.path().join(which).join(camera)));
        assert!(first.len() > 2 * 6, "scripts of frames, of images with blur, and of the sequence");
        assert!(first == second, "{camera}");
    }
}

/// A temporary folder with a scene that takes a while to simulate, and with its own cache.
struct Kept {
    folder: tempfile::TempDir,
}

const CLOUD: &str = "
    simulation = { duration = 0.4, step = 0.0005 }
    [body.star]
    repeat = 150
    shape.sphere.radius = 0.01
    location = ['i % 7', 'i % 11', 'i / 50']
    [force.all.gravitation]
    constant = 1e-3
    softening = 0.1
    [camera]
    location = [0, 0, 30]
    look_at = [3, 3, 0]
    ";

impl Kept {
    fn new() -> Kept {
        let kept = Kept { folder: tempfile::tempdir().unwrap() };
        fs::write(kept.folder.path().join("scene.toml"), CLOUD).unwrap();
        kept
    }

    fn command(&self, out: &str) -> Command {
        let mut command = support::jabuka();
        command.current_dir(self.folder.path()).env("JABUKA_CACHE_DIR", self.cache());
        command.env("JABUKA_CACHE_ALL", "1").env_remove("JABUKA_CACHE_SIZE").args([
            "compile",
            "scene.toml",
            "-o",
            out,
        ]);
        command
    }

    fn compile(&self, out: &str, arguments: &[&str]) -> Vec<(String, Vec<u8>)> {
        let output = self.command(out).args(arguments).output().unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
        contents(&self.folder.path().join(out))
    }

    fn cache(&self) -> PathBuf {
        self.folder.path().join("cache")
    }

    fn files(&self, ending: &str) -> Vec<PathBuf> {
        let Ok(entries) = fs::read_dir(self.cache()) else { return Vec::new() };
        let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
        files.retain(|path| path.extension().is_some_and(|extension| extension == ending));
        files.sort();
        files
    }
}

#[test]
fn a_change_of_the_camera_takes_the_run_that_is_kept_and_gives_the_bytes_of_a_new_one() {
    let kept = Kept::new();
    kept.compile("first", &[]);
    assert_eq!(kept.files("run").len(), 1);
    let camera = ["--set", "camera.location=[0, 40, 1]", "--set", "title=Other"];
    let by_cache = kept.compile("second", &camera);
    assert_eq!(kept.files("run").len(), 1, "the run is the same");
    let anew = kept.compile("third", &[&camera[..], &["--no-cache"]].concat());
    assert!(by_cache == anew);
    kept.compile("fourth", &["--set", "simulation.step=0.0006"]);
    assert_eq!(kept.files("run").len(), 2, "another step is another run");
}

#[test]
fn what_is_damaged_is_made_again() {
    let kept = Kept::new();
    let right = kept.compile("right", &[]);
    let path = kept.files("run").remove(0);
    let whole = fs::read(&path).unwrap();
    type Damage = Box<dyn Fn(&mut Vec<u8>)>;
    let damages: [(&str, Damage); 8] = [
        ("the format", Box::new(|bytes| bytes[3] ^= 1)),
        ("the key, as of another version", Box::new(|bytes| bytes[20] ^= 1)),
        ("a bit of a page", Box::new(|bytes| bytes[5_000] ^= 4)),
        (
            "a bit in the middle",
            Box::new(|bytes| {
                let middle = bytes.len() / 2;
                bytes[middle] ^= 64;
            }),
        ),
        (
            "the description",
            Box::new(|bytes| {
                let near_the_end = bytes.len() - 60;
                bytes[near_the_end] ^= 1;
            }),
        ),
        ("the end", Box::new(|bytes| bytes.truncate(bytes.len() - 1))),
        ("half", Box::new(|bytes| bytes.truncate(bytes.len() / 2))),
        ("all", Box::new(Vec::clear)),
    ];
    for (what, damage) in damages {
        let mut bytes = whole.clone();
        damage(&mut bytes);
        fs::write(&path, bytes).unwrap();
        assert!(kept.compile("again", &[]) == right, "{what}");
        assert!(fs::read(&path).unwrap() == whole, "{what}: it is mended");
    }
}

#[test]
fn a_killed_run_leaves_nothing_that_matters_and_two_at_once_do_not_disturb_each_other() {
    let kept = Kept::new();
    let right = kept.compile("right", &["--no-cache"]);
    for delay in 1..=20 {
        let mut child = kept.command("out").spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(delay * delay));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    let mut children = ["one", "two"].map(|out| kept.command(out).spawn().unwrap());
    assert!(children.iter_mut().all(|child| child.wait().unwrap().success()));
    for out in ["one", "two"] {
        assert!(contents(&kept.folder.path().join(out)) == right);
    }
    assert!(kept.compile("out", &[]) == right);
    assert_eq!((kept.files("run").len(), kept.files("part").len()), (1, 0));
}

/// Runs a command whose cache folder is a disk of 2 MB, in its own mount namespace. Returns `None` on systems that do not allow this.
fn on_a_small_disk(kept: &Kept, command: &Command) -> Option<Output> {
    fs::create_dir_all(kept.cache()).unwrap();
    let mut small = Command::new("unshare");
    small.args(["--user", "--map-root-user", "--mount", "sh", "-c"]);
    small.arg("mount -t tmpfs -o size=2m none \"$0\" || exit 77; exec \"$@\"").arg(kept.cache());
    let output = like(small, command).output().ok()?;
    let is_refused = output.status.code() == Some(77) || stderr(&output).starts_with("unshare: ");
    (!is_refused).then_some(output)
}

/// Runs a command that cannot write files larger than 100 kB.
fn with_small_files(command: &Command) -> Output {
    let mut small = Command::new("sh");
    // Without the trap, the signal SIGXFSZ would end the command.
    small.args(["-c", "trap '' XFSZ; ulimit -f 200; exec \"$0\" \"$@\""]);
    like(small, command).output().unwrap()
}

/// Returns the command `outer` with `command` as its arguments, in the same folder and with the same environment variables.
fn like(mut outer: Command, command: &Command) -> Command {
    outer.arg(command.get_program()).args(command.get_args());
    outer.current_dir(command.get_current_dir().unwrap());
    outer.envs(command.get_envs().filter_map(|(name, value)| Some((name, value?))));
    outer
}

/// Checks that a command succeeds on a full disk without keeping its run. The recording has 2 MB, of which 1 MB stays in memory.
#[test]
fn a_full_disk_keeps_nothing_and_the_next_command_gives_the_right_bytes() {
    let kept = Kept::new();
    let long = ["--set", "simulation.duration=8", "--set", "simulation.step=0.02"];
    let right = kept.compile("right", &[&long[..], &["--no-cache"]].concat());
    let command = |out: &str| {
        let mut command = kept.command(out);
        command.args(long);
        command
    };
    // Only the cache's disk is small; the folder for temporary files has enough room.
    if let Some(output) = on_a_small_disk(&kept, &command("small")) {
        assert!(output.status.success(), "{}", stderr(&output));
        assert!(contents(&kept.folder.path().join("small")) == right);
    }
    let output = with_small_files(&command("none"));
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert_eq!(kept.files("run").len(), 0, "{}", stderr(&output));
    for (out, runs) in [("again", 1), ("kept", 1)] {
        assert!(kept.compile(out, &long) == right);
        assert_eq!((kept.files("run").len(), kept.files("part").len()), (runs, 0));
    }
}

#[test]
fn those_that_were_not_used_for_longest_go_first_and_all_can_be_cleared() {
    let kept = Kept::new();
    let scenes: Vec<Scene> = [0.0005, 0.0006, 0.0007]
        .map(|step| Scene::parse(&CLOUD.replace("step = 0.0005", &format!("step = {step}"))).unwrap())
        .into();
    let run = |cache: &Cache, scene: &Scene| {
        cache.run(scene, Moments::of(scene), &PairCounter::default(), |_| {}).unwrap();
    };
    let cache = Cache::new(kept.cache(), 1 << 30).keeping_all();
    run(&cache, &scenes[0]);
    let size = cache.holding().unwrap().bytes;
    run(&cache, &scenes[1]);
    let [older, newer] =
        [0, 1].map(|scene| cache.find(&scenes[scene], &Moments::of(&scenes[scene])).is_some());
    assert!(older && newer);
    // File times are too coarse to order the runs, so the test sets the time of use explicitly.
    let path = |scene: &Scene| {
        let before = kept.files("run");
        cache.forget(scene, &Moments::of(scene));
        let gone = before.into_iter().find(|path| !path.exists()).unwrap();
        run(&cache, scene);
        gone
    };
    let (first, second) = (path(&scenes[0]), path(&scenes[1]));
    let set = |path: &Path, seconds: u64| {
        let time = std::time::SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(seconds);
        fs::File::options().append(true).open(path).unwrap().set_modified(time).unwrap();
    };
    set(&first, 2_000);
    set(&second, 1_000);
    let small = Cache::new(kept.cache(), size * 5 / 2).keeping_all();
    run(&small, &scenes[2]);
    assert!(first.exists() && !second.exists(), "the one that was not used for longest is gone");
    assert_eq!(small.holding().unwrap().runs, 2);

    let said = |arguments: &[&str]| {
        let mut command = support::jabuka();
        command
            .env("JABUKA_CACHE_DIR", kept.cache())
            .env_remove("JABUKA_CACHE_SIZE")
            .arg("cache")
            .args(arguments);
        support::stdout(&command.output().unwrap())
    };
    assert!(said(&[]).contains(": 2 runs, "), "{}", said(&[]));
    assert!(said(&["--clear"]).contains("2 runs, ") && kept.files("run").is_empty());
    assert!(said(&[]).ends_with(": 0 runs, 0 B\n"), "{}", said(&[]));
}

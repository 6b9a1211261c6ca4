//! Tests that an interrupted run continues from its last checkpoint and gives the same bytes.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use crate::support::{contents, jabuka, signal, stderr};

/// A scene with balls, boxes and a pendulum. Some bodies appear while others disappear, and an open shutter needs moments between frames.
const PILE: &str = "
    [simulation]
    duration = 2
    gravity = [0, -9.81, 0]
    contacts = 'time-stepping'
    [defaults.body]
    friction = 0.4
    [body.ball]
    repeat = 40
    shape.sphere.radius = 0.1
    location = ['uniform(-0.4, 0.4)', '0.3 + 0.21*i', 'uniform(-0.4, 0.4)']
    start = 'if(i > 30, 0.5, 0)'
    end = 'if(i < 5, 1.1, 1e9)'
    [body.box]
    repeat = 20
    shape.box.size = [0.2, 0.1, 0.15]
    location = ['uniform(-0.4, 0.4)', '0.4 + 0.28*i', 2]
    orientation = ['uniform(0, 90)', 0, 'uniform(0, 90)']
    ghosts.every = 0.03
    [body.bob]
    shape.sphere.radius = 0.2
    location = [1, 1, 2]
    [joint.arm.hinge]
    between = [[0, 1.5, 2], 'bob']
    at = [0, 1.5, 2]
    axis = [0, 0, 1]
    [label.hits]
    text = '${bob.impacts} ${bob.impacts.ground} ${box[0].speed}'
    ";

struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Place {
        let place = Place(tempfile::tempdir().unwrap());
        fs::write(place.scene(), PILE).unwrap();
        place
    }

    fn scene(&self) -> PathBuf {
        self.0.path().join("pile.toml")
    }

    fn cache(&self) -> PathBuf {
        self.0.path().join("cache")
    }

    /// Returns a command that compiles [`PILE`]. It writes a checkpoint after each frame, and caches even a short run.
    fn compile(&self, out: &Path, threads: &str) -> Command {
        let mut command = jabuka();
        command
            .env_remove("JABUKA_CACHE_SIZE")
            .env("JABUKA_CACHE_DIR", self.cache())
            .env("JABUKA_CHECKPOINT_SECONDS", "0")
            .env("JABUKA_CACHE_ALL", "1")
            .env("RAYON_NUM_THREADS", threads)
            .arg("compile")
            .arg(self.scene())
            .arg("-o")
            .arg(out);
        command
    }

    fn start(&self, out: &Path) -> Child {
        self.compile(out, "2").stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    }

    /// Compiles the scene without interruption, empties the cache, and returns the names and bytes of the scripts.
    fn undisturbed(&self) -> Vec<(String, Vec<u8>)> {
        let out = self.0.path().join("undisturbed");
        assert!(self.compile(&out, "2").output().unwrap().status.success());
        fs::remove_dir_all(self.cache()).unwrap();
        contents(&out)
    }

    /// Returns the paths of the cache's files with this extension.
    fn files(&self, ending: &str) -> Vec<PathBuf> {
        let Ok(folder) = fs::read_dir(self.cache()) else { return Vec::new() };
        let paths = folder.map(|entry| entry.unwrap().path());
        paths.filter(|path| path.extension().is_some_and(|found| found == ending)).collect()
    }

    /// Returns the size of the largest partial recording that has a checkpoint, bytes. It grows during a run.
    fn saved(&self) -> u64 {
        let sizes = self.files("part").into_iter().filter_map(|path| {
            path.with_extension("checkpoint").exists().then(|| fs::metadata(path).ok())?
        });
        sizes.map(|about| about.len()).max().unwrap_or(0)
    }

    /// Kills a run as soon as its partial recording with a checkpoint is larger than `before` bytes.
    fn kill_behind(&self, child: &mut Child, before: u64) {
        while child.try_wait().unwrap().is_none() && self.saved() <= before {
            sleep(Duration::from_micros(200));
        }
        child.kill().unwrap();
        child.wait().unwrap();
    }
}

#[test]
fn killed_at_ten_moments_it_goes_on_to_the_same_bytes() {
    let place = Place::new();
    let expected = place.undisturbed();
    let out = place.0.path().join("out");
    let mut killed = 0;
    for _ in 0..10 {
        let before = place.saved();
        place.kill_behind(&mut place.start(&out), before + 10_000);
        killed += usize::from(place.saved() > before);
    }
    assert!(killed >= 5, "only {killed} of 10 runs were killed behind the checkpoint before");
    let output = place.compile(&out, "8").output().unwrap();
    assert!(stderr(&output).contains("it went on from t = "), "{}", stderr(&output));
    assert!(expected == contents(&out));
    assert!(["part", "checkpoint", "saving"].iter().all(|ending| place.files(ending).is_empty()));
    assert_eq!(place.files("run").len(), 1);
}

/// Checks that two processes use separate recordings and checkpoints. A later process continues from those that no running process uses.
#[test]
fn two_processes_at_once_do_not_harm_each_other() {
    let place = Place::new();
    let expected = place.undisturbed();
    let [one, two] = ["one", "two"].map(|name| place.0.path().join(name));
    let mut first = place.start(&one);
    // Stop the first process in the middle of its run, however busy the machine is, while the second process completes its own run.
    while place.saved() <= 20_000 {
        assert!(first.try_wait().unwrap().is_none(), "the first run has ended");
        sleep(Duration::from_micros(200));
    }
    signal("STOP", first.id());
    assert!(place.start(&two).wait().unwrap().success());
    assert!(expected == contents(&two));
    first.kill().unwrap();
    first.wait().unwrap();
    fs::remove_file(&place.files("run")[0]).unwrap();
    let output = place.compile(&one, "1").output().unwrap();
    assert!(stderr(&output).contains("it went on from t = "), "{}", stderr(&output));
    assert!(expected == contents(&one));
    assert!(["part", "checkpoint"].iter().all(|ending| place.files(ending).is_empty()));
}

#[test]
fn what_is_damaged_is_simulated_again() {
    let place = Place::new();
    let expected = place.undisturbed();
    let out = place.0.path().join("out");
    for ending in ["part", "checkpoint"] {
        place.kill_behind(&mut place.start(&out), 20_000);
        let [path] = &place.files(ending)[..] else { panic!("one file ends with {ending}") };
        let mut bytes = fs::read(path).unwrap();
        bytes[5000] ^= 1;
        fs::write(path, bytes).unwrap();
        let output = place.compile(&out, "2").output().unwrap();
        assert!(!stderr(&output).contains("went on"), "{ending}: {}", stderr(&output));
        assert!(expected == contents(&out), "{ending}");
        fs::remove_dir_all(place.cache()).unwrap();
    }
}

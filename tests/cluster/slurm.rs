//! Tests on a real Slurm with two nodes, including failures of a node and of the controller.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Output, Stdio};
use std::time::Duration;

use super::hostile::{assert_nothing_was_run, hostile_job};
use super::job::{Job, film, scene, wait_until};
use super::support::{jabuka, root, stderr, stdout};

/// The time limit for each wait. A step that takes seconds may take minutes on a busy machine.
const LONG: Duration = Duration::from_secs(600);

/// A running Slurm cluster on this machine. Dropping it shuts the cluster down.
struct Slurm {
    folder: tempfile::TempDir,
    process: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl Slurm {
    fn up() -> Slurm {
        let folder = tempfile::Builder::new().prefix("slurm").tempdir().unwrap();
        let mut process = Command::new(root().join("tests/cluster/slurm"))
            .arg(folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let input = process.stdin.take();
        let output = BufReader::new(process.stdout.take().unwrap());
        let mut slurm = Slurm { folder, process, input, output };
        slurm.expect("ready\n");
        slurm
    }

    fn expect(&mut self, line: &str) {
        let mut said = String::new();
        self.output.read_line(&mut said).unwrap();
        assert_eq!(said, line);
    }

    /// Tells the cluster to cause or to end a failure, such as `down` for the controller, and waits for its reply.
    fn order(&mut self, order: &str) {
        self.input.as_mut().unwrap().write_all(format!("{order}\n").as_bytes()).unwrap();
        self.expect("ok\n");
    }

    fn command(&self, command: &mut Command) -> Output {
        command.env("SLURM_CONF", self.folder.path().join("slurm.conf")).output().unwrap()
    }

    /// Runs in this folder the command that `jabuka batch` suggested, and so submits the job.
    fn send(&self, command: &str, folder: &std::path::Path) -> Output {
        self.command(Command::new("bash").args(["-c", command]).current_dir(folder))
    }

    fn submit(&self, job: &Job) -> String {
        let output = self.command(&mut job.command("submit"));
        assert!(output.status.success(), "{}{}", stdout(&output), stderr(&output));
        stdout(&output)
    }

    /// Returns the jobs in Slurm's queue. On a busy machine `squeue` may fail; a failure does not count as an empty queue, so it is
    /// repeated.
    fn queue(&self) -> String {
        let mut queue = String::new();
        wait_until("Slurm says what is in the queue", LONG, || {
            let output = self.command(Command::new("squeue").args(["--noheader", "--array"]));
            queue = stdout(&output);
            output.status.success()
        });
        queue
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        drop(self.input.take());
        let _ = self.process.wait();
    }
}

#[test]
fn a_hostile_scene_is_rendered_by_the_cluster_and_nothing_in_it_is_run() {
    let folder = tempfile::tempdir().unwrap();
    let refused = ["--engine", "slurm", "--partition", "all\n#SBATCH --wrap=touch"];
    let output = jabuka().arg("batch").args(refused).arg("x.toml").output().unwrap();
    assert_eq!(output.status.code(), Some(2), "a partition is one word");
    let (job, said) =
        hostile_job(folder.path(), 3, &["--engine", "slurm", "--partition", "all", "--chunk", "2"]);
    let command = said.lines().find_map(|line| line.strip_prefix("send      ")).unwrap();
    let slurm = Slurm::up();
    let output = slurm.send(command, folder.path());
    assert!(output.status.success(), "{command}\n{}{}", stdout(&output), stderr(&output));
    assert!(first_line(&stdout(&output)).starts_with("sent 3 frames in 2 chunks: job "));
    // A second submission finds the jobs of the first in the queue, and submits nothing.
    let again = slurm.send(command, folder.path());
    assert!(stdout(&again).ends_with("nothing was sent\n"), "{}{}", stdout(&again), stderr(&again));
    wait_until("the film is made", LONG, || job.join("film.mp4").exists());
    wait_until("the queue is empty", LONG, || slurm.queue().is_empty());
    assert_eq!(film(&job.join("film.mp4")).0, 3);
    assert_nothing_was_run(folder.path());
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

#[test]
fn a_node_dies_on_the_way_and_the_film_is_made() {
    let job = Job::new(&scene(240), &["--engine", "slurm", "--chunk", "12"]);
    let mut slurm = Slurm::up();
    assert!(first_line(&slurm.submit(&job)).starts_with("sent 240 frames in 20 chunks: job "));
    let said = slurm.submit(&job);
    assert!(said.ends_with(" in the queue already\nnothing was sent\n"), "{said}");

    wait_until("some images are there", LONG, || job.images().len() >= 24);
    slurm.order("kill n1");
    wait_until("all images are there", LONG, || job.missing().is_empty());
    wait_until("the film is made", LONG, || job.status().0.contains("film     made"));
    assert_eq!(job.status(), ("done     240 of 240\nfilm     made\n".to_owned(), true));
    // The images have 65 by 37 pixels. This pixel format needs even sizes, so the film has 64 by 36.
    assert_eq!(film(&job.join("film.mp4")), (240, "64,36,yuv420p".to_owned()));

    wait_until("the queue is empty", LONG, || slurm.queue().is_empty());
    assert_eq!(slurm.submit(&job), "all images and the film are there: nothing was sent\n");
    assert_eq!(slurm.queue(), "");
    assert_eq!(job.leftovers(), [""; 0], "what the dead node has left is gone");
    let logs = super::job::names(&job.join("logs"));
    assert!(logs.len() >= 20, "every chunk has a log: {logs:?}");
}

#[test]
fn a_broken_frame_is_named_and_after_its_repair_only_it_is_sent() {
    let job = Job::new(&scene(20), &["--engine", "slurm", "--chunk", "6"]);
    let mended = job.read("scripts/frame_0013.pov");
    let line = job.break_frame(13);
    let mut slurm = Slurm::up();
    assert!(slurm.submit(&job).starts_with("sent 20 frames in 4 chunks: job "));
    wait_until("the others are there and the queue is empty", LONG, || {
        job.missing() == "13" && slurm.queue().is_empty()
    });
    let (said, complete) = job.status();
    assert!(
        !complete && said.starts_with("done     19 of 20\nfailed   1\n  frame 13: frame_0013.pov:"),
        "{said}"
    );
    assert!(said.contains(&format!("frame_0013.pov:{line}: ")) && said.contains("(body `ball`)"), "{said}");
    assert!(!job.join("film.mp4").exists(), "a film waits for all frames");

    // Without the controller the state of the queue is unknown, so nothing is submitted. The controller saves its state every five
    // seconds.
    std::thread::sleep(Duration::from_secs(7));
    slurm.order("down");
    let output = slurm.command(job.command("submit").env("SLURM_CLIENT_TIMEOUT", "1"));
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("nothing was sent"), "{}", stderr(&output));
    slurm.order("up");
    // If the controller died before it saved its latest state, it runs the jobs that have ended since then again. This does no harm but
    // takes minutes, and the frame stays in the queue until these jobs end.
    wait_until("the controller is back and the queue is empty", LONG, || slurm.queue().is_empty());
    assert_eq!(job.missing(), "13", "it is not mended yet");

    std::fs::write(job.join("scripts/frame_0013.pov"), mended).unwrap();
    let said = slurm.submit(&job);
    assert!(said.starts_with("sent 1 frame in 1 chunk: job "), "{said}");
    wait_until("the film is made", LONG, || job.status().0.contains("film     made"));
    assert_eq!(film(&job.join("film.mp4")).0, 20);

    // If only the film is missing, only the film is submitted.
    wait_until("the queue is empty", LONG, || slurm.queue().is_empty());
    std::fs::remove_file(job.join("film.mp4")).unwrap();
    let said = slurm.submit(&job);
    assert!(said.starts_with("sent the film: job ") && said.lines().count() == 1, "{said}");
    wait_until("the film is made again", LONG, || job.join("film.mp4").exists());
}

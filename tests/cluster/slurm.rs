//! A real Slurm of two nodes, and faults.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Output, Stdio};
use std::time::Duration;

use super::job::{Job, film, scene, wait_until};
use super::support::{root, stderr, stdout};

/// What takes seconds may take minutes on a machine that is busy.
const LONG: Duration = Duration::from_secs(600);

/// A Slurm that ends with this.
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

    /// Has a fault happen, or mends it.
    fn order(&mut self, order: &str) {
        self.input.as_mut().unwrap().write_all(format!("{order}\n").as_bytes()).unwrap();
        self.expect("ok\n");
    }

    fn command(&self, command: &mut Command) -> Output {
        command.env("SLURM_CONF", self.folder.path().join("slurm.conf")).output().unwrap()
    }

    fn submit(&self, job: &Job) -> String {
        let output = self.command(&mut job.command("submit"));
        assert!(output.status.success(), "{}{}", stdout(&output), stderr(&output));
        stdout(&output)
    }

    /// What is in the queue.
    fn queue(&self) -> String {
        stdout(&self.command(Command::new("squeue").args(["--noheader", "--array"])))
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        drop(self.input.take());
        let _ = self.process.wait();
    }
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
    assert!(said.ends_with("frames are in the queue already\nnothing was sent\n"), "{said}");

    wait_until("some images are there", LONG, || job.images().len() >= 24);
    slurm.order("kill n1");
    wait_until("all images are there", LONG, || job.missing().is_empty());
    wait_until("the film is made", LONG, || job.status().0.contains("film     made"));
    assert_eq!(job.status(), ("done     240 of 240\nfilm     made\n".to_owned(), true));
    // 65 by 37 pixels are no even size.
    assert_eq!(film(&job.join("film.mp4")), (240, "64,36,yuv420p".to_owned()));

    wait_until("the queue is empty", LONG, || slurm.queue().is_empty());
    assert_eq!(slurm.submit(&job), "all images and the film are there: nothing was sent\n");
    assert_eq!(slurm.queue(), "");
    assert_eq!(job.leftovers(), [""; 0], "what the dead node has left is gone");
    let logs = super::job::names(&job.join("logs"));
    assert!(logs.len() >= 20, "every chunk has a log: {logs:?}");
}

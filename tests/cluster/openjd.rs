//! Tests of the job bundle for Open Job Description, checked and run by `openjd`, its reference implementation.

use std::process::Command;

use super::hostile::{assert_nothing_was_run, hostile_job};
use super::job::{Job, film, scene};
use super::support::{root, stderr, stdout};

fn openjd(job: &Job, arguments: &[&str]) -> String {
    let output =
        Command::new(root().join("tests/cluster/openjd")).args(arguments).current_dir(job.path()).output();
    let output = output.unwrap();
    assert!(output.status.success(), "{arguments:?}\n{}{}", stdout(&output), stderr(&output));
    stdout(&output)
}

#[test]
fn openjd_checks_and_runs_the_bundle() {
    let job = Job::new(&scene(7), &["--engine", "openjd", "--chunk", "3"]);
    openjd(&job, &["check", "template.yaml"]);
    let rendered = openjd(&job, &["run", "template.yaml", "--step", "Render", "-p", "Frames=1-2,5"]);
    assert_eq!(job.missing(), "0,3-4,6", "{rendered}");
    openjd(&job, &["run", "template.yaml", "--step", "Render"]);
    assert_eq!(job.missing(), "");
    openjd(&job, &["run", "template.yaml", "--step", "Video"]);
    assert_eq!(film(&job.join("film.mp4")).0, 7);
    assert_eq!(job.status(), ("done     7 of 7\nfilm     made\n".to_owned(), true));
}

#[test]
fn a_hostile_scene_is_a_bundle_and_nothing_in_it_is_run() {
    let folder = tempfile::tempdir().unwrap();
    let (job, _) = hostile_job(folder.path(), 2, &["--engine", "openjd"]);
    for arguments in
        [&["check", "template.yaml"][..], &["run", "template.yaml", "--step", "Render", "-p", "Frames=1"]]
    {
        let mut command = Command::new(root().join("tests/cluster/openjd"));
        let output = command.args(arguments).current_dir(&job).output().unwrap();
        assert!(output.status.success(), "{arguments:?}\n{}{}", stdout(&output), stderr(&output));
    }
    assert!(job.join("images/frame_0001.png").exists());
    assert_nothing_was_run(folder.path());
}

#[test]
fn a_bundle_says_that_a_frame_failed() {
    let job = Job::new(&scene(3), &["--engine", "openjd"]);
    job.break_frame(1);
    let output = Command::new(root().join("tests/cluster/openjd"))
        .args(["run", "template.yaml", "--step", "Render"])
        .current_dir(job.path())
        .output()
        .unwrap();
    assert!(!output.status.success());
    assert!(stdout(&output).contains("frame_0001 failed: frame_0001.pov:"), "{}", stdout(&output));
    assert_eq!(job.missing(), "1");
}

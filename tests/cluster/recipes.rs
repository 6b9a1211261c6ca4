//! Tests that run the commands and jobs shown in `docs/cluster.md`.

use std::fs;
use std::process::Command;

use super::job::{Job, film, scene};
use super::support::{root, stderr, stdout};

/// Returns the code blocks of one language below a heading of `docs/cluster.md`.
fn blocks(heading: &str, language: &str) -> Vec<String> {
    let page = fs::read_to_string(root().join("docs/cluster.md")).unwrap();
    let section = page.split(&format!("\n## {heading}\n")).nth(1).unwrap_or_else(|| panic!("no {heading}"));
    let section = section.split("\n## ").next().unwrap();
    let fence = format!("```{language}\n");
    section.split(&fence).skip(1).map(|block| block.split("```").next().unwrap().to_owned()).collect()
}

#[test]
fn gnu_parallel_renders_the_film_and_repeats_what_failed() {
    let job = Job::new(&scene(8), &["--engine", "slurm", "--chunk", "3"]);
    let recipe = &blocks("GNU parallel", "sh")[0];
    let run = || {
        let output = Command::new("bash").args(["-ec", recipe]).current_dir(job.path()).output().unwrap();
        (output.status.success(), stdout(&output) + &stderr(&output))
    };
    let mended = job.read("scripts/frame_0004.pov");
    job.break_frame(4);
    let (done, said) = run();
    assert!(!done && job.missing() == "4", "{said}");
    fs::write(job.join("scripts/frame_0004.pov"), mended).unwrap();
    let (done, said) = run();
    assert!(done, "{said}");
    assert_eq!(said.matches("rendered in").count(), 1, "{said}");
    assert_eq!(film(&job.join("film.mp4")).0, 8);
}

#[test]
fn the_jobs_of_the_page_can_be_written() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("film.toml"), scene(2)).unwrap();
    let bin = std::path::Path::new(env!("CARGO_BIN_EXE_jabuka")).parent().unwrap();
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
    for heading in ["Slurm", "Open Job Description"] {
        let command = &blocks(heading, "sh")[0];
        let output =
            Command::new("bash").args(["-ec", command]).env("PATH", &path).current_dir(&folder).output();
        let output = output.unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
    }
}

#[test]
fn the_job_of_kubernetes_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let yaml = folder.path().join("job.yaml");
    fs::write(&yaml, &blocks("Kubernetes", "yaml")[0]).unwrap();
    let program = "import json, sys, yaml; print(json.dumps(yaml.safe_load(open(sys.argv[1]))))";
    let python = Command::new(root().join("tests/cluster/openjd"))
        .args(["--python", "-c", program])
        .arg(&yaml)
        .output();
    let job: serde_json::Value = serde_json::from_str(&stdout(&python.unwrap())).unwrap();
    assert_eq!((&job["apiVersion"], &job["kind"]), (&"batch/v1".into(), &"Job".into()));
    let spec = &job["spec"];
    assert_eq!((&spec["completionMode"], &spec["completions"]), (&"Indexed".into(), &24.into()));
    let pod = &spec["template"]["spec"];
    // Kubernetes requires this value for a job with `backoffLimitPerIndex`.
    assert_eq!(pod["restartPolicy"], "Never");
    let container = &pod["containers"][0];
    assert_eq!(container["volumeMounts"][0]["name"], pod["volumes"][0]["name"]);

    // Run the command of the pod's container here, for each index of the job.
    let job = Job::new(&scene(5), &["--engine", "openjd", "--chunk", "3"]);
    let command: Vec<&str> =
        container["command"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
    let pod = |index: &str| {
        let mut run = Command::new(command[0]);
        run.args(&command[1..]).env("JOB_COMPLETION_INDEX", index).current_dir(job.path());
        run.status().unwrap().success()
    };
    assert!(pod("1"));
    assert_eq!(job.missing(), "0-2");
}

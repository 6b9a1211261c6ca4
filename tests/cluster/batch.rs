//! Tests of `jabuka batch` and `jabuka status` that need no cluster software.

use std::fs;

use super::job::{Job, scene};
use super::support::{compile, jabuka, stderr, stdout};

const SLURM: [&str; 2] = ["--engine", "slurm"];

#[test]
fn a_scene_that_is_changed_keeps_the_images_that_are_up_to_date() {
    // The ball spins in place. A ball that moved farther in the longer film would change camera, lights and ground, and so every script.
    let scene = |frames| {
        scene(frames)
            .replace("velocity = [1, 0, 0]", "angular_velocity = [0, 3, 0]\nmaterial.like = 'beach_ball'")
    };
    let job = Job::new(&scene(3), &SLURM);
    assert!(job.chunk(&["0", "2"]).status.success());
    // The longer film begins with the same frames.
    let longer = scene(5);
    let output = job.batch(&longer, &SLURM);
    assert!(stdout(&output).contains("\nimages    3 of 5 are there\n"), "{}", stdout(&output));
    assert_eq!(job.missing(), "3-4");
    // Images of another size must be rendered again.
    let output = job.batch(&longer, &[&SLURM[..], &["--size", "32x18"]].concat());
    assert!(stdout(&output).contains("\nimages    0 of 5 are there\n"), "{}", stdout(&output));
    assert_eq!(job.missing(), "0-4");
    let output = job.batch(&longer, &[&SLURM[..], &["--quality", "draft", "--frames", "1-3"]].concat());
    assert!(output.status.success());
    assert_eq!(job.missing(), "1-3");
    assert!(job.read("job.conf").contains("\nOPTIONS=+W65 +H37 -A +Q9\n"));
}

#[test]
fn the_lines_of_a_user_stay() {
    let job = Job::new(&scene(2), &[&SLURM[..], &["--partition", "long", "--cpus", "4"]].concat());
    let lines = job.read("render.sbatch");
    assert!(lines.contains("\n#SBATCH --partition=long\n##SBATCH --account=my_group\n"), "{lines}");
    assert!(lines.contains("\n#SBATCH --cpus-per-task=4\n"), "{lines}");
    let mine = lines.replace("##SBATCH --account=my_group", "#SBATCH --account=physics");
    fs::write(job.join("render.sbatch"), &mine).unwrap();
    let output = job.batch(&scene(2), &[&SLURM[..], &["--time", "02:00:00"]].concat());
    let said = stdout(&output);
    assert!(
        said.contains(
            "kept      render.sbatch, as you edited it; what jabuka would write now is render.sbatch.new\n"
        ),
        "{said}"
    );
    assert_eq!(job.read("render.sbatch"), mine);
    assert!(job.read("render.sbatch.new").contains("\n#SBATCH --time=02:00:00\n"));
    assert!(!said.contains("video.sbatch"), "{said}");
}

#[test]
fn a_folder_of_scripts_makes_the_same_job_as_its_scene() {
    let folder = tempfile::tempdir().unwrap();
    let (toml, scripts, job) =
        (folder.path().join("x.toml"), folder.path().join("scripts"), folder.path().join("job"));
    fs::write(&toml, scene(3)).unwrap();
    compile(&toml, &scripts, &[]);
    let batch = |arguments: &[&str]| {
        jabuka()
            .args(["batch", "--engine", "slurm"])
            .arg(&scripts)
            .arg("-o")
            .arg(&job)
            .args(arguments)
            .output()
            .unwrap()
    };
    assert!(batch(&[]).status.success());
    let of_scene = Job::new(&scene(3), &SLURM);
    for name in ["job.conf", "render-chunk", "scripts/frame_0002.pov", "scripts/manifest.json"] {
        assert_eq!(fs::read_to_string(job.join(name)).unwrap(), of_scene.read(name), "{name}");
    }
    // The second compilation has fewer frames, and removes the scripts of the last ones.
    fs::write(&toml, scene(2)).unwrap();
    compile(&toml, &scripts, &[]);
    assert!(stdout(&batch(&[])).contains("images    0 of 2 are there"));
    assert!(!job.join("scripts/frame_0002.pov").exists());
    let output = batch(&["--frames", "7-9"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no scripts of the frames 7-9"), "{}", stderr(&output));
    let output = batch(&["--set", "simulation.gravity=[0,-1,0]"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("want the scene"), "{}", stderr(&output));
}

#[test]
fn a_folder_of_somebody_else_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("thesis.txt"), "years of work").unwrap();
    let toml = tempfile::Builder::new().suffix(".toml").tempfile().unwrap();
    fs::write(toml.path(), scene(2)).unwrap();
    let output =
        jabuka().args(["batch", "--engine", "slurm"]).arg(toml.path()).arg("-o").arg(folder.path()).output();
    let output = output.unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).starts_with("error[folder-not-ours]"), "{}", stderr(&output));
    for argument in [["--chunk", "0"], ["--size", "5"], ["--partition", "a\nb"], ["--modules", "$(x)"]] {
        let output = jabuka().args(["batch", "--engine", "slurm"]).arg(toml.path()).args(argument).output();
        assert_eq!(output.unwrap().status.code(), Some(2), "{argument:?}");
    }
}

#[test]
fn a_folder_without_scripts_is_no_job() {
    let folder = tempfile::tempdir().unwrap();
    let (scripts, job) = (folder.path().join("scripts"), folder.path().join("job"));
    fs::create_dir(&scripts).unwrap();
    let batch = || {
        let output =
            jabuka().args(["batch", "--engine", "slurm"]).arg(&scripts).arg("-o").arg(&job).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        assert!(!job.exists(), "nothing is begun");
        stderr(&output)
    };
    let said = batch();
    assert!(said.starts_with("error[no-scripts]") && said.contains("`jabuka compile` writes them"), "{said}");
    fs::write(folder.path().join("x.toml"), scene(2)).unwrap();
    compile(&folder.path().join("x.toml"), &scripts, &[]);
    let manifest = fs::read_to_string(scripts.join("manifest.json")).unwrap();
    fs::write(scripts.join("manifest.json"), manifest.replace("\"complete\"", "\"writing\"")).unwrap();
    let said = batch();
    assert!(said.starts_with("error[incomplete-scripts]") && said.contains("`jabuka compile`"), "{said}");
}

#[test]
fn settings_that_cannot_be_read_are_said_with_their_line() {
    let job = Job::new(&scene(2), &SLURM);
    fs::write(job.join("local.conf"), "# mine\nLIMIT 5\n").unwrap();
    let output = jabuka().arg("status").arg(job.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("`local.conf`, line 2: expected KEY=value"), "{}", stderr(&output));
    for name in ["render-chunk", "render-video", "submit"] {
        let output = job.command(name).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        let said = format!("{name}: local.conf, line 2: expected KEY=value, found `LIMIT 5`\n");
        assert_eq!(stderr(&output), said);
    }
}

#[test]
fn every_view_has_a_job_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let toml = folder.path().join("x.toml");
    fs::write(&toml, scene(2) + "[view.top]\nlocation = [0, 10, 0]\n").unwrap();
    let mut command = jabuka();
    command.args(["batch", "--engine", "openjd", "--view", "all"]).arg(&toml);
    let output = command.arg("-o").arg(folder.path().join("job")).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(
        folder.path().join("job/template.yaml").exists()
            && folder.path().join("job-top/template.yaml").exists()
    );
}

#[test]
fn status_reads_the_folder_of_a_render_too() {
    let folder = tempfile::tempdir().unwrap();
    let (toml, out) = (folder.path().join("x.toml"), folder.path().join("out"));
    fs::write(&toml, scene(3)).unwrap();
    let status = || jabuka().args(["status", "--format", "json"]).arg(&out).output().unwrap();
    assert_eq!(status().status.code(), Some(1));
    assert!(stderr(&status()).contains("it holds no scripts that jabuka wrote"), "{}", stderr(&status()));
    compile(&toml, &out, &[]);
    let json = |text: &str| serde_json::from_str::<serde_json::Value>(text).unwrap();
    assert_eq!(json(&stdout(&status()))["missing"], serde_json::json!([0, 1, 2]));

    // Take the images of a job instead: they are equal to those that a render makes.
    let job = Job::new(&scene(3), &SLURM);
    assert!(job.chunk(&["0", "1"]).status.success());
    fs::rename(job.join("images"), out.join("images")).unwrap();
    let output = status();
    let value = json(&stdout(&output));
    assert_eq!((&value["done"], &value["missing"]), (&serde_json::json!([0, 1]), &serde_json::json!([2])));
    assert_eq!((&value["frames"], &value["complete"]), (&serde_json::json!(3), &serde_json::json!(false)));
    assert_eq!(value["film"], serde_json::Value::Null);
    assert_eq!(output.status.code(), Some(1));
}

//! Tests of `render-chunk`, the script of a job folder that every cluster engine calls to render a chunk of frames.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::{Child, Command};
use std::time::Duration;

use jabuka::render::{Files, Record};

use super::job::{Job, film, names, scene, wait_until};
use super::support::{jabuka, stderr, stdout};

const SLURM: [&str; 2] = ["--engine", "slurm"];
const LONG: Duration = Duration::from_secs(300);

#[test]
fn a_chunk_is_rendered_once_and_jabuka_reads_its_records() {
    let job = Job::new(&scene(8), &[&SLURM[..], &["--chunk", "5"]].concat());
    assert_eq!(stdout(&job.chunk(&["--chunks"])), "2\n");
    assert_eq!(job.missing(), "0-7");
    let output = job.chunk(&["--chunk", "1"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(job.images(), ["frame_0005.png", "frame_0006.png", "frame_0007.png"]);
    assert_eq!(job.missing(), "0-4");
    assert_eq!(job.status(), ("done     3 of 8\nmissing  5: 0-4\nfilm     not made\n".to_owned(), false));

    // The record that the bash script writes must equal, byte for byte, the record that the library expects.
    let version = Command::new("povray").arg("--version").output().unwrap();
    let version = stderr(&version) + &stdout(&version);
    let version = version.split("POV-Ray ").nth(1).unwrap().split_whitespace().next().unwrap();
    let script = job.join("scripts/frame_0006.pov");
    let files = Files::read(&[]).unwrap();
    let record = Record::expected(&script, 6, &files, "+W65 +H37 +A0.1 +AM1 +R3", version).unwrap();
    let record = record.of_image(&job.join("images/frame_0006.png")).unwrap();
    assert_eq!(job.read("images/.jabuka/frame_0006.txt"), record.to_text());

    // jabuka gives the same bytes, since neither keeps the date of rendering.
    let output = jabuka()
        .args(["render", "--frames", "6", "-o"])
        .args([job.join("mine"), job.join("scripts")])
        .output();
    assert!(output.unwrap().status.success());
    assert!(
        fs::read(job.join("mine/frame_0006.png")).unwrap()
            == fs::read(job.join("images/frame_0006.png")).unwrap()
    );

    let before = fs::metadata(job.join("images/frame_0006.png")).unwrap().modified().unwrap();
    assert!(job.chunk(&["0", "7"]).status.success());
    assert_eq!(fs::metadata(job.join("images/frame_0006.png")).unwrap().modified().unwrap(), before);
    assert_eq!(job.missing(), "");
    assert_eq!(job.leftovers(), [""; 0]);
    assert!(job.status().1);

    // Three images must be rendered again: a truncated one, one without a record, and one whose script has changed.
    fs::write(job.join("images/frame_0001.png"), "cut off").unwrap();
    fs::remove_file(job.join("images/.jabuka/frame_0003.txt")).unwrap();
    let text = job.read("scripts/frame_0005.pov");
    fs::write(job.join("scripts/frame_0005.pov"), text.replace("sphere { <0.2,", "sphere { <0.25,")).unwrap();
    assert_eq!(job.missing(), "1,3,5");
    let output = job.chunk(&["0-9:2,1"]);
    assert!(output.status.success() && stdout(&output).contains("1 made now"), "0, 2, 4, 6 and 1");
    assert_eq!(job.missing(), "3,5");
}

#[test]
fn scripts_that_know_their_number_see_it() {
    // The background is black up to frame 1 and white from frame 2 on, depending on the frame's number and clock.
    let sdl = "background { rgb (frame_number > 1) * (clock > 0.07) } // clock of a longer film";
    let text = format!("environment = 'space'\n[povray]\nsdl = '{sdl}'\n") + &scene(4);
    for layout in ["self-contained", "shared"] {
        let text = text.replace("[output]", &format!("[output]\nlayout = '{layout}'"));
        let job = Job::new(&text, &SLURM);
        let output = job.chunk(&["0", "3"]);
        assert!(output.status.success(), "{}{}", stdout(&output), stderr(&output));
        let corner = |frame: usize| {
            let file = fs::File::open(job.join(format!("images/frame_{frame:04}.png"))).unwrap();
            let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
            let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut pixels).unwrap();
            pixels[0]
        };
        assert_eq!([0, 1, 2, 3].map(corner), [0, 0, 255, 255], "{layout}");
        assert!(job.read("images/.jabuka/frame_0002.txt").contains("\nframe 2\n"));
        assert!(job.status().1, "{}", job.status().0);
    }
}

#[test]
fn equal_scripts_are_rendered_once() {
    let job = Job::new(&scene(6).replace("velocity = [1, 0, 0]", ""), &SLURM);
    let output = job.chunk(&["0", "2"]);
    assert_eq!(stdout(&output).matches("rendered in").count(), 1, "{}", stdout(&output));
    let output = job.chunk(&["3", "5"]);
    assert_eq!(stdout(&output).matches("rendered in").count(), 0, "{}", stdout(&output));
    assert_eq!(job.missing(), "");
    let images = |frame: usize| fs::read(job.join(format!("images/frame_{frame:04}.png"))).unwrap();
    assert_eq!(images(0), images(5));
    // Two equal scripts are rendered once, and a failure counts for both frames.
    for frame in [0, 1] {
        job.break_frame(frame);
    }
    let output = job.chunk(&["0", "1"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(job.read("images/.jabuka/failed/frame_0001.txt").starts_with("frame_0001.pov:"));
}

#[test]
fn a_broken_frame_stops_no_other_and_says_where_it_is_broken() {
    let job = Job::new(&scene(6), &SLURM);
    let line = job.break_frame(3);
    let output = job.chunk(&["0", "5"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(job.missing(), "3");
    let why = format!(
        "frame_0003.pov:{line}: Parse Error: Expected 'numeric expression', undeclared identifier 'oops' found instead (body `ball`)"
    );
    let status = format!("done     5 of 6\nfailed   1\n  frame 3: {why}\nfilm     not made\n");
    assert_eq!(job.status(), (status, false));
    assert!(job.read("images/.jabuka/failed/frame_0003.txt").starts_with(&why));

    // After the script is repaired, its frame counts as missing, no longer as failed.
    std::thread::sleep(Duration::from_millis(20));
    let good = job.read("scripts/frame_0002.pov");
    fs::write(job.join("scripts/frame_0003.pov"), good.replace("<0.08", "<0.12")).unwrap();
    assert_eq!(job.status().0, "done     5 of 6\nmissing  1: 3\nfilm     not made\n");
    assert!(job.chunk(&["0", "5"]).status.success());
    assert_eq!((job.missing().as_str(), job.leftovers().len()), ("", 0));
}

#[test]
fn a_frame_that_takes_too_long_is_given_up() {
    let job = Job::new(&scene(3), &[&SLURM[..], &["--limit", "2"]].concat());
    let endless = "// frame 1\n#version 3.7;\n#while (1) #end\n";
    fs::write(job.join("scripts/frame_0001.pov"), endless).unwrap();
    let output = job.chunk(&["0-2"]);
    assert_eq!(output.status.code(), Some(124), "{}", stdout(&output));
    assert!(job.status().0.contains("  frame 1: it took longer than 2 s\n"), "{}", job.status().0);
    assert_eq!(job.missing(), "1");
}

#[test]
fn what_is_stopped_in_the_middle_leaves_nothing_half() {
    let job = Job::new(&scene(40), &SLURM);
    // Two frames get scripts that never end.
    for frame in [5, 6] {
        let endless = format!("// frame {frame}\n#version 3.7;\n#while (1) #declare X = {frame}; #end\n");
        fs::write(job.join(format!("scripts/frame_{frame:04}.pov")), endless).unwrap();
    }
    for signal in ["TERM", "INT", "KILL"] {
        let mut command = job.command("/usr/bin/env");
        // A test runner in the background may make its children ignore SIGINT, and bash cannot trap a signal that it ignored at its start.
        command.arg("--default-signal=INT").arg(job.join("render-chunk"));
        let mut chunk = Running(command.args(["0", "39"]).env("PROCESSES", "3").spawn().unwrap());
        // Two workers render the endless frames; the third renders all other frames meanwhile.
        wait_until("the frames that never end are being rendered", LONG, || {
            let running = job.running();
            running.contains(&5) && running.contains(&6)
        });
        let kill = Command::new("kill").args([&format!("-{signal}"), &chunk.0.id().to_string()]).status();
        assert!(kill.unwrap().success());
        let code = chunk.0.wait().unwrap().code();
        if signal == "KILL" {
            // A killed script cannot clean up, so the test ends the remaining processes.
            end_endless_frames(&job);
        } else {
            assert_eq!(code, Some(143));
            assert_eq!(job.leftovers(), [""; 0], "after {signal}");
        }
        for image in job.images() {
            let bytes = fs::read(job.join("images").join(&image)).unwrap();
            assert!(bytes.ends_with(b"IEND\xae\x42\x60\x82"), "{image} is half");
        }
    }
    // A `running` marker that has not been touched for three minutes no longer counts as work in progress.
    wait_until("workers end", LONG, || {
        let markers = names(&job.join("images/.jabuka/running"));
        let old = |marker: &String| {
            let path = job.join("images/.jabuka/running").join(marker);
            Command::new("touch").args(["-d", "4 minutes ago"]).arg(path).status().unwrap().success()
        };
        markers.iter().all(old) && job.status().0.contains("begun and not heard of for three minutes")
    });
}

/// A running `render-chunk`. Dropping it ends the process, so that endless frames do not outlive a failed test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        if matches!(self.0.try_wait(), Ok(None)) {
            let _ = Command::new("kill").args(["-TERM", &self.0.id().to_string()]).status();
            let _ = self.0.wait();
        }
    }
}

/// Kills all processes whose working directory is in the job folder: the workers of a killed chunk and their POV-Ray processes.
fn end_endless_frames(job: &Job) {
    let folder = fs::canonicalize(job.path()).unwrap();
    let send = |signal: &str| {
        let mut found = false;
        for entry in fs::read_dir("/proc").unwrap().flatten() {
            let inside = fs::read_link(entry.path().join("cwd")).is_ok_and(|cwd| cwd.starts_with(&folder));
            if let Some(process) = entry.file_name().to_str().filter(|_| inside) {
                found = true;
                let _ = Command::new("kill").args([signal, process]).status();
            }
        }
        found
    };
    // Stop all processes first: a worker that sees its POV-Ray process end would record a failure and begin the next frame.
    send("-STOP");
    send("-STOP");
    wait_until("all have ended", LONG, || !send("-KILL"));
}

#[test]
fn two_machines_may_render_the_same_frames() {
    let job = Job::new(&scene(12), &SLURM);
    let spawn = || job.command("render-chunk").args(["0", "11"]).spawn().unwrap();
    let mut both = [spawn(), spawn()];
    assert!(both.iter_mut().all(|chunk| chunk.wait().unwrap().success()));
    assert_eq!((job.missing().as_str(), job.leftovers().len()), ("", 0));
    assert!(job.status().1, "{}", job.status().0);
}

/// Writes a bash script with this text into the job folder, to be called in place of a real program.
fn stand_in(job: &Job, name: &str, text: &str) -> std::path::PathBuf {
    let path = job.join(name);
    fs::write(&path, format!("#!/usr/bin/env bash\n{text}\n")).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    path
}

#[test]
fn an_image_that_is_not_whole_is_none() {
    let job = Job::new(&scene(2), &SLURM);
    let version = "[[ $1 == --version ]] && { echo 'POV-Ray 3.7.0'; exit; }";
    stand_in(&job, "povray", &format!("{version}\nprintf 'half a PNG' >image.png"));
    fs::write(job.join("local.conf"), format!("POVRAY={}\n", job.join("povray").display())).unwrap();
    let output = job.chunk(&["0"]);
    assert_eq!(output.status.code(), Some(74), "{}", stdout(&output));
    assert_eq!(job.images(), [""; 0]);
    assert!(job.status().0.contains("frame 0: POV-Ray wrote no whole image"), "{}", job.status().0);

    stand_in(&job, "povray", &format!("{version}\nkill -SEGV $$"));
    assert_eq!(job.chunk(&["0"]).status.code(), Some(139));
    assert!(job.status().0.contains("frame 0: POV-Ray ended with code 139"), "{}", job.status().0);

    // Images made by another version of POV-Ray must be rendered again, but only where a POV-Ray is available to report its version.
    fs::remove_file(job.join("local.conf")).unwrap();
    assert!(job.chunk(&["0", "1"]).status.success());
    fs::write(job.join("local.conf"), format!("POVRAY={}\n", job.join("povray").display())).unwrap();
    assert_eq!((job.missing().as_str(), job.status().1), ("", true));
    assert_eq!(job.chunk(&["0"]).status.code(), Some(139));

    fs::write(job.join("local.conf"), "POVRAY=no-such-povray\n").unwrap();
    let output = job.chunk(&["0"]);
    assert_eq!(output.status.code(), Some(127));
    assert!(stderr(&output).contains("`no-such-povray` was not found"), "{}", stderr(&output));
}

#[test]
fn a_folder_in_the_place_of_a_file_is_named() {
    let job = Job::new(&scene(3), &SLURM);
    fs::create_dir_all(job.join("images/.jabuka/frame_0000.txt")).unwrap();
    fs::create_dir_all(job.join("images/frame_0001.png")).unwrap();
    let output = job.chunk(&["0", "1"]);
    assert_eq!(output.status.code(), Some(74), "{}", stdout(&output));
    let said = job.status().0;
    for place in ["images/.jabuka/frame_0000.txt", "images/frame_0001.png"] {
        assert!(said.contains(&format!("'{place}'")), "{said}");
        assert_eq!(names(&job.join(place)), [""; 0], "nothing was put into it");
        fs::remove_dir(job.join(place)).unwrap();
    }
    assert!(job.chunk(&["0", "2"]).status.success());
    fs::create_dir(job.join("film.mp4")).unwrap();
    let output = job.command("render-video").output().unwrap();
    assert!(!output.status.success() && stderr(&output).contains("film.mp4"), "{}", stderr(&output));
    assert!(job.status().0.contains("film     not made"));
}

#[test]
fn a_blurred_frame_is_the_average_of_its_moments() {
    let job = Job::new(&scene(2), &SLURM);
    let moments: String =
        [1, 2, 3].map(|moment| format!("#case ({})\n#declare X = {moment};\n#break\n", moment - 1)).concat();
    let body = job.read("scripts/frame_0001.pov");
    let body: String = body.lines().skip(2).map(|line| format!("{line}\n")).collect();
    let blurred = format!(
        "// frame 1, t = 0.04 s, 3 moments while the shutter is open\n#version 3.7;\n\
         #ifndef (Shutter_Sample) #declare Shutter_Sample = frame_number; #end\n#switch (Shutter_Sample)\n{moments}#end\n{body}"
    );
    fs::write(job.join("scripts/shutter_0001.pov"), blurred).unwrap();
    // This stand-in for the averaging program copies the first image, and records how many arguments it got.
    let stand_in = stand_in(
        &job,
        "average",
        "[[ $1 == average && $2 == -o ]] || exit 1\ncp -- \"$4\" \"$3\"; echo \"$#\" >\"$(dirname \"$0\")/arguments\"",
    );
    let conf = job.read("job.conf").replace("BLURRED=no", "BLURRED=yes");
    fs::write(job.join("job.conf"), conf).unwrap();
    let output = job.command("render-chunk").arg("0-1").env("PATH", path_without_jabuka()).output().unwrap();
    assert_eq!(output.status.code(), Some(127), "there is no jabuka");
    assert!(stderr(&output).contains("`jabuka` was not found"), "{}", stderr(&output));

    fs::write(job.join("local.conf"), format!("JABUKA={:?}\n", stand_in.to_str().unwrap())).unwrap();
    let output = job.chunk(&["0-1"]);
    assert!(output.status.success(), "{}{}", stdout(&output), stderr(&output));
    assert_eq!(job.read("arguments"), "6\n", "three images");
    assert!(
        job.read("images/.jabuka/frame_0001.txt").contains("\nframe -\n"),
        "its frame_number is that of a moment"
    );
    assert!(job.status().1, "{}", job.status().0);
    // With motion blur, the sharp script of a frame is not used, so breaking it changes nothing.
    job.break_frame(1);
    assert_eq!(job.missing(), "");
}

#[test]
fn a_scene_with_motion_blur_is_a_job_of_as_many_images_as_frames() {
    let text = scene(3) + "[camera]\nshutter = 0.02\nsamples = 2\n";
    let job = Job::new(&text, &[&SLURM[..], &["--chunk", "2"]].concat());
    assert_eq!((job.missing().as_str(), stdout(&job.chunk(&["--chunks"]))), ("0-2", "2\n".to_owned()));
    let output = job.command("submit").env("PATH", path_without_jabuka()).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("the nodes need it for motion blur"), "{}", stderr(&output));

    fs::write(job.join("local.conf"), format!("JABUKA={:?}\n", env!("CARGO_BIN_EXE_jabuka"))).unwrap();
    let output = job.chunk(&["0-2"]);
    assert!(output.status.success(), "{}{}", stdout(&output), stderr(&output));
    assert!(job.command("render-video").status().unwrap().success());
    assert_eq!(film(&job.join("film.mp4")).0, 3);
    assert_eq!(job.status(), ("done     3 of 3\nfilm     made\n".to_owned(), true));
    // Read the folder of scripts and images directly, without the settings of the job.
    let scripts = job.join("scripts");
    let output = jabuka().arg("status").arg(scripts).output().unwrap();
    assert!(stdout(&output).starts_with("done     0 of 3\n"), "{}", stdout(&output));
}

#[test]
fn a_script_that_writes_elsewhere_fails_where_a_node_has_jabuka() {
    let job = Job::new(&scene(2), &SLURM);
    let victim = tempfile::NamedTempFile::new().unwrap();
    let script = job.read("scripts/frame_0000.pov");
    let write = format!("#fopen F \"{}\" write\n#write (F, \"gone\")\n", victim.path().display());
    fs::write(job.join("scripts/frame_0000.pov"), script + &write).unwrap();
    fs::write(job.join("local.conf"), format!("JABUKA={}\n", env!("CARGO_BIN_EXE_jabuka"))).unwrap();
    let output = job.chunk(&["0-1"]);
    assert_eq!(output.status.code(), Some(1), "{}{}", stdout(&output), stderr(&output));
    assert_eq!(fs::read_to_string(victim.path()).unwrap(), "");
    let said = stdout(&output);
    assert!(said.starts_with("sandbox: Landlock, ABI "), "{said}");
    assert!(said.contains("Cannot open user file"), "{said}");
    assert_eq!(job.images(), ["frame_0001.png"]);
    // On a node without jabuka, no sandbox confines POV-Ray, and the output must say so.
    let output = job.command("render-chunk").arg("1").env("PATH", path_without_jabuka()).output().unwrap();
    assert!(stdout(&output).starts_with("sandbox: Landlock"), "local.conf names it");
    fs::remove_file(job.join("local.conf")).unwrap();
    let output = job.command("render-chunk").arg("1").env("PATH", path_without_jabuka()).output().unwrap();
    assert!(stdout(&output).starts_with("sandbox: none, since `jabuka` is not there"), "{}", stdout(&output));
}

fn path_without_jabuka() -> String {
    let path = std::env::var("PATH").unwrap();
    path.split(':')
        .filter(|folder| !fs::exists(format!("{folder}/jabuka")).unwrap())
        .collect::<Vec<_>>()
        .join(":")
}

#[test]
fn wrong_usage_is_said() {
    let job = Job::new(&scene(2), &SLURM);
    for arguments in [&[][..], &["x"], &["3-"], &["--chunk"], &["1-5:0"], &["--misssing"]] {
        let output = job.chunk(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains("./render-chunk 7 31"), "{}", stderr(&output));
    }
    for name in ["render-chunk", "render-video", "submit"] {
        let output = job.command(name).arg("--help").output().unwrap();
        assert!(output.status.success() && stderr(&output).is_empty(), "{name}: {}", stderr(&output));
        assert!(stdout(&output).contains(&format!("\n   ./{name} ")), "{}", stdout(&output));
        let output = job.command(name).arg("--hlep").output().unwrap();
        assert!(!output.status.success() && stderr(&output).contains("`--hlep`"), "{}", stderr(&output));
    }
    let output = job.chunk(&["7", "31"]);
    assert!(
        output.status.success() && stderr(&output).contains("its frames are 0,1")
            || stderr(&output).contains("0-1")
    );
}

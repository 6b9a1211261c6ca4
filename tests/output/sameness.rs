//! Tests that a scene gives the same bytes in every run, with any number of threads, for any user and locale, and from any folder.

use std::fs;

use crate::support::{compile, contents, jabuka, scene};

#[test]
fn any_run_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let compile_with = |threads: &str| {
        let path = folder.path().join(threads);
        let output = jabuka()
            .env("RAYON_NUM_THREADS", threads)
            .arg("compile")
            .arg(scene("tumbling_box"))
            .arg("-o")
            .arg(&path)
            .output()
            .unwrap();
        assert!(output.status.success());
        contents(&path)
    };
    let one = compile_with("1");
    // 301 scripts of frames, two files of the sequence, the manifest and the lock.
    assert_eq!(one.len(), 301 + 2 + 2);
    for threads in ["2", "8"] {
        assert!(one == compile_with(threads), "{threads} threads give other bytes than one");
    }
}

/// Checks scenes with impacts, friction and bodies at rest, with ghosts and with motion blur, which need moments between frames.
#[test]
fn contacts_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let seen = "[camera]\nshutter = 0.01\nsamples = 3\n";
    for name in ["billiard_break", "incline", "newtons_cradle"] {
        let text = fs::read_to_string(scene(name)).unwrap();
        let text = text.replacen("[camera]\n", seen, 1).replacen(
            "[body.ball]\n",
            "[body.ball]\nghosts.every = 0.03\n",
            1,
        );
        let path = folder.path().join(format!("{name}.toml"));
        fs::write(&path, text).unwrap();
        let compile_with = |threads: &str| {
            let out = folder.path().join(format!("{name}-{threads}"));
            let mut command = jabuka();
            command.env("RAYON_NUM_THREADS", threads).arg("compile").arg(&path).arg("-o").arg(&out);
            let output = command.args(["--set", "simulation.duration=1"]).output().unwrap();
            assert!(output.status.success(), "{output:?}");
            contents(&out)
        };
        let one = compile_with("1");
        for threads in ["2", "8"] {
            assert!(one == compile_with(threads), "{name}: {threads} threads give other bytes than one");
        }
    }
}

#[test]
fn any_folder_user_and_locale() {
    let here = tempfile::tempdir().unwrap();
    compile(&scene("parabola"), &here.path().join("out"), &["--frames", "0-20"]);

    let there = tempfile::tempdir().unwrap();
    fs::create_dir_all(there.path().join("a b/é")).unwrap();
    fs::copy(scene("parabola"), there.path().join("a b/é/parabola.toml")).unwrap();
    let output = jabuka()
        .current_dir(there.path())
        .env_clear()
        .envs([
            ("USER", "someone_else"),
            ("HOME", "/nowhere"),
            ("LC_ALL", "de_DE.UTF-8"),
            ("TZ", "Asia/Tokyo"),
        ])
        .args(["compile", "a b/é/parabola.toml", "--frames", "0-20"])
        .output()
        .unwrap();
    assert!(output.status.success());
    // Without `-o`, the output folder has the name of the scene's file.
    assert!(contents(&here.path().join("out")) == contents(&there.path().join("out/parabola")));
}

#[test]
fn nothing_of_the_machine_is_in_the_files() {
    let folder = tempfile::tempdir().unwrap();
    compile(&scene("parabola"), folder.path(), &["--frames", "0"]);
    let path = folder.path().to_str().unwrap();
    for (name, bytes) in contents(folder.path()) {
        let text = String::from_utf8(bytes).unwrap();
        assert!(!text.contains(path) && !text.contains(env!("CARGO_MANIFEST_DIR")), "{name}");
    }
}

#[test]
fn compiled_again_into_the_same_folder() {
    let folder = tempfile::tempdir().unwrap();
    compile(&scene("damped_spring"), folder.path(), &[]);
    let first = contents(folder.path());
    compile(&scene("damped_spring"), folder.path(), &[]);
    assert!(first == contents(folder.path()));
}

/// Checks that the drawn past of a frame, such as a trail, depends neither on the selected frames nor on the number of threads.
#[test]
fn the_past_of_a_frame_does_not_depend_on_which_are_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let compile_with = |threads: &str, name: &str, frames: &str| {
        let path = folder.path().join(name);
        let mut command = jabuka();
        command.env("RAYON_NUM_THREADS", threads).arg("compile").arg(scene("projectile"));
        assert!(command.arg("-o").arg(&path).args(["--frames", frames]).output().unwrap().status.success());
        move |frame: usize| fs::read_to_string(path.join(format!("frame_{frame:04}.pov"))).unwrap()
    };
    let (one, eight, some) = (
        compile_with("1", "one", "0-100"),
        compile_with("8", "eight", "0-100"),
        compile_with("3", "some", "47,99"),
    );
    for frame in 0..=100 {
        assert!(one(frame) == eight(frame), "frame {frame}");
    }
    for frame in [47, 99] {
        assert!(one(frame) == some(frame), "frame {frame}");
        assert!(some(frame).contains("Ghost_") && some(frame).contains("trail"));
    }
}

//! Tests that no file in the cache folder, whatever it is, blocks a command or changes its results.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::support::{contents, jabuka};

/// A scene whose run writes checkpoints.
const SCENE: &str = "
    [simulation]
    duration = 0.4
    gravity = [0, -9.81, 0]
    contacts = 'time-stepping'
    [body.ball]
    repeat = 3
    shape.sphere.radius = 0.1
    location = [0, '0.2 + 0.3*i', 0]
    ";

/// Compiles the scene with the cache in `folder/cache`. Panics if this takes too long.
fn compile(folder: &Path, out: &str) {
    let mut command = jabuka();
    command.args(["compile", "scene.toml", "-o", out]).current_dir(folder);
    command
        .env_remove("JABUKA_CACHE_SIZE")
        .env("JABUKA_CACHE_DIR", folder.join("cache"))
        .env("JABUKA_CACHE_ALL", "1");
    command.env("JABUKA_CHECKPOINT_SECONDS", "0").stdout(Stdio::null());
    ends_well(&mut command, out);
}

/// Runs a command, and panics if it fails or takes too long.
fn ends_well(command: &mut Command, of: &str) {
    let mut child = command.spawn().unwrap();
    let begun = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if begun.elapsed() > Duration::from_secs(60) {
            child.kill().unwrap();
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    assert!(status.success(), "{of}: {status}, after {:?}", begun.elapsed());
}

/// A function that makes something in the place of a file.
type Make<'a> = &'a dyn Fn(&Path);

#[test]
fn pipes_devices_folders_and_links_in_the_cache_are_passed_over() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    fs::write(folder.join("scene.toml"), SCENE).unwrap();
    compile(folder, "first");
    let run = fs::read_dir(folder.join("cache")).unwrap().map(|entry| entry.unwrap().path());
    let run: Vec<_> = run.filter(|path| path.extension().is_some_and(|end| end == "run")).collect();
    assert_eq!(run.len(), 1, "{run:?}");
    let stem = run[0].file_stem().unwrap().to_str().unwrap().to_owned();
    fs::write(folder.join("victim"), "keep").unwrap();
    let expected = contents(&folder.join("first"));
    let pipe = |path: &Path| assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
    let kinds: [(&str, Make<'_>); 6] = [
        ("pipe", &pipe),
        ("device", &|path| symlink("/dev/zero", path).unwrap()),
        ("folder", &|path| fs::create_dir(path).unwrap()),
        ("link", &|path| symlink(folder.join("victim"), path).unwrap()),
        ("unreadable", &|path| {
            fs::write(path, "x").unwrap();
            Command::new("chmod").arg("000").arg(path).status().unwrap();
        }),
        ("damaged", &|path| fs::write(path, [7; 300]).unwrap()),
    ];
    for (kind, make) in kinds {
        let cache = folder.join("cache");
        fs::remove_dir_all(&cache).unwrap();
        fs::create_dir(&cache).unwrap();
        for name in
            ["run", "7-0.part", "7-0.checkpoint", "7-0.saving", "8-0.part", "9-0.checkpoint", "9-0.saving"]
        {
            make(&cache.join(format!("{stem}.{name}")));
        }
        compile(folder, kind);
        assert!(contents(&folder.join(kind)) == expected, "{kind}");
        compile(folder, kind);
        for arguments in [&["cache"][..], &["cache", "--clear"]] {
            let mut command = jabuka();
            command
                .args(arguments)
                .env_remove("JABUKA_CACHE_SIZE")
                .env("JABUKA_CACHE_DIR", &cache)
                .stdout(Stdio::null());
            ends_well(&mut command, kind);
        }
        assert_eq!(fs::read_to_string(folder.join("victim")).unwrap(), "keep", "{kind}");
    }
}

//! Tests of the sandbox, which limits what a POV-Ray process may read and write.

use std::fs;
use std::process::Command;

use crate::scene::{Place, SCENE};
use crate::support::{jabuka, stderr, stdout};

/// Returns a scene whose SDL writes to a file.
fn writing(file: &std::path::Path) -> String {
    let sdl = format!("#fopen F \"{}\" write\n#write (F, \"gone\")\n#fclose F", file.display());
    format!("povray.sdl = '''\n{sdl}\n'''\n{SCENE}")
}

/// Makes a second folder with a file that scenes in other folders must not change. Returns the folder and the file.
fn victim() -> (Place, std::path::PathBuf) {
    let other = Place::new("keep");
    let file = other.path("scene.toml");
    (other, file)
}

#[test]
fn a_trusted_scene_writes_in_its_folder_and_nowhere_else() {
    let (_other, victim) = victim();
    let place = Place::new(&writing(&victim));
    let output = place.run(&["render", "scene.toml", "--trust", "--frames", "0"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(fs::read_to_string(&victim).unwrap(), "keep");
    let said = stderr(&output);
    let error =
        format!("error[outside-sandbox]: frame 0: Cannot open user file {} (write).", victim.display());
    assert!(said.starts_with(&error) && said.contains("= help: POV-Ray may read the scripts"), "{said}");
    assert_eq!(place.run(&["still", "scene.toml", "--trust", "-o", "x.png"]).status.code(), Some(1));
    assert_eq!(fs::read_to_string(&victim).unwrap(), "keep");

    let inside = place.path("written.txt");
    fs::write(place.path("scene.toml"), writing(&inside)).unwrap();
    place.succeed(&["render", "scene.toml", "--trust", "--frames", "0"]);
    assert_eq!(fs::read_to_string(&inside).unwrap(), "gone");
}

#[test]
fn scripts_that_nobody_vouches_for_write_and_read_nothing_outside() {
    let (other, victim) = victim();
    let place = Place::new(&writing(&victim));
    place.succeed(&["compile", "scene.toml", "--trust", "--frames", "0"]);
    assert_eq!(place.run(&["render", "out/scene"]).status.code(), Some(1));
    assert_eq!(fs::read_to_string(&victim).unwrap(), "keep");

    let secret = other.path("secret.inc");
    fs::write(&secret, "sphere { y * 2, 1 }").unwrap();
    let sdl = format!("#include \"{}\"", secret.display());
    fs::write(place.path("scene.toml"), format!("povray.sdl = '{sdl}'\n{SCENE}")).unwrap();
    place.succeed(&["compile", "scene.toml", "--trust", "--frames", "0"]);
    let output = place.run(&["render", "out/scene"]);
    assert!(stderr(&output).starts_with("error[outside-sandbox]: frame 0: "), "{}", stderr(&output));
    // With `--trust`, the scripts may write.
    place.succeed(&["render", "out/scene", "--trust"]);
}

#[test]
fn an_image_that_may_not_be_read_is_said_without_another_try() {
    let (other, _) = victim();
    let image = other.path("secret.png");
    fs::copy(crate::support::root().join("docs/gallery.png"), &image).unwrap();
    let pigment = format!("pigment {{ image_map {{ png \"{}\" }} }}", image.display());
    let place = Place::new(&format!("povray.sdl = 'sphere {{ y * 9, 1 {pigment} }}'\n{SCENE}"));
    place.succeed(&["compile", "scene.toml", "--trust", "--frames", "0"]);
    let said = stderr(&place.run(&["render", "out/scene"]));
    assert!(said.starts_with("error[outside-sandbox]: frame 0: Cannot open file."), "{said}");
    place.succeed(&["render", "out/scene", "--trust"]);
}

#[test]
fn includes_and_fonts_of_povray_are_readable() {
    let sdl = "#include \"metals.inc\"\ntext { ttf \"cyrvetic.ttf\" \"x\" 1, 0 texture { T_Brass_1A } }";
    let place = Place::new(&format!("povray.sdl = '''{sdl}'''\n{SCENE}"));
    place.succeed(&["compile", "scene.toml", "--trust", "--frames", "0"]);
    place.succeed(&["render", "out/scene"]);
}

#[test]
fn a_povray_that_cannot_start_there_reads_everything_and_that_is_said() {
    let place = Place::new(SCENE);
    let (other, _) = victim();
    fs::write(other.path("library"), "").unwrap();
    let needs = other.path("library").display().to_string();
    let version = format!("cat {needs} >&2 || exit 127; exec povray --version");
    let povray = place.path("povray");
    fs::write(
        &povray,
        format!("#!/bin/sh\nif [ \"$1\" = --version ]; then {version}; fi\nexec povray \"$@\"\n"),
    )
    .unwrap();
    assert!(Command::new("chmod").arg("+x").arg(&povray).status().unwrap().success());
    let povray = povray.display().to_string();
    let output = place.succeed(&["render", "scene.toml", "--frames", "0", "--povray", &povray]);
    let said = stderr(&output);
    assert!(said.contains("may read all files, since it does not start in the sandbox: it says `"), "{said}");
    assert!(said.contains("Permission denied"), "{said}");
    // Writing is limited all the same.
    let (_another, victim) = self::victim();
    fs::write(place.path("scene.toml"), writing(&victim)).unwrap();
    place.succeed(&["compile", "scene.toml", "--trust", "--frames", "0"]);
    assert_eq!(place.run(&["render", "out/scene", "--povray", &povray]).status.code(), Some(1));
    assert_eq!(fs::read_to_string(&victim).unwrap(), "keep");
}

/// Runs a shell script in the sandbox, with access to one folder for reading and to one for writing. Returns true if it succeeds.
fn shell(place: &Place, script: &str) -> bool {
    let (read, write) = (place.path("read"), place.path("write"));
    fs::create_dir_all(&read).unwrap();
    fs::create_dir_all(&write).unwrap();
    let mut command = jabuka();
    command
        .arg("sandbox")
        .arg("--read")
        .arg(&read)
        .arg("--write")
        .arg(&write)
        .args(["--", "bash", "-ec", script]);
    command.current_dir(place.path("")).output().unwrap().status.success()
}

#[test]
fn the_launcher_grants_what_is_named_and_the_folders_of_the_system() {
    let place = Place::new(SCENE);
    for script in
        ["echo x >write/a", "ls /usr/lib", "cat /proc/self/stat", "echo x >/dev/null", "touch $TMPDIR/b"]
    {
        assert!(shell(&place, script), "{script}");
    }
    fs::write(place.path("read/a"), "").unwrap();
    assert!(shell(&place, "cat read/a && cp read/a write/c && mv write/c write/d && rm write/d"));
    for script in [
        "echo x >read/a",
        "echo x >b",
        "rm scene.toml",
        "mv scene.toml write/",
        "ln scene.toml write/",
        "truncate -s 0 scene.toml",
        "cat scene.toml",
        "ls .",
        "ls ~",
        "ls /tmp",
        "cat /etc/shadow",
        "mkfifo write/fifo",
        "ln -s /etc write/link",
        "kill -0 $PPID",
    ] {
        assert!(!shell(&place, script), "{script} was not refused");
    }
    assert_eq!(fs::read_to_string(place.path("scene.toml")).unwrap(), SCENE);
}

/// Checks that a script learns nothing of the environment, which may hold passwords and keys.
#[test]
fn the_environment_is_closed() {
    let place = Place::new(SCENE);
    for script in
        ["cat /proc/self/environ", "cat /proc/$$/environ; cat /proc/$PPID/environ", "ls /proc/self/fd"]
    {
        assert!(!shell(&place, script), "{script}");
    }
    let sandbox = |arguments: &[&str], program: &[&str]| {
        let mut command = jabuka();
        command.arg("sandbox").args(arguments).arg("--").args(program);
        command.env("API_TOKEN", "sekret").env("LC_ALL", "C").env("POVINI", "/etc/none");
        stdout(&command.output().unwrap())
    };
    // Even a trusted program, which may read all files, gets only what it needs.
    for said in [sandbox(&[], &["env"]), sandbox(&["--read", "/"], &["cat", "/proc/self/environ"])] {
        assert!(said.contains("PATH=") && said.contains("LC_ALL=C") && said.contains("POVINI="), "{said}");
        assert!(!said.contains("sekret"), "{said}");
    }
    let sdl = "#fopen F \"/proc/self/environ\" read\n#read (F, X)";
    let place = Place::new(&format!("povray.sdl = '''\n{sdl}\n'''\n{SCENE}"));
    place.succeed(&["compile", "scene.toml", "--trust", "--frames", "0"]);
    let said = stderr(&place.run(&["render", "out/scene"]));
    assert!(said.starts_with("error[outside-sandbox]: frame 0: "), "{said}");
}

#[test]
fn nothing_connects_to_the_network() {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let connect = format!("exec 3<>/dev/tcp/127.0.0.1/{}", listener.local_addr().unwrap().port());
    assert!(Command::new("bash").args(["-c", &connect]).status().unwrap().success());
    assert!(!shell(&Place::new(SCENE), &connect));
}

#[test]
fn a_program_passes_on_its_code_and_ends_with_who_wanted_it() {
    let code = |arguments: &[&str]| jabuka().arg("sandbox").args(arguments).output().unwrap().status.code();
    assert_eq!(code(&["--", "sh", "-c", "exit 7"]), Some(7));
    assert_eq!(code(&["--", "no-such-program"]), Some(127));
    assert_eq!(code(&["--write", "no/such/folder", "--", "true"]), Some(126));
    // The parent must be this test, not the first process of the system.
    assert_eq!(code(&["--parent", "1", "--", "true"]), Some(126));
    assert_eq!(code(&["--parent", &std::process::id().to_string(), "--", "true"]), Some(0));
}

#[test]
fn what_is_there_is_said_with_the_version() {
    let version = env!("CARGO_PKG_VERSION");
    for arguments in [&["--version"][..], &["-V"]] {
        let output = jabuka().args(arguments).output().unwrap();
        assert_eq!(stdout(&output), format!("jabuka {version}\n"));
    }
    for arguments in
        [&["--version", "-v"][..], &["-v", "--version"], &["--version", "--verbose"], &["-Vv"], &["-vV"]]
    {
        let said = stdout(&jabuka().args(arguments).output().unwrap());
        let lines: Vec<&str> = said.lines().collect();
        assert_eq!(lines[0], format!("jabuka   {version}"), "{arguments:?}");
        assert!(lines[1].starts_with("POV-Ray  3.") && lines[2].starts_with("ffmpeg   "), "{said}");
        assert!(lines[3].starts_with("sandbox  Landlock, ABI ") && lines.len() == 4, "{said}");
    }
    let output = jabuka().args(["-v", "--version"]).env("PATH", "").output().unwrap();
    assert!(
        stdout(&output).contains("\nPOV-Ray  not found: no `povray` on the PATH\n"),
        "{}",
        stdout(&output)
    );
    let output = jabuka().args(["doctor"]).output().unwrap();
    let said = stdout(&output);
    assert!(output.status.success() && said.ends_with("\nall is there\n"), "{said}");
    assert!(said.contains("\ncores    ") && said.contains(", films as mp4, webm, gif\n"), "{said}");
    let folder = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink("/bin/true", folder.path().join("apt-get")).unwrap();
    let output = jabuka().args(["doctor"]).env("PATH", folder.path()).output().unwrap();
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(1));
    assert!(said.ends_with("\nmissing  sudo apt-get install povray povray-includes ffmpeg\n"), "{said}");
    assert_eq!(jabuka().args(["-v", "list"]).output().unwrap().status.code(), Some(2));
}

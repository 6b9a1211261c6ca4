//! Stands in for POV-Ray on Windows: takes the same options, checks that it can read the scripts, and writes images of one pixel.
//!
//! As `povray.exe`, it takes options as arguments and tells its version. As `pvengine64.exe`, it takes `/EXIT /RENDER FILE.ini`, and its
//! version stands in its file. With `POV_STAND_IN_WAITS` in the environment, it starts another copy of itself, and both wait forever.

use std::fs;
use std::hint::black_box;
use std::process::{Command, ExitCode};

/// An image of one pixel.
const IMAGE: &[u8] = &[
    0x89, b'P', b'N', b'G', 0x0d, 0x0a, 0x1a, 0x0a, 0, 0, 0, 0x0d, b'I', b'H', b'D', b'R', 0, 0, 0, 1, 0, 0,
    0, 1, 8, 2, 0, 0, 0, 0x90, 0x77, 0x53, 0xde, 0, 0, 0, 0x0c, b'I', b'D', b'A', b'T', 0x78, 0x9c, 0x63,
    0xf8, 0xff, 0xff, 0x3f, 0, 0x05, 0xfe, 0x02, 0xfe, 0x0d, 0xef, 0x46, 0xb8, 0, 0, 0, 0, b'I', b'E', b'N',
    b'D', 0xae, 0x42, 0x60, 0x82,
];

/// The version 3.7.0.1, as in the resources of a program: `VS_FIXEDFILEINFO`.
static VERSION: [u8; 16] = [0xbd, 0x04, 0xef, 0xfe, 0, 0, 1, 0, 7, 0, 3, 0, 1, 0, 0, 0];

fn main() -> ExitCode {
    black_box(&VERSION);
    let asks_version = std::env::args().any(|argument| argument == "--version");
    if std::env::var_os("POV_STAND_IN_WAITS").is_some() && !asks_version {
        let program = std::env::current_exe().unwrap();
        // The second copy gets an argument that the first one does not have, so there is no third.
        if std::env::args().next_back().as_deref() != Some("second") {
            Command::new(program).arg("second").spawn().unwrap();
        }
        loop {
            std::thread::park();
        }
    }
    match render() {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            fs::write("errors.txt", format!("{why}\n")).unwrap();
            ExitCode::FAILURE
        }
    }
}

fn render() -> Result<(), String> {
    let mut options: Vec<String> = std::env::args().skip(1).collect();
    if options == ["--version"] {
        eprintln!("POV-Ray 3.7.0.1");
        return Ok(());
    }
    let window =
        std::env::current_exe().unwrap().file_stem().unwrap().to_string_lossy().starts_with("pvengine");
    if window {
        let [exit, render, settings] = &options[..] else {
            return Err(format!("unknown options: {options:?}"));
        };
        if (exit.as_str(), render.as_str()) != ("/EXIT", "/RENDER") {
            return Err(format!("unknown options: {options:?}"));
        }
        options = read(settings)?.lines().map(str::to_owned).collect();
    }
    let value = |start: &str| {
        let found = options.iter().find_map(|option| option.strip_prefix(start));
        found.ok_or_else(|| format!("no option {start}: {options:?}"))
    };
    let number = |start: &str| value(start)?.parse::<usize>().map_err(|error| error.to_string());
    let main = read(value("+I")?)?;
    for script in main.lines().filter_map(|line| line.strip_prefix("#include \"")?.strip_suffix('"')) {
        read(script)?;
    }
    let name = value("+O")?.strip_suffix(".png").ok_or("the image is no PNG")?;
    for frame in number("+SF")?..=number("+EF")? {
        fs::write(format!("{name}{frame:05}.png"), IMAGE).map_err(|error| error.to_string())?;
    }
    Ok(())
}

fn read(path: &str) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("cannot read {path}: {error}"))
}

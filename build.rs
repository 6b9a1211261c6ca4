//! Makes a digest of all that the scripts depend on, by which jabuka knows those that it would write again. Puts the example scenes into the
//! program.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

use sha2::{Digest, Sha256};

/// What the scripts of a scene depend on, beside the scene.
const SOURCES: [&str; 4] = ["Cargo.lock", "physics/src", "src", "templates"];

#[allow(clippy::print_stdout, reason = "this is how a build script speaks to cargo")]
fn main() -> io::Result<()> {
    let variable = |name| env::var_os(name).ok_or_else(|| io::Error::other(format!("{name} is not set")));
    let root = PathBuf::from(variable("CARGO_MANIFEST_DIR")?);
    let mut digest = Sha256::new();
    for source in SOURCES {
        println!("cargo::rerun-if-changed={source}");
        add(&root.join(source), &mut digest)?;
    }
    let hex: String = digest.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect();
    println!("cargo::rustc-env=JABUKA_BUILD={hex}");
    println!("cargo::rerun-if-changed=scenes");
    let out = PathBuf::from(variable("OUT_DIR")?);
    fs::write(out.join("scenes.rs"), scenes(&root.join("scenes"))?)?;
    fs::write(out.join("starters.rs"), scenes(&root.join("scenes/starters"))?)
}

/// Returns Rust code with the text of each scene in a folder, and the bytes of each file in its subfolders. Scripts do not depend on them.
fn scenes(folder: &Path) -> io::Result<String> {
    let (mut scenes, mut files) = (String::new(), String::new());
    for path in sorted(folder)? {
        // The starters are a list of their own.
        if path.ends_with("starters") {
            continue;
        }
        if path.is_dir() {
            for file in sorted(&path)?.into_iter().filter(|file| file.is_file()) {
                // Scenes name files with `/` on every system.
                let name =
                    file.strip_prefix(folder).map_err(io::Error::other)?.to_string_lossy().replace('\\', "/");
                files.push_str(&format!("    ({name:?}, include_bytes!({file:?})),\n"));
            }
        } else if let Some(name) =
            path.file_stem().filter(|_| path.extension().is_some_and(|end| end == "toml"))
        {
            scenes.push_str(&format!("    Example {{ name: {name:?}, text: include_str!({path:?}) }},\n"));
        }
    }
    Ok(format!("Folder {{ scenes: &[\n{scenes}], files: &[\n{files}] }}\n"))
}

/// Returns the paths in a folder, by name.
fn sorted(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut paths = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<_>>>()?;
    paths.sort();
    Ok(paths)
}

/// Adds a file, or all files of a folder in the order of their names, where it is there.
fn add(path: &Path, digest: &mut Sha256) -> io::Result<()> {
    if path.is_dir() {
        return sorted(path)?.iter().try_for_each(|path| add(path, digest));
    }
    if path.is_file() {
        let bytes = fs::read(path)?;
        digest.update(path.file_name().unwrap_or_default().as_encoded_bytes());
        digest.update((bytes.len() as u64).to_le_bytes());
        digest.update(&bytes);
    }
    Ok(())
}

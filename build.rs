//! Makes a table of the files in `explanations/`, so that adding one is dropping a file there.

use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs, io};

#[allow(clippy::print_stdout, reason = "this is how a build script speaks to cargo")]
fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=explanations");
    let variable = |name| env::var_os(name).ok_or_else(|| io::Error::other(format!("{name} is not set")));
    let folder = Path::new(&variable("CARGO_MANIFEST_DIR")?).join("explanations");
    let mut paths = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<_>>>()?;
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    paths.sort();

    let mut table = String::from("&[\n");
    for path in &paths {
        let code = path.file_stem().unwrap_or_default().to_string_lossy();
        let path = path.to_string_lossy();
        let _ = writeln!(table, "    Explanation {{ code: {code:?}, text: include_str!({path:?}) }},");
    }
    table.push(']');
    fs::write(Path::new(&variable("OUT_DIR")?).join("explanations.rs"), table)
}

//! The paths that every program may read: the system's folders, and the files of the program itself.
//!
//! Folders with personal data are excluded: homes, `/tmp`, `/srv`, `/mnt`, `/media`, `/data`.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};

/// The folders and files with programs, libraries and their configuration, on all distributions.
const SYSTEM_PATHS: &[&str] = &[
    "/usr",
    "/bin",
    "/sbin",
    "/lib",
    "/lib32",
    "/lib64",
    "/libx32",
    "/opt",
    // The folders of Nix, Guix, Homebrew on Linux, and snaps.
    "/nix/store",
    "/gnu/store",
    "/run/current-system",
    "/home/linuxbrew/.linuxbrew",
    "/snap",
    // Only the part of /etc that programs need to start, since other files in /etc hold keys and passwords.
    "/etc/alternatives",
    "/etc/fonts",
    "/etc/group",
    "/etc/ld.so.cache",
    "/etc/ld.so.conf",
    "/etc/ld.so.conf.d",
    "/etc/ld.so.preload",
    "/etc/locale.alias",
    "/etc/localtime",
    "/etc/nsswitch.conf",
    "/etc/passwd",
    "/etc/povray",
    "/etc/static",
    "/var/cache/fontconfig",
    "/dev/full",
    "/dev/null",
    "/dev/random",
    "/dev/tty",
    "/dev/urandom",
    "/dev/zero",
    // The number of processors, the free memory, and a process's information about itself, but not its environment or its open files.
    "/proc/cpuinfo",
    "/proc/filesystems",
    "/proc/meminfo",
    "/proc/self/cgroup",
    "/proc/self/maps",
    "/proc/self/stat",
    "/proc/self/statm",
    "/proc/self/status",
    "/proc/stat",
    "/proc/sys",
    "/sys/devices/system/cpu",
    "/sys/devices/system/node",
    "/sys/fs/cgroup",
];

/// The folders and files next to the folder `bin` of a program that is installed outside of the system's folders.
const INSTALLATION_PATHS: &[&str] = &["lib", "lib32", "lib64", "libexec", "etc/povray"];

/// The paths that every program may read.
pub(super) fn by_all() -> impl Iterator<Item = PathBuf> {
    SYSTEM_PATHS.iter().map(PathBuf::from)
}

/// The additional paths that one program may read: its own folder, libraries and configuration, and the folders and settings files that
/// its arguments name.
pub(super) fn by(program: &Path, arguments: &[OsString]) -> Vec<PathBuf> {
    let home = std::env::var_os("HOME").map(PathBuf::from).filter(|home| home.is_absolute());
    let canonical = program.canonicalize().unwrap_or_else(|_| program.to_owned());
    let mut paths = vec![canonical.clone()];
    paths.extend(canonical.parent().filter(|folder| is_narrow(folder, home.as_deref())).map(Path::to_owned));
    paths.extend(installed_with(&canonical));
    if let Some(libraries) = std::env::var_os("LD_LIBRARY_PATH") {
        let folders = std::env::split_paths(&libraries);
        paths.extend(folders.filter(|folder| is_narrow(folder, home.as_deref())));
    }
    paths.extend(home.map(|home| home.join(".povray")));
    paths.extend(std::env::var_os("POVINI").map(PathBuf::from));
    paths.extend(arguments.iter().filter_map(|argument| named(argument)));
    paths
}

/// True if an absolute folder contains neither a whole home nor all temporary files, so that a program may read it.
fn is_narrow(folder: &Path, home: Option<&Path>) -> bool {
    let temporary = std::env::temp_dir();
    let broad = [Some(Path::new("/tmp")), Some(Path::new("/var/tmp")), Some(temporary.as_path()), home];
    let resolved = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    folder.is_absolute()
        && !broad.into_iter().flatten().any(|broad| {
            broad.starts_with(&resolved)
                || broad.canonicalize().is_ok_and(|broad| broad.starts_with(&resolved))
        })
}

/// The files installed together with a program in a folder `bin`: libraries, configuration, and POV-Ray's shared files.
fn installed_with(program: &Path) -> Vec<PathBuf> {
    let folder = program.parent().filter(|folder| folder.file_name() == Some(OsStr::new("bin")));
    let Some(root) = folder.and_then(Path::parent) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = INSTALLATION_PATHS.iter().map(|name| root.join(name)).collect();
    let shared = fs::read_dir(root.join("share")).into_iter().flatten().flatten();
    paths.extend(
        shared.filter(|entry| entry.file_name().as_bytes().starts_with(b"povray")).map(|entry| entry.path()),
    );
    paths
}

/// The include folder or settings file that a POV-Ray argument names by an absolute path. `None` for other arguments.
fn named(argument: &OsStr) -> Option<PathBuf> {
    let bytes = argument.as_bytes();
    let library = [&b"+L"[..], b"-L", b"Library_Path="].iter().find_map(|start| bytes.strip_prefix(*start));
    let settings = bytes.ends_with(b".ini").then_some(bytes);
    let path = Path::new(OsStr::from_bytes(library.or(settings)?));
    path.is_absolute().then(|| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_brings_its_own_files_and_not_a_whole_home() {
        let place = tempfile::tempdir().unwrap();
        let root = place.path().canonicalize().unwrap();
        for name in ["bin/povray", "share/povray-3.7/x.inc", "share/keyrings/secret"] {
            let path = root.join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        let paths = by(&root.join("bin/povray"), &[]);
        let has = |name: &str| paths.contains(&root.join(name));
        assert!(has("bin/povray") && has("bin") && has("lib") && has("share/povray-3.7"), "{paths:?}");
        assert!(!has("share") && !has("share/keyrings") && !has(""), "{paths:?}");

        let home = Path::new("/home/me");
        for (folder, narrow) in [
            ("/home/me/bin", true),
            ("/home/me", false),
            ("/home", false),
            ("/", false),
            ("/tmp", false),
            ("lib", false),
        ] {
            assert_eq!(is_narrow(Path::new(folder), Some(home)), narrow, "{folder}");
        }
    }

    #[test]
    fn arguments_name_folders_and_settings_by_whole_paths() {
        let path = |argument: &str| named(OsStr::new(argument));
        assert_eq!(path("+L/opt/x"), Some(PathBuf::from("/opt/x")));
        assert_eq!(path("Library_Path=/y z"), Some(PathBuf::from("/y z")));
        assert_eq!(path("/etc/a.ini"), Some(PathBuf::from("/etc/a.ini")));
        for argument in ["+Lscripts", "a.ini", "+O/x.png", "file:/x", "+W64"] {
            assert_eq!(path(argument), None, "{argument}");
        }
    }
}

//! The two builds of POV-Ray: a program of the console, and POV-Ray for Windows, which is a window with an editor.
//!
//! The program of the console takes its options as arguments, and prints its version. POV-Ray for Windows prints nothing. It renders what an
//! INI file says and then ends, if it gets `/EXIT /RENDER FILE.ini`. Its version stands in the program file.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

/// A build of POV-Ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PovRayBuild {
    /// The build for consoles, `povray`.
    Console,
    /// POV-Ray for Windows, `pvengine64`.
    Windows,
}

impl PovRayBuild {
    /// Returns the build of a program by its name.
    pub fn of(path: &Path) -> PovRayBuild {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        if name.starts_with("pvengine") { PovRayBuild::Windows } else { PovRayBuild::Console }
    }

    /// Returns the name of the build for people.
    pub fn name(self) -> &'static str {
        match self {
            PovRayBuild::Console => "the build for consoles",
            PovRayBuild::Windows => "POV-Ray for Windows",
        }
    }
}

/// Reads the version from a program file of Windows, such as `3.7.0.0`. `None` if there is none.
pub(super) fn version_in(program: &Path) -> io::Result<Option<String>> {
    /// The largest size of a program that is read, bytes. POV-Ray has a tenth of it.
    const MAX_PROGRAM_BYTES: u64 = 256 << 20;
    let mut bytes = Vec::new();
    File::open(program)?.take(MAX_PROGRAM_BYTES).read_to_end(&mut bytes)?;
    Ok(fixed_file_version(&bytes))
}

/// Finds the structure `VS_FIXEDFILEINFO` in a program file, and returns the version of the file.
fn fixed_file_version(program: &[u8]) -> Option<String> {
    /// The members `dwSignature` and `dwStrucVersion`. The version of the file follows.
    const SIGNATURE: [u8; 8] = [0xbd, 0x04, 0xef, 0xfe, 0, 0, 1, 0];
    let at = program.windows(SIGNATURE.len()).position(|bytes| bytes == SIGNATURE)?;
    let version = program.get(at + SIGNATURE.len()..)?.first_chunk::<8>()?;
    let part = |i: usize| u16::from_le_bytes([version[i], version[i + 1]]);
    Some(format!("{}.{}.{}.{}", part(2), part(0), part(6), part(4)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_is_known_by_its_name() {
        for name in ["pvengine64.exe", "PVENGINE.EXE", "pvengine64", "pvengine-sse2.exe"] {
            assert_eq!(PovRayBuild::of(Path::new(name)), PovRayBuild::Windows, "{name}");
        }
        for name in ["povray", "povray.exe", "povconsole64.exe", "x/pvengine/povray"] {
            assert_eq!(PovRayBuild::of(Path::new(name)), PovRayBuild::Console, "{name}");
        }
    }

    #[test]
    fn the_version_stands_behind_its_signature() {
        let mut program = vec![0xbd, 0x04, 0, 0xbd, 0x04, 0xef, 0xfe, 0, 0, 1, 0];
        assert_eq!(fixed_file_version(&program), None);
        program.extend([7, 0, 3, 0, 0x39, 0x30, 2, 0]);
        assert_eq!(fixed_file_version(&program).as_deref(), Some("3.7.2.12345"));
        assert_eq!(fixed_file_version(b"MZ"), None);
    }
}

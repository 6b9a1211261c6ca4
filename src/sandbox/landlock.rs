//! Restricts a process by Linux's Landlock, and describes what the running kernel can enforce.

use std::path::Path;
use std::thread;

use landlock::{
    ABI, Access, AccessFs, AccessNet, BitFlags, LandlockStatus, PathBeneath, PathFd, Ruleset, RulesetAttr,
    RulesetCreatedAttr, RulesetError, Scope, make_bitflags,
};

use super::{Launch, LaunchError, readable};

/// The newest Landlock version that jabuka was tested with. An older kernel enforces the rules that it knows.
const NEWEST_TESTED_ABI: ABI = ABI::V7;

/// Restricts the current thread, and all programs that it starts, to what `launch` needs to run the program at the path `program`. Paths to
/// read need not exist.
/// TCP connections, signals to other processes and abstract sockets are forbidden.
///
/// # Errors
/// If the kernel refuses the rules, or a path to write does not exist.
pub(super) fn restrict(program: &Path, launch: &Launch) -> Result<(), LaunchError> {
    let mut read = launch.read.clone();
    read.extend(readable::by_all());
    read.extend(readable::by(program, &launch.arguments));
    // Programs may not create devices, links or pipes, because jabuka reads the files that they write.
    let written = AccessFs::from_all(NEWEST_TESTED_ABI)
        & !make_bitflags!(AccessFs::{Execute | MakeChar | MakeBlock | MakeSock | MakeFifo | MakeSym | IoctlDev});
    let refused = |error: RulesetError| LaunchError::Refused(error.to_string());
    let ruleset = Ruleset::default()
        .handle_access(AccessFs::from_all(NEWEST_TESTED_ABI))
        .and_then(|ruleset| ruleset.handle_access(AccessNet::from_all(NEWEST_TESTED_ABI)))
        .and_then(|ruleset| ruleset.scope(Scope::from_all(NEWEST_TESTED_ABI)))
        .and_then(Ruleset::create)
        .map_err(refused)?;
    // A path that does not exist needs no rule.
    let reading = read.iter().filter_map(|path| beneath(path, AccessFs::from_read(NEWEST_TESTED_ABI)).ok());
    let writing: Result<Vec<_>, LaunchError> = launch
        .write
        .iter()
        .map(|path| beneath(path, written).map_err(|why| LaunchError::Write(path.clone(), why)))
        .collect();
    // Shell scripts discard output by writing to `/dev/null`.
    let null = beneath(Path::new("/dev/null"), written).ok();
    let rules = reading.chain(writing?).chain(null).map(Ok::<_, RulesetError>);
    ruleset.add_rules(rules).and_then(landlock::RulesetCreated::restrict_self).map_err(refused)?;
    Ok(())
}

/// Creates the rule for a file, or for a folder and everything in it.
fn beneath(path: &Path, access: BitFlags<AccessFs>) -> Result<PathBeneath<PathFd>, String> {
    let opened = PathFd::new(path).map_err(|error| error.to_string())?;
    let access = if path.is_dir() { access } else { access & AccessFs::from_file(NEWEST_TESTED_ABI) };
    Ok(PathBeneath::new(opened, access))
}

/// Describes in a few words what the running kernel enforces, for users and logs.
pub fn enforced() -> String {
    // The crate reveals the kernel's version only to a thread that has restricted itself, so use a thread for this purpose alone.
    let ask = || {
        let ruleset = Ruleset::default().handle_access(AccessFs::MakeBlock).ok()?.create().ok()?;
        ruleset.restrict_self().ok().map(|status| status.landlock)
    };
    match thread::spawn(ask).join().ok().flatten() {
        Some(LandlockStatus::Available { effective_abi, kernel_abi }) => {
            let number = kernel_abi.map_or_else(|| effective_abi.to_string(), |abi| abi.to_string());
            let lacking = lacking(effective_abi);
            let lacking = if lacking.is_empty() {
                String::new()
            } else {
                format!("; this kernel cannot forbid {}", lacking.join(", nor "))
            };
            format!("Landlock, ABI {number}{lacking}")
        }
        Some(LandlockStatus::NotEnabled) => {
            "none: Landlock is switched off on this machine (see the kernel's option `lsm=`)".to_owned()
        }
        Some(LandlockStatus::NotImplemented) => {
            "none: this kernel has no Landlock, which came with Linux 5.13".to_owned()
        }
        None => "none: the kernel refuses Landlock".to_owned(),
    }
}

/// The actions that the kernel's version of Landlock cannot forbid.
fn lacking(abi: ABI) -> Vec<&'static str> {
    let mut lacking = Vec::new();
    if abi < ABI::V3 {
        lacking.push("to empty files of others");
    }
    if abi < ABI::V4 {
        lacking.push("network connections");
    }
    lacking
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_old_kernel_cannot_forbid_is_known() {
        assert_eq!(lacking(ABI::V2), ["to empty files of others", "network connections"]);
        assert_eq!(lacking(ABI::V3), ["network connections"]);
        assert_eq!(lacking(ABI::V7), [""; 0]);
    }
}

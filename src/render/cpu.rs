//! The CPU time of processes, where the system reports it (Linux does, in `/proc`).

use std::collections::HashMap;
use std::fs;

/// The CPU time that every process group has used so far, s; `None` where the system does not report it.
pub(super) fn seconds_by_group() -> Option<HashMap<i32, f64>> {
    let mut groups = HashMap::new();
    for entry in fs::read_dir("/proc").ok()?.flatten() {
        let is_process =
            entry.file_name().to_str().is_some_and(|name| name.bytes().all(|b| b.is_ascii_digit()));
        if !is_process {
            continue;
        }
        // A process may end during this loop.
        let Ok(stat) = fs::read_to_string(entry.path().join("stat")) else { continue };
        if let Some((group, seconds)) = group_and_seconds(&stat) {
            *groups.entry(group).or_default() += seconds;
        }
    }
    Some(groups)
}

/// The CPU time that a process has used so far, s.
pub(super) fn seconds(process: u32) -> Option<f64> {
    group_and_seconds(&fs::read_to_string(format!("/proc/{process}/stat")).ok()?).map(|(_, seconds)| seconds)
}

/// The memory available to new processes, bytes.
pub(super) fn available_memory() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim().strip_suffix("kB")?.trim().parse().ok().map(|kilobytes: u64| kilobytes * 1024)
}

/// The process group, and the CPU time of a process and of its children that have ended; see proc_pid_stat(5).
fn group_and_seconds(stat: &str) -> Option<(i32, f64)> {
    // The second field is a name in parentheses that may contain anything.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks: f64 = fields.get(11..15)?.iter().filter_map(|field| field.parse::<f64>().ok()).sum();
    #[allow(clippy::cast_precision_loss, reason = "it is 100")]
    let per_second = rustix::param::clock_ticks_per_second() as f64;
    Some((fields.get(2)?.parse().ok()?, ticks / per_second))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_proc_is_read_whatever_the_name() {
        let stat = "42 (a ) b) R 1 40 40 0 -1 4194304 100 0 0 0 150 50 10 5 20 0 1 0 100 1 1";
        let per_second = rustix::param::clock_ticks_per_second() as f64;
        assert_eq!(group_and_seconds(stat), Some((40, 215.0 / per_second)));
        assert_eq!(group_and_seconds("nonsense"), None);
    }
}

//! Reads the CPU time of processes from `/proc`, which only Linux has.

use std::collections::HashMap;
use std::fs;

/// Returns the CPU time that each process group has used so far, s, by the group's id. `None` where the system does not report CPU times.
pub(crate) fn cpu_seconds_by_group() -> Option<HashMap<i32, f64>> {
    let mut groups = HashMap::new();
    for entry in fs::read_dir("/proc").ok()?.flatten() {
        let is_process =
            entry.file_name().to_str().is_some_and(|name| name.bytes().all(|b| b.is_ascii_digit()));
        if !is_process {
            continue;
        }
        // A process whose file has disappeared ended during this loop.
        let Ok(stat) = fs::read_to_string(entry.path().join("stat")) else { continue };
        if let Some((group, seconds)) = group_and_seconds(&stat) {
            *groups.entry(group).or_default() += seconds;
        }
    }
    Some(groups)
}

/// Returns the CPU time that a process has used so far, s. `None` where the system does not report it.
pub(crate) fn cpu_seconds(process: u32) -> Option<f64> {
    group_and_seconds(&fs::read_to_string(format!("/proc/{process}/stat")).ok()?).map(|(_, seconds)| seconds)
}

/// Reads a line of `/proc/PID/stat`. Returns the process group, and the CPU time (s) of the process and of its ended children; see
/// proc_pid_stat(5).
fn group_and_seconds(stat: &str) -> Option<(i32, f64)> {
    // The second field is the program's name in parentheses. The name may itself contain spaces and parentheses.
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

//! Tests that memory does not grow with the number of frames.

use std::process::{Child, Stdio};

use crate::support::{jabuka, scene};

/// Returns the peak memory of a process, bytes. The kernel's high-water mark never falls, so the last value read before the process ends
/// counts.
pub(crate) fn peak(mut child: Child) -> u64 {
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0;
    while child.try_wait().unwrap().is_none() {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let mark = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kibibytes = mark.and_then(|mark| mark.trim().strip_suffix(" kB")?.trim().parse::<u64>().ok());
        peak = kibibytes.map_or(peak, |kib| kib * 1024).max(peak);
        // Pause, so that this loop takes no processor time from the measured process.
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    assert!(child.wait().unwrap().success());
    peak
}

#[test]
fn ten_thousand_frames_need_the_memory_of_a_hundred() {
    compare(10_000, &[]);
}

#[test]
fn nor_do_the_moments_of_blurred_ones_add_up() {
    compare(2_000, &["--set", "camera.shutter=0.02", "--set", "camera.samples=10"]);
}

fn compare(frames: u32, arguments: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let compile = |frames: u32| {
        let duration = format!("simulation.duration={}", f64::from(frames - 1) / 25.0);
        let child = jabuka()
            .arg("compile")
            .arg(scene("damped_spring"))
            .args(["--set", &duration, "-o"])
            .arg(folder.path().join(frames.to_string()))
            .args(arguments)
            .stdout(Stdio::null())
            .spawn();
        peak(child.unwrap())
    };
    // The last reading before a short process ends may come before its peak, above all on a busy machine.
    let few = (0..5).map(|_| compile(100)).max().unwrap_or(0);
    let many = compile(frames);
    assert!(few > 1_000_000, "a process needs more than {few} bytes: nothing was measured");
    // Each frame keeps 40 bytes for its size and digest, and about 12 for the position of its state. The readings may differ by about 1 MB.
    let most = few as f64 * 1.1 + 1e6 + 60.0 * f64::from(frames);
    assert!(many as f64 <= most, "100 frames need {few} bytes, {frames} frames {many}");
}

//! Tests of long runs: memory does not grow with them, and the page works while they continue.

use std::fs;

use crate::http::begun;
use crate::server::{Scene, Server};

const BODIES: u64 = 10_000;
const FRAMES: u64 = 1_000;

/// A scene with few steps per frame and without contacts, that still runs long enough for a page to be opened.
const MANY: &str = "
    [simulation]
    duration = 9.99
    frame_rate = 100
    step = 0.0005
    integrator = 'euler-cromer'
    gravity = [0, -10, 0]
    [body.ball]
    shape.sphere.radius = 0.1
    repeat.grid = { count = [100, 100], spacing = [1, 1] }
    ";

/// Returns the peak memory of a server so far, bytes.
fn peak(server: &Server) -> u64 {
    let status = fs::read_to_string(format!("/proc/{}/status", server.process())).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    line.trim().strip_suffix(" kB").unwrap().parse::<u64>().unwrap() * 1024
}

/// Sends a GET request, and reads the answer piece by piece without keeping it. Returns the number of bytes.
fn count(port: u16, path: &str) -> u64 {
    let (mut stream, head) = begun(port, "GET", path, &format!("Host: 127.0.0.1:{port}\r\n"), "");
    assert_eq!(head.status, 200);
    head.body.len() as u64 + std::io::copy(&mut stream, &mut std::io::sink()).unwrap()
}

#[test]
fn the_page_works_while_the_run_goes_on() {
    let server = Scene::of(MANY).served();
    // A second client receives all poses from the first frame on, as soon as they are computed.
    let poses = std::thread::scope(|scope| {
        let streamed = scope.spawn(|| {
            server.wait_for_the_run();
            count(server.port(), &format!("/api/runs/1/poses?token={}", server.token()))
        });
        server.shows("large.mjs", "the_page_works_while_the_run_goes_on");
        streamed.join().unwrap()
    });
    assert_eq!(poses, BODIES * FRAMES * 7 * 8);
    // Only Linux has `/proc` with the peak memory.
    if cfg!(target_os = "linux") {
        let peak = peak(&server);
        assert!(peak < 300_000_000, "{peak}");
    }
}

/// A scene whose run does not finish during a test. The positions of labels are known only when a run is finished.
const ENDLESS: &str = "
    [simulation]
    duration = 1e4
    frame_rate = 10
    step = 1e-6
    [body.ball]
    shape.sphere.radius = 1
    velocity = [1, 0, 0]
    [label.clock]
    text = '${t:.1}'
    ";

in_the_browser! { Scene::of(ENDLESS), "large.mjs":
    what_is_shown_beside_bodies_does_not_hold_up_a_run_that_goes_on,
}

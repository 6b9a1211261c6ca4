//! Many bodies for a long time: memory does not grow with them, and the page need not wait.

use std::fs;

use crate::http::{count, get};
use crate::server::{Scene, Server};

const BODIES: u64 = 10_000;
const FRAMES: u64 = 1_000;

/// One step a frame, and nothing that could meet.
const MANY: &str = "
    [simulation]
    duration = 9.99
    frame_rate = 100
    step = 0.01
    integrator = 'euler-cromer'
    gravity = [0, -10, 0]
    [body.ball]
    shape.sphere.radius = 0.1
    repeat.grid = { count = [100, 100], spacing = [1, 1] }
    ";

/// The most memory that a server has needed so far, in bytes.
fn peak(server: &Server) -> u64 {
    let status = fs::read_to_string(format!("/proc/{}/status", server.process())).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    line.trim().strip_suffix(" kB").unwrap().parse::<u64>().unwrap() * 1024
}

#[test]
fn the_page_works_while_the_run_goes_on() {
    let server = Scene::of(MANY).served();
    // Another page has all poses sent to it, from the first frame on, as soon as they are there.
    let poses = std::thread::scope(|scope| {
        let streamed = scope.spawn(|| {
            let of_run = |what: &str| format!("/api/runs/1{what}?token={}", server.token());
            while get(server.port(), &of_run("")).status != 200 {
                std::thread::yield_now();
            }
            count(server.port(), &of_run("/poses"))
        });
        server.shows("large.mjs", "the_page_works_while_the_run_goes_on");
        streamed.join().unwrap()
    });
    assert_eq!(poses, BODIES * FRAMES * 7 * 8);
    // There is no such list elsewhere.
    if cfg!(target_os = "linux") {
        let peak = peak(&server);
        println!("{} MB", peak / 1_000_000);
        assert!(peak < 300_000_000, "{peak}");
    }
}

//! Tests of the command `jabuka preview`: how it starts, and how it ends.

use std::fs;

use crate::http::get;
use crate::server::{Scene, wait_until};
use crate::support::{jabuka, stderr, stdout};

fn parabola() -> Scene {
    Scene::gallery("parabola")
}

#[test]
fn ctrl_c_ends_it_even_while_pages_are_open() {
    let server = parabola().served();
    let events = format!("/api/events?token={}", server.token());
    // The test stops reading, but keeps the connection open.
    let mut open = std::net::TcpStream::connect(("127.0.0.1", server.port())).unwrap();
    let request = format!("GET {events} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", server.port());
    std::io::Write::write_all(&mut open, request.as_bytes()).unwrap();
    let mut first = [0; 1];
    std::io::Read::read_exact(&mut open, &mut first).unwrap();
    // An interrupted command has the exit code 130, as other commands have.
    assert_eq!(server.ended_by("INT").code(), Some(130));
    assert_eq!(parabola().served().ended_by("TERM").code(), Some(130));
}

#[test]
fn ctrl_c_ends_it_in_the_middle_of_a_run() {
    let endless = "simulation.duration = 1000\nsimulation.step = 1e-6\nsimulation.frame_rate = 1\n[body.ball]\nshape.sphere.radius = 1\n";
    assert_eq!(Scene::of(endless).served().ended_by("INT").code(), Some(130));
}

#[test]
fn a_port_that_is_taken_is_an_error() {
    let server = parabola().served();
    let port = server.port().to_string();
    let mut second = jabuka();
    second.arg("preview").arg(server.scene.path()).args(["--no-open", "--port", &port]);
    let output = second.current_dir(server.scene.folder()).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(stdout(&output), "");
    let said = stderr(&output);
    let expected = format!("error: the page cannot be served on port {port}: Address already in use");
    assert!(said.starts_with(&expected), "{said}");
    // The first server must still answer.
    assert_eq!(get(server.port(), "/").status, 200);
}

#[test]
fn the_port_is_the_one_that_is_asked_for() {
    let free = parabola().served();
    let port = free.port();
    drop(free);
    // Another program may have taken the port meanwhile; the test above covers this case.
    let output = parabola().previewed_with(&["--port", &port.to_string()]).served();
    assert_eq!(output.port(), port);
    assert_ne!(parabola().previewed_with(&["--port", "0"]).served().port(), 0);
}

#[test]
fn a_scene_that_is_not_there_is_the_error_of_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let said = |arguments: &[&str]| {
        let output = jabuka().args(arguments).current_dir(folder.path()).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        stderr(&output)
    };
    let missing = said(&["preview", "nowhere.toml", "--no-open"]);
    assert!(missing.contains("nowhere.toml"), "{missing}");
    assert_eq!(missing, said(&["compile", "nowhere.toml"]));
    fs::create_dir(folder.path().join("folder.toml")).unwrap();
    assert_eq!(said(&["preview", "folder.toml", "--no-open"]), said(&["compile", "folder.toml"]));
}

#[test]
fn two_at_once_keep_to_themselves() {
    let (one, two) = (parabola().served(), Scene::gallery("hammer").served());
    one.wait_for_the_run();
    two.wait_for_the_run();
    assert_ne!(one.port(), two.port());
    assert_ne!(one.token(), two.token());
    let run = |of: &crate::server::Server, token: &str| get(of.port(), &format!("/api/runs/1?token={token}"));
    assert_eq!(run(&one, two.token()).status, 403);
    assert!(run(&one, one.token()).text().contains("Parabola"));
    assert!(!run(&two, two.token()).text().contains("Parabola"));
}

/// Checks that a server starts even if its scene is invalid: the page shows the errors.
#[test]
fn it_says_its_address_and_what_is_wrong() {
    let server = Scene::of("[body.ball]\nshape.sphere.radius = -1\n").served();
    assert_eq!(get(server.port(), "/").status, 200);
    let check = server.scene.jabuka(&["check"]).arg(server.scene.path()).output().unwrap();
    let error = stderr(&check).lines().next().unwrap().to_owned();
    wait_until(&error, || server.said().contains(&error));
}

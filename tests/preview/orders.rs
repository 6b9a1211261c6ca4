//! Tests of what a previewed scene, and a request for another method, are allowed to do.

use crate::http::{ask, get};
use crate::server::{Scene, wait_until};
use crate::support::stderr;

/// Checks that the preview needs `--trust` for the same scenes as every other command, since a user may preview a scene by somebody else.
#[test]
fn what_a_scene_may_do_needs_trust_as_in_every_command() {
    let scenes = [
        "[povray]\nsdl = '#fopen F \"/tmp/x\" write'\n[body.ball]\nshape.sphere.radius = 1\n",
        "include = ['../elsewhere.toml']\n",
    ];
    for text in scenes {
        let server = Scene::of(text).served();
        let compile = server.scene.jabuka(&["compile"]).arg(server.scene.path()).output().unwrap();
        assert!(!compile.status.success());
        let said = stderr(&compile);
        let error = said.rsplit_once("\nnothing was written").map_or(&*said, |(error, _)| error).trim();
        assert!(error.starts_with("error["), "{error}");
        wait_until(error, || server.said().lines().count() >= error.lines().count());
        assert!(server.said().contains(error), "{}\n… is not …\n{error}", server.said());
        assert_eq!(get(server.port(), &format!("/api/runs/1?token={}", server.token())).status, 404);
    }
}

/// Checks that a request for another method can change only the method and its step.
#[test]
fn an_order_cannot_change_more_of_a_scene_than_its_method() {
    let server = Scene::gallery("parabola").served();
    server.wait_for_the_run();
    let path = format!("/api/variants?token={}", server.token());
    let headers = format!("Host: 127.0.0.1:{}\r\nContent-Type: application/json\r\n", server.port());
    for step in ["1\\n[povray]\\nsdl='#fopen F'", "0.1, povray.sdl='x'", "{}", "[0.1]", "nan"] {
        let order = format!(r#"{{"integrator":"rk4","step":"{step}"}}"#);
        let answer = ask(server.port(), "POST", &path, &headers, &order);
        assert_eq!(answer.status, 422, "{step}: {}", answer.text());
    }
}

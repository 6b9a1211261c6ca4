//! Pages of others, and words in a scene that would like to be more than words.

use crate::http::{ask, get};
use crate::in_the_browser;
use crate::server::Scene;
use crate::support::stderr;

in_the_browser! { Scene::gallery("parabola"), "strangers.mjs":
    a_page_of_another_origin_gets_nothing_even_with_the_token,
    a_page_without_the_token_says_what_to_open,
    a_name_that_is_let_point_here_gets_nothing,
}

const HTML: &str = r#"
    title = "<img src=x onerror=alert(2)>"
    [simulation]
    duration = 1
    [body."<script>alert(1)</script>"]
    shape.sphere.radius = 1
    force = [1, 0, 0]
    [label.clock]
    text = "<b>bold</b> ${t:.2}"
    [label.beside]
    text = "<i onclick=alert(4)>"
    body = "<script>alert(1)</script>"
    "#;

in_the_browser! { Scene::of(HTML), "strangers.mjs":
    names_titles_and_labels_are_shown_as_text,
}

in_the_browser! { Scene::of("[body.ball]\n\"<img src=x onerror=alert(3)>\" = 1\n"), "strangers.mjs":
    a_mistake_with_html_in_it_is_shown_as_text,
}

/// The page may be open while somebody else's scene is looked at.
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
        while server.said().lines().count() < error.lines().count() {
            std::thread::yield_now();
        }
        assert!(server.said().contains(error), "{}\n… is not …\n{error}", server.said());
        assert_eq!(get(server.port(), &format!("/api/runs/1?token={}", server.token())).status, 404);
    }
}

/// An order is a method and a step, and can set nothing else.
#[test]
fn an_order_cannot_change_more_of_a_scene_than_its_method() {
    let server = Scene::gallery("parabola").served();
    let path = format!("/api/variants?token={}", server.token());
    let headers = format!("Host: 127.0.0.1:{}\r\nContent-Type: application/json\r\n", server.port());
    for step in ["1\\n[povray]\\nsdl='#fopen F'", "0.1, povray.sdl='x'", "{}", "[0.1]", "1e999", "nan"] {
        let order = format!(r#"{{"integrator":"rk4","step":"{step}"}}"#);
        let answer = ask(server.port(), "POST", &path, &headers, &order);
        assert_eq!(answer.status, 422, "{step}: {}", answer.text());
    }
}

//! Tests of attacks: web pages of others that contact the server, and texts in a scene that contain HTML.

use crate::server::Scene;

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

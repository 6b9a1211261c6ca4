//! Tests of the access to the preview's server: it answers only its own page, and only with the token.

use std::io::{Read as _, Write as _};
use std::net::{IpAddr, SocketAddr, TcpStream, UdpSocket};
use std::time::Duration;

use jabuka::page::FILES;

use crate::http::{Answer, ask, get};
use crate::server::{Scene, Server};
use crate::support::root;

/// A scene with an unusual name, so that a leak of it is noticed.
const SECRET: &str = "title = 'Sekret'\nsimulation.duration = 1\n[body.sekret]\nshape.sphere.radius = 1\n\
    [variables]\nsize = { value = 1, min = 0, max = 2 }\n";

/// Starts a server, and waits until it has begun the run of its scene.
fn server() -> Server {
    let server = Scene::of(SECRET).served();
    server.wait_for_the_run();
    server
}

/// Requests as pairs of method and path.
type Asked = Vec<(&'static str, String)>;

/// Returns the paths of the server's interface, read from its source code, with a run and a body inserted, and those of the files of its page.
fn paths() -> (Asked, Asked) {
    let read = |file: &str| std::fs::read_to_string(root().join("src").join(file)).unwrap();
    let (routes, answers) = (read("preview/routes.rs"), read("page/answers.rs"));
    let of_api = routes.split(".route(\"").skip(1).map(|rest| {
        let (path, after) = rest.split_once('"').unwrap();
        (if after.contains("post(") && after.find("post(") < after.find('\n') { "POST" } else { "GET" }, path)
    });
    // The last part of a path names one of the answers about a run.
    let whats: Vec<&str> =
        answers.split("\n        \"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    let api: Vec<_> = of_api
        .flat_map(|(method, path)| {
            let path = path.replace("{id}", "1");
            match path.strip_suffix("{what}") {
                Some(path) => whats.iter().map(|what| (method, format!("{path}{what}"))).collect(),
                None => vec![(method, path)],
            }
        })
        .filter(|(_, path)| !path.ends_with('/'))
        .collect();
    let files: Vec<_> = FILES.iter().map(|(path, ..)| ("GET", (*path).to_owned())).collect();
    assert!(api.len() >= 12 && api.iter().all(|(_, path)| path.starts_with("/api/")), "{api:?}");
    assert!(api.iter().filter(|(method, _)| *method == "POST").count() == 4, "{api:?}");
    assert!(files.len() >= 60, "{files:?}");
    (api, files)
}

/// Returns the body of a request that saves the text that the file has, or asks for another integration method, an image, or another value
/// of a variable.
fn order() -> String {
    let order = serde_json::json!({
        "text": SECRET, "base": "", "integrator": "rk4", "step": "", "run": "1", "frame": 0, "variable": "size", "value": 1.5
    });
    order.to_string()
}

fn host(port: u16) -> String {
    format!("Host: 127.0.0.1:{port}\r\nContent-Type: application/json\r\n")
}

/// Asserts that an answer has this status and contains nothing of the scene.
fn assert_refused(answer: &Answer, status: u16, what: &str) {
    assert_eq!(answer.status, status, "{what}: {}", answer.text());
    assert!(!answer.text().to_lowercase().contains("sekret"), "{what}: {}", answer.text());
    assert!(answer.body.len() < 120, "{what}: {}", answer.text());
}

#[test]
fn another_host_is_refused_on_every_path() {
    let server = server();
    let (port, token) = (server.port(), server.token());
    let (api, files) = paths();
    for (method, path) in api.into_iter().chain(files) {
        for host in [
            format!("evil.example:{port}"),
            "evil.example".to_owned(),
            format!("127.0.0.1.evil.example:{port}"),
            "0.0.0.0".to_owned(),
        ] {
            let path = format!("{path}?token={token}");
            let answer = ask(
                port,
                method,
                &path,
                &format!("Host: {host}\r\nContent-Type: application/json\r\n"),
                &order(),
            );
            assert_refused(&answer, 403, &format!("{host} {path}"));
        }
        let nameless = ask(port, method, &format!("{path}?token={token}"), "", &order());
        assert_refused(&nameless, 403, &path);
    }
}

#[test]
fn nobody_is_told_of_the_scene_without_the_token() {
    let server = server();
    let (port, token) = (server.port(), server.token());
    let other: String = token.chars().rev().collect();
    let longer = format!("{token}0");
    let wrong = [
        "".to_owned(),
        "?token=".to_owned(),
        format!("?token={other}"),
        format!("?token={longer}"),
        format!("?token={}", &token[1..]),
        format!("?tokens={token}"),
        format!("?token={}", token.to_uppercase()),
    ];
    assert_ne!(token.to_uppercase(), token, "one without letters comes once in millions of starts");
    for (method, path) in paths().0 {
        for wrong in &wrong {
            let answer = ask(port, method, &format!("{path}{wrong}"), &host(port), &order());
            assert_refused(&answer, 403, &format!("{path}{wrong}"));
        }
    }
}

#[test]
fn the_page_itself_knows_nothing_of_the_scene() {
    let server = server();
    for (_, path) in paths().1 {
        let answer = get(server.port(), &path);
        assert_eq!(answer.status, 200, "{path}");
        let text = answer.text();
        assert!(!text.to_lowercase().contains("sekret") && !text.contains(server.token()), "{path}");
    }
}

#[test]
fn a_page_of_another_origin_is_refused_even_with_the_token() {
    let server = server();
    let (port, token) = (server.port(), server.token());
    let (api, files) = paths();
    let foreign = [
        "http://evil.example".to_owned(),
        format!("http://127.0.0.1:{}", port ^ 1),
        format!("http://localhost:{port}"),
        format!("https://127.0.0.1:{port}"),
        "null".to_owned(),
    ];
    for (method, path) in api.into_iter().chain(files) {
        for origin in &foreign {
            let headers = format!("{}Origin: {origin}\r\n", host(port));
            let answer = ask(port, method, &format!("{path}?token={token}"), &headers, &order());
            assert_refused(&answer, 403, &format!("{origin} {path}"));
            assert_eq!(answer.header("access-control-allow-origin"), None);
        }
        let asked_first =
            format!("{}Origin: http://evil.example\r\nAccess-Control-Request-Method: POST\r\n", host(port));
        let answer = ask(port, "OPTIONS", &format!("{path}?token={token}"), &asked_first, "");
        assert_refused(&answer, 403, &path);
        assert_eq!(answer.header("access-control-allow-origin"), None);
    }
}

#[test]
fn its_own_page_is_answered() {
    let server = server();
    let (port, token) = (server.port(), server.token());
    for (method, path) in paths().0.into_iter().filter(|(_, path)| path != "/api/render") {
        let headers = format!("{}Origin: http://127.0.0.1:{port}\r\n", host(port));
        let answer = ask(port, method, &format!("{path}?token={token}"), &headers, &order());
        assert_eq!(answer.status, 200, "{path}: {}", answer.text());
    }
}

#[test]
fn every_answer_says_what_a_page_may_do_with_it() {
    let server = server();
    let (port, token) = (server.port(), server.token());
    let mut asked: Vec<(&str, String, u16)> = vec![
        ("GET", "/nowhere".to_owned(), 404),
        ("GET", format!("/api/runs/99?token={token}"), 404),
        ("GET", format!("/api/runs/x?token={token}"), 400),
        ("POST", format!("/api/runs/1?token={token}"), 405),
        ("GET", "/api/runs/1".to_owned(), 403),
        ("GET", format!("/api/runs/1?token={token}"), 200),
        ("GET", format!("/api/events?token={token}"), 200),
        ("POST", format!("/api/variants?token={token}"), 422),
    ];
    asked.extend(paths().1.into_iter().map(|(method, path)| (method, path, 200)));
    for (method, path, status) in asked {
        let answer = ask(port, method, &path, &host(port), r#"{"integrator":"none","step":""}"#);
        assert_eq!(answer.status, status, "{path}: {}", answer.text());
        let policy = answer.header("content-security-policy").unwrap();
        for rule in [
            "default-src 'none'",
            "script-src 'self'",
            "connect-src 'self'",
            "base-uri 'none'",
            "form-action 'none'",
            "frame-ancestors 'none'",
        ] {
            assert!(policy.contains(rule), "{path}: {policy}");
        }
        assert!(!policy.contains("unsafe"), "{path}: {policy}");
        let others = [
            ("x-content-type-options", "nosniff"),
            ("referrer-policy", "no-referrer"),
            ("cache-control", "no-store"),
            ("x-frame-options", "DENY"),
            ("cross-origin-resource-policy", "same-origin"),
        ];
        for (name, value) in others {
            assert_eq!(answer.header(name), Some(value), "{path}");
        }
    }
}

/// Returns this machine's addresses that other machines can reach, as far as they can be found without sending anything.
fn reachable() -> Vec<IpAddr> {
    let toward = |from: &str, to: &str| {
        let socket = UdpSocket::bind(from).ok()?;
        socket.connect(to).ok()?;
        Some(socket.local_addr().ok()?.ip())
    };
    // These addresses are reserved for examples. Connecting a UDP socket sends nothing; it only chooses the local address for the route.
    let found = [toward("0.0.0.0:0", "192.0.2.1:9"), toward("[::]:0", "[2001:db8::1]:9")];
    found.into_iter().flatten().filter(|address| !address.is_loopback()).collect()
}

#[test]
fn it_listens_on_the_loopback_address_alone() {
    let server = server();
    let port = server.port();
    let others = ["127.0.0.2".parse().unwrap(), "::1".parse().unwrap()];
    for address in reachable().into_iter().chain(others) {
        let tried = TcpStream::connect_timeout(&SocketAddr::new(address, port), Duration::from_secs(2));
        assert!(tried.is_err(), "{address} answers");
    }
    // The kernel's table lists the address and the port of every listening socket.
    let Ok(table) = std::fs::read_to_string("/proc/net/tcp") else { return };
    let listens = |line: &&str| line.split_whitespace().nth(3) == Some("0A");
    let locals: Vec<&str> =
        table.lines().filter(listens).filter_map(|line| line.split_whitespace().nth(1)).collect();
    let here: Vec<&&str> = locals.iter().filter(|local| local.ends_with(&format!(":{port:04X}"))).collect();
    assert_eq!(here, [&format!("0100007F:{port:04X}")]);
}

/// Checks that connections without a whole request are closed, and that they keep no page from being served.
#[test]
fn requests_that_are_not_sent_to_their_end_are_given_up() {
    let server = Scene::gallery("parabola").served();
    let (port, token) = (server.port(), server.token());
    let host = format!("Host: 127.0.0.1:{port}\r\n");
    let begin = |text: &str| {
        let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        stream.write_all(text.as_bytes()).unwrap();
        stream
    };
    let body = format!("POST /api/render?token={token} HTTP/1.1\r\n{host}Content-Length: 100\r\n\r\n{{");
    let head = format!("GET / HTTP/1.1\r\n{host}");
    let mut begun = [begin(""), begin("G"), begin(&head), begin(&body), begin(&format!("{head}\r\n"))];
    let silent: Vec<TcpStream> = (0..150).map(|_| begin("")).collect();
    let answers = begun.each_mut().map(|stream| {
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer.lines().next().unwrap_or_default().to_owned()
    });
    assert_eq!(answers[..2], ["", ""]);
    // The server may say why it gives up, or close the connection at once.
    for (answer, status) in [(2, "408"), (3, "408")] {
        let answer = &answers[answer];
        assert!(answer.is_empty() || answer.starts_with(&format!("HTTP/1.1 {status} ")), "{answer}");
    }
    assert_eq!(answers[4], "HTTP/1.1 200 OK", "a connection that is not used any more is closed, too");
    assert_eq!(get(port, "/").status, 200);
    drop(silent);
}

//! HTTP requests that need no browser.

use std::io::{Read as _, Write as _};
use std::net::TcpStream;

/// The server's answer to a request.
pub(crate) struct Answer {
    pub(crate) status: u16,
    /// The headers as pairs of name and value; names are in lower case.
    headers: Vec<(String, String)>,
    pub(crate) body: Vec<u8>,
}

impl Answer {
    pub(crate) fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    pub(crate) fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }
}

/// Sends a request to a port of this machine, and reads the answer. `headers` are all headers that are sent, each with its line break.
pub(crate) fn ask(port: u16, method: &str, path: &str, headers: &str, body: &str) -> Answer {
    let (mut stream, head) = begun(port, method, path, headers, body);
    let mut answer = head;
    // The event stream never ends, so only its head is read.
    if answer.header("content-type") != Some("text/event-stream") {
        stream.read_to_end(&mut answer.body).unwrap();
    }
    answer
}

/// Sends a GET request with the headers that the page sends.
pub(crate) fn get(port: u16, path: &str) -> Answer {
    ask(port, "GET", path, &format!("Host: 127.0.0.1:{port}\r\n"), "")
}

/// Sends a request. Returns the connection and the answer with its head, and with the part of the body that arrived together with the
/// head.
pub(crate) fn begun(port: u16, method: &str, path: &str, headers: &str, body: &str) -> (TcpStream, Answer) {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    // With HTTP/1.0, an answer ends with the connection and is not split into chunks.
    let length = body.len();
    let request = format!(
        "{method} {path} HTTP/1.0\r\n{headers}Content-Length: {length}\r\nConnection: close\r\n\r\n{body}"
    );
    stream.write_all(request.as_bytes()).unwrap();
    let mut bytes = Vec::new();
    let mut piece = [0; 4096];
    let end = loop {
        let read = stream.read(&mut piece).unwrap();
        assert!(read > 0, "{path}: {}", String::from_utf8_lossy(&bytes));
        bytes.extend_from_slice(&piece[..read]);
        if let Some(end) = bytes.windows(4).position(|four| four == b"\r\n\r\n") {
            break end;
        }
    };
    let head = String::from_utf8(bytes[..end].to_vec()).unwrap();
    let mut lines = head.lines();
    let status = lines.next().unwrap().split(' ').nth(1).unwrap().parse().unwrap();
    let pair = |line: &str| {
        let (name, value) = line.split_once(": ").unwrap();
        (name.to_lowercase(), value.to_owned())
    };
    (stream, Answer { status, headers: lines.map(pair).collect(), body: bytes[end + 4..].to_vec() })
}

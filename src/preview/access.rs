//! Access control: only the page that the user has opened can send requests to the server.
//!
//! The server listens only on the loopback address, but other web pages run on the same machine. Any of them can send requests to the
//! server. If the host name of a page resolves to 127.0.0.1, the page can even read the answers. So a request must meet three conditions:
//! its host is a name of this machine; its origin, if the browser sends one, is this host; and it contains the token. Each start of the
//! server makes a new token. Only the files of the page itself, which contain nothing of the scene, need no token.

use axum::http::header::{HOST, ORIGIN};
use axum::http::{HeaderMap, Uri};

/// The secret token that requests must contain.
#[derive(Clone)]
pub(super) struct Token(String);

/// The reason why a request is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refused {
    /// The host in the request is not a name of this machine.
    Host,
    /// The request comes from another web page.
    Origin,
    /// The token is missing or wrong.
    Token,
}

impl Refused {
    /// Returns the reason as a message of one line.
    pub(super) fn message(self) -> &'static str {
        match self {
            Refused::Host => "this server answers to 127.0.0.1 and localhost only\n",
            Refused::Origin => "this server answers to its own page only\n",
            Refused::Token => {
                "the token is missing or wrong: open the address that `jabuka preview` has printed\n"
            }
        }
    }
}

impl Token {
    /// Makes a new token from 128 random bits of the system.
    pub(super) fn new() -> std::io::Result<Token> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes)?;
        Ok(Token(bytes.iter().map(|byte| format!("{byte:02x}")).collect()))
    }

    /// Returns the token as it appears in the address of the page.
    pub(super) fn as_str(&self) -> &str {
        &self.0
    }

    /// Checks that the query of a request contains the token.
    pub(super) fn admits(&self, uri: &Uri) -> Result<(), Refused> {
        let query = uri.query().unwrap_or_default();
        let given = query.split('&').find_map(|pair| pair.strip_prefix("token=")).unwrap_or_default();
        // The comparison takes constant time, so that the time does not reveal how much of a guessed token is right.
        let differs = given.bytes().zip(self.0.bytes()).fold(0, |differs, (a, b)| differs | (a ^ b));
        if given.len() == self.0.len() && differs == 0 { Ok(()) } else { Err(Refused::Token) }
    }
}

/// Checks that a request comes from a page of this server, or from no page. The port is not checked against the server's, since it may be
/// forwarded.
pub(super) fn is_own(headers: &HeaderMap) -> Result<(), Refused> {
    let text = |name| headers.get(name).map(|value| value.to_str().unwrap_or_default());
    let host = text(HOST).unwrap_or_default();
    if !is_loopback(host) {
        return Err(Refused::Host);
    }
    match text(ORIGIN) {
        Some(origin) if origin.strip_prefix("http://") != Some(host) => Err(Refused::Origin),
        _ => Ok(()),
    }
}

/// Returns true if a host, with or without a port, is a loopback name or address. No other machine can have such a name.
fn is_loopback(host: &str) -> bool {
    let is_port = |port: &str| port.parse::<u16>().is_ok();
    ["127.0.0.1", "localhost", "[::1]"].into_iter().any(|own| match host.strip_prefix(own) {
        Some("") => true,
        Some(rest) => rest.strip_prefix(':').is_some_and(is_port),
        None => false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(host: &str, origin: Option<&str>) -> Result<(), Refused> {
        let mut headers = HeaderMap::new();
        headers.insert(HOST, host.parse().unwrap());
        origin.map(|origin| headers.insert(ORIGIN, origin.parse().unwrap()));
        is_own(&headers)
    }

    #[test]
    fn hosts_are_names_of_this_machine_with_any_port() {
        for host in ["127.0.0.1", "127.0.0.1:8080", "localhost:1", "[::1]:65535"] {
            assert_eq!(asked(host, None), Ok(()), "{host}");
        }
        for host in
            ["evil.example", "127.0.0.1.evil.example", "localhost:99999", "localhost:", "127.0.0.2", ""]
        {
            assert_eq!(asked(host, None), Err(Refused::Host), "{host}");
        }
        assert_eq!(is_own(&HeaderMap::new()), Err(Refused::Host));
    }

    #[test]
    fn pages_of_other_origins_are_refused() {
        assert_eq!(asked("localhost:80", Some("http://localhost:80")), Ok(()));
        for origin in ["http://evil.example", "http://localhost:81", "https://localhost:80", "null", ""] {
            assert_eq!(asked("localhost:80", Some(origin)), Err(Refused::Origin), "{origin}");
        }
    }

    #[test]
    fn tokens_differ_and_admit_nobody_else() {
        let (token, other) = (Token::new().unwrap(), Token::new().unwrap());
        let asked = |query: &str| token.admits(&format!("/api/events?{query}").parse().unwrap());
        assert_eq!(asked(&format!("token={}", token.as_str())), Ok(()));
        assert_eq!(asked(&format!("from=3&token={}", token.as_str())), Ok(()));
        for query in
            ["", "token=", &format!("token={}", other.as_str()), &format!("token={}0", token.as_str())]
        {
            assert_eq!(asked(query), Err(Refused::Token), "{query}");
        }
    }
}

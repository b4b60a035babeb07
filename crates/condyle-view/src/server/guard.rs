//! Who may ask: the token in the address, the headers `Host` and `Origin`.

use axum::http::{HeaderMap, Uri, header};
use std::io;

/// What every request must have.
#[derive(Debug)]
pub(super) struct Guard {
    port: u16,
    /// 128 random bits in hexadecimal digits.
    token: String,
}

impl Guard {
    pub(super) fn new(port: u16) -> io::Result<Self> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(io::Error::other)?;
        let token = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self { port, token })
    }

    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// Whether this server is what a client says that it talks to.
    fn is_host(&self, host: &str) -> bool {
        let (name, port) = match host.rsplit_once(':') {
            Some((name, port)) => (name, port.parse().ok()),
            None => (host, Some(80)),
        };
        (name == "127.0.0.1" || name.eq_ignore_ascii_case("localhost")) && port == Some(self.port)
    }

    /// Whether a request comes to this server, and from its own page or from none.
    pub(super) fn admits(&self, uri: &Uri, headers: &HeaderMap) -> bool {
        let mut hosts = headers.get_all(header::HOST).iter();
        let host = hosts.next().and_then(|host| host.to_str().ok());
        let one_host = hosts.next().is_none() && host.is_some_and(|host| self.is_host(host));
        let same_target = uri.authority().is_none_or(|target| self.is_host(target.as_str()));
        let own = |origin: &axum::http::HeaderValue| {
            let origin = origin.to_str().unwrap_or_default();
            origin.strip_prefix("http://").is_some_and(|host| self.is_host(host))
        };
        let own_origin = headers.get_all(header::ORIGIN).iter().all(own);
        // Browsers say which page a request without an origin comes from.
        let site = headers.get("sec-fetch-site").map(|site| site.as_bytes());
        let own_site = matches!(site, None | Some(b"same-origin" | b"none"));
        one_host && same_target && own_origin && own_site
    }

    /// What an address asks for behind the token; `None` without the right one.
    ///
    /// The time that this takes does not depend on how much of a token is right.
    pub(super) fn behind_token<'p>(&self, path: &'p str) -> Option<&'p str> {
        let (given, rest) = path.strip_prefix('/')?.split_once('/')?;
        let same_length = given.len() == self.token.len();
        let differ = given.bytes().zip(self.token.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
        (same_length && differ == 0).then_some(rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_this_server_is_asked_and_only_by_its_page() {
        let guard = Guard::new(8123).unwrap();
        let admits = |host: &'static str, origin: Option<&'static str>| {
            let mut headers = HeaderMap::new();
            headers.insert(header::HOST, host.parse().unwrap());
            if let Some(origin) = origin {
                headers.insert(header::ORIGIN, origin.parse().unwrap());
            }
            guard.admits(&Uri::from_static("/x/"), &headers)
        };
        assert!(admits("127.0.0.1:8123", None));
        assert!(admits("localhost:8123", Some("http://localhost:8123")));
        for host in [
            "127.0.0.1",
            "127.0.0.1:8124",
            "evil.example:8123",
            "127.0.0.1.evil.example:8123",
            "",
            "[::1]:8123",
        ] {
            assert!(!admits(host, None), "{host}");
        }
        for origin in
            ["https://127.0.0.1:8123", "http://evil.example", "null", "http://127.0.0.1:8124"]
        {
            assert!(!admits("127.0.0.1:8123", Some(origin)), "{origin}");
        }
        assert!(!guard.admits(&Uri::from_static("/x/"), &HeaderMap::new()));
    }

    #[test]
    fn a_token_is_long_drawn_anew_and_compared_whole() {
        let (one, other) = (Guard::new(1).unwrap(), Guard::new(1).unwrap());
        assert_eq!(one.token.len(), 32);
        assert_ne!(one.token, other.token);
        let path = format!("/{}/session.json", one.token);
        assert_eq!(one.behind_token(&path), Some("session.json"));
        assert_eq!(other.behind_token(&path), None);
        for path in ["", "/", "//", "/session.json", &path[..20], &format!("/{}", one.token)] {
            assert_eq!(one.behind_token(path), None, "{path}");
        }
    }
}

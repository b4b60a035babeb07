//! Requests that must change nothing and stop nothing; after each the page is still served.

use super::{Answer, LEG, Running};
use std::io::Write;
use std::time::{Duration, Instant};

/// That all is as it was.
fn unharmed(server: &Running, after: &str) {
    let answer = server.get("session.json");
    assert_eq!(answer.status, 200, "after {after}");
    assert!(String::from_utf8_lossy(&answer.body).contains("shank_l"), "after {after}");
    assert_eq!(server.text(), LEG, "after {after}");
    let files: Vec<_> = std::fs::read_dir(&server.folder).unwrap().collect();
    assert_eq!(files.len(), 1, "after {after}");
}

const EDIT: &str = r#"{"path":["segment","shank_r","at",1],"value":-0.5,"confirm":true}"#;

fn post(token: &str, headers: &str) -> String {
    format!(
        "POST /{token}/edit HTTP/1.1\r\n{headers}Connection: close\r\nContent-Length: {}\r\n\r\n{EDIT}",
        EDIT.len()
    )
}

#[test]
fn without_the_token_nothing_is_there() {
    let server = Running::start("token");
    let host = format!("Host: {}\r\n", server.host());
    let short = &server.token[..31];
    let wrong = format!("{short}{}", if server.token.ends_with('0') { '1' } else { '0' });
    for token in [
        "",
        "x",
        short,
        &wrong,
        &format!("{}0", server.token),
        &server.token.to_uppercase().replace(|c: char| c.is_ascii_digit(), "A"),
    ] {
        assert_eq!(server.raw(post(token, &host).as_bytes()).status, 404, "{token}");
        for wanted in ["", "session.json", "assets/page.js"] {
            let request =
                format!("GET /{token}/{wanted} HTTP/1.1\r\n{host}Connection: close\r\n\r\n");
            assert_eq!(server.raw(request.as_bytes()).status, 404, "{token}/{wanted}");
        }
        unharmed(&server, token);
    }
    for path in ["/", "*", "/favicon.ico", "/session.json", "/edit"] {
        let request = format!("GET {path} HTTP/1.1\r\n{host}Connection: close\r\n\r\n");
        assert!(matches!(server.raw(request.as_bytes()).status, 400 | 404), "{path}");
    }
    unharmed(&server, "other paths");
}

#[test]
fn other_hosts_and_origins_are_refused() {
    let server = Running::start("origin");
    let (own, token) = (server.host(), server.token.clone());
    let port = server.port;
    for host in [
        "evil.example".to_owned(),
        format!("evil.example:{port}"),
        format!("127.0.0.1.evil.example:{port}"),
        "127.0.0.1".into(),
        "127.0.0.1:1".into(),
        String::new(),
    ] {
        let answer = server.raw(post(&token, &format!("Host: {host}\r\n")).as_bytes());
        assert!(matches!(answer.status, 400 | 403), "{host}: {}", answer.status);
        unharmed(&server, &host);
    }
    // None, two, and one in the address.
    assert!(matches!(server.raw(post(&token, "").as_bytes()).status, 400 | 403));
    let two = format!("Host: {own}\r\nHost: evil.example\r\n");
    assert!(matches!(server.raw(post(&token, &two).as_bytes()).status, 400 | 403));
    let absolute = format!(
        "POST http://evil.example/{token}/edit HTTP/1.1\r\nHost: {own}\r\nConnection: close\r\nContent-Length: {}\r\n\r\n{EDIT}",
        EDIT.len()
    );
    assert_eq!(server.raw(absolute.as_bytes()).status, 403);
    unharmed(&server, "hosts");
    for origin in [
        "http://evil.example".to_owned(),
        "null".into(),
        format!("https://127.0.0.1:{port}"),
        "http://127.0.0.1:1".into(),
        format!("http://127.0.0.1:{port}.evil.example"),
    ] {
        let headers = format!("Host: {own}\r\nOrigin: {origin}\r\n");
        assert_eq!(server.raw(post(&token, &headers).as_bytes()).status, 403, "{origin}");
        unharmed(&server, &origin);
    }
    let other_site = format!("Host: {own}\r\nSec-Fetch-Site: cross-site\r\n");
    assert_eq!(server.raw(post(&token, &other_site).as_bytes()).status, 403);
    unharmed(&server, "another site");
    // Its own page may.
    let headers = format!(
        "Host: localhost:{port}\r\nOrigin: http://localhost:{port}\r\nSec-Fetch-Site: same-origin\r\n"
    );
    assert_eq!(server.raw(post(&token, &headers).as_bytes()).status, 200);
    assert_ne!(server.text(), LEG);
}

#[test]
fn no_path_leads_outside_the_page() {
    let server = Running::start("paths");
    let secret = server.folder.join("leg.toml");
    let absolute = secret.to_str().unwrap().to_owned();
    for wanted in [
        "../leg.toml",
        "assets/../leg.toml",
        "assets/../../leg.toml",
        "%2e%2e/leg.toml",
        "assets/%2e%2e/%2e%2e/leg.toml",
        "assets/..%2f..%2fleg.toml",
        "assets/%2fetc%2fpasswd",
        "assets//etc/passwd",
        "files/../leg.toml",
        "files/leg.toml",
        "files//etc/passwd",
        "files/%2e%2e%2fleg.toml",
        "files/..\\leg.toml",
        "..%5c..%5cleg.toml",
        "assets/page.js/",
        "assets/page.js%00",
        "assets/PAGE.JS",
        "assets/",
        "files/",
        "assets",
        "session.json/",
        "./session.json",
        "assets/..;/leg.toml",
        "%252e%252e/leg.toml",
        &format!("files/{absolute}"),
        &format!("assets/{absolute}"),
        &absolute,
    ] {
        let answer = server.get(wanted);
        assert!(matches!(answer.status, 400 | 404), "{wanted}: {}", answer.status);
        assert!(!String::from_utf8_lossy(&answer.body).contains("Dumas"), "{wanted}");
    }
    unharmed(&server, "paths");
    let page = server.get("");
    assert_eq!(page.status, 200);
    assert!(page.head.to_lowercase().contains("frame-ancestors 'none'"), "{}", page.head);
    assert!(String::from_utf8_lossy(&page.body).starts_with("<!doctype html>"));
    assert_eq!(server.get("assets/page.js").status, 200);
}

#[test]
fn a_gigabyte_is_not_read() {
    let server = Running::start("large");
    let (token, host) = (server.token.clone(), server.host());
    let begun = Instant::now();
    // Declared, and not sent.
    let declared = format!(
        "POST /{token}/edit HTTP/1.1\r\nHost: {host}\r\nContent-Length: 1073741824\r\n\r\n"
    );
    assert_eq!(server.raw(declared.as_bytes()).status, 413);
    unharmed(&server, "a length of 1 GB");
    // Sent in chunks without a length, until the server closes.
    let mut stream = server.connect();
    write!(
        stream,
        "POST /{token}/edit HTTP/1.1\r\nHost: {host}\r\nTransfer-Encoding: chunked\r\n\r\n"
    )
    .unwrap();
    let chunk = [b"10000\r\n".as_slice(), &[b' '; 0x10000], b"\r\n"].concat();
    let sent = (0..16_384).take_while(|_| stream.write_all(&chunk).is_ok()).count();
    assert!(sent < 1000, "{sent} chunks of 64 KiB were taken");
    drop(stream);
    unharmed(&server, "1 GB in chunks");
    // A length that is none, one that overflows, and both.
    for headers in [
        "Content-Length: -1",
        "Content-Length: 99999999999999999999999",
        "Content-Length: 1\r\nContent-Length: 2",
        "Transfer-Encoding: gzip",
        "Content-Length: 5\r\nTransfer-Encoding: chunked",
    ] {
        let request = format!(
            "POST /{token}/edit HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n{headers}\r\n\r\n0\r\n\r\n"
        );
        let answer = server.raw(request.as_bytes());
        assert!(matches!(answer.status, 0 | 400..=499 | 501), "{headers}: {}", answer.status);
        unharmed(&server, headers);
    }
    // A head without an end.
    let mut stream = server.connect();
    let _ = write!(stream, "GET /{token}/ HTTP/1.1\r\nHost: {host}\r\n");
    let line = format!("X-Filler: {}\r\n", "x".repeat(8000));
    let sent = (0..10_000).take_while(|_| stream.write_all(line.as_bytes()).is_ok()).count();
    assert!(sent < 1000, "{sent} lines of 8 kB were taken");
    unharmed(&server, "a head without an end");
    assert!(begun.elapsed() < Duration::from_secs(60));
}

#[test]
fn broken_messages_change_nothing() {
    let server = Running::start("broken");
    for (wanted, body) in [
        ("edit", ""),
        ("edit", "{"),
        ("edit", "[1, 2"),
        ("edit", "null"),
        ("edit", "\u{0}\u{0}\u{0}"),
        ("edit", r#"{"path":"segment","value":1}"#),
        ("edit", r#"{"path":["segment","shank_r","at",1],"value":"-0.5","confirm":true}"#),
        ("edit", r#"{"path":["segment","shank_r","at",1],"value":1e999,"confirm":true}"#),
        ("edit", r#"{"path":["segment","shank_r","at",99999999999999999999],"value":1}"#),
        ("add", r#"{"kind":"segment","name":"x\"]\n[segment.y","parent":"none"}"#),
        ("add", r#"{"kind":"wire","path":["include"],"value":"/etc/passwd"}"#),
        ("add", r#"{"kind":"wire","path":["joint_set"],"value":{"a":1}}"#),
        ("add", "{}"),
        ("undo", "not json at all"),
        ("redo", ""),
    ] {
        let answer = server.ask("POST", wanted, body);
        assert!(matches!(answer.status, 400 | 422), "{wanted} {body}: {}", answer.status);
        unharmed(&server, body);
    }
    let deep = "[".repeat(1 << 20);
    assert_eq!(server.ask("POST", "edit", &deep).status, 400);
    unharmed(&server, "a million brackets");
    for request in [
        "\r\n\r\n",
        "GET\r\n\r\n",
        "\u{16}\u{3}\u{1}\u{2}\u{0}",
        "GET / HTTP/9.9\r\n\r\n",
        "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
        "A".repeat(100_000).as_str(),
    ] {
        let answer = server.raw(request.as_bytes());
        assert!(matches!(answer.status, 0 | 400..=505), "{request:.20}: {}", answer.status);
        unharmed(&server, "no HTTP");
    }
    for method in ["PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT", "PATCH", "X"] {
        let answer = server.ask(method, "edit", EDIT);
        assert!(matches!(answer.status, 400 | 403 | 404 | 405), "{method}: {}", answer.status);
        unharmed(&server, method);
    }
    assert_eq!(server.get("edit").status, 405);
}

#[test]
fn who_sends_slowly_is_cut_off_and_holds_up_nobody() {
    let server = Running::start("slow");
    let (token, host) = (server.token.clone(), server.host());
    // Heads that do not end, a body that does not come, and connections that say nothing.
    let mut waiting = vec![];
    for number in 0..60 {
        let mut stream = server.connect();
        match number % 3 {
            0 => write!(stream, "GET /{token}/ HTTP/1.1\r\nHost: {host}\r\nX-Slow: ").unwrap(),
            1 => write!(
                stream,
                "POST /{token}/edit HTTP/1.1\r\nHost: {host}\r\nContent-Length: 100\r\n\r\n{{"
            )
            .unwrap(),
            _ => {}
        }
        waiting.push(stream);
    }
    let begun = Instant::now();
    unharmed(&server, "60 slow connections");
    assert!(begun.elapsed() < Duration::from_secs(4), "others wait {:?}", begun.elapsed());
    for (number, stream) in waiting.into_iter().enumerate() {
        let answer = Answer::read(stream);
        assert!(matches!(answer.status, 0 | 408), "{number}: {}", answer.status);
    }
    // Seconds to wait for the slow, and time of a busy machine.
    assert!(begun.elapsed() < Duration::from_secs(40), "cut off after {:?}", begun.elapsed());
    unharmed(&server, "all of them");
}

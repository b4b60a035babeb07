//! The server of `condyle view`, asked as browsers and as attackers ask.

mod attacks;
mod editing;

use condyle_view::server::{Server, Wanted};
use serde_json::Value;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::PathBuf;
use std::sync::mpsc;
use std::time::Duration;

const LEG: &str = "condyle = 1\nkind = \"model\"\nangles = \"deg\"\nmirror = { plane = \"z\", from = \"_r\", to = \"_l\" }\nconstants = { shank = 0.400 } # of one person\n\n[segment.shank_r]\nat = [0, -0.420, 0.083] # Dumas 2007\n[segment.foot_r]\nparent = \"shank_r\"\nat = [0, \"-$shank\", 0]\n[joint.ankle_r]\ntype = \"hinge\"\nsegment = \"foot_r\"\naxis = [0, 0, 1]\ncoordinates = [\"ankle_r\"]\ncoordinate.ankle_r = { range = [-50, 20] }\n";

/// A server with a model file in a folder of its own; both end with it.
struct Running {
    folder: PathBuf,
    file: PathBuf,
    port: u16,
    token: String,
    end: Option<tokio::sync::oneshot::Sender<()>>,
    thread: Option<std::thread::JoinHandle<()>>,
}

impl Running {
    fn start(name: &str) -> Self {
        let folder =
            std::env::temp_dir().join(format!("condyle-view-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        let file = folder.join("leg.toml");
        std::fs::write(&file, LEG).unwrap();
        Self::of(folder, file.clone(), file)
    }

    fn of(folder: PathBuf, model: PathBuf, file: PathBuf) -> Self {
        let (told, heard) = mpsc::channel();
        let (end, ended) = tokio::sync::oneshot::channel();
        let wanted = Wanted { model: Some(model), folder: folder.clone(), ..Wanted::default() };
        let thread = std::thread::spawn(move || {
            let runtime = tokio::runtime::Builder::new_multi_thread()
                .worker_threads(2)
                .enable_all()
                .build()
                .unwrap();
            runtime.block_on(async {
                let server = Server::start(wanted).await.unwrap().value;
                told.send(server.address()).unwrap();
                server.run(async { _ = ended.await }).await.unwrap();
            });
        });
        let address = heard.recv_timeout(Duration::from_secs(60)).expect("it starts");
        let rest =
            address.strip_prefix("http://127.0.0.1:").expect("it is on the loopback interface");
        let (port, token) = rest.trim_end_matches('/').split_once('/').unwrap();
        let (port, token) = (port.parse().unwrap(), token.to_owned());
        Self { folder, file, port, token, end: Some(end), thread: Some(thread) }
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        stream.set_write_timeout(Some(Duration::from_secs(60))).unwrap();
        stream
    }

    fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    /// Sends bytes and reads the answer to its end; what cannot be sent any more is not.
    fn raw(&self, bytes: &[u8]) -> Answer {
        let mut stream = self.connect();
        let _ = stream.write_all(bytes);
        Answer::read(stream)
    }

    /// A request with the server's own headers.
    fn ask(&self, method: &str, wanted: &str, body: &str) -> Answer {
        let (token, host, length) = (&self.token, self.host(), body.len());
        self.raw(format!("{method} /{token}/{wanted} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\nContent-Length: {length}\r\n\r\n{body}").as_bytes())
    }

    fn get(&self, wanted: &str) -> Answer {
        self.ask("GET", wanted, "")
    }

    fn post(&self, wanted: &str, body: &Value) -> (u16, Value) {
        let answer = self.ask("POST", wanted, &body.to_string());
        let said = serde_json::from_slice(&answer.body).unwrap_or(Value::Null);
        (answer.status, said)
    }

    fn text(&self) -> String {
        std::fs::read_to_string(&self.file).unwrap()
    }

    /// The events from now on, each as JSON.
    fn events(&self) -> mpsc::Receiver<Value> {
        let (token, host) = (&self.token, self.host());
        let mut stream = self.connect();
        write!(stream, "GET /{token}/events HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        let (told, heard) = mpsc::channel();
        let (begun, begins) = mpsc::channel();
        std::thread::spawn(move || {
            let (mut all, mut started) = (String::new(), false);
            let mut bytes = [0; 4096];
            while let Ok(count @ 1..) = stream.read(&mut bytes) {
                all.push_str(&String::from_utf8_lossy(&bytes[..count]));
                // The head names `data:` as well: events come after the first line of the body.
                if let Some(at) = all.find("retry: 1000\n\n") {
                    all.drain(..at + 13);
                    started = true;
                    let _ = begun.send(());
                }
                if !started {
                    continue;
                }
                while let Some(at) = all.find("data: ") {
                    let Some(end) = all[at..].find("\n\n") else { break };
                    let event = all[at + 6..at + end].to_owned();
                    all.drain(..at + end);
                    if told.send(serde_json::from_str(&event).unwrap()).is_err() {
                        return;
                    }
                }
            }
        });
        begins.recv_timeout(Duration::from_secs(60)).expect("it listens");
        heard
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.end.take().map(|end| end.send(()));
        let _ = self.thread.take().map(std::thread::JoinHandle::join);
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

struct Answer {
    /// 0 if the connection was closed without an answer.
    status: u16,
    head: String,
    body: Vec<u8>,
}

impl Answer {
    fn read(mut stream: TcpStream) -> Self {
        let mut all = vec![];
        // A connection that is reset gave what it gave.
        let _ = stream.read_to_end(&mut all);
        let end = all.windows(4).position(|four| four == b"\r\n\r\n").unwrap_or(all.len());
        let head = String::from_utf8_lossy(&all[..end]).into_owned();
        let status = head.split(' ').nth(1).and_then(|code| code.parse().ok()).unwrap_or(0);
        let mut body = all.get(end + 4..).unwrap_or_default().to_vec();
        if head.to_lowercase().contains("transfer-encoding: chunked") {
            body = unchunked(&body);
        }
        Self { status, head, body }
    }
}

fn unchunked(mut body: &[u8]) -> Vec<u8> {
    let mut whole = vec![];
    while let Some(end) = body.windows(2).position(|two| two == b"\r\n") {
        let length = usize::from_str_radix(&String::from_utf8_lossy(&body[..end]), 16).unwrap();
        whole.extend(&body[end + 2..end + 2 + length]);
        body = &body[end + 4 + length..];
    }
    whole
}

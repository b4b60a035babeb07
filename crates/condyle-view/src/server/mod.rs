//! The server of `condyle view`: it hands out the page and what it shows, edits the model's file, and tells changes.
//!
//! It listens on the loopback interface alone. Every address begins with a token that is drawn when it starts, so that
//! other pages and programs of other users do not find it; the header `Host` must name this server, and the header
//! `Origin`, where there is one, too, so that no other page can use it through the browser. Bodies have at most
//! [`LARGEST`] bytes, and whoever sends slowly is cut off. No request leads to a path outside the page: its files are found
//! by their exact names.
//!
//! ```text
//! GET  /TOKEN/                 the page          GET  /TOKEN/assets/NAME   its files
//! GET  /TOKEN/session.json     what it shows     GET  /TOKEN/files/NAME    meshes and skins of the model
//! GET  /TOKEN/editable.json    numbers of the model's text
//! GET  /TOKEN/events           server-sent events: the model changed, its file is wrong, it is mended
//! POST /TOKEN/edit, add, undo, redo
//! ```

mod answers;
mod desk;
mod guard;
mod messages;
mod routes;
mod watch;

use condyle::Read;
use condyle::open::OpenError;
use desk::Desk;
use guard::Guard;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::future::Future;
use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;

/// How many bytes the body of a request may have.
pub const LARGEST: usize = 4 << 20;
/// How long the head of a request, and then its body, may take to arrive.
const PATIENCE: Duration = Duration::from_secs(5);
/// How many connections are served at a time; others wait.
const MOST: usize = 256;

/// A server that is bound to its address.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    guard: Arc<Guard>,
    desk: Arc<Desk>,
}

/// What is served.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// The model, a file or the name of a shipped one; without it the page waits for one to be dropped onto it.
    pub model: Option<PathBuf>,
    /// Motions and recordings of it.
    pub motions: Vec<PathBuf>,
    /// Folders in which meshes are that the model names, beside its own.
    pub meshes: Vec<PathBuf>,
    /// The port; a free one if it is 0.
    pub port: u16,
    /// The folder in which the first edit of a shipped model makes a file; the current one if it is empty.
    pub folder: PathBuf,
}

/// Why a server did not start.
#[derive(Debug)]
pub enum StartError {
    /// The model or a motion could not be opened.
    Open(OpenError),
    /// The port could not be had, or the system gives no random numbers.
    Io(io::Error),
}

impl std::fmt::Display for StartError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Open(error) => error.fmt(f),
            Self::Io(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for StartError {}

impl Server {
    /// Opens what is wanted and binds the port, on the loopback interface.
    ///
    /// # Errors
    /// [`StartError`].
    pub async fn start(wanted: Wanted) -> Result<Read<Self>, StartError> {
        let listener =
            TcpListener::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, wanted.port))).await;
        let listener = listener.map_err(StartError::Io)?;
        let port = listener.local_addr().map_err(StartError::Io)?.port();
        let guard = Guard::new(port).map_err(StartError::Io)?;
        let opened = tokio::task::spawn_blocking(move || {
            let folder = match wanted.folder.as_os_str().is_empty() {
                true => Path::new("."),
                false => &wanted.folder,
            };
            Desk::open(wanted.model.as_deref(), &wanted.motions, &wanted.meshes, folder)
        });
        let opened = opened.await.map_err(|error| StartError::Io(io::Error::other(error)))?;
        let opened = opened.map_err(StartError::Open)?;
        Ok(opened.map(|desk| Self { listener, guard: Arc::new(guard), desk: Arc::new(desk) }))
    }

    /// Where the page is: `http://127.0.0.1:PORT/TOKEN/`.
    #[must_use]
    pub fn address(&self) -> String {
        self.guard.address()
    }

    /// Serves until `end` is over.
    ///
    /// # Errors
    /// None at present: what is wrong with a connection ends that connection.
    pub async fn run(self, end: impl Future<Output = ()>) -> io::Result<()> {
        let watching = watch::start(self.desk.clone());
        let routes = routes::router(self.guard.clone(), self.desk.clone());
        let places = Arc::new(Semaphore::new(MOST));
        let mut end = std::pin::pin!(end);
        loop {
            let accepted = tokio::select! {
                () = &mut end => break,
                accepted = self.listener.accept() => accepted,
            };
            let stream = match accepted {
                Ok((stream, _)) => stream,
                // Such as too many open files: others go on.
                Err(_) => {
                    tokio::time::sleep(Duration::from_millis(50)).await;
                    continue;
                }
            };
            let (routes, places) = (routes.clone(), places.clone());
            tokio::spawn(async move {
                let Ok(_place) = places.acquire_owned().await else { return };
                let service = TowerToHyperService::new(routes);
                let mut http = hyper::server::conn::http1::Builder::new();
                http.timer(TokioTimer::new()).header_read_timeout(PATIENCE).max_buf_size(1 << 16);
                // What goes wrong with a connection ends it, and concerns no other.
                let _ = http.serve_connection(TokioIo::new(stream), service).await;
            });
        }
        watching.abort();
        Ok(())
    }
}

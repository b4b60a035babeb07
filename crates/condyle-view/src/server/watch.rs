//! Changes of the model's files by other programs.

use super::desk::Desk;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, SystemTime};
use tokio::task::JoinHandle;

/// How often the files are looked at. Some file systems tell no changes, and editors write in many ways: asking works
/// with all of them, and a dozen files are asked about in microseconds.
const OFTEN: Duration = Duration::from_millis(250);

/// What is known of a file without reading it.
type Stamp = (PathBuf, Option<(SystemTime, u64)>);

fn stamps(desk: &Desk) -> Vec<Stamp> {
    let stamp = |file: PathBuf| {
        let known = std::fs::metadata(&file).ok();
        let known = known.and_then(|known| Some((known.modified().ok()?, known.len())));
        (file, known)
    };
    desk.files().into_iter().map(stamp).collect()
}

/// Looks at the files until it is aborted.
pub(super) fn start(desk: Arc<Desk>) -> JoinHandle<()> {
    tokio::spawn(async move {
        let mut known: Option<Vec<Stamp>> = None;
        loop {
            let (desk, before) = (desk.clone(), known.take());
            let looked = tokio::task::spawn_blocking(move || {
                let now = stamps(&desk);
                if before.as_ref().is_some_and(|before| *before != now) {
                    // Bytes are compared: what the server wrote itself is no change.
                    desk.reload();
                }
                now
            });
            known = looked.await.ok();
            tokio::time::sleep(OFTEN).await;
        }
    })
}

//! A file that is being received.

use std::fmt::Display;
use std::fs::{self, File};
use std::io::{self, Write as _};
use std::time::Duration;

use axum::http::StatusCode;
use futures_util::{Stream, StreamExt};
use tokio::task::block_in_place;
use tokio::time::timeout;

use super::folder::Upload;
use crate::refusal::Refusal;

/// Stores a stream of bytes as a file of an upload, within a time. What was received is deleted if this fails, or is dropped.
///
/// # Errors
/// If the file is not accepted, late, or cannot be stored.
pub async fn receive<B: AsRef<[u8]>, E: Display>(
    upload: &Upload,
    name: &str,
    mut stream: impl Stream<Item = Result<B, E>> + Unpin,
    within: Duration,
) -> Result<(), Refusal> {
    let mut incoming = Incoming::new(upload, name)?;
    let all = async {
        while let Some(bytes) = stream.next().await {
            let bytes = bytes.map_err(broken)?;
            block_in_place(|| incoming.write(bytes.as_ref()))?;
        }
        Ok::<(), Refusal>(())
    };
    timeout(within, all).await.map_err(|_| late(within))??;
    incoming.is_complete = true;
    Ok(())
}

fn broken(why: impl Display) -> Refusal {
    let what = format!("the file was not received: {why}");
    Refusal::of(StatusCode::BAD_REQUEST, &what)
}

fn late(within: Duration) -> Refusal {
    let seconds = within.as_secs();
    let what = format!("the file was not received within {seconds} s; try it again");
    Refusal::of(StatusCode::REQUEST_TIMEOUT, &what)
}

fn unstored(why: io::Error) -> Refusal {
    let what = format!("the file cannot be stored: {why}; make room on the disk");
    Refusal::of(StatusCode::INSUFFICIENT_STORAGE, &what)
}

/// Deletes its file when dropped, unless it is complete.
struct Incoming<'u> {
    upload: &'u Upload,
    name: &'u str,
    file: File,
    bytes: u64,
    is_complete: bool,
}

impl<'u> Incoming<'u> {
    fn new(upload: &'u Upload, name: &'u str) -> Result<Self, Refusal> {
        upload.received().reserve(name)?;
        let file = File::create_new(upload.path().join(name)).map_err(|error| {
            upload.received().forget(name, 0);
            unstored(error)
        })?;
        Ok(Self {
            upload,
            name,
            file,
            bytes: 0,
            is_complete: false,
        })
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), Refusal> {
        self.upload.received().grow(bytes.len() as u64)?;
        self.bytes += bytes.len() as u64;
        let written = self.file.write_all(bytes);
        written.map_err(unstored)
    }
}

impl Drop for Incoming<'_> {
    fn drop(&mut self) {
        let mut received = self.upload.received();
        if self.is_complete {
            received.complete(self.name);
        } else {
            // The folder may be gone already.
            let _ = fs::remove_file(self.upload.path().join(self.name));
            received.forget(self.name, self.bytes);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::folder::Folders;
    use super::*;

    type Chunk = Result<&'static str, String>;

    fn received(chunks: Vec<Chunk>, waits: bool) -> (Folders, Upload, Result<(), Refusal>) {
        let folders = Folders::default();
        let upload = folders.begin().unwrap();
        let runtime = tokio::runtime::Runtime::new().unwrap();
        let chunks = futures_util::stream::iter(chunks);
        let within = Duration::from_millis(50);
        let outcome = runtime.block_on(async {
            if waits {
                let chunks = chunks.chain(futures_util::stream::pending());
                receive(&upload, "a.csv", chunks, within).await
            } else {
                receive(&upload, "a.csv", chunks, within).await
            }
        });
        (folders, upload, outcome)
    }

    #[test]
    fn a_file_is_stored_completely_or_not_at_all() {
        let (_folders, upload, outcome) = received(vec![Ok("12"), Ok("3")], false);
        assert_eq!(outcome, Ok(()));
        let files = upload.files().unwrap();
        assert_eq!(fs::read_to_string(&files[0]).unwrap(), "123");

        for (chunks, waits, expected) in [
            (vec![Ok("12")], true, late(Duration::from_millis(50))),
            (vec![Ok("12"), Err("cut".to_owned())], false, broken("cut")),
        ] {
            let (_folders, upload, outcome) = received(chunks, waits);
            assert_eq!(outcome, Err(expected));
            assert_eq!(upload.files().unwrap().len(), 0);
            assert!(!upload.path().join("a.csv").exists());
        }
    }
}

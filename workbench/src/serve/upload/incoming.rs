//! A file that is being received.

use std::fmt::Display;
use std::fs::{self, File};
use std::io::Write as _;
use std::time::Duration;

use tokio::task::block_in_place;
use tokio::time::timeout;
use tokio_stream::{Stream, StreamExt};

use super::folder::{Unacceptable, Upload};

/// The reason why a file was not received.
#[derive(Debug, PartialEq, Eq)]
pub enum Lost {
    /// It is not accepted.
    Unacceptable(Unacceptable),
    /// It took too long.
    Late,
    /// The connection failed.
    Broken(String),
    /// It cannot be stored.
    Disk(String),
}

impl From<Unacceptable> for Lost {
    fn from(reason: Unacceptable) -> Self {
        Self::Unacceptable(reason)
    }
}

/// Stores a stream of bytes as a file of an upload, within a time. What was received is deleted if this fails, or is dropped.
///
/// # Errors
/// If the file is not accepted, late, or cannot be stored.
pub async fn receive<B: AsRef<[u8]>, E: Display>(
    upload: &Upload,
    name: &str,
    mut stream: impl Stream<Item = Result<B, E>> + Unpin,
    within: Duration,
) -> Result<(), Lost> {
    let mut incoming = Incoming::new(upload, name)?;
    let all = async {
        while let Some(bytes) = stream.next().await {
            let bytes = bytes.map_err(|error| Lost::Broken(error.to_string()))?;
            block_in_place(|| incoming.write(bytes.as_ref()))?;
        }
        Ok::<(), Lost>(())
    };
    timeout(within, all).await.map_err(|_| Lost::Late)??;
    incoming.is_complete = true;
    Ok(())
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
    fn new(upload: &'u Upload, name: &'u str) -> Result<Self, Lost> {
        upload.received().reserve(name)?;
        let file = File::create_new(upload.path().join(name)).map_err(|error| {
            upload.received().forget(name, 0);
            Lost::Disk(error.to_string())
        })?;
        Ok(Self {
            upload,
            name,
            file,
            bytes: 0,
            is_complete: false,
        })
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), Lost> {
        self.upload.received().grow(bytes.len() as u64)?;
        self.bytes += bytes.len() as u64;
        let written = self.file.write_all(bytes);
        written.map_err(|error| Lost::Disk(error.to_string()))
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

    fn received(chunks: Vec<Chunk>, waits: bool) -> (Folders, Upload, Result<(), Lost>) {
        let folders = Folders::default();
        let upload = folders.begin().unwrap();
        let runtime = tokio::runtime::Runtime::new().unwrap();
        let chunks = tokio_stream::iter(chunks);
        let within = Duration::from_millis(50);
        let outcome = runtime.block_on(async {
            if waits {
                let chunks = chunks.chain(tokio_stream::pending());
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
            (vec![Ok("12")], true, Lost::Late),
            (
                vec![Ok("12"), Err("cut".to_owned())],
                false,
                Lost::Broken("cut".to_owned()),
            ),
        ] {
            let (_folders, upload, outcome) = received(chunks, waits);
            assert_eq!(outcome, Err(expected));
            assert_eq!(upload.files().unwrap().len(), 0);
            assert!(!upload.path().join("a.csv").exists());
        }
    }
}

//! Limits of an upload.

use std::time::Duration;

/// Maximum number of files.
pub const MOST_FILES: usize = 256;

/// Maximum size of all files together, bytes.
pub const MOST_BYTES: u64 = 256 << 20;

/// Maximum time to receive a file.
pub const LONGEST: Duration = Duration::from_secs(120);

/// Time after which the files of an upload that was not opened are deleted.
pub const LIFETIME: Duration = Duration::from_secs(3600);

/// Maximum length of a file's name, bytes; file systems have 255.
pub const LONGEST_NAME: usize = 200;

/// Maximum size of the assignment of an upload, bytes.
pub const LARGEST_ASSIGNMENT: usize = 1 << 20;

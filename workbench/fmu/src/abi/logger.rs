//! Messages to the importer.

use std::ffi::{CString, c_void};

use super::types::{FormatFunction, Status};

/// The importer's function for messages, with the pointer that is passed back to it.
#[derive(Clone)]
pub struct Logger {
    function: Option<FormatFunction>,
    instance: CString,
    environment: *mut c_void,
}

// SAFETY: the environment is never read here. It goes back to the importer in the thread of the importer's own call.
unsafe impl Send for Logger {}

impl Logger {
    /// A logger of the instance with this name. Without a function of the importer messages are dropped.
    #[must_use]
    pub fn new(function: Option<FormatFunction>, instance: &str, environment: *mut c_void) -> Self {
        Self {
            function,
            instance: without_zeros(instance),
            environment,
        }
    }

    /// Writes a message.
    pub fn write(&self, status: Status, text: &str) {
        let Some(function) = self.function else {
            return;
        };
        let category = match status {
            Status::Discard => c"logStatusDiscard",
            _ => c"logStatusError",
        };
        // It is taken for a format.
        let text = without_zeros(&text.replace('%', "%%"));
        // SAFETY: the importer promises that its function can be called as the standard declares it until the
        // instance is freed. The texts end with a zero byte and live until the call returns. The format has no
        // argument.
        unsafe {
            function(
                self.environment,
                self.instance.as_ptr(),
                status,
                category.as_ptr(),
                text.as_ptr(),
            )
        }
    }
}

/// A text for C: nothing behind a zero byte.
#[must_use]
pub fn without_zeros(text: &str) -> CString {
    let bytes: Vec<u8> = text.bytes().take_while(|byte| *byte != 0).collect();
    CString::new(bytes).unwrap_or_default()
}

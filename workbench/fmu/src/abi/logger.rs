//! Messages to the importer.

use std::ffi::{CString, c_void};

use super::types::{Status, Text};

/// Writes a message, FMI 2.0: environment, instance, status, category, format as of `printf`, and its arguments.
pub type FormatFunction = unsafe extern "C" fn(*mut c_void, Text, Status, Text, Text, ...);
/// Writes a message, FMI 3.0: environment, status, category, message.
pub type MessageFunction = unsafe extern "C" fn(*mut c_void, Status, Text, Text);

/// The importer's function.
#[derive(Clone)]
pub enum Sink {
    /// None: messages are dropped.
    Nowhere,
    /// That of FMI 2.0, with the name of the instance.
    Format(FormatFunction, CString),
    /// That of FMI 3.0.
    Message(MessageFunction),
}

/// The importer's function for messages, with the pointer that is passed back to it.
#[derive(Clone)]
pub struct Logger {
    sink: Sink,
    environment: *mut c_void,
}

// SAFETY: the environment is never read here. It goes back to the importer in the thread of the importer's own call.
unsafe impl Send for Logger {}

impl Logger {
    /// A logger with a function of the importer.
    #[must_use]
    pub fn new(sink: Sink, environment: *mut c_void) -> Self {
        Self { sink, environment }
    }

    /// Writes a message.
    pub fn write(&self, status: Status, text: &str) {
        let category = match status {
            Status::Discard => c"logStatusDiscard",
            _ => c"logStatusError",
        }
        .as_ptr();
        let environment = self.environment;
        match &self.sink {
            Sink::Nowhere => (),
            Sink::Format(function, instance) => {
                // It is taken for a format.
                let text = without_zeros(&text.replace('%', "%%"));
                // SAFETY: the importer promises that its function can be called as the standard declares it until the
                // instance is freed. The texts end with a zero byte and live until the call returns. The format has no
                // argument.
                unsafe {
                    function(
                        environment,
                        instance.as_ptr(),
                        status,
                        category,
                        text.as_ptr(),
                    )
                }
            }
            Sink::Message(function) => {
                let text = without_zeros(text);
                // SAFETY: as above; there is no format.
                unsafe { function(environment, status, category, text.as_ptr()) }
            }
        }
    }
}

/// A text for C: nothing behind a zero byte.
#[must_use]
pub fn without_zeros(text: &str) -> CString {
    let bytes: Vec<u8> = text.bytes().take_while(|byte| *byte != 0).collect();
    CString::new(bytes).unwrap_or_default()
}

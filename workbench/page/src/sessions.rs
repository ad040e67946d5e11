//! The sessions of all browser tabs.
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use super::guard::random_token;
use super::live::LoopSource;
use super::session::Session;
use super::source::{Source, Subject};
use super::upload::Folders;
use hitch_output::error::Error;

/// Maximum number of sessions; the oldest is dropped, and its tab starts a new one.
const MOST_SESSIONS: usize = 32;

/// A session, shared by concurrent requests of its tab.
pub type Shared = Arc<Mutex<Session>>;

/// State of the server.
#[derive(Debug)]
pub struct Sessions {
    source: Source,
    subject: Mutex<Option<Arc<Subject>>>,
    /// What runs the closed loops.
    pub loop_source: LoopSource,
    /// Temporary folders of the tabs.
    pub folders: Folders,
    /// Sessions, the newest last.
    known: Mutex<VecDeque<(String, Shared)>>,
}

impl Sessions {
    /// No session yet.
    pub fn new(source: Source, loop_source: LoopSource) -> Self {
        Self {
            source,
            loop_source,
            subject: Mutex::default(),
            folders: Folders::default(),
            known: Mutex::default(),
        }
    }

    /// Reads the campaign on first use; after a fault it is read again, as the files may have been corrected.
    ///
    /// # Errors
    /// If the campaign is invalid.
    pub fn subject(&self) -> Result<Arc<Subject>, Error> {
        let mut subject = self.subject.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = &*subject {
            return Ok(Arc::clone(known));
        }
        let read = Arc::new(self.source.read()?);
        *subject = Some(Arc::clone(&read));
        Ok(read)
    }

    /// Starts a session; returns it with its id.
    ///
    /// # Errors
    /// If the campaign is invalid.
    pub fn begin(&self) -> Result<(String, Shared), Error> {
        let session = Arc::new(Mutex::new(Session::new(self.subject()?)));
        let id = random_token();
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if known.len() == MOST_SESSIONS {
            known.pop_front();
        }
        known.push_back((id.clone(), Arc::clone(&session)));
        Ok((id, session))
    }

    /// A session by its id.
    pub fn get(&self, id: &str) -> Option<Shared> {
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let mut sessions = known.iter();
        let (_, session) = sessions.find(|(known, _)| known == id)?;
        Some(Arc::clone(session))
    }
}

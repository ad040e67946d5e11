//! The sessions of all tabs.
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use super::guard::random_token;
use super::session::Session;
use super::source::{Source, Subject};
use crate::error::Error;

/// Most sessions that are kept; a tab whose session was dropped begins anew.
const MOST_SESSIONS: usize = 32;

/// A session that several requests of its tab may ask for at once.
pub type Shared = Arc<Mutex<Session>>;

/// Everything that the server knows.
#[derive(Debug)]
pub struct Sessions {
    source: Source,
    subject: Mutex<Option<Arc<Subject>>>,
    /// The latest last.
    known: Mutex<VecDeque<(String, Shared)>>,
}

impl Sessions {
    /// No session yet.
    pub fn new(source: Source) -> Self {
        Self {
            source,
            subject: Mutex::default(),
            known: Mutex::default(),
        }
    }

    /// Reads the campaign if that has not been done; one that was wrong is read again, it may have been mended.
    ///
    /// # Errors
    /// If the campaign is wrong.
    pub fn subject(&self) -> Result<Arc<Subject>, Error> {
        let mut subject = self.subject.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = &*subject {
            return Ok(Arc::clone(known));
        }
        let read = Arc::new(self.source.read()?);
        *subject = Some(Arc::clone(&read));
        Ok(read)
    }

    /// Begins a session; its id.
    ///
    /// # Errors
    /// If the campaign is wrong.
    pub fn begin(&self) -> Result<String, Error> {
        let session = Session::new(self.subject()?);
        let id = random_token();
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if known.len() == MOST_SESSIONS {
            known.pop_front();
        }
        known.push_back((id.clone(), Arc::new(Mutex::new(session))));
        Ok(id)
    }

    /// A session by its id.
    pub fn get(&self, id: &str) -> Option<Shared> {
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let mut sessions = known.iter();
        let (_, session) = sessions.find(|(known, _)| known == id)?;
        Some(Arc::clone(session))
    }
}

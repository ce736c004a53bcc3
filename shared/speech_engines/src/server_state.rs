//! State of a server in whose place something built in stands while it fails.

use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use wyoming::{Address, Client, ClientError, Kind};

/// A device that may be a server elsewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Device {
    /// The recogniser.
    Recogniser,
    /// The voice.
    Voice,
}

/// Returns what a server is, for the operator.
///
/// # Errors
/// If it is away or of another kind; with its address.
pub(crate) fn examine(client: &Client, kind: Kind) -> Result<String, String> {
    client.examine(kind, &|| false).map_err(|error| format!("{}: {error}", client.address))
}

/// Interval of attempts to reach a server that is away.
const RETRY_EVERY: Duration = Duration::from_secs(2);
/// Characters of an error that are shown: a server may send any number.
const ERROR_MAX: usize = 70;

/// Whether a server works, as far as its last request shows.
pub(crate) struct ServerState {
    address: Address,
    /// What stands in its place, e.g. `built-in recogniser`.
    stand_in: &'static str,
    /// Key of its time limit.
    limit_key: &'static str,
    /// Time for which a server that was late counts as away, if it does.
    late_for: Option<Duration>,
    retry_at: Option<Instant>,
    note: Option<String>,
}

impl ServerState {
    pub(crate) fn new(address: Address, stand_in: &'static str, limit_key: &'static str) -> Self {
        let retry_at = Some(Instant::now());
        Self { address, stand_in, limit_key, late_for: None, retry_at, note: None }
    }

    /// Has a server that was late count as away for this time.
    pub(crate) fn away_if_late(self, late_for: Duration) -> Self {
        Self { late_for: Some(late_for), ..self }
    }

    /// Returns when to ask a server that was not asked yet, or is away.
    pub(crate) fn retry_at(&self) -> Option<Instant> {
        self.retry_at
    }

    /// Returns whether the server was away a moment ago: to ask it would only cost time.
    pub(crate) fn is_away(&self) -> bool {
        self.retry_at.is_some_and(|at| Instant::now() < at)
    }

    /// Returns what stands in the server's place and why, for the operator; `None` if it works.
    pub(crate) fn note(&self) -> Option<&str> {
        self.note.as_deref()
    }

    /// Takes the result of a request. Returns whether the note changes.
    pub(crate) fn record<T>(&mut self, result: &Result<T, ClientError>) -> bool {
        let (address, stand_in, key) = (&self.address, self.stand_in, self.limit_key);
        let failing = |error: &ClientError, help: String| {
            let error: String = error.to_string().chars().take(ERROR_MAX).collect();
            Some(format!("{stand_in} in place of {address}: {error}{help}"))
        };
        let note = match result {
            // It shows nothing about the server.
            Err(ClientError::Cancelled) => return false,
            Ok(_) => None,
            Err(error @ ClientError::Late(_)) => {
                failing(error, format!("; help: raise speech.wyoming.{key}"))
            }
            Err(error) => failing(error, String::new()),
        };
        let away_for = match result {
            Err(ClientError::Unreachable(_)) => Some(RETRY_EVERY),
            Err(ClientError::Late(_)) => self.late_for,
            _ => None,
        };
        self.retry_at = away_for.map(|time| Instant::now() + time);
        if note == self.note {
            return false;
        }
        match &note {
            Some(note) => tracing::warn!("{note}"),
            None if self.note.is_some() => tracing::info!(%address, "the server works again"),
            None => {}
        }
        self.note = note;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn server_state_notes_each_change_once_and_waits_only_for_an_absent_server() {
        let address: Address = "tcp://127.0.0.1:10300".parse().unwrap();
        let state = || ServerState::new(address.clone(), "built-in recogniser", "answer_ms");
        let mut voice = state().away_if_late(Duration::from_secs(30));
        let mut state = state();
        let away = Err::<(), _>(ClientError::Unreachable("refused".to_owned()));
        let late = Err::<(), _>(ClientError::Late(Duration::from_millis(700)));
        assert!(!state.record(&Ok(())) && state.note().is_none());
        assert!(state.record(&away) && !state.record(&away) && state.is_away());
        assert!(!state.record(&Err::<(), _>(ClientError::Cancelled)) && state.is_away());
        assert!(state.record(&late) && !state.is_away());
        assert_eq!(
            state.note().unwrap(),
            "built-in recogniser in place of tcp://127.0.0.1:10300: no answer within 700 ms; help: \
             raise speech.wyoming.answer_ms"
        );
        assert!(state.record(&Ok(())) && state.note().is_none());
        assert!(voice.record(&late) && voice.is_away(), "each line would wait as long");
        let long = Err::<(), _>(ClientError::Broken("ü".repeat(1 << 20)));
        assert!(state.record(&long));
        assert_eq!(state.note().unwrap().matches('ü').count(), ERROR_MAX);
    }
}

//! What the routes share: tokens, events, the ways to the robot, and the audit.

use std::collections::BTreeSet;
use std::fmt;
use std::io;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use axum::http::{HeaderMap, HeaderName};
use discovery::{Announcement, Identity};
use roster::Name;
use safe_files::{read_private, replace_private_synced};
use serde::Serialize;
use service::console_link::{is_token, random_secret};
use service::group::GroupPaths;
use service::worker_channel::{self, DeviceSender};
use tokio::sync::watch;
use web_server::audit::Audit;
use web_server::connections::Connection;
use web_server::login::pause;
use web_server::request::{authorizations, bearer, is_own, origin};
use web_server::sessions::unix_s;

use crate::conversations::Conversations;
use crate::events::Events;
use crate::feed::{Feed, Request};
use crate::limits::Places;
use crate::motion::Motion;
use crate::problem::Problem;
use crate::tokens::{OWNER, Right, Token, TokenFile, Tokens, tokens_file};
use crate::uses::{UseFile, uses_file};

/// Version of the interface.
const API: u64 = 1;
/// Where it begins below the server's address.
pub(crate) const PATH: &str = "/api/v1";
/// Name of the audit in the group's folder, without ending.
pub(crate) const AUDIT: &str = "http-audit";
/// The person for whom a gateway asks, which has the console's own token.
const PERSON: HeaderName = HeaderName::from_static("whichone-person");
/// Requests with a wrong token whose answers are delayed at a time, against guessing; others are refused at once.
const GUESSES_MAX: usize = 16;
/// Words that wait for a reply, of one token and of all.
const WORDS_MAX: (usize, usize) = (48, 128);
/// Open streams of events, of one token and of all.
const STREAMS_MAX: (usize, usize) = (8, 24);

/// What the console knows and this crate does not.
pub struct Rules {
    /// Whether this is the console's own token, which has every right.
    pub is_owner: Box<dyn Fn(&str) -> bool + Send + Sync>,
    /// Whether words halt the arm.
    pub is_stop: fn(&str) -> bool,
    /// True once the server is to end.
    pub ending: watch::Receiver<bool>,
    /// Whether the robot is announced in the local network.
    pub discovery: bool,
}

impl fmt::Debug for Rules {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Rules").finish_non_exhaustive()
    }
}

/// The server's half.
#[derive(Debug)]
pub struct Api {
    pub(crate) identity: Identity,
    pub(crate) rules: Rules,
    pub(crate) events: Arc<Events>,
    pub(crate) motion: Motion,
    pub(crate) requests: DeviceSender<Request>,
    pub(crate) words: Places,
    pub(crate) streams: Places,
    conversations: Mutex<Conversations>,
    tokens: TokenFile,
    uses: UseFile,
    audit: Audit,
    guesses: Places,
    announcement: Mutex<Option<Announcement>>,
}

/// Who makes a request.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Caller {
    /// Name of the token.
    pub(crate) name: String,
    may: BTreeSet<Right>,
    /// The token, but for the console's own.
    token: Option<(Name, Token)>,
}

/// A line of the audit.
#[derive(Debug, Serialize)]
struct Entry<'a> {
    /// Wall time, seconds since 1970.
    unix_s: u64,
    token: &'a str,
    what: &'a str,
    outcome: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    text: Option<&'a str>,
}

/// Opens both halves for a group.
///
/// # Errors
/// No descriptor is left, or a file of the group's folder cannot be written.
pub fn open(paths: &GroupPaths, rules: Rules) -> io::Result<(Arc<Api>, Feed)> {
    let (requests, inbox) = worker_channel::channel()?;
    let events = Arc::new(Events::open(&paths.run()));
    let api = Api {
        identity: Identity {
            api: API,
            id: own_id(paths)?,
            name: paths.name().to_string(),
            version: build_info::VERSION,
        },
        motion: Motion::new(paths.clone(), rules.ending.clone()),
        rules,
        events: Arc::clone(&events),
        requests,
        words: Places::new(WORDS_MAX.0, WORDS_MAX.1),
        streams: Places::new(STREAMS_MAX.0, STREAMS_MAX.1),
        conversations: Mutex::default(),
        tokens: TokenFile::new(tokens_file(paths), Tokens::load),
        uses: UseFile::open(uses_file(paths)),
        audit: Audit::open(paths.root(), AUDIT)?,
        guesses: Places::new(GUESSES_MAX, GUESSES_MAX),
        announcement: Mutex::default(),
    };
    Ok((Arc::new(api), Feed::new(inbox, events)))
}

/// Reads the group's identifier, or makes one.
fn own_id(paths: &GroupPaths) -> io::Result<String> {
    let file = paths.root().join("http.id");
    let kept = read_private(&file).unwrap_or_default().trim().to_owned();
    if is_token(&kept) {
        return Ok(kept);
    }
    let id: String = random_secret()?.chars().take(16).collect();
    replace_private_synced(&file, format!("{id}\n"))?;
    Ok(id)
}

impl Api {
    /// Announces the robot in its local network if that is wanted. The server listens at this address.
    pub fn announce(&self, listening: SocketAddr) {
        if !self.rules.discovery {
            return;
        }
        match Announcement::begin(&self.identity, listening, PATH) {
            Ok(announcement) => *self.announcement() = Some(announcement),
            Err(error) => tracing::warn!("the robot is not announced: {error}"),
        }
    }

    /// Withdraws the announcement, so that others do not look for the robot.
    pub fn withdraw(&self) {
        *self.announcement() = None;
    }

    fn announcement(&self) -> MutexGuard<'_, Option<Announcement>> {
        self.announcement.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns who makes a request, whose connection is proven then.
    pub(crate) async fn caller(
        &self,
        headers: &HeaderMap,
        connection: &Connection,
    ) -> Result<Caller, Problem> {
        if let Some(origin) = origin(headers).filter(|_| !is_own(headers)) {
            return Err(Problem::origin(origin));
        }
        let count = authorizations(headers);
        if count > 1 {
            let what = format!("expected one header Authorization, found {count}");
            return Err(Problem::unreadable(format!(
                "{what}; help: send the program's token alone"
            )));
        }
        let said = bearer(headers);
        let Some(caller) = self.known(headers, said.unwrap_or_default()) else {
            if said.is_some() {
                let _place = self.guesses.take("").ok_or(Problem::too_many("wrong tokens"))?;
                pause().await;
            }
            return Err(Problem::token(said.is_some()));
        };
        connection.prove();
        Ok(caller)
    }

    fn known(&self, headers: &HeaderMap, said: &str) -> Option<Caller> {
        let tokens = self.tokens.current();
        if let Some((name, token)) = tokens.with_secret(said) {
            let names = tokens.iter().map(|(name, _)| name.as_str());
            self.uses.note(name.as_str(), unix_s(), names);
            let own = (name.clone(), token.clone());
            return Some(Caller {
                name: name.to_string(),
                may: token.may.clone(),
                token: Some(own),
            });
        }
        (self.rules.is_owner)(said).then(|| {
            let person = headers.get(PERSON).and_then(|name| Name::new(name.to_str().ok()?).ok());
            // No token has such a name.
            let name = person.map_or(OWNER.to_owned(), |person| format!("{person}@gateway"));
            Caller { name, may: Right::ALL.into(), token: None }
        })
    }

    /// Returns whether a caller's token is still in force as it was.
    pub(crate) fn lasts(&self, caller: &Caller) -> bool {
        let Some((name, token)) = &caller.token else { return true };
        self.tokens.current().iter().any(|known| known == (name, token))
    }

    /// Checks a right.
    pub(crate) fn must(&self, caller: &Caller, right: Right, what: &str) -> Result<(), Problem> {
        if caller.may(right) {
            return Ok(());
        }
        self.note(caller, what, "refused", None);
        Err(Problem::right(&caller.name, right.word()))
    }

    /// Writes an order into the audit before it is passed on.
    pub(crate) async fn record(
        &self,
        caller: &Caller,
        what: &str,
        text: Option<&str>,
    ) -> Result<(), Problem> {
        let recorded = self.audit.record(&Entry::new(caller, what, "ordered", text)).await;
        recorded.map_err(|error| {
            Problem::unavailable(format!(
                "the audit cannot be written: {error}; help: free some disk"
            ))
        })
    }

    /// Writes into the audit soon.
    pub(crate) fn note(&self, caller: &Caller, what: &str, outcome: &str, text: Option<&str>) {
        self.audit.note(&Entry::new(caller, what, outcome, text));
    }

    pub(crate) fn conversations(&self) -> MutexGuard<'_, Conversations> {
        // Every change leaves a consistent state.
        self.conversations.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Caller {
    pub(crate) fn may(&self, right: Right) -> bool {
        self.may.contains(&right)
    }
}

impl<'a> Entry<'a> {
    fn new(caller: &'a Caller, what: &'a str, outcome: &'a str, text: Option<&'a str>) -> Self {
        Self { unix_s: unix_s(), token: &caller.name, what, outcome, text }
    }
}

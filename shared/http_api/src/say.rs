//! `say` and `cancel`: words under a key, and the robot's reply to them.

use std::time::{Duration, Instant};

use axum::body::{Body, Bytes, to_bytes};
use axum::http::{HeaderMap, HeaderName, StatusCode, header};
use axum::response::{IntoResponse, Response};
use messages::{PromptId, StopId};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use service::console_link::random_secret;
use tokio::sync::oneshot;
use tokio::time::timeout;
use vocabulary::PersonId;

use crate::api::{Api, Caller};
use crate::conversations::Repeated;
use crate::feed::{Heard, PATIENCE, Request, request_key};
use crate::problem::Problem;
use crate::state::{Kind, Reply, State};
use crate::tokens::Right;

/// Longest body, bytes.
const BODY_MAX: usize = 16 << 10;
/// Time for the body to arrive, seconds.
const BODY_S: u64 = 10;
/// Longest text, characters.
const TEXT_MAX: usize = 1_000;
/// Longest key and conversation, bytes.
const KEY_MAX: usize = 200;
/// Waits for a reply, seconds: unless the request says otherwise, and the longest.
const WAIT_S: (f64, f64) = (8.0, 60.0);
/// Time after which an utterance that no act answers has its reply.
const SETTLED_AFTER: Duration = Duration::from_millis(300);
/// Longest sleep while a reply is awaited.
const LOOK_EVERY: Duration = Duration::from_millis(100);
/// Longest wait for the number of words that stop the arm.
const STOP_WORDS: Duration = Duration::from_millis(250);
/// Words that withdraw a request.
const NEVER_MIND: &str = "never mind";
/// The same words under the same key are said once.
const IDEMPOTENCY_KEY: HeaderName = HeaderName::from_static("idempotency-key");

/// The body of `say`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Said {
    text: String,
    conversation: Option<String>,
    from: Option<String>,
    wait_s: Option<f64>,
    seen: Option<u64>,
}

/// The body of `resume`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Release {
    #[serde(default)]
    stop: StopId,
}

/// A checked request.
#[derive(Debug)]
pub(crate) struct Words {
    text: String,
    /// Whose dialogue it is; the token's name where the request has none.
    conversation: String,
    from: PersonId,
    /// The key of the request; a random one where it has none.
    key: String,
    wait: Duration,
    seen: Option<u64>,
}

/// The answer.
#[derive(Debug, Serialize)]
struct Answer {
    /// Number of the utterance; `None` if words that stop the arm were not said as well.
    utterance: Option<u64>,
    /// Whether an earlier request with this key had said it.
    known: bool,
    reply: Reply,
}

/// Reads the body of `say`.
pub(crate) async fn read(
    body: Body,
    headers: &HeaderMap,
    caller: &Caller,
) -> Result<Words, Problem> {
    let bytes = bytes(body).await?;
    check(parse(&bytes, r#"{"text": "…"}"#)?, headers, caller)
}

/// Reads the body of `resume`, which may be empty: the stop that the person saw, 0 for any.
pub(crate) async fn stop_to_release(body: Body) -> Result<StopId, Problem> {
    let bytes = bytes(body).await?;
    if bytes.is_empty() {
        return Ok(StopId(0));
    }
    parse::<Release>(&bytes, r#"nothing, or {"stop": 1234}"#).map(|release| release.stop)
}

async fn bytes(body: Body) -> Result<Bytes, Problem> {
    let read = timeout(Duration::from_secs(BODY_S), to_bytes(body, BODY_MAX)).await;
    match read {
        Err(_) => Err(Problem::slow(BODY_S)),
        Ok(Err(error)) if error.to_string().contains("length limit") => {
            Err(Problem::too_large(BODY_MAX))
        }
        Ok(Err(error)) => Err(Problem::unreadable(error.to_string())),
        Ok(Ok(bytes)) => Ok(bytes),
    }
}

fn parse<T: DeserializeOwned>(bytes: &[u8], expected: &str) -> Result<T, Problem> {
    serde_json::from_slice(bytes).map_err(|error| {
        let help = format!("help: expected {expected}; see /api/v1/openapi.json");
        Problem::unreadable(format!("invalid request: {error}; {help}"))
    })
}

fn check(said: Said, headers: &HeaderMap, caller: &Caller) -> Result<Words, Problem> {
    let Said { text, conversation, from, wait_s, seen } = said;
    let text = text.replace(char::is_control, " ").trim().to_owned();
    let length = text.chars().count();
    if !(1..=TEXT_MAX).contains(&length) {
        let what = format!("text: expected 1 to {TEXT_MAX} characters, found {length}");
        return Err(Problem::invalid(what));
    }
    let wait_s = wait_s.unwrap_or(WAIT_S.0);
    if !(0.0..=WAIT_S.1).contains(&wait_s) {
        let what = format!("wait_s: expected 0 to {} seconds, found {wait_s}", WAIT_S.1);
        return Err(Problem::invalid(what));
    }
    let from = PersonId::new(from.as_deref().unwrap_or_default());
    Ok(Words {
        text,
        conversation: match conversation {
            Some(name) => within("conversation", name)?,
            None => caller.name.clone(),
        },
        from: from.map_err(|error| Problem::invalid(format!("from: {error}")))?,
        key: key(headers)?,
        wait: Duration::from_secs_f64(wait_s),
        seen,
    })
}

fn within(what: &str, text: String) -> Result<String, Problem> {
    match text.len() {
        1..=KEY_MAX => Ok(text),
        found => {
            Err(Problem::invalid(format!("{what}: expected 1 to {KEY_MAX} bytes, found {found}")))
        }
    }
}

/// Returns the request's key, or a random one.
fn key(headers: &HeaderMap) -> Result<String, Problem> {
    let Some(key) = headers.get(&IDEMPOTENCY_KEY) else {
        let random = random_secret();
        return random.map_err(|error| Problem::unavailable(format!("random numbers: {error}")));
    };
    let plain = key.to_str().map_err(|_| Problem::invalid("Idempotency-Key: expected ASCII"))?;
    within("Idempotency-Key", plain.to_owned())
}

/// Says the words, and answers with the robot's reply. Words that stop the arm stop it first, whatever becomes of them.
pub(crate) async fn say(api: &Api, caller: &Caller, words: Words) -> Result<Response, Problem> {
    if !(api.rules.is_stop)(&words.text) {
        api.must(caller, Right::Talk, "say")?;
        return answer(api, caller, &words).await;
    }
    if !caller.may(Right::Stop) {
        api.must(caller, Right::Talk, "say")?;
    }
    let talk = async {
        match caller.may(Right::Talk) {
            // The words are on their way at once; the answer to a stop does not wait for them.
            true => timeout(STOP_WORDS, utter(api, caller, &words, true)).await.ok()?.ok(),
            false => None,
        }
    };
    let (stopped, said) = tokio::join!(api.motion.stop(), talk);
    let outcome = if stopped.is_ok() { "done" } else { "failed" };
    api.note(caller, "stop", outcome, Some(&words.text));
    stopped?;
    let reply = Reply::plain(Kind::Stopped, "I have stopped.");
    let (utterance, known) = said.unzip();
    let answer = Answer { utterance, known: known.unwrap_or(false), reply };
    Ok(json(StatusCode::OK, body_of(&answer)))
}

/// Withdraws the open request.
pub(crate) async fn cancel(
    api: &Api,
    caller: &Caller,
    headers: &HeaderMap,
) -> Result<Response, Problem> {
    api.must(caller, Right::Talk, "cancel")?;
    let said = Said { text: NEVER_MIND.to_owned(), ..Said::default() };
    let words = check(said, headers, caller)?;
    let is_new = api.conversations().repeated(&words.key_of(caller), &words.text).is_none();
    if is_new && api.events.state().interaction == 0 {
        return Err(Problem::conflict("nothing_open", "no request is open"));
    }
    answer(api, caller, &words).await
}

async fn answer(api: &Api, caller: &Caller, words: &Words) -> Result<Response, Problem> {
    let _place = api.words.take(&caller.name).ok_or_else(|| Problem::too_many("requests"))?;
    let until = Instant::now() + words.wait;
    match api.conversations().repeated(&words.key_of(caller), &words.text) {
        Some(Repeated::Reply(body)) => return Ok(json(StatusCode::OK, body)),
        Some(Repeated::OtherWords) => return Err(other_words()),
        None => {}
    }
    let open = api.events.state().interaction;
    let (seq, known) = utter(api, caller, words, false).await?;
    let reply = reply(api, (seq, open), until).await;
    api.conversations().show(&words.conversation, reply.prompt);
    if reply.kind == Kind::Pending {
        let answer = Answer { utterance: Some(seq), known, reply };
        return Ok(json(StatusCode::ACCEPTED, body_of(&answer)));
    }
    let answer = Answer { utterance: Some(seq), known, reply };
    let repeated = body_of(&Answer { known: true, reply: answer.reply.clone(), ..answer });
    api.conversations().remember(words.key_of(caller), &words.text, &repeated);
    Ok(json(StatusCode::OK, body_of(&answer)))
}

fn other_words() -> Problem {
    let help = "help: use a new Idempotency-Key for other words";
    Problem::conflict("key_of_another_text", format!("this key belongs to other words; {help}"))
}

/// Hands the words to the robot; returns the utterance's number, and whether an earlier request had said it. Words that
/// stop the arm ask for no conversation.
async fn utter(
    api: &Api,
    caller: &Caller,
    words: &Words,
    is_stop: bool,
) -> Result<(u64, bool), Problem> {
    let state = api.events.state();
    let seen = match seen(api, words, &state) {
        // Nothing may keep a stop back.
        Err(_) if is_stop => 0,
        seen => seen?,
    };
    if !is_stop {
        if !api.conversations().claim(&words.conversation, &state, Instant::now()) {
            return Err(Problem::busy());
        }
        if let Err(problem) = api.record(caller, "say", Some(&words.text)).await {
            api.conversations().said(&words.conversation, None);
            return Err(problem);
        }
    }
    let heard = hand_over(api, caller, words, seen).await;
    let seq = match heard {
        Heard::Accepted { seq, .. } => Some(seq),
        _ => None,
    };
    if !is_stop {
        api.conversations().said(&words.conversation, seq);
    }
    match heard {
        Heard::Accepted { seq, known } => Ok((seq, known)),
        Heard::Conflict(_) => Err(other_words()),
        Heard::Refused(note) => Err(Problem::refused(&note)),
        Heard::Unavailable(why) => Err(Problem::unavailable(why)),
        Heard::Lost(why) => Err(Problem::not_accepted(why)),
    }
}

/// Returns the latest prompt that the person was shown. For one that was not said yet the speech service would wait.
fn seen(api: &Api, words: &Words, state: &State) -> Result<u64, Problem> {
    let Some(seen) = words.seen else { return Ok(api.conversations().shown(&words.conversation)) };
    if seen > state.prompt && !state.inner.is_known {
        return Err(Problem::unavailable("the robot's latest line is not known yet"));
    }
    if seen > state.prompt {
        let what = format!("seen: expected a line that was said, up to {}", state.prompt);
        return Err(Problem::invalid(format!("{what}, found {seen}; help: leave it out")));
    }
    Ok(seen)
}

async fn hand_over(api: &Api, caller: &Caller, words: &Words, seen: u64) -> Heard {
    let (answer, answered) = oneshot::channel();
    let request = Request {
        key: request_key(&caller.name, &words.key),
        text: words.text.clone(),
        from: words.from.as_str().to_owned(),
        seen: PromptId(seen),
        answer,
    };
    if api.requests.offer(request).is_err() {
        return Heard::Lost("the console is busy");
    }
    // The main loop gives up earlier, unless it hangs.
    let patience = Duration::from_secs_f64(PATIENCE.s() + 2.0);
    match timeout(patience, answered).await {
        Ok(Ok(heard)) => heard,
        Ok(Err(_)) | Err(_) => Heard::Lost("the console does not answer"),
    }
}

/// Waits for the reply to an utterance: until it is applied and an act answers it, and the arm has given up an object that
/// it is to give up. `open` is the request that was open before, 0 for none.
async fn reply(api: &Api, (utterance, open): (u64, u64), until: Instant) -> Reply {
    let mut states = api.events.watch();
    let mut applied = None;
    loop {
        let state = states.borrow_and_update().clone();
        let now = Instant::now();
        if state.utterance >= utterance {
            let since = *applied.get_or_insert(now);
            let is_settled = state.answers(utterance) || now >= since + SETTLED_AFTER;
            let is_on_the_way = state.is_on_the_way() && now < until;
            if is_settled && !is_on_the_way {
                return state.reply(utterance, open);
            }
        }
        if now >= until {
            return Reply::plain(Kind::Pending, "");
        }
        // Changed or not: the time counts as well.
        let _ = timeout(LOOK_EVERY.min(until - now), states.changed()).await;
    }
}

impl Words {
    /// What a repetition of the request has in common with it.
    fn key_of(&self, caller: &Caller) -> (String, String) {
        (caller.name.clone(), self.key.clone())
    }
}

fn body_of(answer: &Answer) -> String {
    // Every answer can be written.
    serde_json::to_string(answer).unwrap_or_default()
}

fn json(status: StatusCode, body: String) -> Response {
    let kind = [(header::CONTENT_TYPE, "application/json"), (header::CACHE_CONTROL, "no-store")];
    (status, kind, body).into_response()
}

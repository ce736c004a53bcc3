//! A recogniser behind the Wyoming protocol, such as Whisper or Vosk. It decides what was said; the
//! built-in recogniser listens beside it, finds the ends of utterances and the words that stop the
//! arm, and answers if the server does not.
//!
//! Invariant: an utterance has one answer. That of the server counts within its limits; a later
//! one is never read, as its connection is closed.

use std::ops::Range;
use std::time::Instant;

use scene::Scene;
use wyoming::{Client, Kind};

use super::second_opinion::{Limit, Network, TEXT_MAX};
use super::{
    FirstView, Opinion, PocketSphinx, PocketSphinxOptions, Recogniser, RecogniserUnavailable,
    Recognition, SecondOpinion,
};
use crate::audio::RATE_HZ;
use crate::server_state::ServerState;
use crate::{language_model, server_state};

/// The server, and the recogniser in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct WyomingOptions {
    /// Client of the server.
    pub client: Client,
    /// The built-in recogniser.
    pub built_in: PocketSphinxOptions,
}

impl WyomingOptions {
    /// Returns what the server is.
    ///
    /// # Errors
    /// If it is away or no recogniser; with its address.
    pub fn examine(&self) -> Result<String, String> {
        server_state::examine(&self.client, Kind::Recogniser)
    }
}

/// Gets what stands in the server's place and why, whenever that changes; `None`: it works.
pub type Report = Box<dyn Fn(Option<String>) + Send>;

/// Language of the scenes and the dialogue.
const LANGUAGE: &str = "en";
/// Words of the scene that are handed to the server: prompts of recognisers are short.
const TERMS_MAX: usize = 100;

/// Returns the recogniser beside the server: without a built-in one it has never heard a word.
pub(super) fn beside(
    built_in: Result<PocketSphinx, RecogniserUnavailable>,
) -> Result<Box<dyn Recogniser>, RecogniserUnavailable> {
    match built_in {
        Ok(recogniser) => Ok(Box::new(recogniser)),
        Err(RecogniserUnavailable::Missing(reason)) => {
            tracing::warn!(reason, "nothing recognises speech in place of the server");
            Ok(Box::new(NoWords))
        }
        Err(short) => Err(short),
    }
}

struct NoWords;

impl Recogniser for NoWords {
    fn recognise(&mut self, _: &[i16], _: Range<usize>) -> Recognition {
        Ok(FirstView::default())
    }

    fn is_missing(&self) -> bool {
        true
    }
}

/// Starts the client, which first asks what the server is: some load their models then.
pub(super) fn start(
    options: &WyomingOptions,
    scene: &Scene,
    first: &dyn Recogniser,
    report: Report,
) -> SecondOpinion {
    let (client, terms) = (options.client.clone(), terms(scene));
    let stand_in = if first.is_missing() { "nothing" } else { "built-in recogniser" };
    SecondOpinion::deciding(move || {
        let state = ServerState::new(client.address.clone(), stand_in, "answer_ms");
        Box::new(Server { client, terms, state, report })
    })
}

/// Returns words and phrases of the scene, each once.
fn terms(scene: &Scene) -> Vec<String> {
    let mut terms = vec![scene.noun().to_owned()];
    let values = || scene.attributes().iter().flat_map(|attribute| &attribute.values);
    // Synonyms last, as they are the first that do without.
    let all = values().map(|value| &value.name).chain(values().flat_map(|value| &value.synonyms));
    for term in all {
        if !terms.contains(term) {
            terms.push(term.clone());
        }
    }
    terms.truncate(TERMS_MAX);
    terms
}

struct Server {
    client: Client,
    terms: Vec<String>,
    state: ServerState,
    report: Report,
}

impl Server {
    fn record<T>(&mut self, result: &Result<T, wyoming::ClientError>) {
        if self.state.record(result) {
            (self.report)(self.state.note().map(str::to_owned));
        }
    }
}

impl Network for Server {
    fn opinion(
        &mut self,
        samples: &[i16],
        _: &dyn Fn() -> Option<Vec<String>>,
        limit: &Limit,
    ) -> Option<Opinion> {
        if self.state.is_away() {
            return None;
        }
        let is_over = || limit.is_over();
        let audio = (samples, RATE_HZ);
        let text = self.client.transcribe(audio, (LANGUAGE, &self.terms), &is_over);
        self.record(&text);
        // One character more than counts shows that the words are cut.
        let text =
            language_model::words(&text.ok()?).join(" ").chars().take(TEXT_MAX + 1).collect();
        Some(Opinion { text, ln_own: 0.0, ln_likelihood: Vec::new(), no_speech: 0.0 })
    }

    fn idle_at(&self) -> Option<Instant> {
        self.state.retry_at()
    }

    fn idle(&mut self, is_over: &dyn Fn() -> bool) {
        let examined = self.client.examine(Kind::Recogniser, is_over);
        self.record(&examined);
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use crossbeam_channel::{Receiver, unbounded};
    use wyoming::Info;
    use wyoming::stand_in::{Manner, Request, StandIn};

    use super::*;
    use crate::testing::bowls;

    const PATIENCE: Duration = Duration::from_secs(20);
    const ANSWER: Duration = Duration::from_millis(300);

    /// The recogniser beside the server.
    struct Deaf;

    impl Recogniser for Deaf {
        fn recognise(&mut self, _: &[i16], _: Range<usize>) -> Recognition {
            Ok(FirstView::default())
        }
    }

    fn started(server: &StandIn, answer: Duration) -> (SecondOpinion, Receiver<Option<String>>) {
        started_beside(&Deaf, server, answer)
    }

    fn started_beside(
        first: &dyn Recogniser,
        server: &StandIn,
        answer: Duration,
    ) -> (SecondOpinion, Receiver<Option<String>>) {
        let client = Client::new(server.address.clone(), PATIENCE, answer);
        let built_in = PocketSphinxOptions::debian("/nonexistent");
        let (report, reported) = unbounded();
        let report = Box::new(move |note| report.send(note).unwrap());
        (start(&WyomingOptions { client, built_in }, &bowls(), first, report), reported)
    }

    fn ask(second: &SecondOpinion) -> Option<Opinion> {
        let until = Instant::now() + PATIENCE;
        let pending = second.begin(&[7; 8_000], until).unwrap();
        pending.opinion().recv_deadline(until).ok()
    }

    #[test]
    fn wyoming_recogniser_hands_on_the_words_of_the_scene_and_is_never_certain() {
        let server = StandIn::start(Manner::Answer(" The WHITE one, please! ".to_owned()));
        let (second, reported) = started(&server, PATIENCE);
        assert!(second.decides());
        let [heard] = &ask(&second).unwrap().alone()[..] else { panic!("one hypothesis") };
        assert_eq!(heard.text, "the white one please");
        assert_eq!(heard.word_confidence, [CONFIDENCE; 4]);
        let [Request::Transcribe(terms, 16_000)] = &server.requests()[..] else { panic!("one") };
        for term in ["bowl", "white", "dishwasher"] {
            assert_eq!(terms.iter().filter(|it| *it == term).count(), 1, "{terms:?}");
        }
        server.behave(Manner::Answer("... ".to_owned()));
        assert!(ask(&second).unwrap().alone().is_empty());
        server.behave(Manner::Answer("x".repeat(1 << 19)));
        let long = ask(&second).unwrap();
        assert!(long.is_too_long() && long.text.len() == TEXT_MAX + 1);
        assert!(reported.is_empty(), "it works");
    }

    const CONFIDENCE: f32 = 0.9;

    #[test]
    fn wyoming_recogniser_reports_each_failure_and_recovers() {
        let server = StandIn::start(Manner::Error("no model".to_owned()));
        let (second, reported) = started(&server, PATIENCE);
        let note = || reported.recv_timeout(PATIENCE).unwrap().unwrap();
        for (manner, expected) in [
            (Manner::Error("no model".to_owned()), "it reports: no model"),
            (Manner::Bytes(b"garbage\n".to_vec()), "not JSON"),
            (Manner::Cut(b"{\"type\": \"trans".to_vec()), "ended the connection"),
        ] {
            server.behave(manner);
            assert_eq!(ask(&second), None, "{expected}");
            let note = note();
            assert!(note.contains(expected), "{note}");
            assert!(note.starts_with("built-in recogniser in place of tcp://127"), "{note}");
        }
        server.behave(Manner::Answer("yes".to_owned()));
        assert_eq!(ask(&second).unwrap().text, "yes");
        assert_eq!(reported.recv_timeout(PATIENCE), Ok(None));
    }

    #[test]
    fn wyoming_recogniser_never_takes_a_late_answer() {
        let server = StandIn::start(Manner::Slow("late".to_owned(), 2 * ANSWER));
        let (second, reported) = started(&server, ANSWER);
        assert_eq!(ask(&second), None);
        let note = reported.recv_timeout(PATIENCE).unwrap().unwrap();
        assert!(note.contains("no answer within 300 ms; help: raise"), "{note}");
        server.behave(Manner::Answer("yes".to_owned()));
        // A busy machine may be late a few times.
        let heard = (0..50).find_map(|_| ask(&second)).unwrap();
        assert_eq!(heard.text, "yes");
        while reported.recv_timeout(PATIENCE).unwrap().is_some() {}
    }

    #[test]
    fn wyoming_recogniser_says_what_is_missing() {
        let server = StandIn::start(Manner::Offers(Info::default()));
        let (_second, reported) = started_beside(&NoWords, &server, PATIENCE);
        let note = reported.recv_timeout(PATIENCE).unwrap().unwrap();
        let expected = format!("nothing in place of {}: it offers no recogniser", server.address);
        assert_eq!(note, expected);
    }

    #[test]
    fn wyoming_recogniser_looks_for_a_server_that_is_away() {
        let free = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        let port = free.local_addr().unwrap().port();
        drop(free);
        let mut away = StandIn::start(Manner::Deaf);
        away.address.port = port;
        let (second, reported) = started(&away, PATIENCE);
        assert!(reported.recv_timeout(PATIENCE).unwrap().unwrap().contains("no connection"));
        assert_eq!(ask(&second), None);
        let _back = StandIn::start_at(port, Manner::Answer("yes".to_owned()));
        assert_eq!(reported.recv_timeout(PATIENCE), Ok(None), "without an utterance");
        // A busy machine may be late a few times.
        let heard = (0..50).find_map(|_| ask(&second)).unwrap();
        assert_eq!(heard.text, "yes");
    }

    #[test]
    fn wyoming_recogniser_ends_though_its_server_is_silent() {
        let server = StandIn::start(Manner::Deaf);
        let (second, _reported) = started(&server, PATIENCE);
        let began = Instant::now();
        std::thread::sleep(Duration::from_millis(100));
        drop(second);
        assert!(began.elapsed() < PATIENCE / 2, "{:?}", began.elapsed());
    }

    #[test]
    fn recogniser_beside_the_server_may_be_missing_but_waits_for_the_disk() {
        let missing = RecogniserUnavailable::Missing("no library".to_owned());
        let mut alone = beside(Err(missing)).unwrap();
        assert!(alone.recognise(&[7; 100], 0..100).unwrap().hypotheses.is_empty());
        assert!(alone.is_missing() && !Deaf.is_missing());
        let short = RecogniserUnavailable::Short("full".to_owned());
        assert!(matches!(beside(Err(short)), Err(RecogniserUnavailable::Short(_))));
    }
}

//! A second opinion on utterances: a network that was trained on many voices scores the first
//! recogniser's texts, and adds words of its own. It needs a model file of the operator's, and the
//! feature `whisper`, because building its library takes a C++ compiler, cmake and libclang.
//!
//! Another kind of second recogniser decides alone: one that the operator chose, with the built-in
//! one beside it.
//!
//! Invariant: the network never acts alone, and no second recogniser delays beyond its limit.
//! Without one, and if it is late, the first recogniser's hypotheses count as they are.

mod combine;
#[cfg(feature = "whisper")]
mod engine;
#[cfg(feature = "whisper")]
mod rendering;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use scene::Scene;

use super::RecogniserUnavailable;
use crate::worker_thread::WorkerThread;
use messages::{CONFIDENCES_MAX, Hypothesis};

/// The second recogniser's result for an utterance.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Opinion {
    /// The network's own words, empty if it heard none.
    pub text: String,
    /// Logarithm of the likelihood of its own words.
    pub ln_own: f64,
    /// Logarithm of the likelihood of each of the first recogniser's hypotheses.
    pub ln_likelihood: Vec<f64>,
    /// Probability of no speech, 0 to 1.
    pub no_speech: f32,
}

/// Probability of no speech from which on there is none: that of words hardly exceeds 0.3.
const NO_SPEECH: f32 = 0.4;
/// Confidence in each word of a recogniser that decides alone and states none. Recognisers of open
/// vocabulary mistake a word in ten of short commands; a belief must not take them as certain.
const CONFIDENCE: f32 = 0.9;
/// Characters of the words of a recogniser that decides alone: a minute of fast speech.
pub(super) const TEXT_MAX: usize = 2_000;

impl Opinion {
    /// Returns whether the network heard no speech.
    pub fn is_silence(&self) -> bool {
        self.no_speech > NO_SPEECH
    }

    /// Returns the hypotheses of both recognisers, heaviest first.
    pub fn combined_with(&self, first: &[Hypothesis]) -> Vec<Hypothesis> {
        combine::combined(first, self)
    }

    /// Returns whether its own words are cut, or more than those whose confidence is published:
    /// the others would count as certain.
    pub fn is_too_long(&self) -> bool {
        self.text.split_whitespace().count() > CONFIDENCES_MAX
            || self.text.chars().count() > TEXT_MAX
    }

    /// Returns its own words as the only hypothesis, if there are any.
    pub fn alone(&self) -> Vec<Hypothesis> {
        let words = self.text.split_whitespace().map(|word| (word.to_owned(), CONFIDENCE));
        let hypothesis = Hypothesis::of_words(words, 1.0);
        if hypothesis.text.is_empty() { Vec::new() } else { vec![hypothesis] }
    }
}

/// Time limit of an opinion, which also ends when its receiver is dropped.
#[derive(Debug)]
pub struct Limit {
    until: Instant,
    dropped: AtomicBool,
}

impl Limit {
    /// Returns whether the opinion is too late, or not needed any more.
    pub fn is_over(&self) -> bool {
        self.dropped.load(Ordering::Relaxed) || Instant::now() >= self.until
    }
}

/// An utterance for the thread of the network.
struct Job {
    samples: Vec<i16>,
    candidates: Receiver<Vec<String>>,
    opinion: Sender<Opinion>,
    limit: Arc<Limit>,
}

/// The second recogniser, on a thread of its own.
pub struct SecondOpinion {
    thread: WorkerThread<Job>,
    decides: bool,
    closed: Arc<AtomicBool>,
}

impl Drop for SecondOpinion {
    fn drop(&mut self) {
        self.closed.store(true, Ordering::Relaxed);
    }
}

/// An utterance that the second recogniser is listening to. Dropping it makes it stop.
pub struct PendingOpinion {
    candidates: Sender<Vec<String>>,
    opinion: Receiver<Opinion>,
    limit: Arc<Limit>,
}

/// A network that listens to utterances.
pub trait Network {
    /// Returns the opinion on the samples; asks for the first recogniser's texts when its own words
    /// are known. `None`: it was too late or not needed any more, or it failed.
    fn opinion(
        &mut self,
        samples: &[i16],
        candidates: &dyn Fn() -> Option<Vec<String>>,
        limit: &Limit,
    ) -> Option<Opinion>;

    /// Returns when [`Self::idle`] is due.
    fn idle_at(&self) -> Option<Instant> {
        None
    }

    /// Does what is due while there is no utterance, until `is_over`.
    fn idle(&mut self, _is_over: &dyn Fn() -> bool) {}
}

/// Loads a model for the sentences of a scene.
///
/// # Errors
/// If the file is missing or rejected, or this build lacks the library.
#[cfg(feature = "whisper")]
pub fn load(model: &Path, scene: &Scene) -> Result<Box<dyn Network>, RecogniserUnavailable> {
    match engine::Engine::open(model, &rendering::example(scene)) {
        Ok(engine) => Ok(Box::new(engine)),
        Err(reason) => Err(RecogniserUnavailable::Missing(format!(
            "speech.whisper_model: {} cannot be loaded: {reason}; help: fetch ggml-base-q8_0.bin of \
             whisper.cpp, 81,768,585 bytes (docs/speech.md has its SHA-256)",
            model.display()
        ))),
    }
}

/// Returns that this build lacks the library.
///
/// # Errors
/// Always.
#[cfg(not(feature = "whisper"))]
pub fn load(_: &Path, _: &Scene) -> Result<Box<dyn Network>, RecogniserUnavailable> {
    Err(RecogniserUnavailable::Missing(
        "speech.whisper_model: the second recogniser is not part of this build; help: build with \
         `--features whisper` (WHICHONE_FEATURES=whisper scripts/run), or remove the key"
            .to_owned(),
    ))
}

/// Scheduling priority relative to the threads that return results (nice).
const NICENESS: i32 = 5;
/// Utterances that may wait while the network notices that the one before is over.
const WAITING_MAX: usize = 8;

impl SecondOpinion {
    /// Starts the thread, which first loads a model for the sentences of a scene; until then it has
    /// no opinion.
    pub fn start(model: PathBuf, scene: Scene) -> Self {
        Self::with(move || match load(&model, &scene) {
            Ok(network) => Some(network),
            Err(error) => {
                tracing::warn!(%error, "no second opinion on what is heard");
                None
            }
        })
    }

    /// Starts a thread that asks the network of `open`.
    pub fn with(open: impl FnOnce() -> Option<Box<dyn Network>> + Send + 'static) -> Self {
        let run = move |jobs: &Receiver<Job>| {
            let Some(network) = open() else { return };
            // Without the permission it runs at normal priority.
            let _ = rustix::process::setpriority_process(Some(rustix::thread::gettid()), NICENESS);
            serve(network, jobs, &AtomicBool::new(false));
        };
        let thread = WorkerThread::start(WAITING_MAX, run);
        Self { thread, decides: false, closed: Arc::default() }
    }

    /// Starts a thread that asks a recogniser which decides alone.
    pub fn deciding(open: impl FnOnce() -> Box<dyn Network> + Send + 'static) -> Self {
        let closed: Arc<AtomicBool> = Arc::default();
        let own = Arc::clone(&closed);
        let run = move |jobs: &Receiver<Job>| serve(open(), jobs, &own);
        Self { thread: WorkerThread::start(WAITING_MAX, run), decides: true, closed }
    }

    /// Returns whether it decides alone, so that its words count in place of the first
    /// recogniser's.
    pub fn decides(&self) -> bool {
        self.decides
    }

    /// Begins to listen to one utterance, 16 kHz mono, as it was recorded. `None`: no room.
    pub fn begin(&self, samples: &[i16], until: Instant) -> Option<PendingOpinion> {
        let limit = Arc::new(Limit { until, dropped: AtomicBool::new(false) });
        let (candidates, asked) = bounded(1);
        let (known, opinion) = bounded(1);
        let samples = samples.to_vec();
        let job = Job { samples, candidates: asked, opinion: known, limit: Arc::clone(&limit) };
        self.thread.offer(job).ok()?;
        Some(PendingOpinion { candidates, opinion, limit })
    }
}

/// Asks the network about each utterance. Work dropped meanwhile is skipped: it would only delay
/// the next one.
fn serve(mut network: Box<dyn Network>, jobs: &Receiver<Job>, closed: &AtomicBool) {
    let is_wanted = || closed.load(Ordering::Relaxed) || !jobs.is_empty();
    loop {
        let next = match network.idle_at() {
            None => jobs.recv().map_err(RecvTimeoutError::from),
            Some(at) => jobs.recv_deadline(at),
        };
        match next {
            Ok(Job { limit, .. }) if limit.is_over() => {}
            Ok(Job { samples, candidates, opinion, limit }) => {
                let candidates = || candidates.recv_deadline(limit.until).ok();
                if let Some(known) = network.opinion(&samples, &candidates, &limit) {
                    // The receiver may have been dropped.
                    let _ = opinion.send(known);
                }
            }
            Err(RecvTimeoutError::Timeout) => network.idle(&is_wanted),
            Err(RecvTimeoutError::Disconnected) => return,
        }
    }
}

impl PendingOpinion {
    /// Asks for the opinion on the first recogniser's hypotheses; the first call counts.
    pub fn ask_about(&self, first: &[Hypothesis]) {
        let texts = first.iter().map(|hypothesis| hypothesis.text.clone()).collect();
        // The thread may have given up already.
        let _ = self.candidates.try_send(texts);
    }

    /// Returns the opinion's channel; disconnected if there will be none.
    pub fn opinion(&self) -> &Receiver<Opinion> {
        &self.opinion
    }

    /// Returns the time after which the opinion is late.
    pub fn until(&self) -> Instant {
        self.limit.until
    }
}

impl Drop for PendingOpinion {
    fn drop(&mut self) {
        self.limit.dropped.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::bowls;

    #[test]
    fn second_opinion_names_what_is_missing() {
        let Err(error) = load(Path::new("/no/such/ggml-model.bin"), &bowls()) else {
            panic!("a missing model opened")
        };
        let help = if crate::WHISPER { "ggml-base-q8_0.bin" } else { "not part of this build" };
        assert!(error.to_string().contains(help), "{error}");
    }

    /// Answers "yes" once it is permitted to.
    struct Slow(Receiver<()>);

    impl Network for Slow {
        fn opinion(
            &mut self,
            _: &[i16],
            _: &dyn Fn() -> Option<Vec<String>>,
            _: &Limit,
        ) -> Option<Opinion> {
            self.0.recv().ok()?;
            let text = "yes".to_owned();
            Some(Opinion { text, ln_own: 0.0, ln_likelihood: Vec::new(), no_speech: 0.0 })
        }
    }

    #[test]
    fn second_opinion_skips_what_was_dropped_while_it_was_busy() {
        let (permit, permission) = bounded(2);
        let second = SecondOpinion::with(move || Some(Box::new(Slow(permission))));
        let until = Instant::now() + std::time::Duration::from_secs(60);
        let first = second.begin(&[1], until).unwrap();
        for _ in 1..WAITING_MAX - 1 {
            drop(second.begin(&[1], until).expect("room"));
        }
        let last = second.begin(&[1], until).expect("room");
        // As many permissions as utterances that count.
        (0..2).for_each(|_| permit.send(()).unwrap());
        for pending in [first, last] {
            assert_eq!(pending.opinion().recv_deadline(until).unwrap().text, "yes");
        }
    }

    #[cfg(feature = "whisper")]
    #[test]
    #[ignore = "needs a model of whisper.cpp (WHICHONE_WHISPER_MODEL)"]
    fn second_opinion_is_deterministic_and_keeps_its_limit() {
        use crate::testing::voice;
        use std::time::Duration;
        let model = std::env::var_os("WHICHONE_WHISPER_MODEL").expect("WHICHONE_WHISPER_MODEL");
        let second = SecondOpinion::start(model.into(), bowls());
        let first: Vec<_> =
            ["the white one", "the white bowl", "yes"].map(Hypothesis::certain).into();
        let listen = |samples: &[i16], within_s| {
            let until = Instant::now() + Duration::from_secs(within_s);
            let pending = second.begin(samples, until).unwrap();
            pending.ask_about(&first);
            pending.opinion().recv_deadline(until).ok()
        };
        let once = listen(&voice(2.0), 60).unwrap();
        assert_eq!(listen(&voice(2.0), 60).unwrap(), once);
        assert!(once.ln_likelihood.len() == 3 && once.ln_likelihood.iter().all(|ln| *ln <= 0.0));
        assert!(listen(&[1; 100], 60).is_some());
        assert_eq!(listen(&voice(2.0), 0), None);
        drop(second.begin(&voice(2.0), Instant::now() + Duration::from_secs(60)));
        assert!(listen(&voice(1.0), 60).is_some(), "usable behind what was dropped");
    }
}

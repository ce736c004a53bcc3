//! Ends of utterances: how soon after the voice, and how often in the middle of a sentence.
//!
//! The clips pass through the service's own stream, recogniser and judgement in simulated time, in
//! which decoding takes as long as it took.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use ::speech::hearing::{Gate, Heard, SecondView};
use ::speech::{EarlyDecoding, Endpointing, PreparedJudge, RecognisedSegment};
use ::speech_engines::audio::RATE_HZ;
use ::speech_engines::recogniser::{PocketSphinx, PocketSphinxOptions, Recogniser};
use ::speech_engines::stream::{Began, Closings, LIVE_FROM, SpeechSegment, Stream, StreamEvent};
use ::speech_engines::vad::SegmenterOptions;
use language::{Completeness, Reader};
use messages::{RequestKey, Source};
use scene::{Question, Reading, Scene};
use service::{Span, Time};
use vocabulary::Language;
use whichone_tests::spoken::{Pink, SPEAKERS, SPEECH_RMS, levelled};

use super::conditions::QUIET;
use super::corpus::question;
use super::voices::Voices;
use crate::report::{Report, percentile, print};

/// Inner pauses, milliseconds.
const PAUSES_MS: [u32; 6] = [150, 300, 450, 600, 750, 900];
/// Voices per sentence, out of [`SPEAKERS`] in turn.
const VOICES: usize = 2;
/// Speech above the noise, decibels.
const SNR_DB: f64 = 25.0;
/// Samples per block of a microphone: 20 ms.
const BLOCK: usize = 320;
/// Quiet before and behind the voice, seconds.
const LEAD_S: f64 = 0.8;
const TAIL_S: f64 = 1.4;

/// A sentence in which people may stop to think.
struct Hesitant {
    question: Question,
    /// Before and after the pause; the second is empty where there is none.
    parts: [String; 2],
}

/// How utterances end.
struct Rule {
    name: &'static str,
    /// Pauses that end a complete utterance, any other one, and an open one.
    pauses: [Duration; 3],
    interrupts: bool,
    options: SegmenterOptions,
}

/// An utterance that the service found.
struct Found {
    /// When its end was certain, and when its result was there, seconds.
    ended_s: f64,
    ready_s: f64,
    text: String,
}

pub(super) fn measure(report: &mut Report, voices: &Voices, quick: bool) {
    let scene = crate::core::scenes::configured("bowls");
    let sentences = sentences(&scene);
    let config = whichone_tests::settings(&[]).speech;
    let by_meaning = [config.complete_pause, config.closing_pause, config.open_pause];
    let rule = |name, pauses, interrupts| {
        let options = ::speech::options::segmenter(&config);
        Rule { name, pauses, interrupts, options }
    };
    let rules = [
        rule("the closing pause always", [config.closing_pause; 3], false),
        rule("by meaning", by_meaning, false),
        rule("by meaning, the robot can be interrupted", by_meaning, true),
    ];
    let mut cut_rows = Vec::new();
    let mut end_rows = Vec::new();
    let voices_each = if quick { 1 } else { VOICES };
    // Decoding counts by processor time, so rules may be measured side by side.
    let heard = std::thread::scope(|scope| {
        let hear = |rule| {
            let (scene, sentences) = (&scene, &sentences);
            scope.spawn(move || {
                Room::open(scene, voices, rule).map(|mut room| room.hear(sentences, voices_each))
            })
        };
        let rooms: Vec<_> = rules.iter().map(hear).collect();
        rooms.into_iter().map(|room| room.join().expect("a room")).collect::<Vec<_>>()
    });
    for (rule, heard) in rules.iter().zip(heard) {
        let (cuts, ends) = match heard {
            Ok(tables) => tables,
            Err(error) => return print(&format!("ends of utterances are left out: {error}")),
        };
        cut_rows.push(std::iter::once(rule.name.to_owned()).chain(cuts).collect());
        end_rows.push(std::iter::once(rule.name.to_owned()).chain(ends).collect());
    }
    let heads: Vec<String> = ["an utterance ends".to_owned()]
        .into_iter()
        .chain(PAUSES_MS.iter().map(|ms| format!("{ms} ms")))
        .chain(["all".to_owned(), "after \"no\"".to_owned(), "after words that lead on".to_owned()])
        .chain(["elsewhere".to_owned()])
        .collect();
    let note = format!(
        "Share of {} sentences (tests/fixtures/speech/pauses.txt) that were ended in an inner pause of \
         this length, at {SNR_DB} dB.",
        sentences.iter().filter(|sentence| sentence.pauses()).count()
    );
    report.table("People cut off", note, heads, cut_rows);
    let heads = [
        "an utterance ends",
        "after the voice's end, ms, p50",
        "p95",
        "complete: p50",
        "complete: p95",
        "meaning right",
        "decodings per utterance",
    ];
    let note = "The same sentences without pauses and short answers: from the end of the voice to the \
                recogniser's result. Complete: of those judged so by their true words.";
    report.table("Ends of utterances", note, heads, end_rows);
}

fn sentences(scene: &Scene) -> Vec<Hesitant> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/speech/pauses.txt");
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let sentence = |line: &str| {
        let mut columns = line.split(" | ").skip(1);
        let question = question(scene, columns.next()?)?;
        let text = columns.next()?;
        let (first, second) = text.split_once(" ... ").unwrap_or((text, ""));
        Some(Hesitant { question, parts: [first.to_owned(), second.to_owned()] })
    };
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| sentence(line).unwrap_or_else(|| panic!("{path}: {line}"))).collect()
}

/// One pause within an utterance: its length in milliseconds, how complete the words before it are,
/// whether they deny, and whether the utterance was ended there.
type Cut = (u32, Completeness, bool, bool);

impl Hesitant {
    fn pauses(&self) -> bool {
        !self.parts[1].is_empty()
    }

    fn text(&self) -> String {
        self.parts.join(" ").trim().to_owned()
    }
}

/// A room with one robot.
struct Room<'a> {
    voices: &'a Voices,
    recogniser: PocketSphinx,
    gate: Gate,
    reader: Reader,
    endpointing: Endpointing,
    rule: &'a Rule,
    decodings: usize,
    _work: tempfile::TempDir,
}

impl<'a> Room<'a> {
    fn open(scene: &Scene, voices: &'a Voices, rule: &'a Rule) -> Result<Self, String> {
        let work = tempfile::tempdir().map_err(|error| error.to_string())?;
        let options = PocketSphinxOptions::debian(work.path());
        let [complete, closing, open] = rule.pauses;
        Ok(Self {
            voices,
            recogniser: PocketSphinx::open(scene, &options).map_err(|error| error.to_string())?,
            gate: Gate::new(scene, Gate::THRESHOLD),
            reader: Reader::new(scene, Language::Careful),
            endpointing: Endpointing { judge: PreparedJudge::new(scene), complete, closing, open },
            rule,
            decodings: 0,
            _work: work,
        })
    }

    /// Returns the cells of both tables.
    fn hear(&mut self, sentences: &[Hesitant], voices: usize) -> (Vec<String>, Vec<String>) {
        let mut cuts: Vec<Cut> = Vec::new();
        let (mut delays, mut complete, mut right, mut heard) = (Vec::new(), Vec::new(), 0, 0);
        for (n, sentence) in sentences.iter().enumerate() {
            for voice in 0..voices {
                let voice = (n + voice * 2) % SPEAKERS.len();
                let judge = |text: &str| self.endpointing.judge.judge(text, sentence.question);
                let (whole, first) = (judge(&sentence.text()), judge(&sentence.parts[0]));
                let denies = sentence.parts[0] == "no";
                for ms in PAUSES_MS.iter().filter(|_| sentence.pauses()) {
                    let (found, resumed_s, _) = self.say(sentence, voice, *ms);
                    let is_cut = found.iter().any(|found| found.ended_s < resumed_s);
                    cuts.push((*ms, first, denies, is_cut));
                }
                let (found, _, ended_s) = self.say(&plain(sentence), voice, 0);
                heard += 1;
                let Some(last) = found.last() else { continue };
                let text: Vec<&str> = found.iter().map(|found| found.text.as_str()).collect();
                right +=
                    usize::from(self.same(&text.join(" "), &sentence.text(), sentence.question));
                delays.push((last.ready_s - ended_s) * 1e3);
                if whole == Completeness::Complete {
                    complete.push((last.ready_s - ended_s) * 1e3);
                }
            }
        }
        let share = |of: &dyn Fn(&Cut) -> bool| {
            let among: Vec<_> = cuts.iter().filter(|cut| of(cut)).collect();
            let cut = among.iter().filter(|cut| cut.3).count();
            format!("{:.0} % of {}", 100.0 * cut as f64 / among.len().max(1) as f64, among.len())
        };
        let mut cells: Vec<String> =
            PAUSES_MS.iter().map(|ms| share(&|cut| cut.0 == *ms)).collect();
        cells.push(share(&|_| true));
        cells.push(share(&|cut| cut.2));
        cells.push(share(&|cut| !cut.2 && cut.1 == Completeness::Open));
        cells.push(share(&|cut| !cut.2 && cut.1 != Completeness::Open));
        let at = |samples: &[f64], share| format!("{:.0}", percentile(samples, share));
        let ends = vec![
            at(&delays, 0.5),
            at(&delays, 0.95),
            at(&complete, 0.5),
            at(&complete, 0.95),
            format!("{:.1} % of {heard}", 100.0 * right as f64 / heard.max(1) as f64),
            format!("{:.2}", self.decodings as f64 / (heard + cuts.len()).max(1) as f64),
        ];
        (cells, ends)
    }

    fn same(&self, heard: &str, said: &str, question: Question) -> bool {
        let meaning = |text: &str| {
            let Reading { mut base, response, mut excluded, .. } = self.reader.read(text, question);
            base.sort_unstable();
            base.dedup();
            excluded.sort_unstable();
            (base, response, excluded)
        };
        meaning(heard) == meaning(said)
    }

    /// Says a sentence. Returns what was found, and when the voice resumed and ended, seconds.
    fn say(&mut self, sentence: &Hesitant, voice: usize, pause_ms: u32) -> (Vec<Found>, f64, f64) {
        let seed = u64::from(pause_ms) + voice as u64 * 1_000 + sentence.text().len() as u64;
        let noise = Pink::new(SPEECH_RMS / 10_f64.powf(SNR_DB / 20.0), seed);
        let quiet = |s: f64| vec![0; (s * f64::from(RATE_HZ)) as usize];
        let speak = |text: &str| match text {
            "" => Vec::new(),
            text => levelled(&self.voices.speak(&SPEAKERS[voice], &QUIET, text)),
        };
        let [first, second] = sentence.parts.each_ref().map(|part| speak(part));
        let before = [quiet(LEAD_S), first, quiet(f64::from(pause_ms) / 1e3)].concat();
        let resumed_s = before.len() as f64 / f64::from(RATE_HZ);
        let voiced = [before, second].concat();
        let ended_s = voiced.len() as f64 / f64::from(RATE_HZ);
        let clip = [voiced, quiet(TAIL_S)].concat();
        let noisy =
            clip.iter().zip(noise).map(|(sample, noise)| (f64::from(*sample) + noise) as i16);
        let found = self.listen(&noisy.collect::<Vec<_>>(), sentence.question);
        (found, resumed_s, ended_s)
    }

    fn listen(&mut self, clip: &[i16], question: Question) -> Vec<Found> {
        let closings = Arc::new(Closings::default());
        let mut stream = Stream::new(self.rule.options.clone(), Arc::clone(&closings));
        let mut early = EarlyDecoding::default();
        let mut decoder = Decoder::default();
        let (mut found, mut sound) = (Vec::new(), LIVE_FROM);
        for (n, block) in clip.chunks(BLOCK).enumerate() {
            let now_s = (n + 1) as f64 * BLOCK as f64 / f64::from(RATE_HZ);
            while let Some(Job { sound, segment, result, done_s }) = decoder.take_done(now_s) {
                let at = segment.closing(Duration::ZERO);
                let next = early.decoded(sound, at);
                let judged = self.endpointing.judge(&result, question);
                let pause = self.endpointing.pause(judged, self.rule.interrupts);
                closings.set(sound, segment.closing(pause));
                if let Some(segment) = next.filter(|_| judged != Completeness::Complete) {
                    early.begun(sound, at);
                    decoder.start(sound, segment, done_s, |segment| self.decode(segment));
                }
            }
            let mut began = |at: Time| {
                sound += 1;
                let (stream, source) = (RequestKey([1; 16]), Source::Microphone);
                Began { sound, at, stream, segment: None, source, interrupts: false }
            };
            let at = Time(1_000_000_000) + Span::from_s(now_s - BLOCK as f64 / f64::from(RATE_HZ));
            for event in stream.push(at, block, &mut began) {
                match event {
                    StreamEvent::Paused { sound, segment } => {
                        if let Some(segment) = early.offer(sound, segment) {
                            decoder.start(sound, segment, now_s, |segment| self.decode(segment));
                        }
                    }
                    StreamEvent::Ended { segment, sound } => {
                        let decode = |segment: &SpeechSegment| self.decode(segment);
                        let (result, ready_s) = decoder.finish(sound, segment, now_s, decode);
                        let text = result.text().unwrap_or_default().to_owned();
                        found.push(Found { ended_s: now_s, ready_s, text });
                    }
                    _ => {}
                }
            }
        }
        found
    }

    /// Decodes as the service does. Returns the seconds that it took, too.
    fn decode(&mut self, segment: &SpeechSegment) -> (RecognisedSegment, f64) {
        self.decodings += 1;
        let cpu_s = crate::arm::thread_s();
        let first = self.recogniser.recognise(&segment.samples, segment.speech.clone());
        let first = first.unwrap_or_default();
        let heard = Heard { first: first.clone(), second: SecondView::NotAsked };
        let hypotheses = self.gate.judge(&heard, || true);
        let took_s = crate::arm::thread_s() - cpu_s;
        let result = RecognisedSegment::accepted((0.0, 0.0), SNR_DB as f32, first.hypotheses);
        (RecognisedSegment { hypotheses, ..result }, took_s)
    }
}

/// A decoding in simulated time.
struct Job {
    sound: u64,
    segment: SpeechSegment,
    result: RecognisedSegment,
    done_s: f64,
}

/// The recogniser's thread: one decoding after the other.
#[derive(Default)]
struct Decoder {
    jobs: VecDeque<Job>,
    done: Vec<Job>,
    free_s: f64,
}

impl Decoder {
    fn start(
        &mut self,
        sound: u64,
        segment: SpeechSegment,
        now_s: f64,
        decode: impl FnOnce(&SpeechSegment) -> (RecognisedSegment, f64),
    ) {
        let (result, took_s) = decode(&segment);
        self.free_s = self.free_s.max(now_s) + took_s;
        self.jobs.push_back(Job { sound, segment, result, done_s: self.free_s });
    }

    fn take_done(&mut self, now_s: f64) -> Option<Job> {
        self.jobs.front().filter(|job| job.done_s <= now_s)?;
        let job = self.jobs.pop_front()?;
        let Job { sound, segment, result, done_s } = &job;
        let (sound, done_s) = (*sound, *done_s);
        let known = Job { sound, segment: segment.clone(), result: result.clone(), done_s };
        self.done.push(known);
        Some(job)
    }

    /// Returns the result for these samples and when it is there.
    fn finish(
        &mut self,
        sound: u64,
        segment: SpeechSegment,
        now_s: f64,
        decode: impl FnOnce(&SpeechSegment) -> (RecognisedSegment, f64),
    ) -> (RecognisedSegment, f64) {
        let known = self.done.iter().chain(&self.jobs).find(|job| job.segment == segment);
        if let Some(job) = known {
            return (job.result.clone(), job.done_s.max(now_s));
        }
        self.start(sound, segment, now_s, decode);
        let job = self.jobs.pop_back().expect("a job that was started");
        (job.result, job.done_s)
    }
}

/// The sentence without its pause.
fn plain(sentence: &Hesitant) -> Hesitant {
    Hesitant { question: sentence.question, parts: [sentence.text(), String::new()] }
}

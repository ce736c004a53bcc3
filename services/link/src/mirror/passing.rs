//! The main loop of a mirror: passes states to local topics, local words and sound to the robot.

use std::collections::VecDeque;
use std::io::Read;
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use config::Settings;
use messages::{
    AudioChunk, Injection, Presented, Receipt, ReceiptStatus, Service, Sound, SoundFile, topics,
};
use service::bus::{Bus, EncodedReader, Identity, Joined, Reader, WakeListener};
use service::exit::{Exit, Failure};
use service::status::GroupStatus;
use service::worker_channel::{DeviceReceiver, DeviceSender};
use service::{Span, Time, clock};
use zenoh::Wait;
use zenoh::qos::{CongestionControl, Priority};

use super::console::Console;
use super::control::{self, Known, lock};
use super::inlets::Inlets;
use super::local::{INCARNATION, Local};
use super::motion::{Event, Motion};
use super::{End, Inbound, Link, SAID};
use crate::line::Line;
use crate::names::Call;
use crate::offset::{Offset, age_ns};
use crate::presence::Hello;
use crate::say::{Outbound, PATIENCE, Receipts, Said, Sent};
use crate::session::{request, request_at};
use crate::trouble::Trouble;

/// Longest sleep.
const LOOK_EVERY: Span = Span::from_ms(10);
/// Interval at which late readers are handed the latest messages, and the console is looked after.
const TEND_EVERY: Span = Span::from_ms(200);
/// Messages of one pass: a robot that sends without end does not keep the loop.
const INBOUND_MAX: usize = 256;
/// Longest wait of a robot's line for its sound.
const SOUND_PATIENCE: Span = Span::from_ms(800);
/// Largest sound file that is sent to the robot, bytes: four minutes of speech.
const FILE_BYTES_MAX: u64 = 8 << 20;
/// Sounds of lines that are kept.
const LINES_KEPT: usize = 16;

/// Mirrors until an end.
pub(super) fn run(
    link: &Link,
    inbox: &DeviceReceiver<Inbound>,
    local: Local,
    hello: &Hello,
    settings: &Settings,
    is_ending: &dyn Fn() -> bool,
) -> Result<End, Failure> {
    let mut passing = Passing::open(link, inbox, local, hello, settings)?;
    let end = loop {
        if is_ending() || lock(&passing.known).is_down {
            break End::Asked;
        }
        passing.wait();
        if passing.pass() {
            break End::Changed;
        }
    };
    lock(&passing.known).is_down = true;
    // Wakes the thread that listens there, so that it ends.
    let _ = UnixStream::connect(passing.local.paths.control_socket());
    Ok(end)
}

/// A request with words that is under way; its end is reported.
struct WordsAsked {
    key: messages::RequestKey,
    sender: DeviceSender<Inbound>,
}

impl Drop for WordsAsked {
    fn drop(&mut self) {
        // A full inbox: it is asked again after its time.
        let _ = self.sender.offer(Inbound::WordsEnded(self.key));
    }
}

/// A line of the robot that waits for its sound.
struct Waiting {
    file: SoundFile,
    presented: Presented,
    since: Time,
}

struct Passing<'a> {
    link: &'a Link,
    inbox: &'a DeviceReceiver<Inbound>,
    hello: &'a Hello,
    known: Arc<Mutex<Known>>,
    motion: Motion,
    console: Option<Console>,
    inlets: Inlets,
    injections: EncodedReader<Injection>,
    audio: Reader<AudioChunk>,
    wake_listener: WakeListener,
    bus: Bus,
    /// Dropped last: it removes files that the others use.
    local: Local,
    offset: Offset,
    outbound: Outbound,
    /// The running link of the robot, by its number.
    alive: Option<String>,
    trouble: Trouble,
    voice_dir: Option<PathBuf>,
    line: Option<Waiting>,
    /// Lines with their sound, or not waiting for it, oldest first.
    lines: VecDeque<SoundFile>,
    tended: Time,
}

impl<'a> Passing<'a> {
    fn open(
        link: &'a Link,
        inbox: &'a DeviceReceiver<Inbound>,
        local: Local,
        hello: &'a Hello,
        settings: &Settings,
    ) -> Result<Self, Failure> {
        let failed = |what: &'static str| {
            move |e: std::io::Error| Failure::new(Exit::NotReached, format!("{what}: {e}"))
        };
        let paths = &local.paths;
        let identity = Identity { epoch: local.epoch, incarnation: INCARNATION };
        // As the service whose wake-ups it takes in place of the robot's.
        let bus = Bus::open(paths, Service::Speech.name(), identity)?;
        let console = match link.options.console {
            Some(_) => Some(Console::new(paths, local.epoch).map_err(failed("console"))?),
            None => None,
        };
        let known = Arc::new(Mutex::new(Known {
            robot: link.options.robot.clone(),
            group: paths.name().to_string(),
            epoch: hello.epoch,
            scene: settings.scene.name().to_owned(),
            config: paths.run(),
            began: Instant::now(),
            status: None,
            heard: None,
            console: console.as_ref().map(Console::pid),
            is_down: false,
        }));
        let voice_dir = console.is_some().then(|| paths.run().join(SAID));
        if let Some(folder) = &voice_dir {
            std::fs::create_dir_all(folder).map_err(|error| Failure::file(folder, &error))?;
        }
        let inlets = Inlets::open(&bus)?;
        let motion = Motion::start(paths, &link.session, &link.keys);
        let motion = motion.map_err(failed("the motion stop's socket"))?;
        control::listen(&paths.control_socket(), &known).map_err(failed("control socket"))?;
        Ok(Self {
            link,
            inbox,
            hello,
            known,
            motion,
            console,
            inlets,
            injections: bus.encoded_reader(&topics::INJECTION)?,
            audio: bus.reader(&topics::AUDIO)?,
            wake_listener: bus.wake_listener(Service::Speech)?,
            bus,
            local,
            offset: Offset::default(),
            outbound: Outbound::default(),
            alive: None,
            trouble: Trouble::default(),
            voice_dir,
            line: None,
            lines: VecDeque::new(),
            tended: Time(0),
        })
    }

    fn wait(&self) {
        let woken = self.wake_listener.sleep(&[Some(self.inbox.fd())], LOOK_EVERY);
        if woken.by_wake
            && let Some(joined) = self.wake_listener.take()
        {
            self.bus.connect(joined);
        }
    }

    /// One pass; returns whether the robot's group has changed.
    fn pass(&mut self) -> bool {
        let now = clock::now();
        self.inbox.clear();
        for _ in 0..INBOUND_MAX {
            let Some(inbound) = self.inbox.take() else { break };
            if self.take(inbound, now) {
                return true;
            }
        }
        self.pass_words(now);
        self.pass_sound(now);
        if self.line.as_ref().is_some_and(|line| now >= line.since + SOUND_PATIENCE) {
            self.present();
        }
        if now >= self.tended + TEND_EVERY {
            self.tended = now;
            self.bus.connect(Joined::Client);
            self.local.clean();
            if let Some(console) = &mut self.console {
                console.keep();
                lock(&self.known).console = Some(console.pid());
            }
        }
        false
    }

    fn take(&mut self, inbound: Inbound, now: Time) -> bool {
        match inbound {
            Inbound::State(name, bytes) => self.on_state(&name, &bytes, now),
            Inbound::Joints(bytes) => self.on_frame(topics::JOINTS.name, &bytes, now),
            Inbound::Receipts(key, bytes) => self.on_receipts(key, &bytes, now),
            Inbound::WordsEnded(key) => self.outbound.on_silence(key, now),
            Inbound::Line(bytes) => self.on_line(&bytes),
            Inbound::Hello(bytes) => {
                let new = postcard::from_bytes::<Hello>(&bytes);
                return new.is_ok_and(|new| new != *self.hello);
            }
            Inbound::Alive(start, true) => {
                // Its clock and its settings may be others than before.
                self.alive = Some(start);
                self.offset = Offset::default();
                self.link.ask_hello();
            }
            Inbound::Alive(start, false) => {
                if self.alive.as_ref() == Some(&start) {
                    tracing::warn!("the robot's link is gone; waiting for it");
                    lock(&self.known).heard = None;
                }
            }
        }
        false
    }

    fn on_state(&mut self, name: &str, bytes: &[u8], now: Time) {
        match name {
            "group" => {
                if let Ok(status) = serde_json::from_slice::<GroupStatus>(bytes) {
                    let mut known = lock(&self.known);
                    (known.status, known.heard) = (Some(status), Some(Instant::now()));
                }
            }
            "motion" => {
                if let Ok(seen) = postcard::from_bytes(bytes) {
                    let _ = self.motion.events.offer(Event::Seen(seen));
                }
            }
            topic => self.on_frame(topic, bytes, now),
        }
    }

    fn on_frame(&mut self, topic: &str, bytes: &[u8], now: Time) {
        let Self { inlets, offset, .. } = self;
        let passed = if topic == topics::PRESENTED.name {
            inlets.presented.news(bytes, now, offset).map(|news| {
                news.into_iter().for_each(|presented| self.on_presented(presented, now));
            })
        } else if topic == topics::RECEIPT.name {
            let news = inlets.receipts.news(bytes, now, offset);
            news.map(|news| news.iter().for_each(|receipt| self.inlets.receipts.write(receipt)))
        } else {
            inlets.pass(topic, bytes, now, offset)
        };
        match passed {
            Ok(()) => lock(&self.known).heard = Some(Instant::now()),
            Err(error) => {
                if let Some(frames) = self.trouble.count(now) {
                    tracing::warn!(topic, frames, "robot not shown: {error}");
                }
            }
        }
    }

    /// A line that has begun is shown once its sound has arrived, so that pages play it. The robot
    /// sends it before; it is requested if that was lost, or before this mirror's time.
    fn on_presented(&mut self, presented: Presented, now: Time) {
        let file = SoundFile::of(&presented);
        let has_sound = self.voice_dir.is_none() || self.lines.contains(&file);
        if has_sound || !presented.state.get().has_begun() {
            self.line = None;
            return self.inlets.presented.write(&presented);
        }
        let is_asked = self.line.as_ref().is_some_and(|line| line.file == file);
        let since = self.line.as_ref().filter(|_| is_asked).map_or(now, |line| line.since);
        self.line = Some(Waiting { file, presented, since });
        if !is_asked {
            let sender = self.link.sender.clone();
            let take = move |bytes| drop(sender.offer(Inbound::Line(bytes)));
            let Link { session, keys, .. } = self.link;
            request(
                session,
                keys,
                Call::Line,
                file.to_string().into_bytes(),
                Duration::from_nanos(PATIENCE.0),
                take,
            );
        }
    }

    fn on_line(&mut self, bytes: &[u8]) {
        let Some(folder) = &self.voice_dir else { return };
        let Some((file, sound)) = Line::decode(bytes) else {
            return tracing::warn!(
                "the robot's voice is unintelligible; help: install the same version on both machines"
            );
        };
        let path = folder.join(file.to_string());
        if let Err(error) = safe_files::replace_private(&path, sound) {
            tracing::warn!(%file, %error, "the sound of a line is not kept");
        }
        self.note_line(file);
        if self.line.as_ref().is_some_and(|line| line.file == file) {
            self.present();
        }
    }

    /// Shows the line that waits, with its sound or without.
    fn present(&mut self) {
        if let Some(Waiting { file, presented, .. }) = self.line.take() {
            // It is not requested again.
            self.note_line(file);
            self.inlets.presented.write(&presented);
        }
    }

    /// Notes a line with its sound, or not waiting for it, and forgets the oldest one.
    fn note_line(&mut self, file: SoundFile) {
        if self.lines.contains(&file) {
            return;
        }
        self.lines.push_back(file);
        if self.lines.len() > LINES_KEPT
            && let Some((oldest, folder)) = self.lines.pop_front().zip(self.voice_dir.as_ref())
        {
            let _ = std::fs::remove_file(folder.join(oldest.to_string()));
        }
    }

    fn pass_words(&mut self, now: Time) {
        let (outbound, receipts) = (&mut self.outbound, &self.inlets.receipts);
        let taken = self.injections.drain_in_turn(|injection| {
            let known = outbound.take(injection, now);
            known.into_iter().flatten().for_each(|receipt| receipts.write(receipt));
        });
        if let Err(error) = taken {
            tracing::debug!(%error, "words not read; tried again");
        }
        for said in self.outbound.due(now) {
            self.ask(said, now);
        }
    }

    fn ask(&mut self, mut said: Said, now: Time) {
        if let Sent::Sound(Sound::Wav(path)) = &said.sound {
            match contents(Path::new(path)) {
                Ok(contents) => said.sound = Sent::File(contents),
                Err(why) => return self.refuse(&said, &why, now),
            }
        }
        let patience = Duration::from_nanos(said.sound.patience().0);
        let asked = WordsAsked { key: said.key, sender: self.link.sender.clone() };
        let take = move |bytes| drop(asked.sender.offer(Inbound::Receipts(asked.key, bytes)));
        let Link { session, keys, .. } = self.link;
        // A file is long: words, sound and orders go ahead of it.
        let is_file = matches!(said.sound, Sent::File(_));
        let priority = if is_file { Priority::Data } else { Priority::InteractiveLow };
        let payload = postcard::to_stdvec(&said).unwrap_or_default();
        request_at(session, keys, (Call::Say, priority), payload, patience, take);
    }

    /// Refuses words in the robot's place.
    fn refuse(&mut self, said: &Said, why: &str, now: Time) {
        tracing::warn!(why, "words not passed on");
        let status = ReceiptStatus::Refused.into();
        let mut receipt = Receipt { key: said.key.0, segments: 1, status, ..Receipt::default() };
        receipt.onset_ns = now.ns();
        receipt.note = messages::FixedText::truncated(why);
        self.outbound.on_answer(said.key, &[receipt]);
        self.inlets.receipts.write(&receipt);
    }

    fn on_receipts(&mut self, key: messages::RequestKey, bytes: &[u8], now: Time) {
        let Ok(Receipts { sent_ns, mut receipts }) = postcard::from_bytes(bytes) else {
            return tracing::warn!(
                "unintelligible receipts; help: install the same version on both machines"
            );
        };
        self.offset.observe(sent_ns, now);
        for receipt in &mut receipts {
            receipt.onset_ns = self.offset.here(receipt.onset_ns);
            receipt.end_ns = self.offset.here(receipt.end_ns);
        }
        if self.outbound.on_answer(key, &receipts) {
            receipts.iter().for_each(|receipt| self.inlets.receipts.write(receipt));
        }
    }

    /// Streams sound; each chunk with the age of its first sample in place of the time.
    fn pass_sound(&mut self, now: Time) {
        let Link { session, keys, .. } = self.link;
        let taken = self.audio.drain(|chunk| {
            let mut chunk = *chunk;
            chunk.taken_ns = age_ns(chunk.taken_ns, now).unwrap_or_default();
            let bytes = postcard::to_stdvec(&chunk).unwrap_or_default();
            let put = session.put(keys.audio(), bytes).priority(Priority::InteractiveLow);
            if let Err(error) = put.congestion_control(CongestionControl::Drop).wait() {
                tracing::debug!(%error, "sound lost");
            }
        });
        if let Err(error) = taken {
            tracing::debug!(%error, "sound not read");
        }
    }
}

fn contents(path: &Path) -> Result<Vec<u8>, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", path.display());
    let mut file = safe_files::open_regular(path).map_err(failed)?;
    let bytes = file.metadata().map_err(failed)?.len();
    if bytes > FILE_BYTES_MAX {
        let (mib, most) = (bytes >> 20, FILE_BYTES_MAX >> 20);
        return Err(format!(
            "{}: {mib} MiB; at most {most} MiB are sent to a robot",
            path.display()
        ));
    }
    let mut contents = Vec::new();
    file.read_to_end(&mut contents).map_err(failed)?;
    Ok(contents)
}

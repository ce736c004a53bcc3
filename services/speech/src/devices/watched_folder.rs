//! A folder whose WAV files are heard as they appear.
//!
//! Invariant: a file is given to be heard under a key that its name, size and time make, so that a
//! restart in between does not have it heard twice; it is moved away when its receipts are there,
//! and not before. A file `NAME.wav` is complete: whoever writes it does so under another name and
//! renames it.

use std::collections::HashSet;
use std::fs::{self, Metadata};
use std::io;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, mpsc};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use messages::{Injection, Receipt, ReceiptStatus, RequestKey, Sound};
use serde_json::{Value as Json, json};

/// How often the folder is looked at.
const LOOK: Duration = Duration::from_millis(200);
/// How often a file that has no receipt yet is given again.
const AGAIN: Duration = Duration::from_millis(250);
/// Where files go that said something to the robot, and all others.
const FOLDERS: [&str; 2] = ["heard", "refused"];

/// Takes what is to be heard.
pub type Give = Box<dyn Fn(Injection) + Send>;

/// The thread that watches. Dropping it ends the thread.
pub struct WatchedFolder {
    receipts: Option<mpsc::SyncSender<Receipt>>,
    closed: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// Receipts that may wait for the thread; one that is lost is asked for again.
const RECEIPTS_MAX: usize = 64;

impl WatchedFolder {
    /// Starts the thread.
    pub fn start(folder: PathBuf, give: Give) -> Self {
        let (receipts, received) = mpsc::sync_channel(RECEIPTS_MAX);
        let closed = Arc::new(AtomicBool::new(false));
        let worker =
            Worker { folder, give, received, closed: Arc::clone(&closed), left: HashSet::new() };
        Self { receipts: Some(receipts), closed, thread: Some(thread::spawn(move || worker.run())) }
    }

    /// Takes note of what became of anything.
    pub fn told(&self, receipt: &Receipt) {
        if let Some(receipts) = &self.receipts {
            // A lost one is given again with the next request for it.
            let _ = receipts.try_send(*receipt);
        }
    }
}

impl Drop for WatchedFolder {
    fn drop(&mut self) {
        self.closed.store(true, Ordering::SeqCst);
        self.receipts = None;
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has told so already.
            let _ = thread.join();
        }
    }
}

struct Worker {
    folder: PathBuf,
    give: Give,
    received: mpsc::Receiver<Receipt>,
    closed: Arc<AtomicBool>,
    /// Files that could not be moved away, which are not to be heard again and again.
    left: HashSet<RequestKey>,
}

impl Worker {
    fn run(mut self) {
        let mut complained = None;
        while !self.closed.load(Ordering::SeqCst) {
            match self.next() {
                Ok(Some((path, key))) => self.hear(&path, key),
                Ok(None) => thread::sleep(LOOK),
                Err(error) => {
                    let told = error.to_string();
                    if complained.as_ref() != Some(&told) {
                        let folder = self.folder.display();
                        tracing::warn!(%folder, %error, "the watched folder cannot be used (speech.watch_dir)");
                        complained = Some(told);
                    }
                    thread::sleep(LOOK);
                }
            }
        }
    }

    /// The oldest file, of several the first by name.
    fn next(&self) -> io::Result<Option<(PathBuf, RequestKey)>> {
        for folder in FOLDERS {
            fs::create_dir_all(self.folder.join(folder))?;
        }
        let mut files = Vec::new();
        for entry in fs::read_dir(&self.folder)? {
            let path = entry?.path();
            if !is_wav(&path) {
                continue;
            }
            // One that has gone meanwhile is nobody's concern.
            let Ok(metadata) = fs::metadata(&path) else { continue };
            let key = key(&path, &metadata);
            if metadata.is_file() && !self.left.contains(&key) {
                files.push(((metadata.mtime(), metadata.mtime_nsec()), path, key));
            }
        }
        files.sort();
        Ok(files.into_iter().next().map(|(_, path, key)| (path, key)))
    }

    /// Gives a file to be heard until it is answered, and moves it away.
    fn hear(&mut self, path: &Path, key: RequestKey) {
        let Some(name) = path.to_str() else {
            return self.put_away(path, key, &[], "its name is not UTF-8");
        };
        let injection =
            Injection { key, onset_ns: 0, end_ns: 0, sound: Sound::Wav(name.to_owned()) };
        let mut answers: Vec<Receipt> = Vec::new();
        let mut given: Option<Instant> = None;
        while answers.first().is_none_or(|first| answers.len() < first.segments as usize) {
            if self.closed.load(Ordering::SeqCst) {
                return;
            }
            if given.is_none_or(|given| given.elapsed() >= AGAIN) {
                (self.give)(injection.clone());
                given = Some(Instant::now());
            }
            if let Ok(receipt) = self.received.recv_timeout(LOOK)
                && receipt.request() == key
                && answers.iter().all(|answer| answer.segment != receipt.segment)
            {
                answers.push(receipt);
            }
        }
        answers.sort_by_key(|answer| answer.segment);
        self.put_away(path, key, &answers, "");
    }

    fn put_away(&mut self, path: &Path, key: RequestKey, answers: &[Receipt], why: &str) {
        let is_heard = answers.iter().any(|answer| answer.status == ReceiptStatus::Accepted.code());
        let folder = self.folder.join(FOLDERS[usize::from(!is_heard)]);
        let told = json!({
            "file": path.file_name().map(|name| name.to_string_lossy().into_owned()),
            "why": (!why.is_empty()).then_some(why),
            "segments": answers.iter().map(as_json).collect::<Vec<Json>>(),
        });
        let target = free_name(&folder, path);
        let written = fs::write(target.with_extension("json"), format!("{told:#}\n"))
            .and_then(|()| fs::rename(path, &target));
        match written {
            Ok(()) => {
                tracing::info!(file = %target.display(), is_heard, "a watched file was heard")
            }
            Err(error) => {
                tracing::warn!(file = %path.display(), %error, "a watched file cannot be moved away");
                self.left.insert(key);
            }
        }
    }
}

fn is_wav(path: &Path) -> bool {
    let is_hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
    !is_hidden && path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("wav"))
}

/// The file's own name in `folder`, with a number where that is taken.
fn free_name(folder: &Path, path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let name =
        |n: u32| folder.join(if n < 2 { format!("{stem}.wav") } else { format!("{stem}-{n}.wav") });
    let is_free = |path: &PathBuf| !path.exists() && !path.with_extension("json").exists();
    (1..=u32::MAX).map(name).find(is_free).unwrap_or_else(|| name(1))
}

fn as_json(receipt: &Receipt) -> Json {
    json!({
        "status": ReceiptStatus::from_code(receipt.status).ok(),
        "utterance": receipt.utterance().map(|seq| seq.0),
        "note": receipt.note.as_str().ok(),
        "confidence": receipt.confidence,
        "snr_db": receipt.snr_db,
    })
}

/// A key that the same file has again, and no other.
fn key(path: &Path, metadata: &Metadata) -> RequestKey {
    let (size, seconds) = (metadata.len(), metadata.mtime());
    let what = [size, metadata.ino(), seconds as u64, metadata.mtime_nsec() as u64];
    let bytes = path.as_os_str().as_encoded_bytes().iter().copied();
    let bytes: Vec<u8> = bytes.chain(what.iter().flat_map(|n| n.to_le_bytes())).collect();
    // FNV-1a, 128 bits.
    let hash = bytes.iter().fold(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d_u128, |hash, byte| {
        (hash ^ u128::from(*byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b)
    });
    RequestKey(hash.to_le_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::FixedText;

    const PATIENCE: Duration = Duration::from_secs(20);

    fn receipt(key: RequestKey, segment: u32, segments: u32, status: ReceiptStatus) -> Receipt {
        let note = FixedText::truncated("the red one");
        let (key, status, seq) = (key.0, status.code(), u64::from(segment) + 1);
        Receipt { key, segment, segments, status, seq, note, ..Receipt::default() }
    }

    fn wait_for(path: &Path) {
        let start = Instant::now();
        while !path.exists() {
            assert!(start.elapsed() < PATIENCE, "{}", path.display());
            thread::sleep(Duration::from_millis(5));
        }
    }

    #[test]
    fn files_are_heard_one_after_the_other_and_put_away_with_what_was_heard() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for (name, age_s) in [("b.wav", 5), ("a.WAV", 1), ("c.wav", 9)] {
            let file = fs::File::create(at(name)).unwrap();
            file.set_modified(std::time::SystemTime::now() - Duration::from_secs(age_s)).unwrap();
        }
        for ignored in ["d.wav.part", ".e.wav", "notes.txt"] {
            fs::write(at(ignored), "").unwrap();
        }
        let (given, injections) = mpsc::channel();
        let give = Box::new(move |injection| drop(given.send(injection)));
        let watched = WatchedFolder::start(folder.path().to_owned(), give);
        for (name, status, target) in [
            ("c.wav", ReceiptStatus::Accepted, "heard/c.wav"),
            ("b.wav", ReceiptStatus::NotForMe, "refused/b.wav"),
            ("a.WAV", ReceiptStatus::Accepted, "heard/a.wav"),
        ] {
            let expected = Sound::Wav(at(name).display().to_string());
            let next = |sound: &Sound| loop {
                let injection: Injection = injections.recv_timeout(PATIENCE).unwrap();
                if injection.sound == *sound {
                    return injection.key;
                }
            };
            let key = next(&expected);
            assert_eq!(next(&expected), key, "given again until it is answered");
            watched.told(&receipt(RequestKey([0; 16]), 0, 1, status));
            watched.told(&receipt(key, 1, 2, status));
            watched.told(&receipt(key, 1, 2, status));
            assert!(at(name).exists(), "half of it is not all of it");
            watched.told(&receipt(key, 0, 2, status));
            wait_for(&at(target));
            let json = fs::read_to_string(at(target).with_extension("json")).unwrap();
            let json: Json = serde_json::from_str(&json).unwrap();
            assert_eq!(json["segments"].as_array().unwrap().len(), 2, "{json}");
            assert_eq!(json["segments"][0]["note"], "the red one");
        }
        drop(watched);
        assert!(at("d.wav.part").exists() && at(".e.wav").exists());
    }

    #[test]
    fn a_name_that_is_taken_gets_a_number() {
        let folder = tempfile::tempdir().unwrap();
        let path = Path::new("/x/a.wav");
        assert_eq!(free_name(folder.path(), path), folder.path().join("a.wav"));
        fs::write(folder.path().join("a.wav"), "").unwrap();
        fs::write(folder.path().join("a-2.json"), "").unwrap();
        assert_eq!(free_name(folder.path(), path), folder.path().join("a-3.wav"));
    }
}

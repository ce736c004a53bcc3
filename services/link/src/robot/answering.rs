//! Requests of mirrors, but for orders to the motion stop.

use std::path::{Path, PathBuf};

use messages::{AudioChunk, PresentationState, RequestKey, Sound, SoundFile};
use service::clock;
use zenoh::query::Query;

use super::Robot;
use super::senders::Senders;
use crate::line::{Line, Packed};
use crate::names::Call;
use crate::offset::time_ns;
use crate::presence::Hello;
use crate::say::{Receipts, Said, Sent};

impl Robot {
    pub(super) fn on_call(&mut self, call: Call, query: Query) {
        let payload = query.payload().map(|payload| payload.to_bytes().into_owned());
        let payload = payload.unwrap_or_default();
        let bytes = match call {
            Call::Presence => serde_json::to_vec(&self.presence).ok(),
            Call::Hello => {
                let version = build_info::full_version();
                let settings = self.settings.snapshot();
                postcard::to_stdvec(&Hello { version, epoch: self.epoch, settings }).ok()
            }
            Call::Line => self.asked_line(&payload),
            Call::Say => return self.on_said(query, &payload),
            Call::Motion => None,
        };
        if let Some((bytes, senders)) = bytes.zip(self.senders.as_ref()) {
            senders.answer(call, query, bytes);
        }
    }

    /// Sends the sound of a line that begins, once, to those who listen.
    pub(super) fn send_line(&mut self) {
        let said =
            self.sources.presented().filter(|it| it.state.get() == PresentationState::Speaking);
        let Some(file) = said.map(SoundFile::of).filter(|file| self.line_sent != Some(*file))
        else {
            return;
        };
        if self.senders.as_ref().is_some_and(Senders::is_line_watched) {
            let line = self.line(file);
            if let Some((line, senders)) = line.zip(self.senders.as_ref()) {
                senders.line(line);
            }
            self.line_sent = Some(file);
        }
    }

    /// One of the robot's lines, by its file. The latest is kept: every mirror may ask for it.
    fn line(&mut self, file: SoundFile) -> Option<Vec<u8>> {
        if let Some((known, bytes)) = &self.line
            && *known == file
        {
            return Some(bytes.clone());
        }
        let folder = self.settings.voice_dir(&self.paths.run())?;
        let sound = Packed::of(std::fs::read(folder.join(file.to_string())).ok()?);
        let bytes = Line { file: file.to_string(), sound }.encode()?;
        self.line = Some((file, bytes.clone()));
        Some(bytes)
    }

    fn asked_line(&mut self, name: &[u8]) -> Option<Vec<u8>> {
        self.line(SoundFile::parse(std::str::from_utf8(name).ok()?)?)
    }

    fn on_said(&mut self, query: Query, payload: &[u8]) {
        let Ok(said) = postcard::from_bytes::<Said>(payload) else {
            return tracing::warn!("unintelligible words ignored");
        };
        if let Some(receipts) = self.asked.answer(said.key) {
            let receipts = receipts.to_vec();
            return self.answer_words(vec![query], receipts);
        }
        if !self.asked.waits_for(said.key) && !self.asked.has_room() {
            return tracing::debug!("no room for words; they are asked again");
        }
        let Some(sound) = self.sound_of(&said) else {
            return tracing::warn!("words that name a file of this machine ignored");
        };
        if let Some((query, receipts)) = self.asked.take(&said, sound, query, clock::now()) {
            self.answer_words(vec![query], receipts);
        }
    }

    /// Returns the sound for speech; contents of a file are written to one first.
    fn sound_of(&self, said: &Said) -> Option<Sound> {
        match &said.sound {
            Sent::Sound(Sound::Wav(_)) => None,
            Sent::Sound(sound) => Some(sound.clone()),
            Sent::File(contents) => {
                let file = sound_file(&self.paths.run(), said.key);
                if !self.asked.waits_for(said.key) {
                    let written = safe_files::replace_private(&file, contents);
                    written
                        .inspect_err(|error| tracing::warn!(%error, "sound not written"))
                        .ok()?;
                }
                Some(Sound::Wav(file.display().to_string()))
            }
        }
    }

    /// Submits words, and answers those whose receipts have come.
    pub(super) fn submit(&mut self) {
        let now = clock::now();
        for key in self.asked.expire(now) {
            self.forget_sound(key);
        }
        for injection in self.asked.due(now) {
            if let Err(error) = self.injections.send(&injection) {
                tracing::warn!(%error, "words not submitted; tried again");
            }
        }
        let mut answered = Vec::new();
        let read = self.receipts.drain(|receipt| answered.extend(self.asked.on_receipt(receipt)));
        if let Err(error) = read {
            tracing::debug!(%error, "receipts not read; tried again");
        }
        for (queries, receipts) in answered {
            if let Some(first) = receipts.first() {
                self.forget_sound(first.request());
            }
            self.answer_words(queries, receipts);
        }
    }

    fn forget_sound(&self, key: RequestKey) {
        // The file exists only if one was sent.
        let _ = std::fs::remove_file(sound_file(&self.paths.run(), key));
    }

    fn answer_words(&self, queries: Vec<Query>, receipts: Vec<messages::Receipt>) {
        let Some(senders) = &self.senders else { return };
        let answer = Receipts { sent_ns: clock::now().ns(), receipts };
        let bytes = postcard::to_stdvec(&answer).unwrap_or_default();
        queries.into_iter().for_each(|query| senders.answer(Call::Say, query, bytes.clone()));
    }

    /// A chunk travels with the age of its first sample in place of the time.
    pub(super) fn on_audio(&self, bytes: &[u8]) {
        let Ok(mut chunk) = postcard::from_bytes::<AudioChunk>(bytes) else {
            return tracing::debug!("unintelligible sound ignored");
        };
        chunk.taken_ns = time_ns(Some(chunk.taken_ns), clock::now());
        if let Err(error) = self.audio.send(&chunk) {
            tracing::debug!(%error, "sound not passed on");
        }
    }
}

fn sound_file(run: &Path, RequestKey(key): RequestKey) -> PathBuf {
    let key: String = key.iter().map(|byte| format!("{byte:02x}")).collect();
    run.join(format!("link-{key}.wav"))
}

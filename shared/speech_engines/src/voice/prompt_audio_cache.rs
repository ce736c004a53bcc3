//! A folder with the audio of the latest prompts, for playback elsewhere.

use std::collections::VecDeque;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use messages::{SoundFile, sound_file};

/// Cached prompts; a typical dialogue has a tenth of it.
pub const CACHED_MAX: usize = 64;

/// The folder. Files of an earlier run count, and are removed first.
#[derive(Debug)]
pub(super) struct PromptAudioCache {
    folder: PathBuf,
    files: VecDeque<PathBuf>,
}

impl PromptAudioCache {
    /// Opens the folder, which is created if necessary.
    pub(super) fn open(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let mut found = Vec::new();
        for entry in fs::read_dir(folder)? {
            let entry = entry?;
            if entry.file_name().to_string_lossy().starts_with(sound_file::PREFIX) {
                found.push((entry.metadata()?.modified()?, entry.path()));
            }
        }
        found.sort();
        Ok(Self {
            folder: folder.to_owned(),
            files: found.into_iter().map(|(_, path)| path).collect(),
        })
    }

    /// Stores the audio of a prompt, atomically.
    pub(super) fn store(&mut self, name: SoundFile, sound: &Path) -> io::Result<()> {
        let file = self.folder.join(name.to_string());
        safe_files::replace_private(&file, fs::read(sound)?)?;
        self.files.retain(|known| *known != file);
        self.files.push_back(file);
        while self.files.len() > CACHED_MAX {
            if let Some(oldest) = self.files.pop_front() {
                // It may have been removed already.
                let _ = fs::remove_file(oldest);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
        let mut names: Vec<String> =
            entries.map(|name| name.to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn prompt_audio_cache_keeps_the_latest_over_restarts() {
        let folder = tempfile::tempdir().unwrap();
        let sound = folder.path().join("sound");
        fs::write(&sound, b"RIFF").unwrap();
        let to = folder.path().join("kept");
        let mut cache = PromptAudioCache::open(&to).unwrap();
        fs::write(to.join("mine.wav"), b"").unwrap();
        let name = |prompt| SoundFile { prompt, presentation: 1 };
        (0..CACHED_MAX as u64).for_each(|prompt| cache.store(name(prompt), &sound).unwrap());
        cache.store(name(0), &sound).unwrap();
        assert_eq!(names(&to).len(), CACHED_MAX + 1, "an equal name replaces the file");
        let mut cache = PromptAudioCache::open(&to).unwrap();
        cache.store(name(100), &sound).unwrap();
        cache.store(name(101), &sound).unwrap();
        let left = names(&to);
        assert_eq!(left.len(), CACHED_MAX + 1);
        assert!(PromptAudioCache::open(Path::new("/dev/null/cache")).is_err());
        let last = ["line-100-1.wav", "line-101-1.wav", "mine.wav"];
        assert!(last.iter().all(|name| left.iter().any(|l| l == name)), "{left:?}");
    }
}

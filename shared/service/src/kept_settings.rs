//! The settings in force, which a group's services read, and those by which the journals were
//! written, kept next to them: a journal can be listed and verified without the options of its
//! group's start, and a start need not repeat the same program's checks.

use std::fs::{self, File};
use std::io;
use std::os::unix::fs::MetadataExt;
use std::path::PathBuf;
use std::time::SystemTime;

use config::Settings;

use crate::group::GroupPaths;
use crate::wakes::Wakes;

/// Number of settings that are kept.
const KEPT: usize = 8;
/// The file next to kept settings that names the program that checked them.
const CHECKED_FILE: &str = "checked";

/// Writes everything that the services of a group read, and keeps the settings next to the
/// journals. Those in force change last, when nothing can fail any more.
///
/// # Errors
/// A folder cannot be written.
pub fn put_in_force(paths: &GroupPaths, settings: &Settings) -> io::Result<()> {
    keep(paths, settings)?;
    wakes(settings).save(paths)?;
    settings.write_words(&paths.run())?;
    settings.write_snapshot(&paths.run())
}

/// Sources that wake the services besides the table of topics.
fn wakes(settings: &Settings) -> Wakes {
    let services = settings.group.services.iter();
    Wakes::new(services.flat_map(|service| {
        service.reads.iter().map(|topic| (service.name.as_str(), topic.as_str()))
    }))
}

/// Keeps the settings, as the newest of a few.
///
/// # Errors
/// The folder cannot be written.
fn keep(paths: &GroupPaths, settings: &Settings) -> io::Result<()> {
    let folder = folder(paths, settings);
    fs::create_dir_all(&folder)?;
    if !folder.join(config::SNAPSHOT_FILE).is_file()
        && let Err(error) = settings.write_snapshot(&folder)
    {
        // Settings that were not kept leave no trace.
        let _ = fs::remove_dir_all(&folder);
        return Err(error);
    }
    File::open(&folder)?.set_modified(SystemTime::now())?;
    folders(paths).into_iter().skip(KEPT).try_for_each(fs::remove_dir_all)
}

/// The folder in which these settings are kept.
fn folder(paths: &GroupPaths, settings: &Settings) -> PathBuf {
    let mut hash = scene::StableHash::default();
    hash.text(&settings.snapshot());
    paths.kept_settings().join(format!("{:016x}", hash.value()))
}

/// Returns true if this very program has noted that these settings passed every check.
pub fn are_checked(paths: &GroupPaths, settings: &Settings) -> bool {
    let noted = fs::read_to_string(folder(paths, settings).join(CHECKED_FILE));
    noted.is_ok_and(|noted| own_program().is_some_and(|own| own == noted))
}

/// Notes that settings which are kept have passed every check of this program.
pub fn note_checked(paths: &GroupPaths, settings: &Settings) {
    let (Some(own), file) = (own_program(), folder(paths, settings).join(CHECKED_FILE)) else {
        return;
    };
    if fs::read_to_string(&file).is_ok_and(|noted| noted == own) {
        return;
    }
    if let Err(error) = safe_files::replace_private(&file, own) {
        tracing::debug!(%error, "settings not noted as checked; the next start checks them again");
    }
}

/// Identifies this program's file: another build may check differently. Its times of change, unlike
/// those of modification, are not set by who installs it.
fn own_program() -> Option<String> {
    let file = fs::metadata("/proc/self/exe").ok()?;
    let (device, inode, bytes) = (file.dev(), file.ino(), file.len());
    let (s, ns) = (file.ctime(), file.ctime_nsec());
    Some(format!("{} {device} {inode} {bytes} {s}.{ns:09}\n", build_info::VERSION))
}

/// Folders with the kept settings, newest first.
pub fn folders(paths: &GroupPaths) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(paths.kept_settings()) else { return Vec::new() };
    let dated = |path: PathBuf| Some((fs::metadata(&path).ok()?.modified().ok()?, path));
    let mut folders: Vec<_> = entries.filter_map(|entry| dated(entry.ok()?.path())).collect();
    folders.sort();
    folders.into_iter().rev().map(|(_, path)| path).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::time::Duration;

    use super::*;
    use crate::group::GroupName;

    #[test]
    fn newest_settings_are_kept_once() {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("lab").unwrap()).unwrap();
        let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
        let settings = |repeats: usize| {
            let set = ("dialogue.turns.repeats_max".to_owned(), repeats.to_string());
            Settings::load(&config, None, &[set]).unwrap()
        };
        for repeats in 0..KEPT + 2 {
            keep(&paths, &settings(repeats)).unwrap();
            // The order must not depend on the resolution of the file system's times.
            for folder in folders(&paths) {
                let file = File::open(&folder).unwrap();
                let age = file.metadata().unwrap().modified().unwrap() - Duration::from_secs(10);
                file.set_modified(age).unwrap();
            }
        }
        assert_eq!(folders(&paths).len(), KEPT);
        keep(&paths, &settings(5)).unwrap();
        assert_eq!(folders(&paths).len(), KEPT);
        let newest = Settings::load_snapshot(&folders(&paths)[0]).unwrap();
        assert_eq!(newest.dialogue.turns.repeats_max, 5);
    }

    #[test]
    fn settings_are_checked_once_noted_by_this_program() {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("lab").unwrap()).unwrap();
        let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
        let settings = |set: &[(String, String)]| Settings::load(&config, None, set).unwrap();
        let (ours, others) = (settings(&[]), settings(&[("arm.limb".into(), "left".into())]));
        note_checked(&paths, &ours);
        assert!(!are_checked(&paths, &ours), "they are not kept");
        keep(&paths, &ours).unwrap();
        note_checked(&paths, &ours);
        assert!(are_checked(&paths, &ours));
        keep(&paths, &others).unwrap();
        assert!(!are_checked(&paths, &others));
        let noted = folder(&paths, &ours).join(CHECKED_FILE);
        fs::write(&noted, "0.0.1 1 1 1 1.000000000\n").unwrap();
        assert!(!are_checked(&paths, &ours), "noted by another program");
    }
}

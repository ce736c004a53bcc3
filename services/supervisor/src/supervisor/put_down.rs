//! The services that an operator has put down. They stay down if the supervisor is killed, fails, is restarted by the
//! init system, or begins the group anew: a service that is held for a person's sake must not start because something
//! else failed. `whichone down` alone forgets them.

use std::collections::BTreeSet;
use std::path::Path;
use std::{fs, io};

use serde::{Deserialize, Serialize};

use crate::Time;
use crate::group::Group;
use crate::machine::Event;

/// Names of the services that an operator has put down.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct PutDown {
    held: BTreeSet<String>,
    stopped: BTreeSet<String>,
}

impl PutDown {
    /// Reads what an earlier supervisor of the group has left, if anything.
    ///
    /// # Errors
    /// The file is damaged or cannot be read: which services may start is not known.
    pub(super) fn read(path: &Path) -> io::Result<Self> {
        let named = |error: io::Error| {
            let help = "help: remove the file if no service is to be held";
            io::Error::new(error.kind(), format!("{}: {error}; {help}", path.display()))
        };
        match safe_files::read_regular(path) {
            Ok(text) => serde_json::from_str(&text).map_err(|error| named(error.into())),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Self::default()),
            Err(error) => Err(named(error)),
        }
    }

    /// Takes in an operator's order for a service. Returns whether that changes anything.
    pub(super) fn note(&mut self, service: &str, order: Event) -> bool {
        let before = self.clone();
        match order {
            Event::Hold => drop(self.held.insert(service.to_owned())),
            Event::Release => drop(self.held.remove(service)),
            Event::Stop => {
                self.held.remove(service);
                self.stopped.insert(service.to_owned());
            }
            Event::Start | Event::Restart => {
                self.held.remove(service);
                self.stopped.remove(service);
            }
            _ => {}
        }
        *self != before
    }

    /// Writes it for a successor. An order is carried out even if it cannot be written.
    pub(super) fn write(&self, path: &Path) {
        let text = serde_json::to_string(self).expect("names are text");
        if let Err(error) = safe_files::replace_private_synced(path, text) {
            tracing::error!(file = %path.display(), %error, "a killed supervisor's successor will not know it");
        }
    }

    /// Puts the services of a group down again, before it starts any.
    pub(super) fn apply(
        &self,
        group: &mut Group,
        position: impl Fn(&str) -> Option<usize>,
        now: Time,
    ) {
        for (names, order) in [(&self.stopped, Event::Stop), (&self.held, Event::Hold)] {
            for name in names {
                let Some(service) = position(name) else { continue };
                tracing::warn!(service = name, ?order, "put down by the operator before");
                let effect = group.on(service, order, now);
                debug_assert_eq!(effect, None, "nothing runs yet");
            }
        }
    }
}

/// Removes the file: the operator has ended the group.
pub(super) fn forget(path: &Path) {
    if let Err(error) = safe_files::absent_is_fine(fs::remove_file(path)) {
        tracing::warn!(file = %path.display(), %error, "not removed");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_kept_as_they_stand() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("put_down");
        assert_eq!(PutDown::read(&path).unwrap(), PutDown::default());
        let mut put_down = PutDown::default();
        assert!(put_down.note("arm", Event::Hold) && !put_down.note("arm", Event::Hold));
        assert!(put_down.note("ros1", Event::Stop) && put_down.note("ros1", Event::Hold));
        assert!(put_down.note("ros1", Event::Release), "it stays stopped");
        put_down.write(&path);
        assert_eq!(PutDown::read(&path).unwrap(), put_down);
        assert!(put_down.held.contains("arm") && put_down.stopped.contains("ros1"));
        assert!(put_down.note("ros1", Event::Start) && put_down.note("arm", Event::Restart));
        assert_eq!(put_down, PutDown::default());
        for damaged in ["", "{", "[]", r#"{"held":[1]}"#] {
            fs::write(&path, damaged).unwrap();
            let error = PutDown::read(&path).unwrap_err().to_string();
            assert!(error.contains("put_down") && error.contains("help: "), "{damaged}: {error}");
        }
        forget(&path);
        forget(&path);
        assert!(!path.exists());
    }
}

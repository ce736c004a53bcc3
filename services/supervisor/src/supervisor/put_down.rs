//! The services that an operator has put down. They stay down if the supervisor is killed, or begins the group anew:
//! what is held for a person's sake must not start because something else failed. An orderly end forgets them.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

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
    /// Reads what a killed supervisor has left, if it did.
    pub(super) fn read(path: &Path) -> Self {
        let text = match safe_files::read_regular(path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Self::default(),
            Err(error) => {
                tracing::error!(file = %path.display(), %error, "services that were held may start");
                return Self::default();
            }
        };
        serde_json::from_str(&text).unwrap_or_else(|error| {
            tracing::error!(file = %path.display(), %error, "services that were held may start");
            Self::default()
        })
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

/// Removes the file: the group has ended in order.
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
        assert_eq!(PutDown::read(&path), PutDown::default());
        let mut put_down = PutDown::default();
        assert!(put_down.note("arm", Event::Hold) && !put_down.note("arm", Event::Hold));
        assert!(put_down.note("ros1", Event::Stop) && put_down.note("ros1", Event::Hold));
        assert!(put_down.note("ros1", Event::Release), "it stays stopped");
        put_down.write(&path);
        assert_eq!(PutDown::read(&path), put_down);
        assert!(put_down.held.contains("arm") && put_down.stopped.contains("ros1"));
        assert!(put_down.note("ros1", Event::Start) && put_down.note("arm", Event::Restart));
        assert_eq!(put_down, PutDown::default());
        for damaged in ["", "{", "[]", r#"{"held":[1]}"#] {
            fs::write(&path, damaged).unwrap();
            assert_eq!(PutDown::read(&path), PutDown::default(), "{damaged}");
        }
        forget(&path);
        forget(&path);
        assert!(!path.exists());
    }
}

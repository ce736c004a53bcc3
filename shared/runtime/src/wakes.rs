//! Services woken by a topic beyond its own table: the configuration of the group names them
//! (`reads` of `[services.NAME]`), and the supervisor lists them for every process, one line each.

use std::fs;
use std::io;

use messages::Service;
use messages::topics::Topic;

use crate::group::GroupPaths;

/// Services woken by topics, beyond [`Topic::readers`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wakes(Vec<(String, Service)>);

impl Wakes {
    /// The topics that each service reads.
    pub fn new<'a>(reads: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        let pairs = reads.into_iter();
        Self(pairs.map(|(service, topic)| (topic.to_owned(), Service::named(service))).collect())
    }

    /// Reads the supervisor's file; empty without a supervisor, in tests of topics.
    pub fn load(paths: &GroupPaths) -> Self {
        let text = fs::read_to_string(paths.wakes_file()).unwrap_or_default();
        Self::new(text.lines().filter_map(|line| line.split_once(' ')))
    }

    /// Writes it for the processes of the group.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn save(&self, paths: &GroupPaths) -> io::Result<()> {
        let lines = self.0.iter().map(|(topic, service)| format!("{} {topic}\n", service.name()));
        // Complete as soon as it is there.
        safe_files::replace_private(&paths.wakes_file(), lines.collect::<String>())
    }

    /// Returns the services that are woken by the topic.
    pub fn readers<'a>(&'a self, topic: &'a Topic) -> impl Iterator<Item = Service> + 'a {
        let is_new = |service: &Service| !topic.readers.contains(service);
        let of_topic = self.0.iter().filter(move |(name, _)| name == topic.name);
        of_topic.map(|(_, service)| *service).filter(is_new)
    }

    /// Returns every service that it names, each once.
    pub fn services(&self) -> Vec<Service> {
        let mut services: Vec<Service> = Vec::new();
        for (_, service) in &self.0 {
            if !services.contains(service) {
                services.push(*service);
            }
        }
        services
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;
    use crate::group::GroupName;
    use messages::topics::{ACT, UTTERANCE, VIEW};

    #[test]
    fn services_of_users_are_woken_by_the_topics_that_they_read() {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("lab").unwrap()).unwrap();
        fs::create_dir_all(paths.run()).unwrap();
        assert_eq!(Wakes::load(&paths), Wakes::default());
        let reads = [("label", "policy/act"), ("label", "policy/view"), ("arm", "policy/act")];
        let wakes = Wakes::new(reads);
        wakes.save(&paths).unwrap();
        let wakes = Wakes::load(&paths);
        let label = Service::Other("label");
        assert_eq!(wakes.readers(&ACT).collect::<Vec<_>>(), [label], "the arm is woken anyway");
        assert_eq!(wakes.readers(&VIEW).collect::<Vec<_>>(), [label]);
        assert_eq!(wakes.readers(&UTTERANCE).count(), 0);
        assert_eq!(wakes.services(), [label, Service::Arm]);
    }
}

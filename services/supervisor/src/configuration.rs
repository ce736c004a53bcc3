//! The supervisor's configuration.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use crate::spec::GroupSpec;

pub use from_settings::from_settings;

mod from_settings;

/// Loads the configuration: at the start and on reload. On failure,
/// every problem, one line each.
pub type Load = Box<dyn FnMut() -> Result<Configuration, Vec<String>>>;

/// Writes the settings for the services into the group's run folder.
pub type Publish = Box<dyn Fn(&Path) -> io::Result<()>>;

/// A valid configuration.
pub struct Configuration {
    /// The services and their restart policy.
    pub spec: GroupSpec,
    /// The scene's name.
    pub scene: String,
    /// The profile in force.
    pub profile: Option<String>,
    /// The folder that it was read from.
    pub directory: PathBuf,
    /// Shared memory that must be free for the group to start, MiB.
    pub shared_memory_free_min_mib: u64,
    /// Publishes it to the services.
    pub publish: Publish,
}

impl fmt::Debug for Configuration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Configuration")
            .field("spec", &self.spec)
            .field("scene", &self.scene)
            .field("profile", &self.profile)
            .field("directory", &self.directory)
            .finish_non_exhaustive()
    }
}

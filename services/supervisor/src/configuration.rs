//! The supervisor's configuration: the group, its services in order, and their limits.

use std::env;
use std::io;
use std::path::PathBuf;
use std::time::Duration;

use config::{ServiceConfig, Settings};
use service::group::GroupPaths;
use service::kept_settings;
use service::launch::Options;

pub use config::{Log, Restart, RestartLimits};

/// Loads the configuration: at the start and on reload; with the scene that an operator has chosen since, if
/// any. On failure, every problem, one line each.
pub type Load = Box<dyn FnMut(Option<&str>) -> Result<Configuration, Vec<String>>>;

/// Writes the settings for the services into the group's run folder, and keeps them beside the journals.
pub type Publish = Box<dyn Fn(&GroupPaths) -> io::Result<()>>;

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
    /// Overrides of its values.
    pub set: Vec<(String, String)>,
    /// Shared memory that must be free for the group to start, MiB.
    pub shared_memory_free_min_mib: u64,
    /// Publishes it to the services.
    pub publish: Publish,
}

/// A group as configured, checked: names are unique, `after` names exist and form no cycle
/// (see [`Schedule::new`](crate::schedule::Schedule::new)).
#[derive(Clone, Debug, PartialEq)]
pub struct GroupSpec {
    /// Services in the order of the configuration.
    pub services: Vec<ServiceSpec>,
    /// Limits and backoff of restarts.
    pub restart: RestartLimits,
    /// Logs of the services.
    pub log: Log,
}

/// One service as configured.
#[derive(Clone, Debug, PartialEq)]
pub struct ServiceSpec {
    /// Unique name, e.g. `grounding`.
    pub name: String,
    /// Program and arguments. A program without a slash is looked for in `PATH`.
    pub command: Vec<String>,
    /// True if the program is the one that is shipped.
    pub is_shipped: bool,
    /// Services that must be ready before this one is started for the first time.
    pub after: Vec<String>,
    /// True if the whole group stops in order when this service is given up.
    pub critical: bool,
    /// True if the group is whole without this service.
    pub observer: bool,
    /// Time from start to `READY=1`.
    pub start_deadline: Duration,
    /// Maximum time between two heartbeats once ready; `None` disables the watchdog.
    pub watchdog: Option<Duration>,
    /// Time from the request to stop to the kill.
    pub stop_deadline: Duration,
    /// Scheduling niceness, −20 … 19.
    pub nice: i32,
    /// Exits that are followed by a restart.
    pub restart: Restart,
    /// Everything of the configuration that this service reads, in a form that differs exactly
    /// when it has to be restarted to take notice.
    pub fingerprint: String,
}

/// Reads the configuration folder that `options` name.
pub fn from_settings(options: Options) -> Load {
    Box::new(move |scene| {
        let set = with_scene(&options.set, scene);
        let paths = GroupPaths::resolve(&options.group);
        let is_known = |settings: &Settings| {
            paths.as_ref().is_ok_and(|paths| kept_settings::are_checked(paths, settings))
        };
        match preflight::load_known(&options.config, options.profile.as_deref(), &set, is_known) {
            Ok(settings) => {
                settings.warnings().iter().for_each(|warning| tracing::warn!("{warning}"));
                Ok(configuration(settings, &options, set))
            }
            Err(problems) => Err(problems.iter().map(ToString::to_string).collect()),
        }
    })
}

/// The overrides with another scene.
fn with_scene(set: &[(String, String)], scene: Option<&str>) -> Vec<(String, String)> {
    const KEY: &str = "group.scene";
    let Some(scene) = scene else { return set.to_vec() };
    let others = set.iter().filter(|(key, _)| key != KEY).cloned();
    // A quoted text, so that a scene called `7` is not a number.
    others.chain([(KEY.to_owned(), format!("{scene:?}"))]).collect()
}

fn configuration(
    settings: Settings,
    options: &Options,
    set: Vec<(String, String)>,
) -> Configuration {
    let group = &settings.group;
    Configuration {
        spec: GroupSpec {
            services: group.services.iter().map(|one| service(one, &settings)).collect(),
            restart: group.restart,
            log: group.log.clone(),
        },
        scene: group.scene.clone(),
        profile: options.profile.clone(),
        directory: options.config.clone(),
        set,
        shared_memory_free_min_mib: group.shared_memory_free_min_mib.into(),
        publish: Box::new(move |paths| {
            kept_settings::put_in_force(paths, &settings)?;
            kept_settings::note_checked(paths, &settings);
            Ok(())
        }),
    }
}

fn service(service: &ServiceConfig, settings: &Settings) -> ServiceSpec {
    ServiceSpec {
        name: service.name.clone(),
        command: service.command.clone().unwrap_or_else(|| vec![beside(&service.name)]),
        is_shipped: service.command.is_none(),
        after: service.after.clone(),
        critical: service.critical,
        observer: service.observer,
        start_deadline: service.start_deadline,
        watchdog: service.watchdog,
        stop_deadline: service.stop_deadline,
        nice: service.nice,
        restart: service.restart,
        fingerprint: settings.read_by(&service.name),
    }
}

/// A built-in service's program lies beside the supervisor's own.
fn beside(name: &str) -> String {
    let program = format!("whichone-{name}");
    let own = env::current_exe().ok();
    let path = own.and_then(|own| Some(own.parent()?.join(&program).display().to_string()));
    path.unwrap_or(program)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chosen_scene_replaces_that_of_the_command_line() {
        let set = |pairs: &[(&str, &str)]| -> Vec<(String, String)> {
            pairs.iter().map(|(key, value)| ((*key).into(), (*value).into())).collect()
        };
        let given = set(&[("group.scene", "bowls"), ("arm.limb", "left")]);
        assert_eq!(with_scene(&given, None), given);
        let expected = set(&[("arm.limb", "left"), ("group.scene", "\"7\"")]);
        assert_eq!(with_scene(&given, Some("7")), expected);
    }
}

//! From the settings of the project to what the supervisor needs of them.

use std::env;

use config::{Section, ServiceConfig, Settings};
use messages::Service;

use super::{Configuration, Load};
use crate::spec::{GroupSpec, ServiceSpec};
use service::launch::Options;

/// Reads the configuration folder that `options` name.
pub fn from_settings(options: Options) -> Load {
    Box::new(move || {
        let loaded = preflight::load(&options.config, options.profile.as_deref(), &options.set);
        match loaded {
            Ok(settings) => Ok(configuration(settings, &options)),
            Err(problems) => Err(problems.iter().map(ToString::to_string).collect()),
        }
    })
}

fn configuration(settings: Settings, options: &Options) -> Configuration {
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
        shared_memory_free_min_mib: group.shared_memory_free_min_mib.into(),
        publish: Box::new(move |run| settings.write_snapshot(run)),
    }
}

fn service(service: &ServiceConfig, settings: &Settings) -> ServiceSpec {
    ServiceSpec {
        name: service.name.clone(),
        command: service.command.clone().unwrap_or_else(|| vec![beside(&service.name)]),
        after: service.after.clone(),
        critical: service.critical,
        start_deadline: service.start_deadline,
        watchdog: service.watchdog,
        stop_deadline: service.stop_deadline,
        nice: service.nice,
        restart: service.restart,
        fingerprint: fingerprint(&service.name, settings),
    }
}

/// A built-in service's program lies beside the supervisor's own.
fn beside(name: &str) -> String {
    let program = format!("whichone-{name}");
    let own = env::current_exe().ok();
    let path = own.and_then(|own| Some(own.parent()?.join(&program).display().to_string()));
    path.unwrap_or(program)
}

/// Returns the text of everything that a service reads: its own section, and the scene, which all read.
/// Speech rejects utterances that the dialogue would not understand, so it reads that section too. A
/// service that is not built in may read all of them. Decisions depend on the robot's durations.
fn fingerprint(name: &str, settings: &Settings) -> String {
    let (sections, decides): (&[Section], bool) = match Service::from_name(name) {
        Some(Service::Speech) => (&[Section::Speech, Section::Dialogue], false),
        Some(Service::Grounding) => (&[Section::Dialogue], false),
        Some(Service::Policy) => (&[Section::Dialogue], true),
        Some(Service::Arm) => (&[Section::Arm], false),
        Some(Service::Console) => (&Section::ALL[1..], false),
        Some(Service::Robot) | None => (&[Section::Speech, Section::Dialogue, Section::Arm], true),
    };
    let texts = sections.iter().map(|&section| settings.section_text(section));
    let durations = decides.then(|| settings.durations_text());
    texts.chain([settings.scene_file().text.clone()]).chain(durations).collect()
}

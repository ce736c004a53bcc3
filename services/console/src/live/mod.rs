//! Live view for Foxglove and Lichtblick: the channels of recordings over the protocol
//! `foxglove.sdk.v1`, at `/foxglove`.
//!
//! Its messages are those of `recording::live`. The [`feed`] belongs to the main loop: it reads
//! every topic while there are viewers, and opens none otherwise. The [`socket`] of each viewer
//! takes its messages from [`viewers`]. A viewer is a viewer of the hub like a page, so that the
//! same limits and the same lease of control hold for it.

pub mod feed;
pub mod say;
mod socket;
mod viewers;

use std::collections::BTreeMap;

use config::Settings;
use diagnostics::Diagnostics;
use recording::channels::{Channel, ChannelId, group_topics, shown};
use recording::live as protocol;
use recording::settings::Recorder;

pub use socket::serve;
use viewers::Viewers;

/// Descriptors that reading every topic takes: at most this many for each.
pub fn descriptors() -> usize {
    const OF_A_TOPIC: usize = 6;
    OF_A_TOPIC * group_topics().count()
}

/// Everything that the live view serves, shared by main loop and sockets.
#[derive(Debug)]
pub struct Live {
    pub viewers: Viewers,
    /// Whether enough descriptors are free for the live view.
    pub is_possible: bool,
    /// Other origins whose pages may connect.
    origins: Vec<String>,
    /// The messages that every viewer gets at first: the server, its channels, its services.
    greeting: [String; 3],
    /// Name and value of each parameter.
    parameters: Vec<(&'static str, String)>,
}

impl Live {
    /// Makes the live view of a group. The session identifies this start of the console.
    ///
    /// # Errors
    /// The snapshot does not fit this version.
    pub fn new(
        settings: &Settings,
        group: &str,
        session: &str,
        is_possible: bool,
    ) -> Result<Self, Diagnostics> {
        let Recorder { sound, .. } = settings.part()?;
        let version = build_info::full_version();
        let channels: Vec<(ChannelId, Channel)> = shown(sound).collect();
        let metadata = BTreeMap::from([("group", group.to_owned()), ("version", version.clone())]);
        let name = format!("whichone {group}");
        let states = channels.iter().map(|(id, channel)| (*id, channel.is_state));
        Ok(Self {
            viewers: Viewers::new(states),
            is_possible,
            origins: settings.console.foxglove_origins.clone(),
            greeting: [
                protocol::server_info(&name, session, &metadata),
                protocol::advertise(channels.iter().map(|(id, channel)| (*id, channel))),
                protocol::advertise_services(&[say::service()]),
            ],
            parameters: vec![
                ("/robot_description", settings.robot_files().urdf.text.clone()),
                ("/group", group.to_owned()),
                ("/scene", settings.scene.name().to_owned()),
                ("/version", version),
            ],
        })
    }

    /// Returns whether pages of another origin may connect.
    pub fn admits(&self, origin: &str) -> bool {
        self.origins.iter().any(|known| known.eq_ignore_ascii_case(origin))
    }

    /// Returns the values of the named parameters, of all if none is named, in answer to the
    /// request `id`. Names that do not exist are left out.
    fn parameters(&self, names: &[String], id: Option<&str>) -> String {
        let is_named = |name: &str| names.is_empty() || names.iter().any(|it| it == name);
        let named = self.parameters.iter().filter(|(name, _)| is_named(name));
        protocol::parameter_values(named.map(|(name, value)| (*name, value.as_str())), id)
    }
}

//! The robots of a gateway: groups of this machine, and those that a router connects, each of which
//! is mirrored while its page is in use. Both are groups with a console.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use roster::{Name, Presence};
use serde::Serialize;
use serde_json::Value;
use service::console_link;
use service::exit::{Exit, Failure};
use service::group::{GroupName, GroupPaths};

use crate::feed::Feed;
use crate::mirrors::{Mirrors, Used};
use crate::people::{People, Right};
use crate::proxy;

/// Folder of the mirrors in the gateway's folder.
const MIRRORS: &str = "mirrors";

/// A robot's console.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Console {
    /// Host and port.
    pub(crate) place: String,
    /// The token that lets one in.
    pub(crate) token: String,
}

/// Why a robot's console cannot be reached.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Unreached {
    /// The gateway does not know the robot.
    #[error("robot {0} is not connected")]
    Unknown(Name),
    /// The robot's mirror is about to run.
    #[error("robot {0} is being connected")]
    Starting(Name),
    /// Anything else, with help.
    #[error("{0}")]
    Failed(String),
}

/// A robot in the list.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Listed {
    /// Name of the robot.
    pub(crate) robot: Name,
    /// Right of the person on the robot.
    pub(crate) right: Right,
    /// Whether it is connected: `false` for one that only the rights name.
    pub(crate) connected: bool,
    /// Report of the robot; `None` while it is silent.
    pub(crate) presence: Option<Presence>,
}

/// All robots of the gateway.
#[derive(Debug)]
pub(crate) struct Robots {
    groups: BTreeMap<Name, GroupPaths>,
    remote: Option<(Feed, Mirrors)>,
}

impl Robots {
    /// Robots that are groups of this machine, and those of the router that `keys` are for.
    ///
    /// # Errors
    /// A group has no place, or the link's program cannot be started.
    pub(crate) fn new(
        groups: &[GroupName],
        keys: Option<&Path>,
        folder: &Path,
    ) -> Result<Self, Failure> {
        let place = |group: &GroupName| {
            let name = Name::new(group.as_str())
                .map_err(|error| Failure::new(Exit::Usage, error.to_string()))?;
            Ok((name, GroupPaths::resolve(group)?))
        };
        let groups = groups.iter().map(place).collect::<Result<_, Failure>>()?;
        let remote = keys.map(|keys| {
            let home = folder.join(MIRRORS);
            Ok::<_, Failure>((Feed::start(keys)?, Mirrors::new(keys, home)?))
        });
        Ok(Self { groups, remote: remote.transpose()? })
    }

    /// Returns the robot's console, whose mirror is started if needed.
    ///
    /// # Errors
    /// It cannot be reached yet, or at all.
    pub(crate) async fn reach(&self, robot: &Name) -> Result<Console, Unreached> {
        if let Some(paths) = self.groups.get(robot) {
            return console(paths).ok_or_else(|| {
                Unreached::Failed(format!(
                    "group {robot} serves no page for those with its token; help: see `whichone status`, and leave \
                     console.access at \"token\""
                ))
            });
        }
        match &self.remote {
            Some((feed, mirrors)) if feed.has(robot) || mirrors.runs(robot) => {
                mirrors.reach(robot).await
            }
            _ => Err(Unreached::Unknown(robot.clone())),
        }
    }

    /// Notes that a page of the robot is open until the result is dropped.
    pub(crate) fn used(&self, robot: &Name) -> Option<Used> {
        self.remote.as_ref().map(|(_, mirrors)| mirrors.used(robot))
    }

    /// Ends mirrors that have been unused for a while.
    pub(crate) async fn tidy(&self) {
        if let Some((_, mirrors)) = &self.remote {
            mirrors.end_idle().await;
        }
    }

    /// Ends every mirror.
    pub(crate) fn end(&self) {
        if let Some((_, mirrors)) = &self.remote {
            mirrors.end();
        }
    }

    /// Lists the robots that a person may see.
    pub(crate) async fn list(&self, people: &People, person: &Name) -> Vec<Listed> {
        let remote = self.remote.as_ref().map(|(feed, _)| feed.all()).unwrap_or_default();
        let named = people.iter().filter(|(name, _)| *name == person).flat_map(|(_, person)| {
            let robots = person.operator.iter().chain(&person.viewer);
            robots.filter_map(|robot| Name::new(robot).ok())
        });
        let names: BTreeSet<Name> =
            self.groups.keys().chain(remote.keys()).cloned().chain(named).collect();
        let mut listed = Vec::new();
        for robot in names {
            let Some(right) = people.right(person, &robot) else { continue };
            let known = remote.get(&robot);
            let connected = known.is_some() || self.groups.contains_key(&robot);
            let presence = known.cloned().flatten();
            listed.push(Listed { robot, right, connected, presence });
        }
        let looks = listed.iter_mut().filter_map(|listed| {
            let console = console(self.groups.get(&listed.robot)?)?;
            Some(async move { listed.presence = look(&listed.robot, &console).await })
        });
        futures_util::future::join_all(looks).await;
        listed
    }
}

/// Returns a group's console, while one is served for those with a token.
pub(crate) fn console(paths: &GroupPaths) -> Option<Console> {
    let address = console_link::address(paths)?;
    let place = address.strip_prefix("http://")?.trim_end_matches('/').to_owned();
    Some(Console { place, token: console_link::token(paths)? })
}

/// Asks a console of this machine for its robot's activity.
async fn look(robot: &Name, console: &Console) -> Option<Presence> {
    let state: Value = serde_json::from_slice(&proxy::get(console, "/api/state").await?).ok()?;
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let (group, dialogue, arm) = (&state["group"], &state["dialogue"], &state["arm"]);
    let is_open = dialogue["interaction"].as_u64().is_some_and(|interaction| interaction > 0);
    let belief = dialogue["belief"].as_object().filter(|_| is_open);
    let shares = belief
        .into_iter()
        .flatten()
        .filter_map(|(name, share)| share.as_f64().map(|share| (name.clone(), share)));
    let phase = text(&arm["phase"]);
    let is_at_rest = ["", "idle", "done"].contains(&phase.as_str());
    Some(Presence {
        robot: robot.to_string(),
        version: text(&group["version"]),
        state: text(&group["state"]),
        scene: text(&state["scene"]["name"]),
        dialogue: if is_open { text(&dialogue["decision"]) } else { "idle".to_owned() },
        line: text(&dialogue["text"]),
        likeliest: shares.max_by(|(_, one), (_, other)| one.total_cmp(other)),
        arm: if is_at_rest { "rest".to_owned() } else { phase },
        stopped: arm["stopped"] == true,
    })
}

/// The home of mirrors must leave room for the names of sockets.
pub(crate) fn home_of_mirrors(home: PathBuf) -> Result<PathBuf, Failure> {
    let longest = GroupName::new(&"x".repeat(32))?;
    GroupPaths::in_home(&home, &longest)?;
    Ok(home)
}

//! Registry of the connected robots.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::mpsc;
use std::time::{Duration, Instant};

use roster::{Name, Presence};
use serde::Serialize;
use service::exit::{Exit, Failure};
use zenoh::Wait;

use crate::identity::Identity;
use crate::names::{Call, Keys, robot_of};
use crate::session::{connect, request};

/// Time for robots to answer.
const PATIENCE: Duration = Duration::from_secs(2);

/// A robot in the list.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Listed {
    /// Name of the robot.
    pub robot: Name,
    /// Its presence; `None` if it is connected and does not answer.
    pub presence: Option<Presence>,
}

/// Lists every robot that is connected and that these keys are for, by name.
///
/// # Errors
/// The router cannot be reached, or refuses the keys.
pub fn list(keys: &Path) -> Result<Vec<Listed>, Failure> {
    let identity = Identity::load(keys)?;
    identity.require(false, keys)?;
    let session = connect(&identity, keys)?;
    let allowed = match identity.robots.is_empty() {
        true => vec![Keys::of_all()],
        false => identity.robots.iter().map(Keys::of).collect(),
    };
    let mut robots: BTreeMap<Name, Option<Presence>> = BTreeMap::new();
    for keys in &allowed {
        let tokens = session.liveliness().get(keys.alive("*")).timeout(PATIENCE).wait();
        let tokens = tokens
            .map_err(|error| Failure::new(Exit::NotReached, format!("list of robots: {error}")))?;
        while let Ok(reply) = tokens.recv() {
            let key = reply.result().ok().map(|sample| sample.key_expr().as_str().to_owned());
            if let Some(robot) = key.as_deref().and_then(robot_of) {
                robots.insert(robot, None);
            }
        }
    }
    let (sender, presences) = mpsc::channel();
    for robot in robots.keys() {
        let sender = sender.clone();
        // The list is complete when it has no listener any more.
        let take = move |bytes: Vec<u8>| drop(sender.send(bytes));
        // Each by its own key: the router lets no request for all robots through to one.
        request(&session, &Keys::of(robot), Call::Presence, Vec::new(), PATIENCE, take);
    }
    drop(sender);
    let until = Instant::now() + PATIENCE;
    while robots.values().any(Option::is_none)
        && let Ok(bytes) = presences.recv_timeout(until.saturating_duration_since(Instant::now()))
    {
        let Ok(presence) = serde_json::from_slice::<Presence>(&bytes) else { continue };
        if let Some(known) = Name::new(&presence.robot).ok().and_then(|name| robots.get_mut(&name))
        {
            *known = Some(presence);
        }
    }
    Ok(robots.into_iter().map(|(robot, presence)| Listed { robot, presence }).collect())
}

/// The list for people.
pub fn table(robots: &[Listed]) -> String {
    if robots.is_empty() {
        return "no robots are connected\n".to_owned();
    }
    let mut rows =
        vec![["ROBOT", "STATE", "VERSION", "SCENE", "DIALOGUE", "ARM", "LINE"].map(str::to_owned)];
    for Listed { robot, presence } in robots {
        let Some(presence) = presence else {
            let mut row: [String; 7] = Default::default();
            (row[0], row[1]) = (robot.to_string(), "silent".to_owned());
            rows.push(row);
            continue;
        };
        let Presence { version, state, scene, dialogue, line, likeliest, arm, stopped, .. } =
            presence;
        let likeliest =
            likeliest.as_ref().map(|(name, share)| format!(" {name} {:.0} %", share * 1e2));
        let arm = if *stopped { "stopped" } else { arm };
        let state = if state.is_empty() { "unknown" } else { state };
        let dialogue = format!("{dialogue}{}", likeliest.unwrap_or_default());
        let line = service::printable::one_line(line).into_owned();
        rows.push([
            robot.to_string(),
            state.to_owned(),
            version.clone(),
            scene.clone(),
            dialogue,
            arm.to_owned(),
            line,
        ]);
    }
    let width =
        |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; 7] = std::array::from_fn(width);
    let line = |row: &[String; 7]| {
        let cells = row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}"));
        format!("{}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

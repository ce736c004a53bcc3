//! The people of a gateway and their rights: an administrator's file, read again when changed.

use std::collections::BTreeMap;
use std::path::Path;

use roster::Name;
use safe_files::{read_private, replace_private_synced};
use serde::{Deserialize, Serialize};
use service::console_link::{is_token, random_secret};
use service::exit::{Exit, Failure};
use web_server::followed::Followed;
use web_server::sessions::{HASH, hash};

/// The file in the gateway's folder.
pub const FILE: &str = "people.toml";
/// Stands for every robot.
pub const EVERY_ROBOT: &str = "*";
/// Head of the file.
const HEAD: &str = "# People of the gateway (docs/fleet.md): `whichone gateway add` and `remove` write this file. \
                    A secret is stored as its hash.\n\n";

/// Right of a person on a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Right {
    /// May see the robot.
    Viewer,
    /// See it, talk to it, stop it and release the stop.
    Operator,
}

impl Right {
    /// Returns the right's name.
    pub fn word(self) -> &'static str {
        match self {
            Self::Viewer => "viewer",
            Self::Operator => "operator",
        }
    }
}

/// A person as in the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Person {
    /// Hash of the secret with which the person logs in.
    pub secret: String,
    /// Robots that the person may command; [`EVERY_ROBOT`] for all.
    #[serde(default)]
    pub operator: Vec<String>,
    /// Robots that the person may see; [`EVERY_ROBOT`] for all.
    #[serde(default)]
    pub viewer: Vec<String>,
}

/// Everyone who may log in.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct People(BTreeMap<Name, Person>);

impl People {
    /// Reads the file; a missing one has no people.
    ///
    /// # Errors
    /// Others could read or change the file, or it is not one of people.
    pub fn load(path: &Path) -> Result<Self, Failure> {
        if !path.exists() {
            return Ok(Self::default());
        }
        let bad = |what: String| Failure::new(Exit::Config, format!("{}: {what}", path.display()));
        let text = read_private(path).map_err(|error| bad(error.to_string()))?;
        let people: Self = toml::from_str(&text).map_err(|error| bad(error.to_string()))?;
        people.check().map_err(bad)?;
        Ok(people)
    }

    fn check(&self) -> Result<(), String> {
        for (name, Person { secret, operator, viewer }) in &self.0 {
            let digits = secret.strip_prefix(HASH).unwrap_or_default();
            if digits.len() != 64 || !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
                let help = "help: let `whichone gateway add` write it";
                return Err(format!("{name}.secret: expected {HASH} and 64 digits; {help}"));
            }
            for (key, robots) in [("operator", operator), ("viewer", viewer)] {
                let is_robot = |robot: &&String| *robot == EVERY_ROBOT || Name::new(robot).is_ok();
                if let Some(bad) = robots.iter().find(|robot| !is_robot(robot)) {
                    let help = format!("help: use names of robots, or {EVERY_ROBOT:?} for all");
                    return Err(format!("{name}.{key}: expected robots, found {bad:?}; {help}"));
                }
            }
        }
        Ok(())
    }

    fn save(&self, path: &Path) -> Result<(), Failure> {
        let text = toml::to_string(self)
            .map_err(|error| Failure::new(Exit::Invariant, error.to_string()))?;
        replace_private_synced(path, format!("{HEAD}{text}"))
            .map_err(|error| Failure::file(path, &error))
    }

    /// Everyone, by name.
    pub fn iter(&self) -> impl Iterator<Item = (&Name, &Person)> {
        self.0.iter()
    }

    /// Returns a person's right on a robot; `None` for no access.
    pub fn right(&self, person: &Name, robot: &Name) -> Option<Right> {
        let Person { operator, viewer, .. } = self.0.get(person)?;
        let names = |robots: &[String]| {
            robots.iter().any(|known| known == EVERY_ROBOT || known == robot.as_str())
        };
        match (names(operator), names(viewer)) {
            (true, _) => Some(Right::Operator),
            (false, true) => Some(Right::Viewer),
            (false, false) => None,
        }
    }

    /// Returns the person with the given secret.
    pub fn with_secret(&self, secret: &str) -> Option<&Name> {
        let wanted = Some(secret).filter(|secret| is_token(secret)).map(hash)?;
        self.0.iter().find(|(_, person)| person.secret == wanted).map(|(name, _)| name)
    }

    /// Returns whether this is still the stored hash of the person's secret.
    pub fn has_secret(&self, person: &Name, hash: &str) -> bool {
        self.0.get(person).is_some_and(|person| person.secret == hash)
    }
}

/// Adds a person, or changes the rights of one; returns a new or renewed secret.
///
/// # Errors
/// A robot's name is invalid, or the file cannot be read or written.
pub fn add(
    path: &Path,
    name: &Name,
    operator: &[String],
    viewer: &[String],
    renew: bool,
) -> Result<Option<String>, Failure> {
    let mut people = People::load(path)?;
    let known = people.0.get(name).map(|person| person.secret.clone());
    let fresh =
        match known {
            Some(_) if !renew => None,
            _ => Some(random_secret().map_err(|error| {
                Failure::new(Exit::NotReached, format!("random numbers: {error}"))
            })?),
        };
    let secret = fresh.as_deref().map(hash).or(known).unwrap_or_default();
    let (operator, viewer) = (operator.to_vec(), viewer.to_vec());
    people.0.insert(name.clone(), Person { secret, operator, viewer });
    people.check().map_err(|what| Failure::new(Exit::Usage, what))?;
    people.save(path)?;
    Ok(fresh)
}

/// Removes a person: sessions end at once.
///
/// # Errors
/// The person is unknown, or the file cannot be read or written.
pub fn remove(path: &Path, name: &Name) -> Result<(), Failure> {
    let mut people = People::load(path)?;
    if people.0.remove(name).is_none() {
        let what = format!("{name}: there is no such person; help: `whichone gateway people`");
        return Err(Failure::new(Exit::Usage, what));
    }
    people.save(path)
}

/// The file, read again when it has changed.
pub type PeopleFile = Followed<People>;

#[cfg(test)]
mod tests {
    use super::*;

    fn name(text: &str) -> Name {
        Name::new(text).unwrap()
    }

    #[test]
    fn rights_are_per_robot_and_secrets_are_stored_as_hashes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(FILE);
        let robots = |names: &[&str]| names.iter().map(|it| (*it).to_owned()).collect::<Vec<_>>();
        let ann = add(&path, &name("ann"), &robots(&["r1"]), &robots(&["*"]), false).unwrap();
        let ann = ann.unwrap();
        let bob = add(&path, &name("bob"), &[], &robots(&["r2"]), false).unwrap().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(!text.contains(&ann) && !text.contains(&bob), "{text}");
        let file = PeopleFile::open(path.clone(), People::load).unwrap();
        let people = file.current();
        assert_eq!(people.with_secret(&ann), Some(&name("ann")));
        assert_eq!(people.with_secret("0123456789abcdef"), None);
        let rights = [("ann", "r1"), ("ann", "r2"), ("bob", "r1"), ("bob", "r2"), ("eve", "r1")]
            .map(|(person, robot)| people.right(&name(person), &name(robot)));
        let [operator, viewer] = [Some(Right::Operator), Some(Right::Viewer)];
        assert_eq!(rights, [operator, viewer, None, viewer, None]);
        // Changed rights keep the secret; renewing and removing end it.
        assert_eq!(add(&path, &name("bob"), &robots(&["*"]), &[], false).unwrap(), None);
        assert_eq!(file.current().right(&name("bob"), &name("r1")), operator);
        assert_eq!(file.current().with_secret(&bob), Some(&name("bob")));
        assert_ne!(add(&path, &name("ann"), &[], &[], true).unwrap(), Some(ann.clone()));
        remove(&path, &name("bob")).unwrap();
        assert_eq!(
            [&ann, &bob].map(|secret| file.current().with_secret(secret).cloned()),
            [None, None]
        );
        assert!(remove(&path, &name("bob")).unwrap_err().message.contains("no such person"));
    }

    #[test]
    fn file_of_people_is_checked() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(FILE);
        let load = |text: &str| {
            replace_private_synced(&path, text).unwrap();
            People::load(&path).unwrap_err().message
        };
        let secret = hash("0123456789abcdef");
        for (text, expected) in [
            ("[ann]\nsecret = \"secret\"\n".to_owned(), "ann.secret"),
            (format!("[Ann]\nsecret = \"{secret}\"\n"), "not a name"),
            (format!("[ann]\nsecret = \"{secret}\"\noperator = [\"R1\"]\n"), "ann.operator"),
            (format!("[ann]\nsecret = \"{secret}\"\nadmin = true\n"), "unknown field"),
        ] {
            let message = load(&text);
            assert!(message.contains(expected) && message.contains(FILE), "{message}");
        }
        let error = add(&folder.path().join("new"), &name("ann"), &["a/b".into()], &[], false);
        assert!(error.unwrap_err().message.contains("ann.operator"));
        std::fs::write(folder.path().join("open"), "").unwrap();
        let open = People::load(&folder.path().join("open")).unwrap_err();
        assert!(open.message.contains("chmod 600"), "{open}");
    }
}

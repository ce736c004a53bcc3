//! A folder of keys, which `whichone link init` made for one robot or one person.

use std::path::{Path, PathBuf};

use roster::Name;
use serde::{Deserialize, Serialize};
use service::exit::{Exit, Failure};

/// Certificate of the authority, in every folder of keys.
pub const AUTHORITY: &str = "authority.pem";
/// The owner's certificate.
pub const CERTIFICATE: &str = "certificate.pem";
/// The owner's private key.
pub const KEY: &str = "key.pem";
/// Everything else: [`Identity`] as JSON.
pub const LINK: &str = "link.json";

/// Rights of a certificate's owner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// A robot: may speak for itself.
    Robot,
    /// A person who may see robots, talk to them and give orders to their motion stop.
    Operator,
    /// A person who may see robots.
    Viewer,
}

impl Role {
    /// Returns the role's name.
    pub fn word(self) -> &'static str {
        match self {
            Self::Robot => "robot",
            Self::Operator => "operator",
            Self::Viewer => "viewer",
        }
    }
}

/// Owner of a folder of keys, and the way to the router.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Identity {
    /// The owner's name.
    pub name: Name,
    /// Role of the owner.
    pub role: Role,
    /// Robots that a person may see; empty for all.
    pub robots: Vec<Name>,
    /// Host and port of the router.
    pub router: String,
    /// The password in addition to the certificate.
    pub password: String,
}

impl Identity {
    /// Reads the folder's `link.json`, and checks that the other files exist.
    ///
    /// # Errors
    /// The file and its fault.
    pub fn load(folder: &Path) -> Result<Self, Failure> {
        let help = "help: copy the whole folder that `whichone link init` made for this machine";
        let path = folder.join(LINK);
        let bad = |path: &Path, what: &dyn std::fmt::Display| {
            Failure::new(Exit::Config, format!("{}: {what}; {help}", path.display()))
        };
        let text = safe_files::read_regular(&path).map_err(|error| bad(&path, &error))?;
        let identity = serde_json::from_str(&text).map_err(|error| bad(&path, &error))?;
        for file in [AUTHORITY, CERTIFICATE, KEY] {
            let path = folder.join(file);
            safe_files::open_regular(&path).map_err(|error| bad(&path, &error))?;
        }
        Ok(identity)
    }

    /// Fails unless the folder is a robot's, or a person's.
    ///
    /// # Errors
    /// It is not.
    pub fn require(&self, is_robot: bool, folder: &Path) -> Result<(), Failure> {
        if (self.role == Role::Robot) == is_robot {
            return Ok(());
        }
        let wanted = if is_robot { "a robot" } else { "an operator or a viewer" };
        let (found, name) = (self.role.word(), &self.name);
        let what = format!(
            "{}: expected keys of {wanted}, found those of {found} {name}",
            folder.display()
        );
        Err(Failure::new(Exit::Config, what))
    }

    /// Name of the owner for the router: user, and common name of the certificate.
    pub fn user(&self) -> String {
        user(self.role, &self.name)
    }
}

/// Returns the user name as [`Identity::user`] does.
pub fn user(role: Role, name: &Name) -> String {
    // A viewer who becomes an operator keeps the certificate.
    let kind = if role == Role::Robot { "robot" } else { "person" };
    format!("{kind}-{name}")
}

/// Absolute path of a folder of keys.
pub fn absolute(folder: &Path) -> PathBuf {
    std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned())
}

//! The folder from which all keys come: an own authority, a certificate and a password for the
//! router and each robot and person, and the router's configuration, which denies everything else.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use rcgen::{
    BasicConstraints, CertificateParams, DistinguishedName, DnType, ExtendedKeyUsagePurpose, IsCa,
    Issuer, KeyPair, KeyUsagePurpose, date_time_ymd,
};
use roster::Name;
use serde::{Deserialize, Serialize};
use service::console_link::random_secret;
use service::exit::{Exit, Failure};
use service::folders::{FolderError, make_private};

use crate::identity::{AUTHORITY, CERTIFICATE, Identity, KEY, LINK, Role, user};
use crate::router;

/// File with the folder's content.
const RING: &str = "keys.json";
/// The authority's private key, which leaves this folder never.
const AUTHORITY_KEY: &str = "authority.key";
/// Days for which certificates are good: the authority's, and the others'.
const DAYS: (u64, u64) = (3_650, 397);
/// Port of a router, if none is given.
pub(crate) const PORT: u16 = 7447;

/// Keys to be made.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Host and port of the router; required the first time.
    pub router: Option<String>,
    /// Robots.
    pub robots: Vec<Name>,
    /// Operators, each of whom may command `for_robots`.
    pub operators: Vec<Name>,
    /// Viewers, each of whom may see `for_robots`.
    pub viewers: Vec<Name>,
    /// The robots of the operators and viewers that are named; empty for all.
    pub for_robots: Vec<Name>,
    /// Names that get a new certificate and password.
    pub renew: Vec<Name>,
    /// Names that are no longer let in.
    pub revoke: Vec<Name>,
}

/// A robot or a person who is let in.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Member {
    pub(crate) name: Name,
    pub(crate) role: Role,
    /// Robots that a person may see; empty for all.
    pub(crate) robots: Vec<Name>,
    pub(crate) password: String,
}

impl Member {
    pub(crate) fn user(&self) -> String {
        user(self.role, &self.name)
    }

    fn folder(&self) -> String {
        let kind = if self.role == Role::Robot { "robots" } else { "people" };
        format!("{kind}/{}", self.name)
    }
}

/// Content of the folder other than keys.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Ring {
    /// Host and port.
    pub(crate) router: String,
    pub(crate) members: Vec<Member>,
}

/// Makes the wanted keys in `folder`, and returns the actions, a line each. Existing keys stay.
///
/// # Errors
/// A name twice, an unknown name, or a file that cannot be written.
pub fn init(folder: &Path, wanted: &Wanted) -> Result<Vec<String>, Failure> {
    make_private(folder).map_err(storage)?;
    let mut done = Vec::new();
    let path = folder.join(RING);
    let mut ring = match safe_files::read_regular(&path) {
        Ok(text) => serde_json::from_str::<Ring>(&text)
            .map_err(|error| Failure::new(Exit::Config, format!("{}: {error}", path.display())))?,
        Err(error) if error.kind() == ErrorKind::NotFound => Ring::default(),
        Err(error) => return Err(Failure::file(&path, &error)),
    };
    let authority = Authority::open(folder, &mut done)?;
    let former = ring.clone();
    if let Some(router) = &wanted.router {
        ring.router = with_port(router)?;
    }
    if ring.router.is_empty() {
        let help = "help: give the address under which robots and operators reach it: --router HOST[:PORT]";
        return Err(Failure::new(Exit::Usage, format!("the router's address is missing; {help}")));
    }
    ring.change(wanted)?;
    let router = folder.join("router");
    let host = ring.router.rsplit_once(':').map_or(ring.router.as_str(), |(host, _)| host);
    let is_moved = former.router != ring.router;
    if is_moved || !router.join(CERTIFICATE).exists() {
        authority.certify(&router, "router", Some(host.trim_matches(['[', ']'])))?;
        done.push(format!("router: certificate for {host} in {}", router.display()));
    }
    for member in &ring.members {
        let own = folder.join(member.folder());
        let is_known = former.members.contains(member) && own.join(CERTIFICATE).exists();
        if is_known && !is_moved {
            continue;
        }
        let before = former.members.iter().find(|known| known.user() == member.user());
        if before.is_none_or(|known| known.password != member.password) {
            authority.certify(&own, &member.user(), None)?;
        }
        let Member { name, role, robots, password } = member.clone();
        let identity = Identity { name, role, robots, router: ring.router.clone(), password };
        write_private(&own.join(LINK), &json(&identity)?)?;
        done.push(format!("{} {}: keys in {}", role.word(), member.name, own.display()));
    }
    for gone in former.members.iter().filter(|known| !ring.has(known)) {
        let own = folder.join(gone.folder());
        fs::remove_dir_all(&own).map_err(|error| Failure::file(&own, &error))?;
        done.push(format!("{} {}: no longer let in", gone.role.word(), gone.name));
    }
    router::configure(&router, &ring)?;
    write_private(&path, &json(&ring)?)?;
    if former != ring || !wanted.renew.is_empty() {
        done.push("the router's configuration has changed: start the router again".to_owned());
    }
    Ok(done)
}

impl Ring {
    fn has(&self, member: &Member) -> bool {
        self.members.iter().any(|known| known.user() == member.user())
    }

    fn change(&mut self, wanted: &Wanted) -> Result<(), Failure> {
        let usage = |what: String| Err(Failure::new(Exit::Usage, what));
        for name in &wanted.revoke {
            let before = self.members.len();
            self.members.retain(|member| member.name != *name);
            if self.members.len() == before {
                return usage(format!(
                    "{name}: there is no such robot or person; help: see {RING}"
                ));
            }
        }
        let robots = wanted.robots.iter().map(|name| (name, Role::Robot));
        let operators = wanted.operators.iter().map(|name| (name, Role::Operator));
        let people = operators.chain(wanted.viewers.iter().map(|name| (name, Role::Viewer)));
        for (name, role) in robots.chain(people) {
            let rights = if role == Role::Robot { Vec::new() } else { wanted.for_robots.clone() };
            match self.members.iter_mut().find(|member| member.name == *name) {
                Some(member) if (member.role == Role::Robot) != (role == Role::Robot) => {
                    return usage(format!(
                        "{name} is the name of a {}; help: choose another one",
                        member.role.word()
                    ));
                }
                Some(member) => (member.role, member.robots) = (role, rights),
                None => {
                    let (name, password) = (name.clone(), password()?);
                    self.members.push(Member { name, role, robots: rights, password });
                }
            }
        }
        for name in &wanted.renew {
            match self.members.iter_mut().find(|member| member.name == *name) {
                Some(member) => member.password = password()?,
                None => {
                    return usage(format!(
                        "{name}: there is no such robot or person; help: see {RING}"
                    ));
                }
            }
        }
        let is_robot = |name: &Name| {
            self.members.iter().any(|member| member.role == Role::Robot && member.name == *name)
        };
        let missing = wanted.for_robots.iter().find(|name| !is_robot(name));
        match missing {
            Some(name) => {
                usage(format!("{name}: there is no such robot; help: add it: --robot {name}"))
            }
            None => Ok(()),
        }
    }
}

/// The authority that signs every certificate.
struct Authority {
    issuer: Issuer<'static, KeyPair>,
    pem: String,
}

impl Authority {
    fn open(folder: &Path, done: &mut Vec<String>) -> Result<Self, Failure> {
        let (certificate, key) = (folder.join(AUTHORITY), folder.join(AUTHORITY_KEY));
        if !certificate.exists() {
            let pair = KeyPair::generate().map_err(|error| failed(&key, &error))?;
            let mut params = params("whichone authority", DAYS.0);
            params.is_ca = IsCa::Ca(BasicConstraints::Constrained(0));
            params.key_usages = vec![KeyUsagePurpose::KeyCertSign, KeyUsagePurpose::CrlSign];
            let signed = params.self_signed(&pair).map_err(|error| failed(&certificate, &error))?;
            write_private(&key, pair.serialize_pem().as_bytes())?;
            write_private(&certificate, signed.pem().as_bytes())?;
            done.push(format!("authority: {} (keep its key offline)", certificate.display()));
        }
        let read =
            |path: &PathBuf| safe_files::read_regular(path).map_err(|e| Failure::file(path, &e));
        let pem = read(&certificate)?;
        let pair = KeyPair::from_pem(&read(&key)?).map_err(|error| failed(&key, &error))?;
        let issuer = Issuer::from_ca_cert_pem(&pem, pair);
        Ok(Self { issuer: issuer.map_err(|error| failed(&certificate, &error))?, pem })
    }

    /// Writes a new key with its certificate, and the authority's, into `folder`.
    fn certify(&self, folder: &Path, name: &str, host: Option<&str>) -> Result<(), Failure> {
        if let Some(parent) = folder.parent() {
            make_private(parent).map_err(storage)?;
        }
        make_private(folder).map_err(storage)?;
        let path = folder.join(CERTIFICATE);
        let pair = KeyPair::generate().map_err(|error| failed(&path, &error))?;
        let mut params = params(name, DAYS.1);
        if let Some(host) = host {
            let named = CertificateParams::new(vec![host.to_owned()]);
            params.subject_alt_names =
                named.map_err(|error| failed(&path, &error))?.subject_alt_names;
        }
        params.use_authority_key_identifier_extension = true;
        params.key_usages = vec![KeyUsagePurpose::DigitalSignature];
        params.extended_key_usages =
            vec![ExtendedKeyUsagePurpose::ServerAuth, ExtendedKeyUsagePurpose::ClientAuth];
        let signed =
            params.signed_by(&pair, &self.issuer).map_err(|error| failed(&path, &error))?;
        write_private(&folder.join(KEY), pair.serialize_pem().as_bytes())?;
        write_private(&path, signed.pem().as_bytes())?;
        write_private(&folder.join(AUTHORITY), self.pem.as_bytes())
    }
}

fn params(name: &str, days: u64) -> CertificateParams {
    let mut params = CertificateParams::default();
    params.distinguished_name = DistinguishedName::new();
    params.distinguished_name.push(DnType::CommonName, name);
    let day = Duration::from_secs(86_400);
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let epoch = date_time_ymd(1970, 1, 1);
    // Clocks of robots may be behind.
    params.not_before = epoch + now.saturating_sub(day);
    params.not_after = epoch + now + day * u32::try_from(days).unwrap_or(u32::MAX);
    params
}

fn failed(path: &Path, error: &rcgen::Error) -> Failure {
    Failure::new(Exit::Storage, format!("{}: {error}", path.display()))
}

fn password() -> Result<String, Failure> {
    random_secret()
        .map_err(|error| Failure::new(Exit::NotReached, format!("random numbers: {error}")))
}

fn json(value: &impl Serialize) -> Result<Vec<u8>, Failure> {
    serde_json::to_vec_pretty(value)
        .map_err(|error| Failure::new(Exit::Invariant, error.to_string()))
}

/// A folder that is not its owner's alone, or cannot be made.
pub(crate) fn storage(error: FolderError) -> Failure {
    Failure::new(Exit::Storage, error.to_string())
}

/// Writes a file that only its owner can read.
pub(crate) fn write_private(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    safe_files::replace_private_synced(path, bytes).map_err(|error| Failure::file(path, &error))
}

/// Adds a missing port, and checks that the rest can be a host.
fn with_port(router: &str) -> Result<String, Failure> {
    let (host, port) = match router.rsplit_once(':') {
        Some((host, port)) if !host.contains(':') || host.ends_with(']') => {
            (host, port.parse().ok())
        }
        _ => (router, Some(PORT)),
    };
    let allowed = |c: char| c.is_ascii_alphanumeric() || "-.:[]".contains(c);
    match port.filter(|port| *port > 0) {
        Some(port) if !host.is_empty() && host.chars().all(allowed) => Ok(format!("{host}:{port}")),
        _ => {
            let what = format!("--router: expected HOST or HOST:PORT, found {router:?}");
            Err(Failure::new(Exit::Usage, what))
        }
    }
}

//! Tokens of programs, each with a name and rights: a file of the group's owner, read again when it has changed.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};

use roster::Name;
use safe_files::{read_private, replace_private_synced};
use serde::{Deserialize, Serialize};
use service::console_link::{is_token, random_secret};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use web_server::followed::Followed;
use web_server::sessions::{HASH, hash};

/// Head of the file.
const HEAD: &str = "# Tokens of programs (docs/http.md): `whichone token add` and `revoke` write this file. A secret is \
                    stored as its hash.\n\n";
/// Most tokens.
const TOKENS_MAX: usize = 64;
/// Largest file, bytes: a greater one would keep the requests waiting that are checked against it.
const FILE_MAX: u64 = 64 << 10;
/// Name under which the console's own token is used; none of the file's has it.
pub(crate) const OWNER: &str = "console";

/// What a token allows.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, clap::ValueEnum,
)]
#[serde(rename_all = "lowercase")]
pub enum Right {
    /// Read the state and the events.
    See,
    /// Say something, and withdraw a request.
    Talk,
    /// Stop the arm.
    Stop,
    /// Release the stop.
    Resume,
}

impl Right {
    /// Every right.
    pub const ALL: [Self; 4] = [Self::See, Self::Talk, Self::Stop, Self::Resume];

    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::See => "see",
            Self::Talk => "talk",
            Self::Stop => "stop",
            Self::Resume => "resume",
        }
    }
}

/// A token as in the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Token {
    /// Hash of the secret.
    secret: String,
    /// Its rights.
    pub may: BTreeSet<Right>,
    /// When it was made, Unix seconds.
    pub made_s: u64,
}

/// Every token of a group, by name.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Tokens(BTreeMap<Name, Token>);

/// Returns the file of the tokens.
pub fn tokens_file(paths: &GroupPaths) -> PathBuf {
    paths.root().join("http.tokens")
}

impl Tokens {
    /// Reads the file; a missing one has no token.
    ///
    /// # Errors
    /// Others could read or change the file, or it is not one of tokens.
    pub fn load(path: &Path) -> Result<Self, Failure> {
        if !path.exists() {
            return Ok(Self::default());
        }
        let bad = |what: String| Failure::new(Exit::Config, format!("{}: {what}", path.display()));
        if fs::metadata(path).is_ok_and(|file| file.len() > FILE_MAX) {
            return Err(bad(format!(
                "expected at most {FILE_MAX} bytes; help: remove what is no token"
            )));
        }
        let text = read_private(path).map_err(|error| bad(error.to_string()))?;
        let tokens: Self = toml::from_str(&text).map_err(|error| bad(error.to_string()))?;
        for (name, Token { secret, .. }) in &tokens.0 {
            if name.as_str() == OWNER {
                return Err(bad(reserved()));
            }
            let digits = secret.strip_prefix(HASH).unwrap_or_default();
            if digits.len() != 64 || !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
                let help = "help: let `whichone token add` write it";
                let what = format!("{name}.secret: expected {HASH} and 64 digits; {help}");
                return Err(bad(what));
            }
        }
        Ok(tokens)
    }

    fn save(&self, path: &Path) -> Result<(), Failure> {
        let text = toml::to_string(self)
            .map_err(|error| Failure::new(Exit::Invariant, error.to_string()))?;
        replace_private_synced(path, format!("{HEAD}{text}"))
            .map_err(|error| Failure::file(path, &error))
    }

    /// Every token, by name.
    pub fn iter(&self) -> impl Iterator<Item = (&Name, &Token)> {
        self.0.iter()
    }

    /// Returns the token with this secret. The time that it takes depends on the number of tokens alone.
    pub fn with_secret(&self, secret: &str) -> Option<(&Name, &Token)> {
        let wanted = hash(secret);
        let mut found = None;
        for (name, token) in &self.0 {
            if is_equal(&wanted, &token.secret) {
                found = Some((name, token));
            }
        }
        found.filter(|_| is_token(secret))
    }
}

fn reserved() -> String {
    format!(
        "expected another name than {OWNER}, which the page's token has; help: choose the program's name"
    )
}

/// Compares every byte, wherever the first difference is.
fn is_equal(one: &str, other: &str) -> bool {
    let difference = one.bytes().zip(other.bytes()).fold(0, |all, (a, b)| black_box(all | (a ^ b)));
    one.len() == other.len() && difference == 0
}

/// Adds a token, or changes the rights of one; returns the secret of a new one, or of one whose secret is renewed.
///
/// # Errors
/// There are too many, or the file cannot be read or written.
pub(crate) fn add(
    path: &Path,
    name: &Name,
    may: BTreeSet<Right>,
    renew: bool,
    made_s: u64,
) -> Result<Option<String>, Failure> {
    if name.as_str() == OWNER {
        return Err(Failure::new(Exit::Usage, reserved()));
    }
    let mut tokens = Tokens::load(path)?;
    let known = tokens.0.get(name).filter(|_| !renew).cloned();
    if tokens.0.len() >= TOKENS_MAX && !tokens.0.contains_key(name) {
        let what = format!("expected at most {TOKENS_MAX} tokens; help: `whichone token revoke`");
        return Err(Failure::new(Exit::Usage, what));
    }
    let no_numbers = |error| Failure::new(Exit::NotReached, format!("random numbers: {error}"));
    let fresh = match &known {
        Some(_) => None,
        None => Some(random_secret().map_err(no_numbers)?),
    };
    let made =
        fresh.as_deref().map(|secret| Token { secret: hash(secret), may: may.clone(), made_s });
    let token = known.map(|token| Token { may: may.clone(), ..token }).or(made);
    tokens.0.extend(token.map(|token| (name.clone(), token)));
    tokens.save(path)?;
    Ok(fresh)
}

/// Revokes a token: its next request is refused, and its events end.
///
/// # Errors
/// There is no such token, or the file cannot be read or written.
pub(crate) fn revoke(path: &Path, name: &Name) -> Result<(), Failure> {
    let mut tokens = Tokens::load(path)?;
    if tokens.0.remove(name).is_none() {
        let what = format!("{name}: token not found; help: `whichone token list`");
        return Err(Failure::new(Exit::Usage, what));
    }
    tokens.save(path)
}

/// The file, read again when it has changed.
pub(crate) type TokenFile = Followed<Tokens>;

#[cfg(test)]
mod tests {
    use std::os::unix::fs::MetadataExt;

    use super::*;
    use safe_files::replace_private;

    fn name(text: &str) -> Name {
        Name::new(text).unwrap()
    }

    #[test]
    fn tokens_have_names_rights_and_hashed_secrets() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("http.tokens");
        let may = |rights: &[Right]| rights.iter().copied().collect::<BTreeSet<_>>();
        let file = TokenFile::new(path.clone(), Tokens::load);
        assert_eq!(*file.current(), Tokens::default());
        let hall = add(&path, &name("hall"), may(&[Right::See]), false, 7).unwrap().unwrap();
        let kitchen = add(&path, &name("kitchen"), may(&Right::ALL), false, 8).unwrap().unwrap();
        let text = fs::read_to_string(&path).unwrap();
        assert!(!text.contains(&hall) && !text.contains(&kitchen), "{text}");
        assert_eq!(fs::metadata(&path).unwrap().mode() & 0o777, 0o600);
        let found = |secret: &str| {
            let tokens = file.current();
            let found = tokens.with_secret(secret);
            found.map(|(name, token)| (name.to_string(), token.may.clone()))
        };
        assert_eq!(found(&hall), Some(("hall".to_owned(), may(&[Right::See]))));
        let other = if hall.ends_with('0') { "1" } else { "0" };
        let nearly = format!("{}{other}", &hall[..31]);
        for wrong in [nearly.as_str(), &hall[..31], "", "0123456789abcdef", &hash(&hall)] {
            assert_eq!(found(wrong), None, "{wrong}");
        }
        // Changed rights keep the secret; renewing and revoking end it.
        assert_eq!(add(&path, &name("hall"), may(&[Right::Stop]), false, 9).unwrap(), None);
        assert_eq!(found(&hall), Some(("hall".to_owned(), may(&[Right::Stop]))));
        let renewed = add(&path, &name("hall"), may(&[Right::Stop]), true, 10).unwrap().unwrap();
        assert_eq!((found(&hall), found(&renewed).is_some()), (None, true));
        revoke(&path, &name("kitchen")).unwrap();
        assert_eq!(found(&kitchen), None);
        assert!(revoke(&path, &name("kitchen")).unwrap_err().message.contains("token not found"));
    }

    #[test]
    fn file_of_tokens_is_checked() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("http.tokens");
        let secret = hash("0123456789abcdef");
        for (text, expected) in [
            ("[hall]\nsecret = \"x\"\nmay = []\nmade_s = 1\n".to_owned(), "hall.secret"),
            (format!("[hall]\nsecret = \"{secret}\"\nmay = [\"fly\"]\nmade_s = 1\n"), "fly"),
            (format!("[Hall]\nsecret = \"{secret}\"\nmay = []\nmade_s = 1\n"), "not a name"),
            (format!("[console]\nsecret = \"{secret}\"\nmay = []\nmade_s = 1\n"), "another name"),
            ("# no token\n".repeat(1 << 13), "at most 65536 bytes"),
        ] {
            replace_private(&path, text).unwrap();
            let message = Tokens::load(&path).unwrap_err().message;
            assert!(message.contains(expected) && message.contains("http.tokens"), "{message}");
        }
        let console = add(&path, &name("console"), BTreeSet::new(), false, 7);
        assert!(console.unwrap_err().message.contains("another name"));
        replace_private(&path, b"# caf\xe9\n").unwrap();
        let message = Tokens::load(&path).unwrap_err().message;
        assert!(message.contains("expected UTF-8") && message.contains("http.tokens"), "{message}");
        let other = folder.path().join("open");
        fs::write(&other, "").unwrap();
        assert!(Tokens::load(&other).unwrap_err().message.contains("chmod 600"));
    }

    #[test]
    fn unreadable_file_leaves_the_former_tokens() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("http.tokens");
        let secret = add(&path, &name("hall"), BTreeSet::new(), false, 7).unwrap().unwrap();
        let file = TokenFile::new(path.clone(), Tokens::load);
        assert!(file.current().with_secret(&secret).is_some());
        replace_private(&path, "nonsense").unwrap();
        assert!(file.current().with_secret(&secret).is_some());
    }
}

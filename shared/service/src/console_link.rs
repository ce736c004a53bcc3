//! The console's address for the group's owner: the token in a file that only the owner can read,
//! and the link that carries it.

use std::fs;
use std::io;
use std::path::PathBuf;

use safe_files::read_private;

use crate::group::GroupPaths;

/// Lengths of a token, characters.
const TOKEN_LEN: std::ops::RangeInclusive<usize> = 12..=200;

/// Returns the file of the token: its first line. The owner may write a token of their own; the
/// console writes one only if there is none.
pub fn token_file(paths: &GroupPaths) -> PathBuf {
    paths.root().join("console.token")
}

/// Returns the file of the browsers' sessions, which is the console's own.
pub fn sessions_file(paths: &GroupPaths) -> PathBuf {
    paths.root().join("console.sessions")
}

/// Returns the group's token; `None` before the console's first start.
pub fn token(paths: &GroupPaths) -> Option<String> {
    read_private(&token_file(paths)).ok()?.lines().next().map(str::to_owned)
}

/// Returns the address of the page, while one is served.
pub fn address(paths: &GroupPaths) -> Option<String> {
    let text = fs::read_to_string(paths.console_url()).ok()?;
    let address = text.trim();
    (!address.is_empty()).then(|| address.to_owned())
}

/// Returns the address with the token: who opens it may use the page.
pub fn link(paths: &GroupPaths) -> Option<String> {
    let address = address(paths)?;
    Some(match token(paths) {
        Some(token) => format!("{address}?token={token}"),
        None => address,
    })
}

/// Returns whether a text can be a token: 12 to 200 letters, digits, `-` and `_`, which need no
/// quotes in a link, a cookie or a header.
pub fn is_token(text: &str) -> bool {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_';
    TOKEN_LEN.contains(&text.len()) && text.bytes().all(plain)
}

/// Returns 32 unpredictable hexadecimal digits.
///
/// # Errors
/// The operating system has no random numbers.
pub fn random_secret() -> io::Result<String> {
    let mut bytes = [0; 16];
    let count = rustix::rand::getrandom(&mut bytes, rustix::rand::GetRandomFlags::empty())?;
    if count < bytes.len() {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn link_carries_the_token() {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &"lab".parse().unwrap()).unwrap();
        fs::create_dir_all(paths.run()).unwrap();
        assert_eq!(link(&paths), None, "no page is served");
        fs::write(paths.console_url(), "http://127.0.0.1:8377/\n").unwrap();
        assert_eq!(link(&paths).as_deref(), Some("http://127.0.0.1:8377/"));
        safe_files::replace_private(&token_file(&paths), "correct-horse\nmore\n").unwrap();
        let link = link(&paths);
        assert_eq!(link.as_deref(), Some("http://127.0.0.1:8377/?token=correct-horse"));
    }

    #[test]
    fn secrets_are_tokens_and_differ() {
        let (one, other) = (random_secret().unwrap(), random_secret().unwrap());
        assert!(is_token(&one) && one.len() == 32 && one != other);
        for bad in ["", "short", "with a blank in it", "twelve&signs", &"x".repeat(201)] {
            assert!(!is_token(bad), "{bad}");
        }
    }
}

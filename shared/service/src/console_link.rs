//! The console's address for the group's owner: the token in a file that only the owner can read, and
//! the link that carries it.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};

use crate::group::GroupPaths;

/// Lengths of a token, characters.
const TOKEN_LEN: std::ops::RangeInclusive<usize> = 12..=200;

/// Returns the file of the token: its first line. It is the owner's, who may write a word of
/// their own there; the console writes it only where there is no token.
pub fn token_file(paths: &GroupPaths) -> PathBuf {
    paths.root().join("console.token")
}

/// Returns the file of the browsers' sessions, which is the console's own.
pub fn sessions_file(paths: &GroupPaths) -> PathBuf {
    paths.root().join("console.sessions")
}

/// Returns the group's token; none before the console's first start.
pub fn token(paths: &GroupPaths) -> Option<String> {
    read_private(&token_file(paths))?.lines().next().map(str::to_owned)
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

/// Returns whether a text can be a token: 12 to 200 letters, digits, `-` and `_`, which need no quotes in a
/// link, a cookie or a header.
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

/// Reads a file of this user that no other user can read or change; none otherwise.
pub fn read_private(path: &Path) -> Option<String> {
    let file = fs::symlink_metadata(path).ok()?;
    let is_own = file.uid() == rustix::process::geteuid().as_raw();
    let is_private = file.is_file() && is_own && file.mode() & 0o077 == 0;
    is_private.then(|| fs::read_to_string(path).ok())?
}

/// Replaces the content of a file that only this user can read; readers see the old or the new one, and the old
/// one stays where the new one cannot be written.
///
/// # Errors
/// The file cannot be written.
pub fn replace_private(path: &Path, content: &str) -> io::Result<()> {
    replace(path, content, File::flush)
}

/// As [`replace_private`], and the new content is on the disk before the file is replaced.
///
/// # Errors
/// The file cannot be written.
pub fn replace_private_synced(path: &Path, content: &str) -> io::Result<()> {
    replace(path, content, |file| file.sync_all())
}

fn replace(
    path: &Path,
    content: &str,
    finish: impl FnOnce(&mut File) -> io::Result<()>,
) -> io::Result<()> {
    // Beside it, by a name that belongs to no other file.
    let mut new = path.as_os_str().to_owned();
    new.push(".new");
    let new = Path::new(&new);
    // Never into a file, or through a link, that another has put there.
    match fs::remove_file(new) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    let mut file = OpenOptions::new().write(true).create_new(true).mode(0o600).open(new)?;
    let written = file.write_all(content.as_bytes()).and_then(|()| finish(&mut file));
    written.and_then(|()| fs::rename(new, path)).inspect_err(|_| {
        // What a full disk has left of it.
        let _ = fs::remove_file(new);
    })
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::{PermissionsExt, symlink};

    use super::*;

    #[test]
    fn private_file_is_for_its_owner_alone() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("console.token");
        fs::write(folder.path().join("console.token.new"), "left behind").unwrap();
        replace_private_synced(&file, "secret\n").unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        assert_eq!(fs::metadata(&file).unwrap().mode() & 0o777, 0o600);
        assert_eq!(read_private(&file).as_deref(), Some("secret\n"));
        for mode in [0o640, 0o602, 0o604] {
            fs::set_permissions(&file, fs::Permissions::from_mode(mode)).unwrap();
            assert_eq!(read_private(&file), None, "{mode:o}");
        }
        fs::set_permissions(&file, fs::Permissions::from_mode(0o600)).unwrap();
        let link = folder.path().join("link");
        symlink(&file, &link).unwrap();
        assert_eq!(read_private(&link), None);
    }

    #[test]
    fn failed_replacement_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("console.token");
        replace_private(&file, "secret").unwrap();
        let full = |_: &mut File| Err(io::ErrorKind::StorageFull.into());
        assert_eq!(replace(&file, "new", full).unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert_eq!(read_private(&file).as_deref(), Some("secret"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn link_carries_the_token() {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &"lab".parse().unwrap()).unwrap();
        fs::create_dir_all(paths.run()).unwrap();
        assert_eq!(link(&paths), None, "no page is served");
        fs::write(paths.console_url(), "http://127.0.0.1:8377/\n").unwrap();
        assert_eq!(link(&paths).as_deref(), Some("http://127.0.0.1:8377/"));
        replace_private(&token_file(&paths), "correct-horse\nmore\n").unwrap();
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

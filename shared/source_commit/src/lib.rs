//! The commit that a program is compiled from, as an expression of its `main.rs`.
//!
//! A macro and not a build script: a build script belongs to a package, so that each commit would compile its library,
//! and every test that uses it, again. The file that expands [`source_commit!`] alone depends on the commit.

use std::path::{Path, PathBuf};
use std::process::Command;

use proc_macro::TokenStream;

/// Variable that overrides what is found, as `HASH DAY`. Packagers set it if they build from a copy.
const OVERRIDE: &str = "WHICHONE_COMMIT";

/// File below the root of the sources, in which `git archive` enters the commit.
const ARCHIVED: &str = "scripts/packaging/commit";

/// Characters of an abbreviated hash.
const HASH_LEN: usize = 12;

/// Expands to an `Option<&'static str>`: the abbreviated hash and the day of the commit (`4fd360ed3a1b 2026-11-30`).
///
/// It is looked for in `WHICHONE_COMMIT`, in git if these sources are the checkout's own, and in the file that
/// `git archive` writes. The program is compiled again when one of them changes.
#[proc_macro]
pub fn source_commit(_: TokenStream) -> TokenStream {
    let manifest = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
    let source = Source::find(&manifest, std::env::var(OVERRIDE).ok());
    let watched =
        source.watched.iter().map(|path| format!("const _: &[u8] = include_bytes!({path:?});"));
    let watched: String = watched.collect();
    let commit = match source.commit {
        Some(commit) => format!("Some({commit:?})"),
        None => "None".to_owned(),
    };
    let tracked = format!("const _: Option<&str> = option_env!({OVERRIDE:?}); {watched}");
    let code = format!("{{ {tracked} let commit: Option<&'static str> = {commit}; commit }}");
    code.parse().unwrap_or_default()
}

/// A commit, and the files that change with it.
#[derive(Debug, Default, PartialEq, Eq)]
struct Source {
    commit: Option<String>,
    watched: Vec<PathBuf>,
}

impl Source {
    /// The commit of the sources that contain `folder`.
    fn find(folder: &Path, named: Option<String>) -> Self {
        if let Some(commit) = named.filter(|text| !text.trim().is_empty()) {
            return Self { commit: short(&commit), watched: Vec::new() };
        }
        let Some(root) = folder.ancestors().find(|folder| folder.join(ARCHIVED).is_file()) else {
            return Self::default();
        };
        let archived = root.join(ARCHIVED);
        Self::of_checkout(root).unwrap_or_else(|| {
            let text = std::fs::read_to_string(&archived).unwrap_or_default();
            Self { commit: short(&text), watched: vec![archived] }
        })
    }

    /// None if `root` is not the top of a checkout: an archive may be unpacked inside another repository.
    fn of_checkout(root: &Path) -> Option<Self> {
        let top = git(root, &["rev-parse", "--show-toplevel"])?;
        let is_own = Path::new(&top).canonicalize().ok()? == root.canonicalize().ok()?;
        let commit = is_own.then(|| git(root, &["log", "-1", "--format=%H %cs"]))??;
        // The first names the branch, the second grows with every commit, checkout and reset.
        let names = ["HEAD", "logs/HEAD"];
        let paths = names.iter().filter_map(|name| git(root, &["rev-parse", "--git-path", name]));
        let paths = paths.map(|path| root.join(path)).filter(|path| path.is_file());
        Some(Self { commit: short(&commit), watched: paths.collect() })
    }
}

fn git(folder: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").arg("-C").arg(folder).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

/// The hash abbreviated, and the day; None if the text is no such pair, as in a file that git has not filled in.
fn short(text: &str) -> Option<String> {
    let mut words = text.split_whitespace();
    let hash = words.next()?;
    let is_hash = hash.len() >= 7 && hash.bytes().all(|byte| byte.is_ascii_hexdigit());
    let is_day = |word: &&str| word.bytes().all(|byte| byte.is_ascii_digit() || byte == b'-');
    let hash = is_hash.then(|| &hash[..hash.len().min(HASH_LEN)])?;
    let day = words.next().filter(is_day).unwrap_or_default();
    Some(format!("{hash} {day}").trim_end().to_owned())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;

    const HASH: &str = "4fd360ed3a1b5c6d7e8f4fd360ed3a1b5c6d7e8f";

    fn sources(commit: &str) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(folder.path().join("services/whichone")).unwrap();
        std::fs::create_dir_all(folder.path().join("scripts/packaging")).unwrap();
        std::fs::write(folder.path().join(ARCHIVED), commit).unwrap();
        folder
    }

    fn must(folder: &Path, line: &str) {
        let options = ["-c", "user.name=x", "-c", "user.email=x@y", "-c", "commit.gpgsign=false"];
        let words: Vec<&str> = options.into_iter().chain(line.split(' ')).collect();
        assert!(git(folder, &words).is_some(), "git {line}");
    }

    #[test]
    fn archive_has_its_commit_in_a_file() {
        let folder = sources(&format!("{HASH} 2026-11-30\n"));
        let crate_folder = folder.path().join("services/whichone");
        let found = Source::find(&crate_folder, None);
        assert_eq!(found.commit.as_deref(), Some("4fd360ed3a1b 2026-11-30"));
        let named = Source::find(&crate_folder, Some("0123456789ab 2027-01-02".to_owned()));
        assert_eq!(named.commit.as_deref(), Some("0123456789ab 2027-01-02"));
    }

    #[test]
    fn sources_without_git_and_without_archive_have_no_known_commit() {
        let folder = sources("$Format:%H %cs$\n");
        assert_eq!(Source::find(folder.path(), None).commit, None);
        assert_eq!(Source::find(tempfile::tempdir().unwrap().path(), None), Source::default());
    }

    #[test]
    fn checkout_has_the_commit_of_its_head_and_an_archive_inside_it_its_own() {
        let folder = sources("$Format:%H %cs$\n");
        for line in ["init --quiet", "add .", "commit --quiet -m one"] {
            must(folder.path(), line);
        }
        let found = Source::find(folder.path(), None);
        let head = git(folder.path(), &["rev-parse", "HEAD"]).unwrap();
        assert!(found.commit.unwrap().starts_with(&head[..HASH_LEN]));
        assert_eq!(found.watched.len(), 2, "{:?}", found.watched);
        let inside = folder.path().join("unpacked");
        std::fs::create_dir_all(inside.join("scripts/packaging")).unwrap();
        std::fs::write(inside.join(ARCHIVED), format!("{HASH} 2026-11-30\n")).unwrap();
        let commit = Source::find(&inside, None).commit;
        assert_eq!(commit.as_deref(), Some("4fd360ed3a1b 2026-11-30"));
    }
}

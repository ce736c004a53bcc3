//! Audit of the dependencies: licences, sources, duplicates, pins, and their table in
//! docs/dependencies.md. Known advisories need a database that no registry serves: `scripts/test`
//! asks cargo-deny for them where that is installed and its database is reached.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Read as _;
use std::process::Command;

const TOP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// Licences of dependencies, and the reason why each may be linked.
const LICENCES: [(&str, &str); 11] = [
    ("MIT", "the project's own"),
    ("Apache-2.0", "the project's own"),
    ("0BSD", "asks for nothing"),
    ("Unlicense", "public domain"),
    ("BSD-2-Clause", "asks for its notice only"),
    ("BSD-3-Clause", "asks for its notice only"),
    ("ISC", "asks for its notice only"),
    ("Zlib", "asks for nothing in binaries"),
    ("Unicode-3.0", "tables of characters: asks for its notice only"),
    ("Apache-2.0 WITH LLVM-exception", "Apache-2.0 that asks for less"),
    ("CDLA-Permissive-2.0", "data: certificates of public authorities"),
];

/// Crates under a licence that is not in that list, and the reason why each may be linked.
const EXCEPTIONS: [(&str, &str, &str); 1] =
    [("option-ext", "MPL-2.0", "dirs of zenoh brings it, unchanged; the default build lacks it")];

/// Crates of which two versions are built, and who brings the older one.
const DUPLICATES: [(&str, &str); 25] = [
    ("base64", "axum's web sockets; ureq has the newer one"),
    ("cpufeatures", "sha1 of axum's web sockets"),
    ("darling", "enumset of iceoryx2; beside it zenoh's serde_with"),
    ("darling_core", "darling of enumset"),
    ("darling_macro", "darling of enumset"),
    ("flume", "zenoh; mdns-sd has the newer one"),
    ("foldhash", "hashbrown of zenoh's petgraph"),
    ("getrandom", "rand of axum's web sockets"),
    ("hashbrown", "zenoh"),
    ("itertools", "bindgen, to build iceoryx2"),
    ("libloading", "clang-sys, to build iceoryx2"),
    ("nom", "bindgen's cexpr, to build iceoryx2"),
    ("rand", "axum's web sockets"),
    ("rand_chacha", "rand of zenoh"),
    ("rand_core", "rand of axum's web sockets"),
    ("shlex", "bindgen, to build iceoryx2"),
    ("signal-hook", "crossterm of ratatui"),
    ("socket2", "zenoh"),
    ("spin", "flume of zenoh"),
    ("syn", "macros of crates that have not moved on: built, not linked"),
    ("thiserror", "serde-reflection"),
    ("thiserror-impl", "serde-reflection"),
    ("toml", "iceoryx2's own configuration"),
    ("toml_datetime", "toml of iceoryx2"),
    ("winnow", "toml of iceoryx2"),
];

/// Requirements that are not exact: interfaces that have been stable for years.
const UNPINNED: [&str; 9] = [
    "clap_complete",
    "crc32c",
    "nalgebra",
    "proptest",
    "serde",
    "serde_json",
    "strsim",
    "tempfile",
    "unicode-normalization",
];

/// Parts of the console's page, which are vendored and not built by cargo.
const VENDORED: [&str; 2] = ["three", "urdf-loader"];

struct Package {
    name: String,
    version: String,
    licence: String,
}

/// Every crate of others that the workspace is built and tested with, by name and version.
fn packages() -> Vec<Package> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--locked", "--workspace", "--prefix", "none"])
        .args([
            "--features",
            "ros2/dds,link/zenoh,grounding/tls",
            "--edges",
            "normal,build,dev",
            "--format",
            "{p}\t{l}",
        ])
        .current_dir(TOP)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let lines = distinct(&output.stdout);
    let package = |line: &String| {
        let (package, licence) = line.split_once('\t')?;
        let mut words = package.split(' ');
        let (name, version) = (words.next()?, words.next()?.strip_prefix('v')?);
        // Our own are followed by their folder.
        let ours = words.next().is_some_and(|word| word.starts_with("(/"));
        let (name, version, licence) = (name.to_owned(), version.to_owned(), licence.to_owned());
        (!ours).then_some(Package { name, version, licence })
    };
    let packages: Vec<Package> = lines.iter().filter_map(package).collect();
    assert!(packages.len() > 100, "cargo tree prints something else: {lines:?}");
    packages
}

/// The parts of an SPDX expression between `word`s that stand outside of parentheses.
fn parts<'a>(expression: &'a str, word: &str) -> Vec<&'a str> {
    let (mut depth, mut start, mut parts) = (0, 0, Vec::new());
    for (at, character) in expression.char_indices() {
        depth += i32::from(character == '(') - i32::from(character == ')');
        if depth == 0 && at >= start && expression[at..].starts_with(word) {
            parts.push(expression[start..at].trim());
            start = at + word.len();
        }
    }
    parts.push(expression[start..].trim());
    parts
}

fn is_allowed(expression: &str) -> bool {
    let expression = expression.trim();
    let inner = expression.strip_prefix('(').and_then(|inner| inner.strip_suffix(')'));
    if let Some(inner) = inner.filter(|inner| !inner.contains('(')) {
        return is_allowed(inner);
    }
    // The older way to write `OR`.
    for word in [" OR ", "/", " AND "] {
        let parts = parts(expression, word);
        if parts.len() > 1 {
            let mut parts = parts.into_iter();
            return if word == " AND " { parts.all(is_allowed) } else { parts.any(is_allowed) };
        }
    }
    LICENCES.iter().any(|(licence, _)| *licence == expression)
}

/// Every crate, with its features, that `cargo build` with these arguments compiles.
fn built(arguments: &[&str]) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--locked", "--prefix", "none"])
        .args(["--edges", "normal,build", "--format", "{p} [{f}]"])
        .args(arguments)
        .current_dir(TOP)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    distinct(&output.stdout)
}

/// Returns the lines of `cargo tree`, which marks a package whose dependencies it has shown already.
fn distinct(output: &[u8]) -> BTreeSet<String> {
    let lines = std::str::from_utf8(output).unwrap().lines();
    lines.map(|line| line.strip_suffix(" (*)").unwrap_or(line).to_owned()).collect()
}

#[test]
fn a_build_for_benchmarks_compiles_no_crate_of_the_default_build_again() {
    // The gateway is a client of HTTP, too.
    let others = ["--workspace", "--exclude", "link", "--exclude", "gateway"];
    let (default, workspace) = (built(&[]), built(&others));
    let again: Vec<_> = default.difference(&workspace).collect();
    assert!(again.is_empty(), "ask for these features in the workspace's table: {again:?}");
}

#[test]
fn licence_expressions_are_understood() {
    for good in ["MIT", "(MIT OR GPL-3.0) AND ISC", "MPL-2.0/Zlib", "GPL-2.0 OR MIT AND 0BSD"] {
        assert!(is_allowed(good), "{good}");
    }
    for bad in ["", "GPL-3.0", "MIT AND GPL-3.0", "(MIT OR ISC) AND (MPL-2.0 OR GPL-3.0)"] {
        assert!(!is_allowed(bad), "{bad}");
    }
}

#[test]
fn licences_of_dependencies_are_allowed() {
    for Package { name, version, licence } in packages() {
        let is_exception = EXCEPTIONS.iter().any(|it| (it.0, it.1) == (&*name, &*licence));
        let is_allowed = is_exception || is_allowed(&licence);
        assert!(is_allowed, "{name} {version}: licence `{licence}` is not in the list");
    }
}

#[test]
fn dependencies_come_from_the_registry_alone() {
    let lock: toml::Table =
        fs::read_to_string(format!("{TOP}/Cargo.lock")).unwrap().parse().unwrap();
    let packages = lock["package"].as_array().unwrap();
    for package in packages {
        let Some(source) = package.get("source") else { continue };
        let registry = "registry+https://github.com/rust-lang/crates.io-index";
        assert_eq!(source.as_str(), Some(registry), "{}", package["name"]);
        assert!(package.get("checksum").is_some(), "{}: no checksum", package["name"]);
    }
}

#[test]
fn duplicates_are_the_known_ones() {
    let mut versions: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for Package { name, version, .. } in packages() {
        versions.entry(name).or_default().insert(version);
    }
    versions.retain(|_, versions| versions.len() > 1);
    let found: Vec<&str> = versions.keys().map(String::as_str).collect();
    let known: Vec<&str> = DUPLICATES.iter().map(|(name, _)| *name).collect();
    assert_eq!(
        found, known,
        "{versions:?}; help: use one version, or give the reason in DUPLICATES"
    );
}

/// Name and requirement of every direct dependency.
fn direct() -> BTreeMap<String, String> {
    let manifest: toml::Table =
        fs::read_to_string(format!("{TOP}/Cargo.toml")).unwrap().parse().unwrap();
    let dependencies = manifest["workspace"]["dependencies"].as_table().unwrap();
    let requirement = |(name, wanted): (&String, &toml::Value)| {
        let wanted = wanted.as_str().or_else(|| wanted.get("version")?.as_str())?;
        Some((name.clone(), wanted.to_owned()))
    };
    dependencies.iter().filter_map(requirement).collect()
}

#[test]
fn direct_dependencies_are_pinned() {
    let direct = direct();
    let loose = direct.iter().filter(|(_, wanted)| !wanted.starts_with('='));
    let loose: Vec<&str> = loose.map(|(name, _)| name.as_str()).collect();
    assert_eq!(loose, UNPINNED);
}

#[test]
fn every_direct_dependency_is_documented_with_its_licence() {
    let page = fs::read_to_string(format!("{TOP}/docs/dependencies.md")).unwrap();
    let rows = page.lines().filter_map(|line| {
        let mut cells = line.strip_prefix('|')?.split('|').map(str::trim);
        Some((cells.next()?, cells.next()?, cells.next()?))
    });
    let mut documented: BTreeMap<&str, &str> = BTreeMap::new();
    for (crates, licence, reason) in rows.skip(2) {
        assert!(!reason.is_empty(), "{crates}: no reason");
        documented.extend(crates.split(", ").map(|name| (name, licence)));
    }
    let direct = direct();
    let named: BTreeSet<&str> = documented.keys().copied().collect();
    let used: BTreeSet<&str> = direct.keys().map(String::as_str).chain(VENDORED).collect();
    assert_eq!(named, used, "docs/dependencies.md and Cargo.toml differ");
    for Package { name, licence: actual, .. } in packages() {
        let Some(claimed) = documented.get(name.as_str()) else { continue };
        let claimed = claimed.split(" (").next().unwrap();
        for one in claimed.split('/') {
            assert!(actual.contains(one), "{name}: `{claimed}` documented, `{actual}` found");
        }
    }
}

/// `scripts/package notices` writes them.
#[test]
fn licences_of_every_library_are_in_the_program() {
    let notices = fs::read(format!("{TOP}/services/whichone/notices.gz")).unwrap();
    let mut text = String::new();
    flate2::read::GzDecoder::new(notices.as_slice()).read_to_string(&mut text).unwrap();
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--locked", "--package", "whichone", "--edges", "normal"])
        .args(["--prefix", "none", "--features", "dds,zenoh,tls", "--format", "{p}"])
        .current_dir(TOP)
        .output()
        .unwrap();
    let lines = distinct(&output.stdout);
    let others = lines.iter().filter(|line| !line.contains("(/"));
    let named = others.map(|line| line.replacen(" v", " ", 1).replace(" (proc-macro)", ""));
    let has = |name: &String| text.lines().any(|line| line.split(", ").any(|it| it == name));
    let missing: Vec<String> =
        named.chain(VENDORED.map(str::to_owned)).filter(|name| !has(name)).collect();
    assert!(missing.is_empty(), "{missing:?}; help: scripts/package notices");
}

/// What is released together has one version.
#[test]
fn version_is_the_same_wherever_it_stands() {
    let version = env!("CARGO_PKG_VERSION");
    for (file, line) in [
        ("shared/sdk/python/pyproject.toml", format!("version = \"{version}\"")),
        ("shared/sdk/python/whichone/__init__.py", format!("__version__ = \"{version}\"")),
        ("CITATION.cff", format!("version: {version}")),
        ("README.md", format!("file=whichone-{version}-x86_64-linux.tar.gz")),
        ("README.md", format!("/releases/download/v{version}/")),
        ("CHANGELOG.md", format!("## {version} (")),
    ] {
        let text = fs::read_to_string(format!("{TOP}/{file}")).unwrap();
        assert!(text.contains(&line), "{file}: expected `{line}`");
    }
}

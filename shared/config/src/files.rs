//! The files that settings name: the scene and the robot's description.

use std::fs;
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

use diagnostics::{Diagnostic, Report, Table, TextFile, suggestion};

/// Files that describe the robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotFiles {
    /// Links, joints, limits and shapes.
    pub urdf: TextFile,
    /// Named postures, and links that may touch, if there is such a file.
    pub srdf: Option<TextFile>,
}

/// The files that the settings name; `None` after a problem with one.
#[derive(Clone, Debug)]
pub(crate) struct Files {
    pub(crate) scene: Option<TextFile>,
    pub(crate) robot: Option<RobotFiles>,
}

/// Largest file that a person writes, bytes: a scene of a thousand objects has a tenth of a MiB.
pub(crate) const FILE_BYTES_MAX: u64 = 16 << 20;

/// The robot that needs no files.
const BUILT_IN: &str = "baxter";

impl Files {
    /// Reads the files that `group.scene` and `arm.robot` name, the scene's unless it is given. The
    /// SRDF is next to the URDF.
    pub(crate) fn find(
        dir: &Path,
        tree: &Table,
        given: Option<TextFile>,
        report: &mut Report,
    ) -> Self {
        let scene = Kind { key: ["group", "scene"], folder: "scenes", ending: ".toml", more: None };
        let robot =
            Kind { key: ["arm", "robot"], folder: "robots", ending: ".urdf", more: Some(BUILT_IN) };
        Self {
            scene: given.or_else(|| scene.find(dir, tree, report)?.read(report)),
            robot: robot.find(dir, tree, report).and_then(|path| {
                let Found::File(path) = path else { return Some(RobotFiles::built_in()) };
                let urdf = Found::File(path.clone()).read(report)?;
                let srdf = Found::File(path.with_extension("srdf")).read(report);
                Some(RobotFiles { urdf, srdf })
            }),
        }
    }
}

impl RobotFiles {
    /// The description that ships.
    fn built_in() -> Self {
        let file = |text: &str, ending: &str| TextFile {
            label: format!("built-in {BUILT_IN}.{ending}"),
            text: text.to_owned(),
        };
        Self {
            urdf: file(include_str!("../../../config/robots/baxter.urdf"), "urdf"),
            srdf: Some(file(include_str!("../../../config/robots/baxter.srdf"), "srdf")),
        }
    }
}

/// A kind of file that is named in a setting.
struct Kind {
    key: [&'static str; 2],
    /// The folder of files that are given by name.
    folder: &'static str,
    ending: &'static str,
    /// A name that needs no file.
    more: Option<&'static str>,
}

enum Found {
    File(PathBuf),
    BuiltIn,
}

impl Kind {
    /// Finds the file: a name with the ending is a path from the configuration folder, any other
    /// name a file of the kind's folder.
    fn find(&self, dir: &Path, tree: &Table, report: &mut Report) -> Option<Found> {
        let [section, key] = self.key;
        let node = tree.get(section)?.as_table()?.get(key)?;
        let name = node.as_text().filter(|name| !name.trim().is_empty())?;
        let folder = dir.join(self.folder);
        let path = match name.ends_with(self.ending) {
            true => dir.join(name),
            false => folder.join(format!("{name}{}", self.ending)),
        };
        if path.is_file() {
            return Some(Found::File(path));
        }
        if self.more == Some(name) {
            return Some(Found::BuiltIn);
        }
        let names = names(&folder, self.ending);
        let known = names.iter().map(String::as_str).chain(self.more);
        let what = format!("no {key} `{name}`: there is no {}", path.display());
        let help = suggestion(name, known.clone(), || one_of(known));
        report.add(node.source().diagnostic(&self.key.map(str::to_owned), what, help));
        None
    }
}

impl Found {
    fn read(&self, report: &mut Report) -> Option<TextFile> {
        let Self::File(path) = self else { return None };
        Some(TextFile {
            label: path.display().to_string(),
            text: read_text(path, FILE_BYTES_MAX, report)?,
        })
    }
}

/// Returns help that lists the known values.
pub fn one_of<'a>(known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.collect();
    if known.is_empty() {
        "there is none".to_owned()
    } else {
        format!("use one of {}", known.join(", "))
    }
}

/// Reads a person's text file: a regular one of at most 16 MiB, checked before it is read.
///
/// # Errors
/// It cannot be read; it is too large ([`ErrorKind::FileTooLarge`]), no file, or no text
/// ([`ErrorKind::InvalidData`]).
pub fn read_file(path: &Path) -> io::Result<String> {
    read_bounded(path, FILE_BYTES_MAX)
}

fn read_bounded(path: &Path, bytes_max: u64) -> io::Result<String> {
    let file = safe_files::open_regular(path)?;
    let bytes = file.metadata()?.len();
    if bytes > bytes_max {
        return Err(too_large(bytes, bytes_max));
    }
    let mut text = String::new();
    // It may grow meanwhile.
    let bytes = file.take(bytes_max + 1).read_to_string(&mut text)? as u64;
    if bytes > bytes_max { Err(too_large(bytes, bytes_max)) } else { Ok(text) }
}

fn too_large(bytes: u64, bytes_max: u64) -> io::Error {
    let (found, most) = (bytes.div_ceil(1 << 20), bytes_max >> 20);
    let what = format!("expected at most {most} MiB, found {found} MiB ({bytes} bytes)");
    io::Error::new(ErrorKind::FileTooLarge, what)
}

/// Reads a text file of at most `bytes_max` bytes; an absent one is `None` without a problem.
pub(crate) fn read_text(path: &Path, bytes_max: u64, report: &mut Report) -> Option<String> {
    match read_bounded(path, bytes_max) {
        Ok(text) => Some(text),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => {
            let what = format!("cannot read the file: {error}");
            report.add(Diagnostic::new(path.display().to_string(), "", what, "fix or remove it"));
            None
        }
    }
}

/// Names of the files in a folder with an ending, sorted, without it.
pub(crate) fn names(folder: &Path, ending: &str) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .filter_map(|entry| Some(entry.file_name().to_str()?.strip_suffix(ending)?.to_owned()))
        .collect();
    names.sort();
    names
}

//! Files of the robot that the arm section names.

use std::path::{Path, PathBuf};

use crate::load::read_text;
use crate::named::Named;
use crate::nearest;
use crate::problems::Report;
use crate::text_file::TextFile;

/// Files that describe the robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotFiles {
    /// Links, joints, limits and shapes.
    pub urdf: TextFile,
    /// Named postures, and links that may touch; none where there is no such file.
    pub srdf: Option<TextFile>,
}

/// The robot that needs no files.
const BUILT_IN: &str = "baxter";

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

/// Finds and reads a robot's description: a path that ends with `.urdf` is taken from the
/// configuration folder, anything else is a name in its `robots/`. The SRDF lies beside it.
pub(crate) fn find(dir: &Path, named: &Named<'_>, report: &mut Report) -> Option<RobotFiles> {
    let folder = dir.join("robots");
    let path: PathBuf = match named.name.ends_with(".urdf") {
        true => dir.join(named.name),
        false => folder.join(format!("{}.urdf", named.name)),
    };
    if !path.is_file() {
        if named.name == BUILT_IN {
            return Some(RobotFiles::built_in());
        }
        let names = crate::load::names(&folder, ".urdf");
        let known: Vec<&str> = names.iter().map(String::as_str).chain([BUILT_IN]).collect();
        let what = format!("there is no robot `{}` ({})", named.name, path.display());
        report.add(named.problem(what, nearest::cure(named.name, &known)));
        return None;
    }
    let read = |path: &Path, report: &mut Report| {
        let text = read_text(path, report)?;
        Some(TextFile { label: path.display().to_string(), text })
    };
    let urdf = read(&path, report)?;
    Some(RobotFiles { urdf, srdf: read(&path.with_extension("srdf"), report) })
}

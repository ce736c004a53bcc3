//! The robot that the arm names.

use std::path::{Path, PathBuf};

use manipulation::Robot;
use robot_model::{BAXTER_SRDF, BAXTER_URDF};
use scene::Problem;

use crate::load::read_text;
use crate::named::Named;
use crate::nearest;
use crate::problems::Report;
use crate::text_file::TextFile;

/// The files of a robot's description as they were read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RobotFiles {
    /// Links, joints, limits and shapes.
    pub(crate) urdf: TextFile,
    /// Named postures, and links that may touch; none where there is no such file.
    pub(crate) srdf: Option<TextFile>,
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
        Self { urdf: file(BAXTER_URDF, "urdf"), srdf: Some(file(BAXTER_SRDF, "srdf")) }
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

/// Reads the description. What ships is read once for all.
pub(crate) fn read(files: &RobotFiles, report: &mut Report) -> Option<Robot> {
    let srdf = files.srdf.as_ref().map(|file| file.text.as_str());
    if files.urdf.text == BAXTER_URDF && srdf == Some(BAXTER_SRDF) {
        return Some(Robot::baxter().clone());
    }
    let description = match robot_model::Robot::parse(&files.urdf.text, srdf) {
        Ok(description) => description,
        Err(faults) => {
            for fault in faults.all() {
                let file = match (fault.document, &files.srdf) {
                    (robot_model::Document::Srdf, Some(srdf)) => &srdf.label,
                    _ => &files.urdf.label,
                };
                let place = format!("line {}, {}", fault.line, fault.element);
                report.add(Problem::new(file, place, &fault.problem, &fault.cure));
            }
            return None;
        }
    };
    Robot::from_description(&description)
        .map_err(|error| {
            report.add(Problem::new(&*files.urdf.label, "", error.what, error.cure));
        })
        .ok()
}

//! Expansion of xacro by the program of that name.

use std::path::Path;
use std::process::Command;

use diagnostics::Diagnostic;

/// Returns whether a file is xacro, by its name or its contents.
pub(crate) fn is(file: &Path, text: &str) -> bool {
    if file.extension().is_some_and(|ending| ending == "xacro") {
        return true;
    }
    // Expanded files may name it in comments.
    let mut parts = text.split("<!--");
    let first = parts.next().unwrap_or_default();
    let rest = parts.filter_map(|part| Some(part.split_once("-->")?.1));
    [first].into_iter().chain(rest).any(|part| part.contains("<xacro:"))
}

/// Expands a file.
///
/// # Errors
/// The program is missing, or it reports a problem.
pub(crate) fn expanded(file: &Path) -> Result<String, Diagnostic> {
    let label = file.display().to_string();
    let by_module = ["-m", "xacro"].map(std::ffi::OsString::from);
    let ways = [("xacro", &by_module[..0]), ("python3", &by_module[..])];
    let mut said = None;
    for (program, before) in ways {
        // The first way that starts at all decides, unless it has no such module.
        let Ok(output) = Command::new(program).args(before).arg(file).output() else { continue };
        if output.status.success() {
            return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
        }
        let text = String::from_utf8_lossy(&output.stderr);
        if !text.contains("No module named") {
            said = text.lines().rev().find(|line| !line.trim().is_empty()).map(str::to_owned);
            break;
        }
    }
    Err(match said {
        Some(said) => {
            let help = "correct it, or expand it where its packages are: xacro FILE > robot.urdf";
            Diagnostic::new(label, "", format!("xacro does not expand it: {said}"), help)
        }
        None => {
            let help = "pip install xacro, or expand it elsewhere: xacro FILE > robot.urdf";
            Diagnostic::new(
                label,
                "",
                "expected a URDF, found xacro, and no program that expands it",
                help,
            )
        }
    })
}

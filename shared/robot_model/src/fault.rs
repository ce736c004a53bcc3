//! What is wrong with a description.

use std::fmt;

/// One of the two texts that describe a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Document {
    /// Links and joints.
    Urdf,
    /// Named postures, and links that may touch.
    Srdf,
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Where it was found.
    pub document: Document,
    /// The line, from 1.
    pub line: u32,
    /// What it is about, e.g. `joint "left_s0"`.
    pub element: String,
    /// What is wrong.
    pub problem: String,
    /// What to do about it.
    pub cure: String,
}

/// Everything that is wrong, by line; never empty.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Faults(pub(crate) Vec<Fault>);

impl Faults {
    /// The faults, those of the URDF first.
    pub fn all(&self) -> &[Fault] {
        &self.0
    }

    /// One line per fault, each beginning with the file's name and the line.
    pub fn in_files(&self, urdf: &str, srdf: &str) -> String {
        let lines: Vec<String> = self
            .0
            .iter()
            .map(|fault| {
                let Fault { line, element, problem, cure, .. } = fault;
                let file = match fault.document {
                    Document::Urdf => urdf,
                    Document::Srdf => srdf,
                };
                format!("{file}:{line}: {element}: {problem}; {cure}")
            })
            .collect();
        lines.join("\n")
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.in_files("URDF", "SRDF"))
    }
}

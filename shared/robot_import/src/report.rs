//! Findings of an import that do not stop it.

use serde::Serialize;

/// A sort of finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A part that was found, and by which rule.
    Chosen,
    /// A value that the files lack or state wrongly, and what stands in its place.
    Assumed,
    /// A part of the files without effect.
    Ignored,
    /// A part that the owner has to supply before the real robot moves.
    Missing,
}

/// One finding.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Its sort.
    pub kind: Kind,
    /// Sentence for the owner.
    pub text: String,
}

/// How well the shapes of a link enclose it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// The link.
    pub link: String,
    /// Number of shapes.
    pub shapes: usize,
    /// Greatest distance of the shapes' surface from the link's convex hull, millimetres.
    pub stands_out_mm: f64,
    /// Greatest distance of the link from its shapes, millimetres.
    pub left_out_mm: f64,
    /// Whether nothing but the joints' spacing says how big the link is.
    pub is_guessed: bool,
}

/// Pairs of links that are not checked for collisions.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PairCounts {
    /// Pairs with a link of the arm.
    pub all: usize,
    /// Random postures that were looked at.
    pub postures: usize,
    /// Joined by one joint.
    pub adjacent: usize,
    /// In contact with every joint at zero.
    pub default: usize,
    /// In contact in almost every posture.
    pub always: usize,
    /// Never in contact, nor nearer than 20 mm.
    pub never: usize,
    /// Never in contact, but nearer than 20 mm: checked nevertheless.
    pub near: usize,
    /// Apart, while the shapes that enclose them overlap in most postures.
    pub fat: Vec<(String, String)>,
    /// Share of the sampled pairs that the published SRDF disables as well, where there is one.
    pub precision: Option<f64>,
    /// Share of the SRDF's pairs that sampling finds.
    pub recall: Option<f64>,
}

/// Everything found, for the owner to read.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Findings {
    /// In the order in which they were made.
    pub findings: Vec<Finding>,
    /// One row a link of the arm and the body.
    pub fits: Vec<Fit>,
    /// Collision pairs.
    pub pairs: PairCounts,
    /// Files of meshes that were not found, as they are written.
    pub lost_meshes: Vec<String>,
}

impl Findings {
    pub(crate) fn chosen(&mut self, text: impl Into<String>) {
        self.add(Kind::Chosen, text.into());
    }

    pub(crate) fn assumed(&mut self, text: impl Into<String>) {
        self.add(Kind::Assumed, text.into());
    }

    pub(crate) fn ignored(&mut self, text: impl Into<String>) {
        self.add(Kind::Ignored, text.into());
    }

    pub(crate) fn missing(&mut self, text: impl Into<String>) {
        self.add(Kind::Missing, text.into());
    }

    fn add(&mut self, kind: Kind, text: String) {
        let finding = Finding { kind, text };
        if !self.findings.contains(&finding) {
            self.findings.push(finding);
        }
    }

    /// Findings of one sort.
    pub fn of(&self, kind: Kind) -> impl Iterator<Item = &str> {
        self.findings.iter().filter(move |it| it.kind == kind).map(|it| it.text.as_str())
    }
}

//! A file that a setting names.

use scene::Problem;
use toml::Value;

use crate::layer::{Node, Source, Table};

/// The name and where it was written.
pub(crate) struct Named<'a> {
    pub(crate) name: &'a str,
    key: [&'static str; 2],
    source: &'a Source,
}

impl<'a> Named<'a> {
    /// The text at a section's key; `None` where there is none, which has been reported.
    pub(crate) fn find(tree: &'a Table, key: [&'static str; 2]) -> Option<Self> {
        let Node::Table(section) = tree.get(key[0])? else { return None };
        let node = section.get(key[1])?;
        let Node::Leaf(Value::String(name), source) = node else { return None };
        (!name.trim().is_empty()).then_some(Self { name, key, source })
    }

    /// Something that is wrong with what is named.
    pub(crate) fn problem(&self, what: String, cure: String) -> Problem {
        self.source.problem(&self.key.map(str::to_owned), what, cure)
    }
}

//! A text file that settings name.

/// A file as it was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TextFile {
    /// The file, as people know it.
    pub(crate) label: String,
    pub(crate) text: String,
}

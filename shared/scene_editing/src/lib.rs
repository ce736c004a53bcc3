//! Editing of scene files for programs: the console's editor and `whichone scene`.
//!
//! A scene file is edited as its author wrote it: comments, layout and the form of numbers stay
//! wherever nothing else is wanted. Editors see it as a [`Document`]; [`SceneEdit`] applies a
//! changed one. [`ScenesFolder`] keeps the files of a configuration, [`check`] finds every problem
//! at once as `whichone scene check` does, and [`Reach`] gives the places within the arm's reach.
//!
//! | contents | file |
//! |---|---|
//! | a scene as an editor sees it | `document.rs` |
//! | a scene file while it is edited | `edit.rs` |
//! | single keys and lists of a file, with their comments | `keys.rs`, `lists.rs` |
//! | a new scene file | `template.rs` |
//! | scene files of a configuration | `folder.rs` |
//! | problems, and where the arm reaches | `examine.rs` |
//! | objects and words that a person cannot name clearly | `ambiguity.rs` |

mod ambiguity;
mod document;
mod edit;
mod examine;
mod folder;
mod keys;
mod lists;
mod template;

pub use document::{AttributeEntry, Document, ObjectEntry, ValueEntry};
pub use edit::SceneEdit;
pub use examine::{
    Configuration, Findings, LimbSummary, Problem, Reach, ReadBack, RobotSummary, check,
    misunderstood,
};
pub use folder::{FileError, ScenesFolder, fingerprint};
pub use template::{new_scene, schema_line};

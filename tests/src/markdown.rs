//! The documents as tests read them: blocks of code, commands in the text, links and headings.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The repository.
pub const TOP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// A document.
#[derive(Clone, Debug)]
pub struct Page {
    /// Its path, from the repository's top.
    pub path: PathBuf,
    /// Its contents.
    pub text: String,
}

/// A block of code between fences.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// Number of the opening fence's line, from 1.
    pub line: usize,
    /// What the opening fence says: the language, and marks after it.
    pub info: String,
    /// The lines between the fences.
    pub text: String,
}

/// Returns the documents: those of the top level, and all of `docs/`.
///
/// # Panics
/// If one cannot be read.
pub fn pages() -> Vec<Page> {
    let mut pages = Vec::new();
    for folder in ["", "docs"] {
        let entries = std::fs::read_dir(Path::new(TOP).join(folder)).expect("the repository");
        for entry in entries {
            let name = PathBuf::from(entry.expect("an entry").file_name());
            if name.extension().is_some_and(|extension| extension == "md") {
                pages.push(page(&Path::new(folder).join(name)));
            }
        }
    }
    pages.sort_by(|a, b| a.path.cmp(&b.path));
    assert!(pages.len() > 20, "{pages:?}");
    pages
}

/// Returns one document.
///
/// # Panics
/// If it cannot be read.
pub fn page(path: &Path) -> Page {
    let text = std::fs::read_to_string(Path::new(TOP).join(path));
    let text = text.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    Page { path: path.to_owned(), text }
}

impl Page {
    /// Returns the blocks of code.
    pub fn blocks(&self) -> Vec<Block> {
        let mut blocks: Vec<Block> = Vec::new();
        let mut is_open = false;
        for (number, line) in self.text.lines().enumerate() {
            let fence = line.trim_start().strip_prefix("```");
            match (fence, is_open) {
                (Some(info), false) => {
                    let info = info.trim().to_owned();
                    blocks.push(Block { line: number + 1, info, text: String::new() });
                    is_open = true;
                }
                (Some(_), true) => is_open = false,
                (None, true) => {
                    let block = blocks.last_mut().expect("an open block");
                    block.text += line;
                    block.text.push('\n');
                }
                (None, false) => {}
            }
        }
        assert!(!is_open, "{}: the last block does not end", self.path.display());
        blocks
    }

    /// Returns the lines outside of blocks with their numbers, from 1.
    pub fn prose(&self) -> Vec<(usize, &str)> {
        let mut is_open = false;
        let lines = self.text.lines().enumerate().filter(|(_, line)| {
            let is_fence = line.trim_start().starts_with("```");
            is_open ^= is_fence;
            !is_open && !is_fence
        });
        lines.map(|(number, line)| (number + 1, line)).collect()
    }

    /// Returns the pieces of code within the text, with the numbers of their lines.
    pub fn spans(&self) -> Vec<(usize, &str)> {
        let mut found = Vec::new();
        for (number, line) in self.prose() {
            // Odd parts stand between backquotes.
            found.extend(line.split('`').skip(1).step_by(2).map(|span| (number, span)));
        }
        found
    }

    /// Returns the targets of links and pictures, with the numbers of their lines.
    pub fn links(&self) -> Vec<(usize, String)> {
        let mut found = Vec::new();
        for (number, line) in self.prose() {
            let text = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
            let targets = text.split("](").skip(1);
            found.extend(targets.filter_map(|rest| {
                let (target, _) = rest.split_once(')')?;
                Some((number, target.split(' ').next()?.to_owned()))
            }));
        }
        found
    }

    /// Returns the anchors of the headings, as forges and mdBook make them.
    pub fn anchors(&self) -> BTreeSet<String> {
        let mut anchors = BTreeSet::new();
        for (_, line) in self.prose() {
            let heading = line.trim_start_matches('#');
            if heading.len() == line.len() || !heading.starts_with(' ') {
                continue;
            }
            let anchor = anchor(heading.trim());
            let mut numbered = anchor.clone();
            for number in 1.. {
                if anchors.insert(numbered) {
                    break;
                }
                numbered = format!("{anchor}-{number}");
            }
        }
        anchors
    }
}

/// The anchor of a heading: lower case, words joined by hyphens, other signs left out.
fn anchor(heading: &str) -> String {
    let signs = heading.chars().filter_map(|c| match c {
        ' ' => Some('-'),
        '-' | '_' => Some(c),
        _ if c.is_alphanumeric() => Some(c),
        _ => None,
    });
    signs.flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Page {
        Page { path: PathBuf::from("a.md"), text: text.to_owned() }
    }

    #[test]
    fn blocks_spans_and_links_are_found_where_they_stand() {
        let page = of("see [a](b.md#c) and `[x](y)`\n```sh norun why\nls `no`\n```\n`code`\n");
        let block = Block { line: 2, info: "sh norun why".into(), text: "ls `no`\n".into() };
        assert_eq!(page.blocks(), [block]);
        assert_eq!(page.links(), [(1, "b.md#c".to_owned())]);
        assert_eq!(page.spans(), [(1, "[x](y)"), (5, "code")]);
    }

    #[test]
    fn anchors_are_those_of_forges() {
        let page = of("# Supervisor, and `more`\n## A_b\n## A_b\n#no\n");
        assert_eq!(
            page.anchors().into_iter().collect::<Vec<_>>(),
            ["a_b", "a_b-1", "supervisor-and-more"]
        );
    }
}

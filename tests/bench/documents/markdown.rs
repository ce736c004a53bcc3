//! Tables of a Markdown document, and the command that prints each.

/// Programs whose commands print figures.
const PROGRAMS: [&str; 5] = ["scripts/", "whichone ", "cargo ", "node ", "echo "];

/// A table of a document.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Table {
    /// The command in the nearest paragraph above it, in the same section.
    pub(super) source: Option<Source>,
    /// Line of its heads, from 1.
    pub(super) line: usize,
    pub(super) heads: Vec<String>,
    /// Cells of its rows, one row a line.
    pub(super) rows: Vec<Vec<String>>,
}

/// What prints a table: `` `scripts/bench --core`, "Exact values" ``.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Source {
    /// As it is typed.
    pub(super) command: String,
    /// Title of a table of the report; none for its single figures.
    pub(super) title: Option<String>,
}

impl Table {
    /// Line of a row, from 1.
    pub(super) fn line_of(&self, row: usize) -> usize {
        self.line + 2 + row
    }
}

/// Returns the tables of a document in their order.
pub(super) fn tables(text: &str) -> Vec<Table> {
    let (mut tables, mut source, mut paragraph) = (Vec::<Table>::new(), None, String::new());
    let mut is_inside = false;
    for (n, line) in text.lines().enumerate() {
        let is_row = line.starts_with('|');
        if is_row && !is_inside {
            tables.push(Table {
                source: source.clone(),
                line: n + 1,
                heads: cells(line),
                ..Table::default()
            });
        } else if let (true, Some(table)) = (is_row, tables.last_mut())
            && n > table.line
        {
            table.rows.push(cells(line));
        }
        is_inside = is_row;
        if is_row || line.is_empty() {
            paragraph.clear();
        } else if line.starts_with('#') {
            (paragraph, source) = (String::new(), None);
        } else {
            paragraph += line;
            paragraph.push(' ');
            source = command(&paragraph).or(source);
        }
    }
    tables
}

/// Returns the cells of a row.
fn cells(line: &str) -> Vec<String> {
    let line = line.trim_end();
    let inner = line.strip_prefix('|').unwrap_or(line);
    let inner = inner.strip_suffix('|').unwrap_or(inner);
    inner.split('|').map(|cell| cell.trim().to_owned()).collect()
}

/// Returns a row of these cells.
pub(super) fn row(cells: &[String]) -> String {
    format!("| {} |", cells.join(" | "))
}

/// Returns a name without its emphasis.
pub(super) fn plain(name: &str) -> String {
    name.replace(['`', '*'], "")
}

/// Returns the first command of a paragraph, with the title behind it.
fn command(paragraph: &str) -> Option<Source> {
    let pieces: Vec<&str> = paragraph.split('`').collect();
    let codes = pieces.chunks(2).filter_map(|pair| <[&str; 2]>::try_from(pair).ok());
    let after = pieces.iter().skip(2).step_by(2);
    codes.zip(after).find_map(|([_, code], after)| {
        let mut words = code.split_inclusive(' ').skip_while(|word| word.contains('='));
        let program: String = words.next()?.to_owned() + words.next().unwrap_or_default();
        let is_command = PROGRAMS.iter().any(|start| program.starts_with(start));
        let title = after.strip_prefix(", \"").and_then(|rest| rest.split_once('"'));
        let title = title.map(|(title, _)| title.to_owned());
        is_command.then(|| Source { command: code.to_owned(), title })
    })
}

//! Optional parts of the group, each of which registers its sections of the configuration and its
//! service. Drivers of the arm register theirs likewise ([`Driver`]).
//!
//! A program that loads configurations names its parts ([`register`]). Others read sections of
//! snapshots on request ([`Settings::part`](crate::Settings::part)).

use std::sync::OnceLock;

use diagnostics::{Diagnostics, Fields, Node, Report, Source, Table};
use scene::Scene;

use crate::driver::{self, Driver};
use crate::resolved::{self, CORE, CORE_DEFAULTS};
use crate::{Arm, Group};

/// A section of the configuration for an optional part: its place, its reader and its checks.
pub trait Section: Sized + 'static {
    /// Place of the table: `["ros2"]` for an own file, `["arm", "ros1"]` in another section's.
    const KEY: &'static [&'static str];
    /// The shipped text of its own file, with defaults; `None` for a table in another section's.
    const FILE: Option<&'static str> = None;

    /// Reads the section's values.
    fn read(f: &mut Fields<'_>) -> Self;

    /// Reports contradictions with other sections.
    fn check(&self, _others: &mut Check<'_>) {}
}

/// The other sections, as far as a part's section may depend on them.
#[derive(Debug)]
pub struct Check<'a> {
    /// The services, and the source of objects.
    pub group: &'a Group,
    /// The arm.
    pub arm: &'a Arm,
    /// The scene; `None` if it is wrong.
    pub scene: Option<&'a Scene>,
    pub(crate) tree: &'a Table,
    pub(crate) report: &'a mut Report,
}

impl Check<'_> {
    /// Reports a problem at a key, located in the file that its value came from.
    pub fn problem(&mut self, key: &[&str], what: &str, help: &str) {
        let path: Vec<String> = key.iter().map(|part| (*part).to_owned()).collect();
        self.report.add(self.tree.source_of(key).diagnostic(&path, what, help));
    }

    /// Reports a problem with the value at `inner` of an item of the list at a key.
    pub fn problem_in(
        &mut self,
        key: &[&str],
        (item, inner): (usize, &str),
        what: &str,
        help: &str,
    ) {
        let mut path: Vec<String> = key.iter().map(|part| (*part).to_owned()).collect();
        path.iter_mut().last().into_iter().for_each(|list| list.push_str(&format!("[{item}]")));
        path.push(inner.to_owned());
        self.report.add(self.tree.source_of(key).diagnostic(&path, what, help));
    }
}

/// An optional part of the group.
#[derive(Debug)]
pub struct Part {
    /// Name of the part, and of its service and the program `whichone-NAME`, if it has them.
    pub name: &'static str,
    /// The part's service, if it is one.
    pub service: Option<PartService>,
    /// Sections of the part's configuration.
    pub sections: &'static [Registered],
}

/// A service that ships and that a group can do without.
#[derive(Debug)]
pub struct PartService {
    /// Values whose change restarts the service.
    pub reads: Reads,
    /// Whether the part hands on words and orders of people, and may write the topics of clients.
    pub is_client: bool,
}

/// Names of sections, dotted keys of values, `durations`; or [`EVERYTHING`]. The scene and the
/// source of its objects, which every service reads, are implied.
pub type Reads = &'static [&'static str];

/// Every section, and the durations.
pub const EVERYTHING: Reads = &["*", DURATIONS];

/// The durations of questions and picks, by which decisions are made.
pub(crate) const DURATIONS: &str = "durations";

/// A [`Section`] in the list of a part or driver.
#[derive(Debug)]
pub struct Registered {
    pub(crate) key: &'static [&'static str],
    pub(crate) file: Option<&'static str>,
    read: fn(&mut Fields<'_>),
    check: fn(&mut Check<'_>),
}

impl Registered {
    /// Registers a section.
    pub const fn of<S: Section>() -> Self {
        Self { key: S::KEY, file: S::FILE, read: |f| drop(S::read(f)), check: check_one::<S> }
    }

    /// Name in the table that holds it.
    fn name(&self) -> &'static str {
        self.key.last().copied().unwrap_or_default()
    }
}

static PARTS: OnceLock<&'static [&'static Part]> = OnceLock::new();

/// Names the optional parts whose sections and services configurations may have, and the further
/// drivers of the arm, once and before the first is loaded. Later calls change nothing.
pub fn register(
    parts: &'static [&'static Part],
    drivers: impl IntoIterator<Item = &'static Driver>,
) {
    driver::register(drivers);
    PARTS.get_or_init(|| parts);
}

fn parts() -> impl Iterator<Item = &'static Part> {
    PARTS.get().copied().unwrap_or_default().iter().copied()
}

fn registered() -> impl Iterator<Item = &'static Registered> {
    driver::sections().chain(parts().flat_map(|part| part.sections))
}

/// Name and shipped file of every section: the core's, then those of the registered parts. The name
/// is the first part of its keys, and that of its file `NAME.toml`.
pub fn sections() -> impl Iterator<Item = (&'static str, &'static str)> {
    let of_parts = registered().filter_map(|it| Some((*it.key.first()?, it.file?)));
    CORE.into_iter().chain(of_parts)
}

/// The defaults of every section: the bottom layer.
pub(crate) fn defaults() -> Table {
    resolved::parsed(sections(), &Source::built_in())
}

/// The service of a registered part with this name.
pub fn part_service(name: &str) -> Option<&'static PartService> {
    parts().find(|part| part.name == name)?.service.as_ref()
}

/// Returns whether a service may lack a command. Snapshots, without parts, were checked before.
pub(crate) fn has_program(name: &str) -> bool {
    PARTS.get().is_none() || part_service(name).is_some()
}

/// Reads a section and the tables of parts in it. A program without parts does not know the other
/// tables of the shipped file.
pub(crate) fn with_tables<T>(
    section: &str,
    f: &mut Fields<'_>,
    read: impl FnOnce(&mut Fields<'_>) -> T,
) -> T {
    let value = read(f);
    let own = registered().filter(|it| it.key.len() > 1 && it.key[0] == section);
    own.for_each(|it| f.table(it.name(), it.read));
    if PARTS.get().is_some() {
        return value;
    }
    let shipped = CORE_DEFAULTS.get(section).and_then(Node::as_table);
    let tables = shipped.into_iter().flat_map(|table| &table.entries);
    let tables = tables.filter(|(_, node)| node.as_table().is_some());
    tables.for_each(|(name, _)| f.allow(&[name]));
    value
}

/// Reads the sections of parts that have files of their own. The snapshot that a program without
/// parts is given was checked by one that knows them.
pub(crate) fn read_sections(f: &mut Fields<'_>, is_snapshot: bool) {
    own_files().for_each(|it| f.table(it.name(), |f| with_tables(it.name(), f, it.read)));
    if is_snapshot && PARTS.get().is_none() {
        let names = f.names();
        f.allow(&names);
    }
}

/// Reads the contents of a part's section that has a file of its own.
pub(crate) fn read_contents(name: &str, f: &mut Fields<'_>) {
    own_files().filter(|it| it.name() == name).for_each(|it| (it.read)(f));
}

fn own_files() -> impl Iterator<Item = &'static Registered> {
    registered().filter(|it| it.key.len() == 1)
}

/// Checks the sections of parts against the others.
pub(crate) fn check(others: &mut Check<'_>) {
    registered().for_each(|it| (it.check)(others));
}

/// Reads a section from the merged layers, or its defaults if they do not have it.
pub(crate) fn read<S: Section>(tree: &Table) -> Result<S, Diagnostics> {
    let mut report = Report::default();
    let own = S::FILE.filter(|_| tree.get(S::KEY[0]).is_none());
    let own =
        own.map(|file| resolved::parsed([(S::KEY[0], file)].into_iter(), &Source::built_in()));
    let value = read_at(own.as_ref().unwrap_or(tree), &mut report);
    report.verdict(value)
}

/// Reads a section below the root of the merged layers; `None` if its parent is not a table.
fn read_at<S: Section>(tree: &Table, report: &mut Report) -> Option<S> {
    let (own, above) = S::KEY.split_last()?;
    let mut table = tree;
    for key in above {
        table = table.get(key)?.as_table()?;
    }
    let path = above.iter().map(|key| (*key).to_owned()).collect();
    Some(Fields::new(table, path, report).table(own, S::read))
}

fn check_one<S: Section>(others: &mut Check<'_>) {
    let value = read_at::<S>(others.tree, &mut Report::default());
    value.iter().for_each(|value| value.check(others));
}

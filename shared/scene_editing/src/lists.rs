//! Lists of a file: attributes, values and objects, each entry with the comments that belong to it.

use std::mem;

use toml_edit::{Array, ArrayOfTables, InlineTable, Item, Table, TableLike, Value};

use crate::keys::arranged;

/// An entry that may be of the file that is edited.
pub(crate) trait Entry {
    /// Returns the entry's position in the file.
    fn from(&self) -> Option<usize>;
    /// Writes its keys into a table that has those of the file, or none.
    fn write(&self, table: &mut dyn TableLike);
    /// Returns it as a value that needs no table, if it can be one.
    fn plain(&self) -> Option<Value>;
}

/// Replaces the list at `key` by entries. Returns the comments of removed entries that belong to no
/// single entry, if no entry follows that could keep them.
pub(crate) fn set_entries<T: Entry>(
    parent: &mut dyn TableLike,
    key: &str,
    entries: &[T],
    is_inline: bool,
) -> String {
    let item = match parent.get_mut(key) {
        Some(item) => item,
        None if entries.is_empty() => return String::new(),
        None => {
            let list = match is_inline {
                true => Item::Value(Array::new().into()),
                false => Item::ArrayOfTables(ArrayOfTables::new()),
            };
            parent.insert(key, list);
            let Some(item) = parent.get_mut(key) else { return String::new() };
            item
        }
    };
    match item {
        Item::Value(Value::Array(array)) => {
            set_values(array, entries);
            String::new()
        }
        Item::ArrayOfTables(tables) => set_tables(tables, entries),
        // It was read as a list before.
        _ => String::new(),
    }
}

fn set_values<T: Entry>(array: &mut Array, entries: &[T]) {
    let old: Vec<Value> = array.iter().cloned().collect();
    let is_same_order = entries.len() == old.len()
        && entries.iter().enumerate().all(|(n, entry)| entry.from() == Some(n));
    let value = |entry: &T| {
        let known = entry.from().and_then(|n| old.get(n));
        value_of(entry, known)
    };
    if is_same_order {
        for (n, entry) in entries.iter().enumerate() {
            if let Some(slot) = array.get_mut(n) {
                *slot = value(entry);
            }
        }
        return;
    }
    let decor = array.decor().clone();
    *array = arranged(Some(array), entries.iter().map(value));
    *array.decor_mut() = decor;
}

/// The value of an entry; `known` is that of the file.
fn value_of(entry: &impl Entry, known: Option<&Value>) -> Value {
    let mut value = match (entry.plain(), known) {
        (_, Some(Value::InlineTable(table))) => {
            let mut table = table.clone();
            let keys = table.len();
            entry.write(&mut table);
            if table.len() != keys {
                table.fmt();
            }
            Value::InlineTable(table)
        }
        (Some(plain), Some(known)) if plain.as_str() == known.as_str() => known.clone(),
        (Some(plain), _) => plain,
        (None, _) => {
            let mut table = InlineTable::new();
            entry.write(&mut table);
            table.fmt();
            Value::InlineTable(table)
        }
    };
    if let Some(known) = known {
        *value.decor_mut() = known.decor().clone();
    }
    value
}

fn set_tables<T: Entry>(tables: &mut ArrayOfTables, entries: &[T]) -> String {
    let is_same_order = entries.len() == tables.len()
        && entries.iter().enumerate().all(|(n, entry)| entry.from() == Some(n));
    if is_same_order {
        for (table, entry) in tables.iter_mut().zip(entries) {
            entry.write(table);
        }
        return String::new();
    }
    let old = mem::take(tables);
    let position = old.iter().find_map(Table::position);
    let is_kept = |n: usize| entries.iter().any(|entry| entry.from() == Some(n));
    // Comments before a removed entry that belong to no single one go to the next that stays.
    let mut loose = String::new();
    let mut before: Vec<String> = Vec::new();
    for (n, table) in old.iter().enumerate() {
        let prefix = prefix(table);
        if is_kept(n) {
            before.push(mem::take(&mut loose) + &prefix);
        } else {
            loose += split(&prefix).0;
            before.push(String::new());
        }
    }
    for entry in entries {
        let known = entry.from().and_then(|n| Some((n, old.get(n)?)));
        let mut table = match known {
            Some((n, table)) => {
                let mut table = table.clone();
                table.decor_mut().set_prefix(before[n].as_str());
                table
            }
            None => {
                let mut table = Table::new();
                table.decor_mut().set_prefix(mem::take(&mut loose) + "\n");
                table
            }
        };
        place(&mut table, position);
        entry.write(&mut table);
        tables.push(table);
    }
    loose
}

fn prefix(table: &Table) -> String {
    let prefix = table.decor().prefix().and_then(|prefix| prefix.as_str());
    prefix.unwrap_or_default().to_owned()
}

/// Divides the text before a table at its last empty line: comments before belong to no entry.
fn split(prefix: &str) -> (&str, &str) {
    let at = prefix.rfind("\n\n").map_or(0, |at| at + 1);
    match prefix[..at].trim().is_empty() {
        true => ("", prefix),
        false => prefix.split_at(at),
    }
}

/// Puts a table and those in it at one position, so that they follow the order of their list.
fn place(table: &mut Table, position: Option<isize>) {
    table.set_position(position);
    for (_, item) in table.iter_mut() {
        match item {
            Item::Table(inner) => place(inner, position),
            Item::ArrayOfTables(inner) => inner.iter_mut().for_each(|table| place(table, position)),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_before_an_empty_line_belong_to_no_single_entry() {
        assert_eq!(split("\n# all\n# of them\n\n"), ("\n# all\n# of them\n", "\n"));
        assert_eq!(split("\n# all\n\n# this\n"), ("\n# all\n", "\n# this\n"));
        for attached in ["", "\n", "\n# this\n", "\n\n\n# this\n"] {
            assert_eq!(split(attached), ("", attached));
        }
    }
}

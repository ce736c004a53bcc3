//! Single keys of a table. A key with the wanted value stays as it is written; a replaced one keeps
//! the comments around it.

use std::collections::BTreeMap;

use toml_edit::{Array, InlineTable, Item, TableLike, Value};

use crate::document::number_of;

/// Sets the value of a key, or removes the key.
fn set(table: &mut dyn TableLike, key: &str, new: Option<Value>) {
    match (table.get_mut(key), new) {
        (Some(item), Some(mut value)) => {
            if let Some(old) = item.as_value() {
                *value.decor_mut() = old.decor().clone();
            }
            *item = Item::Value(value);
        }
        (None, Some(value)) => {
            table.insert(key, Item::Value(value));
        }
        (Some(_), None) => {
            table.remove(key);
        }
        (None, None) => {}
    }
}

pub(crate) fn set_text(table: &mut dyn TableLike, key: &str, text: Option<&str>) {
    if table.get(key).and_then(Item::as_str) != text {
        set(table, key, text.map(Value::from));
    }
}

pub(crate) fn set_number(table: &mut dyn TableLike, key: &str, number: Option<f64>) {
    if table.get(key).and_then(Item::as_value).and_then(number_of) != number {
        set(table, key, number.map(Value::from));
    }
}

/// Sets three numbers; each of them that stays keeps its form.
pub(crate) fn set_triple(table: &mut dyn TableLike, key: &str, numbers: Option<[f64; 3]>) {
    let written = table.get_mut(key).and_then(Item::as_array_mut).filter(|array| array.len() == 3);
    match (written, numbers) {
        (Some(array), Some(numbers)) => {
            for (old, new) in array.iter_mut().zip(numbers) {
                if number_of(old) != Some(new) {
                    let decor = old.decor().clone();
                    *old = Value::from(new);
                    *old.decor_mut() = decor;
                }
            }
        }
        (_, numbers) => set(table, key, numbers.map(|numbers| Array::from_iter(numbers).into())),
    }
}

/// Sets a list of texts. With `is_one_or_more`, a single one is a text, and none leaves no key.
pub(crate) fn set_texts(
    table: &mut dyn TableLike,
    key: &str,
    texts: &[String],
    is_one_or_more: bool,
) {
    if is_one_or_more
        && let [one] = texts
        && table.get(key).is_none_or(|item| item.as_array().is_none())
    {
        return set_text(table, key, Some(one));
    }
    let old = table.get(key).and_then(Item::as_array);
    let is_same = old.is_some_and(|old| {
        old.iter().map(Value::as_str).eq(texts.iter().map(|text| Some(text.as_str())))
    });
    if is_same || (old.is_none() && texts.is_empty() && table.get(key).is_none()) {
        return;
    }
    let new = (!texts.is_empty()).then(|| {
        let find = |text: &String| old?.iter().find(|value| value.as_str() == Some(text)).cloned();
        let values = texts.iter().map(|text| find(text).unwrap_or_else(|| Value::from(text)));
        arranged(old, values).into()
    });
    set(table, key, new);
}

/// Makes an array laid out as `old`: on several lines if `old` was, with its comments.
pub(crate) fn arranged(old: Option<&Array>, values: impl Iterator<Item = Value>) -> Array {
    let prefix = |value: &Value| value.decor().prefix()?.as_str().map(str::to_owned);
    let is_broken = |prefix: &String| prefix.contains('\n');
    let indent = old.and_then(|old| old.iter().find_map(|value| prefix(value).filter(is_broken)));
    // Without the comment that its first value may have.
    let indent = indent.map(|text| format!("\n{}", text.rsplit('\n').next().unwrap_or_default()));
    let mut array = Array::new();
    for (n, mut value) in values.enumerate() {
        let stays = prefix(&value).is_some_and(|prefix| is_broken(&prefix));
        let suffix = value.decor().suffix().and_then(|suffix| suffix.as_str()).unwrap_or_default();
        let suffix = if suffix.contains('#') { suffix.to_owned() } else { String::new() };
        match &indent {
            Some(indent) if !stays => value.decor_mut().set_prefix(indent.as_str()),
            Some(_) => {}
            None => value.decor_mut().set_prefix(if n == 0 { "" } else { " " }),
        }
        value.decor_mut().set_suffix(suffix);
        array.push_formatted(value);
    }
    if let Some(old) = old {
        let trailing = old.trailing().as_str().unwrap_or_default().to_owned();
        array.set_trailing(trailing);
        array.set_trailing_comma(indent.is_some());
    }
    array
}

/// Sets the texts of a table by their keys; new ones come in the order of `order`.
pub(crate) fn set_map(
    table: &mut dyn TableLike,
    key: &str,
    map: &BTreeMap<String, String>,
    order: &[&str],
) {
    if table.get(key).is_none() {
        if map.is_empty() {
            return;
        }
        table.insert(key, Item::Value(InlineTable::new().into()));
    }
    let Some(item) = table.get_mut(key) else { return };
    let Some(inner) = item.as_table_like_mut() else { return };
    let known: Vec<String> = inner.iter().map(|(name, _)| name.to_owned()).collect();
    known.iter().filter(|name| !map.contains_key(*name)).for_each(|name| {
        inner.remove(name);
    });
    let others = map.keys().map(String::as_str).filter(|name| !order.contains(name));
    for name in order.iter().copied().chain(others) {
        if let Some(text) = map.get(name) {
            set_text(inner, name, Some(text));
        }
    }
    let is_changed = known.len() != map.len() || known.iter().any(|name| !map.contains_key(name));
    // Spaces between the pairs; an inline table has no comments.
    if is_changed && let Some(inline) = item.as_inline_table_mut() {
        inline.fmt();
    }
}

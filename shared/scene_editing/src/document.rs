//! A scene as an editor sees it: the keys of its file, nothing computed.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use toml_edit::{Item, TableLike, Value};

/// A scene. Keys missing in the file are `None`, or empty.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Document {
    /// Name of the scene.
    pub name: String,
    /// Name of an object if nothing distinguishes it.
    pub noun: String,
    /// Wordings of the first prompt.
    #[serde(default)]
    pub ask_wanted: Vec<String>,
    /// Wordings while the arm points at an object.
    #[serde(default)]
    pub ask_point: Vec<String>,
    /// Attributes in their order.
    pub attributes: Vec<AttributeEntry>,
    /// Objects in their order.
    pub objects: Vec<ObjectEntry>,
}

/// An attribute.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AttributeEntry {
    /// Position in the edited file; `None` for a new attribute.
    #[serde(default)]
    pub from: Option<usize>,
    /// Name of the attribute.
    pub name: String,
    /// Other words for the attribute.
    #[serde(default)]
    pub synonyms: Vec<String>,
    /// Wordings of yes/no questions.
    #[serde(default)]
    pub ask_yes_no: Vec<String>,
    /// Wordings of the open question.
    #[serde(default)]
    pub ask_which: Vec<String>,
    /// Role of its values in a sentence.
    #[serde(default)]
    pub role: Option<String>,
    /// Values in their order.
    pub values: Vec<ValueEntry>,
}

/// A value of an attribute.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ValueEntry {
    /// Position in the attribute's list in the file; `None` for a new value.
    #[serde(default)]
    pub from: Option<usize>,
    /// Name of the value, and a word that people say.
    pub name: String,
    /// Other words and phrases for the value.
    #[serde(default)]
    pub synonyms: Vec<String>,
    /// Name of the value in questions.
    #[serde(default)]
    pub spoken: Option<String>,
    /// Role of the value in a sentence.
    #[serde(default)]
    pub role: Option<String>,
}

impl ValueEntry {
    /// Returns whether a file has it as a string.
    pub(crate) fn is_plain(&self) -> bool {
        self.synonyms.is_empty() && self.spoken.is_none() && self.role.is_none()
    }
}

/// An object. Lengths are metres in frame `base`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectEntry {
    /// Position in the edited file; `None` for a new object.
    #[serde(default)]
    pub from: Option<usize>,
    /// Name of the object.
    pub name: String,
    /// Value by attribute.
    #[serde(default)]
    pub attributes: BTreeMap<String, String>,
    /// Centre, metres.
    #[serde(default)]
    pub xyz: Option<[f64; 3]>,
    /// Rotation about the vertical, radians.
    #[serde(default)]
    pub yaw: Option<f64>,
    /// Extents along the object's own axes, metres.
    #[serde(default)]
    pub size: Option<[f64; 3]>,
    /// Width that the fingers close on, metres.
    #[serde(default)]
    pub grasp_width: Option<f64>,
    /// Mass, kg.
    #[serde(default)]
    pub mass_kg: Option<f64>,
    /// `solid` or `hollow`.
    #[serde(default)]
    pub form: Option<String>,
    /// Slope of a bowl's wall, degrees.
    #[serde(default)]
    pub wall_deg: Option<f64>,
}

/// A key that is not of the type that scene files have there.
pub(crate) struct WrongType;

type Read<T> = Result<T, WrongType>;

impl Document {
    /// Reads a file's table; keys that scene files do not have are left alone.
    pub(crate) fn read(root: &dyn TableLike) -> Read<Self> {
        let attributes = tables(root, "attributes")?.into_iter().enumerate();
        let objects = tables(root, "objects")?.into_iter().enumerate();
        Ok(Self {
            name: text(root, "name")?.unwrap_or_default(),
            noun: text(root, "noun")?.unwrap_or_default(),
            ask_wanted: texts(root, "ask_wanted")?,
            ask_point: texts(root, "ask_point")?,
            attributes: attributes.map(|(n, table)| attribute(n, table)).collect::<Read<_>>()?,
            objects: objects.map(|(n, table)| object(n, table)).collect::<Read<_>>()?,
        })
    }

    /// Returns it as it would be read after it was written: every entry at its own position.
    pub(crate) fn renumbered(&self) -> Self {
        let mut all = self.clone();
        for (n, attribute) in all.attributes.iter_mut().enumerate() {
            attribute.from = Some(n);
            attribute.values.iter_mut().enumerate().for_each(|(k, value)| value.from = Some(k));
        }
        all.objects.iter_mut().enumerate().for_each(|(n, object)| object.from = Some(n));
        all
    }
}

fn attribute(n: usize, table: &dyn TableLike) -> Read<AttributeEntry> {
    Ok(AttributeEntry {
        from: Some(n),
        name: text(table, "name")?.unwrap_or_default(),
        synonyms: list(table, "synonyms")?,
        ask_yes_no: texts(table, "ask_yes_no")?,
        ask_which: texts(table, "ask_which")?,
        role: text(table, "role")?,
        values: values(table)?,
    })
}

fn values(table: &dyn TableLike) -> Read<Vec<ValueEntry>> {
    let of_table = |n: usize, table: &dyn TableLike| -> Read<ValueEntry> {
        Ok(ValueEntry {
            from: Some(n),
            name: text(table, "name")?.unwrap_or_default(),
            synonyms: list(table, "synonyms")?,
            spoken: text(table, "spoken")?,
            role: text(table, "role")?,
        })
    };
    let of_value = |n: usize, value: &Value| match value {
        Value::String(name) => {
            Ok(ValueEntry { from: Some(n), name: name.value().clone(), ..ValueEntry::default() })
        }
        Value::InlineTable(table) => of_table(n, table),
        _ => Err(WrongType),
    };
    match table.get("values") {
        None => Ok(Vec::new()),
        Some(Item::Value(Value::Array(array))) => {
            array.iter().enumerate().map(|(n, value)| of_value(n, value)).collect()
        }
        Some(Item::ArrayOfTables(tables)) => {
            tables.iter().enumerate().map(|(n, table)| of_table(n, table)).collect()
        }
        Some(_) => Err(WrongType),
    }
}

fn object(n: usize, table: &dyn TableLike) -> Read<ObjectEntry> {
    let attributes = match table.get("attributes") {
        None => BTreeMap::new(),
        Some(item) => {
            let table = item.as_table_like().ok_or(WrongType)?;
            let pair = |(key, item): (&str, &Item)| {
                Ok((key.to_owned(), item.as_str().ok_or(WrongType)?.to_owned()))
            };
            table.iter().map(pair).collect::<Read<_>>()?
        }
    };
    Ok(ObjectEntry {
        from: Some(n),
        name: text(table, "name")?.unwrap_or_default(),
        attributes,
        xyz: triple(table, "xyz")?,
        yaw: number(table, "yaw")?,
        size: triple(table, "size")?,
        grasp_width: number(table, "grasp_width")?,
        mass_kg: number(table, "mass_kg")?,
        form: text(table, "form")?,
        wall_deg: number(table, "wall_deg")?,
    })
}

fn text(table: &dyn TableLike, key: &str) -> Read<Option<String>> {
    let Some(item) = table.get(key) else { return Ok(None) };
    item.as_str().map(|text| Some(text.to_owned())).ok_or(WrongType)
}

fn list(table: &dyn TableLike, key: &str) -> Read<Vec<String>> {
    let Some(item) = table.get(key) else { return Ok(Vec::new()) };
    let texts = item.as_array().ok_or(WrongType)?.iter();
    texts.map(|text| text.as_str().map(str::to_owned).ok_or(WrongType)).collect()
}

/// A text, or a list of them.
fn texts(table: &dyn TableLike, key: &str) -> Read<Vec<String>> {
    match table.get(key).and_then(Item::as_str) {
        Some(one) => Ok(vec![one.to_owned()]),
        None => list(table, key),
    }
}

/// A number as scene files write it.
pub(crate) fn number_of(value: &Value) -> Option<f64> {
    #[expect(clippy::cast_precision_loss, reason = "metres")]
    value.as_float().or(value.as_integer().map(|whole| whole as f64))
}

fn number(table: &dyn TableLike, key: &str) -> Read<Option<f64>> {
    let Some(item) = table.get(key) else { return Ok(None) };
    item.as_value().and_then(number_of).map(Some).ok_or(WrongType)
}

fn triple(table: &dyn TableLike, key: &str) -> Read<Option<[f64; 3]>> {
    let Some(item) = table.get(key) else { return Ok(None) };
    let numbers = item.as_array().ok_or(WrongType)?.iter();
    let numbers: Vec<f64> = numbers.map(number_of).collect::<Option<_>>().ok_or(WrongType)?;
    numbers.try_into().map(Some).map_err(|_| WrongType)
}

fn tables<'a>(table: &'a dyn TableLike, key: &str) -> Read<Vec<&'a dyn TableLike>> {
    match table.get(key) {
        None => Ok(Vec::new()),
        Some(Item::ArrayOfTables(tables)) => {
            Ok(tables.iter().map(|table| table as &dyn TableLike).collect())
        }
        Some(Item::Value(Value::Array(array))) => array
            .iter()
            .map(|value| value.as_inline_table().map(|table| table as &dyn TableLike))
            .collect::<Option<_>>()
            .ok_or(WrongType),
        Some(_) => Err(WrongType),
    }
}

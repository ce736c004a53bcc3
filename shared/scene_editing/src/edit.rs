//! Edits of a scene file that keep its comments and its layout.

use diagnostics::{Diagnostic, Diagnostics, Report};
use scene::Scene;
use toml_edit::{Array, DocumentMut, Item, TableLike, Value};

use crate::document::{AttributeEntry, Document, ObjectEntry, ValueEntry};
use crate::keys::{set_map, set_number, set_text, set_texts, set_triple};
use crate::lists::{Entry, set_entries};

/// A scene file while it is edited.
#[derive(Clone, Debug)]
pub struct SceneEdit {
    /// Name of the file in diagnostics.
    label: String,
    toml: DocumentMut,
}

impl SceneEdit {
    /// Parses a file; `label` is its name in diagnostics.
    ///
    /// # Errors
    /// Every syntax error.
    pub fn parse(label: &str, text: &str) -> Result<Self, Diagnostics> {
        let toml =
            text.parse::<DocumentMut>().map_err(|error| match Scene::from_toml(label, text) {
                // The usual reader names every error with its place.
                Err(found) => found,
                Ok(_) => Diagnostic::new(label, "", format!("{error}"), "correct it there").into(),
            })?;
        Ok(Self { label: label.to_owned(), toml })
    }

    /// The edited text.
    pub fn text(&self) -> String {
        self.toml.to_string()
    }

    /// Returns the scene as an editor sees it.
    ///
    /// # Errors
    /// Every problem of the form, if a key has a wrong type: such a file is corrected as text.
    pub fn document(&self) -> Result<Document, Diagnostics> {
        Document::read(self.toml.as_table()).map_err(|_| {
            let mut report = Report::default();
            let scene = Scene::examine(&self.label, &self.text(), &mut report);
            let what = "expected a scene, found keys of other types";
            let otherwise = Diagnostic::new(&*self.label, "", what, "correct it as a text");
            report.verdict(scene).err().unwrap_or_else(|| otherwise.into())
        })
    }

    /// Makes the file that of a changed document: keys, entries and comments that stay are left as
    /// they are written.
    ///
    /// # Errors
    /// The file is in a form that would have another meaning afterwards; it is unchanged then.
    pub fn apply(&mut self, document: &Document) -> Result<(), Diagnostics> {
        let before = self.toml.clone();
        write(&mut self.toml, document);
        let written = Self::parse(&self.label, &self.text()).and_then(|edit| edit.document());
        if written.is_ok_and(|written| written == document.renumbered()) {
            return Ok(());
        }
        self.toml = before;
        let what = "this file cannot be edited so: its tables are written in an unusual form";
        let help = "save the scene under another name, or edit the file as a text";
        Err(Diagnostic::new(&*self.label, "", what, help).into())
    }

    /// Gives every object that has a size and a grasp width but no place one at the origin, which
    /// is still to be replaced. Returns their numbers.
    pub fn add_places(&mut self) -> Vec<usize> {
        let mut added = Vec::new();
        for n in 0..self.objects() {
            let Some(object) = self.object_mut(n) else { continue };
            let has = |key| object.contains_key(key);
            if has("size") && has("grasp_width") && !has("xyz") {
                self.set_place(n, [0.0; 3]);
                added.push(n);
            }
        }
        added
    }

    /// Sets the place of an object, metres. Numbers that stay keep their form.
    pub fn set_place(&mut self, n: usize, xyz: [f64; 3]) {
        if let Some(object) = self.object_mut(n) {
            set_triple(object, "xyz", Some(xyz));
        }
    }

    fn objects(&self) -> usize {
        match self.toml.get("objects") {
            Some(Item::ArrayOfTables(tables)) => tables.len(),
            Some(Item::Value(Value::Array(items))) => items.len(),
            _ => 0,
        }
    }

    fn object_mut(&mut self, n: usize) -> Option<&mut dyn TableLike> {
        match self.toml.get_mut("objects")? {
            Item::ArrayOfTables(tables) => Some(tables.get_mut(n)? as &mut dyn TableLike),
            Item::Value(Value::Array(items)) => {
                Some(items.get_mut(n)?.as_inline_table_mut()? as &mut dyn TableLike)
            }
            _ => None,
        }
    }
}

fn write(toml: &mut DocumentMut, document: &Document) {
    let root = toml.as_table_mut();
    set_text(root, "name", Some(&document.name));
    set_text(root, "noun", Some(&document.noun));
    set_texts(root, "ask_wanted", &document.ask_wanted, true);
    set_texts(root, "ask_point", &document.ask_point, true);
    let mut loose = set_entries(root, "attributes", &document.attributes, false);
    let order: Vec<&str> = document.attributes.iter().map(|it| it.name.as_str()).collect();
    let objects: Vec<Ordered<'_>> =
        document.objects.iter().map(|object| Ordered { object, order: &order }).collect();
    loose += &set_entries(root, "objects", &objects, false);
    if !loose.is_empty() {
        let after = toml.trailing().as_str().unwrap_or_default().to_owned();
        toml.set_trailing(loose + &after);
    }
}

impl Entry for AttributeEntry {
    fn from(&self) -> Option<usize> {
        self.from
    }

    fn write(&self, table: &mut dyn TableLike) {
        set_text(table, "name", Some(&self.name));
        set_texts(table, "synonyms", &self.synonyms, false);
        set_text(table, "role", self.role.as_deref());
        set_texts(table, "ask_yes_no", &self.ask_yes_no, true);
        set_texts(table, "ask_which", &self.ask_which, true);
        set_entries(table, "values", &self.values, true);
        if self.values.is_empty() && table.get("values").is_none() {
            table.insert("values", Item::Value(Array::new().into()));
        }
    }

    fn plain(&self) -> Option<Value> {
        None
    }
}

impl Entry for ValueEntry {
    fn from(&self) -> Option<usize> {
        self.from
    }

    fn write(&self, table: &mut dyn TableLike) {
        set_text(table, "name", Some(&self.name));
        set_texts(table, "synonyms", &self.synonyms, false);
        set_text(table, "spoken", self.spoken.as_deref());
        set_text(table, "role", self.role.as_deref());
    }

    fn plain(&self) -> Option<Value> {
        self.is_plain().then(|| Value::from(&self.name))
    }
}

/// An object, with the order in which its attributes are written.
struct Ordered<'a> {
    object: &'a ObjectEntry,
    order: &'a [&'a str],
}

impl Entry for Ordered<'_> {
    fn from(&self) -> Option<usize> {
        self.object.from
    }

    fn write(&self, table: &mut dyn TableLike) {
        let ObjectEntry { name, attributes, xyz, yaw, size, .. } = self.object;
        set_text(table, "name", Some(name));
        set_map(table, "attributes", attributes, self.order);
        set_triple(table, "xyz", *xyz);
        set_number(table, "yaw", *yaw);
        set_triple(table, "size", *size);
        set_text(table, "form", self.object.form.as_deref());
        set_number(table, "grasp_width", self.object.grasp_width);
        set_number(table, "mass_kg", self.object.mass_kg);
        set_number(table, "wall_deg", self.object.wall_deg);
    }

    fn plain(&self) -> Option<Value> {
        None
    }
}

#[cfg(test)]
mod tests;

//! Edits of a scene file that keep its comments and its layout.

use scene::Scene;
use service::exit::{Exit, Failure};
use toml_edit::{Array, DocumentMut, Item, TableLike, Value};

/// A scene file while it is edited.
pub(super) struct SceneEdit(DocumentMut);

impl SceneEdit {
    /// Parses a file; `label` is its name in diagnostics.
    ///
    /// # Errors
    /// Every syntax error.
    pub(super) fn parse(label: &str, text: &str) -> Result<Self, Failure> {
        text.parse().map(Self).map_err(|error| match Scene::from_toml(label, text) {
            // The usual reader names every error with its place.
            Err(found) => found.into(),
            Ok(_) => Failure::new(Exit::Config, format!("{label}: {error}")),
        })
    }

    /// The edited text.
    pub(super) fn text(&self) -> String {
        self.0.to_string()
    }

    /// Gives every object that has a size and a grasp width but no place one at the origin, which is
    /// still to be replaced. Returns their numbers.
    pub(super) fn add_places(&mut self) -> Vec<usize> {
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
    pub(super) fn set_place(&mut self, n: usize, xyz: [f64; 3]) {
        let Some(object) = self.object_mut(n) else { return };
        let written = object.get_mut("xyz").and_then(Item::as_array_mut);
        match written.filter(|array| array.len() == 3) {
            Some(array) => {
                for (old, new) in array.iter_mut().zip(xyz) {
                    #[expect(clippy::cast_precision_loss, reason = "metres")]
                    let known = old.as_float().or(old.as_integer().map(|whole| whole as f64));
                    if known != Some(new) {
                        let decor = old.decor().clone();
                        *old = Value::from(new);
                        *old.decor_mut() = decor;
                    }
                }
            }
            None => {
                let array = Array::from_iter(xyz);
                object.insert("xyz", toml_edit::value(array));
            }
        }
    }

    fn objects(&self) -> usize {
        match self.0.get("objects") {
            Some(Item::ArrayOfTables(tables)) => tables.len(),
            Some(Item::Value(Value::Array(items))) => items.len(),
            _ => 0,
        }
    }

    fn object_mut(&mut self, n: usize) -> Option<&mut dyn TableLike> {
        match self.0.get_mut("objects")? {
            Item::ArrayOfTables(tables) => Some(tables.get_mut(n)? as &mut dyn TableLike),
            Item::Value(Value::Array(items)) => {
                Some(items.get_mut(n)?.as_inline_table_mut()? as &mut dyn TableLike)
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_set_without_a_change_elsewhere() {
        let text = "# a\nname = 's'\n\n[[objects]]  # b\nname = 'o'\n\
                    xyz = [0.650, 1,\n  -0.1]  # c\n\n# d\n[[objects]]\nname = 'p'\n\
                    size = [1, 1, 1]\ngrasp_width = 1 # e\n";
        let mut edit = SceneEdit::parse("s", text).unwrap();
        assert_eq!(edit.text(), text);
        assert_eq!(edit.add_places(), [1]);
        edit.set_place(0, [0.65, 0.5, -0.1]);
        edit.set_place(1, [0.25, 0.0, 0.1]);
        let expected = text
            .replace("0.650, 1,", "0.650, 0.5,")
            .replace("1 # e\n", "1 # e\nxyz = [0.25, 0.0, 0.1]\n");
        assert_eq!(edit.text(), expected);
        let text = "objects = [{ name = 'o', size = [1, 1, 1], grasp_width = 1 }, 'p']";
        let mut edit = SceneEdit::parse("s", text).unwrap();
        assert_eq!(edit.add_places(), [0]);
        edit.set_place(0, [0.5, 0.0, 0.0]);
        assert!(
            edit.text().contains("grasp_width = 1 , xyz = [0.5, 0.0, 0.0] }, 'p']")
                || edit.text().contains("grasp_width = 1, xyz = [0.5, 0.0, 0.0] }, 'p']"),
            "{}",
            edit.text()
        );
    }

    #[test]
    fn syntax_errors_have_a_place() {
        let error = SceneEdit::parse("s.toml", "name = \n").err().unwrap().to_string();
        assert!(error.starts_with("s.toml:1:"), "{error}");
    }
}

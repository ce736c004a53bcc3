//! The first place at which two values differ.

use serde_json::Value;

/// Returns the path of the first difference, with both values there: null if one is missing. `None`
/// for equal values.
///
/// A path is as in `outputs[0].Act.prompt`.
pub fn first_difference(a: &Value, b: &Value) -> Option<(String, Value, Value)> {
    let mut path = String::new();
    let (a, b) = search(a, b, &mut path)?;
    Some((path, a.clone(), b.clone()))
}

fn search<'a>(a: &'a Value, b: &'a Value, path: &mut String) -> Option<(&'a Value, &'a Value)> {
    const NONE: &Value = &Value::Null;
    let before = path.len();
    match (a, b) {
        (Value::Object(a), Value::Object(b)) => {
            let keys = a.keys().chain(b.keys().filter(|key| !a.contains_key(*key)));
            for key in keys {
                if before > 0 {
                    path.push('.');
                }
                path.push_str(key);
                let (a, b) = (a.get(key).unwrap_or(NONE), b.get(key).unwrap_or(NONE));
                if let Some(found) = search(a, b, path) {
                    return Some(found);
                }
                path.truncate(before);
            }
            None
        }
        (Value::Array(a), Value::Array(b)) => {
            for i in 0..a.len().max(b.len()) {
                path.push_str(&format!("[{i}]"));
                let found = match (a.get(i), b.get(i)) {
                    (Some(a), Some(b)) => search(a, b, path),
                    (a, b) => Some((a.unwrap_or(NONE), b.unwrap_or(NONE))),
                };
                if found.is_some() {
                    return found;
                }
                path.truncate(before);
            }
            None
        }
        // Numbers as they are printed: 0.0 and -0.0 differ.
        (Value::Number(x), Value::Number(y)) if x.to_string() == y.to_string() => None,
        (Value::Number(_), Value::Number(_)) => Some((a, b)),
        _ => (a != b).then_some((a, b)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn first_difference_has_its_path_and_both_values() {
        let a = json!({ "outputs": [{ "Act": { "prompt": 3, "share": 0.0 } }], "exit": false });
        assert_eq!(first_difference(&a, &a), None);
        let mut b = a.clone();
        b["outputs"][0]["Act"]["prompt"] = json!(4);
        let found = first_difference(&a, &b);
        assert_eq!(found, Some(("outputs[0].Act.prompt".to_owned(), json!(3), json!(4))));
        let mut b = a.clone();
        b["outputs"][0]["Act"]["share"] = json!(-0.0);
        let path = first_difference(&a, &b).map(|(path, ..)| path);
        assert_eq!(path.as_deref(), Some("outputs[0].Act.share"));
    }

    #[test]
    fn what_one_side_lacks_is_a_difference() {
        let (a, b) = (json!({ "x": [1, 2] }), json!({ "x": [1], "y": 5 }));
        assert_eq!(first_difference(&a, &b), Some(("x[1]".to_owned(), json!(2), Value::Null)));
        let (a, b) = (json!({ "x": [1] }), json!({ "x": [1], "y": 5 }));
        assert_eq!(first_difference(&a, &b), Some(("y".to_owned(), Value::Null, json!(5))));
        let (a, b) = (json!({ "kind": "Ask" }), json!({ "kind": { "Pick": 1 } }));
        assert_eq!(first_difference(&a, &b).map(|(path, ..)| path), Some("kind".to_owned()));
    }
}

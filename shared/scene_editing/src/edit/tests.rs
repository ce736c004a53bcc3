use proptest::prelude::*;

use super::*;

const BOWLS: &str = include_str!("../../../../config/scenes/bowls.toml");

fn edit(text: &str) -> (SceneEdit, Document) {
    let edit = SceneEdit::parse("s.toml", text).unwrap();
    let document = edit.document().unwrap();
    (edit, document)
}

/// The text after a change of the document.
fn changed(text: &str, change: impl FnOnce(&mut Document)) -> String {
    let (mut edit, mut document) = edit(text);
    change(&mut document);
    edit.apply(&document).unwrap();
    edit.text()
}

/// The lines that one text has and the other has not.
fn lines_only_in<'a>(a: &'a str, b: &str) -> Vec<&'a str> {
    a.lines().filter(|line| !b.lines().any(|other| other == *line)).collect()
}

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
    assert!(edit.text().contains("xyz = [0.5, 0.0, 0.0] }, 'p']"), "{}", edit.text());
}

#[test]
fn syntax_errors_have_a_place() {
    let error = SceneEdit::parse("s.toml", "name = \n").err().unwrap().to_string();
    assert!(error.starts_with("s.toml:1:"), "{error}");
}

#[test]
fn unchanged_document_leaves_every_shipped_scene_as_it_is() {
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/scenes");
    for file in std::fs::read_dir(scenes).unwrap() {
        let text = std::fs::read_to_string(file.unwrap().path()).unwrap();
        assert_eq!(changed(&text, |_| ()), text);
    }
}

#[test]
fn single_keys_are_replaced_where_they_stand() {
    let text = changed(BOWLS, |document| {
        document.objects[1].xyz = Some([0.64, 0.05, -0.13]);
        document.objects[1].yaw = Some(0.5);
        document.objects[2].attributes.insert("color".into(), "clear".into());
        document.attributes[0].values[0].synonyms = vec!["ivory".into()];
        document.attributes[1].values[1].synonyms.push("iron".into());
        document.attributes[2].ask_which = vec!["Small or big?".into(), "Which size?".into()];
    });
    let expected = [
        "  { name = \"white\", synonyms = [\"ivory\"] },",
        "  { name = \"metal\", synonyms = [\"steel\", \"stainless\", \"stainless steel\", \"tin\", \
         \"aluminium\", \"aluminum\", \"iron\"] },",
        "ask_which = [\"Small or big?\", \"Which size?\"]",
        "xyz = [0.64, 0.05, -0.13]",
        "yaw = 0.5",
        "attributes = { color = \"clear\", material = \"plastic\", size = \"big\", shape = \"round\", \
         location = \"cabinet\" }",
    ];
    assert_eq!(lines_only_in(&text, BOWLS), expected);
    assert_eq!(text.lines().count(), BOWLS.lines().count() + 1);
}

#[test]
fn comments_stay_when_entries_are_removed_added_and_moved() {
    let text = "# head\nname = 's'\nnoun = 'n'\n\n# about attributes\n\n[[attributes]] # k\nname = 'k'\n\
                values = [\n  'a', # the first\n  'b',\n]\n\n# about objects\n\n# the left one\n[[objects]]\n\
                name = 'l' # left\nattributes = { k = 'a' }\n\n# the right one\n[[objects]]\nname = 'r'\n\
                attributes = { k = 'b' }\n\n# end\n";
    let gone = changed(text, |document| {
        document.objects.remove(0);
    });
    assert_eq!(
        lines_only_in(text, &gone),
        ["# the left one", "name = 'l' # left", "attributes = { k = 'a' }"]
    );
    assert!(
        gone.contains("\n# about objects\n\n# the right one\n[[objects]]\nname = 'r'"),
        "{gone}"
    );
    let swapped = changed(text, |document| document.objects.swap(0, 1));
    assert!(swapped.find("name = 'r'") < swapped.find("name = 'l' # left"), "{swapped}");
    assert_eq!(lines_only_in(text, &swapped), [""; 0]);
    let added = changed(text, |document| {
        let attributes = [("k".to_owned(), "c".to_owned())].into();
        let value = ValueEntry { name: "c".into(), ..ValueEntry::default() };
        document.attributes[0].values.push(value);
        let name = "m".to_owned();
        document.objects.insert(1, ObjectEntry { name, attributes, ..ObjectEntry::default() });
    });
    assert_eq!(lines_only_in(text, &added), [""; 0]);
    assert_eq!(
        lines_only_in(&added, text),
        ["  \"c\",", "name = \"m\"", "attributes = { k = \"c\" }"]
    );
    let none = changed(text, |document| document.objects.clear());
    assert!(none.contains("# about objects") && none.contains("# end"), "{none}");
    assert!(!none.contains("[[objects]]"), "{none}");
}

#[test]
fn other_forms_of_tables_are_kept() {
    let text = "name = 's'\nnoun = 'n'\nattributes = [{ name = 'k', values = ['a'] }]\n[[objects]]\n\
                name = 'l'\n[objects.attributes]\nk = 'a'\n[[objects]]\nname = 'r'\nattributes.k = 'a'\n";
    let text = changed(text, |document| {
        document.objects.reverse();
        document.objects[0].attributes.insert("k".into(), "b".into());
        document.attributes[0].values[0].name = "b".into();
        document.objects[1].attributes.insert("k".into(), "b".into());
    });
    let expected = "name = 's'\nnoun = 'n'\nattributes = [{ name = 'k', values = [\"b\"] }]\n[[objects]]\n\
                    name = 'r'\nattributes.k = \"b\"\n[[objects]]\nname = 'l'\n[objects.attributes]\nk = \"b\"\n";
    assert_eq!(text, expected);
}

#[test]
fn file_with_keys_of_other_types_is_refused_with_their_places() {
    let edit = SceneEdit::parse("s.toml", "name = 's'\nnoun = 3\n").unwrap();
    let refused = edit.document().unwrap_err().to_string();
    assert!(refused.contains("s.toml:2:1: noun: "), "{refused}");
}

#[test]
fn new_scene_has_every_comment_after_its_objects_are_replaced() {
    let text = crate::new_scene("desk", "");
    let new = changed(&text, |document| {
        let mut object = document.objects[0].clone();
        (object.from, object.name) = (None, "cup".to_owned());
        document.objects = vec![object];
    });
    let comments = |text: &str| text.lines().filter(|line| line.starts_with('#')).count();
    assert_eq!(comments(&new), comments(&text), "{new}");
    let empty = changed(&text, |document| document.objects.clear());
    assert_eq!(comments(&empty), comments(&text), "{empty}");
}

/// Steps of an editor, by numbers.
fn disturb(document: &mut Document, steps: &[(u8, usize, usize)]) {
    for &(kind, a, b) in steps {
        let objects = document.objects.len().max(1);
        let attributes = document.attributes.len().max(1);
        match kind % 8 {
            0 if !document.objects.is_empty() => {
                document.objects.remove(a % objects);
            }
            1 if !document.objects.is_empty() => {
                let mut copy = document.objects[a % objects].clone();
                copy.from = None;
                document.objects.insert(b % (objects + 1), copy);
            }
            2 if document.objects.len() > 1 => document.objects.swap(a % objects, b % objects),
            3 if !document.objects.is_empty() => {
                document.objects[a % objects].xyz = (b % 3 > 0).then_some([0.1, b as f64, 0.25]);
            }
            4 if !document.attributes.is_empty() => {
                let values = &mut document.attributes[a % attributes].values;
                let name = format!("v{b}");
                let synonyms = vec!["x".to_owned(); b % 2];
                values.insert(
                    b % (values.len() + 1),
                    ValueEntry { name, synonyms, ..ValueEntry::default() },
                );
            }
            5 if !document.attributes.is_empty() => {
                let values = &mut document.attributes[a % attributes].values;
                if !values.is_empty() {
                    values.remove(b % values.len());
                }
            }
            6 if document.attributes.len() > 1 => {
                document.attributes.swap(a % attributes, b % attributes)
            }
            7 if !document.attributes.is_empty() => {
                document.attributes.remove(a % attributes);
            }
            _ => {}
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 200, ..ProptestConfig::default() })]

    /// After any change the text and the document agree.
    #[test]
    fn any_change_is_written_as_it_is_meant(
        steps in proptest::collection::vec((any::<u8>(), 0_usize..40, 0_usize..40), 0..12),
        more in proptest::collection::vec((any::<u8>(), 0_usize..40, 0_usize..40), 0..12),
    ) {
        let (mut edit, mut document) = edit(BOWLS);
        for steps in [steps, more] {
            disturb(&mut document, &steps);
            edit.apply(&document).unwrap();
            // The written text is read again.
            document = SceneEdit::parse("s", &edit.text()).unwrap().document().unwrap();
        }
    }
}

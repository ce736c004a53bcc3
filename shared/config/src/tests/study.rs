//! `study.toml`, right and wrong.

use super::Folder;
use crate::Settings;
use crate::study::{Design, Kind, Objects};

#[track_caller]
fn check(text: &str, expected: &[&str]) {
    assert_eq!(Folder::new(&[("study.toml", text)]).complaints(None, &[]), expected, "{text}");
}

#[test]
fn what_is_shipped_is_the_published_protocol_with_a_questionnaire() {
    let settings = Folder::new(&[]).load(None, &[]).unwrap();
    let study = &settings.study;
    assert!(!study.enabled, "nobody takes part unasked");
    let protocol = &study.protocol;
    assert_eq!((protocol.interactions, protocol.warmup), (3, 0));
    assert_eq!((protocol.objects, protocol.instructions.len()), (Objects::Uniform, 4));
    assert_eq!(protocol.policies, ["lookahead"], "the one that is configured");
    let kinds: Vec<Kind> = protocol.questionnaire.iter().map(|item| item.kind).collect();
    assert_eq!(kinds, [Kind::Likert, Kind::Likert, Kind::Likert, Kind::Likert, Kind::Text]);
    assert_eq!(protocol.questionnaire[0].points, 5);
}

#[test]
fn a_lab_s_own_questionnaire_survives_the_snapshot() {
    let text = r#"
design = "between"
policies = ["lookahead", "entropy"]
questionnaire = [
  { id = "hand", text = "Which hand do you write with?", kind = "choice", options = ["left", "right"] },
  { id = "age_group", text = "How old are you?", kind = "number", required = false },
]
"#;
    let folder = Folder::new(&[("study.toml", text)]);
    let settings = folder.load(None, &[("dialogue.planner", "optimal")]).unwrap();
    let protocol = &settings.study.protocol;
    assert_eq!((protocol.design, protocol.policies.len()), (Design::Between, 2));
    assert_eq!(protocol.questionnaire.len(), 2);
    assert!(protocol.questionnaire[0].required && !protocol.questionnaire[1].required);
    settings.write_snapshot(folder.path()).unwrap();
    assert_eq!(Settings::load_snapshot(folder.path()).unwrap().study, settings.study);
}

#[test]
fn no_questionnaire_at_all() {
    let settings = Folder::new(&[("study.toml", "questionnaire = []")]).load(None, &[]).unwrap();
    assert!(settings.study.protocol.questionnaire.is_empty());
}

#[test]
fn policies_that_there_are_not() {
    check(
        "policies = ['lookahaed']",
        &["study.toml: policies: `lookahaed` is not one of lookahead, optimal, \
           information-seeking, entropy, sparse-sampling, no-attribute, always-ask, never-ask \
           (did you mean `lookahead`?)"],
    );
    check(
        "policies = ['entropy', 'entropy']",
        &["study.toml: policies: names `entropy` twice (name each policy once)"],
    );
}

#[test]
fn questions_that_are_wrong_are_told_by_their_place() {
    check(
        "[[questionnaire]]\nid = 'a b'\ntext = 'Well?'\nkind = 'scale'\n\
         [[questionnaire]]\nid = 'c'\ntxt = 'Well?'\nkind = 'choice'",
        &[
            "study.toml: questionnaire[1].kind: `scale` is not one of likert, choice, number, text \
             (use one of these)",
            "study.toml: questionnaire[1].id: `a b` is no column name (use letters, digits and _)",
            "study.toml: questionnaire[2].text: is empty (write a text)",
            "study.toml: questionnaire[2].options: offers nothing to choose \
             (write `options = [\"one\", \"two\"]`)",
            "study.toml: questionnaire[2].txt: unknown key (did you mean `text`?)",
        ],
    );
    check(
        "questionnaire = [{ id = 'a', text = 'A', kind = 'text' }, { id = 'a', text = 'B', kind = 'text' }]",
        &[
            "study.toml: questionnaire: has two questions with the id `a` (give each an id of its own)",
        ],
    );
    check(
        "questionnaire = ['How was it?']",
        &["study.toml: questionnaire: expected a list of tables alone, found a list \
           (write a table `[[questionnaire]]` for each)"],
    );
}

#[test]
fn numbers_out_of_range_and_a_relative_folder() {
    check(
        "interactions = 0\ndata_dir = 'study'",
        &[
            "study.toml: interactions: 0 is out of range (use a number from 1 to 100)",
            "study.toml: data_dir: is not an absolute path (write it from `/` on)",
        ],
    );
}

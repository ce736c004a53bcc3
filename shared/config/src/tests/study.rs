//! `study.toml`.

use super::Folder;
use crate::Settings;
use crate::study::{Design, Kind, Objects};

#[test]
fn study_default_is_the_published_protocol_with_a_questionnaire() {
    let settings = Folder::new(&[]).load(None, &[]).unwrap();
    let study = &settings.study;
    assert!(!study.enabled, "a study starts on request only");
    let protocol = &study.protocol;
    assert_eq!((protocol.interactions, protocol.warmup), (3, 0));
    assert_eq!((protocol.objects, protocol.instructions.len()), (Objects::Uniform, 4));
    assert_eq!(protocol.policies, ["lookahead"], "the one that is configured");
    let kinds: Vec<Kind> = protocol.questionnaire.iter().map(|item| item.kind).collect();
    assert_eq!(kinds, [Kind::Likert, Kind::Likert, Kind::Likert, Kind::Likert, Kind::Text]);
    assert_eq!(protocol.questionnaire[0].points, 5);
}

#[test]
fn a_configured_questionnaire_survives_the_snapshot() {
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
fn study_may_have_no_questionnaire() {
    let settings = Folder::new(&[("study.toml", "questionnaire = []")]).load(None, &[]).unwrap();
    assert!(settings.study.protocol.questionnaire.is_empty());
}

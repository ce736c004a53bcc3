//! `study.toml`.

use config::Settings;
use user_study::{Design, Kind, Objects, Study};

use super::Folder;

/// The defaults with this text of the section.
fn configured(text: &str) -> (Settings, Study) {
    let settings = Folder::new(&[("study.toml", text)]).load(None, &[]).unwrap();
    let study = settings.part().unwrap();
    (settings, study)
}

#[test]
fn study_default_is_the_published_protocol_with_a_questionnaire() {
    let (_, study) = configured("");
    assert!(!study.enabled, "a study starts on request only");
    let protocol = study.protocol_with("lookahead");
    assert_eq!((protocol.interactions, protocol.warmup), (3, 0));
    assert_eq!((protocol.objects, protocol.instructions.len()), (Objects::Uniform, 4));
    assert_eq!(protocol.policies, ["lookahead"], "the one that is configured");
    let kinds: Vec<Kind> = protocol.questionnaire.iter().map(|item| item.kind).collect();
    assert_eq!(kinds, [Kind::Likert, Kind::Likert, Kind::Likert, Kind::Likert, Kind::Text]);
    assert_eq!(protocol.questionnaire[0].points, 5);
    assert!(configured("questionnaire = []").1.protocol.questionnaire.is_empty());
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
    let (settings, study) = configured(text);
    let protocol = study.protocol_with("optimal");
    assert_eq!((protocol.design, protocol.policies.len()), (Design::Between, 2));
    assert_eq!(protocol.questionnaire.len(), 2);
    assert!(protocol.questionnaire[0].required && !protocol.questionnaire[1].required);
    let read = Settings::from_snapshot("snapshot", &settings.snapshot(), ("", &[])).unwrap();
    assert_eq!(read.part::<Study>().unwrap(), study);
}

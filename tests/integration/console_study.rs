//! A user study through the console, from the first page to the exported files.

use rustix::process::Signal;
use serde_json::{Value as Json, json};
use whichone_tests::Group;
use whichone_tests::console::{Page, Visitor, http};

/// The secret of the participant's page.
const PAGE: &str = "00112233445566778899aabbccddeeff";

const STUDY: [&str; 3] =
    ["study.enabled=true", "study.consent=I agree.", "study.title=Asking for bowls"];

fn operator(group: &Group) -> Page {
    group.page(&Visitor::operator(1))
}

/// Has a verb of the study's done, which must succeed.
fn must(page: &mut Page, verb: &str, more: Json) -> Json {
    let done = ask(page, verb, more);
    assert_eq!(done["ok"], true, "study.{verb}: {done}");
    done
}

fn ask(page: &mut Page, verb: &str, mut more: Json) -> Json {
    if more["page"].is_null() {
        more["page"] = PAGE.into();
    }
    page.ask(&format!("study.{verb}"), &more)
}

/// Looks until the participant is at that stage, and returns what is shown.
fn at_stage(page: &mut Page, stage: &str) -> Json {
    let of = |study: &Json, key: &str| study[key]["stage"] == stage;
    let study = page.until_part("study", |study| of(study, "active") || of(study, "last"));
    if of(&study, "active") { study["active"].clone() } else { study["last"].clone() }
}

/// Waits until the robot is ready for what was drawn, begins, and names the desired object.
fn start(page: &mut Page) -> String {
    page.until_part("study", |study| {
        let (stage, trial) = (&study["active"]["stage"], &study["active"]["trial"]);
        stage == "drawn" && trial["waits_for"].is_null()
    });
    must(page, "start", json!({}));
    let shown = at_stage(page, "running");
    shown["trial"]["desired"].as_str().expect("a desired object").to_owned()
}

/// One interaction with a truthful person, from the card to the outcome.
fn interact(group: &Group, page: &mut Page) -> Json {
    let desired = start(page);
    let said = page.ask("say", &json!({ "text": "get me the bowl" }));
    assert_eq!(said["ok"], true, "{said}");
    group.await_pick(Some(&desired));
    at_stage(page, "over")["trial"].clone()
}

/// From the first page to the first card.
fn begin(page: &mut Page) -> String {
    let code = must(page, "begin", json!({}))["participant"].as_str().unwrap().to_owned();
    at_stage(page, "consent");
    must(page, "consent", json!({}));
    must(page, "next", json!({}));
    code
}

const ANSWERS: [&str; 4] = ["understood", "sensible", "quick", "again"];

fn finish(page: &mut Page) {
    must(page, "next", json!({}));
    at_stage(page, "questionnaire");
    let open = ask(page, "answer", json!({ "answers": { "quick": 4 } }));
    assert_eq!(open["ok"], false, "required answers are missing: {open}");
    let answers: Json = ANSWERS.iter().map(|id| ((*id).to_owned(), json!(4))).collect();
    must(page, "answer", json!({ "answers": answers }));
    at_stage(page, "thanks");
}

/// The rows of a table of the console's, by column.
fn table(group: &Group, file: &str) -> Vec<std::collections::BTreeMap<String, String>> {
    let (status, _, text) = http(&group.console(), "GET", &format!("/study/{file}"), &[], "");
    assert_eq!(status, 200, "{text}");
    let mut lines = text.lines();
    let heads: Vec<&str> = lines.next().expect("heads").split(',').collect();
    let row = |line: &str| {
        heads
            .iter()
            .map(|head| (*head).to_owned())
            .zip(line.split(',').map(str::to_owned))
            .collect()
    };
    lines.map(row).collect()
}

fn report(group: &Group) -> Json {
    group.must(&["study", "report", "--json"]).json()
}

#[test]
fn participant_completes_the_study_and_its_files() {
    let group = Group::up(&STUDY);
    let mut page = operator(&group);
    assert_eq!(page.welcome["settings"]["study"], true);
    let code = begin(&mut page);
    let mut shown = vec![interact(&group, &mut page)];
    must(&mut page, "next", json!({}));

    // The console is killed while the second interaction runs, and resumes.
    let desired = start(&mut page);
    assert_eq!(page.ask("say", &json!({ "text": "the bowl" }))["ok"], true);
    group.wait_for_decision("ask");
    group.signal("console", Signal::KILL);
    group.await_pick(Some(&desired));
    let mut page = operator(&group);
    let found = ask(&mut page, "find", json!({}));
    assert_eq!(found["participant"], code.as_str(), "{found}");
    shown.push(at_stage(&mut page, "over")["trial"].clone());
    must(&mut page, "next", json!({}));
    shown.push(interact(&group, &mut page));

    // A second participant has to wait.
    let other = json!({ "page": "f".repeat(32) });
    let waits = ask(&mut page, "begin", other.clone());
    assert!(waits["error"].as_str().unwrap_or_default().contains("wait"), "{waits}");
    finish(&mut page);

    let rows = table(&group, "export.csv");
    assert_eq!(rows.len(), 3, "{rows:?}");
    for (row, shown) in rows.iter().zip(&shown) {
        assert_eq!(row["participant"], code);
        assert_eq!(row["desired"], shown["desired"].as_str().unwrap());
        assert_eq!((&*row["outcome"], &*row["success"]), ("right", "1"), "{row:?}");
        assert_eq!((&*row["policy"], &*row["picked"]), ("lookahead", &*row["desired"]));
        let seconds: f64 = row["seconds"].parse().expect("seconds");
        let questions: u32 = row["questions"].parse().expect("questions");
        let utterances: u32 = row["utterances"].parse().expect("utterances");
        // On a slow machine a question may be asked, and answered, twice.
        assert!(seconds > 0.0 && questions > 0 && utterances > questions, "{row:?}");
    }
    let people = table(&group, "participants.csv");
    assert_eq!((&*people[0]["status"], &*people[0]["q_again"]), ("complete", "4"));
    let mut results = report(&group);
    assert_eq!(results["participants"]["complete"], 1);
    assert_eq!(
        (&results["all"]["interactions"], &results["all"]["success"]),
        (&json!(3), &json!(1.0))
    );
    let (_, _, served) = http(&group.console(), "GET", "/study/report.json", &[], "");
    let served: Json = serde_json::from_str(&served).expect("JSON");
    // Outputs of the command line name their schema.
    assert_eq!(results.as_object_mut().expect("an object").remove("schema"), Some(json!(1)));
    assert_eq!(served, results, "page and command line agree");
    let (status, head, _) = http(&group.console(), "GET", "/study/success.svg", &[], "");
    assert!(status == 200 && head.contains("image/svg+xml"), "{head}");

    // Starting afresh takes nothing of it away.
    group.must(&["down"]);
    let config = concat!(env!("CARGO_MANIFEST_DIR"), "/../config");
    let words = ["up", "--detach", "--wait", "ready", "--fresh", "--config", config];
    group.must(&[&words[..], &["--profile", "ci", "--set", STUDY[0]]].concat());
    assert_eq!(report(&group)["all"]["interactions"], 3);
    group.down();
}

#[test]
fn within_subject_design_switches_and_restores_the_planner() {
    let more = ["study.policies=[\"lookahead\", \"entropy\"]", "study.interactions=1"];
    let group = Group::up(&[&STUDY[..], &more, &["study.questionnaire=[]"]].concat());
    let mut page = operator(&group);
    begin(&mut page);
    let mut decided = Vec::new();
    for _ in 0..2 {
        let desired = start(&mut page);
        decided.push(group.dialogue()["planner"].as_str().unwrap().to_owned());
        assert_eq!(page.ask("say", &json!({ "text": "get me the bowl" }))["ok"], true);
        group.await_pick(Some(&desired));
        at_stage(&mut page, "over");
        must(&mut page, "next", json!({}));
    }
    assert_eq!(decided, ["lookahead", "entropy"]);
    at_stage(&mut page, "thanks");
    page.until_part("dialogue", |dialogue| dialogue["planner"] == "lookahead");
    whichone_tests::wait_for("the configured policy", 20.0, || {
        group.service("policy")["swapped"].is_null().then_some(())
    });
    let rows = table(&group, "interactions.csv");
    let policies: Vec<&str> = rows.iter().map(|row| &*row["policy"]).collect();
    assert_eq!(policies, decided);
    assert_eq!(report(&group)["paired"][0]["participants"], 1);
    group.verify_journals();
    group.down();
}

#[test]
fn withdrawal_removes_all_data() {
    let group = Group::up(&STUDY);
    let mut page = operator(&group);
    let code = begin(&mut page);
    start(&mut page);
    assert_eq!(page.ask("say", &json!({ "text": "the bowl" }))["ok"], true);
    group.wait_for_decision("ask");
    // Nobody else's page does it, not without control of the robot.
    let mut viewer = group.page(&Visitor { role: "viewer", ..Visitor::operator(2) });
    for verb in ["resume", "close", "spoilt", "delete"] {
        let more = json!({ "page": "f".repeat(32), "participant": code });
        let refused = ask(&mut viewer, verb, more);
        assert!(refused["error"].as_str().unwrap().contains("in control"), "{verb}: {refused}");
    }
    drop(viewer);
    must(&mut page, "withdraw", json!({ "delete": true }));
    assert_eq!(at_stage(&mut page, "withdrawn")["deleted"], true);
    assert!(table(&group, "interactions.csv").is_empty());
    let file = group.paths().study().join(format!("{code}.jsonl"));
    let kept = std::fs::read_to_string(file).expect("the record that there was a participant");
    assert!(!kept.contains("drawn") && !kept.contains("heard"), "{kept}");

    // The next one begins with a robot that has nothing to do.
    let other = "e".repeat(32);
    let mut next = |verb: &str| must(&mut page, verb, json!({ "page": other }));
    next("begin");
    next("consent");
    next("next");
    page.until_part("study", |study| {
        let trial = &study["active"]["trial"];
        !trial.is_null() && trial["waits_for"].is_null()
    });
    group.down();
}

//! The documentation's programs in Python in the grounding service's place.

use whichone_tests::{Group, program};

use crate::swap::swap;

/// The Python interpreter that has the iceoryx2 wheel: `$WHICHONE_PYTHON`, else `python3`.
fn python() -> String {
    std::env::var("WHICHONE_PYTHON").unwrap_or_else(|_| "python3".to_owned())
}

/// The service in Python that the documentation holds takes grounding's place under traffic.
#[test]
#[ignore = "needs python3 with iceoryx2"]
fn example_in_python_replaces_grounding() {
    let python = python();
    let program_text = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/examples/python/grounding.py");
    let group = Group::up(&[]);
    for object in ["metal2", "clear", "white3"] {
        group.say("get me the bowl");
        let talk = std::thread::scope(|scope| {
            let talk = scope.spawn(|| group.await_pick(Some(object)));
            let ended = swap(&group, "grounding", &[&python, program_text]);
            assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
            talk.join().expect("the dialogue")
        });
        assert_eq!(talk["object"], object, "{talk}\n{}", group.logs());
    }
    let before = group.incarnation("grounding");
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    assert_eq!(group.incarnation("grounding"), before, "it runs on\n{}", group.logs());
    group.signal("grounding", rustix::process::Signal::KILL);
    group.wait_for_restart("grounding", before);
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    let old = program("whichone-grounding").display().to_string();
    assert_eq!(swap(&group, "grounding", &[&old]).code, Some(0));
    assert!(!group.logs().contains("Traceback"), "{}", group.logs());
    group.verify_journals();
    group.down();
}

/// A stand-in for a language model. It knows a word that the built-in readers do not, logs its
/// input, and gives invalid output or sleeps where the input says so.
const STAND_IN: &str = r#"
import json, re, sys, time
prompt = sys.stdin.read()
line = lambda name: json.loads(re.search(name + ": (.*)", prompt)[1])
heard = line("heard")[0]["text"].lower()
with open(sys.argv[1], "a", encoding="utf-8") as log:
    log.write(heard + "\n")
said = re.findall("[a-z]+", heard.replace("glassy", "clear"))
if "sleep" in said:
    time.sleep(60)
if "broken" in said:
    print("the clear one, I think")
else:
    response = [word for word in said if word in ("yes", "no")][:1] or ["none"]
    base = [word for word in line("scene words") if word in said]
    print(json.dumps({"readings": [{"base": base, "response": response[0]}]}))
"#;

#[test]
#[ignore = "needs python3 with iceoryx2"]
fn external_program_replaces_grounding() {
    let python = python();
    let by_program = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/examples/python/by_program.py");
    let group = Group::up(&[]);
    let folder = tempfile::tempdir().unwrap();
    let (stand_in, log) = (folder.path().join("stand_in.py"), folder.path().join("asked.txt"));
    std::fs::write(&stand_in, STAND_IN).unwrap();
    let asked = || std::fs::read_to_string(&log).unwrap();
    let paths = [&stand_in, &log].map(|path| path.display().to_string());
    let command = [python.as_str(), by_program, &python, &paths[0], &paths[1]];
    assert_eq!(swap(&group, "grounding", &command).code, Some(0), "{}", group.logs());
    assert_eq!(group.fetch("the glassy one", "clear")["object"], "clear", "{}", group.logs());
    assert!(asked().contains("the glassy one\n"), "{}", asked());
    assert!(!group.logs().contains("word spotting"), "{}", group.logs());
    // A program that says nothing of use, or nothing in time, is done without.
    for text in ["broken the clear bowl", "sleep the clear bowl"] {
        assert_eq!(group.fetch(text, "clear")["object"], "clear", "{text}: {}", group.logs());
        assert!(asked().contains(text) && group.logs().contains("word spotting"), "{text}");
    }
    assert!(!group.logs().contains("Traceback"), "{}", group.logs());
    group.verify_journals();
    group.down();
}

//! A robot elsewhere behind a gateway: its mirror starts with the first visit.

use serde_json::{Value, json};
use whichone_tests::console::{Page, Visitor, http};
use whichone_tests::gateway::Gateway;
use whichone_tests::link::Relay;
use whichone_tests::{Group, wait_for};

#[test]
#[ignore = "needs whichone-link, which scripts/link builds"]
fn robot_elsewhere_is_listed_and_commanded_through_the_gateway() {
    let relay = Relay::start(&["--robot", "r1", "--operator", "gate"]);
    let robot = relay.robot_up("r1", &[]);
    let keys = relay.person("gate").display().to_string();
    let elsewhere = Group::new();
    let gateway = Gateway::start(elsewhere.paths().home(), &["--keys", &keys]);
    let secret = gateway.add("ann", &["--operator", "r1"]);
    let list = || -> Value {
        let (_, _, body) = http(&gateway.console("", &secret), "GET", "/_/robots", &[], "");
        serde_json::from_str(&body).unwrap()
    };
    let row = wait_for("the robot in the list", 20.0, || {
        let row = list()["robots"][0].clone();
        (row["connected"] == true && row["presence"]["state"] == "ready").then_some(row)
    });
    assert_eq!((&row["robot"], &row["right"]), (&json!("r1"), &json!("operator")), "{row}");
    let here = gateway.console("r1", &secret);
    let mut page =
        wait_for("the mirror's page", 40.0, || Page::open(&here, &Visitor::operator(1)).ok());
    page.stop();
    robot.wait_shown(true);
    // No release counts sooner, and the gateway passes on few orders at a time.
    std::thread::sleep(std::time::Duration::from_millis(2_200));
    wait_for("a release", 10.0, || (page.ask("resume", &json!({}))["ok"] == true).then_some(()));
    robot.wait_shown(false);
    assert_eq!(page.ask("say", &json!({ "text": "get me the bowl" }))["ok"], true);
    robot.wait_for_decision("ask");
    gateway.wait_for_entry("ann", "say", "done");
    // A robot that has gone is in the list, as the rights name it, and is not connected.
    robot.down();
    wait_for("the robot's end in the list", 20.0, || {
        (list()["robots"][0]["connected"] == false).then_some(())
    });
    let mirrors = gateway.folder().join("mirrors");
    assert!(gateway.end().success());
    assert!(!mirrors.join("r1/run").exists(), "the mirror has not ended");
}

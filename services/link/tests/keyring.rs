//! Keys of a fleet: making, keeping, renewing and revoking.

use link::identity::{Identity, Role};
use link::keyring::{Wanted, init};
use roster::Name;
use std::fs;
use std::os::unix::fs::symlink;

fn name(text: &str) -> Name {
    Name::new(text).expect("a name")
}

#[test]
fn members_keep_their_keys_until_they_are_renewed_or_revoked() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("keys");
    let wanted = Wanted {
        router: Some("localhost".into()),
        robots: vec![name("r1")],
        operators: vec![name("ann")],
        ..Wanted::default()
    };
    init(&folder, &wanted).unwrap();
    let read = |file: &str| fs::read_to_string(folder.join(file)).unwrap();
    let identity = Identity::load(&folder.join("people/ann")).unwrap();
    assert_eq!((identity.router.as_str(), identity.role), ("localhost:7447", Role::Operator));
    let first = [read("robots/r1/key.pem"), read("people/ann/key.pem")];
    let more = Wanted { robots: vec![name("r2")], renew: vec![name("ann")], ..Wanted::default() };
    init(&folder, &more).unwrap();
    assert_eq!(read("robots/r1/key.pem"), first[0]);
    assert_ne!(read("people/ann/key.pem"), first[1]);
    assert!(read("router/passwords").contains("robot-r2:"));
    init(&folder, &Wanted { revoke: vec![name("r1")], ..Wanted::default() }).unwrap();
    assert!(!folder.join("robots/r1").exists());
    assert!(!read("router/passwords").contains("robot-r1"));
    assert!(!read("router/router.json").contains("whichone/r1/"));
    let error = init(&folder, &Wanted { operators: vec![name("r2")], ..Wanted::default() });
    assert!(error.unwrap_err().message.contains("name of a robot"));
}

#[test]
fn addresses_of_routers_are_checked() {
    let home = tempfile::tempdir().unwrap();
    let make = |number: usize, router: &str| {
        let folder = home.path().join(number.to_string());
        let robots = vec![name("r1")];
        let wanted = Wanted { router: Some(router.into()), robots, ..Wanted::default() };
        init(&folder, &wanted).map(|_| Identity::load(&folder.join("robots/r1")).unwrap().router)
    };
    let good = [
        ("relay.example", "relay.example:7447"),
        ("10.0.0.1:99", "10.0.0.1:99"),
        ("[::1]:99", "[::1]:99"),
    ];
    for (number, (text, expected)) in good.into_iter().enumerate() {
        assert_eq!(make(number, text).unwrap(), expected);
    }
    for bad in ["", ":5", "a:b", "a b", "a:0", "a?x", "quic/a"] {
        assert!(make(9, bad).is_err(), "{bad}");
    }
}

/// A list that cannot be read is not an empty one, whose next writing would lose every member.
#[test]
fn list_that_cannot_be_read_is_kept() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("keys");
    let wanted = |robot| Wanted {
        router: Some("localhost".into()),
        robots: vec![name(robot)],
        ..Wanted::default()
    };
    init(&folder, &wanted("r1")).unwrap();
    let list = folder.join("keys.json");
    fs::write(&list, [0xff, 0xfe]).unwrap();
    assert!(init(&folder, &wanted("r2")).is_err());
    assert_eq!(fs::read(&list).unwrap(), [0xff, 0xfe]);
}

#[test]
fn key_is_written_in_the_place_of_a_link_and_not_through_it() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("keys");
    fs::create_dir(&folder).unwrap();
    let other = home.path().join("other");
    fs::write(&other, "of somebody else").unwrap();
    symlink(&other, folder.join("authority.key")).unwrap();
    let wanted = Wanted { router: Some("localhost".into()), ..Wanted::default() };
    let _ = init(&folder, &wanted);
    assert_eq!(fs::read_to_string(&other).unwrap(), "of somebody else");
}

//! Datagrams of a peer that claims what it does not send.

use std::net::UdpSocket;

use whichone_tests::ros2::own_domain;
use whichone_tests::{Group, program, wait_for};

/// Writers that every participant has: of participants, publications and subscriptions.
const BUILT_IN: [[u8; 4]; 3] = [[0, 1, 0, 0xc2], [0, 0, 3, 0xc2], [0, 0, 4, 0xc2]];
const PEER: [u8; 12] = *b"a-rtps-peer!";
/// What the node may take (SECURITY.md), with its program and libraries, KiB.
const MEMORY_KIB: u64 = 576 << 10;

fn message(kind: u8, body: &[&[u8]]) -> Vec<u8> {
    let body = body.concat();
    let length = (body.len() as u16).to_le_bytes();
    [b"RTPS\x02\x04\x01\x12".as_slice(), &PEER, &[kind, 5], &length, &body].concat()
}

/// The beginning of data of `writer`, whose own part is `length` bytes.
fn head(length: u8, writer: &[u8; 4], number: u8) -> Vec<u8> {
    [&[0, 0, length, 0, 0, 0, 0, 0], writer.as_slice(), &[0, 0, 0, 0, number, 0, 0, 0]].concat()
}

/// A participant with its key and an address at which nobody listens.
fn presence() -> Vec<u8> {
    let parameter = |id: u16, value: &[u8]| {
        [&id.to_le_bytes(), &(value.len() as u16).to_le_bytes(), value].concat()
    };
    let own = [PEER.as_slice(), &[0, 0, 1, 0xc1]].concat();
    let mut locator = [0; 24];
    (locator[0], locator[4]) = (1, 9);
    locator[20..].copy_from_slice(&[127, 0, 0, 1]);
    let parameters = [
        parameter(0x15, &[2, 4, 0, 0]),
        parameter(0x16, &[1, 0x12, 0, 0]),
        parameter(0x50, &own),
        parameter(0x32, &locator),
        parameter(0x31, &locator),
        parameter(0x02, &[0x40, 0x42, 0x0f, 0, 0, 0, 0, 0]),
        parameter(0x58, &0xc3f_u32.to_le_bytes()),
        vec![1, 0, 0, 0],
    ];
    let head = head(16, &BUILT_IN[0], 1);
    message(0x15, &[&head, &[0, 3, 0, 0], &parameters.concat()])
}

/// The first fragment of a message of 4 GiB.
fn fragment(writer: &[u8; 4]) -> Vec<u8> {
    let head = head(28, writer, 7);
    // Its number, one fragment, of 1 KiB.
    let of = [1, 0, 0, 0, 1, 0, 0, 4];
    message(0x16, &[&head, &of, &u32::MAX.to_le_bytes(), &[7; 1_024]])
}

fn memory_kib(pid: u64) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok()).unwrap_or(0)
}

#[test]
#[ignore = "needs whichone-ros2 built with ros2/dds"]
fn ros2_node_takes_no_gigabytes_on_the_word_of_a_peer() {
    let domain = own_domain();
    let program = program("whichone-ros2");
    let group = Group::up(&[
        &format!("group.services.ros2.command=[\"{}\"]", program.display()),
        &format!("ros2.domain_id={domain}"),
    ]);
    let node = || group.service("ros2");
    let first = node()["pid"].as_u64().unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let restarted = wait_for("the node that ends instead of taking 4 GiB", 30.0, || {
        for port in (0..4).map(|n| 7_410 + 250 * domain + n) {
            let _ = socket.send_to(&presence(), ("127.0.0.1", port));
            for writer in &BUILT_IN {
                let _ = socket.send_to(&fragment(writer), ("127.0.0.1", port));
            }
        }
        let taken = memory_kib(first);
        assert!(taken < MEMORY_KIB, "{taken} KiB");
        Some(node()).filter(|node| node["pid"] != first && node["pid"].is_u64())
    });
    assert_ne!(restarted["restarts"], 0, "{restarted}");
    // The others do not notice, and the arm is stopped as ever.
    group.must(&["stop-motion"]);
    for other in ["speech", "policy", "arm", "console"] {
        assert_eq!(group.service(other)["restarts"], 0, "{other}");
    }
    wait_for("the node", 30.0, || (node()["actual"] == "ready").then_some(()));
    group.down();
}

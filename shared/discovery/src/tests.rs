#![allow(clippy::unwrap_used, reason = "tests")]

mod responder;

use std::net::IpAddr;

use mdns_sd::IfKind;

use super::*;
use crate::records::{HOST_ID_LEN, networks, service};

fn robot() -> Identity {
    let [id, name] = ["0123456789abcdef", "kitchen"].map(str::to_owned);
    Identity { api: 1, id, name, version: "0.1.0" }
}

/// The pairs of the TXT record, in its order.
fn text_of(service: &ServiceInfo) -> Vec<(&str, &str)> {
    service.get_properties().iter().map(|pair| (pair.key(), pair.val_str())).collect()
}

#[test]
fn records_name_the_robot_and_its_interface() {
    let service = service(&robot(), 8377, "/api/v1", &[IfKind::IPv4]).unwrap();
    assert_eq!(service.get_fullname(), "kitchen._whichone._tcp.local.");
    assert_eq!(service.get_hostname(), "whichone-0123456789abcdef.local.");
    assert_eq!((service.get_port(), service.is_addr_auto()), (8377, true));
    assert!(service.requires_probe(), "a name that is taken is changed");
    let expected = [
        ("api", "1"),
        ("id", "0123456789abcdef"),
        ("name", "kitchen"),
        ("version", "0.1.0"),
        ("scheme", "http"),
        ("path", "/api/v1"),
    ];
    assert_eq!(text_of(&service), expected);
}

#[test]
fn records_of_the_longest_id_are_those_that_dns_allows() {
    let long = Identity { id: "i".repeat(200), ..robot() };
    let service = service(&long, 1, "/api/v1", &[IfKind::IPv4]).unwrap();
    let label = service.get_hostname().split('.').next().unwrap();
    assert_eq!(label.len(), "whichone-".len() + HOST_ID_LEN);
    assert_eq!(text_of(&service)[1], ("id", &*long.id));
}

#[test]
fn networks_are_those_of_the_listener() {
    let of = |ip: &str| networks(ip.parse().unwrap());
    for loopback in ["127.0.0.1", "127.1.2.3", "::1", "::ffff:127.0.0.1"] {
        assert!(of(loopback).is_none(), "{loopback}");
        let listening = SocketAddr::new(loopback.parse().unwrap(), 80);
        let refused = Announcement::begin(&robot(), listening, "/api/v1").unwrap_err();
        let help = "help: set console.listen = \"0.0.0.0:80\", or console.discovery = false";
        assert!(refused.to_string().ends_with(help), "{refused}");
    }
    assert!(matches!(of("0.0.0.0").unwrap()[..], [IfKind::IPv4]));
    assert!(matches!(of("::").unwrap()[..], [IfKind::IPv4, IfKind::IPv6]));
    let one: IpAddr = "192.168.7.5".parse().unwrap();
    assert!(matches!(of("192.168.7.5").unwrap()[..], [IfKind::Addr(ip)] if ip == one));
}

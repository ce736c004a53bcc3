//! Records of a robot, and the networks in which they are announced.

use std::net::IpAddr;

use mdns_sd::{IfKind, ServiceInfo};

use crate::{Identity, SERVICE};

/// Length of the robot's id in its host name, of which DNS allows 63 characters.
pub(crate) const HOST_ID_LEN: usize = 32;

/// A robot's records with the networks in which they are announced.
#[derive(Clone)]
pub(crate) struct Records {
    pub(crate) service: ServiceInfo,
    pub(crate) networks: Vec<IfKind>,
}

/// Networks in which a listener is reached from other machines; `None` for a loopback address.
pub(crate) fn networks(listening: IpAddr) -> Option<Vec<IfKind>> {
    match listening.to_canonical() {
        ip if ip.is_loopback() => None,
        IpAddr::V4(ip) if ip.is_unspecified() => Some(vec![IfKind::IPv4]),
        // It accepts connections over IPv4 as well.
        IpAddr::V6(ip) if ip.is_unspecified() => Some(vec![IfKind::IPv4, IfKind::IPv6]),
        ip => Some(vec![IfKind::Addr(ip)]),
    }
}

/// Records of a robot, without addresses: the responder adds those that the machine has in `networks`.
pub(crate) fn service(
    robot: &Identity,
    port: u16,
    path: &str,
    networks: &[IfKind],
) -> mdns_sd::Result<ServiceInfo> {
    let api = robot.api.to_string();
    let text = [
        ("api", &*api),
        ("id", &robot.id),
        ("name", &robot.name),
        ("version", robot.version),
        ("scheme", "http"),
        ("path", path),
    ];
    // Not the machine's own name, for which another responder may answer.
    let id: String = robot.id.chars().take(HOST_ID_LEN).collect();
    let host = format!("whichone-{id}.local.");
    let service = ServiceInfo::new(SERVICE, &robot.name, &host, (), port, &text[..])?;
    let mut service = service.enable_addr_auto();
    service.set_interfaces(networks.to_vec());
    Ok(service)
}

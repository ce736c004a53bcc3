//! `ros2.toml`: the ROS 2 node.

use std::net::Ipv4Addr;

use diagnostics::Fields;
use serde_json::json;

use crate::detectors::{self, Ros2Objects, is_name};

/// The ROS 2 node.
#[derive(Clone, Debug, PartialEq)]
pub struct Ros2 {
    /// DDS domain.
    pub domain_id: u16,
    /// Namespace of the node and of its relative names: `/`, or e.g. `/lab`.
    pub namespace: String,
    /// Name of the node, under which its own topics and services are: `/whichone/say`.
    pub node: String,
    /// How services are mapped to DDS topics.
    pub services: ServiceMapping,
    /// Networks on which the node is announced.
    pub network: Network,
    /// Objects from detectors.
    pub objects: Ros2Objects,
}

/// Mapping of services to DDS topics. It differs between middlewares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ServiceMapping {
    /// `rmw_fastrtps_cpp`, the default of ROS 2.
    Enhanced,
    /// `rmw_cyclonedds_cpp`.
    Cyclone,
}

/// Networks on which the node is announced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Network {
    /// This machine alone.
    Loopback,
    /// Every network of this machine.
    All,
    /// The network of the interface with this address.
    Interface(Ipv4Addr),
}

/// Reads the section.
pub(crate) fn read(f: &mut Fields<'_>) -> Ros2 {
    Ros2 {
        // More would need ports above 65535.
        domain_id: f.whole("domain_id", 0..=232),
        namespace: namespace(f),
        node: node(f),
        services: f.choice(
            "services",
            &[("enhanced", ServiceMapping::Enhanced), ("cyclone", ServiceMapping::Cyclone)],
        ),
        network: network(f),
        objects: f.table("objects", detectors::ros2),
    }
}

fn namespace(f: &mut Fields<'_>) -> String {
    let text = f.text("namespace");
    f.note("namespace", || json!({ "pattern": "^/$|^(/[A-Za-z_][A-Za-z0-9_]*)+$" }));
    let is_namespace = |parts: &str| parts.is_empty() || parts.split('/').all(is_name);
    let is_good = text.strip_prefix('/').is_some_and(is_namespace);
    if !is_good && !f.is_wrong("namespace") {
        let what = format!("`{text}` is not a ROS namespace");
        f.problem("namespace", what, "write \"/\", or e.g. \"/lab\": letters, digits and _");
    }
    text
}

fn node(f: &mut Fields<'_>) -> String {
    let text = f.text("node");
    f.note("node", || json!({ "pattern": "^[A-Za-z_][A-Za-z0-9_]{0,63}$" }));
    if !is_name(&text) && !f.is_wrong("node") {
        let what = format!("`{text}` is not a name of a ROS node");
        f.problem("node", what, "use letters, digits and _, e.g. \"whichone\"");
    }
    text
}

fn network(f: &mut Fields<'_>) -> Network {
    let text = f.text("network");
    f.note("network", || json!({ "pattern": "^(loopback|all|[0-9]+(\\.[0-9]+){3})$" }));
    match (text.as_str(), text.parse::<Ipv4Addr>()) {
        ("loopback", _) => Network::Loopback,
        ("all", _) => Network::All,
        (_, Ok(address)) => Network::Interface(address),
        (_, Err(_)) => {
            if !f.is_wrong("network") {
                let what = format!("`{text}` is neither a choice nor an IPv4 address");
                let help = "write \"loopback\", \"all\", or the address of one of this machine's interfaces";
                f.problem("network", what, help);
            }
            Network::Loopback
        }
    }
}

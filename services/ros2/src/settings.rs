//! `ros2.toml`: the ROS 2 node.

use std::net::Ipv4Addr;

use config::{Check, Section};
use diagnostics::Fields;
use ros::detectors::{self, Labels, topic};
use ros::is_name;
use serde_json::json;

/// Name of the service.
pub(crate) const NAME: &str = "ros2";

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

/// Detectors of ROS 2. A topic that is absent is not subscribed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ros2Objects {
    /// Topic of `vision_msgs/Detection3DArray`.
    pub detections: Option<String>,
    /// Topic of `ar_track_alvar_msgs/AlvarMarkers`.
    pub ar_markers: Option<String>,
    /// Topic of `tf2_msgs/TFMessage` with a frame for each marker, as apriltag_ros publishes them.
    pub tf: Option<String>,
    /// Identifiers.
    pub labels: Labels,
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

impl Ros2 {
    /// Name of a topic or service: own names are below the node's, `joint_states` is in its namespace.
    pub fn own_name(&self, name: &str) -> (String, String) {
        let namespace = self.namespace.trim_end_matches('/');
        (format!("{namespace}/{}", self.node), name.to_owned())
    }
}

impl Section for Ros2 {
    const KEY: &'static [&'static str] = &["ros2"];
    const FILE: Option<&'static str> = Some(include_str!("../../../config/ros2.toml"));

    fn read(f: &mut Fields<'_>) -> Self {
        Self {
            // More would need ports above 65535.
            domain_id: f.whole("domain_id", 0..=232),
            namespace: namespace(f),
            node: node(f),
            services: f.choice(
                "services",
                &[("enhanced", ServiceMapping::Enhanced), ("cyclone", ServiceMapping::Cyclone)],
            ),
            network: network(f),
            objects: f.table("objects", objects),
        }
    }

    fn check(&self, others: &mut Check<'_>) {
        let Ros2Objects { detections, ar_markers, tf, labels } = &self.objects;
        let topics = [("detections", detections), ("ar_markers", ar_markers), ("tf", tf)];
        detectors::check(&["ros2", "objects"], topics, labels, others);
    }
}

fn objects(f: &mut Fields<'_>) -> Ros2Objects {
    Ros2Objects {
        detections: topic(f, "detections"),
        ar_markers: topic(f, "ar_markers"),
        tf: topic(f, "tf"),
        labels: Labels::read(f),
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

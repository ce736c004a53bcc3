//! `console.toml`: the web page.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::time::Duration;

use diagnostics::Fields;
use serde_json::json;

/// Users who may use the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Users who have the group's token.
    Token,
    /// Every user and every program of this machine.
    Open,
}

/// The web page.
#[derive(Clone, Debug, PartialEq)]
pub struct Console {
    /// Address and port; port 0 for any free one.
    pub listen: SocketAddr,
    /// Users who may use the page; [`Access::Open`] only if `listen` accepts this machine alone.
    pub access: Access,
    /// Maximum number of open pages; one place is reserved for an operator.
    pub viewers_max: usize,
    /// Announce the console in the local network, unless `listen` accepts this machine alone.
    pub discovery: bool,
    /// Time after which a request for control is granted if the operator does not answer.
    pub handover: Duration,
    /// Language of the page, e.g. `en`.
    pub language: String,
    /// Origins, besides the console's own, whose pages may open the live view.
    pub foxglove_origins: Vec<String>,
    /// Operators may save scene files from the page and put them into force.
    pub edit_scenes: bool,
    /// A camera whose picture the page shows.
    pub camera: Option<Camera>,
}

/// A camera that browsers fetch pictures from.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Address of the picture or stream.
    pub url: String,
    /// Scheme, host and port of the address, as in a content security policy.
    pub origin: String,
    /// Time between two single pictures; `None` for a stream (MJPEG).
    pub every: Option<Duration>,
}

pub(crate) fn read(f: &mut Fields<'_>) -> Console {
    let listen = listen(f);
    let access = f.choice("access", &[("token", Access::Token), ("open", Access::Open)]);
    if !f.is_wrong("listen") && access == Access::Open && !listen.ip().is_loopback() {
        let what = format!("{} accepts other machines, and access is open", listen.ip());
        f.problem("listen", what, "set console.access = \"token\", or listen at 127.0.0.1");
    }
    Console {
        listen,
        access,
        viewers_max: usize::from(f.whole::<u16>("viewers_max", 2..=200)),
        discovery: f.flag("discovery"),
        handover: f.seconds("handover_s", 1.0..=300.0),
        language: language(f),
        foxglove_origins: foxglove_origins(f),
        edit_scenes: f.flag("edit_scenes"),
        camera: camera(f),
    }
}

impl Console {
    /// Returns why `discovery` has no effect, if it has none.
    pub(crate) fn unannounced(&self) -> Option<String> {
        let (ip, what) = (self.listen.ip(), "nothing is announced, as the console listens at");
        (self.discovery && ip.is_loopback()).then(|| format!("{what} {ip}"))
    }
}

fn foxglove_origins(f: &mut Fields<'_>) -> Vec<String> {
    let origins = f.texts("foxglove_origins");
    f.note("foxglove_origins", || {
        let origin = "^(file://|[A-Za-z0-9-]+://[A-Za-z0-9.:\\[\\]-]+)$";
        json!({ "items": { "type": "string", "pattern": origin } })
    });
    for origin in &origins {
        // `null` is the origin of pages that hide theirs; a star is a misunderstanding.
        let is_plain = |b: u8| b.is_ascii_alphanumeric() || b".-:[]".contains(&b);
        let is_origin = origin.split_once("://").is_some_and(|(scheme, host)| {
            !scheme.is_empty()
                && scheme.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-')
                && (!host.is_empty() || scheme == "file")
                && host.bytes().all(is_plain)
        });
        if !is_origin {
            let what = format!("`{origin}` is not the origin of a page");
            const HELP: &str = "write scheme, host and port, e.g. \"https://app.foxglove.dev\"";
            f.problem("foxglove_origins", what, HELP);
        }
    }
    origins
}

fn camera(f: &mut Fields<'_>) -> Option<Camera> {
    let url = f.optional_text("camera");
    f.note("camera", || {
        let host = "[A-Za-z0-9.-]+(:[0-9]{1,5})?";
        json!({ "pattern": format!("^$|^https?://{host}([/?#][^\\s\"'<>\\\\;,]*)?$") })
    });
    let every = f.seconds("camera_every_s", 0.0..=3600.0);
    let url = url?;
    match origin(&url) {
        Ok(origin) => Some(Camera { url, origin, every: (!every.is_zero()).then_some(every) }),
        Err(why) => {
            let what = format!("`{url}`: {why}");
            f.problem("camera", what, "write e.g. \"http://camera:8080/stream\"");
            None
        }
    }
}

/// Returns scheme, host and port of a web address.
fn origin(url: &str) -> Result<String, &'static str> {
    let (scheme, rest) =
        url.split_once("://").ok_or("expected an address that begins with http://")?;
    if !matches!(scheme, "http" | "https") {
        return Err("expected http:// or https://");
    }
    // It goes into the page, and its origin into the page's content security policy.
    let is_plain = |b: u8| b.is_ascii_graphic() && !br#""'<>\;,"#.contains(&b);
    if !url.bytes().all(is_plain) {
        return Err("expected no spaces, quotes, commas and semicolons: escape them, e.g. %20");
    }
    let authority = rest.split(['/', '?', '#']).next().unwrap_or_default();
    if authority.contains('@') {
        return Err("expected no user and password: every viewer would see them");
    }
    let (host, port) = match authority.split_once(':') {
        Some((host, port)) => (host, Some(port)),
        None => (authority, None),
    };
    // A policy names no IPv6 addresses.
    let is_host = |b: u8| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'-');
    if host.is_empty() || !host.bytes().all(is_host) {
        return Err("expected a host's name or IPv4 address after ://");
    }
    if port.is_some_and(|port| port.parse::<u16>().unwrap_or(0) == 0) {
        return Err("expected a port from 1 to 65535");
    }
    Ok(format!("{scheme}://{authority}"))
}

fn listen(f: &mut Fields<'_>) -> SocketAddr {
    let text = f.text("listen");
    f.note("listen", || json!({ "pattern": "^([0-9.]+|\\[[0-9A-Fa-f:.]+\\]):[0-9]{1,5}$" }));
    text.parse().unwrap_or_else(|_| {
        if !f.is_wrong("listen") {
            let what = format!("`{text}` is not an address with a port");
            f.problem("listen", what, "write e.g. \"127.0.0.1:8377\"");
        }
        SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 0)
    })
}

/// Reads the language, which is part of a path and so must be a plain name.
fn language(f: &mut Fields<'_>) -> String {
    let language = f.text("language");
    f.note("language", || json!({ "pattern": "^[A-Za-z0-9-]{1,16}$" }));
    let plain =
        language.len() <= 16 && language.chars().all(|c| c.is_ascii_alphanumeric() || c == '-');
    if !plain && !f.is_wrong("language") {
        let what = format!("`{language}` is not a language code");
        f.problem("language", what, "use e.g. \"en\"");
    }
    language
}

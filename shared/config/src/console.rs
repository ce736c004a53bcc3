//! `console.toml`: the web page.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::time::Duration;

use diagnostics::Fields;

/// Who may use the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Those who have the group's token.
    Token,
    /// Every user and every program of this machine.
    Open,
}

/// The web page.
#[derive(Clone, Debug, PartialEq)]
pub struct Console {
    /// Address and port; port 0 for any free one.
    pub listen: SocketAddr,
    /// Who may use the page; [`Access::Open`] only where `listen` accepts this machine alone.
    pub access: Access,
    /// Maximum number of open pages; one place is reserved for an operator.
    pub viewers_max: usize,
    /// Time after which a request for control is granted if the operator does not answer.
    pub handover: Duration,
    /// Language of the page, e.g. `en`.
    pub language: String,
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
        handover: f.seconds("handover_s", 1.0..=300.0),
        language: language(f),
    }
}

fn listen(f: &mut Fields<'_>) -> SocketAddr {
    let text = f.text("listen");
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
    let plain =
        language.len() <= 16 && language.chars().all(|c| c.is_ascii_alphanumeric() || c == '-');
    if !plain && !f.is_wrong("language") {
        let what = format!("`{language}` is not a language code");
        f.problem("language", what, "use e.g. \"en\"");
    }
    language
}

//! `console.toml`: where the operator's page is served, and to whom.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::time::Duration;

use diagnostics::Fields;

/// The operator's page.
#[derive(Clone, Debug, PartialEq)]
pub struct Console {
    /// Where it is served; port 0 stands for any.
    pub listen: SocketAddr,
    /// What a visitor has to know, if anything. Always there where `listen` is beyond this machine.
    pub token: Option<String>,
    /// Pages open at a time.
    pub viewers_max: usize,
    /// Time after which control goes to who asked for it, where its holder does not answer.
    pub handover: Duration,
    /// Language of the page, e.g. `en`.
    pub language: String,
}

pub(crate) fn read(f: &mut Fields<'_>) -> Console {
    let listen = listen(f);
    let token = token(f);
    if !f.is_wrong("listen")
        && !f.is_wrong("token")
        && token.is_none()
        && !listen.ip().is_loopback()
    {
        let what = format!("{} accepts other machines, and there is no token", listen.ip());
        f.problem("listen", what, "set console.token, or listen at 127.0.0.1");
    }
    Console {
        listen,
        token,
        viewers_max: usize::from(f.whole::<u16>("viewers_max", 1..=200)),
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

fn token(f: &mut Fields<'_>) -> Option<String> {
    let token = f.optional_text("token")?;
    let fits = (12..=200).contains(&token.len()) && token.chars().all(|c| c.is_ascii_graphic());
    if !fits {
        let help = "choose a longer one, or remove spaces and accents";
        f.problem("token", "expected 12 to 200 ASCII characters without spaces", help);
    }
    Some(token)
}

/// It is part of a path, so it must be a plain name.
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

//! Names whose values are secrets, in whatever syntax: TOML, JSON, logs, command lines, addresses.

/// What replaces a secret.
pub(crate) const LEFT_OUT: &str = "(left out)";

/// Endings of the names of secrets, in lower case and with `_` for `-`.
const ENDINGS: [&str; 14] = [
    "token",
    "secret",
    "password",
    "passwd",
    "passphrase",
    "passcode",
    "credential",
    "credentials",
    "cookie",
    "apikey",
    "_key",
    "authorization",
    "bearer",
    "pin",
];

/// Names that end so and are none.
const HARMLESS: [&str; 4] = ["dont_pin", "to_pin", "unknown_key", "idempotency_key"];

/// Longest distance of a value from its name, characters that are no blanks.
const GAP_MAX: usize = 8;

/// Replaces secrets that a name or a form gives away, and adds them to `found`.
pub(crate) fn without_secrets(text: &str, found: &mut Vec<String>) -> String {
    let clean = without_user_of_addresses(&without_named(text, found), found);
    without_pem(&without_schemes(&clean, found))
}

/// Replaces the values of names that are those of secrets.
fn without_named(text: &str, found: &mut Vec<String>) -> String {
    let mut clean = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(is_name_character) {
        let end =
            rest[start..].find(|it| !is_name_character(it)).map_or(rest.len(), |at| start + at);
        let name = &rest[start..end];
        clean.push_str(&rest[..end]);
        rest = &rest[end..];
        if let Some((gap, value)) = value_of(name, rest) {
            clean.push_str(&rest[..gap]);
            clean.push_str(LEFT_OUT);
            let value = &rest[gap..gap + value];
            found.extend(is_telling(value).then(|| value.to_owned()));
            rest = &rest[gap + value.len()..];
        }
    }
    clean + rest
}

fn is_name_character(it: char) -> bool {
    it.is_alphanumeric() || ['_', '-', '.'].contains(&it)
}

/// Whether a name is that of a secret; `key` alone is a setting's and a message's, too.
fn is_secret(name: &str) -> bool {
    let last = name.rsplit('.').find(|part| !part.is_empty()).unwrap_or(name);
    let last = last.trim_start_matches('-').to_lowercase().replace('-', "_");
    ENDINGS.iter().any(|ending| last.ends_with(ending)) && !HARMLESS.contains(&last.as_str())
}

/// Whether a value would be found in other places by accident: an ordinary word in a comment is.
fn is_telling(value: &str) -> bool {
    !value.chars().all(char::is_alphabetic)
}

/// The distance and the length of the value behind a secret's name, bytes.
fn value_of(name: &str, rest: &str) -> Option<(usize, usize)> {
    let is_option = name.starts_with("--");
    let is_dotted = name.contains('.');
    let gap = gap(rest);
    let between = &rest[..gap];
    // `key` is a secret's name where something is assigned to it: in TOML, or as an option.
    let is_assigned = between.contains('=') || is_option;
    let is_named =
        is_secret(name) || is_assigned && name.trim_start_matches('-').eq_ignore_ascii_case("key");
    // An option's value is the next word, or the next text of a list; so is that of `--set` in a status.
    let is_pair = between.contains([':', '=']) || is_option || is_dotted && between.contains("\",");
    if !is_named || !is_pair || gap == 0 {
        return None;
    }
    let len = value_len(&rest[gap..], between);
    (len > 0).then_some((gap, len))
}

/// Bytes between a name and its value: spaces, quotes and one sign.
fn gap(rest: &str) -> usize {
    let (mut has_sign, mut marks) = (false, 0);
    for (at, it) in rest.char_indices() {
        let is_sign = ['=', ':', ','].contains(&it);
        let is_blank = [' ', '\t'].contains(&it);
        let is_between = is_sign && !has_sign || is_blank || ['"', '\'', '\\'].contains(&it);
        marks += usize::from(!is_blank);
        if !is_between || marks > GAP_MAX {
            return at;
        }
        has_sign |= is_sign;
    }
    rest.len()
}

/// Bytes of a value: to the closing quote, or bracket, or the end of the word.
fn value_len(value: &str, between: &str) -> usize {
    for quotes in ["\"\"\"", "'''"] {
        if between.ends_with(quotes) {
            return value.find(quotes).unwrap_or(value.len());
        }
    }
    if value.starts_with(['[', '{']) {
        return value.find([']', '}']).map_or(value.len(), |at| at + 1);
    }
    match between.chars().next_back() {
        Some(quote @ ('"' | '\'')) => {
            let is_escaped = between.ends_with("\\\"");
            let mut escaped = false;
            let end = value.char_indices().find(|(_, it)| {
                let ends = *it == quote && (!escaped || is_escaped) || *it == '\n';
                escaped = *it == '\\' && !escaped;
                ends
            });
            // Of an escaped quote the backslash stays outside.
            let end = end.map_or(value.len(), |(at, _)| at);
            value[..end].strip_suffix('\\').filter(|_| is_escaped).map_or(end, str::len)
        }
        // The scheme of a header is followed by the secret.
        _ => {
            let word = word_len(value);
            let is_scheme = ["bearer", "basic"].contains(&value[..word].to_lowercase().as_str());
            let next = value[word..].len() - value[word..].trim_start_matches(' ').len();
            if is_scheme { word + next + word_len(&value[word + next..]) } else { word }
        }
    }
}

fn word_len(text: &str) -> usize {
    let is_end =
        |it: char| it.is_whitespace() || ['"', '\'', ',', ';', '&', '}', ']', ')'].contains(&it);
    text.find(is_end).unwrap_or(text.len())
}

/// User and password in addresses.
fn without_user_of_addresses(text: &str, found: &mut Vec<String>) -> String {
    let mut parts = text.split("://");
    let mut clean = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        clean.push_str("://");
        let is_end =
            |it: char| it.is_whitespace() || ['/', '"', '\'', '?', '#', '<', '>'].contains(&it);
        let authority = &part[..part.find(is_end).unwrap_or(part.len())];
        match authority.rfind('@') {
            Some(at) => {
                clean.push_str(LEFT_OUT);
                found.extend(authority[..at].rsplit(':').next().map(str::to_owned));
                clean.push_str(&part[at..]);
            }
            None => clean.push_str(part),
        }
    }
    clean
}

/// `Bearer SECRET` without a name before it.
fn without_schemes(text: &str, found: &mut Vec<String>) -> String {
    let mut clean = String::with_capacity(text.len());
    let mut rest = text;
    let next = |rest: &str| {
        let schemes = ["Bearer ", "bearer ", "Basic "].iter();
        schemes.filter_map(|it| Some(rest.find(it)? + it.len())).min()
    };
    while let Some(at) = next(rest) {
        clean.push_str(&rest[..at]);
        rest = &rest[at..];
        let len = word_len(rest);
        let is_secret = len >= 8 && !rest.starts_with(LEFT_OUT);
        clean.push_str(if is_secret { LEFT_OUT } else { &rest[..len] });
        found.extend(is_secret.then(|| rest[..len].to_owned()));
        rest = &rest[len..];
    }
    clean + rest
}

/// Private keys between the lines that mark them.
fn without_pem(text: &str) -> String {
    const BEGIN: &str = "PRIVATE KEY-----";
    const END: &str = "-----END";
    let mut clean = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(BEGIN) {
        let start = at + BEGIN.len();
        clean.push_str(&rest[..start]);
        rest = &rest[start..];
        if clean.ends_with(&format!("-----END {}", BEGIN)) {
            continue;
        }
        clean.push_str(LEFT_OUT);
        rest = &rest[rest.find(END).unwrap_or(rest.len())..];
    }
    clean + rest
}

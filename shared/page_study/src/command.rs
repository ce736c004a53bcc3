//! Commands of the study as pages send them.

use serde_json::Value as Json;

use super::study_controller::Command;

/// Longest reason that the experimenter may give, characters.
const WHY_MAX: usize = 200;

/// Returns the secret of a page.
pub(super) fn page(arguments: &Json) -> Result<String, String> {
    let page = arguments["page"].as_str().unwrap_or_default();
    if page.len() != 32 || !page.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return Err("page: expected 32 hexadecimal digits".to_owned());
    }
    Ok(page.to_owned())
}

/// Reads a command.
pub fn read(verb: &str, arguments: &Json) -> Result<Command, String> {
    let text = |key: &str| {
        let text = arguments[key].as_str().filter(|text| !text.trim().is_empty());
        text.map(str::to_owned).ok_or_else(|| format!("{key}: expected a text"))
    };
    Ok(match verb {
        "begin" => Command::Begin,
        "resume" => Command::Resume(text("participant")?),
        "consent" => Command::Consent,
        "next" => Command::Next,
        "start" => Command::Start,
        "answer" => match &arguments["answers"] {
            Json::Object(answers) => Command::Answer(answers.clone()),
            _ => return Err("answers: expected an object".to_owned()),
        },
        "withdraw" => Command::Withdraw(arguments["delete"].as_bool().unwrap_or(false)),
        "close" => Command::Close(text("participant")?),
        "spoilt" => {
            let why = text("why").unwrap_or_else(|_| "the experimenter said so".to_owned());
            Command::Spoilt(text("participant")?, why.chars().take(WHY_MAX).collect())
        }
        "delete" => Command::Delete(text("participant")?),
        other => {
            return Err(format!(
                "unknown command study.{other}; help: use find, begin, resume, consent, next, start, \
                 answer, withdraw, close, spoilt and delete"
            ));
        }
    })
}

/// Returns an unpredictable seed.
pub(super) fn seed() -> u64 {
    let key = service::client::random_key().0;
    key.iter().take(8).fold(0, |seed, byte| (seed << 8) | u64::from(*byte))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn study_commands_are_read_with_their_arguments() {
        assert_eq!(read("next", &json!({})), Ok(Command::Next));
        assert_eq!(read("withdraw", &json!({ "delete": true })), Ok(Command::Withdraw(true)));
        let spoilt = read("spoilt", &json!({ "participant": "ABCDEF" })).unwrap();
        assert_eq!(spoilt, Command::Spoilt("ABCDEF".into(), "the experimenter said so".into()));
        for (verb, arguments) in
            [("answer", json!({})), ("resume", json!({ "participant": " " })), ("dance", json!({}))]
        {
            assert!(read(verb, &arguments).is_err(), "{verb}");
        }
        assert!(page(&json!({ "page": "ab".repeat(16) })).is_ok());
        assert!(page(&json!({ "page": "no" })).is_err());
        assert_ne!(seed(), seed());
    }
}

//! What browsers send to the console.

use std::path::{Component, Path};

use ::console::inputs::{Do, Message, PcmFrame, Verb, hello, message, say};
use messages::SoundFile;
use page_study::read_command;
use recording::live::{Request, read_binary, read_text};
use service::Time;
use web_server::login::form_field;

use super::bytes::{Input, chosen};

/// The server's clock: 1,000 s.
const NOW: Time = Time(1_000_000_000_000);

pub(super) fn run(input: &[u8]) {
    let mut input = Input(input);
    let kind = input.byte() % 7;
    let text = String::from_utf8_lossy(input.0);
    match kind {
        0 => greeted(&text),
        1 => said(&text),
        2 => sounded(input.0),
        3 => drop(form_field(&text, "token")),
        4 => contained(&text),
        5 => drop(read_text(&text)),
        _ => called(input.0),
    }
}

fn greeted(text: &str) {
    match hello(text) {
        Ok(hello) => {
            assert_eq!(hello.session.len(), 32);
            assert!(hello.name.chars().count() <= 40);
        }
        Err(why) => assert!(!why.is_empty()),
    }
}

fn said(text: &str) {
    match message(text, NOW) {
        Ok(Message::Do(_, Do::Ask(Verb::Say(words)))) => {
            assert!(!words.text.trim().is_empty() && words.alternatives.len() <= 5);
            let fits = |(text, weight): &(String, f64)| {
                !text.is_empty() && weight.is_finite() && *weight > 0.0
            };
            assert!(words.alternatives.iter().all(fits));
            assert!(words.began <= words.ended || words.ended.is_none());
            assert!(words.began.max(words.ended).is_none_or(|at| at <= NOW));
        }
        Ok(Message::Do(_, Do::Ask(Verb::Study(verb, arguments)))) => {
            let _ = read_command(&verb, &arguments);
        }
        Ok(Message::Wrong(_, why)) | Err(why) => assert!(!why.is_empty()),
        Ok(_) => {}
    }
}

fn sounded(bytes: &[u8]) {
    match PcmFrame::read(bytes) {
        Ok(frame) => assert!(frame.samples.len() * 2 + 24 == bytes.len()),
        Err(why) => assert!(!why.is_empty()),
    }
}

/// A message of a live viewer: what it calls for is words, or nothing.
fn called(bytes: &[u8]) {
    match read_binary(bytes) {
        Ok(Request::Call(call)) => match say::read(&call.request) {
            Ok(words) => assert!(!words.text.trim().is_empty() && words.alternatives.is_empty()),
            Err(why) => assert!(!why.is_empty()),
        },
        Ok(other) => panic!("{other:?}"),
        Err(why) => assert!(!why.is_empty()),
    }
}

/// Checks that no name leads out of the folder.
fn contained(name: &str) {
    if let Some(file) = SoundFile::parse(name) {
        let file = file.to_string();
        let mut parts = Path::new(&file).components();
        assert!(matches!(parts.next(), Some(Component::Normal(_))) && parts.next().is_none());
    }
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let messages = [
        r#"{"t":"ping","at":17.5}"#,
        r#"{"t":"do","id":3,"do":"say","text":"the red one","source":"browser","began_ms":999000.5,"ended_ms":999900,"alternatives":[{"text":"the bed one","weight":0.2}]}"#,
        r#"{"t":"do","id":1,"do":"not_that"}"#,
        r#"{"t":"do","id":1,"do":"start_over"}"#,
        r#"{"t":"do","id":1,"do":"stop"}"#,
        r#"{"t":"do","id":2,"do":"resume"}"#,
        r#"{"t":"do","id":4,"do":"take_control"}"#,
        r#"{"t":"do","id":5,"do":"give_control","viewer":"v3"}"#,
        r#"{"t":"do","id":6,"do":"restart_service","service":"policy"}"#,
        r#"{"t":"do","id":7,"do":"study.answer","page":"0123","answers":{"ease":4,"why":"good"}}"#,
        r#"{"t":"do","id":8,"do":"study.spoilt","participant":"ABCDEF","why":"noise"}"#,
    ];
    let mut seeds: Vec<_> = messages.iter().map(|text| chosen(1, text)).collect();
    let hello = r#"{"t":"hello","protocol":2,"session":"0123456789abcdef0123456789ABCDEF","name":"Ada","last_line":7,"role":"operator"}"#;
    seeds.push(chosen(0, hello));
    let mut sound = vec![1, 3, 0, 0, 7, 0, 0, 0];
    sound.extend(1.5_f64.to_le_bytes());
    sound.extend(3_200_u64.to_le_bytes());
    sound.extend([1, 2, 3, 4]);
    seeds.push(chosen(2, sound));
    seeds.push(chosen(3, "a=b&token=p%26a+b%25%C3%A9"));
    seeds.push(chosen(4, "line-12-1.wav"));
    for text in [
        r#"{"op":"subscribe","subscriptions":[{"id":0,"channelId":3}]}"#,
        r#"{"op":"unsubscribe","subscriptionIds":[0]}"#,
        r#"{"op":"getParameters","parameterNames":["/scene"],"id":"x"}"#,
        r#"{"op":"setParameters","parameters":[{"name":"/scene","value":1}],"id":"x"}"#,
    ] {
        seeds.push(chosen(5, text));
    }
    let mut call = vec![2, 1, 0, 0, 0, 9, 0, 0, 0, 4, 0, 0, 0];
    call.extend(br#"json{"text":"the clear bowl","key":"one"}"#);
    seeds.push(chosen(6, call));
    seeds
}

//! Message types for other languages, generated from the wire layout: `shared/sdk/python/whichone/messages.py` and
//! `shared/sdk/c/whichone.h`. `WHICHONE_BLESS=1 cargo test -p whichone-sdk --test bindings` rewrites them.

#![allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod c;
mod docs;
#[path = "../../../../messages/tests/layouts/mod.rs"]
mod layouts;
mod model;
mod python;

use docs::Docs;
use model::Model;

const SDK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

#[track_caller]
fn check(file: &str, text: &str) {
    let path = std::path::Path::new(SDK).join(file);
    if std::env::var_os("WHICHONE_BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, text).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    let line = text.lines().zip(found.lines()).position(|(ours, theirs)| ours != theirs);
    assert!(
        text == found,
        "shared/sdk/{file} is not that of this wire layout (first difference in line {}); help: see the head of {}",
        line.unwrap_or(text.lines().count().min(found.lines().count())) + 1,
        file!()
    );
}

#[test]
fn python_messages_are_those_of_the_wire_layout() {
    check("python/whichone/messages.py", &python::text(&Model::read(), &Docs::read()));
}

/// Sizes and offsets are assertions in the header.
#[test]
fn c_header_is_that_of_the_wire_layout_and_compiles() {
    check("c/whichone.h", &c::text(&Model::read(), &Docs::read()));
    let header = format!("{SDK}/c/whichone.h");
    let mut compiler = std::process::Command::new("cc");
    compiler.args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-x", "c", &header]);
    // Rust links with the same program.
    let ended = compiler.output().expect("cc is installed");
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
}

#[test]
fn fields_of_messages_are_documented() {
    let (model, docs) = (Model::read(), Docs::read());
    for message in &model.structs {
        assert!(!docs.of(&message.rust).is_empty(), "{}", message.rust);
        for (field, ..) in &message.fields {
            assert!(!docs.of_field(&message.rust, field).is_empty(), "{}.{field}", message.rust);
        }
    }
    assert!(docs.of_field("PolicyView", "belief").contains("Probability"));
    assert!(docs.of_field("Sound", "longest_s").contains("seconds"));
}

//! The layout for viewers names topics, fields and panels that exist.

#![allow(clippy::unwrap_used, reason = "tests")]

use recording::channels::{self, Channel, ROS2MSG};
use serde_json::Value;

const LAYOUT: &str = include_str!("../../../docs/recording-layout.json");

/// Texts that begin with a slash, keys too: topics, perhaps with a field.
fn paths(value: &Value, found: &mut Vec<String>) {
    match value {
        Value::String(text) if text.starts_with('/') => found.push(text.clone()),
        Value::Array(items) => items.iter().for_each(|item| paths(item, found)),
        Value::Object(entries) => {
            for (key, value) in entries {
                found.extend(key.starts_with('/').then(|| key.clone()));
                paths(value, found);
            }
        }
        _ => {}
    }
}

/// Whether messages of the channel have a field.
fn has_field(channel: &Channel, field: &str) -> bool {
    let name = field.split(['.', '[', '{']).next().unwrap();
    if channel.schema_encoding == ROS2MSG {
        // Before the first of the types in it.
        let own = channel.definition.split("====").next().unwrap();
        return own.lines().any(|line| line.split(' ').nth(1) == Some(name));
    }
    let schema: Value = serde_json::from_str(&channel.definition).unwrap();
    schema["properties"].get(name).is_some()
}

#[test]
fn every_topic_and_field_of_the_layout_is_recorded() {
    let layout: Value = serde_json::from_str(LAYOUT).unwrap();
    let mut found = Vec::new();
    paths(&layout, &mut found);
    let channels = channels::all();
    for path in &found {
        let (topic, field) = path
            .split_once('.')
            .map_or((path.as_str(), None), |(topic, field)| (topic, Some(field)));
        let channel = channels.iter().find(|channel| channel.topic == topic);
        let channel = channel.unwrap_or_else(|| panic!("no topic {topic}"));
        if let Some(field) = field {
            assert!(has_field(channel, field), "{topic} has no {field}");
        }
    }
    for shown in
        ["/robot_description", "/joint_states", "/scene", "/dialogue", "/log", "/policy/view"]
    {
        assert!(found.iter().any(|path| path == shown), "{shown} is not shown");
    }
}

#[test]
fn every_panel_is_placed_once() {
    let layout: Value = serde_json::from_str(LAYOUT).unwrap();
    fn placed<'a>(node: &'a Value, found: &mut Vec<&'a str>) {
        match node.as_str() {
            Some(panel) => found.push(panel),
            None => ["first", "second"].iter().for_each(|part| placed(&node[part], found)),
        }
    }
    let mut found = Vec::new();
    placed(&layout["layout"], &mut found);
    found.sort_unstable();
    let mut panels: Vec<&str> =
        layout["configById"].as_object().unwrap().keys().map(String::as_str).collect();
    panels.sort_unstable();
    assert_eq!(found, panels);
}

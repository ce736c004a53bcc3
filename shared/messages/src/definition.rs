//! Descriptions of message types for programs that do not share this code: ROS 2 message
//! definitions of fixed layouts, whose bytes are CDR as they lie, and the types in payloads.
//!
//! A fixed layout has no implicit padding and its fields are aligned to their size, as CDR
//! prescribes. So a message is CDR once four bytes for "plain, little-endian" precede it.

use serde_reflection::Registry;

/// Package of the message types in ROS 2 message definitions.
const PACKAGE: &str = "whichone";
/// Line between a definition and those of the types in it.
const SEPARATOR: &str =
    "================================================================================";

/// Description of a message type.
#[derive(Clone, Debug, PartialEq)]
pub enum Definition {
    /// A fixed layout: a ROS 2 message definition, with those of the types in it.
    Ros2Msg(String),
    /// A payload in postcard: every type in it.
    Payload(Registry),
}

/// Type of a field as a ROS 2 message definition has it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FieldType {
    /// A primitive type, or a message type with its package.
    pub name: String,
    /// Number of elements of an array field.
    pub count: Option<usize>,
    /// The codes of an enum, with their names.
    pub constants: Vec<(&'static str, u8)>,
    /// Message types that the definition needs, with their own definitions.
    pub nested: Vec<(String, String)>,
}

impl FieldType {
    /// A primitive type.
    pub fn primitive(name: &str) -> Self {
        Self { name: name.to_owned(), ..Self::default() }
    }

    /// A message type of this package with these fields.
    pub fn message(name: &str, fields: &[(&str, Self)]) -> Self {
        let mut text = String::new();
        let mut nested: Vec<(String, String)> = Vec::new();
        for (field, ty) in fields {
            for (constant, code) in &ty.constants {
                let (field, constant) = (upper(field), upper(constant));
                text += &format!("{} {field}_{constant}={code}\n", ty.name);
            }
            let count = ty.count.map(|count| format!("[{count}]")).unwrap_or_default();
            text += &format!("{}{count} {field}\n", ty.name);
            for one in &ty.nested {
                if !nested.contains(one) {
                    nested.push(one.clone());
                }
            }
        }
        let name = format!("{PACKAGE}/{name}");
        nested.insert(0, (name.clone(), text));
        Self { name, nested, ..Self::default() }
    }

    /// An array of `count` of these; arrays of arrays are one, element after element.
    #[must_use]
    pub fn array(mut self, count: usize) -> Self {
        self.count = Some(count * self.count.unwrap_or(1));
        self
    }

    /// The definition of a message type, with those of the types in it.
    pub fn definition(&self) -> Definition {
        let mut parts = self.nested.iter();
        let mut text = parts.next().map(|(_, own)| own.clone()).unwrap_or_default();
        for (name, own) in parts {
            text += &format!("{SEPARATOR}\nMSG: {name}\n{own}");
        }
        Definition::Ros2Msg(text)
    }
}

/// `MotionInhibit` and `hindrance` as constants have them: `MOTION_INHIBIT`, `HINDRANCE`.
fn upper(name: &str) -> String {
    let mut text = String::new();
    for (i, letter) in name.char_indices() {
        if i > 0 && letter.is_ascii_uppercase() {
            text.push('_');
        }
        text.push(letter.to_ascii_uppercase());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::Schema;
    use crate::topics::{self, Topic};
    use crate::{ArmStatus, AudioChunk, RobotAct};

    fn ros2<T: Schema>() -> String {
        match T::definition() {
            Definition::Ros2Msg(text) => text,
            Definition::Payload(types) => panic!("{types:?}"),
        }
    }

    #[test]
    fn layouts_become_ros2_definitions_with_nested_types_and_constants() {
        let text = ros2::<RobotAct>();
        let (own, nested) = text.split_once(SEPARATOR).unwrap();
        assert!(own.contains("uint8 KIND_PUT_BACK=5\n"), "{own}");
        assert!(own.contains(
            "\nuint8 kind\nuint8 in_words\nuint8[2] reserved\nwhichone/Question question\n"
        ));
        assert!(own.ends_with("whichone/Text244 text\n"), "{own}");
        assert!(nested.contains("MSG: whichone/Question\nuint16 kind\n"), "{nested}");
        assert!(nested.contains("MSG: whichone/Text244\nuint32 len\nuint8[244] bytes\n"));
        assert!(ros2::<AudioChunk>().ends_with("int16[1600] samples\n"));
        assert!(ros2::<ArmStatus>().contains("uint8 HINDRANCE_CALIBRATING=7\nuint8 hindrance\n"));
    }

    #[test]
    fn every_topic_has_a_definition_of_its_encoding() {
        for Topic { name, layout, definition, .. } in topics::ALL.iter().chain(&topics::robot::ALL)
        {
            match definition() {
                Definition::Ros2Msg(text) => {
                    assert!(layout().is_some() && !text.is_empty(), "{name}")
                }
                Definition::Payload(types) => {
                    assert!(layout().is_none() && !types.is_empty(), "{name}");
                }
            }
        }
    }
}

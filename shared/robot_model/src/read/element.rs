//! XML elements with their checks; an invalid attribute is reported and read as a harmless value.

use std::cell::RefCell;
use std::rc::Rc;

use diagnostics::{Diagnostic, Diagnostics, Report, TextFile};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use roxmltree::{Document as Xml, Node};

/// Longest length in a description, metres: longer ones are mistakes, and ways are divided into steps of millimetres.
const LENGTH_M_MAX: f64 = 100.0;

/// A document and its problems.
pub(super) struct Log<'a> {
    file: &'a str,
    xml: &'a Xml<'a>,
    report: RefCell<Report>,
}

/// An element of the document.
#[derive(Clone)]
pub(super) struct Element<'a> {
    pub(super) node: Node<'a, 'a>,
    /// The described part in diagnostics, e.g. `joint "left_s0"`.
    pub(super) label: Rc<str>,
    pub(super) log: &'a Log<'a>,
}

/// Parses the XML of a file.
pub(super) fn document(file: &TextFile) -> Result<Xml<'_>, Diagnostic> {
    Xml::parse(&file.text).map_err(|error| {
        let what = format!("malformed XML: {error}");
        Diagnostic::new(&file.label, "document", what, "correct the markup there")
            .at(Some(error.pos().row))
    })
}

impl<'a> Log<'a> {
    pub(super) fn new(file: &'a TextFile, xml: &'a Xml<'a>) -> Self {
        Self { file: &file.label, xml, report: RefCell::default() }
    }

    /// Number of problems so far.
    pub(super) fn count(&self) -> usize {
        self.report.borrow().count()
    }

    /// Returns `value` if there is no problem.
    ///
    /// # Errors
    /// Every problem, by line.
    pub(super) fn verdict<T>(&self, value: Option<T>) -> Result<T, Diagnostics> {
        let mut report = self.report.take();
        report.sort_by_line();
        report.verdict(value)
    }

    /// Returns the root element; reports anything but `<robot>`.
    pub(super) fn root(&'a self) -> Option<Element<'a>> {
        let node = self.xml.root_element();
        let root = Element { node, label: "robot".into(), log: self };
        if !node.has_tag_name("robot") {
            let found = format!("it begins with <{}>", root.tag());
            let help = "its first element must be <robot name=\"…\">";
            root.labelled("document").problem(found, help);
            return None;
        }
        Some(root)
    }
}

impl<'a> Element<'a> {
    /// Reports a problem at the line of the element.
    pub(super) fn problem(&self, what: impl Into<String>, help: impl Into<String>) {
        let line = self.log.xml.text_pos_at(self.node.range().start).row;
        let problem = Diagnostic::new(self.log.file, &*self.label, what, help).at(Some(line));
        self.log.report.borrow_mut().add(problem);
    }

    /// Reports the value of an attribute.
    pub(super) fn unreadable(&self, key: &str, help: &str) {
        let text = self.attribute(key).unwrap_or_default();
        self.problem(format!("<{}> has {key}={text:?}", self.tag()), help);
    }

    pub(super) fn labelled(self, label: impl Into<Rc<str>>) -> Self {
        Self { label: label.into(), ..self }
    }

    pub(super) fn tag(&self) -> &'a str {
        self.node.tag_name().name()
    }

    pub(super) fn attribute(&self, key: &str) -> Option<&'a str> {
        self.node.attribute(key)
    }

    /// Every child element, as a part of this one.
    pub(super) fn all_children(&self) -> impl Iterator<Item = Self> {
        let own = self.clone();
        let elements = self.node.children().filter(Node::is_element);
        elements.map(move |node| Self { node, ..own.clone() })
    }

    /// The child elements of that name.
    pub(super) fn children(&self, name: &'static str) -> impl Iterator<Item = Self> {
        self.all_children().filter(move |child| child.tag() == name)
    }

    /// The first child element of that name.
    pub(super) fn child(&self, name: &'static str) -> Option<Self> {
        self.children(name).next()
    }

    /// A child element that must be there.
    pub(super) fn part(&self, name: &'static str, help: &str) -> Option<Self> {
        let found = self.child(name);
        if found.is_none() {
            self.problem(format!("it has no <{name}>"), help);
        }
        found
    }

    /// Returns the element's name, and the element labelled with it.
    pub(super) fn named(self) -> (&'a str, Self) {
        let tag = self.tag();
        let element = self.labelled(tag);
        let name = element.name();
        let label = if name.is_empty() { tag.to_owned() } else { format!("{tag} {name:?}") };
        (name, element.labelled(label))
    }

    /// Returns the attribute `name`; reports a missing one.
    pub(super) fn name(&self) -> &'a str {
        let name = self.attribute("name").unwrap_or_default().trim();
        if name.is_empty() {
            self.problem("it has no name", "write name=\"…\"");
        }
        name
    }

    /// A text that must be there.
    pub(super) fn text(&self, key: &str) -> &'a str {
        let text = self.attribute(key).unwrap_or_default().trim();
        if text.is_empty() {
            self.missing(key, "…");
        }
        text
    }

    /// A number that must be there.
    pub(super) fn number(&self, key: &str) -> f64 {
        self.number_if_any(key).unwrap_or_else(|| {
            self.missing(key, "a number");
            0.0
        })
    }

    /// A number that may be left out.
    pub(super) fn number_if_any(&self, key: &str) -> Option<f64> {
        let text = self.attribute(key)?;
        Some(finite(text.trim()).unwrap_or_else(|| {
            self.unreadable(key, "write one finite number");
            0.0
        }))
    }

    /// A length that may be left out, metres; reports what no robot has.
    pub(super) fn length_if_any(&self, key: &str) -> Option<f64> {
        self.number_if_any(key).map(|length_m| self.checked(key, length_m))
    }

    /// Returns a length, metres; reports one that no robot has.
    pub(super) fn checked(&self, key: &str, length_m: f64) -> f64 {
        if length_m.abs() <= LENGTH_M_MAX {
            return length_m;
        }
        let mm = length_m / 1e3;
        let help = match mm.abs() {
            ..=LENGTH_M_MAX => format!("lengths are in metres: {mm} if it is {length_m} mm"),
            _ => format!("lengths are in metres, at most {LENGTH_M_MAX}"),
        };
        self.unreadable(key, &help);
        0.0
    }

    /// A number that must be there and be greater than 0 (or 0, where `zero` allows it).
    pub(super) fn magnitude(&self, key: &str, zero: bool) -> f64 {
        let before = self.log.count();
        let number = self.number(key);
        if self.log.count() == before && (number < 0.0 || (number == 0.0 && !zero)) {
            let least = if zero { "it must be 0 or more" } else { "it must be more than 0" };
            self.unreadable(key, least);
        }
        number
    }

    /// `N` numbers with white space between them, if the attribute is there.
    pub(super) fn numbers_if_any<const N: usize>(&self, key: &str) -> Option<[f64; N]> {
        let numbers: Option<Vec<f64>> =
            self.attribute(key)?.split_whitespace().map(finite).collect();
        Some(numbers.and_then(|numbers| numbers.try_into().ok()).unwrap_or_else(|| {
            self.unreadable(key, &format!("write {N} finite numbers with spaces between them"));
            [0.0; N]
        }))
    }

    /// The `<origin>` of the element; the identity if there is none.
    pub(super) fn origin(&self) -> Isometry3<f64> {
        let Some(origin) = self.child("origin") else { return Isometry3::identity() };
        let place = origin.numbers_if_any("xyz").unwrap_or_default();
        let [x, y, z] = place.map(|length_m| origin.checked("xyz", length_m));
        let [roll, pitch, yaw] = origin.numbers_if_any("rpy").unwrap_or_default();
        let rotation = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        Isometry3::from_parts(Translation3::new(x, y, z), rotation)
    }

    fn missing(&self, key: &str, what: &str) {
        self.problem(format!("<{}> has no {key}", self.tag()), format!("write {key}=\"{what}\""));
    }
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

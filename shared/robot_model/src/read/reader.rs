//! Attributes with their checks; an invalid one is reported and read as a harmless value.

use diagnostics::{Diagnostic, Diagnostics, Report, TextFile};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use roxmltree::{Document as Xml, Node};

pub(super) struct Reader<'a> {
    file: &'a str,
    xml: &'a Xml<'a>,
    report: Report,
}

/// Parses the XML of a file.
pub(super) fn document(file: &TextFile) -> Result<Xml<'_>, Diagnostic> {
    Xml::parse(&file.text).map_err(|error| {
        let what = format!("malformed XML: {error}");
        Diagnostic::new(&file.label, "document", what, "correct the markup there")
            .at(Some(error.pos().row))
    })
}

/// The child elements of that name.
pub(super) fn children<'a>(
    node: Node<'a, 'a>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'a>> {
    node.children().filter(move |child| child.has_tag_name(name))
}

/// The first child element of that name.
pub(super) fn child<'a>(node: Node<'a, 'a>, name: &'static str) -> Option<Node<'a, 'a>> {
    children(node, name).next()
}

impl<'a> Reader<'a> {
    pub(super) fn new(file: &'a TextFile, xml: &'a Xml<'a>) -> Self {
        Self { file: &file.label, xml, report: Report::default() }
    }

    /// Reports a problem with `element` at the line of `node`.
    pub(super) fn problem(
        &mut self,
        node: Node<'_, '_>,
        element: &str,
        what: impl Into<String>,
        help: impl Into<String>,
    ) {
        let line = self.xml.text_pos_at(node.range().start).row;
        self.report.add(Diagnostic::new(self.file, element, what, help).at(Some(line)));
    }

    /// Number of problems so far.
    pub(super) fn count(&self) -> usize {
        self.report.count()
    }

    /// Returns `value` if there is no problem.
    ///
    /// # Errors
    /// Every problem, by line.
    pub(super) fn verdict<T>(mut self, value: Option<T>) -> Result<T, Diagnostics> {
        self.report.sort_by_line();
        self.report.verdict(value)
    }

    /// Returns the root element; reports anything but `<robot>`.
    pub(super) fn root(&mut self) -> Node<'a, 'a> {
        let root = self.xml.root_element();
        if !root.has_tag_name("robot") {
            let found = format!("it begins with <{}>", root.tag_name().name());
            self.problem(root, "document", found, "its first element must be <robot name=\"…\">");
        }
        root
    }

    /// Returns the element's name, and the name of the element in diagnostics.
    pub(super) fn named(&mut self, node: Node<'a, 'a>) -> (&'a str, String) {
        let kind = node.tag_name().name();
        let name = self.name(node, kind);
        (name, if name.is_empty() { kind.to_owned() } else { format!("{kind} {name:?}") })
    }

    /// Returns the attribute `name`; reports a missing one.
    pub(super) fn name(&mut self, node: Node<'a, 'a>, element: &str) -> &'a str {
        let name = node.attribute("name").unwrap_or_default().trim();
        if name.is_empty() {
            self.problem(node, element, "it has no name", "write name=\"…\"");
        }
        name
    }

    /// A text that must be there.
    pub(super) fn text(&mut self, node: Node<'a, 'a>, element: &str, key: &str) -> &'a str {
        match node.attribute(key).map(str::trim) {
            Some(text) if !text.is_empty() => text,
            _ => {
                self.missing(node, element, key, "…");
                ""
            }
        }
    }

    /// A number that must be there.
    pub(super) fn number(&mut self, node: Node<'a, 'a>, element: &str, key: &str) -> f64 {
        match self.number_if_any(node, element, key) {
            Some(number) => number,
            None => {
                self.missing(node, element, key, "a number");
                0.0
            }
        }
    }

    /// A number that may be left out.
    pub(super) fn number_if_any(
        &mut self,
        node: Node<'a, 'a>,
        element: &str,
        key: &str,
    ) -> Option<f64> {
        let text = node.attribute(key)?;
        Some(finite(text.trim()).unwrap_or_else(|| {
            self.unreadable(node, element, key, text, "write one finite number");
            0.0
        }))
    }

    /// A number that must be there and be greater than 0 (or 0, where `zero` allows it).
    pub(super) fn magnitude(
        &mut self,
        node: Node<'a, 'a>,
        element: &str,
        key: &str,
        zero: bool,
    ) -> f64 {
        let before = self.count();
        let number = self.number(node, element, key);
        if self.count() == before && (number < 0.0 || (number == 0.0 && !zero)) {
            let least = if zero { "0 or more" } else { "more than 0" };
            self.unreadable(
                node,
                element,
                key,
                &number.to_string(),
                &format!("it must be {least}"),
            );
        }
        number
    }

    /// `N` numbers with white space between them, if the attribute is there.
    pub(super) fn numbers_if_any<const N: usize>(
        &mut self,
        node: Node<'a, 'a>,
        element: &str,
        key: &str,
    ) -> Option<[f64; N]> {
        let text = node.attribute(key)?;
        let numbers: Option<Vec<f64>> = text.split_whitespace().map(finite).collect();
        Some(numbers.and_then(|numbers| numbers.try_into().ok()).unwrap_or_else(|| {
            let help = format!("write {N} finite numbers with spaces between them");
            self.unreadable(node, element, key, text, &help);
            [0.0; N]
        }))
    }

    /// The `<origin>` of an element; the identity if there is none.
    pub(super) fn origin(&mut self, node: Node<'a, 'a>, element: &str) -> Isometry3<f64> {
        let Some(origin) = child(node, "origin") else { return Isometry3::identity() };
        let [x, y, z] = self.numbers_if_any(origin, element, "xyz").unwrap_or_default();
        let [roll, pitch, yaw] = self.numbers_if_any(origin, element, "rpy").unwrap_or_default();
        Isometry3::from_parts(
            Translation3::new(x, y, z),
            UnitQuaternion::from_euler_angles(roll, pitch, yaw),
        )
    }

    /// A child element that must be there.
    pub(super) fn part(
        &mut self,
        node: Node<'a, 'a>,
        element: &str,
        name: &'static str,
        help: &str,
    ) -> Option<Node<'a, 'a>> {
        let found = child(node, name);
        if found.is_none() {
            self.problem(node, element, format!("it has no <{name}>"), help);
        }
        found
    }

    fn missing(&mut self, node: Node<'_, '_>, element: &str, key: &str, what: &str) {
        let tag = node.tag_name().name();
        self.problem(
            node,
            element,
            format!("<{tag}> has no {key}"),
            format!("write {key}=\"{what}\""),
        );
    }

    pub(super) fn unreadable(
        &mut self,
        node: Node<'_, '_>,
        element: &str,
        key: &str,
        text: &str,
        help: &str,
    ) {
        let tag = node.tag_name().name();
        self.problem(node, element, format!("<{tag}> has {key}={text:?}"), help);
    }
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

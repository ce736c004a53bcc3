//! Links: mass, shapes and colours.

use std::collections::HashMap;

use diagnostics::suggestion;
use nalgebra::{Matrix3, Vector3};
use roxmltree::Node;

use crate::model::{Body, Inertial, Link, Rgba, Shape};

use super::reader::{Reader, child, children};

/// Colours by name; a material may also be a picture, which has none.
pub(super) type Materials<'a> = HashMap<&'a str, Option<Rgba>>;

pub(super) fn read<'a>(
    reader: &mut Reader<'a>,
    node: Node<'a, 'a>,
    materials: &mut Materials<'a>,
) -> Link {
    let (name, element) = reader.named(node);
    let inertial = child(node, "inertial").map(|node| inertial(reader, node, &element));
    let collision =
        children(node, "collision").filter_map(|node| body(reader, node, &element, None)).collect();
    let visual = children(node, "visual")
        .filter_map(|node| {
            let colour = child(node, "material")
                .and_then(|node| colour_of(reader, node, &element, materials));
            body(reader, node, &element, colour)
        })
        .collect();
    Link { name: name.to_owned(), inertial, collision, visual }
}

/// Adds a material that the whole description may use.
pub(super) fn material<'a>(
    reader: &mut Reader<'a>,
    node: Node<'a, 'a>,
    materials: &mut Materials<'a>,
) {
    let (name, element) = reader.named(node);
    let colour = child(node, "color").map(|colour| rgba(reader, colour, &element));
    materials.insert(name, colour);
}

/// The colour of a visual: its material's own, or that of an earlier material of the same name.
fn colour_of<'a>(
    reader: &mut Reader<'a>,
    node: Node<'a, 'a>,
    element: &str,
    materials: &mut Materials<'a>,
) -> Option<Rgba> {
    let name = node.attribute("name").unwrap_or_default();
    if let Some(colour) = child(node, "color") {
        let colour = rgba(reader, colour, element);
        materials.entry(name).or_insert(Some(colour));
        return Some(colour);
    }
    if child(node, "texture").is_some() {
        materials.entry(name).or_insert(None);
    }
    let known = materials.get(name).copied();
    if known.is_none() {
        let what = format!("<material> {name:?} is not defined");
        let otherwise = "give it a <color rgba=\"…\"/>, or leave it out";
        let help = suggestion(name, materials.keys().copied(), || otherwise.to_owned());
        reader.problem(node, element, what, help);
    }
    known.flatten()
}

fn rgba<'a>(reader: &mut Reader<'a>, node: Node<'a, 'a>, element: &str) -> Rgba {
    let Some(rgba) = reader.numbers_if_any::<4>(node, element, "rgba") else {
        reader.problem(
            node,
            element,
            "<color> has no rgba",
            "write rgba=\"red green blue opacity\"",
        );
        return Rgba::default();
    };
    if rgba.iter().any(|part| !(0.0..=1.0).contains(part)) {
        let text = node.attribute("rgba").unwrap_or_default();
        reader.unreadable(node, element, "rgba", text, "each of its numbers must be 0 to 1");
    }
    rgba
}

fn inertial<'a>(reader: &mut Reader<'a>, node: Node<'a, 'a>, element: &str) -> Inertial {
    let origin = reader.origin(node, element);
    let mass = reader
        .part(node, element, "mass", "write <mass value=\"…\"/> in kg into its <inertial>")
        .map_or(0.0, |mass| reader.magnitude(mass, element, "value", true));
    let inertia = reader
        .part(node, element, "inertia", "write <inertia ixx=… ixy=… ixz=… iyy=… iyz=… izz=…/>")
        .map_or_else(Matrix3::zeros, |inertia| {
            let mut of = |key| reader.number(inertia, element, key);
            let [xx, xy, xz] = [of("ixx"), of("ixy"), of("ixz")];
            let [yy, yz, zz] = [of("iyy"), of("iyz"), of("izz")];
            Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
        });
    Inertial { origin, mass, inertia }
}

fn body<'a>(
    reader: &mut Reader<'a>,
    node: Node<'a, 'a>,
    element: &str,
    colour: Option<Rgba>,
) -> Option<Body> {
    let origin = reader.origin(node, element);
    let kind = node.tag_name().name();
    let help =
        format!("write what the <{kind}> is, e.g. <geometry><sphere radius=\"…\"/></geometry>");
    let geometry = reader.part(node, element, "geometry", &help)?;
    let Some(shape) = geometry.children().find(Node::is_element) else {
        reader.problem(geometry, element, "<geometry> is empty", help);
        return None;
    };
    let shape = read_shape(reader, shape, element)?;
    Some(Body { origin, shape, colour })
}

fn read_shape<'a>(reader: &mut Reader<'a>, node: Node<'a, 'a>, element: &str) -> Option<Shape> {
    Some(match node.tag_name().name() {
        "box" => {
            let Some(size) = reader.numbers_if_any::<3>(node, element, "size") else {
                reader.problem(
                    node,
                    element,
                    "<box> has no size",
                    "write size=\"x y z\" in metres",
                );
                return None;
            };
            if size.iter().any(|edge| *edge < 0.0) {
                let text = node.attribute("size").unwrap_or_default();
                reader.unreadable(node, element, "size", text, "each edge must be 0 or more");
            }
            Shape::Box { size: Vector3::from(size) }
        }
        "cylinder" => Shape::Cylinder {
            radius: reader.magnitude(node, element, "radius", false),
            length: reader.magnitude(node, element, "length", true),
        },
        "capsule" => Shape::Capsule {
            radius: reader.magnitude(node, element, "radius", false),
            length: reader.magnitude(node, element, "length", true),
        },
        "sphere" => Shape::Sphere { radius: reader.magnitude(node, element, "radius", false) },
        "mesh" => Shape::Mesh { file: reader.text(node, element, "filename").to_owned() },
        other => {
            let what = format!("<geometry> has the unknown shape <{other}>");
            let help = "use <box>, <cylinder>, <capsule>, <sphere> or <mesh>";
            reader.problem(node, element, what, help);
            return None;
        }
    })
}

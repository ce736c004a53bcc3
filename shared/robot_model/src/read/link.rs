//! Links: mass, shapes and colours.

use std::collections::HashMap;

use diagnostics::suggestion;
use nalgebra::{Matrix3, Vector3};

use crate::model::{Body, Inertial, Link, Rgba, Shape};

use super::element::Element;

/// Colours by name; a material may also be a picture, which has none.
pub(super) type Materials<'a> = HashMap<&'a str, Option<Rgba>>;

pub(super) fn read<'a>(link: Element<'a>, materials: &mut Materials<'a>) -> (Link, Element<'a>) {
    let (name, element) = link.named();
    let inertial = element.child("inertial").map(|own| inertial(&own));
    let collision = element.children("collision").filter_map(|own| body(&own, None)).collect();
    let visual = element.children("visual").filter_map(|own| {
        let colour = own.child("material").and_then(|material| colour_of(&material, materials));
        body(&own, colour)
    });
    let visual = visual.collect();
    (Link { name: name.to_owned(), inertial, collision, visual }, element)
}

/// Adds a material that the whole description may use.
pub(super) fn material<'a>(material: Element<'a>, materials: &mut Materials<'a>) {
    let (name, element) = material.named();
    materials.insert(name, element.child("color").map(|colour| rgba(&colour)));
}

/// The colour of a visual: its material's own, or that of an earlier material of the same name.
fn colour_of<'a>(material: &Element<'a>, materials: &mut Materials<'a>) -> Option<Rgba> {
    let name = material.attribute("name").unwrap_or_default();
    if let Some(colour) = material.child("color") {
        let colour = rgba(&colour);
        materials.entry(name).or_insert(Some(colour));
        return Some(colour);
    }
    if material.child("texture").is_some() {
        materials.entry(name).or_insert(None);
    }
    let known = materials.get(name).copied();
    if known.is_none() {
        let otherwise = "give it a <color rgba=\"…\"/>, or leave it out";
        let help = suggestion(name, materials.keys().copied(), || otherwise.to_owned());
        material.problem(format!("<material> {name:?} is not defined"), help);
    }
    known.flatten()
}

fn rgba(colour: &Element<'_>) -> Rgba {
    let Some(rgba) = colour.numbers_if_any::<4>("rgba") else {
        colour.problem("<color> has no rgba", "write rgba=\"red green blue opacity\"");
        return Rgba::default();
    };
    if rgba.iter().any(|part| !(0.0..=1.0).contains(part)) {
        colour.unreadable("rgba", "each of its numbers must be 0 to 1");
    }
    rgba
}

fn inertial(own: &Element<'_>) -> Inertial {
    let origin = own.origin();
    let mass = own.part("mass", "write <mass value=\"…\"/> in kg into its <inertial>");
    let mass = mass.map_or(0.0, |mass| mass.magnitude("value", true));
    let inertia = own.part("inertia", "write <inertia ixx=… ixy=… ixz=… iyy=… iyz=… izz=…/>");
    let inertia = inertia.map_or_else(Matrix3::zeros, |inertia| {
        let [xx, xy, xz, yy, yz, zz] =
            ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"].map(|key| inertia.number(key));
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    });
    Inertial { origin, mass, inertia }
}

fn body(own: &Element<'_>, colour: Option<Rgba>) -> Option<Body> {
    let origin = own.origin();
    let kind = own.tag();
    let help =
        format!("write what the <{kind}> is, e.g. <geometry><sphere radius=\"…\"/></geometry>");
    let geometry = own.part("geometry", &help)?;
    let Some(shape) = geometry.all_children().next() else {
        geometry.problem("<geometry> is empty", help);
        return None;
    };
    Some(Body { origin, shape: read_shape(&shape)?, colour })
}

fn read_shape(shape: &Element<'_>) -> Option<Shape> {
    let radius = || shape.checked("radius", shape.magnitude("radius", false));
    let length = || shape.checked("length", shape.magnitude("length", true));
    Some(match shape.tag() {
        "box" => {
            let Some(size) = shape.numbers_if_any::<3>("size") else {
                shape.problem("<box> has no size", "write size=\"x y z\" in metres");
                return None;
            };
            if size.iter().any(|edge| *edge < 0.0) {
                shape.unreadable("size", "each edge must be 0 or more");
            }
            Shape::Box { size: Vector3::from(size.map(|edge| shape.checked("size", edge))) }
        }
        "cylinder" => Shape::Cylinder { radius: radius(), length: length() },
        "capsule" => Shape::Capsule { radius: radius(), length: length() },
        "sphere" => Shape::Sphere { radius: radius() },
        "mesh" => Shape::Mesh { file: shape.text("filename").to_owned() },
        other => {
            let what = format!("<geometry> has the unknown shape <{other}>");
            shape.problem(what, "use <box>, <cylinder>, <capsule>, <sphere> or <mesh>");
            return None;
        }
    })
}

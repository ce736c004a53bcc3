//! COLLADA: positions of geometries where the scene's nodes put them.
//!
//! The unit counts. The up axis does not: ROS's viewers, for which these files are made, take no notice of it.

use std::collections::HashMap;

use nalgebra::{Matrix4, Point3, Rotation3, Unit, Vector3};
use roxmltree::{Document, Node, ParsingOptions};

/// Most levels of nodes.
const DEPTH_MAX: usize = 64;

type Geometries = HashMap<String, Vec<Vector3<f64>>>;

/// Returns the vertices, metres.
///
/// # Errors
/// The text is not XML.
pub(super) fn vertices(text: &str) -> Result<Vec<Vector3<f64>>, String> {
    let text = text.trim_start_matches('\u{feff}');
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options);
    let document = document.map_err(|error| format!("not XML: {error}"))?;
    let root = document.root_element();
    let unit = named(root, "unit").find_map(|unit| unit.attribute("meter")?.parse::<f64>().ok());
    let geometries: Geometries = named(root, "geometry")
        .filter_map(|geometry| Some((geometry.attribute("id")?.to_owned(), positions(geometry))))
        .collect();
    let mut all = Vec::new();
    for scene in named(root, "visual_scene") {
        for node in scene.children().filter(|node| is(*node, "node")) {
            place(node, &Matrix4::identity(), &geometries, 0, &mut all);
        }
    }
    if all.is_empty() {
        all = geometries.into_values().flatten().collect();
    }
    Ok(all.into_iter().map(|at: Vector3<f64>| at * unit.unwrap_or(1.0)).collect())
}

fn is(node: Node<'_, '_>, name: &str) -> bool {
    node.is_element() && node.tag_name().name() == name
}

fn named<'a, 'i: 'a>(node: Node<'a, 'i>, name: &'a str) -> impl Iterator<Item = Node<'a, 'i>> + 'a {
    node.descendants().filter(move |node| is(*node, name))
}

fn numbers(node: Node<'_, '_>) -> Vec<f64> {
    let text = node.text().unwrap_or_default();
    text.split_whitespace().filter_map(|part| part.parse().ok()).collect()
}

/// Positions of a geometry: the sources that its `vertices` name so.
fn positions(geometry: Node<'_, '_>) -> Vec<Vector3<f64>> {
    let inputs = named(geometry, "vertices").flat_map(|vertices| named(vertices, "input"));
    let inputs = inputs.filter(|input| input.attribute("semantic") == Some("POSITION"));
    let names: Vec<&str> =
        inputs.filter_map(|input| input.attribute("source")?.strip_prefix('#')).collect();
    let sources = named(geometry, "source")
        .filter(|source| source.attribute("id").is_some_and(|id| names.contains(&id)));
    let arrays = sources.flat_map(|source| named(source, "float_array"));
    arrays.flat_map(numbers_by_three).collect()
}

fn numbers_by_three(array: Node<'_, '_>) -> Vec<Vector3<f64>> {
    numbers(array).chunks_exact(3).map(Vector3::from_column_slice).collect()
}

fn place(
    node: Node<'_, '_>,
    above: &Matrix4<f64>,
    geometries: &Geometries,
    depth: usize,
    all: &mut Vec<Vector3<f64>>,
) {
    if depth > DEPTH_MAX {
        return;
    }
    let own = node.children().filter_map(transform).fold(*above, |pose, step| pose * step);
    for child in node.children() {
        if is(child, "instance_geometry") {
            let name = child.attribute("url").and_then(|url| url.strip_prefix('#'));
            let vertices = name.and_then(|name| geometries.get(name)).into_iter().flatten();
            all.extend(vertices.map(|at| own.transform_point(&Point3::from(*at)).coords));
        } else if is(child, "node") {
            place(child, &own, geometries, depth + 1, all);
        }
    }
}

fn transform(node: Node<'_, '_>) -> Option<Matrix4<f64>> {
    let (name, numbers) = (node.tag_name().name(), numbers(node));
    match (name, &numbers[..]) {
        ("matrix", rows) if rows.len() == 16 => Some(Matrix4::from_row_slice(rows)),
        ("translate", [x, y, z]) => Some(Matrix4::new_translation(&Vector3::new(*x, *y, *z))),
        ("scale", [x, y, z]) => Some(Matrix4::new_nonuniform_scaling(&Vector3::new(*x, *y, *z))),
        ("rotate", [x, y, z, degrees]) => {
            let axis = Unit::try_new(Vector3::new(*x, *y, *z), 1e-9)?;
            Some(Rotation3::from_axis_angle(&axis, degrees.to_radians()).to_homogeneous())
        }
        _ => None,
    }
}

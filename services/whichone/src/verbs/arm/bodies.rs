//! What robot and objects look like.

use manipulation::ObjectPose;
use nalgebra::{Isometry3, Vector3};
use robot_model::{Body, Shape};
use scene::ObjectId;
use solid::{Mesh, Paint, Rgb};

use super::pick::Pick;

/// Colours by the names that scenes give them.
const COLOURS: [(&str, Rgb); 16] = [
    ("white", [0.94, 0.94, 0.92]),
    ("black", [0.12, 0.12, 0.13]),
    ("grey", [0.55, 0.56, 0.58]),
    ("gray", [0.55, 0.56, 0.58]),
    ("red", [0.80, 0.16, 0.15]),
    ("orange", [0.92, 0.50, 0.12]),
    ("yellow", [0.93, 0.80, 0.20]),
    ("green", [0.22, 0.60, 0.30]),
    ("blue", [0.16, 0.36, 0.75]),
    ("purple", [0.50, 0.26, 0.62]),
    ("pink", [0.93, 0.55, 0.66]),
    ("brown", [0.46, 0.30, 0.20]),
    ("metallic", [0.66, 0.68, 0.71]),
    ("silver", [0.66, 0.68, 0.71]),
    ("clear", [0.66, 0.82, 0.90]),
    ("transparent", [0.66, 0.82, 0.90]),
];
/// Of what has no colour of its own.
const PLAIN: Rgb = [0.78, 0.66, 0.50];
const SEE_THROUGH: [&str; 2] = ["clear", "transparent"];
const SHINY: [&str; 2] = ["metallic", "silver"];

/// How a robot whose description gives no colours is painted.
const BARE: Rgb = [0.55, 0.57, 0.60];

/// The links of the robot: all, or those alone that the fetching limb moves.
pub(super) fn robot(pick: &Pick<'_>, t_s: f64, moving_alone: bool) -> Mesh {
    let poses = pick.links(t_s);
    let mut mesh = Mesh::default();
    for (index, link) in pick.robot.description().links().iter().enumerate() {
        if moving_alone && !pick.moves_with_limb(index) {
            continue;
        }
        let mut seen = link.visual.iter().filter_map(body).collect::<Vec<_>>();
        if seen.is_empty() {
            // What is drawn from files only is shown by the room that it takes.
            let enclosing = if link.visual.is_empty() { &[][..] } else { &link.collision[..] };
            seen.extend(enclosing.iter().filter_map(body));
        }
        for part in seen {
            mesh.add(part.placed(&poses[index]).part(1 + index as u32));
        }
    }
    mesh
}

fn body(body: &Body) -> Option<Mesh> {
    let [r, g, b, _] = body.colour.unwrap_or([BARE[0], BARE[1], BARE[2], 1.0]);
    let paint = Paint { gloss: 0.35, ..Paint::new([r, g, b]) };
    let mesh = match &body.shape {
        Shape::Box { size } => Mesh::cuboid(size, paint),
        Shape::Cylinder { radius, length } => Mesh::cylinder(*radius, *length, paint),
        Shape::Capsule { radius, length } => Mesh::capsule(*radius, *length, paint),
        Shape::Sphere { radius } => Mesh::ball(*radius, paint),
        Shape::Mesh { .. } => return None,
    };
    Some(mesh.placed(&body.origin))
}

/// An object about its own frame, and whether it is seen through.
pub(super) fn object(pick: &Pick<'_>, index: usize) -> (Mesh, bool) {
    let values = values(pick, index);
    let known = COLOURS.iter().find(|(name, _)| values.contains(name));
    let is = |names: &[&str]| names.iter().any(|name| values.contains(name));
    let rgb = known.map_or(PLAIN, |(_, rgb)| *rgb);
    let gloss = if is(&SHINY) || is(&SEE_THROUGH) { 0.9 } else { 0.3 };
    let paint = Paint { gloss, ..Paint::new(rgb) };
    let mesh = form(&pick.places[index], values.contains(&"round"), paint);
    (mesh.part(10_000 + index as u32), is(&SEE_THROUGH))
}

/// The names of an object's values.
fn values<'a>(pick: &'a Pick<'_>, index: usize) -> Vec<&'a str> {
    let object = pick.scene.object(ObjectId::from(index));
    let named = pick.scene.attributes().iter().zip(&object.values);
    named.filter_map(|(k, v)| Some(k.values[(*v)?.index()].name.as_str())).collect()
}

fn form(place: &ObjectPose, is_round: bool, paint: Paint) -> Mesh {
    let [x, y, z] = place.size_m;
    let across = x.min(y);
    if is_round && z < 0.75 * across {
        return Mesh::bowl(0.5 * across, z, (0.06 * across).max(place.grasp_width_m), paint);
    }
    if is_round {
        return Mesh::cylinder(0.5 * across, z, paint);
    }
    let longest = x.max(y).max(z);
    let others = x + y + z - longest;
    if longest < 1.5 * others {
        return Mesh::cuboid(&Vector3::new(x, y, z), paint);
    }
    // Long and thin: pens, handles.
    let turn = match longest {
        long if long == x => Vector3::y() * std::f64::consts::FRAC_PI_2,
        long if long == y => Vector3::x() * std::f64::consts::FRAC_PI_2,
        _ => Vector3::zeros(),
    };
    Mesh::cylinder(0.25 * others, longest, paint).placed(&Isometry3::rotation(turn))
}

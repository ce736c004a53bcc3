//! The objects as markers, with the belief as colour, and as frames. Where they come from perception, they are
//! those of the table, where they are estimated to be.

use crate::types::{
    Color, Header, Marker, MarkerArray, Pose, TfMessage, Time, TransformStamped, Vector3,
};
use messages::WorldView;
use scene::{ObjectId, Scene};
use service::view::LatestTopics;

/// Frame of the objects: the robot's base.
pub const BASE: &str = "base";
/// Extents of an object whose size is not known, metres.
const UNKNOWN_SIZE: [f64; 3] = [0.05; 3];
/// Height of the letters above an object, metres.
const LETTERS_M: f64 = 0.03;

/// Returns the colour of a probability: from blue at 0 over green to red at 1, and more opaque.
fn color(p: f64) -> Color {
    let p = p.clamp(0.0, 1.0) as f32;
    let (r, b) = ((2.0 * p - 1.0).max(0.0), (1.0 - 2.0 * p).max(0.0));
    Color { r, g: 1.0 - r - b, b, a: 0.4 + 0.6 * p }
}

/// Poses of the objects that are there, with their indices. A world of another scene has none.
fn placed<'a>(scene: &Scene, world: &'a WorldView) -> impl Iterator<Item = (usize, Pose)> + 'a {
    let is_of_scene = world.objects.len() == scene.objects().len();
    let poses = world.objects.iter().filter(move |_| is_of_scene).enumerate();
    poses.filter_map(|(at, pose)| Some((at, Pose::from((*pose)?))))
}

/// The world's objects in the order of the scene that `latest` shows.
pub fn located(latest: &LatestTopics, world: &WorldView) -> WorldView {
    latest.table().map_or_else(|| world.clone(), |table| table.world(world))
}

/// All markers: a box and a text for each object that is there. `belief` is in the scene's order; where
/// it is shorter the probability is 0. The array removes those before, so the latest one is whole.
pub fn markers(scene: &Scene, world: &WorldView, belief: &[f64]) -> MarkerArray {
    // Without a stamp the newest transform counts, so that one that joins late can show them.
    let header = || Header { frame_id: BASE.to_owned(), ..Header::default() };
    let clear = Marker {
        header: header(),
        action: Marker::DELETE_ALL,
        pose: Pose::IDENTITY,
        ..Marker::default()
    };
    let mut markers = vec![clear];
    for (at, pose) in placed(scene, world) {
        let object = &scene.objects()[at];
        let size = object.placement.map_or(UNKNOWN_SIZE, |placement| placement.size);
        let p = belief.get(at).copied().filter(|p| p.is_finite()).unwrap_or(0.0);
        let marker = |ns: &str, kind| Marker {
            header: header(),
            ns: ns.to_owned(),
            // Never reused, also where objects come and go.
            id: scene.number(ObjectId::from(at)).0.into(),
            kind,
            action: Marker::ADD,
            pose,
            color: color(p),
            ..Marker::default()
        };
        markers.push(Marker { scale: size.into(), ..marker("object", Marker::CUBE) });
        let mut label = marker("name", Marker::TEXT);
        label.pose.position.z += size[2] / 2.0 + LETTERS_M;
        label.scale = Vector3 { z: LETTERS_M, ..Vector3::default() };
        label.color = Color { r: 1.0, g: 1.0, b: 1.0, a: 1.0 };
        label.text = format!("{} {:.0} %", object.name, 100.0 * p);
        markers.push(label);
    }
    MarkerArray { markers }
}

/// A frame `object/NAME` for each object that is there, as it was at `stamp`.
pub fn frames(scene: &Scene, world: &WorldView, stamp: Time) -> TfMessage {
    let frame = |(at, transform): (usize, Pose)| TransformStamped {
        header: Header { stamp, frame_id: BASE.to_owned() },
        child_frame_id: format!("object/{}", scene.objects()[at].name),
        transform,
    };
    TfMessage { transforms: placed(scene, world).map(frame).collect() }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::types::Point;

    fn scene() -> Scene {
        Scene::from_toml("b", include_str!("../../../config/scenes/bowls.toml")).unwrap()
    }

    fn world() -> WorldView {
        let pose = |x: usize| Some([x as f64, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0]);
        let mut objects: Vec<_> = (0..6).map(pose).collect();
        objects[2] = None;
        WorldView { objects, ..WorldView::default() }
    }

    #[test]
    fn markers_show_the_belief_and_leave_out_what_was_handed_over() {
        let MarkerArray { markers } = markers(&scene(), &world(), &[0.0, 1.0, 0.5, f64::NAN]);
        assert_eq!(markers.len(), 1 + 2 * 5);
        assert_eq!(markers[0].action, Marker::DELETE_ALL);
        assert!(markers.iter().all(|marker| marker.header.frame_id == "base" && marker.id != 2));
        let boxes: Vec<_> = markers.iter().filter(|marker| marker.ns == "object").collect();
        assert_eq!(boxes[0].color, Color { r: 0.0, g: 0.0, b: 1.0, a: 0.4 });
        assert_eq!(boxes[1].color, Color { r: 1.0, g: 0.0, b: 0.0, a: 1.0 });
        let size = scene().objects()[1].placement.unwrap().size;
        assert_eq!(boxes[1].scale, size.into());
        let texts = markers.iter().filter(|marker| marker.kind == Marker::TEXT);
        let texts: Vec<_> = texts.map(|marker| marker.text.as_str()).collect();
        assert_eq!(texts[1], "white2 100 %");
        assert_eq!(texts[2], "metal 0 %");
    }

    #[test]
    fn markers_of_perceived_objects_have_their_numbers_and_places() {
        let seen = |number: u16, class: &str| scene::Perceived {
            number: ObjectId(number),
            name: format!("{class}-{number}"),
            classes: vec![(class.to_owned(), 1.0)],
            attributes: Vec::new(),
            xyz: [0.7, 0.1, -0.1],
            yaw: 0.0,
            seen_by: Vec::new(),
            taken: false,
        };
        let table = scene().with_objects(&[seen(6, "white"), seen(9, "clear")]);
        let pose = Some([0.65, 0.25, -0.12, 0.0, 0.0, 0.0, 1.0]);
        let world = WorldView { objects: vec![None, pose], ..WorldView::default() };
        let MarkerArray { markers } = markers(&table, &world, &[0.0, 1.0]);
        assert_eq!(markers.len(), 3, "number 6 is not there any more");
        assert_eq!([markers[1].id, markers[2].id], [9, 9]);
        assert_eq!(markers[1].pose.position, Point { x: 0.65, y: 0.25, z: -0.12 });
        assert_eq!(
            markers[1].scale,
            Vector3 { x: 0.18, y: 0.18, z: 0.07 },
            "the size of its class"
        );
        assert_eq!(markers[2].text, "clear-9 100 %");
        let TfMessage { transforms } = frames(&table, &world, Time::default());
        assert_eq!(transforms[0].child_frame_id, "object/clear-9");
    }

    #[test]
    fn frames_have_the_objects_names_and_another_scene_has_none() {
        let TfMessage { transforms } = frames(&scene(), &world(), Time { sec: 1, nanosec: 2 });
        assert_eq!(transforms.len(), 5);
        assert_eq!(transforms[1].child_frame_id, "object/white2");
        assert_eq!(transforms[1].transform.position, Point { x: 1.0, y: 0.0, z: 0.5 });
        let other = WorldView { objects: vec![None; 5], ..WorldView::default() };
        assert!(frames(&scene(), &other, Time::default()).transforms.is_empty());
    }
}

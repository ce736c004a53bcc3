use nalgebra::{Isometry3, Vector3};

use crate::{Camera, Image, Layer, Mesh, Paint, Sheet, render};

const WHITE: [f64; 3] = [1.0; 3];
const RED: [f64; 3] = [1.0, 0.0, 0.0];
const BLUE: [f64; 3] = [0.0, 0.0, 1.0];

/// From x = 4 m towards the origin.
fn camera() -> Camera {
    let (eye, target) = (Vector3::new(4.0, 0.0, 0.0), Vector3::zeros());
    Camera { eye, target, up: Vector3::z(), height_rad: 0.5 }
}

fn sheet() -> Sheet {
    Sheet { size: (60, 40), samples: 2, ground: WHITE, ground_z: -5.0 }
}

fn board(x: f64, y: f64, rgb: [f64; 3]) -> Mesh {
    let board = Mesh::cuboid(&Vector3::new(0.02, 0.6, 0.6), Paint::glowing(rgb));
    board.placed(&Isometry3::translation(x, y, 0.0))
}

fn solid(meshes: &[Mesh]) -> Vec<Layer> {
    meshes.iter().map(|mesh| Layer { mesh: mesh.clone(), opacity: 1.0 }).collect()
}

fn draw(layers: &[Layer]) -> Image {
    render(layers, &camera(), &sheet())
}

#[test]
fn the_nearer_hides_the_farther_in_any_order() {
    let (near, far) = (board(0.5, 0.2, RED), board(-0.5, -0.2, BLUE));
    let one = draw(&solid(&[near.clone(), far.clone()]));
    let other = draw(&solid(&[far, near]));
    assert_eq!(one, other);
    assert_eq!(one.pixel(30, 20), [255, 0, 0], "both are in the middle");
    // Seen from the front, the robot's left is at the picture's right.
    assert_eq!(one.pixel(23, 20), [0, 0, 255]);
    assert_eq!(one.pixel(40, 20), [255, 0, 0]);
    assert_eq!(one.pixel(2, 2), [255; 3]);
}

/// Painting whole faces from back to front would show one board whole.
#[test]
fn boards_that_cross_hide_each_other_by_halves() {
    let turned = |angle: f64, rgb| {
        let turn = Isometry3::new(Vector3::zeros(), Vector3::new(0.0, 0.0, angle));
        Mesh::cuboid(&Vector3::new(0.02, 0.8, 0.6), Paint::glowing(rgb)).placed(&turn)
    };
    let image = draw(&solid(&[turned(0.6, RED), turned(-0.6, BLUE)]));
    let (left, right) = (image.pixel(24, 20), image.pixel(36, 20));
    assert!(left != right && [left, right].contains(&[255, 0, 0]), "{left:?} {right:?}");
    assert!([left, right].contains(&[0, 0, 255]));
}

#[test]
fn a_ghost_is_seen_through_and_hidden_behind_what_is_solid() {
    let over = |x| {
        let ghost = Layer { mesh: board(x, 0.0, BLUE), opacity: 0.5 };
        let mut layers = solid(&[board(0.0, 0.0, RED)]);
        layers.push(ghost);
        draw(&layers).pixel(30, 20)
    };
    assert_eq!(over(-0.5), [255, 0, 0]);
    let [red, green, blue] = over(0.5);
    assert!(red == blue && red > 150 && green == 0, "{:?}", over(0.5));
}

#[test]
fn what_keeps_the_sun_off_throws_a_shadow() {
    let sheet = Sheet { ground_z: -0.3, ..sheet() };
    let camera = Camera { eye: Vector3::new(4.0, 0.0, 2.0), ..camera() };
    let brightness = |layers: &[Layer], place: Vector3<f64>| {
        let image = render(layers, &camera, &sheet);
        let (x, y, _) = camera.project(&place, sheet.size).unwrap();
        image.pixel(x as usize, y as usize)[0]
    };
    let ball = Mesh::ball(0.15, Paint::new(RED));
    // The sun stands behind the viewer's left, so that the shadow falls to the other side.
    let behind = Vector3::new(-0.11, -0.12, -0.3);
    let light = brightness(&[], behind);
    assert_eq!(light, 255);
    let far = Vector3::new(-0.11, 0.5, -0.3);
    let layers = solid(&[ball]);
    assert_eq!(brightness(&layers, far), 255);
    assert!(brightness(&layers, behind) < 250, "{}", brightness(&layers, behind));
}

#[test]
fn the_lit_side_of_a_ball_is_the_brighter() {
    let image = draw(&solid(&[Mesh::ball(0.4, Paint::dull([0.6; 3]))]));
    let [above, below] =
        [image.pixel(30, 16), image.pixel(30, 24)].map(|pixel| u32::from(pixel[0]));
    assert!(above > below + 20, "{above} {below}");
}

#[test]
fn places_are_where_they_are_drawn() {
    let mark = Mesh::ball(0.03, Paint::glowing(RED));
    let place = Vector3::new(0.3, 0.25, -0.12);
    let image = draw(&solid(&[mark.placed(&Isometry3::from(place))]));
    let (x, y, distance) = camera().project(&place, (60, 40)).unwrap();
    assert_eq!(image.pixel(x as usize, y as usize), [255, 0, 0]);
    assert!((distance - 3.7).abs() < 1e-9);
    assert_eq!(camera().project(&Vector3::new(5.0, 0.0, 0.0), (60, 40)), None);
}

/// Closed bodies: every edge belongs to two faces, so the faces' directions cancel.
#[test]
fn bodies_are_closed() {
    let paint = Paint::new(RED);
    let bodies = [
        Mesh::cuboid(&Vector3::new(0.3, 0.2, 0.1), paint),
        Mesh::cylinder(0.2, 0.5, paint),
        Mesh::capsule(0.1, 0.3, paint),
        Mesh::ball(0.2, paint),
    ];
    for mesh in bodies {
        let out: Vector3<f64> = mesh
            .triangles
            .iter()
            .map(|t| {
                let area = (t.corners[1] - t.corners[0]).cross(&(t.corners[2] - t.corners[0]));
                area * area.dot(&t.normals[0]).signum()
            })
            .sum();
        assert!(out.norm() < 1e-9, "{out}");
    }
    let bowl = Mesh::bowl(0.09, 0.07, 0.008, paint);
    let span =
        |axis: usize| bowl.triangles.iter().flat_map(|t| t.corners).map(move |p| p[axis].abs());
    assert!((span(2).fold(0.0, f64::max) - 0.035).abs() < 1e-12);
    assert!((span(0).fold(0.0, f64::max) - 0.09).abs() < 1e-12);
    assert!(bowl.triangles.iter().all(|t| t.normals.iter().all(|n| (n.norm() - 1.0).abs() < 1e-9)));
}

//! The picture of a pick: two views of robot and scene, the phases, and the motion in time.

use evaluation::charts::{Align, BLACK, Canvas, GREY, Ink, PlotError, Raster, Size};
use manipulation::PickPhase;
use nalgebra::Vector3;
use solid::{Camera, Layer, Mesh, Paint, Rgb, Sheet, render};

use super::pick::{PHASES, Pick, ink};
use super::strip::{self, Frame};
use super::{bodies, furniture};

/// Height of the picture over its width.
const SHAPE: f64 = 0.78;
/// Share of the width that the view from the person's side takes.
const WIDE: f64 = 0.64;
/// How much of a ghost is seen.
const GHOST: f64 = 0.30;
/// How much a ghost takes on the colour of its phase.
const TINT: f64 = 0.6;
/// Lowest bits of a colour that are not told apart.
const STEP: u8 = 3;
/// Height of a line of names.
const LINE: f64 = 10.0;
const WAY_M: f64 = 0.006;
const PAPER: [f64; 3] = [0.965, 0.967, 0.97];

/// Draws it so many pixels wide, with so many samples along either side of a pixel.
///
/// # Errors
/// It cannot be encoded.
pub(super) fn draw(pick: &Pick<'_>, pixels: u32, samples: u8) -> Result<Canvas, PlotError> {
    let width = 0.5 * f64::from(pixels);
    let height = (SHAPE * width).round();
    let mut canvas = Canvas::new(width, height);
    let object = &pick.scene.object(pick.object.into()).name;
    let (scene, limb) = (pick.scene.name(), pick.plan.limb());
    let title = format!("Fetching {object} from the scene {scene} with the {limb} arm");
    canvas.words((16.0, 20.0), &title, Align::Left, Size::Large, BLACK);
    let top = legend(&mut canvas, pick, 44.0, width) + 16.0;
    let bottom = height - 172.0;
    let layers = layers(pick);
    let samples = usize::from(samples);
    let sheet = Sheet { size: (1, 1), samples, ground: PAPER, ground_z: ground_z(pick) };
    let split = (WIDE * width).round();
    let beside = (split + 2.0, top, width - split - 2.0, bottom - top);
    let views = [
        (front(pick), (0.0, top, split - 2.0, bottom - top), "from the person's side"),
        (above(beside), beside, "from above"),
    ];
    for (camera, frame, name) in views {
        view(&mut canvas, pick, (&layers, &sheet), &camera, frame, name)?;
    }
    strip::draw(&mut canvas, pick, (8.0, bottom + 14.0, width - 20.0, 156.0));
    Ok(canvas)
}

/// One view with the names of the objects.
fn view(
    canvas: &mut Canvas,
    pick: &Pick<'_>,
    (layers, sheet): (&[Layer], &Sheet),
    camera: &Camera,
    (left, top, width, height): Frame,
    name: &str,
) -> Result<(), PlotError> {
    // A canvas shows two pixels a unit.
    let size = ((2.0 * width) as usize, (2.0 * height) as usize);
    let sheet = Sheet { size, ..*sheet };
    let image = render(layers, camera, &sheet);
    // Steps too small to be seen would double the file.
    let pixels: Vec<_> = image.pixels.iter().map(|pixel| pixel.map(|part| part | STEP)).collect();
    let raster = Raster::new(image.width, &pixels)?;
    canvas.raster((left, top), (width, height), raster);
    let onto = |place: &Vector3<f64>| {
        let (right, down, _) = camera.project(place, size)?;
        Some((left + 0.5 * right, top + 0.5 * down))
    };
    names(canvas, pick, onto);
    canvas.words((left + 12.0, top + 14.0), name, Align::Left, Size::Small, GREY);
    Ok(())
}

/// Writes the objects' names beside them: above, or where that is free.
fn names(canvas: &mut Canvas, pick: &Pick<'_>, onto: impl Fn(&Vector3<f64>) -> Option<(f64, f64)>) {
    let mut taken: Vec<(f64, f64, f64)> = Vec::new();
    for (index, place) in pick.places.iter().enumerate() {
        let text = &pick.scene.object(index.into()).name;
        let half = 0.5 * evaluation::charts::LETTER_WIDTH * text.chars().count() as f64 + 2.0;
        let [x, y, z] = place.xyz_m;
        let Some((over, top)) = onto(&Vector3::new(x, y, place.top_z_m())) else { continue };
        let near = Vector3::new(x + 0.5 * place.size_m[0], y, place.bottom_z_m());
        let bottom = onto(&near).map_or(top, |(_, bottom)| bottom);
        let edge = onto(&Vector3::new(x, y + 0.5 * place.size_m[1], z)).map_or(over, |(x, _)| x);
        let aside = (edge - over).abs() + half + 2.0;
        let middle = 0.5 * (top + bottom);
        let above = top - (bottom - top).abs().min(10.0) - LINE;
        let beside = [(over, above), (over, bottom + LINE), (over + aside, middle)];
        let farther =
            [1.0, 2.0].map(|n| [(over, above - n * LINE), (over, bottom + (n + 1.0) * LINE)]);
        let places = beside.into_iter().chain([(over - aside, middle)]);
        let places = places.chain(farther.into_iter().flatten());
        let free = |(x, y): &(f64, f64)| {
            taken
                .iter()
                .all(|other| (x - other.0).abs() > half + other.2 || (y - other.1).abs() > LINE)
        };
        let at = places.clone().find(free).or(places.last()).unwrap_or((over, above));
        taken.push((at.0, at.1, half));
        label(
            canvas,
            at,
            text,
            if index == pick.object { ink(PickPhase::HandOver) } else { BLACK },
        );
    }
}

/// Words that can be read on anything.
fn label(canvas: &mut Canvas, (x, y): (f64, f64), text: &str, ink: Ink) {
    const ROUND: [(f64, f64); 8] = [
        (-1.2, 0.0),
        (1.2, 0.0),
        (0.0, -1.2),
        (0.0, 1.2),
        (-0.9, -0.9),
        (0.9, -0.9),
        (-0.9, 0.9),
        (0.9, 0.9),
    ];
    for (dx, dy) in ROUND {
        canvas.words((x + dx, y + dy), text, Align::Middle, Size::Small, [0xff; 3]);
    }
    canvas.words((x, y), text, Align::Middle, Size::Small, ink);
}

/// The phases with their seconds, in as many rows as it takes; where the last one is.
fn legend(canvas: &mut Canvas, pick: &Pick<'_>, mut y: f64, width: f64) -> f64 {
    const LEFT: f64 = 16.0;
    let mut x = LEFT;
    for (phase, name, _) in PHASES {
        let Some((begin_s, end_s)) = pick.plan.timeline.span_s(phase) else { continue };
        let text = format!("{name} {:.1} s", end_s - begin_s);
        let long = 20.0 + evaluation::charts::LETTER_WIDTH * text.len() as f64;
        if x + long > width {
            (x, y) = (LEFT, y + 18.0);
        }
        canvas.area((x, y - 4.0), (14.0, 8.0), ink(phase));
        canvas.words((x + 19.0, y), &text, Align::Left, Size::Small, BLACK);
        x += long + 12.0;
    }
    y
}

/// Everything that is seen, solid and as ghosts.
fn layers(pick: &Pick<'_>) -> Vec<Layer> {
    let span = |phase| pick.plan.timeline.span_s(phase).unwrap_or_default();
    let (lifted_s, given_s) = (span(PickPhase::Lift).1, span(PickPhase::HandOver).1);
    let (down_s, grasped_s) = (span(PickPhase::Approach).1, span(PickPhase::Close).1);
    let mut solid = bodies::robot(pick, given_s, false);
    let boards = furniture::boards(&pick.places);
    solid.add(furniture::mesh(&boards, pick.settings.table_z_m, ground_z(pick)));
    let mut clear = Mesh::default();
    let mut put = |index: usize, pose| {
        let (mesh, seen_through) = bodies::object(pick, index);
        let onto = if seen_through { &mut clear } else { &mut solid };
        onto.add(mesh.placed(&pose));
    };
    for (index, place) in pick.places.iter().enumerate().filter(|(i, _)| *i != pick.object) {
        put(index, place.isometry());
    }
    put(pick.object, pick.object_at(given_s));
    let ghost = |(t_s, phase): (f64, PickPhase)| {
        let mut mesh = bodies::robot(pick, t_s, true);
        let (object, _) = bodies::object(pick, pick.object);
        mesh.add(object.placed(&pick.object_at(t_s)));
        // Each in a tint of its phase.
        let tint = rgb(phase);
        for triangle in &mut mesh.triangles {
            let own = triangle.paint.rgb;
            triangle.paint.rgb = [0, 1, 2].map(|n| own[n] + TINT * (tint[n] - own[n]));
        }
        Layer { mesh, opacity: GHOST }
    };
    let mut ways = Mesh::default();
    for (phase, way) in pick.ways() {
        ways.add(Mesh::tube(&way, WAY_M, Paint::glowing(rgb(phase))).part(30_000));
    }
    let solid = Layer { mesh: solid, opacity: 1.0 };
    let clear = Layer { mesh: clear, opacity: 0.55 };
    let ways = Layer { mesh: ways, opacity: 0.95 };
    let ghosts = [
        (0.0, PickPhase::Approach),
        (0.5 * down_s, PickPhase::Approach),
        (grasped_s, PickPhase::Close),
        (lifted_s, PickPhase::Lift),
    ]
    .map(ghost);
    [solid, clear].into_iter().chain(ghosts).chain([ways]).collect()
}

/// The colour of a phase.
fn rgb(phase: PickPhase) -> Rgb {
    ink(phase).map(|part| f64::from(part) / 255.0)
}

/// The lowest point of the robot at rest, or of what its objects stand on.
fn ground_z(pick: &Pick<'_>) -> f64 {
    let robot = bodies::robot(pick, 0.0, false);
    let corners = robot.triangles.iter().flat_map(|triangle| &triangle.corners);
    let lowest = corners.map(|corner| corner.z).fold(f64::INFINITY, f64::min);
    pick.places.iter().map(|place| place.bottom_z_m() - 0.3).fold(lowest, f64::min)
}

/// From where the person stands, a little to the side.
fn front(pick: &Pick<'_>) -> Camera {
    let side = pick.plan.limb().side();
    Camera {
        eye: Vector3::new(3.0, 1.35 * side, 1.25),
        target: Vector3::new(0.36, 0.10 * side, 0.18),
        up: Vector3::z(),
        height_rad: 0.51,
    }
}

/// From high above, the robot at the top.
fn above((_, _, width, height): Frame) -> Camera {
    const SEEN_M: f64 = 2.05;
    const HIGH_M: f64 = 9.0;
    Camera {
        eye: Vector3::new(0.30, 0.0, HIGH_M),
        target: Vector3::new(0.30, 0.0, 0.0),
        up: -Vector3::x(),
        height_rad: SEEN_M / HIGH_M * height / width,
    }
}

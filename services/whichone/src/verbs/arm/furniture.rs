//! What the objects stand on: a board under each group that stands equally high and close.

use manipulation::ObjectPose;
use nalgebra::{Isometry3, Vector3};
use solid::{Mesh, Paint, Rgb};

/// A board, metres in frame `base`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Board {
    /// Least x and y.
    pub(super) low: [f64; 2],
    /// Greatest x and y.
    pub(super) high: [f64; 2],
    /// Height of its upper side.
    pub(super) top: f64,
}

/// Objects whose feet differ by less stand equally high.
const LEVEL_M: f64 = 0.015;
/// Objects that are no farther apart stand on one board.
const CLOSE_M: f64 = 0.30;
/// How far a board reaches beyond what stands on it.
const RIM_M: f64 = 0.05;
const THICK_M: f64 = 0.025;
const LEG_M: f64 = 0.014;

const WOOD: Rgb = [0.80, 0.66, 0.48];
const PALE: Rgb = [0.76, 0.79, 0.82];
const STEEL: Rgb = [0.62, 0.64, 0.67];

/// The boards under all objects.
pub(super) fn boards(places: &[ObjectPose]) -> Vec<Board> {
    let mut boards: Vec<Board> = places.iter().map(under).collect();
    let near = |a: &Board, b: &Board| {
        let apart = |k: usize| (a.low[k] - b.high[k]).max(b.low[k] - a.high[k]);
        (a.top - b.top).abs() < LEVEL_M && apart(0) < CLOSE_M && apart(1) < CLOSE_M
    };
    // Boards that come close grow together until none do.
    while let Some((i, j)) = (0..boards.len())
        .flat_map(|j| (0..j).map(move |i| (i, j)))
        .find(|(i, j)| near(&boards[*i], &boards[*j]))
    {
        let other = boards.remove(j);
        let board = &mut boards[i];
        for k in 0..2 {
            board.low[k] = board.low[k].min(other.low[k]);
            board.high[k] = board.high[k].max(other.high[k]);
        }
        board.top = board.top.min(other.top);
    }
    boards
}

fn under(place: &ObjectPose) -> Board {
    let [x, y, _] = place.xyz_m;
    let (sin, cos) = place.yaw_rad.sin_cos();
    let [wide, deep, _] = place.size_m;
    let half = [wide * cos.abs() + deep * sin.abs(), wide * sin.abs() + deep * cos.abs()];
    let half = half.map(|side| 0.5 * side + RIM_M);
    let top = place.bottom_z_m();
    Board { low: [x - half[0], y - half[1]], high: [x + half[0], y + half[1]], top }
}

/// Boards on legs that stand on the ground; the one at the table's height is of wood.
pub(super) fn mesh(boards: &[Board], table_z: f64, ground_z: f64) -> Mesh {
    let mut mesh = Mesh::default();
    for (n, board) in boards.iter().enumerate() {
        let part = 20_000 + 10 * n as u32;
        let wood = (board.top - table_z).abs() < LEVEL_M;
        let size = [board.high[0] - board.low[0], board.high[1] - board.low[1]];
        let middle = [0, 1].map(|k| 0.5 * (board.low[k] + board.high[k]));
        let at = Isometry3::translation(middle[0], middle[1], board.top - 0.5 * THICK_M);
        let paint = Paint { gloss: 0.1, ..Paint::new(if wood { WOOD } else { PALE }) };
        let slab = Mesh::cuboid(&Vector3::new(size[0], size[1], THICK_M), paint);
        mesh.add(slab.placed(&at).part(part));
        let length = board.top - THICK_M - ground_z;
        if length <= 0.0 {
            continue;
        }
        for (k, (x, y)) in [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().enumerate() {
            let inset = |ends: [f64; 2], end: usize, to: f64| ends[end] + 0.12 * (to - ends[end]);
            let x = inset([board.low[0], board.high[0]], x, middle[0]);
            let y = inset([board.low[1], board.high[1]], y, middle[1]);
            let leg = Mesh::cylinder(LEG_M, length, Paint::new(STEEL));
            let at = Isometry3::translation(x, y, ground_z + 0.5 * length);
            mesh.add(leg.placed(&at).part(part + 1 + k as u32));
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stands_close_and_equally_high_shares_a_board() {
        let place = |x: f64, y: f64, z: f64| ObjectPose {
            xyz_m: [x, y, z],
            yaw_rad: 0.0,
            size_m: [0.1, 0.1, 0.06],
            grasp_width_m: 0.01,
        };
        let found = boards(&[place(0.6, 0.0, 0.0), place(0.6, 0.9, 0.0), place(0.7, 0.2, 0.005)]);
        assert_eq!(found.len(), 2);
        assert!((found[0].high[1] - 0.3).abs() < 1e-12 && (found[0].top + 0.03).abs() < 1e-12);
        assert_eq!(boards(&[place(0.6, 0.0, 0.0), place(0.6, 0.1, 0.2)]).len(), 2);
    }
}

//! Static obstacles: a table, boards of shelves, and the objects on them, as upright boxes.

use crate::collision::Cuboid;

/// A box and what to call it.
pub(crate) type Obstacle = (&'static str, Cuboid);

/// Returns the table: from its near edge to beyond the arms' reach, solid below its top.
/// Where the arm is to reach lower than that, into a rack or a drawer, there is an opening round
/// the place.
pub(crate) fn table(
    (near_m, top_z_m): (f64, f64),
    place_m: [f64; 3],
    lowest_z_m: f64,
) -> Vec<Obstacle> {
    let whole = (near_m, near_m.max(0.0) + TABLE_FAR_M);
    if lowest_z_m >= top_z_m {
        return vec![slab(whole, TABLE_Y_M, top_z_m)];
    }
    let [x, y, _] = place_m;
    let (near, far) = (x - OPENING_M, x + OPENING_M);
    let (right, left) = (y - OPENING_M, y + OPENING_M);
    vec![
        slab(whole, TABLE_Y_M, lowest_z_m),
        slab((whole.0, near), TABLE_Y_M, top_z_m),
        slab((far, whole.1), TABLE_Y_M, top_z_m),
        slab((near, far), (TABLE_Y_M.0, right), top_z_m),
        slab((near, far), (left, TABLE_Y_M.1), top_z_m),
    ]
}

/// Objects, and a board under each that stands above the table.
pub(crate) fn objects(others: &[Cuboid], table_z_m: f64) -> Vec<Obstacle> {
    let mut obstacles = Vec::with_capacity(others.len());
    for other in others {
        obstacles.push(("other object", *other));
        let bottom_m = other.centre[2] - 0.5 * other.size[2];
        if bottom_m > table_z_m + THICKNESS_M {
            obstacles.push(board(other, NEIGHBOUR_M));
        }
    }
    obstacles
}

/// Returns a solid between two bounds of x and of y, from its top half a metre down.
fn slab((near, far): (f64, f64), (right, left): (f64, f64), top_z_m: f64) -> Obstacle {
    let centre = [0.5 * (near + far), 0.5 * (right + left), top_z_m - 0.25];
    ("table", Cuboid::aligned(centre, [(far - near).max(0.0), (left - right).max(0.0), 0.5]))
}

/// Returns the board under an object, wider than the object by `margin_m` on every side.
pub(crate) fn board(object: &Cuboid, margin_m: f64) -> Obstacle {
    let [x, y, z] = object.centre;
    let [length, width, height] = object.size;
    let board = Cuboid {
        centre: [x, y, z - 0.5 * (height + THICKNESS_M)],
        size: [length + 2.0 * margin_m, width + 2.0 * margin_m, THICKNESS_M],
        yaw: object.yaw,
    };
    ("shelf", board)
}

/// The table's length, at least as far as the robot reaches, and its bounds across, metres.
const TABLE_FAR_M: f64 = 1.1;
const TABLE_Y_M: (f64, f64) = (-1.2, 1.2);

/// From the middle of an opening in the table to its edges, metres.
const OPENING_M: f64 = 0.2;

/// Thickness of a board, metres.
pub(crate) const THICKNESS_M: f64 = 0.02;

/// Extent of the boards beyond other objects, metres: no more than is certain.
pub(crate) const NEIGHBOUR_M: f64 = 0.02;

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::collision::Capsule;

    /// Returns whether a point is inside any of the boxes.
    fn inside(obstacles: &[Obstacle], [x, y, z]: [f64; 3]) -> bool {
        let at = Vector3::new(x, y, z);
        let dot = Capsule { a: at, b: at, radius: 0.0 };
        obstacles.iter().any(|(_, cuboid)| dot.to_cuboid(cuboid) < 0.0)
    }

    #[test]
    fn a_table_is_solid_below_its_top() {
        let table = table((0.4, -0.15), [0.7, 0.0, -0.1], -0.12);
        assert_eq!(table.len(), 1);
        assert!(inside(&table, [0.7, 0.0, -0.16]) && !inside(&table, [0.7, 0.0, -0.14]));
        assert!(!inside(&table, [0.3, 0.0, -0.16]), "the trunk is not in the table");
    }

    #[test]
    fn a_rack_below_the_top_is_open_round_the_place_only() {
        let table = table((0.4, -0.15), [0.7, -0.4, -0.2], -0.22);
        assert!(!inside(&table, [0.7, -0.4, -0.2]) && inside(&table, [0.7, -0.4, -0.23]));
        assert!(inside(&table, [0.7, 0.1, -0.2]) && inside(&table, [1.0, -0.4, -0.2]));
        assert!(inside(&table, [0.45, -0.4, -0.2]) && inside(&table, [0.7, -0.7, -0.2]));
    }

    #[test]
    fn only_what_stands_above_the_table_has_a_board() {
        let low = Cuboid::aligned([0.7, 0.0, -0.12], [0.1, 0.1, 0.06]);
        let high = Cuboid::aligned([0.7, 0.4, 0.13], [0.1, 0.1, 0.06]);
        let names: Vec<_> = objects(&[low, high], -0.15).iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["other object", "other object", "shelf"]);
    }
}

//! Scene and profile that use an imported robot.

use std::fmt::Write;

use crate::place::Placed;
use crate::site::Site;

/// Colours of the blocks, two of each.
const COLOURS: [&str; 3] = ["red", "blue", "green"];

/// Returns the scene: six blocks of three colours and two sizes.
pub(crate) fn scene(name: &str, placed: &Placed) -> String {
    let mut out = format!(
        "#:schema ../schemas/scene.json\n\
         # Six building blocks within reach of {name}, written by `whichone robot import` (docs/robots.md).\n\n\
         name = \"{name}-blocks\"\nnoun = \"block\"\n\n\
         ask_wanted = [\"Which {{noun}} would you like?\", \"Which {{noun}} shall I get?\"]\n\
         ask_point = [\"This one?\", \"Is it this one?\", \"Do you mean this one?\"]\n\n\
         [[attributes]]\nname = \"color\"\nsynonyms = [\"colour\"]\n\
         ask_yes_no = [\"Is it {{value}}?\", \"Is it the {{value}} one?\"]\n\
         ask_which = [\"What colour is it?\", \"Which colour is it?\"]\n\
         values = [\"red\", \"blue\", \"green\"]\n\n\
         [[attributes]]\nname = \"size\"\n\
         ask_yes_no = [\"Is it {{value}}?\", \"Do you want the {{value}} one?\"]\n\
         ask_which = \"Is it small or large?\"\nvalues = [\n\
         \x20 {{ name = \"small\", synonyms = [\"little\", \"smaller\"] }},\n\
         \x20 {{ name = \"large\", synonyms = [\"big\", \"larger\"] }},\n]\n\n\
         # Metres in frame `base`: x ahead, y left, z up; `xyz` is the block's centre.\n"
    );
    for (number, block) in placed.blocks.iter().enumerate() {
        let (colour, size) = (COLOURS[number / 2], ["small", "large"][number % 2]);
        let ([x, y, z], [l, w, h]) = (block.xyz_m, block.size_m);
        let mass = block.mass_kg.unwrap_or(0.02);
        // Writing to a string does not fail.
        let _ = write!(
            out,
            "\n[[objects]]\nname = \"{colour}_{size}\"\nattributes = {{ color = \"{colour}\", size = \"{size}\" }}\n\
             xyz = [{x}, {y}, {z}]\nsize = [{l}, {w}, {h}]\ngrasp_width = {}\nmass_kg = {mass}\n",
            block.grasp_width_m
        );
    }
    out
}

/// Returns the profile.
pub(crate) fn profile(name: &str, placed: &Placed) -> String {
    let [x, y, z] = placed.hand_over_m;
    let table = placed.table_z_m;
    let Site { near_m, hover_m, standoff_m, .. } = placed.site;
    let small = match placed.site.is_small() {
        true => format!(
            "table_near_m = {near_m:?}\nhover_m = {hover_m:?}\nstandoff_m = {standoff_m:?}\n"
        ),
        false => String::new(),
    };
    format!(
        "#:schema ../schemas/profile.json\n\
         # {name} in a simulated world, written by `whichone robot import` (docs/robots.md).\n\n\
         [group]\nscene = \"{name}-blocks\"\n\n\
         [arm]\nrobot = \"{name}\"\nhand_over_xyz = [{x:?}, {y:?}, {z:?}]\ntable_z_m = {table:?}\n{small}"
    )
}

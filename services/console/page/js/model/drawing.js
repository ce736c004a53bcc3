// @ts-check
/** Words of colour and their appearance: fill and outline. */
const COLOURS = {
  white: ["#fafaf7", "#a9aaa4"],
  black: ["#2c2e31", "#6c7076"],
  grey: ["#9a9ea3", "#6b6f75"],
  gray: ["#9a9ea3", "#6b6f75"],
  red: ["#d8433b", "#98231d"],
  orange: ["#ee8a2e", "#a95708"],
  yellow: ["#f3c93b", "#a08012"],
  green: ["#3f9e57", "#236637"],
  blue: ["#3b78d8", "#1f4c99"],
  purple: ["#8a55c4", "#5a2f8d"],
  violet: ["#8a55c4", "#5a2f8d"],
  pink: ["#ec86ac", "#ad4672"],
  brown: ["#94643c", "#5f3d21"],
  beige: ["#e2d2b0", "#a08d64"],
  gold: ["#d9ae45", "#94711a"],
  metallic: ["#c3c9cf", "#7b838b"],
  silver: ["#c3c9cf", "#7b838b"],
  steel: ["#c3c9cf", "#7b838b"],
  clear: ["#cfe6ee", "#7ba5b4"],
  transparent: ["#cfe6ee", "#7ba5b4"],
};
/** Words of kind and their form. */
const FORMS = {
  bowl: ["bowl", "basin", "dish"],
  cup: ["cup", "mug", "teacup"],
  glass: ["glass", "tumbler", "beaker", "vase"],
  plate: ["plate", "saucer", "tray", "lid"],
  bottle: ["bottle", "flask", "shampoo", "ketchup"],
  can: ["can", "tin", "jar", "cylinder", "drum", "roll"],
  box: ["box", "carton", "package", "packet", "cube", "block", "brick", "case", "tea", "crate"],
  book: ["book", "notebook", "magazine", "binder"],
  ball: ["ball", "apple", "orange", "lemon", "sphere", "tomato", "egg"],
  pen: ["pen", "pencil", "biro", "crayon"],
  marker: ["marker", "highlighter", "felt", "chalk"],
  screwdriver: ["screwdriver", "driver", "awl", "chisel"],
  wrench: ["wrench", "spanner", "pliers", "key"],
  hammer: ["hammer", "mallet"],
  spoon: ["spoon", "ladle", "spatula"],
  fork: ["fork", "knife", "whisk", "cutlery"],
};
/** Attributes that say where an object is and not what: what stands in the tray is no tray. */
const PLACES = ["location", "place", "position"];
const GLASSY = ["clear", "transparent", "glass", "see-through"];
const SHINY = ["metal", "metallic", "steel", "silver", "chrome", "aluminium", "aluminum", "gold"];
const SMALL = ["small", "little", "tiny", "short", "mini"];
const LARGE = ["big", "large", "huge", "long", "tall"];
const NEUTRAL = ["#b9bdc2", "#787d84"];

/**
 * @typedef {object} Drawing
 * @property {string} form one of the forms that can be drawn
 * @property {string} fill
 * @property {string} outline
 * @property {"plain"|"glass"|"shiny"} finish
 * @property {number} scale 0 to 1
 */

/**
 * Chooses an object's drawing from the words that describe it, else from its size.
 * @param {{attributes: Record<string, string>, size?: number[]}} object
 * @param {string} noun the scene's word for any of them
 * @returns {Drawing}
 */
export function drawingOf(object, noun) {
  const own = Object.entries(object.attributes ?? {}).filter(([name]) => !PLACES.includes(name));
  const values = own.map(([, value]) => String(value).toLowerCase());
  const words = values.flatMap((value) => [value, ...value.split(/[\s_-]+/)]);
  const has = (list) => words.some((word) => list.includes(word));
  const colour = words.find((word) => Object.hasOwn(COLOURS, word));
  const [fill, outline] = colour ? COLOURS[colour] : has(SHINY) ? COLOURS.steel : NEUTRAL;
  const form =
    formOf(words) ?? formOf(noun.toLowerCase().split(/\s+/)) ?? bodyOf(object.size, words);
  const finish = has(GLASSY) ? "glass" : has(SHINY) ? "shiny" : "plain";
  const scale = has(SMALL) ? 0.74 : has(LARGE) ? 1 : 0.88;
  return { form, fill, outline, finish, scale };
}

function formOf(words) {
  const matches = ([, names]) =>
    words.some((word) => names.includes(word.replace(/s$/, "")) || names.includes(word));
  return Object.entries(FORMS).find(matches)?.[0];
}

/** A plain body of about the object's proportions. */
function bodyOf(size, words) {
  if (words.some((word) => ["round", "ball", "spherical"].includes(word))) return "ball";
  if (!size || size.length < 3) return "box";
  const [long, middle, high] = [Math.max(size[0], size[1]), Math.min(size[0], size[1]), size[2]];
  if (long > 3 * middle && long > 3 * high) return "rod";
  if (high > 1.6 * long) return "can";
  return high < 0.3 * long ? "plate" : "box";
}

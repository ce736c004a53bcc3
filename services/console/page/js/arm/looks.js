// @ts-check
/** Colours by the names that scenes give them. */
const COLOURS = {
  white: 0xf2f1ec,
  black: 0x26272b,
  grey: 0x8b8f96,
  gray: 0x8b8f96,
  red: 0xc8322e,
  orange: 0xe8842a,
  yellow: 0xeac435,
  green: 0x3a9a55,
  blue: 0x2f66c4,
  purple: 0x7d46a0,
  pink: 0xe98fa9,
  brown: 0x76502f,
  beige: 0xd9c7a3,
  metallic: 0xc9cdd3,
  silver: 0xc9cdd3,
  gold: 0xd9b24c,
  golden: 0xd9b24c,
  clear: 0xbfe3ee,
  transparent: 0xbfe3ee,
  wooden: 0xb98b55,
};
/** Colour of things without a colour of their own. */
const PLAIN = 0xc7a97f;

const SEE_THROUGH = ["clear", "transparent", "glass"];
const SHINY = ["metallic", "silver", "gold", "golden", "metal", "steel", "chrome"];

/** Looks of a thing by its name. The first word that is found counts. */
const FORMS = {
  bowl: "bowl",
  plate: "plate",
  cup: "cup",
  mug: "cup",
  glass: "cup",
  bottle: "bottle",
  can: "can",
  marker: "marker",
  pen: "pen",
  pencil: "pen",
  screwdriver: "screwdriver",
  wrench: "wrench",
  spanner: "wrench",
  box: "box",
  ball: "ball",
};

/**
 * @typedef {object} Look
 * @property {number} colour 0xrrggbb
 * @property {"clear"|"metal"|"plain"} finish
 * @property {string} form one of the values of `FORMS`, or "box", "rod", "can"
 */

/**
 * Returns an object's looks.
 * @param {{name: string, attributes: Record<string, string>, size: number[]}} object
 * @param {string} noun the scene's word for its objects
 * @returns {Look}
 */
export function lookOf({ attributes, size }, noun) {
  const values = Object.values(attributes).map((value) => value.toLowerCase());
  const has = (names) => names.some((name) => values.includes(name));
  const colour = values.find((value) => Object.hasOwn(COLOURS, value));
  const finish = has(SEE_THROUGH) ? "clear" : has(SHINY) ? "metal" : "plain";
  const bare = finish === "metal" ? COLOURS.metallic : PLAIN;
  return {
    colour: colour ? COLOURS[colour] : bare,
    finish,
    form: formOf([...values, noun.toLowerCase()], size),
  };
}

function formOf(words, [x, y, z]) {
  const named = words.find((word) => Object.hasOwn(FORMS, word));
  if (named) return FORMS[named];
  const across = Math.min(x, y);
  if (words.includes("round")) return z < 0.75 * across ? "bowl" : "can";
  const longest = Math.max(x, y, z);
  return longest < 1.5 * (x + y + z - longest) ? "box" : "rod";
}

/**
 * @typedef {object} Part a body in the object's own frame, z up, its centre at `at`
 * @property {"lathe"|"box"|"ball"|"ring"} body
 * @property {[number, number, number]} at metres
 * @property {"x"|"y"|"z"} along axis of a lathe, normal of a ring
 * @property {[number, number][]} [profile] of a lathe: distance from the axis, place along it
 * @property {number[]} [size] of a box; radius and thickness of a ring; radius of a ball
 * @property {number} [colour] if it is not the object's
 * @property {boolean} [metal] whether it is of bare metal
 */

const DARK = 0x2b2d31;
const STEEL = 0xb9bec5;

/**
 * The bodies that an object is drawn with.
 * @param {string} form of a `Look`
 * @param {number[]} size metres along x, y and z
 * @returns {Part[]}
 */
export function partsOf(form, [x, y, z]) {
  const across = Math.min(x, y);
  const upright = (profile) => [
    /** @type {Part} */ ({ body: "lathe", at: [0, 0, 0], along: "z", profile }),
  ];
  const make = {
    bowl: () => upright(bowl(0.5 * across, z)),
    plate: () => upright(plate(0.5 * across, z)),
    cup: () => upright(cup(0.5 * across, z)),
    bottle: () => upright(bottle(0.5 * across, z)),
    can: () => upright(rod(0.5 * across, z)),
    ball: () => [part("ball", [0, 0, 0], { size: [0.5 * Math.min(across, z)] })],
    box: () => [part("box", [0, 0, 0], { size: [x, y, z] })],
    rod: () => lengthwise([x, y, z], (radius, length) => [["", rod(radius, length)]]),
    marker: () => lengthwise([x, y, z], marker),
    pen: () => lengthwise([x, y, z], pen),
    screwdriver: () => lengthwise([x, y, z], screwdriver),
    wrench: () => wrench([x, y, z]),
  };
  return (make[form] ?? make.box)();
}

/** @returns {Part} */
function part(body, at, more) {
  return { body, at, along: "z", ...more };
}

/** Lathes about the longest axis. */
function lengthwise(size, profiles) {
  const length = Math.max(...size);
  const n = size.indexOf(length);
  const others = size.filter((_, k) => k !== n);
  const along = /** @type {"x"|"y"|"z"} */ ("xyz"[n]);
  return profiles(0.5 * Math.min(...others), length).map(([kind, profile]) => {
    const paint = { dark: { colour: DARK }, steel: { colour: STEEL, metal: true } }[kind] ?? {};
    return /** @type {Part} */ ({ body: "lathe", at: [0, 0, 0], along, profile, ...paint });
  });
}

/** A rod with rounded edges about its middle. */
function rod(radius, length, from = -0.5 * length, bevel = Math.min(0.15 * radius, 0.2 * length)) {
  const to = from + length;
  return [
    [0, from],
    [radius - bevel, from],
    [radius, from + bevel],
    [radius, to - bevel],
    [radius - bevel, to],
    [0, to],
  ];
}

/** Foot, outside, rim, inside. */
function bowl(radius, height) {
  const wall = Math.max(0.05 * radius, 0.002);
  const foot = 0.42 * radius;
  const outside = curve(7, (s) => [foot + (radius - foot) * s ** 0.55, -0.5 * height + height * s]);
  const inside = curve(6, (s) => [
    foot + (radius - foot) * (1 - s) ** 0.55 - wall,
    0.5 * height - (height - wall) * s,
  ]);
  return [[0, -0.5 * height], ...outside, ...inside, [0, wall - 0.5 * height]];
}

function plate(radius, height) {
  const low = -0.5 * height;
  const wall = Math.max(0.3 * height, 0.002);
  return [
    [0, low],
    [0.6 * radius, low],
    [radius, 0.5 * height - 0.5 * wall],
    [radius, 0.5 * height],
    [0.6 * radius, low + wall],
    [0, low + wall],
  ];
}

function cup(radius, height) {
  const [low, top, wall] = [-0.5 * height, 0.5 * height, Math.max(0.07 * radius, 0.002)];
  return [
    [0, low],
    [0.84 * radius, low],
    [0.88 * radius, low + 0.03 * height],
    [radius, top],
    [radius - wall, top],
    [0.86 * radius - wall, low + 2 * wall],
    [0, low + 2 * wall],
  ];
}

function bottle(radius, height) {
  const at = (share) => (share - 0.5) * height;
  return [
    [0, at(0)],
    [0.9 * radius, at(0)],
    [radius, at(0.03)],
    [radius, at(0.55)],
    [0.75 * radius, at(0.68)],
    [0.36 * radius, at(0.8)],
    [0.32 * radius, at(0.92)],
    [0.38 * radius, at(0.93)],
    [0.38 * radius, at(1)],
    [0, at(1)],
  ];
}

const marker = (r, l) => [
  ["", rod(r, 0.66 * l, -0.5 * l)],
  ["dark", rod(0.8 * r, 0.06 * l, 0.15 * l)],
  ["", rod(0.96 * r, 0.31 * l, 0.19 * l)],
];

const pen = (r, l) => [
  ["", rod(0.85 * r, 0.78 * l, -0.5 * l)],
  [
    "steel",
    [
      [0.8 * r, 0.28 * l],
      [0.8 * r, 0.36 * l],
      [0.25 * r, 0.47 * l],
      [0, 0.5 * l],
    ],
  ],
  ["dark", rod(0.6 * r, 0.02 * l, -0.5 * l)],
];

const screwdriver = (r, l) => [
  [
    "",
    [
      [0, -0.5 * l],
      [0.8 * r, -0.49 * l],
      [r, -0.45 * l],
      [r, -0.2 * l],
      [0.7 * r, -0.12 * l],
      [0.8 * r, -0.06 * l],
      [0, -0.05 * l],
    ],
  ],
  ["steel", rod(0.26 * r, 0.53 * l, -0.06 * l)],
  ["steel", rod(0.36 * r, 0.04 * l, 0.46 * l)],
];

/** A flat shaft with a ring at either end. */
function wrench(size) {
  const length = Math.max(...size);
  const n = size.indexOf(length) === 1 ? 1 : 0;
  const [wide, high] = [size[1 - n], size[2]];
  const radius = 0.5 * wide;
  const shaft = [0, 0, 0];
  shaft[n] = length - 3 * radius;
  shaft[1 - n] = 0.9 * radius;
  shaft[2] = 0.7 * high;
  const ring = (end) => {
    const at = [0, 0, 0];
    at[n] = end * (0.5 * length - radius);
    return part("ring", at, { size: [0.68 * radius, 0.32 * radius] });
  };
  return [part("box", [0, 0, 0], { size: shaft }), ring(-1), ring(1)];
}

function curve(points, f) {
  return Array.from({ length: points }, (_, n) => f(n / (points - 1)));
}

// @ts-check
import { h } from "../dom.js";
import { resize, rounded, setPlaced, setValue, turnTo } from "./document.js";
import { fieldSet } from "./fields.js";

const CM = { unit: "cm", scale: 100 };
const MM = { unit: "mm", scale: 1000 };
const GRAMS = { unit: "g", scale: 1000 };

/**
 * The form of one object.
 * @param {any} t
 * @param {() => any} documentNow
 * @param {number} n
 * @param {object} does
 * @param {(f: (document: any) => void, what: string) => void} does.change
 * @param {() => [number, number, number]} does.spot a place for one that has none
 * @returns {{element: HTMLElement, show: () => void}}
 */
export function objectPanel(t, documentNow, n, { change, spot }) {
  const own = () => documentNow().objects[n] ?? {};
  const fields = fieldSet(change);
  const to = (f) => (document, value) => f(document.objects[n], value);
  const plain = (key, about, more = {}) =>
    fields.number(t(`scene.object.${key}`), {
      ...about,
      read: () => own()[key],
      write: to((object, value) => {
        object[key] = value;
      }),
      more,
    });

  const name = fields.text(
    t("scene.object.name"),
    () => own().name ?? "",
    to((object, text) => {
      object.name = text.trim();
    }),
    { required: true },
  );
  const attributes = documentNow().attributes.map((attribute) => valueField(attribute));
  const hasPlace = fields.box(
    t("scene.object.placed"),
    () => Boolean(own().xyz),
    to((object, isOn) => setPlaced(object, isOn ? spot() : null)),
  );
  const place = h("div", { class: "fields" }, coordinate(0), coordinate(1), underside(), yaw());
  const size = h("div", { class: "fields" }, extent(0), extent(1), extent(2));
  const grasp = h(
    "div",
    { class: "fields" },
    plain("grasp_width", MM, { min: 0.1, required: true }),
    fields.choice(
      t("scene.object.form"),
      ["solid", "hollow"].map((form) => [form, t(`scene.object.form.${form}`)]),
      () => own().form ?? "solid",
      to((object, form) => {
        object.form = form;
      }),
    ),
    plain("mass_kg", GRAMS, { min: 0.1 }),
    plain("wall_deg", { unit: "°", scale: 1 }, { min: 0, max: 30 }),
  );
  const standing = h("div", { class: "standing" }, place, size, grasp);
  const element = h(
    "div",
    { class: "scene-form" },
    name,
    h("div", { class: "fields" }, ...attributes),
    hasPlace,
    standing,
  );

  function valueField({ name: attribute, values }) {
    const options = values.map((value) => [value.name, value.name]);
    const held = own().attributes?.[attribute];
    // A value in the file that the attribute lacks stays visible.
    if (held && !values.some((value) => value.name === held)) options.push([held, held]);
    return fields.choice(
      attribute,
      [["", t("scene.object.none")], ...options],
      () => own().attributes?.[attribute] ?? "",
      to((object, value) => setValue(object, attribute, value)),
    );
  }
  function coordinate(k) {
    return fields.number(t(`scene.object.${"xy"[k]}`), {
      ...CM,
      read: () => own().xyz?.[k],
      write: to((object, value) => {
        if (object.xyz) object.xyz[k] = value;
      }),
      more: { required: true, min: -500, max: 500 },
    });
  }
  /** People measure from an object's base, not from its middle. */
  function underside() {
    const half = (object) => (object.size?.[2] ?? 0) / 2;
    return fields.number(t("scene.object.z"), {
      ...CM,
      read: () => (own().xyz ? rounded(own().xyz[2] - half(own())) : null),
      write: to((object, value) => {
        if (object.xyz) object.xyz[2] = rounded(value + half(object));
      }),
      more: { required: true, min: -500, max: 500 },
    });
  }
  function yaw() {
    const scale = 180 / Math.PI;
    return fields.number(t("scene.object.yaw"), {
      unit: "°",
      scale,
      read: () => Math.round((own().yaw ?? 0) * scale * 10) / 10 / scale,
      write: to((object, value) => turnTo(object, value)),
      more: { required: true, min: -360, max: 360 },
    });
  }
  function extent(k) {
    return fields.number(t(`scene.object.size.${k}`), {
      ...CM,
      read: () => own().size?.[k],
      write: to((object, value) => {
        const size = [...object.size];
        size[k] = value;
        resize(object, size);
      }),
      more: { required: true, min: 0.1, max: 200 },
    });
  }
  function show() {
    standing.hidden = !own().xyz;
    fields.show();
  }
  show();
  return { element, show };
}

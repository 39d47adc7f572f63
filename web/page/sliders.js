// Sliders for the numbers of a scene, made from the schema of scene files.

/** Tables whose numbers may change while a scene runs. */
const TABLES = ["liquid", "gas", "smoke", "solid", "rope", "body", "emitter"];
/** Keys that are offered for each of a kind, given or not. */
const ALWAYS = { liquid: ["density", "kinematic_viscosity"], gas: ["density"] };
/** Keys that say where or how large something is, or are no number to turn. */
const FIXED = ["radius", "width", "mass", "particle_mass", "angle_deg", "spin_deg", "user_data", "length", "start", "stop",
  "gap"];
const UNIT = /\[([^\]]+)\]/;

/** The sliders of a scene: key of the override, label, unit, value, range. */
export function slidersOf(schema, scene) {
  return [...gravity(scene), ...TABLES.flatMap((kind) => tables(schema, scene, kind))];
}

function gravity({ gravity = [0, -9.81] }) {
  const size = Math.max(10, 2 * Math.hypot(...gravity));
  return [{
    key: "gravity",
    label: "gravity",
    unit: "m/s^2",
    about: "Gravity, positive upwards.",
    value: gravity[1],
    min: -2 * size,
    max: size,
    setting: (value) => [gravity[0], value],
  }];
}

function tables(schema, scene, kind) {
  const entries = scene[kind] ?? [];
  const properties = resolve(schema, resolve(schema, schema.properties[kind]).items).properties;
  return entries.flatMap((entry, index) => {
    const keys = new Set([...(ALWAYS[kind] ?? []), ...Object.keys(entry)]);
    const numbers = [...keys].filter((key) => isNumber(schema, properties[key]) && !FIXED.includes(key));
    return numbers.map((key) => slider(resolve(schema, properties[key]), kind, entry, index, key));
  });
}

function slider(property, kind, entry, index, key) {
  const value = entry[key] ?? property.default ?? 0;
  const name = entry.name ?? `${kind} ${index + 1}`;
  const [min, max] = range(key, value, property);
  const about = property.description ?? "";
  return {
    key: `${kind}.${index}.${key}`,
    label: `${name}: ${key.replaceAll("_", " ")}`,
    unit: UNIT.exec(about)?.[1] ?? "",
    about,
    value,
    min,
    max,
    setting: (value) => value,
  };
}

/** From nothing, or a twentieth of a density, to some times the value; within what the schema allows. */
function range(key, value, { minimum, maximum }) {
  let [low, high] = value === 0 ? [0, 1] : [Math.min(0, 3 * value), Math.max(0, 3 * value)];
  if (key.includes("density")) [low, high] = [0.05 * value, 4 * value];
  if (key === "kinematic_viscosity") high = Math.max(high, 0.5);
  if (["xsph", "friction", "restitution", "damping"].includes(key)) [low, high] = [0, 1];
  return [Math.max(low, minimum ?? low), Math.min(high, maximum ?? high)];
}

function isNumber(schema, property) {
  return property !== undefined && resolve(schema, property).type === "number";
}

function resolve(schema, node) {
  const name = node.$ref?.replace("#/$defs/", "");
  return name ? { ...schema.$defs[name], ...node, $ref: undefined } : node;
}

/** A number as people write it. */
export function shown(value) {
  return String(Number(value.toPrecision(3)));
}

/** Puts the sliders into an element; `change` gets all settings that differ from the scene. */
export function putSliders(parent, sliders, change) {
  const settings = {};
  parent.replaceChildren(...sliders.map((slider) => {
    const row = document.createElement("label");
    row.className = "slider";
    row.title = slider.about;
    const [name, output, input] = ["span", "output", "input"].map((tag) => document.createElement(tag));
    name.textContent = slider.label;
    const say = () => {
      output.textContent = `${shown(Number(input.value))} ${slider.unit}`;
    };
    Object.assign(input, { type: "range", min: slider.min, max: slider.max, step: "any" });
    input.value = slider.value;
    input.name = slider.key;
    input.addEventListener("input", say);
    input.addEventListener("change", () => {
      settings[slider.key] = slider.setting(Number(shown(Number(input.value))));
      change({ ...settings });
    });
    say();
    row.append(name, output, input);
    return row;
  }));
}

// The JSON Schema of a demonstration's parameters -> what the form needs to know of each.

/** Shown at once; the rest waits under "More". A schema may say otherwise with x-advanced. */
const FOREMOST = new Set(["mineral", "cut", "size_mm", "axis_tilt_deg", "analyser_deg"]);

/**
 * @typedef {object} Field
 * @property {string} name
 * @property {"mineral"|"analyser"|"choice"|"boolean"|"number"|"integer"|"numbers"|"text"|"json"} kind
 * @property {{en: string, ru: string}} label
 * @property {string} description
 * @property {string} unit
 * @property {{en: string, ru: string} | null} group
 * @property {{least?: number, most?: number}[]} limits one per number
 * @property {string[]} choices
 * @property {boolean} nullable
 * @property {boolean} advanced
 * @property {unknown} default
 */

/** @returns {Field[]} in the order of the schema */
export function fieldsOf(schema) {
  const resolve = (node) => {
    if (!node?.$ref) return node;
    const target = node.$ref
      .replace(/^#\//, "")
      .split("/")
      .reduce((at, key) => at?.[key], schema);
    return { ...target, ...node, $ref: undefined };
  };
  return Object.entries(schema.properties).map(([name, raw]) => fieldOf(name, resolve(raw), resolve));
}

function fieldOf(name, property, resolve) {
  const branches = (property.anyOf ?? property.oneOf ?? [property]).map(resolve);
  const nullable = branches.some((b) => b.type === "null");
  const value = branches.find((b) => b.type !== "null") ?? property;
  const title = property.title ?? name;
  return {
    name,
    kind: kindOf(name, property, value),
    label: property["x-label"] ?? { en: title, ru: title },
    description: property.description ?? "",
    unit: property["x-unit"] ?? "",
    group: property["x-group"] ?? null,
    limits: (value.prefixItems ?? [value]).map(resolve).map(limitsOf),
    choices: value.enum ?? (value.const === undefined ? [] : [value.const]),
    classes: property["x-optical-classes"] ?? null,
    nullable,
    advanced: property["x-advanced"] ?? !FOREMOST.has(name),
    default: property.default,
  };
}

function kindOf(name, property, value) {
  if (property["x-choices"] === "minerals") return "mineral";
  if (name === "analyser_deg") return "analyser";
  if (value.enum || value.const !== undefined) return "choice";
  if (value.type === "boolean") return "boolean";
  if (value.type === "number" || value.type === "integer") return value.type;
  if (value.type === "array" && value.prefixItems?.every((item) => item.type === "number" || item.type === "integer")) {
    return "numbers";
  }
  return value.type === "string" ? "text" : "json";
}

function limitsOf(value) {
  return {
    least: value.minimum ?? value.exclusiveMinimum,
    most: value.maximum ?? value.exclusiveMaximum,
  };
}

/** The parameters' defaults. */
export function defaultsOf(fields) {
  return Object.fromEntries(fields.map((field) => [field.name, structuredClone(field.default)]));
}

/** What someone wrote in a link or a text field, as the field's value; what cannot be read stays text for the service to refuse. */
export function read(field, text) {
  if (field.nullable && (text === "" || text === "null")) return null;
  switch (field.kind) {
    case "number":
    case "integer":
    case "analyser": {
      const number = Number(text.trim().replace(",", "."));
      return text.trim() !== "" && Number.isFinite(number) ? number : text;
    }
    case "boolean":
      return text === "true" ? true : text === "false" ? false : text;
    case "numbers":
    case "json":
      try {
        return JSON.parse(text);
      } catch {
        return text;
      }
    default:
      return text;
  }
}

/** The other way: a field's value as text. */
export function write(value) {
  return typeof value === "string" ? value : JSON.stringify(value);
}

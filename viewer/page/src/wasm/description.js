// Reads modelDescription.xml of an FMU (FMI 2.0) into an object.

const TYPES = ["Real", "Integer", "Boolean", "String", "Enumeration"];

/**
 * @typedef {object} Variable
 * @property {string} name
 * @property {number} reference its value reference, unique among variables of its type
 * @property {string} type "Real", "Integer", "Boolean" or "String"
 * @property {string} causality "input", "output", "parameter", "local", ...
 * @property {string} variability "continuous", "discrete", "tunable", "fixed", "constant"
 * @property {string|undefined} unit
 * @property {number|undefined} min
 * @property {number|undefined} max
 * @property {number|string|undefined} start
 * @property {string} description
 */

/**
 * @typedef {object} Description
 * @property {string} modelName
 * @property {string} guid
 * @property {string} description
 * @property {number|undefined} startTime of the default experiment, s; so are the next two
 * @property {number|undefined} stopTime
 * @property {number|undefined} stepSize
 * @property {Variable[]} variables
 */

/**
 * Reads or checks the description of an FMU.
 * @param {string|Description} source text of modelDescription.xml, which needs a DOMParser, or the object itself
 * @returns {Description}
 */
export function describe(source) {
  const description = typeof source === "string" ? read(source) : source;
  if (!description || typeof description.guid !== "string" || !Array.isArray(description.variables)) {
    throw new Error("The description of the FMU has no guid and variables; give modelDescription.xml or what it says.");
  }
  return description;
}

function read(text) {
  if (typeof DOMParser === "undefined") {
    throw new Error("There is no DOMParser here to read modelDescription.xml; give the description as an object.");
  }
  const root = new DOMParser().parseFromString(text, "application/xml").documentElement;
  if (root.nodeName !== "fmiModelDescription" || !root.getAttribute("fmiVersion")?.startsWith("2.")) {
    throw new Error("This is not the modelDescription.xml of an FMU of FMI 2.0.");
  }
  const experiment = root.querySelector(":scope > DefaultExperiment");
  return {
    modelName: root.getAttribute("modelName"),
    guid: root.getAttribute("guid"),
    description: root.getAttribute("description") ?? "",
    startTime: number(experiment, "startTime"),
    stopTime: number(experiment, "stopTime"),
    stepSize: number(experiment, "stepSize"),
    variables: Array.from(root.querySelectorAll(":scope > ModelVariables > ScalarVariable"), variable),
  };
}

function variable(node) {
  const kind = Array.from(node.children).find((child) => TYPES.includes(child.nodeName));
  const type = kind.nodeName === "Enumeration" ? "Integer" : kind.nodeName;
  const start = kind.getAttribute("start") ?? undefined;
  const numeric = type === "Real" || type === "Integer";
  return {
    name: node.getAttribute("name"),
    reference: Number(node.getAttribute("valueReference")),
    type,
    causality: node.getAttribute("causality") ?? "local",
    variability: node.getAttribute("variability") ?? "continuous",
    unit: kind.getAttribute("unit") ?? undefined,
    min: number(kind, "min"),
    max: number(kind, "max"),
    start: start === undefined || !numeric ? start : Number(start),
    description: node.getAttribute("description") ?? "",
  };
}

function number(node, name) {
  const text = node?.getAttribute(name) ?? null;
  return text === null ? undefined : Number(text);
}

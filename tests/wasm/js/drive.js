// Drives an FMU as a plan says, in Node or in a page, and gives every output of every step and states as bytes.
const base64 = (bytes) => {
  let text = "";
  for (let k = 0; k < bytes.length; k += 0x8000) text += String.fromCharCode(...bytes.subarray(k, k + 0x8000));
  return btoa(text);
};

const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

/**
 * @param {function} loadFmu of the page's fmu.js
 * @param {object} job wasm and resources in base64, description, plan
 * @returns {Promise<object>} rows and states in base64, refusals and messages
 */
export async function drive(loadFmu, { wasm, resources, description, plan }) {
  const files = Object.fromEntries(Object.entries(resources).map(([path, text]) => [path, bytesOf(text)]));
  const fmu = await loadFmu({ wasm: bytesOf(wasm), description, resources: files });
  const instance = fmu.instantiate();
  const refusals = [];
  instance.set(plan.start);
  instance.initialise({ startTime: 0 });
  const read = instance.reader(plan.outputs);
  const write = instance.writer(plan.inputs);
  const rows = new Float64Array(plan.outputs.length * (plan.steps.length + 1));
  const states = [];
  rows.set(read(), 0);
  plan.steps.forEach(({ h, inputs, save }, k) => {
    write(inputs);
    try {
      instance.step(h);
    } catch (error) {
      refusals.push([k, error.status, error.message]);
    }
    rows.set(read(), plan.outputs.length * (k + 1));
    if (save) {
      const state = instance.getState();
      states.push(base64(instance.serialise(state)));
      state.free();
    }
  });
  return { rows: base64(new Uint8Array(rows.buffer)), states, refusals, messages: instance.messages };
}

// Times the steps of an FMU, in Node or in a page.

const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

/**
 * @param {function} loadFmu of the page's fmu.js
 * @param {object} job wasm and resources in base64, description, and the plan: start, inputs, values, outputs, h, inner,
 *   steps, warmUp, repeats
 * @returns {Promise<object>} microseconds an inner step of each run that counts: `inner`, with as many inner steps in a
 *   call as the plan says, and `each`, one a call, its inputs set and its outputs read
 */
export async function clock(loadFmu, { wasm, resources, description, plan }) {
  const files = Object.fromEntries(Object.entries(resources).map(([path, text]) => [path, bytesOf(text)]));
  const fmu = await loadFmu({ wasm: bytesOf(wasm), description, resources: files });
  const instance = fmu.instantiate();
  const read = instance.reader(plan.outputs);
  const write = instance.writer(plan.inputs);
  const start = () => {
    instance.reset();
    instance.set(plan.start);
    instance.initialise();
    write(plan.values);
  };
  const inner = () => {
    for (let k = 0; k < plan.steps; k += plan.inner) instance.step(plan.h * plan.inner);
  };
  const each = () => {
    for (let k = 0; k < plan.steps; k++) {
      write(plan.values);
      instance.step(plan.h);
      read();
    }
  };
  const timed = (work) => {
    const found = [];
    for (let run = 0; run < plan.warmUp + plan.repeats; run++) {
      start();
      const begin = performance.now();
      work();
      if (run >= plan.warmUp) found.push((1e3 * (performance.now() - begin)) / plan.steps);
    }
    return found;
  };
  return { inner: timed(inner), each: timed(each), end: read()[0] };
}

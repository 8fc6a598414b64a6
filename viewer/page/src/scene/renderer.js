// The WebGL context: creation, loss and release; a sentence if there is none.
import * as THREE from "three";
import { el } from "../common/dom.js";

const NO_WEBGL =
  "This browser gives no WebGL, so nothing can be drawn here; plots still work. " +
  "Switch on hardware acceleration in the browser's settings, or open the page in another browser.";

/** Whether a context draws on the processor, such as SwiftShader and llvmpipe. @param {WebGLRenderingContext} gl */
function drawsBySoftware(gl) {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

/**
 * Makes a renderer with its canvas.
 * @param {HTMLElement} container
 * @param {{smooth?: boolean, keep?: boolean}} options smooth: edges, which are smooth with a graphics card in any case; keep: whether
 *   the picture can be read after it is drawn
 * @returns {{renderer?: THREE.WebGLRenderer, software?: boolean, problem?: string}}
 */
export function makeRenderer(container, { smooth = false, keep = false }) {
  const style = "display:block;width:100%;height:100%;touch-action:none";
  const canvas = el("canvas", { style });
  // The context is created here, because three.js would write an error to the console if there is none.
  /** @type {WebGL2RenderingContext | null} */
  let gl;
  let software = false;
  try {
    const probe = el("canvas").getContext("webgl2");
    if (probe === null) return { problem: NO_WEBGL };
    software = drawsBySoftware(probe);
    probe.getExtension("WEBGL_lose_context")?.loseContext();
    const settings = { antialias: smooth || !software, alpha: false, powerPreference: "high-performance", preserveDrawingBuffer: keep };
    gl = /** @type {WebGL2RenderingContext | null} */ (canvas.getContext("webgl2", settings));
  } catch {
    gl = null;
  }
  if (gl === null) return { problem: NO_WEBGL };
  const renderer = new THREE.WebGLRenderer({ canvas, context: gl });
  renderer.outputColorSpace = THREE.SRGBColorSpace;
  container.append(canvas);
  return { renderer, software };
}

// Tells what a page needs of a browser and does not find.

/** A sentence on what this browser lacks; empty if nothing. @param {Data} [scope] @param {boolean} [runs] whether the page runs FMUs */
export function missingParts(scope = globalThis, runs = true) {
  if (runs && typeof scope.WebAssembly !== "object") {
    return "This browser has no WebAssembly, in which the FMU runs; use a current Chrome, Edge, Firefox or Safari.";
  }
  if (typeof scope.DecompressionStream === "undefined") {
    return (
      "This browser has no DecompressionStream, by which the page is unpacked; use Chrome or Edge 97, Firefox 113, " +
      "Safari 16.4 or newer."
    );
  }
  return "";
}

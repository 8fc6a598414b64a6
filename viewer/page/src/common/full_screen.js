/** A part of the page on the whole screen, or back in it. @param {HTMLElement} element */
export function fullScreen(element) {
  if (document.fullscreenElement) document.exitFullscreen();
  else element.requestFullscreen?.().catch(() => {}); // a browser may refuse it, as in a frame
}

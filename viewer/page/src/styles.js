// Styles of the parts of a page.

const known = new Set();

/** Put CSS into the page, once; its policy takes no style elements but its own. @param {string} css */
export function styled(css) {
  if (known.has(css)) return;
  known.add(css);
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(css);
  document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
}

// Adds style sheets to the page.

const added = new Set();

/** Add CSS to the page, once; by a sheet, since the page's security policy forbids new style elements. @param {string} css */
export function styled(css) {
  if (added.has(css)) return;
  added.add(css);
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(css);
  document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
}

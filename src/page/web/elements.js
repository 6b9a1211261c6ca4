// Makes elements of the page.

/** Makes an element with properties and children. Texts are inserted as text, never as HTML. */
export function make(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

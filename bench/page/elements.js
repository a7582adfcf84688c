// Creates elements. Strings become text or attributes, never markup, because names in a report are
// arbitrary.

function withAttributes(made, attributes, children) {
  for (const [name, value] of Object.entries(attributes || {})) {
    if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else if (name.startsWith('--')) made.style.setProperty(name, value);
    else if (value === true) made.setAttribute(name, '');
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children.flat().filter(child => child !== null && child !== undefined && child !== ''));
  return made;
}

function element(tag, attributes, ...children) {
  return withAttributes(document.createElement(tag), attributes, children);
}

function svg(tag, attributes, ...children) {
  return withAttributes(document.createElementNS('http://www.w3.org/2000/svg', tag), attributes, children);
}

function byId(id) {
  return document.getElementById(id);
}

// A name with optional line breaks after its parts.
function breakable(name) {
  return name.split(/(?<=[:,])/).flatMap((part, i) => (i ? [element('wbr'), part] : [part]));
}

// The few lines that stand in for a framework.

/** el("button", {class: "primary", onclick: f}, "Text", child) */
export function el(name, properties = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
    else if (key === "class") node.className = value;
    else node.setAttribute(key, value === true ? "" : value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

const kSvg = "http://www.w3.org/2000/svg";

/** The same for a drawing. */
export function svg(name, properties, ...children) {
  const node = document.createElementNS(kSvg, name);
  for (const [key, value] of Object.entries(properties)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

/** Writes only what changed: screen readers and selections stay undisturbed ten times a second. */
export function put(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** A card with a heading and, right of it, tools. */
export function card(kind, title, tools, ...content) {
  const head = el("div", {class: "head"}, el("h2", {}, title), ...tools);
  return el("section", {class: "card " + kind, "aria-label": title}, head, ...content);
}

/** A table with its heads over `body`; a head that ends in "#" stands over numbers. */
export function tableOf(heads, body) {
  const cells = heads.map((head) => {
    const numbers = head.endsWith("#");
    return el("th", {scope: "col", class: numbers ? "n" : null}, numbers ? head.slice(0, -1) : head);
  });
  return el("table", {}, el("thead", {}, el("tr", {}, ...cells)), body);
}

/** A table in a box of its own that scrolls, reachable by keyboard. */
export const scroller = (label, ...content) =>
  el("div", {class: "scroll", tabindex: 0, role: "group", "aria-label": label}, ...content);

/**
 * What became of a measurement: mark, word and look. Inertial samples are judged only when something is wrong with
 * one: their last verdict says nothing about now.
 */
export function verdictLook(kind, source = "") {
  const word = String(kind).replaceAll("_", " ");
  if (source === "imu") return ["○ last fault: " + word, "soft"];
  if (kind === "used") return ["✔ " + word, "good-text"];
  return kind === "source_disabled" ? ["○ " + word, "soft"] : ["✖ " + word, "bad-text"];
}

/** A value with a name that scripts find: <dt>label</dt><dd data-field="name">. */
export function field(list, label, name) {
  const value = el("dd", {"data-field": name}, "–");
  list.append(el("dt", {}, label), value);
  return value;
}

/** Brings the children of `parent` in line with `items` by key, touching only what changed. */
export function reconcile(parent, items, keyOf, make, update) {
  const old = new Map([...parent.children].map((node) => [node.dataset.key, node]));
  let at = parent.firstElementChild;
  for (const item of items) {
    const key = String(keyOf(item));
    let node = old.get(key);
    old.delete(key);
    if (!node) {
      node = make(item);
      node.dataset.key = key;
    }
    if (node !== at) parent.insertBefore(node, at);
    else at = at.nextElementSibling;
    update(node, item);
  }
  for (const node of old.values()) node.remove();
}

// Small helpers. Texts from the device reach the page only as text nodes.

export const byId = (id) => document.getElementById(id);

/** Set a text, but touch the document only where it changed. */
export function text(node, value) {
  const said = String(value);
  if (node.textContent !== said) node.textContent = said;
}

export function element(tag, { className = "", said = "", title = "" } = {}) {
  const node = document.createElement(tag);
  if (className) node.className = className;
  if (said !== "") node.textContent = said;
  if (title) node.title = title;
  return node;
}

/** Show name-value pairs in a description list; `mark` colours a value that needs attention. */
export function pairs(list, entries) {
  while (list.children.length > entries.length) list.lastChild.remove();
  entries.forEach(([name, value, mark = "", title = ""], index) => {
    let box = list.children[index];
    if (!box) {
      box = element("div");
      box.append(element("dt"), element("dd"));
      list.append(box);
    }
    text(box.firstChild, name);
    text(box.lastChild, value);
    if (box.lastChild.className !== mark) box.lastChild.className = mark;
    if (box.title !== title) box.title = title;
  });
}

/** Show rows in a table with one heading row; the first cell of a row is its heading. */
export function table(node, headings, rows) {
  const key = headings.join("\n");
  if (node.dataset.headings !== key) {
    node.dataset.headings = key;
    node.replaceChildren();
    const head = node.createTHead().insertRow();
    headings.forEach((said, index) => {
      const cell = element(index ? "th" : "td", { said });
      if (index) cell.scope = "col";
      head.append(cell);
    });
    node.createTBody();
  }
  const body = node.tBodies[0];
  while (body.rows.length > rows.length) body.deleteRow(-1);
  rows.forEach((row, index) => {
    const line = body.rows[index] ?? newRow(body, row.length);
    row.forEach((said, column) => text(line.cells[column], said));
  });
}

function newRow(body, length) {
  const line = body.insertRow();
  for (let column = 0; column < length; column++) {
    const cell = element(column ? "td" : "th");
    if (!column) cell.scope = "row";
    line.append(cell);
  }
  return line;
}

/** Do something that may fail, and say next to the control why it did. */
export async function attempt(said, action) {
  said.classList.remove("bad");
  try {
    text(said, "");
    await action();
    return true;
  } catch (error) {
    said.classList.add("bad");
    text(said, error.message);
    return false;
  }
}

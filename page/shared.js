// shared.js: what every page does: the record and the arrays in it, elements, heading, provenance, light and dark.
'use strict';
const Page = (() => {
  const byId = (id) => document.getElementById(id);
  const record = JSON.parse(byId('record').textContent);
  let arrays = null;

  function add(parent, tag, text, className) {
    const element = parent.appendChild(document.createElement(tag));
    if (text !== undefined) element.textContent = text;
    if (className) element.className = className;
    return element;
  }

  const svgSpace = 'http://www.w3.org/2000/svg';
  function draw(parent, tag, attributes, text) {
    const element = parent.appendChild(document.createElementNS(svgSpace, tag));
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    if (text !== undefined) element.textContent = text;
    return element;
  }

  function picture(holder, width, height, label) {
    holder.textContent = '';
    const svg = draw(holder, 'svg', { viewBox: '0 0 ' + width + ' ' + height, role: 'img', 'aria-label': label });
    draw(svg, 'title', {}, label);
    return svg;
  }

  const shown = (value) => (value === null || !isFinite(value) ? '-' : Number(value.toPrecision(4)).toString());

  async function unpack() {
    const text = atob(byId('arrays').textContent.trim());
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    if (!record.deflated) return arrays = bytes.buffer;
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    return arrays = await new Response(stream).arrayBuffer();
  }

  // Single precision, or 16-bit steps between minimum and maximum; the last step stands for no value.
  function decode(column) {
    if (column.single) return new Float32Array(arrays, column.offset, column.n);
    const steps = new Uint16Array(arrays, column.offset, column.n);
    const out = new Float32Array(column.n), width = (column.max - column.min) / 65534;
    for (let i = 0; i < column.n; ++i) out[i] = steps[i] === 65535 ? NaN : column.min + steps[i] * width;
    return out;
  }

  // Title, what is compared, verdict, reasons, warnings.
  function showHead(states) {
    document.title = record.title + ' - espdiff';
    byId('title').textContent = record.title;
    byId('states').textContent = states;
    const verdict = byId('verdict');
    verdict.classList.toggle('refused', !record.verdict.trustworthy);
    add(verdict, 'strong', record.verdict.text);
    const parts = record.verdict.parts || [];
    for (const list of [record.verdict.reasons, parts, record.warnings]) {
      if (!list.length) continue;
      if (list === parts) add(verdict, 'p', 'Not trusted');
      if (list === record.warnings) add(verdict, 'p', 'Warnings');
      const items = add(verdict, 'ul');
      for (const text of list) add(items, 'li', text);
    }
  }

  function showTable(holder, { title, help, columns, rows }) {
    add(holder, 'h2', title);
    add(holder, 'p', help, 'help');
    const table = add(add(holder, 'div', undefined, 'wide'), 'table'), head = add(add(table, 'thead'), 'tr');
    for (const column of columns) add(head, 'th', column);
    const body = add(table, 'tbody');
    for (const cells of rows) {
      const line = add(body, 'tr');
      for (const text of cells) add(line, 'td', text);
    }
  }

  function showProvenance() {
    const box = byId('provenance');
    add(box, 'h2', 'How it was made');
    const table = add(box, 'table');
    for (const [name, text] of record.provenance) {
      const line = add(table, 'tr');
      add(line, 'td', name);
      add(line, 'td', text);
    }
  }

  byId('theme').onclick = () => {
    const dark = getComputedStyle(document.body).backgroundColor === 'rgb(255, 255, 255)';
    document.documentElement.dataset.theme = dark ? 'dark' : 'light';
  };

  return { byId, record, add, draw, picture, shown, unpack, decode, showHead, showTable, showProvenance };
})();

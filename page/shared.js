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

  async function bytesOf(element) {
    const text = atob(element.textContent.trim());
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    if (!record.deflated) return bytes.buffer;
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Response(stream).arrayBuffer();
  }

  // The arrays; before them three.js, where the page has it, which runs as soon as it is an element of the page.
  async function unpack() {
    if (byId('library')) add(document.head, 'script', new TextDecoder().decode(await bytesOf(byId('library'))));
    return arrays = await bytesOf(byId('arrays'));
  }

  // Single precision, or steps between minimum and maximum, each as its difference from the one before: all low bytes, then
  // all high ones. Step 65535 stands for no value.
  function decode(column) {
    const { offset, n, min, max, steps, stride } = column;
    if (column.single) return new Float32Array(arrays, offset, n);
    const low = new Uint8Array(arrays, offset, n), high = new Uint8Array(arrays, offset + n, n);
    const at = new Uint16Array(n), out = new Float32Array(n), width = (max - min) / steps;
    for (let i = 0; i < n; ++i) {
      at[i] = (i < stride ? 0 : at[i - stride]) + low[i] + 256 * high[i];
      out[i] = at[i] === 65535 ? NaN : min + at[i] * width;
    }
    return out;
  }

  // The values of each quantity; a target's may be the sum of the source's and the difference.
  function decodeAll(quantities) {
    const all = quantities.map((q) => (q.sum_of ? null : decode(q)));
    return all.map((values, i) => {
      if (values) return values;
      const [a, b] = quantities[i].sum_of.map((name) => all[quantities.findIndex((q) => q.name === name)]);
      return a.map((x, v) => x + b[v]);
    });
  }

  // Corners, each as its difference from the one before, in four planes of bytes.
  function decodeTriangles({ offset, n }) {
    const bytes = new Uint8Array(arrays, offset, 12 * n), out = new Uint32Array(3 * n);
    for (let i = 0, corner = 0, m = 3 * n; i < m; ++i)
      out[i] = corner = (corner + (bytes[i] | bytes[m + i] << 8 | bytes[2 * m + i] << 16 | bytes[3 * m + i] << 24)) >>> 0;
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
    const n = record.warnings.length;
    if (n) add(verdict, 'span', n === 1 ? ', with a warning' : `, with ${n} warnings`);
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

  return { byId, record, add, draw, picture, shown, unpack, decode, decodeAll, decodeTriangles, showHead, showTable, showProvenance };
})();

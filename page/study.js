// study.js: the page of a trajectory or a matrix: plots in which a click selects a frame or a pair.
'use strict';
(async function () {
  const { byId, record, add, shown, decode, draw, picture } = Page;
  const isMatrix = record.kind === 'matrix', n = record.labels.length;
  await Page.unpack();
  const columns = record.metrics.map(decode), residues = record.residues ? decode(record.residues) : null;
  const main = Math.max(0, record.metrics.findIndex((m) => m.name === 'mean_abs_difference'));
  let picked = -1, pickedResidue = -1;
  Page.showHead(record.states);
  Page.showProvenance();

  // ---- plots ----------------------------------------------------------------------------------------------------

  const scaleOf = (of) => record.scales[of.signed ? byId('colours').value : 'magnitude'];
  function colourOf(of, value) {
    if (isNaN(value)) return record.no_value;
    const scale = scaleOf(of), t = of.signed ? 0.5 + 0.5 * value / of.range : value / of.range;
    return scale[Math.max(0, Math.min(scale.length - 1, Math.round(t * (scale.length - 1))))];
  }
  const css = (rgb) => 'rgb(' + rgb.join(',') + ')';

  function legend(of) {
    const context = byId('scale').getContext('2d'), scale = scaleOf(of);
    for (let x = 0; x < 256; ++x) {
      context.fillStyle = css(scale[Math.floor(x * scale.length / 256)]);
      context.fillRect(x, 0, 1, 12);
    }
    byId('low').textContent = shown(of.signed ? -of.range : 0);
    byId('high').textContent = shown(of.range) + ' ' + of.unit;
  }

  const metric = () => Number(byId('metric').value);
  const order = () => (isMatrix && byId('order').value === 'clustered' ? record.order : record.labels.map((_, i) => i));

  // Cells of 16 units; a pair that is not trustworthy has a dot.
  function drawMatrix() {
    const of = record.metrics[metric()], values = columns[metric()], places = order(), cell = 16;
    const margin = 8 + 7 * Math.min(24, Math.max(...record.labels.map((l) => l.length)));
    const svg = picture(byId('plot'), margin + n * cell + 4, margin + n * cell + 4, of.label + ' of each pair');
    svg.style.maxWidth = 2.2 * (margin + n * cell) + 'px';
    places.forEach((v, i) => {
      const at = margin + i * cell + 0.75 * cell;
      draw(svg, 'text', { x: margin - 4, y: at, 'text-anchor': 'end' }, record.labels[v].slice(0, 24));
      draw(svg, 'text', { transform: 'translate(' + at + ',' + (margin - 4) + ') rotate(-90)' }, record.labels[v].slice(0, 24));
    });
    places.forEach((source, row) => places.forEach((target, column) => {
      if (source === target) return;
      const place = source * n + target, x = margin + column * cell, y = margin + row * cell;
      const box = draw(svg, 'rect', { x, y, width: cell - 1, height: cell - 1, fill: css(colourOf(of, values[place])), 'data-place': place });
      if (place === picked) box.setAttribute('class', 'picked');
      if (record.trust[place] === false) draw(svg, 'circle', { cx: x + cell / 2 - 0.5, cy: y + cell / 2 - 0.5, r: 2.5, class: 'doubt' });
    }));
    svg.onclick = (event) => { if (event.target.dataset.place) pick(Number(event.target.dataset.place)); };
    legend(of);
  }

  // In units of the screen's pixels, so that a phone's texts have their size.
  const width = Math.max(320, Math.min(640, byId('plot').clientWidth)), left = 56;
  const xOf = (i) => left + (n > 1 ? i / (n - 1) : 0.5) * (width - left - 12);
  function frameAt(svg, event) {
    const box = svg.getBoundingClientRect(), x = (event.clientX - box.left) / box.width * width;
    return Math.max(0, Math.min(n - 1, Math.round((x - left) / (width - left - 12) * (n - 1))));
  }

  // Values along the frames; gaps where there is none, hollow points where the frame is not trustworthy.
  function drawLine(holder, label, unit, values) {
    const height = 220, bottom = height - 34, finite = values.filter((v) => isFinite(v));
    const svg = picture(holder, width, height, label + ' along the frames');
    const low = Math.min(0, ...finite), high = Math.max(...finite, low + 1e-9);
    const yOf = (v) => bottom - (v - low) / (high - low) * (bottom - 20);
    for (const v of [low, (low + high) / 2, high]) {
      draw(svg, 'line', { x1: left, x2: width - 12, y1: yOf(v), y2: yOf(v), class: 'grid' });
      draw(svg, 'text', { x: left - 6, y: yOf(v) + 4, 'text-anchor': 'end' }, shown(v));
    }
    draw(svg, 'text', { x: left, y: 10 }, label + (unit ? ' [' + unit + ']' : ''));
    for (const i of [0, Math.floor((n - 1) / 2), n - 1])
      draw(svg, 'text', { x: xOf(i), y: height - 16, 'text-anchor': 'middle' }, record.labels[i]);
    draw(svg, 'text', { x: (left + width) / 2, y: height - 2, 'text-anchor': 'middle' }, 'Frame');
    let path = '';
    values.forEach((v, i) => { if (isFinite(v)) path += (path && isFinite(values[i - 1]) ? 'L' : 'M') + xOf(i).toFixed(1) + ' ' + yOf(v).toFixed(1); });
    draw(svg, 'path', { d: path, class: 'line' });
    if (n <= 500) values.forEach((v, i) => { if (isFinite(v)) draw(svg, 'circle', { cx: xOf(i), cy: yOf(v), r: 3, class: record.trust[i] === false ? 'point doubt' : 'point' }); });
    if (picked >= 0) draw(svg, 'line', { x1: xOf(picked), x2: xOf(picked), y1: 20, y2: bottom, class: 'mark' });
    svg.onclick = (event) => pick(frameAt(svg, event));
  }

  // A row a residue, a column a frame.
  function drawResidues() {
    const holder = byId('residues'), of = record.residues, names = of.names;
    holder.textContent = '';
    add(holder, 'h2', 'Residues: ' + of.label);
    const canvas = add(holder, 'canvas');
    canvas.width = n;
    canvas.height = names.length;
    const context = canvas.getContext('2d'), pixels = context.createImageData(n, names.length);
    for (let i = 0; i < n * names.length; ++i) pixels.data.set([...colourOf(of, residues[i]), 255], 4 * i);
    context.putImageData(pixels, 0, 0);
    canvas.onclick = (event) => {
      const box = canvas.getBoundingClientRect();
      pickedResidue = Math.min(names.length - 1, Math.floor((event.clientY - box.top) / box.height * names.length));
      pick(Math.min(n - 1, Math.floor((event.clientX - box.left) / box.width * n)));
    };
    add(holder, 'p', names[0] + ' above, ' + names[names.length - 1] + ' below; colours from ' + (of.signed ? -of.range : 0) + ' to ' + of.range +
      (residues.some(isNaN) ? '; grey: no value' : '') + '.', 'help');
    if (pickedResidue >= 0) drawLine(add(holder, 'div'), names[pickedResidue], '', Array.from(residues.subarray(pickedResidue * n, (pickedResidue + 1) * n)));
  }

  function redraw() {
    const of = record.metrics[metric()];
    byId('help').textContent = of.help;
    if (isMatrix) drawMatrix(); else drawLine(byId('plot'), of.label, of.unit, Array.from(columns[metric()]));
    if (residues) drawResidues();
  }

  // ---- the selected frame or pair ---------------------------------------------------------------------------------

  function pick(place) {
    if (isMatrix && Math.floor(place / n) === place % n) return;
    picked = place;
    const [source, target] = [record.labels[Math.floor(place / n)], record.labels[place % n]];
    const name = isMatrix ? source + ' to ' + target : 'Frame ' + record.labels[place];
    byId('chosen').textContent = name;
    const trust = record.trust[place], box = byId('remarks');
    box.textContent = '';
    add(box, 'p', trust === null ? 'Not computed' : trust ? 'Trustworthy' : 'Not trustworthy', trust ? 'good' : 'bad');
    for (const text of record.remarks[place] || []) add(box, 'p', text);
    const body = byId('values').tBodies[0];
    body.textContent = '';
    record.metrics.forEach((m, i) => {
      const line = add(body, 'tr', undefined, i === metric() ? 'picked' : '');
      const label = add(line, 'td', m.label);
      label.title = m.help;
      add(line, 'td', shown(columns[i][place]) + (m.unit ? ' ' + m.unit : ''));
      line.onclick = () => { byId('metric').value = i; redraw(); pick(picked); };
    });
    byId('picked').textContent = name + ': ' + record.metrics[metric()].label + ' ' + shown(columns[metric()][place]) + ' ' + record.metrics[metric()].unit +
      (pickedResidue >= 0 && residues ? '; ' + record.residues.names[pickedResidue] + ' ' + shown(residues[pickedResidue * n + place]) : '');
    redraw();
  }

  const steps = { ArrowRight: 1, ArrowLeft: -1, ArrowDown: isMatrix ? n : 1, ArrowUp: isMatrix ? -n : -1 };
  byId('plot').onkeydown = (event) => {
    const step = steps[event.key];
    if (!step || picked < 0) return;
    event.preventDefault();
    const last = record.trust.length - 1;
    let next = picked + step;
    if (isMatrix && Math.floor(next / n) === next % n) next += step;
    if (next >= 0 && next <= last) pick(next);
  };

  record.metrics.forEach((m, i) => { add(byId('metric'), 'option', m.label).value = i; });
  for (const name of record.diverging) add(byId('colours'), 'option', name).value = name;
  byId('metric').value = main;
  byId('orders').hidden = !isMatrix || !record.order.length;
  byId('legend').hidden = !isMatrix;
  byId('metric').onchange = byId('order').onchange = byId('colours').onchange = () => { redraw(); if (picked >= 0) pick(picked); };
  redraw();
  pick(isMatrix ? 1 : 0);
  document.documentElement.dataset.ready = 'yes';
})();

// patches.js: the significant patches of an ensemble: their table, and the mean of one in each frame.
'use strict';
Page.patches = (() => {
  const { byId, record, add, shown, draw, picture } = Page;
  const colours = ['#3b6fb6', '#d07a1d'], width = 900, height = 240, left = 56, bottom = height - 40;
  let picked = -1, chosen = -1;

  // Calls `onPick` with the number of a patch, from 0, that the reader chose in the table.
  function showTable(onPick) {
    byId('patches').hidden = false;
    if (!record.patches.length) return void add(byId('patches'), 'p', 'No patch is significant.');
    const body = add(add(byId('patches'), 'div', undefined, 'wide'), 'table');
    const head = add(add(body, 'thead'), 'tr'), rows = add(body, 'tbody');
    for (const title of ['Patch', 'Area', 'Difference', 'p', 'Residues']) add(head, 'th', title);
    record.patches.forEach((patch, k) => {
      const line = add(rows, 'tr', undefined, 'choice');
      for (const text of [k + 1, patch.area, patch.difference, patch.p, patch.residues.slice(0, 6).join(', ')]) add(line, 'td', text);
      line.onclick = () => onPick(k);
    });
    add(byId('patches'), 'div', undefined, 'wide').id = 'series';
    add(byId('patches'), 'p', '', 'help').id = 'frame';
  }

  function show(k) {
    if (k !== picked) chosen = -1;
    picked = k;
    byId('patches').querySelectorAll('tr.choice').forEach((line, i) => line.classList.toggle('picked', i === k));
    if (record.series) drawSeries();
  }

  // Each run's frames one after the other, in its group's colour.
  function drawSeries() {
    const { runs, frames } = record.series, n = frames.length, holder = byId('series');
    const values = Page.decode(record.series.patches[picked]), finite = values.filter((v) => isFinite(v));
    const svg = picture(holder, width, height, 'Mean of patch ' + (picked + 1) + ' in each frame');
    const low = Math.min(0, ...extremes(finite)), high = Math.max(...extremes(finite), low + 1e-9);
    const groups = [...new Set(runs.map((run) => run.group))];
    const xOf = (i) => left + (i + 0.5) / n * (width - left - 8), yOf = (v) => bottom - (v - low) / (high - low) * (bottom - 18);
    for (const v of low < 0 && high > 0 ? [low, 0, high] : [low, high]) {
      draw(svg, 'line', { x1: left, x2: width - 8, y1: yOf(v), y2: yOf(v), class: 'grid' });
      draw(svg, 'text', { x: left - 6, y: yOf(v) + 4, 'text-anchor': 'end' }, shown(v));
    }
    draw(svg, 'text', { x: left, y: 11 }, 'Mean of patch ' + (picked + 1) + (record.quantities[0].unit ? ' [' + record.quantities[0].unit + ']' : '') + ', frame by frame; bars: means of the replicates');
    runs.forEach((run, r) => {
      const end = r + 1 < runs.length ? runs[r + 1].begin : n, colour = colours[groups.indexOf(run.group) % 2];
      let path = '', sum = 0, count = 0;
      for (let i = run.begin; i < end; ++i) {
        if (!isFinite(values[i])) continue;
        path += (path && isFinite(values[i - 1]) ? 'L' : 'M') + xOf(i).toFixed(1) + ' ' + yOf(values[i]).toFixed(1);
        sum += values[i];
        ++count;
      }
      draw(svg, 'path', { d: path, class: 'line', style: 'stroke:' + colour });
      if (count) draw(svg, 'line', { x1: xOf(run.begin), x2: xOf(end - 1), y1: yOf(sum / count), y2: yOf(sum / count), style: 'stroke:' + colour + ';stroke-width:3' });
      draw(svg, 'line', { x1: xOf(end - 0.5), x2: xOf(end - 0.5), y1: 18, y2: bottom, class: 'grid' });
      draw(svg, 'text', { x: (xOf(run.begin) + xOf(end - 1)) / 2, y: height - (r % 2 ? 10 : 24), 'text-anchor': 'middle', style: 'fill:' + colour }, run.name.slice(0, 30));
    });
    if (chosen >= 0) draw(svg, 'line', { x1: xOf(chosen), x2: xOf(chosen), y1: 18, y2: bottom, class: 'mark' });
    svg.onclick = (event) => {
      const box = svg.getBoundingClientRect(), x = (event.clientX - box.left) / box.width * width;
      chosen = Math.max(0, Math.min(n - 1, Math.floor((x - left) / (width - left - 8) * n)));
      drawSeries();
    };
    const run = runs.filter((one) => one.begin <= chosen).pop();
    byId('frame').textContent = chosen < 0 ? 'Click in the plot to read a frame.' : run.group + ', ' + run.name + ', frame ' + frames[chosen] + ': ' + shown(values[chosen]) + ' ' + record.quantities[0].unit;
  }

  // Not Math.min(...values): a call takes only so many arguments.
  function extremes(values) {
    return values.length ? [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))] : [0];
  }

  return { showTable, show };
})();
